//! The command line: one file per command, options in one place, no mechanics.
//!
//! A command reads its input, calls the library and returns an [`Exit`] or a [`CliError`]. Nothing is written before
//! there is a result to write, so an error leaves no file behind.

pub mod cases;
pub mod certify;
pub mod chart;
pub mod ci;
pub mod conclude;
pub mod diff;
pub mod element;
pub mod error;
pub mod exit;
pub mod gather;
pub mod given;
pub mod job;
pub mod judge;
pub mod mcp;
pub mod measure;
pub mod memory;
pub mod mesh;
mod methods;
pub mod options;
pub mod part;
mod points;
pub mod progress;
mod proof;
pub mod revolved;
pub mod say;
pub mod schema;
pub mod session;
pub mod shell;
pub mod show;
pub mod solve;
pub mod stability;
pub mod threads;
mod values;
pub mod verify;
pub mod version;

use std::ffi::OsString;
use std::io::Write;
use std::panic::AssertUnwindSafe;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::OnceLock;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

pub use error::CliError;
pub use exit::Exit;
use given::Given;

use crate::process::{clear, signals};

/// Guaranteed two-sided energy bounds for plane frictionless contact, and a displacement model to compare with.
#[derive(Debug, Parser)]
#[command(name = "hypercircle", version, propagate_version = true, after_help = exit::TABLE)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve in stresses and, with FEniCSx, in displacements; compare, report and judge
    Verify(verify::Args),
    /// Solve in stresses, with a two-sided energy bracket; needs no Python
    Solve(solve::Args),
    /// Hold a displacement field from elsewhere against the bound
    Certify(certify::Args),
    /// Make one page of the parts of a job
    Gather(gather::Args),
    /// Examine an element formulation: what is right and wrong with it
    Element(element::Args),
    /// Compare two reports: what changed, and whether it matters
    Diff(diff::Args),
    /// Show what a mesh file holds, and write a scene to start from
    Mesh(mesh::Args),
    /// List the published benchmarks, and run them: is the printed number inside the guaranteed interval?
    Cases(cases::Args),
    /// Measure accuracy against time, every method and refinement
    Chart(chart::Args),
    /// Sweep the regimes where contact methods are known to fail
    Stability(stability::Args),
    /// Serve as tools of an agent (Model Context Protocol), over standard input and output
    Mcp(mcp::Args),
    /// One run for a chart or a matrix, printed as JSON
    #[command(hide = true)]
    Measure(measure::Args),
    /// The part of a bracket that one of several ranks makes
    #[command(hide = true)]
    Part(part::Args),
    /// Print the JSON Schema of a file format
    Schema(schema::Args),
    /// Print the script that completes command lines in a shell
    Completions(shell::CompletionsArgs),
    /// Print the manual page, or write one for each command
    Man(shell::ManArgs),
}

/// The executable of this program; there is none where a program of someone else's calls the library.
static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// What this process can start to be this program once more.
fn program() -> Option<PathBuf> {
    PROGRAM.get().cloned()
}

/// Runs the command of this process's arguments.
pub fn main() -> ExitCode {
    if let Ok(program) = std::env::current_exe() {
        let _ = PROGRAM.set(program);
    }
    let (cli, given) = match parsed(std::env::args_os()) {
        Ok(parsed) => parsed,
        Err(error) if error.kind() == ErrorKind::DisplayVersion && std::env::args_os().any(|w| w == "--version") => {
            let _ = writeln!(std::io::stdout(), "{}", version::long());
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            // Help and version are answers, on stdout with code 0; the rest is bad usage, with the code of bad input.
            // Where nobody reads the answer there is nobody to tell.
            let _ = error.print();
            return if error.use_stderr() { Exit::BadInput.into() } else { ExitCode::SUCCESS };
        }
    };
    show::install_panic_message();
    signals::watch();
    clear();
    match std::panic::catch_unwind(AssertUnwindSafe(|| run(&cli.command, &given))) {
        Ok(Ok(exit)) => exit.into(),
        Ok(Err(error)) => {
            show::error(&error);
            ci::annotate_error(&error);
            error.exit().into()
        }
        Err(_) => Exit::Failed.into(),
    }
}

