//! Bodies on top of each other with slanted faces.

use crate::support::random::Random;
use crate::support::toml::Toml;

use super::Made;

/// [`slanted`] as a family; nothing is prescribed but zero.
pub fn made(random: &mut Random) -> Made {
    Made { toml: slanted(random), mesh: None, energy: 0.0, rounds: false }
}

/// [`slanted`] with body forces that are affine, rotations among them, in some of the bodies.
pub fn heavy(random: &mut Random) -> Made {
    let mut toml = slanted(random);
    let all = random.chance(0.5);
    for body in ["base", "middle", "top"] {
        if all || random.chance(0.5) {
            toml = toml.loaded(body, &varying(random));
        }
    }
    Made { toml, mesh: None, energy: 0.0, rounds: false }
}

/// The keys of a random affine force, of a rotation about a random point, or of both.
pub fn varying(random: &mut Random) -> String {
    let mut numbers = |size: f64| [random.between(-size, size), random.between(-size, size)];
    let (value, gradient, about) = (numbers(0.4), [numbers(0.5), numbers(0.5)], numbers(2.0));
    let field = format!("body_force = {{ value = {value:?}, gradient = {gradient:?} }}");
    let turning = format!("rotation = {{ density = 0.3, omega = {:?}, about = {about:?} }}", random.between(0.3, 1.2));
    match random.below(3) {
        0 => field,
        1 => turning,
        _ => format!("{field}\n{turning}"),
    }
}

/// Two or three convex bodies on top of each other, each resting on the slanted edge of the one below.
pub fn slanted(random: &mut Random) -> Toml {
    let bodies = 2 + random.below(2);
    let mut toml = Toml::default();
    let (mut left, mut right) = ([0.0, 0.0], [random.between(1.0, 2.0), 0.0]);
    for k in 0..bodies {
        let name = ["base", "middle", "top"][k];
        let side = |which: &str| format!("{name}_{which}");
        let (foot, east, head, west) = (side("foot"), side("east"), side("head"), side("west"));
        let height = random.between(0.5, 1.5);
        let lean = random.between(-0.2, 0.2);
        let slant = random.between(-0.15, 0.15);
        let p = [right[0] + lean + random.between(-0.2, 0.1), right[1] + height + slant];
        let q = [left[0] + lean + random.between(-0.1, 0.2), left[1] + height];
        let last = k + 1 == bodies;
        let head_load = format!(
            "value = [{:?}, {:?}]\ngradient = [[{:?}, 0.0], [{:?}, 0.0]]",
            random.between(-0.3, 0.3),
            -random.between(0.5, 2.0),
            random.between(-0.2, 0.2),
            random.between(-1.0, 1.0)
        );
        toml = if last && random.below(3) == 0 {
            // A triangle, loaded on its right side.
            toml.polygon(name, &[left, right, q], [&foot, &head, &west])
        } else {
            toml.polygon(name, &[left, right, p, q], [&foot, &east, &head, &west])
        };
        let poisson = [random.between(0.0, 0.45), 0.4999][usize::from(random.below(5) == 0)];
        let young = 10f64.powf(random.between(-1.0, 1.0));
        toml = toml.material(name, young, poisson).force(name, [0.0, -random.between(0.0, 0.5)]);
        if k == 0 {
            toml = toml.clamp(&foot);
        } else {
            let gap = match random.below(3) {
                0 => random.between(0.0, 0.02).to_string(),
                1 => format!(
                    "[[0.0, {:?}], [0.4, 0.0], [9.0, {:?}]]",
                    random.between(0.0, 0.1),
                    random.between(0.0, 0.9)
                ),
                _ => "0.0".to_string(),
            };
            let below = ["base_head", "middle_head"][k - 1];
            toml = toml.table(&format!("[[contacts]]\nbetween = [\"{below}\", \"{foot}\"]\ngap = {gap}"));
            toml = match random.below(3) {
                0 => toml.roller(&west),
                1 => toml.table(&format!("[[contacts]]\non = \"{west}\"\ngap = {:?}", random.between(0.0, 0.01))),
                _ => toml.clamp(&west),
            };
        }
        if last {
            toml = toml.table(&format!("[[tractions]]\non = \"{head}\"\n{head_load}"));
        }
        (left, right) = (q, p);
    }
    toml
}
