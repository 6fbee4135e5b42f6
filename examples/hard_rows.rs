//! The rows of the stability matrix over MPI ranks, held against the condensed method: prints a table of docs/scale.md.
//!
//! Run with `ci/scale rows [RANKS [SOLVER [ROW…]]]`, for instance `ci/scale rows "1 2 4" gamg slivers fan`. It fails where a bound
//! differs by more than 10⁻⁹ of the energy, equilibrium is missed by more, or one method refuses what the other solves.

use std::error::Error;
use std::fmt;
use std::path::Path;
use std::time::Duration;

use clap::ValueEnum;
use hypercircle::bounds::Bracket;
use hypercircle::dual::{Condensed, DualMethod, LinearSolver, Options, Petsc};
use hypercircle::stability::{REGIMES, Regime};
use hypercircle::study::{Certified, certify_divided};

/// Largest difference of bounds, relative to the larger of both, and largest violation of equilibrium, relative to the load.
const EQUAL: f64 = 1e-9;
const LIMIT: Duration = Duration::from_secs(600);

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let ranks = arguments.next().unwrap_or_else(|| "1 2 4".to_string());
    let linear_solver =
        arguments.next().map_or(Ok(LinearSolver::default()), |name| LinearSolver::from_str(&name, false))?;
    // Beside the folder of the examples.
    let program = std::env::current_exe()?.parent().and_then(Path::parent).map(|built| built.join("hypercircle"));
    let program = program.filter(|program| program.is_file()).ok_or("build the program first: ci/scale does")?;
    let ranks = ranks.split_whitespace().map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    let wanted: Vec<String> = arguments.collect();
    let all = || REGIMES.iter().copied().flatten();
    if let Some(unknown) = wanted.iter().find(|name| all().all(|row| row.id != name.as_str())) {
        return Err(format!("no row is called {unknown}").into());
    }
    // The row about the step length of the paper's iteration has one problem for all values.
    let rows = all().filter(|row| !row.is_step_length && (wanted.is_empty() || wanted.iter().any(|w| w == row.id)));

    println!("| row | ranks | solved | refused by both | lower bounds differ by | upper bounds | equilibrium |");
    println!("|---|--:|--:|--:|--:|--:|--:|");
    let mut unequal = Vec::new();
    for row in rows {
        let expected: Vec<_> = row.values.iter().map(|&value| solve(row, value, &Condensed::default())).collect();
        for &ranks in &ranks {
            let method =
                Petsc { ranks, linear_solver, limit: LIMIT, interpreter: None, program: Some(program.clone()) };
            let mut worst = Difference::default();
            for (step, (&value, expected)) in row.values.iter().zip(&expected).enumerate() {
                let found = solve(row, value, &method);
                if let Some(words) = worst.add(expected, &found) {
                    unequal.push(format!("{} at {} on {ranks} ranks: {words}", row.id, row.label(step)));
                }
            }
            println!("| `{}` | {ranks} {worst}", row.id);
        }
    }
    if unequal.is_empty() { Ok(()) } else { Err(unequal.join("\n").into()) }
}

fn solve(row: &Regime, value: f64, method: &dyn DualMethod) -> Result<Certified, String> {
    let problem = row.problem(value)?;
    certify_divided(problem, method, &Options::default()).map_err(|e| e.to_string())
}

/// The largest differences along a row.
#[derive(Default)]
struct Difference {
    solved: usize,
    refused: usize,
    lower: f64,
    upper: f64,
    equilibrium: f64,
}

impl Difference {
    /// Counts a value in, and says what is wrong with it.
    fn add(&mut self, expected: &Result<Certified, String>, found: &Result<Certified, String>) -> Option<String> {
        let (expected, found) = match (expected, found) {
            (Ok(expected), Ok(found)) => (expected, found),
            (Err(_), Err(_)) => {
                self.refused += 1;
                return None;
            }
            (Ok(_), Err(said)) => return Some(format!("refused, {said}")),
            (Err(said), Ok(_)) => return Some(format!("solved, where the condensed method says: {said}")),
        };
        self.solved += 1;
        let (a, b) = (&expected.bracket, &found.bracket);
        let both = [upper(a), upper(b)];
        let finite = both.iter().filter(|x| x.is_finite()).count();
        let size = [a.lower(), both[0]].into_iter().filter(|x| x.is_finite()).fold(a.round_off, |m, x| m.max(x.abs()));
        let over = |difference: f64| difference.abs() / size.max(f64::MIN_POSITIVE);
        let lower = over(a.lower() - b.lower());
        let upper = match finite {
            0 => 0.0,
            1 => f64::INFINITY,
            _ => over(both[0] - both[1]),
        };
        let equilibrium = found.dual.equilibrium.residual();
        self.lower = self.lower.max(lower);
        self.upper = self.upper.max(upper);
        self.equilibrium = self.equilibrium.max(equilibrium);
        let equal = lower <= EQUAL && upper <= EQUAL && equilibrium <= EQUAL;
        (!equal).then(|| {
            format!("lower bounds {lower:.0e} apart, upper bounds {upper:.0e}, equilibrium missed by {equilibrium:.0e}")
        })
    }
}

/// The free upper bound, infinite where there is none.
fn upper(bracket: &Bracket) -> f64 {
    bracket.free.as_ref().map_or(f64::INFINITY, |free| free.upper())
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Difference { solved, refused, lower, upper, equilibrium } = self;
        write!(f, "| {solved} | {refused} | {lower:.0e} | {upper:.0e} | {equilibrium:.0e} |")
    }
}
