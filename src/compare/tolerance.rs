//! Tolerances that theory leaves open, and how the command line changes them.

/// The tolerances this program chose, by the last part of the check name. A value that exceeds them is a remark only.
pub const CHOSEN: [(&str, f64, &str); 8] = [
    ("sharpness", SHARP, "a bracket wider than this could not tell two models apart"),
    ("energy-error", 0.25, "a field whose stress may be wrong by more than this does not answer the question"),
    ("pressure-l2", 0.25, "where no reactions are given, nothing bounds the pressure in L²"),
    ("pressure-max", 0.35, "where no reactions are given, nothing bounds a maximum"),
    ("peak-pressure", 1.5, "times what the bracket explains of means: nothing bounds the pressure at a point"),
    ("resultant", 0.05, "where supports hold every vertex of a contact, nothing bounds the force at its ends"),
    ("open-length", 0.1, "the end of contact is known to a few edges on either side"),
    (
        "friction-force",
        0.25,
        "two searches for a Coulomb solution need not find the same one, and nothing bounds their difference",
    ),
];

/// The guaranteed relative error that a bracket is refined to before two models are compared by it.
pub const SHARP: f64 = 0.15;

/// The guaranteed relative error above which a bracket that could not be refined further does not tell two models apart:
/// the interval of the energy is then wider than a tenth of the strain energy.
pub const BLUNT: f64 = 0.32;

/// The chosen tolerance for checks whose name ends with `last`.
pub fn chosen(last: &str) -> f64 {
    CHOSEN.iter().find(|(key, ..)| *key == last).map_or(0.0, |row| row.1)
}

/// Allowed values from the command line, by check name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Allowances {
    entries: Vec<(String, f64)>,
}

impl Allowances {
    /// Allowances from NAME=VALUE pairs; NAME is the whole name of a check or its last part.
    pub fn new(entries: Vec<(String, f64)>) -> Self {
        Allowances { entries }
    }

    /// These allowances with `defaults` for the checks that the command line does not mention.
    pub fn after(mut self, defaults: impl IntoIterator<Item = (String, f64)>) -> Self {
        self.entries.splice(0..0, defaults);
        self
    }

    /// The allowed value of the check `name`, where one was given; the last one given counts.
    pub fn given(&self, name: &str) -> Option<f64> {
        let last = name.rsplit('/').next().unwrap_or(name);
        self.entries.iter().rev().find(|(key, _)| key == name || key == last).map(|(_, value)| *value)
    }

    /// Replaces tolerances of `checks` by the values given; those checks then take part in the verdict, whatever their basis was.
    pub fn apply(&self, checks: &mut [super::Check]) {
        for check in checks {
            if let Some(allowed) = self.given(&check.name) {
                *check = check.clone().asked(allowed);
            }
        }
    }

    /// Names that match none of `names` and none of their last parts.
    pub fn foreign<'a>(&'a self, names: &[String]) -> Vec<&'a str> {
        let matches = |key: &str| names.iter().any(|name| name == key || name.rsplit('/').next() == Some(key));
        self.entries.iter().map(|(key, _)| key.as_str()).filter(|key| !matches(key)).collect()
    }

    /// Names that match none of `checks`.
    pub fn unknown<'a>(&'a self, checks: &[super::Check]) -> Vec<&'a str> {
        let matches = |key: &str| checks.iter().any(|c| c.name == key || c.name.rsplit('/').next() == Some(key));
        self.entries.iter().map(|(key, _)| key.as_str()).filter(|key| !matches(key)).collect()
    }
}
