//! Adaptive refinement to a guaranteed tolerance, on the two blocks of which the energy is known to nine digits.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, DualError, DualMethod, Found, Motion, Options, Size, contact_coefficients};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Adapted, Goal, adapt, certify, closed_coefficients};

/// Between the bounds of a run to 0.008 %.
const EXACT: f64 = -1.796413405;

fn problem(toml: &Toml) -> Problem {
    let text = toml.text();
    let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Two unit blocks, the left one on a roller and pressed on by `load` against the clamped right one.
fn blocks(nu: f64, load: &str) -> Toml {
    Toml::default()
        .polygon("left", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["rollers", "face", "", "load"])
        .polygon("right", &[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]], ["", "wall", "", "right_face"])
        .material("left", 1.0, nu)
        .material("right", 1.0, nu)
        .clamp("wall")
        .roller("rollers")
        .table(&format!("[[tractions]]\non = \"load\"\n{load}"))
        .contact("face", "right_face")
}

const LIFT_OFF: &str = "value = [4.0, 0.0]\ngradient = [[0.0, -7.0], [0.0, 0.0]]";

fn run(problem: Problem, tolerance: f64) -> Adapted {
    let adapted =
        adapt(problem, &Condensed::default(), &Options::default(), &Goal::new(tolerance), |_| ()).expect("solves");
    for row in &adapted.history {
        println!("{:6} {:7} {:.3e} {:?}", row.triangles, row.unknowns, row.relative_error_bound, row.rate);
    }
    assert!(adapted.stopped.is_none());
    assert!(adapted.history.last().expect("one mesh").relative_error_bound <= tolerance);
    adapted
}

fn triangles(adapted: &Adapted) -> usize {
    adapted.certified.problem.mesh.triangles.len()
}

/// The guaranteed error and the unknowns of `docs/data/hp.json`.
#[derive(serde::Deserialize)]
struct Curve {
    poisson: f64,
    refinement: String,
    unknowns_and_guaranteed_relative_error: Vec<[f64; 2]>,
}

#[test]
fn mesh_and_degrees_take_the_unknowns_that_the_figure_shows() {
    let curves: Vec<Curve> = serde_json::from_str(include_str!("../../docs/data/hp.json")).expect("committed curves");
    for (poisson, most, last) in [(0.3, [6_000, 16_000], 40_000.0), (0.4999, [12_000, 32_000], 80_000.0)] {
        let hp = curves.iter().find(|c| c.refinement == "hp" && c.poisson == poisson).expect("a curve");
        let points = &hp.unknowns_and_guaranteed_relative_error;
        let [unknowns, error] = points.last().expect("meshes");
        assert!(*unknowns <= last && *error <= 1e-5, "{error} with {unknowns} at ν = {poisson}");
        for (tolerance, most) in [1e-3, 1e-4].into_iter().zip(most) {
            let options = Options { elements: Elements::Uniform(block(3)), ..Options::default() };
            let goal = Goal { adapt: Adapt::Hp, ..Goal::new(tolerance) };
            let again = adapt(problem(&blocks(poisson, LIFT_OFF)), &Condensed::default(), &options, &goal, |_| ());
            let again = again.expect("solves");
            let unknowns = again.certified.dual.unknowns;
            assert!(again.stopped.is_none() && unknowns <= most, "{unknowns} for {tolerance} at ν = {poisson}");
            // The first meshes do not know yet what tolerance they lead to.
            for (row, [unknowns, error]) in again.history.iter().zip(points).take(5) {
                assert_eq!(row.unknowns as f64, *unknowns, "ν = {poisson}");
                assert!((row.relative_error_bound / error - 1.0).abs() < 1e-6, "{row:?} and {error}");
            }
        }
    }
}

#[test]
fn one_per_cent_to_one_per_mille_with_few_triangles() {
    let limits = [(1e-2, 1_000), (3e-3, 3_000), (1e-3, 10_000)];
    let mut needed = Vec::new();
    for (tolerance, most) in limits {
        let adapted = run(problem(&blocks(0.3, LIFT_OFF)), tolerance);
        assert!(triangles(&adapted) < most, "{} for {tolerance}", triangles(&adapted));
        assert_eq!(adapted.history[0].triangles, 4, "the coarsest mesh");
        for row in &adapted.history {
            assert!(row.lower <= EXACT + 2e-9 && row.upper >= EXACT - 2e-9, "{row:?}");
        }
        needed.push(triangles(&adapted));
        if tolerance == 1e-3 {
            // Asymptotically the bound falls like 1/unknowns; least squares over the meshes beyond the first hundred.
            let points: Vec<[f64; 2]> = (adapted.history.iter().filter(|r| r.triangles > 100))
                .map(|r| [(r.unknowns as f64).ln(), r.relative_error_bound.ln()])
                .collect();
            let mean = [0, 1].map(|c| points.iter().map(|p| p[c]).sum::<f64>() / points.len() as f64);
            let xy: f64 = points.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum();
            let xx: f64 = points.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
            assert!(-xy / xx > 0.95, "rate {}", -xy / xx);
        }
    }
    let nearly_incompressible = run(problem(&blocks(0.4999, LIFT_OFF)), 1e-3);
    assert!(triangles(&nearly_incompressible) <= 3 * needed[2], "{}", triangles(&nearly_incompressible));
}

