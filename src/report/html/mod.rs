//! `report.html`: one page that stands alone, for a reader who does not know the program.

mod causes;
mod checks;
mod links;
mod map;
mod pictures;
mod quantities;
mod scene;
mod style;
mod tables;
mod values;
mod verdict;
pub(crate) mod why;

use maud::{Markup, PreEscaped, html};

use super::document::document;
use super::text::number::{clean, grouped};
use super::{Dossier, Report};
pub(crate) use style::CSS;

/// Reading values off the map, zooming, sorting: a comfort, and nothing else.
const SCRIPT: &str = include_str!("page.js");

/// The page: nothing loaded, and complete where its one script does not run.
pub fn page(dossier: &Dossier) -> String {
    let report = &dossier.report;
    let title = format!("{} · {}", clean(&report.title), super::text::words::headline(report));
    let body = html! {
        a.skip href="#pictures" { "To the pictures" }
        (verdict::first_screen(dossier))
        main {
            (pictures::pictures(dossier))
            (tables::tables(report))
            (reading(report))
        }
        footer {
            "Made by hypercircle " (clean(&report.provenance.version)) " (" (clean(&report.command)) ") from "
            (grouped(dossier.problem.mesh.triangles.len())) " triangles. "
            code { "report.json" } " holds every number of this page, " code { "fields.vtu" } " the fields for ParaView."
        }
        script { (PreEscaped(SCRIPT)) }
    };
    document(&title, &[style::CSS], Some(&report.run), body)
}

/// Explains the words of the page.
fn reading(report: &Report) -> Markup {
    html! {
        section #reading {
            h2 { "How to read this page" }
            dl.words {
                dt { "Two models, one scene" }
                dd {
                    "The " b { "dual" } " model looks for stresses that are in exact equilibrium with the loads; it knows nothing of \
                    displacements. The " b { "primal" } " model looks for displacements that do not penetrate; its stresses are only \
                    nearly in equilibrium. They share the scene and the mesh and nothing else, so an error in one of them shows as a \
                    difference."
                }
                dt { "The bracket" }
                dd {
                    "Every equilibrated stress gives a number below the exact energy, every admissible displacement a number \
                    above it. The exact energy lies between, whatever the mesh. A short interval means that both models are accurate; \
                    an interval the wrong way round means that one of them is wrong."
                }
                @if !report.quantities.is_empty() {
                    dt { "Intervals of quantities" }
                    dd {
                        "A displacement, a force or a stress that the scene asks for. The interval follows from the same two solutions as \
                        the bracket, and from two more for the quantity itself. No correct solution of the scene has a value outside; \
                        one on this mesh may miss it by its own error."
                    }
                }
                dt { "Relative error in the energy norm" }
                dd {
                    "The size of the stress error, measured by the energy it stores, relative to the size of the stress itself. The width of the \
                    bracket limits it from above; no estimate and no finer mesh is needed."
                }
                dt { "Admissible" }
                dd { "A displacement that respects supports and contact everywhere, also between the nodes. Only then is its energy an upper bound." }
                dt { "Guaranteed, round-off, chosen" }
                dd {
                    "Where the allowed difference of a check comes from: a theorem, the accuracy of floating-point arithmetic, or a \
                    decision, where theory is silent."
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::report::page;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    fn svgs(page: &str) -> Vec<&str> {
        page.match_indices("<svg").map(|(i, _)| &page[i..i + page[i..].find("</svg>").unwrap() + 6]).collect()
    }

    #[test]
    fn the_page_stands_alone() {
        for verdict in [Verdict::Agree, Verdict::Disagree, Verdict::Infeasible, Verdict::Failed] {
            let text = page(&Sample::new(3, verdict).dossier());
            let without_names = text.replace("xmlns=\"http://www.w3.org/2000/svg\"", "").replace(super::SCRIPT, "");
            assert_eq!(without_names.matches("<script").count(), 1);
            for forbidden in ["http", "<script>\n", "<script ", "<link", "@import", "url(", "src="] {
                assert!(!without_names.contains(forbidden), "{forbidden}");
            }
            assert!(!text.contains("<a&b>") && text.contains("left &lt;a&amp;b&gt;"));
            for svg in svgs(&text) {
                assert_well_formed(svg);
                assert!(svg.contains("role=\"img\"") && svg.contains("aria-label=\""));
            }
        }
    }

    #[test]
    fn every_picture_of_a_full_dossier_is_there() {
        let text = page(&Sample::new(3, Verdict::Agree).dossier());
        // Three quantities, bracket, scene, two shapes, pressure, one map with the colours of its two kinds, history.
        assert_eq!(svgs(&text).len(), 12);
        assert_eq!(
            svgs(&page(&Sample::new(3, Verdict::Infeasible).dossier())).iter().filter(|s| s.contains("motion")).count(),
            1
        );
    }

    #[test]
    fn failing_checks_come_before_the_pictures() {
        let sample = Sample::new(2, Verdict::Disagree);
        let dossier = sample.dossier();
        let text = page(&dossier);
        let first = text.find("<main").unwrap();
        for check in dossier.report.checks.iter().filter(|c| !c.passed) {
            let name = crate::report::figure::escape(&check.name);
            assert!(text.find(&name).unwrap() < first, "{name}");
        }
        assert!(text.contains("no correct pair of solutions"));
        // Why they fail comes before what fails, and its place is marked in every picture of the bodies and of the contact.
        let cause = &dossier.report.causes[0];
        assert!(text.find(&cause.sentence[..40]).unwrap() < text.find("energy.order.P2").unwrap());
        assert_eq!(text.matches("class=\"place\" data-cause=\"1\"").count(), 5);
    }

    #[test]
    fn a_fine_mesh_makes_no_fat_page() {
        let text = page(&Sample::new(96, Verdict::Agree).dossier());
        assert!(text.len() < 1_000_000, "{}", text.len());
        // The largest mesh that is drawn triangle by triangle.
        let text = page(&Sample::new(44, Verdict::Agree).dossier());
        assert!(text.len() < 1_000_000, "{}", text.len());
    }
}
