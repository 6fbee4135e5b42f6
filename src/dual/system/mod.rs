//! The hybrid form: element matrices and the sparse system they add up to.
//!
//! Eliminating the stresses element by element from the saddle-point problem leaves
//!
//! min ½ mᵀKm − fᵀm over moments m with jumps at most ∫ g B_k, K = Σ T Tᵀ, f = ∫P·(…) − T̄,
//!
//! whose minimum, less ½ Σ ∫ a λ̄:λ̄, equals −Π(λ_h).

pub(super) mod beds;
pub(super) mod dissection;
pub(super) mod initial;
pub(super) mod pattern;
pub(super) mod reduced;
pub(super) mod rows;
pub(super) mod unknowns;

use std::sync::Arc;
use std::time::Instant;

use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMatRef};
use rayon::prelude::*;

use super::factor::SymbolicFactor;
use super::hybrid::structure;
use super::modes::ModeTable;
use super::{DualError, Options};
use crate::element::polynomial::side;
use crate::lanes::wide;
use crate::problem::{ContactPair, Problem};
use beds::Springs;
use initial::initial_parameters;
use pattern::Pattern;
use rows::Sides;
use unknowns::{Component, UnknownBlock, Unknowns};

/// The assembled problem. Copies share what does not depend on the loads.
#[derive(Debug, Clone)]
pub struct System {
    /// Numbering.
    pub unknowns: Arc<Unknowns>,
    /// Element matrices.
    pub modes: Arc<ModeTable>,
    /// Springs and elastic layers.
    pub springs: Arc<Springs>,
    /// Lower triangle of K.
    pub matrix: Arc<SparseColMat<usize, f64>>,
    /// f, given moments included.
    pub rhs: Vec<f64>,
    /// The part of f that comes from applied tractions.
    pub external: Vec<f64>,
    /// Upper bound ∫ g B_k of each jump along n̂.
    pub jump_bound: Vec<f64>,
    /// The coefficient of the friction bound of each jump along t̂.
    pub slide_bound: Vec<f64>,
    /// −∫ τ_k:ε0 of each mode; empty where no body has an initial strain.
    pub initial: Arc<[f64]>,
}

/// A system with the structure of its factor.
pub struct Structured {
    /// The assembled problem.
    pub system: System,
    /// The structure, where there is memory for its values.
    pub structure: Result<SymbolicFactor, DualError>,
    /// Seconds that it took.
    pub seconds_of_structure: f64,
}

impl System {
    /// Numbers the unknowns of `problem` and assembles K and f.
    pub fn new(problem: &Problem, options: &Options) -> Self {
        Self::new_beside(problem, options, |_, _| ()).0
    }

    /// Builds the system, and on another thread the structure of the factor of K with its jumps last.
    pub fn structured(problem: &Problem, options: &Options) -> Structured {
        let (system, (structure, seconds_of_structure)) = Self::new_beside(problem, options, |unknowns, pattern| {
            let start = Instant::now();
            let structure = structure(problem, unknowns, pattern, options);
            (structure, start.elapsed().as_secs_f64())
        });
        Structured { system, structure, seconds_of_structure }
    }

    /// Assembles, and does what needs no more than the pattern of K beside it.
    fn new_beside<T: Send>(
        problem: &Problem,
        options: &Options,
        beside: impl FnOnce(&Unknowns, SymbolicSparseColMatRef<'_, usize>) -> T + Send,
    ) -> (Self, T) {
        let modes = ModeTable::new(problem, options.elements.clone());
        let unknowns = Unknowns::new(problem, modes.elements());
        let pattern = Pattern::new(problem, &unknowns);
        let initial: Arc<[f64]> = initial_parameters(problem, &modes).into();
        let entries = || entries(problem, &unknowns, &modes, &initial, &pattern);
        let springs = Springs::new(problem, &unknowns);
        let ((mut values, mut rhs), done) = rayon::join(entries, || beside(&unknowns, pattern.symbolic.as_ref()));
        springs.assemble(&pattern, &mut values);
        let external = load_of_tractions(problem, &unknowns, problem.tractions());
        rhs.iter_mut().zip(&external).for_each(|(r, e)| *r += e);
        let jump_bound = jump_bounds(problem, &unknowns);
        let slide_bound = slide_bounds(problem, &unknowns);
        let matrix = Arc::new(SparseColMat::new(pattern.symbolic, values));
        let (unknowns, modes, springs) = (Arc::new(unknowns), Arc::new(modes), Arc::new(springs));
        (System { unknowns, modes, springs, matrix, rhs, external, jump_bound, slide_bound, initial }, done)
    }

    /// Number of parameters of triangles and springs.
    pub fn parameters(&self) -> usize {
        self.modes.parameters() + self.springs.parameters()
    }

    /// The size of the terms of K x: the largest entry of the diagonal times that of x, all of it or a part.
    pub fn size_of_terms(&self, x: &[f64]) -> f64 {
        let columns = self.matrix.symbolic().col_ptr();
        let diagonal = columns[..self.unknowns.count].iter().fold(0.0_f64, |m, &k| m.max(self.matrix.val()[k]));
        diagonal * x.iter().fold(0.0_f64, |m, v| m.max(v.abs()))
    }

    /// y = K x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        symmetric_multiply((*self.matrix).as_ref(), x)
    }
}

