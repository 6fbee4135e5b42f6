//! How wide guaranteed intervals of quantities are: mesh by mesh on the two blocks, and on random scenes against far finer
//! meshes. Writes `docs/data/quantities.json` and prints the tables of `docs/quantities.md`.
//!
//! `cargo run --release --example quantity_widths -- 200`, with the number of random scenes

#[path = "../tests/support/mod.rs"]
mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::{Component, Extent, Gap, Kinematics, Quantity, Region, Scene, Target};
use hypercircle::study::{Answer, Certified, answers, certify_divided};
use serde_json::{Value, json};
use support::Blocks;
use support::random::Random;
use support::scenes::sample;

const COMMAND: &str = "cargo run --release --example quantity_widths";

/// Meshes of random scenes are refined until one has more triangles than this.
const FINE: usize = 2500;

fn main() -> std::io::Result<()> {
    let scenes: usize = std::env::args().nth(1).map_or(Ok(40), |n| n.parse()).expect("a number of scenes");
    let blocks = two_blocks();
    let mistakes = mistakes();
    let kinds = random_scenes(scenes);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/data/quantities.json");
    let data =
        json!({ "command": COMMAND, "two_blocks": blocks, "mistakes": mistakes, "scenes": scenes, "kinds": kinds });
    std::fs::write(&file, format!("{data:#}\n"))?;
    println!("wrote docs/data/quantities.json");
    Ok(())
}

fn quantity(name: &str, target: Target) -> Quantity {
    Quantity { name: name.to_string(), target }
}

fn of_degree(degree: usize) -> Options {
    Options { keep_factor: true, elements: Elements::Uniform(block(degree)), ..Options::default() }
}

/// What the two blocks are asked.
fn asked(problem: &mut Problem) {
    let of = Extent::Boundary("left_west".to_string());
    let square = vec![[0.25, 0.25], [0.75, 0.25], [0.75, 0.75], [0.25, 0.75]];
    let window = Some([0.125, 0.25, 0.375, 0.5]);
    let (region, component) = (Region::Polygon(square), Component([1.0, 0.0, 0.0]));
    problem.scene.quantities = vec![
        quantity("displacement", Target::Displacement { of, direction: [1.0, 0.0] }),
        quantity("force", Target::ContactForce { contact: 0, window }),
        quantity("stress", Target::Stress { body: 0, region, component }),
    ];
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

/// Half-width over the distance of the value from that of the finest mesh, by kind.
fn random_scenes(wanted: usize) -> Vec<Value> {
    let mut found: BTreeMap<&'static str, Vec<f64>> = BTreeMap::new();
    let (mut met, mut open, mut outside, mut seed) = (0, 0, 0, 20_000);
    while met < wanted {
        seed += 1;
        let folder = tempfile::tempdir().expect("a folder");
        let Ok(scene) = Scene::read(&sample(seed).write(folder.path())) else { continue };
        let Ok(mut problem) = Problem::load(scene) else { continue };
        if problem.contact_turns() || problem.mesh.triangles.len() > FINE / 4 {
            continue;
        }
        let mut random = Random::new(seed);
        let angle = random.between(0.0, 6.3);
        let direction = [angle.cos(), angle.sin()];
        let component = Component::along(direction);
        problem.scene.quantities =
            vec![quantity("displacement", Target::Displacement { of: Extent::Body(0), direction })];
        problem.scene.quantities.push(match problem.interfaces.first().map_or(0, |i| i.pairs.len()) {
            0..4 => quantity("force", Target::SupportForce { support: 0, direction }),
            count => {
                let window = [0, 1, 2, 3].map(|i| problem.interfaces[0].pairs[i * count / 4].arc[0]);
                quantity("weighted force", Target::ContactForce { contact: 0, window: Some(window) })
            }
        });
        problem.scene.quantities.push(quantity("stress", Target::Stress { body: 0, region: Region::Whole, component }));
        let options = of_degree(1);
        let solve = |problem: Problem| -> Option<(Certified, Vec<Answer>)> {
            let certified = certify_divided(problem, &Condensed::default(), &options).ok()?;
            let found = answers(&certified, &options, |_| true);
            Some((certified, found))
        };
        let Some((coarse, first)) = solve(problem) else { continue };
        let mut last = first.clone();
        let mut finer = coarse;
        while finer.problem.mesh.triangles.len() <= FINE {
            let next = finer.problem.refine_uniform(1).expect("a finer mesh");
            let Some((certified, found)) = solve(next) else { break };
            (finer, last) = (certified, found);
        }
        met += 1;
        for (coarse, fine) in first.iter().zip(&last) {
            let ([low, high], [least, most]) = (coarse.interval.ends, fine.interval.ends);
            if !(high - low).is_finite() || !(most - least).is_finite() {
                open += 1;
                continue;
            }
            outside += usize::from(low > most || least > high);
            let (width, error) = (0.5 * (high - low), (coarse.interval.value - fine.interval.value).abs());
            let known = 0.5 * (most - least);
            // What is exact, or not known far better on the finest mesh, has no error to compare with.
            if known < 0.25 * width && error > 4.0 * known && width > 1e-9 * coarse.interval.value.abs() {
                found.entry(coarse.kind).or_default().push(width / error);
            }
        }
    }
    println!(
        "\n{met} random scenes, {open} quantities without an end, {outside} intervals that contradict a finer one\n"
    );
    println!("| kind | compared | least | median | nine tenths below |");
    println!("|---|--:|--:|--:|--:|");
    let mut rows = Vec::new();
    for (kind, mut list) in found {
        list.sort_by(f64::total_cmp);
        let at = |part: f64| list[((list.len() - 1) as f64 * part).round() as usize];
        println!("| {kind} | {} | {:.1} | {:.1} | {:.0} |", list.len(), at(0.0), at(0.5), at(0.9));
        rows.push(json!({ "kind": kind, "compared": list.len(), "least": at(0.0), "median": at(0.5), "nine_tenths": at(0.9) }));
    }
    rows.push(json!({ "open": open, "outside": outside }));
    rows
}
