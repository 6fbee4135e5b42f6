//! Contradictions in the answers to one scene.

use serde_json::Value;

use super::run::{Ended, Way};

/// Something that is wrong.
pub struct Fault {
    /// The kind, without names of this scene.
    pub kind: String,
    /// The finding in words.
    pub text: String,
}

impl Fault {
    fn new(kind: impl Into<String>, text: impl Into<String>) -> Fault {
        Fault { kind: kind.into(), text: text.into() }
    }
}

/// Digits that energies of displacement models, which carry no allowance for rounding, may lack.
const ROUNDING: f64 = 1e-9;

/// Every fault in the runs of one scene.
///
/// `rounding` is what arithmetic alone can cost a displacement model in energy, and `rounds` says that other meshes are
/// other polygons for the same curve, which bound nothing on this one.
pub fn faults(runs: &[(Way, Ended)], rounding: f64, rounds: bool) -> Vec<Fault> {
    let mut faults: Vec<Fault> = runs.iter().flat_map(|(way, ended)| of_one(*way, ended)).collect();
    let codes: Vec<(Way, bool)> =
        runs.iter().filter(|(_, e)| matches!(e.code, 0 | 1 | 5)).map(|(way, e)| (*way, e.code == 5)).collect();
    if codes.iter().any(|c| c.1) && !codes.iter().all(|c| c.1) {
        let list: Vec<_> = codes.iter().filter(|c| c.1).map(|c| c.0.name()).collect();
        faults.push(Fault::new("infeasible for some", format!("infeasible for {} only", list.join(", "))));
    }
    let same: Vec<&(Way, Ended)> = runs.iter().filter(|(way, _)| !(rounds && is_other_mesh(*way))).collect();
    faults.extend(contradictions(&same, rounding));
    faults
}

fn is_other_mesh(way: Way) -> bool {
    matches!(way, Way::Finer | Way::Adaptive(_))
}

fn of_one(way: Way, ended: &Ended) -> Vec<Fault> {
    let name = way.name();
    let verdict = ended.verdict();
    if ended.timed_out || !(0..=5).contains(&ended.code) || ended.words.contains("panicked") {
        return vec![Fault::new(format!("{name}: {verdict}"), ended.message())];
    }
    let mut faults: Vec<Fault> = match ended.code {
        0 | 5 => Vec::new(),
        1 => {
            // Refinement may end at its limits.
            let may_fail = |check: &&Value| matches!(way, Way::Adaptive(_)) && check["name"] == "bracket/tolerance";
            let all = ended.failed_checks();
            let checks: Vec<&Value> = all.iter().copied().filter(|check| !may_fail(check)).collect();
            let list = checks.iter().map(|check| {
                let what = check["name"].as_str().unwrap_or("a check without a name");
                let text =
                    format!("{what}: {} against {}, allowed {}", check["value"], check["reference"], check["allowed"]);
                Fault::new(format!("{name}: {verdict}: {}", anonymous(what)), text)
            });
            let mut found: Vec<Fault> = list.collect();
            if all.is_empty() {
                found.push(Fault::new(format!("{name}: {verdict}, and no check failed"), ended.message()));
            }
            found
        }
        // Two methods may end without an answer, as long as they say why: the paper's knows only what the paper does and
        // has a limit of iterations, and an interior point may stop short.
        2 | 3 if way == Way::Method("uzawa") && says(ended, &["cannot express", "uzawa stopped after"]) => Vec::new(),
        2 | 3 if way == Way::Method("clarabel") && says(ended, &["cannot express", "clarabel stopped after"]) => {
            Vec::new()
        }
        _ => vec![Fault::new(format!("{name}: {verdict}: {}", gist(&ended.message())), ended.message())],
    };
    if ended.code == 0 || ended.code == 1 && faults.is_empty() {
        faults.extend(bracketed(name, ended));
    }
    faults
}

/// True if a run that did not complete gives one of these reasons.
fn says(ended: &Ended, reasons: &[&str]) -> bool {
    let message = ended.message();
    reasons.iter().any(|reason| message.contains(reason))
}

