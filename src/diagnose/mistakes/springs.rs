//! Wrong springs, elastic layers and elastic contact.

use std::collections::BTreeSet;

use crate::compare::forces::functions::nodes_along;
use crate::compare::forces::springs::{Part, spring_forces};
use crate::compare::solution::SOLVER;
use crate::diagnose::fit::Terms;
use crate::diagnose::space::Space;
use crate::diagnose::words::{factor, near, number};
use crate::diagnose::{Finding, Trial};
use crate::problem::{Bed, OneSided};

const DIRECTIONS: [&str; 2] = ["normal", "tangential"];

/// Names of a bed in findings and in sentences.
struct Called {
    /// `support/foot`, `bond/a|b` or `contact/a|b`.
    name: String,
    /// `the springs on foot` and the like.
    what: String,
}

impl Called {
    fn of(bed: &Bed) -> Self {
        let (name, elastic) = (&bed.name, bed.pairs.iter().any(|pair| pair.contact.is_some()));
        match (elastic, bed.is_layer()) {
            (true, _) => Called { name: format!("contact/{name}"), what: format!("contact {name}") },
            (false, true) => Called { name: format!("bond/{name}"), what: format!("the layer {name}") },
            (false, false) => Called { name: format!("support/{name}"), what: format!("the springs on {name}") },
        }
    }
}

/// Gaps of elastic contact that are mistaken most often, as factors on those of the scene.
const GAPS: [(f64, &str); 3] = [(0.0, "is ignored"), (2.0, "counts twice"), (-1.0, "has the opposite sign")];

/// Nodes that have to move together for a layer to be rigid.
const TOGETHER: usize = 3;
/// The part of the forces on two sides, as their squares, that they may leave together.
const LEFT: f64 = 1e-6;

/// Layers whose sides move together, under forces that one exerts on the other.
fn rigid(space: &Space<'_>, bed: &Bed) -> Option<Trial> {
    let (mesh, solution) = (&space.problem().mesh, space.solution);
    let degree = solution.candidate.degree.min(2);
    let edges = bed.pairs.iter().filter_map(|pair| Some((pair.edge, pair.opposite?)));
    let pairs: BTreeSet<(usize, usize)> = edges
        .flat_map(|(first, second)| {
            let along = |e: usize| nodes_along(mesh, e, degree).collect::<Vec<usize>>();
            along(first).into_iter().zip(along(second).into_iter().rev()).collect::<Vec<_>>()
        })
        .collect();
    let enough = (SOLVER + solution.candidate.precision) * solution.reference;
    let value = |node: usize| solution.candidate.value(node);
    let apart = |(a, b): &(usize, usize)| (0..2).any(|c| (value(*a)[c] - value(*b)[c]).abs() > enough);
    if pairs.len() < TOGETHER || pairs.iter().any(apart) {
        return None;
    }
    let square = |f: [f64; 2]| f[0] * f[0] + f[1] * f[1];
    let (mut both, mut sum, mut inside) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        let [own, other] = [a, b].map(|node| solution.rest[node]);
        both += square(own) + square(other);
        sum += square([own[0] + other[0], own[1] + other[1]]);
        inside += space.square_at(a) + space.square_at(b);
    }
    let Called { name, what } = Called::of(bed);
    let finding = Finding::new(
        format!("{name}/rigid"),
        None,
        None,
        format!("the sides of {what} move together: nothing gives way between them"),
    );
    let left = (1.0 - inside / space.square).max(0.0);
    (sum <= LEFT * both).then(|| Trial { rank: 1, left, findings: vec![finding] })
}

/// Rigid layers, and elastic contact with another gap.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let layers = space.problem().beds.iter().filter(|bed| bed.is_layer());
    let rigid: Vec<Trial> = layers.filter_map(|bed| rigid(space, bed)).collect();
    let beds = space.problem().beds.iter();
    let elastic = beds.filter(|bed| bed.pairs.iter().any(|pair| pair.contact.is_some_and(has_gap)));
    let of_bed = |bed: &Bed| -> Vec<Trial> {
        let (name, k) = (&bed.name, bed.stiffness[0]);
        let own = column(space, bed, 0, Part::Own);
        let other = |(factor, words): (f64, &str)| {
            let made = column(space, bed, 0, Part::WithGap(factor));
            let change: Vec<f64> = made.iter().zip(&own).map(|(made, own)| k * (made - own)).collect();
            let sentence = format!("the gap of contact {name} {words}");
            let finding = Finding::new(format!("contact/{name}/gap"), Some(factor), Some(1.0), sentence);
            Trial { rank: 1, left: space.left_with(&change), findings: vec![finding] }
        };
        GAPS.map(other).into()
    };
    elastic.flat_map(of_bed).chain(rigid).collect()
}

