//! Triangulations: where the triangles come from and how their edges and boundaries are named.
//!
//! Readers and the polygon mesher make a [`RawMesh`]; [`Triangulation::new`] checks it and works out its topology.
//! Bodies that meet in a contact have their own vertices there, at equal coordinates; triangles that share a vertex
//! index are bonded.

pub mod cells;
pub mod error;
pub mod files;
pub mod inventory;
pub mod polygons;
pub mod refinement;
mod select;
pub mod sides;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod topology;

pub use cells::file_cells::{FileCells, Quadrilateral};
pub use error::MeshError;
pub use refinement::uncut::Uncut;
pub use select::Sets;
pub use sides::bulge::CORNER;
pub use topology::touching::{Touching, touching};

/// A hash map whose order is of no consequence, with a hash that is fast on vertex pairs.
pub(crate) type Map<K, V> = std::collections::HashMap<K, V, foldhash::fast::FixedState>;

use std::time::Duration;

use sides::glue::Glued;

/// The circles of the edges that stand for an arc, by edge; refining puts new vertices on them.
pub type Curved = Map<usize, crate::scene::Circle>;

use crate::scene::Note;
use crate::scene::{MeshSource, Scene};

/// About how many triangles [`load`] makes of polygons; `None` where the mesh comes from a file.
pub fn expected_triangles(scene: &Scene) -> Option<f64> {
    match &scene.mesh {
        MeshSource::Geometry { size, polygons } => Some(polygons::expected_triangles(polygons, *size)),
        MeshSource::File(_) | MeshSource::Parts(_) => None,
    }
}

/// A scene with its mesh.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scene, its coordinates counted as those of the mesh.
    pub scene: Scene,
    /// The mesh, with contact sides that match.
    pub mesh: Triangulation,
    /// How it was made.
    pub notes: Vec<Note>,
    /// The mesh before contact sides were made to match; `None` where they did already.
    pub uncut: Option<Uncut>,
}

/// Reads or makes the mesh of `scene`, checks it, and makes contact sides match. The mesh counts its coordinates from a
/// point in its middle where it lies far from (0, 0), and so does the scene that comes with it. A program that helps to read
/// a file is given at most `limit`.
///
/// # Errors
/// [`MeshError`] says what is wrong, where, and what to do.
pub fn load(scene: Scene, limit: Duration) -> Result<Loaded, MeshError> {
    let (scene, (raw, mut notes)) = match &scene.mesh {
        MeshSource::File(_) | MeshSource::Parts(_) => {
            let (raw, mut notes) = match &scene.mesh {
                MeshSource::Parts(parts) => files::parts::read(parts, &scene, limit)?,
                MeshSource::File(path) => files::file::read(path, limit)?,
                MeshSource::Geometry { .. } => Default::default(),
            };
            let (scene, raw) = chosen(scene, raw, &mut notes)?;
            (scene, (raw, notes))
        }
        MeshSource::Geometry { polygons, .. } => {
            let corners: Vec<[f64; 2]> = polygons.iter().flat_map(|p| p.points.iter().copied()).collect();
            let (scene, _) = scene.about_middle(corners.iter());
            let (mut raw, mut notes) = polygons::mesh(&scene)?;
            select::select(&mut raw, &scene, &mut notes)?;
            (scene, (raw, notes))
        }
    };
    let (mesh, more) = Triangulation::new(raw, &scene)?;
    notes.extend(more);
    let Glued { mesh, notes: more, uncut } = sides::glue::glue(mesh, &scene)?;
    notes.extend(more);
    let size = mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    notes.extend(scene.coarseness(size));
    Ok(Loaded { scene, mesh, notes, uncut })
}

/// What `scene` chooses of the mesh of a file, counted from its middle.
fn chosen(scene: Scene, mut raw: RawMesh, notes: &mut Vec<Note>) -> Result<(Scene, RawMesh), MeshError> {
    raw.shift(scene.origin);
    select::select(&mut raw, &scene, notes)?;
    let (scene, middle) = scene.about_middle(raw.points.iter());
    raw.shift(middle);
    Ok((scene, raw))
}

/// The mesh with the bonds of `scene` closed, whose sides match vertex for vertex.
///
/// # Errors
/// [`MeshError::Contact`] with an edge of one side that has none of the other opposite.
pub fn bonded(mesh: Triangulation, scene: &Scene) -> Result<Triangulation, MeshError> {
    Ok(sides::bonded::bond(mesh, scene)?.0)
}

/// Result of a reader or a mesher: triangles and named segments, not yet checked.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    /// Vertex coordinates.
    pub points: Vec<[f64; 2]>,
    /// Vertex indices and body name of each triangle, either orientation.
    pub triangles: Vec<([usize; 3], String)>,
    /// Vertex indices and boundary name of each named segment.
    pub segments: Vec<([usize; 2], String)>,
    /// More of both, with several names each.
    pub shared: Vec<Shared>,
    /// The corners of the quadrilaterals of which some of the triangles are halves.
    pub quadrilaterals: Vec<[usize; 4]>,
    /// Other sets of the file.
    pub sets: Sets,
}

/// Cells that all carry the same names, listed once: those of an entity that is in many physical groups.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shared {
    /// Names of the bodies or boundaries.
    pub names: Vec<String>,
    /// Triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Segments.
    pub segments: Vec<[usize; 2]>,
}

impl RawMesh {
    /// With all cells listed name by name: under every name that `scene` uses, and under one of the others where there is
    /// no such name. The other names stand at one cell, so that they can be spoken of.
    fn resolved(mut self, scene: &Scene) -> Self {
        for Shared { names, triangles, segments } in std::mem::take(&mut self.shared) {
            let bodies = |name: &String| scene.bodies.iter().any(|body| body.name == *name);
            spread(&names, triangles, bodies, &mut self.triangles);
            let used = topology::labels::used_names(scene);
            spread(&names, segments, |name| used.contains(&name.as_str()), &mut self.segments);
        }
        self
    }
}

fn spread<C: Copy>(names: &[String], cells: Vec<C>, used: impl Fn(&String) -> bool, into: &mut Vec<(C, String)>) {
    let Some(first) = cells.first() else { return };
    let (mut wanted, mut others): (Vec<&String>, Vec<&String>) = names.iter().partition(|name| used(name));
    if wanted.is_empty() && !others.is_empty() {
        wanted.push(others.swap_remove(0));
    }
    for cell in &cells {
        into.extend(wanted.iter().map(|name| (*cell, (*name).clone())));
    }
    into.extend(others.into_iter().map(|name| (*first, name.clone())));
}

impl RawMesh {
    /// Counts coordinates from `origin`.
    fn shift(&mut self, origin: [f64; 2]) {
        if origin != [0.0; 2] {
            self.points.iter_mut().for_each(|p| *p = [p[0] - origin[0], p[1] - origin[1]]);
        }
    }
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
    /// True if only one triangle has this edge.
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
    /// Body of each triangle, as an index into [`crate::scene::Draft::bodies`].
    pub body: Vec<usize>,
    /// All edges. A pair of coinciding contact sides is two sets of boundary edges.
    pub edges: Vec<Edge>,
    /// The three edges of each triangle; edge i is opposite vertex i, that is, it joins vertices i + 1 and i + 2.
    pub triangle_edges: Vec<[usize; 3]>,
    /// Boundary names.
    pub names: Vec<String>,
    /// Which triangles are halves of a quadrilateral of the mesh file.
    pub cells: FileCells,
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
