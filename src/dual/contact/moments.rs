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
//!
//! Where there is friction C has the columns t̂ B_k, too, and jumps along t̂ replace moments of the first side likewise. A constant
//! direction leaves no rest then.

use nalgebra::DMatrix;

use crate::dual::system::unknowns::Component;
use crate::problem::{ContactPair, Direction};

/// An edge on Γ_K.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactEdge {
    /// First unknown of the rest: the moments across the direction of contact in the order of the edge, or z; where there is friction
    /// only of z, if n̂ turns, and none (`usize::MAX`) otherwise.
    pub across: usize,
    /// First jump along n̂.
    pub jump: usize,
    /// First jump along t̂, where there is friction.
    pub slide: Option<usize>,
    /// First of the moments along the direction on the second side, where that is a body; those along t̂ follow.
    pub second: Option<usize>,
    /// First stretch of an elastic contact, on its first side: the jump is what is numbered as one and this, see
    /// [`crate::problem::Problem::softened`].
    pub stretch: Option<usize>,
    /// 0 on the first side, 1 on the second.
    pub side: usize,
    pub(in crate::dual) degree: usize,
    /// True if the pair runs against the edge.
    reversed: bool,
    axes: Axes,
}

/// The unknowns that the moments of a contact edge are made of.
#[derive(Debug, Clone, Copy)]
pub struct ContactUnknowns {
    /// As in [`ContactEdge::across`].
    pub across: usize,
    /// As in [`ContactEdge::jump`].
    pub jump: usize,
    /// As in [`ContactEdge::slide`].
    pub slide: Option<usize>,
    /// As in [`ContactEdge::second`].
    pub second: Option<usize>,
}

#[derive(Debug, Clone, PartialEq)]
enum Axes {
    /// The direction and t̂, out of this side, and the length of the pair per unit length of each edge.
    Constant { along: [f64; 2], tangent: [f64; 2], shares: [f64; 2] },
    /// C, C (CᵀC)⁻¹ and Z; rows are x and y of the moments, in the order of the edge.
    Turning { columns: DMatrix<f64>, dual: DMatrix<f64>, rest: DMatrix<f64> },
}

const AXES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

impl ContactEdge {
    /// An edge of degree `degree` on side `side` of `pair`, which runs against the edge where it is `reversed`, and its unknowns.
    pub fn new(pair: &ContactPair, degree: usize, side: usize, reversed: bool, unknowns: ContactUnknowns) -> Self {
        let ContactUnknowns { across, jump, slide, second } = unknowns;
        let direction = &pair.direction;
        let axes = if direction.is_constant() {
            let out = |v: [f64; 2]| if side == 1 { v.map(|x| -x) } else { v };
            let along = out(direction.unit(0));
            let tangent = pair.friction.map_or([-along[1], along[0]], |friction| out(friction.tangent.unit(0)));
            Axes::Constant { along, tangent, shares: direction.shares }
        } else {
            let mut columns = columns_of_pair(pair, degree) * direction.shares[side];
            if reversed {
                columns = DMatrix::from_fn(columns.nrows(), columns.ncols(), |i, k| {
                    columns[(2 * (degree - i / 2) + i % 2, k)]
                });
            }
            let (dual, rest) = dual_and_rest(&columns);
            Axes::Turning { columns, dual, rest }
        };
        ContactEdge { across, jump, slide, second, stretch: None, side, degree, reversed, axes }
    }

    /// The first unknowns of all blocks that its moments are made of.
    pub fn first_unknowns(&self) -> impl Iterator<Item = usize> {
        let of_pair = self.side == 0 || self.second.is_none();
        let across = Some(self.across).filter(|across| *across != usize::MAX);
        let (jump, slide) = if of_pair { (Some(self.jump), self.slide) } else { (None, None) };
        [across, jump, slide, self.second].into_iter().flatten()
    }

    /// Number of columns along n̂.
    fn along_normal(&self) -> usize {
        match &self.axes {
            Axes::Constant { .. } => self.degree + 1,
            Axes::Turning { .. } => self.degree,
        }
    }

    /// The jump of column `i`, those along t̂ behind those along n̂.
    fn jump_of(&self, i: usize) -> usize {
        let n = self.along_normal();
        if i < n { self.jump + i } else { self.slide.map_or(self.jump, |slide| slide + i - n) }
    }

