//! Wrong loads.

use std::f64::consts::TAU;

use crate::compare::forces::functions::Functions;
use crate::compare::forces::{cells, tractions, turned};
use crate::diagnose::fit::Terms;
use crate::diagnose::space::Space;
use crate::diagnose::words::{LEAST_UNIT, factor, near, number, times};
use crate::diagnose::{Finding, Trial};
use crate::load::{Affine, BodyForce};
use crate::scene::{Body, Load, Traction};

/// Coefficients of components that are smaller than this are none.
const NONE: f64 = 5e-3;
/// Squared sines of angles up to this one are of one direction.
const ALIKE: f64 = 1e-12;

/// Loads that are off by a number, one by one and all together, and body forces that the scene does not have.
pub fn terms<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) {
    let scene = &space.problem().scene;
    let tractions: Vec<(&str, Vec<[f64; 2]>)> = scene
        .tractions
        .iter()
        .map(|traction| (traction.on.as_str(), of_traction(space, &traction.on)))
        .filter(|(_, forces)| forces.iter().flatten().any(|f| *f != 0.0))
        .collect();
    let weights: Vec<usize> = (0..scene.bodies.len()).filter(|b| !scene.bodies[*b].body_force.is_none()).collect();
    let several = tractions.len() + weights.len() > 1;
    let negative = |forces: &[[f64; 2]]| space.column(forces.iter().map(|f| f.map(|x| -x)).collect());
    let (thickness, revolved) = (scene.thickness, space.solution.rule.is_some());
    let hinted = move |what: &str, s: f64| {
        let mut sentence = factor(what, s);
        if revolved && (near(s, TAU) || near(s, 1.0 / TAU)) {
            sentence += ", as if 2π were left out on one side";
        } else if thickness != 1.0 && (near(s, thickness) || near(s, 1.0 / thickness)) {
            sentence += &format!(", as if the thickness {thickness} were left out on one side");
        }
        sentence
    };
    let all = move |name: &str, what: &str, s: f64| {
        let mut sentence = hinted(what, s);
        // No modulus is negative, and what is missing is no unit.
        if s > LEAST_UNIT {
            sentence += &format!(" (or every Young's modulus {} times)", times(1.0 / s));
        }
        vec![Finding::new(name, Some(s), Some(1.0), sentence)]
    };
    if several {
        // What initial strains pull is no load.
        let column = negative(&space.solution.forces.applied());
        terms.push(1, vec![column], move |x| all("loads", "every load", 1.0 + x[0]));
    }
    if weights.len() > 1 {
        let all = weights.iter().map(|&b| of_body(space, b, &scene.bodies[b].body_force));
        let whole = all.reduce(|sum, own| sum.iter().zip(own).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect());
        terms.push(1, vec![negative(&whole.unwrap_or_default())], move |x| {
            let sentence = hinted("the body force of every body", 1.0 + x[0]);
            vec![Finding::new("bodies/body_force", Some(1.0 + x[0]), Some(1.0), sentence)]
        });
    }
    for traction in &scene.tractions {
        parts_of_traction(space, traction, terms);
    }
    for (on, forces) in &tractions {
        let (on, name, what) = (on.to_string(), format!("load/{on}"), format!("the load on {on}"));
        terms.push(1, vec![negative(forces)], move |x| match several {
            true => vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), hinted(&what, 1.0 + x[0]))],
            false if revolved => all("loads", "every load", 1.0 + x[0]),
            false => all(&name, &what, 1.0 + x[0]),
        });
        // Each component of the traction acting in each direction.
        let part = |from: usize, to: usize| {
            let turned = |f: &[f64; 2]| if to == 0 { [f[from], 0.0] } else { [0.0, f[from]] };
            negative(&forces.iter().map(turned).collect::<Vec<_>>())
        };
        let given = [0, 1].map(|c| forces.iter().any(|f| f[c] != 0.0));
        let parts: Vec<[usize; 2]> =
            [[0, 0], [1, 1], [0, 1], [1, 0]].into_iter().filter(|[from, _]| given[*from]).collect();
        let columns = |parts: &[[usize; 2]]| parts.iter().map(|[from, to]| part(*from, *to)).collect();
        if given == [true; 2] {
            let (on, own) = (on.clone(), [[0, 0], [1, 1]]);
            terms.push(2, columns(&own), move |x| components(&on, given, &own, x));
        }
        if !are_proportional(forces) {
            terms.push(3, columns(&parts), move |x| components(&on, given, &parts, x));
        }
    }
    let origin = scene.origin;
    for (b, body) in scene.bodies.iter().enumerate() {
        let [fx, fy] = [[1.0, 0.0], [0.0, 1.0]].map(|f| of_body(space, b, &f.into()));
        let force = &body.body_force;
        let name = format!("body/{}/body_force", body.name);
        let what = format!("the body force of {}", body.name);
        if !force.is_none() {
            let whole = of_body(space, b, force);
            let (name, what) = (name.clone(), what.clone());
            terms.push(1, vec![negative(&whole)], move |x| match several {
                true => vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), hinted(&what, 1.0 + x[0]))],
                false if revolved => all("loads", "every load", 1.0 + x[0]),
                false => all(&name, &what, 1.0 + x[0]),
            });
        }
        if !force.is_constant() {
            parts(space, b, terms);
            if revolved {
                continue;
            }
            let rotation = force.rotation();
            terms.push(3, vec![negative(&fx), negative(&fy)], move |x| {
                let sentence = match rotation.filter(|rotation| rotation.stiffness() != 0.0) {
                    Some(rotation) => {
                        let about = [0, 1].map(|c| origin[c] + rotation.about[c] - x[c] / rotation.stiffness());
                        format!(
                            "{what} lacks or adds the constant ({}, {}), as if it turned about ({}, {})",
                            number(x[0]),
                            number(x[1]),
                            number(about[0]),
                            number(about[1])
                        )
                    }
                    None => format!("{what} lacks or adds the constant ({}, {})", number(x[0]), number(x[1])),
                };
                vec![Finding::new(name.clone(), Some(x[0].hypot(x[1])), Some(0.0), sentence)]
            });
            continue;
        }
        let given = force.given().value;
        terms.push(3, vec![negative(&fx), negative(&fy)], move |x| {
            let [found, wanted] = [[given[0] + x[0], given[1] + x[1]], given];
            let vector = |v: [f64; 2]| format!("({}, {})", number(v[0]), number(v[1]));
            let sentence = format!("{what} is {} in place of {}", vector(found), vector(wanted));
            vec![Finding::new(name.clone(), Some(found[0].hypot(found[1])), Some(wanted[0].hypot(wanted[1])), sentence)]
        });
    }
}

