//! The command line: one file per command, options in one place, no mechanics.
//!
//! A command reads its input, calls the library and returns an [`Exit`] or a [`CliError`]. Nothing is written before
//! there is a result to write, so an error leaves no file behind.

pub mod commands;
pub mod conclude;
pub mod given;
pub mod session;
pub mod words;

use std::ffi::OsString;
use std::io::Write;
use std::panic::AssertUnwindSafe;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::OnceLock;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use given::Given;
pub use words::error::CliError;
pub use words::exit::Exit;

use crate::process::{clear, signals};

/// Guaranteed two-sided energy bounds for contact, and a displacement model to compare with.
#[derive(Debug, Parser)]
#[command(name = "hypercircle", version, propagate_version = true, after_help = words::exit::TABLE)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve in stresses and, with FEniCSx, in displacements; compare, report and judge
    Verify(commands::verify::Args),
    /// Solve in stresses, with a two-sided energy bracket; needs no Python
    Solve(commands::solve::Args),
    /// Hold a displacement field from elsewhere against the bound
    Certify(commands::certify::Args),
    /// Make one page of the parts of a job
    Gather(commands::gather::Args),
    /// Examine an element formulation: what is right and wrong with it
    Element(commands::element::Args),
    /// Compare two reports: what changed, and whether it matters
    Diff(commands::diff::Args),
    /// Show what a mesh file holds, and write a scene to start from
    Mesh(commands::mesh::Args),
    /// List the published benchmarks, and run them: is the printed number inside the guaranteed interval?
    Cases(commands::cases::Args),
    /// Measure accuracy against time, every method and refinement
    Chart(commands::chart::Args),
    /// Sweep the regimes where contact methods are known to fail
    Stability(commands::stability::Args),
    /// Serve as tools of an agent (Model Context Protocol), over standard input and output
    Mcp(commands::mcp::Args),
    /// One run for a chart or a matrix, printed as JSON
    #[command(hide = true)]
    Measure(commands::measure::Args),
    /// The part of a bracket that one of several ranks makes
    #[command(hide = true)]
    Part(commands::part::Args),
    /// Print the JSON Schema of a file format
    Schema(commands::schema::Args),
    /// Print the script that completes command lines in a shell
    Completions(commands::shell::CompletionsArgs),
    /// Print the manual page, or write one for each command
    Man(commands::shell::ManArgs),
}

/// How this program was started; nothing is known where a program of someone else's calls the library.
static STARTED: OnceLock<Started> = OnceLock::new();

/// The program that was started, and its command line.
pub struct Started {
    /// The executable that starts this program once more, where that is known.
    pub program: Option<PathBuf>,
    /// The file with its code: the same, or the library that it calls.
    pub code: Option<PathBuf>,
    /// The command line; the first word is the name of the program.
    pub words: Vec<OsString>,
}

/// The executable with which this process can start this program once more.
fn program() -> Option<PathBuf> {
    STARTED.get()?.program.clone()
}

/// As [`program`], for a command that cannot do without, with the file of its code.
fn this_program() -> Result<(PathBuf, PathBuf), CliError> {
    let found = STARTED.get().and_then(|started| started.program.clone().zip(started.code.clone()));
    found.ok_or_else(|| {
        CliError::stopped(
            Exit::Failed,
            "this program does not find itself to start its runs",
            "start it by its whole path",
        )
    })
}

/// The words of the command line after the name of the program; none where the library is called.
fn arguments() -> impl Iterator<Item = &'static OsString> {
    STARTED.get().into_iter().flat_map(|started| &started.words).skip(1)
}

/// Runs the command of this process's arguments.
pub fn main() -> ExitCode {
    let program = std::env::current_exe().ok();
    main_of(Started { code: program.clone(), program, words: std::env::args_os().collect() }).into()
}

/// Runs the command of a program that was started so.
pub fn main_of(started: Started) -> Exit {
    let words = STARTED.get_or_init(|| started).words.clone();
    let is_version = words.iter().any(|word| word == "--version");
    let (cli, given) = match parsed(words) {
        Ok(parsed) => parsed,
        Err(error) if error.kind() == ErrorKind::DisplayVersion && is_version => {
            let _ = writeln!(std::io::stdout(), "{}", words::version::long());
            return Exit::Agree;
        }
        Err(error) => {
            // Help and version are answers, on stdout with code 0; the rest is bad usage, with the code of bad input.
            // Where nobody reads the answer there is nobody to tell.
            let _ = error.print();
            return if error.use_stderr() { Exit::BadInput } else { Exit::Agree };
        }
    };
    words::show::install_panic_message();
    signals::watch();
    clear();
    match std::panic::catch_unwind(AssertUnwindSafe(|| run(&cli.command, &given))) {
        Ok(Ok(exit)) => exit,
        Ok(Err(error)) => {
            words::show::error(&error);
            words::ci::annotate_error(&error);
            error.exit()
        }
        Err(_) => Exit::Failed,
    }
}

/// The command line, and the options of its command as they were given.
fn parsed(words: impl IntoIterator<Item = OsString>) -> Result<(Cli, Given), clap::Error> {
    // A number below zero is the value of an option, and refused as such.
    let mut definition = Cli::command().mut_subcommands(|command| command.allow_negative_numbers(true));
    let matches = definition.try_get_matches_from_mut(words)?;
    let cli = Cli::from_arg_matches(&matches).map_err(|error| error.format(&mut definition))?;
    let used = matches.subcommand().and_then(|(name, matches)| Some((definition.find_subcommand(name)?, matches)));
    let given = used.map_or_else(Given::default, |(command, matches)| Given::new(command, matches));
    Ok((cli, given))
}

/// The options of one command, from its words alone; refused as on the command line.
pub fn options_of<A: clap::Args>(words: impl IntoIterator<Item = OsString>) -> Result<A, clap::Error> {
    let command = A::augment_args(clap::Command::new("hypercircle").no_binary_name(true));
    A::from_arg_matches(&command.try_get_matches_from(words)?)
}

fn run(command: &Command, given: &Given) -> Result<Exit, CliError> {
    match command {
        Command::Verify(args) => commands::verify::run(args, given),
        Command::Solve(args) => commands::solve::run(args, given),
        Command::Certify(args) => commands::certify::run(args, given),
        Command::Gather(args) => commands::gather::run(args),
        Command::Element(args) => commands::element::run(args),
        Command::Diff(args) => commands::diff::run(args),
        Command::Mesh(args) => commands::mesh::run(args),
        Command::Cases(args) => commands::cases::run(args),
        Command::Chart(args) => commands::chart::run(args),
        Command::Stability(args) => commands::stability::run(args),
        Command::Mcp(args) => commands::mcp::run(args),
        Command::Measure(args) => commands::measure::run(args),
        Command::Part(args) => commands::part::run(args),
        Command::Schema(args) => commands::schema::run(args),
        Command::Completions(args) => commands::shell::completions(args),
        Command::Man(args) => commands::shell::man(args),
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
