//! Stiffness matrices of rings: the isoparametric family in a body of revolution about r = 0, of the full turn,
//!
//! K = 2π ∫ Bᵀ D B r dA, with the rows rr, zz, tt and γ_rz of B, of which tt is N/r.
//!
//! The integrand is no polynomial, so that every rule makes a matrix of its own, all as good.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix4};

use super::{BIQUADRATIC, Family, Point, Rule, Variant, points_at, quadratic};
use crate::element::polynomial::symmetric_rules::symmetric_rules;

/// Points in each direction of a quadrilateral that are tried.
const GAUSS: [usize; 4] = [2, 3, 4, 5];

/// Where a radius is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Radius {
    /// At the point of the rule, as it must be.
    AtPoint,
    /// In the middle of the element.
    InTheMiddle,
    /// At the node whose function it goes with.
    AtNodes,
    /// Nowhere: it is left out.
    LeftOut,
}

/// How a ring is made: where the radius of the hoop strain u_r/r, and that of the weight 2πr, are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Way {
    /// Of the hoop strain; left out, there is no hoop strain.
    pub hoop: Radius,
    /// Of the weight; left out, the matrix is that of a slice with a hoop strain.
    pub weight: Radius,
}

impl Way {
    /// As it must be.
    pub const RIGHT: Self = Way { hoop: Radius::AtPoint, weight: Radius::AtPoint };
}

/// A rule of a family.
pub struct Points {
    /// How many points there are.
    pub count: usize,
    rule: Rule,
}

/// The rules by which textbooks and programs make rings of a family, the usual one first.
pub fn rules(family: Family) -> Vec<Points> {
    let made = |rule: Rule| Points { count: rule.len(), rule };
    let mut all: Vec<Points> = match family.corners() {
        // Four points leave bends of Q9 without energy.
        4 => GAUSS
            .iter()
            .filter(|n| family != Family::Q9 || **n > 2)
            .map(|n| made(family.rule(Variant::Points(*n))))
            .collect(),
        _ => symmetric_rules()
            .iter()
            .map(|rule| made(rule.iter().map(|(l, w)| ([l[1], l[2]], 0.5 * w)).collect()))
            .collect(),
    };
    let usual = match family {
        // One point would leave a rotation about it without energy.
        Family::P1 | Family::P2 => 3,
        _ => family.usual_points().pow(2),
    };
    all.sort_by_key(|points| (points.count != usual, points.count));
    all
}

/// One point in the middle.
pub fn one_point(family: Family) -> Points {
    Points { count: 1, rule: family.rule(Variant::OnePoint) }
}

/// K of the usual rule, or of one point; variants that have no ring are refused.
///
/// # Errors
/// As [`made`], and of variants without a ring.
pub fn stiffness(
    family: Family,
    nodes: &[[f64; 2]],
    d: &Matrix4<f64>,
    variant: Variant,
) -> Result<DMatrix<f64>, String> {
    let points = match variant {
        Variant::Right => rules(family).swap_remove(0),
        Variant::OnePoint => one_point(family),
        _ => return Err("this element is one of the plane".into()),
    };
    made(family, nodes, d, &points, Way::RIGHT)
}

/// K by a rule and a way, nodes in the order of the family.
///
/// # Errors
/// The number of nodes is another one, the Jacobian vanishes at a point, or a point lies on the axis or beyond.
pub fn made(
    family: Family,
    nodes: &[[f64; 2]],
    d: &Matrix4<f64>,
    points: &Points,
    way: Way,
) -> Result<DMatrix<f64>, String> {
    let n = family.nodes().len();
    if nodes.len() != n {
        return Err(format!("{} nodes, but the {} has {n}", nodes.len(), family.words()));
    }
    let slopes = |at| family.slopes(at);
    let radius = |at: [f64; 2]| family.values(at).iter().zip(nodes).map(|(value, x)| value * x[0]).sum::<f64>();
    let middle = radius(one_point(family).rule[0].0);
    let mut k = DMatrix::zeros(2 * n, 2 * n);
    for Point { at, weight, det, gradients, .. } in points_at(nodes, points.rule.clone(), &slopes, &slopes)? {
        let (values, own) = (family.values(at), radius(at));
        if own <= 0.0 {
            return Err("a quadrature point lies on the axis r = 0 or beyond it".into());
        }
        let mut b = DMatrix::zeros(4, 2 * n);
        for (i, [r, z]) in gradients.into_iter().enumerate() {
            (b[(0, 2 * i)], b[(1, 2 * i + 1)]) = (r, z);
            (b[(3, 2 * i)], b[(3, 2 * i + 1)]) = (z, r);
            b[(2, 2 * i)] = match way.hoop {
                Radius::AtPoint => values[i] / own,
                Radius::InTheMiddle => values[i] / middle,
                // On the axis a node does not move.
                Radius::AtNodes if nodes[i][0] > 0.0 => values[i] / nodes[i][0],
                Radius::AtNodes | Radius::LeftOut => 0.0,
            };
        }
        let by = match way.weight {
            Radius::InTheMiddle => middle,
            Radius::LeftOut => 1.0,
            Radius::AtPoint | Radius::AtNodes => own,
        };
        k += b.transpose() * d * b * (TAU * by * weight * det);
    }
    Ok(k)
}

impl Family {
    /// The shape functions at a place of the reference shape.
    fn values(self, [s, t]: [f64; 2]) -> Vec<f64> {
        let l = [1.0 - s - t, s, t];
        match self {
            Family::P1 => l.to_vec(),
            Family::P2 => {
                let middle = [(0, 1), (1, 2), (2, 0)].map(|(i, j): (usize, usize)| 4.0 * l[i] * l[j]);
                l.iter().map(|l| l * (2.0 * l - 1.0)).chain(middle).collect()
            }
            Family::Q4 => vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t],
            Family::Q8 => {
                let (x, y) = (2.0 * s - 1.0, 2.0 * t - 1.0);
                let corner = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                    .map(|[a, b]| 0.25 * (1.0 + a * x) * (1.0 + b * y) * (a * x + b * y - 1.0));
                let along = |b: f64| 0.5 * (1.0 - x * x) * (1.0 + b * y);
                let across = |a: f64| 0.5 * (1.0 - y * y) * (1.0 + a * x);
                corner.into_iter().chain([along(-1.0), across(1.0), along(1.0), across(-1.0)]).collect()
            }
            Family::Q9 => {
                let [f, g] = [s, t].map(quadratic);
                BIQUADRATIC.map(|(i, j)| f[i] * g[j]).into()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values against slopes by differences, and their sum.
    #[test]
    fn functions_have_their_slopes() {
        const STEP: f64 = 1e-6;
        for family in Family::ALL {
            let at = [0.31, 0.23];
            assert!((family.values(at).iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for c in 0..2 {
                let moved = |by: f64| family.values(std::array::from_fn(|i| if i == c { at[i] + by } else { at[i] }));
                let pairs = moved(STEP).into_iter().zip(moved(-STEP)).zip(family.slopes(at));
                for ((after, before), slope) in pairs {
                    assert!(((after - before) / (2.0 * STEP) - slope[c]).abs() < 1e-8, "{family:?}");
                }
            }
            for (i, x) in family.nodes().into_iter().enumerate() {
                let at_node = family.values(x);
                assert!((0..at_node.len()).all(|k| (at_node[k] - f64::from(u8::from(k == i))).abs() < 1e-14));
            }
        }
    }
}
