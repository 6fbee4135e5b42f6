//! Three dual solvers, one answer: every case of `cases/` solved by each of them.

use std::path::Path;

use hypercircle::bounds::complementary;
use hypercircle::dual::{self, Clarabel, Condensed, DualError, DualMethod, DualSolution, Motion, Options, Uzawa};
use hypercircle::problem::{ContactPair, Problem};
use hypercircle::scene::{Body, Scene};
use hypercircle::statics;

/// Cases above this size cost Clarabel more than all others together.
const MOST: usize = 2200;

/// Cases above this size may end at Uzawa's iteration limit, and then say so.
const UZAWA_SIZE: usize = 1000;

fn cases() -> Vec<(String, Problem)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder of cases")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    assert!(files.len() >= 10, "{files:?}");
    let load = |path: &std::path::PathBuf| {
        let problem = Problem::load(Scene::read(path).expect("a valid scene")).expect("a valid problem");
        (problem.scene.name.clone(), problem)
    };
    files.iter().map(load).collect()
}

fn run(method: &dyn DualMethod, problem: &Problem) -> Result<(DualSolution, f64), DualError> {
    let statics = statics::check(problem).expect("statics");
    let motions: Vec<Motion> = statics.held.iter().map(|m| m.at_vertices(problem, &statics.components)).collect();
    let solution = dual::solve(method, problem, &motions, &Options::default())?;
    let lower = complementary(problem, &solution.stress).lower();
    Ok((solution, lower))
}

/// True if two contact states agree where the state matters: at ends that carry pressure or stand open. An end
/// with neither may be called open or closed.
fn same_contact(problem: &Problem, a: &DualSolution, b: &DualSolution) -> bool {
    let tractions =
        |s: &DualSolution| -> Vec<f64> { s.contact_traction.iter().flat_map(|t| t.values()).copied().collect() };
    let (ta, tb) = (tractions(a), tractions(b));
    let largest = ta.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    assert_eq!(a.closed.len(), problem.interfaces.iter().map(|i| i.pairs.len()).sum::<usize>());
    let (closed, other) = (a.closed.values(), b.closed.values());
    (0..ta.len()).all(|k| closed[k] == other[k] || ta[k].abs().max(tb[k].abs()) < 1e-7 * largest)
}

#[test]
fn interior_point_and_condensed_agree_on_every_case() {
    for (name, problem) in cases().into_iter().filter(|(_, problem)| problem.mesh.triangles.len() <= MOST) {
        let (condensed, energy) = run(&Condensed::default(), &problem).expect("condensed");
        let (clarabel, other) = match run(&Clarabel::default(), &problem) {
            // Only what the other methods have of their own may be refused.
            Err(DualError::NotExpressible { .. }) if beyond_the_paper(&problem) => continue,
            found => found.unwrap_or_else(|e| panic!("{name}: {e}")),
        };
        let scale = complementary(&problem, &condensed.stress).strain.max(energy.abs());
        assert!((energy - other).abs() <= 1e-8 * scale, "{name}: {energy} and {other}");
        assert!(same_contact(&problem, &condensed, &clarabel), "{name}: contact states differ");
    }
}

/// True if a scene has springs, elastic contact, friction, a force that is not constant, an initial strain, or is one of revolution.
fn beyond_the_paper(problem: &Problem) -> bool {
    let more = |body: &Body| !body.body_force.is_constant() || !body.initial.is_none();
    !problem.beds.is_empty()
        || problem.has_elastic_contact()
        || problem.has_friction()
        || problem.section().is_revolved()
        || problem.scene.bodies.iter().any(more)
}

/// True if the direction of contact is not the normal of each edge, a case that the paper does not treat.
fn turning(problem: &Problem) -> bool {
    let along = |pair: &ContactPair| {
        pair.direction.ends.iter().all(|n| (n[0] - pair.normal[0]).hypot(n[1] - pair.normal[1]) < 1e-9)
    };
    !problem.pairs().all(along)
}

#[test]
fn uzawa_arrives_on_every_small_case() {
    for (name, problem) in cases() {
        let small = problem.mesh.triangles.len() <= UZAWA_SIZE;
        if !small {
            // Enough to see that a stop is said to be one.
            let stopped = run(&Uzawa { most_iterations: 50, ..Uzawa::default() }, &problem);
            let wanted = match turning(&problem) || beyond_the_paper(&problem) {
                true => matches!(stopped, Err(DualError::NotExpressible { .. })),
                false => matches!(stopped, Err(DualError::NotConverged { .. })),
            };
            assert!(wanted, "{name}: {:?}", stopped.err());
            continue;
        }
        if turning(&problem) {
            let refused = run(&Uzawa::default(), &problem);
            assert!(matches!(refused, Err(DualError::NotExpressible { .. })), "{name}: {:?}", refused.err());
            continue;
        }
        let (condensed, energy) = run(&Condensed::default(), &problem).expect("condensed");
        let (_, other) = match run(&Uzawa::default(), &problem) {
            Err(DualError::NotExpressible { .. }) if beyond_the_paper(&problem) => continue,
            found => found.unwrap_or_else(|e| panic!("{name}: {e}")),
        };
        let scale = complementary(&problem, &condensed.stress).strain.max(energy.abs());
        assert!((energy - other).abs() <= 1e-5 * scale, "{name}: {energy} and {other}");
    }
}
