//! The two files shared with the displacement model; `docs/exchange.md` describes them.

mod problem;
mod solution;

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;

pub use solution::{parse_solution, read_solution};

use super::{Cells, HIGHEST_DEGREE, PrimalError, Space};
use crate::problem::{Pin, Problem};
use problem::ProblemFile;

/// Name of the file the model reads.
pub const PROBLEM_FILE: &str = "problem.json";

/// Name of the file the model writes for `space`.
pub fn solution_file(space: Space) -> String {
    format!("primal-{space}.json")
}

/// Write `problem.json` into `folder`, which is made where it does not exist. Results of an earlier run are removed.
pub fn write_problem(problem: &Problem, pins: &[Pin], folder: &Path) -> Result<(), PrimalError> {
    let in_folder = |source| PrimalError::Io { path: folder.to_owned(), source };
    fs::create_dir_all(folder).map_err(in_folder)?;
    for cells in [Cells::Triangles, Cells::Quadrilaterals] {
        for degree in 1..=HIGHEST_DEGREE {
            match fs::remove_file(folder.join(solution_file(Space { cells, degree }))) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(in_folder(error)),
                _ => {}
            }
        }
    }
    let path = folder.join(PROBLEM_FILE);
    let in_file = |source| PrimalError::Io { path: path.clone(), source };
    let mut writer = BufWriter::new(File::create(&path).map_err(in_file)?);
    serde_json::to_writer(&mut writer, &ProblemFile::new(problem, pins)).map_err(|error| in_file(error.into()))?;
    writer.flush().map_err(in_file)
}

#[cfg(test)]
mod tests;
