//! Restrictions of commands and options for bodies of revolution.

use crate::cli::{CliError, Exit};
use crate::problem::Problem;
use crate::scene::{Kinematics, Scene};

/// Refuses displacement models that do not exist for bodies of revolution.
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

/// A claim about a field that is not looked into on bodies of revolution.
#[derive(Debug, Clone, Copy, Default)]
pub struct Claims {
    /// Contact in the mean.
    pub weak: bool,
    /// A solution on triangles that contact cut.
    pub is_cut: bool,
    /// A solution of CalculiX.
    pub is_of_calculix: bool,
}

/// Refuses claims that are not looked into on bodies of revolution.
///
/// # Errors
/// Names the option.
pub fn refuse_claims(problem: &Problem, claims: Claims) -> Result<(), CliError> {
    let Claims { weak, is_cut, is_of_calculix } = claims;
    if !problem.section().is_revolved() || !(weak || is_cut || is_of_calculix) {
        return Ok(());
    }
    let (what, help) = if weak {
        (
            "--contact weak: contact in the mean is not looked into on bodies of revolution",
            "leave --contact out: the bounds are those of the field made admissible",
        )
    } else if is_of_calculix {
        (
            "--solution: in place of a body of revolution CalculiX computes a wedge of two degrees, whose equations are others by up to some \
             parts in a thousand",
            "leave --solution out: the bounds on the error of its field are guaranteed all the same",
        )
    } else {
        (
            "--solution: contacts cut triangles of the file, and what is then the discrete solution is not looked into on bodies of revolution",
            "give both sides of every contact the same vertices, and kinks of the gap one, or leave --solution out",
        )
    };
    Err(CliError::stopped(Exit::BadInput, what, help))
}