#[test]
fn uniform_refinement_is_slower() {
    let adaptive = run(problem(&blocks(0.3, LIFT_OFF)), 3e-3);
    let uniform = problem(&blocks(0.3, LIFT_OFF)).refine_uniform(5).expect("refines");
    assert!(uniform.mesh.triangles.len() > triangles(&adaptive));
    let uniform = certify(uniform, &Condensed::default(), &Options::default()).expect("solves");
    let bound = uniform.bracket.relative_error(uniform.bracket.free.as_ref().expect("an upper bound").upper());
    assert!(bound > 3e-3, "{bound}");
}

/// Meshes grow by a factor of more than two: all of them together have little more than twice the triangles of the last.
#[test]
fn all_meshes_together_cost_little_more_than_the_last() {
    for (nu, tolerance) in [(0.3, 1e-2), (0.3, 3e-3), (0.3, 1e-3), (0.4999, 3e-3)] {
        let history = run(problem(&blocks(nu, LIFT_OFF)), tolerance).history;
        let all: usize = history.iter().map(|row| row.unknowns).sum();
        let last = history.last().expect("one mesh").unknowns;
        assert!(all < 3 * last, "{all} unknowns in all, {last} on the last mesh");
    }
}

#[test]
fn wholly_closed_contact_and_no_contact_take_one_step() {
    // Scene B of the paper's example stays closed.
    let closed = problem(&blocks(0.3, "value = [1.5, 0.0]\ngradient = [[0.0, -1.8], [0.0, 0.0]]"));
    let adapted = run(closed.clone(), 1e-2);
    assert_eq!(adapted.certified.dual.iterations, 1);
    assert!(adapted.certified.dual.closed.values().iter().all(|c| *c));
    assert_eq!(certify(closed, &Condensed::default(), &Options::default()).expect("solves").dual.iterations, 1);
    let alone = Toml::default()
        .polygon("plate", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["", "load", "", "wall"])
        .clamp("wall")
        .traction("load", [1.0, 0.5]);
    let adapted = run(problem(&alone), 1e-2);
    assert!(adapted.certified.dual.closed.values().is_empty() && adapted.certified.dual.iterations <= 1);
}

#[test]
fn a_limit_is_said_with_the_bound_reached() {
    let scene = problem(&blocks(0.3, LIFT_OFF));
    let goal = Goal { max_triangles: Some(300), ..Goal::new(1e-3) };
    let adapted = adapt(scene.clone(), &Condensed::default(), &Options::default(), &goal, |_| ()).expect("solves");
    assert!(triangles(&adapted) <= 300 && triangles(&adapted) > 100);
    let row = adapted.history.last().expect("one mesh");
    let said = adapted.stopped.expect("stopped");
    assert!(said.contains("more than 300 triangles"), "{said}");
    // Rounded, and never down.
    let told = said.split("error is ").nth(1).and_then(|rest| rest.split(" %").next()?.parse::<f64>().ok());
    let bound = 100.0 * row.relative_error_bound;
    assert!(told.is_some_and(|told| (bound..=1.01 * bound).contains(&told)), "{said}");
    let goal = Goal { max_seconds: Some(1e-9), ..Goal::new(1e-3) };
    let adapted = adapt(scene, &Condensed::default(), &Options::default(), &goal, |_| ()).expect("solves");
    assert_eq!(adapted.history.len(), 1);
    assert!(adapted.stopped.expect("stopped").contains("seconds"));
}

