//! Displacements of FEniCSx with elastic contact, held to their claim as fields of another program.

use super::run::{Run, with_reference};
use crate::support::toml::Toml;

/// A block on another one, on a contact of this stiffness that opens with a gap.
fn scene(stiffness: f64) -> String {
    Toml::default()
        .size(0.25)
        .polygon("a", &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "west"])
        .outline(
            "b",
            &[[-0.5, -1.0], [2.5, -1.0], [2.5, 0.0], [2.0, 0.0], [0.0, 0.0], [-0.5, 0.0]],
            &["ground", "", "", "seat", "", ""],
        )
        .material("b", 2.0, 0.3)
        .clamp("ground")
        .roller("west")
        .table("[[tractions]]\non = \"top\"\nvalue = [0.0, -0.1]\ngradient = [[0.0, 0.0], [0.06, 0.0]]")
        .table(&format!(
            "[[contacts]]\nbetween = [\"foot\", \"seat\"]\ngap = [[0.0, 0.0], [2.0, 0.03]]\nstiffness = {stiffness:?}"
        ))
        .text()
}

#[test]
fn a_solution_is_one_and_another_stiffness_is_named() {
    if !with_reference() {
        return;
    }
    for degree in ["1", "2"] {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, stiffness: f64| {
            let path = folder.path().join(name);
            std::fs::write(&path, scene(stiffness)).expect("writable");
            path
        };
        let [own, other] = [write("own.toml", 3.0), write("other.toml", 4.5)];
        let verified = Run::new("verify", &own, &["--primal-degree", degree]);
        assert_eq!(verified.code, Some(0), "{}{}", verified.stdout, verified.stderr);
        let field = verified.folder.path().join("out/fields.vtu").display().to_string();
        let name = format!("displacement_FEniCSx_P{degree}");
        let more = ["--displacement", &field, "--field", &name, "--solution"];
        let certified = Run::new("certify", &own, &more);
        assert_eq!(certified.code, Some(0), "{degree}: {}{}", certified.stdout, certified.stderr);
        let certified = Run::new("certify", &other, &more);
        assert_eq!(certified.code, Some(1), "{degree}: {}{}", certified.stdout, certified.stderr);
        let report = certified.report();
        let finding = &report.0["diagnosis"][0]["findings"][0];
        assert_eq!(finding["name"], "contact/foot|seat/stiffness", "{finding}");
        let found = finding["value"].as_f64().expect("a number");
        assert!((found - 3.0).abs() < 1e-3, "{found}");
    }
}
