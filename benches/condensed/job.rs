//! One measurement: a method, a family of meshes and a size, in a process of its own.

use std::collections::BTreeMap;
use std::io::Read;
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use hypercircle::bounds::Bracket;
use hypercircle::dual::{self, ActiveSet, Clarabel, Condensed, DualMethod, Options, Uzawa, yardstick};
use hypercircle::primal;
use hypercircle::problem::Problem;

use crate::{machine, support};

/// The dual methods.
pub const METHODS: [&str; 4] = ["condensed", "active-set", "clarabel", "uzawa"];

fn method(name: &str) -> Option<Box<dyn DualMethod>> {
    match name {
        "condensed" => Some(Box::new(Condensed::default())),
        "active-set" => Some(Box::new(ActiveSet::default())),
        "clarabel" => Some(Box::new(Clarabel::default())),
        "uzawa" => Some(Box::new(Uzawa::default())),
        _ => None,
    }
}

/// How the triangles look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Squares cut in two: eight congruence classes.
    Squares,
    /// Inner vertices moved at random: no two triangles are congruent.
    Rough,
}

/// A measurement to be made.
pub struct Job {
    what: String,
    family: Family,
    n: usize,
}

/// Measured values of a job.
pub struct Measured {
    /// Squares per side.
    pub n: usize,
    values: BTreeMap<String, f64>,
}

impl Measured {
    /// A value by name; NaN where it was not measured.
    pub fn get(&self, name: &str) -> f64 {
        self.values.get(name).copied().unwrap_or(f64::NAN)
    }
}

/// First argument of a process that makes one measurement.
const MARK: &str = "--measure";

impl Job {
    pub fn new(what: &str, family: Family, n: usize) -> Self {
        Job { what: what.to_string(), family, n }
    }

    /// The job a process was started for.
    pub fn from_arguments(arguments: &[String]) -> Option<Self> {
        let [mark, what, family, n] = arguments else { return None };
        let family = if family == "rough" { Family::Rough } else { Family::Squares };
        (mark == MARK).then(|| Job { what: what.clone(), family, n: n.parse().unwrap_or(2) })
    }

    /// Runs the job in a process of its own, for `limit` at most.
    pub fn measure(&self, limit: Duration) -> Result<Measured, String> {
        let family = if self.family == Family::Rough { "rough" } else { "squares" };
        let n = self.n.to_string();
        let program = std::env::current_exe().map_err(|e| e.to_string())?;
        let mut child = Command::new(program)
            .args([MARK, &self.what, family, &n])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| e.to_string())?;
        let start = Instant::now();
        loop {
            match child.try_wait().map_err(|e| e.to_string())? {
                Some(status) => {
                    let text = |pipe: Option<&mut dyn Read>| {
                        let mut text = String::new();
                        if let Some(pipe) = pipe {
                            let _ = pipe.read_to_string(&mut text);
                        }
                        text
                    };
                    let errors = text(child.stderr.as_mut().map(|p| p as &mut dyn Read));
                    if !status.success() {
                        return Err(errors.lines().last().unwrap_or("ended without a word").to_string());
                    }
                    let out = text(child.stdout.as_mut().map(|p| p as &mut dyn Read));
                    let pair = |line: &str| {
                        let (name, value) = line.split_once(' ')?;
                        Some((name.to_string(), value.parse().ok()?))
                    };
                    return Ok(Measured { n: self.n, values: out.lines().filter_map(pair).collect() });
                }
                None if start.elapsed() > limit => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return Err(format!("not ended after {} s", limit.as_secs()));
                }
                None => std::thread::sleep(Duration::from_millis(20)),
            }
        }
    }

    /// Makes the measurement and prints it, one name and value a line.
    pub fn run(&self) -> ExitCode {
        let _ = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
        let problem = problem(self.family, self.n);
        let mut values: BTreeMap<&str, f64> = BTreeMap::new();
        values.insert("triangles", problem.mesh.triangles.len() as f64);
        let done = match self.what.as_str() {
            "faer" => repeat(&mut values, |values| plain(&problem, values)),
            "fenicsx" => displacements(&problem, &mut values),
            name => match method(name) {
                Some(method) => repeat(&mut values, |values| bracket(&*method, &problem, values)),
                None => Err(format!("no method is called {name}")),
            },
        };
        if let Err(message) = done {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
        values.insert("peak", machine::peak());
        values.iter().for_each(|(name, value)| println!("{name} {value}"));
        ExitCode::SUCCESS
    }
}