    /// Moment `k` of the edge along two axes at right angles.
    pub fn components(&self, k: usize) -> [Component; 2] {
        let at = if self.reversed { self.degree - k } else { k };
        match &self.axes {
            Axes::Constant { along, tangent, shares: [c, d] } => {
                // Of what follows the jump of column i, c m' = j − d m'': outward directions point against each other.
                let joined = |axis: [f64; 2], i: usize| match (self.side, self.second, self.stretch) {
                    (0, Some(second), Some(stretch)) => {
                        let terms = [(stretch + i, 1.0 / c), (self.jump_of(i), 1.0 / c), (second + i, -d / c)];
                        Component::sum(axis, &terms, 1)
                    }
                    (0, None, Some(stretch)) => {
                        Component::sum(axis, &[(stretch + i, 1.0 / c), (self.jump_of(i), 1.0 / c)], 2)
                    }
                    (0, Some(second), None) => {
                        Component::sum(axis, &[(self.jump_of(i), 1.0 / c), (second + i, -d / c)], 0)
                    }
                    (1, Some(second), _) => Component::sum(axis, &[(second + i, 1.0)], 1),
                    _ => Component::sum(axis, &[(self.jump_of(i), 1.0 / c)], 1),
                };
                let across = match self.slide {
                    Some(_) => joined(*tangent, self.degree + 1 + at),
                    None => Component::sum(*tangent, &[(self.across + k, 1.0)], 1),
                };
                [joined(*along, at), across]
            }
            Axes::Turning { dual, rest, .. } => [0, 1].map(|c| {
                let row = 2 * k + c;
                let mut terms: Vec<_> = (0..rest.ncols()).map(|i| (self.across + i, rest[(row, i)])).collect();
                let mut own = terms.len();
                let jumps = (0..dual.ncols()).map(|i| (self.jump_of(i), dual[(row, i)]));
                let second = self.second.map(|first| (0..dual.ncols()).map(move |i| (first + i, dual[(row, i)])));
                // y' = j + y'', each in units of its own side.
                if self.side == 0 || self.second.is_none() {
                    terms.extend(jumps);
                }
                terms.extend(second.into_iter().flatten());
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
            Axes::Constant { along, tangent, shares } => {
                let at = if self.reversed { self.degree - k } else { k };
                let mut joined = |axis: &[f64; 2], i: usize| {
                    let part = m[0] * axis[0] + m[1] * axis[1];
                    x[self.jump_of(i)] += shares[self.side] * part;
                    if let Some(second) = second {
                        x[second + i] = part;
                    }
                };
                joined(along, at);
                match self.slide {
                    Some(_) => joined(tangent, self.degree + 1 + at),
                    None => x[self.across + k] = m[1] * along[0] - m[0] * along[1],
                }
            }
            Axes::Turning { columns, rest, .. } => {
                let part = |matrix: &DMatrix<f64>, i: usize| m[0] * matrix[(2 * k, i)] + m[1] * matrix[(2 * k + 1, i)];
                (0..rest.ncols()).for_each(|i| x[self.across + i] += part(rest, i));
                for i in 0..columns.ncols() {
                    let y = part(columns, i);
                    x[self.jump_of(i)] += if self.side == 0 { y } else { -y };
                    if let Some(second) = second {
                        x[second + i] += y;
                    }
                }
            }
        }
    }
}

/// The number of columns of a pair for tractions of degree `degree`: along n̂, and along t̂ where there is friction.
pub fn columns_along(pair: &ContactPair, degree: usize) -> [usize; 2] {
    [pair.direction.columns(degree), pair.friction.map_or(0, |friction| friction.tangent.columns(degree))]
}

/// The columns of a pair whose direction turns, those along t̂ behind those along n̂.
pub fn columns_of_pair(pair: &ContactPair, degree: usize) -> DMatrix<f64> {
    let along = columns(&pair.direction, degree);
    let Some(friction) = pair.friction else { return along };
    let across = columns(&friction.tangent, degree);
    let n = along.ncols();
    DMatrix::from_fn(along.nrows(), 2 * n, |i, k| if k < n { along[(i, k)] } else { across[(i, k - n)] })
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
    use crate::problem::{Bow, EdgeWeight, Friction};

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

    /// A pair with that direction, with friction or without.
    fn pair(direction: Direction, rubs: bool) -> ContactPair {
        let tangent = Direction { ends: direction.ends.map(|[x, y]| [y, -x]), ..direction };
        ContactPair {
            edges: [Some(0), Some(1)],
            first: [0, 1],
            second: Some([2, 3]),
            normal: direction.ends[0],
            direction,
            length: 1.0,
            arc: [0.0, 1.0],
            gap: [0.0; 2],
            bow: Bow::default(),
            stiffness: None,
            friction: rubs.then_some(Friction {
                bound: [1.0; 2],
                tangent,
                weight: EdgeWeight::default(),
                coefficient: None,
            }),
        }
    }

    #[test]
    fn moments_come_back_from_their_projection() {
        let direction = Direction { ends: [[0.6, 0.8], [0.0, 1.0]], shares: [0.9, 1.1] };
        let straight = Direction { ends: [[0.6, 0.8]; 2], shares: [0.9, 1.1] };
        let pairs = [(direction, false), (straight, false), (direction, true), (straight, true)];
        for (pair, p) in pairs.into_iter().flat_map(|(d, rubs)| (1..=5).map(move |p| (pair(d, rubs), p))) {
            let [jumps, slides] = columns_along(&pair, p);
            let both = jumps + slides;
            let rest = 2 * (p + 1) - both;
            // First side, second side and jumps one after the other.
            let jump = 2 * rest + both;
            let slide = (slides > 0).then_some(jump + jumps);
            let unknowns = |across| ContactUnknowns { across, jump, slide, second: Some(2 * rest) };
            let sides = [
                ContactEdge::new(&pair, p, 0, false, unknowns(0)),
                ContactEdge::new(&pair, p, 1, true, unknowns(rest)),
            ];
            let m = |side: usize, k: usize| [(1 + side + 3 * k) as f64, ((2 + side) * (k + 1)) as f64 * 0.7 - 2.0];
            let mut x = vec![0.0; 2 * rest + 2 * both];
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
