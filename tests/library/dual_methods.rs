//! Four methods, one λ_h: energies, contact states and the free upper bound on problems of every kind.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::setup::{Role, Setup, lift_off, pressed, two_blocks};
use crate::support::Blocks;
use hypercircle::bounds::energy::{complementary, potential};
use hypercircle::bounds::upper::admissible;
use hypercircle::dual::{
    ActiveSet, Clarabel, Condensed, DualError, DualMethod, DualSolution, Found, Motion, Options, Size, Uzawa, solve,
};
use hypercircle::problem::Problem;
use hypercircle::scene::Kinematics;
use hypercircle::study::certify;

fn run(method: &dyn DualMethod, problem: &Problem, motions: &[Motion]) -> DualSolution {
    solve(method, problem, motions, &Options::default()).unwrap_or_else(|e| panic!("{}: {e}", method.name()))
}

fn lower(problem: &Problem, solution: &DualSolution) -> f64 {
    complementary(problem, &solution.stress).lower()
}

fn tractions(solution: &DualSolution) -> impl Iterator<Item = f64> {
    solution.contact_traction.iter().flat_map(|t| t.values().iter().copied())
}

fn open(solution: &DualSolution) -> usize {
    solution.closed.values().iter().filter(|c| !**c).count()
}

/// Uzawa's iteration, as far as comparisons need it.
const UZAWA: Uzawa = Uzawa { step_length: None, most_iterations: 200_000, tolerance: 1e-9, accelerate: true };

/// All methods reach `energy`, where it is known, and each other: energies, equilibrium, contact tractions, contact
/// state.
fn agree(what: &str, problem: &Problem, motions: &[Motion], energy: Option<f64>) -> DualSolution {
    let condensed = run(&Condensed::default(), problem, motions);
    let reference = lower(problem, &condensed);
    if let Some(energy) = energy {
        assert!((reference - energy).abs() <= 1e-9 * energy.abs(), "{what}: condensed {reference} for {energy}");
    }
    for (method, allowed) in
        [(&ActiveSet::default() as &dyn DualMethod, 1e-9), (&Clarabel::default(), 1e-9), (&UZAWA, 1e-7)]
    {
        let other = run(method, problem, motions);
        let value = lower(problem, &other);
        let name = method.name();
        assert!((value - reference).abs() <= allowed * reference.abs(), "{what}: {name} {value} for {reference}");
        assert!(other.equilibrium.residual() <= allowed, "{what}: {name} leaves {:e}", other.equilibrium.residual());
        let largest = tractions(&condensed).fold(0.0_f64, |m, t| m.max(t.abs()));
        for (a, b) in tractions(&condensed).zip(tractions(&other)) {
            assert!((a - b).abs() <= 1e-4 * largest, "{what}: {name} T_n {b} for {a}");
            assert!(b <= 1e-6 * largest, "{what}: {name} pulls with {b}");
        }
    }
    condensed
}

fn same_state(what: &str, problem: &Problem, motions: &[Motion], condensed: &DualSolution) {
    for method in [&ActiveSet::default() as &dyn DualMethod, &Clarabel::default(), &UZAWA] {
        assert_eq!(run(method, problem, motions).closed, condensed.closed, "{what}: {}", method.name());
    }
}

#[test]
fn reach_the_reference_energies() {
    for (n, energy, open_ends) in [(2, -1.8477439265, 1), (4, -1.8051124296, 3), (8, -1.7972865675, 6)] {
        let problem = lift_off(n);
        let found = agree("lift-off", &problem, &[], Some(energy));
        assert_eq!(open(&found), open_ends);
        same_state("lift-off", &problem, &[], &found);
    }
    for (n, energy) in [(2, -0.4299880678), (4, -0.4275808346), (8, -0.4269994402)] {
        let found = agree("pressed", &pressed(n), &[], Some(energy));
        assert_eq!(open(&found), 0);
    }
}

