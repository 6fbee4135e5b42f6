//! Contact along curves that are meshed as facets: one direction field for both sides.

use crate::arcs::{Arcs, disc, ring_on_ring};
use hypercircle::bounds::{Bracket, complementary, local_gap, potential};
use hypercircle::dual::{self, ActiveSet, Clarabel, Condensed, DualError, DualMethod, DualSolution, Options, Uzawa};
use hypercircle::problem::{Problem, Refinement};
use hypercircle::scene::Scene;
use hypercircle::statics::{self, MotionKind, Solvability};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The motions that nothing holds, as displacements of the vertices.
fn motions(problem: &Problem) -> Vec<Vec<[f64; 2]>> {
    statics::check(problem).expect("decided").null_motions(problem)
}

fn solve(problem: &Problem, method: &dyn DualMethod) -> DualSolution {
    dual::solve(method, problem, &motions(problem), &Options::default()).expect("solves")
}

/// The guaranteed relative error, after the self-checks of the bracket.
fn relative_error(problem: &Problem) -> f64 {
    let dual = solve(problem, &Condensed::default());
    assert!(dual.equilibrium.residual() < 1e-11, "{:?}", dual.equilibrium);
    let bracket = Bracket::new(problem, &dual);
    let free = bracket.free.as_ref().expect("an upper bound");
    let lower = complementary(problem, &dual.stress);
    let gap = potential(problem, &free.displacement).total() - lower.lower();
    let local = local_gap(problem, &dual.stress, &free.displacement);
    assert!((gap - local.total).abs() < 1e-10 * lower.strain, "{gap} is not {}", local.total);
    assert!(local.triangles.iter().chain(local.pairs.iter().flatten()).all(|g| *g > -1e-12 * lower.strain));
    bracket.relative_error(free.upper())
}

#[test]
fn smooth_normals_close_the_bracket_and_facets_do_not() {
    let errors = |normals: &'static str| {
        [8, 16, 32].map(move |n| relative_error(&problem(&Arcs { n, normals, ..Arcs::default() }.text())))
    };
    let (smooth, facets) = (errors("smooth"), errors("facets"));
    println!("smooth {smooth:?}, facets {facets:?}");
    assert!(smooth[1] < 0.65 * smooth[0] && smooth[2] < 0.7 * smooth[1], "{smooth:?}");
    assert!(facets[2] > 3.0 * smooth[2], "{facets:?} {smooth:?}");
}

/// Its edges turn by 30°, which rounding makes a little more here and a little less there.
#[test]
fn a_circle_of_twelve_edges_has_no_corner() {
    let problem = problem(&disc(12, "", "smooth"));
    for pair in problem.pairs() {
        for (v, n) in pair.first.into_iter().zip(pair.direction.ends) {
            let [x, y] = problem.mesh.points[v];
            assert!((x * n[1] - y * n[0]).abs() < 1e-9, "{n:?} at ({x}, {y})");
        }
    }
}

#[test]
fn concave_arcs_are_as_good_as_convex_ones() {
    let error = |rise| relative_error(&problem(&Arcs { rise, n: 16, ..Arcs::default() }.text()));
    let (up, down) = (error(0.12), error(-0.12));
    assert!(up < 0.05 && down < 0.05, "{up} {down}");
}

#[test]
fn methods_agree_where_the_direction_turns() {
    let problem = problem(&Arcs { n: 12, ..Arcs::default() }.text());
    let energy = |method: &dyn DualMethod| complementary(&problem, &solve(&problem, method).stress).lower();
    let condensed = energy(&Condensed::default());
    let (one_by_one, iterative) = (ActiveSet::default(), Condensed { longest_dense: 0, ..Condensed::default() });
    let others: [(&dyn DualMethod, f64); 3] = [(&one_by_one, 1e-12), (&iterative, 1e-10), (&Clarabel::default(), 1e-8)];
    for (method, allowed) in others {
        let other = energy(method);
        assert!((other - condensed).abs() < allowed * condensed.abs(), "{}: {other} is not {condensed}", method.name());
    }
}

#[test]
fn the_algorithm_of_the_paper_says_that_it_has_no_words_for_a_turning_direction() {
    let problem = problem(&Arcs { n: 8, ..Arcs::default() }.text());
    match dual::solve(&Uzawa::default(), &problem, &[], &Options::default()) {
        Err(DualError::NotExpressible { what, .. }) => assert!(what.contains("lower|upper"), "{what}"),
        other => panic!("{other:?}"),
    }
    let facets = self::problem(&Arcs { n: 4, normals: "facets", ..Arcs::default() }.text());
    assert!(dual::solve(&Uzawa::default(), &facets, &[], &Options::default()).is_ok());
}

