//! Messages of a run to the service that runs it: GitHub's page of a step, and its marks beside the lines of files.

use std::env;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::say::{self, shown};
use crate::cli::CliError;
use crate::report::{Report, Status, summary};

/// Bytes that GitHub shows of a step.
const MOST: u64 = 1 << 20;
/// Marks that GitHub shows of a step.
const MARKS: usize = 10;

/// True once anything has been marked.
static MARKED: AtomicBool = AtomicBool::new(false);

/// One thing that is wrong with a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Complaint {
    /// The file, where it is about one.
    pub file: Option<PathBuf>,
    /// The line, from 1.
    pub line: Option<usize>,
    /// A few words.
    pub title: String,
    /// A sentence.
    pub message: String,
}

/// Appends `summary` to the page of this step, where there is one, or `short` where the page would be too long.
pub fn step_summary(summary: &str, short: &str) {
    let Some(path) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) else { return };
    let there = std::fs::metadata(&path).map_or(0, |file| file.len());
    let text = if there + (summary.len() as u64) < MOST { summary } else { short };
    // The results are written; a page that cannot be is no reason to lose the verdict.
    let opened = OpenOptions::new().create(true).append(true).open(&path);
    if let Err(error) = opened.and_then(|mut file| writeln!(file, "{text}")) {
        let path = path.to_string_lossy();
        say::complaint(&format!("the summary of this step is missing: GITHUB_STEP_SUMMARY is {path}, and {error}"));
    }
}

/// Marks the first complaints where GitHub runs this.
pub fn annotate(complaints: &[Complaint]) {
    if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
        for complaint in complaints.iter().take(MARKS) {
            MARKED.store(true, Ordering::Relaxed);
            let _ = writeln!(std::io::stdout(), "{}", mark(complaint, &workspace()));
        }
    }
}

/// Tells of the report on one scene.
pub fn report(report: &Report, scene: &Path) {
    step_summary(&summary(report), &report.verdict);
    if report.status != Status::Agree {
        let message = report.causes.first().map_or(report.verdict.clone(), |cause| cause.sentence.clone());
        annotate(&[Complaint { file: Some(scene.to_path_buf()), line: None, title: report.scene.clone(), message }]);
    }
}

/// Marks an error that a command ended with, unless the run has marked what was wrong already.
pub fn annotate_error(error: &CliError) {
    if MARKED.load(Ordering::Relaxed) {
        return;
    }
    let place = match error {
        CliError::Scene(error) => error.place(),
        CliError::Stopped { .. } => None,
    };
    let (file, line) = place.map(|place| (place.path().to_path_buf(), place.line())).unzip();
    annotate(&[Complaint { file, line, title: "hypercircle".to_string(), message: error.to_string() }]);
}

fn workspace() -> PathBuf {
    env::var_os("GITHUB_WORKSPACE").map_or_else(|| env::current_dir().unwrap_or_default(), PathBuf::from)
}

/// `::error file=…,line=…,title=…::…`
fn mark(complaint: &Complaint, workspace: &Path) -> String {
    let file = complaint.file.as_ref().map_or(String::new(), |given| {
        let whole = std::path::absolute(given).unwrap_or_else(|_| given.clone());
        let inside = whole.strip_prefix(workspace).unwrap_or(given);
        let inside: PathBuf = inside.components().filter(|part| *part != Component::CurDir).collect();
        format!("file={},", property(&inside.display().to_string()))
    });
    let line = complaint.line.map_or(String::new(), |line| format!("line={line},"));
    format!("::error {file}{line}title={}::{}", property(&complaint.title), data(&shown(&complaint.message)))
}

/// Text behind the last colons.
fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// Text between them.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_one_line_whatever_it_says() {
        let complaint = Complaint {
            file: Some(PathBuf::from("/work/a/./cases/b,c.toml")),
            line: Some(3),
            title: "x: disagree".to_string(),
            message: "50 %\n::error::not mine".to_string(),
        };
        let expected = "::error file=cases/b%2Cc.toml,line=3,title=x%3A disagree::50 %25%0A::error::not mine";
        assert_eq!(mark(&complaint, Path::new("/work/a")), expected);
    }
}