/// The command line, and the options of its command as they were given.
fn parsed(words: impl IntoIterator<Item = OsString>) -> Result<(Cli, Given), clap::Error> {
    let mut definition = Cli::command();
    let matches = definition.try_get_matches_from_mut(words)?;
    let cli = Cli::from_arg_matches(&matches).map_err(|error| error.format(&mut definition))?;
    let used = matches.subcommand().and_then(|(name, matches)| Some((definition.find_subcommand(name)?, matches)));
    let given = used.map_or_else(Given::default, |(command, matches)| Given::new(command, matches));
    Ok((cli, given))
}

/// The options of one command, from its words alone.
pub(crate) fn options_of<A: clap::Args>(words: impl IntoIterator<Item = OsString>) -> Result<A, clap::Error> {
    let command = A::augment_args(clap::Command::new("hypercircle").no_binary_name(true));
    A::from_arg_matches(&command.try_get_matches_from(words)?)
}

fn run(command: &Command, given: &Given) -> Result<Exit, CliError> {
    match command {
        Command::Verify(args) => verify::run(args, given),
        Command::Solve(args) => solve::run(args, given),
        Command::Certify(args) => certify::run(args, given),
        Command::Gather(args) => gather::run(args),
        Command::Element(args) => element::run(args),
        Command::Diff(args) => diff::run(args),
        Command::Mesh(args) => mesh::run(args),
        Command::Cases(args) => cases::run(args),
        Command::Chart(args) => chart::run(args),
        Command::Stability(args) => stability::run(args),
        Command::Mcp(args) => mcp::run(args),
        Command::Measure(args) => measure::run(args),
        Command::Part(args) => part::run(args),
        Command::Schema(args) => schema::run(args),
        Command::Completions(args) => shell::completions(args),
        Command::Man(args) => shell::man(args),
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::{Cli, Command};
    use crate::dual::Solver;

    fn parse(line: &str) -> Result<Command, clap::Error> {
        Cli::try_parse_from(line.split_whitespace()).map(|cli| cli.command)
    }

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn options_arrive() {
        let line = "hypercircle verify a.toml --method active-set --refine 2 --tolerance 0.01 --threads 2 --out o -q \
                    --baseline b.json --accept --allow energy=1e-3 --allow contact=0 --max-triangles 9 --max-seconds 1.5 \
                    --max-memory 2G";
        let Ok(Command::Verify(args)) = parse(line) else { panic!("{:?}", parse(line)) };
        assert_eq!(args.scenes, [std::path::PathBuf::from("a.toml")]);
        assert_eq!((args.solve.method, args.solve.refine, args.solve.threads), (Solver::ActiveSet, 2, 2));
        assert_eq!(args.solve.memory.max_memory, Some(2_000_000_000));
        assert_eq!((args.limits.max_triangles, args.limits.max_seconds), (Some(9), Some(1.5)));
        let allowed: Vec<_> = args.judge.allow.iter().map(|a| (a.name.as_str(), a.value)).collect();
        assert_eq!(allowed, [("energy", 1e-3), ("contact", 0.0)]);
        assert!(args.judge.accept && args.run.quiet);
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for line in [
            "hypercircle solve",
            "hypercircle solve a.toml --jobs 0",
            "hypercircle solve a.toml --shard 3/2",
            "hypercircle solve a.toml --scene-seconds 0",
            "hypercircle solve a.toml --tolerance nan",
            "hypercircle solve a.toml --tolerance 0",
            "hypercircle solve a.toml --refine -1",
            "hypercircle solve a.toml --refine 40",
            "hypercircle solve a.toml --threads 0",
            "hypercircle solve a.toml --max-triangles 0",
            "hypercircle solve a.toml --max-seconds inf",
            "hypercircle solve a.toml --max-memory 0",
            "hypercircle chart a.toml --max-memory lots",
            "hypercircle solve a.toml --method newton",
            "hypercircle solve a.toml --baseline b.json",
            "hypercircle verify a.toml --accept",
            "hypercircle verify a.toml --allow energy",
            "hypercircle verify a.toml --allow =1",
            "hypercircle verify a.toml --allow energy=-1",
            "hypercircle verify a.toml --allow energy=nan",
            "hypercircle certify a.toml",
            "hypercircle chart",
            "hypercircle schema mesh",
        ] {
            assert_eq!(parse(line).map_err(|error| error.exit_code()).err(), Some(2), "{line}");
        }
    }
}
