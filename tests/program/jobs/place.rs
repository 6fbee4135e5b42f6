//! A folder with scenes, and the job that they are.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use crate::command::{self, case, hypercircle, script};

/// A folder to work in.
pub struct Place(TempDir);

impl Place {
    /// With a copy of `cases/patch.toml` for each name in `scenes/`.
    pub fn with(names: &[&str]) -> Self {
        let place = Place(tempfile::tempdir().expect("a folder"));
        for name in names {
            place.write(&format!("scenes/{name}.toml"), &patch());
        }
        place
    }

    pub fn folder(&self) -> &Path {
        self.0.path()
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("a parent")).expect("writable");
        std::fs::write(path, text).expect("writable");
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = hypercircle(self.folder(), arguments);
        command.env("HYPERCIRCLE_PYTHON", "/nonexistent/python3");
        for variable in ["GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "GITHUB_WORKSPACE"] {
            command.env_remove(variable);
        }
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        command::run(self.command(arguments))
    }

    /// Scenes whose meshes only an interpreter can read, and one that hangs over `hangs.mesh` until there is a file `go`,
    /// and ends the program over `crashes.mesh`.
    pub fn stand_in(&self) -> PathBuf {
        for name in ["hangs", "crashes"] {
            self.write(&format!("scenes/{name}.mesh"), "MeshVersionFormatted 2\n");
            self.write(&format!("scenes/{name}.toml"), &on_mesh(name));
        }
        let go = self.path("go");
        let body = format!(
            "case \"$*\" in *crashes.mesh*) kill -KILL $PPID; exit 1 ;; esac\nwhile [ ! -e '{}' ]; do sleep 0.05; done; exit 1",
            go.display()
        );
        script(self.path("python3"), &body)
    }
}

pub fn patch() -> String {
    std::fs::read_to_string(case("patch")).expect("a case")
}

fn on_mesh(name: &str) -> String {
    format!(
        "model.kinematics = \"plane-strain\"\nmesh.file = \"{name}.mesh\"\nbodies.1 = {{ young = 1.0, poisson = 0.3 }}\n\
         supports = [{{ on = \"11\", type = \"clamped\" }}]\ntractions = [{{ on = \"12\", pressure = 1.0 }}]\n"
    )
}

/// A block that nothing holds.
pub const LOOSE: &str = r#"
[model]
kinematics = "plane-strain"
[geometry]
size = 0.5
[[geometry.polygons]]
body = "b"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["", "", "top", ""]
[bodies.b]
young = 1.0
poisson = 0.3
[[tractions]]
on = "top"
value = [1.0, 0.0]
"#;

/// A job without what differs from run to run.
pub fn lasting(job: &Value) -> Value {
    let mut job = job.clone();
    job["seconds"] = Value::Null;
    for scene in job["scenes"].as_array_mut().expect("scenes") {
        scene["seconds"] = Value::Null;
        scene["run"] = Value::Null;
        // A sentence may name the seconds.
        if scene["status"] == "timed-out" {
            scene["verdict"] = Value::Null;
        }
    }
    job
}

/// The scene `name` of a job.
pub fn scene<'a>(job: &'a Value, name: &str) -> &'a Value {
    let scenes = job["scenes"].as_array().expect("scenes");
    scenes.iter().find(|scene| scene["name"] == name).unwrap_or_else(|| panic!("no scene {name}"))
}
