//! Contact state and displacement of one mesh as a first guess on the next.

use crate::bounds::{NodalValues, Nodes};
use crate::dual::{self, Condensed, Options, contact_coefficients};
use crate::element::displacement::through;
use crate::element::{Displacement, SideValues};
use crate::problem::Problem;
use crate::study::certified::balance;

/// Triangles of the largest mesh that is solved on for nothing but a guess.
const QUICKLY_SOLVED: usize = 20_000;

/// First guess of the closed coefficients of `fine`, `counts` of them on its pairs, from the state `closed` of `coarse` at the
/// same arc length.
///
/// The guess decides the path to the contact state, not the state: that is the unique solution of a convex problem.
pub fn closed_coefficients(
    coarse: &Problem,
    closed: &SideValues<bool>,
    fine: &Problem,
    counts: &[usize],
) -> SideValues<bool> {
    let mut guess = Vec::with_capacity(counts.iter().sum());
    let mut counted = counts.iter();
    let mut first = 0;
    for (old, new) in coarse.interfaces.iter().zip(&fine.interfaces) {
        let mut k = 0;
        for (pair, &count) in new.pairs.iter().zip(&mut counted) {
            let middle = 0.5 * (pair.arc[0] + pair.arc[1]);
            while k + 1 < old.pairs.len() && old.pairs[k].arc[1] <= middle {
                k += 1;
            }
            let [from, to] = old.pairs[k].arc;
            let flags = closed.of(first + k);
            guess.extend((0..count).map(|i| {
                // A coefficient speaks for its part of the side.
                let part = if count == 1 { 0.5 } else { i as f64 / (count - 1) as f64 };
                let s = pair.arc[0] + part * (pair.arc[1] - pair.arc[0]);
                let at = ((s - from) / (to - from)).clamp(0.0, 1.0) * (flags.len() - 1) as f64;
                let (below, above) = (at.floor() as usize, at.ceil() as usize);
                // Half-way between an open and a closed one: closed, from where every problem can be solved.
                if (at - below as f64 - 0.5).abs() < 1e-6 {
                    flags[below] || flags[above]
                } else {
                    flags[at.round() as usize]
                }
            }));
        }
        first += old.pairs.len();
    }
    SideValues::new(counts.iter().copied(), guess)
}

/// The closed coefficients on `given` refined uniformly `levels` times, which is `fine`: those of the largest mesh on the way
/// there that is quickly solved on, where there is one and it can be solved on.
pub fn guess_refined(given: &Problem, levels: usize, fine: &Problem, options: &Options) -> Option<SideValues<bool>> {
    let size = |level: u32| given.mesh.triangles.len().saturating_mul(4_usize.saturating_pow(level));
    let level = (0..levels as u32).rev().find(|&level| size(level) <= QUICKLY_SOLVED)?;
    let coarse = given.refine_uniform(level as usize).ok()?;
    let elements = dual::carrying(&coarse, &options.elements).ok()?;
    let statics = balance(&coarse, &elements, None).ok()?;
    let options = Options { keep_factor: false, elements, ..options.clone() };
    let motions = statics.null_motions(&coarse);
    let found = options.on_threads(|| dual::solve(&Condensed::default(), &coarse, &motions, &options)).ok()?;
    let counts = contact_coefficients(fine, &dual::carrying(fine, &options.elements).ok()?);
    Some(closed_coefficients(&coarse, &found.closed, fine, &counts))
}

/// The displacement `v` of `coarse` on the edges of `fine`, whose triangle t lies in triangle `parent[t]` and gets the degree
/// that it has there: on every edge the polynomial through its values at equal steps.
///
/// A part of an admissible jump is admissible, so that the interpolant is as admissible as `v`.
pub fn carried(coarse: &Problem, v: &Displacement, fine: &Problem, parent: &[usize]) -> NodalValues {
    let mesh = &fine.mesh;
    let mut degree = vec![1; mesh.edges.len()];
    for (edges, &old) in mesh.triangle_edges.iter().zip(parent) {
        edges.iter().for_each(|&e| degree[e] = degree[e].max(v.degree(old)));
    }
    let nodes = Nodes::new(mesh.points.len(), degree.iter().copied());
    let mut field = NodalValues::zeros(nodes.clone());
    for (e, edge) in mesh.edges.iter().enumerate() {
        let sides = edge.triangles.iter().flatten();
        let Some(&old) = sides.map(|t| &parent[*t]).max_by_key(|old| v.degree(**old)) else { continue };
        let corners = coarse.mesh.corners(old);
        let [p, q] = edge.vertices.map(|v| mesh.points[v]);
        let k = degree[e];
        let at = |i: usize| {
            let s = i as f64 / k as f64;
            v.at(old, barycentric(corners, [0, 1].map(|c| if i == k { q[c] } else { p[c] + s * (q[c] - p[c]) })))
        };
        let coefficients = through(&(0..=k).map(at).collect::<Vec<_>>());
        field.values[edge.vertices[0]] = coefficients[0];
        field.values[edge.vertices[1]] = coefficients[k];
        field.values[nodes.inside(e)].copy_from_slice(&coefficients[1..k]);
    }
    field
}

/// Barycentric coordinates of `p`; they add up to one.
fn barycentric([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> [f64; 3] {
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let from = |q: [f64; 2]| [q[0] - a[0], q[1] - a[1]];
    let whole = cross(from(b), from(c));
    let (second, third) = (cross(from(p), from(c)) / whole, cross(from(b), from(p)) / whole);
    [1.0 - second - third, second, third]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn barycentric_coordinates_give_the_point_back() {
        let corners = [[0.3, 0.1], [2.0, -0.4], [1.1, 1.7]];
        let p = [1.2, 0.5];
        let l = barycentric(corners, p);
        let back = [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum::<f64>());
        assert!((back[0] - p[0]).abs() < 1e-15 && (back[1] - p[1]).abs() < 1e-15);
        assert!((l.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }
}
