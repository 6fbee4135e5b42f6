//! A disc in its bore: it turns freely, and rests where it is pressed through its centre. A ring on a pin, which turns freely about the
//! centre of both alone.

use std::f64::consts::PI;

use super::run::{Run, close, with_reference};
use crate::arcs::{disc, ring_on_pin};

fn written(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("disc.toml");
    std::fs::write(&path, text).expect("written");
    (folder, path)
}

#[test]
fn turned_by_a_couple_there_is_no_equilibrium() {
    let (_folder, scene) = written(&disc(24, "couple", "smooth"));
    for command in ["solve", "verify"] {
        let run = Run::new(command, &scene, &[]);
        assert_eq!(run.code, Some(5), "{}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains("turns counter-clockwise about (0, 0)"), "{}", run.stderr);
        assert_eq!(run.report().0["status"], "infeasible");
    }
}

#[test]
fn pressed_through_its_centre_both_models_agree() {
    let (_folder, scene) = written(&disc(24, "force", "smooth"));
    let run = Run::new(if with_reference() { "verify" } else { "solve" }, &scene, &[]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(report.0["status"], "agree");
    assert_eq!(report.0["energy"]["guaranteed"], true);
    // Weight 0.1 on the ring of 24 facets between radii ½ and 1.
    let weight = 0.1 * 12.0 * 0.75 * (std::f64::consts::TAU / 24.0).sin();
    let force = [0, 1].map(|c| report.number(&format!("/contact/0/resultant/dual/{c}")));
    assert!(force[0].abs() < 1e-9 * weight && (force[1] - weight).abs() < 1e-9 * weight, "{force:?} for {weight}");
}

/// Vertices that refinement moves to the circle here and there would shift the centre of the weight, and turn the disc.
#[test]
fn refined_towards_a_tolerance_it_stays_at_rest() {
    let (_folder, scene) = written(&disc(24, "force", "smooth"));
    for adapt in ["h", "hp"] {
        let run = Run::new("solve", &scene, &["--tolerance", "0.02", "--adapt", adapt, "--max-triangles", "4000"]);
        assert_eq!(run.code, Some(0), "{adapt}: {}{}", run.stdout, run.stderr);
        let report = run.report();
        assert!(report.number("/energy/relative_error_bound") <= 0.02, "{adapt}");
        assert!(report.notes().contains("slides freely along it"), "{}", report.notes());
    }
}

/// What nothing holds but an overlap has a size all the same, and what the vertices of P1 leave free those of P2 hinder.
#[test]
fn on_a_pin_beside_its_centre_both_models_agree() {
    for centre in [[0.0, 0.0], [1e-5, 2e-5], [-0.2, 0.1]] {
        let (_folder, scene) = written(&ring_on_pin(centre));
        let run = Run::new(if with_reference() { "verify" } else { "solve" }, &scene, &[]);
        assert_eq!(run.code, Some(0), "{centre:?}: {}{}", run.stdout, run.stderr);
    }
}

/// Friction carries nothing, and along the contact displacements are rounding errors of those elsewhere. Of Lamé: σ_r = A − B/r² with no
/// displacement at the pin, B = −(1 − 2ν) A, and −p at the rim.
#[test]
fn pressed_on_its_pin_all_around_it_sticks() {
    if !with_reference() {
        return;
    }
    let text = ring_on_pin([0.0; 2]).replace("radius = 1.01", "radius = 1.0")
        + "friction = { bound = 0.01 }\n[[tractions]]\non = \"rim\"\npressure = 0.1\n";
    let (_folder, scene) = written(&text);
    let run = Run::new("verify", &scene, &[]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let (young, nu, pressure) = (1.0, 0.3, 0.1);
    let a = -pressure / (1.0 + (1.0 - 2.0 * nu) / 4.0);
    let moved = (1.0 + nu) / young * (1.0 - 2.0 * nu) * a * (2.0 - 0.5);
    // The polygon has 1.1 % less area than the disc.
    close(run.report().number("/energy/lower"), 0.5 * pressure * 2.0 * PI * 2.0 * moved, 0.02);
}

/// Linear displacements meet contact at vertices alone where it turns: their energy with Coulomb friction may lie below that of none.
#[test]
fn with_coulomb_friction_linear_displacements_are_not_blamed() {
    if !with_reference() {
        return;
    }
    let text = "model.kinematics = \"plane-strain\"\nmesh.file = \"disc_in_ring.msh\"\nbodies.b = { young = 1.0, poisson = 0.3 }\n\
                bodies.a = { young = 1.0, poisson = 0.3, body_force = [0.0, -0.005] }\n\
                supports = [{ on = \"wall\", type = \"clamped\" }]\n\
                contacts = [{ between = [\"rim\", \"bore\"], gap = -0.01, friction = { coefficient = 0.3 } }]\n";
    let (folder, scene) = written(text);
    let mesh = include_str!("../../support/scenes/disc_in_ring.msh");
    std::fs::write(folder.path().join("disc_in_ring.msh"), mesh).expect("written");
    let run = Run::new("verify", &scene, &[]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let report = run.report().0.to_string();
    assert!(report.contains("coulomb/FEniCSx P1/friction-force"), "{report}");
}
