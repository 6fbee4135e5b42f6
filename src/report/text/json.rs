//! `report.json` and its schema.

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use serde_json::Value;

use crate::report::Report;

/// The report as indented JSON with a final newline. Numbers that are not finite become `null`.
pub fn json(report: &Report) -> Result<String, serde_json::Error> {
    let mut text = serde_json::to_string_pretty(report)?;
    text.push('\n');
    Ok(text)
}

/// JSON Schema of `report.json`. Every floating-point number may be `null`: that is how one that is not finite is
/// written.
pub fn schema() -> Value {
    let written = SchemaSettings::default().for_serialize();
    let mut schema = written.into_generator().into_root_schema_for::<Report>();
    RecursiveTransform(|schema: &mut schemars::Schema| {
        if schema.get("type").and_then(Value::as_str) == Some("number") {
            schema.insert("type".to_string(), serde_json::json!(["number", "null"]));
        }
    })
    .transform(&mut schema);
    schema.to_value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    /// Follows a path like `dual.seconds.total`.
    fn get<'a>(value: &'a Value, path: &str) -> &'a Value {
        path.split('.').fold(value, |v, key| match key.parse::<usize>() {
            Ok(index) => &v[index],
            Err(_) => &v[key],
        })
    }

    #[test]
    fn the_keys_that_stay_are_there_with_their_types() {
        let sample = Sample::new(2, Verdict::Agree);
        let value: Value = serde_json::from_str(&json(&sample.dossier().report).unwrap()).unwrap();
        let numbers = [
            "schema_version",
            "energy.lower",
            "energy.upper",
            "energy.gap",
            "energy.relative_error_bound",
            "dual.degree_min",
            "dual.degree_max",
            "dual.triangles",
            "dual.unknowns",
            "dual.iterations",
            "dual.equilibrium_residual",
            "dual.seconds.read",
            "dual.seconds.statics",
            "dual.seconds.assemble",
            "dual.seconds.factor",
            "dual.seconds.contact",
            "dual.seconds.recover",
            "dual.seconds.bounds",
            "dual.seconds.total",
            "primal.0.degree",
            "primal.0.energy",
            "primal.0.iterations",
            "primal.0.seconds.total",
            "contact.0.resultant.dual.0",
            "contact.0.resultant.primal.1",
            "contact.0.pressure_max.dual",
            "contact.0.pressure_max.primal",
            "contact.0.open_fraction",
            "contact.0.pressure_l2_difference",
            "stress.relative_energy_norm_difference",
            "stress.worst_triangle",
            "quantities.0.value",
            "quantities.0.lower",
            "quantities.0.upper",
            "quantities.0.first_order.0",
            "quantities.0.first_order.1",
            "quantities.0.primal.0.degree",
            "quantities.0.primal.0.value",
            "checks.0.value",
            "checks.0.reference",
            "checks.0.difference",
            "checks.0.allowed",
            "checks.0.margin",
        ];
        for path in numbers {
            assert!(get(&value, path).is_number(), "{path}");
        }
        let strings = [
            "scene",
            "status",
            "energy.upper_from",
            "dual.method",
            "primal.0.solver",
            "primal.0.version",
            "contact.0.name",
            "quantities.0.name",
            "quantities.0.kind",
            "quantities.0.primal.0.solver",
            "checks.0.name",
            "checks.0.why",
        ];
        for path in strings {
            assert!(get(&value, path).is_string(), "{path}");
        }
        for path in
            ["primal.0.admissible", "quantities.0.exact_by_statics", "quantities.0.primal.0.inside", "checks.0.passed"]
        {
            assert!(get(&value, path).is_boolean(), "{path}");
        }
        assert_eq!(value["status"], "agree");
    }

    #[test]
    fn every_key_of_a_report_is_in_the_schema() {
        let sample = Sample::new(2, Verdict::Disagree);
        let value: Value = serde_json::from_str(&json(&sample.dossier().report).unwrap()).unwrap();
        let schema = schema();
        for key in value.as_object().unwrap().keys() {
            assert!(schema["properties"].get(key).is_some(), "{key} is missing in the schema");
        }
        let check = &schema["$defs"]["Check"];
        assert_eq!(check["properties"]["allowed"]["type"], serde_json::json!(["number", "null"]));
        let status = schema["$defs"]["Status"].to_string();
        for word in ["agree", "disagree", "infeasible", "failed"] {
            assert!(status.contains(&format!("\"{word}\"")), "{status}");
        }
    }

    #[test]
    fn an_end_that_is_missing_is_null_in_report_and_schema() {
        let sample = Sample::new(1, Verdict::Agree);
        let mut report = sample.dossier().report;
        report.quantities[1].first_order = [f64::NEG_INFINITY, f64::INFINITY];
        let value: Value = serde_json::from_str(&json(&report).unwrap()).unwrap();
        let seat = &value["quantities"][1];
        assert!(seat["lower"].is_number() && seat["upper"].is_null() && seat["reason"].is_string(), "{seat}");
        assert_eq!(seat["first_order"], serde_json::json!([null, null]));
        let properties = &schema()["$defs"]["QuantitySummary"]["properties"];
        for key in ["value", "lower", "upper"] {
            assert_eq!(properties[key]["type"], serde_json::json!(["number", "null"]), "{key}");
        }
        assert_eq!(properties["first_order"]["items"]["type"], serde_json::json!(["number", "null"]));
        for key in seat.as_object().unwrap().keys() {
            assert!(properties.get(key).is_some(), "{key} is missing in the schema");
        }
    }

    #[test]
    fn numbers_that_are_none_become_null() {
        let sample = Sample::new(1, Verdict::Agree);
        let mut report = sample.dossier().report;
        report.energy.as_mut().unwrap().gap = f64::NAN;
        report.energy.as_mut().unwrap().upper = f64::INFINITY;
        let value: Value = serde_json::from_str(&json(&report).unwrap()).unwrap();
        assert!(value["energy"]["gap"].is_null() && value["energy"]["upper"].is_null());
    }
}
