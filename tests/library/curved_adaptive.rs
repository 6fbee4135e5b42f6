//! How far adaptive refinement gets where contact turns: triangles for a guaranteed one per cent, and bounds that are bounds.

use std::collections::HashMap;

use crate::arcs::{Arcs, between_arcs, disc};
use crate::support::random::Random;
use hypercircle::dual::{Condensed, Options};
use hypercircle::mesh::refinement::bisect::RefinementEdges;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Adapted, Goal, adapt, certify, certify_divided};

/// Most triangles for one per cent.
const MOST: usize = 3000;

/// The problem on the coarsest mesh that represents the scene.
fn coarsest(text: &str) -> Problem {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("size")).collect();
    let text = lines.join("\n");
    let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn refined(problem: Problem, tolerance: f64) -> Adapted {
    adapt(problem, &Condensed::default(), &Options::default(), &Goal::new(tolerance), |_| ()).expect("refines")
}

#[track_caller]
fn one_per_cent(text: &str, name: &str) {
    let run = refined(coarsest(text), 0.01);
    let last = run.history.last().expect("a mesh");
    println!("{name}: {:.3} % with {} triangles", 100.0 * last.relative_error_bound, last.triangles);
    assert!(run.stopped.is_none() && last.relative_error_bound <= 0.01, "{name}: {last:?}");
    assert!(last.triangles <= MOST, "{name}: {} triangles", last.triangles);
}

#[test]
fn blocks_that_meet_along_facets_of_an_arc_take_few_triangles_for_one_per_cent() {
    for rise in [0.03, 0.12, 0.3] {
        for n in [12, 16, 24] {
            for rise in [rise, -rise] {
                one_per_cent(&Arcs { n, rise, ..Arcs::default() }.text(), &format!("{n} facets, rise {rise}"));
            }
        }
    }
}

/// Relaxing must not end while a body that slides as a whole moves on a little with every sweep: the upper bound then stays where
/// it is on any number of triangles.
#[test]
fn the_error_does_not_stall_where_a_body_slides_around_facets() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/sliding_around_facets.toml");
    let problem = Problem::load(Scene::read(&file).expect("a scene")).expect("a problem");
    let goal = Goal { adapt: Adapt::H, max_triangles: Some(20_000), ..Goal::new(0.003) };
    let run = adapt(problem, &Condensed::default(), &Options::default(), &goal, |_| ()).expect("refines");
    assert!(run.stopped.is_none(), "{:?}", run.history.last());
}

#[test]
fn blocks_that_meet_along_an_arc_take_few_triangles_for_one_per_cent() {
    for rise in [0.03, -0.03, 0.12, -0.12, 0.3, -0.3] {
        one_per_cent(&between_arcs(rise), &format!("rise {rise}"));
    }
}

/// Facets of an ellipse stay what they are under refinement, and so does the direction of contact: every mesh is one of the
/// same problem, and any upper bound lies above any lower one.
#[test]
fn bounds_of_every_mesh_hold_for_the_finest() {
    for rise in [0.12, -0.3] {
        let run = refined(coarsest(&Arcs { n: 12, rise, squeezed: true, ..Arcs::default() }.text()), 0.01);
        let coarse = Arcs { n: 12, rise, squeezed: true, ..Arcs::default() }.text();
        let finest = run.certified.problem.refine_uniform(1).expect("refines");
        let fine = certify(finest, &Condensed::default(), &Options::default()).expect("solves").bracket;
        let fine = [fine.lower(), fine.free.as_ref().expect("an upper bound").upper()];
        let uniform = coarsest(&coarse).refine_uniform(3).expect("refines");
        let uniform = certify(uniform, &Condensed::default(), &Options::default()).expect("solves").bracket;
        let uniform = [uniform.lower(), uniform.free.as_ref().expect("an upper bound").upper()];
        let of_run = run.history.iter().map(|row| [row.lower, row.upper]);
        let all: Vec<[f64; 2]> = of_run.chain([fine, uniform]).collect();
        let lower = all.iter().map(|b| b[0]).fold(f64::NEG_INFINITY, f64::max);
        let upper = all.iter().map(|b| b[1]).fold(f64::INFINITY, f64::min);
        println!("rise {rise}: {lower} to {upper}");
        assert!(lower < upper, "{all:?}");
        // The finest mesh contains the last of the run.
        assert_eq!([lower, upper], fine);
    }
}

