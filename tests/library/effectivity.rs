//! How much larger the guaranteed error is than the true one, on random scenes.
//!
//! The error of λ_h is measured in energy: d = 𝓛(u) + Π(λ_h) = ½‖τ(u) − λ_h‖²_a + ∫ (−T_n(λ_h)) (g − u_n' − u_n'') ds,
//! and the bound claims d ≤ gap. The effectivity is √(gap/d). 𝓛(u) is enclosed by a far finer mesh, hence d as well:
//! the guarantee holds when the gap is at least the smallest d that the enclosure allows.
//!
//! Forty scenes; set `HYPERCIRCLE_SCENES` for another number. The same is asked of every case on its own mesh.

use crate::support::random::Random;
use crate::support::scenes::stack::slanted;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, Goal, StudyError, adapt, certify};

/// A scene whose finer mesh would need more triangles than this …
const MOST_TRIANGLES: usize = 30_000;
/// … and whose bound there is more than this part of the coarse one, has no truth to compare with.
const FINE_ENOUGH: f64 = 0.25;

fn upper(certified: &Certified) -> f64 {
    certified.bracket.free.as_ref().expect("an upper bound").upper()
}

#[test]
fn the_bound_is_never_below_the_error_and_never_three_times_as_large() {
    let wanted: usize = std::env::var("HYPERCIRCLE_SCENES").ok().map_or(40, |n| n.parse().expect("a number of scenes"));
    let mut random = Random::new(1981);
    let (mut found, mut infeasible, mut unknown) = (Vec::new(), 0, 0);
    while found.len() < wanted {
        let toml = slanted(&mut random);
        let coarse_bound = random.between(0.02, 0.2);
        let text = toml.text();
        let scene = Scene::parse(&text, "random.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let run = |problem: Problem, tolerance: f64| {
            let goal = Goal { max_triangles: Some(MOST_TRIANGLES), ..Goal::new(tolerance) };
            adapt(problem, &Condensed::default(), &Options::default(), &goal, |_| ())
        };
        let coarse = match run(problem.clone(), coarse_bound) {
            Ok(adapted) => adapted.certified,
            Err(StudyError::NoEquilibrium { .. }) => {
                infeasible += 1;
                continue;
            }
            Err(error) => panic!("{error}\n{text}"),
        };
        let reached = coarse.bracket.relative_error(upper(&coarse));
        let fine = run(problem, 0.08 * reached).unwrap_or_else(|e| panic!("{e}\n{text}")).certified;
        let known_to = fine.bracket.relative_error(upper(&fine)) / reached;
        let gap = upper(&coarse) - coarse.bracket.lower();
        let [least, most] = [fine.bracket.lower(), upper(&fine)].map(|exact| exact - coarse.bracket.lower());
        assert!(least <= gap, "the bound {gap:e} misses the error, which is at least {least:e}\n{text}");
        assert!(fine.bracket.lower() <= upper(&coarse) && coarse.bracket.lower() <= upper(&fine), "{text}");
        match known_to <= FINE_ENOUGH {
            true => found.push((gap / (0.5 * (least.max(0.0) + most))).sqrt()),
            false => unknown += 1,
        }
    }
    found.sort_by(f64::total_cmp);
    let at = |part: f64| found[((found.len() - 1) as f64 * part).round() as usize];
    println!(
        "{wanted} scenes, {infeasible} more without equilibrium, {unknown} more without a far finer bracket: effectivity from {:.2}, median {:.2}, nine tenths \
         below {:.2}, up to {:.2}",
        at(0.0),
        at(0.5),
        at(0.9),
        at(1.0)
    );
    assert!(20 * unknown <= wanted.max(20), "{unknown} scenes of which the truth is not known");
    assert!(at(0.0) >= 1.0 && at(1.0) <= 3.0, "from {} to {}", at(0.0), at(1.0));
}

/// Below this guaranteed relative error a case is exact but for rounding, and there is no error to compare with.
const EXACT: f64 = 1e-4;

/// Cases whose bodies become rounder as the mesh becomes finer: a finer mesh does not know the error of a coarse one.
const ROUND: [&str; 4] = ["cylinder_on_block", "pin", "ring", "two_cylinders"];

#[test]
fn every_case_bounds_its_error_between_once_and_three_times() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut compared = 0;
    for entry in std::fs::read_dir(folder).expect("cases") {
        let path = entry.expect("readable").path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if path.extension().is_none_or(|e| e != "toml") || ROUND.contains(&stem) {
            continue;
        }
        let name = path.display();
        let problem = Problem::load(Scene::read(&path).expect("valid")).expect("valid");
        let (method, options) = (Condensed::default(), Options::default());
        let coarse = certify(problem.clone(), &method, &options).unwrap_or_else(|e| panic!("{name}: {e}"));
        let gap = upper(&coarse) - coarse.bracket.lower();
        let reached = coarse.bracket.relative_error(upper(&coarse));
        if reached < EXACT {
            continue;
        }
        let fine = adapt(problem, &method, &options, &Goal::new(0.15 * reached), |_| ())
            .unwrap_or_else(|e| panic!("{name}: {e}"))
            .certified;
        let [least, most] = [fine.bracket.lower(), upper(&fine)].map(|exact| exact - coarse.bracket.lower());
        println!("{name}: from {:.2} to {:.2}", (gap / most).sqrt(), (gap / least).sqrt());
        assert!(least > 0.0 && least <= gap, "{name}: the bound {gap:e} misses the error, which is at least {least:e}");
        assert!((gap / least).sqrt() <= 3.0, "{name}: {}", (gap / least).sqrt());
        compared += 1;
    }
    assert!(compared >= 6, "{compared} cases with an error");
}
