//! How adaptive refinement went.

use super::axis::Axis;
use super::outline::polyline;
use super::svg::{Anchor, Svg, look};
use crate::report::HistoryRow;
use crate::report::text::number::significant;

const WIDTH: f64 = 560.0;

/// The exponent r of bound ≈ C · unknowns⁻ʳ, fitted to all meshes by least squares of the logarithms.
pub fn rate(history: &[HistoryRow]) -> Option<f64> {
    let points: Vec<[f64; 2]> = history
        .iter()
        .filter(|row| row.relative_error_bound.is_finite() && row.relative_error_bound > 0.0 && row.unknowns > 0)
        .map(|row| [(row.unknowns as f64).ln(), row.relative_error_bound.ln()])
        .collect();
    let n = points.len() as f64;
    let mean = [0, 1].map(|c| points.iter().map(|p| p[c]).sum::<f64>() / n);
    let xx: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let xy: f64 = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum();
    (xx > 0.0).then(|| -xy / xx)
}

/// Guaranteed relative error against unknowns, both logarithmic.
pub fn history(history: &[HistoryRow]) -> String {
    let (left, top, bottom) = (70.0, 34.0, 290.0);
    let mut svg =
        Svg::new(WIDTH, bottom + 46.0, "Guaranteed relative error against the number of unknowns, one point per mesh");
    let x = Axis::over(history.iter().map(|r| r.unknowns as f64), left, WIDTH - 16.0, true).padded(0.06);
    let y = Axis::over(history.iter().map(|r| r.relative_error_bound), bottom, top, true).padded(0.06);
    x.draw_below(&mut svg, bottom, top, "unknowns");
    y.draw_left(&mut svg, left, WIDTH - 16.0, "guaranteed relative error");
    let points: Vec<[f64; 2]> = history
        .iter()
        .filter(|r| r.unknowns > 0 && r.relative_error_bound > 0.0 && r.relative_error_bound.is_finite())
        .map(|r| [x.at(r.unknowns as f64), y.at(r.relative_error_bound)])
        .collect();
    let (class, colour) = look::SERIES[0];
    svg.path(&format!(r#"class="{class}" fill="none" stroke="{colour}" stroke-width="2""#), "", &polyline(&points));
    for p in &points {
        svg.marker(0, *p, 4.0);
    }
    if let Some(rate) = rate(history) {
        let text = format!("error ≈ unknowns to the power {}", significant(-rate, 2));
        svg.text(&format!("{} {}", look::INK, look::HALO), [WIDTH - 22.0, top + 16.0], Anchor::End, &text);
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn the_rate_of_a_power_law_is_found() {
        let row = |unknowns: usize| HistoryRow {
            triangles: unknowns,
            unknowns,
            lower: 0.0,
            upper: 0.0,
            relative_error_bound: 3.0 * (unknowns as f64).powf(-0.75),
            seconds: 0.0,
            step_seconds: 0.0,
            rate: None,
        };
        let rows: Vec<HistoryRow> = [10, 50, 700, 3000].map(row).to_vec();
        assert!((rate(&rows).unwrap() - 0.75).abs() < 1e-12);
        assert_eq!(rate(&rows[..1]), None);
        assert_eq!(rate(&[]), None);
    }

    #[test]
    fn any_history_is_drawn() {
        let rows = Sample::new(1, Verdict::Agree).dossier().report.history;
        let text = history(&rows);
        assert_well_formed(&text);
        assert_eq!(text.matches("<circle").count(), rows.len());
        assert_well_formed(&history(&rows[..1]));
        assert_well_formed(&history(&[]));
    }
}
