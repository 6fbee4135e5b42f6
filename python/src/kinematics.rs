//! The plane state by its name.

use pyo3::PyResult;

use crate::errors::fault;
use hypercircle::scene::Kinematics;

/// The plane state of that name.
///
/// # Errors
/// `InputError` for any other.
pub fn kinematics_named(name: &str) -> PyResult<Kinematics> {
    Kinematics::named(name)
        .ok_or_else(|| fault(format!("kinematics '{name}'; use plane-strain, plane-stress or axisymmetric")))
}
