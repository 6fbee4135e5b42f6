//! Rigid motions in words.

use super::components::{Components, RigidMotion};
use super::loads::LoadResultants;
use super::restraint::{Group, Run};
use crate::problem::{Condition, Problem};
use crate::scene::capital;

/// Displacements and jumps below this fraction of the largest displacement count as none.
const STILL: f64 = 1e-5;

/// How one piece moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionKind {
    /// Translates, with no contact or roller it would move along.
    MovesOff,
    /// Translates along its contacts and rollers without leaving them.
    Slides,
    /// Leaves a contact as a whole; turns about `centre` as well where there is one.
    LiftsOff {
        /// Centre of rotation.
        centre: Option<[f64; 2]>,
    },
    /// Turns about `centre` and leaves a contact everywhere but in a point.
    Tips {
        /// Centre of rotation.
        centre: [f64; 2],
    },
    /// Turns about `centre` without leaving a contact.
    Turns {
        /// Centre of rotation.
        centre: [f64; 2],
    },
}

/// A piece that takes part in a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Moving {
    /// The piece, as numbered in [`Components`].
    pub component: usize,
    /// Names of its bodies.
    pub bodies: Vec<String>,
    /// How it moves.
    pub kind: MotionKind,
    /// Displacement of its centroid.
    pub displacement: [f64; 2],
    /// Rotation, counter-clockwise.
    pub rotation: f64,
    /// Work of the loads on it.
    pub work: f64,
    /// Names of the contacts it leaves, or, where it leaves none, those it moves along.
    pub contacts: Vec<String>,
}

/// The pieces of `group` that take part in `motion`, the one on which the loads do most work first.
pub(super) fn moving(problem: &Problem, group: &Group, loads: &LoadResultants, motion: &RigidMotion) -> Vec<Moving> {
    let reach = |c: usize| {
        let [a, b, omega] = motion.component[c];
        a.hypot(b) + omega.abs() * group.components.size[c]
    };
    let largest = group.members.iter().map(|c| reach(*c)).fold(0.0, f64::max);
    let mut all: Vec<Moving> = (group.members.iter().copied())
        .filter(|c| reach(*c) > STILL * largest)
        .map(|c| piece(problem, group, loads, motion, c, reach(c), largest))
        .collect();
    all.sort_by(|a, b| b.work.total_cmp(&a.work));
    all
}

fn piece(
    problem: &Problem,
    group: &Group,
    loads: &LoadResultants,
    motion: &RigidMotion,
    c: usize,
    reach: f64,
    largest: f64,
) -> Moving {
    let components = group.components;
    let [a, b, omega] = motion.component[c];
    let turning = omega.abs() * components.size[c] > STILL * reach;
    let centre = [components.centre[c][0] - b / omega, components.centre[c][1] + a / omega];
    let mine: Vec<&Run> = group.runs.iter().copied().filter(|run| run.sides.contains(&Some(c))).collect();
    let jumps = |run: &Run| run.ends.map(|end| relative(components, motion, run, end)[0]);
    let opens = |run: &Run| jumps(run).iter().any(|jump| *jump < -STILL * largest);
    let hinged = mine.iter().any(|run| jumps(run).iter().any(|jump| *jump > -STILL * largest));
    let open: Vec<&Run> = mine.iter().copied().filter(|run| opens(run)).collect();
    let slides =
        |run: &&Run| run.ends.iter().any(|end| relative(components, motion, run, *end)[1].abs() > STILL * largest);
    let sliding: Vec<&Run> = mine.iter().copied().filter(slides).collect();
    let kind = match (turning, open.is_empty()) {
        (true, true) => MotionKind::Turns { centre },
        (true, false) if hinged => MotionKind::Tips { centre },
        (_, false) => MotionKind::LiftsOff { centre: turning.then_some(centre) },
        (false, true) if sliding.is_empty() && !on_roller(problem, components, c) => MotionKind::MovesOff,
        (false, true) => MotionKind::Slides,
    };
    let mut contacts = Vec::new();
    for run in if open.is_empty() { sliding } else { open } {
        let name = &problem.interfaces[run.interface].name;
        if !contacts.contains(name) {
            contacts.push(name.clone());
        }
    }
    Moving {
        component: c,
        bodies: components.bodies[c].clone(),
        kind,
        displacement: [a, b],
        rotation: if turning { omega } else { 0.0 },
        work: loads.work_on(motion, c),
        contacts,
    }
}

