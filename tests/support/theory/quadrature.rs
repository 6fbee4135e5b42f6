//! Quadrature of its own: Gauss–Legendre by Newton's method, and on triangles by collapsing a square.

use hypercircle::element::StressField;

/// `n` Gauss–Legendre points on [0, 1] with weights, exact to degree 2n − 1.
pub fn gauss(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..50 {
                let (mut p, mut q) = (1.0, 0.0);
                for k in 1..=n {
                    let k = k as f64;
                    (p, q) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * q) / k, p);
                }
                slope = n as f64 * (x * p - q) / (x * x - 1.0);
                x -= p / slope;
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Barycentric points with weights that sum to one, exact to degree 2n − 2.
pub fn triangle(n: usize) -> Vec<([f64; 3], f64)> {
    let line = gauss(n);
    let mut rule = Vec::with_capacity(n * n);
    for &(s, v) in &line {
        for &(t, w) in &line {
            rule.push(([1.0 - s, s * (1.0 - t), s * t], 2.0 * s * v * w));
        }
    }
    rule
}

pub fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

/// Corners (a_{i+1}, a_{i+2}, 0) of a subtriangle.
pub fn sub_corners(p: [[f64; 2]; 3], sub: usize) -> [[f64; 2]; 3] {
    let centre = [0, 1].map(|c| (p[0][c] + p[1][c] + p[2][c]) / 3.0);
    [p[(sub + 1) % 3], p[(sub + 2) % 3], centre]
}

pub fn point(q: [[f64; 2]; 3], bary: [f64; 3]) -> [f64; 2] {
    [0, 1].map(|c| bary[0] * q[0][c] + bary[1] * q[1][c] + bary[2] * q[2][c])
}

/// Visits quadrature points of all subtriangles with (triangle, subtriangle, barycentric point, point, weight).
pub fn visit(corners: &[[[f64; 2]; 3]], order: usize, mut each: impl FnMut(usize, usize, [f64; 3], [f64; 2], f64)) {
    let rule = triangle(order);
    for (t, &p) in corners.iter().enumerate() {
        for sub in 0..3 {
            let q = sub_corners(p, sub);
            for &(bary, w) in &rule {
                each(t, sub, bary, point(q, bary), w * area(q));
            }
        }
    }
}

/// ‖τ − exact‖ in [L2]⁴ and the largest difference of a component at a quadrature point.
pub fn stress_error(
    corners: &[[[f64; 2]; 3]],
    body: &[usize],
    field: &StressField,
    exact: impl Fn(usize, [f64; 2]) -> [f64; 3],
) -> (f64, f64) {
    let (mut square, mut largest) = (0.0, 0.0_f64);
    visit(corners, 5, |t, sub, bary, x, w| {
        let (l, e) = (field.at(t, sub, bary), exact(body[t], x));
        let d = [l[0] - e[0], l[1] - e[1], l[2] - e[2]];
        square += w * (d[0] * d[0] + d[1] * d[1] + 2.0 * d[2] * d[2]);
        largest = d.iter().fold(largest, |m, v| m.max(v.abs()));
    });
    (square.sqrt(), largest)
}
