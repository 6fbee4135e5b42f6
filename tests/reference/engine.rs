//! The stress side on PETSc over MPI ranks, held against the condensed method, and what becomes of it when a rank dies, MPI is
//! missing, or what comes back is wrong.

use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::{Duration, Instant};

use hypercircle::dual::{Condensed, DualMethod, LinearSolver, Options, Petsc};
use hypercircle::stability::regime;
use hypercircle::study::certify_divided;
use serde_json::Value;

use crate::command::{case, ended, hypercircle, run, said, script, with_reference};

const LIMIT: Duration = Duration::from_secs(60);

/// The report of a run of `arguments` on the case `name`.
#[track_caller]
fn report(folder: &Path, name: &str, arguments: &[&str]) -> Value {
    let scene = case(name);
    let mut all = vec!["solve", scene.to_str().expect("plain path"), "--out", "out", "--quiet"];
    all.extend(arguments);
    let output = run(hypercircle(folder, &all));
    assert_eq!(output.status.code(), Some(0), "{name} {arguments:?}: {}", said(&output));
    let text = std::fs::read_to_string(folder.join("out/report.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

fn number(report: &Value, key: &str) -> f64 {
    report.pointer(key).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {key}"))
}

/// Asserts equal bounds, and equilibrium below 1e-9. Returns the number of contact states that were tried.
#[track_caller]
fn same(name: &str, options: &[&str], engine: &[&str]) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = report(folder.path(), name, options);
    let arguments: Vec<&str> = options.iter().chain(&["--engine", "petsc"]).chain(engine).copied().collect();
    let found = report(folder.path(), name, &arguments);
    let value = |option: &str| engine.iter().skip_while(|&&argument| argument != option).nth(1).copied();
    let solver = value("--linear-solver");
    assert_eq!(found["dual"]["method"], solver.map_or("petsc".to_string(), |solver| format!("petsc-{solver}")));
    for key in ["/energy/lower", "/energy/upper"] {
        let (found, expected) = (number(&found, key), number(&expected, key));
        assert!(((found - expected) / expected).abs() < 1e-9, "{name} {arguments:?} {key}: {found:e}, {expected:e}");
    }
    let left = number(&found, "/dual/equilibrium_residual");
    assert!(left < 1e-9, "{name} {arguments:?}: {left:e}");
    assert!(solver.is_none() || number(&found, "/dual/iterations") > 10.0);
    let notes = found["notes"].to_string();
    let ranks = value("--ranks")
        .filter(|&ranks| ranks != "1")
        .map_or("on 1 rank,".to_string(), |ranks| format!("on {ranks} ranks,"));
    assert!(notes.contains("PETSc") && notes.contains(&ranks), "{notes}");
    let states = notes.split_once("contact states tried: ").and_then(|(_, rest)| rest.split(';').next()?.parse().ok());
    states.unwrap_or_else(|| panic!("no states: {notes}"))
}

#[test]
fn ranks_find_the_stresses_of_the_condensed_method() {
    if !with_reference() {
        return;
    }
    same("two_blocks", &[], &[]);
    // Free to slide; a higher degree; degrees that differ.
    same("sliding", &[], &["--ranks", "2"]);
    same("two_blocks", &["--degree", "2"], &["--ranks", "2"]);
    same("two_blocks", &["--tolerance", "0.05"], &["--ranks", "2"]);
}

fn petsc(ranks: usize, linear_solver: LinearSolver) -> Petsc {
    let program = Some(env!("CARGO_BIN_EXE_hypercircle").into());
    Petsc { ranks, linear_solver, limit: LIMIT, interpreter: None, program }
}

/// Bounds and residual of the row `row` of the stability matrix at its value `step`.
fn of_row(row: &str, step: usize, method: &dyn DualMethod) -> [f64; 3] {
    let row = regime(row).expect("a row");
    let problem = row.problem(row.values[step]).expect("a problem");
    let found = certify_divided(problem, method, &Options::default());
    let found = found.unwrap_or_else(|e| panic!("{} at {}: {e}", row.id, row.label(step)));
    let upper = found.bracket.free.as_ref().expect("an upper bound").upper();
    [found.bracket.lower(), upper, found.dual.equilibrium.residual()]
}

/// A beam 512 times as long as high, flat triangles at a contact, a curve, and a body that all but tips: where rounding shows first.
#[test]
fn ranks_find_the_bounds_of_the_condensed_method_where_rows_are_hardest() {
    if !with_reference() {
        return;
    }
    let rows: [(&str, usize, &[usize]); 5] = [
        ("thin-beam", 4, &[2]),
        ("fan", 6, &[1]),
        ("slivers", 6, &[2]),
        ("curved-hollow", 4, &[2]),
        ("contact-alone", 7, &[2]),
    ];
    for (row, step, ranks) in rows {
        let [lower, upper, _] = of_row(row, step, &Condensed::default());
        for &ranks in ranks {
            let found = of_row(row, step, &petsc(ranks, LinearSolver::Mumps));
            for (found, expected) in found.into_iter().zip([lower, upper]) {
                assert!(((found - expected) / lower).abs() < 1e-9, "{row}, {ranks} ranks: {found:e}, {expected:e}");
            }
            assert!(found[2] < 1e-9, "{row}, {ranks} ranks: {:e}", found[2]);
        }
    }
}

/// The bounds on two ranks, which make the upper one too, and on one rank, where this program makes it: stresses and sums come in
/// another order.
#[track_caller]
fn same_on_ranks(name: &str, options: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder");
    let with = |ranks: &'static str| {
        let engine = ["--engine", "petsc", "--ranks", ranks];
        let arguments: Vec<&str> = options.iter().chain(&engine).copied().collect();
        report(folder.path(), name, &arguments)
    };
    let [one, two] = ["1", "2"].map(with);
    for key in ["/energy/lower", "/energy/upper"] {
        let [one, two] = [&one, &two].map(|report| number(report, key));
        assert!((one - two).abs() <= 1e-12 * one.abs(), "{name} {options:?} {key}: {one:e}, {two:e}");
    }
    let [one, two] = [one, two].map(|report| report["notes"].to_string().contains("upper bound was made on 2 ranks"));
    assert!(two && !one, "{name}: who made the upper bound");
}

#[test]
fn ranks_make_the_upper_bound_of_one_process() {
    if with_reference() {
        same_on_ranks("two_blocks", &[]);
        same_on_ranks("two_blocks", &["--degree", "3"]);
        same_on_ranks("ring", &[]);
        same_on_ranks("stack", &[]);
    }
}

#[test]
fn an_iteration_finds_the_same() {
    if with_reference() {
        same("two_blocks", &[], &["--ranks", "2", "--linear-solver", "gamg"]);
        // From closed contact there are nine states.
        let states = same("two_blocks", &["--refine", "2"], &["--ranks", "1", "--linear-solver", "gamg"]);
        assert!(states < 5, "{states} contact states from that of a coarser mesh");
    }
}

/// Bodies that contact alone holds, and more ranks than bodies.
#[test]
fn subdomains_find_the_same() {
    if !with_reference() {
        return;
    }
    for (name, ranks) in [("stack", "4"), ("cylinder_on_block", "2")] {
        same(name, &[], &["--ranks", ranks, "--linear-solver", "bddc"]);
    }
    // Lengths in which all entries of K are far from those of rows that stand alone, and a body 1e12 times as stiff as the other.
    for row in ["scale-length", "stiffness"] {
        let [lower, upper, _] = of_row(row, 6, &Condensed::default());
        let found = of_row(row, 6, &petsc(2, LinearSolver::Bddc));
        for (found, expected) in found.into_iter().zip([lower, upper]) {
            assert!(((found - expected) / lower).abs() < 1e-9, "{row}: {found:e}, {expected:e}");
        }
    }
}

/// Multigrid takes thousands of iterations there.
#[test]
fn subdomains_do_not_mind_an_incompressible_body() {
    if !with_reference() {
        return;
    }
    let row = regime("poisson").expect("a row");
    let step = row.values.iter().position(|&nu| nu > 0.4999).expect("a value near 1/2");
    let problem = || row.problem(row.values[step]).expect("a problem");
    let expected =
        certify_divided(problem(), &Condensed::default(), &Options::default()).expect("bounds").bracket.lower();
    let found = certify_divided(problem(), &petsc(2, LinearSolver::Bddc), &Options::default()).expect("bounds");
    let (lower, iterations) = (found.bracket.lower(), found.dual.iterations);
    assert!(((lower - expected) / expected).abs() < 1e-9, "{lower:e}, {expected:e}");
    assert!(iterations < 100, "{iterations} iterations");
}

#[test]
fn both_sides_run_on_the_ranks() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let scene = case("patch");
    let arguments = ["verify", scene.to_str().expect("plain path"), "--engine", "petsc", "--ranks", "2", "--quiet"];
    ended("verify", &run(hypercircle(folder.path(), arguments)), 0, &[]);
}

