//! The faults that only a quantity can have, with their words.

use crate::scene::reading::nearest::{list, suggestion};

/// Faults of a table of `[[quantities]]`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum QuantityFault {
    /// Not exactly one of the keys that say what is wanted.
    #[error("{}", kinds(.table, .found))]
    Kinds {
        /// `[[quantities]] number 2`.
        table: String,
        /// Those that are there, in the order of the format.
        found: Vec<&'static str>,
    },
    /// A name that `--tolerance-of NAME=X` or a report cannot carry.
    #[error("`name` in {table} contains {what}")]
    Name {
        /// The table.
        table: String,
        /// `=`, or what cannot be seen.
        what: &'static str,
    },
    /// Two quantities of one name.
    #[error("two quantities have the name \"{name}\": {first} (line {line}) and {second}")]
    TwoOfOneName {
        /// As written.
        name: String,
        /// The table met first.
        first: String,
        /// The line of its name, from 1.
        line: usize,
        /// The table met second.
        second: String,
    },
    /// A name that nothing has.
    #[error("`{key}` in {table} is \"{found}\", but no {kinds} has that name")]
    Unknown {
        /// The key.
        key: &'static str,
        /// Its table.
        table: String,
        /// As written.
        found: String,
        /// `contact or support`, …
        kinds: &'static str,
        /// Names that exist.
        known: Vec<String>,
    },
    /// A name that several things have.
    #[error("`{key}` in {table} is \"{found}\", which is the name of {}", .owners.join(" and of "))]
    Ambiguous {
        /// The key.
        key: &'static str,
        /// Its table.
        table: String,
        /// As written.
        found: String,
        /// `a body`, `[[supports]] number 1`, …
        owners: Vec<String>,
    },
    /// A window that is no weight, or none whose integral is bounded.
    #[error("`window` in {table} is {found}, but {rule}")]
    Window {
        /// The table.
        table: String,
        /// As written.
        found: String,
        /// The rule that the window breaks.
        rule: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// A polygon that bounds no region.
    #[error("the polygon of {table} {problem}")]
    Region {
        /// The table.
        table: String,
        /// The defect of the polygon.
        problem: String,
        /// The remedy.
        remedy: &'static str,
    },
}

/// The keys that say what a quantity is.
pub(super) const KINDS: [&str; 5] = ["displacement", "force", "moment", "stress", "stress_intensity"];

fn kinds(table: &str, found: &[&str]) -> String {
    let found: Vec<String> = found.iter().map(|key| (*key).to_owned()).collect();
    match found.as_slice() {
        [] => format!("{table} does not say what is wanted"),
        several => format!("{table} asks for {} things at once: {}", several.len(), list(several, '`')),
    }
}

impl QuantityFault {
    /// The remedy, as one clause.
    pub fn remedy(&self) -> String {
        match self {
            QuantityFault::Kinds { found, .. } if found.is_empty() => {
                format!("give one of {}", list(&KINDS.map(str::to_owned), '`'))
            }
            QuantityFault::Kinds { .. } => "write a table [[quantities]] with a name of its own for each".into(),
            QuantityFault::Name { .. } => "choose another name; --tolerance-of NAME=X and reports use it".into(),
            QuantityFault::TwoOfOneName { .. } => "give one of them another name".into(),
            QuantityFault::Unknown { found, known, .. } => suggestion(found, known, "known are", '"'),
            QuantityFault::Ambiguous { .. } => "give one of them another name, in the geometry or mesh too".into(),
            QuantityFault::Window { remedy, .. } | QuantityFault::Region { remedy, .. } => (*remedy).into(),
        }
    }

    /// The words to write under the place in the file.
    pub fn label(&self) -> String {
        match self {
            QuantityFault::Kinds { found, .. } if found.is_empty() => "one key is missing here",
            QuantityFault::Kinds { .. } => "one too many",
            QuantityFault::Name { .. } | QuantityFault::Region { .. } => "here",
            QuantityFault::TwoOfOneName { .. } => "the second of this name",
            QuantityFault::Unknown { .. } => "nothing of this name",
            QuantityFault::Ambiguous { .. } => "which of them?",
            QuantityFault::Window { rule, .. } => rule,
        }
        .into()
    }
}
