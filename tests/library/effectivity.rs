//! How much larger the guaranteed error is than the true one, on random scenes.
//!
//! The error of λ_h is measured in energy: d = 𝓛(u) + Π(λ_h) = ½‖τ(u) − λ_h‖²_a + ∫ (−T_n(λ_h)) (g − u_n' − u_n'') ds,
//! and the bound claims d ≤ gap. The effectivity is √(gap/d). 𝓛(u) is enclosed by a far finer mesh, hence d as well:
//! the guarantee holds when the gap is at least the smallest d that the enclosure allows.
//!
//! Linear stresses and those of degrees 2 to 4 on meshes of their own, and mesh and degrees refined together (hp), are held against one
//! truth, and against each other. Four scenes; set `HYPERCIRCLE_SCENES` for another number. Every case is asked the same on
//! its own mesh.

use crate::support::random::{Random, scenes_or};
use crate::support::scenes::stack::slanted;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Certified, Goal, StudyError, adapt, certify};

/// A scene whose finer mesh would need more triangles than this …
const MOST_TRIANGLES: usize = 30_000;
/// … and whose bound there is more than this part of the coarse one, has no truth to compare with.
const FINE_ENOUGH: f64 = 0.25;

fn upper(certified: &Certified) -> f64 {
    certified.bracket.free.as_ref().expect("an upper bound").upper()
}

/// A way to a bracket: its name, the degree that refinement begins with, and what it refines.
const WAYS: [(&str, usize, Adapt); 5] = [
    ("p = 1", 1, Adapt::H),
    ("p = 2", 2, Adapt::H),
    ("p = 3", 3, Adapt::H),
    ("p = 4", 4, Adapt::H),
    ("hp", 3, Adapt::Hp),
];

fn run(problem: &Problem, (_, degree, what): (&str, usize, Adapt), tolerance: f64) -> Result<Certified, StudyError> {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    let goal = Goal { max_triangles: Some(MOST_TRIANGLES), adapt: what, ..Goal::new(tolerance) };
    Ok(adapt(problem.clone(), &Condensed::default(), &options, &goal, |_| ())?.certified)
}

#[test]
fn the_bound_is_never_below_the_error_and_never_three_times_as_large() {
    let wanted = scenes_or(4);
    let mut random = Random::new(1981);
    let (mut found, mut unknown) = (vec![Vec::new(); WAYS.len()], [0; WAYS.len()]);
    let (mut scenes, mut infeasible) = (0, 0);
    while scenes < wanted {
        let toml = slanted(&mut random);
        let coarse_bound = random.between(0.02, 0.2);
        let text = toml.text();
        let scene = Scene::parse(&text, "random.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let problem = Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let mut coarse = Vec::new();
        for way in WAYS {
            // Higher degrees are asked for more, or all of them would stay on the first mesh.
            match run(&problem, way, coarse_bound / way.1 as f64) {
                Ok(certified) => coarse.push(certified),
                Err(StudyError::NoEquilibrium { .. }) if coarse.is_empty() => break,
                Err(error) => panic!("{}: {error}\n{text}", way.0),
            }
        }
        if coarse.is_empty() {
            infeasible += 1;
            continue;
        }
        scenes += 1;
        let reached: Vec<f64> = coarse.iter().map(|c| c.bracket.relative_error(upper(c))).collect();
        let fine = run(&problem, WAYS[4], 0.1 * reached.iter().copied().fold(f64::INFINITY, f64::min));
        let fine = fine.unwrap_or_else(|e| panic!("{e}\n{text}"));
        for (k, own) in coarse.iter().enumerate() {
            let name = WAYS[k].0;
            let known_to = fine.bracket.relative_error(upper(&fine)) / reached[k];
            let gap = upper(own) - own.bracket.lower();
            let [least, most] = [fine.bracket.lower(), upper(&fine)].map(|exact| exact - own.bracket.lower());
            assert!(least <= gap, "{name}: the bound {gap:e} misses the error, which is at least {least:e}\n{text}");
            for (other, (against, ..)) in coarse.iter().chain([&fine]).zip(WAYS.iter().chain([&WAYS[4]])) {
                let [low, high] = [own.bracket.lower(), upper(other)];
                assert!(low <= high, "{name} is above {low}, {against} below {high}\n{text}");
            }
            match known_to <= FINE_ENOUGH {
                true => found[k].push((gap / (0.5 * (least.max(0.0) + most))).sqrt()),
                false => unknown[k] += 1,
            }
        }
    }
    println!("{wanted} scenes, {infeasible} more without equilibrium; effectivity:");
    println!("|  | least | median | nine tenths below | most | truth not known |");
    for (k, found) in found.iter_mut().enumerate() {
        let name = WAYS[k].0;
        found.sort_by(f64::total_cmp);
        let at = |part: f64| found[((found.len() - 1) as f64 * part).round() as usize];
        let [least, median, most_of, most] = [0.0, 0.5, 0.9, 1.0].map(at);
        println!("| {name} | {least:.2} | {median:.2} | {most_of:.2} | {most:.2} | {} |", unknown[k]);
        assert!(10 * unknown[k] <= wanted.max(10), "{name}: {} scenes of which the truth is not known", unknown[k]);
        assert!(least >= 1.0 && most <= 3.0, "{name}: from {least} to {most}");
    }
}

/// Below this guaranteed relative error a case is exact but for rounding, and there is no error to compare with.
const EXACT: f64 = 1e-4;

/// Cases whose bodies become rounder as the mesh becomes finer: a finer mesh does not know the error of a coarse one.
const ROUND: [&str; 6] = ["cylinder_on_block", "hollow_sphere", "pin", "ring", "rotor", "two_cylinders"];

/// Cases whose truth takes longer than that of all others together.
const LONG: [&str; 3] = ["boussinesq", "cone", "hertz_sphere"];

#[test]
fn every_case_bounds_its_error_between_once_and_three_times() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut compared = 0;
    for entry in std::fs::read_dir(folder).expect("cases") {
        let path = entry.expect("readable").path();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if path.extension().is_none_or(|e| e != "toml") || ROUND.contains(&stem) || LONG.contains(&stem) {
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
        let truth = Goal { adapt: Adapt::Hp, ..Goal::new(0.3 * reached) };
        let fine =
            adapt(problem, &method, &options, &truth, |_| ()).unwrap_or_else(|e| panic!("{name}: {e}")).certified;
        let [least, most] = [fine.bracket.lower(), upper(&fine)].map(|exact| exact - coarse.bracket.lower());
        println!("{name}: from {:.2} to {:.2}", (gap / most).sqrt(), (gap / least).sqrt());
        assert!(least > 0.0 && least <= gap, "{name}: the bound {gap:e} misses the error, which is at least {least:e}");
        assert!((gap / least).sqrt() <= 3.0, "{name}: {}", (gap / least).sqrt());
        compared += 1;
    }
    assert!(compared >= 6, "{compared} cases with an error");
}