/// A run on two ranks whose interpreter is the script `body`, in which `$python` stands for the real one.
fn with_interpreter(body: &str, refine: &str) -> (Output, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let python = std::env::var_os("HYPERCIRCLE_PYTHON").map_or_else(|| "/usr/bin/python3".into(), PathBuf::from);
    let body = format!("here={}\npython={}\n{body}", folder.path().display(), python.display());
    let fake = script(folder.path().join("python"), &body);
    let scene = case("two_blocks");
    let scene = scene.to_str().expect("plain path");
    let arguments = ["solve", scene, "--engine", "petsc", "--ranks", "2", "--refine", refine, "--quiet"];
    let mut command = hypercircle(folder.path(), arguments);
    command.env("HYPERCIRCLE_PYTHON", fake);
    (run(command), folder)
}

fn alive(process: &str) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    stat.rsplit_once(')').is_some_and(|(_, rest)| !rest.trim_start().starts_with('Z'))
}

#[test]
fn a_killed_rank_ends_the_run_and_leaves_no_other() {
    if !with_reference() {
        return;
    }
    let body = "echo $$ >$here/rank-$OMPI_COMM_WORLD_RANK\n\
                if [ $OMPI_COMM_WORLD_RANK = 1 ]; then sleep 0.5; kill -KILL $$; fi\nexec $python \"$@\"";
    let (output, folder) = with_interpreter(body, "0");
    ended("a killed rank", &output, 3, &["the parallel solver failed"]);
    assert!(!folder.path().join("out").exists(), "a report of nothing");
    goes(folder.path(), "rank-0");
}

