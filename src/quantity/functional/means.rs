//! Means of displacements over boundaries and bodies, and of stresses over regions.

use super::region::{Cut, cut, twice_area};
use super::{Functional, Kind, NotBounded};
use crate::problem::{Condition, Problem};
use crate::quantity::adjoint::revolved;
use crate::scene::{Component, Region};

/// The mean displacement of a boundary along `d`.
pub fn on_boundary(problem: &Problem, name: &str, d: [f64; 2]) -> Result<Functional, NotBounded> {
    let edges = problem.mesh.boundary(name);
    let length = |e: usize| problem.mesh.edge_frame(e).0;
    // ∫ of a linear function, times the weight of the section.
    let integral = |e: usize, ends: [[f64; 2]; 2]| {
        let own = problem.weighted(e, ends);
        [0, 1].map(|c| length(e) * own.iter().map(|v| v[c]).sum::<f64>() / own.len() as f64)
    };
    let total: f64 = edges.iter().map(|&e| integral(e, [[1.0, 0.0]; 2])[0]).sum();
    if edges.is_empty() || total <= 0.0 {
        return Err(NotBounded::Empty { name: name.to_string() });
    }
    let mut functional = Functional::empty(problem, Kind::Displacement);
    let q = d.map(|d| d / total);
    for e in edges {
        match problem.conditions[e] {
            Condition::Clamped(ends) => {
                let [x, y] = integral(e, ends);
                functional.constant += q[0] * x + q[1] * y;
            }
            Condition::Roller { direction: [x, y], displacement } => {
                // What the roller prescribes is known; the load acts across it.
                let along = q[0] * x + q[1] * y;
                functional.constant += along * integral(e, [[displacement, 0.0]; 2])[0];
                functional.load.tractions.push((e, [[q[0] - along * x, q[1] - along * y]; 2]));
            }
            _ => functional.load.tractions.push((e, [q; 2])),
        }
    }
    Ok(functional)
}

/// The mean displacement of a body along `d`.
pub fn on_body(problem: &Problem, body: usize, d: [f64; 2]) -> Result<Functional, NotBounded> {
    let volume = volume(problem, body)?;
    let mut functional = Functional::empty(problem, Kind::Displacement);
    functional.load.force[body] = d.map(|d| d / volume).into();
    Ok(functional)
}

/// The area of a body, with the weight of its section.
fn volume(problem: &Problem, body: usize) -> Result<f64, NotBounded> {
    let mesh = &problem.mesh;
    let own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body);
    let section = problem.section();
    let of = |t: usize| if section.is_revolved() { section.volume(mesh.corners(t)) } else { mesh.area(t) };
    let volume: f64 = own.map(of).sum();
    if volume > 0.0 { Ok(volume) } else { Err(NotBounded::Empty { name: problem.scene.bodies[body].name.clone() }) }
}

/// Parts of a region outside its body, relative to its area, that are rounding.
const OUTSIDE: f64 = 1e-9;

/// The mean of a component of stress over a region of a body.
pub fn mean_stress(
    problem: &Problem,
    body: usize,
    region: &Region,
    component: Component,
) -> Result<Functional, NotBounded> {
    let mesh = &problem.mesh;
    let whole = |t: usize| Cut { triangle: t, pieces: Vec::new(), part: 1.0 };
    let (cuts, area) = match region {
        Region::Whole => {
            let own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body);
            (own.map(whole).collect(), volume(problem, body)?)
        }
        Region::Polygon(points) => {
            let (cuts, inside) = cut(problem, body, points);
            let area = 0.5 * twice_area(points);
            if inside < (1.0 - OUTSIDE) * area {
                let name = problem.scene.bodies[body].name.clone();
                return Err(NotBounded::Outside { inside: format!("{:.1}", 100.0 * inside / area), body: name });
            }
            (cuts, area)
        }
    };
    let mut functional = Functional::empty(problem, Kind::Stress);
    let [xx, yy, xy] = component.factors();
    if let Some(revolved) = problem.section().revolved() {
        let volume = revolved::volume(problem, revolved, &cuts);
        let chi = [xx, yy, component.hoop(), 0.5 * xy].map(|c| c / volume);
        functional.load.turned = cuts.iter().map(|cut| (cut.triangle, chi.map(|c| cut.part * c))).collect();
        functional.turned = Some((chi, cuts));
        return Ok(functional.beside(problem));
    }
    let chi = [xx / area, yy / area, 0.5 * xy / area];
    let mean = |cut: &Cut| (cut.triangle, chi.map(|c| cut.part * c));
    functional.load.strains = cuts.iter().map(mean).collect();
    functional.region = Some((chi, cuts));
    Ok(functional)
}
