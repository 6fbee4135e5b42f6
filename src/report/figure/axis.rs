//! A linear or logarithmic axis.

use super::svg::{Anchor, Svg, look};
use crate::report::text::number::superscript;

/// Page length of a digit.
const DIGIT: f64 = 8.2;

/// Maps numbers between `from` and `to` to page coordinates between `start` and `end`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis {
    pub from: f64,
    pub to: f64,
    pub start: f64,
    pub end: f64,
    pub log: bool,
}

impl Axis {
    /// An axis that shows all finite `values` (positive ones on a logarithmic axis) and something when there are none.
    pub fn over(values: impl IntoIterator<Item = f64>, start: f64, end: f64, log: bool) -> Self {
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in values.into_iter().filter(|x| x.is_finite() && x.abs() < 1e300 && (!log || *x > 0.0)) {
            from = from.min(x);
            to = to.max(x);
        }
        if from > to {
            (from, to) = (if log { 0.1 } else { 0.0 }, 1.0);
        }
        // A single value, or values that cannot be told apart.
        if to - from <= 1e-14 * to.abs().max(from.abs()) {
            let pad = if to == 0.0 { 1.0 } else { 0.05 * to.abs() };
            (from, to) = if log { (from / 2.0, to * 2.0) } else { (from - pad, to + pad) };
        }
        Axis { from, to, start, end, log }
    }

    /// Room of `fraction` of the length on both sides.
    pub fn padded(mut self, fraction: f64) -> Self {
        if self.log {
            let factor = (self.to / self.from).powf(fraction);
            (self.from, self.to) = (self.from / factor, self.to * factor);
        } else {
            let pad = fraction * (self.to - self.from);
            (self.from, self.to) = (self.from - pad, self.to + pad);
        }
        self
    }

    /// Page coordinate of `x`.
    pub fn at(&self, x: f64) -> f64 {
        let fraction = if self.log {
            (x / self.from).ln() / (self.to / self.from).ln()
        } else {
            (x - self.from) / (self.to - self.from)
        };
        self.start + fraction * (self.end - self.start)
    }

    /// Values worth a tick, at most about `count`, with their labels.
    pub fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        if self.log { self.log_ticks(count) } else { self.linear_ticks(count) }
    }

    /// Ticks whose labels stand beside each other without touching.
    fn ticks_side_by_side(&self) -> Vec<(f64, String)> {
        let apart = |ticks: &[(f64, String)]| {
            ticks.windows(2).all(|pair| {
                let [(a, left), (b, right)] = pair else { return true };
                self.at(*b) - self.at(*a) >= half_width(left) + half_width(right) + DIGIT
            })
        };
        let most = if self.end - self.start < 340.0 { 4 } else { 6 };
        let mut several = (1..=most).rev().map(|count| self.ticks(count));
        several.find(|ticks| apart(ticks)).unwrap_or_else(|| self.ticks(1))
    }

    fn linear_ticks(&self, count: usize) -> Vec<(f64, String)> {
        let span = self.to - self.from;
        let raw = span / count.max(1) as f64;
        let power = 10f64.powf(raw.log10().floor());
        let step = power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= raw * 0.8).unwrap_or(10.0);
        let (first, last) = ((self.from / step - 1e-9).ceil(), (self.to / step + 1e-9).floor());
        let largest = self.from.abs().max(self.to.abs());
        let step_exponent = step.log10().floor() as i32;
        let label = |x: f64| {
            let text = if (1e-4..1e6).contains(&largest) {
                format!("{x:.*}", (-step_exponent).clamp(0, 15) as usize)
            } else {
                let exponent = largest.log10().floor() as i32;
                let digits = (exponent - step_exponent).clamp(0, 15) as usize;
                if x == 0.0 {
                    "0".to_string()
                } else {
                    format!("{:.digits$}×10{}", x / 10f64.powi(exponent), superscript(exponent))
                }
            };
            text.replace('-', "−")
        };
        let steps = (last - first).clamp(0.0, 50.0) as usize;
        (0..=steps).map(|k| (first + k as f64) * step + 0.0).map(|x| (x, label(x))).collect()
    }

    fn log_ticks(&self, count: usize) -> Vec<(f64, String)> {
        let (low, high) = (self.from.log10().floor() as i32, self.to.log10().ceil() as i32);
        let decades = (self.to / self.from).log10();
        let factors: &[f64] = if decades < 1.2 {
            &[1.0, 2.0, 5.0]
        } else if decades < 2.2 {
            &[1.0, 3.0]
        } else {
            &[1.0]
        };
        let every = ((high - low) as usize / count.max(1) + 1) as i32;
        let inside = |x: f64| x >= self.from * (1.0 - 1e-9) && x <= self.to * (1.0 + 1e-9);
        (low..=high)
            .filter(|e| e.rem_euclid(every) == 0)
            .flat_map(|e| factors.iter().map(move |f| (f * 10f64.powi(e), *f, e)))
            .filter(|(x, _, _)| inside(*x))
            .map(|(x, f, e)| {
                let label = match (f, e) {
                    _ if (-3..4).contains(&e) => format!("{x:.*}", (-e).max(0) as usize),
                    (1.0, _) => format!("10{}", superscript(e)),
                    _ => format!("{f}×10{}", superscript(e)),
                };
                (x, label)
            })
            .collect()
    }

    /// Draws the axis horizontally at `y`, with grid lines up to `top`.
    pub fn draw_below(&self, svg: &mut Svg, y: f64, top: f64, title: &str) {
        for (x, label) in self.ticks_side_by_side() {
            let at = self.at(x);
            svg.line(look::GRID, "", [at, top], [at, y + 4.0]);
            // A label near the edge of the page keeps to it.
            let half = half_width(&label);
            let inside = at.min(svg.width - half).max(half);
            svg.text(&format!("{} {}", look::DIM, look::HALO), [inside, y + 18.0], Anchor::Middle, &label);
        }
        svg.line(look::LINE, "", [self.start, y], [self.end, y]);
        let middle = 0.5 * (self.start + self.end);
        svg.text(&format!("{} {}", look::INK, look::HALO), [middle, y + 37.0], Anchor::Middle, title);
    }

    /// Draws the axis vertically at `x`, with grid lines up to `right`; the title stands above it.
    pub fn draw_left(&self, svg: &mut Svg, x: f64, right: f64, title: &str) {
        for (value, label) in self.ticks(5) {
            let at = self.at(value);
            svg.line(look::GRID, "", [x - 4.0, at], [right, at]);
            svg.text(look::DIM, [x - 8.0, at + 4.5], Anchor::End, &label);
        }
        svg.line(look::LINE, "", [x, self.start], [x, self.end]);
        svg.text(look::INK, [4.0, self.end - 12.0], Anchor::Start, title);
    }
}

