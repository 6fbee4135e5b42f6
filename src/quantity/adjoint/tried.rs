//! Predicts the width at another ratio from the ratios tried.
//!
//! At the end of a contact the adjoint stress grows like 1/√r and the pressure falls like √r. A ratio ρ clips the part that is nearer
//! than about 1/ρ, and the energy of the clipped part is proportional to that distance: D² = d² + c/ρ, where d is due to the mesh.

use super::end::width;

/// Ratios are looked for over so many powers of two beyond those that were tried, in such steps.
const REACH: i32 = 12;
const STEPS: i32 = 8;

/// Part of the width that a try has to promise.
const WORTH_A_TRY: f64 = 0.03;

/// Ratios and the distances D that they gave.
#[derive(Debug, Default)]
pub(in crate::quantity) struct Tried {
    found: Vec<[f64; 2]>,
}

impl Tried {
    /// Adds what `ratio` gave, the end of which asked for less or for all of it.
    pub fn add(&mut self, [ratio, asked]: [f64; 2], distance: f64) {
        self.found.extend([asked, ratio].map(|ratio| [ratio, distance]));
        self.found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        self.found.dedup();
    }

    /// The ratio to try next, `square` being H; none where nothing is to be gained.
    pub fn next(&self, square: f64) -> Option<f64> {
        let wide = |[ratio, distance]: &[f64; 2]| width(*distance, square, *ratio);
        let (at, best) = self.found.iter().map(wide).enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let law = self.law(at);
        let near = self.found[at][0];
        // The largest of those that promise the same.
        let promised = (-REACH * STEPS..=REACH * STEPS).rev().map(|k| {
            let ratio = near * (f64::from(k) / f64::from(STEPS)).exp2();
            (ratio, width(law.distance(ratio), square, ratio))
        });
        let (ratio, promised) = promised.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (promised < (1.0 - WORTH_A_TRY) * best).then_some(ratio)
    }

    /// The law through the try `at` and its nearest neighbour.
    fn law(&self, at: usize) -> Law {
        let [ratio, distance] = self.found[at];
        let beside = [at.checked_sub(1), Some(at + 1)].into_iter().flatten().filter_map(|i| self.found.get(i));
        let nearest = beside.min_by(|a, b| (a[0] / ratio).ln().abs().total_cmp(&(b[0] / ratio).ln().abs()));
        let all = distance * distance * ratio;
        let clipped = match nearest {
            Some([other, far]) if *other != ratio => (distance * distance - far * far) / (1.0 / ratio - 1.0 / other),
            _ => all,
        };
        let clipped = if clipped.is_finite() { clipped.clamp(0.0, all) } else { all };
        Law { clipped, rest: distance * distance - clipped / ratio }
    }
}

/// D² = rest + clipped/ρ.
struct Law {
    rest: f64,
    clipped: f64,
}

impl Law {
    fn distance(&self, ratio: f64) -> f64 {
        (self.rest + self.clipped / ratio).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tries until nothing is promised, where D² = rest + clipped/ρ.
    fn search(rest: f64, clipped: f64, square: f64, first: f64) -> (Vec<f64>, f64) {
        let of = |ratio: f64| (rest + clipped / ratio).sqrt();
        let mut tried = Tried::default();
        let mut ratios = vec![first];
        tried.add([first, first], of(first));
        while let Some(next) = tried.next(square) {
            tried.add([next, next], of(next));
            ratios.push(next);
            assert!(ratios.len() < 10, "{ratios:?}");
        }
        let best = ratios.iter().map(|&ratio| width(of(ratio), square, ratio)).fold(f64::INFINITY, f64::min);
        (ratios, best)
    }

    #[test]
    fn a_few_tries_find_the_ratio_of_least_width() {
        for (rest, clipped) in [(0.0, 1.0), (0.01, 1.0), (1.0, 0.1), (1e-4, 30.0)] {
            for (square, first) in [(1e-3, 0.5), (1e-5, 3.0), (1e-7, 1000.0)] {
                let (ratios, found) = search(rest, clipped, square, first);
                let of = |k: i32| {
                    let ratio = (f64::from(k) / 50.0).exp();
                    width((rest + clipped / ratio).sqrt(), square, ratio)
                };
                let least = (-600..=900).map(of).fold(f64::INFINITY, f64::min);
                assert!(found <= 1.05 * least, "{found} where {least} can be had: {ratios:?}");
                assert!(ratios.len() <= 5, "{ratios:?}");
            }
        }
    }

    #[test]
    fn nothing_is_gained_by_another_ratio_where_none_was_asked_for_in_full() {
        let mut tried = Tried::default();
        tried.add([40.0, 0.4], 0.1);
        assert_eq!(tried.next(1e-2), None);
    }
}
