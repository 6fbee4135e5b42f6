//! Places where two parts of a body, or two bodies, touch without being bonded: hanging nodes and doubled vertices.

use super::boxes::{BoxTree, around};
use super::labels::contact_names;
use super::touching;
use crate::mesh::Triangulation;
use crate::mesh::error::{MeshError, at};
use crate::scene::Note;
use crate::scene::Scene;

/// Distance from an edge, and from its ends, in parts of its length.
const CLOSE: f64 = 1e-9;

/// A vertex inside a boundary edge of its own body is an error; two edges at the same place may be meant, and make a
/// note. Contact sides are left to the gluing.
pub(in crate::mesh) fn check(mesh: &Triangulation, scene: &Scene, notes: &mut Vec<Note>) -> Result<(), MeshError> {
    let sides = contact_names(scene);
    let in_contact = |e: usize| mesh.edges[e].name.is_some_and(|n| sides.contains(&mesh.names[n].as_str()));
    let boundary: Vec<usize> =
        (0..mesh.edges.len()).filter(|&e| mesh.edges[e].is_boundary() && !in_contact(e)).collect();
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let body = |e: usize| mesh.edges[e].triangles[0].map(|t| mesh.body[t]);
    let tree = BoxTree::new(boundary.iter().map(|&e| around(&ends(e), CLOSE * mesh.edge_frame(e).0)).collect());
    for &e in &boundary {
        for p in ends(e) {
            for f in tree.meeting(&[p, p]).into_iter().map(|i| boundary[i]) {
                if body(e) == body(f) && inside(p, ends(f)) {
                    let [a, b] = ends(f).map(|p| at(scene, p));
                    let name = body(e).map_or("", |b| &scene.bodies[b].name);
                    return Err(MeshError::cells(
                        scene,
                        format!(
                            "body '{name}' has a hanging node: the vertex {} lies inside the edge {a} to {b}",
                            at(scene, p)
                        ),
                        "mesh the parts of a body conformingly (in gmsh: BooleanFragments, or Coherence)",
                    ));
                }
            }
        }
    }
    notes.extend(touching::notes(mesh, scene));
    Ok(())
}

/// True if `p` lies on the edge, away from its ends.
fn inside(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> bool {
    let (d, w) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = d[0] * d[0] + d[1] * d[1];
    let along = (w[0] * d[0] + w[1] * d[1]) / square;
    let off = (d[0] * w[1] - d[1] * w[0]) / square;
    off.abs() < CLOSE && along > CLOSE && along < 1.0 - CLOSE
}
