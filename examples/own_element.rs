//! An element of one's own in one file: quadratic stresses on the split triangle, found by plain linear algebra.
//!
//! Nodal values are the unknowns. Equilibrium is a list of equations in them, the self-equilibrated fields are its null space, and a
//! QR factor makes an energy-orthonormal basis. `hypercircle::element::block(2)` is the same space by formulas that bear
//! flat triangles. Run with `cargo run --release --example own_element`.

use std::error::Error;
use std::path::Path;

use hypercircle::bounds::complementary;
use hypercircle::dual::{self, Condensed, DualError, DualSolution, Options};
use hypercircle::element::polynomial::quadrature::triangle_rule;
use hypercircle::element::{Elements, EquilibriumElement, Material, Modes, ModesMut, block};
use hypercircle::load::{BodyForce, balancing};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use nalgebra::{DMatrix, DVector};

/// The element.
pub struct Plain;

/// One for the whole program: the elements of a solve are borrowed for ever.
pub static PLAIN: Plain = Plain;

const DEGREE: usize = 2;
/// Nodes of a subtriangle, by the two corners they lie between, in the order of `StressField::block`.
const NODES: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
/// Nodal values: xx, yy, xy at each node of each subtriangle.
const VALUES: usize = 3 * 6 * 3;
const TRACTIONS: usize = 6 * (DEGREE + 1);
const MODES: usize = TRACTIONS - 3;
/// Singular values below this part of the largest are zero.
const ZERO: f64 = 1e-9;

impl EquilibriumElement for Plain {
    fn name(&self) -> &'static str {
        "plain quadratic block"
    }

    fn degree(&self) -> usize {
        DEGREE
    }

    fn parameters(&self) -> usize {
        MODES
    }

    /// The nodal values of all modes and of λ̄.
    fn kept(&self) -> usize {
        (MODES + 1) * VALUES
    }

    fn compute(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce, out: ModesMut<'_>) {
        let parts = [0, 1, 2].map(|sub| Part::new(corners, sub));
        let (energy, traction) = (energy(&parts, material), tractions(&parts));
        let balanced = null_space(&equations(&parts));
        // Fields without traction come first: modes are what is left of the others by them.
        let [carrying, idle] = row_and_null_space(&(&traction * &balanced));
        let mut columns = idle.column_iter().map(|c| c.into_owned()).collect::<Vec<_>>();
        columns.extend(carrying.column_iter().map(|c| c.into_owned()));
        let basis = balanced * DMatrix::from_columns(&columns);
        let r = (&energy * &basis).qr().r();
        let fields = r.transpose().solve_lower_triangular(&basis.transpose()).map_or(basis, |f| f.transpose());
        let modes = fields.columns(columns.len() - MODES, MODES).into_owned();

        let force = force.about_centroid(corners);
        let mut particular = DVector::zeros(VALUES);
        for (sub, part) in parts.iter().enumerate() {
            for (node, between) in NODES.iter().enumerate() {
                for (c, stress) in balancing(&force, part.middle(*between)).into_iter().enumerate() {
                    particular[value(sub, node, c)] = stress;
                }
            }
        }
        particular -= &fields * ((&energy * &fields).transpose() * (&energy * &particular));

        out.traction.copy_from_slice((&traction * &modes).as_slice());
        out.particular_traction.copy_from_slice((&traction * &particular).as_slice());
        *out.particular_energy = (&energy * &particular).norm_squared();
        let (kept, last) = out.kept.split_at_mut(MODES * VALUES);
        kept.copy_from_slice(modes.as_slice());
        last.copy_from_slice(particular.as_slice());
    }

    fn stresses(
        &self,
        _: [[f64; 2]; 3],
        _: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        particular: f64,
        out: &mut [[f64; 3]],
    ) {
        let factors = s.iter().chain([&particular]);
        let values = out.as_flattened_mut();
        values.fill(0.0);
        for (field, factor) in modes.kept().chunks_exact(VALUES).zip(factors) {
            values.iter_mut().zip(field).for_each(|(v, f)| *v += factor * f);
        }
    }
}

/// Where a nodal value stands.
fn value(sub: usize, node: usize, component: usize) -> usize {
    3 * (6 * sub + node) + component
}

/// A subtriangle (a_{i+1}, a_{i+2}, centroid), counted from the centroid.
struct Part {
    corners: [[f64; 2]; 3],
    area: f64,
    /// Gradients of the barycentric coordinates.
    gradients: [[f64; 2]; 3],
}

impl Part {
    fn new(a: [[f64; 2]; 3], sub: usize) -> Self {
        let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0);
        let from_centre = |p: [f64; 2]| [p[0] - centre[0], p[1] - centre[1]];
        let [p, q] = [from_centre(a[(sub + 1) % 3]), from_centre(a[(sub + 2) % 3])];
        let twice = p[0] * q[1] - p[1] * q[0];
        let gradients = [[q[1], -q[0]], [-p[1], p[0]], [p[1] - q[1], q[0] - p[0]]].map(|g| g.map(|x| x / twice));
        Part { corners: [p, q, [0.0; 2]], area: 0.5 * twice, gradients }
    }

    fn middle(&self, [i, j]: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|c| 0.5 * (self.corners[i][c] + self.corners[j][c]))
    }
}

