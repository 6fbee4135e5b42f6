//! The moments of an edge on Γ_K in a basis whose first vectors are dual to the columns n̂ q_k.
//!
//! Let a and b be the direction of contact at the two ends of an edge, in units of force per length of that edge. Where it
//! is constant, the two moments along it belong to the two coefficients of a linear t. Where it turns, t is constant: the
//! moment y = a·m_a + b·m_b belongs to it, and z = (|b| a/|a|)·m_a − (|a| b/|b|)·m_b is its complement, with
//!
//! m_a · a/|a| = (|a| y + |b| z) / (|a|² + |b|²),  m_b · b/|b| = (|b| y − |a| z) / (|a|² + |b|²).
//!
//! The moments along n̂ of the first side are then replaced by the jumps j = y' − y''; all others are free on both sides.

use super::unknowns::{Block, Component};
use crate::problem::Direction;

/// An edge on Γ_K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEdge {
    /// Block of the moments across the direction of contact at both ends, in the order of the edge, and of the complement
    /// where the direction turns.
    pub across: usize,
    /// Block of the jumps.
    pub jump: usize,
    /// Block of the moments along the direction on the second side, where that is a body.
    pub second: Option<usize>,
    /// 0 on the first side, 1 on the second.
    pub side: usize,
    /// Whether the pair runs against the edge, so that its first end is the edge's second.
    pub reversed: bool,
    /// The direction of contact.
    pub direction: Direction,
}

impl ContactEdge {
    /// The unit vectors along which the moment at end `end` of the edge is taken: along the direction of contact, out of
    /// this side where it is constant, and across it.
    fn axes(&self, end: usize) -> [[f64; 2]; 2] {
        let n = self.direction.unit(self.pair_end(end));
        let n = if self.side == 1 && self.direction.is_constant() { n.map(|x| -x) } else { n };
        [n, [-n[1], n[0]]]
    }

    fn pair_end(&self, end: usize) -> usize {
        if self.reversed { 1 - end } else { end }
    }

    /// |a| and |b|, of end `end` and of the other one.
    fn sizes(&self, end: usize) -> [f64; 2] {
        let share = self.direction.shares[self.side];
        let at = self.pair_end(end);
        [at, 1 - at].map(|k| share * self.direction.ends[k][0].hypot(self.direction.ends[k][1]))
    }

    /// 1 at the first end of the pair and −1 at the second: the sign of the complement.
    fn sign(&self, end: usize) -> f64 {
        if self.pair_end(end) == 0 { 1.0 } else { -1.0 }
    }

    /// The moment at end `end` of the edge, along and across the direction of contact.
    pub fn components(&self, blocks: &[Block], end: usize) -> [Component; 2] {
        let [along, across] = self.axes(end);
        let own = blocks[self.across].start;
        let across = Component::sum(across, &[(own + end, 1.0)], 1);
        let jump = blocks[self.jump].start;
        if !self.direction.is_constant() {
            let [size, other] = self.sizes(end);
            let square = size * size + other * other;
            let rest = (own + 2, self.sign(end) * other / square);
            let y = size / square;
            let second = self.second.map(|b| blocks[b].start);
            let along = match (self.side, second) {
                (0, Some(second)) => {
                    // y' = j + y'', each in units of its own side.
                    Component::sum(along, &[rest, (jump, y), (second, y)], 1)
                }
                (1, Some(second)) => Component::sum(along, &[rest, (second, y)], 2),
                _ => Component::sum(along, &[rest, (jump, y)], 2),
            };
            return [along, across];
        }
        let at = self.pair_end(end);
        let [c, d] = self.direction.shares;
        let along = match (self.side, self.second) {
            // c m_n' = j − d m_n'': outward directions point against each other.
            (0, Some(second)) => Component::sum(along, &[(jump + at, 1.0 / c), (blocks[second].start + at, -d / c)], 0),
            (1, Some(second)) => Component::sum(along, &[(blocks[second].start + at, 1.0)], 1),
            _ => Component::sum(along, &[(jump + at, 1.0 / c)], 1),
        };
        [along, across]
    }

    /// Adds to the unknowns `x` what the moment `m` at end `end` contributes to them.
    pub fn project(&self, blocks: &[Block], end: usize, m: [f64; 2], x: &mut [f64]) {
        let [along, across] = self.axes(end).map(|axis| m[0] * axis[0] + m[1] * axis[1]);
        let own = blocks[self.across].start;
        x[own + end] = across;
        let jump = blocks[self.jump].start;
        let second = self.second.filter(|_| self.side == 1).map(|b| blocks[b].start);
        if !self.direction.is_constant() {
            let [size, other] = self.sizes(end);
            x[own + 2] += self.sign(end) * other * along;
            let y = size * along;
            x[jump] += if self.side == 0 { y } else { -y };
            if let Some(second) = second {
                x[second] += y;
            }
            return;
        }
        let at = self.pair_end(end);
        x[jump + at] += self.direction.shares[self.side] * along;
        if let Some(second) = second {
            x[second + at] = along;
        }
    }
}
