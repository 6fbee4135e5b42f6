//! Results of a job: `job.json`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::plan::Shard;
use crate::report::{Status, Stored};

/// `job.json`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Job {
    /// Version of this format.
    pub schema_version: u32,
    /// The command that every scene was given to: `verify`, `solve`, `certify`.
    pub command: String,
    /// The options of that command, the same for every scene.
    pub options: Vec<String>,
    /// Version of hypercircle.
    pub version: String,
    /// The exit code: that of the worst scene, in the order 3, 2, 4, 5, 1, 0.
    pub exit: u8,
    /// How many scenes ended how.
    pub counts: Counts,
    /// The seconds of all scenes, added.
    pub seconds: f64,
    /// The scenes, in the order in which they were found.
    pub scenes: Vec<Entry>,
    /// TOML files in the folders that describe no scene, and were left out.
    pub left_out: Vec<String>,
    /// Scenes of the baseline that are not in the job.
    pub not_in_job: Vec<String>,
}

/// How many scenes ended how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Counts {
    /// All scenes.
    pub scenes: usize,
    /// Exit code 0.
    pub agree: usize,
    /// Exit code 1, `undecided` among them.
    pub disagree: usize,
    /// Exit code 2.
    pub bad_input: usize,
    /// Exit code 3.
    pub failed: usize,
    /// Exit code 4.
    pub not_installed: usize,
    /// Exit code 5.
    pub no_equilibrium: usize,
}

/// One scene of a job.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Entry {
    /// Its name in the job, which no other scene has.
    pub name: String,
    /// The scene file, as given.
    pub scene: String,
    /// Its title, where the scene could be read.
    pub title: Option<String>,
    /// Its folder below that of the job; `null` where the scene left no report.
    pub folder: Option<String>,
    /// Exit code of its own run; 3 where it crashed, took too long or was not run.
    pub exit: u8,
    /// How it ended.
    pub status: SceneStatus,
    /// One sentence: the verdict, or why there is none.
    pub verdict: String,
    /// The line of the scene file that is at fault, where one is.
    pub line: Option<usize>,
    /// Seconds of the whole process.
    pub seconds: f64,
    /// Identifies the run, as in its report.
    pub run: Option<String>,
    /// The energy bracket.
    pub energy: Option<Bracketed>,
    /// Number of triangles.
    pub triangles: Option<usize>,
    /// How many checks were made or should have been.
    pub checks: usize,
    /// Names of those that did not pass.
    pub failing: Vec<String>,
    /// Numbers that differ from the baseline.
    pub changed: Vec<String>,
    /// Numbers that the baseline does not have.
    pub new: Vec<String>,
    /// Numbers that only the baseline has.
    pub missing: Vec<String>,
    /// The last lines that it printed, where it left no report.
    pub said: Vec<String>,
}

/// The bounds of the energy; `null` for a number that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Bracketed {
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
    /// √(gap / 𝒮).
    pub relative_error_bound: Option<f64>,
    /// Whether the bracket holds for the scene as written.
    pub guaranteed: bool,
}

/// How a scene ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SceneStatus {
    /// All checks passed.
    Agree,
    /// At least one check did not.
    Disagree,
    /// The bracket is too wide to tell.
    Undecided,
    /// There is no equilibrium.
    Infeasible,
    /// A solver or the reference failed.
    Failed,
    /// The scene, its mesh or field, or an option is at fault.
    BadInput,
    /// The reference is not installed.
    NotInstalled,
    /// The process was ended by a signal, or ended without telling how.
    Crashed,
    /// It took longer than a scene may, and was ended.
    TimedOut,
    /// It has not been run, or not with these options.
    NotRun,
}

impl SceneStatus {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            SceneStatus::Agree => "agree",
            SceneStatus::Disagree => "disagree",
            SceneStatus::Undecided => "undecided",
            SceneStatus::Infeasible => "no equilibrium",
            SceneStatus::Failed => "failed",
            SceneStatus::BadInput => "bad input",
            SceneStatus::NotInstalled => "reference not installed",
            SceneStatus::Crashed => "crashed",
            SceneStatus::TimedOut => "took too long",
            SceneStatus::NotRun => "not run",
        }
    }

    /// A symbol that tells the groups apart without colour.
    pub fn symbol(self) -> &'static str {
        match self {
            SceneStatus::Agree => "✔",
            SceneStatus::Disagree => "✘",
            SceneStatus::Undecided => "?",
            SceneStatus::Infeasible => "∅",
            _ => "⚠",
        }
    }

    /// That of a report whose process ended with `exit`.
    pub(super) fn of(report: Status, exit: u8) -> Self {
        match (report, exit) {
            (_, 4) => SceneStatus::NotInstalled,
            (Status::Agree, _) => SceneStatus::Agree,
            (Status::Disagree, _) => SceneStatus::Disagree,
            (Status::Undecided, _) => SceneStatus::Undecided,
            (Status::Infeasible, _) => SceneStatus::Infeasible,
            (Status::Failed, _) => SceneStatus::Failed,
        }
    }
}

