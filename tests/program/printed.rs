//! Program output shown in README and docs, compared with the real output, digit by digit.

use crate::pages::{blocks, needs_reference, pages, read, replay};

#[test]
fn sessions_on_the_pages_are_those_of_the_program() {
    let mut commands = 0;
    for page in pages() {
        let text = read(&page);
        if needs_reference(&text) {
            continue;
        }
        let (count, wrong) = replay(&page, &text);
        commands += count;
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
    assert!(commands > 1, "only {commands} commands are shown with what they print");
}

/// The checker of proofs; `checker/tests` compares its output.
const CHECKER: &str = "hypercircle-check";

/// A block of plain text is what a program printed: it is behind a program of Python, which `tests/python` runs, behind the checker of
/// proofs, or in a section that names the commit which it was measured at.
#[test]
fn no_page_shows_output_that_nothing_runs() {
    for page in pages() {
        let text = read(&page);
        let lines: Vec<&str> = text.lines().collect();
        let mut before = "";
        let blocks = blocks(&text);
        for block in &blocks {
            let section = lines[..block.line].iter().rposition(|line| line.starts_with('#')).unwrap_or(0);
            let measured = lines[section..block.line].iter().any(|line| line.contains("at commit `"));
            assert!(
                block.language != "text" || before == "python" || before == CHECKER || measured,
                "{page}:{}: nothing compares this with what is printed; make it a session (`console`)",
                block.line
            );
            assert!(
                matches!(block.language.as_str(), "console" | "text")
                    || !block.text.lines().any(|line| line.starts_with("$ ")),
                "{page}:{}: a session is a block of `console`",
                block.line
            );
            before = if block.text.contains(CHECKER) { CHECKER } else { &block.language };
        }
    }
}

/// Runs one session and says what differs from it.
#[track_caller]
fn differs(session: &str) -> String {
    let (count, wrong) = replay("page.md", &format!("# Page\n\n```console\n{session}\n```\n"));
    assert!(count > 0);
    wrong.join("\n")
}

#[test]
fn what_differs_from_a_page_is_seen() {
    assert_eq!(differs("$ echo 1.25; echo b\n1.25\nb"), "");
    assert_eq!(differs("$ printf '1\\n2\\n3\\n'\n[…]\n3"), "");
    assert_eq!(differs("$ echo 'took 0.31 s, 1 … 2'\ntook […] s, 1 … 2"), "");
    assert_eq!(differs("$ echo a > kept\n$ cat \\\n  kept nothing\na\ncat: nothing: […]"), "");
    for wrong in [
        "$ echo 1.25\n1.26",
        "$ echo 1.25",
        "$ echo 1.25\n1.25\n1.25",
        "$ echo 1.25\n1.25\n[…]",
        "$ true\n1.25",
        "$ echo 'took 0.31 s, 1 … 2'\ntook […] s, 1 … 3",
        "$ echo 'took s'\ntook […]s",
    ] {
        assert!(differs(wrong).contains("page.md:4: `"), "{wrong}");
    }
}
