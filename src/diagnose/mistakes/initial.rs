//! Wrong temperatures and initial stresses.

use crate::diagnose::Finding;
use crate::diagnose::fit::Terms;
use crate::diagnose::space::Space;
use crate::diagnose::words::{factor, near};
use crate::elasticity::Initial;
use crate::element::Material;
use crate::scene::{Body, Kinematics};

/// Temperatures and initial stresses that are off by a factor, body by body and all together.
pub fn terms<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) {
    terms_of(space, terms, |of| {
        let materials: Vec<Option<Material>> = (0..space.problem().scene.bodies.len()).map(of).collect();
        space.forces_of(|b, x| materials[b].as_ref().map(|material| material.held_back(x)))
    });
}

/// As [`terms`], with the nodal forces of the stresses that the initial strains of given materials ask for.
pub fn terms_of<'a>(
    space: &'a Space<'a>,
    terms: &mut Terms<'a>,
    held: impl Fn(&dyn Fn(usize) -> Option<Material>) -> Vec<[f64; 2]>,
) {
    let scene = &space.problem().scene;
    let warm = |body: &Body| Initial { stress: [0.0; 4], ..body.initial };
    let strained = |body: &Body| Initial { stress: body.initial.stress, ..Initial::default() };
    type PartOf<'a> = &'a dyn Fn(&Body) -> Initial;
    let kinds: [(&str, &str, PartOf<'_>); 2] =
        [("temperature", "temperature", &warm), ("initial_stress", "initial stress", &strained)];
    for (key, what, part) in kinds {
        let own: Vec<usize> = (0..scene.bodies.len()).filter(|b| !part(&scene.bodies[*b]).is_none()).collect();
        let column = |counted: &dyn Fn(usize) -> bool| {
            let of = |b: usize| {
                let body = &scene.bodies[b];
                let material = Material::new(scene.kinematics, &body.elasticity);
                counted(b).then(|| material.with_initial(scene.kinematics, &body.elasticity, &part(body)))
            };
            space.column(held(&of).into_iter().map(|f| f.map(|x| -x)).collect())
        };
        for &b in &own {
            let body = &scene.bodies[b];
            let (name, what) = (format!("body/{}/{key}", body.name), format!("the {what} of {}", body.name));
            let strip = ratio_of_strip(body, scene.kinematics).filter(|_| key == "temperature");
            terms.push(1, vec![column(&|at| at == b)], move |x| {
                let s = 1.0 + x[0];
                let mut sentence = factor(&what, s);
                if strip.is_some_and(|strip| near(s, 1.0 / strip)) {
                    sentence += ", as if αΔT stood in place of (1 + ν)αΔT";
                }
                vec![Finding::new(name.clone(), Some(s), Some(1.0), sentence)]
            });
        }
        if own.len() > 1 {
            let (name, what) = (format!("bodies/{key}"), format!("the {what} of every body"));
            terms.push(1, vec![column(&|at| own.contains(&at))], move |x| {
                vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), factor(&what, 1.0 + x[0]))]
            });
        }
    }
}

/// 1 + ν of an isotropic body in plane strain.
fn ratio_of_strip(body: &Body, kinematics: Kinematics) -> Option<f64> {
    let [_, poisson] = body.elasticity.isotropic()?;
    (kinematics == Kinematics::PlaneStrain && poisson != 0.0).then_some(1.0 + poisson)
}
