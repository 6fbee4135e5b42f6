//! Why a quantity is no bounded functional.

use crate::quantity::tip::NoTip;

/// Why a quantity is no bounded functional on a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotBounded {
    /// A force of a support that meets another one.
    #[error(
        "the support meets another one at ({x}, {y}), and how they share the force there is no bounded functional; ask for \
         the force of what lies apart from it"
    )]
    Shared {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
    /// The force of a contact up to a place where another boundary condition transmits force too.
    #[error(
        "what friction carries up to ({x}, {y}), where {what}, is no bounded functional; ask for the force within a `window` that is zero \
         there"
    )]
    Carried {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
        /// The other condition there.
        what: &'static str,
    },
    /// A region that leaves its body.
    #[error("of the region only {inside} % lie inside body '{body}'; give a region inside the body")]
    Outside {
        /// Per cent of the area, with one digit.
        inside: String,
        /// Name of the body.
        body: String,
    },
    /// A window beside the contact.
    #[error(
        "the window from {} to {} lies beside the contact, whose first side runs from {} to {}; give a window on it, in arc length along that \
         side",
        .window[0], .window[1], .contact[0], .contact[1]
    )]
    WindowOutside {
        /// Its ends.
        window: [f64; 2],
        /// Those of the contact.
        contact: [f64; 2],
    },
    /// A stress intensity where there is no tip of a crack.
    #[error(transparent)]
    NoTip(#[from] NoTip),
    /// A number that is no linear functional, but a function of several.
    #[error("`{word}` is no linear functional of the solution")]
    NotLinear {
        /// The word of the format.
        word: &'static str,
    },
    /// A point in a body whose values at points are no means with a known weight.
    #[error(
        "body '{body}' is not isotropic: the value at a point is a mean with a known weight only in isotropic bodies; ask for the mean over a \
         small region, `polygon = [...]` or `box = [...]` in the place of `point`"
    )]
    PointInAnisotropic {
        /// Name of the body.
        body: String,
    },
    /// A point that is not in its body.
    #[error("the point ({x}, {y}) does not lie in body '{body}'; give a point inside the body")]
    PointOutside {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// Name of the body.
        body: String,
    },
    /// A point where values are not bounded.
    #[error(
        "the point ({x}, {y}) lies on the outline of body '{body}', where a value at a point is no bounded functional; ask for {instead}"
    )]
    PointOnOutline {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// Name of the body.
        body: String,
        /// A bounded quantity to ask for, in the words of a scene.
        instead: String,
    },
    /// A quantity that has no interval in bodies of revolution.
    #[error(
        "a body of revolution has no interval for {what}; ask for the force of a contact, the axial force of a support, or a mean displacement or \
         stress"
    )]
    Revolved {
        /// In words.
        what: &'static str,
    },
    /// A boundary without edges.
    #[error("no edge of the mesh belongs to '{name}'")]
    Empty {
        /// Name of the boundary or body.
        name: String,
    },
}
