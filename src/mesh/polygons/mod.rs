//! `[geometry]`: polygons to triangles.
//!
//! The boundary is divided first, once for both bodies where two polygons touch; every polygon is then filled against
//! its fixed boundary. So the two sides of a contact match bit for bit, and polygons of one body join without gaps.

mod fill;
mod grade;
mod outline;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use super::sides::polyline::key;
use super::{MeshError, RawMesh};
use crate::scene::Note;
use crate::scene::{MeshSource, Polygon, Scene};

/// Triangles that fill a square of the size that is asked for: they are a little smaller than equilateral ones with sides
/// as long.
const IN_A_SQUARE: f64 = 2.5;

/// About how many triangles [`mesh`] makes at the target edge length `size`, or without one.
pub fn expected_triangles(polygons: &[Polygon], size: Option<f64>) -> f64 {
    let of = |polygon: &Polygon| {
        let points = &polygon.points;
        let Some(size) = size else { return points.len() as f64 };
        let sides = (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]);
        let (mut double_area, mut pieces) = (0.0, 0.0);
        for [a, b] in sides {
            double_area +=
                (a[0] - points[0][0]) * (b[1] - points[0][1]) - (b[0] - points[0][0]) * (a[1] - points[0][1]);
            pieces += ((b[0] - a[0]).hypot(b[1] - a[1]) / size).ceil();
        }
        IN_A_SQUARE * 0.5 * (double_area / (size * size)).abs() + pieces
    };
    polygons.iter().map(of).sum()
}

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
