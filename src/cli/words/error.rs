//! Why a command gave no answer.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::Path;

use miette::{Diagnostic, LabeledSpan, SourceCode};

use super::exit::Exit;
use super::say::shown;
use crate::report::ReportError;
use crate::scene::SceneError;

/// An error to show, with its exit code.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The scene was refused.
    #[error("{}", shown(&.0.found()))]
    Scene(#[from] SceneError),
    /// The command, for an answer that ends with `exit`.
    #[error("{}", shown(message))]
    Stopped {
        /// The finding, with the file it concerns.
        message: String,
        /// The remedy.
        remedy: String,
        /// One of the codes from 2 on.
        exit: Exit,
    },
}

impl CliError {
    /// An error that is not about the text of a scene.
    pub fn stopped(exit: Exit, message: impl Into<String>, remedy: impl Into<String>) -> Self {
        CliError::Stopped { message: message.into(), remedy: remedy.into(), exit }
    }

    /// A result that finds no place: bad input where it is the place that was named that cannot be.
    pub fn unwritable(path: &Path, error: &io::Error) -> Self {
        let exit = match error.kind() {
            ErrorKind::NotFound
            | ErrorKind::NotADirectory
            | ErrorKind::IsADirectory
            | ErrorKind::PermissionDenied
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::AlreadyExists
            | ErrorKind::InvalidFilename => Exit::BadInput,
            _ => Exit::Failed,
        };
        CliError::stopped(exit, format!("{} cannot be written: {error}", path.display()), "choose another place")
    }

    /// The exit code that belongs to it.
    pub fn exit(&self) -> Exit {
        match self {
            CliError::Scene(_) => Exit::BadInput,
            CliError::Stopped { exit, .. } => *exit,
        }
    }
}

impl From<ReportError> for CliError {
    /// A report that finds no place: bad input where there can be none at the place that was named.
    fn from(error: ReportError) -> Self {
        let exit = if error.is_of_the_place() { Exit::BadInput } else { Exit::Failed };
        CliError::stopped(exit, error.to_string(), "")
    }
}

impl Diagnostic for CliError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        match self {
            CliError::Scene(error) => Some(Box::new(shown(&error.remedy()))),
            CliError::Stopped { remedy, .. } => {
                (!remedy.is_empty()).then(|| Box::new(shown(remedy)) as Box<dyn fmt::Display>)
            }
        }
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self {
            CliError::Scene(error) => error.source_code(),
            CliError::Stopped { .. } => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        match self {
            CliError::Scene(error) => {
                let fit = |label: LabeledSpan| {
                    let (words, span) = (label.label().map(shown), *label.inner());
                    match label.primary() {
                        true => LabeledSpan::new_primary_with_span(words, span),
                        false => LabeledSpan::new_with_span(words, span),
                    }
                };
                Some(Box::new(error.labels()?.map(fit)))
            }
            CliError::Stopped { .. } => None,
        }
    }
}
