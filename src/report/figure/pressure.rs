//! Contact pressure along an interface, from every model.

use std::fmt::Write;

use super::axis::Axis;
use super::svg::{Anchor, Svg, look, px};
use crate::report::ContactSummary;

pub(super) const WIDTH: f64 = 560.0;
/// Where the axis of arc lengths begins and ends.
pub(super) const LEFT: f64 = 62.0;
pub(super) const RIGHT: f64 = WIDTH - 14.0;
const DASHES: [&str; 5] = ["", "8 4", "2 3", "10 3 2 3", "5 2"];
/// Markers per curve.
const MARKERS: usize = 16;

/// A part of the length of a contact at least as large as this, relative to the whole, is not worth cutting off.
const WORTH_CUTTING: f64 = 0.25;
/// Pressures below this fraction of the largest are none.
const NONE: f64 = 1e-3;

/// The arc lengths between which pressures are, or bodies meet, with some room; all of the contact where that is most of it.
pub fn extent(contact: &ContactSummary) -> [f64; 2] {
    let points =
        || contact.profiles.iter().flat_map(|profile| &profile.points).filter(|p| p.iter().all(|x| x.is_finite()));
    let largest = points().fold(0.0_f64, |m, p| m.max(p[1].abs()));
    let pressed = points().filter(|p| p[1].abs() > NONE * largest).map(|p| p[0]);
    let all = pressed.chain(contact.contact_ends.iter().copied().filter(|s| s.is_finite()));
    let [from, to] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| [low.min(s), high.max(s)]);
    let room = 0.15 * (to - from);
    let [from, to] = [(from - room).max(0.0), (to + room).min(contact.length)];
    let cut = contact.length - (to - from);
    if from < to && cut > WORTH_CUTTING * contact.length { [from, to] } else { [0.0, contact.length] }
}

/// The axis of arc lengths, with room for all `marks`.
pub(super) fn along(extent: [f64; 2], marks: &[(f64, usize)]) -> Axis {
    Axis::over(marks.iter().map(|mark| mark.0).chain(extent), LEFT, RIGHT, false)
}

