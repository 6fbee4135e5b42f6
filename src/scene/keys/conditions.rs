//! Supports, tractions and contacts: every boundary exists and carries one condition.

use std::collections::HashMap;
use std::ops::Range;

use super::bonds::{Bond, bond};
use super::friction::friction;
use super::obstacle::obstacle;
use super::range::ordered;
use super::springs::{no_stiffness, spring, stiffness_of};
use super::table::table_of;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::fault::names;
use crate::scene::reading::raw::{
    At, RawAffine, RawContact, RawCurve, RawDisplacement, RawGap, RawScene, RawSupport, RawTerm, RawTraction, Table,
};
use crate::scene::reading::source::{Source, counted};
use crate::scene::{
    Affine, Boundary, Contact, ContactSides, Gap, Load, MeshSource, Normals, Support, SupportKind, Term, Touching,
    Traction,
};

const NAME_A_BOUNDARY: &str = "name the boundary that is meant; an edge without a name cannot carry a condition";

/// Conditions on the boundaries.
pub(in crate::scene) struct Conditions {
    pub supports: Vec<Support>,
    pub tractions: Vec<Traction>,
    pub contacts: Vec<Contact>,
    pub bonds: Vec<Bond>,
}

/// Checks the three lists, in the order of the file within each.
/// `known` has the names of the edges, sorted; `None` where only a mesh file knows them.
pub(in crate::scene) fn conditions(
    raw: &RawScene,
    known: Option<Vec<String>>,
    source: &Source,
) -> Result<Conditions, SceneError> {
    let mut taken = Taken { source, known, by: HashMap::new() };
    let supports = each(&raw.supports, "supports", |raw, table| support(raw, table, &mut taken))?;
    let tractions = each(&raw.tractions, "tractions", |raw, table| traction(raw, table, &mut taken))?;
    let contacts = each(&raw.contacts, "contacts", |raw, table| contact(raw, table, &mut taken))?;
    let bonds = each(&raw.bonds, "bonds", |raw, table| bond(raw, table, &mut taken))?;
    Ok(Conditions { supports, tractions, contacts, bonds })
}

fn each<R, T>(
    list: &[At<Table<R>>],
    key: &str,
    mut check: impl FnMut(&At<Table<R>>, &str) -> Result<T, SceneError>,
) -> Result<Vec<T>, SceneError> {
    list.iter().enumerate().map(|(i, raw)| check(raw, &format!("[[{key}]] number {}", i + 1))).collect()
}

/// The names of polygon edges and of `boundaries`, sorted; `None` where only a mesh file knows them.
pub(in crate::scene) fn edge_names(mesh: &MeshSource, boundaries: &[Boundary]) -> Option<Vec<String>> {
    match mesh {
        MeshSource::File(_) | MeshSource::Parts(_) => None,
        MeshSource::Geometry { polygons, .. } => {
            let edges = polygons.iter().flat_map(|p| &p.edges);
            Some(names(edges.chain(boundaries.iter().map(|boundary| &boundary.name)).map(String::as_str)))
        }
    }
}

/// The boundaries that have a condition already.
pub(in crate::scene) struct Taken<'a> {
    pub(in crate::scene) source: &'a Source<'a>,
    /// Names of the polygon edges; `None` where only a mesh file knows them.
    known: Option<Vec<String>>,
    by: HashMap<String, (String, Range<usize>)>,
}

impl Taken<'_> {
    /// The name, if it exists and is free; from now on it belongs to `table`.
    pub(in crate::scene) fn claim(&mut self, name: &At<String>, table: &str, key: &str) -> Result<String, SceneError> {
        let on = self.source.name(name, (table, key), NAME_A_BOUNDARY)?;
        if let Some(known) = &self.known
            && known.binary_search(&on).is_err()
        {
            let fault = Fault::UnknownBoundary { name: on, table: table.to_owned(), known: known.clone() };
            return Err(self.source.error(name.span(), fault));
        }
        if let Some((first, span)) = self.by.get(&on) {
            let line = self.source.line(span.start);
            let fault = Fault::TwoConditions { name: on, first: first.clone(), line, second: table.to_owned() };
            return Err(self.source.error(name.span(), fault).with_related(span.clone(), "the first condition"));
        }
        self.by.insert(on.clone(), (table.to_owned(), name.span()));
        Ok(on)
    }
}

