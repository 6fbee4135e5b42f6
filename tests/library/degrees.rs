//! Stresses of degree p, degrees side by side, and refinement of mesh and degrees.

use std::path::Path;
use std::sync::Arc;

use hypercircle::dual::{ActiveSet, Clarabel, Condensed, DualError, DualMethod, Options, Uzawa};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Certified, Goal, StudyError, adapt, certify};

fn case(name: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(name);
    Problem::load(Scene::read(&file).expect("a scene")).expect("a problem")
}

fn of_degree(degree: usize) -> Options {
    Options { elements: Elements::Uniform(block(degree)), ..Options::default() }
}

fn solved(problem: &Problem, method: &dyn DualMethod, options: &Options) -> Certified {
    certify(problem.clone(), method, options).expect("solves")
}

fn bounds(found: &Certified) -> [f64; 2] {
    [found.bracket.lower(), found.bracket.free.as_ref().expect("an upper bound").upper()]
}

/// Interior point, active sets and the Schur complement share no path to the contact state.
#[test]
fn methods_agree_in_every_degree() {
    for name in ["two_blocks.toml", "gap.toml", "ring.toml"] {
        let problem = case(name);
        for degree in [2, 3] {
            let options = of_degree(degree);
            let reference = solved(&problem, &Condensed::default(), &options);
            let energy = reference.bracket.complementary.lower();
            assert!(reference.dual.equilibrium.residual() < 1e-11, "{name}: {:?}", reference.dual.equilibrium);
            for method in [&ActiveSet::default() as &dyn DualMethod, &Clarabel::default()] {
                let other = solved(&problem, method, &options).bracket.complementary.lower();
                let off = (other - energy).abs();
                assert!(off < 1e-8 * energy.abs(), "{name}, p = {degree}, {}: {other} for {energy}", method.name());
            }
        }
    }
}

/// Spaces of a higher degree contain those of a lower one, and so does a mixture: −Π rises, and never above an upper bound.
#[test]
fn more_degrees_give_more_of_the_energy() {
    for name in ["two_blocks.toml", "sliding.toml", "ring.toml"] {
        let problem = case(name);
        let (mut last, mut least_upper) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut lowers = Vec::new();
        for degree in 1..=3 {
            let options = of_degree(degree);
            let mixed: Arc<[u8]> =
                (0..problem.mesh.triangles.len()).map(|t| (degree + usize::from((7 * t) % 3 == 1)) as u8).collect();
            let between = Options { elements: Elements::Blocks(mixed), ..Options::default() };
            for options in [options, between] {
                let found = solved(&problem, &Condensed::default(), &options);
                let [lower, upper] = bounds(&found);
                let room = 2.0 * found.bracket.lower_widening;
                assert!(lower > last - room, "{name}, p = {degree}: {lower} after {last}");
                assert!(found.dual.equilibrium.residual() < 1e-10, "{name}: {:?}", found.dual.equilibrium);
                least_upper = least_upper.min(upper);
                last = lower;
                lowers.push(lower);
            }
        }
        assert!(lowers.iter().all(|lower| *lower <= least_upper), "{name}: {lowers:?} and {least_upper}");
    }
}

/// A displacement quadratic in x gives linear stresses: any degree is exact, next to any other.
#[test]
fn a_solution_in_the_space_is_found_in_every_mixture() {
    let problem = case("bending.toml");
    let exact = solved(&problem, &Condensed::default(), &of_degree(1));
    let [lower, upper] = bounds(&exact);
    let mixed: Arc<[u8]> = (0..problem.mesh.triangles.len()).map(|t| (1 + t % 5) as u8).collect();
    let options = Options { elements: Elements::Blocks(mixed), ..Options::default() };
    let found = bounds(&solved(&problem, &Condensed::default(), &options));
    assert!((found[0] - lower).abs() < 1e-10 * lower.abs() && (found[1] - upper).abs() < 1e-10 * upper.abs());
}

