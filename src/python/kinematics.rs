//! The plane state by its name.

use pyo3::PyResult;

use super::errors::fault;
use crate::scene::Kinematics;

/// The plane state of that name.
///
/// # Errors
/// `InputError` for any other.
pub fn kinematics_named(name: &str) -> PyResult<Kinematics> {
    match name {
        "plane-strain" => Ok(Kinematics::PlaneStrain),
        "plane-stress" => Ok(Kinematics::PlaneStress),
        other => Err(fault(format!("kinematics '{other}': use plane-strain or plane-stress"))),
    }
}

/// Its name.
pub fn name_of(kinematics: Kinematics) -> &'static str {
    match kinematics {
        Kinematics::PlaneStrain => "plane-strain",
        Kinematics::PlaneStress => "plane-stress",
    }
}
