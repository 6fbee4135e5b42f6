//! Contacts with friction, its bound given: none that matters, some, or more than is ever reached.

use super::{Made, lattice, stack};
use crate::support::random::Random;
use crate::support::toml::Toml;

/// Blocks or polygons on a lattice, or bodies on top of each other, most of their contacts with friction.
pub fn rough(random: &mut Random) -> Made {
    if random.chance(0.35) {
        let made = stack::made(random);
        let toml = rubbed(random, &made.toml, 1.0, 1.0);
        return Made { toml, ..made };
    }
    let (made, traction, length) = lattice::loaded(random);
    let toml = rubbed(random, &made.toml, traction, length);
    Made { toml, ..made }
}

/// Friction of the size of `traction` on contacts of about this `length`.
fn rubbed(random: &mut Random, toml: &Toml, traction: f64, length: f64) -> Toml {
    let often = random.pick(&[0.6, 1.0]);
    toml.with_each("contacts", |table| {
        if !random.chance(often) {
            return table.to_owned();
        }
        let size = traction * random.magnitude(-2.5, 1.5);
        let bound = match random.below(6) {
            0 => {
                let rows = [[0.0, 0.0], [0.3 * length, size], [length, 0.5 * size]];
                format!("{rows:?}")
            }
            1 => format!("{:?}", [[0.0, size], [0.7 * length, 0.0]]),
            _ => format!("{size:?}"),
        };
        format!("{table}\nfriction = {{ bound = {bound} }}")
    })
}
