//! Text → TOML types, with serde's complaints put into the words of the scene format.

use std::ops::Range;
use std::path::Path;

use toml::de::{DeTable, DeValue};

use super::error::{Fault, SceneError};
use super::raw::RawScene;

/// Reads the text as far as TOML and its types go; `path` is for messages.
pub(in crate::scene) fn parse(text: &str, path: &Path) -> Result<RawScene, SceneError> {
    let fail = |span, fault| Err(SceneError::at(path, text, span, fault));
    let document = match DeTable::parse(text) {
        Ok(document) => document,
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            return fail(span, Fault::Syntax { message: error.message().to_owned() });
        }
    };
    if document.get_ref().is_empty() {
        return fail(0..0, Fault::Empty);
    }
    match toml::from_str(text) {
        Ok(raw) => Ok(raw),
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let at = locate(document.get_ref(), &span);
            // A missing top-level table is missing everywhere; point at the first line, not at the whole file.
            let shown = if at.key.is_empty() && at.root { 0..0 } else { span };
            let written = text.get(shown.clone()).unwrap_or_default();
            fail(shown, reword(error.message(), at, written))
        }
    }
}

/// Names of a span of the file.
struct Named {
    /// `[bodies.left]`, `[[supports]] number 2`, `the scene`.
    table: String,
    /// `young`, `points[3]`, or empty where the span is the table itself.
    key: String,
    /// Where the span is the table itself: the table that it stands in, and its key there.
    own: Option<(String, String)>,
    /// True if the table is the whole document.
    root: bool,
}

impl Named {
    fn key(table: &str, key: &str) -> Self {
        Self { table: table.to_owned(), key: key.to_owned(), own: None, root: false }
    }

    fn table(table: &str, (outer, key): (&str, &str)) -> Self {
        let own = Some((outer.to_owned(), key.to_owned()));
        Self { table: table.to_owned(), key: String::new(), own, root: false }
    }
}

/// The innermost table and key whose text contains `span`.
fn locate(root: &DeTable<'_>, span: &Range<usize>) -> Named {
    fn within(inner: &Range<usize>, outer: &Range<usize>) -> bool {
        outer.start <= inner.start && inner.end <= outer.end && !outer.is_empty()
    }
    fn in_table(table: &DeTable<'_>, path: &str, label: &str, span: &Range<usize>) -> Option<Named> {
        table.iter().find_map(|(key, value)| {
            let name = key.get_ref();
            let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
            if within(span, &key.span()) {
                return Some(Named::key(label, name));
            }
            in_value(value, &path, label, name, span)
        })
    }
    fn in_value(
        value: &toml::Spanned<DeValue<'_>>,
        path: &str,
        label: &str,
        key: &str,
        span: &Range<usize>,
    ) -> Option<Named> {
        let table = |table: &DeTable<'_>, name: &str, whole: &Range<usize>| {
            let itself = || Named::table(name, (label, key));
            in_table(table, path, name, span).or_else(|| within(span, whole).then(itself))
        };
        let deeper = match value.get_ref() {
            DeValue::Table(fields) => return table(fields, &format!("[{path}]"), &value.span()),
            DeValue::Array(items) => items.iter().enumerate().find_map(|(i, item)| match item.get_ref() {
                DeValue::Table(fields) => table(fields, &format!("[[{path}]] number {}", i + 1), &item.span()),
                _ => in_value(item, path, label, &format!("{key}[{i}]"), span),
            }),
            _ => None,
        };
        deeper.or_else(|| within(span, &value.span()).then(|| Named::key(label, key)))
    }
    let whole = || Named { table: "the scene".to_owned(), key: String::new(), own: None, root: true };
    in_table(root, "", "the scene", span).unwrap_or_else(whole)
}

/// Serde's message as a fault of the scene format; `written` is the text it is about.
fn reword(message: &str, at: Named, written: &str) -> Fault {
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    if message.starts_with("unknown field") {
        let key = quoted.next().unwrap_or_default();
        return Fault::UnknownKey { key, table: at.table, known: quoted.collect() };
    }
    if message.starts_with("missing field") {
        let key = quoted.next().unwrap_or_default();
        return Fault::MissingKey { remedy: what_to_add(&key).to_owned(), key, table: at.table };
    }
    let (found, expected) = match message.split_once(", expected ") {
        Some((found, expected)) => (type_name(found.trim_start_matches("invalid type: ")), type_name(expected)),
        None => (format!("{written} ({message})"), "a value within the range of double precision".to_owned()),
    };
    let Some((table, key)) = at.own else {
        return Fault::WrongType { key: at.key, table: at.table, found, expected };
    };
    let header = at.table.split(" number").next().unwrap_or_default();
    let expected = match (header.starts_with("[["), expected.as_str()) {
        (true, "a table") if key == "bodies" => "one table for each body, headed [bodies.NAME]".to_owned(),
        (true, "a table") => {
            format!("one table, headed {} in single brackets", header.replace("[[", "[").replace("]]", "]"))
        }
        (false, "a list in [ ]") => format!("a list of tables, each headed [{header}] in double brackets"),
        _ => expected,
    };
    Fault::WrongType { key, table, found, expected }
}

/// Serde's type names in TOML's words.
fn type_name(words: &str) -> String {
    let plain = match words {
        "f64" | "f32" => "a number",
        "map" | "a map" => "a table",
        "sequence" | "a sequence" => "a list in [ ]",
        "a string" | "string" => "text in double quotes",
        "option" => "a value",
        _ => words,
    };
    let plain = plain.replace("floating point `", "the number `").replace("boolean `", "the truth value `");
    plain.replace("integer `", "the number `").replace("string \"", "the text \"")
}

fn what_to_add(key: &str) -> &'static str {
    match key {
        "model" => "add [model] with kinematics = \"plane-strain\" or \"plane-stress\"",
        "kinematics" => "add kinematics = \"plane-strain\" or \"plane-stress\"",
        "bodies" => "add one table [bodies.NAME] with `young` and `poisson` for each body",
        "young" => "add young = [E1, E2, E3], in units of stress",
        "poisson" => "add poisson = [nu12, nu13, nu23]",
        "shear" => "add the shear modulus in the plane, shear = G12",
        "file" => "add file = \"NAME.msh\", a path relative to the scene",
        "polygons" => "add at least one [[geometry.polygons]] with `body`, `points` and `edges`",
        "body" => "add body = \"NAME\", the body that the polygon belongs to",
        "points" => "add the corners, points = [[x, y], ...]",
        "edges" => "add one name for each edge, edges = [\"NAME\", ...]; \"\" leaves an edge free",
        "on" => "add on = \"NAME\", the boundary that is meant",
        "name" => "add name = \"NAME\", what the report is to call the quantity",
        "density" => "add the mass per volume, for instance density = 7850.0",
        "omega" => "add the angular velocity in radians per time, for instance omega = 300.0",
        "gradient" => "add the two rows gradient = [[a, b], [c, d]], or write the constant [x, y] alone",
        "type" => "add type = \"clamped\" or \"roller\"",
        _ => "add it",
    }
}
