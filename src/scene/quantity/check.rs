//! `[[quantities]]` → [`Quantity`]: what a quantity names exists, and its functional is bounded.

use std::collections::HashMap;
use std::ops::Range;

use super::fault::KINDS;
use super::{Component, Extent, Holder, Quantity, QuantityFault, RawQuantity, Region, Target};
use crate::scene::keys::conditions::Conditions;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::fault::names;
use crate::scene::reading::raw::{At, RawScene};
use crate::scene::reading::source::Source;
use crate::scene::reading::text::acts;
use crate::scene::{Body, BoundaryUse, Kinematics};

/// Parts of the scene that quantities may name.
pub(super) struct Named<'a> {
    pub kinematics: Kinematics,
    pub bodies: &'a [Body],
    pub conditions: &'a Conditions,
    /// Names of the polygon edges; `None` where only a mesh file knows them.
    pub edges: Option<Vec<String>>,
}

/// Checks the list, in the order of the file.
pub(in crate::scene) fn quantities(
    raw: &RawScene,
    edges: Option<Vec<String>>,
    bodies: &[Body],
    conditions: &Conditions,
    source: &Source,
) -> Result<Vec<Quantity>, SceneError> {
    let kinematics = Kinematics::named(&raw.model.value.0.kinematics.value).unwrap_or(Kinematics::PlaneStrain);
    let named = Named { kinematics, bodies, conditions, edges };
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
pub(super) struct Context<'a> {
    pub raw: &'a RawQuantity,
    pub table: &'a str,
    pub named: &'a Named<'a>,
    pub source: &'a Source<'a>,
}

