//! Orthonormal polynomials on a triangle (Dubiner, J. Sci. Comput. 6 (1991)).
//!
//! In barycentric coordinates l, with u = l_1 − l_0 and v = l_0 + l_1,
//!
//! ψ_ij = √((2i + 1)(i + j + 1)) v^i P_i(u/v) P_j^{(2i + 1, 0)}(2 l_2 − 1),  i + j ≤ p,
//!
//! P_i being Legendre's and P_j^{(a, 0)} Jacobi's polynomials. The mean of ψ_m ψ_n over the triangle is one for m = n, else zero.

/// A value with its derivatives along x and y.
pub type Jet = [f64; 3];

/// The product of two values, with derivatives.
fn times(a: Jet, b: Jet) -> Jet {
    [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + a[0] * b[2]]
}

/// αa + βb.
fn combined(alpha: f64, a: Jet, beta: f64, b: Jet) -> Jet {
    [0, 1, 2].map(|c| alpha * a[c] + beta * b[c])
}

/// All ψ_ij of degree at most p, with derivatives: i = 0 … p, for each j = 0 … p − i.
pub fn with_derivatives(p: usize, l: [Jet; 3]) -> Vec<Jet> {
    let (u, v) = (combined(1.0, l[1], -1.0, l[0]), combined(1.0, l[0], 1.0, l[1]));
    let z = [2.0 * l[2][0] - 1.0, 2.0 * l[2][1], 2.0 * l[2][2]];
    let square = times(v, v);
    let mut out = Vec::with_capacity((p + 1) * (p + 2) / 2);
    // v^i P_i(u/v), and the one before it.
    let (mut first, mut before) = ([1.0, 0.0, 0.0], [0.0; 3]);
    for i in 0..=p {
        let a = (2 * i + 1) as f64;
        let (mut second, mut earlier) = ([1.0, 0.0, 0.0], [0.0; 3]);
        for j in 0..=p - i {
            let size = (a * (i + j + 1) as f64).sqrt();
            out.push(times(first, second).map(|f| size * f));
            let n = (j + 1) as f64;
            let m = 2.0 * n + a;
            let linear = [m * (m - 2.0) * z[0] + a * a, m * (m - 2.0) * z[1], m * (m - 2.0) * z[2]];
            let scale = 1.0 / (2.0 * n * (n + a) * (m - 2.0));
            let back = 2.0 * (n + a - 1.0) * (n - 1.0) * m;
            (second, earlier) = (combined((m - 1.0) * scale, times(linear, second), -back * scale, earlier), second);
        }
        let k = i as f64;
        let next = combined(a / (k + 1.0), times(u, first), -k / (k + 1.0), times(square, before));
        (first, before) = (next, first);
    }
    out
}

/// All ψ_ij of degree at most p.
pub fn values(p: usize, l: [f64; 3]) -> Vec<f64> {
    with_derivatives(p, l.map(|l| [l, 0.0, 0.0])).into_iter().map(|[value, ..]| value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::polynomial::quadrature::triangle_rule;

    #[test]
    fn they_are_orthonormal() {
        for p in 0..=8 {
            let n = (p + 1) * (p + 2) / 2;
            let mut gram = vec![0.0; n * n];
            for &(l, w) in triangle_rule(2 * p) {
                let psi = values(p, l);
                for i in 0..n {
                    for j in 0..n {
                        gram[i * n + j] += w * psi[i] * psi[j];
                    }
                }
            }
            for i in 0..n {
                for j in 0..n {
                    assert!((gram[i * n + j] - f64::from(i == j)).abs() < 1e-13, "degree {p}: {i} {j}");
                }
            }
        }
    }

    #[test]
    fn derivatives_are_limits_of_differences() {
        let at = |x: f64, y: f64| [[1.0 - x - 2.0 * y, -1.0, -2.0], [x, 1.0, 0.0], [2.0 * y, 0.0, 2.0]];
        let (x, y, h) = (0.3, 0.1, 1e-6);
        let psi = with_derivatives(8, at(x, y));
        for (c, [dx, dy]) in [(1, [h, 0.0]), (2, [0.0, h])] {
            let (ahead, behind) = (with_derivatives(8, at(x + dx, y + dy)), with_derivatives(8, at(x - dx, y - dy)));
            for ((psi, a), b) in psi.iter().zip(ahead).zip(behind) {
                assert!((psi[c] - (a[0] - b[0]) / (2.0 * h)).abs() < 1e-6);
            }
        }
    }
}
