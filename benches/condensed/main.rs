//! Cost of contact: ratios of the condensed method to a plain factorisation, to the other methods and to FEniCSx.
//!
//! `cargo bench --bench condensed -- [squares per side …] [--full] [--limit seconds]`
//!
//! Two unit blocks with lift-off, n × n squares each, so 4n² triangles; in the family `squares` all triangles are
//! congruent to one of eight, in the family `rough` inner vertices are moved at random and none are. Every measurement
//! runs in a process of its own with one thread, so that peaks of memory separate; the least of three runs counts
//! (fewer where they are long). Times are those of the processor: a busy machine changes them little.

mod job;
mod machine;
mod table;

#[path = "../../tests/support/mod.rs"]
mod support;

use std::time::Duration;

use job::{Family, Job, Measured};

/// The measurements that the command line asks for.
struct Plan {
    sizes: Vec<usize>,
    limit: Duration,
    rough: Vec<usize>,
}

impl Plan {
    fn new(arguments: &[String]) -> Result<Self, String> {
        let full = arguments.iter().any(|a| a == "--full");
        let mut plan =
            Plan { sizes: Vec::new(), limit: Duration::from_secs(if full { 600 } else { 20 }), rough: Vec::new() };
        let mut rest = arguments.iter().filter(|a| *a != "--full" && *a != "--bench");
        while let Some(argument) = rest.next() {
            let number = |text: &str| text.parse::<usize>().ok().filter(|n| (1..=2048).contains(n));
            if argument == "--limit" {
                let seconds = rest.next().and_then(|a| number(a)).ok_or("--limit takes whole seconds")?;
                plan.limit = Duration::from_secs(seconds as u64);
            } else {
                plan.sizes.push(number(argument).ok_or(format!(
                    "'{argument}' is no number of squares per side (1 to 2048); other arguments are --full and --limit"
                ))?);
            }
        }
        if plan.sizes.is_empty() {
            plan.sizes = if full { vec![32, 96, 256, 512] } else { vec![32, 96, 256] };
        }
        plan.sizes.sort_unstable();
        plan.rough = plan.sizes.iter().copied().filter(|n| *n <= 256).collect();
        Ok(plan)
    }
}

fn main() -> std::process::ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let Some(job) = Job::from_arguments(&arguments) {
        return job.run();
    }
    let plan = match Plan::new(&arguments) {
        Ok(plan) => plan,
        Err(message) => {
            eprintln!("{message}");
            return std::process::ExitCode::FAILURE;
        }
    };
    println!("{}", machine::name());
    println!("one thread; seconds of processor time; limit per method and size {} s\n", plan.limit.as_secs());
    for (family, sizes) in [(Family::Squares, &plan.sizes), (Family::Rough, &plan.rough)] {
        let condensed = own_costs(family, sizes);
        if family == Family::Squares {
            others(&condensed, plan.limit);
        }
    }
    std::process::ExitCode::SUCCESS
}

/// The condensed method against faer's own factorisation.
fn own_costs(family: Family, sizes: &[usize]) -> Vec<Measured> {
    table::costs_head(family);
    let long = Duration::from_secs(1800);
    let mut all = Vec::new();
    for &n in sizes {
        let condensed = Job::new("condensed", family, n).measure(long);
        let plain = Job::new("faer", family, n).measure(long);
        match condensed {
            Ok(condensed) => {
                table::costs_row(&condensed, &plain);
                all.push(condensed);
            }
            Err(reason) => println!("{:>9}  {reason}", 4 * n * n),
        }
    }
    table::exponent(&all);
    all
}

/// The other methods, each to the size at which it no longer ends in time.
fn others(condensed: &[Measured], limit: Duration) {
    table::others_head();
    for method in job::METHODS.iter().filter(|m| **m != "condensed").chain(&["fenicsx"]) {
        for own in condensed {
            let found = Job::new(method, Family::Squares, own.n).measure(limit);
            table::others_row(method, own, &found);
            if found.is_err() {
                break;
            }
        }
    }
    println!();
}
