//! Quadrature on triangles, in barycentric coordinates with weights that sum to one.

type Rule = &'static [([f64; 3], f64)];

/// The three edge midpoints, exact to degree 2.
const MIDPOINTS: Rule = &[([0.0, 0.5, 0.5], 1.0 / 3.0), ([0.5, 0.0, 0.5], 1.0 / 3.0), ([0.5, 0.5, 0.0], 1.0 / 3.0)];

/// Six points, exact to degree 4 (Dunavant, Int. J. Numer. Meth. Eng. 21 (1985), rule of degree 4).
const DEGREE_4: Rule = &[
    ([0.108103018168070, 0.445948490915965, 0.445948490915965], 0.223381589678011),
    ([0.445948490915965, 0.108103018168070, 0.445948490915965], 0.223381589678011),
    ([0.445948490915965, 0.445948490915965, 0.108103018168070], 0.223381589678011),
    ([0.816847572980459, 0.091576213509771, 0.091576213509771], 0.109951743655322),
    ([0.091576213509771, 0.816847572980459, 0.091576213509771], 0.109951743655322),
    ([0.091576213509771, 0.091576213509771, 0.816847572980459], 0.109951743655322),
];

/// A rule that integrates polynomials of degree at most `degree` (4 at most) over a triangle, as a mean value.
pub fn triangle_rule(degree: usize) -> Rule {
    match degree {
        0..=2 => MIDPOINTS,
        _ => DEGREE_4,
    }
}
