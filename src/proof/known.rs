//! The scenes that a proof can be made of: those of which the checker knows every key.

use toml::{Table, Value};

/// A table of the scene by its place, and the keys that the checker knows in it.
const KNOWN: [(&str, &str); 13] = [
    ("", "title model mesh geometry bodies boundaries supports tractions contacts bonds quantities"),
    ("model", "kinematics thickness"),
    (
        "bodies",
        "young poisson orthotropic stiffness compliance angle expansion temperature initial_stress body_force rotation tag set",
    ),
    ("bodies.orthotropic", "young poisson shear angle"),
    ("bodies.temperature", "value gradient"),
    ("bodies.body_force", "value gradient"),
    ("bodies.rotation", "density omega about"),
    ("supports", "on type displacement direction stiffness"),
    ("tractions", "on value gradient pressure"),
    ("contacts", "between on gap normals direction obstacle move stiffness friction"),
    ("contacts.friction", "bound"),
    ("bonds", "between direction stiffness"),
    ("geometry.polygons", "body points edges arcs"),
];

/// The values that the checker knows of keys that name a kind.
const KINDS: [(&str, &str, &[&str]); 2] = [
    ("model", "kinematics", &["plane-strain", "plane-stress"]),
    ("supports", "type", &["clamped", "roller", "spring"]),
];

/// The first entry in the text of a scene that the checker does not know; `None` if it knows all.
pub fn unknown(text: &str) -> Option<String> {
    let scene: Table = text.parse().ok()?;
    for (place, keys) in KNOWN {
        for table in tables(&scene, place) {
            if let Some(key) = table.keys().find(|key| !keys.split(' ').any(|known| known == key.as_str())) {
                let of = if place.is_empty() { String::new() } else { format!(" in `{place}`") };
                return Some(format!("`{key}`{of}"));
            }
            if let Some(key) =
                ["young", "gap", "stiffness", "bound"].into_iter().find(|key| is_range(place, table, key))
            {
                return Some(format!("a range of `{key}` in `{place}`"));
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

/// True if a number is given by the two ends of a range, for which there is no proof.
fn is_range(place: &str, table: &Table, key: &str) -> bool {
    let Some(Value::Array(parts)) = table.get(key) else { return false };
    let nested = parts.iter().any(Value::is_array);
    match (place, key) {
        ("bodies", "young") | ("contacts", "stiffness") => true,
        ("contacts", "gap") | ("contacts.friction", "bound") => !nested,
        ("supports" | "bonds", "stiffness") => nested,
        _ => false,
    }
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
        let text = std::fs::read_to_string(crate::in_repository("cases/two_blocks.toml")).unwrap();
        assert_eq!(unknown(&text), None);
        let with = |from: &str, to: &str| unknown(&text.replacen(from, to, 1)).unwrap();
        assert_eq!(with("poisson = 0.3", "poisson = 0.3\nplasticity = 1"), "`plasticity` in `bodies`");
        assert_eq!(with("type = \"roller\"", "type = \"glue\""), "`type = \"glue\"` in `supports`");
        let turning = "poisson = 0.3\nrotation = { density = 1.0, omega = 2.0, about = [0, 0], axis = 1 }";
        assert_eq!(with("poisson = 0.3", turning), "`axis` in `bodies.rotation`");
        assert_eq!(with("young = ", "young = [1.0, 2.0] # "), "a range of `young` in `bodies`");
        assert_eq!(unknown(&format!("{text}\n[[cracks]]\n")), Some("`cracks`".to_string()));
    }

    #[test]
    fn friction_has_a_proof_where_its_bound_is_given() {
        let text = std::fs::read_to_string(crate::in_repository("cases/pushed_partly.toml")).unwrap();
        let with = |friction: &str| unknown(&text.replace("bound = 0.15", friction));
        assert_eq!(with("bound = 0.15"), None);
        assert_eq!(with("bound = [[0.0, 0.1], [1.0, 0.3]]"), None);
        assert_eq!(with("bound = [0.1, 0.3]").as_deref(), Some("a range of `bound` in `contacts.friction`"));
        assert_eq!(with("coefficient = 0.15").as_deref(), Some("`coefficient` in `contacts.friction`"));
    }
}
