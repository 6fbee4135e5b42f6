//! `hypercircle mcp`: the program as tools of an agent, by the Model Context Protocol over standard input and output.
//!
//! Each call is a process of its own with a limit of time and of memory: one that hangs, crashes or asks for too much is an answer
//! that says so, and the server goes on. Files are read from one folder and nowhere else.

mod answer;
mod arguments;
mod call;
mod inside;
mod message;
mod resources;
mod serve;
mod tools;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::AtomicBool;

use clap::value_parser;

use crate::cli::given::options::{MemoryOptions, positive};
use crate::cli::{CliError, Exit, program};
use crate::process::{Ended, Outcome, Scratch, limit, supervise_unless};
use answer::Answer;
use call::Call;

/// Options of `mcp`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "An agent starts this program itself; docs/mcp.md says how it is told to. Tools: solve, verify, certify, diagnose, element. Scenes come as \
                        text, mesh and displacement files from the folder alone."
)]
pub struct Args {
    /// Read mesh and displacement files from DIR and the folders in it, and no others
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub folder: PathBuf,
    /// Give each call at most S seconds
    #[arg(long, value_name = "S", default_value_t = 120.0, value_parser = positive)]
    pub max_seconds: f64,
    /// Threads of each call, at most one for each processor
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..=1024))]
    pub threads: u32,
    /// How much memory a call may take.
    #[command(flatten)]
    pub memory: MemoryOptions,
    /// Answer the one call in this folder
    #[arg(long, value_name = "DIR", hide = true)]
    pub call: Option<PathBuf>,
}

/// The file with the call, and the one with its answer, in the folder of a call.
const FILES: [&str; 2] = ["call.json", "answer.json"];

/// Serves until standard input ends; what was asked for by then is answered first.
///
/// # Errors
/// The folder is none, or this program cannot be started again.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    if let Some(place) = &args.call {
        return one(place);
    }
    let folder = args.folder.canonicalize().ok().filter(|folder| folder.is_dir()).ok_or_else(|| {
        let what = format!("--folder {}: there is no such folder", args.folder.display());
        CliError::stopped(Exit::BadInput, what, "give the folder with the mesh and displacement files")
    })?;
    let program =
        program().ok_or_else(|| CliError::stopped(Exit::Failed, "this program does not know where it lies", ""))?;
    let answer = |tool: &str, arguments, unwanted: &AtomicBool| {
        let call = Call {
            tool: tool.to_string(),
            arguments,
            seconds: args.max_seconds,
            threads: args.threads,
            memory: args.memory.max_memory,
        };
        aside(&program, &folder, &call, unwanted)
    };
    serve::serve(std::io::stdin().lock(), std::io::stdout(), &answer);
    Ok(Exit::Agree)
}

/// Answers the call in the folder `place`, for the server that started this process.
fn one(place: &Path) -> Result<Exit, CliError> {
    crate::process::end_with_parent();
    let [call, answer] = FILES.map(|name| place.join(name));
    let unreadable = |e: String| CliError::stopped(Exit::Failed, format!("{}: {e}", call.display()), "");
    let text = fs::read(&call).map_err(|e| unreadable(e.to_string()))?;
    let call: Call = serde_json::from_slice(&text).map_err(|e| unreadable(e.to_string()))?;
    let text = serde_json::to_vec(&call.answer()).map_err(|e| CliError::unwritable(&answer, &e.into()))?;
    fs::write(&answer, text).map_err(|e| CliError::unwritable(&answer, &e))?;
    Ok(Exit::Agree)
}

/// Answers `call` in a process of its own that works in `folder`, and ends when nobody waits for it any more.
fn aside(program: &Path, folder: &Path, call: &Call, unwanted: &AtomicBool) -> Answer {
    let failed = |what: String| Answer::refused(&CliError::stopped(Exit::Failed, what, ""));
    let place = match Scratch::new() {
        Ok(place) => place,
        Err(error) => return failed(format!("there is no temporary folder: {error}")),
    };
    let [request, answer] = FILES.map(|name| place.path().join(name));
    let written = serde_json::to_vec(call)
        .map_err(|e| e.to_string())
        .and_then(|text| fs::write(&request, text).map_err(|e| e.to_string()));
    if let Err(error) = written {
        return failed(format!("the call cannot be kept: {error}"));
    }
    let mut command = Command::new(program);
    command.arg("mcp").arg("--call").arg(place.path()).current_dir(folder);
    command.env_remove("GITHUB_ACTIONS").env_remove("GITHUB_STEP_SUMMARY");
    match supervise_unless(&mut command, limit(call.seconds), unwanted) {
        Err(error) => failed(format!("this program cannot be started once more: {error}")),
        Ok(Ended { outcome: Outcome::TimedOut, .. }) => Answer::late(call.seconds),
        Ok(ended) => match fs::read(&answer).ok().and_then(|text| serde_json::from_slice(&text).ok()) {
            Some(answer) => answer,
            None => failed(format!("the run ended without an answer: {}", ended.text())),
        },
    }
}