/// Displacement of the first side relative to the second at `point` of `run`: across (v_n' + v_n'') and along it.
fn relative(components: &Components, motion: &RigidMotion, run: &Run, point: [f64; 2]) -> [f64; 2] {
    let [u, v] = run.sides.map(|side| side.map_or([0.0; 2], |c| motion.at(components, c, point)));
    let (apart, n) = ([u[0] - v[0], u[1] - v[1]], run.normal_at(point));
    [apart[0] * n[0] + apart[1] * n[1], apart[1] * n[0] - apart[0] * n[1]]
}

fn on_roller(problem: &Problem, components: &Components, c: usize) -> bool {
    problem.mesh.edges.iter().zip(&problem.conditions).any(|(edge, condition)| {
        matches!(condition, Condition::Roller { .. }) && edge.triangles[0].map(|t| components.of_triangle[t]) == Some(c)
    })
}

/// One sentence: which piece moves how, and what work the loads do.
pub(super) fn impossible(components: &Components, moving: &[Moving], work: f64, resisted: f64) -> String {
    let Some((lead, others)) = moving.split_first() else { return String::new() };
    let motion = clause(components, lead);
    if resisted > 0.0 {
        let by = |unit: f64| [short(work / unit), short(resisted / unit)];
        let length = lead.displacement[0].hypot(lead.displacement[1]);
        let ([work, resisted], of) = match (others, lead.rotation) {
            ([], 0.0) => (by(length), "the load in this direction is"),
            ([], turn) => (by(turn.abs()), "the moment of its load about that point is"),
            _ => (by(1.0), "the work of the loads on this motion (largest displacement 1) is"),
        };
        let names: Vec<_> = others.iter().map(|other| name(components, other.component)).collect();
        let with = match names.len() {
            0 => String::new(),
            1 => format!("{} moves with it, ", names[0]),
            _ => format!("{} move with it, ", list(&names)),
        };
        let lead = capital(&name(components, lead.component));
        return format!("{lead} {motion}: {with}friction resists with {resisted}, and {of} {work}.");
    }
    let reason = if !others.is_empty() {
        let others: Vec<_> = others.iter().map(|other| name(components, other.component)).collect();
        let verb = if others.len() == 1 { "moves" } else { "move" };
        format!(
            "{} {verb} with it, nothing resists, and the loads do work {} on this motion (largest displacement 1)",
            list(&others),
            short(work)
        )
    } else if lead.rotation != 0.0 {
        let moment = short(work / lead.rotation.abs());
        format!("nothing holds it against the moment {moment} of its load about that point")
    } else {
        let force = work / lead.displacement[0].hypot(lead.displacement[1]);
        format!("nothing holds it against the load {}", short(force))
    };
    format!("{} {motion}: {reason}.", capital(&name(components, lead.component)))
}

/// Consequence for the displacement of a motion that stays free without work.
pub(super) fn free_both_ways(components: &Components, moving: &[Moving]) -> String {
    let all: Vec<_> =
        moving.iter().map(|one| format!("{} {}", name(components, one.component), clause(components, one))).collect();
    format!(
        "Nothing hinders this motion either way, and the loads do no work on it: {}. The stress is unique, the \
         displacement only up to this motion.",
        all.join(", ")
    )
}

/// As [`free_both_ways`], for a motion that only contacts with a gap would hinder, those of these `names`.
pub(super) fn free_while_open(components: &Components, moving: &[Moving], names: &[String]) -> String {
    let all: Vec<_> =
        moving.iter().map(|one| format!("{} {}", name(components, one.component), clause(components, one))).collect();
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    let (contacts, stay, gaps) =
        if names.len() == 1 { ("contact", "stays", "its gap lets") } else { ("contacts", "stay", "their gaps let") };
    format!(
        "While {contacts} {} {stay} open, nothing hinders this motion either way, and the loads do no work on it: {}. The stress is \
         unique, the displacement only up to this motion, as far as {gaps} it.",
        list(&quoted),
        all.join(", ")
    )
}

