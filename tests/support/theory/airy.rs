//! Airy functions with all derivatives up to the second.

/// f, f,1, f,2, f,11, f,22, f,12.
pub type Jet = [f64; 6];

/// A linear function, by its value and gradient.
pub fn linear(value: f64, [x, y]: [f64; 2]) -> Jet {
    [value, x, y, 0.0, 0.0, 0.0]
}

pub fn times(a: Jet, b: Jet) -> Jet {
    let mixed = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
    [
        a[0] * b[0],
        mixed(0, 1),
        mixed(0, 2),
        mixed(0, 3) + 2.0 * a[1] * b[1],
        mixed(0, 4) + 2.0 * a[2] * b[2],
        mixed(0, 5) + mixed(1, 2),
    ]
}

pub fn power(a: Jet, n: usize) -> Jet {
    (0..n).fold(linear(1.0, [0.0; 2]), |product, _| times(product, a))
}

/// Σ c a.
pub fn combined<const N: usize>(terms: [(f64, Jet); N]) -> Jet {
    std::array::from_fn(|i| terms.iter().map(|(c, a)| c * a[i]).sum())
}

/// τ11 = φ,22, τ22 = φ,11, τ12 = −φ,12.
pub fn stress(phi: Jet) -> [f64; 3] {
    [phi[4], phi[3], -phi[5]]
}

/// Re or Im of z^n (kinds 0 and 1) or of z̄ z^{n − 1} (2 and 3): their stresses solve the equations of elasticity.
pub fn biharmonic(n: usize, kind: usize, [x, y]: [Jet; 2]) -> Jet {
    let by = |[a, b]: [Jet; 2], sign: f64| {
        let (c, d) = (x, y.map(|y| sign * y));
        [combined([(1.0, times(a, c)), (-1.0, times(b, d))]), combined([(1.0, times(a, d)), (1.0, times(b, c))])]
    };
    let first = if kind < 2 { n } else { n - 1 };
    let one = [linear(1.0, [0.0; 2]), [0.0; 6]];
    let z = (0..first).fold(one, |z, _| by(z, 1.0));
    (if kind < 2 { z } else { by(z, -1.0) })[kind % 2]
}

/// Barycentric coordinates of a triangle at a point, in units of √(2 area) for the derivatives.
pub fn barycentric(corners: [[f64; 2]; 3], mu: [f64; 3]) -> [Jet; 3] {
    let size = super::quadrature::area(corners) * 2.0;
    [0, 1, 2].map(|i: usize| {
        let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
        linear(mu[i], [a[1] - b[1], b[0] - a[0]].map(|g| g / size.sqrt()))
    })
}

/// Exponents of the monomials of degree n in three variables.
pub fn powers(n: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=n).flat_map(move |i| (0..=n - i).map(move |j| [i, j, n - i - j]))
}

/// On subtriangle i, μ_i² (μ_i² − 2μ_i(μ_j + μ_k) + 6μ_jμ_k) times a monomial.
///
/// It vanishes on the boundary with its gradient, and is C¹: on 0a_k, the difference of two neighbours is divisible by (μ_i − μ_j)².
pub fn without_traction(mu: [Jet; 3], sub: usize, exponents: [usize; 3]) -> Jet {
    let (m, n, o) = (mu[sub], mu[(sub + 1) % 3], mu[(sub + 2) % 3]);
    let own = combined([(1.0, times(m, m)), (-2.0, times(m, n)), (-2.0, times(m, o)), (6.0, times(n, o))]);
    let monomial = (0..3).fold(linear(1.0, [0.0; 2]), |product, i| times(product, power(mu[i], exponents[i])));
    times(times(times(m, m), own), monomial)
}
