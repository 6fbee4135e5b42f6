//! From results to the data behind the report.

pub(super) mod maps;
pub(super) mod provenance;
pub(super) mod verdict;

use super::Certified;
use super::answers::Answer;
use super::coulomb::{Coulomb, in_verdict};
use super::curves;
use super::quantity_checks::summaries;
use super::ranges::{OtherEnd, data_range, in_words, ranges_note};
use crate::bounds::{Bracket, UpperBound};
use crate::cause::causes;
use crate::compare::Comparison;
use crate::diagnose::Diagnosis;
use crate::dual::Motion;
use crate::element::Displacement;
use crate::problem::{Note, Problem, follows_coulomb};
use crate::report::{
    Dossier, DualSummary, Energy, Given, Guarantee, GuaranteeLevel, HistoryRow, PrimalSummary, Report, SCHEMA_VERSION,
    Status,
};
use maps::Fields;
use provenance::{identifier, provenance};
use verdict::verdict;

/// The findings of a run.
#[derive(Debug)]
pub struct Findings<'a> {
    /// `verify`, `solve` or `certify`.
    pub command: &'a str,
    /// The dual side.
    pub certified: &'a Certified,
    /// The comparison; without displacement models it still holds the checks of the bracket.
    pub comparison: &'a Comparison,
    /// The intervals of the quantities of the scene.
    pub answers: &'a [Answer],
    /// A sharper bracket from a finer mesh, where the one of `certified` could not tell two models apart.
    pub finer: Option<&'a Certified>,
    /// The guaranteed relative error that tells two models apart; `None` where no model has to be told from another.
    pub enough: Option<f64>,
    /// Adaptive refinement, mesh by mesh.
    pub history: Vec<HistoryRow>,
    /// Remarks of the run itself.
    pub notes: Vec<Note>,
    /// Threads used.
    pub threads: usize,
    /// Seconds by phase of the whole run.
    pub seconds: Vec<(&'static str, f64)>,
    /// Versions of programs that took part.
    pub components: Vec<(String, String)>,
    /// Explanations why a field is not the discrete solution it claims to be.
    pub diagnosis: Vec<Diagnosis>,
    /// True if a field is handed in as the discrete solution of its mesh.
    pub is_claimed: bool,
    /// Why the displacement side is missing, where it should be there.
    pub failure: Option<String>,
    /// Advice where refinement ended before its tolerance.
    pub advice: Option<&'static str>,
    /// The scene of the other ends of ranges of the data, solved.
    pub other_end: Option<&'a OtherEnd>,
    /// How the bound of Coulomb friction was found.
    pub coulomb: Option<&'a Coulomb>,
}

/// Puts the report and its fields together.
pub fn assemble<'a>(findings: Findings<'a>, fields: &'a Fields) -> Dossier<'a> {
    let Certified { problem, dual, .. } = findings.certified;
    let report = report(&findings);
    let mut displacements: Vec<(String, &Displacement)> = Vec::new();
    if let Ok(free) = &findings.certified.bracket.free {
        displacements.push(("free upper bound".to_string(), &free.displacement));
    }
    for judged in &findings.comparison.judged {
        displacements.push((judged.candidate.name.clone(), &judged.field.displacement));
    }
    let mesh = &problem.mesh;
    let candidates = findings.comparison.judged.iter().map(|judged| &judged.candidate);
    let fitting = candidates.filter(|own| {
        let at_nodes = own.higher.is_none() || own.on_quadrilaterals.is_some();
        at_nodes && [own.vertex.len(), own.middle.len()] == [mesh.points.len(), mesh.edges.len()]
    });
    let given = fitting.map(|own| {
        let middle = if own.degree == 2 { own.middle.as_slice() } else { &[] };
        Given {
            name: own.name.clone(),
            on_quadrilaterals: own.on_quadrilaterals.is_some(),
            values: [own.vertex.as_slice(), middle].concat(),
        }
    });
    Dossier {
        report,
        problem,
        dual: Some(dual),
        displacements,
        given: given.collect(),
        mid: fields.mid.as_ref(),
        stresses: fields.stresses.iter().map(|(name, stress)| (name.clone(), stress)).collect(),
        maps: fields.maps.clone(),
        motion: None,
        proof: None,
    }
}

