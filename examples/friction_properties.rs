//! Properties of friction with a given bound on random scenes of the family `rough`: energies grow with the bound, one of next to nothing is
//! frictionless contact but for rounding, and one beyond all tractions is one ten times as large to the last digits, and a bond where nothing opens.
//!
//! `cargo run --release --example friction_properties -- 100 1000`: so many scenes, from the seed behind the first number on.

#[path = "../tests/support/mod.rs"]
mod support;

use std::process::ExitCode;

use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::{Affine, Bond, ContactSides, Draft, Scene, Support, SupportKind};
use hypercircle::study::{Certified, StudyError, certify};
use support::scenes::sample_of;

/// Larger meshes take too long when there are hundreds.
const MOST_TRIANGLES: usize = 400;

/// Factors of the bounds of a scene; the first is frictionless, and none is larger than the last two.
const FACTORS: [f64; 8] = [0.0, 1e-12, 1e-3, 0.25, 1.0, 4.0, 1e8, 1e9];

/// Differences of energies that are rounding, relative to the energy that is stored.
const ROUNDING: f64 = 1e-10;

/// Allowed difference of energies with very small bounds from those without friction, and with very large bounds from each other and
/// from those of a bond, relative to the energy that is stored.
const STUCK: f64 = 1e-8;

#[derive(Default)]
struct Seen {
    scenes: usize,
    compared: usize,
    frictionless: usize,
    stuck: usize,
    bonded: usize,
    violations: usize,
    unsolved: usize,
}

fn main() -> ExitCode {
    let number = |n: usize, usual: u64| std::env::args().nth(n).map_or(usual, |n| n.parse().expect("a number"));
    let (wanted, first) = (number(1, 100) as usize, number(2, 1000));
    let (mut seen, mut seed) = (Seen::default(), first);
    while seen.scenes < wanted {
        if let Some(problem) = problem(seed) {
            seen.look_at(seed, &problem);
        }
        seed += 1;
    }
    let Seen { scenes, compared, frictionless, stuck, bonded, violations, unsolved } = seen;
    println!("{scenes} scenes, seeds {first} to {}", seed - 1);
    println!(
        "{compared} pairs of bounds compared; {frictionless} frictionless, {stuck} with no slip, {bonded} against bonds"
    );
    println!("{violations} violations, {unsolved} solves that ended without an answer");
    ExitCode::from(u8::from(violations > 0))
}

fn problem(seed: u64) -> Option<Problem> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = sample_of("rough", seed)?.write(folder.path());
    let problem = Problem::load(Scene::read(&file).ok()?).ok()?;
    (problem.has_friction() && problem.mesh.triangles.len() <= MOST_TRIANGLES).then_some(problem)
}

/// The problem with its bounds times a factor, on the same mesh; without friction for zero, as a scene has it.
fn with_bounds(problem: &Problem, factor: f64) -> Problem {
    let mut changed = problem.clone();
    for pair in changed.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs) {
        pair.friction = pair.friction.filter(|_| factor > 0.0).map(|mut friction| {
            friction.bound = friction.bound.map(|bound| factor * bound);
            friction
        });
    }
    changed
}

fn solved(problem: Problem) -> Result<Certified, StudyError> {
    certify(problem, &Condensed::default(), &Options::default())
}

fn ends(certified: &Certified) -> Option<[f64; 2]> {
    Some([certified.bracket.lower(), certified.bracket.free.as_ref().ok()?.upper()])
}

impl Seen {
    fn look_at(&mut self, seed: u64, problem: &Problem) {
        let mut last: Option<([f64; 2], f64)> = None;
        let (mut found, mut all): (Vec<Option<[f64; 2]>>, Vec<Option<Certified>>) = (Vec::new(), Vec::new());
        for factor in FACTORS {
            let certified = match solved(with_bounds(problem, factor)) {
                Ok(certified) => Some(certified),
                Err(StudyError::NoEquilibrium { .. }) if last.is_none() => None,
                Err(error) => {
                    // Friction only adds to what is held.
                    println!("seed {seed}, {factor}: {error}");
                    let lost = matches!(error, StudyError::NoEquilibrium { .. });
                    self.violations += usize::from(lost);
                    self.unsolved += usize::from(!lost);
                    None
                }
            };
            let own = certified.as_ref().and_then(ends);
            if let (Some(certified), Some(now)) = (&certified, own) {
                let size = certified.bracket.complementary.stored().max(now[0].abs());
                if let Some((before, size_before)) = last {
                    self.compared += 1;
                    let slack = ROUNDING * size.max(size_before);
                    // The discrete lower bounds grow too: more tractions are allowed.
                    self.judge(
                        seed,
                        now[0] >= before[0] - slack && now[1] >= before[0] - slack,
                        "does not grow",
                        [before, now],
                    );
                }
                last = Some((now, size));
            }
            found.push(own);
            all.push(certified);
        }
        if last.is_none() {
            return;
        }
        self.scenes += 1;
        if let (Some(none), Some(tiny), Some(certified)) = (found[0], found[1], &all[1]) {
            self.frictionless += 1;
            let same = (tiny[0] - none[0]).abs() <= STUCK * certified.bracket.complementary.stored();
            self.judge(seed, same, "of a bound of next to nothing is not frictionless", [tiny, none]);
        }
        let [large, largest] = [found[FACTORS.len() - 2], found[FACTORS.len() - 1]];
        if let (Some(large), Some(largest), Some(certified)) = (large, largest, &all[FACTORS.len() - 1]) {
            self.stuck += 1;
            let slack = STUCK * certified.bracket.complementary.stored();
            self.judge(seed, (large[0] - largest[0]).abs() <= slack, "still changes with the bound", [large, largest]);
            if let Some(bonded) = bonded(problem, certified).and_then(|bonded| ends(&solved(bonded).ok()?)) {
                self.bonded += 1;
                self.judge(seed, (bonded[0] - largest[0]).abs() <= slack, "is not that of a bond", [bonded, largest]);
            }
        }
    }

    fn judge(&mut self, seed: u64, holds: bool, what: &str, energies: [[f64; 2]; 2]) {
        if !holds {
            println!("seed {seed}: the energy {what}: {energies:?}");
            self.violations += 1;
        }
    }
}

/// The problem with bonds in the place of contacts, where all of them have friction everywhere, in one direction, and stay closed.
fn bonded(problem: &Problem, stuck: &Certified) -> Option<Problem> {
    let plain = problem.pairs().all(|pair| {
        pair.gap == [0.0; 2]
            && pair.direction.is_constant()
            && pair.friction.is_some_and(|f| f.bound.iter().all(|b| *b > 0.0))
    });
    let straight =
        problem.scene.contacts.iter().all(|contact| contact.direction.is_none() && contact.obstacle.is_none());
    if !plain || !straight || problem.contact_bends() || !stuck.dual.closed.values().iter().all(|closed| *closed) {
        return None;
    }
    let mut draft: Draft = (*problem.scene).clone();
    for contact in std::mem::take(&mut draft.contacts) {
        match contact.sides {
            ContactSides::Between(sides) => draft.bonds.push(Bond { sides, stiffness: None, direction: None }),
            ContactSides::Rigid(on) => {
                let kind = SupportKind::Clamped { displacement: Affine::default() };
                draft.supports.push(Support { on, kind });
            }
        }
    }
    let bonded = Problem::load(Scene::new(draft).ok()?).ok()?;
    (bonded.mesh.triangles.len() == problem.mesh.triangles.len()).then_some(bonded)
}
