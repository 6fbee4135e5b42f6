//! The interval of a quantity, and every value that is held against it.

use super::axis::Axis;
use super::svg::{Anchor, Svg, look, px};
use crate::report::quantity::Held;
use crate::report::text::number::significant;
use crate::report::{QuantitySummary, Report};
use crate::scene::counted;

const WIDTH: f64 = 560.0;
const LANE: f64 = 28.0;
const TOP: f64 = 8.0;
/// Width of the column of names and values.
const LABELS: f64 = 232.0;
/// Longest name that fits there beside its value.
const NAME: usize = 17;
/// A value so many widths away from the interval is an arrow at the edge.
const FAR: f64 = 6.0;
/// Range of an axis on either side of a point, relative to it.
const AROUND: f64 = 0.05;

/// One lane for the interval and one for each value, over an axis of the quantity's own; `None` where there is no number to
/// draw.
pub fn quantity(summary: &QuantitySummary, report: &Report) -> Option<String> {
    let own =
        Held { of: "dual solve".to_string(), degree: None, value: Some(summary.value), reason: None, allowed: None };
    let mut list = vec![own];
    list.extend(summary.held(report));
    list.retain(|held| held.value.is_some_and(f64::is_finite));
    if list.is_empty() {
        return None;
    }
    let values = list.iter().filter_map(|held| held.value);
    let axis = axis(summary, values);
    let bottom = TOP + LANE * (list.len() + 1) as f64;
    let [lower, upper] = summary.ends();
    let label = format!(
        "{}: the exact value lies between {lower} and {upper}; marked on the axis: {}",
        summary.name,
        counted(list.len(), "value")
    );
    let mut svg = Svg::new(WIDTH, bottom + 42.0, label);
    band(&mut svg, summary, &axis, bottom);
    for (lane, held) in list.iter().enumerate() {
        mark(&mut svg, summary, held, &axis, lane);
    }
    Some(svg.finish())
}

/// An axis that shows the interval, and the values that are not far from it.
fn axis(summary: &QuantitySummary, values: impl Iterator<Item = f64> + Clone) -> Axis {
    let shown = |list: Vec<f64>| Axis::over(list, LABELS + 12.0, WIDTH - 22.0, false);
    let ends: Vec<f64> = [summary.lower, summary.upper].into_iter().filter(|end| end.is_finite()).collect();
    if summary.is_point() {
        let around = [1.0 - AROUND, 1.0 + AROUND].map(|factor| factor * summary.value);
        return shown(values.chain(around).collect()).padded(0.06);
    }
    let width = summary.upper - summary.lower;
    let near = values.filter(|x| !width.is_finite() || summary.outside(*x) <= FAR * width);
    shown(near.chain(ends).collect()).padded(if summary.is_enclosed() { 0.08 } else { 0.25 })
}