fn support(raw: &At<Table<RawSupport>>, table: &str, taken: &mut Taken) -> Result<Support, SceneError> {
    let Table(support) = &raw.value;
    let source = taken.source;
    let word = support.kind.value.as_str();
    let kind = match word {
        "clamped" => {
            no_stiffness(support, table, source)?;
            if let Some(d) = &support.direction {
                let remedy = "delete `direction`, or write type = \"roller\", which holds one component";
                let (table, other) = (table.to_owned(), "type = \"clamped\", which holds both components");
                return Err(source.error(d.span(), Fault::Misplaced { key: "direction", table, other, remedy }));
            }
            let displacement = support.displacement.as_ref().map(|u| clamped(u, table, source)).transpose()?;
            SupportKind::Clamped { displacement: displacement.unwrap_or_default() }
        }
        "roller" => {
            no_stiffness(support, table, source)?;
            let remedy = "write the direction of the component that is held, like [1.0, 0.0]";
            let direction =
                support.direction.as_ref().map(|d| source.unit(d, (table, "direction"), remedy)).transpose()?;
            let displacement = support.displacement.as_ref().map(|u| roller(u, table, source)).transpose()?;
            SupportKind::Roller { direction, displacement: displacement.unwrap_or_default() }
        }
        "spring" => SupportKind::Spring { stiffness: spring(raw, table, source)? },
        other => {
            let known = ["clamped", "roller", "spring"].map(String::from).to_vec();
            let fault = Fault::UnknownWord { key: "type", table: table.to_owned(), found: other.to_owned(), known };
            return Err(source.error(support.kind.span(), fault));
        }
    };
    Ok(Support { on: taken.claim(&support.on, table, "on")?, kind })
}

/// The displacement of a clamped boundary.
fn clamped(u: &At<RawDisplacement>, table: &str, source: &Source) -> Result<Affine, SceneError> {
    match &u.value {
        RawDisplacement::Constant(vector) => {
            let vector = At { value: vector.clone(), start: u.start, end: u.end };
            source.vector(&vector, (table, "displacement")).map(Affine::constant)
        }
        RawDisplacement::Affine(field) => affine(field, (table, "displacement"), source),
        RawDisplacement::Component(_) => {
            let (key, table, found) = ("displacement".to_owned(), table.to_owned(), "one number".to_owned());
            let remedy = "write both components [ux, uy], or type = \"roller\", which holds one";
            Err(source.error(u.span(), Fault::Count { key, table, found, expected: "2 numbers".to_owned(), remedy }))
        }
    }
}

