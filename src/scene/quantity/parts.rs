//! The parts of a quantity: what it is of, its direction, weight and region.

use super::check::Context;
use super::{Component, Holder, Invariant, QuantityFault};
use crate::scene::keys::conditions::Conditions;
use crate::scene::keys::polygon::{Defect, area, defect};
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, Pair};
use crate::scene::reading::source::counted;
use crate::scene::{BoundaryUse, ContactSides};

/// The component of the force of a contact that is not its normal force.
const TANGENTIAL: &str = "tangential";

/// Part of its arc length below which the slope of a window is a jump.
const STEEP: f64 = 1e-9;

impl Context<'_> {
    /// The contact or support that a name means.
    pub(super) fn holder(&self, key: &'static str, of: &At<String>) -> Result<Holder, SceneError> {
        let name =
            self.source.name(of, (self.table, key), "name a contact, one of its sides, or a supported boundary")?;
        let Conditions { supports, contacts, .. } = self.named.conditions;
        let called = contacts.iter().enumerate().filter(|(_, contact)| contact.name() == name);
        let mut found: Vec<Holder> = called.map(|(i, _)| Holder::Contact(i)).collect();
        found.extend(self.named.conditions.owner(&name).filter(|owner| !found.contains(owner)));
        match found.as_slice() {
            [holder] => Ok(*holder),
            [] => {
                let sides = contacts.iter().flat_map(|contact| match &contact.sides {
                    ContactSides::Between(sides) => sides.to_vec(),
                    ContactSides::Rigid(side) => vec![side.clone()],
                });
                let boundaries = sides.chain(supports.iter().map(|support| support.on.clone()));
                let known: Vec<String> = contacts.iter().map(|contact| contact.name()).chain(boundaries).collect();
                self.unknown(key, of, "contact or support", known)
            }
            several => {
                let owner = |holder: &Holder| match *holder {
                    Holder::Contact(i) => BoundaryUse::Contact(i).to_string(),
                    Holder::Support(i) => BoundaryUse::Support(i).to_string(),
                };
                self.ambiguous(key, of, several.iter().map(owner).collect())
            }
        }
    }

    /// True if the force of a contact is that of its friction.
    pub(super) fn is_tangential(&self, contact: usize) -> Result<bool, SceneError> {
        let Some(word) = &self.raw.component else { return Ok(false) };
        if word.value != TANGENTIAL {
            let (table, found, known) = (self.table.to_owned(), word.value.clone(), vec![TANGENTIAL.to_owned()]);
            return self.fail(word.span(), Fault::UnknownWord { key: "component", table, found, known });
        }
        let resists = &self.named.conditions.contacts[contact];
        if resists.friction.is_none() && resists.coefficient.is_none() {
            let remedy =
                "delete `component`, or give the contact a `friction`: without it there is no tangential force";
            return self.misplaced("component", word.span(), "a contact without friction", remedy);
        }
        Ok(true)
    }

    pub(super) fn direction(&self, direction: &Pair) -> Result<[f64; 2], SceneError> {
        self.source.unit(direction, (self.table, "direction"), "write the direction that is meant, like [1.0, 0.0]")
    }

    pub(super) fn component(&self, word: &At<String>) -> Result<Component, SceneError> {
        let words = Component::words(self.named.kinematics);
        if let Some((_, component)) = words.iter().find(|(name, _)| *name == word.value) {
            return Ok(*component);
        }
        let other = word.value.as_str();
        let mut known: Vec<String> = words.iter().map(|(name, _)| (*name).to_owned()).collect();
        if self.raw.point.is_some() {
            known.extend(Invariant::ALL.map(|invariant| invariant.word().to_owned()));
        } else if let Some(invariant) = Invariant::ALL.into_iter().find(|known| known.word() == other) {
            let remedy = "add `point = [x, y]`: of a mean over a region only components are bounded";
            return self.misplaced(invariant.word(), word.span(), "a mean over a region", remedy);
        }
        let (table, found) = (self.table.to_owned(), other.to_owned());
        self.fail(word.span(), Fault::UnknownWord { key: "component", table, found, known })
    }

    /// A weight that is 0 or 1 at every end of the side and continuous between: the mean of a pressure over a part with
    /// sharp ends is not bounded by its energy. How long the side is only the mesh tells, so a window that goes up to
    /// its far end says so by s2 and s3 beyond it.
    pub(super) fn window(&self, list: &At<Vec<f64>>) -> Result<[f64; 4], SceneError> {
        let table = || self.table.to_owned();
        let Ok(window) = <[f64; 4]>::try_from(list.value.as_slice()) else {
            let (found, expected) = (counted(list.value.len(), "number"), "4".to_owned());
            let remedy = "write [s0, s1, s2, s3]: weight 0 up to s0 and from s3 on, 1 from s1 to s2, linear between";
            return self
                .fail(list.span(), Fault::Count { key: "window".into(), table: table(), found, expected, remedy });
        };
        for value in window {
            self.source.number(
                &At { value, start: list.start, end: list.end },
                (self.table, "window"),
                |_| true,
                ("", ""),
            )?;
        }
        let [s0, s1, s2, s3] = window;
        let (rule, remedy) = match () {
            _ if !(s0 <= s1 && s1 <= s2 && s2 <= s3 && s0 < s3) => DESCENDING,
            _ if s3 <= 0.0 => NOTHING,
            _ if s1 > 0.0 && s1 - s0 <= STEEP * s1 => SHARP,
            _ if s3 - s2 <= STEEP * s3 => SHARP_AT_END,
            _ => return Ok(window),
        };
        let found = self.source.written(list.span());
        self.fail(list.span(), QuantityFault::Window { table: table(), found, rule, remedy })
    }

    pub(super) fn corners(&self, raw: &At<Vec<Pair>>) -> Result<Vec<[f64; 2]>, SceneError> {
        let remedy = "write the lower left and the upper right corner, [[x0, y0], [x1, y1]]";
        let [low, high] = raw.value.as_slice() else {
            let (key, table) = ("box".to_owned(), self.table.to_owned());
            let (found, expected) = (counted(raw.value.len(), "corner"), "2".to_owned());
            return self.fail(raw.span(), Fault::Count { key, table, found, expected, remedy });
        };
        let [x0, y0] = self.source.vector(low, (self.table, "box[0]"))?;
        let [x1, y1] = self.source.vector(high, (self.table, "box[1]"))?;
        if !(x0 < x1 && y0 < y1) {
            let (key, table, found) = ("box".to_owned(), self.table.to_owned(), self.source.written(raw.span()));
            let rule = "a box [[x0, y0], [x1, y1]] has x0 < x1 and y0 < y1";
            return self.fail(raw.span(), Fault::Number { key, table, found, rule, remedy });
        }
        let points = vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        self.simple(points, raw)
    }

    pub(super) fn polygon(&self, raw: &At<Vec<Pair>>) -> Result<Vec<[f64; 2]>, SceneError> {
        let mut points = Vec::with_capacity(raw.value.len());
        for (i, point) in raw.value.iter().enumerate() {
            points.push(self.source.vector(point, (self.table, &format!("polygon[{i}]")))?);
        }
        let mut points = self.simple(points, raw)?;
        if area(&points) < 0.0 {
            points.reverse();
        }
        Ok(points)
    }

    /// The points, if the polygon through them is simple and has an area.
    fn simple(&self, points: Vec<[f64; 2]>, raw: &At<Vec<Pair>>) -> Result<Vec<[f64; 2]>, SceneError> {
        let Some(defect) = defect(&points) else { return Ok(points) };
        let remedy = match defect {
            Defect::Crossing(..) => {
                "list the corners in order round the region; take a quantity for each of several regions"
            }
            _ => defect.remedy(&points),
        };
        let problem = defect.problem(&points, |edge| (edge + 1).to_string());
        let span = defect.corner().and_then(|i| raw.value.get(i)).map_or(raw.span(), At::span);
        self.fail(span, QuantityFault::Region { table: self.table.to_owned(), problem, remedy })
    }
}

