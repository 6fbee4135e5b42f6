//! Which methods a chart or a matrix has.

use std::collections::BTreeSet;

use clap::Args;
use clap::builder::RangedU64ValueParser;

use crate::cli::commands::chart::quoted;
use crate::measure::Method;

/// The highest degree of FEniCSx that is measured.
const HIGHEST: u64 = 5;

/// The methods asked for.
#[derive(Debug, Clone, Args)]
pub struct MethodOptions {
    /// Only these methods; may be repeated
    #[arg(long, value_name = "NAME", value_parser = known)]
    pub method: Vec<Method>,
    /// FEniCSx in these degrees in place of 1 and 2, each from 1 to 5, with commas between: of one degree more than stresses beside
    /// it
    #[arg(long, value_name = "P,…", value_delimiter = ',', value_parser = RangedU64ValueParser::<u8>::new().range(1..=HIGHEST))]
    pub primal_degree: Vec<u8>,
}

impl MethodOptions {
    /// Those that are run, in the order of tables.
    pub fn chosen(&self) -> Vec<Method> {
        let of_degrees = |method: &Method| self.primal_degree.iter().any(|p| Method::Displacements(*p) == *method);
        let named = |method: &Method| match self.method.is_empty() {
            true => {
                Method::usual().any(|usual| usual == *method) && (!method.is_primal() || self.primal_degree.is_empty())
            }
            false => self.method.contains(method),
        };
        Method::all().filter(|method| named(method) || of_degrees(method)).collect()
    }

    /// The words of a command line that choose the same.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let degrees = BTreeSet::from_iter(&self.primal_degree).into_iter().map(u8::to_string).collect::<Vec<_>>();
        let degrees = (!degrees.is_empty()).then(|| format!("--primal-degree {}", degrees.join(",")));
        self.method.iter().map(|m| format!("--method {}", quoted(m.name()))).chain(degrees)
    }
}

/// The method of that name, or the names there are.
pub(in crate::cli) fn known(name: &str) -> Result<Method, String> {
    let names = Method::all().map(Method::name).collect::<Vec<_>>().join(", ");
    Method::of_name(name).ok_or_else(|| format!("there is no method {name}; choose from {names}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Solver;

    #[test]
    fn degrees_take_the_place_of_the_usual_ones_and_join_what_is_named() {
        let chosen = |method: &[Method], degrees: &[u8]| {
            MethodOptions { method: method.to_vec(), primal_degree: degrees.to_vec() }.chosen()
        };
        let primal = |chosen: Vec<Method>| chosen.into_iter().filter(|m| m.is_primal()).collect::<Vec<_>>();
        let quadratic = Method::Stresses(Solver::Condensed, 2);
        assert_eq!(chosen(&[], &[]), Method::usual().collect::<Vec<_>>());
        assert_eq!(primal(chosen(&[], &[3, 2])), [2, 3].map(Method::Displacements));
        assert_eq!(chosen(&[], &[3]).len(), Method::usual().count() - 1);
        assert_eq!(chosen(&[quadratic], &[3]), [quadratic, Method::Displacements(3)]);
        assert_eq!(chosen(&[Method::Displacements(4)], &[]), [Method::Displacements(4)]);
    }

    #[test]
    fn the_words_choose_the_same() {
        let asked = MethodOptions { method: vec![Method::Displacements(1)], primal_degree: vec![4, 3, 4] };
        assert_eq!(asked.words().collect::<Vec<_>>(), ["--method 'FEniCSx P1'", "--primal-degree 3,4"]);
    }
}