/// The interval: a bar, an arrow for an end that is missing, a point where there is no width.
fn band(svg: &mut Svg, summary: &QuantitySummary, axis: &Axis, bottom: f64) {
    let y = TOP + 0.5 * LANE;
    let [a, b] = [summary.lower, summary.upper].map(|end| axis.at(end).clamp(axis.start, axis.end));
    if !summary.is_point() {
        svg.rect(look::BAND, a, TOP, b - a, bottom - TOP);
    }
    axis.draw_below(svg, bottom, TOP, &summary.kind);
    svg.text(&format!(r#"{} font-weight="600""#, look::INK), [4.0, y + 4.5], Anchor::Start, "exact value");
    if summary.is_point() {
        let words = if summary.exact_by_statics { "exact by statics" } else { "known but for rounding" };
        svg.circle(look::INK, [axis.at(summary.value), y], 5.5);
        svg.line(look::LINE, "", [axis.at(summary.value), y], [axis.at(summary.value), bottom]);
        svg.text(look::DIM, [LABELS, y + 4.5], Anchor::End, words);
        return;
    }
    svg.line(look::LINE, r#"stroke-width="3""#, [a, y], [b, y]);
    for (end, x, outwards) in [(summary.lower, a, -1.0), (summary.upper, b, 1.0)] {
        if end.is_finite() {
            svg.line(look::LINE, r#"stroke-width="1.5""#, [x, TOP + 4.0], [x, bottom]);
        } else {
            arrow(svg, look::INK, [x, y], outwards);
        }
    }
    let words = if summary.is_enclosed() { "in this interval" } else { "an end is missing" };
    svg.text(look::DIM, [LABELS, y + 4.5], Anchor::End, words);
}

/// A value in its lane; one far outside is an arrow at the edge.
fn mark(svg: &mut Svg, summary: &QuantitySummary, held: &Held, axis: &Axis, lane: usize) {
    let value = held.value.unwrap_or(f64::NAN);
    let y = TOP + LANE * (lane as f64 + 1.5);
    let outside = summary.outside(value);
    let look = if outside > 0.0 { look::BAD } else { look::INK };
    svg.text(look, [4.0, y + 4.5], Anchor::Start, &shortened(&held.of));
    let dim = if outside > 0.0 { look::BAD } else { look::DIM };
    svg.text(dim, [LABELS, y + 4.5], Anchor::End, &significant(value, summary.digits()));
    svg.line(look::GRID, "", [axis.start, y], [axis.end, y]);
    let x = axis.at(value);
    if x < axis.start || x > axis.end {
        let outwards = if x < axis.start { -1.0 } else { 1.0 };
        arrow(svg, look::BAD, [x.clamp(axis.start, axis.end), y], outwards);
    } else {
        svg.marker(lane, [x, y], 5.5);
    }
    if outside > 0.0 {
        let text = format!("outside by {}", significant(outside, 3));
        let left = x > 0.5 * (axis.start + axis.end);
        let (anchor, shift) = if left { (Anchor::End, -14.0) } else { (Anchor::Start, 14.0) };
        let at = [x.clamp(axis.start, axis.end) + shift, y + 4.5];
        svg.text(&format!("{} {}", look::BAD, look::HALO), at, anchor, &text);
    }
}

/// The head of an arrow with its point at `tip`.
fn arrow(svg: &mut Svg, look: &str, [x, y]: [f64; 2], outwards: f64) {
    let back = x - 11.0 * outwards;
    svg.path(look, "", &format!("M{} {}L{} {}L{} {}z", px(x), px(y), px(back), px(y - 6.0), px(back), px(y + 6.0)));
}

/// A name that fits into its column.
fn shortened(name: &str) -> String {
    if name.chars().count() <= NAME { name.to_string() } else { name.chars().take(NAME - 1).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::{Basis, Check};
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    fn report() -> Report {
        Sample::new(1, Verdict::Agree).dossier().report
    }

    #[test]
    fn every_value_has_a_lane_and_its_distance() {
        let mut report = report();
        let name = report.quantities[0].name.clone();
        report.quantities[0].primal[0].value = Some(0.82);
        let check = Check::with_difference(
            &format!("quantity/{name}/given"),
            5.0,
            0.81,
            4.19,
            0.0,
            Basis::Guaranteed,
            "No correct value lies outside.",
        );
        report.checks.push(check);
        let text = quantity(&report.quantities[0], &report).unwrap();
        assert_well_formed(&text);
        for piece in
            ["dual solve", "FEniCSx P2", ">given<", "outside by 0.01<", "outside by 4.19<", "tip &lt;a&amp;b&gt;"]
        {
            assert!(text.contains(piece), "{piece} in {text}");
        }
        // The value that is far away does not shrink the interval: it is an arrow.
        let rect = text.split("<rect").nth(1).unwrap();
        let width: f64 = rect.split("width=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        assert!(width > 60.0, "{width}");
        assert_eq!(text.matches("z\"/>").count(), 2, "the square of FEniCSx P2 and the arrow");
    }

    #[test]
    fn missing_ends_are_arrows_and_points_are_points() {
        let report = report();
        let seat = quantity(&report.quantities[1], &report).unwrap();
        assert!(seat.contains("an end is missing") && seat.contains('∞'));
        let whole = quantity(&report.quantities[2], &report).unwrap();
        assert!(whole.contains("exact by statics") && !whole.contains("<rect"));
    }

    #[test]
    fn any_interval_is_drawn() {
        let mut report = report();
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        for (lower, value, upper) in
            [(0.0, 0.0, 0.0), (-inf, 1.0, inf), (-inf, -1e300, 1e300), (1.0, nan, 2.0), (-1e-300, 0.0, 1e-300)]
        {
            let summary = &mut report.quantities[0];
            (summary.lower, summary.value, summary.upper) = (lower, value, upper);
            let text = quantity(&report.quantities[0], &report).unwrap();
            assert_well_formed(&text);
            assert!(!text.contains("NaN"), "{text}");
        }
        let summary = &mut report.quantities[0];
        (summary.lower, summary.value, summary.upper) = (-inf, nan, inf);
        summary.primal.clear();
        assert_eq!(quantity(&report.quantities[0], &report), None);
    }
}
