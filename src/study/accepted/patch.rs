//! Changes of whole lines: applied to a text, or as a patch that people read and `git apply` applies.

use std::fmt::Write;
use std::ops::Range;

/// Lines that a patch shows around a change.
const AROUND: usize = 3;

/// New lines in the place of old ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// Which lines go, from 0; an empty range inserts before its start.
    pub lines: Range<usize>,
    /// The lines that come, each with its end.
    pub new: Vec<String>,
}

/// `text` with `edits`, which are in order and do not overlap.
pub fn apply(text: &str, edits: &[Edit]) -> String {
    let old: Vec<&str> = text.split_inclusive('\n').collect();
    let (mut new, mut next) = (String::new(), 0);
    for edit in edits {
        new.extend(old[next..edit.lines.start].iter().copied());
        new.extend(edit.new.iter().map(String::as_str));
        next = edit.lines.end;
    }
    new.extend(old[next..].iter().copied());
    new
}

/// `edits` as a patch of the file `path`, which does not exist yet where `text` is `None`.
pub fn unified(path: &str, text: Option<&str>, edits: &[Edit]) -> String {
    let old: Vec<&str> = text.unwrap_or_default().split_inclusive('\n').collect();
    let mut patch = match text {
        Some(_) => format!("--- a/{path}\n+++ b/{path}\n"),
        None => format!("--- /dev/null\n+++ b/{path}\n"),
    };
    let mut shift: isize = 0;
    for group in edits.chunk_by(|a, b| b.lines.start - a.lines.end <= 2 * AROUND) {
        let (Some(first), Some(last)) = (group.first(), group.last()) else { continue };
        let start = first.lines.start.saturating_sub(AROUND);
        let end = (last.lines.end + AROUND).min(old.len());
        let added: usize = group.iter().map(|edit| edit.new.len()).sum();
        let removed: usize = group.iter().map(|edit| edit.lines.len()).sum();
        let (before, after) = (end - start, end - start + added - removed);
        // Lines count from 1; a range without lines is named by the line before it.
        let from = |first: usize, length: usize| if length == 0 { first } else { first + 1 };
        // Writing to a String cannot fail.
        let _ = writeln!(
            patch,
            "@@ -{},{before} +{},{after} @@",
            from(start, before),
            from(start.saturating_add_signed(shift), after)
        );
        let mut next = start;
        for edit in group {
            old[next..edit.lines.start].iter().for_each(|line| push(&mut patch, ' ', line));
            old[edit.lines.clone()].iter().for_each(|line| push(&mut patch, '-', line));
            edit.new.iter().for_each(|line| push(&mut patch, '+', line));
            next = edit.lines.end;
        }
        old[next..end].iter().for_each(|line| push(&mut patch, ' ', line));
        shift += added as isize - removed as isize;
    }
    patch
}

fn push(patch: &mut String, sign: char, line: &str) {
    patch.push(sign);
    patch.push_str(line);
    if !line.ends_with('\n') {
        patch.push_str("\n\\ No newline at end of file\n");
    }
}

#[cfg(test)]
mod tests {
    use std::process::{Command, Stdio};

    use super::*;

    fn edit(lines: Range<usize>, new: &[&str]) -> Edit {
        Edit { lines, new: new.iter().map(|line| line.to_string()).collect() }
    }

    /// The file that `git apply` makes of `text` and a patch.
    fn applied(text: Option<&str>, patch: &str) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file.toml");
        if let Some(text) = text {
            std::fs::write(&file, text).expect("writable");
        }
        std::fs::write(folder.path().join("a.patch"), patch).expect("writable");
        let mut git = Command::new("git");
        git.args(["apply", "a.patch"]).current_dir(folder.path()).env("GIT_CEILING_DIRECTORIES", folder.path());
        let output = git.stderr(Stdio::piped()).output().expect("git");
        assert!(output.status.success(), "{}\n{patch}", String::from_utf8_lossy(&output.stderr));
        std::fs::read_to_string(&file).expect("there")
    }

    #[test]
    fn git_applies_what_is_applied_here() {
        let long: String = (0..40).map(|i| format!("line {i}\n")).collect();
        let whole = [
            edit(0..1, &["first\n"]),
            edit(4..5, &[]),
            edit(5..5, &["new\n", "newer\n"]),
            edit(20..23, &[]),
            edit(38..39, &["x\n"]),
            edit(40..40, &["last\n"]),
        ];
        let texts: [(&str, &[Edit]); 3] =
            [(&long, &whole), ("one\ntwo", &[edit(1..2, &["two\n", "three\n"])]), ("one\n", &[edit(0..1, &[])])];
        for (text, edits) in texts {
            let new = apply(text, edits);
            assert_ne!(new, text);
            let patch = unified("file.toml", Some(text), edits);
            if !new.is_empty() {
                assert_eq!(applied(Some(text), &patch), new, "{patch}");
            }
        }
        let edits = [edit(0..0, &["a\n", "b\n"])];
        assert_eq!(applied(None, &unified("file.toml", None, &edits)), apply("", &edits));
    }
}
