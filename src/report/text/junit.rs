//! `junit.xml`: one test case per check, and one per quantity.

use std::time::Duration;

use quick_junit::{
    NonSuccessKind, Report as JunitReport, SerializeError, TestCase, TestCaseStatus, TestSuite, XmlString,
};

use super::number::{optional, significant};
use super::words::worth_a_look;
use crate::cause::told;
use crate::compare::Check;
use crate::report::{QuantitySummary, Report, Status};

/// The checks as a JUnit test suite named after the scene, the notes and remarks as its output; after the checks one test case
/// per quantity, which succeeded where its interval has two ends and was skipped otherwise. A run that ends without
/// agreement though no check failed (undecided, infeasible or failed) adds one test case that says so: a file without failures must mean agreement.
pub fn junit(report: &Report) -> Result<String, SerializeError> {
    let mut suite = TestSuite::new(format!("hypercircle {} {}", report.command, report.scene));
    suite.add_test_cases(report.checks.iter().map(|check| case(check, &report.scene)));
    suite.add_test_cases(report.quantities.iter().map(|quantity| quantity_case(quantity, report)));
    suite.add_property(("run", report.run.as_str()));
    let verdict = match report.status {
        Status::Infeasible | Status::Undecided => Some(NonSuccessKind::Failure),
        Status::Failed => Some(NonSuccessKind::Error),
        Status::Agree | Status::Disagree => None,
    };
    if let Some(kind) = verdict {
        let mut status = TestCaseStatus::non_success(kind);
        status.set_message(report.verdict.as_str()).set_type(super::words::status_word(report.status));
        suite.add_test_case(with_class(TestCase::new("verdict", status), &report.scene));
    }
    if let Some(time) = total_seconds(report) {
        suite.set_time(time);
    }
    let notes = report.notes.iter().map(|note| note.text.clone());
    let remarks =
        worth_a_look(report).into_iter().map(|remark| format!("worth a look: {}: {}", remark.name, remark.why));
    let output: Vec<String> = notes.chain(remarks).collect();
    if !output.is_empty() {
        suite.set_system_out(output.join("\n"));
    }
    let mut junit = JunitReport::new("hypercircle");
    if let Some(time) = total_seconds(report) {
        junit.set_time(time);
    }
    junit.add_test_suite(suite);
    junit.to_string().map(for_jenkins)
}

/// Without the one attribute that Jenkins' schema does not have: `skipped` of all suites together.
pub(crate) fn for_jenkins(text: String) -> String {
    let Some(start) = text.find("<testsuites") else { return text };
    let end = text[start..].find('>').map_or(text.len(), |i| start + i);
    let Some(from) = text[start..end].find(" skipped=\"").map(|i| start + i) else { return text };
    let value = from + " skipped=\"".len();
    let Some(to) = text[value..end].find('"').map(|i| value + i + 1) else { return text };
    [&text[..from], &text[to..]].concat()
}

fn with_class(mut case: TestCase, scene: &str) -> TestCase {
    case.classname = Some(XmlString::new(format!("hypercircle.{scene}")));
    case
}

/// One check of the scene named `scene`.
pub(crate) fn case(check: &Check, scene: &str) -> TestCase {
    let status = if check.passed {
        TestCaseStatus::success()
    } else {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        let message = match check.difference {
            Some(difference) => {
                format!(
                    "{} (difference {}, allowed {})",
                    told(check),
                    significant(difference, 6),
                    significant(check.allowed, 6)
                )
            }
            None => told(check),
        };
        status.set_message(message).set_type(super::words::basis_word(check.basis));
        status.set_description(format!(
            "value {}\nreference {}\ndifference {}\nallowed {}\nwhat it asks: {}",
            optional(check.value, 12),
            optional(check.reference, 12),
            optional(check.difference, 6),
            significant(check.allowed, 6),
            check.why
        ));
        status
    };
    with_class(TestCase::new(check.name.as_str(), status), scene)
}