/// The entries of K in its pattern, and the part of f that is not from tractions.
fn entries(
    problem: &Problem,
    unknowns: &Unknowns,
    modes: &ModeTable,
    initial: &[f64],
    pattern: &Pattern,
) -> (Vec<f64>, Vec<f64>) {
    let mesh = &problem.mesh;
    let mut values = vec![0.0; pattern.symbolic.row_idx().len()];
    let mut rhs = vec![0.0; unknowns.count];
    // Element contributions are computed in parallel in chunks and added in order: the sum does not depend on
    // the number of threads.
    const CHUNK: usize = 1024;
    let count = mesh.triangles.len();
    let sides = |t: usize| Sides::new(mesh, unknowns, t, modes.degree(t));
    let mut memory = Vec::new();
    for start in (0..count).step_by(CHUNK) {
        let chunk: Vec<Sides> = (start..(start + CHUNK).min(count)).map(sides).collect();
        let room = chunk.iter().map(|sides| sides.len() * (sides.len() + 1)).max().unwrap_or(0);
        memory.resize(chunk.len() * room, 0.0);
        let locals = memory.par_chunks_exact_mut(room).zip(&chunk).zip(start..start + chunk.len());
        locals.with_min_len(64).for_each(|((out, sides), t)| local(unknowns, modes, initial, sides, t, out));
        for ((local, sides), t) in memory.chunks_exact(room).zip(&chunk).zip(start..) {
            let (load, rest) = local.split_at(sides.len());
            let stiffness = &rest[..sides.len() * sides.len()];
            match sides.free(unknowns) {
                Some(first) => pattern.add_blocks(sides, first, stiffness, load, &mut values, &mut rhs),
                None => {
                    let terms = terms(unknowns, sides);
                    pattern.add_terms(&terms, stiffness, load, &mut values, &mut rhs);
                }
            }
            debug_assert_eq!(mesh.triangle_edges[t], sides.edges);
        }
    }
    (values, rhs)
}

/// ∫ g B_k of each jump along n̂.
pub fn jump_bounds(problem: &Problem, unknowns: &Unknowns) -> Vec<f64> {
    let gaps: Vec<Vec<f64>> = problem.pairs().map(ContactPair::gap_polynomial).collect();
    let mut bounds = jump_moments(problem, unknowns, gaps.iter().map(Vec::as_slice));
    // A coefficient of the pressure on the axis of revolution has no weight, and its jump no bound.
    for (pair, jumps) in problem.pairs().zip(unknowns.jump_blocks()) {
        let on_axis = pair.first.map(|v| problem.section().on_axis(problem.mesh.points[v]));
        for (end, at) in [jumps.start, jumps.start + jumps.len - 1].into_iter().enumerate() {
            if on_axis[end] {
                bounds[at - unknowns.first_jump] = f64::INFINITY;
            }
        }
    }
    bounds
}

