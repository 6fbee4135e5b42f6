//! A baseline made for people: one file for many scenes, one line a number, with who accepted it, when and why.

pub(super) mod baseline;
pub(super) mod date;
pub(super) mod patch;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;

use super::BaselineError;
use crate::compare::name::of_baseline;
use crate::compare::{Allowances, Basis, Check};
use crate::report::{BaselineRow, Change};
use baseline::unchanged;
use patch::{Edit, apply, unified};

const VERSION: u32 = 1;

const HEAD: [&str; 5] = [
    "# What `hypercircle` holds later runs against: one line for each number of a scene. `value` is what was accepted,\n",
    "# `allowed` the largest difference that counts as none, then who accepted it, when, and the reason.\n",
    "# Edit what you know better. `--accept` changes the lines of numbers that are new, gone, or further away than allowed,\n",
    "# and no others.\n",
    "version = 1\n",
];

/// The file, read.
#[derive(Debug, Clone, PartialEq)]
pub struct Accepted {
    /// As it stands in the file; `None` where there is no file yet.
    text: Option<String>,
    scenes: BTreeMap<String, Scene>,
}

#[derive(Debug, Clone, PartialEq, Default)]
struct Scene {
    numbers: BTreeMap<String, Number>,
    /// Lines of its heading.
    heading: Range<usize>,
}

#[derive(Debug, Clone, PartialEq)]
struct Number {
    value: f64,
    allowed: f64,
    lines: Range<usize>,
}

/// Who accepts, when and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    /// Who.
    pub by: String,
    /// The date, `2026-01-31`.
    pub on: String,
    /// Why.
    pub reason: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    version: u32,
    #[serde(default)]
    scenes: BTreeMap<String, Spanned<BTreeMap<String, Spanned<RawNumber>>>>,
}

/// One line. Who, when and why are for people: the program writes them and reads past them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawNumber {
    value: f64,
    allowed: f64,
    #[serde(rename = "by")]
    _by: Option<toml::Value>,
    #[serde(rename = "on")]
    _on: Option<toml::Value>,
    #[serde(rename = "reason")]
    _reason: Option<toml::Value>,
}

impl Accepted {
    /// A baseline in which nothing is accepted.
    pub fn empty() -> Self {
        Accepted { text: None, scenes: BTreeMap::new() }
    }

    /// True if the name of `path` is that of such a file.
    pub fn is_meant(path: &Path) -> bool {
        path.extension().is_some_and(|extension| extension == "toml")
    }

