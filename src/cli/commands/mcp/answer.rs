//! Answer of a tool: short words for people, and data for programs.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use crate::cli::conclude::lines;
use crate::cli::{CliError, Exit};
use crate::report::Report;
use crate::workbench::{self, SHIPPED, Shipped};

/// Entries of a list that an answer shows; the report of a command has them all.
const MOST_ENTRIES: usize = 40;
/// Characters of the words.
const MOST_WORDS: usize = 6000;

/// The answer to a call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// True if there is no answer, because the request or the run is at fault.
    pub is_error: bool,
    /// In words.
    pub words: String,
    /// In data.
    pub data: Value,
}

impl Answer {
    /// Says that something is wrong. That a scene has no equilibrium is an answer about the scene.
    pub fn refused(error: &CliError) -> Self {
        let (message, remedy) = match error {
            CliError::Scene(scene) => (scene.to_string(), scene.remedy()),
            CliError::Stopped { message, remedy, .. } => (message.clone(), remedy.clone()),
        };
        let words = if remedy.is_empty() || message.contains(&remedy) {
            message.clone()
        } else {
            format!("{message}; {remedy}")
        };
        let status = match error.exit() {
            Exit::NoEquilibrium => "infeasible",
            Exit::BadInput => "refused",
            Exit::NotInstalled => "not-installed",
            Exit::Failed | Exit::Agree | Exit::Disagree => "failed",
        };
        let data = json!({"status": status, "verdict": message, "remedy": remedy});
        Answer { is_error: status != "infeasible", words: shortened(words), data }
    }

    /// Says that time was over.
    pub fn late(seconds: f64) -> Self {
        let what = format!("the call was ended after {seconds} s, without an answer");
        let remedy = "ask for a coarser mesh, a larger tolerance or fewer refinements, or start the server with a larger --max-seconds";
        Answer::refused(&CliError::stopped(Exit::Failed, what, remedy))
    }

    /// The main keys of a report.
    pub fn of_report(report: &Report) -> Self {
        let whole = serde_json::to_value(report).unwrap_or_default();
        let mut data = Map::new();
        for key in [
            "status",
            "verdict",
            "energy",
            "data_range",
            "coulomb",
            "dual",
            "stress",
            "causes",
            "quantities",
            "diagnosis",
        ] {
            if let Some(value) = whole.get(key).filter(|value| !value.is_null()) {
                data.insert(key.to_string(), first(value.clone()));
            }
        }
        let chosen = |key: &str, names: &[&str]| -> Value {
            let entries = whole[key].as_array().into_iter().flatten();
            let of = |entry: &Value| {
                names.iter().map(|name| (name.to_string(), entry[*name].clone())).collect::<Map<_, _>>()
            };
            first(entries.map(|entry| Value::Object(of(entry))).collect())
        };
        let models = ["name", "degree", "cells", "energy", "admissible", "relative_error_bound"];
        data.insert("primal".into(), chosen("primal", &models));
        let contacts = ["name", "resultant", "pressure_max", "open_fraction", "pressure_l2_difference"];
        data.insert("contact".into(), chosen("contact", &contacts));
        data.insert("notes".into(), first(report.notes.iter().map(|note| Value::from(note.text.clone())).collect()));
        let failed = report.checks.iter().filter(|check| !check.passed);
        data.insert(
            "failed_checks".into(),
            first(failed.filter_map(|check| serde_json::to_value(check).ok()).collect()),
        );
        data.insert("passed_checks".into(), report.checks.iter().filter(|check| check.passed).count().into());
        Answer { is_error: false, words: shortened(lines(report).join("\n")), data: Value::Object(data) }
    }

    /// The findings on an element.
    pub fn of_element(report: &workbench::Report) -> Self {
        let mut data = serde_json::to_value(report).unwrap_or_default();
        if let Some(data) = data.as_object_mut() {
            let status = if report.passed { "agree" } else { "disagree" };
            data.insert("status".into(), status.into());
            data.remove("nodes");
        }
        let missing = report.findings.iter().filter(|finding| finding.is_missing()).map(|finding| finding.in_words());
        let diagnosis = report.diagnosis.as_ref().map(|diagnosis| diagnosis.sentence.clone());
        let others = report.hint.iter().chain(&report.untold).cloned();
        let words: Vec<String> =
            [report.verdict.clone()].into_iter().chain(diagnosis).chain(missing).chain(others).collect();
        Answer { is_error: false, words: shortened(words.join("\n")), data }
    }

    /// The elements that come with the program.
    pub fn list() -> Self {
        let told =
            |element: &Shipped| json!({"name": element.name, "about": element.about, "claims": element.claims()});
        let words: Vec<String> = SHIPPED.iter().map(|element| format!("{}: {}", element.name, element.about)).collect();
        let elements: Vec<Value> = SHIPPED.iter().map(told).collect();
        let verdict = format!("{} elements come with the program; name one of them, or give a matrix", elements.len());
        let data = json!({"status": "agree", "verdict": verdict, "elements": elements});
        Answer { is_error: false, words: shortened(words.join("\n")), data }
    }

    /// The result of `tools/call`: hosts that know no structured content find the data in the text.
    pub fn result(self) -> Value {
        let text = self.data.to_string();
        json!({
            "content": [{"type": "text", "text": self.words}, {"type": "text", "text": text}],
            "structuredContent": self.data,
            "isError": self.is_error,
        })
    }
}

/// A list without what is too long to be read; what is no list stays.
fn first(value: Value) -> Value {
    match value {
        Value::Array(mut entries) => {
            entries.truncate(MOST_ENTRIES);
            Value::Array(entries)
        }
        other => other,
    }
}

fn shortened(words: String) -> String {
    match words.char_indices().nth(MOST_WORDS) {
        Some((end, _)) => format!("{}…", &words[..end]),
        None => words,
    }
}
