use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::time::{Duration, Instant};

use super::*;
use crate::primal::fixture::pressed_square;
use crate::primal::{self, Options, PrimalSolution};

/// u = (2 (1 − x), 0) and nothing but what a solver has to say.
const ANSWER: &str = r#"{"format": "hypercircle-primal", "version": 1, "degree": 1,
    "vertex_displacement": [[2, 0], [0, 0], [0, 0], [2, 0]]}"#;

/// Runs a script in the solver's place.
fn with_script(body: &str, line: &str, change: impl FnOnce(&mut Options)) -> Result<Vec<PrimalSolution>, PrimalError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my solver");
    fs::write(&path, format!("#!/bin/sh\n{body}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    fs::write(folder.path().join("answer"), ANSWER).unwrap();
    let line = line.replace("SOLVER", &format!("/bin/sh '{}'", path.display()));
    let mut options = Options { program: Some(line.parse().unwrap()), ..Options::default() };
    change(&mut options);
    primal::run(&pressed_square(), &[], &options)
}

const COPY: &str = "cp \"$(dirname \"$0\")/answer\" \"$2/primal-P1.json\"";

#[test]
fn commands_are_read() {
    for (line, said) in [
        ("my-solver {problem}", "{out} is missing"),
        ("{problem} {out}", "{problem} is missing"),
        ("my-solver '{problem} {out}", "a ' is not closed"),
        ("", "names no program"),
    ] {
        assert!(line.parse::<SolverCommand>().unwrap_err().contains(said), "{line}");
    }
    let program: SolverCommand = "/opt/x/my-solver --in={problem} '{out}/{problem}' {degrees} {else}".parse().unwrap();
    assert_eq!(program.name(), "my-solver");
    let filled = |word: &str| program.filled(word, Path::new("/t/{out}"), &[1, 3]).into_string().unwrap();
    assert_eq!(filled("--in={problem}"), "--in=/t/{out}/problem.json");
    assert_eq!(filled("{out}/{problem}"), "/t/{out}//t/{out}/problem.json");
    assert_eq!((filled("{degrees}").as_str(), filled("{else}").as_str()), ("1,3", "{else}"));
}

#[test]
fn the_least_answer_is_enough() {
    let solutions = with_script(COPY, "SOLVER {problem} {out}", |_| {}).unwrap();
    let [solution] = &solutions[..] else { panic!("{solutions:?}") };
    assert_eq!((solution.solver.as_str(), solution.solver_version.as_str(), solution.degree), ("sh", "", 1));
    assert!(solution.energy.is_none() && solution.contacts.is_none() && solution.seconds.total > 0.0);
    // Where the command has {degrees}, each of them is owed.
    let told = with_script(COPY, "SOLVER {problem} {out} {degrees}", |_| {}).unwrap_err();
    assert!(matches!(&told, PrimalError::BadResult { file, .. } if file == "primal-P2.json"), "{told}");
}

#[test]
fn a_result_on_quadrilaterals_needs_a_mesh_of_them() {
    let copy = COPY.replace("P1", "Q1");
    let told = with_script(&copy, "SOLVER {problem} {out}", |_| {}).unwrap_err().to_string();
    assert!(told.contains("primal-Q1.json") && told.contains("its cells are triangles"), "{told}");
    let told = copy
        .replace("cp", "sed 's/\"degree\"/\"cells\": \"quadrilaterals\", \"gauss_points\": 3, \"degree\"/'")
        .replace(" \"$2", " > \"$2");
    let told = with_script(&told, "SOLVER {problem} {out}", |_| {}).unwrap_err().to_string();
    assert!(told.contains("a mesh file of convex quadrilaterals alone"), "{told}");
}

#[test]
fn what_goes_wrong_is_told() {
    let run = |body: &str| with_script(body, "SOLVER {problem} {out}", |_| {}).unwrap_err().to_string();
    let failed = run("echo 'singular matrix' >&2; exit 7");
    for part in ["solver sh", "exit code 7", "singular matrix"] {
        assert!(failed.contains(part), "{failed}");
    }
    assert!(run("echo nothing done").contains("primal-P1.json"), "no file to write is named");
    assert!(run("mkdir \"$2/primal-P2.json\"").contains("primal-P2.json"));
    for (from, to, said) in [
        ("\"degree\": 1", "\"degree\": 2", "it holds degree 2, not 1"),
        ("[2, 0], [0, 0],", "[2, 0],", "3 vertex displacements for 4 vertices"),
        ("\"version\": 1", "\"version\": 2", "expected hypercircle-primal version 1"),
        ("\"version\"", "\"solver\": \"a/b\", \"version\"", "solver"),
        ("[2, 0]", "[1e999, 0]", "out of range"),
        ("{", "", "primal-P1.json"),
    ] {
        let told = run(&format!("{COPY}\nsed -i 's|{}|{}|' \"$2/primal-P1.json\"", from.replace('[', "\\["), to));
        assert!(told.contains(said), "{said}: {told}");
    }
    let missing = "no-such-solver-here {problem} {out}".parse().unwrap();
    let told = primal::run(&pressed_square(), &[], &Options { program: Some(missing), ..Options::default() });
    assert!(matches!(told, Err(PrimalError::NotFound(name)) if name == "no-such-solver-here"));
}

#[test]
fn a_solver_that_hangs_is_ended_and_nothing_is_left_behind() {
    let note = tempfile::NamedTempFile::new().unwrap();
    let body = format!("echo \"$TMPDIR\" \"$2\" > '{}'; echo waiting; sleep 300", note.path().display());
    let started = Instant::now();
    let outcome = with_script(&body, "SOLVER {problem} {out}", |o| o.timeout = Duration::from_millis(300));
    assert!(matches!(&outcome, Err(PrimalError::TimedOut { log, .. }) if log == "waiting"), "{outcome:?}");
    assert!(started.elapsed() < Duration::from_secs(10));
    let folders = fs::read_to_string(note.path()).unwrap();
    assert_eq!(folders.split_whitespace().filter(|folder| Path::new(folder).exists()).count(), 0, "{folders}");
    assert_eq!(folders.split_whitespace().count(), 2);
}