/// Mistakes without a number: components of tractions, and gradients of body forces.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let mut trials = exchanged_axes(space);
    trials.extend(exchanged_gradients(space));
    trials
}

/// Tractions of two components with x and y exchanged.
fn exchanged_axes(space: &Space<'_>) -> Vec<Trial> {
    let of_traction = |traction: &Traction| {
        let forces = of_traction(space, &traction.on);
        let given = [0, 1].map(|c| forces.iter().any(|f| f[c] != 0.0));
        let change = space.column(forces.iter().map(|[x, y]| [x - y, y - x]).collect());
        let findings = vec![axes(&traction.on)];
        (given == [true; 2]).then(|| Trial { rank: 1, left: space.left_with(&change), findings })
    };
    space.problem().scene.tractions.iter().filter_map(of_traction).collect()
}

/// The finding of x and y exchanged in the traction on `on`.
fn axes(on: &str) -> Finding {
    Finding::new(format!("load/{on}/axes"), None, None, format!("x and y of the load on {on} are exchanged"))
}

/// True if x and y of all forces have one ratio: then what acts along an axis can come from either.
fn are_proportional(forces: &[[f64; 2]]) -> bool {
    let product = |a: usize, b: usize| forces.iter().map(|f| f[a] * f[b]).sum::<f64>();
    let (xx, yy, xy) = (product(0, 0), product(1, 1), product(0, 1));
    xx > 0.0 && yy > 0.0 && xx * yy - xy * xy <= ALIKE * xx * yy
}

