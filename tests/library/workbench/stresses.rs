//! Equilibrium elements that are broken on purpose.

use hypercircle::element::{Block, EquilibriumElement, Material, Modes, ModesMut};
use hypercircle::load::BodyForce;
use hypercircle::workbench::stress::SolverElement;
use hypercircle::workbench::{Options, Report};

/// A defect planted in the block of degree 1.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Defect {
    None,
    /// One part has a constant stress of its own.
    InnerJump,
    /// γ twice as large.
    WrongMaterial,
    /// Stresses are turned the wrong way: Qᵀ τ Q in place of Q τ Qᵀ.
    Transposed,
    /// A stress with a divergence in the first mode.
    Unbalanced,
    /// Tractions along the inward normal.
    Inward,
    /// One mode is missing: twice the same.
    Dependent,
}

struct Broken(Defect);

impl EquilibriumElement for Broken {
    fn name(&self) -> &'static str {
        "broken"
    }

    fn degree(&self) -> usize {
        1
    }

    fn parameters(&self) -> usize {
        9
    }

    fn kept(&self) -> usize {
        Block.kept()
    }

    fn compute(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce, out: ModesMut<'_>) {
        let material = if self.0 == Defect::WrongMaterial { &Material::ANY } else { material };
        let ModesMut { traction, particular_traction, kept, particular_energy } = out;
        let own = ModesMut { traction: &mut *traction, particular_traction, kept, particular_energy };
        Block.compute(corners, material, force, own);
        match self.0 {
            Defect::Inward => traction.iter_mut().for_each(|t| *t = -*t),
            Defect::Dependent => traction.copy_within(0..12, 12),
            _ => {}
        }
    }

    fn stresses(
        &self,
        corners: [[f64; 2]; 3],
        force: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        particular: f64,
        out: &mut [[f64; 3]],
    ) {
        let mut s = s.to_vec();
        if self.0 == Defect::Dependent {
            s[0] += std::mem::take(&mut s[1]);
        }
        Block.stresses(corners, force, modes, &s, particular, out);
        match self.0 {
            Defect::InnerJump => out[..3].iter_mut().for_each(|v| v[0] += s[0]),
            Defect::Unbalanced => {
                let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
                for part in 0..3 {
                    let nodes = [corners[(part + 1) % 3], corners[(part + 2) % 3], centre];
                    (0..3).for_each(|n| out[3 * part + n][0] += s[0] * nodes[n][0]);
                }
            }
            Defect::Transposed => {
                let (sin, cos) = 0.5_f64.sin_cos();
                for [xx, yy, xy] in out {
                    let (a, b, c) = (*xx, *yy, *xy);
                    *xx = cos * cos * a + sin * sin * b + 2.0 * sin * cos * c;
                    *yy = sin * sin * a + cos * cos * b - 2.0 * sin * cos * c;
                    *xy = sin * cos * (b - a) + (cos * cos - sin * sin) * c;
                }
            }
            _ => {}
        }
    }
}

/// The properties that fail.
fn failing(broken: &'static Broken) -> Vec<String> {
    let report = Report::of_stress(&SolverElement(broken), &Options::default());
    assert_eq!(report.passed, broken.0 == Defect::None, "{:?}: {}", broken.0, report.verdict);
    report.findings.into_iter().filter(|f| f.is_missing()).map(|f| f.name).collect()
}

#[test]
fn every_defect_is_named_by_its_property() {
    static BROKEN: [(Broken, &str); 6] = [
        (Broken(Defect::InnerJump), "inner-continuity"),
        (Broken(Defect::WrongMaterial), "orthonormality"),
        (Broken(Defect::Transposed), "divergence"),
        (Broken(Defect::Unbalanced), "divergence"),
        (Broken(Defect::Inward), "traction-coefficients"),
        (Broken(Defect::Dependent), "traction-rank"),
    ];
    for (broken, property) in &BROKEN {
        let missing = failing(broken);
        assert!(missing.iter().any(|name| name == property), "{:?}: {missing:?}", broken.0);
    }
}

/// So that what fails above fails for the defect alone.
#[test]
fn without_a_defect_nothing_fails() {
    static SOUND: Broken = Broken(Defect::None);
    assert_eq!(failing(&SOUND), Vec::<String>::new());
}
