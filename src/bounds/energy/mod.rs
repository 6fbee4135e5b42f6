//! Complementary and potential energy, and the work of loads.

mod complementary;
mod potential;
mod work;

pub use complementary::{
    Complementary, complementary, complementary_of, excess_work, initial_on, square, square_of_section, square_on,
    support_work, work_of_excess,
};
pub use potential::{Potential, initial_energy, initial_work, potential, potential_of, strain_of, strain_on};
pub use work::{work, work_inside, work_of, work_on_edges};

use crate::element::geometry::sub_area;

fn absolute(s: [f64; 3]) -> f64 {
    s[0].abs() + s[1].abs() + s[2].abs()
}

/// Relative error of the area per relative error of the edge vectors: one for a good triangle, its aspect ratio for a sliver.
pub fn shape(corners: [[f64; 2]; 3]) -> f64 {
    let square = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2);
    let [a, b, c] = corners;
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    (longest / (6.0 * sub_area(corners))).max(1.0)
}
