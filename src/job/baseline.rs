//! The baseline of a job: what is to be accepted, as a patch or at once.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use super::plan::Plan;
use super::{Gathered, JobError};
use crate::report::{BaselineRow, Stored};
use crate::study::{Accepted, Baseline, Signature};

/// What a baseline says about a job.
#[derive(Debug, Default)]
pub(super) struct Kept {
    /// Scenes that only the baseline has.
    pub not_in_job: Vec<String>,
    /// What would bring it up to date.
    pub patch: Option<String>,
}

/// The baseline of `plan` beside the numbers of the reports.
///
/// # Errors
/// It cannot be read.
pub(super) fn of(plan: &Plan, reports: &[Option<Stored>]) -> Result<Kept, JobError> {
    let Some(path) = &plan.baseline else { return Ok(Kept::default()) };
    let accepted = if plan.accept { Accepted::read_if_there(path)? } else { Accepted::read(path)? };
    let in_job = |name: &str| plan.scenes.iter().any(|scene| scene.name == name);
    let not_in_job = accepted.scenes().filter(|name| !in_job(name)).map(str::to_string).collect();
    let unsigned = Signature { by: String::new(), on: today(), reason: String::new() };
    let found = found(plan, reports.iter().map(Option::as_ref));
    let patch = (!plan.accept).then(|| accepted.patch(&place(path), &found, &unsigned)).flatten();
    Ok(Kept { not_in_job, patch })
}

/// Writes the numbers of a job into its baseline, if its plan says so; gives whether anything changed.
///
/// # Errors
/// It cannot be read or written.
pub fn accept(plan: &Plan, gathered: &Gathered, signature: &Signature) -> Result<bool, JobError> {
    let Some(path) = plan.baseline.as_ref().filter(|_| plan.accept) else { return Ok(false) };
    let found = found(plan, gathered.reports.iter().map(Option::as_ref));
    match Accepted::read_if_there(path)?.with(&found, signature) {
        Some(text) => Baseline::write_text(path, text).map(|()| true).map_err(JobError::Baseline),
        None => Ok(false),
    }
}

fn found<'a>(plan: &Plan, reports: impl Iterator<Item = Option<&'a Stored>>) -> BTreeMap<String, Vec<BaselineRow>> {
    let rows = plan.scenes.iter().zip(reports);
    rows.filter_map(|(scene, report)| Some((scene.name.clone(), report?.baseline.clone()))).collect()
}

/// The path of a file as `git apply` wants it: from the top of the working tree that the file is in, from here otherwise.
fn place(path: &Path) -> String {
    let whole = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let tree = whole.ancestors().skip(1).find(|folder| folder.join(".git").exists());
    let here = std::env::current_dir().and_then(|here| here.canonicalize()).ok();
    let inside = tree.or(here.as_deref()).and_then(|top| whole.strip_prefix(top).ok());
    let own = whole.file_name().map(Path::new).unwrap_or(path);
    inside.unwrap_or(own).display().to_string()
}

/// The date here and now, of the meridian of Greenwich.
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    date((seconds / 86_400) as i64)
}

/// The date `days` after 1970-01-01, in the Gregorian calendar.
fn date(days: i64) -> String {
    // Years from March on, in eras of 400 years of 146,097 days; 1970-01-01 is day 719,468 of them.
    let day = days + 719_468;
    let (era, of_era) = (day.div_euclid(146_097), day.rem_euclid(146_097));
    let year = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{day:02}", year + era * 400 + next)
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (days, expected) in [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_779, "2026-11-22"),
            (47_540, "2100-02-28"),
            (47_541, "2100-03-01"),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