/// The process whose number is in a file of `folder` ends soon.
#[track_caller]
fn goes(folder: &Path, file: &str) {
    let process = std::fs::read_to_string(folder.join(file)).expect("a number");
    let patience = Instant::now();
    while alive(process.trim()) && patience.elapsed() < Duration::from_secs(5) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(!alive(process.trim()), "{file} lives");
}

#[test]
fn a_killed_part_ends_the_run_and_leaves_no_other() {
    if !with_reference() {
        return;
    }
    // The process of rank 1 is killed when it appears; the number of the other one is kept.
    let body = "rank=$OMPI_COMM_WORLD_RANK\ncase \"$*\" in *--bracket*) echo $$ >$here/rank-$rank\n\
                (until pgrep -P $$ -x hypercircle >$here/part-$rank; do sleep 0.01; done\n\
                if [ $rank = 1 ]; then kill -KILL $(cat $here/part-1); fi) & ;; esac\nexec $python \"$@\"";
    let (output, folder) = with_interpreter(body, "2");
    ended("a killed part", &output, 3, &["the parallel solver failed", "ended before it was done"]);
    assert!(!folder.path().join("out").exists(), "a report of nothing");
    ["rank-0", "rank-1", "part-0", "part-1"].iter().for_each(|process| goes(folder.path(), process));
}

#[test]
fn a_wrong_part_is_caught() {
    if !with_reference() {
        return;
    }
    // The last values that rank 1 finds are lost.
    let body = "case \"$*\" in *--bracket*) $python \"$@\" || exit\n\
                for folder in \"$@\"; do if [ -f \"$folder/found-1\" ]; then truncate -s -16 \"$folder/found-1\"; fi; done ;;\n\
                *) exec $python \"$@\" ;; esac";
    ended("a short file", &with_interpreter(body, "0").0, 3, &["cannot use", "check that the folder exists"]);
}

#[test]
fn a_wrong_answer_is_caught() {
    if !with_reference() {
        return;
    }
    // The first parameters of what the ranks found are lost.
    let body = "for last in \"$@\"; do :; done\n$python \"$@\" || exit\nif [ $OMPI_COMM_WORLD_RANK = 0 ]; then\n\
                dd if=/dev/zero of=$(dirname $last)/parameters.f64 bs=8 count=9 conv=notrunc 2>/dev/null\nfi";
    ended("nine zeros", &with_interpreter(body, "0").0, 3, &["petsc stopped", "with a residual of"]);
}

#[test]
fn what_is_missing_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = case("patch");
    let scene = scene.to_str().expect("plain path");
    let mut command = hypercircle(folder.path(), ["solve", scene, "--engine", "petsc", "--ranks", "2"]);
    command.env("PATH", folder.path());
    ended("no mpirun", &run(command), 4, &["mpirun does not exist", "openmpi-bin"]);
    let output = run(hypercircle(folder.path(), ["solve", scene, "--ranks", "2"]));
    ended("no engine", &output, 2, &["--ranks without --engine"]);
}