/// A field value + gradient · x, written as `key` of `table`.
pub(in crate::scene) fn affine(
    RawAffine { value, gradient }: &RawAffine,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<Affine, SceneError> {
    let value = value.as_ref().map(|value| source.vector(value, (table, &format!("{key}.value")))).transpose()?;
    let gradient = matrix(gradient, (table, &format!("{key}.gradient")), source)?;
    Ok(Affine { value: value.unwrap_or_default(), gradient })
}

/// The component that rollers prescribe.
fn roller(u: &At<RawDisplacement>, table: &str, source: &Source) -> Result<f64, SceneError> {
    match &u.value {
        RawDisplacement::Component(value) => {
            let number = At { value: *value, start: u.start, end: u.end };
            source.number(&number, (table, "displacement"), |_| true, ("", ""))
        }
        RawDisplacement::Constant(_) | RawDisplacement::Affine(_) => {
            let remedy = "write one number, the displacement along the outward normal or along `direction`, or write \
                          type = \"clamped\"";
            let (table, other) = (table.to_owned(), "type = \"roller\", which holds one component, as a vector");
            Err(source.error(u.span(), Fault::Misplaced { key: "displacement", table, other, remedy }))
        }
    }
}

fn traction(raw: &At<Table<RawTraction>>, table: &str, taken: &mut Taken) -> Result<Traction, SceneError> {
    let Table(traction) = &raw.value;
    let source = taken.source;
    let one_of = |both| Fault::OneOf { table: table.to_owned(), first: "`value`", second: "`pressure`", both };
    let misplaced = |other, remedy| Fault::Misplaced { key: "gradient", table: table.to_owned(), other, remedy };
    let load = match (&traction.value, &traction.gradient, &traction.pressure) {
        (Some(value), _, Some(pressure)) => {
            return Err(source.error(pressure.span(), one_of(true)).with_related(value.span(), "the other one"));
        }
        (None, Some(gradient), Some(_)) => {
            let remedy = "delete `gradient`, or write the load as `value` and `gradient`";
            return Err(source.error(gradient.span(), misplaced("`pressure`, which is constant", remedy)));
        }
        (None, Some(gradient), None) => {
            let remedy = "add value = [0.0, 0.0], the traction at the origin";
            return Err(source.error(gradient.span(), misplaced("a missing `value`", remedy)));
        }
        (None, None, None) => return Err(source.error(raw.span(), one_of(false))),
        (None, None, Some(pressure)) => {
            Load::Pressure(source.number(pressure, (table, "pressure"), |_| true, ("", ""))?)
        }
        (Some(value), gradient, None) => {
            let value = source.vector(value, (table, "value"))?;
            let gradient = gradient.as_ref().map(|rows| matrix(rows, (table, "gradient"), source)).transpose()?;
            Load::Affine(Affine { value, gradient: gradient.unwrap_or_default() })
        }
    };
    if let (Some(terms), Load::Pressure(_)) = (&traction.terms, load) {
        let (table, other) = (table.to_owned(), "`pressure`, which is constant");
        let remedy = "write the load as `value` and `terms`";
        return Err(source.error(terms.span(), Fault::Misplaced { key: "terms", table, other, remedy }));
    }
    let terms = traction.terms.iter().flat_map(|terms| &terms.value);
    let terms = terms.map(|raw| term(raw, table, source)).collect::<Result<_, _>>()?;
    Ok(Traction { on: taken.claim(&traction.on, table, "on")?, load, terms })
}

fn term(raw: &RawTerm, table: &str, source: &Source) -> Result<Term, SceneError> {
    let powers: [f64; 2] = source.vector(&raw.powers, (table, "terms.powers"))?;
    let total = powers[0] + powers[1];
    if !powers.iter().all(|p| *p >= 0.0 && p.fract() == 0.0) || !(2.0..=f64::from(Term::HIGHEST)).contains(&total) {
        let (table, key, found) = (table.to_owned(), "terms.powers".to_owned(), source.written(raw.powers.span()));
        let rule = "powers are whole numbers that add up to 2 … 6";
        let remedy = "write what is constant or linear as `value` and `gradient`";
        return Err(source.error(raw.powers.span(), Fault::Number { key, table, found, rule, remedy }));
    }
    Ok(Term { powers: powers.map(|p| p as u8), value: source.vector(&raw.value, (table, "terms.value"))? })
}

fn matrix(
    rows: &At<Vec<At<Vec<f64>>>>,
    (table, key): (&str, &str),
    source: &Source,
) -> Result<[[f64; 2]; 2], SceneError> {
    let [first, second] = rows.value.as_slice() else {
        let (key, found) = (key.to_owned(), counted(rows.value.len(), "row"));
        let remedy = "write the two rows [[∂Px/∂x, ∂Px/∂y], [∂Py/∂x, ∂Py/∂y]]";
        let fault = Fault::Count { key, table: table.to_owned(), found, expected: "2".to_owned(), remedy };
        return Err(source.error(rows.span(), fault));
    };
    let row = |row, i: usize| source.vector(row, (table, &format!("{key}[{i}]")));
    Ok([row(first, 0)?, row(second, 1)?])
}

fn contact(raw: &At<Table<RawContact>>, table: &str, taken: &mut Taken) -> Result<Contact, SceneError> {
    let Table(contact) = &raw.value;
    let source = taken.source;
    let one_of = |both| Fault::OneOf { table: table.to_owned(), first: "`between`", second: "`on`", both };
    let gap = contact.gap.as_ref().map_or(Ok(Gap::Constant(0.0)), |raw| gap(raw, contact, table, source))?;
    let sides = match (&contact.between, &contact.on) {
        (Some(between), Some(on)) => {
            return Err(source.error(on.span(), one_of(true)).with_related(between.span(), "the other one"));
        }
        (None, None) => return Err(source.error(raw.span(), one_of(false))),
        (None, Some(on)) => ContactSides::Rigid(taken.claim(on, table, "on")?),
        (Some(between), None) => {
            let remedy = "name the two boundaries that face each other, or write on = \"…\" for a rigid obstacle";
            ContactSides::Between(taken.between(between, table, remedy)?)
        }
    };
    let obstacle = obstacle(contact, table, source)?;
    let direction = contact.direction.as_ref().map(|d| direction(d, contact, table, source)).transpose()?;
    let stiffness = stiffness_of(contact, table, source)?;
    let (friction, coefficient) = friction(contact, table, source)?;
    if let (Some(raw), Some(_)) = (&contact.friction, stiffness) {
        let remedy = "delete one of the two: elastic contact slides freely";
        let (table, other) = (table.to_owned(), "`stiffness`, elastic contact");
        return Err(source.error(raw.span(), Fault::Misplaced { key: "friction", table, other, remedy }));
    }
    Ok(Contact {
        normals: normals(contact, table, source)?,
        direction,
        obstacle,
        stiffness,
        friction,
        coefficient,
        ..Contact::new(sides, gap)
    })
}

/// A unit vector for a contact between two sides.
fn direction(d: &At<Vec<f64>>, contact: &RawContact, table: &str, source: &Source) -> Result<[f64; 2], SceneError> {
    let remedy = "write the direction from the first side to the second, like [0.0, -1.0]";
    let unit = source.unit(d, (table, "direction"), remedy)?;
    let remedy =
        "delete `direction`; a rigid obstacle has the shape of the boundary, and `gap` says how far away it is";
    let misplaced = |other| Fault::Misplaced { key: "direction", table: table.to_owned(), other, remedy };
    if contact.on.is_some() {
        return Err(source.error(d.span(), misplaced("`on`, a rigid obstacle")));
    }
    if let Some(normals) = &contact.normals {
        let remedy = "keep one of the two: `direction` says along what contact acts, `normals` that its sides say so";
        let fault = Fault::Misplaced { key: "normals", table: table.to_owned(), other: "`direction`", remedy };
        return Err(source.error(normals.span(), fault));
    }
    Ok(unit)
}

fn normals(contact: &RawContact, table: &str, source: &Source) -> Result<Normals, SceneError> {
    let Some(word) = &contact.normals else { return Ok(Normals::default()) };
    match word.value.as_str() {
        "smooth" => Ok(Normals::Smooth),
        "facets" => Ok(Normals::Facets),
        other => {
            let known = ["facets", "smooth"].map(String::from).to_vec();
            let fault = Fault::UnknownWord { key: "normals", table: table.to_owned(), found: other.to_owned(), known };
            Err(source.error(word.span(), fault))
        }
    }
}

fn gap(raw: &At<RawGap>, contact: &RawContact, table: &str, source: &Source) -> Result<Gap, SceneError> {
    const NEGATIVE: (&str, &str) = (
        "the sides must not overlap at the start",
        "write a gap of zero or more; an interference fit is one number below zero, between two sides",
    );
    let rows = match &raw.value {
        RawGap::Constant(g) => {
            let number = At { value: *g, start: raw.start, end: raw.end };
            // One number below zero for the whole of two sides is an interference fit.
            let may_overlap = contact.between.is_some();
            return source.number(&number, (table, "gap"), |g| may_overlap || g >= 0.0, NEGATIVE).map(Gap::Constant);
        }
        RawGap::Range(ends) => {
            let may_overlap = contact.between.is_some();
            let [low, high] = ordered(ends, raw.span(), (table, "gap"), source)?;
            for value in [low, high] {
                let number = At { value, start: raw.start, end: raw.end };
                source.number(&number, (table, "gap"), |g| may_overlap || g >= 0.0, NEGATIVE)?;
            }
            // The end of the lowest energy.
            return Ok(Gap::Constant(high));
        }
        RawGap::Curve(curve) => return touching(curve, raw, table, source),
        RawGap::Table(rows) => rows,
    };
    table_of(rows, raw.span(), (table, "gap"), NEGATIVE, source).map(Gap::Table)
}

fn touching(curve: &RawCurve, raw: &At<RawGap>, table: &str, source: &Source) -> Result<Gap, SceneError> {
    const RADIUS: (&str, &str) = ("a radius must be positive", "write the radius of the curve that touches the side");
    const ARC: (&str, &str) = (
        "an arc length is not negative",
        "measure s along the first side, from its end that comes first in (x, y) order",
    );
    let one_of =
        |both| Fault::OneOf { table: format!("gap of {table}"), first: "`circle`", second: "`parabola`", both };
    let number = |value: f64, key: &str, test: fn(f64) -> bool, words| {
        source.number(&At { value, start: raw.start, end: raw.end }, (table, key), test, words)
    };
    let at = number(curve.at, "gap.at", |s| s >= 0.0, ARC)?;
    let radius = |value: f64, key: &str| number(value, key, |r| r > 0.0, RADIUS);
    match (curve.circle, curve.parabola) {
        (Some(r), None) => Ok(Gap::Circle(Touching { radius: radius(r, "gap.circle")?, at })),
        (None, Some(r)) => Ok(Gap::Parabola(Touching { radius: radius(r, "gap.parabola")?, at })),
        (circle, _) => Err(source.error(raw.span(), one_of(circle.is_some()))),
    }
}
