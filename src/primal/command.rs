//! A displacement solver of somebody's own, run in the place of FEniCSx.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::str::FromStr;
use std::time::Duration;

use super::exchange::{PROBLEM_FILE, solution_file};
use super::{Cells, HIGHEST_DEGREE, PrimalError, Space};
use crate::process::{Outcome, Scratch, package, python, supervise, words};

/// Placeholder of the exchange file in a command.
const PROBLEM: &str = "{problem}";
/// Placeholder of the folder of the result files.
const OUT: &str = "{out}";
/// The exit code of a program that has no answer, and says why.
const NO_ANSWER: i32 = 3;
/// Placeholder of the degrees that are wanted, separated by commas.
const DEGREES: &str = "{degrees}";

/// A command with `{problem}` and `{out}` in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SolverCommand {
    line: String,
    words: Vec<String>,
}

impl FromStr for SolverCommand {
    type Err = String;

    fn from_str(line: &str) -> Result<Self, String> {
        let words = words::split(line).map_err(|error| format!("{error}; give it as you would to a shell"))?;
        for name in [PROBLEM, OUT] {
            if !words[1..].iter().any(|word| word.contains(name)) {
                return Err(format!("{name} is missing; give a command like 'my-solver {PROBLEM} {OUT}'"));
            }
        }
        Ok(SolverCommand { line: line.to_owned(), words })
    }
}

impl SolverCommand {
    /// The command as it was given.
    pub fn line(&self) -> &str {
        &self.line
    }

    /// The name of the program, for a solver that does not tell its own.
    pub fn name(&self) -> String {
        let program = Path::new(&self.words[0]);
        program.file_name().map_or_else(|| self.words[0].clone(), |name| name.to_string_lossy().into_owned())
    }

    /// True if the command is told the degrees that are wanted; it then owes each of them.
    fn is_told_degrees(&self) -> bool {
        self.words.iter().any(|word| word.contains(DEGREES))
    }

    /// Runs the program in the current folder, and finds out for which spaces there is a result in `folder` then; of `degrees` that
    /// the command is told each is owed, on triangles or on quadrilaterals.
    ///
    /// # Errors
    /// [`PrimalError`].
    pub fn run(&self, folder: &Path, degrees: &[u8], limit: Duration) -> Result<Vec<Space>, PrimalError> {
        let in_folder = |source| PrimalError::Io { path: folder.to_owned(), source };
        let folder = std::path::absolute(folder).map_err(in_folder)?;
        let scratch = Scratch::new().map_err(|source| PrimalError::Io { path: std::env::temp_dir(), source })?;
        let missing = || PrimalError::NotFound(self.words[0].clone());
        let mut command = Command::new(self.find().ok_or_else(missing)?);
        command.args(self.words[1..].iter().map(|word| self.filled(word, &folder, degrees)));
        command.env("TMPDIR", scratch.path());
        let of = || format!("the displacement solver {}", self.name());
        let ended = supervise(&mut command, limit).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => missing(),
            _ => PrimalError::Failed { of: of(), status: "it did not start".to_owned(), log: error.to_string() },
        })?;
        let log = ended.text();
        let there = |space: Space| fs::exists(folder.join(solution_file(space))).unwrap_or(true);
        match ended.outcome {
            Outcome::TimedOut => Err(PrimalError::TimedOut { of: of(), limit, log }),
            Outcome::Lost(error) => Err(PrimalError::Failed { of: of(), status: format!("lost: {error}"), log }),
            Outcome::Exit(status) if status.code() == Some(NO_ANSWER) => Err(PrimalError::NoAnswer { of: of(), log }),
            Outcome::Exit(status) if !status.success() => {
                Err(PrimalError::Failed { of: of(), status: package::words(status), log })
            }
            Outcome::Exit(_) if self.is_told_degrees() => {
                let space = |degree: &u8| {
                    let whole = Space { cells: Cells::Quadrilaterals, degree: *degree };
                    if there(whole) { whole } else { Space::on_triangles(*degree) }
                };
                Ok(degrees.iter().map(space).collect())
            }
            Outcome::Exit(_) => {
                let on = |cells| (1..=HIGHEST_DEGREE).map(move |degree| Space { cells, degree });
                let all = on(Cells::Triangles).chain(on(Cells::Quadrilaterals));
                let found: Vec<Space> = all.filter(|space| there(*space)).collect();
                if found.is_empty() { Err(PrimalError::NoResult { of: of(), log }) } else { Ok(found) }
            }
        }
    }

    /// The file of the program: a bare name is looked up in `PATH`.
    fn find(&self) -> Option<PathBuf> {
        python::find(Path::new(&self.words[0]))
    }

    /// A word with what stands for files and degrees replaced.
    fn filled(&self, word: &str, folder: &Path, degrees: &[u8]) -> OsString {
        let degrees: Vec<String> = degrees.iter().map(u8::to_string).collect();
        let problem = folder.join(PROBLEM_FILE);
        let known = [(PROBLEM, problem.as_os_str()), (OUT, folder.as_os_str()), (DEGREES, degrees.join(",").as_ref())]
            .map(|(name, value)| (name, value.to_owned()));
        let (mut filled, mut rest) = (OsString::new(), word);
        // From left to right: what is put in is not looked at again.
        while let Some((at, (name, value))) =
            known.iter().filter_map(|entry| Some((rest.find(entry.0)?, entry))).min_by_key(|(at, _)| *at)
        {
            filled.push(&rest[..at]);
            filled.push(value);
            rest = &rest[at + name.len()..];
        }
        filled.push(rest);
        filled
    }
}

#[cfg(test)]
#[path = "command_tests.rs"]
mod tests;
