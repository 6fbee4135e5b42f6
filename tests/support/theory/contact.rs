//! Contact problems whose solution is known, and their discrete counterparts.
//!
//! Both have the layout of Theorem 2.3: two unit blocks with Γ_K on x = 0, Γ_0 on y = 0. The exact tractions on Γ_τ are
//! not linear; their side-wise L² projections are prescribed, which is what r_h does on an edge.

use hypercircle::dual::Motion;
use hypercircle::mesh::Triangulation;
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::*;
use hypercircle::statics;

use super::meshes::{self, Family};
use super::quadrature::gauss;
use super::westergaard::Westergaard;

/// E and ν of the left and the right body.
pub type Materials = [(f64, f64); 2];

/// A known solution, in plane strain.
#[derive(Debug, Clone, Copy)]
pub enum Solution {
    /// Closed all along, right body clamped at x = 1, different materials.
    Pressed(Pressed),
    /// Contact above, lift-off below.
    LiftOff(Westergaard),
}

impl Solution {
    /// Touching on the whole of Γ_K, with a pressure that grazes zero at an inner point.
    pub fn grazing() -> Self {
        Solution::Pressed(Pressed::new([(1.0, 0.3), (2.0, 0.2)], 4.1, 1.0))
    }

    /// Lift-off below y = 0.4, T_n in H².
    pub fn lift_off() -> Self {
        Solution::LiftOff(Westergaard { exponent: 2.5, tip: 0.4, young: 1.0, poisson: 0.3 })
    }

    /// Lift-off with T_n like the root of the distance from the contact end: not in H².
    pub fn rough() -> Self {
        Solution::LiftOff(Westergaard { exponent: 0.5, tip: 0.4, young: 1.0, poisson: 0.3 })
    }

    pub fn materials(&self) -> Materials {
        match self {
            Solution::Pressed(p) => p.materials,
            Solution::LiftOff(w) => [(w.young, w.poisson); 2],
        }
    }

    /// (xx, yy, xy).
    pub fn stress(&self, body: usize, x: [f64; 2]) -> [f64; 3] {
        match self {
            Solution::Pressed(p) => p.stress(body, x),
            Solution::LiftOff(w) => w.stress(x),
        }
    }

    pub fn displacement(&self, body: usize, x: [f64; 2]) -> [f64; 2] {
        match self {
            Solution::Pressed(p) => p.displacement(body, x),
            Solution::LiftOff(w) => w.displacement(body, x),
        }
    }

    /// a τ:τ from α, β, γ after (3.2).
    pub fn energy_density(&self, body: usize, tau: [f64; 3]) -> f64 {
        let (e, nu) = self.materials()[body];
        let (alpha, beta, gamma) = (1.0 - nu * nu, -nu * (1.0 + nu), 2.0 * (1.0 + nu));
        (alpha * (tau[0] * tau[0] + tau[1] * tau[1]) + 2.0 * beta * tau[0] * tau[1] + gamma * tau[2] * tau[2]) / e
    }

    fn scene(&self) -> Scene {
        let materials = self.materials();
        let body = |k: usize, name: &str| Body::isotropic(name, materials[k].0, materials[k].1);
        let support = |on: &str, kind| Support { on: on.to_string(), kind };
        let other = match self {
            Solution::Pressed(_) => support("right_east", SupportKind::CLAMPED),
            Solution::LiftOff(_) => support("right_south", SupportKind::ROLLER),
        };
        let draft = Draft {
            bodies: vec![body(0, "left"), body(1, "right")],
            supports: vec![support("left_south", SupportKind::ROLLER), other],
            tractions: Vec::new(),
            contacts: vec![Contact::new(
                ContactSides::Between(["left_east".to_string(), "right_west".to_string()]),
                Gap::Constant(0.0),
            )],
            ..Draft::new("known_solution", Kinematics::PlaneStrain, MeshSource::File("made".into()))
        };
        Scene::new(draft).expect("a valid scene")
    }

    /// The discrete problem on an n × n mesh of each block.
    pub fn problem(&self, n: usize, family: Family) -> Problem {
        let scene = self.scene();
        let raw = meshes::blocks(n, family, meshes::side_by_side);
        let (mesh, notes) = Triangulation::new(raw, &scene).expect("a valid mesh");
        let mut problem = Problem::new(scene, mesh, notes).expect("a valid problem");
        let rule = gauss(8);
        for e in 0..problem.mesh.edges.len() {
            let Condition::Traction(ends) = &mut problem.conditions[e] else { continue };
            let (_, normal) = problem.mesh.edge_frame(e);
            let edge = &problem.mesh.edges[e];
            let body = problem.mesh.body[edge.triangles[0].expect("a boundary edge has a triangle")];
            let [a, b] = edge.vertices.map(|v| problem.mesh.points[v]);
            // Moments against the hat functions, and the inverse of their mass matrix.
            let mut moment = [[0.0; 2]; 2];
            for &(s, w) in &rule {
                let tau = self.stress(body, [0, 1].map(|c| a[c] + s * (b[c] - a[c])));
                let t = [tau[0] * normal[0] + tau[2] * normal[1], tau[2] * normal[0] + tau[1] * normal[1]];
                for c in 0..2 {
                    moment[0][c] += w * (1.0 - s) * t[c];
                    moment[1][c] += w * s * t[c];
                }
            }
            for c in 0..2 {
                ends[0][c] = 4.0 * moment[0][c] - 2.0 * moment[1][c];
                ends[1][c] = 4.0 * moment[1][c] - 2.0 * moment[0][c];
            }
        }
        problem
    }
}

