//! The end of a solving command: from results to files, a verdict and an exit code.

use std::path::Path;

use super::session::{DualRun, Session};
use super::words::{ci, say};
use super::{CliError, Exit};
use crate::cause::{outcome, told};
use crate::compare::Comparison;
use crate::compare::name::{Name, OfSolutionContact};
use crate::diagnose::{Diagnosis, Finding};
use crate::mesh::touching;
use crate::problem::{Note, Problem};
use crate::report::{self, BaselineRow, Dossier, Report, Status};
use crate::study::{Answer, Certified, Fields, Findings, Sharpened, assemble};

/// Parts of a report that a command adds to the dual run and its comparison.
#[derive(Default)]
pub struct Particulars {
    /// A sharper bracket, where that of the run could not tell two models apart.
    pub sharpened: Option<Sharpened>,
    /// The guaranteed relative error that can, where models are compared.
    pub enough: Option<f64>,
    /// The intervals of the quantities.
    pub answers: Vec<Answer>,
    /// Remarks of its own.
    pub notes: Vec<Note>,
    /// Its phases.
    pub seconds: Vec<(&'static str, f64)>,
    /// Other programs and files that took part, with versions or checksums.
    pub components: Vec<(String, String)>,
    /// Explanations why a field is not the discrete solution it claims to be.
    pub diagnosis: Vec<Diagnosis>,
    /// Its residual, triangle by triangle, where a field is handed in as the discrete solution of its mesh.
    pub residual: Option<Vec<f64>>,
    /// Why the displacement model gave no answer.
    pub failure: Option<String>,
    /// Its numbers beside those of the baseline.
    pub baseline: Vec<BaselineRow>,
    /// True if a proof of the bracket is to travel with the report.
    pub is_to_prove: bool,
}

impl Session {
    /// Assembles the dossier of a run with its comparison, writes the files and says the verdict.
    ///
    /// # Errors
    /// The files cannot be written.
    pub fn conclude(
        &self,
        run: &DualRun,
        comparison: &Comparison,
        particulars: Particulars,
        folder: &Path,
    ) -> Result<Exit, CliError> {
        self.with_dossier(run, comparison, particulars, |mut dossier| {
            self.sign(&mut dossier);
            self.close(&dossier, &run.certified.problem, folder)
        })
    }

