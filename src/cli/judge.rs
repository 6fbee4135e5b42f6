//! Tolerances and baselines from the command line.

use super::options::JudgeOptions;
use super::{CliError, Exit};
use crate::compare::{Allowances, Check, Comparison, names_of_checks};
use crate::scene::{Contact, Scene};
use crate::study::{Baseline, Certified};

impl JudgeOptions {
    /// The tolerances given with `--allow`.
    pub fn allowances(&self) -> Allowances {
        Allowances::new(self.allow.iter().map(|a| (a.name.clone(), a.value)).collect())
    }

    /// Refuses, before anything is solved, a baseline that cannot be read or written and a tolerance for a check that no
    /// comparison of `fields` makes.
    ///
    /// # Errors
    /// What is at fault.
    pub fn refuse_early(&self, scene: &Scene, fields: &[&str]) -> Result<(), CliError> {
        let refused = |e: crate::study::BaselineError| CliError::stopped(Exit::BadInput, e.to_string(), "");
        match &self.baseline {
            Some(file) if self.accept => Baseline::refuse(file).map_err(refused)?,
            Some(file) => drop(Baseline::read(file).map_err(refused)?),
            None => {}
        }
        let contacts: Vec<String> = scene.contacts.iter().map(Contact::name).collect();
        let fields: Vec<String> = fields.iter().chain(&["free bound"]).map(|f| f.to_string()).collect();
        let mut names = names_of_checks(&contacts, &fields);
        for quantity in &scene.quantities {
            let of = |last: &str| format!("quantity/{}/{last}", quantity.name);
            names.extend(fields.iter().map(String::as_str).chain(["tolerance", "given"]).map(of));
        }
        let allow = self.allowances();
        match allow.foreign(&names).into_iter().find(|name| !name.starts_with("baseline/")) {
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
    pub fn refuse_unknown(&self, allow: &Allowances, checks: &[Check], incomplete: bool) -> Result<(), CliError> {
        let unknown = allow.unknown(checks);
        let meant: Vec<&&str> = unknown.iter().filter(|name| !name.starts_with("baseline/")).collect();
        if incomplete || meant.is_empty() {
            return Ok(());
        }
        let names: Vec<&str> = checks.iter().map(|c| c.name.as_str()).collect();
        Err(CliError::stopped(
            Exit::BadInput,
            format!("--allow names a check that was not made: {}", meant[0]),
            format!("use one of {}, or the last part of one", names.join(", ")),
        ))
    }

    /// Compares with the baseline, or writes it.
    ///
    /// # Errors
    /// The baseline cannot be read or written.
    pub fn against_baseline(
        &self,
        certified: &Certified,
        comparison: &Comparison,
        allow: &Allowances,
    ) -> Result<Vec<Check>, CliError> {
        let Some(file) = &self.baseline else { return Ok(Vec::new()) };
        let present = Baseline::new(certified, comparison);
        let refused = |e: crate::study::BaselineError| CliError::stopped(Exit::BadInput, e.to_string(), "");
        if self.accept {
            present.write(file).map_err(refused)?;
            return Ok(Vec::new());
        }
        Ok(present.checks(&Baseline::read(file).map_err(refused)?, allow))
    }
}