    /// Reads a baseline.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let io = |source: std::io::Error| BaselineError::Io { path: path.to_path_buf(), source };
        if !std::fs::metadata(path).map_err(io)?.is_file() {
            return Err(BaselineError::NoFile { path: path.to_path_buf() });
        }
        let text = std::fs::read_to_string(path).map_err(io)?;
        Self::parse(&text).map_err(|reason| BaselineError::Content { path: path.to_path_buf(), reason })
    }

    /// As [`Self::read`], or [`Accepted::empty`] where there is no such file.
    ///
    /// # Errors
    /// As [`Self::read`], except for a file that does not exist.
    pub fn read_if_there(path: &Path) -> Result<Self, BaselineError> {
        match Self::read(path) {
            Err(BaselineError::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(Self::empty()),
            other => other,
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        let line_at = |at: usize| text[..at.min(text.len())].matches('\n').count();
        let raw: RawFile = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(String::new(), |span| format!("line {}: ", line_at(span.start) + 1));
            format!("{line}{}", e.message())
        })?;
        if raw.version != VERSION {
            return Err(format!("it has version {}, this program reads {VERSION}", raw.version));
        }
        let mut scenes = BTreeMap::new();
        for (name, numbers) in raw.scenes {
            let span = numbers.span();
            let mut scene = Scene { heading: line_at(span.start)..line_at(span.start) + 1, ..Scene::default() };
            for (key, number) in numbers.into_inner() {
                let span = number.span();
                let lines = line_at(span.start)..line_at(span.end) + 1;
                if !is_alone(text, &span) {
                    let line = lines.start + 1;
                    return Err(format!(
                        "line {line}: write {key:?} = {{ value = …, allowed = … }} in a line of its own"
                    ));
                }
                let RawNumber { value, allowed, .. } = number.into_inner();
                if !value.is_finite() || !allowed.is_finite() || allowed < 0.0 {
                    let line = lines.start + 1;
                    return Err(format!("line {line}: `value` must be finite, and `allowed` finite and not negative"));
                }
                scene.numbers.insert(key, Number { value, allowed, lines });
            }
            scenes.insert(name, scene);
        }
        Ok(Accepted { text: Some(text.to_string()), scenes })
    }

    /// Names of the scenes.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        self.scenes.keys().map(String::as_str)
    }

    /// The numbers of a run on `scene` beside the accepted ones, by name.
    pub fn rows(&self, scene: &str, values: &BTreeMap<String, f64>, allow: &Allowances) -> Vec<BaselineRow> {
        let none = BTreeMap::new();
        let accepted = self.scenes.get(scene).map_or(&none, |scene| &scene.numbers);
        let value = |name: &str| values.get(name).copied().filter(|value| value.is_finite());
        let names: BTreeSet<&String> = accepted.keys().chain(values.keys()).collect();
        let row = |name: &String| {
            let (value, accepted) = (value(name), accepted.get(name));
            let allowed = accepted.map(|number| allow.given(&of_baseline(name)).unwrap_or(number.allowed));
            let change = match (value, accepted.zip(allowed)) {
                (None, _) => Change::Missing,
                (Some(_), None) => Change::New,
                (Some(value), Some((number, allowed))) if (value - number.value).abs() <= allowed => Change::Unchanged,
                (Some(_), Some(_)) => Change::Changed,
            };
            BaselineRow { name: name.clone(), value, accepted: accepted.map(|n| n.value), allowed, change }
        };
        names.into_iter().map(row).collect()
    }

    /// Changes of the file when the numbers in `found`, rows of scenes by name, are accepted.
    fn edits(&self, found: &BTreeMap<String, Vec<BaselineRow>>, signature: &Signature) -> Vec<Edit> {
        let text = self.text.as_deref().unwrap_or_default();
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        let (mut edits, mut appended) = (Vec::new(), Vec::new());
        if self.text.is_none() {
            appended.extend(HEAD.map(String::from));
        }
        for (name, rows) in found {
            let largest = rows.iter().filter_map(|row| row.value).fold(0.0_f64, |most, value| most.max(value.abs()));
            let scene = self.scenes.get(name);
            let mut added = Vec::new();
            for row in rows {
                let present = scene.and_then(|scene| scene.numbers.get(&row.name));
                let line = |allowed: f64| row.value.map(|value| line(&row.name, value, allowed, signature));
                match (row.change, present) {
                    (Change::Changed, Some(number)) => edits
                        .push(Edit { lines: number.lines.clone(), new: line(number.allowed).into_iter().collect() }),
                    (Change::Missing, Some(number)) => {
                        edits.push(Edit { lines: number.lines.clone(), new: Vec::new() });
                    }
                    (Change::New, None) => {
                        added.extend(row.value.and_then(|value| line(unchanged(value, largest))));
                    }
                    _ => {}
                }
            }
            match scene {
                _ if added.is_empty() => {}
                Some(scene) => {
                    let last = scene.numbers.values().map(|number| number.lines.end).max();
                    let at = last.unwrap_or(scene.heading.end).min(lines.len());
                    edits.push(Edit { lines: at..at, new: added });
                }
                None => {
                    appended.push("\n".to_string());
                    appended.push(format!("[scenes.{}]\n", key(name)));
                    appended.extend(added);
                }
            }
        }
        if !appended.is_empty() {
            edits.push(Edit { lines: lines.len()..lines.len(), new: appended });
        }
        edits.sort_by_key(|edit| (edit.lines.start, edit.lines.end));
        with_newline(&lines, edits)
    }

    /// The file with the numbers in `found` accepted; `None` where nothing changes.
    pub fn with(&self, found: &BTreeMap<String, Vec<BaselineRow>>, signature: &Signature) -> Option<String> {
        let edits = self.edits(found, signature);
        (!edits.is_empty()).then(|| apply(self.text.as_deref().unwrap_or_default(), &edits))
    }

    /// As [`Self::with`], as a patch of the file `path`.
    pub fn patch(
        &self,
        path: &str,
        found: &BTreeMap<String, Vec<BaselineRow>>,
        signature: &Signature,
    ) -> Option<String> {
        let edits = self.edits(found, signature);
        (!edits.is_empty()).then(|| unified(path, self.text.as_deref(), &edits))
    }
}

