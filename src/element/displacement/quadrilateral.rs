//! Displacements of quadrilaterals with four, eight or nine nodes and straight sides.
//!
//! The square −1 ≤ ξ, η ≤ 1 is mapped by x = c + aξ + bη + hξη, whose determinant is affine:
//!
//! x_ξ × x_η = a × b + (a × h) ξ + (h × b) η.
//!
//! A field of four or eight nodes is one of nine, whose values at the other nodes are those that it has there. Along a side it is a
//! quadratic polynomial, inside a rational function of x; only where h = 0, on a parallelogram, is it a polynomial there too.

/// Where the nodes are: corners, middles of the sides from corner to corner, centre.
const NODES: [[f64; 2]; 9] =
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]];
/// Of a length, what counts as a parallelogram's h.
const PARALLEL: f64 = 1e-9;
/// Steps of Newton's method to a point, and the part of the square at which they end.
const STEPS: usize = 40;
const ENOUGH: f64 = 4.0 * f64::EPSILON;

/// A field on one quadrilateral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadrilateral {
    corners: [[f64; 2]; 4],
    nodes: usize,
    values: [[f64; 2]; 9],
}

/// The map at a point of the square, and the derivatives of the field along ξ and η.
#[derive(Debug, Clone, Copy)]
pub struct At {
    /// x_ξ × x_η.
    pub determinant: f64,
    /// The determinant times the strain (xx, yy, xy).
    pub strain: [f64; 3],
    /// Sum of the absolute values of all terms of `strain`.
    pub spread: f64,
}

impl Quadrilateral {
    /// The field with the given values at four, eight or nine nodes: counter-clockwise corners, the middles of the sides (0, 1),
    /// (1, 2), (2, 3), (3, 0), and the centre. `None` for another number of nodes, or where the quadrilateral is not convex.
    pub fn new(corners: [[f64; 2]; 4], nodal: &[[f64; 2]]) -> Option<Self> {
        let mean = |i: usize| {
            let (a, b) = (nodal[i], nodal[(i + 1) % 4]);
            [0, 1].map(|c| 0.5 * (a[c] + b[c]))
        };
        if ![4, 8, 9].contains(&nodal.len()) || !is_convex(&corners) {
            return None;
        }
        let mut values = [[0.0; 2]; 9];
        for (i, value) in values.iter_mut().take(8).enumerate() {
            *value = if i < nodal.len() { nodal[i] } else { mean(i - 4) };
        }
        values[8] = nodal.get(8).copied().unwrap_or_else(|| {
            let sum = |c: usize, from: usize| (from..from + 4).map(|i| values[i][c] - values[0][c]).sum::<f64>();
            [0, 1].map(|c| values[0][c] + 0.5 * sum(c, 4) - 0.25 * sum(c, 0))
        });
        Some(Quadrilateral { corners, nodes: nodal.len(), values })
    }

    /// Number of nodes: 4, 8 or 9.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// The corners.
    pub fn corners(&self) -> [[f64; 2]; 4] {
        self.corners
    }

    /// The degree of the polynomial that the field is on a triangle of a parallelogram: 2, 3 or 4.
    pub fn degree(&self) -> usize {
        match self.nodes {
            4 => 2,
            8 => 3,
            _ => 4,
        }
    }

    /// a, b and h.
    fn frame(&self) -> [[f64; 2]; 3] {
        let [p, q, r, s] = self.corners;
        let part = |c: usize, sign: [f64; 4]| {
            0.25 * ([q, r, s].iter().zip(&sign[1..]).map(|(x, sign)| sign * (x[c] - p[c])).sum::<f64>())
        };
        [[-1.0, 1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0], [1.0, -1.0, 1.0, -1.0]]
            .map(|sign| [part(0, sign), part(1, sign)])
    }

    /// The determinant as d₀ + d₁ξ + d₂η.
    pub fn determinant(&self) -> [f64; 3] {
        let [a, b, h] = self.frame();
        [cross(a, b), cross(a, h), cross(h, b)]
    }

    /// True if it is a parallelogram, up to round-off.
    pub fn is_parallelogram(&self) -> bool {
        let [a, b, h] = self.frame();
        h[0].hypot(h[1]) <= PARALLEL * a[0].hypot(a[1]).min(b[0].hypot(b[1]))
    }

    /// Where a point of the square lies in the plane.
    pub fn point(&self, [xi, eta]: [f64; 2]) -> [f64; 2] {
        let [a, b, h] = self.frame();
        let [p, q, r, s] = self.corners;
        let middle = |c: usize| p[c] + 0.25 * ((q[c] - p[c]) + (r[c] - p[c]) + (s[c] - p[c]));
        [0, 1].map(|c| middle(c) + a[c] * xi + b[c] * eta + h[c] * xi * eta)
    }

