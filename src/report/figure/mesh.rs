//! A mesh file: its cells by body, and the pieces of its outline with their names.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::outline::View;
use super::svg::{Anchor, Svg, look, px};
use crate::mesh::inventory::{Curve, Inventory, Piece};

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 640.0;
const MARGIN: f64 = 130.0;
/// Triangles beyond which their edges would be a grey area, and a large file.
const MOST_DRAWN: usize = 20_000;
/// Labels beyond which they would cover each other.
const MOST_LABELS: usize = 60;

/// The picture.
pub fn mesh(inventory: &Inventory) -> String {
    let used = inventory.triangles.iter().flatten().map(|&v| inventory.points[v]);
    let (view, height) = View::fit(used, WIDTH, HEIGHT, MARGIN);
    let mut svg = Svg::new(WIDTH, height, "The cells of the mesh file and the pieces of its outline");
    cells(&mut svg, inventory, &view);
    let mut shown = inventory.outline.iter().collect::<Vec<&Piece>>();
    shown.sort_by(|a, b| b.length.total_cmp(&a.length));
    for (i, piece) in inventory.outline.iter().enumerate() {
        let (_, colour) = look::SERIES[i % look::SERIES.len()];
        let dashes = if piece.shared { r#"stroke-dasharray="5 4""# } else { "" };
        let more = format!(r#"fill="none" stroke="{colour}" stroke-width="2.5" stroke-linecap="round" {dashes}"#);
        svg.path("", &more, &path(piece.edges.iter().map(|e| e.map(|v| view.at(inventory.points[v])))));
    }
    for piece in shown.into_iter().take(MOST_LABELS) {
        label(&mut svg, inventory, piece, &view);
    }
    svg.finish()
}

fn path(lines: impl Iterator<Item = [[f64; 2]; 2]>) -> String {
    let mut d = String::new();
    for [a, b] in lines {
        let _ = write!(d, "M{} {}L{} {}", px(a[0]), px(a[1]), px(b[0]), px(b[1]));
    }
    d
}

/// The bodies: cell by cell, or where there are too many by their outlines alone.
fn cells(svg: &mut Svg, inventory: &Inventory, view: &View) {
    let mut of: BTreeMap<usize, String> = BTreeMap::new();
    if inventory.triangles.len() > MOST_DRAWN {
        return;
    }
    for (cell, body) in inventory.triangles.iter().zip(&inventory.body) {
        let [p, q, r] = cell.map(|v| view.at(inventory.points[v]));
        let d = of.entry(*body).or_default();
        let _ = write!(d, "M{} {}L{} {}L{} {}z", px(p[0]), px(p[1]), px(q[0]), px(q[1]), px(r[0]), px(r[1]));
    }
    for (body, d) in of {
        let look = look::BODIES[body % look::BODIES.len()];
        svg.path(look, r##"stroke="#8996a3" stroke-opacity="0.55" stroke-width="0.6""##, &d);
    }
}

/// The name of a piece, that of the file where it has one, outside its middle edge.
fn label(svg: &mut Svg, inventory: &Inventory, piece: &Piece, view: &View) {
    let Some(edge) = piece.edges.get(piece.edges.len() / 2) else { return };
    let [from, to] = *edge;
    let has = |curve: &&Curve| curve.on_outline.iter().any(|e| *e == [from, to] || *e == [to, from]);
    let of_file = inventory.boundaries.iter().rfind(|curve| piece.named && has(curve));
    let name = of_file.map_or(&piece.name, |curve| &curve.name);
    let [a, b] = edge.map(|v| view.at(inventory.points[v]));
    let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(1e-9);
    // On the page y points down, and the body is on the left of its edges.
    let outward = [(a[1] - b[1]) / length, (b[0] - a[0]) / length];
    let at = [0.5 * (a[0] + b[0]) + 9.0 * outward[0], 0.5 * (a[1] + b[1]) + 9.0 * outward[1] + 4.0];
    let anchor = match outward[0] {
        x if x > 0.4 => Anchor::Start,
        x if x < -0.4 => Anchor::End,
        _ => Anchor::Middle,
    };
    svg.text(&format!("{} {}", look::INK, look::HALO), at, anchor, name);
}
