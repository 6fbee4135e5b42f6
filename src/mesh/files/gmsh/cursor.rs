//! Reading numbers from the bytes of a mesh file, in text or binary, with the place for messages.

use std::path::Path;

use crate::mesh::MeshError;
use crate::mesh::files::encoding::decoded;

/// How the numbers of a section are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    Little,
    Big,
}

/// A position in the file. Nothing is allocated by a count that the file claims: every number read uses up bytes.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    position: usize,
    /// Where the last line or word began, for messages.
    mark: usize,
    file: &'a Path,
    /// How `int`, `size` and `double` read.
    pub encoding: Encoding,
    /// Bytes of a `size` in binary.
    pub size_bytes: usize,
    /// Name of the section, for messages.
    pub section: String,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8], file: &'a Path) -> Self {
        Cursor {
            bytes,
            position: 0,
            mark: 0,
            file,
            encoding: Encoding::Text,
            size_bytes: 8,
            section: "start of the file".into(),
        }
    }

    /// An error at the present place.
    pub fn fault(&self, what: impl Into<String>, remedy: &str) -> MeshError {
        let place = match self.encoding {
            Encoding::Text => {
                let lines = self.bytes[..self.mark].iter().filter(|b| **b == b'\n').count();
                format!("{}, line {}", self.section, lines + 1)
            }
            _ => format!("{}, byte {}", self.section, self.position),
        };
        MeshError::Format { file: self.file.to_path_buf(), place, what: what.into(), remedy: remedy.to_string() }
    }

    fn ended(&mut self) -> MeshError {
        self.mark = self.bytes.len();
        self.fault("the file ends here, in the middle of its data", "it is truncated: write it again")
    }

    /// The rest of the line, without surrounding space; `None` at the end of the file.
    pub fn line(&mut self) -> Option<String> {
        self.mark = self.position;
        let rest = &self.bytes[self.position..];
        if rest.is_empty() {
            return None;
        }
        let length = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.position += (length + 1).min(rest.len());
        Some(decoded(&rest[..length]).trim().to_string())
    }

    /// Goes back to the beginning of the last line.
    pub fn back(&mut self) {
        self.position = self.mark;
    }

    /// The next line that is not empty.
    pub fn full_line(&mut self) -> Option<String> {
        loop {
            match self.line() {
                Some(line) if line.is_empty() => {}
                other => return other,
            }
        }
    }

    /// Goes behind the next `text`.
    pub fn skip_past(&mut self, text: &str) -> Result<(), MeshError> {
        let rest = &self.bytes[self.position..];
        match rest.windows(text.len()).position(|w| w == text.as_bytes()) {
            Some(found) => {
                self.position += found + text.len();
                self.line();
                Ok(())
            }
            None => Err(self.fault(format!("{text} is missing"), "the file is truncated: write it again")),
        }
    }

    /// Expects `text` as the next line.
    pub fn expect(&mut self, text: &str) -> Result<(), MeshError> {
        match self.full_line() {
            None => Err(self.ended()),
            Some(line) if line == text => Ok(()),
            Some(line) => Err(self.fault(
                format!("found '{}' where {text} should be", shortened(&line)),
                "the number of entries does not agree with the count above them: write the file again",
            )),
        }
    }

    fn word(&mut self) -> Result<&'a str, MeshError> {
        let rest = &self.bytes[self.position..];
        let Some(start) = rest.iter().position(|b| !b.is_ascii_whitespace()) else { return Err(self.ended()) };
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        let word = &rest[start..start + length];
        self.position += start;
        self.mark = self.position;
        let text = std::str::from_utf8(word).map_err(|_| self.not_a("number", &String::from_utf8_lossy(word)))?;
        Ok(text)
    }

    fn not_a(&self, kind: &str, found: &str) -> MeshError {
        let what = format!("found '{}' where a {kind} should be", shortened(found));
        self.fault(what, "the file is damaged, or a count above is wrong: write it again")
    }

    fn parsed<T: std::str::FromStr>(&mut self, kind: &str) -> Result<T, MeshError> {
        let word = self.word()?;
        let value = word.parse().map_err(|_| self.not_a(kind, word))?;
        self.position += word.len();
        Ok(value)
    }

    fn raw<const N: usize>(&mut self) -> Result<[u8; N], MeshError> {
        let Some(bytes) = self.bytes[self.position..].first_chunk::<N>() else { return Err(self.ended()) };
        self.position += N;
        Ok(if self.encoding == Encoding::Big {
            let mut turned = *bytes;
            turned.reverse();
            turned
        } else {
            *bytes
        })
    }

    /// A 4-byte integer.
    pub fn int(&mut self) -> Result<i32, MeshError> {
        match self.encoding {
            Encoding::Text => self.parsed("whole number"),
            _ => Ok(i32::from_le_bytes(self.raw()?)),
        }
    }

    /// The tag of an entity or a physical group, which other programs write in text with more digits than Gmsh has.
    pub fn entity(&mut self) -> Result<i64, MeshError> {
        match self.encoding {
            Encoding::Text => self.parsed("whole number"),
            _ => Ok(i64::from(self.int()?)),
        }
    }

    /// A count or a tag.
    pub fn size(&mut self) -> Result<u64, MeshError> {
        match self.encoding {
            Encoding::Text => self.parsed("count"),
            _ if self.size_bytes == 4 => Ok(u64::from(u32::from_le_bytes(self.raw()?))),
            _ => Ok(u64::from_le_bytes(self.raw()?)),
        }
    }

    /// A floating-point number.
    pub fn double(&mut self) -> Result<f64, MeshError> {
        match self.encoding {
            Encoding::Text => self.parsed("number"),
            _ => Ok(f64::from_le_bytes(self.raw()?)),
        }
    }

    /// Runs `read` with numbers in text, whatever the file is written in.
    pub fn in_text<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, MeshError>) -> Result<T, MeshError> {
        let encoding = std::mem::replace(&mut self.encoding, Encoding::Text);
        let result = read(self);
        self.encoding = encoding;
        result
    }
}

/// Enough of a piece of a file to recognise it.
pub(super) fn shortened(text: &str) -> String {
    let mut short: String = text.chars().take(40).map(|c| if c.is_control() { '?' } else { c }).collect();
    if text.chars().count() > 40 {
        short.push('…');
    }
    short
}
