//! Bodies of revolution: piles of one to three, solid, with a hole as narrow or as wide as one likes, or far from the axis, in contact or glued
//! to each other, with elastic contact and friction, of any material, heated, turning, and loaded all around.

use super::super::random::Random;
use super::super::toml::Toml;
use super::{Made, matter};

/// Largest initial strain.
const STRAIN: f64 = 0.02;
const NAMES: [&str; 3] = ["first", "second", "third"];

/// The scene.
pub fn turned(random: &mut Random) -> Made {
    let bodies = 1 + random.below(3);
    let inside = match random.below(6) {
        0..=2 => 0.0,
        3 => random.magnitude(-4.0, -1.0),
        4 => random.between(0.2, 1.5),
        _ => random.magnitude(1.0, 3.0),
    };
    let mut toml = Toml::default().turned().size(random.between(0.35, 0.7));
    let mut ends = [[inside, 0.0], [inside + random.between(0.8, 1.8), random.between(-0.1, 0.1)]];
    for k in 0..bodies {
        let name = NAMES[k];
        let inner = inside + inside.min(1.0) * random.between(-0.1, 0.1);
        let above = [
            [inner, ends[0][1] + random.between(0.4, 0.9)],
            [ends[1][0] + random.between(-0.1, 0.1), ends[1][1] + random.between(0.4, 0.9)],
        ];
        toml = body(toml, random, name, [ends, above], inside == 0.0);
        let foot = format!("{name}_foot");
        toml = match k {
            0 => ground(toml, random, &foot),
            _ => between(toml, random, &format!("{}_head", NAMES[k - 1]), &foot),
        };
        if inside > 0.0 {
            toml = wall(toml, random, &format!("{name}_west"));
        }
        toml = wall(toml, random, &format!("{name}_east"));
        ends = above;
    }
    let head = format!("{}_head", NAMES[bodies - 1]);
    let value = [random.between(-0.1, 0.1), -random.between(0.1, 0.5)];
    let toml = match random.below(3) {
        0 => toml.pressure(&head, random.between(0.1, 0.5)),
        1 => toml.traction(&head, value),
        _ => {
            let slope = random.between(-0.05, 0.05) / (1.0 + inside);
            toml.table(&format!(
                "[[tractions]]\non = \"{head}\"\nvalue = {value:?}\ngradient = [[{slope:?}, 0.02], [{slope:?}, 0.0]]"
            ))
        }
    };
    let toml = touching(random, &toml, ends[1][0]);
    Made { toml, mesh: None, energy: (1.0 + inside) * STRAIN * STRAIN, rounds: false }
}

/// A body between two slanted lines, with a vertex of its own along its foot.
fn body(toml: Toml, random: &mut Random, name: &str, [[a, b], [d, c]]: [[[f64; 2]; 2]; 2], solid: bool) -> Toml {
    let of = |side: &str| format!("{name}_{side}");
    let [foot, east, head, west] = ["foot", "east", "head", "west"].map(of);
    let t = random.between(0.2, 0.8);
    let along = [0, 1].map(|c| a[c] + t * (b[c] - a[c]));
    let toml = toml.outline(name, &[a, along, b, c, d], &[&foot, &foot, &east, &head, if solid { "" } else { &west }]);
    let young = random.magnitude(-0.5, 0.5);
    let poisson = if random.chance(0.15) { 0.4999 } else { random.between(0.0, 0.45) };
    let mut keys = match random.below(3) {
        0 => format!("young = {young:?}\npoisson = {poisson:?}"),
        _ => matter::moderate(random, (young, poisson.min(0.4)), STRAIN, 2.0 + b[0]),
    };
    if !keys.contains("initial_stress") && random.chance(0.2) {
        let stress = [0, 1, 2, 3].map(|_| young * STRAIN * random.between(-1.0, 1.0));
        keys += &format!("\ninitial_stress = {stress:?}");
    }
    let force = match random.below(4) {
        0 => "body_force = [0.0, 0.0]".to_string(),
        1 => format!("body_force = [0.0, {:?}]", -random.between(0.05, 0.3)),
        2 => format!("rotation = {{ density = 0.1, omega = {:?} }}", random.between(0.3, 1.2) / (1.0 + b[0])),
        _ => {
            let (value, slope) = ([random.between(-0.1, 0.1), random.between(-0.2, 0.0)], random.between(-0.1, 0.1));
            format!("body_force = {{ value = {value:?}, gradient = [[{:?}, 0.0], [0.0, 0.0]] }}", slope / (1.0 + b[0]))
        }
    };
    toml.matter(name, &keys).loaded(name, &force)
}

