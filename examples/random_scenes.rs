//! Random scenes through every method and both displacement models: `ci/random`.

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use clap::Parser;
use support::scenes::{sample, sample_of};
use support::trial::table::{families, groups, head, row};
use support::trial::{ADAPTIVE, Program, Trial};

/// Solves random scenes in every way, and fails where the answers cannot all be true.
#[derive(Parser)]
struct Args {
    /// How many scenes
    scenes: u64,
    /// The seed of the first scene; the others follow
    #[arg(default_value_t = 1)]
    seed: u64,
    /// Scenes of this family alone
    #[arg(long)]
    family: Option<String>,
    /// Leave FEniCSx out
    #[arg(long)]
    solve_only: bool,
    /// Write the scenes, and solve none
    #[arg(long)]
    write_only: bool,
    /// Scenes solved at a time
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Where scenes and results go; those with nothing wrong are removed
    #[arg(long, default_value = "out/random")]
    out: PathBuf,
    /// The program
    #[arg(long, default_value = "target/release/hypercircle")]
    binary: PathBuf,
    /// Stop a run after so many seconds
    #[arg(long, default_value_t = 120.0)]
    seconds: f64,
}

fn main() -> ExitCode {
    let args = Args::parse();
    std::fs::create_dir_all(&args.out).expect("a folder to write to");
    let seeds = args.seed..args.seed + args.scenes;
    let sample = |seed: u64| match &args.family {
        None => sample(seed),
        Some(family) => sample_of(family, seed).unwrap_or_else(|| panic!("no family is called {family}")),
    };
    if args.write_only {
        for seed in seeds {
            sample(seed).write(&args.out);
        }
        return ExitCode::SUCCESS;
    }
    let program =
        Program { binary: args.binary.clone(), limit: Duration::from_secs_f64(args.seconds), environment: Vec::new() };
    let next = AtomicU64::new(args.seed);
    let trials: Mutex<Vec<Trial>> = Mutex::default();
    println!("{}", head(!args.solve_only));
    std::thread::scope(|scope| {
        for _ in 0..args.jobs {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if !seeds.contains(&seed) {
                        break;
                    }
                    let trial = Trial::of(&sample(seed), &program, &args.out, &ADAPTIVE, !args.solve_only);
                    println!("{}", row(&trial));
                    trials.lock().expect("no other thread panicked").push(trial);
                }
            });
        }
    });
    let mut trials = trials.into_inner().expect("no thread panicked");
    trials.sort_by_key(|t| t.seed);
    let rows: Vec<String> = trials.iter().map(row).collect();
    let summary = groups(&trials);
    let page = format!("{summary}\n{}\n{}\n{}\n", families(&trials), head(!args.solve_only), rows.join("\n"));
    std::fs::write(args.out.join("table.md"), page).expect("a folder to write to");
    println!("\n{summary}");
    for trial in trials.iter().filter(|t| !t.faults.is_empty()) {
        println!("seed {}:", trial.seed);
        for fault in &trial.faults {
            println!("  {}: {}", fault.kind, fault.text);
        }
        println!("  {} verify {}", args.binary.display(), trial.scene.display());
    }
    ExitCode::from(u8::from(trials.iter().any(|t| !t.faults.is_empty())))
}