/// ∫ f B_k of each jump along n̂, f by its Bernstein coefficients on every pair: none where it vanishes.
pub fn jump_moments<'a>(problem: &Problem, unknowns: &Unknowns, f: impl Iterator<Item = &'a [f64]>) -> Vec<f64> {
    let of_pair = |((pair, jumps), f): ((&ContactPair, &UnknownBlock), &[f64])| {
        let length = pair.length;
        let moments = side::moments(if f.is_empty() { &[0.0] } else { f }, jumps.len - 1);
        moments.into_iter().map(move |moment| length * moment)
    };
    problem.pairs().zip(unknowns.jump_blocks()).zip(f).flat_map(of_pair).collect()
}

/// The coefficient of the friction bound of each jump along t̂.
fn slide_bounds(problem: &Problem, unknowns: &Unknowns) -> Vec<f64> {
    let with_friction = problem.pairs().filter_map(|pair| pair.friction);
    with_friction
        .zip(unknowns.slide_blocks())
        .flat_map(|(friction, slides)| friction.coefficients(slides.len - 1))
        .collect()
}

/// Takes the given unknowns out of a symmetric matrix: their rows and columns become those of a diagonal matrix.
pub fn isolate(matrix: &mut SparseColMat<usize, f64>, given: impl Fn(usize) -> bool) {
    let (symbolic, values) = matrix.parts_mut();
    let (columns, rows) = (symbolic.col_ptr(), symbolic.row_idx());
    for j in 0..columns.len() - 1 {
        let own = given(j);
        for k in columns[j]..columns[j + 1] {
            if rows[k] != j && (own || given(rows[k])) {
                values[k] = 0.0;
            }
        }
    }
}

/// The coefficients, on every unknown, of tractions given by their values at the ends of edges.
pub fn load_of_tractions(
    problem: &Problem,
    unknowns: &Unknowns,
    tractions: impl Iterator<Item = (usize, [[f64; 2]; 2])>,
) -> Vec<f64> {
    let mut load = vec![0.0; unknowns.count];
    for (e, ends) in tractions {
        for (k, value) in applied(problem, e, ends, unknowns.degree(e)).into_iter().enumerate() {
            for component in unknowns.components(e, k) {
                for &(dof, c) in component.terms() {
                    load[dof] += c * (component.direction[0] * value[0] + component.direction[1] * value[1]);
                }
            }
        }
    }
    load
}

/// The coefficients of degree `degree` of the weighted traction with these values at the ends of edge `e`. One of a higher degree is
/// represented by the nearest, and what is left of it is left of equilibrium.
pub fn applied(problem: &Problem, e: usize, ends: [[f64; 2]; 2], degree: usize) -> Vec<[f64; 2]> {
    let own = problem.weighted(e, ends);
    let along = |c: usize| -> Vec<f64> {
        match own[..] {
            [a, b] => side::linear([a[c], b[c]], degree).collect(),
            _ => {
                let values = side::component(&own, c);
                if values.len() <= degree + 1 {
                    side::elevate(&values, degree)
                } else {
                    side::from_moments(&side::moments(&values, degree))
                }
            }
        }
    };
    along(0).into_iter().zip(along(1)).map(|(x, y)| [x, y]).collect()
}

/// Adds tractions along any edges, by their Bernstein coefficients in the degree of the edge, whatever the edge is between.
pub fn add_edge_loads(unknowns: &Unknowns, loads: &[(usize, Vec<[f64; 2]>)], load: &mut [f64]) {
    for (e, coefficients) in loads {
        for (k, [x, y]) in coefficients.iter().enumerate() {
            for component in unknowns.components(*e, k) {
                for &(dof, c) in component.terms() {
                    load[dof] += c * (component.direction[0] * x + component.direction[1] * y);
                }
            }
        }
    }
}

/// y = A x for a symmetric matrix given by its lower triangle.
pub fn symmetric_multiply(a: SparseColMatRef<'_, usize, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    let (columns, rows, values) = (a.col_ptr(), a.row_idx(), a.val());
    for j in 0..x.len() {
        let mut sum = 0.0;
        for k in columns[j]..columns[j + 1] {
            let (i, v) = (rows[k], values[k]);
            sum += v * x[i];
            if i != j {
                y[i] += v * x[j];
            }
        }
        y[j] += sum;
    }
    y
}

