//! Runs that would need more memory than there is, or than they may take: refused before, with figures, or ended with
//! the best result so far, and never by a signal.

use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::command::{self, PROGRAM, hypercircle, said as message};

use hypercircle::budget::Budget;
use hypercircle::dual::{ActiveSet, Condensed, DualError, DualMethod, Options, Size};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

fn case(name: &str) -> String {
    command::case(name).display().to_string()
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    command::run(hypercircle(folder, arguments))
}

/// Runs with an address space of so many kB.
fn run_within(kilobytes: u64, folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new("/bin/sh");
    command.args(["-c", &format!("ulimit -v {kilobytes} && exec \"$@\""), "sh", PROGRAM]).args(arguments);
    command.current_dir(folder).output().expect("the shell starts")
}

/// A block with the given edge length.
fn block(folder: &Path, size: f64) -> PathBuf {
    let path = folder.join("block.toml");
    let text = format!(
        "model.kinematics = \"plane-strain\"\ngeometry.size = {size:e}\nbodies.b = {{ young = 1.0, poisson = 0.3 }}\n\
         supports = [{{ on = \"base\", type = \"clamped\" }}]\ntractions = [{{ on = \"top\", pressure = 1.0 }}]\n\
         [[geometry.polygons]]\nbody = \"b\"\npoints = [[0, 0], [1, 0], [1, 1], [0, 1]]\nedges = [\"base\", \"\", \"top\", \"\"]\n"
    );
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn sizes_and_refinements_that_cannot_be_meant_are_refused_with_their_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    for (size, pieces) in [
        (1e-9, vec!["geometry.size = 1e-9 makes about 2.5e18 triangles", "may be used"]),
        (1e-150, vec!["geometry.size", "triangles", "may be used"]),
        (0.002, vec!["geometry.size = 0.002 makes about 627000 triangles", "where 500 MB may be used", "--max-memory"]),
    ] {
        let scene = block(folder.path(), size);
        let output = run(folder.path(), &["solve", &scene.display().to_string(), "--max-memory", "500M"]);
        let text = message(&output);
        assert_eq!(output.status.code(), Some(2), "{size:e}: {text}");
        assert!(pieces.iter().all(|piece| text.contains(piece)), "{size:e}: {text}");
    }
    let two_blocks = case("two_blocks");
    let output = run(folder.path(), &["solve", &two_blocks, "--refine", "12"]);
    let text = message(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("--refine 12 makes about 5.1e9 triangles"), "{text}");
    assert!(!folder.path().join("out").exists(), "nothing was written");
}

#[test]
fn a_mesh_file_that_does_not_fit_is_a_solver_that_failed() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = run(folder.path(), &["solve", &case("from_gmsh"), "--max-memory", "20.5M"]);
    let text = message(&output);
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(text.contains("652 triangles does not fit") && text.contains("may be used"), "{text}");
    assert!(text.contains("help: ") && text.contains("--max-memory"), "{text}");
}

#[test]
fn the_symbolic_factorisation_refuses_the_numeric_one() {
    let scene = Scene::read(Path::new(&case("two_blocks"))).expect("a scene");
    let problem = Problem::load(scene).expect("a mesh");
    for method in [&Condensed::default() as &dyn DualMethod, &ActiveSet::default()] {
        let options = Options { budget: Budget::of(1000), ..Options::default() };
        match method.solve(&problem, &[], &options) {
            Err(DualError::TooLarge { reason }) => {
                let pieces = ["1904 unknowns, 16 of them at contact, does not fit", "1 kB may be used"];
                assert!(pieces.iter().all(|piece| reason.contains(piece)), "{}: {reason}", method.name());
            }
            other => panic!("{}: {:?}", method.name(), other.map(|found| found.unknowns)),
        }
    }
}

#[test]
fn a_refinement_that_does_not_fit_ends_with_the_best_result() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments =
        ["solve", &case("two_blocks"), "--tolerance", "1e-5", "--adapt", "h", "--max-memory", "40M", "--out", "o"];
    let output = run(folder.path(), &arguments);
    let text = message(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("at the present pace 0.001 % takes about"), "said while it runs: {text}");
    let report = std::fs::read_to_string(folder.path().join("o/report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert!(
        report["energy"]["relative_error_bound"].as_f64().is_some_and(|bound| bound < 0.02),
        "{}",
        report["energy"]
    );
    let notes = report["notes"].to_string();
    // Refused from its counts, or from its symbolic factorisation.
    assert!(notes.contains("would not fit into memory (about ") || notes.contains("does not fit: "), "{notes}");
    for piece in ["40 MB may be used", "at the present pace"] {
        assert!(notes.contains(piece), "{piece}: {notes}");
    }
}

#[test]
fn the_estimate_is_what_a_run_takes_and_little_more() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = case("two_blocks");
    let output = run(folder.path(), &["measure", "scene", &path, "--method", "condensed", "--refine", "3"]);
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let Some(peak) = results[0]["peak_memory"].as_f64() else { panic!("no peak in {results}") };
    let problem = Problem::load(Scene::read(Path::new(&path)).expect("a scene")).expect("a mesh");
    let estimate = Condensed::default().memory(Size::of(&problem).refined(3));
    assert!((1.0..1.5).contains(&(estimate / peak)), "estimated {estimate:.3e}, taken {peak:.3e}");
}

