//! A lattice of bodies as a mesh file of Gmsh, version 2.2: vertices are common to all bodies, each side is a physical
//! curve, so that bodies are bonded wherever no contact separates them.

use std::collections::HashMap;
use std::fmt::Write;

use super::layout::{Layout, Side};

/// The cells that the squares of a cell of the lattice become.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Two triangles each.
    Triangles,
    /// Quadrilaterals like the cell.
    Quadrilaterals,
    /// Quadrilaterals whose corners inside the cell are moved.
    Distorted,
    /// Quadrilaterals, and a pair of triangles here and there.
    Mixed,
}

/// `divisions` squares along each side of a cell; `place` gives the point of the scene from one of the lattice.
pub fn text(
    layout: &Layout,
    (divisions, cells): (usize, Cells),
    place: impl Fn([f64; 2]) -> [f64; 2],
    body: impl Fn(usize) -> String,
    sides: &[Side],
    name: impl Fn(usize) -> String,
) -> String {
    let mut nodes: HashMap<[usize; 2], usize> = HashMap::new();
    let (mut points, mut elements) = (Vec::new(), Vec::new());
    for (cell, owner) in layout.cells() {
        let mut node = |i: usize, j: usize| {
            let [column, row] = layout.place_of(cell);
            let key = [column * divisions + i, row * divisions + j];
            *nodes.entry(key).or_insert_with(|| {
                let inside = |k: usize| k > 0 && k < divisions;
                let moved = if cells == Cells::Distorted && inside(i) && inside(j) { 0.2 } else { 0.0 };
                let beside = |k: usize, turn: f64| {
                    (k as f64 + moved * (3.0 * i as f64 + 5.0 * j as f64 + turn + cell as f64).sin()) / divisions as f64
                };
                points.push(place(layout.within(cell, [beside(i, 0.0), beside(j, 2.0)])));
                points.len()
            })
        };
        for j in 0..divisions {
            for i in 0..divisions {
                let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
                let whole = match cells {
                    Cells::Triangles => false,
                    Cells::Mixed => (i + 2 * j + cell) % 3 != 0,
                    Cells::Quadrilaterals | Cells::Distorted => true,
                };
                // Either orientation is allowed.
                if whole {
                    let [b, d] = if (i + cell) % 3 == 0 { [d, b] } else { [b, d] };
                    elements.push(format!("3 2 {0} {0} {a} {b} {c} {d}", owner + 1));
                    continue;
                }
                // Now one diagonal, now the other.
                let cut = if (i + j) % 2 == 0 { [[a, b, c], [a, d, c]] } else { [[a, b, d], [b, c, d]] };
                elements.extend(cut.map(|[a, b, c]| format!("2 2 {0} {0} {a} {b} {c}", owner + 1)));
            }
        }
    }
    for (k, side) in sides.iter().enumerate() {
        for &(cell, facing) in &side.pieces {
            let at = |n: usize| {
                let [i, j] = facing.along(n, divisions);
                let [column, row] = layout.place_of(cell);
                nodes[&[column * divisions + i, row * divisions + j]]
            };
            let tag = layout.bodies + 1 + k;
            elements.extend((0..divisions).map(|n| format!("1 2 {tag} {tag} {} {}", at(n), at(n + 1))));
        }
    }
    let surfaces = (0..layout.bodies).map(|b| format!("2 {} \"{}\"", b + 1, body(b)));
    let curves = (0..sides.len()).map(|k| format!("1 {} \"{}\"", layout.bodies + 1 + k, name(k)));
    let names: Vec<String> = surfaces.chain(curves).collect();
    let points: Vec<String> = points.iter().enumerate().map(|(n, [x, y])| format!("{} {x:?} {y:?} 0", n + 1)).collect();
    let elements: Vec<String> = elements.iter().enumerate().map(|(n, e)| format!("{} {e}", n + 1)).collect();
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    for (section, lines) in [("PhysicalNames", names), ("Nodes", points), ("Elements", elements)] {
        writeln!(text, "${section}\n{}\n{}\n$End{section}", lines.len(), lines.join("\n"))
            .expect("a string takes any text");
    }
    text
}
