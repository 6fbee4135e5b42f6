//! Vertices of two sides that lie close beside each other.

use super::run::{Report, Run, with_reference};
use crate::support::toml::Toml;

/// Two unit squares, one pressed on the other, the lower one with a vertex in the middle of the contact and the upper one with
/// a vertex `off` beside it.
fn pressed(off: f64, direction: bool) -> Report {
    let along = if direction { "\ndirection = [0, -1]" } else { "" };
    let text = Toml::default()
        .polygon(
            "lower",
            &[[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.5, 0.0], [0.0, 0.0]],
            ["ground", "", "low", "low", ""],
        )
        .polygon(
            "upper",
            &[[0.0, 0.0], [0.5 + off, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            ["up", "up", "", "top", ""],
        )
        .clamp("ground")
        .pressure("top", 0.01)
        .table(&format!("[[contacts]]\nbetween = [\"low\", \"up\"]{along}"))
        .text();
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, text).expect("written");
    let run = Run::new(if with_reference() { "verify" } else { "solve" }, &scene, &[]);
    assert_eq!(run.code, Some(0), "{off:e}: {}{}", run.stdout, run.stderr);
    let report = run.report();
    assert_eq!(report.0["energy"]["guaranteed"], true, "{off:e}: {}", report.notes());
    report
}

/// 1e-8 of an edge apart, FEniCSx found a pressure three times too high in the needles between them.
#[test]
fn the_largest_pressure_is_that_of_one_vertex() {
    let one = pressed(0.0, true);
    for (off, direction) in [(1e-8, true), (-3e-9, true), (1e-7, false)] {
        let two = pressed(off, direction);
        for model in if with_reference() { &["dual", "primal"][..] } else { &["dual"] } {
            let [found, expected] =
                [&two, &one].map(|report| report.number(&format!("/contact/0/pressure_max/{model}")));
            // The two meshes are not the same: polygons are cut by their corners.
            assert!((found / expected - 1.0).abs() < 0.1, "{off:e} {model}: {found} and {expected}");
        }
    }
}