#[test]
fn straight_sides_keep_their_normal_whatever_is_asked() {
    let of = |normals| problem(&Arcs { n: 8, rise: 0.0, normals, ..Arcs::default() }.text());
    let (smooth, facets) = (of("smooth"), of("facets"));
    assert!(!smooth.contact_turns());
    assert_eq!(smooth.interfaces, facets.interfaces);
    let energy = |problem: &Problem| complementary(problem, &solve(problem, &Condensed::default()).stress).lower();
    assert_eq!(energy(&smooth).to_bits(), energy(&facets).to_bits());
}

#[test]
fn a_corner_keeps_both_normals() {
    // Twelve edges of a circle turn by 30° each, less one for rounding: eleven turn by more, thirteen by less.
    assert!(problem(&disc(13, "", "smooth")).contact_turns());
    assert!(!problem(&disc(11, "", "smooth")).contact_turns());
}

#[test]
fn the_traction_on_a_contact_is_along_its_direction() {
    let problem = problem(&Arcs { n: 10, ..Arcs::default() }.text());
    let dual = solve(&problem, &Condensed::default());
    for pair in &problem.interfaces[0].pairs {
        let traction = |side: usize| {
            let e = pair.edges[side].expect("a body on either side");
            let t = dual.stress.edge_traction(&problem.mesh, e, 0, 1);
            let vertices = if side == 0 { pair.first } else { pair.second.expect("a body") };
            vertices.map(|v| t[usize::from(problem.mesh.edges[e].vertices[0] != v)])
        };
        let (own, other) = (traction(0), traction(1));
        let size = own.as_flattened().iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let along = |end: usize| own[end][0] * pair.direction.ends[end][0] + own[end][1] * pair.direction.ends[end][1];
        assert!((along(0) - along(1)).abs() < 1e-11 * size && along(0) <= 1e-11 * size);
        for end in 0..2 {
            for c in 0..2 {
                assert!((own[end][c] + other[end][c]).abs() < 1e-11 * size);
                assert!((own[end][c] - along(end) * pair.direction.ends[end][c]).abs() < 1e-11 * size);
            }
        }
    }
}

#[test]
fn a_disc_in_its_bore_turns_freely_unless_its_facets_hold_it() {
    let turned = problem(&disc(24, "couple", "smooth"));
    let statics = statics::check(&turned).expect("decided");
    let Solvability::Impossible { bodies, sentence, .. } = &statics.equilibrium else { panic!("{statics:?}") };
    let MotionKind::Turns { centre } = bodies[0].kind else { panic!("{sentence}") };
    assert!(centre[0].abs() < 1e-9 && centre[1].abs() < 1e-9, "{centre:?}");
    assert!(sentence.contains("turns counter-clockwise about (0, 0)"), "{sentence}");
    let held = statics::check(&problem(&disc(24, "couple", "facets"))).expect("decided");
    assert!(matches!(held.equilibrium, Solvability::Possible { .. }), "{held:?}");
}

#[test]
fn a_disc_pressed_through_its_centre_is_bracketed_and_may_turn() {
    let pressed = problem(&disc(24, "force", "smooth"));
    assert_eq!(motions(&pressed).len(), 1);
    // The force at the centre of the load and the ends of contact are singular: the bound falls, and not like h².
    let finer = pressed.refine_uniform(1).expect("refines");
    let [coarse, fine] = [&pressed, &finer].map(relative_error);
    println!("{coarse} {fine}");
    assert!(fine < 0.75 * coarse && coarse < 0.5, "{coarse} {fine}");
}

/// Lamé's formulas for two rings under pressure inside: see `support/arcs.rs`.
#[test]
fn a_ring_pressed_on_a_ring_has_the_pressure_of_lame() {
    let mut last: Option<f64> = None;
    for n in [6, 12, 24] {
        let (text, exact) = ring_on_ring(n);
        let problem = problem(&text);
        let dual = solve(&problem, &Condensed::default());
        let tractions = dual.contact_traction[0].values();
        let off = tractions.iter().fold(0.0_f64, |m, t| m.max((-t - exact).abs())) / exact;
        println!("{n} facets: pressure off by {off:.2e}");
        // The pressure is one number on each facet: at least of first order, largest difference.
        assert!(last.is_none_or(|last| off < 0.5 * last), "{off} after {last:?}");
        last = Some(off);
    }
    assert!(last.is_some_and(|off| off < 0.01), "{last:?}");
}

