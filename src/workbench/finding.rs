//! Result of checking a property: one finding, with a number, a sentence and, where it helps, a picture.

use schemars::JsonSchema;
use serde::Serialize;

use crate::report::text::number::significant;

/// One property of an element under test.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Finding {
    /// Stable name, for example `patch-forces`.
    pub name: String,
    /// What the property asks.
    pub asks: String,
    /// Whether the element claims it. A property that could not be looked at is claimed by nobody.
    pub claim: bool,
    /// The number measured; `null` where none could be.
    pub value: Option<f64>,
    /// The largest number that passes; `null` where theory sets no limit.
    pub allowed: Option<f64>,
    /// Whether it holds; `null` where it was not made, which never counts as passed.
    pub passed: Option<bool>,
    /// What was found, in a sentence.
    pub sentence: String,
    /// An SVG picture.
    #[serde(skip)]
    pub picture: Option<String>,
}

impl Finding {
    /// True if a property that the element claims is missing.
    pub fn is_missing(&self) -> bool {
        self.claim && self.passed == Some(false)
    }

    /// One sign for lists: what holds, what is missing, what is absent and not claimed, what was not made.
    pub fn sign(&self) -> &'static str {
        match self.passed {
            Some(true) => "✔",
            Some(false) if self.claim => "✘",
            Some(false) => "·",
            None => "–",
        }
    }

    /// Name, verdict and sentence on one line.
    pub fn in_words(&self) -> String {
        let verdict = match self.passed {
            Some(true) => "holds",
            Some(false) if self.claim => "MISSING",
            Some(false) => "absent, not claimed",
            None => "not made",
        };
        format!("{} {} ({verdict}): {}", self.sign(), self.name, self.sentence)
    }
}

/// Result of measuring a property.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// See [`Finding::value`].
    pub value: f64,
    /// See [`Finding::allowed`].
    pub allowed: f64,
    /// See [`Finding::sentence`].
    pub sentence: String,
    /// See [`Finding::picture`].
    pub picture: Option<String>,
}

impl Measured {
    /// A value with the largest that passes. The sentence gets both numbers behind it.
    pub fn new(value: f64, allowed: f64, sentence: impl Into<String>) -> Self {
        let sentence = format!(
            "{} ({}, allowed {}).",
            sentence.into().trim_end_matches('.'),
            significant(value, 3),
            significant(allowed, 3)
        );
        Measured { value, allowed, sentence, picture: None }
    }

    /// A count, of which none passes; the sentence says it all.
    pub fn count(value: usize, sentence: impl Into<String>) -> Self {
        Measured { value: value as f64, allowed: 0.0, sentence: sentence.into(), picture: None }
    }

    /// Sets the picture.
    pub fn drawn(self, picture: Option<String>) -> Self {
        Measured { picture, ..self }
    }

    /// True if the property holds; a NaN does not pass.
    pub fn passes(&self) -> bool {
        self.value <= self.allowed
    }
}

/// Why a property has no number.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Fault {
    /// There is nothing to look at it with.
    #[error("{0}.")]
    NotMade(String),
    /// The element does not deliver what has to be looked at.
    #[error("{0}")]
    Failed(String),
}

/// A property: one name, one question, one function. Those of displacement elements are listed in
/// [`super::displacement::PROPERTIES`], those of equilibrium elements in [`super::stress::PROPERTIES`].
pub struct Property<S: ?Sized> {
    /// See [`Finding::name`].
    pub name: &'static str,
    /// See [`Finding::asks`].
    pub asks: &'static str,
    /// True if an element claims it unless it says otherwise.
    pub usual: bool,
    /// Looks at the element.
    pub measure: fn(&S) -> Result<Measured, Fault>,
}

impl<S: ?Sized> Property<S> {
    /// The finding on `subject`, which claims the property or not.
    pub fn find(&self, subject: &S, claim: bool) -> Finding {
        let (value, allowed, passed, sentence, picture) = match (self.measure)(subject) {
            Ok(m) => {
                let passed = m.passes();
                (Some(m.value), Some(m.allowed), Some(passed), m.sentence, m.picture)
            }
            Err(fault @ Fault::NotMade(_)) => (None, None, None, fault.to_string(), None),
            Err(fault @ Fault::Failed(_)) => (None, None, Some(false), fault.to_string(), None),
        };
        Finding {
            name: self.name.into(),
            asks: self.asks.into(),
            claim: claim && passed.is_some(),
            value: value.filter(|v| v.is_finite()),
            allowed,
            passed,
            sentence,
            picture,
        }
    }
}
