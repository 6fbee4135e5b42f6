//! The made-up numbers of [`super::sample`].

use std::collections::BTreeMap;

use super::sample::{SECONDS, Verdict, contact_pressure};
use super::*;
use crate::compare::{Basis, Check, MeanPressure};
use crate::problem::Problem;

/// A report that agrees with `verdict`: two of four checks fail where it is to disagree.
pub(super) fn report(problem: &Problem, verdict: Verdict) -> Report {
    let failed = verdict == Verdict::Disagree;
    let (lower, upper) = (-1.7972865675, -1.79391);
    let p2 = if failed { -1.8109 } else { -1.7958503770 };
    let complementary = 1.7972865675;
    let energy = Energy {
        lower,
        upper,
        gap: upper - lower,
        relative_error_bound: ((upper - lower) / complementary).sqrt(),
        upper_from: "free".into(),
        free_upper: Some(upper),
        gap_local: Some(upper - lower),
        complementary,
        widening: 3e-14,
        mid_error_bound: 0.5 * ((upper - lower) / complementary).sqrt(),
        enclosed_work: [-2.0 * upper, -2.0 * lower],
        compliance: Some([-2.0 * upper, -2.0 * lower]),
        guaranteed: true,
        guarantee: Guarantee::of_notes(&[]),
        guaranteed_for: "scene".to_string(),
        friction_work: None,
    };
    let primal = |name: &str, degree, energy: f64| PrimalSummary {
        name: name.into(),
        solver: "FEniCSx".into(),
        version: "0.5.2".into(),
        degree,
        cells: "triangles".into(),
        energy,
        admissible: true,
        relative_error_bound: (energy > lower).then(|| ((energy - lower) / complementary).sqrt()),
        iterations: Some(4),
        unknowns: Some(1234 * degree),
        seconds: BTreeMap::from([("assemble".into(), 0.3), ("solve".into(), 0.5), ("total".into(), 0.9)]),
    };
    let verdict_text = match verdict {
        Verdict::Agree => "The two models agree within everything the theory allows.",
        Verdict::Disagree => "The two models disagree: 2 of 4 checks failed.",
        Verdict::Undecided => "No check failed, but the bracket is too wide to tell the two models apart.",
        Verdict::Infeasible => "No equilibrium: left <a&b> would fly off to the left.",
        Verdict::Failed => "The reference model stopped: SNES diverged.",
    };
    let solved = verdict != Verdict::Infeasible;
    Report {
        schema_version: 1,
        scene: problem.scene.name.clone(),
        title: problem.scene.title.clone(),
        command: "verify".into(),
        run: "0123456789abcdef".into(),
        status: verdict,
        verdict: verdict_text.into(),
        causes: if failed { causes() } else { Vec::new() },
        energy: solved.then_some(energy),
        data_range: None,
        coulomb: None,
        dual: solved.then(|| DualSummary {
            method: "condensed".into(),
            degree_min: 1,
            degree_max: 1,
            triangles: problem.mesh.triangles.len(),
            unknowns: 4 * problem.mesh.edges.len(),
            iterations: 3,
            equilibrium_residual: 3e-15,
            seconds: SECONDS,
        }),
        primal: vec![primal("FEniCSx P1", 1, -1.7321463913), primal("FEniCSx P2", 2, p2)],
        contact: vec![contact(failed)],
        stress: Some(StressSummary {
            against: "FEniCSx P2".into(),
            relative_energy_norm_difference: 0.0412,
            worst_triangle: 1,
            worst_at: [0.99, 0.61],
            worst_share: 0.083,
            von_mises_max: TwoSides { dual: 4.31, primal: Some(4.22) },
            component_l2_difference: ComponentDifference {
                xx: 0.011,
                yy: 0.008,
                tt: None,
                xy: 0.004,
                von_mises: 0.012,
            },
        }),
        quantities: if solved { quantities() } else { Vec::new() },
        checks: checks(failed, lower, p2),
        remarks: remarks(),
        diagnosis: Vec::new(),
        notes: problem.notes.clone(),
        baseline: Vec::new(),
        history: [(16, 1.1e-1), (120, 4.4e-2), (900, 1.3e-2), (5900, 4.1e-3)]
            .map(|(triangles, bound)| HistoryRow {
                triangles,
                unknowns: 6 * triangles,
                lower,
                upper,
                relative_error_bound: bound,
                seconds: 1e-5 * triangles as f64,
                step_seconds: 8e-6 * triangles as f64,
                rate: (triangles > 16).then_some(0.6),
            })
            .to_vec(),
        provenance: Provenance {
            version: "0.1.0".into(),
            components: BTreeMap::from([("dolfinx".into(), "0.5.2".into()), ("faer".into(), "0.24.4".into())]),
            scene_sha256: "0123456789abcdef".repeat(4),
            mesh_sha256: "fedcba9876543210".repeat(4),
            lock_sha256: "00ff".repeat(16),
            threads: 1,
            command_line: "hypercircle verify two_blocks.toml".into(),
            date: "2026-01-31".into(),
            seconds: BTreeMap::from([("dual".into(), 0.11), ("primal".into(), 1.9), ("total".into(), 2.1)]),
        },
    }
}

