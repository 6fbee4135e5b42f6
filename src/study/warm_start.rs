//! Contact state and displacement of one mesh as a first guess on the next.

use crate::bounds::{NodalValues, Nodes};
use crate::element::Displacement;
use crate::element::displacement::through;
use crate::problem::Problem;

/// First guess of the closed contact ends of `fine`, from the state `closed` of `coarse` at the same arc length: two
/// flags per pair, interface by interface.
///
/// The guess decides the path to the contact state, not the state: that is the unique solution of a convex problem.
pub fn closed_ends(coarse: &Problem, closed: &[bool], fine: &Problem) -> Vec<bool> {
    let mut guess = Vec::with_capacity(2 * fine.interfaces.iter().map(|i| i.pairs.len()).sum::<usize>());
    let mut first = 0;
    for (old, new) in coarse.interfaces.iter().zip(&fine.interfaces) {
        let flags = &closed[first..first + 2 * old.pairs.len()];
        first += flags.len();
        let mut k = 0;
        for pair in &new.pairs {
            let middle = 0.5 * (pair.arc[0] + pair.arc[1]);
            while k + 1 < old.pairs.len() && old.pairs[k].arc[1] <= middle {
                k += 1;
            }
            let [from, to] = old.pairs[k].arc;
            guess.extend(pair.arc.map(|s| {
                let t = (s - from) / (to - from);
                let [near, far] = [flags[2 * k], flags[2 * k + 1]];
                // Half-way between an open and a closed end: closed, from where every problem can be solved.
                if (t - 0.5).abs() < 1e-6 {
                    near || far
                } else if t < 0.5 {
                    near
                } else {
                    far
                }
            }));
        }
    }
    guess
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
