//! A scalar field as colours, one value per triangle.

use std::fmt::Write;

use super::axis::Axis;
use super::mark::{Mark, Spot, draw, draw_spots};
use super::outline::{View, outline, polyline};
use super::raster::raster;
use super::svg::{Anchor, Svg, look, px};
use super::viridis::{LEVELS, colour, level};
use crate::problem::Problem;

pub(crate) const WIDTH: f64 = 560.0;
/// Height of the colour bar with its numbers.
const BAR: f64 = 58.0;
/// With more triangles than this the map is drawn on a grid, to keep the page small.
const DRAWN_TRIANGLES: usize = 8000;
/// Page length of a cell of that grid.
const CELL: f64 = 2.5;
/// A range this many times its middle is shown on a logarithmic scale.
const LOG_FROM: f64 = 25.0;

/// The colour scale of a map.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// Value of the darkest colour.
    pub from: f64,
    /// Value of the lightest colour.
    pub to: f64,
    /// True if equal ratios rather than equal differences look equal.
    pub log: bool,
}

impl Scale {
    /// A scale for `values`: logarithmic where they are not negative and their largest is far above their median.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (Some(&least), Some(&most)) = (sorted.first(), sorted.last()) else {
            return Scale { from: 0.0, to: 1.0, log: false };
        };
        let positive = &sorted[sorted.partition_point(|v| *v <= 0.0)..];
        let middle = positive.get(positive.len() / 2).copied().unwrap_or(0.0);
        if least >= 0.0 && middle > 0.0 && most > LOG_FROM * middle {
            // The smallest values are noise; two per cent of them share the darkest colour.
            let from = positive[positive.len() / 50].max(1e-6 * most);
            return Scale { from, to: most, log: true };
        }
        let axis = Axis::over([least, most], 0.0, 1.0, false);
        Scale { from: axis.from, to: axis.to, log: false }
    }

    fn level(&self, value: f64) -> usize {
        let fraction = if self.log && value <= 0.0 { 0.0 } else { self.axis(0.0, 1.0).at(value) };
        level(fraction)
    }

    fn axis(&self, start: f64, end: f64) -> Axis {
        Axis { from: self.from, to: self.to, start, end, log: self.log }
    }
}

/// True if a map of this problem is drawn on a grid, each cell showing the largest value in it.
pub fn is_coarsened(problem: &Problem) -> bool {
    problem.mesh.triangles.len() > DRAWN_TRIANGLES
}

/// Where the bodies are on a map, and its height.
pub(crate) fn view(problem: &Problem) -> (View, f64) {
    View::fit(problem.mesh.points.iter().copied(), WIDTH, 420.0, 8.0)
}

