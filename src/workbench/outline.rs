//! The boundary of an element, found from its nodes alone, in whatever order they come.

use nalgebra::DMatrix;

use crate::element::polynomial::quadrature::segment_rule;
use crate::vector::cross;

/// Of the size of the element, how far a node may lie from the side that it is on.
const ON_SIDE: f64 = 1e-6;

/// Corners and sides of a convex element.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// The corners, counter-clockwise, from the one with the lowest number.
    pub corners: Vec<usize>,
    /// The nodes of each side from corner k to corner k + 1, both included.
    pub sides: Vec<Vec<usize>>,
    /// The nodes that lie on no side.
    pub inside: Vec<usize>,
    /// Area enclosed.
    pub area: f64,
    /// Largest distance of two nodes.
    pub size: f64,
}

impl Outline {
    /// The convex outline of the nodes; `None` where they enclose no area.
    pub fn of(nodes: &[[f64; 2]]) -> Option<Self> {
        let apart = |i: usize, j: usize| (nodes[i][0] - nodes[j][0]).hypot(nodes[i][1] - nodes[j][1]);
        let size = (0..nodes.len()).flat_map(|i| (0..i).map(move |j| (i, j))).fold(0.0, |m, (i, j)| apart(i, j).max(m));
        let corners = hull(nodes, size)?;
        let count = corners.len();
        // From a corner, not from the origin, which may be far away.
        let from = nodes[corners[0]];
        let area = 0.5 * corners.windows(2).map(|c| turn(from, nodes[c[0]], nodes[c[1]])).sum::<f64>();
        let mut free: Vec<usize> = (0..nodes.len()).filter(|n| !corners.contains(n)).collect();
        let mut sides = Vec::new();
        for k in 0..count {
            let (a, b) = (corners[k], corners[(k + 1) % count]);
            let length = apart(a, b);
            let distance = |n: usize| turn(nodes[a], nodes[b], nodes[n]).abs() / length;
            let (mut on, off): (Vec<usize>, Vec<usize>) = free.iter().partition(|n| distance(**n) <= ON_SIDE * size);
            on.sort_by(|i, j| apart(a, *i).total_cmp(&apart(a, *j)));
            free = off;
            sides.push([&[a], on.as_slice(), &[b]].concat());
        }
        (area > 0.0).then_some(Outline { corners, sides, inside: free, area, size })
    }

    /// The highest polynomial degree that the nodes of every side carry.
    pub fn degree(&self) -> usize {
        self.sides.iter().map(|side| side.len() - 1).min().unwrap_or(1)
    }

    /// True if every side has as many nodes as the others, evenly spaced. An element of another shape may have curved sides, or traces
    /// that are polynomials in another coordinate than the arc length.
    pub fn is_regular(&self, nodes: &[[f64; 2]]) -> bool {
        let even = |side: &[usize]| {
            let (a, b) = (nodes[side[0]], nodes[side[side.len() - 1]]);
            side.iter().enumerate().all(|(k, &n)| {
                let part = k as f64 / (side.len() - 1) as f64;
                let off = [0, 1].map(|c| nodes[n][c] - a[c] - part * (b[c] - a[c]));
                off[0].hypot(off[1]) <= ON_SIDE * self.size
            })
        };
        self.sides.iter().all(|side| side.len() == self.degree() + 1 && even(side))
    }

    /// ∮ σn·N_i ds: the nodal forces of a constant stress (xx, yy, xy) on the nodes of each side, two rows a node.
    pub fn nodal_forces(&self, nodes: &[[f64; 2]], stress: [f64; 3]) -> Vec<f64> {
        let mut forces = vec![0.0; 2 * nodes.len()];
        for side in &self.sides {
            let (a, b) = (nodes[side[0]], nodes[side[side.len() - 1]]);
            let normal = [b[1] - a[1], a[0] - b[0]];
            let force = [stress[0] * normal[0] + stress[2] * normal[1], stress[2] * normal[0] + stress[1] * normal[1]];
            for (&node, weight) in side.iter().zip(side_weights(nodes, side, |_| 1.0)) {
                (0..2).for_each(|c| forces[2 * node + c] += weight * force[c]);
            }
        }
        forces
    }

    /// The weights of its corners in every node: barycentric coordinates in a triangle, bilinear ones in a quadrilateral. `None`
    /// with other numbers of corners.
    pub fn weights(&self, nodes: &[[f64; 2]]) -> Option<DMatrix<f64>> {
        let at: Vec<[f64; 2]> = self.corners.iter().map(|&c| nodes[c]).collect();
        let mut weights = DMatrix::zeros(nodes.len(), at.len());
        for (n, &x) in nodes.iter().enumerate() {
            let row = match *at.as_slice() {
                [a, b, c] => {
                    let whole = turn(a, b, c);
                    vec![turn(x, b, c) / whole, turn(a, x, c) / whole, turn(a, b, x) / whole]
                }
                [a, b, c, d] => bilinear([a, b, c, d], x),
                _ => return None,
            };
            row.into_iter().enumerate().for_each(|(k, w)| weights[(n, k)] = w);
        }
        Some(weights)
    }
}

