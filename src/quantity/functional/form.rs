//! A quantity as it is asked for: a linear functional, or a number that three of them determine.

use super::value::value_of;
use super::{Functional, Kind, NotBounded};
use crate::element::Displacement;
use crate::problem::Problem;
use crate::quantity::interval::{Interval, Known};
use crate::quantity::invariant::Invariants;
use crate::quantity::point::Wanted;
use crate::scene::{Component, Invariant, PointValue, Quantity, Target};

/// A quantity on a mesh.
#[derive(Debug, Clone)]
pub enum Form {
    /// A linear functional of the solution.
    Linear(Box<Functional>),
    /// A number that the three components of the stress at a point determine.
    Invariant {
        /// σ_xx, σ_yy and σ_xy.
        components: Box<[Functional; 3]>,
        /// Which number.
        of: Invariants,
    },
}

impl Form {
    /// The form of `quantity`.
    ///
    /// # Errors
    /// [`NotBounded`].
    pub fn new(problem: &Problem, quantity: &Quantity) -> Result<Self, NotBounded> {
        match quantity.target {
            Target::Point { body, at, value: PointValue::Invariant(invariant), smoothness } => {
                let component = |component: Component| {
                    Functional::at_point(problem, body, at, smoothness, Wanted::Stress(component.factors()))
                };
                let components = [component(Component::XX)?, component(Component::YY)?, component(Component::XY)?];
                Ok(Form::invariant(problem, (body, at), components, invariant))
            }
            _ => Ok(Form::Linear(Box::new(Functional::new(problem, quantity)?))),
        }
    }

    fn invariant(
        problem: &Problem,
        (body, at): (usize, [f64; 2]),
        components: [Functional; 3],
        invariant: Invariant,
    ) -> Self {
        let out = |stress: [f64; 3]| problem.material(body).out_of_plane(stress, at);
        let offset = out([0.0; 3]);
        let across = out([1.0, 0.0, 0.0]) - offset;
        Form::Invariant { components: Box::new(components), of: Invariants { invariant, across, offset } }
    }

    /// Its kind, for words and sizes.
    pub fn kind(&self) -> Kind {
        match self {
            Form::Linear(functional) => functional.kind,
            Form::Invariant { .. } => Kind::Stress,
        }
    }

    /// The functional, where there is one alone.
    pub fn linear(&self) -> Option<&Functional> {
        match self {
            Form::Linear(functional) => Some(functional),
            Form::Invariant { .. } => None,
        }
    }

    /// Its interval.
    pub fn interval(&self, known: &Known<'_>) -> Interval {
        match self {
            Form::Linear(functional) => known.interval(functional),
            Form::Invariant { components, of } => of.interval(components.each_ref().map(|own| known.interval(own))),
        }
    }

    /// Its value in an admissible displacement alone, as [`value_of`].
    pub fn value_of(&self, problem: &Problem, v: &Displacement) -> Option<f64> {
        match self {
            Form::Linear(functional) => value_of(problem, functional, v),
            Form::Invariant { components, of } => {
                let [xx, yy, xy] = components.each_ref().map(|own| value_of(problem, own, v));
                Some(of.value([xx?, yy?, xy?]))
            }
        }
    }
}
