//! The JSON Schema of scenes, held against scene files.

use std::path::Path;

/// True if `value` conforms to the schema `at`, for the keywords that the schema of scenes has.
fn admits(schema: &serde_json::Value, at: &serde_json::Value, value: &serde_json::Value) -> bool {
    let number = |key: &str| at[key].as_f64();
    let referred = at["$ref"].as_str().is_none_or(|path| {
        let name = path.strip_prefix("#/$defs/").expect("a definition of the schema");
        admits(schema, &schema["$defs"][name], value)
    });
    let is = |kind: &serde_json::Value| match kind.as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.is_u64(),
        Some("null") => value.is_null(),
        other => panic!("the type {other:?}"),
    };
    let kind = match &at["type"] {
        serde_json::Value::Null => true,
        serde_json::Value::Array(kinds) => kinds.iter().any(is),
        kind => is(kind),
    };
    let choices = |key: &str| at[key].as_array().map(|all| all.iter().filter(|one| admits(schema, one, value)).count());
    let chosen = choices("oneOf").is_none_or(|n| n == 1) && choices("anyOf").is_none_or(|n| n > 0);
    let listed = at["enum"].as_array().is_none_or(|words| words.contains(value));
    let inside = value.as_object().is_none_or(|fields| {
        let required = at["required"].as_array().into_iter().flatten();
        let other = &at["additionalProperties"];
        required.filter_map(|key| key.as_str()).all(|key| fields.contains_key(key))
            && fields.iter().all(|(key, field)| match (at["properties"].get(key), other) {
                (Some(property), _) => admits(schema, property, field),
                (None, serde_json::Value::Bool(allowed)) => *allowed,
                (None, serde_json::Value::Null) => true,
                (None, other) => admits(schema, other, field),
            })
    });
    let items = value.as_array().is_none_or(|items| {
        let n = items.len() as f64;
        number("minItems").is_none_or(|least| n >= least)
            && number("maxItems").is_none_or(|most| n <= most)
            && (at["items"].is_null() || items.iter().all(|item| admits(schema, &at["items"], item)))
    });
    referred && kind && chosen && listed && inside && items
}

#[test]
fn the_schema_knows_quantities() {
    let schema = hypercircle::scene::schema();
    let admitted = |text: &str| {
        let value: serde_json::Value = toml::from_str(text).expect("TOML");
        admits(&schema, &schema, &value)
    };
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed/valid/quantities.toml");
    let example = std::fs::read_to_string(path).expect("part of the repository");
    assert!(admitted(&example));
    for (good, bad) in [
        ("component = \"xy\"", "component = \"zx\""),
        ("about = [2.0, 0.5]", "about = [2.0]"),
        ("about = [2.0, 0.5]", ""),
        ("window = [0.1, 0.2, 0.3, 0.4]", "window = [0.1, 0.2, 0.3]"),
        ("window = [0.1, 0.2, 0.3, 0.4]", "window = [0.1, 0.2, 0.3, 0.4]\nmoment = \"wall\"\nabout = [0, 0]"),
        ("displacement = \"left\"", "displacement = 1"),
        ("displacement = \"left\"", "displacement = \"left\"\nat = [0, 0]"),
        ("name = \"drift\"", ""),
    ] {
        assert!(example.contains(good) && !admitted(&example.replacen(good, bad, 1)), "{bad}");
    }
    let described = schema["$defs"]["Quantity"]["properties"].as_object().expect("properties");
    assert_eq!(described.len(), 15);
    assert!(described.values().all(|property| property["description"].is_string()));
}
