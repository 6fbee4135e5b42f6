//! Parts of a scene before it is checked, and the text it would be in a file.
//!
//! A scene made by a program passes the same checks as one that is read: it is written as TOML and parsed. Messages point into
//! that text.

mod text;

use std::ops::Deref;
use std::path::PathBuf;

pub(crate) use text::{key, quoted};

use super::keys::range::DataRange;
use super::{
    Body, BodyCells, Bond, Boundary, Contact, Kinematics, MeshSource, Quantity, Scene, SceneError, Support, Traction,
};

/// The parts of a scene, checked or not; [`Scene::new`] makes a scene of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// Names the output folder; the file stem of a scene file.
    pub name: String,
    /// `title`, or the name where none was given.
    pub title: String,
    /// The scene file; mesh paths in it are relative to its folder.
    pub path: PathBuf,
    /// The point in the coordinates of the file from which coordinates and load gradients count; [0, 0] unless the scene
    /// lies far away (see [`Scene::as_written`]).
    pub origin: [f64; 2],
    /// Plane strain or plane stress.
    pub kinematics: Kinematics,
    /// Thickness t > 0 of the plate; multiplies energies and resultants.
    pub thickness: f64,
    /// Where the triangles come from.
    pub mesh: MeshSource,
    /// Bodies in the order of the file.
    pub bodies: Vec<Body>,
    /// The cells of bodies that are not found by their name.
    pub cells: Vec<BodyCells>,
    /// Names for parts of the outline that the mesh leaves without.
    pub boundaries: Vec<Boundary>,
    /// Γ_u and Γ_0.
    pub supports: Vec<Support>,
    /// Γ_τ.
    pub tractions: Vec<Traction>,
    /// Γ_K.
    pub contacts: Vec<Contact>,
    /// Boundaries that are glued to each other.
    pub bonds: Vec<Bond>,
    /// Quantities that the scene is solved for, in the order of the file.
    pub quantities: Vec<Quantity>,
    /// Numbers that are known between two ends alone; bodies and contacts have those with the lowest energy.
    pub ranges: Vec<DataRange>,
}

impl Draft {
    /// Without bodies and conditions, of thickness one.
    pub fn new(name: &str, kinematics: Kinematics, mesh: MeshSource) -> Self {
        Draft {
            name: name.to_owned(),
            title: name.to_owned(),
            path: PathBuf::from(format!("{name}.toml")),
            origin: [0.0; 2],
            kinematics,
            thickness: kinematics.measure(),
            mesh,
            bodies: Vec::new(),
            cells: Vec::new(),
            boundaries: Vec::new(),
            supports: Vec::new(),
            tractions: Vec::new(),
            contacts: Vec::new(),
            bonds: Vec::new(),
            quantities: Vec::new(),
            ranges: Vec::new(),
        }
    }
}

impl Scene {
    /// The scene of these parts, if it is one.
    ///
    /// # Errors
    /// As [`Scene::parse`], for the text of [`Draft::to_toml`].
    pub fn new(draft: Draft) -> Result<Self, SceneError> {
        let checked = Scene::parse(&draft.to_toml(), &draft.path)?;
        // Directions have the length one now; what the text cannot say is as it was.
        let Draft { name, title, path, origin, mesh, .. } = draft;
        Ok(Scene { draft: Draft { name, title, path, origin, mesh, ..checked.draft } })
    }

    /// The scene with some parts changed, if it is one.
    ///
    /// # Errors
    /// As [`Scene::new`].
    pub fn changed(&self, change: impl FnOnce(&mut Draft)) -> Result<Self, SceneError> {
        let mut draft = self.draft.clone();
        change(&mut draft);
        Scene::new(draft)
    }

    /// A copy without the size of [`MeshSource::Geometry`].
    pub fn coarsest(&self) -> Self {
        let mut draft = self.draft.clone();
        if let MeshSource::Geometry { size, .. } = &mut draft.mesh {
            *size = None;
        }
        Scene { draft }
    }

    /// The scene of parts that are known to make one.
    #[doc(hidden)]
    pub fn unchecked(draft: Draft) -> Self {
        Scene { draft }
    }
}

impl Deref for Scene {
    type Target = Draft;

    fn deref(&self) -> &Draft {
        &self.draft
    }
}
