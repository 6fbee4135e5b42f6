//! Equivalent and principal stresses, and what intervals of the components tell of them.

use super::interval::Interval;
use crate::scene::Invariant;

/// A number that σ_xx, σ_yy, σ_xy determine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Invariants {
    /// Which.
    pub invariant: Invariant,
    /// The stress across the plane is this times σ_xx + σ_yy …
    pub across: f64,
    /// … and this.
    pub offset: f64,
}

/// Steps over which slopes are taken, relative to the largest component.
const STEP: f64 = 1e-6;

impl Invariants {
    /// Its value.
    pub fn value(&self, [xx, yy, xy]: [f64; 3]) -> f64 {
        let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        match self.invariant {
            // (½(σ_xx + σ_yy) − σ_zz)² + ¾(σ_xx − σ_yy)² + 3σ_xy².
            Invariant::VonMises => ((1.0 - 2.0 * self.across) * mean - self.offset).hypot(3.0_f64.sqrt() * radius),
            Invariant::LargestPrincipal => mean + radius,
            Invariant::SmallestPrincipal => mean - radius,
        }
    }

    /// The least and the largest value of components within these bounds.
    pub fn enclosed(&self, [xx, yy, xy]: [[f64; 2]; 3]) -> [f64; 2] {
        let shear = [
            if xy[0] <= 0.0 && xy[1] >= 0.0 { 0.0 } else { xy[0].abs().min(xy[1].abs()) },
            xy[0].abs().max(xy[1].abs()),
        ];
        match self.invariant {
            // Both grow with either normal stress; the larger one with the shear, the smaller one falls with it.
            Invariant::LargestPrincipal => [0, 1].map(|k| self.value([xx[k], yy[k], shear[k]])),
            Invariant::SmallestPrincipal => [0, 1].map(|k| self.value([xx[k], yy[k], shear[1 - k]])),
            // A convex function of the components: largest in a corner.
            Invariant::VonMises => {
                let corners = xx.into_iter().flat_map(|x| yy.map(|y| [x, y, shear[1]]));
                let upper = corners.map(|s| self.value(s)).fold(0.0, f64::max);
                [self.least(xx, yy, shear[0]), upper]
            }
        }
    }

    /// The least of von Mises' stress, a convex function: inside the rectangle of normal stresses, or on a side of it.
    fn least(&self, xx: [f64; 2], yy: [f64; 2], shear: f64) -> f64 {
        let within = |x: f64, [low, high]: [f64; 2]| x.max(low).min(high);
        // With m = qs/2 − c for the first term above, the best other normal stress for a given one.
        let (q, c) = (1.0 - 2.0 * self.across, self.offset);
        let best = |s: f64| ((1.5 - 0.5 * q * q) * s + q * c) / (1.5 + 0.5 * q * q);
        let all = if q == 0.0 { 0.0 } else { c / q };
        let mut candidates = vec![[within(all, xx), within(all, yy)]];
        for k in 0..2 {
            candidates.push([xx[k], within(best(xx[k]), yy)]);
            candidates.push([within(best(yy[k]), xx), yy[k]]);
        }
        candidates.into_iter().map(|[x, y]| self.value([x, y, shear])).fold(f64::INFINITY, f64::min)
    }

    /// The interval that follows from those of the three components.
    pub fn interval(&self, components: [Interval; 3]) -> Interval {
        let all = |ends: [[f64; 2]; 3]| {
            if ends.iter().flatten().all(|end| end.is_finite()) {
                self.enclosed(ends)
            } else {
                [if self.invariant == Invariant::VonMises { 0.0 } else { f64::NEG_INFINITY }, f64::INFINITY]
            }
        };
        let ends = all(components.each_ref().map(|own| own.ends));
        let values = components.each_ref().map(|own| own.value);
        let slopes = self.slopes(values);
        let triangles = components[0].shares.len();
        let share = |t: usize| (0..3).map(|c| slopes[c] * components[c].shares.get(t).copied().unwrap_or(0.0)).sum();
        let reason = components.iter().flat_map(|own| own.reasons.iter().flatten()).next().cloned();
        Interval {
            ends,
            first_order: all(components.each_ref().map(|own| own.first_order)),
            value: self.value(values).max(ends[0]).min(ends[1]),
            exact_by_statics: components.iter().all(|own| own.exact_by_statics),
            rounding: components.iter().map(|own| own.rounding).sum(),
            reasons: ends.map(|end| if end.is_finite() { None } else { reason.clone() }),
            shares: (0..triangles).map(share).collect(),
        }
    }

    /// The absolute values of the derivatives.
    fn slopes(&self, values: [f64; 3]) -> [f64; 3] {
        let step = STEP * values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        [0, 1, 2].map(|c| {
            let moved = |by: f64| {
                let mut moved = values;
                moved[c] += by;
                self.value(moved)
            };
            let slope = 0.5 * (moved(step) - moved(-step)).abs() / step;
            if slope.is_finite() { slope } else { 1.0 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enclosures_hold_all_values_and_are_met() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        for invariant in Invariant::ALL {
            for (across, offset) in [(0.0, 0.0), (0.3, 0.2), (0.49, -0.4)] {
                let of = Invariants { invariant, across, offset };
                for _ in 0..200 {
                    let bounds = [0, 1, 2].map(|_| {
                        let (a, b) = (random(), 0.4 * random());
                        [a.min(a + b), a.max(a + b)]
                    });
                    let [low, high] = of.enclosed(bounds);
                    let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
                    let steps = 24;
                    for i in 0..=steps {
                        for j in 0..=steps {
                            for k in 0..=steps {
                                let at = [i, j, k];
                                let value = of.value([0, 1, 2].map(|c| {
                                    bounds[c][0] + f64::from(at[c]) / f64::from(steps) * (bounds[c][1] - bounds[c][0])
                                }));
                                (least, largest) = (least.min(value), largest.max(value));
                            }
                        }
                    }
                    assert!(low <= least + 1e-12 && high >= largest - 1e-12, "{of:?} {bounds:?}");
                    // Shear stresses of either sign are nearest to zero between two points of the grid.
                    assert!(low >= least - 0.02 && high <= largest + 0.02, "{of:?} {bounds:?}: {low} {least}");
                }
            }
        }
    }
}
