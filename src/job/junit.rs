//! `junit.xml`: one test suite a scene, one test case a check.

use std::time::Duration;

use quick_junit::{
    NonSuccessKind, Report as JunitReport, SerializeError, TestCase, TestCaseStatus, TestSuite, XmlString,
};

use super::data::{Entry, Gathered, Job, SceneStatus};
use crate::report::text::number::clean;
use crate::report::{Stored, case, for_jenkins};

/// The suites in the order of the scenes. A scene that ends otherwise than with agreement though none of its checks failed has
/// one more test case, which says so: a `failure` where it is judged, an `error` where it could not be.
pub(super) fn junit(gathered: &Gathered) -> Result<String, SerializeError> {
    let job = &gathered.job;
    let mut junit = JunitReport::new(format!("hypercircle {}", job.command));
    for (entry, report) in job.scenes.iter().zip(&gathered.reports) {
        junit.add_test_suite(suite(job, entry, report.as_ref()));
    }
    if let Some(time) = time(job.seconds) {
        junit.set_time(time);
    }
    junit.to_string().map(for_jenkins)
}

fn suite(job: &Job, entry: &Entry, report: Option<&Stored>) -> TestSuite {
    let mut suite = TestSuite::new(format!("hypercircle {} {}", job.command, clean(&entry.name)));
    suite.add_property(("scene", clean(&entry.scene).as_str()));
    suite.add_property(("exit", entry.exit.to_string().as_str()));
    suite.add_property(("status", entry.status.words()));
    if let Some(run) = &entry.run {
        suite.add_property(("run", run.as_str()));
    }
    if let Some(report) = report {
        suite.add_test_cases(report.checks.iter().map(|check| case(check, &entry.name)));
    }
    if entry.exit != 1 && entry.exit != 0 || entry.exit == 1 && entry.failing.is_empty() {
        let judged = matches!(entry.status, SceneStatus::Undecided | SceneStatus::Infeasible | SceneStatus::Disagree);
        let mut status =
            TestCaseStatus::non_success(if judged { NonSuccessKind::Failure } else { NonSuccessKind::Error });
        status.set_message(clean(&entry.verdict)).set_type(entry.status.words());
        status.set_description(clean(&entry.said.join("\n")));
        suite.add_test_case(verdict(entry, status));
    } else if entry.checks == 0 {
        suite.add_test_case(verdict(entry, TestCaseStatus::success()));
    }
    if let Some(time) = time(entry.seconds) {
        suite.set_time(time);
    }
    suite
}

fn verdict(entry: &Entry, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new("verdict", status);
    case.classname = Some(XmlString::new(format!("hypercircle.{}", entry.name)));
    case
}

fn time(seconds: f64) -> Option<Duration> {
    Duration::try_from_secs_f64(seconds).ok()
}
