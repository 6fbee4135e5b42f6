//! The bracket of a solve over MPI ranks, of which each makes its part of the upper bound.
//!
//! This program divides the problem as the solve did and writes a file for each rank. The ranks start it again, each on its part
//! ([`make_part`]), and it gathers what they find. No guarantee rests on them: what they hand back are values at nodes and
//! inside triangles, of which any are an admissible displacement once contact and supports have drawn them in, and its energy is
//! evaluated here as that of any other.

use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use super::pipe::Pipe;
use super::upper::{Division, Found, Part};
use super::{Bracket, NoUpperBound, Prepared, admissible};
use crate::dual::{Divided, DualError, DualSolution};
use crate::element::Displacement;
use crate::problem::Problem;
use crate::process::Scratch;

/// Computes both sides, the upper one on the ranks that found `dual`.
///
/// # Errors
/// [`DualError`] where the ranks do not bring a displacement.
pub fn on_ranks(problem: &Problem, dual: &DualSolution, divided: &Divided) -> Result<Bracket, DualError> {
    let made = |floor| {
        let made = match Division::new(problem, &dual.moments, &divided.owner, divided.petsc.ranks) {
            Ok(division) => displacement(problem, &division, dual, divided, floor)?,
            Err(error) => Err(error),
        };
        Ok(made.map(|v| (v, Prepared::default())))
    };
    Bracket::with(problem, dual, made)
}

/// What the ranks make of the parts of `division`.
fn displacement(
    problem: &Problem,
    division: &Division<'_>,
    dual: &DualSolution,
    divided: &Divided,
    floor: f64,
) -> Result<Result<Displacement, NoUpperBound>, DualError> {
    let ranks = divided.petsc.ranks;
    let scratch = Scratch::new().map_err(|source| DualError::Exchange { path: std::env::temp_dir(), source })?;
    let failed = |source: io::Error| DualError::Exchange { path: scratch.path().to_owned(), source };
    let folder = scratch.folder("bracket").map_err(failed)?;
    for rank in 0..ranks {
        let part = division.part(rank, &dual.stress, &dual.moments);
        write_part(&folder.join(format!("part-{rank}")), &part, floor, ranks).map_err(failed)?;
    }
    divided.petsc.run_brackets(&folder)?;
    let found = |rank: usize| {
        let file = BufReader::with_capacity(1 << 20, File::open(folder.join(format!("found-{rank}")))?);
        Found::read(file)
    };
    let found: Vec<Found> = (0..ranks).map(found).collect::<io::Result<_>>().map_err(failed)?;
    if found.iter().all(|found| *found == Found::default()) {
        // They found none, and leave it to this process to say why.
        return Ok(admissible(problem, dual, floor, None));
    }
    let made = division.displacement(&found).transpose();
    made.ok_or_else(|| DualError::Process {
        reason: "the ranks found no displacement".to_string(),
        log: "what they handed back has other lengths than belong there, or is not finite".to_string(),
    })
}

fn write_part(path: &Path, part: &Part, floor: f64, ranks: usize) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 20, File::create(path)?);
    out.write_all(&floor.to_le_bytes())?;
    out.write_all(&(ranks as u64).to_le_bytes())?;
    part.write(&mut out)?;
    out.flush()
}

/// Makes the part in the file `part`, and writes the result to the file `found`; other ranks are asked through standard input and
/// output. Without an upper bound the file holds no values.
///
/// # Errors
/// The files cannot be used.
pub fn make_part(part: &Path, found: &Path) -> io::Result<()> {
    let mut file = BufReader::with_capacity(1 << 20, File::open(part)?);
    let mut word = || {
        let mut word = [0; 8];
        file.read_exact(&mut word).map(|()| word)
    };
    let (floor, ranks) = (f64::from_le_bytes(word()?), u64::from_le_bytes(word()?) as usize);
    let own = Part::read(file)?;
    fs::remove_file(part)?;
    let pipe = Pipe::new(BufReader::new(io::stdin()), BufWriter::new(io::stdout()), ranks, |error| {
        eprintln!("the rank of this part is gone: {error}");
        std::process::exit(3)
    });
    let made = own.displacement(floor, &pipe).unwrap_or_default();
    let mut out = BufWriter::with_capacity(1 << 20, File::create(found)?);
    made.write(&mut out)?;
    out.flush()?;
    pipe.done();
    Ok(())
}
