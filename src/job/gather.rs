//! Plan, records and reports together are the job, whoever made them.

use std::path::Path;

use super::baseline;
use super::data::{Bracketed, Counts, Entry, Gathered, Job, SceneStatus};
use super::plan::{Plan, Planned};
use super::record::{End, Record};
use super::{JobError, SCHEMA_VERSION};
use crate::report::{BaselineRow, Change, Stored};

/// Gathers the results of the job `plan` from `out`. A scene without a record of this plan has not been run, and counts as failed.
///
/// # Errors
/// Its baseline cannot be read.
pub fn gather(out: &Path, plan: &Plan) -> Result<Gathered, JobError> {
    let mut scenes = Vec::new();
    let mut reports = Vec::new();
    for planned in &plan.scenes {
        let record = Record::read(out, plan, planned);
        let report = record.as_ref().and_then(|record| report_of(out, planned, record));
        scenes.push(match record {
            Some(record) => entry_of(planned, &record, report.as_ref()),
            None => not_run(planned),
        });
        reports.push(report);
    }
    let kept = baseline::of(plan, &reports)?;
    let mut job = Job {
        schema_version: SCHEMA_VERSION,
        command: plan.command.clone(),
        options: plan.options.clone(),
        version: env!("CARGO_PKG_VERSION").to_string(),
        exit: 0,
        counts: Counts::default(),
        seconds: 0.0,
        scenes,
        left_out: plan.left_out.clone(),
        not_in_job: kept.not_in_job,
    };
    job.count();
    Ok(Gathered { job, reports, patch: kept.patch })
}

/// The report that the recorded run left, and no other.
fn report_of(out: &Path, planned: &Planned, record: &Record) -> Option<Stored> {
    Stored::read(&out.join(&planned.name)).ok().filter(|report| report.run == record.run)
}

/// The entry of a scene that has ended.
pub fn entry(out: &Path, planned: &Planned, record: &Record) -> Entry {
    entry_of(planned, record, report_of(out, planned, record).as_ref())
}

fn not_run(planned: &Planned) -> Entry {
    let verdict = "This scene has not been run, or not as it is now with the options of this job.".to_string();
    empty(planned, 3, SceneStatus::NotRun, verdict)
}

fn empty(planned: &Planned, exit: u8, status: SceneStatus, verdict: String) -> Entry {
    Entry {
        name: planned.name.clone(),
        scene: planned.scene.display().to_string(),
        title: None,
        folder: None,
        exit,
        status,
        verdict,
        line: None,
        seconds: 0.0,
        run: None,
        energy: None,
        triangles: None,
        checks: 0,
        failing: Vec::new(),
        changed: Vec::new(),
        new: Vec::new(),
        missing: Vec::new(),
        said: Vec::new(),
    }
}

fn entry_of(planned: &Planned, record: &Record, report: Option<&Stored>) -> Entry {
    let code = match record.end {
        End::Exit(code @ 0..=5) => Some(code),
        _ => None,
    };
    let Some((report, code)) = report.zip(code) else {
        let (exit, status, verdict) = without_report(record);
        let line = line_of(&planned.scene.display().to_string(), &record.said);
        let (seconds, said) = (record.seconds, record.said.clone());
        return Entry { line, seconds, said, ..empty(planned, exit, status, verdict) };
    };
    let rows = |change: Change| {
        let of = |row: &&BaselineRow| row.change == change;
        report.baseline.iter().filter(of).map(|row| row.name.clone()).collect()
    };
    Entry {
        title: Some(report.title.clone()),
        folder: Some(planned.name.clone()),
        seconds: record.seconds,
        run: Some(record.run.clone()),
        energy: report.energy.map(|energy| Bracketed {
            lower: energy.lower,
            upper: energy.upper,
            relative_error_bound: energy.relative_error_bound,
            guaranteed: energy.guaranteed,
        }),
        triangles: report.dual.as_ref().map(|dual| dual.triangles),
        checks: report.checks.len(),
        failing: report.checks.iter().filter(|check| !check.passed).map(|check| check.name.clone()).collect(),
        changed: rows(Change::Changed),
        new: rows(Change::New),
        missing: rows(Change::Missing),
        ..empty(planned, code, SceneStatus::of(report.status, code), report.verdict.clone())
    }
}

/// How a run without a report counts, and why there is none.
fn without_report(record: &Record) -> (u8, SceneStatus, String) {
    let seconds = || crate::report::text::number::seconds(record.seconds);
    let reason = reason(&record.said);
    match record.end {
        End::TimedOut => {
            let verdict = format!(
                "It took longer than a scene may, and was ended after {}; allow more with --scene-seconds.",
                seconds()
            );
            (3, SceneStatus::TimedOut, verdict)
        }
        End::Signal(Some(signal)) => {
            (3, SceneStatus::Crashed, format!("Its process was ended by signal {signal}. {reason}"))
        }
        End::Signal(None) => (3, SceneStatus::Crashed, format!("Its process ended without telling how. {reason}")),
        End::Exit(2) => (2, SceneStatus::BadInput, reason),
        End::Exit(3) => (3, SceneStatus::Failed, reason),
        End::Exit(4) => (4, SceneStatus::NotInstalled, reason),
        End::Exit(5) => (5, SceneStatus::Infeasible, reason),
        End::Exit(code) => {
            let verdict =
                format!("It ended with exit code {code} and left no report of its own in its folder. {reason}");
            (3, SceneStatus::Crashed, verdict.trim_end().to_string())
        }
    }
}

/// Reason of the last error that a run printed: the lines from its mark to its help, joined into one.
fn reason(said: &[String]) -> String {
    let start = said.iter().rposition(|line| line.trim_start().starts_with("x ")).unwrap_or(0);
    let words: Vec<&str> = said[start..]
        .iter()
        .map(|line| line.trim())
        .take_while(|line| !line.starts_with("help:") && !line.starts_with(",-["))
        .filter(|line| !line.is_empty())
        .collect();
    let text = words.join(" ");
    text.strip_prefix("x ").unwrap_or(&text).to_string()
}

/// The line of `scene` that an error points at: `scene:21:11]`.
fn line_of(scene: &str, said: &[String]) -> Option<usize> {
    let after = |line: &String| line.split_once(&format!("[{scene}:")).map(|(_, rest)| rest.to_string());
    let rest = said.iter().find_map(after)?;
    rest.split(':').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_becomes_a_sentence_and_a_line() {
        let said: Vec<String> =
            "  x `poisson` in [bodies.left] is 0.5, but ν must lie in (−1, 0.5)\n   ,-[a b/c.toml:21:11]\n 20 | young\
                                 \n    :\n   `----\n  help: choose less"
                .lines()
                .map(str::to_string)
                .collect();
        assert_eq!(reason(&said), "`poisson` in [bodies.left] is 0.5, but ν must lie in (−1, 0.5)");
        assert_eq!(line_of("a b/c.toml", &said), Some(21));
        assert_eq!(line_of("c.toml", &said), None);
        assert_eq!(reason(&[]), "");
    }
}
