//! A scene far from the point (0, 0) is solved as well as the same scene there.

use super::run::{Place, case};
use crate::command::{ended, said, with_reference};
use crate::malformed_meshes::{BLOCKS, SCENE};

/// `two_blocks` moved by whole numbers, its load with it.
fn moved(by: [f64; 2]) -> String {
    let text = case("two_blocks");
    let mut scene = String::new();
    for line in text.lines() {
        let line = match line.strip_prefix("points = ") {
            Some(list) => {
                let points: Vec<[f64; 2]> = serde_json::from_str(list).expect("points");
                let points: Vec<_> = points.iter().map(|p| [p[0] + by[0], p[1] + by[1]]).collect();
                format!("points = {points:?}")
            }
            None if line == "value = [4.0, 0.0]" => format!("value = [{:?}, 0.0]", 4.0 + 7.0 * by[1]),
            None => line.to_string(),
        };
        scene.push_str(&line);
        scene.push('\n');
    }
    scene
}

#[test]
fn a_scene_far_away_keeps_its_digits() {
    let run = |by: [f64; 2], command: &str| {
        let place = Place::with(&moved(by));
        let output = place.run(&[command, "scene.toml", "--out", "out"]);
        let told = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(0), "{by:?}: {told}{}", said(&output));
        place
    };
    let number = |place: &Place, path: &str| {
        let report = place.report("out");
        report.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{path} in {report}"))
    };
    let near = run([0.0, 0.0], "solve");
    for by in [[1e4, -3e4], [2e8, 0.0], [-1e8, 3e8], [4e14, 1e14]] {
        let far = run(by, "solve");
        for path in ["/energy/lower", "/energy/upper", "/contact/0/resultant/dual/0", "/contact/0/pressure_max/dual"] {
            let (a, b) = (number(&near, path), number(&far, path));
            assert!((a - b).abs() < 1e-10 * a.abs(), "{by:?}, {path}: {b} for {a}");
        }
        assert!(number(&far, "/dual/equilibrium_residual") < 1e-11);
        assert_eq!(far.report("out")["energy"]["guaranteed"], true);
        // Places are those of the file: the pressure has its maximum at the lower end of the contact, x = 1.
        let x = number(&far, "/contact/0/pressure_max_at/dual/0");
        assert_eq!(x, 1.0 + by[0], "{by:?}");
        // The moment of the contact force is about (0, 0).
        let moment = number(&near, "/contact/0/moment/dual") + by[0] * number(&near, "/contact/0/resultant/dual/1")
            - by[1] * number(&near, "/contact/0/resultant/dual/0");
        let found = number(&far, "/contact/0/moment/dual");
        assert!((found - moment).abs() <= 1e-9 * moment.abs().max(1.0), "{by:?}: {found} for {moment}");
        let said = far.report("out")["notes"].to_string().contains("neighbouring numbers");
        assert_eq!(said, by[0].abs() > 1e6, "{by:?}");
    }
    if with_reference() {
        let far = run([-1e8, 3e8], "verify");
        assert_eq!(far.report("out")["status"], "agree");
    }
}

#[test]
fn messages_name_the_places_of_the_file() {
    let scene = moved([1e8, 0.0]).replace("[100000001.0, 0.0], [100000002.0", "[100000001.5, 0.0], [100000002.0");
    let place = Place::with(&scene);
    place.refuses(&["solve", "scene.toml"], &["(10000000"]);
}

/// The nodes of [`BLOCKS`] moved.
fn moved_nodes(by: [f64; 2]) -> String {
    let (head, rest) = BLOCKS.split_once("$Nodes\n8\n").expect("nodes");
    let (nodes, tail) = rest.split_once("$EndNodes").expect("nodes");
    let moved = nodes.lines().map(|line| {
        let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().expect("a number")).collect();
        format!("{} {:?} {:?} 0\n", numbers[0], numbers[1] + by[0], numbers[2] + by[1])
    });
    format!("{head}$Nodes\n8\n{}$EndNodes{tail}", moved.collect::<String>())
}

#[test]
fn a_mesh_file_far_away_keeps_its_digits() {
    let report = |by: [f64; 2]| {
        let place = Place::with(SCENE);
        place.write("blocks.msh", &moved_nodes(by));
        ended(&format!("{by:?}"), &place.run(&["solve", "scene.toml", "--refine", "2", "--out", "out"]), 0, &[]);
        place.report("out")
    };
    let near = report([0.0, 0.0]);
    for by in [[2e8, 0.0], [-1e8, 3e8], [4e14, 1e14]] {
        let far = report(by);
        for path in ["/energy/lower", "/energy/upper", "/contact/0/resultant/dual/0"] {
            let number = |report: &serde_json::Value| report.pointer(path).and_then(|n| n.as_f64()).expect("a number");
            let (a, b) = (number(&near), number(&far));
            assert!((a - b).abs() < 1e-10 * a.abs(), "{by:?}, {path}: {b} for {a}");
        }
    }
}
