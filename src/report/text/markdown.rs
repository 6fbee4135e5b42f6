//! `summary.md`: the report on one screen, for a comment of a continuous-integration job.

use std::fmt::Write;

use super::number::{clean, digits_to_tell, enclosing, optional, percent, significant, vector};
use super::words::{accuracy, basis_word, failing, headline, mean_in_words, status_symbol, upper_from, worth_a_look};
use crate::cause::told;
use crate::report::{Report, Status};
use crate::scene::counted;

/// How many failing checks and quantities are listed before the rest is only counted.
const LISTED: usize = 12;

/// The report as Markdown.
pub fn summary(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail, so the results of `write!` below carry no information.
    let symbol = if report.status == Status::Agree { "✅" } else { status_symbol(report.status) };
    let _ = writeln!(text, "## {symbol} {}: {}\n", cell(&report.title), headline(report));
    let _ = writeln!(text, "{}\n", cell(&report.verdict));
    bracket(&mut text, report);
    quantities(&mut text, report);
    causes(&mut text, report);
    checks(&mut text, report);
    for diagnosis in &report.diagnosis {
        let _ = writeln!(text, "**What is wrong with {}:** {}\n", cell(&diagnosis.field), cell(&diagnosis.sentence));
    }
    primals(&mut text, report);
    contacts(&mut text, report);
    let weakening: Vec<_> = report.notes.iter().filter(|note| note.weakens_guarantee).collect();
    for note in &weakening {
        let _ = writeln!(text, "> **Weakens the guarantee:** {}\n", cell(&note.text));
    }
    if report.notes.len() > weakening.len() {
        let _ = writeln!(text, "{} in `report.html`.\n", counted(report.notes.len() - weakening.len(), "more note"));
    }
    let _ = writeln!(
        text,
        "`{}` · hypercircle {} · run {}",
        code(&report.scene),
        cell(&report.provenance.version),
        report.run
    );
    text
}

fn bracket(text: &mut String, report: &Report) {
    let Some(energy) = &report.energy else { return };
    let [lower, upper] = enclosing([energy.lower, energy.upper], digits_to_tell(energy.lower, energy.upper));
    let _ = writeln!(
        text,
        "Exact energy 𝓛(u) between **{lower}** and **{upper}** (upper bound: {}). {}\n",
        cell(&upper_from(&energy.upper_from)),
        accuracy(report)
    );
}

fn quantities(text: &mut String, report: &Report) {
    if report.quantities.is_empty() {
        return;
    }
    let held = match (report.is_guaranteed(), &report.coulomb) {
        (true, None) => "guaranteed within",
        (true, Some(_)) => "guaranteed within, for the friction bound that was found",
        (false, _) => "within, for the data on the mesh",
    };
    let _ = writeln!(text, "| quantity | kind | value | {held} | half-width | | other values |");
    let _ = writeln!(text, "|---|---|--:|--:|--:|---|---|");
    for quantity in report.quantities.iter().take(LISTED) {
        let others = quantity.held(report).into_iter().map(|held| {
            let value = optional(held.value, quantity.digits());
            match quantity.verdict_on(&held).as_str() {
                "" => format!("{} {value}", cell(&held.of)),
                verdict => format!("{} {value}, **{verdict}**", cell(&held.of)),
            }
        });
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} |",
            code(&quantity.name),
            cell(&quantity.kind),
            significant(quantity.value, quantity.digits()),
            quantity.interval(),
            significant(quantity.half_width(), 3),
            if quantity.exact_by_statics {
                "exact by statics".to_string()
            } else {
                cell(quantity.reason.as_deref().unwrap_or(""))
            },
            others.collect::<Vec<_>>().join("; ")
        );
    }
    if report.quantities.len() > LISTED {
        let _ = writeln!(text, "\n{} more quantities in `report.html`.", report.quantities.len() - LISTED);
    }
    text.push('\n');
}

