//! The lines of a deck: keywords with their parameters and data.

use std::path::{Path, PathBuf};

use super::DAMAGED;
use crate::mesh::MeshError;

/// Depth of included files.
const DEEPEST: usize = 10;
/// Most bytes of all files of a deck.
const LARGEST: usize = 2 << 30;

/// `*NAME, KEY=VALUE, …` and the data lines below it.
pub(super) struct Keyword<'a> {
    /// In upper case, with single blanks.
    pub name: String,
    /// Keys in upper case; a key without a value has an empty one.
    parameters: Vec<(String, String)>,
    pub lines: Vec<Line<'a>>,
    place: (PathBuf, usize),
    root: &'a Path,
}

/// Data of a keyword.
pub(super) struct Line<'a> {
    /// Without surrounding blanks; an empty one at the end is left out.
    pub fields: Vec<String>,
    place: (PathBuf, usize),
    root: &'a Path,
}

/// The keywords of a deck and of the files that it includes.
pub(super) struct Deck;

impl Deck {
    /// # Errors
    /// An included file that cannot be read, or text before the first keyword.
    pub fn read<'a>(text: &[u8], file: &'a Path) -> Result<Vec<Keyword<'a>>, MeshError> {
        let (mut keywords, mut size) = (Vec::new(), 0);
        add(text, file, file, 0, &mut size, &mut keywords)?;
        if keywords.is_empty() {
            return Err(MeshError::file(file, "the file has no keyword (*NODE, *ELEMENT)", DAMAGED));
        }
        Ok(keywords)
    }
}

fn add<'a>(
    text: &[u8],
    file: &Path,
    root: &'a Path,
    depth: usize,
    size: &mut usize,
    keywords: &mut Vec<Keyword<'a>>,
) -> Result<(), MeshError> {
    *size += text.len();
    if *size > LARGEST || depth > DEEPEST {
        return Err(MeshError::file(root, "its included files are too large or include each other", DAMAGED));
    }
    let text = String::from_utf8_lossy(text);
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    while let Some((number, line)) = lines.next() {
        if line.is_empty() || line.starts_with("**") {
            continue;
        }
        let place = (file.to_path_buf(), number);
        let Some(head) = line.strip_prefix('*') else {
            let fields = fields(line);
            match keywords.last_mut() {
                Some(keyword) => keyword.lines.push(Line { fields, place, root }),
                None => return Err(fault(&place, root, "data stand before the first keyword", DAMAGED)),
            }
            continue;
        };
        let mut head = head.to_owned();
        while head.ends_with(',') {
            match lines.next() {
                Some((_, more)) if !more.starts_with('*') => head.push_str(more),
                _ => break,
            }
        }
        let mut parts = split(&head).into_iter();
        let name =
            parts.next().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ").to_ascii_uppercase();
        let parameters = parts
            .map(|part| match part.split_once('=') {
                Some((key, value)) => (key.trim().to_ascii_uppercase(), value.trim().trim_matches('"').to_owned()),
                None => (part.trim().to_ascii_uppercase(), String::new()),
            })
            .collect();
        let keyword = Keyword { name, parameters, lines: Vec::new(), place, root };
        if keyword.name != "INCLUDE" {
            keywords.push(keyword);
            continue;
        }
        let Some(input) = keyword.parameter("INPUT") else {
            return Err(keyword.fault("*INCLUDE has no INPUT=", DAMAGED));
        };
        let included = file.parent().unwrap_or(Path::new("")).join(input);
        if !std::fs::metadata(&included).is_ok_and(|kind| kind.is_file()) {
            let what = format!("the included file {} is not there", included.display());
            return Err(keyword.fault(what, "put it beside the deck, or correct INPUT="));
        }
        let bytes = std::fs::read(&included).map_err(|e| {
            keyword
                .fault(format!("the included file {} cannot be read: {e}", included.display()), "check its permissions")
        })?;
        add(&bytes, &included, root, depth + 1, size, keywords)?;
    }
    Ok(())
}

fn fields(line: &str) -> Vec<String> {
    let mut fields: Vec<String> =
        split(line).into_iter().map(|field| field.trim().trim_matches('"').to_owned()).collect();
    while fields.last().is_some_and(String::is_empty) {
        fields.pop();
    }
    fields
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

fn fault(place: &(PathBuf, usize), root: &Path, what: impl Into<String>, remedy: &str) -> MeshError {
    let (file, line) = place;
    let place = match file == root {
        true => format!("line {line}"),
        false => format!("line {line} of {}", file.display()),
    };
    MeshError::Format { file: root.to_path_buf(), place, what: what.into(), remedy: remedy.to_owned() }
}

impl Keyword<'_> {
    /// The value of a parameter.
    pub fn parameter(&self, key: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    pub fn fault(&self, what: impl Into<String>, remedy: &str) -> MeshError {
        fault(&self.place, self.root, what, remedy)
    }
}

impl Line<'_> {
    pub fn fault(&self, what: impl Into<String>, remedy: &str) -> MeshError {
        fault(&self.place, self.root, what, remedy)
    }

    /// Field `i` as a whole number that is not negative.
    pub fn whole(&self, i: usize) -> Result<u64, MeshError> {
        self.parsed(i, "whole number")
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

    fn parsed<T: std::str::FromStr>(&self, i: usize, kind: &str) -> Result<T, MeshError> {
        self.fields.get(i).and_then(|field| field.parse().ok()).ok_or_else(|| self.not_a(i, kind))
    }

    fn not_a(&self, i: usize, kind: &str) -> MeshError {
        let found = self.fields.get(i).map_or("nothing", String::as_str);
        let found: String = found.chars().take(40).filter(|c| !c.is_control()).collect();
        self.fault(format!("found '{found}' where a {kind} should be"), DAMAGED)
    }
}