/// The least of three runs; of fewer, where they are long.
fn repeat(
    values: &mut BTreeMap<&'static str, f64>,
    mut run: impl FnMut(&mut BTreeMap<&'static str, f64>) -> Result<f64, String>,
) -> Result<(), String> {
    let start = Instant::now();
    for _ in 0..3 {
        let mut these = values.clone();
        let seconds = run(&mut these)?;
        these.insert("seconds", seconds);
        if values.get("seconds").is_none_or(|least| seconds < *least) {
            *values = these;
        }
        if start.elapsed() > Duration::from_secs(10) {
            break;
        }
    }
    Ok(())
}

/// Processor time since the start, or wall-clock time where the system does not count it.
struct Clock(Option<f64>, Instant);

impl Clock {
    fn start() -> Self {
        Clock(machine::processor_seconds(), Instant::now())
    }

    fn seconds(&self) -> f64 {
        let own = machine::processor_seconds().zip(self.0).map(|(now, then)| now - then);
        own.unwrap_or_else(|| self.1.elapsed().as_secs_f64())
    }
}

fn bracket(
    method: &dyn DualMethod,
    problem: &Problem,
    values: &mut BTreeMap<&'static str, f64>,
) -> Result<f64, String> {
    let clock = Clock::start();
    let found = dual::solve(method, problem, &[], &Options::default()).map_err(|e| e.to_string())?;
    let solved = clock.1.elapsed().as_secs_f64();
    let bracket = Bracket::new(problem, &found);
    let seconds = clock.seconds();
    let wall = clock.1.elapsed().as_secs_f64();
    let phases = found.seconds;
    let named = [
        ("wall", wall),
        ("assemble", phases.assemble / wall),
        ("factor", phases.factor / wall),
        ("contact", phases.contact / wall),
        ("recover", phases.recover / wall),
        ("bracket", (wall - solved) / wall),
        ("unknowns", found.unknowns as f64),
        ("steps", found.iterations as f64),
        ("residual", found.equilibrium.residual()),
        ("lower", bracket.lower()),
    ];
    values.extend(named);
    Ok(seconds)
}

fn plain(problem: &Problem, values: &mut BTreeMap<&'static str, f64>) -> Result<f64, String> {
    let options = Options::default();
    let mut clock = None;
    let found = yardstick::plain_factorisation(problem, &[], &options, || clock = Some(Clock::start()));
    let seconds = clock.map_or(f64::NAN, |c| c.seconds());
    let found = found.map_err(|e| e.to_string())?;
    values.extend([("symbolic", found.symbolic), ("numeric", found.numeric), ("entries", found.entries as f64)]);
    Ok(seconds)
}

/// FEniCSx P2 on the same triangles, less what it needs to start and to compile.
fn displacements(problem: &Problem, values: &mut BTreeMap<&'static str, f64>) -> Result<(), String> {
    let options = primal::Options { degrees: vec![2], ..Default::default() };
    let found = primal::run(problem, &[], &options).map_err(|e| e.to_string())?;
    let solution = found.first().ok_or("no solution")?;
    let seconds = solution.seconds;
    values.extend([
        ("seconds", seconds.mesh + seconds.assemble + seconds.solve),
        ("steps", solution.iterations.unwrap_or(0) as f64),
        ("unknowns", solution.unknowns.unwrap_or(0) as f64),
    ]);
    Ok(())
}

/// Two blocks with lift-off.
fn problem(family: Family, n: usize) -> Problem {
    let mut problem = support::Blocks { n, ..Default::default() }.problem();
    if family == Family::Rough {
        let h = 1.0 / n as f64;
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for p in &mut problem.mesh.points {
            let inside = |x: f64| x > 0.5 * h && x < 1.0 - 0.5 * h;
            if inside(p[1]) && inside(p[0].fract()) {
                *p = [p[0] + 0.4 * h * random(), p[1] + 0.4 * h * random()];
            }
        }
    }
    problem
}
