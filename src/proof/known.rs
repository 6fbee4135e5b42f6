//! The scenes that a proof can be made of: those of which the checker knows every key.

use toml::{Table, Value};

/// A table of the scene by its place, and the keys that the checker knows in it.
const KNOWN: [(&str, &[&str]); 7] = [
    (
        "",
        &[
            "title",
            "model",
            "mesh",
            "geometry",
            "bodies",
            "boundaries",
            "supports",
            "tractions",
            "contacts",
            "quantities",
        ],
    ),
    ("model", &["kinematics", "thickness"]),
    ("bodies", &["young", "poisson", "body_force", "tag", "set"]),
    ("supports", &["on", "type", "displacement", "direction"]),
    ("tractions", &["on", "value", "gradient", "pressure"]),
    ("contacts", &["between", "on", "gap", "normals", "direction", "obstacle", "move"]),
    ("geometry.polygons", &["body", "points", "edges", "arcs"]),
];

/// The values that the checker knows of keys that name a kind.
const KINDS: [(&str, &str, &[&str]); 2] =
    [("model", "kinematics", &["plane-strain", "plane-stress"]), ("supports", "type", &["clamped", "roller"])];

/// Keys that the checker knows as vectors alone.
const CONSTANT: [(&str, &str); 1] = [("bodies", "body_force")];

/// What the scene with this text has that the checker does not know; `None` where there is nothing.
pub fn unknown(text: &str) -> Option<String> {
    let scene: Table = text.parse().ok()?;
    for (place, keys) in KNOWN {
        for table in tables(&scene, place) {
            if let Some(key) = table.keys().find(|key| !keys.contains(&key.as_str())) {
                let of = if place.is_empty() { String::new() } else { format!(" in `{place}`") };
                return Some(format!("`{key}`{of}"));
            }
            if let Some((_, key)) =
                CONSTANT.iter().find(|(of, key)| *of == place && !table.get(*key).is_none_or(Value::is_array))
            {
                return Some(format!("a `{key}` in `{place}` that is not constant"));
            }
            for (_, key, kinds) in KINDS.iter().filter(|(of, ..)| *of == place) {
                if let Some(kind) = table.get(*key).and_then(Value::as_str).filter(|kind| !kinds.contains(kind)) {
                    return Some(format!("`{key} = \"{kind}\"` in `{place}`"));
                }
            }
        }
    }
    None
}

/// The tables at a place: one, those of an array, or those by name.
fn tables<'a>(scene: &'a Table, place: &str) -> Vec<&'a Table> {
    let mut found = vec![scene];
    for key in place.split('.').filter(|key| !key.is_empty()) {
        let inner = found.iter().filter_map(|table| table.get(key));
        found = inner
            .flat_map(|value| match value {
                Value::Table(named) if key == "bodies" => named.values().filter_map(Value::as_table).collect(),
                Value::Table(table) => vec![table],
                Value::Array(rows) => rows.iter().filter_map(Value::as_table).collect(),
                _ => Vec::new(),
            })
            .collect();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::unknown;

    #[test]
    fn keys_that_the_checker_does_not_know_are_named() {
        let text = std::fs::read_to_string("cases/two_blocks.toml").unwrap();
        assert_eq!(unknown(&text), None);
        let with = |from: &str, to: &str| unknown(&text.replacen(from, to, 1)).unwrap();
        assert_eq!(with("poisson = 0.3", "poisson = 0.3\nplasticity = 1"), "`plasticity` in `bodies`");
        assert_eq!(with("type = \"roller\"", "type = \"spring\""), "`type = \"spring\"` in `supports`");
        let force = "poisson = 0.3\nbody_force = { value = [0, -1], gradient = [[0, 0], [0, 1]] }";
        assert_eq!(with("poisson = 0.3", force), "a `body_force` in `bodies` that is not constant");
        assert_eq!(unknown(&format!("{text}\n[[cracks]]\n")), Some("`cracks`".to_string()));
    }
}
