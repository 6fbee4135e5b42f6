//! Sessions that README and docs show: commands behind `$ ` with what they print, run again and compared line by line.
//!
//! A block of the language `console` is a session; all of a page run in one folder, in order. A line behind a command that
//! ends with `\` continues it. `[…]` stands for whatever depends on time and machine, and alone on a line for lines left out.
//! A comment `<!-- file: NAME -->` above any other block writes it to that file first.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Stands for text, or for lines, that are not shown.
const LEFT_OUT: &str = "[…]";

/// A fenced block of a page.
pub struct Block {
    /// The number of its first line.
    pub line: usize,
    pub language: String,
    /// The file that it is written to.
    pub file: Option<String>,
    pub text: String,
}

/// A command of a session and the lines that it prints.
struct Shown<'a> {
    line: usize,
    command: String,
    prints: Vec<&'a str>,
}

/// README and the pages of `docs`, by their names from the root of the repository.
pub fn pages() -> Vec<String> {
    let docs = root().join("docs");
    let files =
        std::fs::read_dir(docs).expect("part of the repository").map(|entry| entry.expect("readable").file_name());
    let names = files.map(|name| name.into_string().expect("names in UTF-8"));
    let mut pages: Vec<String> =
        names.filter(|name| name.ends_with(".md")).map(|name| format!("docs/{name}")).collect();
    pages.push("README.md".to_string());
    pages.sort();
    pages
}

/// The text of a page.
pub fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).expect("part of the repository")
}

/// The fenced blocks of `text`.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut inside, mut above) = (false, "");
    for (number, line) in text.lines().enumerate() {
        match (inside, line.strip_prefix("```")) {
            (true, Some(_)) => inside = false,
            (true, None) => {
                let block = blocks.last_mut().expect("one has begun");
                block.text.push_str(line);
                block.text.push('\n');
            }
            (false, Some(language)) => {
                let file = above.strip_prefix("<!-- file: ").and_then(|rest| rest.strip_suffix(" -->"));
                blocks.push(Block {
                    line: number + 2,
                    language: language.trim().to_string(),
                    file: file.map(str::to_string),
                    text: String::new(),
                });
                inside = true;
            }
            (false, None) => {}
        }
        above = line;
    }
    blocks
}

/// True if a session in `text` compares with FEniCSx.
pub fn needs_reference(text: &str) -> bool {
    let blocks = blocks(text);
    let sessions = blocks.iter().filter(|block| block.language == "console");
    sessions.flat_map(shown).any(|shown| shown.command.contains("hypercircle verify"))
}

/// Runs the sessions of `page`, which has this text; gives how many commands there were, and what differs from the page.
pub fn replay(page: &str, text: &str) -> (usize, Vec<String>) {
    let folder = scratch();
    let (mut commands, mut wrong) = (0, Vec::new());
    for block in blocks(text) {
        if let Some(file) = &block.file {
            std::fs::write(folder.path().join(file), &block.text).expect("writable");
        }
        if block.language != "console" {
            continue;
        }
        for shown in shown(&block) {
            commands += 1;
            let printed = printed(folder.path(), &shown.command);
            let lines = printed.lines().map(str::trim_end);
            // Signs of life of a run that takes long on this machine.
            let lines: Vec<&str> = lines.filter(|line| !line.ends_with(" after the start)")).collect();
            if !fit(&shown.prints, &lines) {
                let (line, command, prints) = (shown.line, &shown.command, shown.prints.join("\n"));
                wrong.push(format!("{page}:{line}: `{command}` is shown with\n{prints}\nand prints\n{printed}"));
            }
        }
    }
    (commands, wrong)
}

/// The commands of a session.
fn shown(block: &Block) -> Vec<Shown<'_>> {
    let mut commands: Vec<Shown> = Vec::new();
    for (number, line) in block.text.lines().enumerate() {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => {
                commands.push(Shown { line: block.line + number, command: command.to_string(), prints: Vec::new() });
            }
            (None, Some(last)) if last.prints.is_empty() && last.command.ends_with('\\') => {
                last.command.push('\n');
                last.command.push_str(line);
            }
            (None, Some(last)) => last.prints.push(line.trim_end()),
            (None, None) => panic!("line {} of a session comes before its first command: {line}", block.line + number),
        }
    }
    commands
}

/// A folder as a reader has it who built the program: it is on the path, beside the Python of the tests, and the cases are there.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let python =
        std::env::var_os("HYPERCIRCLE_PYTHON").map_or_else(|| PathBuf::from("/usr/bin/python3"), PathBuf::from);
    std::fs::create_dir(folder.path().join("bin")).expect("a new folder");
    let links = [
        (PathBuf::from(env!("CARGO_BIN_EXE_hypercircle")), "bin/hypercircle"),
        (python, "bin/python3"),
        (root().join("cases"), "cases"),
        (root().join("examples"), "examples"),
    ];
    for (target, name) in links {
        std::os::unix::fs::symlink(target, folder.path().join(name)).expect("a new link");
    }
    folder
}

/// The output of a command on both streams, in the order in which it comes.
fn printed(folder: &Path, command: &str) -> String {
    let path = std::env::var("PATH").expect("a path");
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("exec 2>&1\n{command}")]).current_dir(folder);
    shell.env("PATH", format!("{}:{path}", folder.join("bin").display())).env_remove("RUST_BACKTRACE");
    for name in ["GITHUB_ACTIONS", "GITHUB_STEP_SUMMARY", "COLUMNS"] {
        shell.env_remove(name);
    }
    let output = shell.stdin(Stdio::null()).output().expect("a shell");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// True if `printed` matches the lines that a page shows.
fn fit(shown: &[&str], printed: &[&str]) -> bool {
    match shown.split_first() {
        None => printed.is_empty(),
        Some((&LEFT_OUT, rest)) => (1..=printed.len()).any(|left_out| fit(rest, &printed[left_out..])),
        Some((line, rest)) => {
            printed.split_first().is_some_and(|(first, others)| alike(line, first) && fit(rest, others))
        }
    }
}

/// True if a printed line matches the one that a page shows.
fn alike(shown: &str, printed: &str) -> bool {
    let Some((before, behind)) = shown.split_once(LEFT_OUT) else {
        return shown == printed;
    };
    let Some(rest) = printed.strip_prefix(before) else {
        return false;
    };
    let ends = rest.char_indices().map(|(place, letter)| place + letter.len_utf8());
    ends.into_iter().any(|end| alike(behind, &rest[end..]))
}

/// The root of the repository.
fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}
