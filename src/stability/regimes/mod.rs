//! The rows of the matrix.

mod contact;
mod curved;
mod friction;
mod material;
mod matter;
mod meshes;
mod revolved;
mod units;

use super::known::Known;
use crate::problem::Problem;

/// A family of problems with one parameter.
#[derive(Debug, Clone, Copy)]
pub struct Regime {
    /// Name on the command line and in links.
    pub id: &'static str,
    /// A short description.
    pub title: &'static str,
    /// The parameter that is swept.
    pub parameter: &'static str,
    /// Where such a failure was reported.
    pub reported: &'static str,
    /// How the truth is known.
    pub truth: &'static str,
    /// The values, from harmless to hard.
    pub values: &'static [f64],
    /// Words in place of the values.
    pub labels: &'static [&'static str],
    /// The values (by number) of a reduced matrix; the first one is always among them.
    pub reduced: &'static [usize],
    /// Makes the problem.
    pub build: fn(f64) -> Result<Problem, String>,
    /// So many of the first values are promised to be correct, see [`super::PROMISING`].
    pub promised: usize,
    /// The known facts about its answer.
    pub known: fn(f64) -> Known,
    /// The guaranteed error may be at most this many times that at the first value.
    pub flat: Option<f64>,
    /// True if a reduced matrix has the methods of higher degree in this row.
    pub degrees: bool,
    /// True if the value is a step length of the paper's iteration, relative to the largest that converges.
    pub is_step_length: bool,
}

/// Common defaults of most regimes.
const PLAIN: Regime = Regime {
    id: "",
    title: "",
    parameter: "",
    reported: "",
    truth: FINER,
    values: &[],
    labels: &[],
    reduced: &[],
    promised: 0,
    build: |_| Err(String::new()),
    known: |_| Known::none(),
    flat: None,
    degrees: false,
    is_step_length: false,
};

/// Where nothing better is known.
const FINER: &str = "energy: bracket on a finer mesh, cut with the FEniCSx P2 energy; forces: statics";
/// As [`FINER`], with another program in the place of FEniCSx: it is judged, and is no witness.
const FINER_ALONE: &str = "energy: bracket on a finer mesh; forces: statics";
/// Where a closed solution is known.
const CLOSED: &str = "closed solution: energy, forces and pressure";

impl Regime {
    /// The problem for a value.
    ///
    /// # Errors
    /// A description of the defects of its mesh.
    pub fn problem(&self, value: f64) -> Result<Problem, String> {
        (self.build)(value)
    }

    /// The value as a reader sees it.
    pub fn label(&self, step: usize) -> String {
        self.labels.get(step).map_or_else(|| format!("{}", Shown(self.values[step])), ToString::to_string)
    }

    /// How the truth is known; with an `own_solver` in the place of FEniCSx, without its energies.
    pub fn truth_with(&self, own_solver: bool) -> &'static str {
        if own_solver && self.truth == FINER { FINER_ALONE } else { self.truth }
    }

    /// The step length to iterate with, where the regime is about it.
    pub fn step_length(&self, value: f64) -> Option<f64> {
        self.is_step_length.then_some(value)
    }
}

struct Shown(f64);

impl std::fmt::Display for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let x = self.0;
        if x == 0.0 || (1e-2..1e4).contains(&x.abs()) { write!(f, "{x}") } else { write!(f, "{x:e}") }
    }
}

/// All regimes.
pub static REGIMES: &[&[Regime]] = &[
    material::REGIMES,
    matter::REGIMES,
    meshes::REGIMES,
    curved::REGIMES,
    units::REGIMES,
    contact::REGIMES,
    revolved::REGIMES,
    friction::REGIMES,
];

/// The regime of that name.
pub fn regime(id: &str) -> Option<&'static Regime> {
    REGIMES.iter().copied().flatten().find(|r| r.id == id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_regime_is_complete_and_its_problems_can_be_made() {
        let mut names = std::collections::HashSet::new();
        for regime in REGIMES.iter().copied().flatten() {
            assert!(names.insert(regime.id), "{} twice", regime.id);
            assert!(!regime.title.is_empty() && !regime.parameter.is_empty() && !regime.values.is_empty());
            assert!(regime.labels.is_empty() || regime.labels.len() == regime.values.len(), "{}", regime.id);
            assert_eq!(regime.reduced.first(), Some(&0), "{}", regime.id);
            assert!(regime.reduced.windows(2).all(|w| w[0] < w[1]));
            assert!(regime.reduced.iter().all(|&i| i < regime.values.len()), "{}", regime.id);
            for &step in regime.reduced {
                let value = regime.values[step];
                let known = (regime.known)(value);
                match regime.problem(value) {
                    Ok(problem) => {
                        let expected = known.resultants.len();
                        assert!(expected == 0 || expected == problem.interfaces.len(), "{} at {value}", regime.id);
                    }
                    // A mesh may be refused, but only with a reason.
                    Err(reason) => assert!(!reason.is_empty(), "{} at {value}", regime.id),
                }
            }
        }
        assert!(names.len() >= 20);
    }

    #[test]
    fn values_read_well() {
        assert_eq!(Shown(0.4999999).to_string(), "0.4999999");
        assert_eq!(Shown(1e-12).to_string(), "1e-12");
        assert_eq!(Shown(1e10).to_string(), "1e10");
        assert_eq!(Shown(0.0).to_string(), "0");
    }
}