impl Context<'_> {
    pub(super) fn fail<T>(&self, span: Range<usize>, fault: impl Into<Fault>) -> Result<T, SceneError> {
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
        if raw.stress_intensity.is_none() {
            self.refuse(&["tip"], "this quantity")?;
        }
        match [&raw.displacement, &raw.force, &raw.moment, &raw.stress, &raw.stress_intensity] {
            [Some(of), None, None, None, None] => self.displacement(of, whole),
            [None, Some(of), None, None, None] => self.force(of, whole),
            [None, None, Some(of), None, None] => self.moment(of, whole),
            [None, None, None, Some(of), None] => self.stress(of, whole),
            [None, None, None, None, Some(of)] => self.stress_intensity(of, whole),
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
        if let Some(point) = &self.raw.point {
            return self.displacement_at(of, point, whole);
        }
        self.refuse(&["window", "about", "box", "polygon", "component", "smoothness"], "`displacement`")?;
        let name = self.source.name(of, (self.table, "displacement"), "name a boundary or a body")?;
        let body = self.named.bodies.iter().position(|body| body.name == name);
        let boundary = match &self.named.edges {
            Some(edges) => edges.binary_search(&name).is_ok(),
            // A mesh file may have any boundary; those of conditions it has to have.
            None => body.is_none() || self.named.conditions.have(&name),
        };
        if self.named.conditions.bonds.iter().any(|bond| bond.stiffness.is_none() && bond.sides.contains(&name)) {
            let remedy = "take the mean over a body, over a boundary that is no side of one, or of a stress beside it";
            return self.misplaced(
                "displacement",
                of.span(),
                "a side of a rigid bond, which is inside the bonded body",
                remedy,
            );
        }
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
        self.refuse(&["about", "box", "polygon", "point", "smoothness"], "`force`")?;
        match self.holder("force", of)? {
            Holder::Contact(contact) => {
                let tangential = self.is_tangential(contact)?;
                if let Some(direction) = &self.raw.direction {
                    let remedy = "delete `direction`: the force of a contact is the normal force that presses its sides together";
                    return self.misplaced("direction", direction.span(), "the force of a contact", remedy);
                }
                let window = self.raw.window.as_ref().map(|window| self.window(window)).transpose()?;
                Ok(Target::ContactForce { contact, tangential, window })
            }
            Holder::Support(support) => {
                self.refuse(&["component"], "the force of a support")?;
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
        self.refuse(&["direction", "window", "box", "polygon", "component", "point", "smoothness"], "`moment`")?;
        let of = self.holder("moment", of)?;
        let remedy = "add about = [x, y], the point that the moment is taken about";
        let about = self.required(&self.raw.about, "about", remedy, whole)?;
        Ok(Target::Moment { of, about: self.source.vector(about, (self.table, "about"))? })
    }

    fn stress(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        if let Some(point) = &self.raw.point {
            return self.stress_at(of, point, whole);
        }
        self.refuse(&["window", "about", "smoothness"], "`stress`")?;
        let body = self.body("stress", of)?;
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

    /// The body that a name means.
    pub(super) fn body(&self, key: &'static str, of: &At<String>) -> Result<usize, SceneError> {
        let name = self.source.name(of, (self.table, key), "name a body")?;
        match self.named.bodies.iter().position(|body| body.name == name) {
            Some(body) => Ok(body),
            None => self.unknown(key, of, "body", names(self.named.bodies.iter().map(|b| b.name.as_str()))),
        }
    }

    /// Refuses the first of `keys` that is there; `other` is what it does not go with.
    pub(super) fn refuse(&self, keys: &[&'static str], other: &'static str) -> Result<(), SceneError> {
        let RawQuantity { direction, about, window, corners, polygon, component, point, smoothness, tip, .. } =
            self.raw;
        for &key in keys {
            let (span, remedy) = match key {
                "direction" => (direction.as_ref().map(At::span), "delete `direction`; a moment in the plane has none"),
                "about" => (about.as_ref().map(At::span), "delete `about`; only a `moment` is about a point"),
                "window" => (window.as_ref().map(At::span), "delete `window`; only the `force` of a contact has one"),
                "box" => (corners.as_ref().map(At::span), "delete `box`; only a `stress` is taken over a region"),
                "polygon" => {
                    (polygon.as_ref().map(At::span), "delete `polygon`; only a `stress` is taken over a region")
                }
                "point" => (
                    point.as_ref().map(At::span),
                    "delete `point`; only a `displacement` or a `stress` is taken at a point",
                ),
                "tip" => (tip.as_ref().map(At::span), "delete `tip`; only a `stress_intensity` has one"),
                "smoothness" => {
                    (smoothness.as_ref().map(At::span), "delete `smoothness`; only a value at a `point` has one")
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

    pub(super) fn misplaced<T>(
        &self,
        key: &'static str,
        span: Range<usize>,
        other: &'static str,
        remedy: &'static str,
    ) -> Result<T, SceneError> {
        self.fail(span, Fault::Misplaced { key, table: self.table.to_owned(), other, remedy })
    }

    pub(super) fn required<'v, V>(
        &self,
        value: &'v Option<V>,
        key: &str,
        remedy: &str,
        whole: Range<usize>,
    ) -> Result<&'v V, SceneError> {
        let fault = || Fault::MissingKey { key: key.into(), table: self.table.into(), remedy: remedy.into() };
        value.as_ref().ok_or_else(|| self.source.error(whole, fault()))
    }

    pub(super) fn unknown<T>(
        &self,
        key: &'static str,
        of: &At<String>,
        kinds: &'static str,
        known: Vec<String>,
    ) -> Result<T, SceneError> {
        let (table, found) = (self.table.to_owned(), of.value.clone());
        self.fail(of.span(), QuantityFault::Unknown { key, table, found, kinds, known })
    }

    pub(super) fn ambiguous<T>(
        &self,
        key: &'static str,
        of: &At<String>,
        owners: Vec<String>,
    ) -> Result<T, SceneError> {
        let (table, found) = (self.table.to_owned(), of.value.clone());
        self.fail(of.span(), QuantityFault::Ambiguous { key, table, found, owners })
    }
}

pub(super) const DIRECTION_OF_DISPLACEMENT: &str =
    "add the direction of the displacement, for instance direction = [1.0, 0.0]";
const DIRECTION_OF_FORCE: &str =
    "add the direction in which the force of the support is taken, for instance direction = [1.0, 0.0]";
