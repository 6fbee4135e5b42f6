//! Stress intensities at the tip of a crack.
//!
//! With the field w of power r^(−1/2) that has free faces, scaled so that ∮ (T(w)·u_I − T(u_I)·w) = 1 for K = 1 on a circle with the normal
//! towards the tip, and η = 1 at the tip and 0 away from it,
//!
//! K = ∫ (σ(w)∇η)·u − ∫ σ(u) : sym(w ⊗ ∇η) + ∫ F·ηw.
//!
//! η is linear on triangles and 1 on those of a set P about the tip. On the others σ(w)∇η is integrated by parts, so that
//!
//! K = −∫_{Ω∖P} σ(u) : e(ηw) + ∮_{∂P} σ(w)n·u + ∫ F·ηw:
//!
//! an initial strain and tractions along edges, analytic on each triangle, and projected. On a half model with a roller ahead of the tip
//! the circle is half of one.

mod place;
mod williams;

use std::f64::consts::PI;

pub use self::place::NoTip;
use self::place::Place;
use self::williams::Williams;
use super::adjoint::constants::Constants;
use super::functional::Functional;
use super::functional::projection::projected;
use super::point::Disc;
use crate::bounds::{Sum, side_coefficients};
use crate::dual::ShapedStrain;
use crate::element::geometry::gradients;
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::polynomial::side;
use crate::element::{Displacement, contraction};
use crate::problem::Problem;
use crate::scene::Mode;

/// Relative remainders of integrals.
const EXACT: f64 = 1e-17;

/// Most points in one direction.
const MOST_POINTS: f64 = 40.0;

/// The stress intensity at a tip.
#[derive(Debug, Clone)]
pub struct Tip {
    place: Place,
    field: Williams,
}

impl Tip {
    /// The stress intensity of `mode` at `tip`.
    ///
    /// # Errors
    /// [`NoTip`].
    pub fn new(problem: &Problem, mode: Mode, tip: [f64; 2]) -> Result<Self, NoTip> {
        let place = Place::new(problem, mode, tip);
        // What no mesh mends is said first.
        let body = match &place {
            Ok(place) => place.body,
            Err(NoTip::Coarse { body, .. }) => *body,
            Err(other) => return Err(other.clone()),
        };
        let material = problem.materials()[body];
        let Some([kappa, gamma]) = material.pressure_and_shear() else {
            return Err(NoTip::Anisotropic { body: problem.scene.bodies[body].name.clone() });
        };
        if !problem.scene.bodies[body].initial.is_none() {
            return Err(NoTip::Strained { body: problem.scene.bodies[body].name.clone() });
        }
        let place = place?;
        let constants = [0.25 * material.unit() / kappa, material.unit() / gamma];
        let span = if place.half { [0.0, PI] } else { [-PI, PI] };
        Ok(Tip { field: Williams::extracting(mode, constants, span), place })
    }

    /// w at a point.
    fn displacement(&self, at: [f64; 2]) -> [f64; 2] {
        let [first, second] = self.place.axes;
        let [a, b] = self.field.displacement(self.place.seen(at));
        [a * first[0] + b * second[0], a * first[1] + b * second[1]]
    }

    /// σ(w) at a point.
    fn stress(&self, at: [f64; 2]) -> [f64; 3] {
        let [p, q] = self.place.axes;
        let [a, b, c] = self.field.stress(self.place.seen(at));
        let entry = |i: usize, j: usize| a * p[i] * p[j] + b * q[i] * q[j] + c * (p[i] * q[j] + q[i] * p[j]);
        [entry(0, 0), entry(1, 1), entry(0, 1)]
    }

    /// Points of a triangle, beside polynomials up to `degree` for w, with their values of −e(ηw).
    fn strains(&self, problem: &Problem, (t, eta): (usize, [f64; 3]), degree: usize) -> Strained {
        let material = problem.materials()[self.place.body];
        let corners = problem.mesh.corners(t);
        let g = gradients(corners);
        let slope = [0, 1].map(|c| (0..3).map(|i| eta[i] * g[i][c]).sum::<f64>());
        let points = points(self.place.away(corners)).ceil() as usize;
        let spots = Disc { middle: self.place.at, radius: 0.0 }.all(corners, degree + 2 * points);
        let chi = spots
            .iter()
            .map(|spot| {
                let at = [0, 1].map(|c| spot.from_middle[c] + self.place.at[c]);
                let value = eta[0] + (0..2).map(|c| slope[c] * (at[c] - corners[0][c])).sum::<f64>();
                let (w, own) = (self.displacement(at), material.strain(self.stress(at)));
                let turned = [w[0] * slope[0], w[1] * slope[1], 0.5 * (w[0] * slope[1] + w[1] * slope[0])];
                [0, 1, 2].map(|c| -value * own[c] - turned[c])
            })
            .collect();
        Strained { spots, chi }
    }

    /// −∫ σ : e(ηw).
    pub fn strained(
        &self,
        problem: &Problem,
        degree: impl Fn(usize) -> usize,
        mut at: impl FnMut(usize, usize, [f64; 3]) -> [f64; 3],
    ) -> f64 {
        let mut sum = Sum::default();
        for &(t, eta) in &self.place.triangles {
            let Strained { spots, chi } = self.strains(problem, (t, eta), degree(t));
            for (spot, chi) in spots.iter().zip(&chi) {
                sum.add(spot.weight * contraction(*chi, at(t, spot.sub, spot.l)));
            }
        }
        sum.value()
    }

