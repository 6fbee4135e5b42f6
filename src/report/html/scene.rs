//! The computed scene, in words and numbers.

use maud::{Markup, html};

use crate::elasticity::{Anisotropic, Elasticity, Matrix, Orthotropic};
use crate::load::{BodyForce, Rotation};
use crate::problem::Problem;
use crate::report::text::number::{clean, grouped, significant, vector};
use crate::report::{Dossier, Report};
use crate::scene::{Affine, Gap, Kinematics, Load, Scene, SupportKind};

/// The state of strain in words, and the thickness where there is one.
fn state(scene: &Scene) -> String {
    match scene.kinematics {
        Kinematics::Axisymmetric => {
            "body of revolution: points are (r, z), energies and forces those of the full turn".to_string()
        }
        kinematics => format!("{}, thickness {}", kinematics.words(), significant(scene.thickness, 6)),
    }
}

/// The box with everything a reader has to know of the scene.
pub(super) fn card(dossier: &Dossier) -> Markup {
    let (report, problem) = (&dossier.report, dossier.problem);
    let scene = &problem.scene;
    html! {
        section.card #scene aria-label="the scene in numbers" {
            h2 { "What was computed" }
            dl.scene {
                dt { "State" } dd { (state(scene)) "; units as in the scene" }
                dt { "Materials" }
                dd { ul { @for body in &scene.bodies { li {
                    bdi { (clean(&body.name)) } ": " (elasticity(&body.elasticity))
                    (force(&body.body_force))
                } } } }
                dt { "Loads" } dd { (loads(scene)) }
                dt { "Supports" } dd { (supports(scene)) }
                @if !scene.contacts.is_empty() { dt { "Contact" } dd { (contacts(problem)) } }
                @if !scene.bonds.is_empty() { dt { "Bonds" } dd { (bonds(scene)) } }
                dt { "Mesh" } dd { (counts(report, problem)) }
                @if !report.provenance.command_line.is_empty() {
                    dt { "Command" } dd { code { (clean(&report.provenance.command_line)) } }
                }
                dt { "Made" } dd { (report.provenance.date) " by hypercircle " (clean(&report.provenance.version)) }
            }
        }
    }
}

/// The constants of a material.
fn elasticity(law: &Elasticity) -> String {
    let list = |values: &[f64]| values.iter().map(|x| significant(*x, 6)).collect::<Vec<_>>().join(", ");
    match law {
        Elasticity::Isotropic { young, poisson } => {
            format!("E = {}, ν = {}", significant(*young, 6), significant(*poisson, 6))
        }
        Elasticity::Orthotropic(Orthotropic { young, poisson, shear, angle }) => format!(
            "orthotropic, E₁, E₂, E₃ = {}; ν₁₂, ν₁₃, ν₂₃ = {}; G₁₂ = {}; axis 1 at {}° to x",
            list(young),
            list(poisson),
            significant(*shear, 6),
            significant(*angle, 6)
        ),
        Elasticity::Anisotropic(Anisotropic { kind, matrix, angle }) => {
            let rows = match matrix {
                Matrix::Three(rows) => rows.iter().map(|row| list(row)).collect::<Vec<_>>(),
                Matrix::Six(rows) => rows.iter().map(|row| list(row)).collect(),
            };
            format!("{} ({}), axis 1 at {}° to x", kind.key(), rows.join("; "), significant(*angle, 6))
        }
    }
}

fn loads(scene: &Scene) -> Markup {
    let forces = scene.bodies.iter().any(|body| !body.body_force.is_none());
    html! {
        @if scene.tractions.is_empty() { (if forces { "body forces alone" } else { "none" }) } @else {
            ul { @for traction in &scene.tractions { li {
                bdi { (clean(&traction.on)) } ": "
                @match traction.load {
                    Load::Pressure(p) => { "pressure " (significant(p, 5)) }
                    Load::Affine(load) => (affine(load)),
                }
                @for term in &traction.terms {
                    " + (" (significant(term.value[0], 5)) ", " (significant(term.value[1], 5)) ") "
                    "x" sup { (term.powers[0]) } "y" sup { (term.powers[1]) }
                }
            } } }
        }
    }
}