/// The map of `values`, one per triangle, on `scale`; triangles whose value is no number stay blank. What is coloured is a group of
/// the class `cells`.
pub fn map(
    problem: &Problem,
    title: &str,
    values: &[f64],
    scale: &Scale,
    (marks, spots): (&[Mark], &[Spot]),
) -> String {
    let (view, height) = view(problem);
    let mut svg = Svg::new(WIDTH, height, format!("{title}: a map over the bodies"));
    svg.raw(format_args!(r#"<g class="cells">"#));
    if is_coarsened(problem) {
        cells(&mut svg, problem, values, &view, height, scale);
    } else {
        triangles(&mut svg, problem, values, &view, scale);
    }
    svg.raw(format_args!("</g>"));
    for body in 0..problem.scene.bodies.len() {
        svg.path(look::LINE, r#"stroke-width="1""#, &outline(&problem.mesh, body, &view));
    }
    draw_spots(&mut svg, spots, |at| view.at(at));
    draw(&mut svg, marks, |mark| view.at(mark.at));
    svg.finish()
}

/// The colours of a scale with its numbers.
pub fn bar(title: &str, scale: &Scale) -> String {
    let mut svg = Svg::new(WIDTH, BAR, format!("Colours of the map, {title}"));
    colours(&mut svg, scale);
    svg.finish()
}

fn triangles(svg: &mut Svg, problem: &Problem, values: &[f64], view: &View, scale: &Scale) {
    let mut paths = vec![String::new(); LEVELS];
    for (t, &value) in values.iter().enumerate().take(problem.mesh.triangles.len()).filter(|(_, v)| v.is_finite()) {
        let path = &mut paths[scale.level(value)];
        path.push_str(&polyline(&problem.mesh.corners(t).map(|p| view.at(p))));
        path.push('z');
    }
    for (l, d) in paths.iter().enumerate() {
        let colour = colour(l);
        // The thin line closes the hairlines that anti-aliasing leaves between neighbours.
        svg.path(
            &format!(r#"fill="{colour}" stroke="{colour}" stroke-width="0.6" shape-rendering="crispEdges""#),
            "",
            d,
        );
    }
}

fn cells(svg: &mut Svg, problem: &Problem, values: &[f64], view: &View, height: f64, scale: &Scale) {
    let grid = raster(&problem.mesh, values, view, WIDTH, height, CELL);
    let mut paths = vec![String::new(); LEVELS];
    for (row, cells) in grid.values.chunks(grid.columns).enumerate() {
        let mut column = 0;
        while column < cells.len() {
            let start = column;
            let level_of = |v: f64| v.is_finite().then(|| scale.level(v));
            let l = level_of(cells[start]);
            while column < cells.len() && level_of(cells[column]) == l {
                column += 1;
            }
            if let Some(l) = l {
                // A run of equal cells is a stroke as wide as a cell, a little longer than they are, so that no hairline stays
                // between runs. Writing to a String cannot fail.
                let (x, y) = (start as f64 * grid.cell, (row as f64 + 0.5) * grid.cell);
                let _ = write!(paths[l], "M{} {}h{}", px(x), px(y), px((column - start) as f64 * grid.cell + 0.4));
            }
        }
    }
    for (l, d) in paths.iter().enumerate() {
        svg.path(
            &format!(
                r#"fill="none" stroke="{}" stroke-width="{}" shape-rendering="crispEdges""#,
                colour(l),
                px(grid.cell + 0.3)
            ),
            "",
            d,
        );
    }
}

fn colours(svg: &mut Svg, scale: &Scale) {
    let (left, right, y) = (40.0, WIDTH - 40.0, 8.0);
    let step = (right - left) / LEVELS as f64;
    for l in 0..LEVELS {
        svg.rect(
            &format!(r#"fill="{}" shape-rendering="crispEdges""#, colour(l)),
            left + l as f64 * step,
            y,
            step + 0.4,
            12.0,
        );
    }
    let axis = scale.axis(left, right);
    let name = if scale.log { "logarithmic scale" } else { "" };
    for (value, label) in axis.ticks(6) {
        let at = axis.at(value);
        svg.line(look::LINE, "", [at, y + 12.0], [at, y + 17.0]);
        svg.text(look::INK, [at, y + 31.0], Anchor::Middle, &label);
    }
    if !name.is_empty() {
        svg.text(look::DIM, [right, y + 44.0], Anchor::End, name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn scales_follow_the_data() {
        let linear = Scale::of(&[1.0, 2.0, 3.0]);
        assert!(!linear.log && linear.from == 1.0 && linear.to == 3.0);
        let values: Vec<f64> = (0..100).map(|k| 10f64.powf(-0.06 * f64::from(k))).collect();
        let log = Scale::of(&values);
        assert!(log.log && log.to == 1.0 && log.from < 1e-5);
        assert_eq!((log.level(1.0), log.level(0.0)), (LEVELS - 1, 0));
        assert!(!Scale::of(&[-1.0, 1e-3, 1e-3, 5.0]).log);
        assert!(Scale::of(&[]).to > 0.0 && Scale::of(&[f64::NAN]).to > 0.0);
        let flat = Scale::of(&[2.0, 2.0]);
        assert!(flat.from < 2.0 && flat.to > 2.0);
    }

    #[test]
    fn few_triangles_are_drawn_one_by_one() {
        let sample = Sample::new(3, Verdict::Agree);
        let text = {
            let values: Vec<f64> = (0..36).map(f64::from).collect();
            map(&sample.problem, "<von Mises>", &values, &Scale::of(&values), (&[], &[]))
        };
        assert_well_formed(&text);
        // 36 triangles, 2 outlines, and the ticks are single lines without a z.
        assert_eq!(text.matches('z').count() - text.matches("size").count(), 38);
    }

    #[test]
    fn a_fine_map_stays_small() {
        let sample = Sample::new(96, Verdict::Agree);
        assert!(is_coarsened(&sample.problem));
        let noise: Vec<f64> = (0..sample.problem.mesh.triangles.len()).map(|t| ((t * 7919) % 1009) as f64).collect();
        let text = map(&sample.problem, "noise", &noise, &Scale::of(&noise), (&[], &[]));
        assert!(text.len() < 700_000, "{}", text.len());
        let smooth: Vec<f64> =
            sample.problem.mesh.triangles.iter().map(|t| sample.problem.mesh.points[t[0]][0]).collect();
        let text = map(&sample.problem, "smooth", &smooth, &Scale::of(&smooth), (&[], &[]));
        assert!(text.len() < 150_000, "{}", text.len());
    }
}
