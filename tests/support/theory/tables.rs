//! The tables of `docs/theory.md`, from the numbers of `docs/data/`.

use super::constant::Row;
use super::rates::{DEGREES, Study};

/// Smallest angle, c(α), c(α) sin²α.
pub fn constants(rows: &[Row]) -> Vec<String> {
    let line = |r: &Row| format!("| {}° | {:.1} | {:.2} |", r.angle, r.constant, r.times_sin_squared);
    rows.iter().map(line).collect()
}

/// One line for each solution and family, with the rates of `quantities`.
pub fn rates(studies: &[Study], quantities: &[&str]) -> Vec<String> {
    let of = |first: &Study| {
        let rate = |quantity: &&str| {
            let same = |s: &&Study| s.solution == first.solution && s.family == first.family && s.quantity == *quantity;
            studies.iter().find(same).map_or(f64::NAN, |s| s.rate)
        };
        let cells: Vec<String> = quantities.iter().map(|q| format!("{:.2}", rate(q))).collect();
        format!("| {} | {} | {} |", first.solution, first.family, cells.join(" | "))
    };
    studies.iter().filter(|s| s.quantity == quantities[0]).map(of).collect()
}

/// Columns of the tables on degrees, for what is measured of them.
pub fn of_degrees(quantity: &str) -> [String; 4] {
    DEGREES.map(|degree| format!("{quantity}, p = {degree}"))
}

/// One line for each solution and family, with the rate of every degree.
pub fn rates_of_degrees(studies: &[Study]) -> Vec<String> {
    let of = |quantity: &str| rates(studies, &of_degrees(quantity).each_ref().map(String::as_str));
    [of("L2 error of r_h τ"), of("L2 error of λ_h")].concat()
}

/// Columns of the table on contact solutions.
pub const CONTACT: [&str; 5] = [
    "L2 error of λ_h",
    "largest error of λ_h at a quadrature point",
    "L2 error of T_n on Γ_K",
    "energy error of −Π(λ_h)",
    "energy error of the free upper bound",
];

/// Column of the table on r_h.
pub const INTERPOLATION: [&str; 1] = ["L2 error of r_h τ"];
