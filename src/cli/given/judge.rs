//! Tolerances and baselines from the command line.

use super::options::{JudgeOptions, SignatureOptions};
use crate::cli::commands::job::JobOptions;
use crate::cli::words::say;
use crate::cli::{CliError, Exit};
use crate::compare::name::{FREE_BOUND, GIVEN, WIDTH, of_quantity};
use crate::compare::{Allowances, Check, Comparison, Name, names_of_checks};
use crate::report::BaselineRow;
use crate::scene::{Contact, Scene};
use crate::study::{Accepted, Answer, Baseline, BaselineError, Certified, Signature, baseline_checks, today};

impl JudgeOptions {
    /// The tolerances given with `--allow`.
    pub fn allowances(&self) -> Allowances {
        Allowances::new(self.allow.iter().map(|a| (a.name.clone(), a.value)).collect())
    }

    /// Refuses, before anything is solved, a baseline that cannot be read or written and a tolerance for a check that no
    /// comparison of `fields` makes; `None` where they name themselves later.
    ///
    /// # Errors
    /// Names the baseline or the tolerance at fault.
    pub fn refuse_early(&self, scene: &Scene, fields: Option<Vec<String>>, job: &JobOptions) -> Result<(), CliError> {
        self.refuse_unheard(false)?;
        match &self.baseline {
            Some(file) if self.accept && !job.is_part() => Baseline::refuse(file).map_err(refused)?,
            Some(file) if Accepted::is_meant(file) && self.accept => {
                drop(Accepted::read_if_there(file).map_err(refused)?)
            }
            Some(file) if Accepted::is_meant(file) => drop(Accepted::read(file).map_err(refused)?),
            Some(file) => drop(Baseline::read(file).map_err(refused)?),
            None => {}
        }
        match fields {
            // A check of another scene of the job may be meant.
            Some(fields) if !job.is_part() => self.refuse_foreign(&[(scene.clone(), fields)]),
            _ => Ok(()),
        }
    }

    /// Refuses to hear who accepts, and why, where nothing is accepted, or where there is no place to write it; `is_shard` says that parts of
    /// a job are run by themselves.
    ///
    /// # Errors
    /// Bad input.
    pub fn refuse_unheard(&self, is_shard: bool) -> Result<(), CliError> {
        let SignatureOptions { reason, accepted_by } = &self.signature;
        let option = match (reason.as_str(), accepted_by) {
            ("", None) => return Ok(()),
            ("", Some(_)) => "--accepted-by",
            _ => "--reason",
        };
        let [why, remedy] = match &self.baseline {
            _ if !self.accept => ["nothing is accepted", "add --baseline FILE.toml and --accept"],
            _ if is_shard => ["a part of a job accepts nothing by itself", "give it to `hypercircle gather`"],
            Some(file) if !Accepted::is_meant(file) => {
                ["a baseline in JSON has no place for it", "give the baseline a name that ends with .toml"]
            }
            _ => return Ok(()),
        };
        Err(CliError::stopped(
            Exit::BadInput,
            format!("{option} is said of numbers that are accepted, and {why}"),
            remedy,
        ))
    }

    /// Refuses a tolerance for a check that is made on none of `scenes`, given with the displacement fields that are
    /// compared on each.
    ///
    /// # Errors
    /// Names the tolerance at fault.
    pub fn refuse_foreign(&self, scenes: &[(Scene, Vec<String>)]) -> Result<(), CliError> {
        let of_scene = |(scene, fields): &(Scene, Vec<String>)| {
            let contacts: Vec<String> = scene.contacts.iter().map(Contact::name).collect();
            let fields: Vec<String> = fields.iter().cloned().chain([FREE_BOUND.to_string()]).collect();
            let mut names = names_of_checks(&contacts, &fields);
            for quantity in &scene.quantities {
                let of = |by: &str| of_quantity(&quantity.name, by);
                names.extend(fields.iter().map(String::as_str).chain([WIDTH, GIVEN]).map(of));
            }
            names
        };
        let mut names: Vec<String> = scenes.iter().flat_map(of_scene).collect();
        let mut seen = std::collections::HashSet::new();
        names.retain(|name| seen.insert(name.clone()));
        let allow = self.allowances();
        // Where no scene can be read there is nothing to hold a name against.
        let foreign = if names.is_empty() { Vec::new() } else { allow.foreign(&names) };
        match foreign.into_iter().find(|name| !matches!(Name::read(name), Name::Baseline(_))) {
            None => Ok(()),
            Some(name) => Err(CliError::stopped(
                Exit::BadInput,
                format!("--allow names a check that is not made: {name}"),
                format!("use one of {}, or the last part of one", names.join(", ")),
            )),
        }
    }

