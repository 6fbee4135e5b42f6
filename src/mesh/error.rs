//! Errors of meshes, each with the place and the remedy.

use std::path::{Path, PathBuf};

use crate::scene::{MeshSource, Scene};

/// A mesh that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// The file as a whole cannot be read or converted.
    #[error("mesh file {}: {what}; {remedy}", .file.display())]
    File {
        /// The mesh file.
        file: PathBuf,
        /// The finding.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// A place inside the file does not follow its format.
    #[error("mesh file {}, {place}: {what}; {remedy}", .file.display())]
    Format {
        /// The mesh file.
        file: PathBuf,
        /// Section, and line or byte.
        place: String,
        /// The finding.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// The cells do not form a triangulation of the bodies.
    #[error("{mesh}: {what}; {remedy}")]
    Cells {
        /// The mesh file, or `[geometry]`.
        mesh: String,
        /// The finding, with indices and coordinates.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// A named boundary does not fit the scene.
    #[error("{mesh}: boundary '{name}' {what}; {remedy}")]
    Boundary {
        /// The mesh file, or `[geometry]`.
        mesh: String,
        /// Name of the boundary.
        name: String,
        /// The finding.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// The polygons of the scene do not describe bodies.
    #[error("{}: geometry.polygons[{polygon}] (body '{body}') {what}; {remedy}", .scene.display())]
    Polygon {
        /// The scene file.
        scene: PathBuf,
        /// Index of the polygon, from 0.
        polygon: usize,
        /// Body of the polygon.
        body: String,
        /// The finding.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// The two sides of a contact or a bond do not coincide.
    #[error("{mesh}: {contact}: {what}; {remedy}")]
    Contact {
        /// The mesh file, or `[geometry]`.
        mesh: String,
        /// Which: `contact 'first|second'`, `contact 'first|rigid'`, `bond 'first|second'`.
        contact: String,
        /// The finding, with coordinates.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
}

impl MeshError {
    /// A [`MeshError::File`].
    pub(crate) fn file(file: &Path, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        MeshError::File { file: file.to_path_buf(), what: what.into(), remedy: remedy.into() }
    }

    /// A [`MeshError::Cells`].
    pub(crate) fn cells(scene: &Scene, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        MeshError::Cells { mesh: mesh_name(scene), what: what.into(), remedy: remedy.into() }
    }

    /// A [`MeshError::Boundary`].
    pub(crate) fn boundary(scene: &Scene, name: &str, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        MeshError::Boundary { mesh: mesh_name(scene), name: name.to_string(), what: what.into(), remedy: remedy.into() }
    }

    /// A [`MeshError::Contact`].
    pub(crate) fn contact(
        scene: &Scene,
        contact: impl Into<String>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        MeshError::Contact { mesh: mesh_name(scene), contact: contact.into(), what: what.into(), remedy: remedy.into() }
    }
}

/// How messages call the mesh of a scene.
fn mesh_name(scene: &Scene) -> String {
    match &scene.mesh {
        MeshSource::File(path) => format!("mesh file {}", path.display()),
        MeshSource::Parts(parts) => {
            let files: Vec<String> = parts.iter().map(|part| part.file.display().to_string()).collect();
            format!("mesh files {}", files.join(", "))
        }
        MeshSource::Geometry { .. } => format!("{}, [geometry]", scene.path.display()),
    }
}

/// Which command shows what the mesh of `scene` holds, to end a remedy with; nothing where it is made of polygons.
pub(crate) fn shown_by(scene: &Scene) -> String {
    match &scene.mesh {
        MeshSource::File(path) => format!("; `hypercircle mesh {}` shows what there is", path.display()),
        MeshSource::Parts(_) => "; `hypercircle mesh FILE` shows what there is in each file".to_string(),
        MeshSource::Geometry { .. } => String::new(),
    }
}

/// A point as messages show it: in the coordinates of the file.
pub fn at(scene: &Scene, point: [f64; 2]) -> String {
    let [x, y] = scene.as_written(point);
    format!("({x}, {y})")
}
