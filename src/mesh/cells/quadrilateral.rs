//! Quadrilaterals cut into triangles.

/// Difference of two shapes below which they are equally good: a rectangle is always cut along its first diagonal.
const EQUAL: f64 = 1e-9;

/// The triangles of the quadrilateral with these corners: two along the diagonal whose worse triangle is the better one, or
/// the one that is left where two neighbouring corners are the same vertex. `None` where it folds over or has no area.
pub fn cut([a, b, c, d]: [usize; 4], points: &[[f64; 2]]) -> Option<Vec<[usize; 3]>> {
    let mut corners = vec![a, b, c, d];
    corners.dedup();
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if let [a, b, c] = *corners.as_slice() {
        return Some(vec![[a, b, c]]);
    }
    if corners.len() < 3 {
        return None;
    }
    let shape = |t: [usize; 3]| {
        let [p, q, r] = t.map(|v| points[v]);
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let side = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
        area / (side(p, q) + side(q, r) + side(r, p))
    };
    let ways = [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]];
    // Corners may run either way round.
    let worst = ways.map(|[one, other]| {
        let (one, other) = (shape(one), shape(other));
        if one * other > 0.0 { one.abs().min(other.abs()) } else { 0.0 }
    });
    let best = usize::from(worst[1] > worst[0] + EQUAL);
    (worst[best] > 0.0).then(|| ways[best].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[[f64; 2]], t: &[usize; 3]) -> f64 {
        let [p, q, r] = t.map(|v| points[v]);
        0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))
    }

    #[test]
    fn both_ways_round_convex_or_not_the_area_is_kept() {
        for points in [
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            [[0.0, 0.0], [2.0, 0.0], [0.3, 0.3], [0.0, 2.0]],
            [[0.0, 0.0], [3.0, 1.0], [3.2, 2.0], [0.5, 0.8]],
            [[0.0, 2.0], [0.3, 0.3], [2.0, 0.0], [0.0, 0.0]],
        ] {
            let shoelace: f64 = (0..4)
                .map(|i| {
                    let (p, q): ([f64; 2], [f64; 2]) = (points[i], points[(i + 1) % 4]);
                    0.5 * (p[0] * q[1] - p[1] * q[0])
                })
                .sum();
            let parts = cut([0, 1, 2, 3], &points).expect("a quadrilateral");
            assert!((parts.iter().map(|t| area(&points, t)).sum::<f64>() - shoelace).abs() < 1e-14);
            assert!(parts.iter().all(|t| area(&points, t) * shoelace > 0.0), "{points:?}");
        }
    }

    #[test]
    fn corners_that_coincide_leave_a_triangle_and_a_fold_is_refused() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(cut([0, 1, 2, 2], &points), Some(vec![[0, 1, 2]]));
        assert_eq!(cut([0, 1, 2, 0], &points), Some(vec![[0, 1, 2]]));
        assert_eq!(cut([0, 1, 3, 2], &points), None);
        assert_eq!(cut([0, 1, 0, 1], &points).map(|_| ()), None);
    }
}