/// The corner of a block that slides down a slanted wall runs into a clamped corner, where the displacement all but jumps:
/// refinement goes down to edges whose direction is known to few digits, and what they hold must stay one direction.
#[test]
fn a_slanted_roller_stays_one_as_far_as_numbers_resolve_its_edges() {
    let scene = Toml::default()
        .polygon("base", &[[0.0, 0.0], [1.1, 0.0], [0.7, 1.1], [-0.07, 0.97]], ["foot", "", "head", "west"])
        .polygon("top", &[[-0.07, 0.97], [0.7, 1.1], [0.2, 2.3]], ["sole", "load", "wall"])
        .material("base", 0.1, 0.2)
        .clamp("foot")
        .clamp("west")
        .roller("wall")
        .traction("load", [0.1, -0.9])
        .table("[[contacts]]\nbetween = [\"head\", \"sole\"]\ngap = 0.005");
    let goal = Goal { max_triangles: Some(40_000), ..Goal::new(0.05) };
    let adapted = adapt(problem(&scene), &Condensed::default(), &Options::default(), &goal, |_| ()).expect("solves");
    let smallest = |p: &Problem| (0..p.mesh.edges.len()).map(|e| p.mesh.edge_frame(e).0).fold(1.0, f64::min);
    let smallest = smallest(&adapted.certified.problem);
    assert!(smallest < 1e-8, "{smallest:e} after {:?}", adapted.history.last());
    for pair in adapted.history.windows(2).filter(|pair| pair[0].triangles > 200) {
        assert!(pair[1].upper < pair[0].upper && pair[1].lower > pair[0].lower, "{pair:?}");
    }
}

/// Whatever the first guess of the contact state: same state, same bits.
#[test]
fn the_first_guess_of_the_contact_state_does_not_change_the_answer() {
    let coarse = run(problem(&blocks(0.3, LIFT_OFF)), 5e-2).certified;
    let fine = run(problem(&blocks(0.3, LIFT_OFF)), 1e-2).certified.problem;
    let cold = certify(fine.clone(), &Condensed::default(), &Options::default()).expect("solves");
    let from_coarse = closed_coefficients(
        &coarse.problem,
        &coarse.dual.closed,
        &fine,
        &contact_coefficients(&fine, &Options::default().elements),
    );
    assert_eq!(from_coarse.len(), cold.dual.closed.len());
    let (guessed, found) = (from_coarse.values(), cold.dual.closed.values());
    let wrong = guessed.iter().zip(found).filter(|(a, b)| a != b).count();
    assert!(4 * wrong < guessed.len(), "{wrong} of {} guessed wrong", guessed.len());
    let mut opposite = from_coarse.clone();
    opposite.values_mut().iter_mut().for_each(|c| *c = !*c);
    let mut open = from_coarse.clone();
    open.values_mut().fill(false);
    for guess in [from_coarse, opposite, open] {
        let warm = Options { closed: Some(guess), ..Options::default() };
        let warm = certify(fine.clone(), &Condensed::default(), &warm).expect("solves");
        assert_eq!(warm.dual.closed, cold.dual.closed);
        assert_eq!(warm.bracket.complementary, cold.bracket.complementary);
    }
}

/// Gaps with break points, rigid obstacles and two contacts at once are refined alike.
#[test]
fn a_beam_over_a_gap_is_refined_to_one_per_cent() {
    let beam = Toml::default()
        .polygon(
            "beam",
            &[[0.0, 1.0], [1.0, 1.0], [3.0, 1.0], [4.0, 1.0], [4.0, 1.5], [0.0, 1.5]],
            ["foot", "under", "roll", "", "load", ""],
        )
        .polygon("post", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["floor", "", "seat", ""])
        .clamp("floor")
        .pressure("load", 0.01)
        .contact("foot", "seat")
        .table("[[contacts]]\non = \"under\"\ngap = [[0.0, 0.0], [0.7, 0.02], [2.0, 0.0]]")
        .rigid("roll");
    let adapted = run(problem(&beam), 1e-2);
    assert!(adapted.certified.problem.notes.iter().all(|n| !n.weakens_guarantee));
    let Adapted { certified, .. } = adapted;
    let free = certified.bracket.free.as_ref().expect("an upper bound");
    let gap = free.potential.total() - certified.bracket.complementary.lower();
    assert!((gap - free.local.total).abs() < 1e-9 * certified.bracket.complementary.strain);
}

/// A method that does not arrive on some meshes.
struct Fails {
    on: fn(&Problem) -> bool,
    solved: AtomicUsize,
    failed: AtomicUsize,
}

impl Fails {
    fn on(on: fn(&Problem) -> bool) -> Self {
        Fails { on, solved: AtomicUsize::new(0), failed: AtomicUsize::new(0) }
    }
}

impl DualMethod for Fails {
    fn name(&self) -> &'static str {
        "test"
    }

    fn memory(&self, size: Size) -> f64 {
        Condensed::default().memory(size)
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        if !(self.on)(problem) {
            self.solved.fetch_add(1, Ordering::Relaxed);
            return Condensed::default().solve(problem, motions, options);
        }
        self.failed.fetch_add(1, Ordering::Relaxed);
        let advice = "no more".to_string();
        Err(DualError::NotConverged { method: "test", iterations: 1, residual: 1.0, wanted: 0.0, advice })
    }
}

