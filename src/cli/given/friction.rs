//! What commands and options do with friction.

use crate::cli::{CliError, Exit};
use crate::problem::rubs;
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
    Ok(())
}
