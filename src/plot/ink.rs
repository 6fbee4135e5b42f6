//! Colours, markers and dash patterns.

use plotters::style::RGBColor;

/// How series number i is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ink {
    /// Colour after Okabe and Ito, the last seven after Tol.
    pub colour: RGBColor,
    /// Length of dashes and of the space between them, in pixels; `None` is a solid line.
    pub dash: Option<[i32; 2]>,
    /// Corners of the marker in pixels about its centre.
    pub marker: &'static [(i32, i32)],
}

const CIRCLE: &[(i32, i32)] =
    &[(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (-4, -3), (-3, -4), (0, -5), (3, -4), (4, -3)];
const DIAMOND: &[(i32, i32)] = &[(0, -6), (6, 0), (0, 6), (-6, 0)];
const SQUARE: &[(i32, i32)] = &[(-4, -4), (4, -4), (4, 4), (-4, 4)];
const UP: &[(i32, i32)] = &[(0, -6), (5, 4), (-5, 4)];
const DOWN: &[(i32, i32)] = &[(0, 6), (5, -4), (-5, -4)];
const PLUS: &[(i32, i32)] =
    &[(-2, -6), (2, -6), (2, -2), (6, -2), (6, 2), (2, 2), (2, 6), (-2, 6), (-2, 2), (-6, 2), (-6, -2), (-2, -2)];
const STAR: &[(i32, i32)] = &[(0, -7), (2, -2), (7, 0), (2, 2), (0, 7), (-2, 2), (-7, 0), (-2, -2)];
const LEFT: &[(i32, i32)] = &[(-6, 0), (4, -5), (4, 5)];
const RIGHT: &[(i32, i32)] = &[(6, 0), (-4, 5), (-4, -5)];
const HOURGLASS: &[(i32, i32)] = &[(-5, -5), (5, -5), (-5, 5), (5, 5)];

const BOW: &[(i32, i32)] = &[(-5, -5), (5, 5), (5, -5), (-5, 5)];
const PENTAGON: &[(i32, i32)] = &[(0, -6), (6, -1), (4, 5), (-4, 5), (-6, -1)];
const UPRIGHT: &[(i32, i32)] = &[(-2, -6), (2, -6), (2, 6), (-2, 6)];
const FLAT: &[(i32, i32)] = &[(-6, -2), (6, -2), (6, 2), (-6, 2)];

/// Number of series that look different.
const COUNT: usize = 14;

/// The markers in the order of the series.
pub const MARKERS: [&[(i32, i32)]; COUNT] =
    [CIRCLE, STAR, SQUARE, DIAMOND, PLUS, UP, DOWN, LEFT, RIGHT, HOURGLASS, BOW, PENTAGON, UPRIGHT, FLAT];

const COLOURS: [RGBColor; COUNT] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
    RGBColor(136, 34, 85),
    RGBColor(153, 153, 51),
    RGBColor(51, 34, 136),
    RGBColor(17, 119, 51),
    RGBColor(170, 68, 153),
    RGBColor(102, 37, 6),
    RGBColor(119, 119, 119),
];

const DASHES: [Option<[i32; 2]>; COUNT] = [
    None,
    Some([14, 4]),
    Some([8, 4]),
    Some([3, 4]),
    Some([18, 8]),
    Some([6, 8]),
    Some([10, 3]),
    Some([5, 2]),
    Some([12, 9]),
    Some([2, 2]),
    Some([22, 4]),
    Some([4, 10]),
    Some([14, 10]),
    Some([7, 6]),
];

impl Ink {
    /// The ink of series `i`; after fourteen they repeat.
    pub fn of(i: usize) -> Ink {
        let i = i % MARKERS.len();
        Ink { colour: COLOURS[i], dash: DASHES[i], marker: MARKERS[i] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_series_share_colour_marker_or_dash() {
        for i in 0..COUNT {
            for j in 0..i {
                let (a, b) = (Ink::of(i), Ink::of(j));
                assert!(a.colour != b.colour && a.marker != b.marker && a.dash != b.dash);
            }
        }
    }
}
