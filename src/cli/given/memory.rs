//! Memory that a run needs, refused in time and with figures.

use crate::budget::{Budget, Excess};
use crate::cli::{CliError, Exit};
use crate::scene::Scene;

/// Remedy for a mesh that does not fit.
pub const COARSER: &str =
    "choose a coarser mesh, refine where it is needed with --tolerance, or allow more with --max-memory";

/// The answer to a mesh of `scene` that would not fit into memory, before it is made: `cause` asks for it.
pub fn too_fine(scene: &Scene, cause: &str, triangles: f64, excess: Excess) -> CliError {
    let triangles = rounded(triangles);
    let message =
        format!("{}: {cause} makes about {triangles} triangles, for which about {excess}", scene.path.display());
    CliError::stopped(Exit::BadInput, message, COARSER)
}

/// A count to three digits.
fn rounded(count: f64) -> String {
    if count >= 1e9 {
        return format!("{count:.1e}");
    }
    let unit = 10.0_f64.powi((count.max(1.0).log10().floor() as i32 - 2).max(0));
    format!("{:.0}", (count / unit).round() * unit)
}

/// The budget, if the program itself fits into it.
///
/// # Errors
/// It does not.
pub fn enough(budget: Budget) -> Result<Budget, CliError> {
    /// Bytes below which not even a few triangles fit.
    const LEAST: f64 = 20e6;
    budget.admit(LEAST).map(|()| budget).map_err(|excess| {
        CliError::stopped(
            Exit::Failed,
            format!("for any run {excess}"),
            "allow more with --max-memory; under a limit of the address space (ulimit -v), products of matrices take \
             twice the processor's last cache on each thread beside it",
        )
    })
}
