//! Errors on families of meshes, and the rates fitted to them.

use hypercircle::bounds::{admissible, complementary, potential};
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::element::polynomial::side;
use hypercircle::element::{
    Elements, Material, SideValues, StressField, block, interpolant, parameters_from_tractions,
};
use hypercircle::load::BodyForce;
use hypercircle::mesh::Triangulation;
use hypercircle::problem::Problem;
use hypercircle::scene::Kinematics;
use serde::{Deserialize, Serialize};

use super::contact::{Solution, free_motions};
use super::fields::{FIELDS, Stress};
use super::meshes::Family;
use super::quadrature::{gauss, stress_error, visit};

/// One quantity on one family of meshes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Study {
    /// The solution or field.
    pub solution: String,
    /// The family of meshes.
    pub family: String,
    /// The quantity that is measured.
    pub quantity: String,
    /// The rate that a theorem promises.
    pub promised: Option<f64>,
    /// Slope of log error against log h, least squares over all meshes.
    pub rate: f64,
    /// The errors.
    pub meshes: Vec<Measured>,
}

/// One mesh of a study.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Measured {
    /// Squares per side of a block.
    pub n: usize,
    /// Largest diameter of a triangle.
    pub h: f64,
    /// The error.
    pub error: f64,
}

/// Slope of log error against log h.
pub fn fitted(meshes: &[Measured]) -> f64 {
    let points: Vec<[f64; 2]> = meshes.iter().map(|m| [m.h.ln(), m.error.ln()]).collect();
    let mean = [0, 1].map(|c| points.iter().map(|p| p[c]).sum::<f64>() / points.len() as f64);
    let (mut above, mut below) = (0.0, 0.0);
    for p in points {
        above += (p[0] - mean[0]) * (p[1] - mean[1]);
        below += (p[0] - mean[0]).powi(2);
    }
    above / below
}

fn study(solution: &str, family: Family, quantity: &str, promised: Option<f64>, meshes: Vec<Measured>) -> Study {
    Study {
        solution: solution.to_string(),
        family: family.name().to_string(),
        quantity: quantity.to_string(),
        promised,
        rate: fitted(&meshes),
        meshes,
    }
}

fn corners(problem: &Problem) -> Vec<[[f64; 2]; 3]> {
    (0..problem.mesh.triangles.len()).map(|t| problem.mesh.corners(t)).collect()
}

fn diameter(corners: &[[[f64; 2]; 3]]) -> f64 {
    let side = |p: &[[f64; 2]; 3], i: usize| (p[i][0] - p[(i + 1) % 3][0]).hypot(p[i][1] - p[(i + 1) % 3][1]);
    corners.iter().flat_map(|p| [0, 1, 2].map(|i| side(p, i))).fold(0.0, f64::max)
}

/// Theorem 2.2: ‖τ − r_h τ‖ for fields that are not polynomial.
pub fn interpolation(sizes: &[usize]) -> Vec<Study> {
    let mut studies = Vec::new();
    for family in [Family::Squares, Family::Vaulted, Family::Shaken] {
        let meshes: Vec<_> = sizes.iter().map(|&n| (n, Solution::grazing().problem(n, family).mesh)).collect();
        for (name, stress) in FIELDS {
            let measured = meshes.iter().map(|(n, mesh)| {
                let corners: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
                let field = interpolant(mesh, |_, x| stress(x));
                let error = stress_error(&corners, &mesh.body, &field, |_, x| stress(x)).0;
                Measured { n: *n, h: diameter(&corners), error }
            });
            studies.push(study(name, family, "L2 error of r_h τ", Some(2.0), measured.collect()));
        }
    }
    studies
}

/// Degrees of which rates are measured.
pub const DEGREES: [usize; 4] = [1, 2, 3, 4];

/// The field of N(K) of degree `degree` on every triangle with the tractions of a stress, projected side by side.
fn projected(mesh: &Triangulation, degree: usize, stress: Stress) -> StressField {
    let (element, rule) = (block(degree), gauss(degree + 8));
    // Which of the fields with its tractions an element has hangs on the material; elastic stresses belong to all.
    let material = Material::isotropic(Kinematics::PlaneStrain, 1.0, 0.3);
    let mut field = StressField::zeros(degree, mesh.triangles.len());
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        let mut tractions = Vec::new();
        for i in 0..3 {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let n = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
            let mut moments = [vec![0.0; degree + 1], vec![0.0; degree + 1]];
            for &(s, w) in &rule {
                let tau = stress([a[0] + s * dx, a[1] + s * dy]);
                let value = [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]];
                for (moments, value) in moments.iter_mut().zip(value) {
                    moments.iter_mut().enumerate().for_each(|(k, m)| *m += w * value * side::bernstein(degree, k, s));
                }
            }
            let [x, y] = moments.map(|m| side::from_moments(&m));
            tractions.extend(x.into_iter().zip(y).flat_map(|(x, y)| [x, y]));
        }
        let modes = element.modes(corners, &material, &BodyForce::NONE);
        let (s, _) = parameters_from_tractions(&modes, &tractions).expect("no triangle is degenerate");
        element.stresses(corners, &BodyForce::NONE, &modes, &s, 0.0, field.block_mut(t));
    }
    field
}

