//! Restrictions of commands for Coulomb friction.

use crate::cli::{CliError, Exit};
use crate::problem::follows_coulomb;
use crate::scene::Scene;

/// Refuses ranges of the data beside Coulomb friction, which are there beside friction with a given bound.
///
/// # Errors
/// Names what was asked for, and what there is.
pub fn refuse_ranges(scene: &Scene) -> Result<(), CliError> {
    let Some(range) = scene.ranges.first().filter(|_| follows_coulomb(scene)) else { return Ok(()) };
    let what = format!(
        "{} is a range: the energy of Coulomb friction is not monotone in the data, so that two ends say nothing of what lies between",
        scene.name_of(range)
    );
    Err(stopped(scene, &what, "write one number, or give the bound of friction itself"))
}

/// Refuses to chart Coulomb friction.
///
/// # Errors
/// Says why, and what there is.
pub fn refuse_chart(scene: &Scene) -> Result<(), CliError> {
    if !follows_coulomb(scene) {
        return Ok(());
    }
    Err(stopped(
        scene,
        "`chart` does not take Coulomb friction: its solutions have no bracket of their own to measure errors against",
        "give the bound of friction itself, `friction = { bound = ... }`, or use `solve`, `verify` or `certify`",
    ))
}

fn stopped(scene: &Scene, what: &str, help: &str) -> CliError {
    CliError::stopped(Exit::BadInput, format!("{}: {what}", scene.path.display()), help)
}
