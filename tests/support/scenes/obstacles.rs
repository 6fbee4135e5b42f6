//! One or two blocks on an obstacle that has a place of its own: a line or a circle, which moves, overlaps or stays away.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::Made;
use crate::support::random::Random;
use crate::support::toml::Toml;

/// An obstacle below the foot from (0, 0) to (2, 0), in the frame of the scene; `strain` is the size of its gaps.
fn obstacle(random: &mut Random, strain: f64, turn: impl Fn([f64; 2]) -> [f64; 2]) -> (String, bool) {
    let mut apart = || strain * random.between(-1.0, 0.5);
    let [left, right] = [apart(), apart()];
    let shift = turn([0.2 * apart(), apart()]);
    let (shape, is_round) = match random.below(5) {
        0 | 1 => {
            // The body lies on its left.
            let ends = [turn([-1.0, -left]), turn([3.0, -right])];
            (format!("{{ line = {ends:?} }}"), false)
        }
        2 | 3 => {
            let radius = random.magnitude(0.0, 2.0);
            let centre = turn([random.between(-0.5, 2.5), -radius - left]);
            (format!("{{ circle = {{ centre = {centre:?}, radius = {radius:?} }} }}"), true)
        }
        _ => {
            // Touches the ends of the foot.
            let radius = random.between(1.5, 20.0);
            let centre = turn([1.0, (radius * radius - 1.0).sqrt() - left]);
            (format!("{{ circle = {{ centre = {centre:?}, radius = {radius:?}, side = \"inside\" }} }}"), true)
        }
    };
    let moved = if random.chance(0.5) { format!("\nmove = {shift:?}") } else { String::new() };
    (format!("[[contacts]]\non = \"foot\"\nobstacle = {shape}{moved}"), is_round)
}

/// The scene.
pub fn obstacles(random: &mut Random) -> Made {
    let young = random.magnitude(-2.0, 3.0);
    let strain = random.magnitude(-5.0, -2.0);
    let turned = if random.chance(0.3) { 0.0 } else { random.between(0.0, TAU) };
    let turn = |[x, y]: [f64; 2]| {
        let (sin, cos) = turned.sin_cos();
        [x * cos - y * sin, x * sin + y * cos]
    };
    let (obstacle, is_round) = obstacle(random, strain, turn);
    let lean = random.between(-0.2, 0.2);
    // Supports end beside the foot: an obstacle that overlaps it would contradict them at a common corner.
    let lower = [[0.0, 0.0], [2.0, 0.0], [2.1, 0.3], [2.0 + lean, 1.0], [lean, 1.0], [-0.1, 0.3]].map(turn);
    let mut toml = Toml::default()
        .model(random.pick(&["plane-strain", "plane-stress"]), 1.0)
        .size(random.between(0.25, 0.6))
        .polygon("lower", &lower, ["foot", "", "east", "face", "west", ""])
        .material("lower", young, random.between(-0.2, 0.49))
        .table(&obstacle);
    let top = if random.chance(0.4) {
        let upper = [[lean, 1.0], [2.0 + lean, 1.0], [1.8, 1.7], [0.3, 1.8]].map(turn);
        let material = young * random.magnitude(-1.0, 1.0);
        let contact = "[[contacts]]\nbetween = [\"face\", \"sole\"]";
        toml =
            toml.polygon("upper", &upper, ["sole", "", "top", "side"]).material("upper", material, 0.3).table(contact);
        if random.chance(0.7) {
            toml = toml.roller("side");
        }
        "top"
    } else {
        "face"
    };
    let press = young * strain;
    let down = turned - FRAC_PI_2 + random.between(-0.2, 0.2);
    toml = match random.below(5) {
        0 => toml.clamp(top),
        1 => toml,
        _ => toml.traction(top, [press * down.cos(), press * down.sin()]),
    };
    toml = match random.below(4) {
        0 => toml.clamp("west"),
        1 => toml.roller("west"),
        2 => toml.table(&format!(
            "[[contacts]]\non = \"west\"\nobstacle = {{ line = {:?} }}",
            [turn([-0.5, 2.0]), turn([-0.5, -1.0])]
        )),
        _ => toml,
    };
    Made { toml, mesh: None, energy: 100.0 * young * strain * strain, rounds: is_round }
}
