//! `[[quantities]]` → [`Quantity`]: what a quantity names exists, and its functional is bounded.

use std::collections::HashMap;
use std::ops::Range;

use super::fault::KINDS;
use super::{Component, Extent, Holder, Quantity, QuantityFault, RawQuantity, Region, Target};
use crate::scene::conditions::{Conditions, edge_names};
use crate::scene::error::{Fault, SceneError};
use crate::scene::fault::names;
use crate::scene::polygon::{Defect, area, defect};
use crate::scene::raw::{At, Pair, RawScene};
use crate::scene::text::acts;
use crate::scene::validate::{Source, counted};
use crate::scene::{Body, BoundaryUse, ContactSides, MeshSource};

/// What quantities may name.
struct Named<'a> {
    bodies: &'a [Body],
    conditions: &'a Conditions,
    /// Names of the polygon edges; `None` where only a mesh file knows them.
    edges: Option<Vec<String>>,
}

/// Checks the list, in the order of the file.
pub(in crate::scene) fn quantities(
    raw: &RawScene,
    mesh: &MeshSource,
    bodies: &[Body],
    conditions: &Conditions,
    source: &Source,
) -> Result<Vec<Quantity>, SceneError> {
    let named = Named { bodies, conditions, edges: edge_names(mesh) };
    let mut taken: HashMap<&str, (usize, Range<usize>)> = HashMap::new();
    let mut quantities = Vec::with_capacity(raw.quantities.len());
    for (i, raw) in raw.quantities.iter().enumerate() {
        let (whole, raw) = (raw.span(), &raw.value.0);
        let table = BoundaryUse::Quantity(i).to_string();
        let context = Context { raw, table: &table, named: &named, source };
        let name = context.name()?;
        if let Some((first, span)) = taken.get(raw.name.value.as_str()) {
            let (first, line) = (BoundaryUse::Quantity(*first).to_string(), source.line(span.start));
            let fault = QuantityFault::TwoOfOneName { name, first, line, second: table };
            let error = source.error(raw.name.span(), fault.into());
            return Err(error.with_related(span.clone(), "the first of this name"));
        }
        taken.insert(&raw.name.value, (i, raw.name.span()));
        quantities.push(Quantity { name, target: context.target(whole)? });
    }
    Ok(quantities)
}

/// One table under examination.
struct Context<'a> {
    raw: &'a RawQuantity,
    table: &'a str,
    named: &'a Named<'a>,
    source: &'a Source<'a>,
}