    /// The value at a point of the square.
    pub fn value(&self, at: [f64; 2]) -> [f64; 2] {
        let weights = shapes(at);
        let base = self.values[0];
        let sum = |c: usize| self.values.iter().zip(&weights).map(|(u, w)| w * (u[c] - base[c])).sum::<f64>();
        [base[0] + sum(0), base[1] + sum(1)]
    }

    /// The point of the plane that a point of the square is mapped to.
    pub fn position(&self, [xi, eta]: [f64; 2]) -> [f64; 2] {
        let [a, b, h] = self.frame();
        let base = self.corners[0];
        [0, 1].map(|c| base[c] + a[c] * (1.0 + xi) + b[c] * (1.0 + eta) + h[c] * (xi * eta - 1.0))
    }

    /// The point of the square that is mapped to `x`, in or at the edge of the quadrilateral.
    pub fn place(&self, x: [f64; 2]) -> [f64; 2] {
        let [a, b, h] = self.frame();
        let [p, q, r, s] = self.corners;
        let from = [0, 1].map(|c| x[c] - p[c] - 0.25 * ((q[c] - p[c]) + (r[c] - p[c]) + (s[c] - p[c])));
        let mut at = [0.0; 2];
        for _ in 0..STEPS {
            let [xi, eta] = at;
            let along = [[a[0] + h[0] * eta, a[1] + h[1] * eta], [b[0] + h[0] * xi, b[1] + h[1] * xi]];
            let left = [0, 1].map(|c| from[c] - a[c] * xi - b[c] * eta - h[c] * xi * eta);
            let determinant = cross(along[0], along[1]);
            let step = [cross(left, along[1]) / determinant, cross(along[0], left) / determinant];
            at = [0, 1].map(|c| (at[c] + step[c]).clamp(-1.0, 1.0));
            if step[0].abs().max(step[1].abs()) <= ENOUGH {
                break;
            }
        }
        at
    }

    /// The map and the strain at a point of the square.
    pub fn at(&self, at: [f64; 2]) -> At {
        let [a, b, h] = self.frame();
        let [xi, eta] = at;
        let along = [[a[0] + h[0] * eta, a[1] + h[1] * eta], [b[0] + h[0] * xi, b[1] + h[1] * xi]];
        let base = self.values[0];
        let (mut strain, mut spread) = ([0.0; 3], 0.0);
        for (d, u) in derivatives(at).iter().zip(&self.values) {
            // The gradient of the shape function, times the determinant.
            let g = [d[0] * along[1][1] - d[1] * along[0][1], d[1] * along[0][0] - d[0] * along[1][0]];
            let (x, y) = (u[0] - base[0], u[1] - base[1]);
            strain[0] += g[0] * x;
            strain[1] += g[1] * y;
            strain[2] += 0.5 * (g[1] * x + g[0] * y);
            spread += g[0].hypot(g[1]) * u[0].hypot(u[1]);
        }
        At { determinant: cross(along[0], along[1]), strain, spread }
    }

    /// The gradients of the shape functions of its own nodes, times the determinant, and the determinant.
    pub fn gradients(&self, at: [f64; 2]) -> (Vec<[f64; 2]>, f64) {
        let [a, b, h] = self.frame();
        let [xi, eta] = at;
        let along = [[a[0] + h[0] * eta, a[1] + h[1] * eta], [b[0] + h[0] * xi, b[1] + h[1] * xi]];
        let turned = |d: [f64; 2]| [d[0] * along[1][1] - d[1] * along[0][1], d[1] * along[0][0] - d[0] * along[1][0]];
        let own = own(self.nodes, &derivatives(at));
        (own.into_iter().map(turned).collect(), cross(along[0], along[1]))
    }

    /// The shape functions of its own nodes.
    pub fn shapes(&self, at: [f64; 2]) -> Vec<f64> {
        own(self.nodes, &shapes(at).map(|w| [w, 0.0])).into_iter().map(|w| w[0]).collect()
    }

    /// The values at the nine nodes of which it is a polynomial.
    pub fn nine(&self) -> &[[f64; 2]; 9] {
        &self.values
    }

    /// The values at its own nodes.
    pub fn values(&self) -> &[[f64; 2]] {
        &self.values[..self.nodes]
    }
}

/// True if four corners, in either orientation, are those of a convex quadrilateral without an angle of 180 degrees.
pub fn is_convex(corners: &[[f64; 2]; 4]) -> bool {
    let turn = |i: usize| {
        let [p, q, r] = [corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]];
        let (d, e) = ([q[0] - p[0], q[1] - p[1]], [r[0] - q[0], r[1] - q[1]]);
        cross(d, e) / (d[0].hypot(d[1]) * e[0].hypot(e[1]))
    };
    let turns = [0, 1, 2, 3].map(turn);
    turns.iter().all(|t| *t > PARALLEL) || turns.iter().all(|t| *t < -PARALLEL)
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The shape functions of the nine nodes.
fn shapes([xi, eta]: [f64; 2]) -> [f64; 9] {
    NODES.map(|[x, y]| along(x, xi)[0] * along(y, eta)[0])
}

