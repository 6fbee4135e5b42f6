//! The encoding of text files: ASCII or UTF-8, with a byte order mark or without.

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

/// What to do about a file in another encoding.
pub(super) const SAVE_AS_UTF8: &str = "save it as UTF-8 or ASCII text";