/// The checks that numbers against a baseline are. A scene of which nothing has been accepted is one check.
pub fn checks(rows: &[BaselineRow]) -> Vec<Check> {
    if !rows.is_empty() && rows.iter().all(|row| row.change == Change::New) {
        let why = "The baseline has no number of this scene; accept them with --accept, or apply baseline.patch.";
        return vec![Check::not_made(&of_baseline("scene"), 0.0, Basis::Asked, why)];
    }
    let check = |row: &BaselineRow| {
        let (name, allowed) = (of_baseline(&row.name), row.allowed.unwrap_or(0.0));
        let not_made = |why: String| Check { value: row.value, ..Check::not_made(&name, allowed, Basis::Asked, why) };
        match (row.value, row.accepted) {
            (Some(value), Some(accepted)) => {
                let why = format!("Changed or not: {} against the accepted value.", row.name);
                Check::equal(&name, value, accepted, allowed, Basis::Asked, why)
            }
            (None, _) => not_made(format!("Missing: the baseline has {}, this run does not.", row.name)),
            (_, None) => not_made(format!("New: this run has {}, the baseline does not.", row.name)),
        }
    };
    rows.iter().map(check).collect()
}

/// True if the value at `span` is the only one in its lines.
fn is_alone(text: &str, span: &Range<usize>) -> bool {
    let start = text[..span.start].rfind('\n').map_or(0, |i| i + 1);
    let rest = text[span.end..].lines().next().unwrap_or_default().trim_start();
    let before: Result<toml::Table, _> = format!("{}0", &text[start..span.start]).parse();
    before.is_ok_and(|table| table.len() == 1) && (rest.is_empty() || rest.starts_with('#'))
}

/// An insertion behind a last line that does not end puts its end there first.
fn with_newline(lines: &[&str], mut edits: Vec<Edit>) -> Vec<Edit> {
    let Some(last) = lines.last().filter(|line| !line.ends_with('\n')) else { return edits };
    if edits.iter().any(|edit| edit.lines.contains(&(lines.len() - 1))) {
        return edits;
    }
    if let Some(edit) = edits.iter_mut().find(|edit| edit.lines == (lines.len()..lines.len())) {
        edit.lines.start -= 1;
        edit.new.insert(0, format!("{last}\n"));
    }
    edits
}

fn line(name: &str, value: f64, allowed: f64, signature: &Signature) -> String {
    let Signature { by, on, reason } = signature;
    // A zero without a sign.
    let value = value + 0.0;
    format!(
        "{} = {{ value = {value:?}, allowed = {allowed:.1e}, by = {}, on = {on}, reason = {} }}\n",
        text(name),
        text(by),
        text(reason)
    )
}

/// Text in quotes.
fn text(text: &str) -> String {
    // On one line, whatever it contains.
    let escaped: String = text
        .chars()
        .map(|c| match c {
            '"' | '\\' => format!("\\{c}"),
            c if c.is_control() => format!("\\u{:04x}", u32::from(c)),
            c => c.to_string(),
        })
        .collect();
    format!("\"{escaped}\"")
}

/// A name as part of a heading.
fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { name.to_string() } else { text(name) }
}

#[cfg(test)]
#[path = "accepted_tests.rs"]
mod tests;