/// The error of r_h of every degree for elastic stresses that are not polynomial.
pub fn interpolation_of_degrees(sizes: &[usize]) -> Vec<Study> {
    let mut studies = Vec::new();
    for family in [Family::Squares, Family::Shaken] {
        for degree in DEGREES {
            for (name, stress) in &FIELDS[..2] {
                let measured = sizes.iter().map(|&n| {
                    let mesh = Solution::grazing().problem(n, family).mesh;
                    let corners: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect();
                    let field = projected(&mesh, degree, *stress);
                    let mut square = 0.0;
                    visit(&corners, degree + 4, |t, sub, bary, x, w| {
                        let (l, e) = (field.at(t, sub, bary), stress(x));
                        let d = [l[0] - e[0], l[1] - e[1], l[2] - e[2]];
                        square += w * (d[0] * d[0] + d[1] * d[1] + 2.0 * d[2] * d[2]);
                    });
                    Measured { n, h: diameter(&corners), error: square.sqrt() }
                });
                let quantity = format!("L2 error of r_h τ, p = {degree}");
                studies.push(study(name, family, &quantity, Some((degree + 1) as f64), measured.collect()));
            }
        }
    }
    studies
}

/// The error of λ_h of every degree at a contact end like a root, on meshes that are not refined there.
pub fn contact_end_of_degrees(sizes: &[usize]) -> Vec<Study> {
    let (name, solution, _) = solutions()[2];
    let family = Family::Squares;
    let of = |degree: usize| {
        let measured = sizes.iter().map(|&n| {
            let problem = solution.problem(n, family);
            let corners = corners(&problem);
            let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
            let found =
                dual::solve(&Condensed::default(), &problem, &free_motions(&problem), &options).expect("solves");
            let mut square = 0.0;
            visit(&corners, 12, |t, sub, bary, x, w| {
                let (l, e) = (found.stress.at(t, sub, bary), solution.stress(problem.mesh.body[t], x));
                let d = [l[0] - e[0], l[1] - e[1], l[2] - e[2]];
                square += w * (d[0] * d[0] + d[1] * d[1] + 2.0 * d[2] * d[2]);
            });
            Measured { n, h: diameter(&corners), error: square.sqrt() }
        });
        study(name, family, &format!("L2 error of λ_h, p = {degree}"), None, measured.collect())
    };
    DEGREES.map(of).into()
}

/// Quantities measured on a contact solution, with the rate that a theorem promises if the contact pressure is in H².
const QUANTITIES: [(&str, Option<f64>); 7] = [
    ("L2 error of λ_h", Some(1.5)),
    ("L2 error of r_h τ⁰", Some(2.0)),
    ("largest error of λ_h at a quadrature point", None),
    ("L2 error of T_n on Γ_K", None),
    ("energy error of −Π(λ_h)", None),
    ("energy error of the free upper bound", None),
    ("energy norm of λ_h − τ⁰", Some(1.5)),
];

/// The errors of [`QUANTITIES`] on one mesh, after its mesh size.
pub fn contact_errors(solution: &Solution, n: usize, family: Family) -> (f64, [f64; 7]) {
    let problem = solution.problem(n, family);
    let corners = corners(&problem);
    let body = &problem.mesh.body;
    let exact = |b: usize, x: [f64; 2]| solution.stress(b, x);
    let found =
        dual::solve(&Condensed::default(), &problem, &free_motions(&problem), &Options::default()).expect("solves");
    assert!(found.equilibrium.residual() < 1e-9, "residual {}", found.equilibrium.residual());
    let (l2, largest) = stress_error(&corners, body, &found.stress, exact);
    let interpolated = stress_error(&corners, body, &interpolant(&problem.mesh, exact), exact).0;
    let (mut energy, mut distance) = (0.0, 0.0);
    visit(&corners, 6, |t, sub, bary, x, w| {
        let (tau, l) = (exact(body[t], x), found.stress.at(t, sub, bary));
        energy += 0.5 * w * solution.energy_density(body[t], tau);
        distance += w * solution.energy_density(body[t], [l[0] - tau[0], l[1] - tau[1], l[2] - tau[2]]);
    });
    let lower = complementary(&problem, &found.stress).lower();
    let upper = potential(&problem, &admissible(&problem, &found, lower, None).expect("an upper bound")).total();
    let errors = [
        l2,
        interpolated,
        largest,
        pressure_error(solution, &problem, &found.contact_traction),
        (lower + energy).abs(),
        (upper + energy).abs(),
        distance.sqrt(),
    ];
    (diameter(&corners), errors)
}

fn pressure_error(solution: &Solution, problem: &Problem, traction: &[SideValues<f64>]) -> f64 {
    let mut square = 0.0;
    for (pair, t) in problem.interfaces[0].pairs.iter().zip(traction[0].iter()) {
        let [a, b] = pair.first.map(|v| problem.mesh.points[v]);
        for (s, w) in gauss(8) {
            let exact = solution.stress(0, [0, 1].map(|c| a[c] + s * (b[c] - a[c])))[0];
            square += w * pair.length * (side::value(t, s) - exact).powi(2);
        }
    }
    square.sqrt()
}

/// Names of the contact solutions; the theorem's assumptions hold for all but the last.
pub fn solutions() -> [(&'static str, Solution, bool); 3] {
    [
        ("pressed, pressure grazing zero", Solution::grazing(), true),
        ("lift-off, pressure in H²", Solution::lift_off(), true),
        ("lift-off, pressure like a root", Solution::rough(), false),
    ]
}

/// Theorem 2.3, and the energies.
pub fn contact(sizes: &[usize]) -> Vec<Study> {
    let mut studies = Vec::new();
    for (name, solution, smooth) in solutions() {
        for family in [Family::Squares, Family::Vaulted] {
            let runs: Vec<_> = sizes.iter().map(|&n| (n, contact_errors(&solution, n, family))).collect();
            for (k, (quantity, promised)) in QUANTITIES.into_iter().enumerate() {
                let measured = runs.iter().map(|&(n, (h, errors))| Measured { n, h, error: errors[k] }).collect();
                studies.push(study(name, family, quantity, promised.filter(|_| smooth), measured));
            }
        }
    }
    studies
}
