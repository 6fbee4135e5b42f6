//! The faults a scene text can have, with their words.

use super::nearest::suggestion;
use crate::scene::quantity::QuantityFault;

/// Keys with which a traction would be a force at a point, and tables that would list such forces.
const POINT_LOADS: [&str; 6] = ["point", "force", "node", "nodes", "vertex", "at"];
const POINT_TABLES: [&str; 6] = ["forces", "point_loads", "loads", "nodal_forces", "cload", "point_forces"];

/// Faults inside a scene file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Fault {
    /// No key at all.
    #[error("the scene is empty")]
    Empty,
    /// Not TOML.
    #[error("this is not valid TOML: {message}")]
    Syntax {
        /// The TOML parser's words.
        message: String,
    },
    /// A key that the format does not have.
    #[error("unknown key `{key}` in {table}")]
    UnknownKey {
        /// As written.
        key: String,
        /// `[model]`, `[[supports]] number 2`, …
        table: String,
        /// The keys that exist there.
        known: Vec<String>,
    },
    /// A key that has to be there.
    #[error("{table} has no `{key}`")]
    MissingKey {
        /// The key.
        key: String,
        /// Where it belongs.
        table: String,
        /// The remedy.
        remedy: String,
    },
    /// A value of another type.
    #[error("`{key}` in {table} is {found}")]
    WrongType {
        /// The key.
        key: String,
        /// Its table.
        table: String,
        /// The value found there, in words.
        found: String,
        /// The value expected there, in words.
        expected: String,
    },
    /// A word out of a fixed list was expected.
    #[error("`{key}` in {table} is \"{found}\", which is not known")]
    UnknownWord {
        /// The key.
        key: &'static str,
        /// Its table.
        table: String,
        /// As written.
        found: String,
        /// The words that exist.
        known: Vec<String>,
    },
    /// A number outside its range.
    #[error("`{key}` in {table} is {found}, but {rule}")]
    Number {
        /// The key.
        key: String,
        /// Its table.
        table: String,
        /// As written.
        found: String,
        /// The rule that the number breaks.
        rule: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// A point, vector or matrix of another size.
    #[error("`{key}` in {table} has {found}, not {expected}")]
    Count {
        /// The key.
        key: String,
        /// Its table.
        table: String,
        /// `3 components`, …
        found: String,
        /// `2`, …
        expected: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// Two keys that exclude each other, or neither of them.
    #[error("{}", one_of(.table, .first, .second, .both))]
    OneOf {
        /// Where.
        table: String,
        /// One of them, in its quotes or brackets.
        first: &'static str,
        /// The other.
        second: &'static str,
        /// Both given, or none.
        both: bool,
    },
    /// A key that does not go with what else is said there.
    #[error("`{key}` in {table} does not go with {other}")]
    Misplaced {
        /// The key.
        key: &'static str,
        /// Its table.
        table: String,
        /// The key, table or value it clashes with.
        other: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// An empty file, body or boundary name.
    #[error("`{key}` in {table} is an empty string")]
    EmptyName {
        /// The key.
        key: String,
        /// Its table.
        table: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// No body at all.
    #[error("the scene has no body")]
    NoBodies,
    /// A polygon of a body without a table.
    #[error("polygon {polygon} belongs to body \"{name}\", which has no [bodies.{name}] table")]
    UnknownBody {
        /// As written.
        name: String,
        /// Polygon, from 1.
        polygon: usize,
        /// The bodies that have a table.
        known: Vec<String>,
    },
    /// A name that no body has.
    #[error("{table} names the body \"{name}\", which the scene does not have")]
    NoSuchBody {
        /// As written.
        name: String,
        /// Its table.
        table: String,
        /// The bodies of the scene.
        known: Vec<String>,
    },
    /// A body without a polygon.
    #[error("body \"{name}\" has a table but no polygon")]
    BodyWithoutPolygon {
        /// As written.
        name: String,
        /// The bodies that polygons name.
        known: Vec<String>,
    },
    /// A polygon that bounds no region.
    #[error("polygon {polygon} (body \"{body}\") {problem}")]
    Polygon {
        /// Polygon, from 1.
        polygon: usize,
        /// Its body.
        body: String,
        /// The defect of the polygon.
        problem: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// An invalid arc.
    #[error("an arc of {table} {problem}")]
    Arc {
        /// Its polygon.
        table: String,
        /// The defect of the arc.
        problem: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// A condition on a boundary that no edge has.
    #[error("{table} is on \"{name}\", but no polygon edge has that name")]
    UnknownBoundary {
        /// As written.
        name: String,
        /// The table of the condition.
        table: String,
        /// The edge names of the geometry.
        known: Vec<String>,
    },
    /// A boundary with two conditions.
    #[error("boundary \"{name}\" has two conditions: {first} (line {line}) and {second}")]
    TwoConditions {
        /// The boundary.
        name: String,
        /// The table met first.
        first: String,
        /// Its line, from 1.
        line: usize,
        /// The table met second.
        second: String,
    },
    /// Both sides of a contact are the same boundary.
    #[error("{table} is between \"{name}\" and itself")]
    SelfContact {
        /// The boundary.
        name: String,
        /// The contact.
        table: String,
    },
    /// A table of a function of the arc length out of order.
    #[error("row {row} of the {key} table in {table} has s = {s}, {relation} the row before it")]
    GapOrder {
        /// Row, from 1.
        row: usize,
        /// The key whose value is given by rows.
        key: &'static str,
        /// The contact.
        table: String,
        /// Arc length, as written.
        s: String,
        /// `the same as` or `less than`.
        relation: &'static str,
    },
    /// An invalid quantity.
    #[error(transparent)]
    Quantity(#[from] QuantityFault),
}

impl Fault {
    /// The remedy, as one clause.
    pub fn remedy(&self) -> String {
        match self {
            Fault::Empty => "a scene needs at least [model], [bodies.NAME] and [mesh] or [geometry]".into(),
            Fault::Syntax { message } => syntax_remedy(message).into(),
            Fault::UnknownKey { key, table, .. } if key == "at" && table.starts_with("[[quantities]]") => {
                "write `point = [x, y]` for the value at a point inside a body; of the largest value of anything no interval can be guaranteed".into()
            }
            Fault::UnknownKey { key, table, .. }
                if (table.starts_with("[[tractions]]") && POINT_LOADS.contains(&key.as_str()))
                    || (table == "the scene" && POINT_TABLES.contains(&key.as_str())) =>
            {
                "a force at a point has infinite energy, so that no bracket exists and codes give what their mesh gives; spread the same \
                 resultant over an edge: name a short one there in [[tractions]] and give it the force over its area as `value`"
                    .into()
            }
            Fault::UnknownKey { key, known, .. } => suggestion(key, known, "keys known here", '`'),
            Fault::MissingKey { remedy, .. } => remedy.clone(),
            Fault::WrongType { expected, .. } => format!("write {expected}"),
            Fault::UnknownWord { found, known, .. } => suggestion(found, known, "known are", '"'),
            Fault::Number { remedy, .. }
            | Fault::Count { remedy, .. }
            | Fault::Misplaced { remedy, .. }
            | Fault::EmptyName { remedy, .. }
            | Fault::Polygon { remedy, .. }
            | Fault::Arc { remedy, .. } => (*remedy).into(),
            Fault::OneOf { first, second, both: true, .. } => format!("keep {first} or {second} and delete the other"),
            Fault::OneOf { first, second, both: false, .. } => format!("give one of them, {first} or {second}"),
            Fault::NoBodies => "add one table [bodies.NAME] with `young` and `poisson` for each body".into(),
            Fault::UnknownBody { name, known, .. } => {
                format!("{}; or add a table [bodies.{name}]", suggestion(name, known, "bodies with a table", '"'))
            }
            Fault::NoSuchBody { name, known, .. } => suggestion(name, known, "bodies", '"'),
            Fault::BodyWithoutPolygon { name, known } => {
                let named = suggestion(name, known, "bodies that polygons name", '"');
                format!("{named}; or add a [[geometry.polygons]] with body = \"{name}\", or delete the table")
            }
            Fault::UnknownBoundary { name, known, .. } => suggestion(name, known, "edge names", '"'),
            Fault::TwoConditions { .. } => {
                "keep one of them, or split the edge and give the parts names of their own".into()
            }
            Fault::SelfContact { .. } => {
                "a contact or a bond has two sides that face each other: give each a name of its own, and name both".into()
            }
            Fault::GapOrder { .. } => "sort the rows so that the arc length s increases strictly".into(),
            Fault::Quantity(fault) => fault.remedy(),
        }
    }

    /// The words to write under the place in the file.
    pub fn label(&self) -> String {
        match self {
            Fault::Empty | Fault::NoBodies => "nothing here",
            Fault::Syntax { .. } => "the parser stopped here",
            Fault::UnknownKey { .. } | Fault::UnknownWord { .. } => "not known",
            Fault::MissingKey { key, .. } => return format!("`{key}` is missing here"),
            Fault::WrongType { expected, .. } => return format!("expected {expected}"),
            Fault::Number { rule, .. } => rule,
            Fault::Count { expected, .. } => return format!("expected {expected}"),
            Fault::OneOf { both: true, .. } | Fault::Misplaced { .. } => "one too many",
            Fault::OneOf { both: false, .. } => "one is missing here",
            Fault::EmptyName { .. } => "empty",
            Fault::UnknownBody { .. } | Fault::NoSuchBody { .. } => "no table of this name",
            Fault::BodyWithoutPolygon { .. } => "no polygon of this name",
            Fault::Polygon { .. } | Fault::Arc { .. } => "here",
            Fault::UnknownBoundary { .. } => "no edge of this name",
            Fault::TwoConditions { .. } => "the second condition",
            Fault::SelfContact { .. } => "twice the same",
            Fault::GapOrder { .. } => "out of order",
            Fault::Quantity(fault) => return fault.label(),
        }
        .into()
    }
}

fn one_of(table: &str, first: &str, second: &str, both: &bool) -> String {
    if *both {
        format!("{table} has both {first} and {second}")
    } else {
        format!("{table} has neither {first} nor {second}")
    }
}

fn syntax_remedy(message: &str) -> &'static str {
    if message.contains("duplicate") {
        "keep one of the two and delete the other"
    } else if message.contains("unquoted key") {
        "put double quotes around a name that has blanks or letters other than A-Z, a-z, 0-9, - and _"
    } else if message.contains("recursion") {
        "nest no deeper than the scene format does"
    } else {
        "correct it: key = value, text in double quotes, lists in [ ], tables headed by [name] or [[name]]"
    }
}

/// Known names for a message, for the other modules of the scene.
pub(in crate::scene) fn names<'a>(known: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = known.into_iter().filter(|name| !name.is_empty()).map(str::to_owned).collect();
    names.sort();
    names.dedup();
    names
}