    /// Refuses a tolerance for a check that does not exist; where checks could not be made, any name may be meant.
    ///
    /// # Errors
    /// An unknown name.
    pub fn refuse_unknown(
        &self,
        allow: &Allowances,
        checks: &[Check],
        incomplete: bool,
        job: &JobOptions,
    ) -> Result<(), CliError> {
        let unknown = allow.unknown(checks);
        let meant: Vec<&&str> = unknown.iter().filter(|name| !matches!(Name::read(name), Name::Baseline(_))).collect();
        if incomplete || meant.is_empty() || job.is_part() {
            return Ok(());
        }
        let names: Vec<&str> = checks.iter().map(|c| c.name.as_str()).collect();
        Err(CliError::stopped(
            Exit::BadInput,
            format!("--allow names a check that was not made: {}", meant[0]),
            format!("use one of {}, or the last part of one", names.join(", ")),
        ))
    }

    /// Compares with the baseline, or writes it; one scene of a job leaves the writing to the job.
    ///
    /// # Errors
    /// The baseline cannot be read or written.
    pub fn against_baseline(
        &self,
        certified: &Certified,
        comparison: &Comparison,
        answers: &[Answer],
        allow: &Allowances,
        job: &JobOptions,
    ) -> Result<(Vec<Check>, Vec<BaselineRow>), CliError> {
        let Some(file) = &self.baseline else { return Ok((Vec::new(), Vec::new())) };
        let values = Baseline::numbers(certified, comparison, answers);
        let scene = &certified.problem.scene.name;
        if Accepted::is_meant(file) {
            let name = job.part_name.as_ref().unwrap_or(scene);
            let stored = if self.accept { Accepted::read_if_there(file) } else { Accepted::read(file) };
            let stored = stored.map_err(refused)?;
            let rows = stored.rows(name, &values, allow);
            if !self.accept {
                return Ok((baseline_checks(&rows), rows));
            }
            if !job.is_part()
                && let Some(text) = stored.with(&[(name.clone(), rows.clone())].into(), &self.signature())
            {
                Baseline::write_text(file, text).map_err(refused)?;
            }
            return Ok((Vec::new(), rows));
        }
        let present = Baseline::new(scene, values);
        if self.accept {
            present.write(file).map_err(refused)?;
            return Ok((Vec::new(), Vec::new()));
        }
        Ok((present.checks(&Baseline::read(file).map_err(refused)?, allow), Vec::new()))
    }

    /// Says which baseline now holds the numbers of a run; the job does so for the scenes of one.
    pub fn say_accepted(&self, quiet: bool, job: &JobOptions) {
        let accepted = self.baseline.as_ref().filter(|_| self.accept && !quiet && !job.is_part());
        if let Some(file) = accepted {
            say::line(&format!("baseline: {} holds the numbers of this run", file.display()));
        }
    }

    /// Who accepts, when and why.
    pub fn signature(&self) -> Signature {
        self.signature.signature()
    }
}

impl SignatureOptions {
    /// Who accepts, when and why: what is not said is taken from the environment, which in CI names the one who pushed.
    pub fn signature(&self) -> Signature {
        let known = ["GIT_AUTHOR_NAME", "GITHUB_ACTOR", "GITLAB_USER_LOGIN", "LOGNAME", "USER"];
        let named = || known.iter().find_map(|name| std::env::var(name).ok().filter(|value| !value.is_empty()));
        let by = self.accepted_by.clone().or_else(named).unwrap_or_default();
        Signature { by, on: today(), reason: self.reason.clone() }
    }
}

fn refused(error: BaselineError) -> CliError {
    CliError::stopped(Exit::BadInput, error.to_string(), "")
}
