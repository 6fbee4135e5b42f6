//! How wide guaranteed intervals of quantities are on the two blocks, mesh by mesh, and what mistakes change. Writes
//! `docs/data/quantities.json` and prints the tables of `docs/quantities.md`.
//!
//! `cargo run --release --example quantity_widths`

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::Path;
use std::time::Instant;

use hypercircle::dual::Condensed;
use hypercircle::problem::Problem;
use hypercircle::scene::{Component, Extent, Gap, Kinematics, Region, Target};
use hypercircle::study::{answers, certify_divided};
use serde_json::{Value, json};
use support::Blocks;
use support::asked::{ask, of_degree, quantity};

const COMMAND: &str = "cargo run --release --example quantity_widths";

fn main() -> std::io::Result<()> {
    let blocks = two_blocks();
    let mistakes = mistakes();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/data/quantities.json");
    let data = json!({ "command": COMMAND, "two_blocks": blocks, "mistakes": mistakes });
    std::fs::write(&file, format!("{data:#}\n"))?;
    println!("wrote docs/data/quantities.json");
    Ok(())
}

/// Asks the two blocks for a displacement, a force and a stress.
fn asked(problem: &mut Problem) {
    let of = Extent::Boundary("left_west".to_string());
    let square = vec![[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]];
    let window = Some([0.125, 0.25, 0.375, 0.5]);
    let (region, component) = (Region::Polygon(square), Component::XX);
    let quantities = vec![
        quantity("displacement", Target::Displacement { of, direction: [1.0, 0.0] }),
        quantity("force", Target::ContactForce { contact: 0, tangential: false, window }),
        quantity("stress", Target::Stress { body: 0, region, component }),
    ];
    ask(problem, quantities);
}

/// By how much mistakes change what the two blocks are asked: an interval of less than half of that tells them.
fn mistakes() -> Vec<Value> {
    let values = |blocks: Blocks| {
        let mut problem = Blocks { n: 32, ..blocks }.problem();
        asked(&mut problem);
        let options = of_degree(2);
        let certified = certify_divided(problem, &Condensed::default(), &options).expect("an answer");
        answers(&certified, &options, |_| true).iter().map(|answer| answer.interval.value).collect::<Vec<f64>>()
    };
    let right = values(Blocks::default());
    let both = |young, poisson| [(young, poisson); 2];
    let list = [
        ("E of both bodies 5 % too large", Blocks { materials: both(1.05, 0.3), ..Blocks::default() }),
        ("E of the left body 5 % too large", Blocks { materials: [(1.05, 0.3), (1.0, 0.3)], ..Blocks::default() }),
        ("ν = 0.35 in the left body", Blocks { materials: [(1.0, 0.35), (1.0, 0.3)], ..Blocks::default() }),
        ("load 1 % too large", Blocks { load: (4.04, -7.07), ..Blocks::default() }),
        ("plane stress for plane strain", Blocks { kinematics: Kinematics::PlaneStress, ..Blocks::default() }),
        ("a gap of 0.01 that is not there", Blocks { gap: Gap::Constant(0.01), ..Blocks::default() }),
    ];
    println!("\n| mistake | mean displacement | weighted force | mean stress |\n|---|--:|--:|--:|");
    let mut rows = Vec::new();
    for (name, blocks) in list {
        let changes: Vec<f64> = values(blocks).iter().zip(&right).map(|(wrong, right)| wrong / right - 1.0).collect();
        let [a, b, c] = [0, 1, 2].map(|i| format!("{:+.2} %", 100.0 * changes[i]));
        println!("| {name} | {a} | {b} | {c} |");
        rows.push(json!({ "mistake": name, "changes": changes }));
    }
    rows
}

/// Half-widths, and seconds beside those of the solve with its bracket.
fn two_blocks() -> Vec<Value> {
    println!("| degree | triangles | mean displacement | weighted force | mean stress | seconds a quantity / solve |");
    println!("|--:|--:|--:|--:|--:|--:|");
    let mut rows = Vec::new();
    for (degree, sizes) in [(1, [8, 16, 32, 64]), (2, [4, 8, 16, 32]), (3, [4, 8, 16, 32])] {
        for n in sizes {
            let mut problem = Blocks { n, ..Blocks::default() }.problem();
            asked(&mut problem);
            let start = Instant::now();
            let certified = certify_divided(problem, &Condensed::default(), &of_degree(degree)).expect("an answer");
            let solve = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let found = answers(&certified, &of_degree(degree), |_| true);
            let each = start.elapsed().as_secs_f64() / found.len() as f64;
            let widths: Vec<f64> = found.iter().map(|answer| answer.interval.half_width()).collect();
            let triangles = certified.problem.mesh.triangles.len();
            let [a, b, c] = [0, 1, 2].map(|i| format!("{:.1e}", widths[i]));
            println!("| {degree} | {triangles} | {a} | {b} | {c} | {:.2} |", each / solve);
            rows.push(json!({ "degree": degree, "triangles": triangles, "half_widths": widths, "cost": each / solve }));
        }
    }
    rows
}