/// Why checks did not pass, before they are listed.
fn causes(text: &mut String, report: &Report) {
    for cause in report.causes.iter().take(LISTED) {
        let _ = writeln!(
            text,
            "- **{}** {} *Try:* {} ({})",
            cell(&cause.sentence),
            cell(&cause.suggests),
            cell(&cause.remedy),
            counted(cause.checks.len(), "check")
        );
    }
    if report.causes.len() > LISTED {
        let _ = writeln!(text, "- and {} more", report.causes.len() - LISTED);
    }
    if !report.causes.is_empty() {
        text.push('\n');
    }
}

fn checks(text: &mut String, report: &Report) {
    let failing = failing(report);
    if report.checks.is_empty() {
        let _ = writeln!(text, "No checks were made.\n");
    } else if failing.is_empty() {
        let _ = writeln!(text, "All {} checks passed.\n", report.checks.len());
    } else {
        let _ = writeln!(text, "**{} of {} checks did not pass:**\n", failing.len(), report.checks.len());
        let _ = writeln!(text, "| check | value | reference | difference | allowed | basis | result |");
        let _ = writeln!(text, "|---|--:|--:|--:|--:|---|---|");
        for check in failing.iter().take(LISTED) {
            let _ = writeln!(
                text,
                "| `{}` | {} | {} | {} | {} | {} | {} |",
                code(&check.name),
                optional(check.value, 7),
                optional(check.reference, 7),
                check.difference.map_or("not made".to_string(), |d| significant(d, 4)),
                significant(check.allowed, 4),
                basis_word(check.basis),
                cell(&told(check))
            );
        }
        if failing.len() > LISTED {
            let rest: Vec<String> = failing[LISTED..].iter().map(|check| format!("`{}`", code(&check.name))).collect();
            let _ = writeln!(text, "\nand {}", rest.join(", "));
        }
        text.push('\n');
    }
    let look = worth_a_look(report);
    if !look.is_empty() {
        let named: Vec<String> = look.iter().take(LISTED).map(|remark| format!("`{}`", code(&remark.name))).collect();
        let more = if look.len() > LISTED { ", …" } else { "" };
        let _ = writeln!(text, "Worth a look, and no part of the verdict: {}{more}.\n", named.join(", "));
    }
}

fn primals(text: &mut String, report: &Report) {
    if report.primal.is_empty() {
        return;
    }
    let _ = writeln!(text, "| displacement model | energy 𝓛 | admissible | error at most | unknowns |");
    let _ = writeln!(text, "|---|--:|---|--:|--:|");
    let lower = report.energy.as_ref().map_or(f64::NAN, |energy| energy.lower);
    for primal in &report.primal {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            cell(&primal.name),
            significant(primal.energy, digits_to_tell(primal.energy, lower)),
            if primal.admissible { "yes" } else { "no" },
            primal.relative_error_bound.map_or("–".to_string(), percent),
            primal.unknowns.map_or("–".to_string(), |unknowns| unknowns.to_string())
        );
    }
    text.push('\n');
}

fn contacts(text: &mut String, report: &Report) {
    if report.contact.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "| contact | resultant, dual | resultant, primal | largest pressure, dual | primal | open | pressure difference |"
    );
    let _ = writeln!(text, "|---|--:|--:|--:|--:|--:|--:|");
    for contact in &report.contact {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} | {} | {} |",
            code(&contact.name),
            vector(contact.resultant.dual, 5),
            contact.resultant.primal.map_or("–".to_string(), |r| vector(r, 5)),
            significant(contact.pressure_max.dual, 4),
            optional(contact.pressure_max.primal, 4),
            percent(contact.open_fraction),
            contact.pressure_l2_difference.map_or("–".to_string(), percent)
        );
    }
    text.push('\n');
    for contact in &report.contact {
        if let Some(mean) = &contact.pressure_mean {
            let words = mean_in_words(mean, report.is_guaranteed());
            let _ = writeln!(text, "- `{}`: {words}", code(&contact.name));
        }
    }
    text.push('\n');
}

/// Takes the meaning from a character for whoever makes links of words: somebody to notify, an issue, an address.
const NO_LINK: &str = "&#8203;";

