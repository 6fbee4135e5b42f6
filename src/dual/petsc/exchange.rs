//! The files that pass between this program and the ranks, as docs/exchange.md describes them.
//!
//! Arrays are files of their own, little-endian numbers of eight bytes and nothing else, so that a rank reads the parts that
//! it needs.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::LinearSolver;
use super::blocks::Blocks;
use super::nodal::Nodal;
use crate::dual::contact::ends;
use crate::dual::equilibrium::LEAST_STRESS;
use crate::dual::hybrid::{Motion, held_unknowns};
use crate::dual::modes::ModeTable;
use crate::dual::system::unknowns::Unknowns;
use crate::dual::system::{jump_bounds, load_of_tractions};
use crate::problem::{ContactPair, Problem, Scales};

/// Name of the file that the package is started with.
pub const PROBLEM_FILE: &str = "problem.json";
const FORMAT: &str = "hypercircle-dual";
const VERSION: u32 = 1;

/// Sizes and choices.
#[derive(Debug, Serialize)]
struct Header {
    format: &'static str,
    version: u32,
    triangles: usize,
    unknowns: usize,
    first_jump: usize,
    parameters: usize,
    /// Unknowns held at zero: the bodies are free to move there.
    held: Vec<usize>,
    /// The largest applied traction, or the least stress that counts where there is none.
    load: f64,
    ranks: usize,
    linear_solver: LinearSolver,
}

/// The report of the ranks.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Answer {
    format: String,
    version: u32,
    /// Ranks that worked.
    pub ranks: usize,
    /// Contact states that were tried.
    pub steps: usize,
    /// Iterations of the linear solver, all solves together; 0 for a factorisation.
    pub iterations: usize,
    /// Those of the first solve.
    pub first_iterations: usize,
    /// Release of PETSc.
    pub petsc: String,
    /// Seconds by phase.
    pub seconds: AnswerSeconds,
    /// Largest resident memory of each rank, in bytes.
    pub memory: Vec<u64>,
}

/// Seconds of the slowest rank.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct AnswerSeconds {
    /// Reading, distribution and assembly.
    pub assemble: f64,
    /// Factorisation, or set-up of the preconditioner.
    pub factor: f64,
    /// Contact state.
    pub contact: f64,
    /// Refinement on the stresses.
    pub refine: f64,
}

/// The report and the fields that come back from the ranks.
#[derive(Debug)]
pub struct Solution {
    /// The report.
    pub answer: Answer,
    /// Mode parameters, triangle by triangle.
    pub parameters: Vec<f64>,
    /// Values of the unknowns.
    pub unknowns: Vec<f64>,
    /// Closed jumps.
    pub closed: Vec<bool>,
    /// The rank of each triangle, where it was asked for.
    pub owner: Option<Vec<usize>>,
}

/// Writes the problem into `folder`; `guess` holds the jumps that may be closed, and is left out where it belongs to others.
///
/// # Errors
/// The folder cannot be written to.
pub fn write(
    folder: &Path,
    problem: &Problem,
    unknowns: &Unknowns,
    modes: &ModeTable,
    motions: &[Motion],
    guess: Option<&[bool]>,
    (ranks, linear_solver): (usize, LinearSolver),
) -> io::Result<()> {
    let blocks = with_file(folder, "matrices.f64", |out| Blocks::new(problem, unknowns, modes, out))?;
    let numbers = |name: &str, values: &[f64]| with_file(folder, name, |out| write_numbers(out, values));
    let indices = |name: &str, values: &[i64]| {
        with_file(folder, name, |out| values.iter().try_for_each(|v| out.write_all(&v.to_le_bytes())))
    };
    indices("start.i64", &blocks.start)?;
    indices("unknowns.i64", &blocks.unknowns)?;
    indices("matrix.i64", &blocks.matrix)?;
    numbers("load.f64", &blocks.load)?;
    numbers("given.f64", &blocks.given)?;
    drop(blocks);
    let triangles = problem.mesh.triangles.len();
    let ends = (0..triangles).map(|t| modes.parameters_of(t).end as i64);
    indices("parameter.i64", &std::iter::once(0).chain(ends).collect::<Vec<_>>())?;
    let (first, beside) = neighbours(problem);
    indices("beside_start.i64", &first)?;
    indices("beside.i64", &beside)?;
    let begins = unknowns.blocks.iter().map(|block| block.start as i64).chain([unknowns.count as i64]);
    indices("blocks.i64", &begins.collect::<Vec<_>>())?;
    numbers("external.f64", &load_of_tractions(problem, unknowns, problem.tractions()))?;
    let bounds = jump_bounds(problem, unknowns);
    numbers("bound.f64", &bounds)?;
    let guess = guess.filter(|guess| guess.len() == bounds.len());
    let closed: Vec<u8> = guess.map_or(vec![1; bounds.len()], |guess| guess.iter().map(|&c| c.into()).collect());
    fs::write(folder.join("guess.u8"), closed)?;
    let scales = Scales::new(problem);
    numbers("round_off.f64", &ends::round_off(problem, unknowns, modes, &scales))?;
    let pairs = unknowns.jump_blocks().enumerate();
    indices("pair.i64", &pairs.flat_map(|(i, b)| std::iter::repeat_n(i as i64, b.len)).collect::<Vec<_>>())?;
    if linear_solver == LinearSolver::Bddc {
        indices("pair_triangles.i64", sides_of_pairs(problem).as_flattened())?;
    }
    if linear_solver.iterates() {
        let nodal = Nodal::new(problem, unknowns);
        indices("nodal_start.i64", &nodal.start)?;
        indices("nodal.i64", &nodal.component)?;
        numbers("nodal.f64", &nodal.weight)?;
        numbers("points.f64", problem.mesh.points.as_flattened())?;
    }
    let header = Header {
        format: FORMAT,
        version: VERSION,
        triangles,
        unknowns: unknowns.count,
        first_jump: unknowns.first_jump,
        parameters: modes.parameters(),
        held: held_unknowns(problem, unknowns, motions),
        load: if scales.traction > 0.0 { scales.traction } else { LEAST_STRESS * scales.data.stress },
        ranks,
        linear_solver,
    };
    fs::write(folder.join(PROBLEM_FILE), serde_json::to_vec(&header)?)
}

