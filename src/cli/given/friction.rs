//! Restrictions of commands and options for friction.

use crate::cli::{CliError, Exit};
use crate::problem::{follows_coulomb, rubs};
use crate::scene::Scene;

/// The commands that take contacts with friction.
const COMMANDS: [&str; 3] = ["solve", "verify", "certify"];

/// Refuses what is not there for contacts with friction.
///
/// # Errors
/// Names what was asked for, and what there is.
pub fn refuse_friction(command: &str, scene: &Scene) -> Result<(), CliError> {
    if !rubs(scene) {
        return Ok(());
    }
    let path = scene.path.display();
    if !COMMANDS.contains(&command) {
        let what = format!("{path}: `{command}` does not take contacts with friction");
        return Err(CliError::stopped(
            Exit::BadInput,
            what,
            "leave `friction` out of the scene, or use `solve`, `verify` or `certify`",
        ));
    }
    refuse_coulomb(scene)
}

/// Refuses what is not there for Coulomb friction, and is for friction with a given bound.
fn refuse_coulomb(scene: &Scene) -> Result<(), CliError> {
    let stop = |what: String, help: &str| {
        Err(CliError::stopped(Exit::BadInput, format!("{}: {what}", scene.path.display()), help))
    };
    if !follows_coulomb(scene) {
        return Ok(());
    }
    if let Some(range) = scene.ranges.first() {
        let what = format!(
            "{} is a range: the energy of Coulomb friction is not monotone in the data, so that two ends say nothing of what lies between",
            scene.name_of(range)
        );
        return stop(what, "write one number, or give the bound of friction itself");
    }
    Ok(())
}
