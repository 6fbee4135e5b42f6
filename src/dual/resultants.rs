//! Resultants that the tractions of each triangle by itself leave.
//!
//! The tractions on its sides and its body force must have neither a resultant nor a moment. In the basis of an element that
//! is so to the last digits; where bases are shared by triangles that are congruent to most of their digits, or where numbers
//! resolve a triangle badly, it is so to fewer, and tractions that are continuous do not show it. Inside, tractions across the segments from the
//! corners to the centroid must be continuous.

use rayon::prelude::*;

use crate::element::geometry::from_centroid;
use crate::element::{SideValues, StressField};
use crate::problem::Problem;

/// Σ |resultant| · |displacement| + |moment| · |rotation| + ∫ |jump inside| · |displacement| over all triangles, per unit thickness;
/// `moments` are those of the displacement on the edges, ∫ u B_k ds.
pub fn work_within(problem: &Problem, stress: &StressField, moments: &SideValues<[f64; 2]>) -> f64 {
    let mesh = &problem.mesh;
    let mean = |e: usize| {
        let (length, _) = mesh.edge_frame(e);
        [0, 1].map(|c| moments.of(e).iter().map(|m| m[c]).sum::<f64>() / length)
    };
    let means: Vec<[f64; 2]> = (0..moments.len()).into_par_iter().with_min_len(1024).map(mean).collect();
    let of = |t: usize| {
        let corners = from_centroid(mesh.corners(t));
        let [fx, fy, moment] = match problem.section().revolved() {
            // The hoop stress balances what is along r.
            Some(_) => {
                let [_, axial] = problem.section().forces(problem.body_force(t));
                let force = axial * problem.section().volume(mesh.corners(t));
                [0.0, resultant(stress, t, corners, [0.0, force])[1], 0.0]
            }
            None => {
                let force = problem.force_on(t).of_area(mesh.area(t));
                let [fx, fy, moment] = resultant(stress, t, corners, force.resultant());
                [fx, fy, moment + force.moment()]
            }
        };
        let of_edges = mesh.triangle_edges[t].map(|e| means[e]);
        let largest = of_edges.iter().fold(0.0_f64, |m, u| m.max(u[0].hypot(u[1])));
        let longest = (0..3).map(|i| along(corners, i)).fold(0.0_f64, |m, [x, y]| m.max(x.hypot(y)));
        // The midpoints of two sides lie half of the third apart.
        let apart = |i: usize| [0, 1].map(|c| of_edges[i][c] - of_edges[(i + 1) % 3][c]);
        let turned = (0..3).map(apart).fold(0.0_f64, |m, [x, y]| m.max(x.hypot(y))) / (0.5 * longest);
        (fx.hypot(fy) + jumps(stress, t, corners)) * largest + moment.abs() * turned
    };
    let terms: Vec<f64> = (0..stress.len()).into_par_iter().with_min_len(256).map(of).collect();
    terms.into_iter().sum()
}

/// The side from corner i + 1 to corner i + 2.
fn along(corners: [[f64; 2]; 3], i: usize) -> [f64; 2] {
    let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
    [b[0] - a[0], b[1] - a[1]]
}

/// Force and moment about the centroid of the tractions on the sides of triangle `t`, whose `corners` are seen from there, and of
/// a `force` in it.
fn resultant(stress: &StressField, t: usize, corners: [[f64; 2]; 3], force: [f64; 2]) -> [f64; 3] {
    let degree = stress.degree(t) as f64;
    let mut sum = [force[0], force[1], 0.0];
    for side in 0..3 {
        let (start, [dx, dy]) = (corners[(side + 1) % 3], along(corners, side));
        for (k, [xx, yy, xy]) in stress.on_side(t, side).enumerate() {
            // ∫ B_k is 1/(p + 1) of the side, and has its centre at (k + 1)/(p + 2).
            let share = 1.0 / (degree + 1.0);
            let at = (k as f64 + 1.0) / (degree + 2.0);
            let [x, y] = [start[0] + at * dx, start[1] + at * dy];
            let traction = [share * (xx * dy - xy * dx), share * (xy * dy - yy * dx)];
            sum[0] += traction[0];
            sum[1] += traction[1];
            sum[2] += x * traction[1] - y * traction[0];
        }
    }
    sum
}

