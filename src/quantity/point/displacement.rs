//! The load of a displacement at a point, ∫ k d·u, in terms that the adjoint problem can balance.
//!
//! The stress S(g) = −(g ⊗ d + d ⊗ g − (g·d) I) of a field g without curl has −div S = (div g) d. With g = (x − x0) G on triangles of a set
//! that follows the disc, and with one linear field on each triangle that the circle cuts, for the mean ρ̄ of what is left,
//!
//! ∫ k d·u = ∫ S:e(u) − Σ_T ∮ S n·u + Σ_T [∫_T (ρ − ρ̄) d·u]:
//!
//! an initial strain aS, and tractions along edges. What is left in the brackets has no resultant. Its moment is balanced by a constant
//! traction along the tangent of the triangle, which does no work on fields whose rotation has the mean zero; so, with such a w' = w less a rigid
//! motion, the rest is at most ‖ρ − ρ̄‖ ‖w'‖ ≤ ‖ρ − ρ̄‖ (h/π) ‖∇w'‖ (Payne & Weinberger), and ‖∇w'‖² ≤ (1 + 2/β²) ‖e(w)‖². The last follows from
//! ∇ω = (∂_x e_xy − ∂_y e_xx, ∂_x e_yy − ∂_y e_xy) for the rotation ω with the constant β of div on the triangle, which is at least ρ_i/(2R_i) for a
//! domain that is star-shaped about a disc of radius ρ_i and lies in the one of radius R_i about the same point (Costabel & Dauge, Arch. Ration.
//! Mech. Anal. 217 (2015)); both are taken about the centre of the inscribed circle. Tractions are projected in the degree of the edge; what that leaves is
//! bounded by the trace inequality ‖w'‖²_e ≤ |e|/|T| (‖w'‖² + h ‖w'‖ ‖∇w'‖). For w = u − v these bounds widen the interval.

use std::collections::{BTreeMap, BTreeSet};

use super::disc::Place;
use super::{Point, Wanted};
use crate::dual::ShapedStrain;
use crate::element::contraction;
use crate::element::geometry::from_centroid;
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::polynomial::side;
use crate::problem::{Condition, Problem};
use crate::quantity::adjoint::constants::Constants;
use crate::quantity::functional::Functional;
use crate::quantity::functional::projection::projected;

/// Relative rounding error of a difference of squares.
const ROUNDING: f64 = 1e-14;

/// The share of a triangle in the load.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    /// True if g = (x − x0) G on it.
    follows: bool,
    /// ρ̄.
    mean: f64,
    /// The tangential traction.
    tangential: f64,
}

impl Point {
    pub(super) fn load_of_displacement(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        stress_degree: impl Fn(usize) -> usize,
        edge_degree: impl Fn(usize) -> usize,
    ) {
        let Wanted::Displacement(d) = self.wanted else { return };
        let mesh = &problem.mesh;
        let material = problem.materials()[self.body];
        let mut oscillation: BTreeMap<usize, f64> = BTreeMap::new();
        let mut shares: BTreeMap<usize, Share> = BTreeMap::new();
        for &t in &self.triangles {
            let corners = mesh.corners(t);
            let degree = stress_degree(t);
            let all = self.disc.all(corners, 2 * (self.kernel.degree() + 1).max(degree));
            let (share, left) = self.share(corners, d);
            shares.insert(t, share);
            if left > 0.0 {
                *oscillation.entry(t).or_default() += left * Constants::new(corners).of_load;
            }
            let stresses: Vec<[f64; 3]> =
                all.iter().map(|spot| self.stress(&share, corners, spot.from_middle, d)).collect();
            // e(u) = aτ + ε0.
            for (spot, stress) in all.iter().zip(&stresses) {
                let at = [0, 1].map(|c| spot.from_middle[c] + self.disc.middle[c]);
                functional.constant += spot.weight * contraction(*stress, material.initial().at(at));
            }
            let chi: Vec<[f64; 3]> = stresses.into_iter().map(|stress| material.strain(stress)).collect();
            let found = projected(corners, &material, degree, (&all, true), &chi);
            functional.load.shaped.push(ShapedStrain { triangle: t, strain: found.field });
            functional.rests.push(found.rest);
        }
        let edges: BTreeSet<usize> = self.triangles.iter().flat_map(|&t| mesh.triangle_edges[t]).collect();
        for e in edges {
            self.load_edge(problem, functional, (e, edge_degree(e)), &shares, &mut oscillation);
        }
        functional.oscillation.extend(oscillation);
    }

