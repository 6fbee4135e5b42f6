//! Problems whose answer is without stress.

use super::energy::complementary;
use crate::dual::{DualSolution, Equilibrium};
use crate::problem::{Problem, Scales, amplified};

/// `dual` with λ_h = 0 in place of its stress, where that is the better field.
///
/// Where nothing is applied λ = 0 is admissible, and its lower bound is zero: it is better than a λ_h whose own bound is
/// not above what λ_h misses of equilibrium, and as good as one that is nothing but round-off of the data.
/// The prescribed displacements and gaps then cause no stress: a body is moved rigidly, or a gap stays open.
pub fn without_stress(problem: &Problem, mut dual: DualSolution) -> DualSolution {
    let scales = Scales::new(problem);
    if scales.traction > 0.0 {
        return dual;
    }
    let missed = problem.scene.thickness * dual.equilibrium.work;
    let lower = complementary(problem, &dual.stress).lower() - missed;
    let largest = dual.stress.values_mut().as_flattened().iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let rounding = amplified(dual.stress.largest_degree()) * scales.round_off.stress;
    let round_off = largest <= rounding && lower <= scales.round_off.energy;
    if lower > missed && !round_off {
        return dual;
    }
    dual.stress.values_mut().iter_mut().for_each(|s| *s = [0.0; 3]);
    dual.contact_traction.iter_mut().for_each(|t| t.values_mut().fill(0.0));
    dual.equilibrium = Equilibrium::measure(problem, &dual.stress, &dual.moments);
    dual
}
