//! `hypercircle stability`: cells say what happened, planted lies are found, and the program's own methods hold.

use hypercircle::measure::{Answer, End, Ended, Machine, Measured, Method, Seconds};
use hypercircle::stability::{Cell, Claim, Known, Matrix, Outcome, REGIMES, Row, Step, Truth, judge};
use hypercircle::study::Adapt;

use crate::command::{ended, hypercircle, run};

/// An answer that is right: the exact energy −1 inside, the force exact.
fn good() -> Answer {
    Answer {
        solver: None,
        triangles: 8,
        unknowns: 10,
        iterations: 1,
        lower: Some(-1.001),
        upper: Some(-0.999),
        strain: Some(1.0),
        relative_error_bound: Some(0.002_f64.sqrt()),
        equilibrium: Some(1e-15),
        violation: None,
        resultants: vec![[-0.5, 0.0]],
        pressure_max: vec![1.0],
        variation: vec![1.0],
        quantities: Vec::new(),
        missing: None,
    }
}

fn told(method: Method, end: End, answer: Option<Answer>) -> Ended {
    let (seconds, peak_memory) = (Seconds::default(), None);
    Ended::Told(vec![Measured { method: method.name().to_string(), end, answer, seconds, peak_memory }])
}

fn known() -> Known {
    Known { variation: vec![1.0], ..Known::forces(vec![[-0.5, 0.0]], 1.0) }
}

fn outcome_of(method: Method, known: &Known, ended: &Ended) -> (Outcome, String) {
    let truth = Some(Truth { lower: -1.0, upper: -1.0, strain: 1.0 });
    let first = good();
    let step = judge(
        method,
        ended,
        &Claim { known, truth, first: Some(&first), first_error: first.relative_error_bound, flat: Some(3.0) },
    );
    (step.outcome, step.why)
}

fn outcome(answer: Answer) -> Outcome {
    outcome_of(Method::CONDENSED, &known(), &told(Method::CONDENSED, End::Solved, Some(answer))).0
}

#[test]
fn a_right_answer_is_correct() {
    assert_eq!(outcome(good()), Outcome::Correct);
}

#[test]
fn a_bracket_that_excludes_the_truth_is_wrong() {
    assert_eq!(outcome(Answer { lower: Some(-0.9999), ..good() }), Outcome::Wrong);
    assert_eq!(outcome(Answer { upper: Some(-1.0001), ..good() }), Outcome::Wrong);
    assert_eq!(outcome(Answer { lower: Some(-1.0 + 1e-9), ..good() }), Outcome::Wrong);
}

#[test]
fn bounds_out_of_order_or_no_numbers_are_wrong() {
    assert_eq!(outcome(Answer { lower: Some(-0.99), upper: Some(-1.01), ..good() }), Outcome::Wrong);
    assert_eq!(outcome(Answer { lower: None, ..good() }), Outcome::Wrong);
    assert_eq!(outcome(Answer { upper: None, ..good() }), Outcome::Wrong);
    let missing = Some("supports disagree".to_string());
    assert_eq!(outcome(Answer { upper: None, missing, ..good() }), Outcome::Refused);
    assert_eq!(outcome(Answer { resultants: vec![[f64::NAN, 0.0]], ..good() }), Outcome::Wrong);
}

#[test]
fn a_force_that_is_off_is_wrong_unless_the_residual_says_so() {
    let off = vec![[-0.5 + 1e-6, 0.0]];
    assert_eq!(outcome(Answer { resultants: off.clone(), ..good() }), Outcome::Wrong);
    assert_eq!(outcome(Answer { resultants: off, equilibrium: Some(1e-7), ..good() }), Outcome::Inaccurate);
}

#[test]
fn a_wide_bracket_is_inaccurate_and_an_error_without_a_bound_wrong() {
    let wide = Answer { lower: Some(-1.3), upper: Some(-0.7), relative_error_bound: Some(0.6_f64.sqrt()), ..good() };
    assert_eq!(outcome(wide), Outcome::Inaccurate);
    let locked = Answer { lower: None, upper: Some(-0.6), relative_error_bound: None, equilibrium: None, ..good() };
    let ended = told(Method::Displacements(1), End::Solved, Some(locked));
    assert_eq!(outcome_of(Method::Displacements(1), &known(), &ended).0, Outcome::Wrong);
}

