//! Rings so flat that rounding is not wholly enclosed.
//!
//! The hoop stress of a ring is a derivative of its other stresses. In triangles that are long beside their height it loses digits faster than
//! [`super::terms`] counts: by the third power of that ratio, and more in higher degrees.

use crate::bounds::energy::shape;
use crate::element::StressField;
use crate::problem::{Note, Problem};

/// Length over height of triangles from which on stresses of degree `FINE` and more are not relied on …
const FLAT: f64 = 50.0;
const FINE: usize = 3;
/// … and those of any degree. At 25 a bracket of degree 4 was right with room to spare, at 250 wrong by 6e-10 of the energy (the row
/// `revolved-flat` of the stability matrix at 1e-2 and at 1e-3).
const FLATTEST: f64 = 1000.0;

/// A note on such triangles; none in the plane, and where there are none.
pub fn flat_rings(problem: &Problem, stress: &StressField) -> Option<Note> {
    problem.section().revolved()?;
    let is_flat = |t: &usize| {
        let ratio = shape(problem.mesh.corners(*t));
        ratio > FLATTEST || ratio > FLAT && stress.degree(*t) >= FINE
    };
    let count = (0..problem.mesh.triangles.len()).filter(is_flat).count();
    (count > 0).then(|| Note {
        weakens_guarantee: true,
        text: format!(
            "{count} of the triangles of bodies of revolution are more than {FLAT} times as long as high; their stresses lose digits that the \
             enclosure of rounding does not count, so that the last digits of the bounds may be wrong"
        ),
    })
}