fn report(findings: &Findings<'_>) -> Report {
    let Certified { problem, statics, dual, bracket } = findings.certified;
    let comparison = findings.comparison;
    let mut notes = problem.notes.clone();
    let remark = |text: &String| Note { weakens_guarantee: false, text: text.clone() };
    notes.extend(statics.notes.iter().map(remark));
    notes.extend(dual.notes.iter().map(remark));
    notes.extend(findings.notes.iter().cloned());
    // A finer mesh for the sake of the verdict keeps the edges.
    let followed = if findings.finer.is_none() { findings.history.as_slice() } else { &[] };
    notes.extend(curves::remarks(findings.certified, followed));
    let sharpest = findings.finer.map_or(bracket, |finer| &finer.bracket);
    let energy = comparison
        .upper(sharpest)
        .map(|(upper, from)| energy(problem, sharpest, bracket, upper, from, Guarantee::of_notes(&notes)));
    let blunt = |enough: f64| !energy.as_ref().is_some_and(|energy| sharpest.tells(energy.upper, enough));
    let status = match (&findings.failure, comparison.agrees()) {
        (Some(_), _) => Status::Failed,
        (None, false) => Status::Disagree,
        (None, true) if findings.enough.is_some_and(blunt) => Status::Undecided,
        (None, true) if findings.coulomb.is_some_and(Coulomb::has_several) => Status::Undecided,
        (None, true) => Status::Agree,
    };
    let coulomb = findings.coulomb.map(|coulomb| coulomb.summary(energy.as_ref()));
    let mut contact = comparison.contacts.clone();
    findings.coulomb.iter().for_each(|coulomb| coulomb.complete(&mut contact));
    let across = findings.other_end.map(|end| data_range(problem, sharpest, end));
    notes.extend(across.as_ref().map(ranges_note));
    let causes = causes(problem, comparison, &findings.diagnosis, findings.advice);
    let (checks, remarks) = comparison.checks.iter().cloned().partition(|check| check.decides());
    let mut provenance = provenance(problem, findings.threads);
    provenance.components.extend(findings.components.iter().cloned());
    provenance.seconds.extend(findings.seconds.iter().map(|(k, v)| (k.to_string(), *v)));
    Report {
        schema_version: SCHEMA_VERSION,
        scene: problem.scene.name.clone(),
        title: problem.scene.title.clone(),
        command: findings.command.to_string(),
        run: identifier(),
        status,
        verdict: verdict(findings, status, energy.as_ref(), &causes)
            + &across.as_ref().map_or_else(String::new, in_words)
            + &coulomb.as_ref().map_or_else(String::new, in_verdict),
        causes,
        energy,
        data_range: across,
        coulomb,
        dual: Some(DualSummary {
            method: dual.method.to_string(),
            degree_min: (0..dual.stress.len()).map(|t| dual.stress.degree(t)).min().unwrap_or(0),
            degree_max: dual.stress.largest_degree(),
            triangles: problem.mesh.triangles.len(),
            unknowns: dual.unknowns,
            iterations: dual.iterations,
            equilibrium_residual: dual.equilibrium.residual(),
            seconds: dual.seconds,
        }),
        primal: comparison
            .judged
            .iter()
            .map(|j| PrimalSummary {
                name: j.candidate.name.clone(),
                solver: j.candidate.solver.clone(),
                version: j.candidate.version.clone(),
                degree: j.candidate.degree,
                cells: if j.candidate.on_quadrilaterals.is_some() { "quadrilaterals" } else { "triangles" }.to_string(),
                energy: j.candidate.reported.unwrap_or(j.own.total()),
                admissible: j.is_admissible(),
                relative_error_bound: j.candidate.is_polynomial().then(|| j.relative_error(sharpest)),
                iterations: j.candidate.iterations,
                unknowns: j.candidate.unknowns,
                seconds: j.candidate.seconds.clone(),
            })
            .collect(),
        contact,
        stress: comparison.stress.clone(),
        quantities: summaries(findings.certified, findings.answers, comparison),
        checks,
        remarks,
        diagnosis: findings.diagnosis.clone(),
        notes,
        baseline: Vec::new(),
        history: findings.history.clone(),
        provenance,
    }
}

