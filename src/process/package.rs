//! Python packages that this program carries inside it, so that both always belong together, and their runs.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::time::Duration;

use super::{Ended, Outcome, Scratch, python, supervise};

/// A package as it is carried.
#[derive(Debug, Clone, Copy)]
pub struct Package {
    /// Its name in Python.
    pub name: &'static str,
    /// Names and texts of its files.
    pub files: &'static [(&'static str, &'static str)],
}

/// How a package is run.
#[derive(Debug, Clone)]
pub struct Call<'a> {
    /// The Python interpreter; `None` asks `HYPERCIRCLE_PYTHON`, then takes `/usr/bin/python3`.
    pub interpreter: Option<&'a Path>,
    /// Number of MPI ranks; `None` runs without `mpirun`.
    pub ranks: Option<usize>,
    /// Arguments of the package.
    pub arguments: Vec<OsString>,
    /// The process is ended when it takes longer.
    pub limit: Duration,
}

/// Why a package did not run to its end.
#[derive(Debug)]
pub enum Failure {
    /// The interpreter, `mpirun` or a Python package is missing.
    NotInstalled(String),
    /// The process ended without success.
    Failed {
        /// How it ended.
        status: String,
        /// The last lines it printed.
        log: String,
    },
    /// The process did not end in time and was stopped.
    TimedOut {
        /// The last lines it printed.
        log: String,
    },
    /// A folder cannot be used.
    Io {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

/// The package that all others import.
const SHARED: Package = Package {
    name: "hypercircle_process",
    files: &[("__init__.py", include_str!("../../reference/hypercircle_process/__init__.py"))],
};

/// Exit code of a package that lacks something it imports.
const NOT_INSTALLED: i32 = 4;

/// Settings that relieve Open MPI where one process is all there is; those of the user go first.
const ALONE: [(&str, &str); 2] = [("OMPI_MCA_pml", "ob1"), ("OMPI_MCA_ess_singleton_isolated", "1")];

impl Package {
    /// Runs the package as `python3 -m` does, in an empty folder, and waits for its end. Of a package `a_b` a line that
    /// begins with `a-b: not installed:` names what is missing.
    ///
    /// `HYPERCIRCLE_REFERENCE` may name a folder with another copy of the package.
    ///
    /// # Errors
    /// [`Failure`].
    pub fn run(&self, call: &Call<'_>) -> Result<(), Failure> {
        let scratch = Scratch::new().map_err(|source| Failure::Io { path: env::temp_dir(), source })?;
        let in_scratch = |source| Failure::Io { path: scratch.path().to_owned(), source };
        let folder = match env::var_os("HYPERCIRCLE_REFERENCE") {
            Some(given) => {
                let given = PathBuf::from(given);
                std::path::absolute(&given).map_err(|source| Failure::Io { path: given, source })?
            }
            None => self.unpack(&scratch).map_err(in_scratch)?,
        };
        let missing = [(self.name, "__main__.py"), (SHARED.name, "__init__.py")]
            .into_iter()
            .find(|(name, file)| !folder.join(name).join(file).is_file());
        if let Some((name, _)) = missing {
            let reason = format!("{} (from HYPERCIRCLE_REFERENCE) holds no {name}", folder.display());
            return Err(Failure::NotInstalled(reason));
        }
        let place = scratch.folder("run").map_err(in_scratch)?;
        let mut command = self.command(&folder, &place, call)?;
        let program = command.get_program().to_owned();
        let ended = supervise(&mut command, call.limit).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => Failure::NotInstalled(format!("{} does not exist", program.display())),
            _ => Failure::Failed { status: format!("{} did not start", program.display()), log: error.to_string() },
        })?;
        self.judge(ended)
    }

    /// Puts the package, and what it imports, into a folder of `scratch`, which is the result.
    fn unpack(&self, scratch: &Scratch) -> io::Result<PathBuf> {
        let root = scratch.folder("package")?;
        for package in [self, &SHARED] {
            let folder = root.join(package.name);
            fs::create_dir(&folder)?;
            for (name, text) in package.files {
                fs::write(folder.join(name), text)?;
            }
        }
        Ok(root)
    }