/// Their derivatives along ξ and η.
fn derivatives([xi, eta]: [f64; 2]) -> [[f64; 2]; 9] {
    NODES.map(|[x, y]| {
        let ([f, df], [g, dg]) = (along(x, xi), along(y, eta));
        [df * g, f * dg]
    })
}

/// The quadratic polynomial that is one at the node `at` of −1, 0, 1 and zero at the others, and its derivative, at `s`.
fn along(at: f64, s: f64) -> [f64; 2] {
    if at == 0.0 { [1.0 - s * s, -2.0 * s] } else { [0.5 * s * (s + at), s + 0.5 * at] }
}

/// Shape functions of four or eight nodes from those of nine: each is their sum weighted with its values at the nine nodes.
fn own(nodes: usize, nine: &[[f64; 2]; 9]) -> Vec<[f64; 2]> {
    let mut own = nine.to_vec();
    let mut add = |to: usize, from: usize, weight: f64| {
        own[to] = [0, 1].map(|c| own[to][c] + weight * nine[from][c]);
    };
    match nodes {
        4 => {
            for i in 0..4 {
                add(i, 4 + i, 0.5);
                add((i + 1) % 4, 4 + i, 0.5);
                add(i, 8, 0.25);
            }
        }
        8 => {
            for i in 0..4 {
                add(i, 8, -0.25);
                add(4 + i, 8, 0.5);
            }
        }
        _ => {}
    }
    own.truncate(nodes);
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 2]; 4] = [[0.1, -0.2], [2.3, 0.1], [1.8, 1.6], [-0.3, 1.1]];

    /// Values at so many nodes that are no polynomial of low degree.
    fn nodal(nodes: usize) -> Vec<[f64; 2]> {
        (0..nodes).map(|i| [(1.3 * i as f64).sin(), (0.7 * i as f64 + 0.4).cos()]).collect()
    }

    #[test]
    fn strains_are_those_of_differences_and_shapes_have_the_values() {
        for nodes in [4, 8, 9] {
            let cell = Quadrilateral::new(CORNERS, &nodal(nodes)).expect("convex");
            let point = |at: [f64; 2]| {
                let corner = |i: usize| 0.25 * (1.0 + NODES[i][0] * at[0]) * (1.0 + NODES[i][1] * at[1]);
                [0, 1].map(|c| (0..4).map(|i| corner(i) * CORNERS[i][c]).sum::<f64>())
            };
            for at in [[0.3, -0.7], [-0.95, 0.2], [0.0, 0.0], [0.8, 0.9]] {
                let back = cell.place(point(at));
                assert!((back[0] - at[0]).hypot(back[1] - at[1]) < 1e-13);
                let value = |x: [f64; 2]| cell.value(cell.place(x));
                let (x, step) = (point(at), 1e-5);
                let along = |d: [f64; 2]| {
                    let [p, q] = [1.0, -1.0].map(|s| value([x[0] + s * step * d[0], x[1] + s * step * d[1]]));
                    [0, 1].map(|c| (p[c] - q[c]) / (2.0 * step))
                };
                let (dx, dy) = (along([1.0, 0.0]), along([0.0, 1.0]));
                let found = cell.at(at);
                for (e, expected) in found.strain.iter().zip([dx[0], dy[1], 0.5 * (dy[0] + dx[1])]) {
                    assert!((e / found.determinant - expected).abs() < 1e-8, "{nodes}");
                }
                let [d0, d1, d2] = cell.determinant();
                assert!((d0 + d1 * at[0] + d2 * at[1] - found.determinant).abs() < 1e-14);
                let (gradients, shapes) = (cell.gradients(at).0, cell.shapes(at));
                assert!((shapes.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                let own = |c: usize| cell.values().iter().zip(&shapes).map(|(u, w)| u[c] * w).sum::<f64>();
                assert!((own(0) - cell.value(at)[0]).abs() < 1e-14);
                let xx: f64 = gradients.iter().zip(cell.values()).map(|(g, u)| g[0] * u[0]).sum();
                assert!((xx - found.strain[0]).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn what_folds_over_is_none() {
        let nodal = nodal(4);
        assert!(Quadrilateral::new([[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]], &nodal).is_none());
        assert!(Quadrilateral::new([[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [0.0, 1.0]], &nodal).is_none());
        assert!(Quadrilateral::new(CORNERS, &nodal[..3]).is_none());
    }
}
