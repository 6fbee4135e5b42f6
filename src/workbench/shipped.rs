//! The elements that come with the program, and what each claims.

use super::displacement::{self, DisplacementElement};
use super::formulas::{Family, Variant};
use super::material::Material;
use super::report::{Options, Report};
use super::stress::{self, Composite, SolverElement, StressElement};
use crate::element::block;

/// An element under test.
pub enum Subject {
    /// A displacement element.
    Displacement(Box<DisplacementElement>),
    /// An equilibrium element.
    Stress(Box<dyn StressElement>),
}

impl Subject {
    /// Looks at every property.
    pub fn examine(&self, options: &Options) -> Report {
        match self {
            Subject::Displacement(e) => Report::of_displacement(e, options),
            Subject::Stress(e) => Report::of_stress(e.as_ref(), options),
        }
    }
}

/// An element that comes with the program.
pub struct Shipped {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its description.
    pub about: &'static str,
    /// Properties that are usual and that it does not claim.
    pub lacks: &'static [&'static str],
    /// Properties that it claims beside the usual ones.
    pub adds: &'static [&'static str],
    make: fn() -> Result<Subject, String>,
}

impl Shipped {
    /// The element.
    ///
    /// # Errors
    /// It cannot be made, which no shipped one should say.
    pub fn subject(&self) -> Result<Subject, String> {
        (self.make)()
    }

    /// The properties that it claims.
    pub fn claims(&self) -> Vec<&'static str> {
        let displacement = displacement::PROPERTIES.iter().map(|p| (p.name, p.usual));
        let stress = stress::PROPERTIES.iter().map(|p| (p.name, p.usual));
        let all: Vec<_> = match self.subject() {
            Ok(Subject::Stress(_)) => stress.collect(),
            _ => displacement.collect(),
        };
        let is_claimed =
            |(name, usual): &(&str, bool)| self.adds.contains(name) || *usual && !self.lacks.contains(name);
        all.into_iter().filter(is_claimed).map(|(name, _)| name).collect()
    }
}

/// The element of that name.
pub fn shipped(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|s| s.name == name)
}

fn family(family: Family, variant: Variant, name: &str) -> Result<Subject, String> {
    family.element(name, Material::USUAL, variant).map(|e| Subject::Displacement(Box::new(e)))
}

fn stresses(element: impl StressElement + 'static) -> Result<Subject, String> {
    Ok(Subject::Stress(Box::new(element)))
}

/// All of them.
pub const SHIPPED: &[Shipped] = &[
    Shipped {
        name: "block-1",
        about: "equilibrium block of Watwood and Hartz, linear stresses on three subtriangles",
        lacks: &[],
        adds: &[],
        make: || stresses(SolverElement(block(1))),
    },
    Shipped {
        name: "block-2",
        about: "equilibrium block of degree 2",
        lacks: &[],
        adds: &[],
        make: || stresses(SolverElement(block(2))),
    },
    Shipped {
        name: "block-3",
        about: "equilibrium block of degree 3",
        lacks: &[],
        adds: &[],
        make: || stresses(SolverElement(block(3))),
    },
    Shipped {
        name: "block-4",
        about: "equilibrium block of degree 4",
        lacks: &[],
        adds: &[],
        make: || stresses(SolverElement(block(4))),
    },
    Shipped {
        name: "single-triangle",
        about: "linear equilibrium triangle without subdivision, which has spurious modes",
        lacks: &["dimension", "traction-rank"],
        adds: &[],
        make: || stresses(Composite::SINGLE),
    },
    Shipped {
        name: "johnson-mercier",
        about: "linear stresses of Johnson and Mercier with continuous tractions, which need not balance themselves",
        lacks: &["dimension", "divergence", "self-equilibrium"],
        adds: &[],
        make: || stresses(Composite::JOHNSON_MERCIER),
    },
    Shipped {
        name: "p1",
        about: "linear displacement triangle, which locks as ν → ½",
        lacks: &[],
        adds: &[],
        make: || family(Family::P1, Variant::Right, "P1"),
    },
    Shipped {
        name: "p2",
        about: "quadratic displacement triangle",
        lacks: &[],
        adds: &["incompressible"],
        make: || family(Family::P2, Variant::Right, "P2"),
    },
    Shipped {
        name: "q4",
        about: "bilinear displacement quadrilateral, fully integrated, which locks as ν → ½",
        lacks: &[],
        adds: &[],
        make: || family(Family::Q4, Variant::Right, "Q4"),
    },
    Shipped {
        name: "q4-reduced",
        about: "bilinear displacement quadrilateral with one quadrature point, which has hourglass modes",
        lacks: &["rank", "bound", "convergence"],
        adds: &["incompressible"],
        make: || family(Family::Q4, Variant::OnePoint, "Q4, one point"),
    },
];