/// ∫ |jump of traction| along the three segments from the corners of triangle `t` to its centroid, which is the origin of `corners`.
fn jumps(stress: &StressField, t: usize, corners: [[f64; 2]; 3]) -> f64 {
    let of_segment = |corner: usize| {
        let [dx, dy] = corners[corner];
        let size = |[xx, yy, xy]: [f64; 3]| (xx * dy - xy * dx).hypot(xy * dy - yy * dx);
        stress.jump_inside(t, corner).map(size).sum::<f64>()
    };
    (0..3).map(of_segment).sum::<f64>() / (stress.degree(t) as f64 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 2]; 3] = [[0.2, -0.1], [1.7, 0.4], [0.5, 1.3]];

    fn constant(value: [f64; 3]) -> StressField {
        let mut stress = StressField::zeros(2, 1);
        stress.values_mut().fill(value);
        stress
    }

    #[test]
    fn a_constant_stress_is_in_balance_and_a_body_force_against_nothing_is_not() {
        let corners = from_centroid(CORNERS);
        let found = resultant(&constant([1.0, -2.0, 0.7]), 0, corners, [0.0; 2]);
        assert!(found.iter().all(|x| x.abs() < 1e-15), "{found:?}");
        let found = resultant(&constant([0.0; 3]), 0, corners, [0.3, -0.4]);
        assert_eq!(found, [0.3, -0.4, 0.0]);
    }

    /// A pressure q on the first subtriangle alone jumps by q across two segments.
    #[test]
    fn jumps_inside_are_seen() {
        let corners = from_centroid(CORNERS);
        let mut stress = StressField::zeros(2, 1);
        assert_eq!(jumps(&stress, 0, corners), 0.0);
        stress.block_mut(0)[..6].fill([3.0, 3.0, 0.0]);
        let expected = 3.0 * (corners[1][0].hypot(corners[1][1]) + corners[2][0].hypot(corners[2][1]));
        assert!((jumps(&stress, 0, corners) - expected).abs() < 1e-14 * expected);
    }

    /// (xx, yy, xy) = (−Fx x, −Fy y, 0) balances F, wherever its origin is; turned by an antisymmetric part it would not.
    #[test]
    fn linear_stresses_that_balance_a_body_force() {
        let (corners, force, origin) = (from_centroid(CORNERS), [0.3, -0.4], [5.0, -3.0]);
        let area = 0.5 * (along(corners, 2)[0] * -along(corners, 1)[1] - along(corners, 2)[1] * -along(corners, 1)[0]);
        let mut stress = StressField::zeros(1, 1);
        for sub in 0..3 {
            let nodes = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], [0.0; 2]];
            for (value, [x, y]) in stress.block_mut(0)[3 * sub..].iter_mut().zip(nodes) {
                *value = [-force[0] * (x - origin[0]), -force[1] * (y - origin[1]), 0.0];
            }
        }
        let found = resultant(&stress, 0, corners, force.map(|f| f * area));
        assert!(found.iter().all(|x| x.abs() < 1e-14), "{found:?}");
        // Shear that grows along x has the resultant −A along y.
        for sub in 0..3 {
            let nodes = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], [0.0; 2]];
            for (value, [x, _]) in stress.block_mut(0)[3 * sub..].iter_mut().zip(nodes) {
                *value = [0.0, 0.0, x];
            }
        }
        let found = resultant(&stress, 0, corners, [0.0; 2]);
        assert!((found[1] - area).abs() < 1e-15 && found[0].abs() < 1e-15, "{found:?} {area}");
    }
}
