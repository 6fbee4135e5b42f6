//! What commands and options do with bodies of revolution.

use super::{CliError, Exit};
use crate::scene::{Kinematics, Scene};

/// Refuses what is not there for bodies of revolution.
///
/// # Errors
/// Names what was asked for, and what there is.
pub fn refuse_unsupported(command: &str, scene: &Scene) -> Result<(), CliError> {
    if scene.kinematics != Kinematics::Axisymmetric {
        return Ok(());
    }
    let refused = |what: String, remedy: &str| Err(CliError::stopped(Exit::BadInput, what, remedy));
    if command != "solve" {
        let what = format!("{}: `{command}` does not take bodies of revolution", scene.path.display());
        return refused(what, "`hypercircle solve` brackets the energy of axisymmetric scenes");
    }
    if let Some(quantity) = scene.quantities.first() {
        let what = format!(
            "{}: the quantity `{}` has no interval, because those of bodies of revolution are not computed",
            scene.path.display(),
            quantity.name
        );
        return refused(what, "leave [[quantities]] out of the axisymmetric scene");
    }
    Ok(())
}
