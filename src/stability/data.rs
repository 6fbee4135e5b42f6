//! Contents of a stability matrix.

use serde::{Deserialize, Serialize};

use crate::measure::{Answer, Machine, Method};
use crate::study::Adapt;

/// The methods that promise a range in which they are correct.
pub const PROMISING: [Method; 3] = [Method::CONDENSED, Method::Adaptive(Adapt::H), Method::Adaptive(Adapt::Hp)];

/// Everything in `stability.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// Version of this layout.
    pub schema_version: u32,
    /// Where it was made.
    pub machine: Machine,
    /// True if only a part of the values was swept.
    pub reduced: bool,
    /// The command that makes it again.
    #[serde(default)]
    pub command: String,
    /// The regimes.
    pub rows: Vec<Row>,
}

/// One regime.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name on the command line and in links.
    pub id: String,
    /// A short description.
    pub title: String,
    /// The parameter that is swept.
    pub parameter: String,
    /// The values as a reader sees them, in the order of the sweep.
    pub values: Vec<String>,
    /// So many of the first values have to be correct for the methods of [`PROMISING`].
    #[serde(default)]
    pub promised: usize,
    /// How the truth is known.
    pub truth: String,
    /// Where such a failure was reported.
    pub reported: String,
    /// One cell a method.
    pub cells: Vec<Cell>,
}

/// One method in one regime.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The method.
    pub method: Method,
    /// The displacement solver that was run in the place of FEniCSx.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<String>,
    /// The worst outcome.
    pub worst: Outcome,
    /// The outcome at each value.
    pub steps: Vec<Step>,
}

/// One method at one value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// How it went.
    pub outcome: Outcome,
    /// Why, in words.
    pub why: String,
    /// Relative error of the energy that is known from outside, where it is.
    pub error: Option<f64>,
    /// Relative error that the method guarantees.
    pub bound: Option<f64>,
    /// The numbers.
    pub answer: Option<Answer>,
}

impl Step {
    /// Of a value at which a method is not run.
    pub fn left_out() -> Step {
        let why = "left out of a reduced matrix".to_string();
        Step { outcome: Outcome::NotApplicable, why, error: None, bound: None, answer: None }
    }
}

/// How a run went, better before worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The method has nothing to do with the question, or is left out of this row of a reduced matrix.
    NotApplicable,
    /// Bounds ordered, the truth inside, resultants exact.
    Correct,
    /// The numbers are poor, and the method's own bound or residual says so or they are within a quarter of an answer.
    Inaccurate,
    /// No answer, with a reason.
    Refused,
    /// No answer in the iterations or the time allowed.
    NoConvergence,
    /// The process died.
    Crash,
    /// Numbers that are not true, and nothing that says so.
    Wrong,
}

impl Outcome {
    /// For tables.
    pub fn words(self) -> &'static str {
        match self {
            Outcome::NotApplicable => "not applicable",
            Outcome::Correct => "correct",
            Outcome::Inaccurate => "inaccurate",
            Outcome::Refused => "refused with a reason",
            Outcome::NoConvergence => "no convergence",
            Outcome::Crash => "crash",
            Outcome::Wrong => "wrong without saying so",
        }
    }

    /// A sign that needs no colour.
    pub fn sign(self) -> &'static str {
        match self {
            Outcome::NotApplicable => "·",
            Outcome::Correct => "✓",
            Outcome::Inaccurate => "≈",
            Outcome::Refused => "⊘",
            Outcome::NoConvergence => "∞",
            Outcome::Crash => "✕",
            Outcome::Wrong => "‼",
        }
    }
}

impl Cell {
    /// Its name: the method, or the solver in the place of FEniCSx with its degree.
    pub fn name(&self) -> String {
        self.method.name_with(self.solver.as_deref())
    }

    /// The last value before the first that is not correct; `None` where the first is not.
    pub fn correct_to(&self) -> Option<usize> {
        let good = self.steps.iter().take_while(|s| s.outcome <= Outcome::Correct).count();
        self.steps[..good].iter().rposition(|s| s.outcome == Outcome::Correct)
    }

    /// The first value with the worst outcome.
    pub fn worst_at(&self) -> Option<usize> {
        self.steps.iter().position(|s| s.outcome == self.worst)
    }
}

impl Matrix {
    /// Cells of this program's own methods, and of a solver handed in, that are wrong without saying so or crashed: none, if
    /// all is well.
    pub fn defects(&self) -> Vec<(&Row, &Cell)> {
        let mut found = Vec::new();
        for row in &self.rows {
            let on_trial = |c: &Cell| c.method.has_bracket() || c.solver.is_some();
            let bad = |c: &&Cell| on_trial(c) && matches!(c.worst, Outcome::Wrong | Outcome::Crash);
            found.extend(row.cells.iter().filter(bad).map(|c| (row, c)));
        }
        found
    }

    /// Steps that are not correct although they are promised to be: none, if all is well.
    pub fn shortfalls(&self) -> Vec<(&Row, &Cell, usize)> {
        let mut found = Vec::new();
        for row in &self.rows {
            for cell in row.cells.iter().filter(|c| PROMISING.contains(&c.method)) {
                let missed =
                    (0..row.promised).filter(|&i| cell.steps.get(i).is_none_or(|s| s.outcome != Outcome::Correct));
                found.extend(missed.map(|i| (row, cell, i)));
            }
        }
        found
    }
}
