//! A scene through every method and both displacement models, and whether the answers can all be true.

mod judge;
mod run;
pub mod table;

use std::path::{Path, PathBuf};

pub use judge::{Fault, faults};
pub use run::{Ended, Program, Way};

use super::scenes::Sample;

/// The methods of the dual problem.
pub const METHODS: [&str; 4] = ["condensed", "active-set", "clarabel", "uzawa"];

/// The adaptive refinements on the way to a tolerance.
pub const ADAPTIVE: [&str; 2] = ["h", "hp"];

/// The outcome of a scene.
pub struct Trial {
    pub seed: u64,
    pub family: &'static str,
    /// The scene file, kept where something is wrong.
    pub scene: PathBuf,
    pub runs: Vec<(Way, Ended)>,
    pub faults: Vec<Fault>,
}

impl Trial {
    /// Solves `sample` by every method, finer, by these adaptive ways, and with `models` by `verify`. Files appear in `folder`, and
    /// stay there where something is wrong.
    pub fn of(sample: &Sample, program: &Program, folder: &Path, adaptive: &[&'static str], models: bool) -> Trial {
        let scene = sample.write(folder);
        let results = folder.join(format!("seed-{}", sample.seed));
        let mut ways: Vec<Way> = METHODS.map(Way::Method).to_vec();
        ways.push(Way::Finer);
        ways.extend(adaptive.iter().copied().map(Way::Adaptive));
        ways.extend(models.then_some(Way::Verify));
        let runs: Vec<(Way, Ended)> = ways.into_iter().map(|way| (way, program.run(way, &scene, &results))).collect();
        let faults = faults(&runs, sample.rounding, sample.rounds);
        if faults.is_empty() {
            // Left-overs are no reason to fail.
            let _ = std::fs::remove_dir_all(&results);
            let _ = std::fs::remove_file(&scene);
            let _ = std::fs::remove_file(scene.with_extension("msh"));
        }
        Trial { seed: sample.seed, family: sample.family, scene, runs, faults }
    }
}
