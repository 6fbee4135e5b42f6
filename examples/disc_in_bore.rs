//! A disc in its bore as a polygon, with facets and with smooth directions of contact: writes `docs/data/bore.json` and
//! `docs/figures/bore.svg`. Run with `cargo run --release --example disc_in_bore`.

#[allow(dead_code)]
#[path = "../tests/support/arcs.rs"]
mod arcs;
#[path = "../tests/support/lame.rs"]
mod lame;

use std::path::Path;

use hypercircle::dual::{Condensed, Options};
use hypercircle::plot::{Scale, Series, Sheet, draw};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::certify;

/// Edges of the polygon; elements shrink with them.
const FACETS: [usize; 6] = [16, 24, 32, 48, 64, 96];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut curves, mut series) = (Vec::new(), Vec::new());
    for (ink, normals) in ["smooth", "facets"].into_iter().enumerate() {
        let mut points = Vec::new();
        for n in FACETS {
            let scene = Scene::parse(&arcs::disc(n, "force", normals), "disc.toml".as_ref())?;
            let certified = certify(Problem::load(scene)?, &Condensed::default(), &Options::default())?;
            let free = certified.bracket.free.as_ref().map_err(Clone::clone)?;
            let triangles = certified.problem.mesh.triangles.len();
            points.push([n as f64, certified.bracket.relative_error(free.upper())]);
            curves.push(serde_json::json!({
                "normals": normals, "facets": n, "triangles": triangles,
                "lower": certified.bracket.lower(), "upper": free.upper(),
            }));
        }
        series.push(Series {
            label: normals.to_string(),
            ink,
            secondary: false,
            points,
            spread: Vec::new(),
            open: Vec::new(),
        });
    }
    let svg = draw(&Sheet {
        title: "A disc pressed into its bore".to_string(),
        labels: ["facets all round, elements shrinking with them".to_string(), "guaranteed relative error".to_string()],
        x: Scale::Logarithmic,
        series,
        front: Vec::new(),
        level: None,
        notes: Vec::new(),
        size: [1040, 560],
    })?;
    std::fs::write(root.join("docs/figures/bore.svg"), svg)?;
    std::fs::write(root.join("docs/data/bore.json"), format!("{:#}\n", serde_json::Value::from(curves)))?;
    Ok(())
}
