//! Which triangles have the same shape.

use std::collections::HashMap;
use std::hash::Hash;

/// Edge vectors that agree to this fraction of the size of a triangle are the same: well above what rounding of the coordinates
/// does, well below what equilibrium could notice.
pub const SAME: f64 = 1.0 / (1_u64 << 42) as f64;

/// Edge vectors of a triangle in units of its size, rounded up to a power of two, and the exponent of that. Triangles with the same
/// vectors are similar and not turned against each other; with the same exponent too they are congruent.
pub fn shape([a, b, c]: [[f64; 2]; 3]) -> ([i64; 4], i64) {
    let sides = [b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]];
    let largest = sides.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let exponent = largest.log2().ceil();
    let unit = exponent.exp2() * SAME;
    (sides.map(|v| (v / unit).round() as i64), exponent as i64)
}

/// Numbers equal keys alike, in the order in which they come: the class of each, and the place of the first of each class.
pub fn classes<K: Eq + Hash>(keys: impl Iterator<Item = K>) -> (Vec<u32>, Vec<usize>) {
    let mut seen = HashMap::new();
    let mut first = Vec::new();
    let class = keys.enumerate().map(|(place, key)| {
        let next = first.len() as u32;
        *seen.entry(key).or_insert_with(|| {
            first.push(place);
            next
        })
    });
    (class.collect(), first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_keys_have_one_class_from_the_first_of_them_on() {
        let (class, first) = classes("abacbd".chars());
        assert_eq!((class, first), (vec![0, 1, 0, 2, 1, 3], vec![0, 1, 3, 5]));
    }

    #[test]
    fn shapes_are_those_of_similar_triangles_that_are_not_turned() {
        let triangle = [[0.1, 0.7], [1.3, 0.9], [0.4, 1.6]];
        let (own, exponent) = shape(triangle);
        assert_eq!(shape(triangle.map(|[x, y]| [x + 3.0, y - 2.0])), (own, exponent));
        assert_eq!(shape(triangle.map(|[x, y]| [0.25 * x, 0.25 * y])), (own, exponent - 2));
        assert_ne!(shape(triangle.map(|[x, y]| [-y, x])).0, own);
        assert_ne!(shape([triangle[1], triangle[2], triangle[0]]).0, own);
        assert_ne!(shape(triangle.map(|[x, y]| [x, y * (1.0 + 1e-11)])).0, own);
    }
}
