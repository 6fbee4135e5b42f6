//! Intervals of quantities on random scenes against those of cubic stresses on a finer mesh: whether any is wrong, how wide
//! they are beside the error of the value that is printed, and why ends are missing. Writes `docs/data/quantity_scenes.json` and
//! prints a table of `docs/quantities.md`.
//!
//! `cargo run --release --example quantity_scenes -- 200 7000`
//!
//! The name of a family behind the first seed asks for scenes of it alone, prints, and writes nothing.

#[path = "../tests/support/mod.rs"]
mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use hypercircle::dual::Condensed;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::study::{Answer, StudyError, answers, certify_divided};
use serde_json::json;
use support::asked::{ask, everything, of_degree};
use support::random::Random;
use support::scenes::{sample, sample_of};

/// Larger meshes take too long when there are hundreds.
const MOST_TRIANGLES: usize = 600;

/// An interval of the finer mesh that is this much narrower stands for the truth.
const NARROWER: f64 = 5.0;

/// Counts and figures of quantities of one kind.
#[derive(Default)]
struct Seen {
    asked: usize,
    by_statics: usize,
    one_end: usize,
    no_end: usize,
    outside: usize,
    /// Half-width over the distance of the value from the truth.
    effectivity: Vec<f64>,
    /// Width over that of first order.
    of_first_order: Vec<f64>,
}

fn main() -> ExitCode {
    let number = |n: usize, usual: u64| std::env::args().nth(n).map_or(usual, |n| n.parse().expect("a number"));
    let (wanted, first) = (number(1, 200), number(2, 7000));
    let family = std::env::args().nth(3);
    let mut kinds: BTreeMap<&str, Seen> = BTreeMap::new();
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    let (mut met, mut seed) = (0, first);
    while met < wanted {
        seed += 1;
        let Some([coarse, fine]) = both(seed, family.as_deref()) else { continue };
        met += 1;
        for (coarse, fine) in coarse.iter().zip(&fine) {
            kinds.entry(coarse.kind.name()).or_default().add(seed, coarse, fine);
            for reason in coarse.interval.reasons.iter().flatten() {
                *reasons.entry(anonymous(reason)).or_default() += 1;
            }
        }
    }
    let mut rows = Vec::new();
    println!("{met} scenes, seeds {} to {seed}", first + 1);
    println!(
        "\n| kind | asked | exact by statics | one end missing | both | outside | effectivity: median | nine tenths below | width / first order |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    for (kind, seen) in &mut kinds {
        let [median, most] = [0.5, 0.9].map(|part| quantile(&mut seen.effectivity, part));
        let narrower = quantile(&mut seen.of_first_order, 0.5);
        let Seen { asked, by_statics, one_end, no_end, outside, .. } = seen;
        println!(
            "| {kind} | {asked} | {by_statics} | {one_end} | {no_end} | {outside} | {median:.1} | {most:.1} | {narrower:.3} |"
        );
        rows.push(json!({
            "kind": kind, "asked": asked, "exact_by_statics": by_statics, "one_end_missing": one_end,
            "both_ends_missing": no_end, "outside": outside, "effectivity": [median, most], "of_first_order": narrower,
        }));
    }
    println!("\n| why an end is missing | ends |\n|---|--:|");
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    reasons.iter().for_each(|(reason, count)| println!("| {reason} | {count} |"));

    if family.is_some() {
        return ExitCode::from(u8::from(kinds.values().any(|seen| seen.outside > 0)));
    }
    let command = format!("cargo run --release --example quantity_scenes -- {wanted} {first}");
    let data =
        json!({ "command": command, "scenes": met, "seeds": [first + 1, seed], "kinds": rows, "reasons": reasons });
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/data/quantity_scenes.json");
    if let Err(error) = std::fs::write(&file, format!("{data:#}\n")) {
        eprintln!("docs/data/quantity_scenes.json: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::from(u8::from(kinds.values().any(|seen| seen.outside > 0)))
}

/// The answers of linear stresses on the mesh of a scene and of cubic ones on a finer mesh, where the scene has an equilibrium
/// and no curves.
fn both(seed: u64, family: Option<&str>) -> Option<[Vec<Answer>; 2]> {
    let folder = tempfile::tempdir().expect("a folder");
    let sample = family.map_or_else(|| Some(sample(seed)), |family| sample_of(family, seed))?;
    let file = sample.write(folder.path());
    let mut problem = Problem::load(Scene::read(&file).ok()?).ok()?;
    // A finer mesh of a curve is another problem.
    if problem.has_elastic_contact()
        || problem.contact_turns()
        || problem.follows_curves()
        || problem.mesh.triangles.len() > MOST_TRIANGLES
    {
        return None;
    }
    let quantities = everything(&problem, &mut Random::new(seed));
    ask(&mut problem, quantities);
    let found = |problem: Problem, degree: usize| {
        let options = of_degree(degree);
        match certify_divided(problem, &Condensed::default(), &options) {
            Ok(certified) => Some(answers(&certified, &options, |_| true)),
            Err(StudyError::NoEquilibrium { .. } | StudyError::Contradiction(_)) => None,
            Err(error) => {
                eprintln!("seed {seed}, degree {degree}: {error}");
                None
            }
        }
    };
    let finer = problem.refine_uniform(1).ok()?;
    Some([found(problem, 1)?, found(finer, 3)?])
}

impl Seen {
    fn add(&mut self, seed: u64, coarse: &Answer, fine: &Answer) {
        self.asked += 1;
        self.by_statics += usize::from(coarse.interval.exact_by_statics);
        let ([a, b], [c, d]) = (coarse.interval.ends, fine.interval.ends);
        if a > d || c > b || a > b {
            println!("seed {seed}: {} is in [{a}, {b}] and in [{c}, {d}]", coarse.name);
            self.outside += 1;
        }
        match coarse.interval.reasons.iter().flatten().count() {
            0 => {}
            1 => self.one_end += 1,
            _ => self.no_end += 1,
        }
        let [half, finer] = [coarse, fine].map(|answer| answer.interval.half_width());
        let told = half.is_finite() && NARROWER * finer < half;
        if coarse.interval.exact_by_statics || !told {
            return;
        }
        let off = (coarse.interval.value - 0.5 * (c + d)).abs();
        self.effectivity.push(half / off.max(finer));
        let [low, high] = coarse.interval.first_order;
        if (high - low).is_finite() {
            self.of_first_order.push((b - a) / (high - low));
        }
    }
}

fn quantile(values: &mut [f64], part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get((part * values.len() as f64) as usize).copied().unwrap_or(f64::NAN)
}

/// A reason without its numbers and names of bodies, so that those alike are counted together.
fn anonymous(reason: &str) -> String {
    let word = |word: &str| {
        let bare = word.trim_matches(|c: char| !c.is_alphanumeric() && c != '-');
        let is_name = word == format!("'{bare}'");
        if bare.parse::<f64>().is_ok() || is_name { word.replace(bare, "…") } else { word.to_string() }
    };
    reason.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
