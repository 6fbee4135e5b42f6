//! `--proof`: what lets a reader verify the bracket travels with the report.

use super::options::ProofOptions;
use super::session::Session;
use super::{CliError, Exit};
use crate::compare::Comparison;
use crate::problem::Note;
use crate::proof::{Fields, proof, unknown};
use crate::report::Dossier;
use crate::study::Certified;

impl ProofOptions {
    /// Refuses a scene that the checker could not verify, before it is solved.
    ///
    /// # Errors
    /// The scene has something that the checker does not know.
    pub(super) fn refuse_early(&self, session: &Session) -> Result<(), CliError> {
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
    pub(super) fn prove(
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
        let fields = Fields {
            stress: (&sharpest.problem, &sharpest.dual),
            displacement: (of, &upper.displacement),
            claim: [energy.lower, energy.upper],
            upper_from: from,
        };
        match proof(&fields) {
            Ok(bytes) => dossier.proof = Some(bytes),
            Err(error) => self.without_proof(dossier, &error.to_string()),
        }
    }

    fn without_proof(&self, dossier: &mut Dossier<'_>, why: &str) {
        let text = format!("No proof travels with this report: {why}.");
        self.progress.remark(&text);
        dossier.report.notes.push(Note { weakens_guarantee: false, text });
    }
}
