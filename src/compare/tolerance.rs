//! Tolerances that theory leaves open, and how the command line changes them.

/// Defaults of the chosen tolerances, by the last part of the check name.
pub const CHOSEN: [(&str, f64, &str); 5] = [
    ("sharpness", 0.15, "a bracket wider than this could not tell two models apart"),
    ("energy-error", 0.25, "a field whose stress may be wrong by more than this does not answer the question"),
    ("pressure-l2", 0.25, "where no reactions are given, nothing bounds the pressure in L²"),
    ("pressure-max", 0.35, "where no reactions are given, nothing bounds a maximum"),
    ("open-length", 0.1, "the end of contact is known to a few edges on either side"),
];

/// Allowed values from the command line, by check name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Allowances {
    entries: Vec<(String, f64)>,
}

impl Allowances {
    /// From NAME=VALUE pairs; NAME is the whole name of a check or its last part.
    pub fn new(entries: Vec<(String, f64)>) -> Self {
        Allowances { entries }
    }

    /// The same, over values that hold where the command line says nothing.
    pub fn after(mut self, defaults: impl IntoIterator<Item = (String, f64)>) -> Self {
        self.entries.splice(0..0, defaults);
        self
    }

    /// The allowed value of the check `name`, or `default`.
    pub fn get(&self, name: &str, default: f64) -> f64 {
        let last = name.rsplit('/').next().unwrap_or(name);
        self.entries.iter().rev().find(|(key, _)| key == name || key == last).map_or(default, |(_, value)| *value)
    }

    /// The chosen default for `name`, unless overridden.
    pub fn chosen(&self, name: &str) -> f64 {
        let last = name.rsplit('/').next().unwrap_or(name);
        let default = CHOSEN.iter().find(|(key, ..)| *key == last).map_or(0.0, |row| row.1);
        self.get(name, default)
    }

    /// Names that match none of `checks`.
    pub fn unknown<'a>(&'a self, checks: &[super::Check]) -> Vec<&'a str> {
        let matches = |key: &str| checks.iter().any(|c| c.name == key || c.name.rsplit('/').next() == Some(key));
        self.entries.iter().map(|(key, _)| key.as_str()).filter(|key| !matches(key)).collect()
    }
}
