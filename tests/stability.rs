//! `hypercircle stability`: cells say what happened, planted lies are found, and the program's own methods hold.

use std::process::Command;

use hypercircle::measure::{Answer, End, Ended, Measured, Method, Seconds};
use hypercircle::stability::{Claim, Known, Outcome, Truth, judge};

/// An answer that is right: the exact energy −1 inside, the force exact.
fn good() -> Answer {
    Answer {
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
    let step = judge(method, ended, &Claim { known, truth, first: Some(&first), flat: Some(3.0) });
    (step.outcome, step.why)
}

fn outcome(answer: Answer) -> Outcome {
    outcome_of(Method::Condensed, &known(), &told(Method::Condensed, End::Solved, Some(answer))).0
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
    let ended = told(Method::FenicsP1, End::Solved, Some(locked));
    assert_eq!(outcome_of(Method::FenicsP1, &known(), &ended).0, Outcome::Wrong);
}

#[test]
fn pressure_that_goes_up_and_down_is_inaccurate() {
    assert_eq!(outcome(Answer { variation: vec![1.5], ..good() }), Outcome::Inaccurate);
}

#[test]
fn numbers_without_an_equilibrium_are_wrong_and_a_refusal_is_right() {
    let none = Known::none();
    let solved = told(Method::Condensed, End::Solved, Some(good()));
    assert_eq!(outcome_of(Method::Condensed, &none, &solved).0, Outcome::Wrong);
    let denied = told(Method::Condensed, End::NoEquilibrium("it slides".to_string()), None);
    assert_eq!(outcome_of(Method::Condensed, &none, &denied).0, Outcome::Correct);
    assert_eq!(outcome_of(Method::Condensed, &known(), &denied).0, Outcome::Wrong);
}

#[test]
fn every_other_end_has_its_word() {
    let of = |ended: &Ended| outcome_of(Method::Uzawa, &known(), ended).0;
    let end = |end: End| of(&told(Method::Uzawa, end, None));
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
        let ended = told(Method::Condensed, End::Solved, Some(answer));
        judge(Method::Condensed, &ended, &Claim { known: &scaled, truth, first: Some(&first), flat: None }).outcome
    };
    assert_eq!(of(answer.clone()), Outcome::Correct);
    assert_eq!(of(Answer { lower: Some(-4.004 * (1.0 + 1e-11)), ..answer }), Outcome::Inaccurate);
}

/// The parameter of the hardest value that must still be correct, for the methods that the guarantee rests on.
#[test]
fn the_own_methods_hold_where_they_promise_to() {
    let folder = tempfile::tempdir().expect("a folder");
    let promised = [
        "poisson",
        "poisson-exact",
        "stiffness",
        "stiffness-exact",
        "slivers",
        "slivers-exact",
        "scale-length",
        "scale-force",
    ];
    let mut command = Command::new(env!("CARGO_BIN_EXE_hypercircle"));
    command
        .args(["stability", "--reduced", "--method", "condensed", "--method", "adaptive", "--out"])
        .arg(folder.path());
    for id in promised {
        command.args(["--regime", id]);
    }
    let output = command.output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.path().join("stability.json")).expect("written");
    let matrix: hypercircle::stability::Matrix = serde_json::from_str(&text).expect("readable");
    assert_eq!(matrix.rows.len(), promised.len());
    // Slivers under lift-off lose the sharpness of the bound, not the bound, between 1e4 and 1e5.
    let beyond = [("stiffness-exact", "1e12"), ("slivers", "1e5"), ("slivers-exact", "1e6")];
    for row in &matrix.rows {
        for cell in &row.cells {
            for (value, step) in row.values.iter().zip(&cell.steps) {
                if !beyond.contains(&(row.id.as_str(), value.as_str())) {
                    let place = format!("{} in {} at {value}", cell.method.name(), row.id);
                    assert_eq!(step.outcome, Outcome::Correct, "{place}: {}", step.why);
                }
            }
        }
    }
    for name in ["stability.html", "stability.md", "figures/stability-poisson.svg"] {
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}