fn force(force: &BodyForce) -> Markup {
    html! {
        @if force.given() != Affine::default() { ", body force " (affine(force.given())) }
        @if let Some(Rotation { density, omega, about }) = force.rotation() {
            ", turning about "
            @if force.is_about_line() { "the axis" } @else { (vector(about, 5)) }
            " with ω = " (significant(omega, 5)) ", ϱ = " (significant(density, 5))
        }
    }
}

fn affine(Affine { value, gradient }: Affine) -> Markup {
    html! {
        (vector(value, 5))
        @if gradient != [[0.0; 2]; 2] { " + [" (vector(gradient[0], 5)) ", " (vector(gradient[1], 5)) "] · x" }
    }
}

fn supports(scene: &Scene) -> Markup {
    html! {
        @if scene.supports.is_empty() { "none" } @else {
            ul { @for support in &scene.supports { li {
                bdi { (clean(&support.on)) } ": "
                @match support.kind {
                    SupportKind::Clamped { displacement } if displacement == Affine::default() => "clamped",
                    SupportKind::Clamped { displacement } => { "clamped, moved by " (affine(displacement)) }
                    SupportKind::Spring { stiffness: [normal, tangential] } => {
                        "springs of stiffness " (significant(normal, 5)) " along the normal, "
                        @if tangential == 0.0 { "none along the boundary" } @else { (significant(tangential, 5)) " along the boundary" }
                    }
                    SupportKind::Roller { direction, displacement } => {
                        "roller"
                        @if let Some(d) = direction { " that holds along " (vector(d, 5)) }
                        @if displacement != 0.0 {
                            ", moved by " (significant(displacement, 5)) (if direction.is_none() { " along its normal" } else { "" })
                        }
                    }
                }
            } } }
        }
    }
}

fn contacts(problem: &Problem) -> Markup {
    html! {
        ul { @for (contact, interface) in problem.scene.contacts.iter().zip(&problem.interfaces) { li {
            bdi { code { (clean(&interface.name)) } } ": " (grouped(interface.pairs.len())) (if interface.pairs.len() == 1 { " pair" } else { " pairs" }) " of edges, gap "
            @match &contact.gap {
                _ if contact.obstacle.is_some() => { "to an obstacle with a place of its own" }
                Gap::Constant(g) => (significant(*g, 5)),
                Gap::Table(rows) => { "from a table of " (rows.len()) " rows" }
                Gap::Circle(touching) => { "of a circle of radius " (significant(touching.radius, 5)) }
                Gap::Parabola(touching) => { "of a parabola of radius " (significant(touching.radius, 5)) }
            }
            @if contact.direction.is_some() { ", matched along a direction" }
            @if let Some(k) = contact.stiffness { ", elastic with the stiffness " (significant(k, 5)) }
        } } }
    }
}

fn bonds(scene: &Scene) -> Markup {
    html! {
        ul { @for bond in &scene.bonds { li { bdi { code { (clean(&bond.name())) } } ": "
            @match bond.stiffness {
                None => "glued",
                Some([normal, tangential]) => {
                    "an elastic layer of stiffness " (significant(normal, 5)) " along the normal, " (significant(tangential, 5)) " along the sides"
                }
            }
        } } }
    }
}

fn counts(report: &Report, problem: &Problem) -> Markup {
    let mesh = &problem.mesh;
    html! {
        (grouped(mesh.triangles.len())) " triangles, " (grouped(mesh.points.len())) " vertices"
        @if let Some(dual) = &report.dual {
            ", " (grouped(dual.unknowns)) " unknowns in stresses of degree " (dual.degree_min)
            @if dual.degree_max > dual.degree_min { " to " (dual.degree_max) }
        }
        @for primal in &report.primal { @if let Some(unknowns) = primal.unknowns {
            ", " (grouped(unknowns)) " in " (clean(&primal.name))
        } }
    }
}
