//! Results that have a name in the scene: quantities and contacts.

use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays;
use hypercircle::report::{ContactSummary, QuantitySummary};

/// A quantity of the scene, with an interval that holds its exact value.
#[pyclass(frozen, module = "hypercircle")]
pub struct Quantity {
    of: QuantitySummary,
    firmness: &'static str,
}

impl Quantity {
    /// With how firmly its interval holds, before "within".
    pub fn new(of: QuantitySummary, firmness: &'static str) -> Self {
        Quantity { of, firmness }
    }
}

#[pymethods]
impl Quantity {
    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.of.name
    }

    /// `displacement`, `force`, `moment` or `stress`.
    #[getter]
    fn kind(&self) -> &str {
        &self.of.kind
    }

    /// The value of the solution, `None` where it is not known.
    #[getter]
    fn value(&self) -> Option<f64> {
        Some(self.of.value).filter(|value| value.is_finite())
    }

    /// The exact value is no less; −inf where nothing is guaranteed.
    #[getter]
    fn lower(&self) -> f64 {
        self.of.lower
    }

    /// The exact value is no more; inf where nothing is guaranteed.
    #[getter]
    fn upper(&self) -> f64 {
        self.of.upper
    }

    /// The wider interval of first order, to compare with.
    #[getter]
    fn first_order(&self) -> (f64, f64) {
        self.of.first_order.into()
    }

    /// Whether equilibrium alone determines the value.
    #[getter]
    fn exact_by_statics(&self) -> bool {
        self.of.exact_by_statics
    }

    /// Why an end is missing, or `None`.
    #[getter]
    fn reason(&self) -> Option<&str> {
        self.of.reason.as_deref()
    }

    /// Whether `value` may be the exact one.
    fn __contains__(&self, value: f64) -> bool {
        !value.is_nan() && self.of.outside(value) == 0.0
    }

    fn __repr__(&self) -> String {
        format!("<Quantity {}>", self.of.in_words(self.firmness))
    }
}

/// A contact: its pressure and what follows from it.
#[pyclass(frozen, module = "hypercircle", name = "Contact")]
pub struct ContactAnswer {
    of: ContactSummary,
    arc_length: Vec<f64>,
    pressure: Vec<f64>,
}

impl ContactAnswer {
    /// Of the stress side.
    pub fn new(of: ContactSummary) -> Self {
        let own = of.profiles.iter().find(|profile| profile.model == "dual");
        let (arc_length, pressure) = own.iter().flat_map(|profile| &profile.points).map(|[s, p]| (*s, *p)).unzip();
        let pressure = without_rounding(pressure);
        ContactAnswer { of, arc_length, pressure }
    }
}

/// Pressures below zero by no more than rounding, relative to the largest, as zero.
fn without_rounding(pressure: Vec<f64>) -> Vec<f64> {
    let rounding = 1e-12 * pressure.iter().fold(0.0, |largest: f64, p| largest.max(p.abs()));
    pressure.into_iter().map(|p| if p < 0.0 && p > -rounding { 0.0 } else { p }).collect()
}

#[pymethods]
impl ContactAnswer {
    /// `first|second`, or `first|rigid`.
    #[getter]
    fn name(&self) -> &str {
        &self.of.name
    }

    /// Arc length along the first side, n numbers that do not fall; two that are equal are a jump of the pressure.
    #[getter]
    fn arc_length<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        arrays::numbers(this, |contact| &contact.arc_length)
    }

    /// Pressure there, n numbers, not negative.
    #[getter]
    fn pressure<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        arrays::numbers(this, |contact| &contact.pressure)
    }

    /// The force (x, y) on the first side.
    #[getter]
    fn force(&self) -> (f64, f64) {
        self.of.resultant.dual.into()
    }

    /// Its moment about the origin.
    #[getter]
    fn moment(&self) -> f64 {
        self.of.moment.dual
    }

    /// The largest pressure.
    #[getter]
    fn pressure_max(&self) -> f64 {
        self.of.pressure_max.dual
    }

    /// The point (x, y) where it is.
    #[getter]
    fn pressure_max_at(&self) -> (f64, f64) {
        self.of.pressure_max_at.dual.into()
    }

    /// Part of the length that carries no pressure.
    #[getter]
    fn open_fraction(&self) -> f64 {
        self.of.open_fraction
    }

    /// Arc lengths where contact ends, between the two ends of the interface.
    #[getter]
    fn contact_ends(&self) -> Vec<f64> {
        self.of.contact_ends.clone()
    }

    /// Length of the interface.
    #[getter]
    fn length(&self) -> f64 {
        self.of.length
    }

    fn __repr__(&self) -> String {
        format!("<Contact {}: force ({}, {})>", self.of.name, self.of.resultant.dual[0], self.of.resultant.dual[1])
    }
}
