//! Trials as Markdown.

use std::collections::{BTreeMap, BTreeSet};

use super::run::Way;
use super::{ADAPTIVE, METHODS, Trial};

/// One line about a trial; verdicts in the order of its runs.
pub fn row(trial: &Trial) -> String {
    let seconds: f64 = trial.runs.iter().map(|r| r.1.seconds).sum();
    let triangles = trial.runs[0].1.number("/dual/triangles").map_or("–".to_owned(), |n| n.to_string());
    let runs: Vec<String> = trial.runs.iter().map(|r| r.1.verdict()).collect();
    let last = trial.runs.iter().rev().filter(|(way, _)| !matches!(way, Way::Adaptive(_)));
    let error = last.filter_map(|r| r.1.number("/energy/relative_error_bound")).next();
    let error = error.map_or("–".to_owned(), |e| format!("{e:.1e}"));
    let mut faults: Vec<&str> = trial.faults.iter().map(|f| f.kind.as_str()).collect();
    faults.dedup();
    let (seed, family) = (trial.seed, trial.family);
    format!(
        "| {seed} | {family} | {triangles} | {} | {error} | {seconds:.1} | {} |",
        runs.join(" | "),
        faults.join("; ")
    )
}

/// The head of the table whose lines [`row`] makes.
pub fn head(models: bool) -> String {
    let mut names: Vec<&str> = METHODS.to_vec();
    names.push("finer");
    names.extend(ADAPTIVE);
    names.extend(models.then_some("verify"));
    let rule = "|---".repeat(names.len());
    format!(
        "| seed | family | triangles | {} | error at most | seconds | wrong |\n|--:|---|--:{rule}|--:|--:|---|",
        names.join(" | ")
    )
}

/// The verdict of the last run that is no adaptive one: those may end at their limits.
fn last_verdict(trial: &Trial) -> String {
    let mut others = trial.runs.iter().rev().filter(|(way, _)| !matches!(way, Way::Adaptive(_)));
    others.next().map_or(String::new(), |run| run.1.verdict())
}

/// Table of verdicts by family, and of all.
pub fn families(trials: &[Trial]) -> String {
    const VERDICTS: [&str; 5] = ["agree", "undecided", "disagree", "failed", "infeasible"];
    let line = |name: &str, is_in: &dyn Fn(&Trial) -> bool| {
        let verdicts: Vec<String> = trials.iter().filter(|trial| is_in(trial)).map(last_verdict).collect();
        let counts = VERDICTS.map(|known| verdicts.iter().filter(|verdict| *verdict == known).count().to_string());
        format!("| {name} | {} | {} |\n", verdicts.len(), counts.join(" | "))
    };
    let names: BTreeSet<&str> = trials.iter().map(|trial| trial.family).collect();
    let lines: String = names.iter().map(|name| line(name, &|trial| trial.family == *name)).collect();
    let rule = "|--:".repeat(VERDICTS.len());
    format!("| family | scenes | {} |\n|---|--:{rule}|\n{lines}{}", VERDICTS.join(" | "), line("all", &|_| true))
}

/// Table of faults by kind with their counts and seeds, and of verdicts with their counts.
pub fn groups(trials: &[Trial]) -> String {
    let mut verdicts: BTreeMap<String, usize> = BTreeMap::new();
    let mut kinds: BTreeMap<&str, Vec<u64>> = BTreeMap::new();
    for trial in trials {
        *verdicts.entry(last_verdict(trial)).or_default() += 1;
        for fault in &trial.faults {
            let seeds = kinds.entry(&fault.kind).or_default();
            if seeds.last() != Some(&trial.seed) {
                seeds.push(trial.seed);
            }
        }
    }
    let verdicts: Vec<String> = verdicts.iter().map(|(verdict, count)| format!("{count} {verdict}")).collect();
    let wrong = trials.iter().filter(|t| !t.faults.is_empty()).count();
    let mut text = format!("{} scenes: {}; something is wrong with {wrong}.\n", trials.len(), verdicts.join(", "));
    let mut kinds: Vec<_> = kinds.into_iter().collect();
    kinds.sort_by_key(|(_, seeds)| std::cmp::Reverse(seeds.len()));
    if !kinds.is_empty() {
        text.push_str("\n| wrong | scenes | seeds |\n|---|--:|---|\n");
    }
    for (kind, seeds) in kinds {
        let list: Vec<String> = seeds.iter().map(u64::to_string).collect();
        text.push_str(&format!("| {} | {} | {} |\n", kind.replace('|', "\\|"), seeds.len(), list.join(" ")));
    }
    text
}
