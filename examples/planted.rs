//! Bugs planted in the displacement model, their effect, and what caught them: `ci/planted`.

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Parser;
use support::planted::{Effect, Fate, Kind, Planted, Soil, kinds};
use support::scenes::sample;

/// Plants every known bug in the displacement model of every scene; fails where one is missed that theory lets be seen.
#[derive(Parser)]
struct Args {
    /// Scenes
    scenes: Vec<PathBuf>,
    /// Random scenes in addition, with seeds from this one on …
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// … and how many
    #[arg(long, default_value_t = 0)]
    random: u64,
    /// Places in which each bug is planted
    #[arg(long, default_value_t = 1)]
    places: u64,
    /// Bugs whose name contains this
    #[arg(long, default_value = "")]
    only: String,
    /// Runs at a time
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Where everything goes
    #[arg(long, default_value = "out/planted")]
    out: PathBuf,
    /// The program
    #[arg(long, default_value = "target/release/hypercircle")]
    binary: PathBuf,
}

fn main() -> ExitCode {
    let args = Args::parse();
    // A folder that is not there yet is no reason to fail.
    let _ = std::fs::remove_dir_all(&args.out);
    std::fs::create_dir_all(&args.out).expect("a folder to write to");
    let out = std::path::absolute(&args.out).expect("a folder to write to");
    let mut scenes = args.scenes.clone();
    for seed in args.seed..args.seed + args.random {
        scenes.push(sample(seed).write(&out));
    }
    let faults: Vec<Kind> = kinds().into_iter().filter(|k| k.name.contains(&args.only)).collect();
    let head = "| scene | planted in | what | energy | force | displacement | bracket leaves open | caught by |\n\
                |---|---|---|--:|--:|--:|--:|---|";
    println!("{head}");
    let (mut lines, mut missed, mut other) = (vec![head.to_owned()], 0, None::<PathBuf>);
    let mut counts = [0_usize; 4];
    for scene in &scenes {
        let name = scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = out.join(&name);
        let soil = match Soil::new(&args.binary, scene, &folder) {
            Ok(soil) => soil,
            Err(why) => {
                eprintln!("{name} is left out, the honest model does not agree: {why}");
                continue;
            }
        };
        let tasks: Vec<(&Kind, u64)> = faults.iter().flat_map(|k| (0..args.places).map(move |s| (k, s))).collect();
        let mut planted = in_parallel(&soil, &tasks, other.as_deref(), args.jobs);
        planted.sort_by_key(|p| (!p.kind.in_model, p.kind.name.clone(), p.seed));
        for one in planted {
            if let Some(line) = line(&name, &soil, &one) {
                println!("{line}");
                lines.push(line);
            }
            match one.fate {
                Fate::Caught(_) => counts[0] += 1,
                Fate::WithoutEffect => counts[1] += 1,
                Fate::WithinBracket => counts[2] += 1,
                Fate::Missed => missed += 1,
                Fate::NoPlace => counts[3] += 1,
            }
        }
        other = Some(soil.kept("nothing", 0));
    }
    let [caught, without, within, nowhere] = counts;
    let summary = format!(
        "{} planted: {caught} caught, {without} without effect, {within} within what the bracket leaves open, {missed} missed; \
         {nowhere} more had no place in their scene.",
        caught + without + within + missed
    );
    println!("\n{summary}");
    let page = format!("{summary}\n\n{}\n", lines.join("\n"));
    std::fs::write(out.join("table.md"), page).expect("a folder to write to");
    ExitCode::from(u8::from(missed > 0 || caught == 0))
}

fn in_parallel(soil: &Soil, tasks: &[(&Kind, u64)], other: Option<&Path>, jobs: usize) -> Vec<Planted> {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while let Some((kind, seed)) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let planted = soil.plant(kind, *seed, other);
                    found.lock().expect("no other thread panicked").push(planted);
                }
            });
        }
    });
    found.into_inner().expect("no thread panicked")
}

fn line(scene: &str, soil: &Soil, planted: &Planted) -> Option<String> {
    let caught = match &planted.fate {
        Fate::NoPlace => return None,
        Fate::Caught(checks) => {
            let mut names: Vec<String> = checks.iter().map(|c| c.replace('|', "\\|")).collect();
            let more = names.len().saturating_sub(3);
            names.truncate(3);
            let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
            format!("{}{rest}", names.join(", "))
        }
        Fate::WithoutEffect => "nothing: without effect".to_owned(),
        Fate::WithinBracket => "nothing: within what the bracket leaves open".to_owned(),
        Fate::Missed => "**nothing**".to_owned(),
    };
    let effect = match planted.effect {
        None => "– | – | –".to_owned(),
        Some(Effect { energy, force, displacement }) => format!("{energy:.1e} | {force:.1e} | {displacement:.1e}"),
    };
    let place = if planted.kind.in_model { "model" } else { "result" };
    let what = planted.kind.name.replace('_', " ");
    Some(format!("| {scene} | {place} | {what} | {effect} | {:.1e} | {caught} |", soil.open[0]))
}