fn contact(failed: bool) -> ContactSummary {
    let steps: Vec<[f64; 2]> = (0..8)
        .flat_map(|k| [k, k + 1].map(|j| [f64::from(j) / 8.0, contact_pressure((f64::from(k) + 0.5) / 8.0)]))
        .collect();
    let factor = if failed { -0.6 } else { 1.0 };
    let smooth = (0..=16).map(|k| f64::from(k) / 16.0).map(|s| [s, factor * contact_pressure(s)]).collect();
    let trace = (0..=16)
        .map(|k| f64::from(k) / 16.0)
        .map(|s| [s, factor * contact_pressure(s) + 0.1 * (20.0 * s).sin()])
        .collect();
    let profile = |model: &str, points| Profile { model: model.into(), points };
    ContactSummary {
        name: "left_face|right_face".into(),
        resultant: TwoSides { dual: [-0.5, 0.0], primal: Some([-0.5 * factor, 0.0]) },
        moment: TwoSides { dual: 0.0833, primal: Some(0.0829) },
        pressure_max: TwoSides { dual: 2.01, primal: Some(1.97) },
        pressure_max_at: TwoSides { dual: [1.0, 0.0], primal: Some([1.0, 0.0]) },
        pressure_mean: Some(MeanPressure { value: 1.58, half_width: Some(0.21), at: [1.0, 0.0], radius: 0.156 }),
        open_fraction: 0.375,
        open_fraction_primal: Some(0.375),
        contact_ends: vec![0.5],
        pressure_l2_difference: Some(0.034),
        friction: None,
        length: 1.0,
        profiles: vec![
            profile("dual", steps),
            profile("FEniCSx P2 reactions", smooth),
            profile("FEniCSx P2 trace", trace),
        ],
    }
}

fn checks(failed: bool, lower: f64, p2: f64) -> Vec<Check> {
    let sign = if failed { -1.0 } else { 1.0 };
    vec![
        Check::at_most(
            "tolerance",
            0.0433,
            0.15,
            0.0,
            Basis::Asked,
            "The guaranteed error against what was asked for.",
        ),
        Check::at_most(
            "energy.order.P2",
            lower,
            p2,
            1e-9,
            Basis::Guaranteed,
            "An admissible displacement cannot have less energy than −Π(λ_h).",
        ),
        Check::equal(
            "contact.left_face|right_face.resultant <a&b>",
            -0.5,
            -0.5 * sign,
            1e-2,
            Basis::Guaranteed,
            "Both sides carry the same force.",
        ),
        Check::equal(
            "gap.local",
            0.0033765,
            0.0033765,
            1e-9,
            Basis::RoundOff,
            "The gap computed from energies and from local terms.",
        ),
    ]
}

/// The common cause of the two failing checks.
fn causes() -> Vec<Cause> {
    vec![Cause {
        name: "contact/left_face|right_face/in-part".to_string(),
        sentence: "In FEniCSx P2 contact left_face|right_face does not act at (1, 0) of <a&b>.".to_string(),
        place: Some(Place {
            at: [1.0, 0.0],
            vertex: Some(1),
            triangle: Some(0),
            body: "left <a&b>".to_string(),
            contact: Some("left_face|right_face".to_string()),
            boundary: None,
        }),
        suggests: "A row is missing.".to_string(),
        remedy: "Count the rows.".to_string(),
        checks: ["energy.order.P2", "contact.left_face|right_face.resultant <a&b>"].map(String::from).to_vec(),
    }]
}

/// One as usual, one that is worth a look.
fn remarks() -> Vec<Check> {
    let remark = |name: &str, value: f64| {
        Check::at_most(name, value, 0.0, 0.1, Basis::Chosen, "Theory sets no limit to this difference.")
    };
    vec![remark("sharpness", 0.04), remark("contact.left_face|right_face.open-length <a&b>", 0.3)]
}

/// Three quantities: one known, one with an end missing, one that statics determines.
fn quantities() -> Vec<QuantitySummary> {
    let model = |value: f64, inside: bool| QuantityOfModel {
        solver: "FEniCSx P2".to_string(),
        degree: 2,
        value: Some(value),
        reason: None,
        inside: Some(inside),
    };
    let row = |name: &str, kind: &str, lower: f64, value: f64, upper: f64| QuantitySummary {
        name: name.to_string(),
        kind: kind.to_string(),
        value,
        lower,
        upper,
        first_order: [lower - 0.1, upper + 0.1],
        exact_by_statics: lower == upper,
        rounding: 0.0,
        primal: vec![model(value, true)],
        reason: upper.is_infinite().then(|| "nothing holds <it>".to_string()),
    };
    vec![
        row("tip <a&b>", "displacement", 0.79, 0.801, 0.81),
        row("seat", "force", 0.2, 0.25, f64::INFINITY),
        row("whole", "force", 0.5, 0.5, 0.5),
    ]
}