/// Minus the load of the particular field, of given moments and of initial strains, then T Tᵀ row by row, in the components of the numbering.
fn local(unknowns: &Unknowns, modes: &ModeTable, initial: &[f64], sides: &Sides, t: usize, out: &mut [f64]) {
    let element = modes.of(t);
    let m = sides.len();
    let (load, rest) = out.split_at_mut(m);
    let stiffness = &mut rest[..m * m];
    let mut raised = Vec::new();
    let mut turned = Vec::new();
    let mut tractions = element.traction();
    sides.raise(element.particular_traction(), load);
    load.iter_mut().for_each(|l| *l = -*l);
    if !sides.are_even() {
        raised.resize(m * element.parameters(), 0.0);
        for (out, mode) in raised.chunks_exact_mut(m).zip(element.tractions()) {
            sides.raise(mode, out);
        }
        tractions = &raised;
    }
    if !initial.is_empty() {
        for (mode, s) in tractions.chunks_exact(m).zip(&initial[modes.parameters_of(t)]) {
            load.iter_mut().zip(mode).for_each(|(l, t)| *l -= s * t);
        }
    }
    if sides.free(unknowns).is_none() {
        turned.extend_from_slice(tractions);
        let mut fixed = vec![0.0; element.parameters()];
        for (at, components) in sides.rows(unknowns) {
            let directions = [components[0].direction, components[1].direction];
            let turn = |[x, y]: [f64; 2]| directions.map(|d| d[0] * x + d[1] * y);
            for (mode, fixed) in turned.chunks_exact_mut(m).zip(&mut fixed) {
                let own = turn([mode[at], mode[at + 1]]);
                mode[at..at + 2].copy_from_slice(&own);
                *fixed += components[0].fixed * own[0] + components[1].fixed * own[1];
            }
            let own = turn([load[at], load[at + 1]]);
            load[at..at + 2].copy_from_slice(&own);
        }
        for (mode, fixed) in turned.chunks_exact(m).zip(fixed) {
            load.iter_mut().zip(mode).for_each(|(l, t)| *l -= fixed * t);
        }
        tractions = &turned;
    }
    gram(tractions, m, stiffness);
    resist_on_axis(m, stiffness);
}

/// Coefficients that have no traction in any mode, as those on an axis of revolution, stand for displacements that nothing resists: a
/// spring of any stiffness keeps them at zero.
fn resist_on_axis(m: usize, stiffness: &mut [f64]) {
    if (0..m).any(|i| stiffness[i * m + i] == 0.0) {
        let largest = (0..m).fold(0.0_f64, |largest, i| largest.max(stiffness[i * m + i]));
        (0..m).filter(|i| stiffness[i * m + i] == 0.0).collect::<Vec<_>>().into_iter().for_each(|i| {
            stiffness[i * m + i] = largest;
        });
    }
}

wide! {
    /// Σ t tᵀ over rows t of length m.
    fn gram(tractions: &[f64], m: usize, out: &mut [f64]) {
        match m {
            12 => gram_of::<12>(tractions, out),
            18 => gram_of::<18>(tractions, out),
            24 => gram_of::<24>(tractions, out),
            30 => gram_of::<30>(tractions, out),
            _ => {
                out.fill(0.0);
                for mode in tractions.chunks_exact(m) {
                    for (row, a) in out.chunks_exact_mut(m).zip(mode) {
                        row.iter_mut().zip(mode).for_each(|(k, b)| *k += a * b);
                    }
                }
            }
        }
    }
}

/// [`gram`] for a length that the compiler knows.
#[inline(always)]
fn gram_of<const M: usize>(tractions: &[f64], out: &mut [f64]) {
    let (rows, _) = out.as_chunks_mut::<M>();
    rows.iter_mut().for_each(|row| *row = [0.0; M]);
    for mode in tractions.as_chunks::<M>().0 {
        for (row, a) in rows.iter_mut().zip(mode) {
            row.iter_mut().zip(mode).for_each(|(k, b)| *k += a * b);
        }
    }
}

/// The components of all coefficients of a triangle, each at its place.
fn terms(unknowns: &Unknowns, sides: &Sides) -> Vec<Component> {
    let mut terms: Vec<Option<Component>> = vec![None; sides.len()];
    for (at, [along, across]) in sides.rows(unknowns) {
        terms[at] = Some(along);
        terms[at + 1] = Some(across);
    }
    terms.into_iter().flatten().collect()
}