/// The bracket of `sharpest`, which is that of the mesh of the comparison, `own`, or one of a finer mesh.
fn energy(
    problem: &Problem,
    sharpest: &Bracket,
    own: &Bracket,
    upper: &UpperBound,
    from: &str,
    guarantee: Guarantee,
) -> Energy {
    let guaranteed = guarantee.level == GuaranteeLevel::Guaranteed;
    let free = sharpest.free.as_ref().ok();
    let gap = upper.upper() - sharpest.lower();
    // The constitutive error of a displacement is known against the stress of its own mesh.
    let same_mesh = std::ptr::eq(sharpest, own) || free.is_some_and(|free| std::ptr::eq(free, upper));
    let mid_error = if same_mesh { upper.mid_error(gap) } else { gap.max(0.0).sqrt() };
    let energy = sharpest.complementary.strain;
    Energy {
        lower: sharpest.lower(),
        upper: upper.upper(),
        gap,
        relative_error_bound: in_numbers(sharpest.relative_error(upper.upper())),
        upper_from: from.to_string(),
        free_upper: free.map(UpperBound::upper),
        gap_local: free.map(|f| f.local.total),
        complementary: energy,
        widening: sharpest.lower_widening + upper.widening,
        mid_error_bound: match sharpest.relative_error(upper.upper()) {
            0.0 => 0.0,
            _ => in_numbers(mid_error / (2.0 * energy).sqrt()),
        },
        enclosed_work: enclosed_work(upper, sharpest),
        compliance: problem.only_loads_work().then(|| enclosed_work(upper, sharpest)),
        guaranteed,
        guarantee,
        guaranteed_for: if follows_coulomb(&problem.scene) { "friction bound" } else { "scene" }.to_string(),
        friction_work: problem.has_friction().then_some(upper.potential.friction),
    }
}

/// A relative error for a report: a stress field that is zero, where the bracket leaves an energy open, misses all of it.
pub(in crate::study) fn in_numbers(relative_error: f64) -> f64 {
    if relative_error.is_infinite() { 1.0 } else { relative_error }
}

/// −2𝓛(u), enclosed.
fn enclosed_work(upper: &UpperBound, bracket: &Bracket) -> [f64; 2] {
    // Zero minus the number: never a negative zero.
    [0.0 - 2.0 * upper.upper(), 0.0 - 2.0 * bracket.lower()]
}

/// The report on a scene without equilibrium.
pub fn infeasible<'a>(
    command: &str,
    problem: &'a Problem,
    sentence: &str,
    motion: Motion,
    threads: usize,
) -> Dossier<'a> {
    Dossier {
        report: Report {
            schema_version: SCHEMA_VERSION,
            scene: problem.scene.name.clone(),
            title: problem.scene.title.clone(),
            command: command.to_string(),
            run: identifier(),
            status: Status::Infeasible,
            verdict: sentence.to_string(),
            causes: Vec::new(),
            energy: None,
            data_range: None,
            coulomb: None,
            dual: None,
            primal: Vec::new(),
            contact: Vec::new(),
            stress: None,
            quantities: Vec::new(),
            checks: Vec::new(),
            remarks: Vec::new(),
            diagnosis: Vec::new(),
            notes: problem.notes.clone(),
            baseline: Vec::new(),
            history: Vec::new(),
            provenance: provenance(problem, threads),
        },
        problem,
        dual: None,
        displacements: Vec::new(),
        given: Vec::new(),
        mid: None,
        stresses: Vec::new(),
        maps: Vec::new(),
        motion: Some(motion),
        proof: None,
    }
}
