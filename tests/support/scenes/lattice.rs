//! Bodies on a lattice, with supports, loads and contacts of every kind, meshed by the program or in a mesh file.

use super::Made;
use super::conditions::{Condition, Manner, conditions, displacements, meet};
use super::frame::{Frame, gap, load};
use super::layout::{Layout, Side};
use super::msh::{self, Cells};
use crate::support::random::Random;
use crate::support::toml::Toml;

use Condition::{Clamped, Contact, Free, Loaded, Roller};

/// Rectangular blocks.
pub fn blocks(random: &mut Random) -> Made {
    scene(random, false)
}

/// Four to six blocks or polygons on a full lattice.
pub fn crowd(random: &mut Random) -> Made {
    let general = random.chance(0.5);
    let (aside, frame) = (random.aside(), Frame::random(random));
    let layout = Layout::crowded(random);
    complete(random, aside, frame, layout, Drawn { general, sheared: false, cells: None })
}

/// Blocks in a mesh file with quadrilaterals: rectangles, other parallelograms, distorted ones, or triangles beside them.
pub fn quadrilaterals(random: &mut Random) -> Made {
    let cells = random.pick(&[Cells::Quadrilaterals, Cells::Quadrilaterals, Cells::Distorted, Cells::Mixed]);
    let (general, sheared) = random.pick(&[(false, false), (true, false), (true, true)]);
    let (aside, frame) = (random.aside(), Frame::random(random));
    let layout = Layout::random(random, general);
    complete(random, aside, frame, layout, Drawn { general, sheared, cells: Some(cells) })
}

/// How a lattice is drawn.
#[derive(Clone, Copy)]
struct Drawn {
    /// Its sides need not be at right angles.
    general: bool,
    /// Its cells are parallelograms all the same.
    sheared: bool,
    /// The cells of a mesh file, where there has to be one.
    cells: Option<Cells>,
}

/// Polygons: a lattice with displaced points, bodies of several cells that need not be convex.
pub fn shapes(random: &mut Random) -> Made {
    scene(random, true)
}

/// Blocks or polygons, with the size of their tractions and of the scene.
pub fn loaded(random: &mut Random) -> (Made, f64, f64) {
    let aside = random.aside();
    let frame = Frame::random(random);
    let (traction, length) = (frame.young * frame.load, frame.length);
    let general = random.chance(0.4);
    let layout = Layout::random(random, general);
    (complete(random, aside, frame, layout, Drawn { general, sheared: false, cells: None }), traction, length)
}

/// Bodies of any material, some of them warm or with initial stress.
pub fn matter(random: &mut Random) -> Made {
    let aside = random.aside();
    let frame = Frame::random(random);
    let (length, strain) = (frame.length, frame.load);
    let general = random.chance(0.4);
    let layout = Layout::random(random, general);
    let made = complete(random, aside, frame, layout, Drawn { general, sheared: false, cells: None });
    let bodies = made.toml.bodies();
    let keys = |toml: Toml, (name, constants): (String, (f64, f64))| {
        let keys = super::matter::keys(random, constants, strain, length);
        toml.matter(&name, &keys)
    };
    let toml = bodies.into_iter().fold(made.toml.clone(), keys);
    Made { toml, ..made }
}

fn lines(random: &mut Random, n: usize, equal: bool) -> Vec<f64> {
    let mut at = vec![0.0];
    for k in 0..n {
        at.push(at[k] + if equal { 1.0 } else { random.between(0.4, 1.8) });
    }
    at
}

fn scene(random: &mut Random, general: bool) -> Made {
    let aside = random.aside();
    let frame = Frame::random(random);
    let grown = general || random.chance(0.15);
    let layout = Layout::random(random, grown);
    complete(random, aside, frame, layout, Drawn { general, sheared: false, cells: None })
}

