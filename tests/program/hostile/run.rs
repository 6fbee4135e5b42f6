//! Starts the program in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use hypercircle::report::NAMES;
use serde_json::Value;
use tempfile::TempDir;

use crate::command::{self, ended, hypercircle};

/// A folder to work in, and one for temporary files.
pub struct Place {
    pub folder: TempDir,
    pub temporary: TempDir,
}

impl Place {
    pub fn new() -> Self {
        let folder = || tempfile::tempdir().expect("a folder");
        Place { folder: folder(), temporary: folder() }
    }

    /// With `scene.toml` in it.
    pub fn with(scene: &str) -> Self {
        let place = Place::new();
        place.write("scene.toml", scene);
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("writable");
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = hypercircle(self.folder.path(), arguments);
        command.env("TMPDIR", self.temporary.path());
        command
    }

    /// The program with all signals as they are by default: what started these tests may ignore some, as `nohup` does.
    pub fn heeding(&self, arguments: &[&str]) -> Command {
        let own = self.command(arguments);
        let mut command = Command::new("env");
        command.arg("--default-signal").arg(own.get_program()).args(own.get_args()).current_dir(self.folder.path());
        for (name, value) in own.get_envs() {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        command::run(self.command(arguments))
    }

    /// Asserts that `arguments` end with exit code 2, saying `fragments` and leaving nothing new; gives the message.
    #[track_caller]
    pub fn refuses(&self, arguments: &[&str], fragments: &[&str]) -> String {
        let before = names(self.folder.path());
        let message = ended(&arguments.join(" "), &self.run(arguments), 2, fragments);
        assert_eq!(names(self.folder.path()), before, "{arguments:?} left something");
        message
    }

    #[track_caller]
    pub fn report(&self, folder: &str) -> Value {
        let path = self.path(folder).join("report.json");
        serde_json::from_slice(&std::fs::read(&path).expect("a report")).expect("JSON")
    }
}

/// The names in a folder, hidden ones too.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> = entries.filter_map(|e| e.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    names
}

/// True if `holds` becomes true within some seconds.
pub fn soon(holds: impl Fn() -> bool) -> bool {
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(20) {
        if holds() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    false
}

/// True if a process exists and is no zombie.
pub fn alive(process: &str) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", process.trim())).unwrap_or_default();
    stat.rsplit_once(')').is_some_and(|(_, rest)| !rest.trim_start().starts_with('Z'))
}

/// The text of the scene `name` of `cases/`.
pub fn case(name: &str) -> String {
    std::fs::read_to_string(command::case(name)).expect("a case")
}

/// A square that is pressed, on the two triangles of `mesh.vtk`.
pub const SQUARE: &str = "model.kinematics = \"plane-strain\"\nmesh.file = \"mesh.vtk\"\n\
    bodies.1 = { young = 1.0, poisson = 0.3 }\nsupports = [{ on = \"11\", type = \"clamped\" }]\n\
    tractions = [{ on = \"12\", pressure = 1.0 }]\n";

/// VTK's format, which meshio reads.
pub const MESH: &str = "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n\
    0 0 0\n1 0 0\n1 1 0\n0 1 0\nCELLS 4 14\n2 0 1\n2 2 3\n3 0 1 2\n3 0 2 3\nCELL_TYPES 4\n3\n3\n5\n5\n\
    CELL_DATA 4\nSCALARS CellEntityIds int 1\nLOOKUP_TABLE default\n11\n12\n1\n1\n";

/// A displacement on the same triangles.
pub const FIELD: &str = "# vtk DataFile Version 3.0\nfield\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n\
    0 0 0\n1 0 0\n1 1 0\n0 1 0\nCELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5\n5\nPOINT_DATA 4\n\
    VECTORS displacement double\n0 0 0\n0 0 0\n0 -0.7 0\n0 -0.7 0\n";

/// The files of a run on a scene with contacts and without quantities.
pub fn expected() -> Vec<String> {
    let mut names: Vec<String> = NAMES.into_iter().chain(["checks.csv", "contacts.csv"]).map(String::from).collect();
    names.sort();
    names
}