impl Conditions {
    /// True if one of them is on the boundary of this name.
    pub(super) fn have(&self, name: &str) -> bool {
        self.owner(name).is_some()
            || self.tractions.iter().any(|traction| traction.on == name)
            || self.bonds.iter().any(|bond| bond.sides.iter().any(|side| side == name))
    }

    /// The contact or support whose boundary has this name.
    fn owner(&self, name: &str) -> Option<Holder> {
        let support = self.supports.iter().position(|support| support.on == name).map(Holder::Support);
        let contact = self.contacts.iter().position(|contact| match &contact.sides {
            ContactSides::Between(sides) => sides.iter().any(|side| side == name),
            ContactSides::Rigid(side) => side == name,
        });
        support.or(contact.map(Holder::Contact))
    }
}

const DESCENDING: (&str, &str) =
    ("the arc lengths of a window do not descend", "write [s0, s1, s2, s3] with s0 < s1 ≤ s2 < s3");
const SHARP: (&str, &str) = (
    "a weight that jumps (s0 = s1, or as good as) inside the side is no bounded functional",
    "take a trapezoid, s0 < s1; at the beginning of the side, s = 0, the two may be equal",
);
const SHARP_AT_END: (&str, &str) = (
    "a weight that jumps (s2 = s3, or as good as) is no bounded functional",
    "take a trapezoid, s2 < s3; for a window up to the end of the side let both lie beyond it",
);
const NOTHING: (&str, &str) = (
    "the side begins at s = 0, so nothing of it lies in this window",
    "measure s along the first side, from its end that comes first in (x, y) order",
);