#[test]
fn every_method_carries_the_free_upper_bound() {
    let problem = lift_off(4);
    let upper = |method: &dyn DualMethod| {
        let dual = run(method, &problem, &[]);
        let lower = complementary(&problem, &dual.stress).lower();
        let v = admissible(&problem, &dual, lower, None).expect("an admissible displacement");
        potential(&problem, &v).total()
    };
    let condensed = upper(&Condensed::default());
    // Above every lower bound, and above the energy of the exact solution as finer meshes know it.
    assert!(condensed > -1.79642);
    for method in [&Clarabel::default() as &dyn DualMethod, &UZAWA, &Uzawa::plain()] {
        assert!((upper(method) - condensed).abs() < 1e-6, "{}", method.name());
    }
}

#[test]
fn constant_gap_costs_the_resultant_times_the_gap() {
    // The resultant on Γ_K is given by equilibrium: T_n g integrates to −0.5 · 0.3.
    let problem = two_blocks(4, |[_, y]| [4.0 - 7.0 * y, 0.0]).gap(|_| 0.3).build();
    agree("constant gap", &problem, &[], Some(-1.8051124296 - 0.5 * 0.3));
}

#[test]
fn gap_that_opens() {
    let problem = two_blocks(4, |[_, y]| [4.0 - 7.0 * y, 0.0]).gap(|s| 0.2 * s + 0.3 * s * s).build();
    let found = agree("varying gap", &problem, &[], None);
    assert!(open(&found) > 3, "a gap that grows upwards opens more than none");
}

