//! Contents of a mesh file, as text for a terminal and as a page.

mod page;

pub use page::page;

use super::text::number::significant;
use crate::mesh::inventory::{Curve, Inventory, Piece, Region, Shape};
use crate::scene::counted;

/// Entries of a list on a terminal.
const LISTED: usize = 30;

/// The lines for a terminal.
pub fn text(inventory: &Inventory) -> Vec<String> {
    let mut lines = vec![format!("{}: {}", inventory.file.display(), kinds(inventory))];
    let mut list = |title: &str, entries: Vec<(String, Vec<String>)>| {
        if entries.is_empty() {
            return;
        }
        lines.push(String::new());
        lines.push(title.to_string());
        let more = entries.len().saturating_sub(LISTED);
        for (told, toml) in entries.into_iter().take(LISTED) {
            lines.push(format!("  {told}"));
            lines.extend(toml.into_iter().map(|line| format!("      {line}")));
        }
        if more > 0 {
            lines.push(format!("  and {more} more, which the page and the scene of --scene list"));
        }
    };
    let bodies = inventory.bodies.iter().map(|region| (told(region), inventory.body_lines(region)));
    list("bodies, each cell in one", bodies.collect());
    let groups = inventory.groups.iter().map(|region| (format!("{}: {}", told(region), region.key()), Vec::new()));
    list("other groups of cells", groups.collect());
    for (title, curves, of) in curves(inventory) {
        list(title, curves.iter().map(|curve| (curve_told(curve, of), inventory.curve_lines(curve))).collect());
    }
    let pieces = inventory.outline.iter().map(|piece| (piece_told(piece, inventory), inventory.piece_lines(piece)));
    list("outline by line and circle", pieces.collect());
    lines.extend(inventory.notes.iter().map(|note| format!("note: {}", note.text)));
    lines
}

/// The groups of edges of a file, with what their members are.
fn curves(inventory: &Inventory) -> [(&'static str, &[Curve], &'static str); 4] {
    [
        ("boundaries by name", &inventory.boundaries, "edge"),
        ("surfaces, which are boundaries by their names", &inventory.surfaces, "side"),
        ("node sets, which are boundaries by their names", &inventory.node_sets, "node"),
        ("curves by tag", &inventory.entities, "edge"),
    ]
}

fn kinds(inventory: &Inventory) -> String {
    let kinds: Vec<String> = inventory.kinds.iter().map(|(kind, n)| format!("{n} × {kind}")).collect();
    format!("{}; {}", kinds.join(", "), counted(inventory.points.len(), "node"))
}

fn told(region: &Region) -> String {
    let name = match region.name.as_str() {
        "" => "all cells, in no group",
        name => name,
    };
    let [[x0, y0], [x1, y1]] = region.extent.map(|p| p.map(|x| significant(x, 4)));
    let (triangles, area) = (counted(region.triangles, "triangle"), significant(region.area, 6));
    format!("{name}: {triangles}, area {area}, between ({x0}, {y0}) and ({x1}, {y1})")
}

fn curve_told(curve: &Curve, of: &str) -> String {
    let (members, name) = (counted(curve.members, of), &curve.name);
    match curve.on_outline.len() {
        0 => format!("{name}: {members}, no edge on the outline"),
        n => {
            format!("{name}: {members}, {} on the outline, length {}", counted(n, "edge"), significant(curve.length, 6))
        }
    }
}

fn piece_told(piece: &Piece, inventory: &Inventory) -> String {
    let kind = match piece.shape {
        Shape::Line(_) => "line",
        Shape::Circle { .. } => "circle",
        Shape::Curve(_) => "curve",
    };
    let mut told = format!("{kind}: {}, length {}", counted(piece.edges.len(), "edge"), significant(piece.length, 6));
    match inventory.names_on(piece) {
        (names, _) if names.is_empty() => {}
        (names, true) => told += &format!("; in the file {}", names.join(", ")),
        (names, false) => told += &format!("; in the file in part {}", names.join(", ")),
    }
    if piece.shared {
        told += "; between two bodies, for a contact or nothing";
    }
    if piece.others > 0 {
        told += &format!("; the box takes {} of the body too", counted(piece.others, "other edge"));
    }
    told
}
