//! Equilibrium elements: spaces of stresses on a triangle.

mod bound;
mod composite;
mod continuity;
mod dimension;
mod divergence;
mod energy;
mod fields;
mod frame;
mod interpolation;
mod span;
mod tractions;

pub use composite::Composite;
pub use continuity::inner_jump;
pub use dimension::traction_condition;
pub use divergence::divergence;
pub use energy::{orthonormality, particular};
pub use fields::{Fields, Nodal, Particular};
pub use tractions::{coefficients, resultant};

use super::displacement::Shape;
use super::finding::{Fault, Property};
use super::material::Material;
use crate::element::{self, EquilibriumElement};

/// A space of stresses under test.
///
/// ```
/// use hypercircle::element::block;
/// use hypercircle::workbench::stress::SolverElement;
/// use hypercircle::workbench::{Options, Report};
///
/// let report = Report::of_stress(&SolverElement(block(1)), &Options::default());
/// assert!(report.passed, "{}", report.verdict);
/// ```
pub trait StressElement {
    /// Its name.
    fn name(&self) -> &str;

    /// Polynomial degree p of stresses and tractions.
    fn degree(&self) -> usize;

    /// Its fields on a counter-clockwise triangle.
    fn fields(&self, corners: [[f64; 2]; 3], material: &element::Material, body_force: [f64; 2]) -> Fields;

    /// The element as the dual methods take it, where it is one for them.
    fn solver(&self) -> Option<&'static dyn EquilibriumElement> {
        None
    }
}

/// An equilibrium element of the library, or one of somebody's own.
pub struct SolverElement(pub &'static dyn EquilibriumElement);

impl StressElement for SolverElement {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn degree(&self) -> usize {
        self.0.degree()
    }

    fn fields(&self, corners: [[f64; 2]; 3], material: &element::Material, body_force: [f64; 2]) -> Fields {
        Fields::of(self.0, corners, material, body_force)
    }

    fn solver(&self) -> Option<&'static dyn EquilibriumElement> {
        Some(self.0)
    }
}

/// Properties checked on an equilibrium element, in the order of a report: one file each, one line each.
pub const PROPERTIES: &[Property<dyn StressElement>] = &[
    dimension::DIMENSION,
    dimension::TRACTIONS,
    divergence::DIVERGENCE,
    continuity::CONTINUITY,
    tractions::COEFFICIENTS,
    tractions::RESULTANT,
    energy::ORTHONORMAL,
    energy::PARTICULAR,
    interpolation::INTERPOLATION,
    frame::FRAME,
    span::SPAN,
    bound::BOUND,
];

/// Poisson's ratios of the sweeps.
const POISSON: [f64; 2] = [0.3, 0.4999];
/// A body force.
const FORCE: [f64; 2] = [0.6, -1.0];

/// The largest of a figure over shapes and Poisson's ratios, and where.
fn worst(e: &dyn StressElement, figure: impl Fn(&Fields) -> f64) -> (f64, String) {
    let (mut value, mut place) = (0.0_f64, String::new());
    for Shape { name, corners } in super::displacement::sweep(3) {
        let [a, b, c] = corners[..] else { continue };
        for poisson in POISSON {
            let fields = e.fields([a, b, c], &Material::USUAL.with_poisson(poisson).compliance(), FORCE);
            if !fields.is_finite() {
                return (f64::NAN, format!("{name}, ν = {poisson}, where a stress is no number"));
            }
            let found = figure(&fields);
            if found > value || place.is_empty() {
                place = format!("{name}, ν = {poisson}");
                value = found;
            }
        }
    }
    (value, place)
}

/// The fields on the shape without symmetry.
fn usual(e: &dyn StressElement) -> Result<Fields, Fault> {
    let corners = [[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]];
    let fields = e.fields(corners, &Material::USUAL.compliance(), FORCE);
    match fields.fields.is_empty() || !fields.is_finite() {
        true => Err(Fault::Failed("The space is empty, or a stress in it is no number.".into())),
        false => Ok(fields),
    }
}
