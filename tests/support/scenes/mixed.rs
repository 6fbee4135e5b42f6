//! Every law of part two in one scene: a pile of bodies on springs or a clamp, with contact, elastic contact, bonds of unlike meshes and
//! elastic layers between them, cracks inside them, any material, heated, and loaded as they like.

use super::super::random::Random;
use super::super::toml::Toml;
use super::{Made, matter, stack};

/// Largest initial strain.
const STRAIN: f64 = 0.02;

/// Two to four bodies on top of each other.
pub fn mixed(random: &mut Random) -> Made {
    let bodies = 2 + random.below(3);
    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    let mut toml = Toml::default().model(kinematics, random.pick(&[1.0, 1.0, 0.4])).size(random.between(0.35, 0.7));
    let mut ends = [[0.0, 0.0], [random.between(1.0, 2.0), random.between(-0.1, 0.1)]];
    for k in 0..bodies {
        let name = ["first", "second", "third", "fourth"][k];
        let up = |random: &mut Random, [x, y]: [f64; 2]| [x + random.between(-0.1, 0.1), y + random.between(0.5, 0.9)];
        let above = [up(random, ends[0]), up(random, ends[1])];
        toml = body(toml, random, name, [ends, above]);
        let foot = format!("{name}_foot");
        toml = match k {
            0 => ground(toml, random, &foot),
            _ => between(toml, random, &format!("{}_head", ["first", "second", "third"][k - 1]), &foot),
        };
        toml = wall(toml, random, &format!("{name}_west"));
        ends = above;
    }
    let head = format!("{}_head", ["first", "second", "third", "fourth"][bodies - 1]);
    let value = [random.between(-0.1, 0.1), -random.between(0.2, 0.8)];
    let toml = match random.below(3) {
        0 => toml.pressure(&head, random.between(0.2, 0.8)),
        1 => toml.traction(&head, value),
        _ => {
            let slope = random.between(-0.3, 0.3);
            toml.table(&format!(
                "[[tractions]]\non = \"{head}\"\nvalue = {value:?}\ngradient = [[0.0, 0.0], [{slope:?}, 0.0]]"
            ))
        }
    };
    Made { toml, mesh: None, energy: STRAIN * STRAIN, rounds: false }
}

fn part(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

/// A body between two slanted lines, which may have a crack, and vertices of its own along its foot.
fn body(toml: Toml, random: &mut Random, name: &str, [[a, b], [d, c]]: [[[f64; 2]; 2]; 2]) -> Toml {
    let of = |side: &str| format!("{name}_{side}");
    let [foot, east, head, west] = ["foot", "east", "head", "west"].map(of);
    let along = part(a, b, random.between(0.2, 0.8));
    let toml = if random.chance(0.3) {
        // Two polygons that are one body where their common line has no name.
        let (p, q) = (part(a, d, 0.5), part(b, c, 0.5));
        let (s, t) = (part(p, q, random.between(0.2, 0.4)), part(p, q, random.between(0.6, 0.8)));
        let [low, high] = ["low", "high"].map(of);
        toml.outline(name, &[a, along, b, q, t, s, p], &[&foot, &foot, &east, "", &low, "", &west])
            .outline(name, &[p, s, t, q, c, d], &["", &high, "", &east, &head, &west])
            .table(&format!("[[contacts]]\nbetween = [\"{low}\", \"{high}\"]{}", law(random)))
    } else {
        toml.outline(name, &[a, along, b, c, d], &[&foot, &foot, &east, &head, &west])
    };
    let young = random.magnitude(-0.5, 0.5);
    let poisson = if random.chance(0.15) { 0.4999 } else { random.between(0.0, 0.45) };
    let keys = match random.below(3) {
        0 => format!("young = {young:?}\npoisson = {poisson:?}"),
        _ => matter::keys(random, (young, poisson.min(0.4)), STRAIN, 2.0),
    };
    let force = match random.below(3) {
        0 => "body_force = [0.0, 0.0]".to_string(),
        1 => format!("body_force = [0.0, {:?}]", -random.between(0.05, 0.3)),
        _ => stack::varying(random),
    };
    toml.matter(name, &keys).loaded(name, &force)
}

/// The keys of a contact besides its sides.
fn law(random: &mut Random) -> String {
    match random.below(3) {
        0 => String::new(),
        1 => format!("\nstiffness = {:?}", random.magnitude(-1.0, 1.0)),
        _ => format!("\nstiffness = {:?}", random.magnitude(-2.0, 5.0)),
    }
}

fn stiffness(random: &mut Random) -> f64 {
    if random.chance(0.2) { random.magnitude(-3.0, 6.0) } else { random.magnitude(-0.5, 1.5) }
}

fn ground(toml: Toml, random: &mut Random, foot: &str) -> Toml {
    match random.below(3) {
        0 => toml.clamp(foot),
        1 => {
            let both = [stiffness(random), stiffness(random)];
            toml.table(&format!("[[supports]]\non = \"{foot}\"\ntype = \"spring\"\nstiffness = {both:?}"))
        }
        _ => toml
            .table(&format!("[[supports]]\non = \"{foot}\"\ntype = \"spring\"\nstiffness = {:?}", stiffness(random))),
    }
}

fn between(toml: Toml, random: &mut Random, below: &str, foot: &str) -> Toml {
    let sides = format!("between = [\"{below}\", \"{foot}\"]");
    match random.below(4) {
        0 => toml.table(&format!("[[bonds]]\n{sides}")),
        1 => {
            let both = [stiffness(random), stiffness(random)];
            toml.table(&format!("[[bonds]]\n{sides}\nstiffness = {both:?}"))
        }
        _ => {
            let gap = match random.below(3) {
                0 => "0.0".to_string(),
                1 => format!("{:?}", random.between(0.0, 0.05)),
                _ => format!("[[0.0, {:?}], [2.5, {:?}]]", random.between(0.0, 0.1), random.between(0.0, 0.1)),
            };
            toml.table(&format!("[[contacts]]\n{sides}\ngap = {gap}{}", law(random)))
        }
    }
}

fn wall(toml: Toml, random: &mut Random, west: &str) -> Toml {
    match random.below(5) {
        0 => toml.roller(west),
        1 => {
            toml.table(&format!("[[contacts]]\non = \"{west}\"\ngap = {:?}{}", random.between(0.0, 0.02), law(random)))
        }
        2 => {
            let both = [stiffness(random), 0.0];
            toml.table(&format!("[[supports]]\non = \"{west}\"\ntype = \"spring\"\nstiffness = {both:?}"))
        }
        3 => toml.clamp(west),
        _ => toml,
    }
}
