//! Pictures of findings, as SVG.

use std::fmt::Write;

use nalgebra::DVector;

use super::outline::Outline;
use crate::plot::{Scale, Series, Sheet, draw};
use crate::report::figure::svg::{Anchor, Svg, look, px};

/// Pixels of a panel.
const PANEL: f64 = 200.0;
/// Of the size of an element, the largest displacement drawn.
const AMPLITUDE: f64 = 0.22;

/// Motions of an element, panel by panel: the outline as it is and as it moves.
pub fn motions(title: &str, nodes: &[[f64; 2]], outline: &Outline, panels: &[DVector<f64>]) -> String {
    let shown = &panels[..panels.len().min(6)];
    let sides = |u: Option<&DVector<f64>>| -> Vec<Vec<[f64; 2]>> {
        let factor = u.map_or(0.0, |u| AMPLITUDE * outline.size / u.amax());
        let at = |n: usize| [0, 1].map(|c| nodes[n][c] + u.map_or(0.0, |u| factor * u[2 * n + c]));
        outline.sides.iter().map(|side| side.iter().map(|&n| at(n)).collect()).collect()
    };
    let moved: Vec<Vec<Vec<[f64; 2]>>> = shown.iter().map(|u| sides(Some(u))).collect();
    panelled(title, &sides(None), &moved)
}

/// Motions of the sides of a triangle, each by itself: what its tractions do not feel.
pub fn side_motions(title: &str, corners: [[f64; 2]; 3], panels: &[[[[f64; 2]; 2]; 3]]) -> String {
    let side = |s: usize| [corners[(s + 1) % 3], corners[(s + 2) % 3]];
    let size = (0..3).map(side).fold(0.0, |m: f64, [a, b]| m.max((a[0] - b[0]).hypot(a[1] - b[1])));
    let rest: Vec<Vec<[f64; 2]>> = (0..3).map(|s| side(s).to_vec()).collect();
    let moved: Vec<Vec<Vec<[f64; 2]>>> = panels
        .iter()
        .map(|u| {
            let largest = u.as_flattened().as_flattened().iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
            let factor = AMPLITUDE * size / largest;
            (0..3).map(|s| (0..2).map(|e| [0, 1].map(|c| side(s)[e][c] + factor * u[s][e][c])).collect()).collect()
        })
        .collect();
    panelled(title, &rest, &moved)
}

fn panelled(title: &str, rest: &[Vec<[f64; 2]>], panels: &[Vec<Vec<[f64; 2]>>]) -> String {
    let points = || rest.iter().chain(panels.iter().flatten()).flatten();
    let end = |c: usize, pick: fn(f64, f64) -> f64| points().map(|x| x[c]).reduce(pick).unwrap_or(0.0);
    let low = [end(0, f64::min), end(1, f64::min)];
    let span = (end(0, f64::max) - low[0]).max(end(1, f64::max) - low[1]).max(f64::MIN_POSITIVE);
    let mut svg = Svg::new(PANEL * panels.len().max(1) as f64, PANEL + 24.0, title);
    for (k, moved) in panels.iter().enumerate() {
        let left = PANEL * k as f64;
        let place = |x: &[f64; 2]| {
            let [s, t] = [0, 1].map(|c| 16.0 + (PANEL - 32.0) * (x[c] - low[c]) / span);
            [left + s, PANEL - t]
        };
        for (sides, look, width) in [(rest, look::GRID, "2"), (moved.as_slice(), look::CONTACT, "2.5")] {
            for side in sides {
                let mut d = String::new();
                for (i, x) in side.iter().enumerate() {
                    let [x, y] = place(x);
                    let _ = write!(d, "{}{} {}", if i == 0 { 'M' } else { 'L' }, px(x), px(y));
                }
                svg.path(look, &format!(r#"stroke-width="{width}""#), &d);
            }
        }
        moved.iter().flatten().for_each(|x| svg.marker(1, place(x), 3.0));
        svg.text(
            look::DIM,
            [left + 0.5 * PANEL, PANEL + 16.0],
            Anchor::Middle,
            &format!("{} of {}", k + 1, panels.len()),
        );
    }
    svg.finish()
}

/// Curves on logarithmic axes, by name.
pub fn curves(title: &str, labels: [&str; 2], series: &[(String, Vec<[f64; 2]>)]) -> Option<String> {
    let of = |(ink, (label, points)): (usize, &(String, Vec<[f64; 2]>))| Series {
        label: label.clone(),
        ink,
        secondary: false,
        points: points.clone(),
        spread: Vec::new(),
        open: Vec::new(),
    };
    draw(&Sheet {
        title: title.into(),
        labels: labels.map(String::from),
        x: Scale::Logarithmic,
        series: series.iter().enumerate().map(of).collect(),
        front: Vec::new(),
        level: None,
        notes: Vec::new(),
        size: [880, 420],
    })
    .ok()
}
