//! Strains of a displacement that is quadratic on each subtriangle.

/// Area of one of the three equal subtriangles.
pub fn sub_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 6.0
}

/// Corners (a_{i+1}, a_{i+2}, 0) of subtriangle `sub`.
pub fn sub_corners(corners: [[f64; 2]; 3], sub: usize) -> [[f64; 2]; 3] {
    let from = corners[0];
    let centre = [0, 1].map(|c| from[c] + ((corners[1][c] - from[c]) + (corners[2][c] - from[c])) / 3.0);
    [corners[(sub + 1) % 3], corners[(sub + 2) % 3], centre]
}

/// Gradients of the barycentric coordinates of a triangle.
pub fn gradients(q: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let twice = (q[1][0] - q[0][0]) * (q[2][1] - q[0][1]) - (q[1][1] - q[0][1]) * (q[2][0] - q[0][0]);
    [0, 1, 2].map(|i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        [(q[j][1] - q[k][1]) / twice, (q[k][0] - q[j][0]) / twice]
    })
}

/// Gradients of the six quadratic shape functions (corners, then the midpoints opposite them) at the midpoint opposite
/// corner `at` of a triangle with barycentric gradients `g`.
pub fn shape_gradients(g: &[[f64; 2]; 3], at: usize) -> [[f64; 2]; 6] {
    let mut l = [0.5; 3];
    l[at] = 0.0;
    let mut out = [[0.0; 2]; 6];
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for c in 0..2 {
            out[i][c] = (4.0 * l[i] - 1.0) * g[i][c];
            out[3 + i][c] = 4.0 * (l[j] * g[k][c] + l[k] * g[j][c]);
        }
    }
    out
}

/// Strains (xx, yy, xy) at the three edge midpoints of subtriangle `sub`, in the order of the midpoint rule, from the
/// nodal values `u` as in [`crate::element::Displacement::sub`].
pub fn strains(corners: [[f64; 2]; 3], sub: usize, u: &[[f64; 2]; 6]) -> [[f64; 3]; 3] {
    let g = gradients(sub_corners(corners, sub));
    [0, 1, 2].map(|at| {
        let shape = shape_gradients(&g, at);
        let mut e = [0.0; 3];
        // Differences from one node: a rigid translation leaves no trace.
        for (d, value) in shape.iter().zip(u).skip(1) {
            let (ux, uy) = (value[0] - u[0][0], value[1] - u[0][1]);
            e[0] += d[0] * ux;
            e[1] += d[1] * uy;
            e[2] += 0.5 * (d[1] * ux + d[0] * uy);
        }
        e
    })
}

/// The sums of the absolute values of all products that [`strains`] adds up, at the three midpoints.
pub fn spreads(corners: [[f64; 2]; 3], sub: usize, u: &[[f64; 2]; 6]) -> [f64; 3] {
    let g = gradients(sub_corners(corners, sub));
    [0, 1, 2].map(|at| {
        let term = |(d, v): (&[f64; 2], &[f64; 2])| {
            (d[0].abs() + d[1].abs()) * ((v[0] - u[0][0]).abs() + (v[1] - u[0][1]).abs())
        };
        shape_gradients(&g, at).iter().zip(u).skip(1).map(term).sum()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strains_of_a_quadratic_field() {
        let corners = [[0.2, -0.1], [1.7, 0.4], [0.5, 1.3]];
        let u = |p: [f64; 2]| [p[0] * p[0] - 2.0 * p[0] * p[1], 3.0 * p[1] * p[1] + p[0]];
        for sub in 0..3 {
            let q = sub_corners(corners, sub);
            let mid = |i: usize, j: usize| [0.5 * (q[i][0] + q[j][0]), 0.5 * (q[i][1] + q[j][1])];
            let mids = [mid(1, 2), mid(2, 0), mid(0, 1)];
            let values = [u(q[0]), u(q[1]), u(q[2]), u(mids[0]), u(mids[1]), u(mids[2])];
            for (e, [x, y]) in strains(corners, sub, &values).into_iter().zip(mids) {
                let exact = [2.0 * x - 2.0 * y, 6.0 * y, 0.5 * (-2.0 * x + 1.0)];
                for c in 0..3 {
                    assert!((e[c] - exact[c]).abs() < 1e-13);
                }
            }
        }
    }
}