/// A mesh that cannot be solved may have too small triangles, and is tried again with larger ones; one that has none would be the
/// same again.
#[test]
fn a_mesh_that_cannot_be_solved_is_tried_again_where_that_can_help() {
    let run = |method: &Fails| {
        let goal = Goal { max_triangles: Some(1500), ..Goal::new(1e-4) };
        adapt(problem(&blocks(0.3, LIFT_OFF)), method, &Options::default(), &goal, |_| ()).expect("an answer")
    };
    let large = Fails::on(|problem| problem.mesh.triangles.len() > 200);
    let said = run(&large).stopped.expect("stopped");
    assert!(said.contains("the next mesh could not be solved"), "{said}");
    assert_eq!(large.failed.into_inner(), 1);
    assert!(large.solved.into_inner() > 2);

    let small = Fails::on(|problem| {
        let mesh = &problem.mesh;
        (0..mesh.triangles.len()).any(|t| mesh.area(t).sqrt() < 1e-6)
    });
    // The floor turns by a little, and holds the corner like a point.
    let kink = Toml::default()
        .polygon("a", &[[0.0, 0.0], [1.0, 0.02], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "foot", "", "top", ""])
        .roller("foot")
        .traction("top", [0.1, -1.0]);
    let goal = Goal { max_triangles: Some(2000), ..Goal::new(0.01) };
    let adapted = adapt(problem(&kink), &small, &Options::default(), &goal, |_| ()).expect("an answer");
    let last = adapted.certified.problem.mesh;
    let smallest = (0..last.triangles.len()).map(|t| last.area(t).sqrt()).fold(1.0, f64::min);
    assert!((1e-6..1e-4).contains(&smallest), "{smallest:e}");
    assert!((1..=2).contains(&small.failed.into_inner()));
    assert!(adapted.stopped.expect("out of reach").contains("as small as numbers can resolve"));
}

/// Rollers that turn by a degree in a corner hold it as a point is held: what is missing there lies on scales that no
/// triangle has.
#[test]
fn what_numbers_cannot_resolve_ends_a_run_with_its_place() {
    let kink = Toml::default()
        .polygon("a", &[[0.0, 0.0], [1.0, 0.02], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "foot", "", "top", ""])
        .material("a", 1.0, 0.3)
        .roller("foot")
        .table("[[tractions]]\non = \"top\"\nvalue = [0.1, -1.0]");
    let goal = Goal { adapt: Adapt::H, max_triangles: Some(20_000), ..Goal::new(0.01) };
    let adapted = adapt(problem(&kink), &Condensed::default(), &Options::default(), &goal, |_| ()).expect("an answer");
    let stopped = adapted.stopped.expect("out of reach");
    assert!(stopped.contains("at (1, 0.02), where the triangles are as small as numbers can resolve"), "{stopped}");
    // One mesh shows that it is of no use: no other is solved for nothing, and none after it.
    let rates: Vec<f64> = adapted.history.iter().filter_map(|row| row.rate).collect();
    let idle = rates.iter().skip_while(|rate| **rate < 0.03).filter(|rate| **rate < 0.01).count();
    assert!(idle == 1 && rates.last().is_some_and(|rate| *rate < 0.01), "{rates:?}");
}

/// Condensed, and which deadline it was given on each mesh.
struct Watched(Mutex<Vec<Option<Instant>>>);

impl DualMethod for Watched {
    fn name(&self) -> &'static str {
        "watched"
    }

    fn memory(&self, size: Size) -> f64 {
        Condensed::default().memory(size)
    }

    fn solve(&self, problem: &Problem, motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        self.0.lock().expect("one thread").push(options.deadline);
        Condensed::default().solve(problem, motions, options)
    }
}

#[test]
fn a_limit_in_seconds_holds_for_the_first_mesh_too_with_more_patience() {
    let began = Instant::now();
    for limit in [None, Some(1000.0)] {
        let method = Watched(Mutex::default());
        let goal = Goal { max_seconds: limit, ..Goal::new(0.05) };
        adapt(problem(&blocks(0.3, LIFT_OFF)), &method, &Options::default(), &goal, |_| ()).expect("an answer");
        let given = method.0.into_inner().expect("one thread");
        assert!(given.len() > 1, "{} meshes", given.len());
        for (mesh, deadline) in given.iter().enumerate() {
            let after = deadline.map(|end| end.duration_since(began).as_secs_f64());
            let factor = if mesh == 0 { 3.0 } else { 1.0 };
            match (limit, after) {
                (None, None) => (),
                (Some(most), Some(after)) => assert!((after - factor * most).abs() < 500.0, "mesh {mesh}: {after} s"),
                mixed => panic!("mesh {mesh}: {mixed:?}"),
            }
        }
    }
}
