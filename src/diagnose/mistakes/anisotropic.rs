//! Wrong axes and constants of bodies that are not isotropic.

use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::{Finding, Trial};
use crate::elasticity::{Anisotropic, Elasticity, Matrix, MatrixKind, Orthotropic};

/// A mistake: the end of its name, the law that results, and the sentence about a body.
struct Mistake {
    name: &'static str,
    law: Elasticity,
    sentence: &'static str,
}

/// Mistakes of one body after the other, and of all of them at once.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let bodies = &space.problem().scene.bodies;
    let own: Vec<usize> = (0..bodies.len()).filter(|b| bodies[*b].elasticity.isotropic().is_none()).collect();
    let mut trials = Vec::new();
    for &b in &own {
        for Mistake { name, law, sentence } in mistakes(&bodies[b].elasticity) {
            let finding = format!("body/{}/{name}", bodies[b].name);
            let sentence = format!("{sentence} of {}", bodies[b].name);
            if !bodies[b].initial.is_none() && !space.problem().section().is_revolved() {
                trials.push(with_own_initial(space, (b, &law), &finding, &sentence));
            }
            trials.push(trial(space, |at| (at == b).then_some(law), finding, sentence));
        }
    }
    if own.len() > 1 {
        let of_first: Vec<(&str, &str)> =
            mistakes(&bodies[own[0]].elasticity).iter().map(|mistake| (mistake.name, mistake.sentence)).collect();
        for (name, sentence) in of_first {
            let law = |at: usize| {
                let found = mistakes(&bodies[at].elasticity).into_iter().find(|mistake| mistake.name == name);
                found.map(|mistake| mistake.law)
            };
            trials.push(trial(space, law, format!("bodies/{name}"), format!("{sentence} of every body")));
        }
    }
    trials
}

fn trial(space: &Space<'_>, law: impl Fn(usize) -> Option<Elasticity>, name: String, sentence: String) -> Trial {
    let left = space.left_with(&space.with_laws(law));
    Trial { rank: 0, left, findings: vec![Finding::new(name, None, None, sentence)] }
}

/// As [`trial`], for one body whose initial strain stays as it is.
fn with_own_initial(space: &Space<'_>, (body, law): (usize, &Elasticity), name: &str, sentence: &str) -> Trial {
    let kinematics = space.problem().scene.kinematics;
    let change = space.stiffness(|b| {
        let own = Moduli::of_law(kinematics, &space.problem().scene.bodies[b].elasticity);
        (b == body).then(|| Moduli::of_law(kinematics, law).less(own))
    });
    let sentence = format!("{sentence}, and its initial strain is that of the scene");
    Trial { rank: 0, left: space.left_with(&change), findings: vec![Finding::new(name, None, None, sentence)] }
}

/// The commonest mistakes in such a law, where they result in another material.
fn mistakes(law: &Elasticity) -> Vec<Mistake> {
    let angle = law.angle();
    let to = |other: f64| law.turned(other - angle);
    let mut all = vec![
        Mistake {
            name: "angle-sign",
            law: to(-angle),
            sentence: "the angle from x to axis 1 has the other sign: axis 1",
        },
        Mistake { name: "angle-missing", law: to(0.0), sentence: "the angle from x to axis 1 is left out: axis 1" },
        Mistake {
            name: "angle-radians",
            law: to(angle.to_degrees()),
            sentence: "the angle in degrees is taken for one in radians: axis 1",
        },
        Mistake {
            name: "angle-degrees",
            law: to(angle.to_radians()),
            sentence: "the angle is converted to radians where degrees are asked for: axis 1",
        },
        Mistake { name: "axes-swapped", law: law.turned(90.0), sentence: "axes 1 and 2 are exchanged: those" },
    ];
    match *law {
        Elasticity::Orthotropic(own) => {
            let Orthotropic { young: [e1, e2, e3], poisson: [nu12, nu13, nu23], shear, .. } = own;
            let mut push =
                |name, sentence, law| all.push(Mistake { name, law: Elasticity::Orthotropic(law), sentence });
            let with_poisson = |first: f64| Orthotropic { poisson: [first, nu13, nu23], ..own };
            push("nu12-for-nu21", "nu12 stands where nu21 belongs: the ratio", with_poisson(nu12 * e1 / e2));
            push("nu21-for-nu12", "nu21 stands where nu12 belongs: the ratio", with_poisson(nu12 * e2 / e1));
            push("young-swapped", "E1 and E2 are exchanged: the moduli", Orthotropic { young: [e2, e1, e3], ..own });
            push("shear-doubled", "G12 counts twice: the shear modulus", Orthotropic { shear: 2.0 * shear, ..own });
            push("shear-halved", "G12 counts half: the shear modulus", Orthotropic { shear: 0.5 * shear, ..own });
        }
        Elasticity::Anisotropic(own) => {
            let of = |factor: f64| {
                let mut matrix = own.matrix;
                match &mut matrix {
                    Matrix::Three(rows) => rows[2][2] *= factor,
                    Matrix::Six(rows) => rows[5][5] *= factor,
                }
                Elasticity::Anisotropic(Anisotropic { matrix, ..own })
            };
            let larger = if own.kind == MatrixKind::Stiffness { 2.0 } else { 0.5 };
            all.push(Mistake {
                name: "shear-doubled",
                law: of(larger),
                sentence: "the shear stiffness counts twice: that",
            });
            all.push(Mistake {
                name: "shear-halved",
                law: of(1.0 / larger),
                sentence: "the shear stiffness counts half: that",
            });
        }
        Elasticity::Isotropic { .. } => {}
    }
    all.retain(|mistake| mistake.law != *law && mistake.law.flaw().is_none());
    all
}
