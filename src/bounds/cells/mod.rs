//! Energies of fields on quadrilaterals: those of the field itself, whatever polynomial stands for it on triangles.
//!
//! A field v that is rational inside a quadrilateral has a polynomial v_p beside it on the triangles that make up the quadrilateral,
//! with the same values along its sides. For an equilibrated λ and w = v − v_p, which vanishes there, ∫ λ:e(w) = ∫ F·w, and so
//!
//! ½‖c e(v) − λ‖²_a − ½‖c e(v_p) − λ‖²_a = 𝓛(v) − 𝓛(v_p) on the quadrilateral:
//!
//! one difference of energies corrects the bound and the local terms of the gap. Admissibility is a matter of the sides, where
//! v is the polynomial. A change d that makes v_p admissible makes v so too; 𝓛(v + d) differs from 𝓛(v) as 𝓛(v_p + d) does from
//! 𝓛(v_p), but for a(w, d), which is at most (‖v‖ + ‖v_p‖)‖d‖ in the norm of the energy. Of v + d and v_p + d, both of which have the
//! same values along the sides, the one of lower energy is the bound.

mod enclosure;
mod turned;

use rayon::prelude::*;

use super::bracket::UpperBound;
use super::energy::{strain_of, strain_on, work_inside};
use super::rounding::ROUNDING_PER_TERM;
use super::rounding::counted::Counted;
use super::rounding::terms::UpperTerms;
use crate::dual::DualSolution;
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::{Displacement, Material, Quadrilateral, Section, contraction};
use crate::load::BodyForce;
use crate::problem::Problem;

pub use enclosure::{Enclosed, strain_energy, strain_energy_by};

/// Change of the energy of a quadrilateral, in parts of it, up to which a change of the field is round-off.
const SLIGHT: f64 = 1e-6;

/// A quadrilateral with the triangles of the mesh that make it up.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// The field on it.
    pub field: Quadrilateral,
    /// The triangles.
    pub triangles: Vec<usize>,
    /// Its nodes: vertices of the mesh, then middles of edges, as they are counted there; the centre is the edge between two of its
    /// triangles. Empty where contact has put vertices into its sides.
    pub nodes: Vec<usize>,
}

/// Energy of the field on a quadrilateral less that of the polynomials on its triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Correction {
    /// Strain energy and work, thickness included.
    strain: f64,
    work: f64,
    /// By how much the energy can be off: the error of the rule.
    error: f64,
    sensitivity: f64,
    /// ½a(v, v) and ½a(v_p, v_p).
    own: f64,
    polynomial: f64,
}

impl Correction {
    fn of(problem: &Problem, cell: &Cell, polynomial: &Displacement) -> Self {
        let mesh = &problem.mesh;
        let body = cell.triangles.first().map_or(0, |t| mesh.body[*t]);
        let data = &problem.scene.bodies[body];
        let thickness = problem.scene.thickness;
        let material = problem.material(body);
        let section = problem.section();
        let own = match section.axis() {
            None => strain_energy(&cell.field, &material),
            Some(axis) => turned::strain_energy(&cell.field, &material, axis),
        };
        let of_triangles: f64 = cell.triangles.iter().map(|t| strain_on(problem, polynomial, *t)[0]).sum();
        let [initial, size] = match section.axis() {
            _ if material.initial().is_none() => [0.0; 2],
            None => of_initial(&cell.field, &material),
            Some(axis) => turned::of_initial(&cell.field, &material, axis),
        };
        let homogeneous = match material.initial().is_none() {
            true => of_triangles,
            false => cell.triangles.iter().map(|t| strain_of(problem, polynomial, *t, *t)[0]).sum(),
        };
        let force = &data.body_force;
        let mut work = 0.0;
        if !force.is_none() {
            work += work_on(section, force, &cell.field);
            for &t in &cell.triangles {
                let own = match section.revolved() {
                    None => work_inside(force, mesh.corners(t), polynomial, t),
                    Some(revolved) => revolved.work_inside(force, mesh.corners(t), polynomial, t),
                };
                work -= own.iter().sum::<f64>();
            }
        }
        Correction {
            strain: thickness * (own.value + initial - of_triangles),
            work: thickness * work,
            error: thickness * own.error,
            sensitivity: thickness * (own.sensitivity + size),
            own: thickness * own.value,
            polynomial: thickness * homogeneous,
        }
    }

    fn total(&self) -> f64 {
        self.strain - self.work
    }
}

