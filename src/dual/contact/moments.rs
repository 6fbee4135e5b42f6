//! The moments of an edge on Γ_K in a basis whose first vectors are dual to the columns n̂ B_k.
//!
//! Where the direction of contact is constant, the moments along it belong to the coefficients of a t of the edge's degree
//! p. Where it turns, from a at the first end to b at the second, t has degree p − 1, and the column of its coefficient t_k
//! is what t n̂ has in the coefficients of the traction: (1 − k/p) a in the k-th and ((k + 1)/p) b in the next. With these
//! columns C, y = Cᵀm are the moments that belong to t, z = Zᵀm those of an orthonormal basis Z of the rest, and
//!
//! m = C (CᵀC)⁻¹ y + Z z.
//!
//! The moments y' of the first side are then replaced by the jumps j = y' − y''; all others are free on both sides.

use nalgebra::DMatrix;

use crate::dual::system::unknowns::Component;
use crate::problem::Direction;

/// An edge on Γ_K.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactEdge {
    /// First unknown of the rest: the moments across the direction of contact in the order of the edge, or z.
    pub across: usize,
    /// First jump.
    pub jump: usize,
    /// First of the moments along the direction on the second side, where that is a body.
    pub second: Option<usize>,
    /// First stretch of an elastic contact, on its first side: the jump is what is numbered as one and this, see
    /// [`crate::problem::Problem::softened`].
    pub stretch: Option<usize>,
    /// 0 on the first side, 1 on the second.
    pub side: usize,
    pub(in crate::dual) degree: usize,
    /// Whether the pair runs against the edge.
    reversed: bool,
    axes: Axes,
}

#[derive(Debug, Clone, PartialEq)]
enum Axes {
    /// The direction, out of this side, and the length of the pair per unit length of each edge.
    Constant { along: [f64; 2], shares: [f64; 2] },
    /// C, C (CᵀC)⁻¹ and Z; rows are x and y of the moments, in the order of the edge.
    Turning { columns: DMatrix<f64>, dual: DMatrix<f64>, rest: DMatrix<f64> },
}

const AXES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

impl ContactEdge {
    /// An edge of degree `degree` on side `side` of a pair with that direction, which runs against the edge where it is
    /// `reversed`, and its first unknowns as in the fields of those names.
    pub fn new(
        direction: &Direction,
        degree: usize,
        side: usize,
        reversed: bool,
        across: usize,
        jump: usize,
        second: Option<usize>,
    ) -> Self {
        let axes = if direction.is_constant() {
            let n = direction.unit(0);
            let along = if side == 1 { n.map(|x| -x) } else { n };
            Axes::Constant { along, shares: direction.shares }
        } else {
            let mut columns = columns(direction, degree) * direction.shares[side];
            if reversed {
                columns = DMatrix::from_fn(columns.nrows(), columns.ncols(), |i, k| {
                    columns[(2 * (degree - i / 2) + i % 2, k)]
                });
            }
            let (dual, rest) = dual_and_rest(&columns);
            Axes::Turning { columns, dual, rest }
        };
        ContactEdge { across, jump, second, stretch: None, side, degree, reversed, axes }
    }

    /// Moment `k` of the edge along two axes at right angles.
    pub fn components(&self, k: usize) -> [Component; 2] {
        let at = if self.reversed { self.degree - k } else { k };
        match &self.axes {
            Axes::Constant { along, shares: [c, d] } => {
                let across = Component::sum([-along[1], along[0]], &[(self.across + k, 1.0)], 1);
                let along = match (self.side, self.second) {
                    (0, Some(second)) if self.stretch.is_some() => {
                        let stretch = self.stretch.map_or(0, |first| first + at);
                        let terms = [(stretch, 1.0 / c), (self.jump + at, 1.0 / c), (second + at, -d / c)];
                        Component::sum(*along, &terms, 1)
                    }
                    (0, None) if self.stretch.is_some() => {
                        let stretch = self.stretch.map_or(0, |first| first + at);
                        Component::sum(*along, &[(stretch, 1.0 / c), (self.jump + at, 1.0 / c)], 2)
                    }
                    // c m_n' = j − d m_n'': outward directions point against each other.
                    (0, Some(second)) => Component::sum(*along, &[(self.jump + at, 1.0 / c), (second + at, -d / c)], 0),
                    (1, Some(second)) => Component::sum(*along, &[(second + at, 1.0)], 1),
                    _ => Component::sum(*along, &[(self.jump + at, 1.0 / c)], 1),
                };
                [along, across]
            }
            Axes::Turning { dual, rest, .. } => [0, 1].map(|c| {
                let row = 2 * k + c;
                let mut terms: Vec<_> = (0..rest.ncols()).map(|i| (self.across + i, rest[(row, i)])).collect();
                let along = |first: usize| (0..dual.ncols()).map(move |i| (first + i, dual[(row, i)]));
                let mut own = terms.len();
                match (self.side, self.second) {
                    // y' = j + y'', each in units of its own side.
                    (0, Some(second)) => terms.extend(along(self.jump).chain(along(second))),
                    (1, Some(second)) => terms.extend(along(second)),
                    _ => terms.extend(along(self.jump)),
                }
                if self.side == 1 || self.second.is_none() {
                    own = terms.len();
                }
                Component::sum(AXES[c], &terms, own)
            }),
        }
    }

