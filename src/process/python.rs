//! How Python is started.
//!
//! An interpreter looks for modules in its current folder first, and in what empty and relative entries of `PYTHONPATH`
//! stand for. A `json.py` beside a scene would be run by whoever reads the scene. So: the current folder of an interpreter
//! is an empty one of this program, the entries that mean "wherever I am" are left out of `PYTHONPATH`, and the first
//! statement takes the current folder out of the search, which `PYTHONSAFEPATH` does on its own from Python 3.11 on. All
//! other folders of the user's `PYTHONPATH` stay: some install DOLFINx that way.

use std::env;
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

/// The statements that every interpreter runs first.
const BEGIN: &str = include_str!("begin.py");

/// A command that runs the Python statements `script` with `interpreter`, its current folder being `folder`, which holds
/// nothing that is not this program's. `before` is a launcher with its arguments, `packages` the folder to search first.
///
/// # Errors
/// A relative path cannot be made absolute because there is no current folder.
pub fn command(
    interpreter: &Path,
    script: &str,
    folder: &Path,
    before: &[OsString],
    packages: Option<&Path>,
) -> io::Result<Command> {
    let mut command = match before {
        [] => Command::new(interpreter),
        [launcher, arguments @ ..] => {
            let mut command = Command::new(launcher);
            command.args(arguments).arg(interpreter);
            command
        }
    };
    command.arg("-c").arg(format!("{BEGIN}\n{script}"));
    let inherited = kept(env::var_os("PYTHONPATH").as_deref())?;
    let folders = packages.map(Path::to_path_buf).into_iter().chain(inherited);
    let path = env::join_paths(folders).map_err(io::Error::other)?;
    if path.is_empty() {
        command.env_remove("PYTHONPATH");
    } else {
        command.env("PYTHONPATH", path);
    }
    command
        .current_dir(folder)
        // What compilers and MPI put down goes with the folder.
        .env("TMPDIR", folder)
        .env("PYTHONSAFEPATH", "1")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env_remove("PYTHONSTARTUP")
        .env_remove("PYTHONINSPECT");
    Ok(command)
}

/// The file of the program `name`: a bare name is looked up in the folders of `PATH` that are absolute, anything else is a
/// path.
pub fn find(name: &Path) -> Option<PathBuf> {
    if name.components().count() != 1 || name.is_absolute() {
        return Some(std::path::absolute(name).ok()?).filter(|path| path.is_file());
    }
    let folders = env::var_os("PATH")?;
    let mut found = env::split_paths(&folders).filter(|f| f.is_absolute()).map(|f| f.join(name));
    found.find(|path| path.is_file())
}

/// The entries of a search path, absolute; without those that mean the current folder.
fn kept(path: Option<&OsStr>) -> io::Result<Vec<PathBuf>> {
    let here = |folder: &PathBuf| folder.components().all(|part| part == Component::CurDir);
    env::split_paths(path.unwrap_or_default()).filter(|f| !here(f)).map(std::path::absolute).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_current_folder_is_no_part_of_the_search() {
        let kept = |text: &str| kept(Some(OsStr::new(text))).expect("a current folder");
        assert_eq!(kept(""), Vec::<PathBuf>::new());
        assert_eq!(kept(":.:./:/opt/x::"), [PathBuf::from("/opt/x")]);
        assert_eq!(kept("/a:/b"), ["/a", "/b"].map(PathBuf::from));
        let relative = kept("lib");
        assert!(relative[0].is_absolute() && relative[0].ends_with("lib"));
    }

    #[test]
    fn programs_are_found_by_name_and_by_path() {
        assert!(find(Path::new("sh")).is_some_and(|path| path.is_absolute()));
        assert_eq!(find(Path::new("/bin/sh")), Some(PathBuf::from("/bin/sh")));
        assert_eq!(find(Path::new("no-such-program-here")), None);
        assert_eq!(find(Path::new("/nonexistent/sh")), None);
    }
}
