//! One subtriangle of the block: stress parameters (3.1), flexibility (3.2), side parameters (3.4).
//!
//! Coordinates are dimensionless, x = (X − origin)/√A with the area A of the block, so that the factors √A of the paper
//! are one. The seven parameters S stand for
//!
//! τ11 = S1 + S5 x1 + S7 x2, τ22 = S2 + S4 x1 + S6 x2, τ12 = S3 − S6 x1 − S5 x2.

use nalgebra::SMatrix;

/// A (rows × columns) matrix of fixed size.
pub type Matrix<const R: usize, const C: usize> = SMatrix<f64, R, C>;

/// The matrix M of (3.1) at a point: (τ11, τ22, τ12) = M S.
pub fn stress_map([x, y]: [f64; 2]) -> Matrix<3, 7> {
    Matrix::from_row_slice(&[
        1.0, 0.0, 0.0, 0.0, x, 0.0, y, //
        0.0, 1.0, 0.0, x, 0.0, y, 0.0, //
        0.0, 0.0, 1.0, 0.0, -y, -x, 0.0,
    ])
}

/// Area and second moments of a triangle about its centre of gravity: δ1 = ∫x1²/A, δ2 = ∫x2²/A, δ12 = ∫x1 x2/A.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Area A.
    pub area: f64,
    /// Centre of gravity.
    pub centre: [f64; 2],
    /// δ1, δ2, δ12.
    pub delta: [f64; 3],
}

impl Moments {
    /// Moments of the triangle with the given corners.
    pub fn new([a, b, c]: [[f64; 2]; 3]) -> Self {
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        let centre = [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0];
        let mut delta = [0.0; 3];
        for p in [a, b, c] {
            let (x, y) = (p[0] - centre[0], p[1] - centre[1]);
            delta[0] += x * x / 12.0;
            delta[1] += y * y / 12.0;
            delta[2] += x * y / 12.0;
        }
        Moments { area, centre, delta }
    }
}

/// The flexibility f of (3.2) for parameters about the centre of gravity: ∫ a τ:τ dx = SᵀfS with E = 1, t = 1.
///
/// `constants` are α, β, γ. The form is linear in them: the material enters through two purely geometric matrices,
/// f(1, 1, 0) for the trace and f(¼, −¼, 1) for the deviator.
pub fn flexibility(moments: &Moments, constants: [f64; 3]) -> Matrix<7, 7> {
    let [alpha, beta, gamma] = constants;
    let [d1, d2, d12] = moments.delta;
    let mut f = Matrix::<7, 7>::zeros();
    let lower = [
        (0, 0, alpha),
        (1, 0, beta),
        (1, 1, alpha),
        (2, 2, gamma),
        (3, 3, alpha * d1),
        (4, 3, beta * d1),
        (4, 4, alpha * d1 + gamma * d2),
        (5, 3, alpha * d12),
        (5, 4, (beta + gamma) * d12),
        (5, 5, alpha * d2 + gamma * d1),
        (6, 3, beta * d12),
        (6, 4, alpha * d12),
        (6, 5, beta * d2),
        (6, 6, alpha * d2),
    ];
    for (i, j, value) in lower {
        f[(i, j)] = value * moments.area;
        f[(j, i)] = value * moments.area;
    }
    f
}

/// The flexibility of any material, from its compliance `a` for stresses (11, 22, 12).
pub fn flexibility_of(moments: &Moments, a: [[f64; 3]; 3]) -> Matrix<7, 7> {
    let a = Matrix::<3, 3>::from_fn(|i, j| a[i][j]);
    let [d1, d2, d12] = moments.delta;
    let constant = stress_map([0.0; 2]);
    let [along, up] = [stress_map([1.0, 0.0]) - constant, stress_map([0.0, 1.0]) - constant];
    let form = |l: &Matrix<3, 7>, m: &Matrix<3, 7>| l.transpose() * a * m;
    let mixed = form(&along, &up);
    (form(&constant, &constant) + form(&along, &along) * d1 + form(&up, &up) * d2 + (mixed + mixed.transpose()) * d12)
        * moments.area
}

/// Parameters about another origin: S at `centre` from S at the common origin, as S_centre = shift · S.
pub fn shift([x, y]: [f64; 2]) -> Matrix<7, 7> {
    let mut matrix = Matrix::<7, 7>::identity();
    matrix.fixed_view_mut::<3, 7>(0, 0).copy_from(&stress_map([x, y]));
    matrix
}

/// The side matrix C of (3.4) for the side from `a` to `b`, counter-clockwise: (S1*, S2*, S3*, S4*) = C S, where the
/// traction is T1 = S1* + S2* p, T2 = S3* + S4* p with p from −1 at `a` to 1 at `b`.
pub fn side_map(a: [f64; 2], b: [f64; 2]) -> Matrix<4, 7> {
    let ([x2, y2], [x3, y3]) = (a, b);
    let (dx, dy) = (x2 - x3, y2 - y3);
    let length = dx.hypot(dy);
    // Differences of squares and products as products of differences and sums: no digits are lost on short sides.
    let (sx, sy) = (x2 + x3, y2 + y3);
    let cross = 0.5 * (dx * sy + sx * dy);
    let rows = [
        [-2.0 * dy, 0.0, 2.0 * dx, 0.0, -2.0 * cross, -dx * sx, -dy * sy],
        [0.0, 0.0, 0.0, 0.0, 2.0 * dx * dy, dx * dx, dy * dy],
        [0.0, 2.0 * dx, -2.0 * dy, dx * sx, dy * sy, 2.0 * cross, 0.0],
        [0.0, 0.0, 0.0, -dx * dx, -dy * dy, -2.0 * dx * dy, 0.0],
    ];
    Matrix::<4, 7>::from_fn(|i, j| rows[i][j] / (2.0 * length))
}
