//! The contact pressure where it means something: its mean around the place where it is largest, with a bound.
//!
//! A pressure at a point is no bounded functional of the loads: on coarse triangles of high degree the largest one is off by a
//! fifth where forces are right to a thousandth. A mean with a weight φ is one. Let φ fall from 1 to 0 within a radius R of a vertex of
//! Γ_K, linear between the vertices of the mesh, and w = φ n the displacement that moves the first side there along the
//! direction n of contact. The exact stresses and λ_h are in equilibrium with the same loads, and where supports and other contacts
//! let w pass,
//!
//! |∫ (t_h − t) φ n·n̂| = |∫ (λ_h − λ) : e(w)| ≤ ‖λ_h − λ‖_a ‖e(w)‖_c ≤ √(2·gap) ‖e(w)‖_c.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::pressure::Piece;
use crate::problem::{Condition, ContactPair, Interface, Problem};
use crate::vector::{distance, dot};

/// The radius, in parts of the length that carries pressure: of Hertz's pressure, half of the contact modelled, the mean is half a
/// per cent below the peak.
const RADIUS: f64 = 0.25;

/// Cosines within this of 0 are.
const ALIGNED: f64 = 1e-9;

/// Cosine of the angle between directions of contact beyond which they have no common one.
const ONE_WAY: f64 = 0.5;

/// A mean pressure with how far it can be from the exact one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeanPressure {
    /// ∫ p φ / ∫ φ of the dual solution.
    pub value: f64,
    /// The exact mean is no farther away on either side, from the energy bracket; `null` without an upper bound.
    pub half_width: Option<f64>,
    /// The vertex in the middle, where φ = 1.
    pub at: [f64; 2],
    /// Where φ is zero: so far away and farther.
    pub radius: f64,
}

/// The mean of the pressure `own` of λ_h around the vertex next to `at`; `carries` is the length that carries pressure, `gap`
/// that between the bounds. `None` where nothing presses, or a support or another contact holds that vertex.
pub fn around(
    problem: &Problem,
    (index, interface): (usize, &Interface),
    own: &[Piece],
    at: [f64; 2],
    carries: f64,
    gap: f64,
) -> Option<MeanPressure> {
    let mesh = &problem.mesh;
    let ends = interface.pairs.iter().flat_map(|pair| pair.first.into_iter().zip(pair.direction.ends));
    let nearest = |a: &(usize, [f64; 2]), b: &(usize, [f64; 2])| {
        distance(mesh.points[a.0], at).total_cmp(&distance(mesh.points[b.0], at))
    };
    let (middle, n) = ends.min_by(nearest)?;
    let centre = mesh.points[middle];
    let beside = interface.pairs.iter().filter(|pair| pair.first.contains(&middle));
    let radius = beside.map(|pair| pair.length).fold(RADIUS * carries, f64::max);
    let weight = Weight::new(problem, index, (middle, n), radius)?;
    let (mut pressure, mut whole) = (0.0, 0.0);
    for (pair, piece) in interface.pairs.iter().zip(own) {
        let along = weight.along(pair)?;
        pressure += pair.length * piece.integral(&along);
        whole += pair.length * along.iter().sum::<f64>() / along.len() as f64;
    }
    if carries <= 0.0 || whole <= 0.0 {
        return None;
    }
    let bound = (2.0 * gap / problem.scene.thickness).sqrt() * weight.size() / whole;
    Some(MeanPressure {
        value: pressure / whole,
        half_width: Some(bound).filter(|bound| bound.is_finite()),
        at: problem.scene.as_written(centre),
        radius,
    })
}

/// φ at the vertices, and the direction n.
struct Weight<'a> {
    problem: &'a Problem,
    at: Vec<f64>,
    n: [f64; 2],
}

impl<'a> Weight<'a> {
    /// φ around the vertex `middle` of the first side of interface `index`; `None` where w is not free to move there.
    fn new(problem: &'a Problem, index: usize, (middle, n): (usize, [f64; 2]), radius: f64) -> Option<Self> {
        let mesh = &problem.mesh;
        let (piece, _) = mesh.pieces();
        let mut at = vec![0.0; mesh.points.len()];
        let own = (0..mesh.triangles.len()).find(|t| mesh.triangles[*t].contains(&middle)).map(|t| piece[t]);
        for (_, corners) in mesh.triangles.iter().enumerate().filter(|(t, _)| Some(piece[*t]) == own) {
            for &v in corners {
                at[v] = (1.0 - distance(mesh.points[v], mesh.points[middle]) / radius).max(0.0);
            }
        }
        for (e, condition) in problem.conditions.iter().enumerate() {
            let across = |d: [f64; 2]| dot(n, d).abs() > ALIGNED;
            let stops = match condition {
                Condition::Interior | Condition::Traction(_) => false,
                Condition::Clamped(_) | Condition::Axis | Condition::Elastic { .. } => true,
                Condition::Contact { interface, side: 0, .. } if *interface == index => false,
                Condition::Roller { direction, .. } => across(*direction),
                Condition::Contact { .. } => across(mesh.edge_frame(e).1),
            };
            if stops {
                mesh.edges[e].vertices.iter().for_each(|v| at[*v] = 0.0);
            }
        }
        (at[middle] > 0.0).then_some(Weight { problem, at, n })
    }

    /// Bernstein coefficients of φ n·n̂ along a pair; `None` where contact acts along another direction.
    fn along(&self, pair: &ContactPair) -> Option<[f64; 3]> {
        let [a, b] = pair.first.map(|v| self.at[v]);
        let [m, n] = pair.direction.ends.map(|d| dot(self.n, d) / dot(d, d).sqrt());
        let is_one_way = (a == 0.0 && b == 0.0) || m.min(n) > ONE_WAY * dot(self.n, self.n).sqrt();
        is_one_way.then(|| {
            let [m, n] = pair.direction.ends.map(|d| dot(self.n, d));
            [a * m, 0.5 * (a * n + b * m), b * n]
        })
    }

    /// ‖e(w)‖_c, per thickness.
    fn size(&self) -> f64 {
        let mesh = &self.problem.mesh;
        let materials = self.problem.materials();
        let square = |(t, corners): (usize, &[usize; 3])| {
            let phi = corners.map(|v| self.at[v]);
            if phi == [0.0; 3] {
                return 0.0;
            }
            let [p, q, r] = mesh.corners(t);
            let area = mesh.area(t);
            let twice = 2.0 * area;
            let g = [
                (phi[0] * (q[1] - r[1]) + phi[1] * (r[1] - p[1]) + phi[2] * (p[1] - q[1])) / twice,
                (phi[0] * (r[0] - q[0]) + phi[1] * (p[0] - r[0]) + phi[2] * (q[0] - p[0])) / twice,
            ];
            let n = self.n;
            let e = [n[0] * g[0], n[1] * g[1], 0.5 * (n[0] * g[1] + n[1] * g[0])];
            area * materials[mesh.body[t]].strain_product(e, e)
        };
        mesh.triangles.iter().enumerate().map(square).sum::<f64>().sqrt()
    }
}