/// Body forces and tractions with rows and columns of their gradient exchanged.
fn exchanged_gradients(space: &Space<'_>) -> Vec<Trial> {
    let scene = &space.problem().scene;
    let trial = |name: String, of: &str, forces: Vec<[f64; 2]>| {
        let change = space.column(forces.iter().map(|f| f.map(|x| -x)).collect());
        let finding = Finding::new(name, None, None, format!("rows and columns of the gradient of {of} are exchanged"));
        Trial { rank: 1, left: space.left_with(&change), findings: vec![finding] }
    };
    // What is there in place of it, less what should be.
    let change = |own: &Affine| {
        let is_symmetric = own.gradient[0][1] == own.gradient[1][0];
        (!is_symmetric).then(|| own.transposed(scene.origin).less(own))
    };
    let of_body = |(b, body): (usize, &Body)| {
        let more = BodyForce::affine(change(&body.body_force.given())?);
        let (name, of) =
            (format!("body/{}/gradient/body_force", body.name), format!("the body force of {}", body.name));
        Some(trial(name, &of, of_body(space, b, &more)))
    };
    let of_traction = |traction: &Traction| {
        let Load::Affine(own) = &traction.load else { return None };
        let on = &traction.on;
        Some(trial(format!("load/{on}/gradient"), &format!("the load on {on}"), of_affine(space, on, &change(own)?)))
    };
    let bodies = scene.bodies.iter().enumerate().filter_map(of_body);
    bodies.chain(scene.tractions.iter().filter_map(of_traction)).collect()
}

/// The two parts of an affine traction, each with a factor of its own, where it has both.
fn parts_of_traction<'a>(space: &'a Space<'a>, traction: &'a Traction, terms: &mut Terms<'a>) {
    let Load::Affine(own) = &traction.load else { return };
    let [constant, varying] = own.parts(space.problem().scene.origin);
    if constant.value == [0.0; 2] || own.is_constant() {
        return;
    }
    for (key, what, part) in [("value", "the constant part", constant), ("gradient", "the gradient", varying)] {
        let forces = of_affine(space, &traction.on, &part);
        let column = space.column(forces.iter().map(|f| f.map(|x| -x)).collect());
        let (name, what) = (format!("load/{}/{key}", traction.on), format!("{what} of the load on {}", traction.on));
        terms.push(1, vec![column], move |x| {
            vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), factor(&what, 1.0 + x[0]))]
        });
    }
}

/// The parts of a force that is not the same everywhere, each with a factor of its own, where there are several.
fn parts<'a>(space: &'a Space<'a>, b: usize, terms: &mut Terms<'a>) {
    let scene = &space.problem().scene;
    let body = &scene.bodies[b];
    let [constant, varying] = body.body_force.given().parts(scene.origin);
    let rotation = body.body_force.rotation().map(|rotation| BodyForce::NONE.with_rotation(rotation));
    let all = [
        ("value", "the constant part of the body force of", BodyForce::affine(constant)),
        ("gradient", "the gradient of the body force of", BodyForce::affine(varying)),
        ("rotation", "the rotation of", rotation.unwrap_or(BodyForce::NONE)),
    ];
    let present: Vec<_> = all.into_iter().filter(|(_, _, force)| !force.is_none()).collect();
    if present.len() < 2 {
        return;
    }
    for (key, what, force) in present {
        let column = space.column(of_body(space, b, &force).iter().map(|f| f.map(|x| -x)).collect());
        let (name, what) = (format!("body/{}/{key}/body_force", body.name), format!("{what} {}", body.name));
        terms.push(2, vec![column], move |x| {
            vec![Finding::new(name.clone(), Some(1.0 + x[0]), Some(1.0), factor(&what, 1.0 + x[0]))]
        });
    }
}