/// Quadratic shape functions.
fn shapes(l: [f64; 3]) -> [f64; 6] {
    NODES.map(|[i, j]| if i == j { l[i] * (2.0 * l[i] - 1.0) } else { 4.0 * l[i] * l[j] })
}

/// The coefficients of τn in the nodal values of a node: rows x and y, columns xx, yy, xy.
fn of_normal([x, y]: [f64; 2]) -> [[f64; 3]; 2] {
    [[x, 0.0, y], [0.0, y, x]]
}

/// div τ = 0 at the corners of every subtriangle, where a linear function is told, and continuous tractions at three points of
/// each inner segment.
fn equations(parts: &[Part; 3]) -> DMatrix<f64> {
    let mut rows = Vec::new();
    for (sub, part) in parts.iter().enumerate() {
        for corner in 0..3 {
            let at = |i: usize| f64::from(i == corner);
            for c in 0..2 {
                let mut row = DVector::zeros(VALUES);
                for (node, [i, j]) in NODES.into_iter().enumerate() {
                    let (a, b) =
                        if i == j { (2.0 * at(i) - 0.5, 2.0 * at(i) - 0.5) } else { (4.0 * at(j), 4.0 * at(i)) };
                    let slope = [0, 1].map(|k| a * part.gradients[i][k] + b * part.gradients[j][k]);
                    let of = of_normal(slope)[c];
                    (0..3).for_each(|k| row[value(sub, node, k)] = part.area.sqrt() * of[k]);
                }
                rows.push(row.transpose());
            }
        }
        // The segment from a_{i+2} to the centroid: nodes on it here and on the next subtriangle.
        let [x, y] = part.corners[1];
        let n = of_normal([y / x.hypot(y), -x / x.hypot(y)]);
        for (own, other) in [(3, 0), (4, 2), (5, 5)] {
            for n in n {
                let mut row = DVector::zeros(VALUES);
                for k in 0..3 {
                    row[value(sub, own, k)] = n[k];
                    row[value((sub + 1) % 3, other, k)] = -n[k];
                }
                rows.push(row.transpose());
            }
        }
    }
    DMatrix::from_rows(&rows)
}

/// Bernstein coefficients of the tractions on the three sides, from nodal values.
fn tractions(parts: &[Part; 3]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(TRACTIONS, VALUES);
    for (sub, part) in parts.iter().enumerate() {
        let [p, q, _] = part.corners;
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let n = of_normal([dy / dx.hypot(dy), -dx / dx.hypot(dy)]);
        // Values at both ends and in the middle to coefficients.
        for (k, weights) in [[1.0, 0.0, 0.0], [-0.5, 2.0, -0.5], [0.0, 0.0, 1.0]].into_iter().enumerate() {
            for (node, weight) in [0, 1, 3].into_iter().zip(weights) {
                for (c, n) in n.iter().enumerate() {
                    for (component, n) in n.iter().enumerate() {
                        matrix[(2 * ((DEGREE + 1) * sub + k) + c, value(sub, node, component))] += weight * n;
                    }
                }
            }
        }
    }
    matrix
}

/// ∫ a τ:τ is |E x|² for the nodal values x.
fn energy(parts: &[Part; 3], material: &Material) -> DMatrix<f64> {
    let rule = triangle_rule(2 * DEGREE);
    let roots = material.roots();
    let mut matrix = DMatrix::zeros(9 * rule.len(), VALUES);
    let mut row = 0;
    for (sub, part) in parts.iter().enumerate() {
        for &(l, weight) in rule {
            let root = (weight * part.area / material.unit()).sqrt();
            for (node, shape) in shapes(l).into_iter().enumerate() {
                for (c, unit) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
                    for (i, part) in roots.apply(unit).into_iter().enumerate() {
                        matrix[(row + i, value(sub, node, c))] = root * part * shape;
                    }
                }
            }
            row += 3;
        }
    }
    matrix
}

/// Orthonormal bases of the vectors that a matrix sees, and of those that it does not.
fn row_and_null_space(matrix: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let columns = matrix.ncols();
    // As many rows as columns, so that all singular vectors are computed.
    let square = matrix.clone().resize_vertically(columns.max(matrix.nrows()), 0.0);
    let svd = square.svd(false, true);
    let vectors = svd.v_t.unwrap_or_default().transpose();
    let least = ZERO * svd.singular_values.max();
    let of = |seen: bool| (0..columns).filter(|&k| (svd.singular_values[k] > least) == seen).collect::<Vec<_>>();
    [true, false].map(|seen| vectors.select_columns(&of(seen)))
}

fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let [_, null] = row_and_null_space(matrix);
    null
}

/// The solution with an element on every triangle.
///
/// # Errors
/// As [`dual::solve`].
pub fn solution(problem: &Problem, element: &'static dyn EquilibriumElement) -> Result<DualSolution, DualError> {
    let options = Options { elements: Elements::Uniform(element), ..Options::default() };
    dual::solve(&Condensed::default(), problem, &[], &options)
}

#[allow(dead_code)]
fn main() -> Result<(), Box<dyn Error>> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/two_blocks.toml");
    let problem = Problem::load(Scene::read(&scene)?)?;
    for element in [&PLAIN as &'static dyn EquilibriumElement, block(DEGREE)] {
        let lower = complementary(&problem, &solution(&problem, element)?.stress).lower();
        println!("{}: {lower:.12}", element.name());
    }
    Ok(())
}
