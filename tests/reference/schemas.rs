//! Reports of comparisons and of fields that are handed in, against the schema of reports.

use crate::command::{case, hypercircle, run, said, with_reference};
use crate::validate::misfits;

#[test]
fn reports_with_displacement_models_fit_their_schema() {
    if !with_reference() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let quantities = format!("{}/tests/malformed/valid/quantities.toml", env!("CARGO_MANIFEST_DIR"));
    let blocks = case("two_blocks").display().to_string();
    let stiff = path("stiff.toml");
    let text = std::fs::read_to_string(&blocks).expect("part of the repository");
    assert!(text.contains("young = 1.0"));
    std::fs::write(&stiff, text.replace("young = 1.0", "young = 1.05")).expect("writable");
    let field = path("plain/fields.vtu").display().to_string();
    let certify = ["--displacement", &field, "--field", "displacement_FEniCSx_P2"];
    let runs: [(&[&str], &[&str], i32, &str); 8] = [
        (&["verify", &blocks], &[], 0, "plain"),
        (&["verify", &quantities, "--primal-degree", "2,3"], &[], 0, "quantities"),
        (&["verify", &blocks, "--baseline", "b.json", "--accept"], &[], 0, "accepted"),
        (&["verify", "stiff.toml", "--baseline", "b.json"], &[], 1, "compared"),
        (&["certify", &blocks], &certify, 0, "field"),
        (&["certify", &blocks, "--solution"], &certify, 0, "solution"),
        (&["certify", "stiff.toml", "--solution"], &certify, 1, "wrong"),
        (&["certify", "stiff.toml", "--solution", "--allow", "residual=1"], &certify, 1, "allowed"),
    ];
    let mut reports = Vec::new();
    for (words, more, code, out) in runs {
        let words = words.iter().chain(more).copied().chain(["--quiet", "--out", out]);
        let output = run(hypercircle(folder.path(), words));
        assert_eq!(output.status.code(), Some(code), "{out}: {}", said(&output));
        reports.push(path(out).join("report.json"));
    }
    assert_eq!(misfits(folder.path(), "report", &reports), "");
}