fn complete(random: &mut Random, mut aside: Random, frame: Frame, mut layout: Layout, drawn: Drawn) -> Made {
    let Drawn { general, sheared, cells } = drawn;
    let equal = random.chance(0.4);
    let (x, y) = (lines(random, layout.columns(), equal), lines(random, layout.rows(), equal));
    layout.lines(&x, &y);
    if sheared {
        let [right, up] = [random.between(-0.4, 0.4), random.between(-0.3, 0.3)];
        layout.points.iter_mut().for_each(|p| *p = [p[0] + right * p[1], p[1] + up * p[0]]);
    } else if general {
        let shake = random.between(0.02, 0.16);
        for p in &mut layout.points {
            *p = p.map(|x| x + shake * random.between(-1.0, 1.0));
        }
    }
    let manner = match random.below(20) {
        0..=7 => Manner::Held,
        8..=13 => Manner::Seated,
        14..=16 => Manner::Loose,
        _ => Manner::Border,
    };
    let sides = layout.sides(general && random.chance(0.3));
    let mut conditions = conditions(random, &layout, &sides, manner);
    let meshed = aside.chance(0.25) || cells.is_some();
    let bonded = meshed && bond(&mut aside, &layout, &sides, &mut conditions);
    let mut moved = displacements(random, &frame, &layout, (&sides, &conditions), general, manner);
    if bonded {
        // What one of the bonded bodies is moved by, the others would have to be moved by as well.
        moved.fill([0.0; 2]);
    }
    let place = |p: [f64; 2]| frame.turned(p).map(|x| x * frame.length);

    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    let thickness = if random.chance(0.6) { 1.0 } else { random.magnitude(-2.0, 1.0) };
    let mut toml = Toml::default().model(kinematics, thickness);
    if random.chance(0.85) {
        toml = toml.size(frame.length * random.between(0.18, 0.7));
    }
    let mut stiffest = 0.0_f64;
    for body in 0..layout.bodies {
        for outline in layout.outlines(body, random.chance(0.7)) {
            let points: Vec<_> = outline.iter().map(|p| place(layout.points[layout.ends(*p)[0]])).collect();
            let of = |piece| sides.iter().position(|s| s.body == body && s.pieces.contains(piece));
            let names: Vec<String> = outline.iter().map(|p| of(p).map_or(String::new(), |k| name(&sides, k))).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            toml = toml.outline(&format!("b{body}"), &points, &names);
        }
        let young =
            frame.young * if random.chance(0.8) { random.magnitude(-1.0, 1.0) } else { random.magnitude(-2.5, 2.5) };
        let poisson = match random.below(8) {
            0 => 0.0,
            1 => 0.4999,
            2 => random.between(-0.4, 0.0),
            3 => 0.3,
            _ => random.between(0.0, 0.47),
        };
        let weight = match manner {
            Manner::Border => 0.0,
            _ if random.chance(0.4) => frame.traction(random) / frame.length,
            _ => 0.0,
        };
        let force = frame.turned([if manner == Manner::Loose { 0.3 * weight } else { 0.0 }, -weight]);
        stiffest = stiffest.max(young);
        toml = toml.material(&format!("b{body}"), young, poisson).force(&format!("b{body}"), force);
    }
    toml = tables(toml, random, &frame, &layout, (&sides, &conditions, &moved), manner);
    let mesh = meshed.then(|| {
        let size = 1 + aside.below(4);
        msh::text(
            &layout,
            (size, cells.unwrap_or(Cells::Triangles)),
            place,
            |body| format!("b{body}"),
            &sides,
            |k| name(&sides, k),
        )
    });
    let farthest = moved.iter().flatten().fold(frame.load * frame.length, |m, u| m.max(u.abs()));
    Made { toml, mesh, energy: thickness * stiffest * farthest * farthest, rounds: false }
}

/// The name of a side.
fn name(sides: &[Side], k: usize) -> String {
    let side = &sides[k];
    match (side.across, side.facing) {
        (Some(other), _) => format!("b{}_to_b{other}_{k}", side.body),
        (None, facing) => format!("b{}_{}_{k}", side.body, format!("{facing:?}").to_lowercase()),
    }
}

/// Leaves some interfaces without contact, which in a mesh of common vertices bonds the bodies; whether there are any.
fn bond(random: &mut Random, layout: &Layout, sides: &[Side], conditions: &mut [Condition]) -> bool {
    let often = random.pick(&[0.0, 0.5, 1.0]);
    for k in 0..sides.len() {
        if sides[k].across.is_some_and(|other| sides[k].body < other) && random.chance(often) {
            conditions[k] = Free;
            let other = sides.iter().position(|s| meet(layout, s, &sides[k])).expect("the other side");
            conditions[other] = Free;
        }
    }
    sides.iter().zip(conditions).any(|(side, condition)| side.across.is_some() && *condition == Free)
}

/// Supports, tractions and contacts.
fn tables(
    mut toml: Toml,
    random: &mut Random,
    frame: &Frame,
    layout: &Layout,
    (sides, conditions, moved): (&[Side], &[Condition], &[[f64; 2]]),
    manner: Manner,
) -> Toml {
    for (k, (side, condition)) in sides.iter().zip(conditions).enumerate() {
        let on = name(sides, k);
        toml = match (condition, side.across) {
            (Free, _) => toml,
            (Clamped, _) => toml.table(&format!(
                "[[supports]]\non = \"{on}\"\ntype = \"clamped\"\ndisplacement = {:?}",
                frame.turned(moved[side.body])
            )),
            (Roller, _) => toml.roller(&on),
            (Loaded, _) => toml.table(&format!("[[tractions]]\non = \"{on}\"\n{}", load(random, frame, manner))),
            (Contact, None) => {
                toml.table(&format!("[[contacts]]\non = \"{on}\"\ngap = {}", gap(random, frame, layout, side, manner)))
            }
            (Contact, Some(other)) if side.body < other => {
                let facing =
                    sides.iter().position(|s| s.body == other && meet(layout, s, side)).expect("the other side");
                let gap = gap(random, frame, layout, side, manner);
                toml.table(&format!("[[contacts]]\nbetween = [\"{on}\", \"{}\"]\ngap = {gap}", name(sides, facing)))
            }
            (Contact, Some(_)) => toml,
        };
    }
    toml
}
