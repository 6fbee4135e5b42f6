//! Cases whose contact forces follow from equilibrium alone.

use serde_json::Value;

use super::run::{Report, Run, carries, case, close, models, sound, turns, with_reference};

#[test]
fn two_blocks() {
    let report = sound("two_blocks");
    // ∫ (4 − 7y) dy = ½.
    carries(&report, 0, [-0.5, 0.0]);
    // The energy of finer meshes, bracketed independently of this program.
    assert!(report.number("/energy/lower") < -1.7964083583 && report.number("/energy/upper") > -1.7964189504);
    // The load pulls at the top: contact ends once, near y = 0.6, and is open above.
    let ends = report.0["contact"][0]["contact_ends"].as_array().expect("a list").clone();
    assert_eq!(ends.len(), 1);
    assert!((ends[0].as_f64().expect("a number") - 0.6).abs() < 0.125, "{ends:?}");
    for [arc, pressure] in report.profile(0, "dual") {
        assert!(if arc < 0.45 { pressure > 0.0 } else { arc < 0.75 || pressure.abs() < 1e-9 }, "{arc}: {pressure}");
    }
}

#[test]
fn dam() {
    let report = sound("dam");
    let expected = [-50.0, 96.0, 50.0 * 10.0 / 3.0 - 96.0 * 16.0 / 3.0];
    for (quantity, expected) in expected.into_iter().enumerate() {
        close(report.number(&format!("/quantities/{quantity}/value")), expected, 1e-11);
        assert_eq!(report.0["quantities"][quantity]["exact_by_statics"], true);
        for model in 0..if with_reference() { 2 } else { 0 } {
            close(report.number(&format!("/quantities/{quantity}/primal/{model}/value")), expected, 1e-9);
        }
    }
}

#[test]
fn inclined() {
    let report = sound("inclined");
    // Frictionless: the force is normal to a slope of 1 in 2, and its vertical part carries the load.
    carries(&report, 0, [-1.0, 2.0]);
}

#[test]
fn sliding() {
    let report = sound("sliding");
    carries(&report, 0, [0.0, 1.0]);
    // ∫ x (x − ½) dx over [1, 2].
    turns(&report, 0, 19.0 / 12.0);
    let notes = report.notes();
    assert!(notes.contains("`block` slides along its contact"), "{notes}");
}

#[test]
fn stack() {
    let report = sound("stack");
    let load = 2.0 * 1.0 * 0.2;
    let weight = 0.4 * 2.0 * 0.5 * 0.2;
    carries(&report, 0, [0.0, load]);
    carries(&report, 1, [0.0, load + weight]);
    // The plate is free: what its two contacts and its weight, at x = 1.5, turn it by adds up to nothing.
    for model in models() {
        let moment = |i| report.number(&format!("/contact/{i}/moment/{model}"));
        close(moment(1), moment(0) + 1.5 * weight, 1e-9);
    }
}

#[test]
fn seal() {
    let report = sound("seal");
    // A pressure of 0.2 on 0.75.
    carries(&report, 0, [0.0, -0.15]);
    if with_reference() {
        // Linear displacements lock: they miss more of the exact energy than the bracket leaves open.
        let [lower, upper] = ["lower", "upper"].map(|key| report.number(&format!("/energy/{key}")));
        let [p1, p2] = [0, 1].map(|i| report.number(&format!("/primal/{i}/energy")));
        assert!(p1 - upper > 10.0 * (upper - lower) && p2 - lower < 2.0 * (upper - lower), "{lower} {upper} {p1} {p2}");
    }
}

#[test]
fn gravity() {
    let report = sound("gravity");
    carries(&report, 0, [0.0, 2.0]);
    turns(&report, 0, 2.0 * 1.0);
    carries(&report, 1, [0.0, 3.5]);
    turns(&report, 1, 2.0 * 1.0 + 1.5 * 1.5);
    assert!(report.number("/energy/upper") < 0.0);
}

#[test]
fn from_gmsh() {
    let report = sound("from_gmsh");
    carries(&report, 0, [0.0, 2.0 * 0.7 * 3.0]);
    let notes = report.notes();
    for side in ["vertices of 'foot' inserted into 'seat'", "vertices of 'seat' inserted into 'foot'"] {
        assert!(notes.contains(side), "{notes}");
    }
    if with_reference() {
        assert!(report.number("/contact/0/pressure_l2_difference") < 0.1);
    }
}