/// Findings on the components of the traction on `on`; `parts` say which component acts in which direction.
fn components(on: &str, given: [bool; 2], parts: &[[usize; 2]], x: &[f64]) -> Vec<Finding> {
    let axis = ["x", "y"];
    let factor_of = |from: usize, to: usize| {
        let own = if from == to { 1.0 } else { 0.0 };
        parts.iter().position(|p| *p == [from, to]).map_or(0.0, |k| own + x[k])
    };
    let (same, crossed) = ([0, 1].map(|c| factor_of(c, c)), [factor_of(0, 1), factor_of(1, 0)]);
    let zero = |values: [f64; 2]| (0..2).all(|c| !given[c] || values[c].abs() < NONE);
    let one = |values: [f64; 2]| (0..2).all(|c| !given[c] || near(values[c], 1.0));
    if zero(same) && one(crossed) {
        return vec![axes(on)];
    }
    let mut findings = Vec::new();
    for c in (0..2).filter(|c| given[*c]) {
        if !near(same[c], 1.0) {
            let sentence = factor(&format!("component {} of the load on {on}", axis[c]), same[c]);
            findings.push(Finding::new(format!("load/{on}/{}", axis[c]), Some(same[c]), Some(1.0), sentence));
        }
        if crossed[c].abs() >= NONE {
            let (from, to) = (axis[c], axis[1 - c]);
            let sentence = format!("component {from} of the load on {on} acts {} times along {to}", number(crossed[c]));
            findings.push(Finding::new(format!("load/{on}/{from}{to}"), Some(crossed[c]), Some(0.0), sentence));
        }
    }
    findings
}

/// Nodal forces of the traction on one boundary.
fn of_traction(space: &Space<'_>, on: &str) -> Vec<[f64; 2]> {
    let problem = space.problem();
    let (named, degree) = (problem.mesh.boundary(on), space.solution.candidate.degree);
    let mut forces = vec![[0.0; 2]; space.count()];
    for (e, traction) in problem.pressed_edges().iter().filter(|(e, _)| named.contains(e)) {
        let weighted = problem.times_weight(*e, traction);
        tractions::add(problem, (*e, &weighted), degree, Functions::Values, &mut forces);
    }
    forces
}

/// Nodal forces of an affine traction on one boundary.
fn of_affine(space: &Space<'_>, on: &str, load: &Affine) -> Vec<[f64; 2]> {
    let (problem, degree) = (space.problem(), space.solution.candidate.degree);
    let mut forces = vec![[0.0; 2]; space.count()];
    for e in problem.mesh.boundary(on) {
        let ends = problem.mesh.edges[e].vertices.map(|v| load.at(problem.mesh.points[v]));
        tractions::add(problem, (e, &problem.times_weight(e, &ends)), degree, Functions::Values, &mut forces);
    }
    forces
}

/// Nodal forces of a body force in one body.
fn of_body(space: &Space<'_>, body: usize, force: &BodyForce) -> Vec<[f64; 2]> {
    let (problem, mesh) = (space.problem(), &space.problem().mesh);
    if let Some(rule) = space.solution.rule {
        let of = |b: usize| if b == body { force } else { &BodyForce::NONE };
        return turned::body_forces(problem, space.solution.candidate, rule, of);
    }
    let mut forces = vec![[0.0; 2]; space.count()];
    for t in (0..mesh.triangles.len()).filter(|t| mesh.body[*t] == body) {
        let Some(cell) = space.counted(t) else { continue };
        if let Some(cell) = cell {
            for (node, f) in cell.nodes.iter().zip(cells::load(&cell.field, force)) {
                (0..2).for_each(|c| forces[*node][c] += problem.scene.thickness * f[c]);
            }
            continue;
        }
        let nodes = space.nodes(t);
        let shares =
            force.on(mesh.corners(t)).of_area(problem.scene.thickness * mesh.area(t)).at_nodes(nodes.len() > 3);
        for (node, f) in nodes.iter().zip(shares) {
            (0..2).for_each(|c| forces[*node][c] += f[c]);
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_of_one_direction_are_proportional() {
        assert!(are_proportional(&[[20.0, 5.0], [0.0, 0.0], [40.0, 10.0]]));
        assert!(!are_proportional(&[[20.0, 5.0], [40.0, 11.0]]));
        assert!(!are_proportional(&[[0.0, 5.0], [0.0, 10.0]]));
    }
}
