//! Nodes and contact inside pairs for displacements of degree 3 and more, whose forces are those on Bernstein polynomials.
//!
//! The jump of a pair has one coefficient for each row ([`of_pair`]); those between its ends act on the coefficients inside the
//! two edges and, where n̂ turns, on those of the vertices next to them too.

use nalgebra::{DMatrix, DVector};

use super::Solution;
use super::cones::follows_cone;
use crate::bounds::{Nodes, Row, sides};
use crate::compare::contact::slides::rows_inside;
use crate::element::PlainDisplacement;
use crate::element::displacement::plain;
use crate::element::polynomial::triangle;
use crate::problem::{ContactPair, Problem};
use crate::statics::cone::unbalanced;

/// The nodes of a displacement of degree `k`, vertices and insides of edges.
pub(super) fn nodes(problem: &Problem, k: usize) -> Nodes {
    Nodes::of_degree(&problem.mesh, k)
}

/// Coordinates of a node of degree `k`: at a vertex, inside an edge, or inside a triangle.
pub(super) fn place(problem: &Problem, k: usize, node: usize) -> [f64; 2] {
    let mesh = &problem.mesh;
    let vertices = mesh.points.len();
    let between = |points: &[[f64; 2]], parts: &[usize]| {
        [0, 1].map(|c| points.iter().zip(parts).map(|(p, part)| *part as f64 / k as f64 * p[c]).sum::<f64>())
    };
    let Some(inside) = node.checked_sub(vertices) else { return mesh.points[node] };
    if inside < (k - 1) * mesh.edges.len() {
        let (e, j) = (inside / (k - 1), inside % (k - 1) + 1);
        return between(&mesh.edges[e].vertices.map(|v| mesh.points[v]), &[k - j, j]);
    }
    let inner = (inside - (k - 1) * mesh.edges.len()) % plain::inner_len(k);
    let at = triangle::indices(k).filter(|alpha| !alpha.contains(&0)).nth(inner).unwrap_or([1; 3]);
    between(&mesh.corners((inside - (k - 1) * mesh.edges.len()) / plain::inner_len(k)), &at)
}

/// The vertex or edge (numbered vertices first, then edges) that a node of degree `k` is on or near.
pub(super) fn near(problem: &Problem, k: usize, node: usize) -> usize {
    let mesh = &problem.mesh;
    let vertices = mesh.points.len();
    match node.checked_sub(vertices) {
        None => node,
        Some(inside) if inside < (k - 1) * mesh.edges.len() => vertices + inside / (k - 1),
        Some(inside) => mesh.triangles[(inside - (k - 1) * mesh.edges.len()) / plain::inner_len(k)][0],
    }
}

/// The rows between the ends of a pair, and the nodes inside its sides.
pub(super) struct Inside {
    pub(super) rows: Vec<Row>,
    nodes: Vec<usize>,
    first: usize,
}

impl Inside {
    pub(super) fn of(problem: &Problem, pair: &ContactPair, k: usize) -> Self {
        let sides = sides(pair, &problem.mesh, &nodes(problem, k));
        let inner = |side: &Option<Vec<usize>>| side.iter().flat_map(|s| s[1..k].to_vec()).collect::<Vec<_>>();
        let [own, other] = [inner(&sides[0]), inner(&sides[1])];
        Inside { rows: rows_inside(problem, pair, k), first: own.len(), nodes: [own, other].concat() }
    }

    /// A row as a vector over the nodes inside.
    pub(super) fn column(&self, terms: &[(usize, [f64; 2])]) -> DVector<f64> {
        let mut column = DVector::zeros(2 * self.nodes.len());
        for (node, factor) in terms {
            if let Some(i) = self.nodes.iter().position(|n| n == node) {
                column[2 * i] += factor[0];
                column[2 * i + 1] += factor[1];
            }
        }
        column
    }

    /// −f at the nodes inside.
    pub(super) fn load(&self, forces: &[[f64; 2]]) -> DVector<f64> {
        DVector::from_iterator(2 * self.nodes.len(), self.nodes.iter().flat_map(|&n| forces[n].map(|f| -f)))
    }
}

/// The coefficients R for which Σ R_r row_r is nearest to `load`.
fn multipliers(rows: &[DVector<f64>], load: &DVector<f64>) -> Vec<f64> {
    if rows.is_empty() {
        return Vec::new();
    }
    let solved = DMatrix::from_columns(rows).svd(true, true).solve(load, f64::EPSILON);
    solved.map_or_else(|_| vec![0.0; rows.len()], |found| found.iter().copied().collect())
}

/// A reaction inside a pair.
pub(super) struct Asked {
    /// The reaction that balances the displacement's nodal forces.
    pub reaction: f64,
    /// Change of the row by a unit translation of the first side, along either axis.
    pub moved: [f64; 2],
}

impl Solution<'_> {
    /// Takes the forces of closed coefficients inside the pairs out of `rest`.
    pub(super) fn take_inside(&self, field: &PlainDisplacement, rest: &mut [[f64; 2]]) {
        let within = self.closed_within();
        for pair in self.problem.pairs().filter(|pair| !follows_cone(pair)) {
            let mut inside = Inside::of(self.problem, pair, field.degree());
            inside.rows.retain(|row| row.excess(field.values()) >= -within);
            let columns: Vec<DVector<f64>> = inside.rows.iter().map(|row| inside.column(row.terms())).collect();
            let unit: Vec<DVector<f64>> = columns.iter().map(|c| c / c.norm()).collect();
            let load = inside.load(rest);
            // Where the working set does not settle, the whole force is left over and the check fails in the open.
            let Ok(left) = unbalanced(&load, &unit) else { continue };
            for (row, reaction) in inside.rows.iter().zip(multipliers(&columns, &(load - left))) {
                for (node, factor) in row.terms() {
                    rest[*node] = [0, 1].map(|c| rest[*node][c] + reaction * factor[c]);
                }
            }
            self.rest_on_supports(pair, rest);
        }
    }

    /// The reactions inside a pair that balance the forces `left` on its first side.
    pub(super) fn asked_inside(&self, pair: &ContactPair, k: usize, left: &[[f64; 2]]) -> Vec<Asked> {
        let mut inside = Inside::of(self.problem, pair, k);
        inside.nodes.truncate(inside.first);
        let columns: Vec<DVector<f64>> = inside.rows.iter().map(|row| inside.column(row.terms())).collect();
        let reactions = multipliers(&columns, &inside.load(left));
        let own = |node: usize| inside.nodes.contains(&node) || pair.first.contains(&node);
        let moved = |row: &Row| {
            let terms = row.terms().iter().filter(|(node, _)| own(*node));
            terms.fold([0.0; 2], |sum, (_, factor)| [sum[0] + factor[0], sum[1] + factor[1]])
        };
        let rows = inside.rows.iter().zip(reactions);
        rows.map(|(row, reaction)| Asked { reaction, moved: moved(row) }).collect()
    }
}
