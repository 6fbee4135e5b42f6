//! The options of a command as they were given, to be given once more.

pub mod field;
pub mod friction;
pub mod judge;
pub mod memory;
pub(super) mod methods;
pub mod options;
pub(super) mod points;
pub(super) mod proof;
pub mod revolved;
pub mod threads;
pub(super) mod values;

use std::ffi::OsString;

use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, Command};

/// Options that the command line gives to one command.
#[derive(Debug, Default)]
pub struct Given {
    options: Vec<(String, OsString)>,
}

impl Given {
    /// The options that `matches` has of `command`; arguments without a name are not among them.
    pub fn new(command: &Command, matches: &ArgMatches) -> Self {
        let mut options = Vec::new();
        for argument in command.get_arguments() {
            let id = argument.get_id().as_str();
            let (Some(name), Some(ValueSource::CommandLine)) = (argument.get_long(), matches.value_source(id)) else {
                continue;
            };
            if matches!(argument.get_action(), ArgAction::SetTrue) {
                options.push((name.to_string(), format!("--{name}").into()));
                continue;
            }
            for value in matches.get_raw(id).into_iter().flatten() {
                let mut option = OsString::from(format!("--{name}="));
                option.push(value);
                options.push((name.to_string(), option));
            }
        }
        Given { options }
    }

    /// The options but those named, each as one word.
    pub fn without(&self, names: &[&str]) -> impl Iterator<Item = &OsString> {
        self.options.iter().filter(move |(name, _)| !names.contains(&name.as_str())).map(|(_, option)| option)
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;
    use crate::cli::Cli;

    fn given(line: &[&str]) -> Given {
        let matches = Cli::command().try_get_matches_from(line).expect("a valid line");
        let (name, matches) = matches.subcommand().expect("a command");
        Given::new(Cli::command().find_subcommand(name).expect("that command"), matches)
    }

    #[test]
    fn what_is_given_again_means_the_same() {
        let line = [
            "hypercircle",
            "verify",
            "a.toml",
            "b.toml",
            "--refine",
            "2",
            "--allow",
            "x=1",
            "-q",
            "--allow=contact/a|b/resultant=-0",
            "--accept",
            "--baseline",
            "a b.toml",
            "--tolerance=0.1",
            "--jobs",
            "3",
        ];
        let first = given(&line);
        let options: Vec<OsString> = first.without(&["jobs", "quiet"]).cloned().collect();
        assert!(
            !options
                .iter()
                .any(|option| option.to_string_lossy().contains("toml")
                    && !option.to_string_lossy().contains("baseline"))
        );
        let mut again: Vec<&str> = vec!["hypercircle", "verify"];
        again.extend(options.iter().map(|option| option.to_str().expect("Unicode")));
        again.extend(["--jobs=3", "--quiet", "--", "a.toml", "b.toml"]);
        let second = given(&again);
        assert_eq!(first.options, second.options);
        assert_eq!(first.options.len(), 8);
    }
}
