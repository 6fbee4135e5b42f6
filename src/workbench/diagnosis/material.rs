//! Mistakes of the material: sign, factor, plane state, shear, any other Hooke's law.

use nalgebra::{DMatrix, Matrix3};

use super::{Reference, Trial, fit};
use crate::report::text::number::significant;
use crate::scene::Kinematics;
use crate::workbench::displacement::{DisplacementElement, material_words};
use crate::workbench::formulas::{Family, Variant};
use crate::workbench::material::Material;

/// How near a factor must be to one with a reason for that to be told.
const SAME: f64 = 1e-6;

/// Sign, factor, plane state, shear.
pub(super) fn trials(e: &DisplacementElement, r: &Reference) -> Vec<Trial> {
    let mut trials = Vec::new();
    let mut push = |rank, cause, sentence: String, matrix: Result<DMatrix<f64>, String>| {
        trials.extend(matrix.ok().map(|matrix| Trial { rank, cause, sentence, matrix }));
    };
    push(0, "sign", "K has the wrong sign".into(), Ok(-&r.matrix));
    let factor = e.matrix.dot(&r.matrix) / r.matrix.norm_squared();
    push(4, "factor", factor_words(e, r, factor), Ok(&r.matrix * factor));
    if let Some(material) = e.material {
        for (cause, factor, words) in wrong_modulus(&material) {
            if (factor - 1.0_f64).abs() > 1e-3 {
                push(1, cause, words.into(), Ok(&r.matrix * factor));
            }
        }
        let other = material.in_other_kinematics();
        let text = format!("K is that of {} and not of {}", other.kinematics.words(), material.kinematics.words());
        push(1, "plane-state", text, r.variant(&(other.hooke() * other.thickness), Variant::Right));
    }
    // K is linear in D_33: how often does shear count?
    let mut only_shear = Matrix3::zeros();
    only_shear[(2, 2)] = r.hooke[(2, 2)];
    if let (true, Ok(shear)) = (r.is_isoparametric(), r.variant(&only_shear, Variant::Right)) {
        let part = (&e.matrix - &r.matrix).dot(&shear) / shear.norm_squared();
        let text = format!(
            "shear counts {} times: γ_xy = 2 ε_xy and ε_xy are mixed up, or G is wrong",
            significant(1.0 + part, 6)
        );
        push(2, "shear", text, Ok(&r.matrix + shear * part));
    }
    trials
}

/// Factors in front of Hooke's law that are mistaken for the right one: what K is multiplied by, and in words.
fn wrong_modulus(m: &Material) -> [(&'static str, f64, &'static str); 3] {
    let nu = m.poisson;
    match m.kinematics {
        Kinematics::PlaneStress => [
            ("plane-stress-factor", 1.0 + nu, "E/(1 − ν) stands where E/(1 − ν²) belongs"),
            ("plane-stress-factor", 1.0 - nu, "E/(1 + ν) stands where E/(1 − ν²) belongs"),
            ("plane-stress-factor", 1.0 - nu * nu, "E stands where E/(1 − ν²) belongs"),
        ],
        Kinematics::PlaneStrain | Kinematics::Axisymmetric => [
            ("plane-strain-factor", 1.0 + nu, "E/(1 − 2ν) stands where E/((1 + ν)(1 − 2ν)) belongs"),
            ("plane-strain-factor", 1.0 - 2.0 * nu, "E/(1 + ν) stands where E/((1 + ν)(1 − 2ν)) belongs"),
            (
                "plane-strain-factor",
                (1.0 - 2.0 * nu) / (1.0 - nu),
                "E/((1 + ν)(1 − ν)) stands where E/((1 + ν)(1 − 2ν)) belongs",
            ),
        ],
    }
}

/// Possible origins of a factor, in words: several mistakes give the same matrix.
fn factor_words(e: &DisplacementElement, r: &Reference, factor: f64) -> String {
    let mut reasons = vec!["another Young's modulus or thickness".to_string()];
    // On [−1, 1]² as most programs have it; of a triangle det J is twice the area.
    let (det, name) =
        if r.family.corners() == 4 { (0.25 * e.outline.area, "a quarter") } else { (2.0 * e.outline.area, "twice") };
    let mut also = |value: f64, words: String| {
        if (factor / value - 1.0).abs() < SAME.max(e.precision) && (value - 1.0).abs() > SAME {
            reasons.push(words);
        }
    };
    also(1.0 / det, format!("det J omitted ({name} of the area, {})", significant(det, 6)));
    also(det, format!("det J squared ({name} of the area, {})", significant(det, 6)));
    match r.family.corners() {
        3 => also(2.0, "weights that sum to 1 and not to ½, the area of the reference triangle".into()),
        _ => also(0.25, "weights that sum to 1 and not to 4, the area of the reference square".into()),
    }
    if let Some(m) = e.material {
        also(1.0 / m.thickness, format!("the thickness omitted ({})", significant(m.thickness, 6)));
        also(m.thickness, format!("the thickness counted twice ({})", significant(m.thickness, 6)));
        also(1.0 / m.young, format!("E omitted ({})", significant(m.young, 6)));
    }
    format!("K is {} times what it must be, as with {}", significant(factor, 6), reasons.join(", or "))
}

/// Any Hooke's law: K is linear in its entries.
pub(super) fn fitted_hooke(k: &DMatrix<f64>, precision: f64, r: &Reference) -> Option<Trial> {
    if !r.is_isoparametric() {
        return None;
    }
    let places: Vec<(usize, usize)> = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).collect();
    let of = |&(i, j): &(usize, usize)| {
        let mut d = Matrix3::zeros();
        d[(i, j)] = 1.0;
        r.variant(&d, Variant::Right).ok()
    };
    let columns: Vec<DMatrix<f64>> = places.iter().map(of).collect::<Option<_>>()?;
    let found = fit::nearest(k, &columns);
    let d = Matrix3::from_fn(|i, j| found[3 * i + j]);
    let matrix = r.variant(&d, Variant::Right).ok()?;
    // On a linear triangle whatever leaves rigid motions without forces is some Hooke's law; one that couples stretch and shear says nothing there.
    let coupling = [(0, 2), (1, 2), (2, 0), (2, 1)].iter().map(|&at| d[at].abs()).fold(0.0, f64::max);
    if r.family == Family::P1 && coupling > 1e-6_f64.max(30.0 * precision) * d.amax() {
        return None;
    }
    let sentence = match material_words(&d) {
        Some(words) => format!("the material is another one: {words}"),
        None => {
            let row = |i: usize| (0..3).map(|j| significant(d[(i, j)], 4)).collect::<Vec<_>>().join(", ");
            format!("Hooke's law times thickness is no isotropic one: ({}; {}; {})", row(0), row(1), row(2))
        }
    };
    Some(Trial { rank: 6, cause: "material", sentence, matrix })
}
