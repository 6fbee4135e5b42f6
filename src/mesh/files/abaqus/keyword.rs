//! A keyword of a deck with its parameters and data lines, and the numbers in them.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::DAMAGED;
use crate::mesh::MeshError;

/// Longest piece of a file in a message.
const SHOWN: usize = 40;

/// A file of the deck.
struct Source {
    file: PathBuf,
    /// The deck that includes it, or the same.
    root: PathBuf,
}

/// A line of the deck, for messages.
#[derive(Clone)]
pub(super) struct Place {
    source: Rc<Source>,
    line: usize,
}

impl Place {
    /// The start of `file`, which the deck `root` includes.
    pub fn start(file: &Path, root: &Path) -> Place {
        Place { source: Rc::new(Source { file: file.to_path_buf(), root: root.to_path_buf() }), line: 1 }
    }

    pub fn at(&self, line: usize) -> Place {
        Place { source: Rc::clone(&self.source), line }
    }

    pub fn fault(&self, what: impl Into<String>, remedy: impl Into<String>) -> MeshError {
        let Source { file, root } = &*self.source;
        let place = match file == root {
            true => format!("line {}", self.line),
            false => format!("line {} of {}", self.line, file.display()),
        };
        MeshError::Format { file: root.clone(), place, what: what.into(), remedy: remedy.into() }
    }
}

/// `*NAME, KEY=VALUE, …` and the data lines below it.
pub(super) struct Keyword {
    /// In upper case, with single blanks.
    pub name: String,
    /// Keys in upper case; a key without a value has an empty one.
    parameters: Vec<(String, String)>,
    pub lines: Vec<Line>,
    pub place: Place,
}

impl Keyword {
    /// Reads what follows the asterisk.
    pub fn new(head: &str, place: Place) -> Keyword {
        let mut parts = split(head).into_iter();
        let name = parts.next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
        let parameters = parts
            .map(|part| match part.split_once('=') {
                Some((key, value)) => (key.trim().to_ascii_uppercase(), value.trim().trim_matches('"').to_owned()),
                None => (part.trim().to_ascii_uppercase(), String::new()),
            })
            .collect();
        Keyword { name: name.to_ascii_uppercase(), parameters, lines: Vec::new(), place }
    }

    /// The value of a parameter.
    pub fn parameter(&self, key: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    /// The value of a parameter that must be there.
    pub fn required(&self, key: &str) -> Result<&str, MeshError> {
        self.parameter(key).ok_or_else(|| self.fault(format!("*{} has no {key}=", self.name), DAMAGED))
    }

    pub fn fault(&self, what: impl Into<String>, remedy: &str) -> MeshError {
        self.place.fault(what, remedy)
    }
}

/// Data of a keyword.
pub(super) struct Line {
    /// Without surrounding blanks; an empty one at the end is left out.
    pub fields: Vec<String>,
    /// True if the line ends with a comma.
    pub continues: bool,
    pub place: Place,
}

impl Line {
    pub fn new(text: &str, place: Place) -> Line {
        let mut fields: Vec<String> =
            split(text).into_iter().map(|field| field.trim().trim_matches('"').to_owned()).collect();
        while fields.last().is_some_and(String::is_empty) {
            fields.pop();
        }
        Line { fields, continues: text.ends_with(','), place }
    }

    pub fn fault(&self, what: impl Into<String>, remedy: &str) -> MeshError {
        self.place.fault(what, remedy)
    }

    /// Field `i` as a whole number that is not negative.
    pub fn whole(&self, i: usize) -> Result<u64, MeshError> {
        self.fields.get(i).and_then(|field| field.parse().ok()).ok_or_else(|| self.not_a(i, "whole number"))
    }

    /// Field `i` as a finite number; an empty one is zero.
    pub fn number(&self, i: usize) -> Result<f64, MeshError> {
        if self.fields.get(i).is_some_and(String::is_empty) {
            return Ok(0.0);
        }
        // Fortran writes 1.5D0 too.
        let text = self.fields.get(i).map(|field| field.replace(['d', 'D'], "e"));
        match text.and_then(|text| text.parse::<f64>().ok()).filter(|x| x.is_finite()) {
            Some(number) => Ok(number),
            None => Err(self.not_a(i, "number")),
        }
    }

    fn not_a(&self, i: usize, kind: &str) -> MeshError {
        let found = self.fields.get(i).map_or("nothing", String::as_str);
        self.fault(format!("found '{}' where a {kind} should be", shown(found)), DAMAGED)
    }
}

/// Enough of a piece of a file to recognise it.
pub(super) fn shown(text: &str) -> String {
    text.chars().take(SHOWN).filter(|c| !c.is_control()).collect()
}

/// Parts between commas that stand outside quotation marks.
fn split(line: &str) -> Vec<&str> {
    let mut quoted = false;
    line.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    })
    .collect()
}