#[test]
fn prescribed_displacement_is_a_patch_test() {
    // Two blocks between rollers, pressed together by 0.02: uniaxial strain of −0.01.
    let (nu, strain) = (0.3, -0.01);
    let problem = Setup::default()
        .rectangle("left", [0.0, 0.0], [1.0, 1.0], 3)
        .rectangle("right", [1.0, 0.0], [2.0, 1.0], 3)
        .on("left.left", Role::Clamped([0.02, 0.0]))
        .on("right.right", Role::Clamped([0.0, 0.0]))
        .on("left.bottom", Role::Roller)
        .on("left.top", Role::Roller)
        .on("right.bottom", Role::Roller)
        .on("right.top", Role::Roller)
        .contact("left.right", Some("right.left"), |_| 0.0)
        .build();
    let modulus = (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    // −Π = 𝓛(u) = strain energy.
    let found = agree("pressed by displacement", &problem, &[], Some(0.5 * modulus * strain * strain * 2.0));
    for t in tractions(&found) {
        assert!((t - modulus * strain).abs() < 1e-9);
    }
}

#[test]
fn rigid_obstacle_is_a_patch_test() {
    let mut setup = Setup::default()
        .material("block", [0.0, 0.0], [2.0, 1.0], [4, 3], 5.0, 0.2, [0.0; 2])
        .on("block.top", Role::Load(|_| [0.0, -3.0]))
        .on("block.left", Role::Roller)
        .contact("block.bottom", None, |_| 0.0);
    setup.kinematics = Kinematics::PlaneStress;
    agree("rigid obstacle", &setup.build(), &[], Some(-0.5 * 9.0 / 5.0 * 2.0));
}

/// A block on a wider, clamped one, free to slide: Example 3.
fn block_on_block(load: fn([f64; 2]) -> [f64; 2]) -> (Problem, Motion) {
    let problem = Setup::default()
        .material("upper", [0.0, 1.0], [1.0, 2.0], [4, 4], 1.0, 0.3, [0.0, -0.5])
        .material("lower", [0.0, 0.0], [1.0, 1.0], [4, 4], 3.0, 0.25, [0.0, -0.1])
        .on("upper.top", Role::Load(load))
        .on("lower.bottom", Role::Clamped([0.0; 2]))
        .contact("upper.bottom", Some("lower.top"), |_| 0.0)
        .build();
    let mut slides = vec![[0.0; 2]; problem.mesh.points.len()];
    for (t, v) in problem.mesh.triangles.iter().enumerate() {
        if problem.mesh.body[t] == 0 {
            v.iter().for_each(|&v| slides[v] = [1.0, 0.0]);
        }
    }
    (problem, slides)
}

#[test]
fn body_held_by_contact_alone() {
    let (problem, slides) = block_on_block(|_| [0.0, -1.0]);
    agree("centred", &problem, std::slice::from_ref(&slides), None);
    let (problem, slides) = block_on_block(|[x, _]| [0.0, -2.4 + 3.2 * x]);
    let found = agree("eccentric", &problem, &[slides], None);
    // Weight 0.5 and load 0.8, off the centre by more than a sixth of the width.
    let total: f64 = found.contact_traction[0]
        .iter()
        .zip(&problem.interfaces[0].pairs)
        .map(|(t, pair)| 0.5 * pair.length * (t[0] + t[1]))
        .sum();
    assert!((total + 1.3).abs() < 1e-10);
    assert!(open(&found) > 0);
}

#[test]
fn rotated_scene_has_the_same_energy() {
    const COS: f64 = 0.8;
    const SIN: f64 = 0.6;
    let load = |[x, y]: [f64; 2]| {
        let p = 4.0 - 7.0 * (COS * y - SIN * x);
        [COS * p, SIN * p]
    };
    let problem = two_blocks(4, load).map(|[x, y]| [COS * x - SIN * y, SIN * x + COS * y]).build();
    agree("rotated", &problem, &[], Some(-1.8051124296));
}

#[test]
fn units_do_not_matter() {
    // Steel in metres, a millimetre in size: energies scale with length² · load² / E.
    let load = |[_, y]: [f64; 2]| [1e6 * (4.0 - 7e3 * y), 0.0];
    let block = |s: Setup, name, x: f64| s.material(name, [x, 0.0], [x + 1e-3, 1e-3], [4, 4], 2.1e11, 0.3, [0.0; 2]);
    let problem = block(block(Setup::default(), "left", 0.0), "right", 1e-3)
        .on("left.left", Role::Load(load))
        .on("left.bottom", Role::Roller)
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
        .build();
    agree("steel", &problem, &[], Some(-1.8051124296 * 1e-6 * 1e12 / 2.1e11));
}

#[test]
fn three_bodies_and_redundant_rows() {
    // A ring (closed loop of triangles) between a clamped and a loaded block, held sideways by nothing.
    let problem = Setup::default()
        .material("lower", [0.0, 0.0], [1.0, 0.5], [4, 2], 1.0, 0.3, [0.0; 2])
        .material("ring", [0.0, 0.5], [1.0, 1.5], [4, 4], 20.0, 0.45, [0.0, -0.2])
        .material("upper", [0.0, 1.5], [1.0, 2.0], [4, 2], 1.0, 0.0, [0.0; 2])
        .without(|[x, y]| (0.25..0.75).contains(&x) && (0.75..1.25).contains(&y))
        .on("lower.bottom", Role::Clamped([0.0; 2]))
        .on("upper.top", Role::Load(|[x, _]| [0.0, -1.0 - 0.5 * x]))
        .contact("lower.top", Some("ring.bottom"), |_| 0.0)
        .contact("upper.bottom", Some("ring.top"), |_| 0.0)
        .build();
    let motions: Vec<Motion> = [1, 2]
        .map(|body| {
            let mut motion = vec![[0.0; 2]; problem.mesh.points.len()];
            for (_, v) in problem.mesh.triangles.iter().enumerate().filter(|(t, _)| problem.mesh.body[*t] == body) {
                v.iter().for_each(|&v| motion[v] = [1.0, 0.0]);
            }
            motion
        })
        .into();
    let found = agree("ring", &problem, &motions, None);
    assert_eq!(found.closed.values().len(), 16);
    let notes = run(&Uzawa::default(), &problem, &motions).notes;
    assert_eq!(notes.iter().filter(|n| n.contains("superfluous")).count(), 2, "{notes:?}");
}

#[test]
fn pulled_apart_is_infeasible_with_its_motion() {
    let problem = two_blocks(3, |_| [-1.0, 0.0]).build();
    let error = solve(&Clarabel::default(), &problem, &[], &Options::default()).expect_err("no equilibrium");
    let DualError::Infeasible { certificate, work } = error else { panic!("{error}") };
    assert!((work - 1.0).abs() < 1e-6, "work of a unit load on a unit motion: {work}");
    for (e, moments) in certificate.iter().enumerate() {
        let (a, b) = (moments[0], moments[1]);
        let edge = &problem.mesh.edges[e];
        let left = problem.mesh.body[edge.triangles[0].unwrap()] == 0;
        let length = problem.mesh.edge_frame(e).0;
        let mean = [(a[0] + b[0]) / length, (a[1] + b[1]) / length];
        let expected = if left { -1.0 } else { 0.0 };
        assert!((mean[0] - expected).abs() < 1e-6 && mean[1].abs() < 1e-6, "edge {e} moves by {mean:?}");
    }
    let error = solve(&Uzawa { most_iterations: 2000, ..Uzawa::default() }, &problem, &[], &Options::default());
    assert!(matches!(error, Err(DualError::NotConverged { .. } | DualError::Infeasible { .. })));
}

#[test]
fn unbalanced_load_is_infeasible_before_the_first_step() {
    let problem = Setup::default()
        .rectangle("block", [0.0, 0.0], [1.0, 1.0], 2)
        .on("block.bottom", Role::Roller)
        .on("block.left", Role::Load(|_| [2.0, 0.0]))
        .build();
    for method in [&Uzawa::default() as &dyn DualMethod, &Clarabel::default()] {
        match solve(method, &problem, &[], &Options::default()) {
            Err(DualError::Infeasible { work, .. }) => assert!((work - 2.0).abs() < 1e-6, "{}: {work}", method.name()),
            Err(error) => panic!("{}: {error}", method.name()),
            Ok(_) => panic!("{}: solved a problem without solution", method.name()),
        }
    }
}

#[test]
fn too_long_a_step_and_too_few_steps_are_no_solution() {
    let problem = lift_off(2);
    let limit = {
        let program = hypercircle::dual::paper::Program::new(&problem).expect("a program");
        2.0 / hypercircle::dual::paper::Iteration::new(&program).norm()
    };
    let with = |step: f64, most_iterations: usize| {
        let method = Uzawa { step_length: Some(step), most_iterations, ..Uzawa::plain() };
        solve(&method, &problem, &[], &Options::default())
    };
    assert!(with(0.98 * limit, 20_000).is_ok());
    match with(1.05 * limit, 20_000) {
        Err(DualError::NotConverged { residual, iterations, advice, .. }) => {
            assert!(residual > 1.0 && iterations < 20_000, "stops at {iterations} with {residual}");
            assert!(advice.contains("step length"), "{advice}");
        }
        other => panic!("{:?}", other.map(|s| s.iterations)),
    }
    match with(0.98 * limit, 200) {
        Err(DualError::NotConverged { residual, iterations: 200, wanted, .. }) => assert!(residual > wanted),
        other => panic!("{:?}", other.map(|s| s.iterations)),
    }
}

#[test]
fn progress_is_told() {
    let told = Arc::new(Mutex::new(Vec::new()));
    let ear = Arc::clone(&told);
    let options =
        Options { progress: Some(Arc::new(move |k, r| ear.lock().unwrap().push((k, r)))), ..Options::default() };
    let found = solve(&Uzawa::default(), &lift_off(2), &[], &options).expect("a solution");
    let told = told.lock().unwrap();
    assert_eq!(told.last().map(|t| t.0), Some(found.iterations));
    assert!(told.windows(2).all(|w| w[0].0 < w[1].0));
}

#[test]
fn no_load_no_stress() {
    let problem = two_blocks(2, |_| [0.0, 0.0]).build();
    for method in [&Clarabel::default() as &dyn DualMethod, &Uzawa::default()] {
        let found = run(method, &problem, &[]);
        assert!(lower(&problem, &found).abs() < 1e-18, "{}", method.name());
    }
}

/// The condensed method, and the threads that there were when it was asked.
#[derive(Default)]
struct Watched {
    method: Condensed,
    threads: AtomicUsize,
}

impl DualMethod for Watched {
    fn name(&self) -> &'static str {
        "watched"
    }

    fn memory(&self, size: Size) -> f64 {
        self.method.memory(size)
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        self.threads.store(rayon::current_num_threads(), Ordering::Relaxed);
        self.method.solve(problem, motions, options)
    }
}

#[test]
fn a_solve_has_the_threads_of_its_options_whatever_pool_it_is_called_from() {
    for threads in [1, 3] {
        let watched = Watched::default();
        let problem = Blocks { n: 2, ..Blocks::default() }.problem();
        certify(problem, &watched, &Options { threads, ..Options::default() }).expect("solves");
        assert_eq!(watched.threads.load(Ordering::Relaxed), threads);
    }
}