/// How bad an exit code is: 0 is best. The order is 3, 2, 4, 5, 1, 0 from the worst on.
pub fn severity(exit: u8) -> usize {
    const FROM_THE_BEST: [u8; 6] = [0, 1, 5, 4, 2, 3];
    FROM_THE_BEST.iter().position(|code| *code == exit).unwrap_or(FROM_THE_BEST.len() - 1)
}

impl Job {
    /// Counts the scenes anew, with what follows from that.
    pub(super) fn count(&mut self) {
        let exits = || self.scenes.iter().map(|scene| scene.exit);
        self.exit = exits().max_by_key(|exit| severity(*exit)).unwrap_or(0);
        self.counts = Counts::of(exits());
        self.seconds = self.scenes.iter().map(|scene| scene.seconds).sum();
    }

    /// Indices of the scenes from the worst on; equally bad ones in the order in which they were found.
    pub fn worst_first(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.scenes.len()).collect();
        let badness = |i: &usize| {
            let entry = &self.scenes[*i];
            (severity(entry.exit), entry.status != SceneStatus::Undecided)
        };
        order.sort_by_key(|i| std::cmp::Reverse(badness(i)));
        order
    }

    /// True if two models were compared, so that they can agree; the checks of one alone can only pass.
    pub fn compares(&self) -> bool {
        self.command != "solve"
    }

    /// The word for a scene.
    pub fn word(&self, status: SceneStatus) -> &'static str {
        if status == SceneStatus::Agree && !self.compares() { "passed" } else { status.words() }
    }

    /// The job in one sentence.
    pub fn sentence(&self) -> String {
        let c = self.counts;
        let word = |n: usize, one: &str| (n > 0).then(|| format!("{n} {one}"));
        let parts: Vec<String> = [
            word(c.agree, self.word(SceneStatus::Agree)),
            word(c.disagree, if self.compares() { "disagree or undecided" } else { "not passed" }),
            word(c.no_equilibrium, "without equilibrium"),
            word(c.not_installed, "without the reference"),
            word(c.bad_input, "with bad input"),
            word(c.failed, "failed"),
        ]
        .into_iter()
        .flatten()
        .collect();
        let scenes = if c.scenes == 1 { "scene" } else { "scenes" };
        format!("{} {scenes}: {}", c.scenes, parts.join(", "))
    }
}

impl Counts {
    /// Counts exit codes.
    pub fn of(exits: impl IntoIterator<Item = u8>) -> Self {
        let mut counts = Counts::default();
        for exit in exits {
            counts.scenes += 1;
            let count = match exit {
                0 => &mut counts.agree,
                1 => &mut counts.disagree,
                2 => &mut counts.bad_input,
                4 => &mut counts.not_installed,
                5 => &mut counts.no_equilibrium,
                _ => &mut counts.failed,
            };
            *count += 1;
        }
        counts
    }
}

/// A job with the reports of its scenes, in the same order.
#[derive(Debug)]
pub struct Gathered {
    /// The job.
    pub job: Job,
    /// The report of each scene that left one.
    pub reports: Vec<Option<Stored>>,
    /// Patch that would bring the baseline up to date, where it differs.
    pub patch: Option<String>,
}

impl Gathered {
    /// The scenes of one part of the job, as if they were all of it.
    pub fn part(mut self, shard: Shard) -> Self {
        let job = &mut self.job;
        job.scenes = job.scenes.drain(..).enumerate().filter(|(i, _)| shard.has(*i)).map(|(_, scene)| scene).collect();
        self.reports =
            self.reports.drain(..).enumerate().filter(|(i, _)| shard.has(*i)).map(|(_, report)| report).collect();
        job.count();
        self
    }
}

/// JSON Schema of `job.json`.
pub fn schema() -> serde_json::Value {
    let written = schemars::generate::SchemaSettings::default().for_serialize();
    written.into_generator().into_root_schema_for::<Job>().to_value()
}

#[cfg(test)]
mod tests {
    use super::severity;

    #[test]
    fn the_worst_exit_code_is_3_then_2_4_5_1_0() {
        let mut codes = [0, 1, 2, 3, 4, 5];
        codes.sort_by_key(|code| std::cmp::Reverse(severity(*code)));
        assert_eq!(codes, [3, 2, 4, 5, 1, 0]);
        assert_eq!(severity(101), severity(3), "an exit code that is none of these is a failure");
    }
}
