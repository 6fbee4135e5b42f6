use serde_json::{Value, json};

use super::*;

fn check(name: &str, value: f64, passed: bool, basis: &str) -> Value {
    json!({"name": name, "value": value, "reference": 0.0, "difference": value, "allowed": 1.0, "margin": 1.0 - value,
        "passed": passed, "why": "", "basis": basis})
}

fn report(change: impl FnOnce(&mut Value)) -> Stored {
    let mut value = json!({
        "schema_version": 1, "scene": "s", "title": "s", "command": "solve", "run": "1", "status": "agree", "verdict": "",
        "energy": {"lower": -2.0, "upper": -1.0, "relative_error_bound": 0.1, "guaranteed": true},
        "dual": {"method": "condensed", "triangles": 8, "unknowns": 10},
        "primal": [], "contact": [], "stress": null,
        "checks": [check("a", 0.1, true, "guaranteed"), check("b", 0.2, true, "round-off")],
        "remarks": [check("r", 0.1, true, "chosen")],
        "quantities": [{"name": "tip", "value": 1.5, "lower": 1.0, "upper": 2.0}],
        "provenance": {"version": "1", "scene_sha256": "x", "mesh_sha256": "m", "threads": 1, "seconds": {}},
    });
    change(&mut value);
    serde_json::from_value(value).expect("a report")
}

fn kinds(difference: &Difference) -> Vec<(&str, Kind)> {
    difference.checks.iter().map(|change| (change.name.as_str(), change.kind)).collect()
}

#[test]
fn a_report_is_like_itself() {
    let same = compare(report(|_| {}), report(|v| v["provenance"]["seconds"] = json!({"total": 5.0})));
    assert!(!same.is_decisive() && same.checks.iter().all(|c| c.kind == Kind::Same), "{same:?}");
    assert!(same.numbers.iter().all(|number| !number.is_changed()));
}

#[test]
fn changed_checks_come_first_and_outcomes_decide() {
    let second = || {
        report(|v| {
            v["checks"] = json!([
                check("c", 0.1, true, "guaranteed"),
                check("b", 2.0, false, "round-off"),
                check("a", 0.3, true, "guaranteed")
            ]);
        })
    };
    let forth = compare(report(|_| {}), second());
    assert_eq!(kinds(&forth), [("b", Kind::Broken), ("a", Kind::Moved), ("c", Kind::New), ("r", Kind::Same)]);
    assert!(forth.is_decisive());
    let back = compare(second(), report(|_| {}));
    assert_eq!(kinds(&back), [("b", Kind::Mended), ("a", Kind::Moved), ("c", Kind::Missing), ("r", Kind::Same)]);
    assert!(back.is_decisive());
    let rounded = compare(report(|_| {}), report(|v| v["checks"][1]["value"] = json!(0.9)));
    assert!(rounded.checks.iter().all(|c| c.kind == Kind::Same), "within round-off");
    // A remark has no part in it, a value alone neither; a check that was not made again has.
    let remark = compare(report(|_| {}), report(|v| v["remarks"][0]["passed"] = json!(false)));
    assert!(remark.checks[0].kind == Kind::Broken && !remark.is_decisive());
    assert!(!compare(report(|_| {}), report(|v| v["checks"][0]["value"] = json!(0.4))).is_decisive());
    let missing = |command: &str| {
        compare(
            report(|_| {}),
            report(|v| {
                v["checks"] = json!([v["checks"][0]]);
                v["command"] = json!(command);
            }),
        )
    };
    assert!(missing("solve").is_decisive() && !missing("certify").is_decisive());
}

#[test]
fn guaranteed_intervals_of_one_scene_must_meet() {
    let moved = |key: &str| {
        report(|v| match key {
            "energy" => v["energy"]["upper"] = json!(-1.5),
            "apart" => {
                v["energy"] = json!({"lower": -0.9, "upper": -0.5, "relative_error_bound": 0.1, "guaranteed": true})
            }
            "not guaranteed" => {
                v["energy"] = json!({"lower": -0.9, "upper": -0.5, "relative_error_bound": 0.1, "guaranteed": false})
            }
            "quantity" => v["quantities"][0] = json!({"name": "tip", "value": 2.5, "lower": 2.1, "upper": 3.0}),
            _ => {
                v["provenance"]["scene_sha256"] = json!("y");
                v["energy"] = json!({"lower": -0.9, "upper": -0.5, "relative_error_bound": 0.1, "guaranteed": true});
            }
        })
    };
    for (key, decisive) in
        [("energy", false), ("apart", true), ("not guaranteed", false), ("quantity", true), ("another scene", false)]
    {
        let difference = compare(report(|_| {}), moved(key));
        assert_eq!(difference.is_decisive(), decisive, "{key}: {:?}", difference.contradictions);
        assert!(difference.numbers.iter().any(NumberChange::is_changed), "{key}");
    }
}
