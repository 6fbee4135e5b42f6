//! Random scenes by seed: the same seed is the same scene for ever.
//!
//! A good share has an equilibrium, a share has none, and some are on the border: bodies that slide freely, that contact
//! alone holds, that nothing loads, gaps that never close. A new family is a file with a function
//! `fn(&mut Random) -> Made` and a line in [`FAMILIES`].

mod conditions;
mod curved;
mod frame;
mod lattice;
mod layout;
mod matter;
mod mixed;
mod moved;
mod msh;
mod obstacles;
mod powers;
mod rough;
pub mod stack;
mod turned;

use std::path::{Path, PathBuf};

use super::random::Random;
use super::toml::Toml;

/// A scene and where it comes from.
pub struct Sample {
    pub seed: u64,
    pub family: &'static str,
    /// The scene file.
    pub text: String,
    /// The mesh file `seed-N.msh` beside it, if there is one.
    pub mesh: Option<String>,
    /// Largest error of an energy by arithmetic alone: the energy of strains as large as the prescribed displacements, times
    /// a little more than the machine epsilon.
    pub rounding: f64,
    /// True if refinement puts vertices on curves, so that a finer mesh is another problem.
    pub rounds: bool,
}

impl Sample {
    /// Writes the scene, and its mesh, to `folder`; the path of the scene.
    pub fn write(&self, folder: &Path) -> PathBuf {
        std::fs::create_dir_all(folder).expect("a folder to write to");
        let path = folder.join(format!("seed-{}.toml", self.seed));
        std::fs::write(&path, &self.text).expect("a folder to write to");
        if let Some(mesh) = &self.mesh {
            std::fs::write(path.with_extension("msh"), mesh).expect("a folder to write to");
        }
        path
    }
}

/// A scene, and the energy of strains as large as the displacements that are prescribed in it.
pub struct Made {
    pub toml: Toml,
    /// The mesh file, for a scene without polygons.
    pub mesh: Option<String>,
    pub energy: f64,
    /// As [`Sample::rounds`].
    pub rounds: bool,
}

/// Makes a scene of one kind.
type Family = fn(&mut Random) -> Made;

/// Name, share, and maker of each family.
const FAMILIES: [(&str, usize, Family); 3] =
    [("blocks", 10, lattice::blocks), ("shapes", 7, lattice::shapes), ("stack", 3, stack::made)];

/// Families that came later take seeds from all others, each with this probability, so that the rest stay what they are.
const LATER: [(&str, f64, Family); 11] = [
    ("crowd", 0.1, lattice::crowd),
    ("curved", 0.15, curved::curved),
    ("moved", 0.1, moved::moved),
    ("quadrilaterals", 0.12, lattice::quadrilaterals),
    ("obstacles", 0.16, obstacles::obstacles),
    ("matter", 0.15, lattice::matter),
    ("heavy", 0.08, stack::heavy),
    ("rough", 0.12, rough::rough),
    ("mixed", 0.2, mixed::mixed),
    ("turned", 0.1, turned::turned),
    ("powers", 0.1, powers::powers),
];

/// The scene of a seed in one family.
pub fn sample_of(wanted: &str, seed: u64) -> Option<Sample> {
    let makers =
        FAMILIES.iter().map(|(name, _, make)| (*name, *make)).chain(LATER.iter().map(|(name, _, make)| (*name, *make)));
    let (family, make) = makers.into_iter().find(|(name, _)| *name == wanted)?;
    Some(finished(seed, family, make(&mut Random::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d)))))
}

/// The scene of a seed.
pub fn sample(seed: u64) -> Sample {
    let mut random = Random::new(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
    let mut aside = random.aside();
    if let Some((family, _, make)) = LATER.into_iter().find(|(_, probability, _)| aside.chance(*probability)) {
        return finished(seed, family, make(&mut random));
    }
    let mut ticket = random.below(FAMILIES.iter().map(|f| f.1).sum());
    let (family, _, make) = FAMILIES
        .into_iter()
        .find(|(_, share, _)| {
            let found = ticket < *share;
            ticket = ticket.saturating_sub(*share);
            found
        })
        .expect("a ticket below the sum of the shares");
    finished(seed, family, make(&mut random))
}

fn finished(seed: u64, family: &'static str, Made { mut toml, mesh, energy, rounds }: Made) -> Sample {
    if mesh.is_some() {
        toml = toml.mesh_file(&format!("seed-{seed}.msh"));
    }
    let text = format!("# Random scene {seed}: {family}\n{}", toml.text());
    Sample { seed, family, text, mesh, rounding: 1e-13 * energy, rounds }
}
