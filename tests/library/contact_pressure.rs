//! Contact pressures of every degree against the stresses at the contact, integrated by a rule that knows no polynomials.

use std::path::Path;

use crate::arcs::Arcs;
use hypercircle::compare::contact::pressure::{
    contact_ends, dual_pressure, l2, maximum, open_length, profile, resultant,
};
use hypercircle::dual::{self, Condensed, DualSolution, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::{ContactPair, Problem};
use hypercircle::scene::Scene;
use hypercircle::statics;

/// Intervals of Simpson's rule on a pair.
const INTERVALS: usize = 200;

fn case(name: &str) -> Problem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(name).with_extension("toml");
    Problem::load(Scene::read(&path).expect("a valid scene")).expect("a valid problem")
}

fn solve(problem: &Problem, degree: usize) -> DualSolution {
    let statics = statics::check(problem).expect("decided");
    let motions: Vec<_> = statics.held.iter().map(|m| m.at_vertices(problem, &statics.components)).collect();
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    dual::solve(&Condensed::default(), problem, &motions, &options).expect("solves")
}

/// Points along the first side of a pair, from its first end to its second: which part of the way, where, the traction of the
/// first side there, and Simpson's weight of it in ∫ ds along the edge.
fn tractions(problem: &Problem, dual: &DualSolution, pair: &ContactPair) -> Vec<(f64, [f64; 2], [f64; 2], f64)> {
    let mesh = &problem.mesh;
    let e = pair.edges[0].expect("the first side is of a body");
    let t = mesh.edges[e].triangles[0].expect("a triangle");
    let side = mesh.triangle_edges[t].iter().position(|&x| x == e).expect("its edge");
    let [a, b] = [1, 2].map(|k| mesh.corners(t)[(side + k) % 3]);
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let n = [(b[1] - a[1]) / length, (a[0] - b[0]) / length];
    let forward = mesh.triangles[t][(side + 1) % 3] == pair.first[0];
    (0..=INTERVALS)
        .map(|k| {
            let s = k as f64 / INTERVALS as f64;
            let stress = dual.stress.at(t, side, [1.0 - s, s, 0.0]);
            let traction = [stress[0] * n[0] + stress[2] * n[1], stress[2] * n[0] + stress[1] * n[1]];
            let weight = if k == 0 || k == INTERVALS { 1.0 } else { (2 + 2 * (k % 2)) as f64 };
            let at = [0, 1].map(|c| (1.0 - s) * a[c] + s * b[c]);
            (if forward { s } else { 1.0 - s }, at, traction, weight * length / (3 * INTERVALS) as f64)
        })
        .collect()
}

fn hold_against_stresses(name: &str, problem: &Problem, degree: usize) {
    let dual = solve(problem, degree);
    for (index, interface) in problem.interfaces.iter().enumerate() {
        let pieces = dual_pressure(&dual, index);
        let (force, moment) = resultant(problem, interface, &pieces);
        let (largest, at) = maximum(problem, interface, &pieces);
        let thickness = problem.scene.thickness;
        let (mut other, mut turning, mut square, mut most, mut size) = ([0.0; 2], 0.0, 0.0, 0.0_f64, 0.0);
        let mut nearest = f64::INFINITY;
        for pair in &interface.pairs {
            for (s, x, traction, weight) in tractions(problem, &dual, pair) {
                let f = traction.map(|t| thickness * weight * t);
                other = [other[0] + f[0], other[1] + f[1]];
                turning += x[0] * f[1] - x[1] * f[0];
                size += f[0].hypot(f[1]);
                let n = pair.direction.at(s);
                let along = traction[0] * n[0] + traction[1] * n[1];
                let pressure = -along / (n[0] * n[0] + n[1] * n[1]) / pair.direction.shares[0];
                square += weight * pair.direction.shares[0].recip() * pressure * pressure;
                most = most.max(pressure);
                nearest = nearest.min((x[0] - at[0]).hypot(x[1] - at[1]));
            }
        }
        let what = format!("{name}, degree {degree}, {}", interface.name);
        for c in 0..2 {
            assert!((force[c] - other[c]).abs() < 1e-8 * size, "{what}: {force:?} is not {other:?}");
        }
        assert!((moment - turning).abs() < 1e-8 * size, "{what}: {moment} is not {turning}");
        assert!(largest > most - 1e-9 * most && largest < most * (1.0 + 1e-3), "{what}: {largest} is not {most}");
        let longest = interface.pairs.iter().map(|p| p.length).fold(0.0, f64::max);
        assert!(nearest < longest / INTERVALS as f64, "{what}: {at:?} is not on the contact");
        let (norm, difference) = l2(interface, &pieces, &pieces);
        assert!(difference == 0.0 && (norm - square.sqrt()).abs() < 1e-8 * norm, "{what}: {norm} is not {square}");
    }
}

#[test]
fn resultant_moment_and_norm_are_integrals_of_the_stresses() {
    for degree in [1, 2, 4] {
        for name in ["two_blocks", "inclined"] {
            hold_against_stresses(name, &case(name), degree);
        }
    }
}

#[test]
fn the_same_where_the_direction_of_contact_turns() {
    let scene = Scene::parse(&Arcs { n: 8, ..Arcs::default() }.text(), "scene.toml".as_ref()).expect("valid");
    let problem = Problem::load(scene).expect("valid");
    assert!(problem.interfaces[0].pairs.iter().any(|p| !p.direction.is_constant()));
    for degree in [1, 2, 3, 5] {
        hold_against_stresses("arcs", &problem, degree);
    }
}

#[test]
fn statics_decides_the_resultant_of_two_blocks_whatever_the_degree() {
    let problem = case("two_blocks");
    for degree in [1, 2, 3, 4] {
        let pieces = dual_pressure(&solve(&problem, degree), 0);
        let ([x, y], _) = resultant(&problem, &problem.interfaces[0], &pieces);
        assert!((x + 0.5).abs() < 1e-9 && y.abs() < 1e-9, "degree {degree}: {x} {y}");
    }
}

#[test]
fn contact_ends_where_open_pairs_begin_and_curves_have_points_enough() {
    let problem = case("two_blocks");
    let interface = &problem.interfaces[0];
    let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
    for degree in 1..=4 {
        let pieces = dual_pressure(&solve(&problem, degree), 0);
        let open = open_length(interface, &pieces, 1e-9);
        assert!(open > 0.1 * length && open < 0.9 * length, "{open} of {length}");
        let ends = contact_ends(interface, &pieces, 1e-9);
        assert_eq!(ends.len(), 1, "{ends:?}");
        // Open from there to one end of the interface.
        let [first, last] = [interface.pairs[0].arc[0], interface.pairs[interface.pairs.len() - 1].arc[1]];
        assert!((ends[0] - first - open).abs().min((last - ends[0] - open).abs()) < 1e-12, "{ends:?} and {open}");
        // Straight lines between the points have nearly the area of the pressure.
        let points = profile(interface, &pieces);
        let per_pair = if degree == 1 { 2 } else { 2 * degree + 1 };
        assert_eq!(points.len(), per_pair * pieces.len());
        let area: f64 = points.windows(2).map(|w| 0.5 * (w[1][0] - w[0][0]) * (w[0][1] + w[1][1])).sum();
        assert!((area - 0.5).abs() < 2e-3, "degree {degree}: {area}");
    }
}
