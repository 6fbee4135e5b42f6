//! A small problem with its dual solution, which foreign results are held against.

use std::path::Path;
use std::sync::OnceLock;

use hypercircle::compare::{Allowances, Candidate, compare};
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::report;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, Fields, Findings, answers, assemble, certify};

/// Two blocks of unequal material in contact, four triangles; the corpora of `exchange` and `field` belong to it.
pub const SCENE: &str = include_str!("setting.toml");

/// Largest mesh that a target solves on.
pub const SMALL: usize = 200;

/// The problem, solved once.
pub fn certified() -> &'static Certified {
    static SOLVED: OnceLock<Certified> = OnceLock::new();
    SOLVED.get_or_init(|| {
        let scene = Scene::parse(SCENE, Path::new("setting.toml")).expect("a valid scene");
        let problem = Problem::load(scene).expect("a mesh");
        certify(problem, &Condensed::default(), &Options::default()).expect("a solution")
    })
}

/// Compares `candidates` with the dual solution and puts every file of a report together.
pub fn judge(certified: &Certified, candidates: Vec<Candidate>) {
    let Certified { problem, dual, bracket, .. } = certified;
    let comparison = compare(problem, dual, bracket, candidates, &Allowances::default());
    let answers = answers(certified, &Options::default(), |_| true);
    let fields = Fields::new(certified, &comparison, &answers);
    let findings = Findings {
        command: "verify",
        certified,
        comparison: &comparison,
        answers: &answers,
        diagnosis: Vec::new(),
        is_claimed: false,
        finer: None,
        enough: Some(0.05),
        history: Vec::new(),
        notes: Vec::new(),
        threads: 1,
        seconds: Vec::new(),
        components: Vec::new(),
        failure: None,
        advice: None,
        other_end: None,
        coulomb: None,
    };
    let dossier = assemble(findings, &fields);
    let text = report::json(&dossier.report).expect("every report can be written");
    assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok(), "the report is no JSON");
    report::page(&dossier);
    report::junit(&dossier.report).expect("every report can be written");
    report::summary(&dossier.report);
    report::tables(&dossier.report);
    report::vtu(&dossier).expect("every field can be written");
}
