//! Numbers that are known between two ends alone, and the two scenes that enclose the energies of all that lie between.
//!
//! The least energy min 𝓛 grows with Young's moduli and falls with gaps: 𝓛(v) does so for every v, or the set of admissible v
//! shrinks. It does neither with Poisson's ratio, so that a range of it is refused. A scene with ranges holds the ends with the lowest
//! energy; [`Scene::of_highest_energy`] is the scene of the other ends.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};

use super::error::SceneError;
use super::fault::Fault;
use super::raw::{At, RawContact, RawGap, RawScene, Table};
use super::source::Source;
use super::{Body, Gap, Scene};
use crate::elasticity::Elasticity;

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

/// A number that may be known as a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ranged {
    /// Young's modulus of a body, by its index.
    Young(usize),
    /// The gap of a contact, by its index.
    Gap(usize),
}

impl DataRange {
    /// The end for which the energy is lowest.
    pub fn softest(&self) -> f64 {
        match self.of {
            Ranged::Young(_) => self.low,
            Ranged::Gap(_) => self.high,
        }
    }

    /// The end for which the energy is highest.
    pub fn stiffest(&self) -> f64 {
        match self.of {
            Ranged::Young(_) => self.high,
            Ranged::Gap(_) => self.low,
        }
    }
}

impl Scene {
    /// The name of a number with a range.
    pub fn name_of(&self, range: &DataRange) -> String {
        match range.of {
            Ranged::Young(body) => format!("Young's modulus of {}", self.bodies[body].name),
            Ranged::Gap(contact) => format!("the gap of {}", self.contacts[contact].name()),
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
            }
        }
        Some(scene)
    }
}

/// One number, or the two ends [low, high] of a range.
#[derive(Debug, Clone, PartialEq, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "NumberOrRange")]
pub(super) enum RawNumber {
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
pub(super) fn ends(
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

/// Two ends, the lower one first.
pub(super) fn ordered(
    ends: &[f64],
    span: std::ops::Range<usize>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<[f64; 2], SceneError> {
    let (table, key) = (table.to_owned(), key.to_owned());
    let Ok([low, high]) = <[f64; 2]>::try_from(ends) else {
        let found = super::counted(ends.len(), "number");
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
pub(super) fn no_range(
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
pub(super) fn ranges(raw: &RawScene, bodies: &[Body]) -> Vec<DataRange> {
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
    bodies.iter().enumerate().filter_map(young).chain(raw.contacts.iter().enumerate().filter_map(gap)).collect()
}
