//! Why a scene and a mesh do not make a problem.

use crate::mesh::MeshError;

/// A scene and a mesh that do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProblemError {
    /// The mesh itself.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The sides of a contact.
    #[error("contact '{contact}': {what}; {remedy}")]
    Contact {
        /// `first|second` or `first|rigid`.
        contact: String,
        /// The finding, with coordinates.
        what: String,
        /// The remedy.
        remedy: String,
    },
}
