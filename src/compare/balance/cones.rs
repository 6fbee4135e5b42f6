//! Contact with Coulomb friction on the nodes of a claimed solution: forces within the cone of n̂ and μ t̂, on its edge where the sides
//! slide.
//!
//! The forces R n̂ + F t̂ with |F| ≤ μ R are those of two rows n̂ ± μ t̂ that only push; where the sides slide, F = μ R sgn(j_t), it is
//! one of the two.

use nalgebra::DVector;

use super::higher::Inside;
use super::rubbing::ALIGNED;
use super::{End, HELD, Solution, dot};
use crate::compare::contact::slides::inside;
use crate::problem::ContactPair;
use crate::statics::cone::balanced;

/// True if Coulomb's law bounds the friction of a pair by its own contact forces.
pub(super) fn follows_cone(pair: &ContactPair) -> bool {
    pair.friction.is_some_and(|friction| friction.coefficient.is_some())
}

/// The signs with which friction can act where the jump along the contact is `slip`.
pub(super) fn senses(slip: f64, within: f64) -> &'static [f64] {
    match () {
        () if slip > within => &[1.0],
        () if slip < -within => &[-1.0],
        () => &[1.0, -1.0],
    }
}

impl Solution<'_> {
    /// The directions of the forces that a closed end of a pair can exert.
    pub(super) fn directions(&self, end: &End) -> Vec<[f64; 2]> {
        let own = self.slides.iter().find_map(|(slide, _)| {
            let is_its = (slide.first, slide.second) == (end.first, end.second)
                && dot(slide.tangent, end.normal).abs() <= ALIGNED;
            Some((slide, slide.coefficient.filter(|_| is_its)?))
        });
        let Some((slide, mu)) = own else { return vec![end.normal] };
        let senses = senses(self.along(slide), self.closed_within()).iter();
        senses.map(|sign| [0, 1].map(|c| end.normal[c] + sign * mu * slide.tangent[c])).collect()
    }

    /// Takes the forces of contact with Coulomb friction between the ends of its pairs out of `rest`.
    pub(super) fn press_and_slide_inside(&self, rest: &mut [[f64; 2]]) {
        let degree = self.candidate.degree;
        let Some(value) = self.inside_values().filter(|_| degree > 1) else { return };
        let within = self.closed_within();
        for pair in self.problem.pairs() {
            let Some(mu) = pair.friction.and_then(|friction| friction.coefficient) else { continue };
            let own = Inside::of(self.problem, pair, degree);
            let slides = inside(self.problem, pair, degree);
            let mut cones: Vec<Vec<(usize, [f64; 2])>> = Vec::new();
            for (row, slide) in own.rows.iter().zip(&slides).filter(|(row, _)| row.excess_at(value) >= -within) {
                for sign in senses(slide.row.excess_at(value), within) {
                    let rubbing = slide.row.terms().iter().map(|(node, factor)| (*node, factor.map(|f| sign * mu * f)));
                    cones.push(row.terms().iter().copied().chain(rubbing).collect());
                }
            }
            let columns: Vec<DVector<f64>> = cones.iter().map(|cone| own.column(cone)).collect();
            let lengths: Vec<f64> = columns.iter().map(|column| column.norm()).collect();
            let acts: Vec<usize> = (0..cones.len()).filter(|k| lengths[*k] > HELD).collect();
            let unit: Vec<DVector<f64>> = acts.iter().map(|k| &columns[*k] / lengths[*k]).collect();
            // Where the working set does not settle, the whole force is left over and the check fails in the open.
            let Ok((_, forces)) = balanced(&own.load(rest), &unit) else { continue };
            for (k, force) in forces {
                for (node, factor) in &cones[acts[k]] {
                    rest[*node] = [0, 1].map(|c| rest[*node][c] + force / lengths[acts[k]] * factor[c]);
                }
            }
            self.rest_on_supports(pair, rest);
        }
    }
}