    fn command(&self, package: &Path, place: &Path, call: &Call<'_>) -> Result<Command, Failure> {
        let launcher: Vec<OsString> = match call.ranks {
            None => Vec::new(),
            Some(ranks) => {
                let missing = || Failure::NotInstalled("mpirun does not exist".to_owned());
                let mpirun = python::find(Path::new("mpirun")).ok_or_else(missing)?;
                let count = ranks.to_string();
                // Bound to a core, the first ranks of several runs would share the first core.
                let arguments = ["--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", &count];
                let arguments = arguments.map(OsString::from);
                std::iter::once(mpirun.into_os_string()).chain(arguments).collect()
            }
        };
        let start = format!("import runpy\nrunpy.run_module('{}', run_name='__main__', alter_sys=True)\n", self.name);
        let mut command = python::command(&interpreter(call.interpreter)?, &start, place, &launcher, Some(package))
            .map_err(|source| Failure::Io { path: place.to_owned(), source })?;
        command.args(&call.arguments).env("OMP_NUM_THREADS", "1");
        // Ranks that wait leave the processor to others.
        command.env("OMPI_MCA_mpi_yield_when_idle", "1");
        if call.ranks.is_none() {
            // Open MPI takes 0.3 s to look for networks and to start a daemon, and one process talks to nobody.
            for (name, value) in ALONE {
                if env::var_os(name).is_none() {
                    command.env(name, value);
                }
            }
        }
        Ok(command)
    }

    /// Translates the end of the process.
    fn judge(&self, ended: Ended) -> Result<(), Failure> {
        let log = ended.text();
        match ended.outcome {
            Outcome::TimedOut => Err(Failure::TimedOut { log }),
            Outcome::Lost(error) => Err(Failure::Failed { status: format!("lost: {error}"), log }),
            Outcome::Exit(status) if status.success() => Ok(()),
            Outcome::Exit(status) if status.code() == Some(NOT_INSTALLED) => {
                let begin = format!("{}: not installed:", self.name.replace('_', "-"));
                let reason = ended.log.iter().find_map(|line| line.strip_prefix(&begin)).map(str::trim);
                Err(Failure::NotInstalled(reason.map_or(log, str::to_owned)))
            }
            Outcome::Exit(status) => Err(Failure::Failed { status: words(status), log }),
        }
    }
}

fn interpreter(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let found = given
        .map(Path::to_path_buf)
        .or_else(|| env::var_os("HYPERCIRCLE_PYTHON").map(PathBuf::from))
        .unwrap_or_else(|| PathBuf::from("/usr/bin/python3"));
    python::find(&found).ok_or_else(|| Failure::NotInstalled(format!("{} does not exist", found.display())))
}

/// How a process ended.
pub fn words(status: ExitStatus) -> String {
    match (status.code(), status.signal()) {
        (Some(code), _) => format!("exit code {code}"),
        (None, Some(signal)) => format!("ended by signal {signal}"),
        (None, None) => "ended abnormally".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn one_process_looks_for_no_network_and_ranks_may() {
        let package = Package { name: "none", files: &[] };
        let named = |ranks| {
            let limit = Duration::from_secs(1);
            let call = Call { interpreter: Some(Path::new("/bin/sh")), ranks, arguments: Vec::new(), limit };
            let command = package.command(Path::new("/"), Path::new("/"), &call).ok()?;
            Some(ALONE.map(|(name, _)| command.get_envs().any(|(key, value)| key == name && value.is_some())))
        };
        assert_eq!(named(None), Some(ALONE.map(|(name, _)| env::var_os(name).is_none())));
        if let Some(ranks) = named(Some(2)) {
            assert_eq!(ranks, [false; 2]);
        }
    }
}
