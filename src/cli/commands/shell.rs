//! `hypercircle completions` and `hypercircle man`: for shells and for readers of manuals, from the definition of the command
//! line itself.

use std::io::Write;
use std::path::PathBuf;

use clap::CommandFactory;
use clap_complete::Shell;

use crate::cli::{Cli, CliError, Exit};

/// Options of `completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// Which shell
    #[arg(value_enum)]
    pub shell: Shell,
}

/// Options of `man`.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// Write hypercircle.1 and a page for each command into DIR, in place of the first on standard output
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Prints the script that completes command lines.
///
/// # Errors
/// It cannot be printed.
pub fn completions(args: &CompletionsArgs) -> Result<Exit, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "hypercircle", &mut script);
    print(&script)
}

/// Prints or writes the manual.
///
/// # Errors
/// It cannot be printed or written.
pub fn man(args: &ManArgs) -> Result<Exit, CliError> {
    let failed = |e: std::io::Error| CliError::stopped(Exit::Failed, format!("the manual cannot be written: {e}"), "");
    match &args.out {
        Some(folder) => {
            std::fs::create_dir_all(folder).map_err(|e| CliError::unwritable(folder, &e))?;
            clap_mangen::generate_to(Cli::command(), folder).map_err(|e| CliError::unwritable(folder, &e))?;
            Ok(Exit::Agree)
        }
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Cli::command()).render(&mut page).map_err(failed)?;
            print(&page)
        }
    }
}

fn print(text: &[u8]) -> Result<Exit, CliError> {
    match std::io::stdout().write_all(text) {
        // A reader such as `head` may have had enough.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(CliError::stopped(Exit::Failed, format!("it cannot be printed: {error}"), ""))
        }
        _ => Ok(Exit::Agree),
    }
}
