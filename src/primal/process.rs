//! Runs the Python package in a process under supervision.

use std::ffi::OsString;
use std::path::Path;

use super::exchange::PROBLEM_FILE;
use super::{Cells, Options, PrimalError, Sabotage, Space};
use crate::process::package::{Call, Failure, Package};

/// Who is meant in messages.
const FENICSX: &str = "the FEniCSx reference";

/// The Python package.
const PACKAGE: Package = Package {
    name: "hypercircle_reference",
    files: &[
        ("__init__.py", include_str!("../../reference/hypercircle_reference/__init__.py")),
        ("__main__.py", include_str!("../../reference/hypercircle_reference/__main__.py")),
        ("builder.py", include_str!("../../reference/hypercircle_reference/builder.py")),
        ("compat.py", include_str!("../../reference/hypercircle_reference/compat.py")),
        ("constraints.py", include_str!("../../reference/hypercircle_reference/constraints.py")),
        ("coulomb.py", include_str!("../../reference/hypercircle_reference/coulomb.py")),
        ("coupled.py", include_str!("../../reference/hypercircle_reference/coupled.py")),
        ("descent.py", include_str!("../../reference/hypercircle_reference/descent.py")),
        ("exchange.py", include_str!("../../reference/hypercircle_reference/exchange.py")),
        ("friction.py", include_str!("../../reference/hypercircle_reference/friction.py")),
        ("group.py", include_str!("../../reference/hypercircle_reference/group.py")),
        ("inside.py", include_str!("../../reference/hypercircle_reference/inside.py")),
        ("lattice.py", include_str!("../../reference/hypercircle_reference/lattice.py")),
        ("model.py", include_str!("../../reference/hypercircle_reference/model.py")),
        ("records.py", include_str!("../../reference/hypercircle_reference/records.py")),
        ("results.py", include_str!("../../reference/hypercircle_reference/results.py")),
        ("run.py", include_str!("../../reference/hypercircle_reference/run.py")),
        ("solve.py", include_str!("../../reference/hypercircle_reference/solve.py")),
        ("springs.py", include_str!("../../reference/hypercircle_reference/springs.py")),
        ("touching.py", include_str!("../../reference/hypercircle_reference/touching.py")),
    ],
};

/// Solve the problem in `folder`, which then holds one result file for each of `spaces`.
pub fn run(folder: &Path, options: &Options, spaces: &[Space]) -> Result<(), PrimalError> {
    let in_folder = |source| PrimalError::Io { path: folder.to_owned(), source };
    let folder = std::path::absolute(folder).map_err(in_folder)?;
    let call = Call {
        interpreter: options.interpreter.as_deref(),
        ranks: options.ranks,
        arguments: arguments(&folder, options, spaces),
        limit: options.timeout,
    };
    PACKAGE.run(&call).map_err(|failure| match failure {
        Failure::NotInstalled(reason) => PrimalError::NotInstalled(reason),
        Failure::Failed { status, log } => PrimalError::Failed { of: FENICSX.to_owned(), status, log },
        Failure::TimedOut { log } => PrimalError::TimedOut { of: FENICSX.to_owned(), limit: options.timeout, log },
        Failure::Io { path, source } => PrimalError::Io { path, source },
    })
}

fn arguments(folder: &Path, options: &Options, spaces: &[Space]) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = vec![folder.join(PROBLEM_FILE).into(), "--out".into(), folder.into()];
    for Space { cells, degree } in spaces {
        let option = match cells {
            Cells::Triangles => "--degree",
            Cells::Quadrilaterals => "--quadrilaterals",
        };
        arguments.extend([option.into(), degree.to_string().into()]);
    }
    let sabotage = options.sabotage.map(|sabotage| match sabotage {
        Sabotage::FlipSign => "flip-sign",
        Sabotage::DropRow => "drop-row",
    });
    arguments.extend(sabotage.into_iter().flat_map(|name| ["--sabotage".into(), name.into()]));
    arguments.extend(options.nodal_contact.then(|| "--nodal-contact".into()));
    arguments
}

#[cfg(test)]
#[path = "process_tests.rs"]
mod tests;