/// Bounds of the energy of the paper's example, from linear stresses on 54,696 triangles.
const TWO_BLOCKS: [f64; 2] = [-1.796_413_415_2, -1.796_413_402_3];

/// Linear stresses where they do, and the degrees of a run that began with cubic ones where they do not.
#[test]
fn degrees_are_raised_where_linear_stresses_do_not_do() {
    let problem = case("hertz_rigid.toml");
    let linear = solved(&problem, &Condensed::default(), &of_degree(1));
    let error = linear.bracket.relative_error(bounds(&linear)[1]);
    let reached = |degree, tolerance| {
        let goal = Goal { adapt: Adapt::Hp, ..Goal::new(tolerance) };
        let run = adapt(problem.clone(), &Condensed::default(), &of_degree(degree), &goal, |_| ()).expect("solves");
        assert!(run.stopped.is_none());
        run.history.iter().map(|row| (row.triangles, row.unknowns, row.lower)).collect::<Vec<_>>()
    };
    let easy = reached(1, 1.1 * error);
    assert_eq!(easy.iter().map(|row| row.0).collect::<Vec<_>>(), [problem.mesh.triangles.len()]);
    assert_eq!(easy[0].1, linear.dual.unknowns);
    // Not far away a few more linear triangles are enough.
    let near = reached(1, 0.7 * error);
    assert!(near.len() == 2 && near[1].0 > near[0].0 && near[1].1 < 2 * near[0].1, "{near:?}");
    let [far, cubic] = [1, 3].map(|degree| reached(degree, 0.05 * error));
    assert_eq!((far[1].0, far[1].1), (far[0].0, 2 * far[0].1));
    assert_eq!(far[1..].iter().map(|row| row.1).collect::<Vec<_>>(), cubic.iter().map(|row| row.1).collect::<Vec<_>>());
}

#[test]
fn mesh_and_degrees_together_cost_few_unknowns() {
    let problem = case("two_blocks.toml");
    for (tolerance, most) in [(1e-3, 6_000), (1e-4, 16_000)] {
        let goal = Goal { adapt: Adapt::Hp, ..Goal::new(tolerance) };
        let run = adapt(problem.clone(), &Condensed::default(), &of_degree(3), &goal, |_| ()).expect("solves");
        let (last, [lower, upper]) = (run.history.last().expect("a mesh"), bounds(&run.certified));
        println!("{tolerance:e}: {} triangles, {} unknowns", last.triangles, last.unknowns);
        assert!(run.stopped.is_none() && last.relative_error_bound <= tolerance);
        assert!(last.unknowns <= most, "{} unknowns for {tolerance:e}", last.unknowns);
        assert!(lower <= TWO_BLOCKS[1] && upper >= TWO_BLOCKS[0], "[{lower}, {upper}]");
        let degrees: Vec<usize> =
            (0..run.certified.problem.mesh.triangles.len()).map(|t| run.certified.dual.stress.degree(t)).collect();
        assert!(degrees.iter().min() < degrees.iter().max(), "one degree everywhere");
        for edge in &run.certified.problem.mesh.edges {
            if let [Some(a), Some(b)] = edge.triangles {
                assert!(degrees[a].abs_diff(degrees[b]) <= 1);
            }
        }
        for pair in &run.certified.problem.interfaces[0].pairs {
            let of = pair.edges.map(|e| run.certified.problem.mesh.edges[e.expect("two sides")].triangles[0]);
            assert_eq!(of[0].map(|t| degrees[t]), of[1].map(|t| degrees[t]));
        }
    }
}

#[test]
fn the_algorithm_of_the_paper_has_linear_stresses() {
    let error = certify(case("two_blocks.toml"), &Uzawa::default(), &of_degree(2)).expect_err("refused");
    assert!(matches!(error, StudyError::Dual(DualError::NotExpressible { .. })), "{error}");
    assert!(error.to_string().contains("--degree 1"), "{error}");
}