fn half_width(label: &str) -> f64 {
    0.5 * DIGIT * label.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(from: f64, to: f64, log: bool) -> Vec<String> {
        Axis { from, to, start: 0.0, end: 1.0, log }.ticks(5).into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn long_labels_do_not_touch() {
        for (from, to) in [(-1.7964170, -1.7964098), (0.0, 1.0), (-1.23456789012e-7, -1.23456789011e-7), (1e-9, 1e9)] {
            for log in [false, from > 0.0] {
                let axis = Axis { from, to, start: 250.0, end: 600.0, log };
                let ticks = axis.ticks_side_by_side();
                let ends = ticks.windows(2).map(|pair| {
                    [axis.at(pair[0].0) + half_width(&pair[0].1), axis.at(pair[1].0) - half_width(&pair[1].1)]
                });
                assert!(ends.clone().all(|[before, after]| before < after), "{ticks:?}");
                assert!(!ticks.is_empty(), "{from} {to}");
            }
        }
    }

    #[test]
    fn ticks_are_round_and_told_apart() {
        assert_eq!(labels(0.0, 1.0, false), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let close = labels(-1.796419, -1.796408, false);
        assert!(close.len() >= 3 && close.windows(2).all(|w| w[0] != w[1]), "{close:?}");
        assert_eq!(labels(0.0, 2e11, false)[1], "0.5×10¹¹");
        assert_eq!(labels(1e-3, 1.0, true), ["0.001", "0.01", "0.1", "1"]);
    }

    #[test]
    fn hopeless_ranges_still_give_an_axis() {
        for values in [vec![], vec![f64::NAN], vec![3.0], vec![0.0, 0.0], vec![f64::INFINITY, 1.0]] {
            for log in [false, true] {
                let axis = Axis::over(values.clone(), 0.0, 100.0, log).padded(0.05);
                assert!(axis.from < axis.to, "{values:?}");
                assert!(axis.ticks(5).len() < 60);
            }
        }
    }

    #[test]
    fn ends_map_to_ends() {
        for log in [false, true] {
            let axis = Axis { from: 2.0, to: 8.0, start: 10.0, end: 90.0, log };
            assert!((axis.at(2.0) - 10.0).abs() < 1e-12 && (axis.at(8.0) - 90.0).abs() < 1e-12);
        }
        let axis = Axis { from: 2.0, to: 8.0, start: 0.0, end: 2.0, log: true };
        assert!((axis.at(4.0) - 1.0).abs() < 1e-12);
    }
}