fn ground(toml: Toml, random: &mut Random, foot: &str) -> Toml {
    match random.below(5) {
        0 => toml.clamp(foot),
        4 => {
            let both = [random.magnitude(-0.5, 1.5), random.magnitude(-0.5, 1.5)];
            toml.table(&format!("[[supports]]\non = \"{foot}\"\ntype = \"spring\"\nstiffness = {both:?}"))
        }
        1 => toml.table(&format!("[[supports]]\non = \"{foot}\"\ntype = \"roller\"\ndirection = [0.0, 1.0]")),
        2 => toml.table(&format!("[[contacts]]\non = \"{foot}\"\ngap = {:?}", random.between(0.0, 0.02))),
        _ => toml.rigid(foot),
    }
}

fn between(toml: Toml, random: &mut Random, below: &str, foot: &str) -> Toml {
    let sides = format!("between = [\"{below}\", \"{foot}\"]");
    match random.below(8) {
        0 | 1 => return toml.table(&format!("[[bonds]]\n{sides}")),
        2 => {
            let both = [random.magnitude(-0.5, 1.5), random.magnitude(-0.5, 1.5)];
            return toml.table(&format!("[[bonds]]\n{sides}\nstiffness = {both:?}"));
        }
        _ => {}
    }
    let gap = match random.below(4) {
        0 => "0.0".to_string(),
        1 => format!("{:?}", random.between(0.0, 0.05)),
        2 => format!("{:?}", -random.between(0.0, 0.02)),
        _ => format!("[[0.0, {:?}], [2.5, {:?}]]", random.between(0.0, 0.1), random.between(0.0, 0.1)),
    };
    toml.table(&format!("[[contacts]]\n{sides}\ngap = {gap}"))
}

/// Some of the contacts elastic, some with friction, along sides that reach to about this `radius`.
fn touching(random: &mut Random, toml: &Toml, radius: f64) -> Toml {
    toml.with_each("contacts", |table| {
        let law = match random.below(6) {
            0 => format!("stiffness = {:?}", random.magnitude(-0.5, 3.0)),
            1 => format!("friction = {{ bound = {:?} }}", random.magnitude(-3.5, 0.0)),
            2 => {
                let rows = [
                    [0.0, random.magnitude(-3.0, -0.5)],
                    [0.4 * radius.min(2.0), 0.0],
                    [2.0, random.between(0.0, 0.2)],
                ];
                format!("friction = {{ bound = {rows:?} }}")
            }
            _ => return table.to_owned(),
        };
        format!("{table}\n{law}")
    })
}

fn wall(toml: Toml, random: &mut Random, side: &str) -> Toml {
    match random.below(9) {
        0 => toml.table(&format!("[[supports]]\non = \"{side}\"\ntype = \"roller\"\ndirection = [1.0, 0.0]")),
        1 => toml.table(&format!("[[contacts]]\non = \"{side}\"\ngap = {:?}", random.between(0.0, 0.02))),
        2 | 3 => toml.pressure(side, random.between(-0.1, 0.3)),
        4 => {
            let (value, slope) = ([random.between(-0.1, 0.1), random.between(-0.1, 0.1)], random.between(-0.1, 0.1));
            toml.table(&format!(
                "[[tractions]]\non = \"{side}\"\nvalue = {value:?}\ngradient = [[0.0, {slope:?}], [0.0, 0.0]]"
            ))
        }
        5 => toml.roller(side),
        6 => {
            let stiffness = random.magnitude(-1.0, 1.5);
            toml.table(&format!("[[supports]]\non = \"{side}\"\ntype = \"spring\"\nstiffness = {stiffness:?}"))
        }
        _ => toml,
    }
}
