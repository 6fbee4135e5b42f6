//! The constant c(α) of (2.10), exactly.
//!
//! For one triangle it is the largest value of a component of τ at a corner of a subtriangle, over all loads t in
//! [−1, 1]¹² (values at the ends of the sides; T⁰ is linear) with G t = 0 (equilibrium). By duality
//!
//! max { r·t : |t_i| ≤ 1, G t = 0 } = min over y in R³ of Σ |r − Gᵀy|_i,
//!
//! and the minimum is taken where three of the twelve terms vanish: all 220 choices are tried.

use hypercircle::element::{Block, EquilibriumElement, Material, Section};
use hypercircle::load::BodyForce;
use hypercircle::scene::Kinematics;
use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};
use serde::{Deserialize, Serialize};

use super::Numbers;

/// A triangle of area 1 or so with angles α, β and its first side turned by θ (degrees).
pub fn triangle_with_angles(alpha: f64, beta: f64, theta: f64) -> [[f64; 2]; 3] {
    let [a, b, t] = [alpha, beta, theta].map(f64::to_radians);
    let far = b.sin() / (a + b).sin();
    let turn = |x: f64, y: f64| [x * t.cos() - y * t.sin(), x * t.sin() + y * t.cos()];
    [[0.0, 0.0], turn(1.0, 0.0), turn(far * a.cos(), far * a.sin())]
}

/// Rows: force x, force y, moment of the load with end values t on the three sides.
pub fn equilibrium(p: [[f64; 2]; 3]) -> SMatrix<f64, 3, 12> {
    let mut g = SMatrix::<f64, 3, 12>::zeros();
    let centre = [0, 1].map(|c| (p[0][c] + p[1][c] + p[2][c]) / 3.0);
    for side in 0..3 {
        let (a, b) = (p[(side + 1) % 3], p[(side + 2) % 3]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        for (end, (own, other)) in [(a, b), (b, a)].into_iter().enumerate() {
            // ∫ x q ds with the hat function q of this end.
            let [mx, my] = [0, 1].map(|c| length / 6.0 * (2.0 * (own[c] - centre[c]) + other[c] - centre[c]));
            let column = 4 * side + 2 * end;
            g[(0, column)] = 0.5 * length;
            g[(1, column + 1)] = 0.5 * length;
            g[(2, column)] = -my;
            g[(2, column + 1)] = mx;
        }
    }
    g
}

/// The 27 × 12 matrix that turns an equilibrated load into the stresses at the corners of the subtriangles.
pub fn stress_of_load(p: [[f64; 2]; 3]) -> DMatrix<f64> {
    let modes = Block.modes(p, &Material::isotropic(Kinematics::PlaneStress, 1.0, 0.0), &BodyForce::NONE);
    let traction = DMatrix::from_column_slice(12, 9, modes.traction());
    let fields = Section::Slice.mode_stresses(&Block, p, &modes);
    let stress = DMatrix::from_fn(27, 9, |i, k| fields[k][i / 3][i % 3]);
    // By a factorisation that does not iterate: singular values that nearly coincide cost the other one half of its digits.
    let qr = traction.qr();
    let inverse = qr.r().solve_upper_triangular(&qr.q().transpose()).expect("independent tractions");
    stress * inverse
}

/// Operator norm of a triangle and a load that attains it.
pub fn norm(p: [[f64; 2]; 3]) -> (f64, [f64; 12]) {
    let g = equilibrium(p);
    let stress = stress_of_load(p);
    let column = |i: usize| Vector3::new(g[(0, i)], g[(1, i)], g[(2, i)]);
    let mut subsets = Vec::with_capacity(220);
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let m = Matrix3::from_columns(&[column(i), column(j), column(k)]);
                let size = column(i).norm() * column(j).norm() * column(k).norm();
                if m.determinant().abs() > 1e-9 * size
                    && let Some(inverse) = m.transpose().try_inverse()
                {
                    subsets.push(([i, j, k], inverse));
                }
            }
        }
    }
    let mut best = (0.0, [0.0; 12]);
    for row in 0..27 {
        let r: Vec<f64> = (0..12).map(|i| stress[(row, i)]).collect();
        let (mut least, mut at) = (f64::INFINITY, Vector3::zeros());
        for (set, inverse) in &subsets {
            let y = inverse * Vector3::new(r[set[0]], r[set[1]], r[set[2]]);
            let sum = (0..12).map(|i| (r[i] - column(i).dot(&y)).abs()).sum::<f64>();
            if sum < least {
                (least, at) = (sum, y);
            }
        }
        if least > best.0 {
            best = (least, attaining(&r, &g, at));
        }
    }
    best
}

