//! The encoding of files: packed with gzip or not, and text in ASCII, in UTF-8 with a byte order mark or without, or in Latin-1.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The name of a file before it was packed: without the ending `.gz`.
pub(super) fn unpacked_name(file: &Path) -> PathBuf {
    let packed = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    if packed { file.with_extension("") } else { file.to_path_buf() }
}

/// The bytes of a text file without the byte order mark of UTF-8.
///
/// # Errors
/// Says which encoding the file has instead.
pub(super) fn text(bytes: &[u8]) -> Result<&[u8], &'static str> {
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Ok(rest),
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => Err("UTF-16 text"),
        _ => Ok(bytes),
    }
}

/// The bytes of a text with the ends of lines of old Macs, with those of others.
pub(super) fn with_line_feeds(bytes: &[u8]) -> Cow<'_, [u8]> {
    if bytes.contains(&b'\n') || !bytes.contains(&b'\r') {
        return Cow::Borrowed(bytes);
    }
    Cow::Owned(bytes.iter().map(|b| if *b == b'\r' { b'\n' } else { *b }).collect())
}

/// The text of bytes; what is no UTF-8 is Latin-1, so that names that differ still do.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|b| char::from(*b)).collect()),
    }
}

/// What to do about a file in another encoding.
pub(super) const SAVE_AS_UTF8: &str = "save it as UTF-8 or ASCII text";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_latin_1_stay_apart() {
        assert_eq!(decoded("W\u{fc}".as_bytes()), "W\u{fc}");
        assert_eq!([decoded(b"W\xfc"), decoded(b"W\xf6")], ["W\u{fc}", "W\u{f6}"]);
    }
}
