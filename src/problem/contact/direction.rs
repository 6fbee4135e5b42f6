//! The direction of contact along a pair of edges.
//!
//! Contact acts along one field n̂ on Γ_K, continuous and linear on every edge, the same for both sides: jumps are
//! j(v) = (v' − v'')·n̂ and tractions T' = −T'' = t n̂ with t ≤ 0. A traction of degree p that is t n̂ leaves t the degree p
//! where n̂ is constant, and p − 1 where it turns.

/// The direction n̂ of a pair, and how its length compares with those of its edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// n̂ at the two ends, out of the first side; linear between. Unit vectors where n̂ is constant and at the vertices that
    /// it is given at, a little shorter between them.
    pub ends: [[f64; 2]; 2],
    /// Length of the pair ([`crate::problem::ContactPair::length`]) per unit length of the edge on each side: one where the sides
    /// coincide.
    pub shares: [f64; 2],
}

impl Direction {
    /// A direction that is constant along sides that coincide.
    pub fn constant(normal: [f64; 2]) -> Self {
        Direction { ends: [normal; 2], shares: [1.0; 2] }
    }

    /// True if n̂ is constant along the pair.
    pub fn is_constant(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// The number of columns n̂ q_k, one for each coefficient of t, for tractions of degree `degree`.
    pub fn columns(&self, degree: usize) -> usize {
        if self.is_constant() { degree + 1 } else { degree }
    }

    /// n̂ at the part `t` of the way from the first end to the second.
    pub fn at(&self, t: f64) -> [f64; 2] {
        let [a, b] = self.ends;
        if self.is_constant() { a } else { [0, 1].map(|c| a[c] + t * (b[c] - a[c])) }
    }

    /// The unit vector along n̂ at an end.
    pub fn unit(&self, end: usize) -> [f64; 2] {
        if self.is_constant() { self.ends[end] } else { unit(self.ends[end]) }
    }

    /// t at an end, from the traction of the first side there.
    pub fn multiplier(&self, end: usize, traction: [f64; 2]) -> f64 {
        let n = self.ends[end];
        let along = traction[0] * n[0] + traction[1] * n[1];
        if self.is_constant() { along / self.shares[0] } else { along / (n[0] * n[0] + n[1] * n[1]) / self.shares[0] }
    }

    /// The rest of a traction of the given side at an end after t n̂ is subtracted.
    pub fn remainder(&self, side: usize, end: usize, traction: [f64; 2], t: f64) -> [f64; 2] {
        let factor = if side == 0 { t * self.shares[0] } else { -t * self.shares[1] };
        [0, 1].map(|c| traction[c] - factor * self.ends[end][c])
    }
}

/// `v` scaled to length one.
pub(in crate::problem) fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = v[0].hypot(v[1]);
    [v[0] / length, v[1] / length]
}
