//! A command in one line: its words as a shell would split them, without a shell.

/// Why a line is no command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum SplitError {
    /// A quotation mark without its partner.
    #[error("a {0} is not closed")]
    Open(char),
    /// A backslash with nothing after it.
    #[error("it ends with a backslash")]
    Backslash,
    /// No word at all.
    #[error("it names no program")]
    Empty,
}

/// The words of `line`. Single quotes keep everything, double quotes all but a backslash before `"` and `\\`, a backslash keeps the
/// next character; variables, patterns, pipes and redirections mean nothing.
///
/// # Errors
/// [`SplitError`].
pub fn split(line: &str) -> Result<Vec<String>, SplitError> {
    let (mut words, mut word): (Vec<String>, Option<String>) = (Vec::new(), None);
    let mut rest = line.chars();
    while let Some(c) = rest.next() {
        if c.is_whitespace() {
            words.extend(word.take());
            continue;
        }
        let word = word.get_or_insert_default();
        match c {
            '\'' => loop {
                match rest.next().ok_or(SplitError::Open('\''))? {
                    '\'' => break,
                    kept => word.push(kept),
                }
            },
            '"' => loop {
                match rest.next().ok_or(SplitError::Open('"'))? {
                    '"' => break,
                    '\\' => {
                        let next = rest.next().ok_or(SplitError::Open('"'))?;
                        if !matches!(next, '"' | '\\') {
                            word.push('\\');
                        }
                        word.push(next);
                    }
                    kept => word.push(kept),
                }
            },
            '\\' => word.push(rest.next().ok_or(SplitError::Backslash)?),
            plain => word.push(plain),
        }
    }
    words.extend(word);
    if words.is_empty() { Err(SplitError::Empty) } else { Ok(words) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        let said = |line: &str| split(line).expect("a command");
        assert_eq!(said("my-solver {problem}  {out}"), ["my-solver", "{problem}", "{out}"]);
        assert_eq!(said(" 'a b'c \"d 'e'\" f\\ g ''"), ["a bc", "d 'e'", "f g", ""]);
        assert_eq!(said(r#"x "a\"b\\c\d" 'a\b'"#), ["x", r#"a"b\c\d"#, r"a\b"]);
        assert_eq!(said("a $HOME *.c | b > c"), ["a", "$HOME", "*.c", "|", "b", ">", "c"]);
        let refused =
            [("'a", SplitError::Open('\'')), ("\"a\\", SplitError::Open('"')), ("a\\", SplitError::Backslash)];
        for (line, error) in refused.into_iter().chain([("", SplitError::Empty), (" \t\n", SplitError::Empty)]) {
            assert_eq!(split(line), Err(error), "{line}");
        }
    }
}