/// ∫ N_i f ds / length of the Lagrange polynomials through the nodes of a side, f by the part of the side.
pub fn side_weights(nodes: &[[f64; 2]], side: &[usize], f: impl Fn(f64) -> f64) -> Vec<f64> {
    let (a, b) = (nodes[side[0]], nodes[side[side.len() - 1]]);
    let d = [b[0] - a[0], b[1] - a[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let at: Vec<f64> =
        side.iter().map(|&n| ((nodes[n][0] - a[0]) * d[0] + (nodes[n][1] - a[1]) * d[1]) / square).collect();
    let lagrange = |i: usize, s: f64| -> f64 {
        (0..at.len()).filter(|j| *j != i).map(|j| (s - at[j]) / (at[i] - at[j])).product()
    };
    let rule = segment_rule(2 * side.len());
    (0..side.len()).map(|i| rule.iter().map(|&(s, w)| w * f(s) * lagrange(i, s)).sum()).collect()
}

/// Twice the area of a triangle, with its sign.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

/// The corners of the convex hull, counter-clockwise from the lowest number (Jarvis's march).
fn hull(nodes: &[[f64; 2]], size: f64) -> Option<Vec<usize>> {
    let start =
        (0..nodes.len()).min_by(|&i, &j| nodes[i].partial_cmp(&nodes[j]).unwrap_or(std::cmp::Ordering::Equal))?;
    let mut corners = vec![start];
    loop {
        let last = corners[corners.len() - 1];
        let mut next = (last + 1) % nodes.len();
        for n in 0..nodes.len() {
            let side = turn(nodes[last], nodes[next], nodes[n]) / size;
            let farther = {
                let d = |k: usize| (nodes[k][0] - nodes[last][0]).hypot(nodes[k][1] - nodes[last][1]);
                d(n) > d(next)
            };
            if n != last && (next == last || side < -ON_SIDE * size || side.abs() <= ON_SIDE * size && farther) {
                next = n;
            }
        }
        if next == start {
            break;
        }
        if corners.contains(&next) || corners.len() > nodes.len() {
            return None;
        }
        corners.push(next);
    }
    let first = (0..corners.len()).min_by_key(|&k| corners[k])?;
    corners.rotate_left(first);
    (corners.len() > 2).then_some(corners)
}

/// Newton's method for the bilinear coordinates of x in a convex quadrilateral, as weights of its corners.
fn bilinear(q: [[f64; 2]; 4], x: [f64; 2]) -> Vec<f64> {
    let shape = |s: f64, t: f64| [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
    let (mut s, mut t) = (0.5, 0.5);
    for _ in 0..30 {
        let weights = shape(s, t);
        let off = [0, 1].map(|c| x[c] - (0..4).map(|k| weights[k] * q[k][c]).sum::<f64>());
        let along = [0, 1].map(|c| (1.0 - t) * (q[1][c] - q[0][c]) + t * (q[2][c] - q[3][c]));
        let across = [0, 1].map(|c| (1.0 - s) * (q[3][c] - q[0][c]) + s * (q[2][c] - q[1][c]));
        let det = cross(along, across);
        if det == 0.0 {
            break;
        }
        s += cross(off, across) / det;
        t += cross(along, off) / det;
    }
    shape(s, t).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_sides_and_middles_are_found_in_any_order() {
        // A quadratic triangle, numbered at random and clockwise.
        let nodes = [[0.5, 0.5], [0.0, 0.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.0], [0.5, 0.0]];
        let outline = Outline::of(&nodes).expect("a triangle");
        assert_eq!(outline.corners, [1, 4, 2]);
        assert_eq!(outline.sides, [vec![1, 5, 4], vec![4, 0, 2], vec![2, 3, 1]]);
        assert!(outline.inside.is_empty() && (outline.area - 0.5).abs() < 1e-15 && outline.degree() == 2);
        let quad = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]];
        let outline = Outline::of(&quad).expect("a square");
        assert_eq!((outline.corners.as_slice(), outline.inside.as_slice()), (&[0, 1, 3, 2][..], &[4][..]));
        let weights = outline.weights(&quad).expect("four corners");
        assert!(weights.row(4).iter().all(|w| (w - 0.25).abs() < 1e-12));
        assert_eq!(Outline::of(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), None);
        assert_eq!(Outline::of(&[[0.0; 2]; 4]), None);
    }

    #[test]
    fn the_area_does_not_depend_on_the_place() {
        let quad = [[0.0, 0.0], [0.25, 0.0], [0.25, 0.5], [0.0, 0.25]];
        let far = quad.map(|[x, y]| [x + 1e6, y - 3e6]);
        assert_eq!(Outline::of(&far).expect("a quadrilateral").area, 0.09375);
    }

    #[test]
    fn sides_that_are_curved_or_unevenly_divided_are_not_regular() {
        let straight = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
        let with = |middle: [f64; 2]| {
            let mut nodes = straight;
            nodes[3] = middle;
            Outline::of(&nodes).expect("a triangle").is_regular(&nodes)
        };
        assert!(with([0.5, 0.0]) && !with([0.5, -0.1]) && !with([0.5, 0.1]) && !with([0.25, 0.0]));
    }

    #[test]
    fn a_side_of_three_nodes_has_simpsons_weights() {
        let nodes = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
        let weights = side_weights(&nodes, &[0, 2, 1], |_| 1.0);
        for (w, simpson) in weights.iter().zip([1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]) {
            assert!((w - simpson).abs() < 1e-14);
        }
    }
}
