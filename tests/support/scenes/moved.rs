//! Two blocks on each other whose supports move: clamped boundaries by an affine displacement, rollers along any direction.

use super::super::random::Random;
use super::super::toml::Toml;
use super::Made;

/// A clamped boundary with a displacement of a size, its gradient included.
fn clamped(random: &mut Random, on: &str, size: f64) -> String {
    let mut part = |factor: f64| factor * size * random.between(-1.0, 1.0);
    let (value, rows) = ([part(1.0), part(1.0)], [[part(0.3), part(0.3)], [part(0.3), part(0.3)]]);
    format!(
        "[[supports]]\non = \"{on}\"\ntype = \"clamped\"\ndisplacement = {{ value = {value:?}, gradient = {rows:?} }}"
    )
}

/// Rollers that hold a component within a right angle, almost, of `normal`, which they move by some.
fn roller(random: &mut Random, on: &str, normal: f64, size: f64) -> String {
    let angle = normal + if random.chance(0.3) { 0.0 } else { random.between(-1.4, 1.4) };
    let moved = if random.chance(0.3) { 0.0 } else { size * random.between(-1.0, 1.0) };
    let direction = [angle.cos(), angle.sin()];
    format!("[[supports]]\non = \"{on}\"\ntype = \"roller\"\ndirection = {direction:?}\ndisplacement = {moved:?}")
}

/// The scene.
pub fn moved(random: &mut Random) -> Made {
    let young = random.magnitude(-2.0, 3.0);
    let strain = random.magnitude(-5.0, -2.0);
    let turned = random.between(0.0, std::f64::consts::TAU);
    let turn = |[x, y]: [f64; 2]| {
        let (sin, cos) = turned.sin_cos();
        [x * cos - y * sin, x * sin + y * cos]
    };
    let mut jitter = |p: [f64; 2]| turn([p[0] + random.between(-0.1, 0.1), p[1] + random.between(-0.1, 0.1)]);
    let lower = [jitter([0.0, 0.0]), jitter([2.0, 0.0]), turn([2.0, 1.0]), turn([0.0, 1.0])];
    let upper = [turn([0.0, 1.0]), turn([2.0, 1.0]), jitter([1.6, 1.7]), jitter([0.3, 1.8])];
    let up = turned + std::f64::consts::FRAC_PI_2;
    let size = random.between(0.25, 0.8);
    let mut toml = Toml::default()
        .model(random.pick(&["plane-strain", "plane-stress"]), 1.0)
        .size(size)
        .polygon("lower", &lower, ["foot", "", "face", "side"])
        .polygon("upper", &upper, ["sole", "", "top", ""])
        .material("lower", young, random.between(-0.2, 0.49))
        .material("upper", young * random.magnitude(-1.0, 1.0), random.between(0.0, 0.45));
    toml = match random.below(3) {
        0 => toml.table(&roller(random, "foot", up, strain)),
        _ => toml.table(&clamped(random, "foot", strain)),
    };
    toml = match random.below(4) {
        0 => toml.table(&clamped(random, "top", strain)),
        1 => toml.table(&format!("[[tractions]]\non = \"top\"\npressure = {:?}", young * strain)),
        _ => toml.table(&roller(random, "top", up, strain)),
    };
    if random.chance(0.25) {
        let load = turn([young * strain * random.between(-1.0, 1.0), 0.0]);
        toml = toml.table(&format!("[[tractions]]\non = \"side\"\nvalue = {load:?}"));
    }
    let gap = if random.chance(0.6) { 0.0 } else { strain * random.between(0.0, 0.5) };
    toml = toml.table(&format!("[[contacts]]\nbetween = [\"face\", \"sole\"]\ngap = {gap:?}"));
    Made { toml, mesh: None, energy: 100.0 * young * strain * strain, rounds: false }
}
