//! Text of a scene that a terminal may be shown.

/// A source text with every character that acts on a terminal replaced by others of the same number of bytes.
pub(in crate::scene) fn disarmed(text: &str) -> String {
    let mut disarmed = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let ends_line = c == '\r' && rest.peek() == Some(&'\n');
        match (acts(c) && !ends_line, c.len_utf8()) {
            (false, _) => disarmed.push(c),
            (true, 3) => disarmed.push(char::REPLACEMENT_CHARACTER),
            (true, bytes) => disarmed.extend(std::iter::repeat_n('?', bytes)),
        }
    }
    disarmed
}

/// True if a character moves the cursor, changes colours or turns the direction of writing.
pub fn acts(c: char) -> bool {
    c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disarmed_text_has_its_bytes_where_they_were() {
        let text = "a\u{1b}b\u{9b}é\u{202e}\rc\r\n";
        let disarmed = disarmed(text);
        assert_eq!(disarmed, "a?b??é\u{fffd}?c\r\n");
        assert_eq!(disarmed.len(), text.len());
    }
}
