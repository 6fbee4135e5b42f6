//! Conditions on the sides of a lattice of bodies.

use super::frame::Frame;
use super::layout::{Facing, Layout, Side};
use crate::support::random::Random;

/// How bodies are held and loaded.
#[derive(Clone, Copy, PartialEq)]
pub enum Manner {
    /// Most bodies have a support.
    Held,
    /// Those at the bottom stand on something, the others on them, and loads press down.
    Seated,
    /// Anything anywhere.
    Loose,
    /// No load but what is moved, large gaps.
    Border,
}

/// The condition on a side.
#[derive(Clone, Copy, PartialEq)]
pub enum Condition {
    Free,
    Clamped,
    Roller,
    Loaded,
    /// Against a rigid obstacle, or the body across.
    Contact,
}

use Condition::{Clamped, Contact, Free, Loaded, Roller};

/// True if two sides are the two of one interface.
pub fn meet(layout: &Layout, one: &Side, other: &Side) -> bool {
    let [a, b] = layout.ends(one.pieces[0]);
    other.across == Some(one.body) && other.pieces.iter().any(|p| layout.ends(*p) == [b, a])
}

/// A condition for every side; the two of an interface have the same.
pub fn conditions(random: &mut Random, layout: &Layout, sides: &[Side], manner: Manner) -> Vec<Condition> {
    let mut conditions: Vec<Condition> = Vec::with_capacity(sides.len());
    for side in sides {
        let condition = match (side.across, manner) {
            (Some(other), _) if other < side.body => {
                let k = sides.iter().position(|s| s.body == other && meet(layout, s, side)).expect("the other side");
                conditions[k]
            }
            // Now and then nothing keeps two bodies from passing through each other.
            (Some(_), _) => {
                if random.chance(0.95) {
                    Contact
                } else {
                    Free
                }
            }
            (None, Manner::Held) => random.pick(&[Free, Free, Free, Loaded, Loaded, Roller, Contact]),
            (None, Manner::Loose) => random.pick(&[Free, Free, Loaded, Clamped, Roller, Contact]),
            (None, Manner::Border) => random.pick(&[Free, Free, Free, Clamped, Roller, Contact]),
            (None, Manner::Seated) => match side.facing {
                Facing::South => random.pick(&[Clamped, Roller, Contact, Contact]),
                Facing::North => random.pick(&[Free, Loaded, Loaded]),
                _ => random.pick(&[Free, Free, Free, Free, Roller, Contact]),
            },
        };
        conditions.push(condition);
    }
    if manner == Manner::Held {
        for body in 0..layout.bodies {
            let outer: Vec<usize> =
                (0..sides.len()).filter(|&k| sides[k].body == body && sides[k].across.is_none()).collect();
            if !outer.is_empty() && random.chance(0.75) {
                conditions[random.pick(&outer)] = Clamped;
            }
        }
    }
    conditions
}

/// The displacement of the clamped sides of each body, before the scene is turned: zero wherever it would contradict
/// another condition at a corner.
pub fn displacements(
    random: &mut Random,
    frame: &Frame,
    layout: &Layout,
    (sides, conditions): (&[Side], &[Condition]),
    general: bool,
    manner: Manner,
) -> Vec<[f64; 2]> {
    let often = if manner == Manner::Border { 0.6 } else { 0.3 };
    let mut moved: Vec<[f64; 2]> = (0..layout.bodies)
        .map(|_| {
            let shift = frame.shift(random) * random.pick(&[1.0, -1.0]);
            match random.chance(often) {
                true => random.pick(&[[shift, 0.0], [0.0, shift], [0.6 * shift, -0.8 * shift]]),
                false => [0.0; 2],
            }
        })
        .collect();
    // Points that the supports of a body prescribe.
    let held = |body: usize, kind: &[Condition]| -> Vec<usize> {
        let of = |k: &usize| sides[*k].body == body && kind.contains(&conditions[*k]);
        (0..sides.len()).filter(of).flat_map(|k| layout.corners(&sides[k])).collect()
    };
    for (body, moved) in moved.iter_mut().enumerate() {
        let clamped = held(body, &[Clamped]);
        let contradicts = |k: usize| {
            let side = &sides[k];
            if side.body != body || !layout.corners(side).iter().any(|p| clamped.contains(p)) {
                return false;
            }
            let along = match side.facing {
                Facing::South | Facing::North => moved[1] == 0.0,
                Facing::East | Facing::West => moved[0] == 0.0,
            };
            match (conditions[k], side.across) {
                (Roller | Contact, None) => general || !along,
                (Contact, Some(other)) => {
                    let theirs = held(other, &[Clamped, Roller, Contact]);
                    layout.corners(side).iter().any(|p| clamped.contains(p) && theirs.contains(p))
                }
                _ => false,
            }
        };
        if (0..sides.len()).any(contradicts) {
            *moved = [0.0; 2];
        }
    }
    moved
}
