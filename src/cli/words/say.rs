//! Text for people: on standard output where it can be had, and fit for a terminal wherever it comes from.

use std::io::Write;

use crate::scene::reading::text::acts;

/// Characters of a word that a terminal shows whole; paths are shorter, names need not be longer.
const LONGEST_WORD: usize = 300;
/// Characters of a text that a terminal shows whole.
const LONGEST_TEXT: usize = 6000;

/// Prints a line. A report is written before anything is said about it, so a standard output that is closed or full
/// changes nothing about the run.
pub fn line(text: &str) {
    let _ = writeln!(std::io::stdout(), "{}", shown(text));
}

/// Prints a line of text that the program made itself, as it is, on standard error.
pub fn complaint(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", shown(text));
}

/// `text` without characters that act on a terminal, with what is too long to be read cut.
pub fn shown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len().min(LONGEST_TEXT));
    let (mut word, mut all) = (0, 0);
    for c in text.chars() {
        word = if c.is_whitespace() { 0 } else { word + 1 };
        if word > LONGEST_WORD {
            if word == LONGEST_WORD + 1 {
                shown.push('…');
            }
            continue;
        }
        if all == LONGEST_TEXT {
            shown.push('…');
            break;
        }
        all += 1;
        shown.push(if acts(c) { char::REPLACEMENT_CHARACTER } else { c });
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_acts_on_a_terminal_and_nothing_floods_it() {
        assert_eq!(shown("a\u{1b}[31mb\u{9b}c\u{202e}d\ne"), "a\u{fffd}[31mb\u{fffd}c\u{fffd}d\ne");
        let long = shown(&format!("body `{}` is loose", "x".repeat(100_000)));
        assert!(long.starts_with("body `xxx") && long.ends_with("… is loose") && long.chars().count() < 400, "{long}");
        assert!(shown(&"word ".repeat(100_000)).chars().count() <= LONGEST_TEXT + 1);
        assert_eq!(shown("Π(λ_h) ≤ 1"), "Π(λ_h) ≤ 1");
    }
}
