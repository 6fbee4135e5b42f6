//! A scene to start from: everything that a mesh file holds by name, with a material and commented examples of conditions.

use std::fmt::Write;

use super::{Curve, Inventory, Piece, Shape};
use crate::scene::{counted, toml_string};

/// Names that a comment lists before it says how many more there are.
const LISTED: usize = 40;

/// The text of a scene on the mesh of `inventory`, which it finds at `mesh`, a path relative to its folder.
///
/// It passes the checks of a scene as it is. Without loads its solution is at rest: the examples in it say what to fill in.
pub fn starting_scene(inventory: &Inventory, mesh: &str, title: &str) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write(&mut text, inventory, mesh, title);
    text
}

fn write(text: &mut String, inventory: &Inventory, mesh: &str, title: &str) -> std::fmt::Result {
    writeln!(
        text,
        "# A scene to start from: put in the materials, then take the # away from supports and loads and choose their boundaries."
    )?;
    writeln!(text, "title = {}\n", toml_string(title))?;
    match &inventory.made_for {
        Some((kinematics, name)) => {
            writeln!(text, "[model]\nkinematics = \"{}\" # elements {name}\n", kinematics.name())?;
        }
        None => {
            writeln!(
                text,
                "[model]\nkinematics = \"plane-strain\" # or \"plane-stress\", or \"axisymmetric\" about x = 0\n"
            )?;
        }
    }
    writeln!(text, "[mesh]\nfile = {}", toml_string(mesh))?;
    for region in &inventory.bodies {
        let lines = inventory.body_lines(region).join("\n");
        let what = counted(region.triangles, "triangle");
        let area: f64 = format!("{:.4e}", region.area).parse().unwrap_or(region.area);
        writeln!(text, "\n# {what}, area {area}\n{lines}")?;
        writeln!(text, "young = 1.0 # example\npoisson = 0.3 # example")?;
    }
    let mut usable: Vec<&str> = Vec::new();
    let lists = [&inventory.boundaries, &inventory.surfaces, &inventory.node_sets];
    usable.extend(lists.into_iter().flatten().filter(|c| !c.on_outline.is_empty()).map(|c| c.name.as_str()));
    if !usable.is_empty() {
        let names: Vec<String> =
            usable.iter().take(LISTED).map(|name| toml_string(&name.replace(['\n', '\r'], " "))).collect();
        let more = usable.len().saturating_sub(LISTED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        writeln!(text, "\n# Names of the file that conditions may use as they are: {}{more}", names.join(", "))?;
    }
    let pieces: Vec<&Piece> = inventory.outline.iter().filter(|piece| !piece.named).collect();
    if !pieces.is_empty() {
        writeln!(text, "\n# The outline by line and circle; what no condition uses is free and may be taken out.")?;
    }
    for piece in &pieces {
        let also = match (piece.shared, piece.others) {
            (true, _) => ", where another body is joined to it: for a contact or nothing",
            (false, 0) => "",
            (false, _) => ", and other edges inside the box",
        };
        let kind = if matches!(piece.shape, Shape::Curve(_)) { " of a curve" } else { "" };
        writeln!(text, "\n# {}{kind}{also}", counted(piece.edges.len(), "edge"))?;
        writeln!(text, "{}", inventory.piece_lines(piece).join("\n"))?;
    }
    let outer = inventory.outline.iter().filter(|p| !p.shared).collect::<Vec<_>>();
    let named = |curves: &[Curve]| curves.iter().find(|c| !c.on_outline.is_empty()).map(|c| c.name.clone());
    let first = outer.iter().find(|p| !p.named).map(|p| p.name.clone());
    let first = named(&inventory.boundaries).or(first).unwrap_or_else(|| "support".into());
    let other = usable.iter().map(|n| n.to_string()).chain(outer.iter().filter(|p| !p.named).map(|p| p.name.clone()));
    let other = other.rev().find(|name| *name != first).unwrap_or_else(|| "load".into());
    let on = |name: &str| toml_string(&name.replace(['\n', '\r'], " "));
    writeln!(text, "\n# Examples of conditions; a boundary has one at most.")?;
    writeln!(text, "# [[supports]]\n# on = {}\n# type = \"clamped\" # or \"roller\"\n", on(&first))?;
    writeln!(text, "# [[tractions]]\n# on = {}\n# pressure = 1.0 # or value = [0.0, -1.0]\n", on(&other))?;
    writeln!(
        text,
        "# [[contacts]]\n# between = [\"one\", \"other\"] # boundaries of two bodies; or on = \"one\" against a rigid obstacle"
    )
}