impl Context<'_> {
    fn fail<T>(&self, span: Range<usize>, fault: impl Into<Fault>) -> Result<T, SceneError> {
        Err(self.source.error(span, fault.into()))
    }

    fn name(&self) -> Result<String, SceneError> {
        let at = &self.raw.name;
        let name = self.source.name(at, (self.table, "name"), "give the quantity a name; the report uses it")?;
        let what = match () {
            _ if name.contains('=') => "the sign =",
            _ if name.chars().any(|c| c.is_control() || acts(c)) => "characters that cannot be shown",
            _ => return Ok(name),
        };
        self.fail(at.span(), QuantityFault::Name { table: self.table.to_owned(), what })
    }

    fn target(&self, whole: Range<usize>) -> Result<Target, SceneError> {
        let raw = self.raw;
        match [&raw.displacement, &raw.force, &raw.moment, &raw.stress] {
            [Some(of), None, None, None] => self.displacement(of, whole),
            [None, Some(of), None, None] => self.force(of, whole),
            [None, None, Some(of), None] => self.moment(of, whole),
            [None, None, None, Some(of)] => self.stress(of, whole),
            several => {
                let given: Vec<_> =
                    KINDS.into_iter().zip(several).filter_map(|(key, of)| Some((key, of.as_ref()?))).collect();
                let fault = QuantityFault::Kinds {
                    table: self.table.to_owned(),
                    found: given.iter().map(|(key, _)| *key).collect(),
                };
                let mut places: Vec<_> = given.iter().map(|(_, of)| of.span()).collect();
                places.sort_by_key(|span| span.start);
                match places.as_slice() {
                    [first, .., last] => {
                        Err(self.source.error(last.clone(), fault.into()).with_related(first.clone(), "another one"))
                    }
                    _ => self.fail(whole, fault),
                }
            }
        }
    }

    fn displacement(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        self.refuse(&["window", "about", "box", "polygon", "component"], "`displacement`")?;
        let name = self.source.name(of, (self.table, "displacement"), "name a boundary or a body")?;
        let body = self.named.bodies.iter().position(|body| body.name == name);
        let boundary = match &self.named.edges {
            Some(edges) => edges.binary_search(&name).is_ok(),
            // A mesh file may have any boundary; those of conditions it has to have.
            None => body.is_none() || self.named.conditions.owner(&name).is_some(),
        };
        let of = match (body, boundary) {
            (Some(body), false) => Extent::Body(body),
            (None, true) => Extent::Boundary(name),
            (Some(_), true) => {
                return self.ambiguous("displacement", of, vec!["a body".to_owned(), "a boundary".to_owned()]);
            }
            (None, false) => {
                let bodies = self.named.bodies.iter().map(|body| body.name.as_str());
                let known = names(self.named.edges.iter().flatten().map(String::as_str).chain(bodies));
                return self.unknown("displacement", of, "boundary or body", known);
            }
        };
        let direction = self.required(&self.raw.direction, "direction", DIRECTION_OF_DISPLACEMENT, whole)?;
        Ok(Target::Displacement { of, direction: self.direction(direction)? })
    }

    fn force(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        self.refuse(&["about", "box", "polygon", "component"], "`force`")?;
        match self.holder("force", of)? {
            Holder::Contact(contact) => {
                if let Some(direction) = &self.raw.direction {
                    let remedy = "delete `direction`: the force of a contact is the normal force that presses its sides together";
                    return self.misplaced("direction", direction.span(), "the force of a contact", remedy);
                }
                let window = self.raw.window.as_ref().map(|window| self.window(window)).transpose()?;
                Ok(Target::ContactForce { contact, window })
            }
            Holder::Support(support) => {
                if let Some(window) = &self.raw.window {
                    let remedy = "delete `window`: the force of a support is that of the whole boundary; split the boundary for less";
                    return self.misplaced("window", window.span(), "the force of a support", remedy);
                }
                let direction = self.required(&self.raw.direction, "direction", DIRECTION_OF_FORCE, whole)?;
                Ok(Target::SupportForce { support, direction: self.direction(direction)? })
            }
        }
    }

    fn moment(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        self.refuse(&["direction", "window", "box", "polygon", "component"], "`moment`")?;
        let of = self.holder("moment", of)?;
        let remedy = "add about = [x, y], the point that the moment is taken about";
        let about = self.required(&self.raw.about, "about", remedy, whole)?;
        Ok(Target::Moment { of, about: self.source.vector(about, (self.table, "about"))? })
    }

    fn stress(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        self.refuse(&["window", "about"], "`stress`")?;
        let name = self.source.name(of, (self.table, "stress"), "name a body")?;
        let Some(body) = self.named.bodies.iter().position(|body| body.name == name) else {
            return self.unknown("stress", of, "body", names(self.named.bodies.iter().map(|b| b.name.as_str())));
        };
        let one_of = |first, second, both| Fault::OneOf { table: self.table.to_owned(), first, second, both };
        let region = match (&self.raw.corners, &self.raw.polygon) {
            (None, None) => Region::Whole,
            (Some(corners), None) => Region::Polygon(self.corners(corners)?),
            (None, Some(polygon)) => Region::Polygon(self.polygon(polygon)?),
            (Some(corners), Some(polygon)) => {
                let error = self.source.error(polygon.span(), one_of("`box`", "`polygon`", true));
                return Err(error.with_related(corners.span(), "the other one"));
            }
        };
        let component = match (&self.raw.component, &self.raw.direction) {
            (Some(word), None) => self.component(word)?,
            (None, Some(direction)) => Component::along(self.direction(direction)?),
            (None, None) => return self.fail(whole, one_of("`component`", "`direction`", false)),
            (Some(word), Some(direction)) => {
                let error = self.source.error(direction.span(), one_of("`component`", "`direction`", true));
                return Err(error.with_related(word.span(), "the other one"));
            }
        };
        Ok(Target::Stress { body, region, component })
    }

    /// Refuses the first of `keys` that is there; `other` is what it does not go with.
    fn refuse(&self, keys: &[&'static str], other: &'static str) -> Result<(), SceneError> {
        let RawQuantity { direction, about, window, corners, polygon, component, .. } = self.raw;
        for &key in keys {
            let (span, remedy) = match key {
                "direction" => (direction.as_ref().map(At::span), "delete `direction`; a moment in the plane has none"),
                "about" => (about.as_ref().map(At::span), "delete `about`; only a `moment` is about a point"),
                "window" => (window.as_ref().map(At::span), "delete `window`; only the `force` of a contact has one"),
                "box" => (corners.as_ref().map(At::span), "delete `box`; only a `stress` is taken over a region"),
                "polygon" => {
                    (polygon.as_ref().map(At::span), "delete `polygon`; only a `stress` is taken over a region")
                }
                _ => (
                    component.as_ref().map(At::span),
                    "delete `component`; a `stress` has components, others a `direction`",
                ),
            };
            if let Some(span) = span {
                return self.misplaced(key, span, other, remedy);
            }
        }
        Ok(())
    }

    fn misplaced<T>(
        &self,
        key: &'static str,
        span: Range<usize>,
        other: &'static str,
        remedy: &'static str,
    ) -> Result<T, SceneError> {
        self.fail(span, Fault::Misplaced { key, table: self.table.to_owned(), other, remedy })
    }

    fn required<'v, V>(
        &self,
        value: &'v Option<V>,
        key: &str,
        remedy: &str,
        whole: Range<usize>,
    ) -> Result<&'v V, SceneError> {
        let fault = || Fault::MissingKey { key: key.into(), table: self.table.into(), remedy: remedy.into() };
        value.as_ref().ok_or_else(|| self.source.error(whole, fault()))
    }

    fn unknown<T>(
        &self,
        key: &'static str,
        of: &At<String>,
        kinds: &'static str,
        known: Vec<String>,
    ) -> Result<T, SceneError> {
        let (table, found) = (self.table.to_owned(), of.value.clone());
        self.fail(of.span(), QuantityFault::Unknown { key, table, found, kinds, known })
    }

    fn ambiguous<T>(&self, key: &'static str, of: &At<String>, owners: Vec<String>) -> Result<T, SceneError> {
        let (table, found) = (self.table.to_owned(), of.value.clone());
        self.fail(of.span(), QuantityFault::Ambiguous { key, table, found, owners })
    }

    /// The contact or support that a name means.
    fn holder(&self, key: &'static str, of: &At<String>) -> Result<Holder, SceneError> {
        let name =
            self.source.name(of, (self.table, key), "name a contact, one of its sides, or a supported boundary")?;
        let Conditions { supports, contacts, .. } = self.named.conditions;
        let called = contacts.iter().enumerate().filter(|(_, contact)| contact.name() == name);
        let mut found: Vec<Holder> = called.map(|(i, _)| Holder::Contact(i)).collect();
        found.extend(self.named.conditions.owner(&name).filter(|owner| !found.contains(owner)));
        match found.as_slice() {
            [holder] => Ok(*holder),
            [] => {
                let supports = supports.iter().map(|support| support.on.clone());
                let known: Vec<String> = contacts.iter().map(|contact| contact.name()).chain(supports).collect();
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

    fn direction(&self, direction: &Pair) -> Result<[f64; 2], SceneError> {
        self.source.unit(direction, (self.table, "direction"), "write the direction that is meant, like [1.0, 0.0]")
    }

    fn component(&self, word: &At<String>) -> Result<Component, SceneError> {
        match word.value.as_str() {
            "xx" => Ok(Component([1.0, 0.0, 0.0])),
            "yy" => Ok(Component([0.0, 1.0, 0.0])),
            "xy" => Ok(Component([0.0, 0.0, 1.0])),
            other => {
                let known = ["xx", "yy", "xy"].map(String::from).to_vec();
                let (table, found) = (self.table.to_owned(), other.to_owned());
                self.fail(word.span(), Fault::UnknownWord { key: "component", table, found, known })
            }
        }
    }

    /// A weight that is 0 or 1 at every end of the side and continuous between: the mean of a pressure over a part with
    /// sharp ends is not bounded by its energy. How long the side is only the mesh tells, so a window that goes up to
    /// its far end says so by s2 and s3 beyond it.
    fn window(&self, list: &At<Vec<f64>>) -> Result<[f64; 4], SceneError> {
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
            _ if s0 == s1 && s1 > 0.0 => SHARP,
            _ if s2 == s3 => SHARP_AT_END,
            _ if s3 <= 0.0 => NOTHING,
            _ => return Ok(window),
        };
        let found = self.source.written(list.span());
        self.fail(list.span(), QuantityFault::Window { table: table(), found, rule, remedy })
    }

    fn corners(&self, raw: &At<Vec<Pair>>) -> Result<Vec<[f64; 2]>, SceneError> {
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

    fn polygon(&self, raw: &At<Vec<Pair>>) -> Result<Vec<[f64; 2]>, SceneError> {
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

const DIRECTION_OF_DISPLACEMENT: &str = "add the direction of the displacement, for instance direction = [1.0, 0.0]";
const DIRECTION_OF_FORCE: &str =
    "add the direction in which the force of the support is taken, for instance direction = [1.0, 0.0]";

const DESCENDING: (&str, &str) =
    ("the arc lengths of a window do not descend", "write [s0, s1, s2, s3] with s0 < s1 ≤ s2 < s3");
const SHARP: (&str, &str) = (
    "a weight that jumps (s0 = s1) inside the side is no bounded functional",
    "take a trapezoid, s0 < s1; at the beginning of the side, s = 0, the two may be equal",
);
const SHARP_AT_END: (&str, &str) = (
    "a weight that jumps (s2 = s3) is no bounded functional",
    "take a trapezoid, s2 < s3; for a window up to the end of the side let both lie beyond it",
);
const NOTHING: (&str, &str) = (
    "the side begins at s = 0, so nothing of it lies in this window",
    "measure s along the first side, from its end that comes first in (x, y) order",
);
