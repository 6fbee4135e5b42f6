//! Numbers that are known between two ends alone, and the two scenes that enclose the energies of all that lie between.
//!
//! The least energy min 𝓛 grows with Young's moduli, the stiffness of springs and friction bounds, and falls with gaps: 𝓛(v) does so for every v, or the set of admissible v
//! shrinks. It does neither with Poisson's ratio, so that a range of it is refused. A scene with ranges holds the ends with the lowest
//! energy; [`Scene::of_highest_energy`] is the scene of the other ends.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};

use crate::elasticity::Elasticity;
use crate::scene::reading::error::SceneError;
use crate::scene::reading::fault::Fault;
use crate::scene::reading::raw::{At, RawBound, RawContact, RawGap, RawScene, RawStiffness, Table};
use crate::scene::reading::source::Source;
use crate::scene::{Body, FrictionBound, Gap, Scene, SupportKind};

/// A number of the scene that is known between two ends alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataRange {
    /// Which number.
    pub of: Ranged,
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// Components of a stiffness in words.
const DIRECTIONS: [&str; 2] = ["normal", "tangential"];

/// A number that may be known as a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ranged {
    /// Young's modulus of a body, by its index.
    Young(usize),
    /// The gap of a contact, by its index.
    Gap(usize),
    /// The friction bound of a contact, by its index.
    Friction(usize),
    /// The stiffness of the springs of a support, by its index, normal (0) or tangential (1).
    Spring(usize, usize),
    /// That of the elastic layer of a bond.
    Layer(usize, usize),
    /// The stiffness of an elastic contact.
    Contact(usize),
}

impl DataRange {
    /// The end for which the energy is lowest.
    pub fn softest(&self) -> f64 {
        match self.of {
            Ranged::Gap(_) => self.high,
            Ranged::Young(_) | Ranged::Friction(_) | Ranged::Contact(_) | Ranged::Spring(..) | Ranged::Layer(..) => {
                self.low
            }
        }
    }

    /// The end for which the energy is highest.
    pub fn stiffest(&self) -> f64 {
        match self.of {
            Ranged::Gap(_) => self.low,
            Ranged::Young(_) | Ranged::Friction(_) | Ranged::Contact(_) | Ranged::Spring(..) | Ranged::Layer(..) => {
                self.high
            }
        }
    }
}

impl Scene {
    /// The name of a number with a range.
    pub fn name_of(&self, range: &DataRange) -> String {
        match range.of {
            Ranged::Young(body) => format!("Young's modulus of {}", self.bodies[body].name),
            Ranged::Gap(contact) => format!("the gap of {}", self.contacts[contact].name()),
            Ranged::Friction(contact) => format!("the friction bound of {}", self.contacts[contact].name()),
            Ranged::Contact(contact) => format!("the stiffness of {}", self.contacts[contact].name()),
            Ranged::Spring(support, c) => {
                format!("the {} stiffness of the springs on {}", DIRECTIONS[c], self.supports[support].on)
            }
            Ranged::Layer(bond, c) => {
                let [a, b] = &self.bonds[bond].sides;
                format!("the {} stiffness of the layer {a}|{b}", DIRECTIONS[c])
            }
        }
    }

    /// The scene of the ends of all ranges for which the energy is highest; `None` where every number is known.
    pub fn of_highest_energy(&self) -> Option<Scene> {
        if self.ranges.is_empty() {
            return None;
        }
        let mut scene = self.clone();
        for range in std::mem::take(&mut scene.draft.ranges) {
            match range.of {
                Ranged::Young(body) => {
                    if let Elasticity::Isotropic { young, .. } = &mut scene.draft.bodies[body].elasticity {
                        *young = range.stiffest();
                    }
                }
                Ranged::Gap(contact) => scene.draft.contacts[contact].gap = Gap::Constant(range.stiffest()),
                Ranged::Friction(contact) => {
                    scene.draft.contacts[contact].friction = Some(FrictionBound::Constant(range.stiffest()));
                }
                Ranged::Contact(contact) => scene.draft.contacts[contact].stiffness = Some(range.stiffest()),
                Ranged::Spring(support, c) => {
                    if let SupportKind::Spring { stiffness } = &mut scene.draft.supports[support].kind {
                        stiffness[c] = range.stiffest();
                    }
                }
                Ranged::Layer(bond, c) => {
                    if let Some(stiffness) = &mut scene.draft.bonds[bond].stiffness {
                        stiffness[c] = range.stiffest();
                    }
                }
            }
        }
        Some(scene)
    }
}

