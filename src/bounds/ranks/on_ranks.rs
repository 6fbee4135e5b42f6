//! The bracket of a solve over MPI ranks, each of which makes its part of it.
//!
//! This program divides the problem as the solve did and writes a file for each rank. The ranks start it again, each on its part
//! ([`make_part`]): they relax the displacement of the upper bound together, and each evaluates the energies of its triangles, edges and
//! contact pairs, and its terms of the gap. This program adds up what they find, with compensation. It draws their displacement
//! to what contact and supports allow as they do, and the gap in local terms shares no arithmetic with the energies
//! here either: a rank that had lost something would show there.

use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use super::pipe::Pipe;
use crate::bounds::Bracket;
use crate::bounds::upper::{Division, Found, Part};
use crate::dual::{Divided, DualError, DualSolution};
use crate::problem::Problem;
use crate::process::Scratch;

/// Computes both sides on the ranks that found `dual`.
///
/// # Errors
/// [`DualError`] where the ranks do not bring a bracket.
pub fn on_ranks(problem: &Problem, dual: &DualSolution, divided: &Divided) -> Result<Bracket, DualError> {
    let Ok(division) = Division::new(problem, &dual.moments, &divided.owner, divided.petsc.ranks) else {
        // There is no upper bound, and this process says why.
        return Ok(Bracket::new(problem, dual));
    };
    let found = found(&division, dual, divided)?;
    if found.iter().all(|found| *found == Found::default()) {
        return Ok(Bracket::new(problem, dual));
    }
    match division.bracket(&found) {
        Ok(Some((lower, upper))) => Ok(Bracket::of_terms(problem, dual, lower, Ok(upper))),
        Ok(None) => Err(DualError::Process {
            reason: "the ranks found no bracket".to_string(),
            log: "what they handed back has other lengths than belong there, or is not finite".to_string(),
        }),
        Err(_) => Ok(Bracket::new(problem, dual)),
    }
}

/// Runs the ranks on the parts of `division` and returns their results.
fn found(division: &Division<'_>, dual: &DualSolution, divided: &Divided) -> Result<Vec<Found>, DualError> {
    let ranks = divided.petsc.ranks;
    let scratch = Scratch::new().map_err(|source| DualError::Exchange { path: std::env::temp_dir(), source })?;
    let failed = |source: io::Error| DualError::Exchange { path: scratch.path().to_owned(), source };
    let folder = scratch.folder("bracket").map_err(failed)?;
    for rank in 0..ranks {
        let part = division.part(rank, &dual.stress, &dual.moments);
        write_part(&folder.join(format!("part-{rank}")), &part, ranks).map_err(failed)?;
    }
    divided.petsc.run_brackets(&folder)?;
    let found = |rank: usize| {
        let file = BufReader::with_capacity(1 << 20, File::open(folder.join(format!("found-{rank}")))?);
        Found::read(file)
    };
    (0..ranks).map(found).collect::<io::Result<_>>().map_err(failed)
}

fn write_part(path: &Path, part: &Part, ranks: usize) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 20, File::create(path)?);
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
    let mut word = [0; 8];
    file.read_exact(&mut word)?;
    let ranks = u64::from_le_bytes(word) as usize;
    let own = Part::read(file)?;
    fs::remove_file(part)?;
    let pipe = Pipe::new(BufReader::new(io::stdin()), BufWriter::new(io::stdout()), ranks, |error| {
        eprintln!("the rank of this part is gone: {error}");
        std::process::exit(3)
    });
    let made = own.bracket(None, &pipe).unwrap_or_default();
    let mut out = BufWriter::with_capacity(1 << 20, File::create(found)?);
    made.write(&mut out)?;
    out.flush()?;
    pipe.done();
    Ok(())
}