#[test]
fn pressure_that_goes_up_and_down_is_inaccurate() {
    assert_eq!(outcome(Answer { variation: vec![1.5], ..good() }), Outcome::Inaccurate);
}

#[test]
fn numbers_without_an_equilibrium_are_wrong_and_a_refusal_is_right() {
    let none = Known::none();
    let solved = told(Method::CONDENSED, End::Solved, Some(good()));
    assert_eq!(outcome_of(Method::CONDENSED, &none, &solved).0, Outcome::Wrong);
    let denied = told(Method::CONDENSED, End::NoEquilibrium("it slides".to_string()), None);
    assert_eq!(outcome_of(Method::CONDENSED, &none, &denied).0, Outcome::Correct);
    assert_eq!(outcome_of(Method::CONDENSED, &known(), &denied).0, Outcome::Wrong);
}

#[test]
fn every_other_end_has_its_word() {
    let of = |ended: &Ended| outcome_of(Method::UZAWA, &known(), ended).0;
    let end = |end: End| of(&told(Method::UZAWA, end, None));
    assert_eq!(end(End::Refused("too flat".to_string())), Outcome::Refused);
    assert_eq!(end(End::NotConverged("2000 steps".to_string())), Outcome::NoConvergence);
    assert_eq!(end(End::NotApplicable("no step".to_string())), Outcome::NotApplicable);
    assert_eq!(of(&Ended::OverBudget), Outcome::NoConvergence);
    assert_eq!(of(&Ended::Crashed("signal 11".to_string())), Outcome::Crash);
    assert_eq!(of(&Ended::Told(Vec::new())), Outcome::Crash);
}

#[test]
fn a_scaled_answer_must_be_the_same_to_round_off() {
    let scaled = known().scaled(4.0, 2.0);
    let scaled = Known { resultants: vec![[-1.0, 0.0]], load: 2.0, variation: Vec::new(), ..scaled };
    let truth = Some(Truth { lower: -4.0, upper: -4.0, strain: 4.0 });
    let first = good();
    let answer =
        Answer { lower: Some(-4.004), upper: Some(-3.996), strain: Some(4.0), resultants: vec![[-1.0, 0.0]], ..good() };
    let of = |answer: Answer| {
        let ended = told(Method::CONDENSED, End::Solved, Some(answer));
        judge(
            Method::CONDENSED,
            &ended,
            &Claim { known: &scaled, truth, first: Some(&first), first_error: None, flat: None },
        )
        .outcome
    };
    assert_eq!(of(answer.clone()), Outcome::Correct);
    assert_eq!(of(Answer { lower: Some(-4.004 * (1.0 + 1e-11)), ..answer }), Outcome::Inaccurate);
}

/// A matrix of one row, whose first two of three values are promised.
fn promising(method: Method, outcomes: [Outcome; 3]) -> Matrix {
    let step = |outcome| Step { outcome, why: String::new(), error: None, bound: None, answer: None };
    let worst = outcomes.into_iter().max().expect("three");
    let cell = Cell { method, solver: None, worst, steps: outcomes.map(step).to_vec() };
    let text = || "row".to_string();
    let row = Row {
        id: text(),
        title: text(),
        parameter: text(),
        values: ["1", "10", "100"].map(str::to_string).to_vec(),
        promised: 2,
        truth: text(),
        reported: text(),
        cells: vec![cell],
    };
    Matrix { schema_version: 1, machine: Machine::here(), reduced: true, command: String::new(), rows: vec![row] }
}

#[test]
fn what_is_not_correct_where_it_is_promised_is_found() {
    use Outcome::{Correct, Crash, Inaccurate, NoConvergence, Refused, Wrong};
    let missed = |method, outcomes| promising(method, outcomes).shortfalls().iter().map(|s| s.2).collect::<Vec<_>>();
    assert_eq!(missed(Method::CONDENSED, [Correct, Correct, Inaccurate]), [0; 0]);
    assert_eq!(missed(Method::CONDENSED, [Correct, Inaccurate, Correct]), [1]);
    assert_eq!(missed(Method::Adaptive(Adapt::H), [Refused, NoConvergence, Correct]), [0, 1]);
    assert_eq!(missed(Method::Adaptive(Adapt::Hp), [Correct, Wrong, Correct]), [1]);
    assert_eq!(missed(Method::CLARABEL, [Refused, Refused, Refused]), [0; 0]);
    let defects = |method, worst| promising(method, [Correct, Correct, worst]).defects().len();
    assert_eq!([Wrong, Crash, Inaccurate].map(|worst| defects(Method::UZAWA, worst)), [1, 1, 0]);
    assert_eq!(defects(Method::Displacements(1), Wrong), 0);
}

