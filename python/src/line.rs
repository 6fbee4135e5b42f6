//! Keyword arguments as words of the command line: they mean the same, and the same is refused.

use std::error::Error;
use std::ffi::OsString;
use std::path::Path;

use clap::Args;
use clap::error::{ContextKind, ContextValue};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::raised;
use hypercircle::cli::{Exit, options_of};

/// The words of one command.
#[derive(Default)]
pub struct Line {
    words: Vec<OsString>,
}

impl Line {
    /// `--name=value`, where there is a value.
    pub fn value(mut self, name: &str, value: Option<impl ToString>) -> Self {
        self.words.extend(value.map(|value| OsString::from(format!("--{name}={}", value.to_string()))));
        self
    }

    /// `--name=path`, where there is one.
    pub fn path(mut self, name: &str, path: Option<&Path>) -> Self {
        self.words.extend(path.map(|path| {
            let mut word = OsString::from(format!("--{name}="));
            word.push(path);
            word
        }));
        self
    }

    /// `--name`, where it is asked for.
    pub fn flag(mut self, name: &str, given: bool) -> Self {
        self.words.extend(given.then(|| OsString::from(format!("--{name}"))));
        self
    }

    /// `--name=KEY=X` for each item of a dictionary.
    ///
    /// # Errors
    /// A key that is no text, a value that is no number.
    pub fn items(mut self, name: &str, items: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        for (key, value) in items.into_iter().flatten() {
            let (key, value): (String, f64) = (key.extract()?, value.extract()?);
            self.words.push(OsString::from(format!("--{name}={key}={value}")));
        }
        Ok(self)
    }

    /// The words themselves.
    pub fn words(self) -> Vec<OsString> {
        self.words
    }

    /// The options of a command, said quietly, of a scene that is there already.
    ///
    /// # Errors
    /// `InputError` for what the command line refuses.
    pub fn parsed<A: Args>(self) -> PyResult<A> {
        let ends = ["--quiet", "--", "scene.toml"].map(OsString::from);
        options_of(self.words.into_iter().chain(ends)).map_err(refused)
    }
}

/// A message of clap in the words of Python: `max_triangles = 0: …`.
fn refused(error: clap::Error) -> PyErr {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        _ => None,
    };
    let known = match error.get(ContextKind::ValidValue) {
        Some(ContextValue::Strings(known)) if !known.is_empty() => format!("use one of {}", known.join(", ")),
        _ => "give another value".to_string(),
    };
    let name = text(ContextKind::InvalidArg).map(|argument| {
        let end = argument.find([' ', '=']).unwrap_or(argument.len());
        argument[..end].trim_start_matches('-').replace('-', "_")
    });
    let (Some(name), Some(value)) = (name, text(ContextKind::InvalidValue)) else {
        let whole = error.to_string();
        let said: Vec<&str> = whole.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
        return raised(Exit::BadInput, said.join(" ").trim_start_matches("error: ").to_string(), "");
    };
    match error.source() {
        Some(reason) => raised(Exit::BadInput, format!("{name} = {value}: {reason}"), &known),
        None => raised(Exit::BadInput, format!("{name} = '{value}' is not known"), &known),
    }
}
