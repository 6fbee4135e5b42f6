//! Cells in space: no part of a plane mesh, counted so that they can be told about.

use std::collections::HashSet;
use std::path::Path;

use crate::mesh::MeshError;
use crate::mesh::files::content::Content;

/// Name and number of nodes of a Gmsh element type in space.
pub(in crate::mesh) fn solid_type(number: i32) -> Option<(&'static str, usize)> {
    Some(match number {
        4 => ("tetrahedron", 4),
        5 => ("hexahedron", 8),
        6 => ("prism", 6),
        7 => ("pyramid", 5),
        11 => ("tetrahedron with 10 nodes", 10),
        12 => ("hexahedron with 27 nodes", 27),
        13 => ("prism with 18 nodes", 18),
        14 => ("pyramid with 14 nodes", 14),
        17 => ("hexahedron with 20 nodes", 20),
        18 => ("prism with 15 nodes", 15),
        19 => ("pyramid with 13 nodes", 13),
        29 => ("tetrahedron with 20 nodes", 20),
        30 => ("tetrahedron with 35 nodes", 35),
        31 => ("tetrahedron with 56 nodes", 56),
        _ => return None,
    })
}

/// The name of a kind of cells in space, where it is one that is known.
pub(in crate::mesh) fn solid_kind(name: &str) -> Option<&'static str> {
    (0..32).filter_map(solid_type).map(|(kind, _)| kind).find(|kind| *kind == name)
}

/// Cells in space of one kind.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::mesh) struct Solids {
    kind: &'static str,
    count: usize,
    /// Their nodes.
    nodes: HashSet<u64>,
}

impl Content {
    /// Counts a cell in space, which is told about and not used.
    pub fn solid(&mut self, kind: &'static str, nodes: &[u64]) {
        if self.solids.iter().all(|solids| solids.kind != kind) {
            self.solids.push(Solids { kind, count: 0, nodes: HashSet::new() });
        }
        if let Some(solids) = self.solids.iter_mut().find(|solids| solids.kind == kind) {
            solids.count += 1;
            solids.nodes.extend(nodes);
        }
    }

    /// Refuses a file with cells in space, and says how many there are and where.
    pub fn no_solids(&self, file: &Path) -> Result<(), MeshError> {
        if self.solids.is_empty() {
            return Ok(());
        }
        let told = self.solids.iter().map(|solids| {
            let mut extent = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
            for p in solids.nodes.iter().filter_map(|tag| self.nodes.get(tag)) {
                for c in 0..3 {
                    extent[0][c] = extent[0][c].min(p[c]);
                    extent[1][c] = extent[1][c].max(p[c]);
                }
            }
            let [[a, b, c], [x, y, z]] = extent;
            let place = if a <= x { format!(" between ({a}, {b}, {c}) and ({x}, {y}, {z})") } else { String::new() };
            format!("{} × {}{place}", solids.count, solids.kind)
        });
        let told = told.collect::<Vec<_>>().join(", ");
        let plane: Vec<String> = self.kinds().into_iter().map(|(kind, n)| format!("{n} × {kind}")).collect();
        let beside = if plane.is_empty() { String::new() } else { format!("; beside them {}", plane.join(", ")) };
        let remedy = "this program is plane: save the surfaces of one plane only";
        Err(MeshError::file(file, format!("it has cells in space: {told}{beside}"), remedy))
    }
}
