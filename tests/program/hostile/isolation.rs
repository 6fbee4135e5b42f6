//! A folder full of Python files named like every module there is: none is run.

use std::process::Command;

use super::run::{FIELD, MESH, Place, SQUARE, case};
use crate::command::{said, script, with_reference};

/// Prints the name of every module that can be imported, and of some that Python looks for by itself.
const LIST: &str = "import pkgutil, sys\n\
    more = {'meshio', 'hypercircle_reference', 'hypercircle_process', 'sitecustomize', 'usercustomize'}\n\
    print('\\n'.join({m.name for m in pkgutil.iter_modules()} | set(sys.stdlib_module_names) | more))";

const PYTHON: &str = "/usr/bin/python3";

/// A folder with a scene, a mesh, a field, and a trap for every import.
fn trapped() -> Place {
    let place = Place::with(&case("patch"));
    place.write("square.toml", SQUARE);
    place.write("mesh.vtk", MESH);
    place.write("field.vtk", FIELD);
    let modules = Command::new(PYTHON).args(["-c", LIST]).output().expect("an interpreter").stdout;
    let sprung = place.temporary.path().with_extension("sprung");
    for module in String::from_utf8(modules).expect("names").lines() {
        let trap = format!("open({:?}, 'a').write({module:?} + '\\n')\n", sprung.display().to_string());
        place.write(&format!("{module}.py"), &trap);
    }
    place
}

/// The modules that were run out of the folder.
fn sprung(place: &Place) -> String {
    let path = place.temporary.path().with_extension("sprung");
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let _ = std::fs::remove_file(path);
    text
}

#[test]
fn no_module_in_the_current_folder_is_run() {
    let place = trapped();
    let mut plain = Command::new(PYTHON);
    plain.args(["-c", "import json"]).current_dir(place.folder.path()).env_remove("PYTHONSAFEPATH");
    plain.output().expect("an interpreter");
    assert!(!sprung(&place).is_empty(), "the traps do not work");
    // Before Python 3.11 the variable means nothing.
    let body = format!("unset PYTHONSAFEPATH\nexec {PYTHON} \"$@\"");
    let older = script(place.temporary.path().join("older"), &body);
    let older = older.to_str().expect("plain path");
    let mut starts = vec![
        vec!["solve", "square.toml", "--out", "out/a"],
        vec!["certify", "square.toml", "--displacement", "field.vtk", "--out", "out/b"],
    ];
    if with_reference() {
        starts.push(vec!["verify", "scene.toml", "--out", "out/c"]);
        starts.push(vec!["verify", "scene.toml", "--ranks", "2", "--out", "out/d"]);
    }
    for arguments in &starts {
        for (interpreter, path) in [(PYTHON, None), (PYTHON, Some(":.:")), (older, Some("."))] {
            let mut command = place.command(arguments);
            command.env("HYPERCIRCLE_PYTHON", interpreter).env_remove("PYTHONPATH");
            if let Some(path) = path {
                command.env("PYTHONPATH", path);
            }
            let output = command.output().expect("the program starts");
            let said = said(&output);
            assert_eq!(sprung(&place), "", "{arguments:?} with {interpreter}, PYTHONPATH {path:?}");
            // A field is judged, and this one may be wrong; that it was read is what counts.
            assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments:?}: {said}");
        }
    }
    assert!(super::run::names(place.temporary.path()).iter().all(|name| name == "older"), "something was left");
}

#[test]
fn the_python_path_of_the_user_stays() {
    let place = Place::with(SQUARE);
    place.write("mesh.vtk", MESH);
    let library = tempfile::tempdir().expect("a folder");
    std::fs::write(library.path().join("meshio.py"), "raise SystemExit('this is the user\\'s own')\n")
        .expect("writable");
    let mut command = place.command(&["solve", "scene.toml"]);
    let output = command.env("PYTHONPATH", library.path()).output().expect("the program starts");
    assert!(said(&output).contains("this is the user's own"), "{output:?}");
}