    /// ∮ σ(w)n·v.
    pub fn displaced(&self, problem: &Problem, v: &Displacement) -> f64 {
        let mut sum = Sum::default();
        for &(e, sign) in &self.place.edges {
            let (length, _) = problem.mesh.edge_frame(e);
            let u = side_coefficients(problem, v, e);
            let [x, y] = [0, 1].map(|c| side::component(&u, c));
            for (s, weight, t) in self.tractions(problem, (e, sign), u.len()) {
                sum.add(length * weight * (t[0] * side::value(&x, s) + t[1] * side::value(&y, s)));
            }
        }
        sum.value()
    }

    /// Points along an edge beside polynomials up to `degree`, with weights and σ(w)n.
    fn tractions(&self, problem: &Problem, (e, sign): (usize, f64), degree: usize) -> Vec<(f64, f64, [f64; 2])> {
        let (_, normal) = problem.mesh.edge_frame(e);
        let [a, b] = problem.mesh.edges[e].vertices.map(|v| problem.mesh.points[v]);
        let points = points(self.place.away([a, b, b])).ceil() as usize;
        let n = normal.map(|n| sign * n);
        let at = |(s, weight): &(f64, f64)| {
            let stress = self.stress([0, 1].map(|c| a[c] + s * (b[c] - a[c])));
            (*s, *weight, [stress[0] * n[0] + stress[2] * n[1], stress[2] * n[0] + stress[1] * n[1]])
        };
        segment_rule(degree + 2 * points).iter().map(at).collect()
    }

    /// Adds what the adjoint problem is loaded with to `functional`.
    pub fn load(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        stress_degree: impl Fn(usize) -> usize,
        edge_degree: impl Fn(usize) -> usize,
    ) {
        let material = problem.materials()[self.place.body];
        for &(t, eta) in &self.place.triangles {
            let (corners, degree) = (problem.mesh.corners(t), stress_degree(t));
            let Strained { spots, chi } = self.strains(problem, (t, eta), 2 * degree);
            let found = projected(corners, &material, degree, (&spots, true), &chi);
            functional.load.shaped.push(ShapedStrain { triangle: t, strain: found.field });
            functional.rests.push(found.rest);
        }
        for &(e, sign) in &self.place.edges {
            let degree = edge_degree(e);
            let values = self.tractions(problem, (e, sign), 2 * degree);
            let moments = |c: usize| -> Vec<f64> {
                let of = |k: usize| values.iter().map(|(s, w, t)| w * t[c] * side::bernstein(degree, k, *s)).sum();
                (0..=degree).map(of).collect()
            };
            let [x, y] = [0, 1].map(|c| side::from_moments(&moments(c)));
            let left: f64 = values
                .iter()
                .map(|(s, w, t)| w * ((t[0] - side::value(&x, *s)).powi(2) + (t[1] - side::value(&y, *s)).powi(2)))
                .sum();
            let (length, _) = problem.mesh.edge_frame(e);
            if let Some(t) = problem.mesh.edges[e].triangles[0] {
                let constant = Constants::new(problem.mesh.corners(t)).of_traction(length);
                functional.oscillation.push((t, (length * left).sqrt() * constant));
            }
            functional.load.edges.push((e, x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()));
        }
    }

    /// ∫ F·ηw, which is known.
    pub fn of_body_force(&self, problem: &Problem) -> f64 {
        let force = problem.scene.bodies[self.place.body].body_force;
        if force.is_none() {
            return 0.0;
        }
        let mut sum = Sum::default();
        let of = |at: [f64; 2]| {
            let (f, w) = (force.at(at), self.displacement(at));
            f[0] * w[0] + f[1] * w[1]
        };
        for &(t, eta) in self.place.triangles.iter().chain(&self.place.inner) {
            let corners = problem.mesh.corners(t);
            if let Some(i) = corners.iter().position(|p| *p == self.place.at) {
                // Of power r^(−1/2) at a corner: polynomial in the root of the distance.
                let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
                let area = problem.mesh.area(t);
                for (root, along) in segment_rule(40) {
                    for (q, across) in segment_rule(40) {
                        let s = root * root;
                        let at = [0, 1].map(|d| a[d] + s * (b[d] + q * (c[d] - b[d]) - a[d]));
                        sum.add(4.0 * area * s * root * along * across * of(at));
                    }
                }
                continue;
            }
            let g = gradients(corners);
            let spots = Disc { middle: self.place.at, radius: 0.0 }.all(corners, MOST_POINTS as usize);
            for spot in spots {
                let at = [0, 1].map(|c| spot.from_middle[c] + self.place.at[c]);
                let from = [0, 1].map(|c| at[c] - corners[0][c]);
                let value = eta[0] + (0..3).map(|i| eta[i] * (g[i][0] * from[0] + g[i][1] * from[1])).sum::<f64>();
                sum.add(spot.weight * value * of(at));
            }
        }
        sum.value()
    }
}

/// Points of a triangle with strains.
struct Strained {
    spots: Vec<super::point::Spot>,
    chi: Vec<[f64; 3]>,
}

/// Points in each direction for what is analytic up to `away` lengths from where it is integrated: the error of n points falls like ρ^(−2n),
/// ρ being the sum of the half-axes of the largest ellipse about the interval without a singular point.
fn points(away: f64) -> f64 {
    let half = 1.0 + 2.0 * away;
    let rho = half + (half * half - 1.0).sqrt();
    (-0.5 * EXACT.ln() / rho.ln()).min(MOST_POINTS)
}
