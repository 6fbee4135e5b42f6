//! The methods that are measured against each other.

use std::borrow::Cow;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::dual::Solver;
use crate::study::Adapt;

/// A way to answer a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// Equilibrated stresses of a degree on the mesh as it is.
    Stresses(Solver, u8),
    /// Equilibrated stresses, linear to begin with, on meshes refined where the gap is, by the condensed method.
    Adaptive(Adapt),
    /// FEniCSx with displacements of a degree.
    Displacements(u8),
}

/// All methods in the order of tables, with their names on the command line and in tables.
const NAMED: [(Method, &str); 14] = [
    (Method::CONDENSED, "condensed"),
    (Method::Stresses(Solver::Condensed, 2), "condensed-p2"),
    (Method::Stresses(Solver::Condensed, 3), "condensed-p3"),
    (Method::Stresses(Solver::Condensed, 4), "condensed-p4"),
    (Method::Adaptive(Adapt::H), "adaptive"),
    (Method::Adaptive(Adapt::Hp), "adaptive-hp"),
    (Method::Stresses(Solver::ActiveSet, 1), "active-set"),
    (Method::CLARABEL, "clarabel"),
    (Method::UZAWA, "uzawa"),
    (Method::Displacements(1), "FEniCSx P1"),
    (Method::Displacements(2), "FEniCSx P2"),
    (Method::Displacements(3), "FEniCSx P3"),
    (Method::Displacements(4), "FEniCSx P4"),
    (Method::Displacements(5), "FEniCSx P5"),
];

impl Method {
    /// One sparse factorisation, contact on its Schur complement, linear stresses.
    pub const CONDENSED: Method = Method::Stresses(Solver::Condensed, 1);
    /// Interior point, linear stresses.
    pub const CLARABEL: Method = Method::Stresses(Solver::Clarabel, 1);
    /// The paper's iteration.
    pub const UZAWA: Method = Method::Stresses(Solver::Uzawa, 1);

    /// All of them, in the order of tables.
    pub fn all() -> impl Iterator<Item = Method> + Clone {
        NAMED.into_iter().map(|(method, _)| method)
    }

    /// Those that are run where none are named; displacements are then linear and quadratic.
    pub fn usual() -> impl Iterator<Item = Method> {
        Self::all().filter(|method| !method.is_primal() || method.degree() <= 2)
    }

    /// Name on the command line and in tables.
    pub fn name(self) -> &'static str {
        NAMED.iter().find(|(method, _)| *method == self).map_or("unnamed", |(_, name)| name)
    }

    /// Name in JSON.
    fn key(self) -> Cow<'static, str> {
        match self {
            Method::Displacements(degree) => Cow::Owned(format!("fenics-p{degree}")),
            Method::Stresses(..) | Method::Adaptive(_) => Cow::Borrowed(self.name()),
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
        NAMED.iter().find(|(_, known)| *known == name).map(|(method, _)| *method)
    }

    /// Place in [`Method::all`].
    pub fn index(self) -> usize {
        Self::all().position(|method| method == self).unwrap_or(0)
    }

    /// Polynomial degree of its stresses, which an adaptive method begins with, or of its displacements where it is the displacement
    /// model.
    pub fn degree(self) -> usize {
        match self {
            Method::Stresses(_, degree) | Method::Displacements(degree) => usize::from(degree),
            Method::Adaptive(_) => 1,
        }
    }

    /// True if its stresses are of a higher degree than those of the paper.
    pub fn is_higher(self) -> bool {
        !self.is_primal() && self.degree() > 1
    }

    /// True if it refines on the way to a tolerance.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Method::Adaptive(_))
    }

    /// True if it delivers a two-sided bracket of its own.
    pub fn has_bracket(self) -> bool {
        !self.is_primal()
    }

    /// True if it is the displacement model.
    pub fn is_primal(self) -> bool {
        matches!(self, Method::Displacements(_))
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.key())
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let key = String::deserialize(deserializer)?;
        let found = Method::all().find(|method| method.key() == key);
        found.ok_or_else(|| serde::de::Error::custom(format!("there is no method {key}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_found_by_its_name_and_place() {
        for (i, method) in Method::all().enumerate() {
            assert_eq!(Method::of_name(method.name()), Some(method));
            assert_eq!(method.index(), i);
            let stored = serde_json::to_string(&method).expect("a name");
            assert_eq!(serde_json::from_str::<Method>(&stored).expect("a method"), method);
            if method.is_primal() || method.is_higher() {
                assert!(method.name().ends_with(&method.degree().to_string()));
            }
        }
        assert_eq!(Method::of_name("newton"), None);
        let usual: Vec<Method> = Method::usual().filter(|method| method.is_primal()).collect();
        assert_eq!(usual, [1, 2].map(Method::Displacements));
    }
}
