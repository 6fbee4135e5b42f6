//! The guaranteed error against the cube root of the unknowns, refining the mesh, the degree, and both: writes
//! `docs/data/hp.json` and `docs/figures/hp.svg`. Run with `cargo run --release --example hp_rates`.

use std::error::Error;
use std::path::Path;

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, MAX_DEGREE, block};
use hypercircle::plot::{Scale, Series, Sheet, draw};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Adapt, Goal, adapt, certify};

/// Where refinement of linear stresses ends, and where all others do.
const LINEAR: f64 = 5e-4;
const TOLERANCE: f64 = 1e-5;

fn blocks(poisson: f64, coarsest: bool) -> Result<Problem, Box<dyn Error>> {
    let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/two_blocks.toml"))?;
    let scene = scene.changed(|draft| {
        draft.bodies.iter_mut().for_each(|b| {
            let young = b.elasticity.isotropic().map_or(1.0, |[young, _]| young);
            b.elasticity = hypercircle::elasticity::Elasticity::Isotropic { young, poisson };
        })
    })?;
    Ok(Problem::load(if coarsest { scene.coarsest() } else { scene })?)
}

fn of_degree(degree: usize) -> Options {
    Options { elements: Elements::Uniform(block(degree)), ..Options::default() }
}

/// Unknowns and guaranteed relative error, mesh by mesh.
fn adaptive(poisson: f64, degree: usize, what: Adapt, tolerance: f64) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let goal = Goal { adapt: what, ..Goal::new(tolerance) };
    let run = adapt(blocks(poisson, true)?, &Condensed::default(), &of_degree(degree), &goal, |_| ())?;
    Ok(run.history.iter().map(|r| [r.unknowns as f64, r.relative_error_bound]).collect())
}

/// Unknowns and guaranteed relative error, degree by degree, on the mesh of the scene.
fn by_degree(poisson: f64) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let problem = blocks(poisson, false)?;
    let of = |p: usize| {
        let certified = certify(problem.clone(), &Condensed::default(), &of_degree(p))?;
        let upper = certified.bracket.free.as_ref().map_err(Clone::clone)?.upper();
        Ok([certified.dual.unknowns as f64, certified.bracket.relative_error(upper)])
    };
    (1..=MAX_DEGREE).map(of).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found = [
        ("h, p = 1", 0.3, adaptive(0.3, 1, Adapt::H, LINEAR)?),
        ("h, p = 4", 0.3, adaptive(0.3, 4, Adapt::H, TOLERANCE)?),
        ("p = 1 … 8, one mesh", 0.3, by_degree(0.3)?),
        ("hp", 0.3, adaptive(0.3, 3, Adapt::Hp, TOLERANCE)?),
        ("hp", 0.4999, adaptive(0.4999, 3, Adapt::Hp, TOLERANCE)?),
    ];
    let (mut curves, mut series) = (Vec::new(), Vec::new());
    for (ink, (name, poisson, points)) in found.into_iter().enumerate() {
        curves.push(serde_json::json!({
            "poisson": poisson, "refinement": name, "unknowns_and_guaranteed_relative_error": points,
        }));
        series.push(Series {
            label: format!("{name}, ν = {poisson}"),
            ink,
            secondary: false,
            points,
            spread: Vec::new(),
            open: Vec::new(),
        });
    }
    let svg = draw(&Sheet {
        title: "Two blocks with lift-off".to_string(),
        labels: ["unknowns, by their cube root".to_string(), "guaranteed relative error".to_string()],
        x: Scale::CubeRoot,
        series,
        front: Vec::new(),
        level: Some((1e-4, "0.01 %".to_string())),
        notes: Vec::new(),
        size: [1040, 560],
    })?;
    std::fs::write(root.join("docs/figures/hp.svg"), svg)?;
    std::fs::write(root.join("docs/data/hp.json"), format!("{:#}\n", serde_json::Value::from(curves)))?;
    Ok(())
}
