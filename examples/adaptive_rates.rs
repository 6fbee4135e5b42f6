//! Adaptive against uniform refinement on two blocks with lift-off: writes `docs/data/adaptive.json` and
//! `docs/figures/adaptive.svg`. Run with `cargo run --release --example adaptive_rates`.

use std::path::Path;

use hypercircle::dual::{Condensed, Options};
use hypercircle::plot::{Scale, Series, Sheet, draw};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Goal, adapt, certify};

const TOLERANCE: f64 = 5e-4;
const UNIFORM: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut curves, mut series) = (Vec::new(), Vec::new());
    for (ink, poisson) in [0.3, 0.4999].into_iter().enumerate() {
        let scene = Scene::read(&root.join("cases/two_blocks.toml"))?;
        let scene = scene.changed(|draft| {
            draft.bodies.iter_mut().for_each(|b| {
                let young = b.elasticity.isotropic().map_or(1.0, |[young, _]| young);
                b.elasticity = hypercircle::elasticity::Elasticity::Isotropic { young, poisson };
            })
        })?;
        let coarsest = Problem::load(scene.coarsest())?;
        let options = Options::default();
        let run = adapt(coarsest.clone(), &Condensed::default(), &options, &Goal::new(TOLERANCE), |_| ())?;
        let adaptive: Vec<[f64; 2]> =
            run.history.iter().map(|r| [r.triangles as f64, r.relative_error_bound]).collect();
        let mut uniform = Vec::new();
        for level in 0..UNIFORM {
            let certified = certify(coarsest.refine_uniform(level)?, &Condensed::default(), &options)?;
            let upper = certified.bracket.free.as_ref().map_err(Clone::clone)?.upper();
            uniform.push([certified.problem.mesh.triangles.len() as f64, certified.bracket.relative_error(upper)]);
        }
        for (name, points, secondary) in [("adaptive", adaptive, false), ("uniform", uniform, true)] {
            curves.push(serde_json::json!({
                "poisson": poisson, "refinement": name, "triangles_and_guaranteed_relative_error": points,
            }));
            series.push(Series {
                label: format!("{name}, ν = {poisson}"),
                ink,
                secondary,
                points,
                spread: Vec::new(),
                open: Vec::new(),
            });
        }
    }
    let svg = draw(&Sheet {
        title: "Two blocks with lift-off".to_string(),
        labels: ["triangles".to_string(), "guaranteed relative error".to_string()],
        x: Scale::Logarithmic,
        series,
        front: Vec::new(),
        level: Some((1e-3, "0.1 %".to_string())),
        notes: Vec::new(),
        size: [1040, 560],
    })?;
    std::fs::write(root.join("docs/figures/adaptive.svg"), svg)?;
    std::fs::write(root.join("docs/data/adaptive.json"), format!("{:#}\n", serde_json::Value::from(curves)))?;
    Ok(())
}
