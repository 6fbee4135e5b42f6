//! The largest contact pressures of two models, each the value at one point.

use std::collections::HashSet;

use super::nodal::{NodalDifference, NodalPressure};
use super::pressure::Piece;
use crate::compare::name::OfContact;
use crate::compare::outcome::ContactSummary;
use crate::compare::tolerance::chosen;
use crate::compare::{Basis, Check};
use crate::problem::{Interface, Problem};

/// The largest pressure of each model and where it is, away from vertices that a support or another contact holds: the pressure
/// there may be unbounded, and nothing is known of means.
pub(in crate::compare) struct Peaks([(f64, [f64; 2]); 2]);

impl Peaks {
    /// The peaks of the pressures of both models; `nodes` are the vertices that nothing else holds.
    pub fn new(problem: &Problem, interface: &Interface, nodes: &[NodalPressure], both: [&[Piece]; 2]) -> Self {
        let free: HashSet<usize> = nodes.iter().map(|node| node.vertex).collect();
        Peaks(both.map(|pieces| {
            let mut best = (0.0, [0.0; 2]);
            for (pair, piece) in interface.pairs.iter().zip(pieces) {
                let (value, s) = piece.largest();
                if value > best.0 && pair.first.iter().all(|v| free.contains(v)) {
                    let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
                    best = (value, problem.scene.as_written([0, 1].map(|c| (1.0 - s) * a[c] + s * b[c])));
                }
            }
            best
        }))
    }

    /// A remark where the two differ: nothing bounds values at points, but what can be said of means, around a vertex or farther,
    /// says by what factor two models are likely to differ. `None` where one of the two is below `floor`, or nothing is known of
    /// any mean.
    pub fn compared(
        &self,
        summary: &ContactSummary,
        means: &NodalDifference,
        model: &str,
        floor: f64,
    ) -> Option<Check> {
        let [(own, own_at), (other, other_at)] = self.0;
        if own.min(other) <= floor {
            return None;
        }
        let at_vertices = means.largest_allowed / means.largest[0].min(means.largest[1]).max(0.0);
        let farther = summary.pressure_mean.and_then(|mean| Some(mean.half_width? / mean.value.max(0.0)));
        let explained = 1.0 + at_vertices.min(farther.unwrap_or(f64::INFINITY));
        let why = format!(
            "The largest pressure is {} at {} in stresses and {} at {} in {model}. The bracket explains a factor of {}; a larger \
         one is that of a corner, of a triangle that is too flat, or of digits that were lost. Forces over a part of the contact \
         are bounded, pressures at points are not.",
            digits(own),
            place(own_at),
            digits(other),
            place(other_at),
            digits(explained),
        );
        let (name, factor) = (OfContact::PeakPressure.of(&summary.name), own.max(other) / own.min(other));
        let allowed = chosen("peak-pressure") * explained;
        allowed.is_finite().then(|| Check::with_difference(&name, own, other, factor, allowed, Basis::Chosen, why))
    }
}

/// Four significant digits.
fn digits(x: f64) -> String {
    let short = format!("{x:.3e}");
    match short.parse::<f64>() {
        Ok(x) if (1e-3..1e5).contains(&x.abs()) => x.to_string(),
        _ => short,
    }
}

fn place([x, y]: [f64; 2]) -> String {
    let coordinate = |x: f64| format!("{x:.6e}").parse().unwrap_or(x);
    format!("({}, {})", coordinate(x), coordinate(y))
}