#[test]
fn a_displacement_that_penetrates_is_inaccurate() {
    let through = Answer { lower: None, relative_error_bound: None, violation: Some(1e-3), ..good() };
    let ended = told(Method::Displacements(2), End::Solved, Some(through));
    assert_eq!(outcome_of(Method::Displacements(2), &known(), &ended).0, Outcome::Inaccurate);
}

#[test]
fn an_error_that_grows_along_the_sweep_is_inaccurate_with_and_without_a_bound() {
    // √0.01 = 0.1 is more than three times the first error, 0.02.
    let growing = |method: Method, answer: Answer| {
        let (known, truth) = (known(), Some(Truth { lower: -1.0, upper: -1.0, strain: 1.0 }));
        let claim = Claim { known: &known, truth, first: None, first_error: Some(0.02), flat: Some(3.0) };
        judge(method, &told(method, End::Solved, Some(answer)), &claim).outcome
    };
    let stress = Answer { lower: Some(-1.005), upper: Some(-0.995), relative_error_bound: Some(0.1), ..good() };
    assert_eq!(growing(Method::CONDENSED, stress), Outcome::Inaccurate);
    let locked = Answer { lower: None, upper: Some(-0.99), relative_error_bound: None, ..good() };
    assert_eq!(growing(Method::Displacements(1), locked.clone()), Outcome::Inaccurate);
    assert_eq!(growing(Method::Displacements(1), Answer { upper: Some(-0.999), ..locked }), Outcome::Correct);
}

/// The files of a sweep, and that a second one makes only the runs that are missing. `ci/figures reduced` sweeps all
/// regimes.
#[test]
fn a_sweep_leaves_its_files_and_is_resumed() {
    let folder = tempfile::tempdir().expect("a folder");
    let sweep = |more: &[&str]| {
        let mut command = hypercircle(folder.path(), ["stability", "--reduced", "--quiet", "--method", "condensed"]);
        command.args(["--regime", "numbering", "--regime", "poisson-exact", "--out", "."]).args(more);
        ended("a sweep", &run(command), 0, &[]);
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("written");
        let matrix: Matrix = serde_json::from_str(&read("stability.json")).expect("readable");
        (matrix, read("runs.jsonl"))
    };
    let (matrix, runs) = sweep(&[]);
    assert_eq!(matrix.rows.len(), 2);
    assert!(matrix.rows.iter().all(|r| r.promised == r.values.len() && r.cells[0].worst == Outcome::Correct));
    for name in ["stability.html", "stability.md", "figures/stability-numbering.svg"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
    // The last run is forgotten, and an answer that no run can give shows that the first was kept.
    let mut lines: Vec<String> = runs.lines().map(str::to_string).collect();
    let removed = lines.pop().expect("a run");
    let place = lines.iter().position(|line| line.contains("\"iterations\":")).expect("an answer");
    lines[place] = lines[place].replace("\"iterations\":", "\"iterations\":77");
    std::fs::write(folder.path().join("runs.jsonl"), lines.join("\n") + "\n").expect("writable");
    let (_, again) = sweep(&["--resume"]);
    assert_eq!(again.lines().count(), runs.lines().count());
    assert!(again.contains("\"iterations\":77"));
    let name = |line: &str| line.split('"').nth(3).map(str::to_string);
    assert_eq!(again.lines().last().and_then(name), name(&removed));
}

#[test]
fn the_help_names_every_regime() {
    let output = run(hypercircle(std::path::Path::new("."), ["stability", "--help"]));
    let text = String::from_utf8(output.stdout).expect("UTF-8").split_whitespace().collect::<Vec<_>>().join(" ");
    for regime in REGIMES.iter().copied().flatten() {
        assert!(text.contains(&format!(" {}", regime.id)), "{}", regime.id);
    }
}