/// ½∫ cε0:ε0 − ∫ cε0:e(v) over a quadrilateral, and the same with the sizes of all terms: polynomials of degree 4 at most along ξ and η.
fn of_initial(cell: &Quadrilateral, material: &Material) -> [f64; 2] {
    let rule = segment_rule(7);
    let mut sum = [0.0; 2];
    for (s, v) in rule {
        for (t, w) in rule {
            let at = [2.0 * s - 1.0, 2.0 * t - 1.0];
            let (of_v, place) = (cell.at(at), cell.position(at));
            let (held, initial) = (material.held_back(place), material.initial().at(place));
            let own = 0.5 * of_v.determinant * contraction(held, initial);
            let size = held.iter().map(|s| s.abs()).sum::<f64>() * of_v.spread;
            sum[0] += 4.0 * v * w * (own - contraction(held, of_v.strain));
            sum[1] += 4.0 * v * w * (own.abs() + size);
        }
    }
    sum
}

/// ∫ f · v over a quadrilateral, with the weight of its section: a polynomial of degree 5 at most along ξ and η.
fn work_on(section: Section, force: &BodyForce, cell: &Quadrilateral) -> f64 {
    let rule = segment_rule(5);
    let [d0, d1, d2] = cell.determinant();
    let mut sum = 0.0;
    for (s, v) in rule {
        for (t, w) in rule {
            let at = [2.0 * s - 1.0, 2.0 * t - 1.0];
            let (u, weight) = (cell.value(at), section.weight(cell.point(at)));
            let f = section.force(force, cell.point(at));
            sum += 4.0 * v * w * weight * (d0 + d1 * at[0] + d2 * at[1]) * (f[0] * u[0] + f[1] * u[1]);
        }
    }
    sum
}

fn corrections(problem: &Problem, cells: &[Cell], polynomial: &Displacement) -> Vec<Correction> {
    cells.par_iter().with_min_len(64).map(|cell| Correction::of(problem, cell, polynomial)).collect()
}

impl UpperBound {
    /// Evaluates the field that is that of `cells` on quadrilaterals and `polynomial` elsewhere against λ_h.
    pub fn of_cells(problem: &Problem, dual: &DualSolution, cells: &[Cell], polynomial: Displacement) -> Self {
        let mut terms = UpperTerms::new(problem, &dual.stress, &polynomial, Counted::ALL);
        for (cell, correction) in cells.iter().zip(corrections(problem, cells, &polynomial)) {
            terms.correct(&cell.triangles, correction.strain, correction.work);
            terms.widen(&correction);
        }
        Self::of_terms(problem, polynomial, terms)
    }

    /// As [`Self::of_cells`], for an admissible field: `admissible` differs from `polynomial` where the latter misses supports or
    /// penetrates.
    pub fn of_mended_cells(
        problem: &Problem,
        dual: &DualSolution,
        cells: &[Cell],
        (polynomial, admissible): (&Displacement, Displacement),
    ) -> Self {
        let mut terms = UpperTerms::new(problem, &dual.stress, &admissible, Counted::ALL);
        for (cell, correction) in cells.iter().zip(corrections(problem, cells, polynomial)) {
            let change = cell.change(problem, polynomial, &admissible);
            let beside = 2.0 * (correction.own.sqrt() + correction.polynomial.sqrt()) * change.sqrt();
            // A change that is round-off leaves the field what it is.
            if beside <= SLIGHT * correction.own || correction.total() + correction.error + beside <= 0.0 {
                terms.correct(&cell.triangles, correction.strain, correction.work);
                terms.widen(&correction);
                terms.widening += beside;
            }
        }
        Self::of_terms(problem, admissible, terms)
    }
}

impl Cell {
    /// ½a(d, d) of the difference of two displacements, thickness included.
    fn change(&self, problem: &Problem, from: &Displacement, to: &Displacement) -> f64 {
        let mut sum = 0.0;
        for &t in &self.triangles {
            if from.block(t) == to.block(t) {
                continue;
            }
            if from.degree(t) != to.degree(t) {
                return f64::INFINITY;
            }
            let mut difference = Displacement::zeros([from.degree(t)]);
            let blocks = from.block(t).iter().zip(to.block(t));
            for (d, (u, v)) in difference.block_mut(0).iter_mut().zip(blocks) {
                *d = [v[0] - u[0], v[1] - u[1]];
            }
            sum += super::energy::strain_of(problem, &difference, 0, t)[0];
        }
        problem.scene.thickness * sum
    }
}

impl UpperTerms {
    /// Adds to the energy, and to the local terms of the gap on `triangles` in the ratio of what they are.
    fn correct(&mut self, triangles: &[usize], strain: f64, work: f64) {
        self.potential.strain += strain;
        self.potential.work += work;
        let now: f64 = triangles.iter().map(|t| self.triangles[*t]).sum();
        // Half a square: what is below zero is rounding.
        let corrected = (now + strain - work).max(0.0);
        for &t in triangles {
            let part = if now > 0.0 { self.triangles[t] / now } else { 1.0 / triangles.len() as f64 };
            self.triangles[t] = part * corrected;
        }
    }

    fn widen(&mut self, correction: &Correction) {
        self.widening += correction.error + ROUNDING_PER_TERM * correction.sensitivity;
        self.potential.sensitivity += correction.sensitivity;
    }
}