#[test]
fn refinement_puts_vertices_on_the_circle_and_keeps_the_sides_together() {
    let (text, _) = ring_on_ring(6);
    let fine = problem(&text).refine_uniform(2).expect("refines");
    assert_eq!(fine.interfaces[0].pairs.len(), 24);
    for pair in &fine.interfaces[0].pairs {
        for (v, w) in pair.first.into_iter().zip(pair.second.expect("a body")) {
            let [x, y] = fine.mesh.points[v];
            assert_eq!(fine.mesh.points[v], fine.mesh.points[w]);
            assert!((x.hypot(y) - 1.5).abs() < 1e-13, "{x} {y}");
        }
        for (v, n) in pair.first.into_iter().zip(pair.direction.ends) {
            let [x, y] = fine.mesh.points[v];
            assert!((n[0] * y - n[1] * x).abs() < 1e-12 && (n[0].hypot(n[1]) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_facetted_curve_that_is_no_circle_keeps_its_directions_under_refinement() {
    let coarse = problem(&Arcs { n: 8, squeezed: true, ..Arcs::default() }.text());
    let fine = coarse.refine_uniform(1).expect("refines");
    let (old, new) = (&coarse.interfaces[0].pairs, &fine.interfaces[0].pairs);
    assert_eq!(new.len(), 2 * old.len());
    for (k, pair) in old.iter().enumerate() {
        let [near, far] = [&new[2 * k], &new[2 * k + 1]];
        assert_eq!(near.direction.ends[0], pair.direction.ends[0]);
        assert_eq!(far.direction.ends[1], pair.direction.ends[1]);
        assert_eq!(near.direction.ends[1], far.direction.ends[0]);
        assert_eq!(near.direction.ends[1], pair.direction.at(0.5));
    }
    relative_error(&fine);
}

/// A field of a mesh is one of every finer mesh that keeps edges and gaps: bounds from there hold for it.
#[test]
fn a_finer_mesh_that_keeps_its_edges_bounds_the_same_problem() {
    let (rings, _) = ring_on_ring(6);
    let touching = "[model]\nkinematics = \"plane-strain\"\n[geometry]\nsize = 0.25\n\
        [[geometry.polygons]]\nbody = \"a\"\npoints = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
        edges = [\"foot\", \"\", \"top\", \"axis\"]\n[bodies.a]\nyoung = 1.0\npoisson = 0.3\n\
        [[supports]]\non = \"axis\"\ntype = \"roller\"\n[[tractions]]\non = \"top\"\npressure = 0.1\n\
        [[contacts]]\non = \"foot\"\ngap = { circle = 3, at = 0 }\n";
    for text in [rings.as_str(), touching] {
        let kept = Problem { refinement: Refinement::KeepsEdges, ..problem(text) };
        let follows = problem(text).refine_uniform(1).expect("refines");
        let finer = kept.refine_uniform(1).expect("refines");
        assert_eq!(finer.refinement, Refinement::KeepsEdges);
        let area = |p: &Problem| (0..p.mesh.triangles.len()).map(|t| p.mesh.area(t)).sum::<f64>();
        assert!((area(&finer) - area(&kept)).abs() < 1e-12);
        for (k, pair) in kept.interfaces[0].pairs.iter().enumerate() {
            let parts = [&finer.interfaces[0].pairs[2 * k], &finer.interfaces[0].pairs[2 * k + 1]];
            assert_eq!([parts[0].gap[0], parts[1].gap[1]], pair.gap);
            let middle = pair.gap_at(0.5);
            assert!(parts[0].gap[1] == parts[1].gap[0] && (parts[0].gap[1] - middle).abs() <= 1e-12 * middle.abs());
        }
        let lower = |p: &Problem| Bracket::new(p, &solve(p, &Condensed::default())).lower();
        assert!(lower(&finer) >= lower(&kept), "{} after {}", lower(&finer), lower(&kept));
        // Following curved edges changes the problem: rounder rings are stiffer or softer, but not the same. A curved gap is the
        // same on every mesh.
        let same = (lower(&follows) - lower(&finer)).abs() <= 1e-12 * lower(&finer).abs();
        assert_eq!(same, text == touching);
    }
}
