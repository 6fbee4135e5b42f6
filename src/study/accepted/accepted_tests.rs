use super::*;

fn signature() -> Signature {
    Signature { by: "Jane \"J\" Doe".into(), on: "2026-01-31".into(), reason: "a\nreason".into() }
}

fn values(list: &[(&str, f64)]) -> BTreeMap<String, f64> {
    list.iter().map(|(name, value)| (name.to_string(), *value)).collect()
}

fn accept(accepted: &Accepted, scene: &str, list: &[(&str, f64)]) -> Option<String> {
    let rows = accepted.rows(scene, &values(list), &Allowances::default());
    accepted.with(&BTreeMap::from([(scene.to_string(), rows)]), &signature())
}

fn changes(accepted: &Accepted, scene: &str, list: &[(&str, f64)]) -> Vec<(String, Change)> {
    let rows = accepted.rows(scene, &values(list), &Allowances::default());
    rows.into_iter().map(|row| (row.name, row.change)).collect()
}

const FOUND: [(&str, f64); 3] = [("energy.lower", -1.5), ("a|b.resultant x", 0.0), ("triangles", 304.0)];

#[test]
fn what_was_accepted_is_unchanged_until_it_changes() {
    let text = accept(&Accepted::empty(), "a scene.v2", &FOUND).expect("something new");
    let accepted = Accepted::parse(&text).expect("a baseline");
    assert!(changes(&accepted, "a scene.v2", &FOUND).iter().all(|(_, change)| *change == Change::Unchanged));
    assert_eq!(accept(&accepted, "a scene.v2", &FOUND), None, "nothing to write");
    let now = [("energy.lower", -1.5 + 1e-6), ("energy.upper", 2.0), ("triangles", 304.0)];
    let expected = [
        ("a|b.resultant x", Change::Missing),
        ("energy.lower", Change::Changed),
        ("energy.upper", Change::New),
        ("triangles", Change::Unchanged),
    ];
    assert_eq!(changes(&accepted, "a scene.v2", &now), expected.map(|(name, change)| (name.to_string(), change)));
    let checks = checks(&accepted.rows("a scene.v2", &values(&now), &Allowances::default()));
    let failed: Vec<&str> = checks.iter().filter(|check| !check.passed).map(|check| check.name.as_str()).collect();
    assert_eq!(failed, ["baseline/a|b.resultant x", "baseline/energy.lower", "baseline/energy.upper"]);
    // A scene that is not there is one check, and a number that is none is missing.
    let other = accepted.rows("another", &values(&now), &Allowances::default());
    assert_eq!(super::checks(&other).len(), 1);
    assert_eq!(changes(&accepted, "a scene.v2", &[("triangles", f64::NAN)])[2].1, Change::Missing);
}

#[test]
fn people_s_words_stay_where_they_are() {
    let written = "# ours\nversion = 1\n[scenes.x]   # first\n'energy.lower' = { value = 1, allowed = 0.5, reason = \"coarse\" } # kept\n\
                   # a remark\ntriangles = { value = 10, allowed = 0 }\n\n[scenes.y]\ngap = { value = 2.0, allowed = 0.1 }";
    let accepted = Accepted::parse(written).expect("a baseline");
    let found = [("energy.lower", 1.4), ("triangles", 12.0), ("energy.upper", 3.0)];
    let new = accept(&accepted, "x", &found).expect("changes");
    for kept in [
        "# ours",
        "[scenes.x]   # first",
        "'energy.lower' = { value = 1, allowed = 0.5, reason = \"coarse\" } # kept",
        "# a remark",
    ] {
        assert!(new.contains(kept), "{kept} in\n{new}");
    }
    assert!(
        new.contains("\"triangles\" = { value = 12.0, allowed = 0.0e0, by = \"Jane \\\"J\\\" Doe\", on = 2026-01-31")
    );
    let again = Accepted::parse(&new).expect("a baseline");
    assert!(changes(&again, "x", &found).iter().all(|(_, change)| *change == Change::Unchanged), "{new}");
    assert_eq!(changes(&again, "y", &[("gap", 2.05)]), [("gap".to_string(), Change::Unchanged)]);
    // Behind a last line without an end, as it is or changed.
    let new = accept(&accepted, "y", &[("gap", 3.0), ("more", 1.0)]).expect("changes");
    let again = Accepted::parse(&new).expect("a baseline");
    assert!(
        changes(&again, "y", &[("gap", 3.0), ("more", 1.0)]).iter().all(|(_, change)| *change == Change::Unchanged)
    );
    let gone = accept(&accepted, "y", &[("more", 1.0)]).expect("changes");
    assert_eq!(changes(&Accepted::parse(&gone).expect("a baseline"), "y", &[("more", 1.0)]).len(), 1);
    let new = accept(&accepted, "y", &[("gap", 2.0), ("more", 1.0)]).expect("changes");
    assert_eq!(
        changes(&Accepted::parse(&new).expect("a baseline"), "y", &[("gap", 2.0), ("more", 1.0)])[1].1,
        Change::Unchanged
    );
}

#[test]
fn what_cannot_be_kept_line_by_line_is_refused_with_its_line() {
    for (text, told) in [
        ("version = 2", "version"),
        ("version = 1\n[scenes.x.gap]\nvalue = 1.0\nallowed = 0.0", "line 2"),
        ("version = 1\nscenes.x = { gap = { value = 1.0, allowed = 0.0 } }", "line of its own"),
        ("version = 1\n[scenes.x]\ngap = { value = 1.0 }", "allowed"),
        ("version = 1\n[scenes.x]\ngap = { value = inf, allowed = 0.0 }", "line 3"),
        ("version = 1\n[scenes.x]\ngap = { value = 1.0, allowed = 0.0, tolerance = 1 }", "tolerance"),
        ("{\"version\": 1}", "line 1"),
    ] {
        let reason = Accepted::parse(text).expect_err(text);
        assert!(reason.contains(told), "{text}: {reason}");
    }
}