#[test]
fn no_run_ends_by_a_signal_whatever_the_address_space() {
    let folder = tempfile::tempdir().expect("a folder");
    let field = folder.path().join("u.vtu");
    let (two_blocks, gmsh) = (case("two_blocks"), case("from_gmsh"));
    std::fs::write(&field, "no field").expect("written");
    let commands: [&[&str]; 9] = [
        &["solve", &two_blocks, "--refine", "3"],
        &["solve", &two_blocks, "--refine", "2", "--max-memory", "100G", "--threads", "2"],
        &["solve", &two_blocks, "--tolerance", "2e-3", "--max-memory", "100G"],
        &["solve", &two_blocks, "--refine", "1", "--method", "clarabel", "--max-memory", "100G"],
        &["solve", &gmsh, "--max-memory", "100G"],
        &["certify", &two_blocks, "--displacement", "u.vtu"],
        &["schema", "report"],
        &["chart", &two_blocks, "--refine", "1", "--repeats", "1", "--quiet", "--out", "chart"],
        &["stability", "--reduced", "--quiet", "--method", "condensed", "--regime", "numbering", "--out", "matrix"],
    ];
    for kilobytes in [200_000, 100_000, 50_000, 30_000, 20_000, 14_000] {
        // Below some size the system cannot even load the program.
        if !run_within(kilobytes, folder.path(), &["--version"]).status.success() {
            assert!(kilobytes <= 30_000, "{kilobytes} kB are enough to begin with");
            continue;
        }
        for arguments in commands {
            let output = run_within(kilobytes, folder.path(), arguments);
            let text = message(&output);
            let place = format!("{kilobytes} kB, {arguments:?}: {text}");
            assert!(output.status.signal().is_none(), "{place}");
            assert!(matches!(output.status.code(), Some(0..=3)), "{place}");
            assert!(!text.contains("internal error"), "{place}");
            assert!(
                output.status.success() || !text.is_empty() || !output.stdout.is_empty(),
                "nothing was said: {place}"
            );
        }
    }
}

/// A mesh of a square in MSH 4.1 whose entities are each in `groups` physical groups.
fn many_groups(n: usize, groups: usize) -> String {
    let mut text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n".to_string();
    text += &format!("{}\n", 2 * groups + 1);
    for g in 1..=groups {
        text += &format!("1 {g} \"c{g}\"\n2 {g} \"s{g}\"\n");
    }
    let wall = groups + 1;
    let list = |last: usize| (1..=last).map(|g| g.to_string()).collect::<Vec<_>>().join(" ");
    text += &format!("1 {wall} \"wall\"\n$EndPhysicalNames\n$Entities\n0 1 1 0\n");
    text +=
        &format!("1 0 0 0 1 0 0 {wall} {} 0\n1 0 0 0 1 1 0 {groups} {} 1 1\n$EndEntities\n", list(wall), list(groups));
    let side = n + 1;
    text += &format!("$Nodes\n1 {0} 1 {0}\n2 1 0 {0}\n", side * side);
    text += &(1..=side * side).map(|tag| format!("{tag}\n")).collect::<String>();
    for i in 0..side * side {
        text += &format!("{} {} 0\n", (i % side) as f64 / n as f64, (i / side) as f64 / n as f64);
    }
    text += &format!("$EndNodes\n$Elements\n2 {0} 1 {0}\n1 1 1 {n}\n", n + 2 * n * n);
    for i in 1..=n {
        text += &format!("{i} {i} {}\n", i + 1);
    }
    text += &format!("2 1 2 {}\n", 2 * n * n);
    for i in 0..n * n {
        let a = (i / n) * side + i % n + 1;
        let (b, c, d) = (a + 1, a + side, a + side + 1);
        text += &format!("{} {a} {b} {d}\n{} {a} {d} {c}\n", n + 2 * i + 1, n + 2 * i + 2);
    }
    text + "$EndElements\n"
}

#[test]
fn entities_in_thousands_of_groups_share_their_names() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("many.msh"), many_groups(32, 15_000)).expect("written");
    let scene = "model.kinematics = \"plane-strain\"\nmesh.file = \"many.msh\"\nbodies.s7 = { young = 1, poisson = 0.3, \
                 body_force = [0, -1] }\nsupports = [{ on = \"wall\", type = \"clamped\" }]\n";
    std::fs::write(folder.path().join("many.toml"), scene).expect("written");
    let output = run(folder.path(), &["measure", "scene", "many.toml", "--method", "condensed"]);
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    // 2048 triangles times 15,000 names, written out one by one, take more than two gigabytes.
    assert!(results[0]["peak_memory"].as_f64().is_some_and(|bytes| bytes < 3e8), "{results}");
    let output = run(folder.path(), &["solve", "many.toml", "--out", "o"]);
    assert_eq!(output.status.code(), Some(0), "{}", message(&output));
    let report = std::fs::read_to_string(folder.path().join("o/report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["dual"]["triangles"], 2048);
    let notes = report["notes"].to_string();
    assert!(notes.contains("physical surface s1, s2, s3, s4, s5, s6, s8"), "{}", &notes[..200]);
}