/// The normals of a foot with a slight kink turn along whole edges: those of the mesh that the size of the scene gives are kept.
/// Where edges stand for arcs, however flat, refinement leads to the arcs from anywhere.
#[test]
fn refinement_begins_on_a_mesh_that_has_the_directions_of_the_scene() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes");
    let kinked = Scene::read(&folder.join("standing_on_a_kink.toml")).expect("a scene");
    let load = |scene: Scene| Problem::load(scene);
    let begun = |scene: &Scene| Problem::to_refine(scene, load).expect("a problem");
    let told = |problem: &Problem, word: &str| problem.notes.iter().any(|note| note.text.contains(word));
    let (given, begin) = (load(kinked.clone()).expect("a problem"), begun(&kinked));
    assert!(told(&begin, "was kept") && begin.mesh == given.mesh);
    let [low, high] = [given, refined(begin, 0.05).certified.problem].map(|problem| {
        let found = certify_divided(problem, &Condensed::default(), &Options::default());
        let bracket = found.expect("solves").bracket;
        [bracket.lower(), bracket.free.expect("an upper bound").upper()]
    });
    assert!(low[0] <= high[1] && high[0] <= low[1], "{low:?} {high:?}");

    for rise in [0.02, -0.03, 0.12] {
        let text = between_arcs(rise).replace("[geometry]\n", "[geometry]\nsize = 0.1\n");
        let begin = begun(&Scene::parse(&text, "arcs.toml".as_ref()).expect("a scene"));
        assert!(told(&begin, "was not used"), "{rise}");
        let run = refined(begin, 0.01);
        let problem = &run.certified.problem;
        let radius = (0.25 + rise * rise) / (2.0 * rise);
        for pair in problem.pairs() {
            let [x, y] = problem.mesh.points[pair.first[1]];
            let off = (x - 0.5).hypot(y - (0.5 + rise - radius)) - radius.abs();
            assert!(off.abs() < 1e-9, "{rise}: ({x}, {y}) is {off:e} from the arc");
        }
        assert!(problem.pairs().count() > 6, "{rise}: {}", problem.pairs().count());
    }
}

/// A contact around a whole disc with a gap along its arc length keeps its edges. Whichever of them are divided, the disc is
/// the same one: it begins where it began and is passed the same way round, so gap and direction stay at every vertex.
#[test]
fn a_contact_all_around_keeps_gap_and_direction_whichever_edges_are_divided() {
    let gap = "normals = \"smooth\"\ngap = [[0.0, 0.0], [1.0, 0.1], [6.0, 0.3]]";
    let text = disc(24, "force", "smooth").replace("normals = \"smooth\"", gap);
    let given = Problem::load(Scene::parse(&text, "disc.toml".as_ref()).expect("a scene")).expect("a problem");
    let at_vertices = |problem: &Problem| -> HashMap<usize, ([f64; 2], f64)> {
        problem.pairs().map(|pair| (pair.first[0], (pair.direction.ends[0], pair.gap[0]))).collect()
    };
    let coarse = at_vertices(&given);
    let mut random = Random::new(7);
    for _ in 0..12 {
        let (mut problem, mut edges) = (given.clone(), RefinementEdges::longest(&given.mesh));
        for _ in 0..4 {
            let marked: Vec<usize> = (0..problem.mesh.triangles.len()).filter(|_| random.chance(0.1)).collect();
            (problem, edges, _) = problem.bisect(&edges, &marked).expect("refines");
        }
        let fine = at_vertices(&problem);
        assert!(fine.len() > coarse.len());
        for (v, (direction, gap)) in &coarse {
            let (now, gap_now) = fine[v];
            let [x, y] = problem.mesh.points[*v];
            assert!((gap - gap_now).abs() < 1e-12, "gap at ({x}, {y}): {gap_now} was {gap}");
            assert!(
                (now[0] - direction[0]).hypot(now[1] - direction[1]) < 1e-12,
                "at ({x}, {y}): {now:?} was {direction:?}"
            );
        }
        for pair in problem.pairs() {
            let ([nx, ny], (next, _)) = (pair.direction.ends[1], fine[&pair.first[1]]);
            let [x, y] = problem.mesh.points[pair.first[1]];
            assert!((nx - next[0]).hypot(ny - next[1]) < 1e-12, "at ({x}, {y}): ({nx}, {ny}) and {next:?}");
        }
    }
}
