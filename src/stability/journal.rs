//! Runs that were made, one line each, so that an interrupted sweep can go on and equal problems are solved once.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::measure::Ended;
use crate::study::{hash, hex};

/// Name of a run: the same problem, method, options and program have the same one.
pub(super) type Name = String;

#[derive(Serialize, Deserialize)]
struct Line {
    run: Name,
    ended: Ended,
}

/// A file of finished runs, and the runs in it.
pub struct Journal {
    file: Option<Mutex<File>>,
    runs: Mutex<HashMap<Name, Ended>>,
    program: String,
}

impl Journal {
    /// A journal of `program` in `folder/runs.jsonl`: what an earlier sweep left there is kept if `resume`, and begun
    /// anew otherwise.
    ///
    /// # Errors
    /// The file cannot be written, or the program not be read; with its path.
    pub fn open(folder: &Path, program: &Path, resume: bool) -> Result<Journal, (PathBuf, std::io::Error)> {
        let path = folder.join("runs.jsonl");
        let at = |e: std::io::Error| (path.clone(), e);
        std::fs::create_dir_all(folder).map_err(at)?;
        let bytes = if resume { std::fs::read(&path).unwrap_or_default() } else { Vec::new() };
        // The last line of an interrupted sweep may be half a line; it is written again.
        let lines = bytes.split(|b| *b == b'\n').filter_map(|line| serde_json::from_slice::<Line>(line).ok());
        let runs: HashMap<Name, Ended> = lines.map(|line| (line.run, line.ended)).collect();
        let mut file = OpenOptions::new().create(true).append(true).open(&path).map_err(at)?;
        if !resume {
            file.set_len(0).map_err(at)?;
        } else if bytes.last().is_some_and(|b| *b != b'\n') {
            file.write_all(b"\n").map_err(at)?;
        }
        // Runs of another build are other runs.
        let build = std::fs::read(program).map_err(|e| (program.to_path_buf(), e))?;
        Ok(Journal { file: Some(Mutex::new(file)), runs: Mutex::new(runs), program: hash(&build) })
    }

    /// A journal without a file.
    pub fn in_memory() -> Journal {
        Journal { file: None, runs: Mutex::new(HashMap::new()), program: String::new() }
    }

    /// The name of the run that solves `problem` with `options`.
    pub(super) fn name(&self, problem: &str, options: &str) -> Name {
        let mut hasher = Sha256::new();
        for part in [&self.program, problem, options] {
            hasher.update(part.len().to_le_bytes());
            hasher.update(part);
        }
        hex(&hasher.finalize())
    }

    fn runs(&self) -> MutexGuard<'_, HashMap<Name, Ended>> {
        self.runs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How a run ended, if it was made.
    pub(super) fn get(&self, run: &Name) -> Option<Ended> {
        self.runs().get(run).cloned()
    }

    /// Keeps a run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn put(&self, run: Name, ended: Ended) -> std::io::Result<()> {
        let line = Line { run, ended };
        if let Some(file) = &self.file {
            let mut text = serde_json::to_string(&line)?;
            text.push('\n');
            file.lock().unwrap_or_else(PoisonError::into_inner).write_all(text.as_bytes())?;
        }
        self.runs().insert(line.run, line.ended);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finished_runs_are_kept_and_half_a_line_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let program = folder.path().join("program");
        std::fs::write(&program, "one build").expect("writable");
        let open = |resume| Journal::open(folder.path(), &program, resume).map_err(|e| e.1).expect("opens");
        let journal = open(false);
        let [a, b] = ["a", "b"].map(|options| journal.name("problem", options));
        assert_ne!(a, b);
        journal.put(a.clone(), Ended::OverBudget).expect("writable");
        let path = folder.path().join("runs.jsonl");
        let mut text = std::fs::read_to_string(&path).expect("readable");
        text.push_str("{\"run\": \"b\", \"en");
        std::fs::write(&path, text).expect("writable");

        let again = open(true);
        assert_eq!(again.get(&a), Some(Ended::OverBudget));
        again.put(b.clone(), Ended::Crashed("signal".to_string())).expect("writable");
        let third = open(true);
        assert_eq!(third.get(&a), Some(Ended::OverBudget));
        assert_eq!(third.get(&b), Some(Ended::Crashed("signal".to_string())));

        std::fs::write(&program, "another build").expect("writable");
        assert_eq!(open(true).get(&open(true).name("problem", "a")), None);
        std::fs::write(&program, "one build").expect("writable");
        assert_eq!(open(false).get(&a), None);
    }
}
