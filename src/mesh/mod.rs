//! Triangulations: where the triangles come from and how their edges and boundaries are named.
//!
//! Readers and the polygon mesher make a [`RawMesh`]; [`Triangulation::new`] checks it and works out its topology.
//! Bodies that meet in a contact have their own vertices there, at equal coordinates; triangles that share a vertex
//! index are bonded.

pub mod bisect;
mod boxes;
mod cells;
pub(crate) mod error;
mod file;
mod foreign;
pub mod glue;
#[cfg(test)]
mod glue_tests;
pub mod gmsh;
mod halves;
mod hanging;
mod insert;
pub(crate) mod labels;
pub(crate) mod meshio;
mod overlap;
pub mod polygons;
pub(crate) mod polyline;
mod quarter;
#[cfg(test)]
pub(crate) mod testing;
mod topology;
#[cfg(test)]
mod topology_tests;

pub use error::MeshError;

/// A hash map whose order is of no consequence, with a hash that is fast on vertex pairs.
pub(crate) type Map<K, V> = std::collections::HashMap<K, V, foldhash::fast::FixedState>;

use crate::scene::Note;
use crate::scene::{MeshSource, Scene};

/// Reads or makes the mesh of `scene`, checks it, and makes contact sides match.
///
/// # Errors
/// [`MeshError`] says what is wrong, where, and what to do.
pub fn load(scene: &Scene) -> Result<(Triangulation, Vec<Note>), MeshError> {
    let (raw, mut notes) = match &scene.mesh {
        MeshSource::File(path) => file::read(path)?,
        MeshSource::Geometry { .. } => polygons::mesh(scene)?,
    };
    let (mesh, more) = Triangulation::new(raw, scene)?;
    notes.extend(more);
    let (mesh, more) = glue::glue(mesh, scene)?;
    notes.extend(more);
    Ok((mesh, notes))
}

/// What a reader or a mesher delivers: triangles and named segments, not yet checked.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    /// Vertex coordinates.
    pub points: Vec<[f64; 2]>,
    /// Vertex indices and body name of each triangle, either orientation.
    pub triangles: Vec<([usize; 3], String)>,
    /// Vertex indices and boundary name of each named segment.
    pub segments: Vec<([usize; 2], String)>,
}

/// An edge of a [`Triangulation`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// End vertices, counter-clockwise as seen from `triangles[0]`.
    pub vertices: [usize; 2],
    /// The triangle on its left, and the one on its right for an interior edge.
    pub triangles: [Option<usize>; 2],
    /// Index into [`Triangulation::names`] for a named boundary edge.
    pub name: Option<usize>,
}

impl Edge {
    /// Whether only one triangle has this edge.
    pub fn is_boundary(&self) -> bool {
        self.triangles[1].is_none()
    }
}

/// A checked triangulation: counter-clockwise, non-degenerate, every triangle in a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangulation {
    /// Vertex coordinates.
    pub points: Vec<[f64; 2]>,
    /// Counter-clockwise vertex indices of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// Body of each triangle, as an index into [`crate::scene::Scene::bodies`].
    pub body: Vec<usize>,
    /// All edges. A pair of coinciding contact sides is two sets of boundary edges.
    pub edges: Vec<Edge>,
    /// The three edges of each triangle; edge i is opposite vertex i, that is, it joins vertices i + 1 and i + 2.
    pub triangle_edges: Vec<[usize; 3]>,
    /// Boundary names.
    pub names: Vec<String>,
}

impl Triangulation {
    /// The corner coordinates of triangle `t`.
    pub fn corners(&self, t: usize) -> [[f64; 2]; 3] {
        self.triangles[t].map(|v| self.points[v])
    }

    /// Length and outward unit normal (as seen from `triangles[0]`) of edge `e`.
    pub fn edge_frame(&self, e: usize) -> (f64, [f64; 2]) {
        let [a, b] = self.edges[e].vertices.map(|v| self.points[v]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        (length, [dy / length, -dx / length])
    }
}