/// The rigid motions that supports and contact leave free both ways.
pub fn free_motions(problem: &Problem) -> Vec<Motion> {
    let found = statics::check(problem).expect("statics are decided");
    found.held.iter().map(|m| m.at_vertices(problem, &found.components)).collect()
}

/// φ = f(x) cos ky + constant pressure, on each body: separated biharmonic functions with
/// f = a cosh ξ + b sinh ξ + c ξ cosh ξ + d ξ sinh ξ, ξ = kx.
///
/// On x = 0 both bodies have T_t = 0, T_n = −p − p cos ky, and the same u1. The right one has u = 0 on x = 1, both have
/// u2 = 0 and T_t = 0 on y = 0.
#[derive(Debug, Clone, Copy)]
pub struct Pressed {
    pub materials: Materials,
    k: f64,
    pressure: f64,
    /// a, b, c, d of the left and the right body.
    f: [[f64; 4]; 2],
}

impl Pressed {
    pub fn new(materials: Materials, k: f64, pressure: f64) -> Self {
        let mu = materials.map(|(e, nu)| e / (2.0 * (1.0 + nu)));
        let plus = materials.map(|(_, nu)| 4.0 - 4.0 * nu);
        // −k² f(0) = −p, f'(0) = 0.
        let a = pressure / (k * k);
        // Right body: u1 = u2 = 0 at x = 1 fixes c = −b and d. Rows as in `displacement`.
        let (ch, sh, half) = (k.cosh(), k.sinh(), 0.5 * plus[1]);
        let row1 = [-(ch + k * sh) + ch + half * ch, -(sh + k * ch) + half * sh];
        let row2 = [k * ch - sh + half * sh, k * sh + half * ch];
        let (r1, r2) = (a * sh, -a * ch);
        let determinant = row1[0] * row2[1] - row1[1] * row2[0];
        let c = (r1 * row2[1] - row1[1] * r2) / determinant;
        let d = (row1[0] * r2 - r1 * row2[0]) / determinant;
        let right = [a, -c, c, d];
        // u1 on x = 0 is (κ+1) k c / (4 μ) cos ky.
        let c = c * plus[1] / mu[1] * mu[0] / plus[0];
        Pressed { materials, k, pressure, f: [[a, -c, c, 0.01], right] }
    }

    fn stress(&self, body: usize, [x, y]: [f64; 2]) -> [f64; 3] {
        let [a, b, c, d] = self.f[body];
        let (k, xi) = (self.k, self.k * x);
        let (ch, sh) = (xi.cosh(), xi.sinh());
        let f = a * ch + b * sh + xi * (c * ch + d * sh);
        let slope = a * sh + b * ch + c * (ch + xi * sh) + d * (sh + xi * ch);
        let second = f + 2.0 * (c * sh + d * ch);
        let (sin, cos) = (k * y).sin_cos();
        let nu = self.materials[body].1;
        let p = self.pressure;
        [-k * k * f * cos - p, k * k * second * cos - p * nu / (1.0 - nu), k * k * slope * sin]
    }

    fn displacement(&self, body: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c, d] = self.f[body];
        let (k, xi) = (self.k, self.k * x);
        let (ch, sh) = (xi.cosh(), xi.sinh());
        let f = a * ch + b * sh + xi * (c * ch + d * sh);
        let slope = a * sh + b * ch + c * (ch + xi * sh) + d * (sh + xi * ch);
        let modulus = |m: usize| {
            let (e, nu) = self.materials[m];
            e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
        };
        let (e, nu) = self.materials[body];
        let (twice_mu, half) = (e / (1.0 + nu), 2.0 - 2.0 * nu);
        let (sin, cos) = (k * y).sin_cos();
        let u1 = k * (half * (c * ch + d * sh) - slope) * cos / twice_mu;
        let u2 = k * (f + half * (c * sh + d * ch)) * sin / twice_mu;
        [u1 + self.pressure * (1.0 / modulus(1) - x / modulus(body)), u2]
    }
}
