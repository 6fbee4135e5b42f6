//! Quantities that the scene was solved for: pictures on the first screen, a table among the numbers.

use maud::{Markup, PreEscaped, html};

use super::tables::scroll;
use crate::report::figure::quantity::quantity;
use crate::report::text::number::{clean, optional, outward, percent, significant};
use crate::report::{QuantitySummary, Report};

/// How many quantities the first screen shows; the table has all.
const SHOWN: usize = 12;

/// The first screen's part.
pub(super) fn card(report: &Report) -> Markup {
    let all = &report.quantities;
    html! {
        @if !all.is_empty() {
            section.card.asked aria-label="what was asked for" {
                h2 { "What was asked for" }
                div.asked-for { @for (i, summary) in all.iter().take(SHOWN).enumerate() { (one(i, summary, report)) } }
                @if all.len() > SHOWN {
                    p { (all.len() - SHOWN) " more are in the " a href="#quantities" { "table" } "." }
                }
            }
        }
    }
}

fn one(index: usize, summary: &QuantitySummary, report: &Report) -> Markup {
    let word = if report.is_guaranteed() { report.firmness() } else { "for the data as represented on the mesh" };
    let id = format!("quantity-{index}");
    html! {
        div id=(id) {
            h3 { code { (clean(&summary.name)) } " · " (clean(&summary.kind)) }
            @if let Some(figure) = quantity(summary, report) { (PreEscaped(figure)) }
            p {
                @if summary.value.is_finite() { b { (significant(summary.value, summary.digits())) } }
                @else { b { "not known" } }
                @if summary.exact_by_statics { ", " b { "exact by statics" } ": equilibrium alone determines it." }
                @else if summary.is_enclosed() {
                    ", " (word) " within " b { (summary.interval()) } ": half-width " (width(summary)) "."
                }
                @else { ", " (word) " within " (summary.interval()) "." }
            }
            @if let Some(reason) = &summary.reason {
                p { (if summary.has_an_end() { "An end is missing: " } else { "No interval: " })
                    (clean(reason)) "." }
            }
            @for held in summary.held(report) {
                @let verdict = summary.verdict_on(&held);
                @if !verdict.is_empty() { p.off {
                    b { (clean(&held.of)) } @if let Some(value) = held.value { ": " (significant(value, summary.digits())) }
                    ", " (verdict) "."
                } }
            }
        }
    }
}

/// Half of the width, absolute and relative.
fn width(summary: &QuantitySummary) -> String {
    let half = significant(summary.half_width(), 3);
    let relative = summary.relative_half_width();
    if relative.is_finite() { format!("{half} ({})", percent(relative)) } else { half }
}

/// All of it.
pub(super) fn table(report: &Report) -> Markup {
    let end = |x: f64, digits: usize, upwards: bool| {
        if x.is_finite() { outward(x, digits, upwards) } else { "–".to_string() }
    };
    html! {
        p {
            "The exact value of each quantity lies between its ends, which are rounded outwards"
            @if !report.is_guaranteed() { ", for the data as represented on the mesh; the notes say what weakens the guarantee" }
            @if report.coulomb.is_some() { ", for the friction bound that was found" }
            ". The value is that of the dual solution, for displacements that of the displacement built from it, and nearer to \
            the truth than the middle. First order: the interval that follows from the energies alone. "
            code { "quantities.csv" } " has the same for a spreadsheet."
        }
        (scroll("quantities", html! {
            table {
                thead { tr {
                    th { "quantity" } th { "kind" } th.n { "value" } th.n { "lower end" } th.n { "upper end" }
                    th.n { "half-width" } th.n { "relative" } th.n { "first order" } th { "other values" } th { "remark" }
                } }
                tbody { @for summary in &report.quantities {
                    @let digits = summary.digits();
                    tr {
                        td.long { code { (clean(&summary.name)) } } td { (clean(&summary.kind)) }
                        td.n { (significant(summary.value, digits)) }
                        td.n { (summary.ends()[0]) } td.n { (summary.ends()[1]) }
                        td.n { (significant(summary.half_width(), 3)) } td.n { (percent(summary.relative_half_width())) }
                        td.n { (end(summary.first_order[0], digits, false)) " … " (end(summary.first_order[1], digits, true)) }
                        td { @for held in summary.held(report) {
                            @let verdict = summary.verdict_on(&held);
                            div {
                                (clean(&held.of)) ": " (optional(held.value, digits))
                                @if !verdict.is_empty() { ", " b { (verdict) } }
                                @else if summary.has_an_end() { ", inside" }
                            }
                        } }
                        td.why {
                            @if summary.exact_by_statics { "exact by statics" }
                            @if let Some(reason) = &summary.reason { (clean(reason)) }
                        }
                    }
                } }
            }
        }))
    }
}

#[cfg(test)]
mod tests {
    use crate::report::page;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn quantities_stand_on_the_first_screen_and_in_a_table() {
        let sample = Sample::new(2, Verdict::Agree);
        let mut dossier = sample.dossier();
        dossier.report.quantities[0].primal[0].value = Some(0.85);
        let text = page(&dossier);
        let (first, rest) = text.split_at(text.find("<main").unwrap());
        for piece in [
            "What was asked for",
            "tip &lt;a&amp;b&gt;",
            "outside by 0.04",
            "exact by statics",
            "nothing holds &lt;it&gt;",
        ] {
            assert!(first.contains(piece), "{piece}");
        }
        let table = &rest[rest.find("id=\"quantities\"").unwrap()..];
        for piece in ["tip &lt;a&amp;b&gt;", "0.79", "1.25 %", "FEniCSx P2: 0.85, <b>outside by 0.04", "nothing holds"]
        {
            assert!(table.contains(piece), "{piece}");
        }
        dossier.report.quantities.clear();
        let text = page(&dossier);
        assert!(!text.contains("What was asked for") && !text.contains("id=\"quantities\""));
    }

    #[test]
    fn more_quantities_than_a_screen_holds_are_in_the_table() {
        let sample = Sample::new(1, Verdict::Agree);
        let mut dossier = sample.dossier();
        let one = dossier.report.quantities[0].clone();
        dossier.report.quantities = (0..40)
            .map(|k| {
                let mut q = one.clone();
                q.name = format!("q{k}.");
                q
            })
            .collect();
        let text = page(&dossier);
        assert!(text.contains("28 more are in the") && text.matches("<code>q39.</code>").count() == 1);
    }
}
