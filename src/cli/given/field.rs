//! Fields that are handed over by callers whose options no parser has seen.

use crate::cli::{CliError, Exit};

/// Where a field comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldFrom {
    /// A file.
    File,
    /// Arrays of the caller.
    Arrays,
    /// There is none, but values of quantities.
    Nowhere,
}

impl FieldFrom {
    /// The one of the two that was given.
    pub fn of(is_file: bool, are_arrays: bool) -> Self {
        match (is_file, are_arrays) {
            (true, _) => FieldFrom::File,
            (false, true) => FieldFrom::Arrays,
            (false, false) => FieldFrom::Nowhere,
        }
    }

    /// Refuses what a caller whose options no parser has seen says of a field, where it would do nothing: a name of point data, and the
    /// claim of a solution.
    ///
    /// # Errors
    /// Bad input.
    pub fn refuse_unheard(self, is_named: bool, is_solution: bool) -> Result<(), CliError> {
        let [message, remedy] = match self {
            FieldFrom::Arrays | FieldFrom::Nowhere if is_named => {
                ["field names the point data of a file, and there is none", "leave it out, or give a file"]
            }
            FieldFrom::Nowhere if is_solution => [
                "solution is about a displacement field, and only values are certified",
                "leave it out, or give the field",
            ],
            _ => return Ok(()),
        };
        Err(CliError::stopped(Exit::BadInput, message, remedy))
    }
}
