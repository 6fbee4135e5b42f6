//! `hypercircle cases`: the published benchmarks, listed and run.

use std::path::{Path, PathBuf};

use super::solve::{Solved, solved};
use crate::cli::conclude::Particulars;
use crate::cli::given::options::{MemoryOptions, positive};
use crate::cli::given::threads;
use crate::cli::session::Session;
use crate::cli::words::progress::Progress;
use crate::cli::words::say;
use crate::cli::{CliError, Exit, options_of};
use crate::published::{Case, Row, Verdict, cases, listed, markdown, text};
use crate::report::folder::{self, replace_file};
use crate::scene::{Scene, counted};
use crate::study::summaries;

/// The table of a run.
const TABLE: &str = "cases.md";

/// Options of `cases`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Without names the collection is listed. A run leaves a scene and a report for each case, and cases.md, in DIR; its exit code \
    is 1 where a published number lies outside of the guaranteed interval by more than its accuracy."
)]
pub struct Args {
    /// Cases to run
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Run them all
    #[arg(long, conflicts_with = "names")]
    pub all: bool,
    /// Refine each case for S seconds at most
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = positive)]
    pub max_seconds: f64,
    /// Threads to use, at most one for each processor
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// How much memory may be taken.
    #[command(flatten)]
    pub memory: MemoryOptions,
    /// Folder for the results
    #[arg(long, value_name = "DIR", default_value = "out/cases")]
    pub out: PathBuf,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Lists the collection, or runs cases of it and judges the published numbers.
///
/// # Errors
/// A name that no case has, a folder that cannot be written to, or a case that cannot be solved here.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let chosen = chosen(args)?;
    if chosen.is_empty() {
        listed(cases()).iter().for_each(|line| say::line(line));
        return Ok(Exit::Agree);
    }
    let threads = threads::start(args.threads);
    let progress = Progress::new(args.quiet);
    let mut rows = Vec::new();
    for (number, case) in chosen.iter().enumerate() {
        progress.phase(format!("{}, {} of {}", case.name, number + 1, chosen.len()));
        rows.extend(ran(case, args, threads)?);
    }
    drop(progress);
    let table = args.out.join(TABLE);
    replace_file(&table, markdown(&rows).into_bytes()).map_err(|e| CliError::unwritable(&table, &e))?;
    let disagreeing = rows.iter().filter(|row| !row.verdict.agrees()).count();
    if !args.quiet {
        text(&rows).iter().for_each(|line| say::line(line));
        say::line("");
        say::line(&sentence(&rows, disagreeing));
        say::line(&format!("table: {}", table.display()));
    }
    Ok(if disagreeing == 0 { Exit::Agree } else { Exit::Disagree })
}

/// The cases that the command line names; none where it asks for the list.
fn chosen(args: &Args) -> Result<Vec<&'static Case>, CliError> {
    if args.all {
        return Ok(cases().iter().collect());
    }
    let of_name = |name: &String| {
        cases().iter().find(|case| case.name == *name).ok_or_else(|| {
            let names: Vec<&str> = cases().iter().map(|case| case.name.as_str()).collect();
            let remedy = format!("the cases are {}", names.join(", "));
            CliError::stopped(Exit::BadInput, format!("there is no case '{name}'"), remedy)
        })
    };
    args.names.iter().map(of_name).collect()
}

/// Solves a case, leaves its scene and its report, and judges what was published of it.
fn ran<'a>(case: &'a Case, args: &Args, threads: usize) -> Result<Vec<Row<'a>>, CliError> {
    let file = args.out.join(format!("{}.toml", case.name));
    let report = args.out.join(&case.name);
    let refused = |e: crate::report::ReportError| CliError::stopped(Exit::BadInput, e.to_string(), "");
    folder::refuse(&report, crate::report::NAMES).map_err(refused)?;
    let options = options(case, args, &file)?;
    let session = Session::new("solve", Scene::parse(case.scene(), &file)?, threads, &options.solve, true)?;
    let Solved { run, comparison, answers } = solved(&options, &session, None)?;
    let rows = {
        let found = summaries(&run.certified, &answers, &comparison);
        let row = |value: &'a crate::published::Value| {
            let summary = found.iter().find(|summary| summary.name == value.quantity)?;
            let wanted = case.refine.get(&value.quantity).map_or(f64::INFINITY, |part| part * summary.value.abs());
            let verdict = Verdict::of(value, [summary.lower, summary.upper], wanted);
            Some(Row { case, value, interval: summary.interval(), verdict })
        };
        case.values.iter().filter_map(row).collect()
    };
    std::fs::create_dir_all(&args.out).map_err(|e| CliError::unwritable(&args.out, &e))?;
    replace_file(&file, case.scene().as_bytes().to_vec()).map_err(|e| CliError::unwritable(&file, &e))?;
    session.conclude(&run, &comparison, Particulars { answers, ..Particulars::default() }, &report)?;
    Ok(rows)
}

/// The options of `hypercircle solve` that a case is run with.
fn options(case: &Case, args: &Args, file: &Path) -> Result<super::solve::Args, CliError> {
    let refine = case.refine.iter();
    let mut words: Vec<String> = refine.map(|(name, part)| format!("--tolerance-of={name}={part:?}")).collect();
    words.push(format!("--max-seconds={:?}", args.max_seconds));
    words.push(format!("--threads={}", args.threads));
    words.extend(args.memory.max_memory.map(|bytes| format!("--max-memory={bytes}")));
    let words = words.into_iter().map(Into::into).chain(["--".into(), file.as_os_str().to_owned()]);
    options_of(words).map_err(|e| CliError::stopped(Exit::BadInput, e.to_string(), ""))
}

/// The overall result in one sentence.
fn sentence(rows: &[Row<'_>], disagreeing: usize) -> String {
    let judged = rows.iter().filter(|row| row.verdict != Verdict::Elsewhere).count();
    let numbers = counted(judged, "published number");
    match disagreeing {
        0 => format!("{numbers} judged: all agree within their accuracy."),
        _ => format!("{numbers} judged: {} agree within their accuracy, {disagreeing} do not.", judged - disagreeing),
    }
}
