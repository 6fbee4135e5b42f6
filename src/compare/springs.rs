//! Forces of springs and elastic layers at the nodes of a displacement model.

use super::forces::NodalForces;
use crate::element::side;
use crate::problem::Problem;
use crate::vector::dot;

/// The functions that belong to the nodes of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Functions {
    /// Values at vertices, and for degree 2 at the middles of edges.
    Values,
    /// Bernstein coefficients.
    Coefficients,
}

impl Functions {
    /// ∫ φ_i φ_j on an edge of length one.
    fn product(self, degree: usize, i: usize, j: usize) -> f64 {
        const QUADRATIC: [[f64; 3]; 3] = [[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]];
        match (self, degree) {
            (Functions::Values, 2) => QUADRATIC[i][j] / 30.0,
            _ => side::product(degree, i, degree, j),
        }
    }
}

impl NodalForces {
    /// Adds the forces of springs for the values `value` of nodes: vertices, then those inside each edge. Gives the energy of the
    /// springs, thickness included.
    pub(super) fn add_springs(
        &mut self,
        problem: &Problem,
        degree: usize,
        functions: Functions,
        value: impl Fn(usize) -> [f64; 2],
    ) -> f64 {
        let mesh = &problem.mesh;
        let along = |e: usize| -> Vec<usize> {
            let [a, b] = mesh.edges[e].vertices;
            let inside = mesh.points.len() + e * (degree - 1);
            std::iter::once(a).chain(inside..inside + degree - 1).chain([b]).collect()
        };
        let mut energy = 0.0;
        for (pair, stiffness) in problem.bed_pairs() {
            let first = along(pair.edge);
            let second: Vec<usize> = pair.opposite.map_or_else(Vec::new, |e| along(e).into_iter().rev().collect());
            for (axis, k) in pair.axes.iter().zip(stiffness).filter(|(_, k)| *k > 0.0) {
                let own = |node: &usize| dot(value(*node), *axis);
                let other = |i: usize| second.get(i).map_or(0.0, own);
                let jump: Vec<f64> = first.iter().enumerate().map(|(i, node)| own(node) - other(i)).collect();
                let size: Vec<f64> = first.iter().enumerate().map(|(i, n)| own(n).abs() + other(i).abs()).collect();
                let whole = problem.scene.thickness * k * pair.length;
                for i in 0..=degree {
                    let weight = |j: usize| whole * functions.product(degree, i, j);
                    let force: f64 = (0..=degree).map(|j| weight(j) * jump[j]).sum();
                    let spread: f64 = (0..=degree).map(|j| weight(j).abs() * size[j]).sum();
                    energy += 0.5 * force * jump[i];
                    for (node, sign) in [(first.get(i), 1.0), (second.get(i), -1.0)] {
                        let Some(&node) = node else { continue };
                        (0..2).for_each(|c| self.left[node][c] += sign * force * axis[c]);
                        self.size[node] += spread;
                        self.stiffness[node] += weight(i);
                    }
                }
            }
        }
        energy
    }
}
