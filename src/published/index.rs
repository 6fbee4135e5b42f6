//! The index of the collection and its scenes, as they lie in `cases/published/`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// The files of `cases/published/`, by name.
macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../cases/published/", $name, ".toml")))),*]
    };
}

const INDEX: &str = include_str!("../../cases/published/index.toml");
const SCENES: [(&str, &str); 14] = scenes![
    "cook",
    "kirsch",
    "hondros",
    "lame",
    "turning_disc",
    "cantilever",
    "bimetal",
    "centre_crack",
    "edge_crack",
    "double_edge_crack",
    "edge_crack_bending",
    "flat_punch",
    "hertz",
    "le1",
];

/// A benchmark: a scene, how closely its quantities are to be known, and what was published of them.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Name of the case and of its scene.
    pub name: String,
    /// The half-width that the interval of a quantity is to be below, relative to its value.
    pub refine: BTreeMap<String, f64>,
    /// The published numbers.
    pub values: Vec<Value>,
}

/// A published number.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Value {
    /// The quantity of the scene that it is a value of.
    pub quantity: String,
    /// The number as printed, or evaluated from `formula`.
    #[serde(rename = "published")]
    pub printed: String,
    /// The formula that it comes from.
    pub formula: Option<String>,
    /// How far the true value may be from it.
    pub accuracy: f64,
    /// Where the accuracy comes from.
    pub because: String,
    /// Who published it, and where.
    pub source: String,
    /// How the number was checked against its source.
    pub checked: String,
    /// The explanation where it lies outside.
    pub finding: Option<String>,
    /// Why the quantity is not the one that was published, where nothing can be bounded at that place.
    pub elsewhere: Option<String>,
}

impl Case {
    /// Text of its scene.
    pub fn scene(&self) -> &'static str {
        SCENES.iter().find(|(name, _)| *name == self.name).map_or("", |(_, text)| text)
    }

    /// First words of its scene: the title.
    pub fn title(&self) -> &'static str {
        let title = self.scene().lines().find_map(|line| line.strip_prefix("title = "));
        title.unwrap_or_default().trim_matches('"')
    }
}

impl Value {
    /// The number; `NaN` where the index has none, which agrees with nothing.
    pub fn number(&self) -> f64 {
        self.printed.parse().unwrap_or(f64::NAN)
    }
}

/// The benchmarks, in the order of the index.
pub fn cases() -> &'static [Case] {
    #[derive(Deserialize)]
    struct Index {
        cases: Vec<Case>,
    }
    // A test reads the index, so that a program with one that cannot be read is not made.
    static CASES: LazyLock<Vec<Case>> =
        LazyLock::new(|| toml::from_str::<Index>(INDEX).map(|index| index.cases).unwrap_or_default());
    &CASES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_index_and_the_scenes_belong_together() {
        let names: Vec<&str> = cases().iter().map(|case| case.name.as_str()).collect();
        let mut expected = SCENES.map(|(name, _)| name).to_vec();
        let mut found = names.clone();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
        for case in cases() {
            assert!(!case.title().is_empty() && !case.values.is_empty() && !case.refine.is_empty(), "{}", case.name);
            for value in &case.values {
                assert!(value.number().is_finite() && value.accuracy > 0.0, "{}: {}", case.name, value.quantity);
                assert!(value.accuracy < 0.01 * value.number().abs(), "{}: {}", case.name, value.quantity);
            }
        }
    }
}
