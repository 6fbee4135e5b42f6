//! Triangles and the three parts that their centroids split them into.

/// The corners as seen from the centroid, which is no point of its own: far from the origin, coordinates have too few digits for
/// that of a small triangle.
pub fn from_centroid(corners: [[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let sides = corners.map(|p| [p[0] - corners[0][0], p[1] - corners[0][1]]);
    let centre = [0, 1].map(|c| (sides[1][c] + sides[2][c]) / 3.0);
    sides.map(|p| [p[0] - centre[0], p[1] - centre[1]])
}

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

/// Gradients of the barycentric coordinates of subtriangle `sub`.
pub fn sub_gradients(corners: [[f64; 2]; 3], sub: usize) -> [[f64; 2]; 3] {
    let corners = from_centroid(corners);
    gradients([corners[(sub + 1) % 3], corners[(sub + 2) % 3], [0.0; 2]])
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
