//! The keywords of a deck and of the files that it includes.

use std::path::{Path, PathBuf};

use super::super::encoding::{SAVE_AS_UTF8, decoded, text, with_line_feeds};
use super::DAMAGED;
use super::keyword::{Keyword, Line, Place, shown};
use crate::mesh::MeshError;

/// Depth of included files.
const DEEPEST: usize = 10;
/// Most bytes of all files of a deck.
const LARGEST: usize = 2 << 30;

/// The keywords of the deck in `bytes` that stand before its first `*STEP`: what follows is no part of the mesh.
///
/// # Errors
/// An included file that cannot be read, or text before the first keyword.
pub(super) fn read(bytes: &[u8], file: &Path) -> Result<Vec<Keyword>, MeshError> {
    let mut deck = Deck { root: file, size: 0, keywords: Vec::new(), ended: false };
    deck.add(bytes, file, 0)?;
    if deck.keywords.is_empty() && !deck.ended {
        return Err(MeshError::file(file, "the file has no keyword (*NODE, *ELEMENT)", DAMAGED));
    }
    Ok(deck.keywords)
}

struct Deck<'a> {
    root: &'a Path,
    /// Bytes read so far.
    size: usize,
    keywords: Vec<Keyword>,
    /// True once the first step begins.
    ended: bool,
}

impl Deck<'_> {
    fn add(&mut self, bytes: &[u8], file: &Path, depth: usize) -> Result<(), MeshError> {
        self.size = self.size.saturating_add(bytes.len());
        if self.size > LARGEST || depth > DEEPEST {
            let what = "its included files are too large or include each other";
            return Err(MeshError::file(self.root, what, DAMAGED));
        }
        let start = Place::start(file, self.root);
        let bytes = text(bytes).map_err(|found| start.fault(format!("the file is {found}"), SAVE_AS_UTF8))?;
        let bytes = with_line_feeds(bytes);
        let text = decoded(&bytes);
        let mut lines = (1..).zip(text.lines().map(str::trim)).peekable();
        while let Some((number, line)) = lines.next() {
            if line.is_empty() || line.starts_with("**") {
                continue;
            }
            let place = start.at(number);
            let Some(head) = line.strip_prefix('*') else {
                self.data(line, place)?;
                continue;
            };
            // A line that ends with a comma goes on in the next.
            let mut head = head.to_owned();
            while head.ends_with(',') {
                let Some((_, more)) = lines.next_if(|(_, more)| !more.starts_with('*')) else { break };
                head.push_str(more);
            }
            self.keyword(Keyword::new(&head, place), file, depth)?;
            if self.ended {
                break;
            }
        }
        Ok(())
    }

    fn data(&mut self, line: &str, place: Place) -> Result<(), MeshError> {
        match self.keywords.last_mut() {
            Some(keyword) => keyword.lines.push(Line::new(line, place)),
            None => {
                let what = format!("data stand before the first keyword: found '{}'", shown(line));
                return Err(place.fault(what, "take the line out, or begin it with ** if it is a comment"));
            }
        }
        Ok(())
    }

    fn keyword(&mut self, keyword: Keyword, file: &Path, depth: usize) -> Result<(), MeshError> {
        match keyword.name.as_str() {
            "STEP" => self.ended = true,
            "INCLUDE" => {
                let included = self.included(&keyword, file)?;
                let bytes = std::fs::read(&included).map_err(|e| {
                    let what = format!("the included file {} cannot be read: {e}", included.display());
                    keyword.fault(what, "check its permissions")
                })?;
                self.add(&bytes, &included, depth + 1)?;
            }
            _ => self.keywords.push(keyword),
        }
        Ok(())
    }

    /// The file that `*INCLUDE` in `file` names: beside that file, or else in the folder of the deck. Windows writes `\` in it.
    fn included(&self, keyword: &Keyword, file: &Path) -> Result<PathBuf, MeshError> {
        let input = keyword.required("INPUT")?;
        let spellings = [input.to_owned(), input.replace('\\', "/")];
        let folders = [file, self.root].map(|file| file.parent().unwrap_or(Path::new("")));
        let candidates = folders.iter().flat_map(|folder| spellings.iter().map(move |input| folder.join(input)));
        let is_file = |path: &PathBuf| std::fs::metadata(path).is_ok_and(|kind| kind.is_file());
        candidates.into_iter().find(is_file).ok_or_else(|| {
            let told = folders[0].join(input);
            let also = match folders[0] == folders[1] {
                true => String::new(),
                false => format!(", nor is {}", folders[1].join(input).display()),
            };
            let what = format!("the included file {} is not there{also}", told.display());
            keyword.fault(what, "put it beside the deck, or correct INPUT=")
        })
    }
}
