//! The numbers.

use std::collections::BTreeMap;

use maud::{Markup, html};

use crate::report::text::number::{
    at_most_percent, clean, digits_to_tell, enclosing, grouped, optional, outward, percent, seconds, significant,
    vector,
};
use crate::report::text::words::{mean_in_words, upper_from};
use crate::report::{CoulombSummary, DualSummary, Energy, PrimalSummary, Report};

pub(super) fn tables(report: &Report) -> Markup {
    html! {
        section #checks { h2 { "Checks" } (super::checks::checks(report)) }
        @if !report.remarks.is_empty() { section #remarks { h2 { "Remarks" } (super::checks::remarks(report)) } }
        @if !report.quantities.is_empty() { section #quantities { h2 { "Quantities" } (super::quantities::table(report)) } }
        @if let Some(energy) = &report.energy { section #energy { h2 { "Energy" } (energies(report, energy)) } }
        @if let Some(coulomb) = &report.coulomb { section #coulomb { h2 { "Coulomb friction" } (friction(coulomb)) } }
        @if !report.contact.is_empty() { section #contact { h2 { "Contact" } (contacts(report)) } }
        @if report.stress.is_some() { section #stress { h2 { "Stress" } (stress(report)) } }
        section #solvers { h2 { "Solvers" } (solvers(report)) }
        @if !report.history.is_empty() { section #history { h2 { "Adaptive refinement" } (history(report)) } }
        @if !report.notes.is_empty() { section #notes { h2 { "Notes" } (notes(report)) } }
        section #provenance { h2 { "Where the numbers come from" } (provenance(report)) }
    }
}

/// A table that scrolls sideways where it does not fit.
pub(super) fn scroll(label: &str, table: Markup) -> Markup {
    html! { div.scroll role="region" aria-label=(label) tabindex="0" { (table) } }
}

/// Statements on all solutions of Coulomb's law, on the bound that was used, and on the number of solutions.
fn friction(coulomb: &CoulombSummary) -> Markup {
    html! { ul { @for statement in coulomb.statements.iter().chain(&coulomb.wedging) { li { (clean(statement)) } } } }
}

fn energies(report: &Report, energy: &Energy) -> Markup {
    let digits = digits_to_tell(energy.lower, energy.upper).max(10);
    let of_upper = format!("best admissible 𝓛(v), {}", upper_from(&energy.upper_from));
    let [lower, upper] = enclosing([energy.lower, energy.upper], digits);
    let interval = |ends: [f64; 2]| enclosing(ends, digits).join(" … ");
    let (work, meaning) = match energy.compliance {
        Some(_) => ("compliance", "encloses ∫F·u + ∫P·u, the work of the loads: twice the elastic energy"),
        None if energy.friction_work.is_some() => (
            "enclosed work",
            "encloses the work of the loads and of stresses on initial strains, less that of friction and of the reactions on prescribed displacements and gaps",
        ),
        None => (
            "enclosed work",
            "encloses the work of the loads and of stresses on initial strains, less that of the reactions on prescribed displacements and gaps",
        ),
    };
    let mut rows = vec![
        ("lower bound", lower, "−Π(λ_h), less what rounding can have cost"),
        ("upper bound", upper, of_upper.as_str()),
        ("gap", significant(energy.gap, 6), "upper − lower"),
        ("relative error bound", at_most_percent(energy.relative_error_bound), "√(gap / 𝒮(λ_h)), in the energy norm"),
        (
            "mid-field error bound",
            percent(energy.mid_error_bound),
            "of (λ_h + σ(v))/2, the stress half-way between the two bounds, in the energy norm",
        ),
        (work, interval(energy.enclosed_work), meaning),
        ("free upper bound", optional(energy.free_upper, digits), "from the dual solve alone"),
        (
            "gap of the free bound, local",
            optional(energy.gap_local, 10),
            "constitutive-relation error plus contact complementarity, integrated triangle by triangle",
        ),
        ("complementary energy", significant(energy.complementary, digits), "𝒮(λ_h) = ½∫ a λ_h : λ_h"),
        (
            "widening",
            significant(energy.widening, 3),
            "what rounding and residual equilibrium can have cost, contained in both bounds",
        ),
        ("guarantee", clean(&energy.guarantee.words), "on whose word the bracket holds for the scene as written"),
    ];
    if energy.friction_work.is_some() {
        let meaning = "∫ τ̄ |v_t' − v_t''| of the upper bound, which nothing stores";
        rows.insert(7, ("work of friction", optional(energy.friction_work, digits), meaning));
    }
    let across = report.data_range.as_ref().map(|range| {
        let digits = range.upper.map_or(6, |upper| digits_to_tell(range.lower, upper).max(6));
        let upper = range.upper.map_or("∞".to_string(), |upper| outward(upper, digits, true));
        format!("{} … {upper}", outward(range.lower, digits, false))
    });
    let primal_meaning = |primal: &PrimalSummary| match (primal.admissible, primal.is_of_quadrature()) {
        (false, _) => "not admissible everywhere: no bound",
        (true, true) => "admissible, but the energy is that of a quadrature: no bound",
        (true, false) => "admissible: an upper bound",
    };
    html! {
        (scroll("energies", html! {
            table {
                thead { tr { th { "quantity" } th.n { "value" } th { "meaning" } } }
                tbody {
                    @for (name, value, meaning) in &rows {
                        tr { td { (name) } td.n { (value) } td.why { (meaning) } }
                    }
                    @for primal in &report.primal {
                        tr {
                            td { "𝓛 of " (clean(&primal.name)) } td.n { (significant(primal.energy, digits)) }
                            td.why { (primal_meaning(primal)) }
                        }
                    }
                    @if let Some(across) = &across {
                        tr {
                            td { "for all data" } td.n { (across) }
                            td.why { "encloses the exact energies for all data in the ranges of the scene: it is as wide as these, however fine the mesh" }
                        }
                    }
                }
            }
        }))
    }
}

fn contacts(report: &Report) -> Markup {
    html! {
        p { "Force and moment act on the first side; the moment is about the origin." }
        (scroll("contacts", html! {
            table {
                thead { tr {
                    th { "contact" } th { "model" } th.n { "force" } th.n { "moment" } th.n { "largest pressure" }
                    th.n { "at" } th.n { "open" }
                    th.n { "ends of contact" } th.n { "pressure difference" }
                } }
                tbody { @for contact in &report.contact {
                    tr {
                        td.long rowspan="2" { code { (clean(&contact.name)) } br; "length " (significant(contact.length, 4)) }
                        td { "dual" } td.n { (vector(contact.resultant.dual, 7)) }
                        td.n { (significant(contact.moment.dual, 7)) }
                        td.n { (significant(contact.pressure_max.dual, 5)) }
                        td.n { (vector(contact.pressure_max_at.dual, 4)) }
                        td.n { (percent(contact.open_fraction)) }
                        td.n rowspan="2" {
                            @if contact.contact_ends.is_empty() { "–" }
                            @for (i, end) in contact.contact_ends.iter().enumerate() { @if i > 0 { ", " } (significant(*end, 4)) }
                        }
                        td.n rowspan="2" { (contact.pressure_l2_difference.map_or("–".to_string(), percent)) }
                    }
                    tr {
                        td { "primal" } td.n { (contact.resultant.primal.map_or("–".to_string(), |r| vector(r, 7))) }
                        td.n { (optional(contact.moment.primal, 7)) }
                        td.n { (optional(contact.pressure_max.primal, 5)) }
                        td.n { (contact.pressure_max_at.primal.map_or("–".to_string(), |p| vector(p, 4))) }
                        td.n { (contact.open_fraction_primal.map_or("–".to_string(), percent)) }
                    }
                } }
            }
        }))
        @if report.contact.iter().any(|contact| contact.pressure_mean.is_some()) {
            p { "A largest pressure is the value at one point, which no energy bounds; a mean around that point is bounded:" }
            ul { @for contact in &report.contact { @if let Some(mean) = &contact.pressure_mean {
                li { code { (clean(&contact.name)) } ": " (mean_in_words(mean, report.is_guaranteed())) }
            } } }
        }
    }
}

fn stress(report: &Report) -> Markup {
    let Some(stress) = &report.stress else { return html! {} };
    let parts = stress.component_l2_difference;
    html! {
        p {
            "Dual against " (clean(&stress.against)) ": " b { (percent(stress.relative_energy_norm_difference)) } " apart in the energy norm. "
            "Component by component, relative to the L² norm of the whole dual stress:"
        }
        (scroll("stress differences", html! {
            table {
                thead { tr { th.n { "σ_xx" } th.n { "σ_yy" } th.n { "σ_xy" } th.n { "von Mises" }
                th.n { "largest von Mises, dual" } th.n { "primal" } } }
                tbody { tr {
                    td.n { (percent(parts.xx)) } td.n { (percent(parts.yy)) } td.n { (percent(parts.xy)) }
                    td.n { (percent(parts.von_mises)) }
                    td.n { (significant(stress.von_mises_max.dual, 5)) }
                    td.n { (optional(stress.von_mises_max.primal, 5)) }
                } }
            }
        }))
    }
}

fn solvers(report: &Report) -> Markup {
    html! {
        @if let Some(dual) = &report.dual { (dual_solver(dual)) } @else { p { "There is no dual solution." } }
        @if !report.primal.is_empty() {
            (scroll("displacement models", html! {
                table {
                    caption { "Displacement models" }
                    thead { tr {
                        th { "model" } th { "program" } th.n { "degree" } th.n { "unknowns" } th.n { "iterations" }
                        th { "admissible" } th.n { "error at most" }
                        th.n { "seconds" }
                    } }
                    tbody { @for primal in &report.primal { tr {
                        td.long { (clean(&primal.name)) }
                        td { (clean(&primal.solver)) " " (clean(&primal.version)) } td.n { (primal.degree) }
                        td.n { (primal.unknowns.map_or("–".to_string(), grouped)) } td.n { (primal.iterations.map_or("–".to_string(), grouped)) }
                        td { @if primal.admissible { "yes" } @else { "no" } }
                        td.n { (primal.relative_error_bound.map_or("–".to_string(), percent)) }
                        td.n { (optional(primal.seconds.get("total").copied(), 3)) }
                    } } }
                }
            }))
            @for primal in &report.primal {
                p { b { (clean(&primal.name)) } ", seconds by phase" }
                (phases(&in_order(&primal.seconds)))
            }
        }
    }
}

fn dual_solver(dual: &DualSummary) -> Markup {
    let s = dual.seconds;
    let degrees = match (dual.degree_min, dual.degree_max) {
        (least, most) if least == most => most.to_string(),
        (least, most) => format!("{least} to {most}"),
    };
    let names = [
        ("read", s.read),
        ("statics", s.statics),
        ("assemble", s.assemble),
        ("factor", s.factor),
        ("contact", s.contact),
        ("recover", s.recover),
        ("bounds", s.bounds),
        ("total", s.total),
    ];
    html! {
        (scroll("dual solver", html! {
            table {
                caption { "Dual solve" }
                thead { tr { th { "method" } th.n { "degree" } th.n { "triangles" } th.n { "unknowns" } th.n { "contact steps" }
                th.n { "equilibrium residual" } th.n { "seconds" } } }
                tbody { tr {
                    td { (dual.method) } td.n { (degrees) } td.n { (grouped(dual.triangles)) } td.n { (grouped(dual.unknowns)) }
                    td.n { (dual.iterations) }
                    td.n { (significant(dual.equilibrium_residual, 3)) } td.n { (significant(s.total, 3)) }
                } }
            }
        }))
        (phases(&names))
    }
}

fn in_order(seconds: &BTreeMap<String, f64>) -> Vec<(&str, f64)> {
    seconds.iter().map(|(name, s)| (name.as_str(), *s)).collect()
}

/// Seconds by phase as one bar; `total` is its length, and what the phases leave of it is shown as the rest.
fn phases(all: &[(&str, f64)]) -> Markup {
    let valid = |s: f64| s.is_finite() && s > 0.0;
    let mut parts: Vec<(&str, f64)> = all.iter().copied().filter(|(name, s)| *name != "total" && valid(*s)).collect();
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    let total = all.iter().find(|(name, s)| *name == "total" && valid(*s)).map_or(sum, |total| total.1.max(sum));
    if total - sum > 0.005 * total {
        parts.push(("rest", total - sum));
    }
    let colour = |i: usize, name: &str| if name == "rest" { "p6".to_string() } else { format!("p{}", i % 6) };
    html! {
        @if total > 0.0 {
            div.phases aria-hidden="true" {
                @for (i, (name, s)) in parts.iter().enumerate() {
                    div class=(colour(i, name)) style=(format!("width:{:.2}%", 100.0 * s / total)) {}
                }
            }
            ul.key {
                @for (i, (name, s)) in parts.iter().enumerate() { li { i class=(colour(i, name)) {} (clean(name)) " " (seconds(*s)) } }
                li { b { "total " (seconds(total)) } }
            }
        }
    }
}

fn history(report: &Report) -> Markup {
    html! {
        (scroll("adaptive refinement", html! {
            table {
                thead { tr { th.n { "mesh" } th.n { "triangles" } th.n { "unknowns" } th.n { "lower bound" }
                th.n { "upper bound" } th.n { "error at most" } th.n { "rate" } th.n { "seconds" }
                th.n { "seconds since start" } } }
                tbody { @for (i, row) in report.history.iter().enumerate() { tr {
                    @let [lower, upper] = enclosing([row.lower, row.upper], digits_to_tell(row.lower, row.upper));
                    td.n { (i + 1) } td.n { (grouped(row.triangles)) } td.n { (grouped(row.unknowns)) }
                    td.n { (lower) } td.n { (upper) } td.n { (at_most_percent(row.relative_error_bound)) }
                    td.n { (optional(row.rate, 2)) } td.n { (significant(row.step_seconds, 3)) }
                    td.n { (significant(row.seconds, 3)) }
                } } }
            }
        }))
        p { "Rate: the power of the unknowns that the error falls with, from the mesh before. Seconds: on this mesh alone." }
    }
}

fn notes(report: &Report) -> Markup {
    html! {
        ul.notes { @for note in &report.notes {
            li { @if note.weakens_guarantee { span.not { "weakens the guarantee: " } } (clean(&note.text)) }
        } }
    }
}

fn provenance(report: &Report) -> Markup {
    let made = &report.provenance;
    html! {
        (scroll("provenance", html! {
            table { tbody {
                tr { th { "hypercircle" }
                td { (clean(&made.version)) ", " (made.threads) @if made.threads == 1 { " thread" } @else { " threads" } } }
                @for (name, version) in &made.components { tr { th { (clean(name)) } td.long { (clean(version)) } } }
                tr { th { "scene, SHA-256" } td.long { code { (clean(&made.scene_sha256)) } } }
                tr { th { "mesh, SHA-256" } td.long { code { (clean(&made.mesh_sha256)) } } }
                tr { th { "Cargo.lock, SHA-256" } td.long { code { (clean(&made.lock_sha256)) } } }
            } }
        }))
        @if !made.seconds.is_empty() { p { b { "The whole run" } ", seconds by phase" } (phases(&in_order(&made.seconds))) }
    }
}