/// A load on which the bound is attained: ±1 where the residual r − Gᵀy does not vanish. Where it does, values in
/// [−1, 1] restore equilibrium; at a vertex of what is left to choose all but three of them are ±1 as well.
fn attaining(r: &[f64], g: &SMatrix<f64, 3, 12>, y: Vector3<f64>) -> [f64; 12] {
    let column = |i: usize| Vector3::new(g[(0, i)], g[(1, i)], g[(2, i)]);
    let residual: [f64; 12] = std::array::from_fn(|i| r[i] - column(i).dot(&y));
    let zero = 1e-9 * r.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let (open, fixed): (Vec<usize>, Vec<usize>) = (0..12).partition(|&i| residual[i].abs() <= zero);
    let mut t = [0.0; 12];
    let mut rest = Vector3::zeros();
    for i in fixed {
        t[i] = residual[i].signum();
        rest -= column(i) * t[i];
    }
    for i in 0..open.len() {
        for j in i + 1..open.len() {
            for k in j + 1..open.len() {
                let set = [open[i], open[j], open[k]];
                let Some(inverse) = Matrix3::from_columns(&set.map(column)).try_inverse() else { continue };
                let others: Vec<usize> = open.iter().copied().filter(|o| !set.contains(o)).collect();
                for signs in 0..1_u32 << others.len() {
                    let mut left = rest;
                    for (bit, &o) in others.iter().enumerate() {
                        t[o] = if signs >> bit & 1 == 1 { 1.0 } else { -1.0 };
                        left -= column(o) * t[o];
                    }
                    let x = inverse * left;
                    if x.amax() <= 1.0 + 1e-9 {
                        (t[set[0]], t[set[1]], t[set[2]]) = (x[0], x[1], x[2]);
                        return t;
                    }
                }
            }
        }
    }
    [f64::NAN; 12]
}

/// One row of the table.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Row {
    /// Smallest angle in degrees.
    pub angle: f64,
    /// c(α): the largest norm among the triangles tried.
    pub constant: f64,
    /// c(α) sin²α.
    pub times_sin_squared: f64,
    /// Second angle and direction of the first side of the worst triangle, in degrees.
    pub worst: [f64; 2],
    /// How many triangles were tried.
    pub triangles: usize,
}

/// The worst of a grid of `grid`² triangles and `random` more with the smallest angle `angle`.
pub fn worst(angle: f64, grid: usize, random: usize) -> Row {
    let mut numbers = Numbers((angle * 1000.0) as u64);
    let last = (grid - 1).max(1) as f64;
    let on_grid = (0..grid * grid).map(|i| [(i / grid) as f64 / last, (i % grid) as f64 / grid as f64]);
    let mut places: Vec<[f64; 2]> = on_grid.collect();
    places.extend((0..random).map(|_| [numbers.next(), numbers.next()]));
    let mut row = Row { angle, constant: 0.0, times_sin_squared: 0.0, worst: [0.0; 2], triangles: places.len() };
    for [s, turn] in places {
        // The other two angles are β and 180° − α − β, both at least α.
        let (beta, theta) = (angle + s * (180.0 - 3.0 * angle), 180.0 * turn);
        let c = norm(triangle_with_angles(angle, beta, theta)).0;
        if c > row.constant {
            (row.constant, row.worst) = (c, [beta, theta]);
        }
    }
    row.times_sin_squared = row.constant * angle.to_radians().sin().powi(2);
    row
}