/// One number, or the two ends [low, high] of a range.
#[derive(Debug, Clone, PartialEq, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "NumberOrRange")]
pub(in crate::scene) enum RawNumber {
    /// The number.
    One(f64),
    /// Its ends, the lower first.
    Range(#[schemars(with = "[f64; 2]")] Vec<f64>),
}

impl<'de> Deserialize<'de> for RawNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberOrRange;
        impl<'de> Visitor<'de> for NumberOrRange {
            type Value = RawNumber;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number")
            }
            fn visit_f64<E>(self, number: f64) -> Result<RawNumber, E> {
                Ok(RawNumber::One(number))
            }
            fn visit_i64<E>(self, number: i64) -> Result<RawNumber, E> {
                Ok(RawNumber::One(number as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<RawNumber, A::Error> {
                let mut ends = Vec::new();
                while let Some(end) = entries.next_element()? {
                    ends.push(end);
                }
                Ok(RawNumber::Range(ends))
            }
        }
        deserializer.deserialize_any(NumberOrRange)
    }
}

/// The numbers of `raw`, one or the two ends of a range, each where it stands.
pub(in crate::scene) fn ends(
    raw: &At<RawNumber>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<(At<f64>, Option<At<f64>>), SceneError> {
    let at = |value: f64| At { value, start: raw.start, end: raw.end };
    match &raw.value {
        RawNumber::One(value) => Ok((at(*value), None)),
        RawNumber::Range(ends) => {
            let [low, high] = ordered(ends, raw.span(), (table, key), source)?;
            Ok((at(low), Some(at(high))))
        }
    }
}

/// The two ends of each of two components, normal and tangential; the same twice where one is a number.
pub(in crate::scene) fn components(
    both: &[RawNumber],
    span: std::ops::Range<usize>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<[[f64; 2]; 2], SceneError> {
    let [normal, tangential] = both else {
        let (key, table, found) = (key.to_owned(), table.to_owned(), crate::scene::counted(both.len(), "component"));
        let remedy = "write both, [normal, tangential]; each may be a range, [[low, high], [low, high]]";
        return Err(source.error(span, Fault::Count { key, table, found, expected: "2".into(), remedy }));
    };
    let ends = |component: &RawNumber| match component {
        RawNumber::One(value) => Ok([*value; 2]),
        RawNumber::Range(ends) => ordered(ends, span.clone(), (table, key), source),
    };
    let all = [ends(normal)?, ends(tangential)?];
    // None beyond what numbers may be.
    let list = At { value: all.as_flattened().to_vec(), start: span.start, end: span.end };
    source.vector::<4>(&list, (table, key))?;
    Ok(all)
}

/// Two ends, the lower one first.
pub(in crate::scene) fn ordered(
    ends: &[f64],
    span: std::ops::Range<usize>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<[f64; 2], SceneError> {
    let (table, key) = (table.to_owned(), key.to_owned());
    let Ok([low, high]) = <[f64; 2]>::try_from(ends) else {
        let found = crate::scene::counted(ends.len(), "number");
        let remedy = "write one number, or the two ends [low, high] between which it is known to lie";
        return Err(source.error(span, Fault::Count { key, table, found, expected: "1 or 2".into(), remedy }));
    };
    if low > high {
        let (found, rule) = (source.written(span.clone()), "a range begins with its lower end");
        let fault = Fault::Number { key, table, found, rule, remedy: "exchange the two ends" };
        return Err(source.error(span, fault));
    }
    Ok([low, high])
}

/// Refuses a range of Poisson's ratio.
pub(in crate::scene) fn no_range(
    raw: &At<RawNumber>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<At<f64>, SceneError> {
    match &raw.value {
        RawNumber::One(value) => Ok(At { value: *value, start: raw.start, end: raw.end }),
        RawNumber::Range(_) => {
            let rule =
                "the energy neither grows nor falls with ν alone: between its ends it may lie beyond both of theirs";
            let remedy = "write one number; a range of `young` is enclosed";
            let (key, table, found) = (key.to_owned(), table.to_owned(), source.written(raw.span()));
            Err(source.error(raw.span(), Fault::Number { key, table, found, rule, remedy }))
        }
    }
}

/// The ranges of a scene whose bodies, in the order of `bodies`, and contacts have passed their own checks.
pub(in crate::scene) fn ranges(raw: &RawScene, bodies: &[Body]) -> Vec<DataRange> {
    let two = |ends: &[f64]| <[f64; 2]>::try_from(ends).ok();
    let young = |(i, body): (usize, &Body)| {
        let (_, At { value: Table(body), .. }) = raw.bodies.iter().find(|(name, _)| name.value == body.name)?;
        match &body.young.as_ref()?.value {
            RawNumber::Range(ends) => two(ends).map(|[low, high]| DataRange { of: Ranged::Young(i), low, high }),
            RawNumber::One(_) => None,
        }
    };
    let gap = |(i, contact): (usize, &At<Table<RawContact>>)| match &contact.value.0.gap.as_ref()?.value {
        RawGap::Range(ends) => two(ends).map(|[low, high]| DataRange { of: Ranged::Gap(i), low, high }),
        _ => None,
    };
    let bound = |(i, contact): (usize, &At<Table<RawContact>>)| {
        let Table(friction) = &contact.value.0.friction.as_ref()?.value;
        match &friction.bound.as_ref()?.value {
            RawBound::Range(ends) => two(ends).map(|[low, high]| DataRange { of: Ranged::Friction(i), low, high }),
            _ => None,
        }
    };
    let stiffness = |(i, contact): (usize, &At<Table<RawContact>>)| match &contact.value.0.stiffness.as_ref()?.value {
        RawNumber::Range(ends) => two(ends).map(|[low, high]| DataRange { of: Ranged::Contact(i), low, high }),
        RawNumber::One(_) => None,
    };
    let of_components = |both: &[RawNumber], of: &dyn Fn(usize) -> Ranged| -> Vec<DataRange> {
        let ranged = |(c, component): (usize, &RawNumber)| match component {
            RawNumber::Range(ends) => two(ends).map(|[low, high]| DataRange { of: of(c), low, high }),
            RawNumber::One(_) => None,
        };
        both.iter().enumerate().filter_map(ranged).collect()
    };
    let mut all: Vec<DataRange> = bodies.iter().enumerate().filter_map(young).collect();
    all.extend(raw.contacts.iter().enumerate().filter_map(gap));
    all.extend(raw.contacts.iter().enumerate().filter_map(bound));
    all.extend(raw.contacts.iter().enumerate().filter_map(stiffness));
    for (i, support) in raw.supports.iter().enumerate() {
        if let Some(At { value: RawStiffness::Both(both), .. }) = &support.value.0.stiffness {
            all.extend(of_components(both, &|c| Ranged::Spring(i, c)));
        }
    }
    for (i, bond) in raw.bonds.iter().enumerate() {
        if let Some(both) = &bond.value.0.stiffness {
            all.extend(of_components(&both.value, &|c| Ranged::Layer(i, c)));
        }
    }
    all
}