/// Each face carries N = P/(2 (sin α + μ cos α)) across it and μ N along it, by stresses, by displacements with the same bound of
/// friction, and by displacements with limits of their own.
#[test]
fn wedges() {
    for (name, mu) in [("wedge", 0.2), ("wedge_locked", 0.5)] {
        let report = sound(name);
        let (sin, cos) = 20.0_f64.to_radians().sin_cos();
        let normal = 0.01 * 2.0 * 0.6639702342662023 / (2.0 * (sin + mu * cos));
        for (contact, side) in [(0, 1.0), (1, -1.0)] {
            carries(&report, contact, [side * normal * (cos - mu * sin), normal * (sin + mu * cos)]);
            let along = report.number(&format!("/contact/{contact}/friction/force"));
            close(along, -side * mu * normal, 1e-7);
            assert_eq!(report.0["contact"][contact]["friction"]["kind"], "coulomb");
            assert!(report.number(&format!("/contact/{contact}/friction/bound_distance/relative")) < 1e-7);
        }
        assert_eq!(report.0["energy"]["guaranteed_for"], "friction bound");
        let wedging = report.0["coulomb"]["wedging"].as_array().map_or(0, Vec::len);
        assert_eq!(wedging, usize::from(mu > (sin / cos)));
        if with_reference() {
            let own = |check: &&Value| check["name"].as_str().is_some_and(|n| n.ends_with("/friction-force"));
            let own: Vec<&Value> = report.0["remarks"].as_array().into_iter().flatten().filter(own).collect();
            assert_eq!(own.len(), 2);
            assert!(own.iter().all(|check| check["difference"].as_f64().is_some_and(|d| d < 1e-6)), "{own:?}");
        }
    }
}

/// Comparisons with FEniCSx on the contact, where the direction is constant and where it turns: above all `reactions`, which
/// asks that each force at a vertex differ from the dual one by the work of the stresses to round-off.
#[test]
fn contact_of_every_degree() {
    if !with_reference() {
        return;
    }
    for (name, degree) in [("two_blocks", "2"), ("two_blocks", "5"), ("inclined", "3"), ("ring", "2")] {
        let report = Run::new("verify", &case(name), &["--degree", degree]).report();
        for end in ["min", "max"] {
            assert_eq!(report.0["dual"][format!("degree_{end}")].to_string(), degree);
        }
        let of_contact = |c: &&Value| c["name"].as_str().is_some_and(|n| n.starts_with("contact/"));
        let checks: Vec<&Value> = report.0["checks"].as_array().into_iter().flatten().filter(of_contact).collect();
        assert!(checks.len() >= 3, "{checks:?}");
        for check in checks {
            assert_eq!(check["passed"], true, "{name}, degree {degree}: {check}");
        }
        if name == "two_blocks" {
            carries(&report, 0, [-0.5, 0.0]);
        }
    }
}

/// A block pushed along its base: what friction carries, and where the sides stick.
fn pushed(name: &str, friction: f64) -> Report {
    let report = sound(name);
    carries(&report, 0, [friction, 1.0]);
    close(report.number("/contact/0/friction/force"), friction, 1e-9);
    let [low, high] = ["lower", "upper"].map(|end| report.number(&format!("/quantities/0/{end}")));
    assert!(low <= friction + 1e-12 && friction - 1e-12 <= high, "{low} {high}");
    report
}

#[test]
fn pushed_blocks_stick_and_slide() {
    let stuck = pushed("pushed_sticks", -0.2);
    close(stuck.number("/contact/0/friction/stick_fraction"), 1.0, 1e-9);
    // Glued on, the block is no other.
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("pushed_sticks")).expect("readable");
    let glued = text.split("[[quantities]]").next().expect("a scene").replace("[[contacts]]", "[[bonds]]");
    let path = folder.path().join("glued.toml");
    std::fs::write(&path, glued.replace("friction = { bound = 5.0 }", "")).expect("writable");
    let glued = Run::new("solve", &path, &[]).report();
    close(glued.number("/energy/lower"), stuck.number("/energy/lower"), 1e-9);

    let partly = pushed("pushed_partly", -0.2);
    let fraction = |of: &str| partly.number(&format!("/contact/0/friction/{of}_fraction"));
    assert!(fraction("stick") > 0.1 && fraction("slip") > 0.1);
    // It gives way as much as its bound says, and not more.
    assert!(partly.number("/energy/lower") < stuck.number("/energy/upper"));

    let sliding = pushed("pushed_slides", -0.06);
    close(sliding.number("/contact/0/friction/slip_fraction"), 1.0, 1e-9);
}
