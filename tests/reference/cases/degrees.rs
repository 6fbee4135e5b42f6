//! Displacements of higher degree on the same mesh: `--primal-degree`.

use serde_json::Value;

use super::run::{Run, case, with_reference};
use crate::command::{ended, hypercircle, run};

#[test]
fn higher_degrees_agree_and_come_closer_to_the_stresses() {
    // Where the direction of contact is constant, and where it turns.
    for scene in ["two_blocks", "ring"] {
        if !with_reference() {
            return;
        }
        let run = Run::new("verify", &case(scene), &["--primal-degree", "4,2,3", "--allow", "p3-above-p4=1e-9"]);
        assert_eq!(run.code, Some(0), "{scene}: {}{}", run.stdout, run.stderr);
        let report = run.report();
        assert!(report.failed().is_empty(), "{scene}: {:?}", report.failed());
        let models = report.0["primal"].as_array().expect("models");
        let degrees: Vec<u64> = models.iter().filter_map(|model| model["degree"].as_u64()).collect();
        assert_eq!(degrees, [2, 3, 4], "{scene}");
        assert!(models.iter().all(|model| model["admissible"] == true), "{scene}: {models:?}");
        let energies: Vec<f64> = models.iter().filter_map(|model| model["energy"].as_f64()).collect();
        assert!(energies.is_sorted_by(|a, b| a > b), "{scene}: {energies:?}");
        assert!(report.number("/energy/lower") < energies[2]);
        let has = |name: &str| report.0["checks"].as_array().into_iter().flatten().any(|c| c["name"] == name);
        for name in
            ["energy/p2-above-p3", "energy/p3-above-p4", "primal/equilibrium/FEniCSx P4", "admissible/FEniCSx P3"]
        {
            assert!(has(name), "{scene}: no {name}");
        }
        // Pressures of every model, and a reaction at every node of degree 4 where the direction is constant.
        let points = report.profile(0, "FEniCSx P4 reactions").len();
        let pairs = report.profile(0, "dual").len() / 2;
        assert_eq!(points, if scene == "ring" { 3 * pairs } else { 5 * pairs }, "{scene}");
        for (file, said) in [("report.html", "FEniCSx P4"), ("fields.vtu", "stress_FEniCSx_P4"), ("summary.md", "P4")] {
            assert!(run.file(file).contains(said), "{scene}: {file}");
        }
    }
}

#[test]
fn a_wrong_model_of_higher_degree_is_found() {
    for (scene, bug, check) in [
        ("two_blocks", "flip-sign", "primal/equilibrium/FEniCSx P3"),
        ("two_blocks", "drop-row", "admissible/FEniCSx P3"),
        ("ring", "flip-sign", "primal/equilibrium/FEniCSx P3"),
    ] {
        if !with_reference() {
            return;
        }
        let run = Run::new("verify", &case(scene), &["--primal-degree", "3", "--sabotage", bug]);
        assert_eq!(run.code, Some(1), "{scene}, {bug}: {}{}", run.stdout, run.stderr);
        let report = run.report();
        assert!(report.failed().contains(&check), "{scene}, {bug}: {:?}", report.failed());
        assert!(report.0["verdict"].as_str().is_some_and(|v| v.contains("FEniCSx P3")), "{}", report.0["verdict"]);
        let causes = report.0["causes"].to_string();
        assert_eq!(causes.contains("looked for in degrees 1 and 2"), bug == "flip-sign", "{causes}");
    }
}

/// Beside stresses of degree 2, displacements of degree 3: as `verify` has them on the same mesh.
#[test]
fn a_chart_has_rows_of_higher_degrees_where_they_are_asked_for() {
    if !with_reference() {
        return;
    }
    let alone = Run::new("verify", &case("two_blocks"), &["--primal-degree", "3"]);
    let energy = alone.report().0["primal"][0]["energy"].as_f64().expect("an energy");
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = hypercircle(folder.path(), ["chart"]);
    command.arg(case("two_blocks")).args(["--reduced", "--refine", "0", "--method", "condensed-p2"]);
    command.args(["--primal-degree", "3", "--quiet", "--out", "out"]);
    ended("chart", &run(command), 0, &[]);
    let chart = std::fs::read_to_string(folder.path().join("out/chart.json")).expect("written");
    let chart: Value = serde_json::from_str(&chart).expect("JSON");
    let runs = chart["scenes"][0]["runs"].as_array().expect("runs");
    let methods: Vec<&str> = runs.iter().filter_map(|run| run["method"].as_str()).collect();
    assert_eq!(methods, ["condensed-p2", "fenics-p3"]);
    let found = runs[1]["plot"]["upper"].as_f64().expect("an upper bound");
    assert!((found - energy).abs() < 1e-10 * energy.abs(), "{found} is not {energy}");
}
