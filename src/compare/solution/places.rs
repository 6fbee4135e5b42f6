//! Places of nodes, in numbers and as messages name them.

use crate::compare::candidate::Candidate;
use crate::problem::{Problem, ROUND_OFF};

impl Candidate {
    /// A node as a message names it: its number in the file it comes from, from one, and its coordinates.
    pub fn named(&self, problem: &Problem, node: usize) -> String {
        let extent = extent(problem);
        let [x, y] = written(problem, node, extent).map(|x| round(x, extent));
        match self.numbering.as_ref().and_then(|n| n.point(node)) {
            Some(point) => format!("{point}, at ({x}, {y})"),
            None => format!("({x}, {y})"),
        }
    }
}

/// Coordinates of a node: a vertex, or the midpoint of an edge.
pub fn place(problem: &Problem, node: usize) -> [f64; 2] {
    let mesh = &problem.mesh;
    match node.checked_sub(mesh.points.len()) {
        None => mesh.points[node],
        Some(e) => {
            let [a, b] = mesh.edges[e].vertices.map(|v| mesh.points[v]);
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        }
    }
}

/// The same as the files of the scene have them; what is zero but for rounding is zero.
pub fn written_place(problem: &Problem, node: usize) -> [f64; 2] {
    written(problem, node, extent(problem))
}

fn written(problem: &Problem, node: usize, extent: f64) -> [f64; 2] {
    problem.scene.as_written(place(problem, node)).map(|x| if x.abs() < ROUND_OFF * extent { 0.0 } else { x })
}

/// The largest coordinate of the mesh.
fn extent(problem: &Problem) -> f64 {
    problem.mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()))
}

/// `x` to six digits of `extent`, for a message; no negative zero.
fn round(x: f64, extent: f64) -> f64 {
    let step = 10f64.powi(extent.max(f64::MIN_POSITIVE).log10().ceil() as i32 - 6);
    let rounded = (x / step).round() / (1.0 / step).round().max(1.0 / step);
    if rounded == 0.0 { 0.0 } else { rounded }
}
