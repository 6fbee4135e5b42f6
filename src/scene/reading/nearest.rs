//! Suggestions for a name that was probably mistyped.

/// Most names a message lists.
const LISTED: usize = 12;

/// The known name closest to `found`, if it is close enough to be meant.
pub(in crate::scene) fn nearest<'a>(found: &str, known: &'a [String]) -> Option<&'a str> {
    let folded = fold(found);
    known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(&folded, &fold(name)), name))
        .filter(|(distance, name)| *distance <= 1 + name.chars().count().max(folded.chars().count()) / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name.as_str())
}

/// `did you mean "a"? (known: "a", "b")`, or only the list.
pub(in crate::scene) fn suggestion(found: &str, known: &[String], heading: &str, quote: char) -> String {
    let all = if known.is_empty() { "none".to_owned() } else { list(known, quote) };
    match nearest(found, known) {
        Some(name) => format!("did you mean {quote}{name}{quote}? ({heading}: {all})"),
        None => format!("{heading}: {all}"),
    }
}

/// The names, quoted and separated by commas; a long list is cut.
pub(in crate::scene) fn list(known: &[String], quote: char) -> String {
    let mut text = known.iter().take(LISTED).map(|name| format!("{quote}{name}{quote}")).collect::<Vec<_>>().join(", ");
    if known.len() > LISTED {
        text.push_str(&format!(", … ({} in all)", known.len()));
    }
    text
}

/// Case and the choice between `-`, `_` and blank are the commonest slips, and no distance at all.
fn fold(name: &str) -> String {
    name.chars().take(80).flat_map(char::to_lowercase).map(|c| if c == '_' || c == ' ' { '-' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::nearest;

    fn known() -> Vec<String> {
        ["young", "poisson", "body_force", "wall"].map(String::from).to_vec()
    }

    #[test]
    fn finds_what_was_meant() {
        assert_eq!(nearest("yuong", &known()), Some("young"));
        assert_eq!(nearest("Poisson", &known()), Some("poisson"));
        assert_eq!(nearest("body-force", &known()), Some("body_force"));
        assert_eq!(nearest("wal", &known()), Some("wall"));
    }

    #[test]
    fn keeps_silent_where_nothing_is_close() {
        assert_eq!(nearest("density", &known()), None);
        assert_eq!(nearest("", &known()), None);
        assert_eq!(nearest("x", &[]), None);
    }
}
