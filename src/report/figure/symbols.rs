//! Symbols of supports and loads, in page coordinates.

use super::outline::{Station, polyline, stations};
use super::svg::{Svg, look};

/// The outward direction at a station of a boundary that has its body on the left: on the page, where y points down,
/// the tangent turned by a right angle against the clock as seen by the reader is inside.
pub(crate) fn outward((_, tangent): Station) -> [f64; 2] {
    [-tangent[1], tangent[0]]
}

fn along(p: [f64; 2], d: [f64; 2], length: f64) -> [f64; 2] {
    [p[0] + length * d[0], p[1] + length * d[1]]
}

/// A strong line with slanted ticks on its outer side: no displacement.
pub(crate) fn clamped(svg: &mut Svg, line: &[[f64; 2]]) {
    svg.path(look::SUPPORT, r#"stroke-width="3""#, &polyline(line));
    hatch(svg, line, 1.0);
}

/// Slanted ticks beside a line, on the outer side for `side` = 1.
pub(crate) fn hatch(svg: &mut Svg, line: &[[f64; 2]], side: f64) {
    let mut d = String::new();
    for station in stations(line, 7.0) {
        let (p, tangent) = station;
        let tip = along(along(p, outward(station), 9.0 * side), tangent, -6.0);
        d.push_str(&polyline(&[p, tip]));
    }
    svg.path(look::SUPPORT, r#"stroke-width="1.2""#, &d);
}

/// Circles between the body and a line: no normal displacement, no friction.
pub(crate) fn roller(svg: &mut Svg, line: &[[f64; 2]]) {
    let radius = 4.0;
    for station in stations(line, 20.0) {
        svg.circle(
            &format!(r#"{} stroke-width="1.4""#, look::SUPPORT),
            along(station.0, outward(station), radius + 1.0),
            radius,
        );
    }
    let shifted: Vec<[f64; 2]> = line
        .windows(2)
        .flat_map(|w| {
            let length = (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
            let station = (w[0], [(w[1][0] - w[0][0]) / length, (w[1][1] - w[0][1]) / length]);
            let n = outward(station);
            [along(w[0], n, 2.0 * radius + 2.0), along(w[1], n, 2.0 * radius + 2.0)]
        })
        .collect();
    svg.path(look::SUPPORT, r#"stroke-width="1.6""#, &polyline(&shifted));
}

/// Zigzags between the body and the ground: springs.
pub(crate) fn springs(svg: &mut Svg, line: &[[f64; 2]]) {
    let mut d = String::new();
    for station in stations(line, 20.0) {
        let (p, tangent) = station;
        let n = outward(station);
        let at = |out: f64, aside: f64| along(along(p, n, out), tangent, aside);
        let zigzag = [(2.0, 0.0), (4.0, 3.0), (7.0, -3.0), (10.0, 3.0), (12.0, 0.0), (15.0, 0.0)];
        let points: Vec<[f64; 2]> = [p]
            .into_iter()
            .chain(zigzag.map(|(out, aside)| at(out, aside)))
            .chain([at(15.0, -5.0), at(15.0, 5.0)])
            .collect();
        d.push_str(&polyline(&points));
    }
    svg.path(look::SUPPORT, r#"stroke-width="1.2""#, &d);
}

/// An arrow of page length |v| that ends at `p`, or starts there where `tail` is set.
pub(crate) fn arrow(svg: &mut Svg, look: &str, p: [f64; 2], v: [f64; 2], tail: bool) {
    let length = v[0].hypot(v[1]);
    if !length.is_finite() || length < 1.5 {
        return;
    }
    let d = [v[0] / length, v[1] / length];
    let (start, tip) = if tail { (p, along(p, d, length)) } else { (along(p, d, -length), p) };
    let head = 6.0_f64.min(0.6 * length);
    let base = along(tip, d, -head);
    let side = [-d[1], d[0]];
    svg.line(look, r#"stroke-width="1.4""#, start, base);
    let triangle = [tip, along(base, side, 0.45 * head), along(base, side, -0.45 * head)];
    svg.path(look, r#"stroke-width="0""#, &(polyline(&triangle) + "z"));
}
