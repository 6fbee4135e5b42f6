//! The answer does not depend on units and numbering, and repeats to the bit.

use crate::setup::blocks::{blocks, cornered, scaled, sliding, solved, tilting};
use crate::setup::lift_off;
use hypercircle::bounds::complementary;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::study::{Certified, certify};

#[test]
fn powers_of_two_scale_every_bit() {
    for problem in [lift_off(8), cornered(1.0), sliding()] {
        let plain = solved(&problem, Condensed::default());
        let (length, force, young) = (2.0_f64.powi(-9), 2.0_f64.powi(13), 4.0_f64.powi(20));
        let other = solved(&scaled(&problem, length, force, young), Condensed::default());
        assert_eq!((plain.iterations, &plain.closed), (other.iterations, &other.closed));
        for t in 0..plain.stress.len() {
            for (a, b) in plain.stress.block(t).as_flattened().iter().zip(other.stress.block(t).as_flattened()) {
                assert_eq!((a * force).to_bits(), b.to_bits());
            }
        }
    }
}

#[test]
fn any_scale_leaves_the_dimensionless_answer() {
    let problem = lift_off(8);
    let energy = complementary(&problem, &solved(&problem, Condensed::default()).stress).lower();
    for (length, force, young) in
        [(1e9, 1.0, 1.0), (1e-9, 1.0, 1.0), (1.0, 1e9, 1.0), (1.0, 1e-9, 1e9), (1e-9, 1e9, 1e-9)]
    {
        let other = scaled(&problem, length, force, young);
        let found = solved(&other, Condensed::default());
        let value = complementary(&other, &found.stress).lower() * young / (force * length).powi(2);
        assert!((value - energy).abs() <= 1e-12 * energy.abs(), "{length:e} {force:e} {young:e}: {value} for {energy}");
        assert!(found.equilibrium.residual() <= 1e-11);
    }
}

/// A permutation of 0..n.
fn permutation(n: usize, seed: u64) -> Vec<usize> {
    let mut state = seed;
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        order.swap(i, (state >> 33) as usize % (i + 1));
    }
    order
}

/// This problem with triangles, vertices and edges renumbered and the corners of each triangle turned by one;
/// `place[t]` is the new number of triangle t.
fn renumbered(problem: &Problem, seed: u64) -> (Problem, Vec<usize>) {
    let mut p = problem.clone();
    let vertex = permutation(p.mesh.points.len(), seed);
    let place = permutation(p.mesh.triangles.len(), seed + 1);
    let edge = permutation(p.mesh.edges.len(), seed + 2);
    for (old, &new) in vertex.iter().enumerate() {
        p.mesh.points[new] = problem.mesh.points[old];
    }
    for (old, &new) in place.iter().enumerate() {
        let [a, b, c] = problem.mesh.triangles[old].map(|v| vertex[v]);
        let [d, e, f] = problem.mesh.triangle_edges[old].map(|e| edge[e]);
        p.mesh.triangles[new] = [b, c, a];
        p.mesh.triangle_edges[new] = [e, f, d];
        p.mesh.body[new] = problem.mesh.body[old];
    }
    for (old, &new) in edge.iter().enumerate() {
        p.mesh.edges[new] = problem.mesh.edges[old];
        p.mesh.edges[new].vertices = problem.mesh.edges[old].vertices.map(|v| vertex[v]);
        p.mesh.edges[new].triangles = problem.mesh.edges[old].triangles.map(|t| t.map(|t| place[t]));
        p.conditions[new] = problem.conditions[old];
    }
    for pair in p.interfaces.iter_mut().flat_map(|i| &mut i.pairs) {
        pair.edges = pair.edges.map(|e| e.map(|e| edge[e]));
        pair.first = pair.first.map(|v| vertex[v]);
        pair.second = pair.second.map(|s| s.map(|v| vertex[v]));
    }
    (p, place)
}

#[test]
fn numbering_does_not_matter() {
    for problem in [lift_off(12), cornered(1.0), blocks([(1.0, 0.49), (50.0, 0.0)], [9, 14], tilting).build()] {
        let plain = solved(&problem, Condensed::default());
        let (other, place) = renumbered(&problem, 5);
        let found = solved(&other, Condensed::default());
        let (a, b) = (complementary(&problem, &plain.stress).lower(), complementary(&other, &found.stress).lower());
        assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} and {b}");
        let largest =
            (0..place.len()).flat_map(|t| plain.stress.block(t).as_flattened()).fold(0.0_f64, |m, v| m.max(v.abs()));
        for (t, &new) in place.iter().enumerate() {
            for sub in 0..3 {
                for node in 0..3 {
                    let mut bary = [0.0; 3];
                    bary[node] = 1.0;
                    let (a, b) = (plain.stress.at(t, (sub + 1) % 3, bary), found.stress.at(new, sub, bary));
                    for c in 0..3 {
                        assert!((a[c] - b[c]).abs() <= 1e-12 * largest, "{a:?} and {b:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn runs_and_threads_repeat_every_bit() {
    for degree in [1, 3] {
        let options = |threads| Options { threads, elements: Elements::Uniform(block(degree)), ..Options::default() };
        let run = |threads| certify(lift_off(16), &Condensed::default(), &options(threads)).expect("an answer");
        let once = run(1);
        for other in [run(1), run(2), run(3)] {
            let ends = |run: &Certified| [run.bracket.lower(), run.bracket.free.as_ref().expect("a bound").upper()];
            assert_eq!(ends(&once).map(f64::to_bits), ends(&other).map(f64::to_bits));
            let (a, b) = (&once.dual, &other.dual);
            for t in 0..a.stress.len() {
                for (x, y) in a.stress.block(t).as_flattened().iter().zip(b.stress.block(t).as_flattened()) {
                    assert_eq!(x.to_bits(), y.to_bits());
                }
            }
            assert!(a.moments == b.moments);
        }
    }
}
