//! What a report says about the polygon and the curve that it stands for.

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

/// Edges of a length l lie l²/8R from the circle; the largest of those that press.
fn away(certified: &Certified) -> f64 {
    let (pairs, tractions) = (&certified.problem.interfaces[0].pairs, &certified.dual.contact_traction[0]);
    let pressed = pairs.iter().zip(tractions.iter()).filter(|(_, t)| t.iter().any(|t| *t < -1e-7));
    pressed.map(|(pair, _)| pair.length * pair.length / 400.0).fold(0.0, f64::max)
}

#[test]
fn an_interpolated_gap_is_held_against_what_closes() {
    let certified = solved(foot("{ circle = 50, at = 0 }"));
    let said = remarks(&certified, &[]);
    assert_eq!(said.len(), 1, "{said:?}");
    let away = away(&certified);
    let figure = format!("up to {away:.1e} away from its curve");
    assert!(said[0].contains("contact foot|rigid") && said[0].contains(&figure), "no `{figure}` in {said:?}");
    assert!(said[0].contains("% of the largest gap that closes"), "{said:?}");
    let finer = solved(foot("{ circle = 50, at = 0 }").refine_uniform(1).expect("refines"));
    let nearer = self::away(&finer);
    assert!(nearer < 0.5 * away && remarks(&finer, &[])[0].contains(&format!("up to {nearer:.1e} away")));
    // A table is what it is.
    assert!(remarks(&solved(foot("[[0.0, 0.0], [120.0, 1.0]]")), &[]).is_empty());
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
    let circle = solved(foot("{ parabola = 50, at = 0 }"));
    assert!(remarks(&circle, &history).iter().any(|text| text.contains(told)));
    let straight = solved(foot("0.0"));
    assert!(remarks(&straight, &history).is_empty());
}