    /// The share of a triangle, and ‖ρ − ρ̄‖.
    fn share(&self, corners: [[f64; 2]; 3], d: [f64; 2]) -> (Share, f64) {
        if self.disc.place(corners) == Place::Inside {
            return (Share { follows: true, ..Share::default() }, 0.0);
        }
        let degree = 2 * self.kernel.degree();
        let all = self.disc.all(corners, degree);
        let area: f64 = all.iter().map(|spot| spot.weight).sum();
        let middle = self.middle(corners);
        // ∫ k², ∫ k and ∫ k (x − x_T) × d.
        let sums = |spots: &[super::disc::Spot]| {
            let mut sums = [0.0; 3];
            for spot in spots {
                let k = self.kernel.weight(spot.from_middle);
                let arm = [0, 1].map(|c| spot.from_middle[c] - middle[c]);
                sums[0] += spot.weight * k * k;
                sums[1] += spot.weight * k;
                sums[2] += spot.weight * k * (arm[0] * d[1] - arm[1] * d[0]);
            }
            sums
        };
        let (whole, part) = (sums(&all), sums(&self.disc.spots(corners, degree)));
        let follows = part[0] >= whole[0] - part[0];
        let [square, force, moment] = if follows { [0, 1, 2].map(|i| part[i] - whole[i]) } else { part };
        let left = square.abs() - force * force / area + ROUNDING * whole[0].max(part[0]);
        let share = Share { follows, mean: force / area, tangential: 0.5 * moment / area };
        (share, left.max(0.0).sqrt())
    }

    /// The centroid, as seen from the middle of the disc.
    fn middle(&self, corners: [[f64; 2]; 3]) -> [f64; 2] {
        let centred = from_centroid(corners);
        [0, 1].map(|c| corners[0][c] - self.disc.middle[c] - centred[0][c])
    }

    /// S on a triangle.
    fn stress(&self, share: &Share, corners: [[f64; 2]; 3], from_middle: [f64; 2], d: [f64; 2]) -> [f64; 3] {
        let centroid = self.middle(corners);
        let mut g = [0, 1].map(|c| 0.5 * share.mean * (from_middle[c] - centroid[c]));
        if share.follows {
            let flux = self.kernel.flux(from_middle);
            g = [0, 1].map(|c| g[c] + flux[c]);
        }
        let [x, y] = [g[0] * d[0], g[1] * d[1]];
        [-(x - y), -(y - x), -(g[0] * d[1] + g[1] * d[0])]
    }

    /// The tractions along an edge, projected.
    fn load_edge(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        (e, degree): (usize, usize),
        shares: &BTreeMap<usize, Share>,
        oscillation: &mut BTreeMap<usize, f64>,
    ) {
        let Wanted::Displacement(d) = self.wanted else { return };
        let mesh = &problem.mesh;
        let edge = &mesh.edges[e];
        let (length, normal) = mesh.edge_frame(e);
        let ends = edge.vertices.map(|v| mesh.points[v]);
        let tangent = [0, 1].map(|c| (ends[1][c] - ends[0][c]) / length);
        let sides: Vec<(f64, Share, [[f64; 2]; 3])> = [1.0, -1.0]
            .into_iter()
            .zip(edge.triangles)
            .filter_map(|(sign, t)| Some((sign, *shares.get(&t?)?, mesh.corners(t?))))
            .collect();
        // Where both sides follow the disc g is continuous, and of no account.
        let cancels = sides.len() == 2 && sides.iter().all(|(_, share, _)| share.follows);
        let traction = |from_middle: [f64; 2]| {
            let mut t = [0.0; 2];
            for (sign, share, corners) in &sides {
                let share = Share { follows: share.follows && !cancels, ..*share };
                let s = self.stress(&share, *corners, from_middle, d);
                t[0] += sign * (share.tangential * tangent[0] - s[0] * normal[0] - s[2] * normal[1]);
                t[1] += sign * (share.tangential * tangent[1] - s[2] * normal[0] - s[1] * normal[1]);
            }
            t
        };
        let rule = segment_rule(2 * (self.kernel.degree() + 1).max(degree));
        let mut values: Vec<(f64, f64, [f64; 2])> = rule
            .iter()
            .map(|(s, weight)| {
                let at = [0, 1].map(|c| ends[0][c] - self.disc.middle[c] + s * (ends[1][c] - ends[0][c]));
                (*s, *weight, traction(at))
            })
            .collect();
        match problem.conditions[e] {
            Condition::Clamped([a, b]) => {
                for (s, weight, t) in values {
                    let u = [0, 1].map(|c| a[c] + s * (b[c] - a[c]));
                    functional.constant += length * weight * (t[0] * u[0] + t[1] * u[1]);
                }
                return;
            }
            Condition::Roller { direction: [x, y], displacement } => {
                // What the roller prescribes is known; the load acts across it.
                for (_, weight, t) in &mut values {
                    let along = t[0] * x + t[1] * y;
                    functional.constant += length * *weight * along * displacement;
                    *t = [t[0] - along * x, t[1] - along * y];
                }
            }
            _ => {}
        }
        let moments = |c: usize| -> Vec<f64> {
            let of = |k: usize| values.iter().map(|(s, w, t)| w * t[c] * side::bernstein(degree, k, *s)).sum();
            (0..=degree).map(of).collect()
        };
        let [x, y] = [0, 1].map(|c| side::from_moments(&moments(c)));
        let left: f64 = values
            .iter()
            .map(|(s, w, t)| w * ((t[0] - side::value(&x, *s)).powi(2) + (t[1] - side::value(&y, *s)).powi(2)))
            .sum();
        let own = edge.triangles.into_iter().flatten().find(|t| shares.contains_key(t));
        if let Some(t) = own {
            let of_traction = Constants::new(mesh.corners(t)).of_traction(length);
            *oscillation.entry(t).or_default() += (length * left).sqrt() * of_traction;
        }
        functional.load.edges.push((e, x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()));
    }
}
