//! `[geometry]`: polygons to triangles.
//!
//! The boundary is divided first, once for both bodies where two polygons touch; every polygon is then filled against
//! its fixed boundary. So the two sides of a contact match bit for bit, and polygons of one body join without gaps.

mod fill;
mod outline;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use super::polyline::key;
use super::{MeshError, RawMesh};
use crate::scene::Note;
use crate::scene::{MeshSource, Scene};

/// Meshes the polygons of `scene`. Each body gets vertices of its own.
///
/// # Errors
/// [`MeshError::Polygon`] when a polygon is not simple or overlaps another one, or when the mesh would be too large.
pub fn mesh(scene: &Scene) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let MeshSource::Geometry { size, polygons } = &scene.mesh else {
        return Ok((RawMesh::default(), Vec::new()));
    };
    let fault = |polygon: usize, (what, remedy): (String, String)| MeshError::Polygon {
        scene: scene.path.clone(),
        polygon,
        body: polygons.get(polygon).map_or(String::new(), |p| p.body.clone()),
        what,
        remedy,
    };
    let outlines = outline::divide(scene, polygons, *size).map_err(|(polygon, text)| fault(polygon, text))?;
    let mut raw = RawMesh::default();
    let mut notes = Vec::new();
    let mut vertex: HashMap<(&str, [u64; 2]), usize> = HashMap::new();
    for (number, (polygon, outline)) in polygons.iter().zip(&outlines).enumerate() {
        let corners: Vec<[f64; 2]> = outline.iter().map(|piece| piece.ends[0]).collect();
        let filled = fill::fill(&corners, *size).map_err(|text| fault(number, text))?;
        if !filled.complete {
            notes.push(Note {
                weakens_guarantee: false,
                text: format!("geometry.polygons[{number}] could not be meshed with good angles everywhere"),
            });
        }
        let index: Vec<usize> = filled
            .points
            .iter()
            .map(|p| {
                *vertex.entry((&polygon.body, key(*p))).or_insert_with(|| {
                    raw.points.push(*p);
                    raw.points.len() - 1
                })
            })
            .collect();
        raw.triangles.extend(filled.triangles.iter().map(|t| (t.map(|v| index[v]), polygon.body.clone())));
        for piece in outline.iter().filter(|piece| !piece.name.is_empty()) {
            let ends = piece.ends.map(|p| vertex[&(polygon.body.as_str(), key(p))]);
            raw.segments.push((ends, piece.name.clone()));
        }
    }
    Ok((raw, notes))
}
