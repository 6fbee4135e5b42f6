//! Errors of a scene file, worded so that the reader can put them right.
//!
//! Every error carries three things: the place (file, line, column, where the text could be read), the fault (what was
//! found) and the remedy (what to do). [`SceneError`]'s `Display` is all three in one line; as a
//! [`miette::Diagnostic`] it also shows the lines concerned.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use miette::{
    Diagnostic, LabeledSpan, MietteError, MietteSpanContents, NamedSource, SourceCode, SourceSpan, SpanContents,
};

pub use super::fault::Fault;
use super::text::disarmed;
pub use crate::scene::quantity::QuantityFault;

/// Bytes of the longest line that is drawn whole.
const LONGEST_LINE: usize = 300;
/// Characters drawn on either side of a place in a text with longer lines.
const WINDOW: usize = 60;

/// Why a scene was refused.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file could not be had as text.
    #[error("{}: {fault}; {}", .path.display(), .fault.remedy())]
    File {
        /// The path as given.
        path: PathBuf,
        /// The fault of the file.
        fault: FileFault,
    },
    /// The text was read, and something in it is wrong.
    #[error("{}: {}; {}", .0.place, .0.fault, .0.fault.remedy())]
    Content(Box<Located>),
}

/// Faults of the scene file as a file.
#[derive(Debug, thiserror::Error)]
pub enum FileFault {
    /// Nothing there, or no permission, or the device failed.
    #[error("the scene file cannot be read ({0})")]
    Unreadable(std::io::Error),
    /// No such file.
    #[error("there is no such scene file")]
    Missing,
    /// A folder was given.
    #[error("this is a directory, not a scene file")]
    Directory,
    /// More bytes than any scene needs.
    #[error("the file is larger than {} MiB, which no scene needs", crate::scene::MAX_BYTES >> 20)]
    TooLarge,
    /// Not UTF-8.
    #[error("the file is not UTF-8 text (first bad byte in line {line}, byte {offset} of the file)")]
    NotText {
        /// Line of the first bad byte, from 1.
        line: usize,
        /// Offset of the first bad byte, from 0.
        offset: usize,
    },
}

impl FileFault {
    /// The remedy.
    pub fn remedy(&self) -> &'static str {
        match self {
            FileFault::Unreadable(_) => "check the path and its permissions",
            FileFault::Missing => "check the path; a scene is a TOML file such as `scene.toml`",
            FileFault::Directory => "give the TOML file inside it, for instance `scene.toml`",
            FileFault::TooLarge => {
                "check that it is a scene; a large mesh belongs in its own file, named by `[mesh] file`"
            }
            FileFault::NotText { .. } => "save it as UTF-8; if it is a mesh, name it in a scene file by `[mesh] file`",
        }
    }
}

/// A fault and where it is.
#[derive(Debug)]
pub struct Located {
    /// Where.
    pub place: Place,
    /// The fault.
    pub fault: Fault,
    /// A second place that belongs to the fault, with the words to write there.
    pub related: Option<(Range<usize>, String)>,
}

/// A range of bytes in a scene file.
#[derive(Debug)]
pub struct Place {
    path: PathBuf,
    source: NamedSource<String>,
    span: Range<usize>,
}

impl Place {
    /// The bytes `span` of `text`; a span that does not fit the text is cut to it.
    pub fn new(path: &Path, text: &str, span: Range<usize>) -> Self {
        let floor = |mut at: usize| {
            at = at.min(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let start = floor(span.start);
        let end = floor(span.end).max(start);
        let source = NamedSource::new(disarmed(&path.display().to_string()), disarmed(text));
        Self { path: path.to_owned(), source, span: start..end }
    }

    /// The scene file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The bytes concerned.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Line, from 1.
    pub fn line(&self) -> usize {
        self.before().matches('\n').count() + 1
    }

    /// Column in characters, from 1.
    pub fn column(&self) -> usize {
        self.before().rsplit('\n').next().unwrap_or_default().chars().count() + 1
    }

    /// True if some line is too long to be drawn.
    fn has_long_lines(&self) -> bool {
        self.source.inner().lines().any(|line| line.len() > LONGEST_LINE)
    }

    /// The bytes to underline.
    fn marked(&self) -> Range<usize> {
        if self.has_long_lines() { self.span.start..self.window().end.min(self.span.end) } else { self.span() }
    }

    /// The neighbourhood of the span in its line, short enough to be drawn.
    fn window(&self) -> Range<usize> {
        let text = self.source.inner();
        let (before, after) = (self.before(), text.get(self.span.start..).unwrap_or_default());
        let back: usize = before.chars().rev().take(WINDOW).take_while(|&c| c != '\n').map(char::len_utf8).sum();
        let ahead: usize = after.chars().take(WINDOW).take_while(|&c| c != '\n').map(char::len_utf8).sum();
        self.span.start - back..self.span.start + ahead
    }

    fn before(&self) -> &str {
        self.source.inner().get(..self.span.start).unwrap_or_default()
    }
}

/// A text with a line of any length is drawn as the neighbourhood of the place only.
impl SourceCode for Place {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        if !self.has_long_lines() {
            return self.source.read_span(span, lines_before, lines_after);
        }
        let window = self.window();
        let text = self.source.inner().get(window.clone()).unwrap_or_default();
        let column = self.before().get(..window.start).unwrap_or_default().rsplit('\n').next().unwrap_or_default();
        Ok(Box::new(MietteSpanContents::new_named(
            self.source.name().to_owned(),
            text.as_bytes(),
            window.into(),
            self.line() - 1,
            column.chars().count(),
            1,
        )))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.path.display(), self.line(), self.column())
    }
}

impl SceneError {
    /// An error at `span` of the scene text.
    pub fn at(path: &Path, text: &str, span: Range<usize>, fault: Fault) -> Self {
        SceneError::Content(Box::new(Located { place: Place::new(path, text, span), fault, related: None }))
    }

    /// An error about the whole file.
    pub fn file(path: &Path, fault: FileFault) -> Self {
        SceneError::File { path: path.to_owned(), fault }
    }

    /// Adds a second place, with the words to show there.
    #[must_use]
    pub fn with_related(mut self, span: Range<usize>, words: impl Into<String>) -> Self {
        if let SceneError::Content(located) = &mut self {
            located.related = Some((span, words.into()));
        }
        self
    }

    /// The fault, without place and remedy.
    pub fn found(&self) -> String {
        match self {
            SceneError::File { path, fault } => format!("{}: {fault}", path.display()),
            SceneError::Content(located) => located.fault.to_string(),
        }
    }

    /// The remedy for the fault.
    pub fn remedy(&self) -> String {
        match self {
            SceneError::File { fault, .. } => fault.remedy().to_owned(),
            SceneError::Content(located) => located.fault.remedy(),
        }
    }

    /// The place in the file, where the fault has one.
    pub fn place(&self) -> Option<&Place> {
        match self {
            SceneError::File { .. } => None,
            SceneError::Content(located) => Some(&located.place),
        }
    }
}

impl Diagnostic for SceneError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.remedy()))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place().map(|place| place as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let SceneError::Content(located) = self else { return None };
        let primary = LabeledSpan::new_primary_with_span(Some(located.fault.label()), located.place.marked());
        // Two places of a text with long lines have no drawing in common.
        let related = located.related.iter().filter(|_| !located.place.has_long_lines()).map(|(span, words)| {
            let length = span.len();
            LabeledSpan::new(Some(words.clone()), span.start, length)
        });
        Some(Box::new(std::iter::once(primary).chain(related)))
    }
}
