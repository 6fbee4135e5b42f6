//! Ways in which a method may require that nothing penetrates, on sides that have different vertices.

use std::collections::BTreeMap;

use super::Nonmatching;
use super::space::Space;
use crate::problem::ContactPair;

/// The ways to decide contact, by side.
const WAYS: [[&str; 4]; 2] = [
    [
        "at the vertices of the first side",
        "in the mean over the functions of the first side",
        "in the mean over the dual functions of the first side",
        "in the mean over the edges of the first side",
    ],
    [
        "at the vertices of the second side",
        "in the mean over the functions of the second side",
        "in the mean over the dual functions of the second side",
        "in the mean over the edges of the second side",
    ],
];

impl Nonmatching<'_> {
    /// Excess of the jump above the gap at the two ends and in the middle of every pair.
    pub(super) fn excesses(&self, pairs: &[ContactPair]) -> Vec<[f64; 3]> {
        let candidate = self.solution.candidate;
        let space = Space::new(self.solution.problem, self.glued, candidate.degree);
        let of = |pair: &ContactPair| [0.0, 1.0, 0.5].map(|at| space.row(pair, at).excess(candidate));
        pairs.iter().map(of).collect()
    }

    /// The least penetration by any of the ways in which a method may decide contact, and the words for it.
    pub(super) fn penetration(&self, pairs: &[ContactPair]) -> (&'static str, f64) {
        let space = Space::new(self.solution.problem, self.glued, self.solution.candidate.degree);
        let excesses = self.excesses(pairs);
        let mut least = ("anywhere", f64::INFINITY);
        for side in 0..2 {
            let mut nodes: BTreeMap<usize, f64> = BTreeMap::new();
            // By node, in the mean with hat functions and with dual ones: ∫ψ e and ∫φ.
            let mut means: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
            let mut edges: BTreeMap<Vec<usize>, [f64; 2]> = BTreeMap::new();
            for (pair, [a, b, middle]) in pairs.iter().zip(&excesses) {
                let Some(ends) = [Some(pair.first), pair.second][side] else { continue };
                let weights = ends.map(|v| space.corners(v));
                for (v, e) in ends.into_iter().zip([a, b]) {
                    if v < space.vertices {
                        nodes.entry(v).and_modify(|most| *most = most.max(*e)).or_insert(*e);
                    }
                }
                let mut own: Vec<usize> = weights.iter().flatten().map(|(node, _)| *node).collect();
                own.sort_unstable();
                own.dedup();
                for node in &own {
                    let weight =
                        |end: usize| weights[end].iter().find(|(n, _)| n == node).map_or(0.0, |(_, weight)| *weight);
                    let [p, q] = [weight(0), weight(1)];
                    let simpson = |[f, g, h]: [f64; 3]| pair.length / 6.0 * (f * a + 4.0 * g * middle + h * b);
                    let mean = means.entry(*node).or_default();
                    mean[0] += simpson([p, 0.5 * (p + q), q]);
                    mean[1] += simpson([3.0 * p - 1.0, 1.5 * (p + q) - 1.0, 3.0 * q - 1.0]);
                    mean[2] += 0.5 * pair.length * (p + q);
                }
                let edge = edges.entry(own).or_default();
                edge[0] += pair.length / 6.0 * (a + 4.0 * middle + b);
                edge[1] += pair.length;
            }
            let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
            let of_means = |which: usize| most(&mut means.values().map(|mean| mean[which] / mean[2]));
            let words = WAYS[side];
            let ways = [
                (words[0], most(&mut nodes.values().copied())),
                (words[1], of_means(0)),
                (words[2], of_means(1)),
                (words[3], most(&mut edges.values().map(|edge| edge[0] / edge[1]))),
            ];
            // A side without values is rigid.
            for way in ways.into_iter().filter(|way| way.1.is_finite()) {
                if way.1.max(0.0) < least.1 {
                    least = (way.0, way.1.max(0.0));
                }
            }
        }
        least
    }
}
