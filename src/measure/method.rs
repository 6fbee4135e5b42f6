//! The methods that are measured against each other.

use serde::{Deserialize, Serialize};

use crate::dual::{self, DualMethod};
use crate::study::Adapt;

/// A way to answer a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// One sparse factorisation, contact on its Schur complement.
    Condensed,
    /// The same with stresses of degree 2.
    CondensedP2,
    /// The same with stresses of degree 3.
    CondensedP3,
    /// The same with stresses of degree 4.
    CondensedP4,
    /// Linear stresses on meshes refined where the gap is.
    Adaptive,
    /// Stresses whose degrees grow, on meshes refined, where the gap is.
    AdaptiveHp,
    /// Active set, refactorising at each step.
    ActiveSet,
    /// Interior point.
    Clarabel,
    /// The paper's iteration.
    Uzawa,
    /// Linear displacements.
    FenicsP1,
    /// Quadratic displacements.
    FenicsP2,
    /// Cubic displacements, beside quadratic stresses.
    FenicsP3,
    /// Displacements of degree 4.
    FenicsP4,
    /// Displacements of degree 5.
    FenicsP5,
}

/// What a method is made of.
pub enum Family {
    /// Equilibrated stresses on the mesh as it is.
    Dual(Box<dyn DualMethod>),
    /// Equilibrated stresses on meshes, and with degrees, that are refined on the way.
    Adaptive(Adapt, Box<dyn DualMethod>),
    /// FEniCSx with displacements of this degree.
    Primal(u8),
}

impl Method {
    /// All of them, in the order of tables.
    pub const ALL: [Method; 14] = [
        Method::Condensed,
        Method::CondensedP2,
        Method::CondensedP3,
        Method::CondensedP4,
        Method::Adaptive,
        Method::AdaptiveHp,
        Method::ActiveSet,
        Method::Clarabel,
        Method::Uzawa,
        Method::FenicsP1,
        Method::FenicsP2,
        Method::FenicsP3,
        Method::FenicsP4,
        Method::FenicsP5,
    ];

    /// Those that are run where none are named; displacements are then linear and quadratic.
    pub fn usual() -> impl Iterator<Item = Method> {
        Self::ALL.into_iter().filter(|method| !method.is_primal() || method.degree() <= 2)
    }

    /// The displacement model of that degree.
    pub fn primal(degree: u8) -> Option<Method> {
        Self::ALL.into_iter().find(|method| method.is_primal() && method.degree() == usize::from(degree))
    }

    /// Name in files, on the command line and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Method::Condensed => "condensed",
            Method::CondensedP2 => "condensed-p2",
            Method::CondensedP3 => "condensed-p3",
            Method::CondensedP4 => "condensed-p4",
            Method::Adaptive => "adaptive",
            Method::AdaptiveHp => "adaptive-hp",
            Method::ActiveSet => "active-set",
            Method::Clarabel => "clarabel",
            Method::Uzawa => "uzawa",
            Method::FenicsP1 => "FEniCSx P1",
            Method::FenicsP2 => "FEniCSx P2",
            Method::FenicsP3 => "FEniCSx P3",
            Method::FenicsP4 => "FEniCSx P4",
            Method::FenicsP5 => "FEniCSx P5",
        }
    }

    /// Its name, or that of a displacement `solver` that was run in the place of FEniCSx, with the degree.
    pub fn name_with(self, solver: Option<&str>) -> String {
        match solver {
            Some(solver) => format!("{solver} P{}", self.degree()),
            None => self.name().to_string(),
        }
    }

    /// The method of that name.
    pub fn of_name(name: &str) -> Option<Method> {
        Self::ALL.into_iter().find(|m| m.name() == name)
    }

    /// Place in [`Method::ALL`].
    pub fn index(self) -> usize {
        Self::ALL.iter().position(|m| *m == self).unwrap_or(0)
    }

    /// What it is made of.
    pub fn family(self) -> Family {
        match self {
            Method::Condensed | Method::CondensedP2 | Method::CondensedP3 | Method::CondensedP4 => {
                Family::Dual(Box::new(dual::Condensed::default()))
            }
            Method::Adaptive => Family::Adaptive(Adapt::H, Box::new(dual::Condensed::default())),
            Method::AdaptiveHp => Family::Adaptive(Adapt::Hp, Box::new(dual::Condensed::default())),
            Method::ActiveSet => Family::Dual(Box::new(dual::ActiveSet::default())),
            Method::Clarabel => Family::Dual(Box::new(dual::Clarabel::default())),
            Method::Uzawa => Family::Dual(Box::new(dual::Uzawa::default())),
            Method::FenicsP1 | Method::FenicsP2 | Method::FenicsP3 | Method::FenicsP4 | Method::FenicsP5 => {
                Family::Primal(self.degree() as u8)
            }
        }
    }

    /// Polynomial degree of its stresses, which an adaptive method begins with, or of its displacements where it is the displacement
    /// model.
    pub fn degree(self) -> usize {
        match self {
            Method::Condensed | Method::Adaptive | Method::ActiveSet | Method::Clarabel | Method::Uzawa => 1,
            Method::FenicsP1 | Method::AdaptiveHp => 1,
            Method::CondensedP2 | Method::FenicsP2 => 2,
            Method::CondensedP3 | Method::FenicsP3 => 3,
            Method::CondensedP4 | Method::FenicsP4 => 4,
            Method::FenicsP5 => 5,
        }
    }

    /// Whether its stresses are of a higher degree than those of the paper.
    pub fn is_higher(self) -> bool {
        !self.is_primal() && self.degree() > 1
    }

    /// What it refines on the way to a tolerance.
    pub fn adapt(self) -> Option<Adapt> {
        match self.family() {
            Family::Adaptive(adapt, _) => Some(adapt),
            _ => None,
        }
    }

    /// Whether it refines on the way to a tolerance.
    pub fn is_adaptive(self) -> bool {
        self.adapt().is_some()
    }

    /// Whether it delivers a two-sided bracket of its own.
    pub fn has_bracket(self) -> bool {
        !self.is_primal()
    }

    /// Whether it is the displacement model.
    pub fn is_primal(self) -> bool {
        matches!(self.family(), Family::Primal(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_found_by_its_name_and_place() {
        for (i, method) in Method::ALL.into_iter().enumerate() {
            assert_eq!(Method::of_name(method.name()), Some(method));
            assert_eq!(method.index(), i);
            if method.is_primal() || method.is_higher() {
                assert!(method.name().ends_with(&method.degree().to_string()));
            }
        }
        assert_eq!(Method::of_name("newton"), None);
        let usual: Vec<Method> = Method::usual().filter(|method| method.is_primal()).collect();
        assert_eq!(usual, [Method::FenicsP1, Method::FenicsP2]);
        assert_eq!([1, 3, 9].map(Method::primal), [Some(Method::FenicsP1), Some(Method::FenicsP3), None]);
    }
}