/// The interval of a quantity. Whether values lie in it is a matter of the checks.
fn quantity_case(quantity: &QuantitySummary, report: &Report) -> TestCase {
    let status = if quantity.is_enclosed() {
        TestCaseStatus::success()
    } else {
        let mut status = TestCaseStatus::skipped();
        status.set_message(quantity.reason.as_deref().unwrap_or("an end of its interval is missing"));
        status
    };
    let mut case = TestCase::new(format!("quantity/{}", quantity.name), status);
    case.set_system_out(quantity.in_words(report.firmness()));
    with_class(case, &report.scene)
}

/// Time of the run, where it is one that a duration can hold.
fn total_seconds(report: &Report) -> Option<Duration> {
    let whole = report.provenance.seconds.get("total").copied();
    let seconds = whole.or_else(|| report.dual.as_ref().map(|dual| dual.seconds.total))?;
    Duration::try_from_secs_f64(seconds).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn failures_are_counted_named_and_explained() {
        let report = Sample::new(2, Verdict::Disagree).dossier().report;
        let text = junit(&report).unwrap();
        assert_well_formed(&text);
        assert!(!text.lines().nth(1).unwrap().contains("skipped"), "no attribute of <testsuites> in Jenkins' schema");
        let parsed = JunitReport::deserialize_from_str(&text).unwrap();
        let failing = report.checks.iter().filter(|c| !c.passed).count();
        assert_eq!((parsed.tests, parsed.failures), (report.checks.len() + report.quantities.len(), failing));
        assert!(failing >= 2);
        for check in report.checks.iter().filter(|c| !c.passed) {
            let case = parsed.test_suites[0].test_cases.iter().find(|c| c.name.as_str() == check.name).unwrap();
            let TestCaseStatus::NonSuccess { description: Some(text), .. } = &case.status else {
                panic!("{}", check.name)
            };
            assert!(text.as_str().contains("allowed") && text.as_str().contains(&check.why));
        }
        assert!(parsed.test_suites[0].system_out.as_ref().unwrap().as_str().contains(&report.notes[0].text));
    }

    #[test]
    fn quantities_succeed_with_two_ends_and_are_skipped_with_a_reason() {
        let report = Sample::new(1, Verdict::Agree).dossier().report;
        let parsed = JunitReport::deserialize_from_str(&junit(&report).unwrap()).unwrap();
        let case = |name: &str| parsed.test_suites[0].test_cases.iter().find(|c| c.name.as_str() == name).unwrap();
        assert!(matches!(case("quantity/tip <a&b>").status, TestCaseStatus::Success { .. }));
        assert!(case("quantity/tip <a&b>").system_out.as_ref().unwrap().as_str().contains("0.79 … 0.81"));
        let TestCaseStatus::Skipped { message: Some(reason), .. } = &case("quantity/seat").status else {
            panic!("{:?}", case("quantity/seat").status)
        };
        assert_eq!(reason.as_str(), "nothing holds <it>");
    }

    #[test]
    fn no_verdict_is_no_success() {
        for (verdict, failures, errors) in
            [(Verdict::Infeasible, 1, 0), (Verdict::Failed, 0, 1), (Verdict::Undecided, 1, 0)]
        {
            let mut report = Sample::new(1, verdict).dossier().report;
            report.checks.clear();
            let parsed = JunitReport::deserialize_from_str(&junit(&report).unwrap()).unwrap();
            assert_eq!((parsed.failures, parsed.errors), (failures, errors));
        }
    }

    #[test]
    fn odd_times_and_characters_do_no_harm() {
        let mut report = Sample::new(1, Verdict::Agree).dossier().report;
        report.provenance.seconds.insert("total".to_string(), f64::NAN);
        report.checks[0].name = "a\u{1}<b>&\"".to_string();
        assert_well_formed(&junit(&report).unwrap());
    }
}
