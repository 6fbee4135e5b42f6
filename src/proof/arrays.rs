//! The arrays of a proof.

use super::npz::Archive;
use crate::bounds::side_coefficients;
use crate::dual::DualSolution;
use crate::dual::equilibrium::contact_tractions;
use crate::element::Displacement;
use crate::problem::{Bow, ContactPair, Problem};

/// Marks the absence of an index.
const NONE: i32 = -1;

fn index(i: usize) -> i32 {
    i as i32
}

fn maybe(i: Option<usize>) -> i32 {
    i.map_or(NONE, index)
}

/// Mesh, conditions' names and contact pairs of the problem of one of the two fields, which `of` names.
pub(super) fn mesh(archive: &mut Archive, of: &str, problem: &Problem) {
    let mesh = &problem.mesh;
    let named = |what: &str| format!("{of}_{what}");
    archive.array(&named("points"), mesh.points.as_flattened(), 2);
    let triangles: Vec<i32> = mesh.triangles.iter().flatten().map(|&v| index(v)).collect();
    archive.array(&named("triangles"), &triangles, 3);
    archive.array(&named("bodies"), &mesh.body.iter().map(|&b| index(b)).collect::<Vec<_>>(), 0);
    let edges: Vec<i32> =
        mesh.edges.iter().flat_map(|e| [index(e.vertices[0]), index(e.vertices[1]), maybe(e.name)]).collect();
    archive.array(&named("edges"), &edges, 3);
    archive.array(&named("names"), mesh.names.join("\n").as_bytes(), 0);
    let (mut whole, mut real) = (Vec::new(), Vec::new());
    for (i, interface) in problem.interfaces.iter().enumerate() {
        for pair in &interface.pairs {
            let ContactPair { edges, first, second, direction, length, arc, gap, bow, .. } = pair;
            let second = second.map_or([NONE; 2], |second| second.map(index));
            let [a, b] = first.map(index);
            whole.extend([index(i), maybe(edges[0]), maybe(edges[1]), a, b, second[0], second[1]]);
            let [from, to] = direction.ends;
            real.extend([from[0], from[1], to[0], to[1], *length, arc[0], arc[1], gap[0], gap[1]]);
            real.extend(bow.numbers());
        }
    }
    archive.array(&named("pairs"), &whole, 7);
    archive.array(&named("pair_data"), &real, 9 + Bow::NUMBERS);
}

/// The tractions of λ_h; `of` stands before their names.
pub(super) fn stress(archive: &mut Archive, of: &str, problem: &Problem, dual: &DualSolution) {
    let (mesh, stress) = (&problem.mesh, &dual.stress);
    let named = |what: &str| format!("{of}{what}");
    let degrees: Vec<u8> = (0..mesh.triangles.len()).map(|t| stress.degree(t) as u8).collect();
    archive.array(&named("stress_degrees"), &degrees, 0);
    let (mut counts, mut values) = (Vec::new(), Vec::new());
    for (e, edge) in mesh.edges.iter().enumerate() {
        // Where degrees meet, the lower one is that of the traction.
        let sides = edge.triangles.iter().enumerate().filter_map(|(side, t)| Some((side, stress.degree((*t)?))));
        let Some((side, degree)) = sides.min_by_key(|(_, degree)| *degree) else { continue };
        let sign = if side == 0 { 1.0 } else { -1.0 };
        counts.push(degree as u8 + 1);
        values.extend(stress.edge_traction(mesh, e, side, degree).into_iter().flatten().map(|t| sign * t));
    }
    archive.array(&named("traction_counts"), &counts, 0);
    archive.array(&named("tractions"), &values, 2);
    let pairs = || dual.contact_traction.iter().flat_map(|interface| interface.iter());
    archive.array(&named("pressure_counts"), &pairs().map(|t| t.len() as u8).collect::<Vec<_>>(), 0);
    archive.array(&named("pressures"), &pairs().flatten().copied().collect::<Vec<f64>>(), 0);
    if problem.has_friction() {
        let along: Vec<Vec<f64>> =
            problem.pairs().map(|pair| contact_tractions(problem, stress, pair)[1].clone()).collect();
        archive.array(&named("friction_counts"), &along.iter().map(|t| t.len() as u8).collect::<Vec<_>>(), 0);
        archive.array(&named("frictions"), &along.concat(), 0);
    }
}

/// The coefficients of v; `of` stands before their names.
pub(super) fn displacement(archive: &mut Archive, of: &str, problem: &Problem, v: &Displacement) {
    let mesh = &problem.mesh;
    let named = |what: &str| format!("{of}{what}");
    let degrees: Vec<u8> = (0..v.len()).map(|t| v.degree(t) as u8).collect();
    archive.array(&named("displacement_degrees"), &degrees, 0);
    let mut vertices = vec![[0.0; 2]; mesh.points.len()];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        (0..3).for_each(|i| vertices[corners[i]] = v.corner(t, i));
    }
    archive.array(&named("u_vertices"), vertices.as_flattened(), 2);
    let (mut counts, mut values) = (Vec::new(), Vec::<f64>::new());
    for (e, edge) in mesh.edges.iter().enumerate() {
        let owners = edge.triangles.iter().flatten().copied();
        let lower = owners.min_by_key(|&t| v.degree(t));
        let mut own = match lower {
            Some(t) if edge.triangles[0] != Some(t) => {
                let i = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
                let mut own: Vec<[f64; 2]> = v.side(t, i).collect();
                own.reverse();
                own
            }
            _ => side_coefficients(problem, v, e),
        };
        own.pop();
        counts.push(own.len() as u8 - 1);
        values.extend(own[1..].as_flattened());
    }
    archive.array(&named("u_edge_counts"), &counts, 0);
    archive.array(&named("u_edges"), &values, 2);
    let inside = |t: usize| v.block(t)[3 * v.degree(t)..].iter().flatten().copied();
    archive.array(&named("u_inside"), &(0..v.len()).flat_map(inside).collect::<Vec<f64>>(), 2);
}
