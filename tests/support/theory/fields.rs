//! Self-equilibrated stresses that are not polynomial, from Airy functions φ: τ11 = φ,22, τ22 = φ,11, τ12 = −φ,12.

pub type Stress = fn([f64; 2]) -> [f64; 3];

/// Name and stress of each field.
pub const FIELDS: [(&str, Stress); 3] = [
    // Harmonic.
    ("e^x sin y", |[x, y]| {
        let (e, s, c) = (x.exp(), y.sin(), y.cos());
        [-e * s, e * s, -e * c]
    }),
    // Harmonic, oscillating.
    ("cos 3x cosh 3y", |[x, y]| {
        let (x, y) = (3.0 * x, 3.0 * y);
        [9.0 * x.cos() * y.cosh(), -9.0 * x.cos() * y.cosh(), 9.0 * x.sin() * y.sinh()]
    }),
    // Not even biharmonic: the theorem asks for equilibrium alone.
    ("sin(2x + 1) cos 3y", |[x, y]| {
        let (s, c) = (2.0 * x + 1.0).sin_cos();
        let (t, d) = (3.0 * y).sin_cos();
        [-9.0 * s * d, -4.0 * s * d, 6.0 * c * t]
    }),
];
