//! What commands and options do with bodies of revolution.

use super::{CliError, Exit};
use crate::scene::{Kinematics, Scene};

/// Refuses displacement models that there are none of for bodies of revolution.
///
/// # Errors
/// Names what was asked for.
pub fn refuse_models(scene: &Scene, degrees: &[u8]) -> Result<(), CliError> {
    let high = degrees.iter().find(|degree| **degree > 2).filter(|_| scene.kinematics == Kinematics::Axisymmetric);
    high.map_or(Ok(()), |degree| {
        let what = format!("--primal-degree {degree}: displacement models of bodies of revolution have degree 1 or 2");
        Err(CliError::stopped(Exit::BadInput, what, "leave degrees above 2 out"))
    })
}

/// Refuses what is not there for bodies of revolution.
///
/// # Errors
/// Names what was asked for, and what there is.
pub fn refuse_unsupported(command: &str, scene: &Scene) -> Result<(), CliError> {
    if scene.kinematics != Kinematics::Axisymmetric {
        return Ok(());
    }
    if !matches!(command, "solve" | "verify") {
        let what = format!("{}: `{command}` does not take bodies of revolution", scene.path.display());
        return Err(CliError::stopped(
            Exit::BadInput,
            what,
            "`hypercircle solve` and `verify` take axisymmetric scenes",
        ));
    }
    Ok(())
}
