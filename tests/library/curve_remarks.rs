//! Remarks of a report on the polygon and the curve that it represents.

use crate::arcs::between_arcs;
use crate::circular_gap::foot;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::report::HistoryRow;
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, certify, curve_remarks};

fn solved(problem: Problem) -> Certified {
    certify(problem, &Condensed::default(), &Options::default()).expect("solves")
}

fn remarks(certified: &Certified, history: &[HistoryRow]) -> Vec<String> {
    curve_remarks(certified, history).into_iter().map(|note| note.text).collect()
}

/// A mesh with the bracket [`lower`, `upper`].
fn row(triangles: usize, lower: f64, upper: f64) -> HistoryRow {
    HistoryRow {
        triangles,
        unknowns: 4 * triangles,
        lower,
        upper,
        relative_error_bound: 0.1,
        seconds: 1.0,
        step_seconds: 1.0,
        rate: None,
    }
}

#[test]
fn the_last_step_of_an_adaptive_run_is_told_on_curves_alone() {
    let history = [row(10, -9.0, 9.0), row(100, -3.0, -1.0), row(240, -1.7, -1.5)];
    let told = "from 100 to 240 triangles the middle of the bracket moved by 0.4, 25 % of itself";
    let curved = Scene::parse(&between_arcs(0.12), "scene.toml".as_ref()).expect("a scene");
    let curved = solved(Problem::load(curved).expect("a mesh"));
    let said = remarks(&curved, &history);
    assert!(said.len() == 1 && said[0].contains(told), "{said:?}");
    assert!(remarks(&curved, &history[..1]).is_empty(), "one mesh has no step");
    // Gaps are what they are on every mesh.
    for gap in ["{ parabola = 50, at = 0 }", "{ circle = 50, at = 0 }", "[[0.0, 0.0], [120.0, 1.0]]", "0.0"] {
        assert!(remarks(&solved(foot(gap)), &history).is_empty(), "{gap}");
    }
}
