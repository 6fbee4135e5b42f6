//! The gallery: scene, shapes, pressures, maps.

use maud::{Markup, PreEscaped, html};

use super::links;
use super::tables::scroll;
use crate::element::Displacement;
use crate::report::figure::drawn::Drawn;
use crate::report::figure::mark::{Mark, marks};
use crate::report::figure::{deformed, friction, history, pressure, scene};
use crate::report::text::number::{clean, optional, percent, significant};
use crate::report::{ContactSummary, Dossier};

pub(super) fn pictures(dossier: &Dossier) -> Markup {
    let marks = marks(dossier.problem, &dossier.report);
    html! {
        section #pictures {
            h2 { "Pictures" }
            div.gallery {
                (scene_figure(dossier, &marks))
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
                @for i in 0..dossier.report.contact.len() { (pressure_figure(dossier, i)) }
                (super::map::figure(dossier, &marks))
                (shapes(dossier, &marks))
                @if !dossier.report.history.is_empty() { (history_figure(dossier)) }
            }
        }
    }
}

fn scene_figure(dossier: &Dossier, marks: &[Mark]) -> Markup {
    html! {
        figure #scene-picture {
            (PreEscaped(scene::scene(dossier.problem, marks)))
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

fn shapes(dossier: &Dossier, marks: &[Mark]) -> Markup {
    let all: Vec<&Displacement> = dossier.displacements.iter().map(|(_, field)| *field).collect();
    let drawn = Drawn::of(dossier.problem, &all);
    html! {
        @for (i, (name, field)) in dossier.displacements.iter().enumerate() {
            @let name = if name == "free" { "from the dual model (free upper bound)".to_string() } else { clean(name) };
            figure id=[(i == 0).then_some("shapes")] {
                (PreEscaped(deformed::deformed(dossier.problem, &name, field, &all, &drawn, marks)))
                figcaption {
                    b { "Deformed shape, " (name) ". " }
                    "Displacements times " b { (significant(drawn.scale, 3)) } ". Dashed grey: undeformed. Red: the two sides of the contact; where they part, \
                    it has opened."
                    @if drawn.gaps_scaled { " Bodies that a gap separates are drawn as many times as far apart." }
                    @if drawn.held_back { " A larger picture would show bodies that do not penetrate as if they did." }
                    @if i == 0 { (links::checks_of("shapes", &dossier.report)) }
                }
            }
        }
    }
}

fn pressure_figure(dossier: &Dossier, index: usize) -> Markup {
    let contact = &dossier.report.contact[index];
    let [from, to] = pressure::extent(contact);
    let (id, marks) = (format!("pressure-{index}"), arc_marks(dossier, index));
    html! {
        figure id=(id) {
            (PreEscaped(pressure::pressure(contact, &marks)))
            @if let Some(drawn) = friction::friction(contact, &marks) { (PreEscaped(drawn)) }
            figcaption {
                b { "Pressure on " bdi { code { (clean(&contact.name)) } } ". " }
                "The dual pressure may jump from edge to edge. Zero: the contact is open; it is open on "
                (percent(contact.open_fraction)) " of its length."
                @if !contact.contact_ends.is_empty() { " Dotted vertical line: end of contact." }
                @if to - from < contact.length {
                    " Shown from " (significant(from, 4)) " to " (significant(to, 4)) " of the length " (significant(contact.length, 4))
                    "; no model has a pressure beyond."
                }
                (friction_caption(contact))
                (pressures(contact, [from, to]))
                (links::checks_of(&id, &dossier.report))
            }
        }
    }
}

/// Explains the strip of states and the tangential traction.
fn friction_caption(contact: &ContactSummary) -> Markup {
    html! {
        @if let Some(friction) = &contact.friction {
            " " b { "Friction. " }
            "The sides stick on " (percent(friction.stick_fraction)) " of the length. They slide, or may begin to, on "
            (percent(friction.slip_fraction)) ": there the tangential traction of the dual solution is at its bound. It adds up to "
            (significant(friction.force, 4)) " on the first side, positive along its arc length."
        }
    }
}

/// The pressures of all models at equal distances along a contact.
fn pressures(contact: &ContactSummary, [from, to]: [f64; 2]) -> Markup {
    const ROWS: usize = 16;
    let at = |k: usize| from + (to - from) * k as f64 / ROWS as f64;
    html! {
        @if !contact.profiles.is_empty() && to > from {
            details {
                summary { "Values" }
                (scroll("pressures along the contact", html! { table {
                    thead { tr { th.n { "arc length" } @for profile in &contact.profiles { th.n { (clean(&profile.model)) } } } }
                    tbody { @for k in 0..=ROWS { tr {
                        td.n { (significant(at(k), 4)) }
                        @for profile in &contact.profiles { td.n { (optional(value(&profile.points, at(k)), 4)) } }
                    } } }
                } }))
            }
        }
    }
}

/// A pressure at arc length `s`, between the points around it; at a jump the first of the two.
fn value(points: &[[f64; 2]], s: f64) -> Option<f64> {
    let pair = points.windows(2).find(|w| w[0][0] <= s && s <= w[1][0] && w[1][0] > w[0][0])?;
    let part = (s - pair[0][0]) / (pair[1][0] - pair[0][0]);
    Some((1.0 - part) * pair[0][1] + part * pair[1][1])
}

/// The marks that are on contact `index`, by arc length.
fn arc_marks(dossier: &Dossier, index: usize) -> Vec<(f64, usize)> {
    let Some(interface) = dossier.problem.interfaces.get(index) else { return Vec::new() };
    let points = &dossier.problem.mesh.points;
    let on = |at: [f64; 2]| {
        interface.pairs.iter().find_map(|pair| {
            let [a, b] = pair.first.map(|v| points[v]);
            let along = [b[0] - a[0], b[1] - a[1]];
            let part = ((at[0] - a[0]) * along[0] + (at[1] - a[1]) * along[1]) / (along[0].powi(2) + along[1].powi(2));
            let off = [0, 1].map(|c| at[c] - a[c] - part * along[c]);
            let near = (-1e-6..=1.000_001).contains(&part) && off[0].hypot(off[1]) <= 1e-6 * pair.length;
            near.then(|| pair.arc[0] + part * (pair.arc[1] - pair.arc[0]))
        })
    };
    let all = marks(dossier.problem, &dossier.report);
    all.into_iter().filter_map(|mark| Some((on(mark.at)?, mark.number))).collect()
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
