//! The element workbench: what is right and what is wrong with an element formulation.
//!
//! A displacement element is a stiffness matrix K on nodes, with the formula that makes it where there is one; an equilibrium element
//! is a space of stresses on a triangle. Each is asked a list of questions ([`displacement::PROPERTIES`], [`stress::PROPERTIES`]), one
//! file a family, whose answers are [`Finding`]s: a number, what it may be, a sentence, a picture. What cannot be looked at is not
//! made and never passes. Where a matrix is not that of the isoparametric element of its nodes, [`diagnosis`] looks for the mistake
//! that explains it.

pub mod diagnosis;
mod digits;
pub mod displacement;
mod finding;
pub mod formulas;
mod material;
mod outline;
mod page;
mod picture;
pub mod read;
mod report;
mod ring;
mod scene;
mod shipped;
pub mod stress;

pub use displacement::{DisplacementElement, Order, precision};
pub use finding::{Fault, Finding, Measured, Property};
pub use material::Material;
pub use outline::Outline;
pub use report::{NAMES, Options, Report, is_property, schema};
pub use shipped::{SHIPPED, Shipped, Subject, shipped};