/// As [`free_both_ways`], for a motion that is free in one direction only.
pub(super) fn free_one_way(components: &Components, moving: &[Moving], loaded: bool) -> String {
    let all: Vec<_> =
        moving.iter().map(|one| format!("{} {}", name(components, one.component), clause(components, one))).collect();
    let motion = all.join(", ");
    if loaded {
        return format!(
            "The loads are on the borderline of equilibrium: they do no work on a motion that contact allows one way, \
             {motion}. The displacement need not be unique."
        );
    }
    format!(
        "Nothing is applied that would keep contact closed in this motion, which contact allows one way: {motion}. The \
         contact carries no force there, and the displacement need not be unique."
    )
}

/// The loads have an equilibrium, but no pressure of degree `degree` on the edges of this mesh carries it.
pub(super) fn beyond_mesh(components: &Components, moving: &[Moving], borderline: bool, degree: usize) -> String {
    let lead = moving.first();
    let place = lead
        .map_or(String::new(), |lead| format!(" ({} {})", name(components, lead.component), clause(components, lead)));
    let remedy = if borderline {
        "refine the ends of the contact, unless the pressure would have to act in a single point, which no mesh can carry"
    } else {
        "refine the ends of the contact"
    };
    let pressure = match degree {
        0 => "constant".to_string(),
        1 => "linear".to_string(),
        degree => format!("of degree {degree}"),
    };
    format!(
        "The contact pressure that balances the loads is so close to an end of the contact that the edges there cannot \
         carry it with pressure {pressure} along each edge{place}: {remedy}."
    )
}

/// "slides along …", without the subject.
fn clause(components: &Components, one: &Moving) -> String {
    let size = components.size[one.component];
    let point = |p: [f64; 2]| place(components, p, size);
    let length = one.displacement[0].hypot(one.displacement[1]);
    let direction = || {
        let [a, b] = one.displacement.map(|x| x / length);
        format!("in direction ({}, {})", near_zero(a, 1.0), near_zero(b, 1.0))
    };
    let sense = if one.rotation > 0.0 { "counter-clockwise" } else { "clockwise" };
    let contacts: Vec<_> = one.contacts.iter().map(|contact| format!("`{contact}`")).collect();
    let contact = format!("{} {}", if contacts.len() == 1 { "its contact" } else { "its contacts" }, list(&contacts));
    match one.kind {
        MotionKind::MovesOff => format!("moves off {}", direction()),
        MotionKind::Slides if contacts.is_empty() => format!("slides along its rollers {}", direction()),
        MotionKind::Slides => format!("slides along {contact} {}", direction()),
        MotionKind::LiftsOff { centre: None } => format!("lifts off {contact} {}", direction()),
        MotionKind::LiftsOff { centre: Some(c) } => format!("lifts off {contact}, turning {sense} about {}", point(c)),
        MotionKind::Tips { centre } => format!("tips {sense} about {} off {contact}", point(centre)),
        MotionKind::Turns { centre } => format!("turns {sense} about {}", point(centre)),
    }
}

/// Names of all bodies of a group.
pub(super) fn all_names(group: &Group) -> String {
    list(&group.members.iter().map(|c| name(group.components, *c)).collect::<Vec<_>>())
}

fn name(components: &Components, c: usize) -> String {
    let names: Vec<_> = components.bodies[c].iter().map(|body| format!("`{body}`")).collect();
    let bodies =
        if names.len() == 1 { format!("body {}", names[0]) } else { format!("bonded bodies {}", list(&names)) };
    if !components.one_of_several[c] {
        return bodies;
    }
    format!("the piece of {bodies} around {}", place(components, components.centre[c], components.size[c]))
}

/// A point in the coordinates of the scene as it was written; `size` says what is as good as zero.
fn place(components: &Components, point: [f64; 2], size: f64) -> String {
    let [x, y] = [0, 1].map(|c| near_zero(point[c] + components.origin[c], size));
    format!("({x}, {y})")
}

fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

fn near_zero(x: f64, scale: f64) -> String {
    short(if x.abs() < STILL * scale { 0.0 } else { x })
}

/// Four significant digits.
fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e5).contains(&x.abs()) {
        return format!("{x:.3e}");
    }
    let decimals = (3 - x.abs().log10().floor() as i32).max(0) as usize;
    let text = format!("{x:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').into() }
}
