//! Guaranteed intervals of three quantities on the two blocks, mesh by mesh.
use std::time::Instant;

use hypercircle::bounds::Bracket;
use hypercircle::dual::{self, Condensed, Factorised, Motion, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::quantity::{Functional, Known};
use hypercircle::scene::Scene;

const QUANTITIES: &str = r#"
[[quantities]]
name = "tip"
displacement = "left_load"
direction = [1, 0]
[[quantities]]
name = "seat"
force = "left_face|right_face"
window = [0.125, 0.25, 0.375, 0.5]
[[quantities]]
name = "core"
stress = "left"
box = [[0.25, 0.25], [0.75, 0.75]]
component = "xx"
[[quantities]]
name = "whole"
force = "left_face|right_face"
[[quantities]]
name = "wall"
force = "wall"
direction = [1, 0]
"#;

fn main() {
    let text = std::fs::read_to_string("cases/two_blocks.toml").unwrap() + QUANTITIES;
    let degree: usize = std::env::args().nth(1).map_or(1, |a| a.parse().unwrap());
    for n in [4, 8, 16, 32] {
        let text = regex_size(&text, 1.0 / n as f64);
        let scene = Scene::parse(&text, "cases/two_blocks.toml".as_ref()).unwrap();
        let problem = Problem::load(scene).unwrap();
        let options = Options { keep_factor: true, elements: Elements::Uniform(block(degree)), ..Options::default() };
        let motions: Vec<Motion> = Vec::new();
        let start = Instant::now();
        let solution = dual::solve(&Condensed::default(), &problem, &motions, &options).unwrap();
        let a = start.elapsed().as_secs_f64();
        let bracket = Bracket::new(&problem, &solution);
        let b = start.elapsed().as_secs_f64();
        println!("{n}: {} triangles, solve {a:.2} s, bracket {:.2} s", problem.mesh.triangles.len(), b - a);
        let upper = bracket.free.as_ref().unwrap();
        let factorised: &Factorised = solution.factorised.as_deref().unwrap();
        let known = Known::new(&problem, &solution, &bracket, upper, factorised, &options).unwrap();
        for quantity in &problem.scene.quantities {
            let functional = Functional::new(&problem, quantity).unwrap();
            let start = Instant::now();
            let i = known.interval(&functional);
            println!(
                "   {} {:.9} [{:.9}, {:.9}] ± {:.2e} first {:.2e} exact {} {:?} {:.2} s",
                quantity.name,
                i.value,
                i.ends[0],
                i.ends[1],
                i.half_width(),
                0.5 * (i.first_order[1] - i.first_order[0]),
                i.exact_by_statics,
                i.reasons,
                start.elapsed().as_secs_f64()
            );
        }
    }
}

fn regex_size(text: &str, size: f64) -> String {
    text.lines()
        .map(|l| if l.starts_with("size") { format!("size = {size}") } else { l.to_string() })
        .collect::<Vec<_>>()
        .join("\n")
}
