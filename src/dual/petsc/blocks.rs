//! The matrices of the triangles in terms of the unknowns.
//!
//! Triangle t has the mode parameters s = Bᵀx + s̄ and leaves the traction jumps l − B s to its unknowns: B are its
//! traction coefficients in their components, s̄ what moments given by supports contribute, l minus the traction of the
//! particular field. Then K = Σ B Bᵀ, and the residual is the applied load plus the sum of these jumps.

use std::io::{self, Write};

use crate::dual::modes::ModeTable;
use crate::dual::system::initial::initial_parameters;
use crate::dual::system::rows::Sides;
use crate::dual::system::unknowns::Unknowns;
use crate::problem::Problem;

/// All triangles, one after the other. B itself is written to a file at once, congruent triangles sharing theirs.
#[derive(Debug, Default)]
pub struct Blocks {
    /// Where the unknowns of each triangle begin, and the end.
    pub start: Vec<i64>,
    /// Unknowns of each triangle.
    pub unknowns: Vec<i64>,
    /// l, in the order of `unknowns`.
    pub load: Vec<f64>,
    /// Where B of each triangle begins, mode by mode.
    pub matrix: Vec<i64>,
    /// s̄, triangle by triangle.
    pub given: Vec<f64>,
}

impl Blocks {
    /// Computes them; the numbers of all B go to `out`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(problem: &Problem, unknowns: &Unknowns, modes: &ModeTable, out: &mut impl Write) -> io::Result<Self> {
        let mut all = Blocks { start: vec![0], ..Blocks::default() };
        let mut of_class: Vec<Option<i64>> = vec![None; modes.classes()];
        let mut written = 0;
        let mut write = |numbers: &[f64]| {
            let start = written;
            written += numbers.len() as i64;
            super::exchange::write_numbers(out, numbers).map(|()| start)
        };
        let initial = initial_parameters(problem, modes);
        for t in 0..problem.mesh.triangles.len() {
            let first_given = all.given.len();
            let sides = Sides::new(&problem.mesh, unknowns, t, modes.degree(t));
            let own = modes.of(t);
            if let (true, Some(first)) = (sides.are_even(), sides.free(unknowns)) {
                all.push_free(&sides, first, own.particular_traction());
                all.given.extend(std::iter::repeat_n(0.0, own.parameters()));
                let kept = &mut of_class[modes.class_of(t)];
                let start = match *kept {
                    Some(start) => start,
                    None => *kept.insert(write(own.traction())?),
                };
                all.matrix.push(start);
                all.add_initial(first_given, &initial, modes, t);
                continue;
            }
            let mut raised = vec![0.0; sides.len() * (own.parameters() + 1)];
            let parts = std::iter::once(own.particular_traction()).chain(own.tractions());
            for (out, part) in raised.chunks_exact_mut(sides.len()).zip(parts) {
                sides.raise(part, out);
            }
            let matrix = all.push_turned(unknowns, &sides, &raised);
            all.matrix.push(write(&matrix)?);
            all.add_initial(first_given, &initial, modes, t);
        }
        Ok(all)
    }

    /// Counts initial strains among what is given.
    fn add_initial(&mut self, first: usize, initial: &[f64], modes: &ModeTable, t: usize) {
        if !initial.is_empty() {
            let own = &initial[modes.parameters_of(t)];
            self.given[first..].iter_mut().zip(own).for_each(|(given, initial)| *given += initial);
        }
    }

    /// A triangle whose sides are all free, with unknowns from `first` on: its coefficients are conjugate to them.
    fn push_free(&mut self, sides: &Sides, first: [usize; 3], particular: &[f64]) {
        let begin = self.unknowns.len();
        self.unknowns.resize(begin + sides.len(), 0);
        for (i, first) in first.into_iter().enumerate() {
            for (k, c) in (0..=sides.degrees[i]).flat_map(|k| [(k, 0), (k, 1)]) {
                self.unknowns[begin + sides.at(i, k) + c] = (first + 2 * k + c) as i64;
            }
        }
        self.load.extend(particular.iter().map(|t| -t));
        self.start.push(self.unknowns.len() as i64);
    }

    /// Any triangle; `raised` has the coefficients of the particular field and of every mode. Returns B, mode by mode.
    fn push_turned(&mut self, unknowns: &Unknowns, sides: &Sides, raised: &[f64]) -> Vec<f64> {
        let rows: Vec<_> = sides.rows(unknowns).collect();
        let all = || rows.iter().flat_map(|(at, both)| both.iter().map(move |component| (*at, component)));
        let mut own: Vec<usize> = all().flat_map(|(_, c)| c.terms().iter().map(|&(unknown, _)| unknown)).collect();
        own.sort_unstable();
        own.dedup();
        let mut matrix = Vec::with_capacity(raised.len());
        for (i, part) in raised.chunks_exact(sides.len()).enumerate() {
            let (mut row, mut given) = (vec![0.0; own.len()], 0.0);
            for (at, component) in all() {
                let value = component.direction[0] * part[at] + component.direction[1] * part[at + 1];
                given += component.fixed * value;
                for &(unknown, c) in component.terms() {
                    if let Ok(place) = own.binary_search(&unknown) {
                        row[place] += c * value;
                    }
                }
            }
            if i == 0 {
                self.load.extend(row.iter().map(|t| -t));
            } else {
                self.given.push(given);
                matrix.extend_from_slice(&row);
            }
        }
        self.unknowns.extend(own.iter().map(|&unknown| unknown as i64));
        self.start.push(self.unknowns.len() as i64);
        matrix
    }
}