    /// Applies `of` to the dossier of a run with its comparison.
    pub fn with_dossier<T>(
        &self,
        run: &DualRun,
        comparison: &Comparison,
        particulars: Particulars,
        of: impl FnOnce(Dossier<'_>) -> T,
    ) -> T {
        let certified = &run.certified;
        let mut history = run.history.clone();
        let Particulars {
            sharpened,
            enough,
            answers,
            mut notes,
            mut seconds,
            components,
            diagnosis,
            residual,
            failure,
            baseline,
            is_to_prove,
        } = particulars;
        let is_claimed = residual.is_some();
        let finer = sharpened.map(|Sharpened { certified, history: meshes, stopped }| {
            notes.push(sharpened_note(&certified, stopped));
            history.extend(meshes);
            certified
        });
        seconds.push(("total", self.start.elapsed().as_secs_f64()));
        let stopped = run.stopped.clone().map(|text| Note { weakens_guarantee: false, text });
        let fields = Fields::new(certified, comparison, &answers).with_residual(residual);
        let mut dossier = assemble(
            Findings {
                command: self.command,
                certified,
                comparison,
                answers: &answers,
                finer: finer.as_ref(),
                enough,
                history,
                notes: stopped.into_iter().chain(notes).collect(),
                threads: self.threads,
                seconds,
                components,
                diagnosis,
                is_claimed,
                failure,
                advice: run.advice,
                other_end: run.other_end.as_ref(),
                coulomb: run.coulomb.as_ref(),
            },
            &fields,
        );
        dossier.report.baseline = baseline;
        if is_to_prove {
            self.prove(&mut dossier, certified, finer.as_ref(), comparison);
        }
        of(dossier)
    }

    /// Gives the report the identifier of this run, where one was given.
    pub(super) fn sign(&self, dossier: &mut Dossier<'_>) {
        dossier.report.provenance.command_line = command_line();
        if let Some(run) = &self.run {
            dossier.report.run.clone_from(run);
        }
    }

    fn close(&self, dossier: &Dossier<'_>, problem: &Problem, folder: &Path) -> Result<Exit, CliError> {
        self.progress.phase("writing the report");
        let replaced = report_of_another_command(folder, self.command);
        report::write(dossier, folder)?;
        ci::report(&dossier.report, &self.scene.path);
        if !self.quiet {
            lines(&dossier.report).iter().for_each(|line| say::line(line));
            let Problem { mesh, scene, .. } = problem;
            touching(mesh, scene).iter().for_each(|line| say::line(&format!("  note: {}", line.told(mesh, scene))));
            say::line(&format!("report: {}", folder.join("report.html").display()));
            if let Some(other) = replaced {
                say::line(&format!("  in place of the report of `{other}` that was there; --out DIR keeps both"));
            }
        }
        Ok(match dossier.report.status {
            Status::Agree => Exit::Agree,
            Status::Disagree | Status::Undecided => Exit::Disagree,
            Status::Infeasible => Exit::NoEquilibrium,
            Status::Failed => Exit::Failed,
        })
    }
}

/// The report in short words: the verdict, the quantities, and what failed with its causes.
pub fn lines(report: &Report) -> Vec<String> {
    let mut lines = vec![report.verdict.clone()];
    for quantity in &report.quantities {
        lines.push(format!("  {}", quantity.in_words(report.firmness())));
    }
    for cause in &report.causes {
        // The verdict begins with the first.
        let is_told = report.verdict.starts_with(&cause.sentence);
        let sentence = if is_told { String::new() } else { format!("{} ", cause.sentence) };
        lines.push(format!("  {sentence}{} {}", cause.suggests, cause.remedy));
        for check in report.checks.iter().filter(|check| cause.checks.contains(&check.name)) {
            lines.push(format!("    {}: {}: {}", outcome(check), check.name, told(check)));
        }
    }
    let is_told = |diagnosis: &&Diagnosis| {
        let told = |finding: &Finding| report.verdict.contains(&finding.sentence);
        !diagnosis.findings.is_empty() && diagnosis.findings.iter().all(told)
    };
    for diagnosis in report.diagnosis.iter().filter(|diagnosis| !is_told(diagnosis)) {
        lines.push(format!("  {}: {}", diagnosis.field, diagnosis.sentence));
    }
    for remark in report.remarks.iter().filter(|c| !c.passed) {
        // What a method does by design is said on the spot.
        let by_design =
            matches!(Name::read(&remark.name), Name::SolutionContact(OfSolutionContact::PenetrationAtNodes, _))
                && !remark.why.is_empty();
        let why = if by_design { remark.why.clone() } else { told(remark) };
        lines.push(format!("  worth a look: {}: {why}", remark.name));
    }
    lines
}

/// The command whose report lies in `folder`, where it is not `command`.
fn report_of_another_command(folder: &Path, command: &str) -> Option<String> {
    let text = std::fs::read(folder.join("report.json")).ok()?;
    let report: serde_json::Value = serde_json::from_slice(&text).ok()?;
    report["command"].as_str().filter(|other| *other != command).map(str::to_owned)
}

/// The command of this process, with quotes around what a shell would take apart.
fn command_line() -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=:,+@%".contains(c);
    let quoted = |word: String| match word.is_empty() || !word.chars().all(plain) {
        true => format!("'{}'", word.replace('\'', r"'\''")),
        false => word,
    };
    let words = super::arguments().map(|word| quoted(word.to_string_lossy().into_owned()));
    std::iter::once("hypercircle".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}

/// How the sharper bracket came about.
fn sharpened_note(finer: &Certified, stopped: Option<String>) -> Note {
    let triangles = finer.problem.mesh.triangles.len();
    let how = format!(
        "The bracket of the mesh as given could not tell two models apart. The stress side alone was refined to {triangles} \
         triangles; the energy bounds and the intervals of quantities are from there, contacts and stresses are compared on the \
         mesh as given."
    );
    Note { weakens_guarantee: false, text: stopped.map_or(how.clone(), |reason| format!("{how} {reason}")) }
}
