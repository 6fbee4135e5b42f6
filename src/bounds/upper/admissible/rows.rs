//! The Bernstein coefficients of (v' − v'')·n̂ − g as functions of the values at nodes.
//!
//! Along a pair v has degree k, and (v' − v'')·n̂ too where n̂ is constant, one more where it turns. All coefficients at most
//! zero is enough for no penetration anywhere.

use super::nodes::Nodes;
use crate::mesh::Triangulation;
use crate::problem::{ContactPair, Direction, Problem};

/// One coefficient.
#[derive(Debug, Clone)]
pub struct Row {
    terms: Vec<(usize, [f64; 2])>,
    gap: f64,
}

impl Row {
    /// Node and factor of its value.
    pub fn terms(&self) -> &[(usize, [f64; 2])] {
        &self.terms
    }

    /// Upper bound of the jump.
    pub fn bound(&self) -> f64 {
        self.gap
    }

    /// This jump with another bound.
    pub fn bounded(self, bound: f64) -> Self {
        Row { gap: bound, ..self }
    }

    /// The coefficient for the given values: admissible where it is not positive.
    pub fn excess(&self, values: &[[f64; 2]]) -> f64 {
        self.excess_at(|node| values[node])
    }

    /// As [`Self::excess`], with a function that gives the values.
    pub fn excess_at(&self, value: impl Fn(usize) -> [f64; 2]) -> f64 {
        let term = |(node, factor): &(usize, [f64; 2])| {
            let u = value(*node);
            u[0] * factor[0] + u[1] * factor[1]
        };
        self.terms.iter().map(term).sum::<f64>() - self.gap
    }
}

/// The nodes of both sides of `pair`, from its first end to its second; equally many on either.
pub fn sides(pair: &ContactPair, mesh: &Triangulation, nodes: &Nodes) -> [Option<Vec<usize>>; 2] {
    let first = pair.edges[0].map(|e| nodes.along(mesh, e, pair.first[0]).collect());
    let second = pair.edges[1].zip(pair.second).map(|(e, second)| nodes.along(mesh, e, second[0]).collect());
    [first, second]
}

/// The coefficients of every pair, one group a pair.
pub fn rows(problem: &Problem, nodes: &Nodes) -> Vec<Vec<Row>> {
    let pairs = problem.pairs();
    pairs.map(|pair| of_pair(pair, &sides(pair, &problem.mesh, nodes))).collect()
}

/// The coefficients of a pair from end to end.
pub fn of_pair(pair: &ContactPair, sides: &[Option<Vec<usize>>; 2]) -> Vec<Row> {
    let mut rows = along_pair(&pair.direction, sides, 1.0);
    if let Some(degree) = rows.len().checked_sub(1) {
        rows.iter_mut().zip(pair.gap_below(degree)).for_each(|(row, gap)| row.gap = gap);
    }
    rows
}

/// The coefficients of `sense` (v' − v'') along a direction, without a gap.
pub fn along_pair(direction: &Direction, sides: &[Option<Vec<usize>>; 2], sense: f64) -> Vec<Row> {
    let [first, last] = direction.ends.map(|n| n.map(|n| sense * n));
    let Some(k) = sides.iter().flatten().map(|nodes| nodes.len() - 1).min() else { return Vec::new() };
    let jump = |j: usize, n: [f64; 2], factor: f64| {
        let term =
            move |(side, sign): (&Option<Vec<usize>>, f64)| Some((side.as_ref()?[j], n.map(|n| sign * factor * n)));
        sides.iter().zip([1.0, -1.0]).filter_map(term)
    };
    let degree = if direction.is_constant() { k } else { k + 1 };
    let row = |j: usize| {
        let terms = if direction.is_constant() {
            jump(j, first, 1.0).collect()
        } else {
            // The product with a linear function: (k + 1 − j) V_j·n̂_0 + j V_{j − 1}·n̂_1 over k + 1.
            let part = |count: usize| count as f64 / degree as f64;
            let own = (j <= k).then(|| jump(j, first, part(degree - j))).into_iter().flatten();
            let before = (j > 0).then(|| jump(j - 1, last, part(j))).into_iter().flatten();
            own.chain(before).collect()
        };
        Row { terms, gap: 0.0 }
    };
    (0..=degree).map(row).collect()
}

/// The coefficients of a pair of quadratic sides as functions of the values at `vertices` vertices and then at the edge
/// midpoints.
pub fn bernstein(pair: &ContactPair, vertices: usize) -> Vec<Row> {
    let side = |e: Option<usize>, ends: Option<[usize; 2]>| e.zip(ends).map(|(e, [a, b])| vec![a, vertices + e, b]);
    let sides = [side(pair.edges[0], Some(pair.first)), side(pair.edges[1], pair.second)];
    let mut rows = of_pair(pair, &sides);
    for row in &mut rows {
        // The inner coefficient is 2 v_mid − ½ (v_a + v_b).
        let inner = |(node, factor): &(usize, [f64; 2])| {
            let ends = sides.iter().flatten().find(|side| side[1] == *node);
            let parts = match ends {
                Some(side) => vec![(*node, 2.0), (side[0], -0.5), (side[2], -0.5)],
                None => vec![(*node, 1.0)],
            };
            let factor = *factor;
            parts.into_iter().map(move |(node, part)| (node, factor.map(|f| part * f)))
        };
        row.terms = row.terms.iter().flat_map(inner).collect();
    }
    rows
}
