//! `certify --solution` with fields of methods whose contact holds in the mean: `tests/support/displacement/weak.py`.

use crate::claimed::{certified, check, prepared_on};
use crate::command::case;
use serde_json::Value;

const CONTACT: &str = "left_face|right_face";

/// Fields by name, with what is said of their contact.
const METHODS: [(&str, &str); 6] = [
    ("mortar_hats", "as of a mortar method"),
    ("mortar_edges", "as of a mortar method"),
    ("nitsche", "Nitsche's method (θ = 1.000, γ = 1.0000e-2 lengths"),
    ("nitsche_unsymmetric", "Nitsche's method (θ = -1.000, γ = 1.0000e-1 lengths"),
    ("nitsche_incomplete", "Nitsche's method (θ = 0.000, γ = 1.0000e-1 lengths"),
    ("augmented", "as of an augmented Lagrangian evaluated at quadrature points"),
];

fn findings(report: &Value) -> Vec<&str> {
    let all = report["diagnosis"].as_array().into_iter().flatten().flat_map(|d| d["findings"].as_array());
    all.flatten().filter_map(|finding| finding["name"].as_str()).collect()
}

#[test]
fn a_law_that_is_met_to_the_accuracy_of_a_solver_is_a_remark() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("two_blocks")).expect("the case");
    let names = METHODS.map(|(name, _)| name);
    if !prepared_on(folder.path(), &text, &names) {
        return;
    }
    for (name, words) in METHODS {
        for degree in ["P1", "P2"] {
            let (code, report) = certified(folder.path(), &format!("{degree}/{name}"), &[]);
            assert_eq!(code, 0, "{degree} {name}: {}", report["verdict"]);
            let remarks = report["remarks"].as_array().expect("remarks");
            let nodes = format!("solution/contact/{CONTACT}/penetration-at-nodes");
            let remark = remarks.iter().find(|remark| remark["name"] == nodes.as_str()).expect("a remark");
            let why = remark["why"].as_str().expect("a sentence");
            assert_eq!(remark["passed"], false, "{degree} {name}: nodes penetrate");
            assert!(why.contains(words), "{degree} {name}: {why}");
            assert!(why.contains("penetrates by up to") && why.contains("the energy is"), "{degree} {name}: {why}");
        }
    }
}

/// A claim about contact excuses nothing else, and a penalty is no such method.
#[test]
fn a_wrong_modulus_and_a_penalty_stay_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("two_blocks")).expect("the case");
    let names = ["nitsche_modulus", "mortar_modulus", "penalty_quadrature", "penalty_soft"];
    if !prepared_on(folder.path(), &text, &names) {
        return;
    }
    for name in names {
        for degree in ["P1", "P2"] {
            for more in [[].as_slice(), &["--contact", "weak"]] {
                let (code, report) = certified(folder.path(), &format!("{degree}/{name}"), more);
                assert_eq!(code, 1, "{degree} {name} {more:?}: {}", report["verdict"]);
                let found = findings(&report);
                match name.strip_suffix("_modulus") {
                    Some(_) => {
                        assert!(found.contains(&"body/left/young"), "{degree} {name} {more:?}: {found:?}");
                        assert!(!check(&report, "solution/residual")["passed"].as_bool().expect("a flag"));
                    }
                    None => assert_eq!(found, [format!("contact/{CONTACT}/penalty")], "{degree} {name} {more:?}"),
                }
            }
        }
    }
}