    /// Adds to the unknowns `x` what moment `k` of the edge contributes to them.
    pub fn project(&self, k: usize, m: [f64; 2], x: &mut [f64]) {
        let second = self.second.filter(|_| self.side == 1);
        match &self.axes {
            Axes::Constant { along, shares } => {
                let at = if self.reversed { self.degree - k } else { k };
                x[self.across + k] = m[1] * along[0] - m[0] * along[1];
                let along = m[0] * along[0] + m[1] * along[1];
                x[self.jump + at] += shares[self.side] * along;
                if let Some(second) = second {
                    x[second + at] = along;
                }
            }
            Axes::Turning { columns, rest, .. } => {
                let part = |matrix: &DMatrix<f64>, i: usize| m[0] * matrix[(2 * k, i)] + m[1] * matrix[(2 * k + 1, i)];
                (0..rest.ncols()).for_each(|i| x[self.across + i] += part(rest, i));
                for i in 0..columns.ncols() {
                    let y = part(columns, i);
                    x[self.jump + i] += if self.side == 0 { y } else { -y };
                    if let Some(second) = second {
                        x[second + i] += y;
                    }
                }
            }
        }
    }
}

/// The coefficients of t n̂ of degree p, x and y of one after the other, for each coefficient of t of degree p − 1, where n̂
/// turns.
pub fn columns(direction: &Direction, degree: usize) -> DMatrix<f64> {
    let ([a, b], p) = (direction.ends, degree as f64);
    DMatrix::from_fn(2 * (degree + 1), degree, |i, k| match i / 2 {
        j if j == k => (1.0 - k as f64 / p) * a[i % 2],
        j if j == k + 1 => (k as f64 + 1.0) / p * b[i % 2],
        _ => 0.0,
    })
}

/// C (CᵀC)⁻¹ and an orthonormal basis of what is at right angles to C.
fn dual_and_rest(columns: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let (rows, count) = columns.shape();
    let mut all = DMatrix::zeros(rows, count + rows);
    all.columns_mut(0, count).copy_from(columns);
    all.columns_mut(count, rows).fill_with_identity();
    let q = all.qr().q();
    // Columns are independent: the direction vanishes nowhere.
    let inverse = columns.clone().pseudo_inverse(0.0).unwrap_or_else(|_| DMatrix::zeros(count, rows));
    (inverse.transpose(), q.columns(count, rows - count).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::side;

    #[test]
    fn columns_are_the_coefficients_of_t_times_a_linear_direction() {
        let direction = Direction { ends: [[0.6, 0.8], [0.0, 1.0]], shares: [1.0; 2] };
        for p in 1..=8 {
            let c = columns(&direction, p);
            for k in 0..p {
                for (s, axis) in [(0.0, 0), (0.3, 1), (0.55, 0), (1.0, 1)] {
                    let found: f64 = (0..=p).map(|j| c[(2 * j + axis, k)] * side::bernstein(p, j, s)).sum();
                    let exact = side::bernstein(p - 1, k, s) * direction.at(s)[axis];
                    assert!((found - exact).abs() < 1e-14);
                }
            }
        }
    }

    #[test]
    fn moments_come_back_from_their_projection() {
        let direction = Direction { ends: [[0.6, 0.8], [0.0, 1.0]], shares: [0.9, 1.1] };
        let straight = Direction { ends: [[0.6, 0.8]; 2], shares: [0.9, 1.1] };
        for direction in [direction, straight] {
            for p in 1..=5 {
                let jumps = direction.columns(p);
                let rest = 2 * (p + 1) - jumps;
                // First side, second side and jumps one after the other.
                let second = Some(2 * rest);
                let sides = [
                    ContactEdge::new(&direction, p, 0, false, 0, 2 * rest + jumps, second),
                    ContactEdge::new(&direction, p, 1, true, rest, 2 * rest + jumps, second),
                ];
                let m = |side: usize, k: usize| [(1 + side + 3 * k) as f64, ((2 + side) * (k + 1)) as f64 * 0.7 - 2.0];
                let mut x = vec![0.0; 2 * rest + 2 * jumps];
                for (side, edge) in sides.iter().enumerate() {
                    (0..=p).for_each(|k| edge.project(k, m(side, k), &mut x));
                }
                for (side, edge) in sides.iter().enumerate() {
                    for k in 0..=p {
                        let mut back = [0.0; 2];
                        for component in edge.components(k) {
                            let value: f64 = component.terms().iter().map(|&(i, c)| c * x[i]).sum();
                            (0..2).for_each(|c| back[c] += value * component.direction[c]);
                        }
                        let exact = m(side, k);
                        assert!((0..2).all(|c| (back[c] - exact[c]).abs() < 1e-11), "{back:?} {exact:?}");
                    }
                }
            }
        }
    }
}
