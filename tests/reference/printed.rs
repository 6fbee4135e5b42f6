//! Comparisons with FEniCSx shown in README and docs, compared with the real output, digit by digit.

use crate::command::with_reference;
use crate::pages::{needs_reference, pages, read, replay};

#[test]
fn sessions_with_fenicsx_are_those_of_the_program() {
    if !with_reference() {
        return;
    }
    let texts = pages().into_iter().map(|page| (read(&page), page));
    let texts: Vec<(String, String)> = texts.filter(|(text, _)| needs_reference(text)).collect();
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let started: Vec<_> = texts.iter().map(|(text, page)| scope.spawn(|| replay(page, text).1)).collect();
        started.into_iter().flat_map(|run| run.join().expect("a page with sessions")).collect()
    });
    assert!(!texts.is_empty(), "no page shows `verify`");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
