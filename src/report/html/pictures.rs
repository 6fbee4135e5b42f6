//! The gallery: scene, shapes, pressures, maps.

use maud::{Markup, PreEscaped, html};

use crate::element::Displacement;
use crate::report::figure::{deformed, history, map, pressure, scene};
use crate::report::number::{clean, percent, significant};
use crate::report::vtu::von_mises;
use crate::report::{ContactSummary, Dossier};

pub(super) fn pictures(dossier: &Dossier) -> Markup {
    html! {
        section #pictures {
            h2 { "Pictures" }
            div.gallery {
                (scene_figure(dossier))
                @if let Some(motion) = &dossier.motion {
                    figure {
                        (PreEscaped(deformed::motion(dossier.problem, motion)))
                        figcaption {
                            b { "The motion that nothing stops. " }
                            "Neither supports nor contact resist it, and the loads do positive work on it: no stress can be in equilibrium. \
                            Dashed: before; its size is arbitrary."
                        }
                    }
                }
                @for contact in &dossier.report.contact { (pressure_figure(contact)) }
                (shapes(dossier))
                (maps(dossier))
                @if !dossier.report.history.is_empty() { (history_figure(dossier)) }
            }
        }
    }
}

fn scene_figure(dossier: &Dossier) -> Markup {
    html! {
        figure {
            (PreEscaped(scene::scene(dossier.problem)))
            figcaption {
                b { "The scene. " }
                "Hatching: held in place. Circles: free to slide along, not to leave or enter. Orange arrows: applied forces. Red: contact, \
                which can push but not pull."
                @match scene::gap_exaggeration(dossier.problem) {
                    Some(1.0) => " Dashed red: the other side of the initial gap.",
                    Some(factor) => { " Dashed red: the other side of the initial gap, drawn " (significant(factor, 3)) " times as wide." }
                    None => {}
                }
            }
        }
    }
}

fn shapes(dossier: &Dossier) -> Markup {
    let all: Vec<&Displacement> = dossier.displacements.iter().map(|(_, field)| *field).collect();
    let scale = deformed::deformation_scale(dossier.problem, &all);
    let gap = dossier.problem.pairs().flat_map(|p| p.gap).any(|g| g > 0.0);
    html! {
        @for (name, field) in &dossier.displacements {
            @let name = if name == "free" { "from the dual model (free upper bound)".to_string() } else { clean(name) };
            figure {
                (PreEscaped(deformed::deformed(dossier.problem, &name, field, &all, scale)))
                figcaption {
                    b { "Deformed shape, " (name) ". " }
                    "Displacements times " b { (significant(scale, 3)) } ". Dashed grey: undeformed. Red: the two sides of the contact; where they part, \
                    it has opened."
                    @if gap && scale > 1.0 {
                        " The bodies start with a gap that is not drawn to this scale, so the sides may seem to overlap."
                    }
                }
            }
        }
    }
}

fn pressure_figure(contact: &ContactSummary) -> Markup {
    html! {
        figure {
            (PreEscaped(pressure::pressure(contact)))
            figcaption {
                b { "Pressure on " code { (clean(&contact.name)) } ". " }
                "The dual pressure may jump from edge to edge. Zero: the contact is open; it is open on "
                (percent(contact.open_fraction)) " of its length."
                @if !contact.contact_ends.is_empty() { " Dotted upright: end of contact." }
            }
        }
    }
}

fn maps(dossier: &Dossier) -> Markup {
    let problem = dossier.problem;
    let triangles = problem.mesh.triangles.len();
    let own = dossier.maps.iter().any(|map| map.key.contains("von_mises"));
    let dual = dossier.dual.filter(|dual| !own && dual.stress.len() == triangles);
    let coarse = if map::is_coarsened(problem) { " Each cell shows the largest value in it." } else { "" };
    html! {
        @if let Some(dual) = dual {
            @let values: Vec<f64> = (0..triangles).map(|t| von_mises(problem, t, dual.stress.mean(t))).collect();
            figure {
                (PreEscaped(map::map(problem, "Von Mises stress", &values)))
                figcaption { b { "Von Mises stress " } "of the dual model, of the mean over each triangle." (coarse) }
            }
        }
        @for field in &dossier.maps {
            figure {
                (PreEscaped(map::map(problem, &field.title, &field.values)))
                figcaption { b { (clean(&field.title)) ". " } (explanation(field.key)) (coarse) }
            }
        }
    }
}

/// What a map shows, where its key says so.
fn explanation(key: &str) -> &'static str {
    if key.contains("quantity") {
        "What each triangle adds to the width of the widest interval, relative to all of it."
    } else if key.contains("difference") {
        "How far the stresses of the two models are apart, triangle by triangle."
    } else if key.contains("contribution") || key.contains("error") || key.contains("gap") {
        "What each triangle adds to the width of the bracket: light triangles are where a finer mesh pays."
    } else if key.contains("residual") {
        "What equilibrium misses at the nodes of each triangle, relative to the whole: next to nothing everywhere for a discrete solution."
    } else {
        ""
    }
}

fn history_figure(dossier: &Dossier) -> Markup {
    html! {
        figure {
            (PreEscaped(history::history(&dossier.report.history)))
            figcaption {
                b { "Adaptive refinement. " }
                "Guaranteed error of each mesh; every mesh was refined where the one before contributed most."
            }
        }
    }
}