/// User text on one line: whatever Markdown or HTML would act on is escaped, and nothing becomes a link.
pub(crate) fn cell(text: &str) -> String {
    let mut escaped = String::new();
    let text = clean(text);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\n' | '\t' => escaped.push(' '),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '#' | '|' | '~' => {
                escaped.push('\\');
                escaped.push(c);
            }
            _ => escaped.push(c),
        }
        let next = rest.peek().copied().unwrap_or(' ');
        let links = match c {
            '@' | '#' => !next.is_whitespace(),
            ':' => next == '/',
            '.' => escaped.len() >= 4 && escaped[..escaped.len() - 1].to_lowercase().ends_with("www"),
            '-' => next.is_ascii_digit() && escaped.to_lowercase().ends_with("gh-"),
            _ => false,
        };
        if links {
            escaped.push_str(NO_LINK);
        }
    }
    escaped
}

/// User text inside a code span in a table: a backtick would end it, and a bar the cell.
pub(crate) fn code(text: &str) -> String {
    clean(text).replace(['\n', '\t'], " ").replace('`', "'").replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn one_screen_with_verdict_bracket_and_checks() {
        let report = Sample::new(2, Verdict::Agree).dossier().report;
        let text = summary(&report);
        assert!(text.lines().count() < 40, "{text}");
        assert!(text.contains(": agree") && text.contains(&format!("All {} checks passed.", report.checks.len())));
    }

    #[test]
    fn without_a_second_model_nothing_agrees() {
        let mut report = Sample::new(2, Verdict::Agree).dossier().report;
        report.primal.clear();
        let text = summary(&report);
        assert!(text.contains(": passed") && !text.contains(": agree"), "{text}");
    }

    #[test]
    fn nothing_in_a_title_notifies_or_links() {
        let escaped =
            cell("@octocat and team@example.org at https://example.org, www.example.org, #12, GH-7; a: b, 3.5");
        for link in ["@o", "@e", "://", "www.e", "#1", "GH-7"] {
            assert!(!escaped.contains(link), "{link} in {escaped}");
        }
        assert!(escaped.contains("a: b, 3.5"), "{escaped}");
        let mut report = Sample::new(2, Verdict::Disagree).dossier().report;
        report.title = "@octocat https://example.org".to_string();
        report.verdict = "see www.example.org/@octocat".to_string();
        let text = summary(&report);
        assert!(!text.contains("@octocat") && !text.contains("://") && !text.contains("www.example"), "{text}");
    }

    #[test]
    fn quantities_are_listed_with_what_lies_outside() {
        let mut report = Sample::new(2, Verdict::Agree).dossier().report;
        report.quantities[0].primal[0].value = Some(0.85);
        let text = summary(&report);
        assert!(text.contains("| 0.801 | 0.79 … 0.81 | 0.01 |"), "{text}");
        assert!(text.contains("FEniCSx P2 0.85, **outside by 0.04**"), "{text}");
        assert!(text.contains("| 0.2 … ∞ | – | nothing holds &lt;it&gt; |"), "{text}");
        assert!(text.contains("| exact by statics |"), "{text}");
    }

    #[test]
    fn tables_keep_their_columns_whatever_the_names() {
        let mut report = Sample::new(2, Verdict::Disagree).dossier().report;
        report.contact[0].name = "a|b`<script>".to_string();
        report.primal[0].name = "P1 | <img src=x>".to_string();
        report.quantities[0].name = "a|b`c".to_string();
        report.quantities[1].primal[0].solver = "P1 | <img src=x>".to_string();
        let text = summary(&report);
        assert!(!text.contains("<img") && text.contains("a\\|b'"));
        let mut columns = None;
        for line in text.lines() {
            let bars = line.replace("\\|", "").matches('|').count();
            match columns {
                _ if !line.starts_with('|') => columns = None,
                None => columns = Some(bars),
                Some(n) => assert_eq!(n, bars, "{line}"),
            }
        }
    }
}