/// Pressure against arc length; jumps are drawn upright, ends of contact as dotted lines, and `marks` (arc length, number) where
/// something is wrong.
pub fn pressure(contact: &ContactSummary, marks: &[(f64, usize)]) -> String {
    let rows = contact.profiles.len() as f64;
    let (left, top, bottom) = (LEFT, 10.0 + 20.0 * rows, 300.0 + 20.0 * rows);
    let mut svg =
        Svg::new(WIDTH, bottom + 46.0, format!("Pressure along the contact {} from every model", contact.name));
    let [from, to] = extent(contact);
    let x = along([from, to], marks);
    let shown = |s: f64| (x.from..=x.to).contains(&s);
    let values = contact.profiles.iter().flat_map(|p| p.points.iter()).filter(|p| shown(p[0]));
    let y = Axis::over(values.map(|p| p[1]).chain([0.0]), bottom, top + 24.0, false).padded(0.03);
    x.draw_below(&mut svg, bottom, top + 24.0, "arc length along the contact");
    y.draw_left(&mut svg, left, RIGHT, "pressure");
    if y.from < 0.0 {
        svg.line(look::LINE, r#"stroke-width="0.8""#, [left, y.at(0.0)], [RIGHT, y.at(0.0)]);
    }
    for &end in contact.contact_ends.iter().filter(|s| shown(**s)) {
        svg.line(
            look::SUPPORT,
            r#"stroke-dasharray="1 4" stroke-width="1.5""#,
            [x.at(end), bottom],
            [x.at(end), top + 24.0],
        );
    }
    for (i, profile) in contact.profiles.iter().enumerate() {
        let finite: Vec<Option<[f64; 2]>> = profile
            .points
            .iter()
            .map(|p| (p[1].is_finite() && shown(p[0])).then(|| [x.at(p[0]), y.at(p[1])]))
            .collect();
        curve(&mut svg, i, &finite);
        let row = 14.0 + 20.0 * i as f64;
        sample(&mut svg, i, [150.0, row]);
        svg.text(look::INK, [206.0, row + 4.5], Anchor::Start, &profile.model);
    }
    for &(s, number) in marks.iter().filter(|(s, _)| s.is_finite()) {
        svg.raw(format_args!(r#"<g class="place" data-cause="{number}">"#));
        svg.line(look::CONTACT, r#"stroke-width="2""#, [x.at(s), bottom], [x.at(s), top + 24.0]);
        svg.text(
            &format!("{} {}", look::BAD, look::HALO),
            [x.at(s) + 4.0, top + 36.0],
            Anchor::Start,
            &number.to_string(),
        );
        svg.raw(format_args!("</g>"));
    }
    svg.finish()
}

pub(super) fn stroke(series: usize) -> String {
    let (class, colour) = look::SERIES[series % look::SERIES.len()];
    let width = if series == 0 { 2.4 } else { 1.7 };
    let dash = DASHES[series % DASHES.len()];
    format!(r#"class="{class}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-dasharray="{dash}""#)
}

/// The path of a curve that is interrupted where a number is missing.
pub(super) fn path_of(points: &[Option<[f64; 2]>]) -> String {
    let mut d = String::new();
    let mut pen: Option<[f64; 2]> = None;
    for point in points {
        match (point, pen) {
            // On a fine mesh many points fall on the same spot of the page.
            (Some(p), Some(last)) if (p[0] - last[0]).hypot(p[1] - last[1]) < 0.3 => {}
            (Some(p), _) => {
                // Writing to a String cannot fail.
                let _ = write!(d, "{}{} {}", if pen.is_some() { 'L' } else { 'M' }, px(p[0]), px(p[1]));
                pen = *point;
            }
            (None, _) => pen = None,
        }
    }
    d
}

/// A curve with its markers.
fn curve(svg: &mut Svg, series: usize, points: &[Option<[f64; 2]>]) {
    svg.path(&stroke(series), "", &path_of(points));
    let every = points.len().div_ceil(MARKERS).max(1);
    // Series start their markers at different points, so that equal curves show all of them.
    for p in points.iter().skip((series * every) / 3).step_by(every).flatten() {
        svg.marker(series, *p, 3.4);
    }
}

/// A piece of the curve for the legend.
pub(super) fn sample(svg: &mut Svg, series: usize, at: [f64; 2]) {
    svg.line(&stroke(series), "", at, [at[0] + 46.0, at[1]]);
    svg.marker(series, [at[0] + 23.0, at[1]], 3.6);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn models_differ_in_dash_and_marker_and_are_named() {
        let report = Sample::new(4, Verdict::Disagree).dossier().report;
        let contact = &report.contact[0];
        let text = pressure(contact, &[(0.25, 1)]);
        assert_well_formed(&text);
        for (i, profile) in contact.profiles.iter().enumerate() {
            assert!(text.contains(&format!("stroke-dasharray=\"{}\"", DASHES[i])), "{i}");
            assert!(text.contains(&profile.model));
        }
        assert!(text.contains("<circle") && text.contains("class=\"m s1\"") && text.contains("class=\"m s2\""));
    }

    #[test]
    fn what_stays_open_is_cut_off() {
        let mut contact = Sample::new(4, Verdict::Agree).dossier().report.contact.remove(0);
        let profile = |points: &[[f64; 2]]| crate::report::Profile { model: "dual".into(), points: points.to_vec() };
        contact.contact_ends = vec![0.4, 0.6];
        contact.profiles = vec![profile(&[[0.0, 0.0], [0.4, 0.0], [0.5, 3.0], [0.6, 0.0], [1.0, 0.0]])];
        let [from, to] = extent(&contact);
        assert!((from - 0.37).abs() < 1e-12 && (to - 0.63).abs() < 1e-12, "{from} {to}");
        contact.profiles = vec![profile(&[[0.0, 1.0], [1.0, 1.0]])];
        assert_eq!(extent(&contact), [0.0, 1.0]);
    }

    #[test]
    fn missing_numbers_interrupt_the_curve() {
        let mut svg = Svg::new(1.0, 1.0, "");
        curve(&mut svg, 0, &[Some([0.0, 0.0]), Some([1.0, 1.0]), None, Some([2.0, 2.0]), Some([3.0, 3.0])]);
        assert!(svg.finish().contains("M0 0L1 1M2 2L3 3"));
    }

    #[test]
    fn nothing_to_draw_is_no_harm() {
        let mut contact = Sample::new(1, Verdict::Agree).dossier().report.contact.remove(0);
        contact.profiles.clear();
        contact.length = f64::NAN;
        assert_well_formed(&pressure(&contact, &[]));
    }
}
