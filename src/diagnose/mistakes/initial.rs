//! Wrong temperatures and initial stresses.

use crate::diagnose::fit::Terms;
use crate::diagnose::space::Space;
use crate::diagnose::words::{factor, near, number};
use crate::diagnose::{Finding, Trial};
use crate::elasticity::Initial;
use crate::element::{Material, Quadrilateral};
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
    let graded = |body: &Body| match body.initial {
        // Where the temperature is its gradient alone, it has that word.
        Initial { temperature: 0.0, .. } => Initial::default(),
        _ => Initial { temperature: 0.0, ..warm(body) },
    };
    let strained = |body: &Body| Initial { stress: body.initial.stress, ..Initial::default() };
    let sheared = |body: &Body| match body.initial.stress {
        // Where it is shear alone, it has the word of all of it.
        [0.0, 0.0, _, 0.0] => Initial::default(),
        [_, _, shear, _] => Initial { stress: [0.0, 0.0, shear, 0.0], ..Initial::default() },
    };
    // An isotropic body in plane strain has the hint of its temperature.
    let plane_strain = scene.kinematics == Kinematics::PlaneStrain;
    let across = |body: &Body| match body.elasticity.isotropic() {
        None if plane_strain => Initial { expansion: [0.0, 0.0, body.initial.expansion[2]], ..warm(body) },
        _ => Initial::default(),
    };
    type PartOf<'a> = &'a dyn Fn(&Body) -> Initial;
    let kinds: [(&str, &str, PartOf<'_>); 5] = [
        ("temperature", "temperature", &warm),
        ("temperature_gradient", "gradient of the temperature", &graded),
        ("temperature_across", "thermal strain out of the plane", &across),
        ("initial_stress", "initial stress", &strained),
        ("initial_stress_shear", "shear of the initial stress", &sheared),
    ];
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
        if key == "temperature" {
            for &b in &own {
                temperatures(space, &[b], terms, &held);
            }
            if own.len() > 1 {
                temperatures(space, &own, terms, &held);
            }
        }
        if own.len() > 1 {
            let (name, what) = (format!("bodies/{key}"), format!("the {what} of every body"));
            terms.push(1, vec![column(&|at| own.contains(&at))], move |x| {
                vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), factor(&what, 1.0 + x[0]))]
            });
        }
    }
}

/// Value and gradient of the temperature of some bodies, each off by a number of its own.
fn temperatures<'a>(
    space: &'a Space<'a>,
    own: &[usize],
    terms: &mut Terms<'a>,
    held: &impl Fn(&dyn Fn(usize) -> Option<Material>) -> Vec<[f64; 2]>,
) {
    let scene = &space.problem().scene;
    let column = |temperature: f64, gradient: [f64; 2]| {
        let of = |b: usize| {
            let body = &scene.bodies[b];
            let initial = Initial { temperature, gradient, stress: [0.0; 4], ..body.initial };
            let material = Material::new(scene.kinematics, &body.elasticity);
            own.contains(&b).then(|| material.with_initial(scene.kinematics, &body.elasticity, &initial))
        };
        space.column(held(&of).into_iter().map(|f| f.map(|x| -x)).collect())
    };
    let columns = vec![column(1.0, [0.0; 2]), column(0.0, [1.0, 0.0]), column(0.0, [0.0, 1.0])];
    let [first, rest @ ..] = own else { return };
    let (body, alone) = (&scene.bodies[*first], rest.is_empty());
    let (given, origin) = (body.initial, scene.origin);
    terms.push(3, columns, move |x| {
        let found = [given.gradient[0] + x[1], given.gradient[1] + x[2]];
        // As the scene has it, about the origin that it is written for.
        let at_origin = |value: f64, gradient: [f64; 2]| value - gradient[0] * origin[0] - gradient[1] * origin[1];
        let values = [at_origin(given.temperature + x[0], found), at_origin(given.temperature, given.gradient)];
        let whose = if alone { body.name.clone() } else { "every body".to_string() };
        let name = if alone { format!("body/{}/temperature", body.name) } else { "bodies/temperature".to_string() };
        let told = |value: f64, gradient: [f64; 2]| {
            let [value, x, y] = [value, gradient[0], gradient[1]].map(|x| short(x, &[value, gradient[0], gradient[1]]));
            if x == "0" && y == "0" { value } else { format!("{value} with the gradient ({x}, {y})") }
        };
        let sentence = match alone {
            true => format!(
                "the temperature of {whose} is {} in place of {}",
                told(values[0], found),
                told(values[1], given.gradient)
            ),
            false => {
                format!("the temperature of {whose} is off by {}", told(at_origin(x[0], [x[1], x[2]]), [x[1], x[2]]))
            }
        };
        vec![Finding::new(name, None, None, sentence)]
    });
}

/// A number, zero for what is rounding beside the largest of some others.
fn short(x: f64, beside: &[f64]) -> String {
    let largest = beside.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    if x.abs() < 1e-6 * largest || x == 0.0 { "0".to_string() } else { number(x) }
}

/// Temperatures that are the mean one of each quadrilateral of four nodes.
pub fn in_the_mean(space: &Space<'_>) -> Option<Trial> {
    let (problem, candidate) = (space.problem(), space.solution.candidate);
    let bodies = &problem.scene.bodies;
    let linear = candidate.cells.iter().all(|cell| cell.field.nodes() == 4) && !candidate.cells.is_empty();
    if !linear || bodies.iter().all(|body| body.initial.gradient == [0.0; 2]) {
        return None;
    }
    let materials = problem.materials();
    let [exact, mean] = [false, true].map(|mean| {
        space.forces_at(|b, x, cell| {
            let middle = |cell: &Quadrilateral| [0, 1].map(|c| cell.corners().iter().map(|p| p[c]).sum::<f64>() / 4.0);
            Some(materials[b].held_back(cell.filter(|_| mean).map_or(x, middle)))
        })
    });
    let change: Vec<f64> = space.column(mean).iter().zip(space.column(exact)).map(|(m, e)| e - m).collect();
    let sentence =
        "the temperature of each quadrilateral of four nodes is the mean one of its nodes, as CalculiX takes it";
    let findings = vec![Finding::new("temperature/mean", None, None, sentence)];
    Some(Trial { rank: 0, left: space.left_with(&change), findings })
}

/// 1 + ν of an isotropic body in plane strain.
fn ratio_of_strip(body: &Body, kinematics: Kinematics) -> Option<f64> {
    let [_, poisson] = body.elasticity.isotropic()?;
    (kinematics == Kinematics::PlaneStrain && poisson != 0.0).then_some(1.0 + poisson)
}
