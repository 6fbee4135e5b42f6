//! Tractions that are polynomials of degree 2 to 6, on scenes of the other families.

use super::{Family, Made, curved, lattice, mixed, rough, stack, turned};
use crate::support::random::Random;
use crate::support::toml::numbers;

/// Kinds of scenes that have such tractions.
const KINDS: [Family; 7] =
    [lattice::blocks, lattice::shapes, stack::made, curved::curved, rough::rough, mixed::mixed, turned::turned];

/// A scene whose tractions have terms, most of them.
pub fn powers(random: &mut Random) -> Made {
    let made = random.pick(&KINDS)(random);
    let reach = made.toml.reach();
    let often = random.pick(&[0.5, 1.0]);
    let toml = made.toml.with_each("tractions", |table| match random.chance(often) {
        true => termed(random, table, reach),
        false => table.to_owned(),
    });
    Made { toml, ..made }
}

/// A table with terms as large as the traction is, as far as the scene reaches.
fn termed(random: &mut Random, table: &str, reach: f64) -> String {
    let size = |line: &str| numbers(line).fold(0.0_f64, |most, x| x.abs().max(most));
    let mut load = 0.0_f64;
    let mut lines: Vec<String> = Vec::new();
    for line in table.lines() {
        let has = |key: &str| line.starts_with(key);
        load = if has("pressure") || has("value") { size(line) } else { load };
        // Terms stand beside a traction, in whatever direction, and not beside a pressure.
        lines.push(match has("pressure") {
            true => format!("value = {:?}", [0.3 * load * random.between(-1.0, 1.0), -load]),
            false => line.to_owned(),
        });
    }
    let term = |random: &mut Random| {
        let degree = random.pick(&[2, 2, 3, 4, 5, 6]);
        let first = random.below(degree + 1);
        let value = [0, 1].map(|_| load * random.between(-1.0, 1.0) / reach.powi(degree as i32));
        format!("{{ powers = {:?}, value = {value:?} }}", [first, degree - first])
    };
    let terms: Vec<String> = (0..1 + random.below(3)).map(|_| term(random)).collect();
    lines.push(format!("terms = [{}]", terms.join(", ")));
    lines.join("\n")
}
