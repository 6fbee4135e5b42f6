//! Axes: positions on a linear sheet, tick marks and their labels.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

use crate::report::text::number::{significant, superscript};

/// How values are placed.
#[derive(Debug, Clone, PartialEq)]
pub enum Scale {
    /// By their logarithm.
    Logarithmic,
    /// By their cube root, on which an error of hp methods falls on a straight line.
    CubeRoot,
    /// Side by side in their order: values are indices into the labels.
    Ordinal(Vec<String>),
}

/// An axis that fits its values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// Positions of the two ends.
    pub range: [f64; 2],
    /// Positions of tick marks, with labels.
    pub ticks: Vec<(f64, String)>,
}

impl Scale {
    /// Position of a value; `None` where the scale has no place for it.
    pub(super) fn position(&self, value: f64) -> Option<f64> {
        match self {
            Scale::Logarithmic => (value.is_finite() && value > 0.0).then(|| value.log10()),
            Scale::CubeRoot => (value.is_finite() && value >= 0.0).then(|| value.cbrt()),
            Scale::Ordinal(_) => value.is_finite().then_some(value),
        }
    }

    /// An axis for values at these positions.
    pub(super) fn axis(&self, positions: impl Iterator<Item = f64>) -> Ticks {
        if let Scale::Ordinal(labels) = self {
            let ticks = labels.iter().enumerate().map(|(i, label)| (i as f64, label.clone())).collect();
            return Ticks { range: [-0.5, labels.len().max(1) as f64 - 0.5], ticks };
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in positions {
            (low, high) = (low.min(p), high.max(p));
        }
        if *self == Scale::CubeRoot {
            return cube_roots(if high > 0.0 { high } else { 1.0 });
        }
        if low > high {
            (low, high) = (-1.0, 0.0);
        }
        let margin = (0.06 * (high - low)).max(0.12);
        let range = [low - margin, high + margin];
        let (first, last) = (range[0].ceil() as i32, range[1].floor() as i32);
        let step = ((last - first) / 8 + 1).max(1) as usize;
        let mut ticks: Vec<(f64, String)> =
            (first..=last).step_by(step).map(|k| (f64::from(k), power_of_ten(k))).collect();
        if ticks.len() < 3 {
            for k in first - 1..=last {
                for digit in [2.0, 5.0] {
                    let value = digit * 10.0_f64.powi(k);
                    let p = value.log10();
                    if range[0] <= p && p <= range[1] {
                        ticks.push((p, significant(value, 1)));
                    }
                }
            }
            ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        Ticks { range, ticks }
    }
}

/// From zero to `high`, with ticks of one digit that stand apart.
fn cube_roots(high: f64) -> Ticks {
    let range = [0.0, 1.04 * high];
    let mut ticks = vec![(0.0, "0".to_string())];
    let decades = -6..=(3.0 * high.log10()).ceil() as i32;
    for value in decades.flat_map(|k| [1.0, 2.0, 5.0].map(|digit| digit * 10.0_f64.powi(k))) {
        let (at, apart) = (value.cbrt(), 0.09 * range[1]);
        if at <= range[1] && ticks.last().is_some_and(|(last, _)| at - last >= apart) {
            ticks.push((at, significant(value, 1)));
        }
    }
    Ticks { range, ticks }
}

fn power_of_ten(k: i32) -> String {
    if (-2..=3).contains(&k) { significant(10.0_f64.powi(k), 1) } else { format!("10{}", superscript(k)) }
}

impl Ranged for Ticks {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, position: &f64, (first, last): (i32, i32)) -> i32 {
        let [low, high] = self.range;
        first + (f64::from(last - first) * (position - low) / (high - low)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.iter().map(|(p, _)| *p).collect() }
    }

    fn range(&self) -> Range<f64> {
        self.range[0]..self.range[1]
    }
}

impl ValueFormatter<f64> for Ticks {
    fn format(position: &f64) -> String {
        significant(*position, 3)
    }

    fn format_ext(&self, position: &f64) -> String {
        let near = self.ticks.iter().find(|(p, _)| (p - position).abs() < 1e-9);
        near.map_or(String::new(), |(_, label)| label.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_have_ticks_and_every_value_a_place_inside() {
        let axis = Scale::Logarithmic.axis([1e-9_f64, 1e3].iter().map(|v| v.log10()));
        assert!(axis.range[0] < -9.0 && axis.range[1] > 3.0);
        assert!(axis.ticks.len() >= 4 && axis.ticks.len() <= 13);
        assert!(axis.ticks.iter().all(|(p, label)| p.fract() == 0.0 && !label.is_empty()));
    }

    #[test]
    fn cube_roots_begin_at_zero_and_have_ticks_at_round_values() {
        for most in [3.0_f64, 900.0, 60_000.0, 2e7] {
            let axis = Scale::CubeRoot.axis([0.1 * most, most].iter().map(|v| v.cbrt()));
            assert!(axis.range[0] == 0.0 && axis.range[1] > most.cbrt() && (4..=12).contains(&axis.ticks.len()));
            assert!(axis.ticks.windows(2).all(|w| w[1].0 > w[0].0 && w[1].1 != w[0].1), "{:?}", axis.ticks);
        }
        assert_eq!(Scale::CubeRoot.position(27.0), Some(27.0_f64.cbrt()));
    }

    #[test]
    fn less_than_a_decade_still_has_ticks() {
        let axis = Scale::Logarithmic.axis([0.3_f64, 0.45].iter().map(|v| v.log10()));
        assert!(!axis.ticks.is_empty());
        assert!(Scale::Logarithmic.position(0.0).is_none() && Scale::Logarithmic.position(f64::NAN).is_none());
    }
}
