//! `--proof`: what lets a reader verify the bracket travels with the report.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use super::options::ProofOptions;
use crate::cli::session::Session;
use crate::cli::{CliError, Exit};
use crate::compare::Comparison;
use crate::dual::Options;
use crate::problem::Note;
use crate::process::{Outcome, Scratch, python, supervise};
use crate::proof::{self, Fields, NAME, proof, unknown};
use crate::report::{Dossier, Guarantee};
use crate::study::{Adjoint, Certified, adjoint};

/// The program that verifies proofs.
const CHECKER: &str = "hypercircle-check";
/// How long it may take.
const LIMIT: Duration = Duration::from_secs(600);

/// Runs the checker on a proof. Returns its name and version, or the cause of failure; `None` where it is not installed.
fn checked(proof: &[u8], begins: impl FnOnce()) -> Option<Result<String, String>> {
    let program = python::find(Path::new(CHECKER))?;
    begins();
    let run = || -> std::io::Result<Result<String, String>> {
        let scratch = Scratch::new()?;
        let file = scratch.path().join(NAME);
        std::fs::write(&file, proof)?;
        let ended = supervise(Command::new(program).arg(&file).env("TMPDIR", scratch.path()), LIMIT)?;
        let text = ended.text();
        let after = |start: &str| text.lines().find_map(|line| line.trim().strip_prefix(start).map(str::to_string));
        Ok(match ended.outcome {
            Outcome::Exit(status) if status.success() => Ok(after("by ").unwrap_or_else(|| CHECKER.to_string())),
            Outcome::TimedOut => Err("it took too long".to_string()),
            _ => Err(after("not proved: ").unwrap_or(text).trim_end_matches('.').to_string()),
        })
    };
    Some(run().unwrap_or_else(|error| Err(error.to_string())))
}

impl ProofOptions {
    /// Refuses a scene that the checker could not verify, before it is solved.
    ///
    /// # Errors
    /// The scene has something that the checker does not know.
    pub(in crate::cli) fn refuse_early(&self, session: &Session) -> Result<(), CliError> {
        let path = &session.scene.path;
        let text = if self.proof { std::fs::read_to_string(path).unwrap_or_default() } else { return Ok(()) };
        let Some(what) = unknown(&text) else { return Ok(()) };
        let message =
            format!("{}: a scene with {what} has no proof: hypercircle-check does not know it", path.display());
        Err(CliError::stopped(Exit::BadInput, message, "leave out --proof"))
    }
}

impl Session {
    /// Gives the dossier its proof, or a note that says why there is none.
    pub(in crate::cli) fn prove(
        &self,
        dossier: &mut Dossier<'_>,
        certified: &Certified,
        finer: Option<&Certified>,
        comparison: &Comparison,
    ) {
        self.progress.phase("writing the proof");
        let sharpest = finer.unwrap_or(certified);
        let upper = comparison.upper(&sharpest.bracket);
        let energy = dossier.report.energy.as_ref();
        let (Some((upper, from)), Some(energy)) = (upper, energy) else {
            return self.without_proof(dossier, "there is no upper bound");
        };
        // The free displacement belongs to the mesh of the bracket, others to the mesh as given.
        let of = if from == "free" { &sharpest.problem } else { &certified.problem };
        let options = Options { threads: self.threads, ..Options::default() };
        let solved: Vec<_> = match from {
            "free" => sharpest
                .problem
                .scene
                .quantities
                .iter()
                .filter_map(|quantity| {
                    let row = dossier.report.quantities.iter().find(|row| row.name == quantity.name)?;
                    let claim = [row.lower, row.upper];
                    claim.iter().all(|end| end.is_finite()).then_some(())?;
                    Some((&quantity.name, claim, adjoint(sharpest, quantity, &options)?))
                })
                .collect(),
            _ => Vec::new(),
        };
        let adjoints: Vec<_> = solved
            .iter()
            .filter_map(|(name, claim, Adjoint { certified, step })| {
                let displacement = &certified.bracket.free.as_ref().ok()?.displacement;
                Some(proof::Adjoint {
                    name,
                    claim: *claim,
                    step: *step,
                    problem: &certified.problem,
                    dual: &certified.dual,
                    displacement,
                })
            })
            .collect();
        let fields = Fields {
            stress: (&sharpest.problem, &sharpest.dual),
            displacement: (of, &upper.displacement),
            claim: [energy.lower, energy.upper],
            upper_from: from,
            adjoints: &adjoints,
        };
        match proof(&fields) {
            Ok(bytes) => {
                self.have_checked(dossier, &bytes);
                dossier.proof = Some(bytes);
            }
            Err(error) => self.without_proof(dossier, &error.to_string()),
        }
    }

    /// Runs the checker where it is installed, and tells in the report what it found.
    fn have_checked(&self, dossier: &mut Dossier<'_>, proof: &[u8]) {
        let Some(energy) = dossier.report.energy.as_mut() else { return };
        let guarantee = energy.guarantee.clone();
        energy.guarantee = match checked(proof, || self.progress.phase("verifying the proof")) {
            Some(Ok(checker)) => guarantee.proved_by(&checker),
            Some(Err(why)) => {
                self.progress.warn(&format!("{CHECKER} did not verify the proof: {why}"));
                Guarantee { words: format!("{}, but not proved: {why}", guarantee.words), ..guarantee }
            }
            None => {
                let words =
                    format!("{}; {CHECKER}, which is not installed here, can verify proof.npz", guarantee.words);
                Guarantee { words, ..guarantee }
            }
        };
    }

    fn without_proof(&self, dossier: &mut Dossier<'_>, why: &str) {
        let text = format!("No proof travels with this report: {why}.");
        self.progress.warn(&text);
        dossier.report.notes.push(Note { weakens_guarantee: false, text });
    }
}
