//! The energy bracket: the interval that holds the exact energy, and every computed energy beside it.

use super::axis::Axis;
use super::svg::{Anchor, Svg, look};
use crate::report::Report;
use crate::report::text::number::{digits_to_tell, enclosing, significant};
use crate::report::text::words::energies;

const WIDTH: f64 = 560.0;
const LANE: f64 = 42.0;
/// Width of the column of names and values.
const LABELS: f64 = 206.0;
/// Longest name that fits there.
const NAME: usize = 29;

/// One lane per energy over an axis; the interval [lower, upper] is a band through all lanes. Where the energies spread
/// much wider than the bracket, a second panel shows its neighbourhood.
pub fn bracket(report: &Report) -> String {
    let Some(energy) = report.energy.as_ref().filter(|e| e.lower.is_finite() && e.upper.is_finite()) else {
        return Svg::new(WIDTH, 10.0, "No energy bracket").finish();
    };
    let (lower, upper) = (energy.lower, energy.upper);
    let list: Vec<(String, f64)> = energies(report).into_iter().filter(|e| e.1.is_finite()).collect();
    let [from, to] = enclosing([lower, upper], digits_to_tell(lower, upper));
    let label =
        format!("The exact energy lies between {from} and {to}; {} energies are marked on the axis", list.len());
    let wide = Axis::over(list.iter().map(|e| e.1).chain([lower, upper]), LABELS, WIDTH - 22.0, false).padded(0.06);
    let zoomed = wide.to - wide.from > 8.0 * (upper - lower).abs() && upper != lower;
    let panel = |lanes: usize| 34.0 + LANE * lanes as f64;
    let all: Vec<usize> = (0..list.len()).collect();
    if !zoomed {
        let mut svg = Svg::new(WIDTH, panel(list.len()) + 44.0, label);
        lanes(&mut svg, &list, &all, &wide, [lower, upper], 0.0, "energy");
        return svg.finish();
    }
    let pad = 0.5 * (upper - lower).abs();
    let near = Axis { from: lower.min(upper) - pad, to: lower.max(upper) + pad, ..wide };
    let close: Vec<usize> = all.iter().copied().filter(|&i| (near.from..=near.to).contains(&list[i].1)).collect();
    let below = panel(list.len());
    let top = below + 58.0;
    let mut svg = Svg::new(WIDTH, top + panel(close.len()) + 44.0, label);
    for x in [lower, upper] {
        svg.line(look::SUPPORT, r#"stroke-dasharray="2 3""#, [wide.at(x), below], [near.at(x), top + 19.0]);
    }
    let factor = (wide.to - wide.from) / (near.to - near.from);
    lanes(&mut svg, &list, &all, &wide, [lower, upper], 0.0, "energy");
    lanes(
        &mut svg,
        &list,
        &close,
        &near,
        [lower, upper],
        top,
        &format!("energy, {} times enlarged", significant(factor, 2)),
    );
    svg.finish()
}

/// One panel with the energies `shown`.
fn lanes(
    svg: &mut Svg,
    list: &[(String, f64)],
    shown: &[usize],
    axis: &Axis,
    [lower, upper]: [f64; 2],
    top: f64,
    title: &str,
) {
    let bottom = top + 34.0 + LANE * shown.len() as f64;
    let (a, b) = (axis.at(lower.min(upper)), axis.at(lower.max(upper)));
    svg.rect(if lower <= upper { look::BAND } else { look::BAD }, a, top + 22.0, (b - a).max(1.5), bottom - top - 22.0);
    axis.draw_below(svg, bottom, top + 22.0, title);
    for x in [a, b] {
        svg.line(look::LINE, r#"stroke-width="1.2""#, [x, top + 19.0], [x, bottom]);
    }
    let band = if lower <= upper { "the exact energy lies here" } else { "the bounds contradict each other" };
    let room = 88.0;
    let at = (0.5 * (a + b)).clamp(axis.start + room, axis.end - room);
    svg.text(&format!(r#"{} {} font-weight="600""#, look::INK, look::HALO), [at, top + 14.0], Anchor::Middle, band);
    for (lane, &i) in shown.iter().enumerate() {
        let (name, value) = &list[i];
        let y = top + 48.0 + LANE * lane as f64;
        svg.line(look::GRID, "", [axis.start, y], [axis.end, y]);
        let digits = digits_to_tell(*value, lower).max(digits_to_tell(upper, lower));
        let below = *value < lower - 1e-13 * lower.abs();
        let look = if below { look::BAD } else { look::INK };
        svg.text(look, [4.0, y - 4.0], Anchor::Start, &shortened(name));
        let note = if below { "  below the bound" } else { "" };
        let text = format!("{}{note}", significant(*value, digits));
        svg.text(if below { look::BAD } else { look::DIM }, [4.0, y + 13.0], Anchor::Start, &text);
        svg.marker(i, [axis.at(*value), y], 5.5);
    }
}

/// A name that fits into its column.
fn shortened(name: &str) -> String {
    if name.chars().count() <= NAME { name.to_string() } else { name.chars().take(NAME - 1).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn every_energy_is_marked() {
        let report = Sample::new(2, Verdict::Agree).dossier().report;
        let text = bracket(&report);
        assert_well_formed(&text);
        for name in ["lower bound", "free upper bound", "FEniCSx P1", "FEniCSx P2"] {
            assert!(text.contains(name), "{name}");
        }
        // P1 lies far from the bracket, so there is a second panel, and P1 is not in it.
        assert!(text.contains("enlarged"));
        assert_eq!((text.matches("FEniCSx P1").count(), text.matches("FEniCSx P2").count()), (1, 2));
    }

    #[test]
    fn an_energy_on_the_wrong_side_is_said() {
        let text = bracket(&Sample::new(2, Verdict::Disagree).dossier().report);
        assert!(text.contains("below the bound"));
        let mut report = Sample::new(2, Verdict::Agree).dossier().report;
        let energy = report.energy.as_mut().unwrap();
        (energy.lower, energy.upper) = (energy.upper, energy.lower);
        assert!(bracket(&report).contains("contradict"));
    }

    #[test]
    fn degenerate_brackets_are_drawn() {
        let mut report = Sample::new(2, Verdict::Agree).dossier().report;
        for (lower, upper) in [(0.0, 0.0), (-1.0, -1.0), (f64::NAN, 1.0), (-1e-300, 1e300)] {
            let energy = report.energy.as_mut().unwrap();
            (energy.lower, energy.upper) = (lower, upper);
            assert_well_formed(&bracket(&report));
        }
    }
}
