//! The text of a scene, and what every value in it must be.

use std::ops::Range;
use std::path::Path;

use super::error::{Fault, SceneError};
use super::raw::At;

/// The text under examination; makes errors that point into it.
pub(in crate::scene) struct Source<'a> {
    pub text: &'a str,
    pub path: &'a Path,
}

impl Source<'_> {
    pub fn error(&self, span: Range<usize>, fault: Fault) -> SceneError {
        SceneError::at(self.path, self.text, span, fault)
    }

    /// The value as the user wrote it, cut if long.
    pub fn written(&self, span: Range<usize>) -> String {
        let text = self.text.get(span).unwrap_or_default().trim();
        if text.chars().count() > 40 { text.chars().take(39).chain(['…']).collect() } else { text.to_owned() }
    }

    /// The line of a byte, from 1.
    pub fn line(&self, at: usize) -> usize {
        self.text.bytes().take(at).filter(|&b| b == b'\n').count() + 1
    }

    /// `number`, if it is finite and `holds`; the error says that `rule` does not hold.
    pub fn number(
        &self,
        number: &At<f64>,
        (table, key): (&str, &str),
        holds: impl Fn(f64) -> bool,
        (rule, remedy): (&'static str, &'static str),
    ) -> Result<f64, SceneError> {
        let value = number.value;
        let (rule, remedy) = match () {
            _ if !value.is_finite() => NOT_FINITE,
            _ if value.abs() > LARGEST => OVERFLOWS,
            _ if !holds(value) => (rule, remedy),
            _ => return Ok(value),
        };
        let (table, key, found) = (table.to_owned(), key.to_owned(), self.written(number.span()));
        Err(self.error(number.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// `number`, if it is positive and its reciprocal is no larger than numbers may be.
    pub fn positive(
        &self,
        number: &At<f64>,
        key: (&str, &str),
        words: (&'static str, &'static str),
    ) -> Result<f64, SceneError> {
        let value = self.number(number, key, |x| x > 0.0, words)?;
        self.number(number, key, |_| value >= 1.0 / LARGEST, UNDERFLOWS)
    }

    /// `N` finite numbers whose energies do not overflow.
    pub fn vector<const N: usize>(&self, list: &At<Vec<f64>>, place: (&str, &str)) -> Result<[f64; N], SceneError> {
        let vector = self.point(list, place)?;
        if vector.iter().all(|x| x.abs() <= LARGEST) {
            return Ok(vector);
        }
        let ((table, key), (rule, remedy)) = (place, OVERFLOWS);
        let (table, key, found) = (table.to_owned(), key.to_owned(), self.written(list.span()));
        Err(self.error(list.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// `N` finite numbers.
    pub fn point<const N: usize>(
        &self,
        list: &At<Vec<f64>>,
        (table, key): (&str, &str),
    ) -> Result<[f64; N], SceneError> {
        let (table, key) = (table.to_owned(), key.to_owned());
        let Ok(vector) = <[f64; N]>::try_from(list.value.as_slice()) else {
            let found = counted(list.value.len(), "component");
            let remedy = "write one number per direction, [x, y]; in a gap table, [s, g]";
            return Err(self.error(list.span(), Fault::Count { key, table, found, expected: N.to_string(), remedy }));
        };
        if vector.iter().all(|x| x.is_finite()) {
            return Ok(vector);
        }
        let (rule, remedy) = NOT_FINITE;
        let found = self.written(list.span());
        Err(self.error(list.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// The unit vector along a direction of any length but zero.
    pub fn unit(&self, list: &At<Vec<f64>>, place: (&str, &str), remedy: &'static str) -> Result<[f64; 2], SceneError> {
        let vector = self.vector::<2>(list, place)?;
        let length = vector[0].hypot(vector[1]);
        let number = At { value: length, start: list.start, end: list.end };
        self.number(&number, place, |length| length > 0.0, ("a direction has a length", remedy))?;
        self.number(&number, place, |length| length >= 1.0 / LARGEST, UNDERFLOWS)?;
        Ok(vector.map(|x| x / length))
    }

    /// A non-empty name.
    pub fn name(
        &self,
        name: &At<String>,
        (table, key): (&str, &str),
        remedy: &'static str,
    ) -> Result<String, SceneError> {
        if name.value.trim().is_empty() {
            let (table, key) = (table.to_owned(), key.to_owned());
            return Err(self.error(name.span(), Fault::EmptyName { key, table, remedy }));
        }
        Ok(name.value.clone())
    }
}

/// Largest number in a scene: the square of a load, over a modulus, times an area and a thickness of such sizes is still
/// a number.
pub(in crate::scene) const LARGEST: f64 = 1e30;
pub(in crate::scene) const OVERFLOWS: (&str, &str) =
    ("energies of numbers beyond 1e30 overflow", "choose units in which the numbers are ordinary ones");
const UNDERFLOWS: (&str, &str) =
    ("energies overflow where this is below 1e-30", "choose units in which the numbers are ordinary ones");

const NOT_FINITE: (&str, &str) = ("every number must be finite", "write a finite number");

/// A text as the beginning of a sentence.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// `1 point`, `3 points`, `2 vertices`.
pub fn counted(n: usize, noun: &str) -> String {
    match (n, noun.strip_suffix("ex")) {
        (1, _) => format!("1 {noun}"),
        (_, Some(stem)) => format!("{n} {stem}ices"),
        (_, None) => format!("{n} {noun}s"),
    }
}