/// Reads what the ranks found; `jumps` is their number.
///
/// # Errors
/// A file is missing, has another length, or holds something else than finite numbers.
pub fn read(folder: &Path, unknowns: usize, jumps: usize, parameters: usize) -> io::Result<Solution> {
    let answer: Answer = serde_json::from_slice(&fs::read(folder.join("answer.json"))?)?;
    if (answer.format.as_str(), answer.version) != (FORMAT, VERSION) {
        return Err(io::Error::other(format!("answer.json is {} {}", answer.format, answer.version)));
    }
    let closed = fs::read(folder.join("closed.u8"))?;
    if closed.len() != jumps {
        return Err(io::Error::other(format!("closed.u8 has {} entries where {jumps} belong", closed.len())));
    }
    Ok(Solution {
        answer,
        parameters: read_numbers(folder, "parameters.f64", parameters)?,
        unknowns: read_numbers(folder, "moments.f64", unknowns)?,
        closed: closed.into_iter().map(|c| c != 0).collect(),
        owner: None,
    })
}

/// Reads which of so many ranks each triangle was on.
///
/// # Errors
/// A file is missing, has another length, or names a rank that is none.
pub fn read_owner(folder: &Path, triangles: usize, ranks: usize) -> io::Result<Vec<usize>> {
    let bytes = fs::read(folder.join("owner.i64"))?;
    let owner = bytes.as_chunks::<8>().0.iter().map(|b| i64::from_le_bytes(*b));
    let owner: Vec<usize> = owner.filter_map(|rank| usize::try_from(rank).ok().filter(|rank| *rank < ranks)).collect();
    if bytes.len() != 8 * triangles || owner.len() != triangles {
        return Err(io::Error::other(format!("owner.i64 does not name a rank for each of {triangles} triangles")));
    }
    Ok(owner)
}

fn read_numbers(folder: &Path, name: &str, count: usize) -> io::Result<Vec<f64>> {
    let bytes = fs::read(folder.join(name))?;
    if bytes.len() != 8 * count {
        return Err(io::Error::other(format!("{name} has {} bytes where {} belong", bytes.len(), 8 * count)));
    }
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    match numbers.iter().position(|v| !v.is_finite()) {
        Some(place) => Err(io::Error::other(format!("entry {place} of {name} is not a finite number"))),
        None => Ok(numbers),
    }
}

/// Appends numbers to a file of them.
pub fn write_numbers(out: &mut impl Write, values: &[f64]) -> io::Result<()> {
    values.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))
}

fn with_file<T>(folder: &Path, name: &str, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>) -> io::Result<T> {
    let mut out = BufWriter::with_capacity(1 << 20, File::create(folder.join(name))?);
    let made = fill(&mut out)?;
    out.flush()?;
    Ok(made)
}

/// The triangles on the two sides of the contact pairs of two bodies.
fn sides_of_pairs(problem: &Problem) -> Vec<[i64; 2]> {
    let triangle = |e: usize| problem.mesh.edges[e].triangles[0].map(|t| t as i64);
    let sides = |pair: &ContactPair| Some([triangle(pair.edges[0]?)?, triangle(pair.edges[1]?)?]);
    problem.pairs().filter_map(sides).collect()
}

/// The triangles beside each triangle, across edges and across contact.
fn neighbours(problem: &Problem) -> (Vec<i64>, Vec<i64>) {
    let mesh = &problem.mesh;
    let mut opposite: Vec<Option<usize>> = vec![None; mesh.edges.len()];
    for pair in problem.pairs() {
        if let [Some(a), Some(b)] = pair.edges {
            (opposite[a], opposite[b]) = (mesh.edges[b].triangles[0], mesh.edges[a].triangles[0]);
        }
    }
    let (mut first, mut beside) = (vec![0], Vec::with_capacity(3 * mesh.triangles.len()));
    for (t, edges) in mesh.triangle_edges.iter().enumerate() {
        for &e in edges {
            let across = mesh.edges[e].triangles.into_iter().flatten().find(|&other| other != t);
            beside.extend(across.or(opposite[e]).filter(|&other| other != t).map(|other| other as i64));
        }
        first.push(beside.len() as i64);
    }
    (first, beside)
}