fn has_gap(contact: OneSided) -> bool {
    contact.gap().iter().any(|g| *g != 0.0)
}

/// Forces per unit of stiffness, as they can be held against the residual.
fn column(space: &Space<'_>, bed: &Bed, direction: usize, part: Part) -> Vec<f64> {
    let of = (space.solution.candidate.degree.min(2), space.count());
    let value = |node: usize| space.solution.candidate.value(node);
    space.column(spring_forces(space.problem(), bed, direction, part, of, value))
}

/// Stiffnesses that are off, exchanged or missing, and springs that act where they should not.
pub fn terms<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) {
    for bed in &space.problem().beds {
        let Called { name, what } = Called::of(bed);
        let own = [0, 1].map(|c| column(space, bed, c, Part::Own));
        let times = |c: usize| -> Vec<f64> { own[c].iter().map(|f| bed.stiffness[c] * f).collect() };
        let given = bed.stiffness;
        let resist = [0, 1].map(|c| given[c] > 0.0);
        for c in (0..2).filter(|c| resist[*c]) {
            let alone = !resist[1 - c];
            let (name, what) = match alone {
                true => (format!("{name}/stiffness"), format!("the stiffness of {what}")),
                false => (format!("{name}/{}", DIRECTIONS[c]), format!("the {} stiffness of {what}", DIRECTIONS[c])),
            };
            terms.push(1, vec![times(c)], move |x| {
                let s = 1.0 + x[0];
                vec![Finding::new(name.clone(), Some(s * given[c]), Some(given[c]), factor(&what, s))]
            });
        }
        if resist == [true; 2] {
            let both = times(0).iter().zip(times(1)).map(|(a, b)| a + b).collect();
            let told = (format!("{name}/stiffness"), format!("the stiffness of {what}"));
            terms.push(1, vec![both], move |x| {
                vec![Finding::new(told.0.clone(), Some(1.0 + x[0]), Some(1.0), factor(&told.1, 1.0 + x[0]))]
            });
            let (name, what) = (name.clone(), what.clone());
            terms.push(2, vec![times(0), times(1)], move |x| {
                both_off(&name, &what, [0, 1].map(|c| (1.0 + x[c]) * given[c]), given)
            });
        } else if let Some(c) = (0..2).find(|c| !resist[*c] && bed.pairs.iter().all(|pair| pair.contact.is_none())) {
            let (name, what) = (format!("{name}/{}", DIRECTIONS[c]), what.clone());
            let direction = ["along their normal", "along the boundary"][c];
            terms.push(2, vec![own[c].clone()], move |x| {
                let sentence = format!("{what} resist {direction} too, with the stiffness {}", number(x[0]));
                vec![Finding::new(name.clone(), Some(x[0]), Some(0.0), sentence)]
            });
        }
        if bed.pairs.iter().any(|pair| pair.contact.is_some()) {
            let pulling = column(space, bed, 0, Part::Pulling).iter().map(|f| given[0] * f).collect();
            terms.push(1, vec![pulling], move |x| {
                let mut sentence = format!("{what} pulls where it is open");
                if !near(x[0], 1.0) {
                    sentence += &format!(", with {} times its stiffness", number(x[0]));
                }
                vec![Finding::new(format!("{name}/pulling"), Some(x[0]), Some(0.0), sentence)]
            });
        }
    }
}

/// Findings on both stiffnesses of a bed: that they are exchanged, or each by itself.
fn both_off(name: &str, what: &str, found: [f64; 2], given: [f64; 2]) -> Vec<Finding> {
    if near(found[0], given[1]) && near(found[1], given[0]) {
        let [normal, tangential] = found.map(number);
        let sentence =
            format!("the stiffness of {what} is [{normal}, {tangential}]: normal and tangential are exchanged");
        return vec![Finding::new(format!("{name}/stiffness"), None, None, sentence)];
    }
    let of = |c: usize| {
        let sentence = factor(&format!("the {} stiffness of {what}", DIRECTIONS[c]), found[c] / given[c]);
        Finding::new(format!("{name}/{}", DIRECTIONS[c]), Some(found[c]), Some(given[c]), sentence)
    };
    [0, 1].into_iter().map(of).collect()
}
