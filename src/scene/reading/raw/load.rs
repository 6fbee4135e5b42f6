//! Tractions.

use schemars::JsonSchema;

use super::{At, Pair};

/// A boundary that is loaded, by `value` (with or without `gradient`) or by `pressure`.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Traction", extend("oneOf" = [{"required": ["value"]}, {"required": ["pressure"]}]))]
pub(in crate::scene) struct RawTraction {
    /// The boundary.
    #[schemars(length(min = 1))]
    pub on: At<String>,
    /// Traction at the origin.
    #[schemars(with = "Option<[f64; 2]>")]
    pub value: Option<Pair>,
    /// Rows of the constant gradient: P(x) = value + gradient · x.
    #[schemars(with = "Option<[[f64; 2]; 2]>")]
    pub gradient: Option<At<Vec<Pair>>>,
    /// Terms of a polynomial beyond it: P(x, y) = value + gradient · (x, y) + Σ term.value · xⁱ yʲ.
    pub terms: Option<At<Vec<RawTerm>>>,
    /// Pressure along the inward normal.
    pub pressure: Option<At<f64>>,
}

/// A term of a traction: value · xⁱ yʲ.
#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Term")]
pub(in crate::scene) struct RawTerm {
    /// i and j, whole numbers that add up to 2 … 6.
    #[schemars(with = "[u8; 2]")]
    pub powers: Pair,
    /// The factor.
    #[schemars(with = "[f64; 2]")]
    pub value: Pair,
}