/// Faults in the bracket of a run that completed.
fn bracketed(name: &str, ended: &Ended) -> Vec<Fault> {
    let found = match ended.bracket() {
        None => Fault::new(format!("{name}: no bracket"), String::new()),
        Some([lower, upper]) if lower > upper => {
            Fault::new(format!("{name}: bracket upside down"), format!("{lower:e} above {upper:e}"))
        }
        // Without stress there is no energy to be relative to.
        Some(_)
            if ended.number("/energy/relative_error_bound").is_none()
                && ended.number("/energy/complementary").is_none_or(|energy| energy > 0.0) =>
        {
            Fault::new(format!("{name}: no relative error"), String::new())
        }
        Some(_) => return Vec::new(),
    };
    vec![found]
}

/// Bounds that exclude each other, and displacement models below a lower bound.
fn contradictions(runs: &[&(Way, Ended)], rounding: f64) -> Vec<Fault> {
    let mut faults = Vec::new();
    let known: Vec<(Way, [f64; 2])> = runs
        .iter()
        .filter(|run| matches!(run.1.code, 0 | 1))
        .filter_map(|run| Some((run.0, run.1.bracket()?)))
        .collect();
    for (a, [lower, _]) in &known {
        for (b, [_, upper]) in &known {
            if a != b && lower > upper {
                let text = format!("lower bound {lower:e} of {} above upper bound {upper:e} of {}", a.name(), b.name());
                faults.push(Fault::new("brackets that exclude each other", text));
            }
        }
    }
    let scale = |ended: &Ended| ended.number("/energy/complementary").unwrap_or(0.0).abs();
    for (_, verified) in runs.iter().filter(|run| run.0 == Way::Verify) {
        let models = verified.report.iter().filter_map(|r| r["primal"].as_array()).flatten();
        for model in models.filter(|m| m["admissible"] == true) {
            let Some(energy) = model["energy"].as_f64() else { continue };
            let slack = ROUNDING * scale(verified).max(energy.abs()) + rounding;
            for (way, [lower, _]) in &known {
                if *lower > energy + slack {
                    let text = format!("lower bound {lower:e} of {} above {} {energy:e}", way.name(), model["name"]);
                    faults.push(Fault::new("a displacement model below a lower bound", text));
                }
            }
        }
    }
    let of = |wanted: Way| runs.iter().find(|run| run.0 == wanted && matches!(run.1.code, 0 | 1)).map(|run| &run.1);
    if let (Some(coarse), Some(fine)) = (of(Way::Method("condensed")), of(Way::Finer))
        && let (Some([before, _]), Some([after, _])) = (coarse.bracket(), fine.bracket())
    {
        // Meshes are nested, and so are the stresses: the bound rises, but for what it is widened by. A mesh that was
        // divided at the ends of contact first need not lie in the finer one, and where triangles beside a body of
        // degree 2 have it too, those that are finer and lie apart from it need not.
        let degree = |ended: &Ended, which: &str| ended.number(&format!("/dual/degree_{which}"));
        let is_nested = !was_divided(coarse) && degree(fine, "min") >= degree(coarse, "max");
        let slack = fine.number("/energy/widening").unwrap_or(0.0) + ROUNDING * scale(coarse) + rounding;
        if after + slack < before && is_nested {
            faults.push(Fault::new("a lower bound that falls", format!("{before:e}, on the finer mesh {after:e}")));
        }
    }
    faults
}

/// True if the mesh as given could not express the pressure that balances the loads.
fn was_divided(ended: &Ended) -> bool {
    let notes = ended.report.iter().filter_map(|report| report["notes"].as_array()).flatten();
    notes.filter_map(|note| note["text"].as_str()).any(|text| text.contains("divided at the ends of contact"))
}

/// A check's name without the names of this scene: `contact/*/resultant`.
fn anonymous(check: &str) -> String {
    let mut parts: Vec<&str> = check.split('/').collect();
    if parts.len() > 2 && matches!(parts[0], "contact" | "support") {
        parts[1] = "*";
    }
    parts.join("/")
}

/// The words of a message, without numbers and names.
fn gist(message: &str) -> String {
    let plain = message.split_whitespace().filter(|word| !word.chars().any(|c| c.is_ascii_digit() || c == '/'));
    plain.take(14).collect::<Vec<_>>().join(" ")
}
