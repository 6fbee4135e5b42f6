//! A displacement field to be compared with the dual solution.

use std::collections::BTreeMap;

use super::balance::Balance;
use super::ceiling::{Extent, MISTAKE, PART};
use super::contact::slides;
use super::forces::turned;
use super::forces::turned::Rule;
use super::on_quadrilaterals::QuadrilateralSolution;
use super::solution::Numbering;
use crate::bounds::energy::initial_energy;
use crate::bounds::{
    Bracket, Cell, NoUpperBound, Potential, Repair, UpperBound, Violation, repaired, repaired_at_contact,
};
use crate::dual::DualSolution;
use crate::element::{Displacement, PlainDisplacement};
use crate::problem::Problem;

/// A displacement solution from some program, on the vertices and edges of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name in the report, for example `FEniCSx P2`.
    pub name: String,
    /// The program.
    pub solver: String,
    /// Its version.
    pub version: String,
    /// Polynomial degree; on quadrilaterals that in each coordinate, which is that along their sides.
    pub degree: usize,
    /// Value at each vertex.
    pub vertex: Vec<[f64; 2]>,
    /// Value at each edge midpoint.
    pub middle: Vec<[f64; 2]>,
    /// The full displacement for degree 3 or more, which these values do not determine, or on quadrilaterals.
    pub higher: Option<PlainDisplacement>,
    /// Quadrilaterals on which it is not a polynomial on each triangle; `higher` represents it there.
    pub cells: Vec<Cell>,
    /// The displacement on the quadrilaterals of the mesh file, which `higher` represents.
    pub on_quadrilaterals: Option<QuadrilateralSolution>,
    /// 𝓛(u_h) as the program reports it.
    pub reported: Option<f64>,
    /// ½a(u_h, u_h) as the program reports it.
    pub reported_strain: Option<f64>,
    /// True if it is meant to be the minimiser over its space, so that the identities of a solution hold.
    pub is_solution: bool,
    /// Contact reactions, interface by interface.
    pub reactions: Option<Vec<Reactions>>,
    /// Nonlinear iterations, if the program reports them.
    pub iterations: Option<usize>,
    /// Unknowns, if the program reports them.
    pub unknowns: Option<usize>,
    /// Seconds by phase.
    pub seconds: BTreeMap<String, f64>,
    /// Relative rounding error of its values: that of the digits of a file, or of the machine.
    pub precision: f64,
    /// Numbers of its nodes in the file that it comes from.
    pub numbering: Option<Numbering>,
}

impl Candidate {
    /// The displacement of a node: vertices, then edge midpoints.
    pub fn value(&self, node: usize) -> [f64; 2] {
        let vertices = self.vertex.len();
        if node < vertices { self.vertex[node] } else { self.middle[node - vertices] }
    }

    /// The nearest admissible field, and how far from admissible this one is.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other or the contact.
    pub fn nearest_admissible(&self, problem: &Problem) -> Result<(Displacement, Violation), NoUpperBound> {
        let repair = if self.is_solution { Repair::AtContact } else { Repair::OfLeastEnergy };
        match &self.higher {
            Some(plain) => repaired_at_contact(problem, plain),
            None => repaired(problem, &self.vertex, &self.middle, repair),
        }
    }

    /// The letter of its space: Q on quadrilaterals, P on triangles.
    pub fn letter(&self) -> char {
        if self.on_quadrilaterals.is_some() { 'Q' } else { 'P' }
    }

    /// True if it is itself piecewise polynomial on the triangles, as its maps and bounds assume.
    pub fn is_polynomial(&self) -> bool {
        self.on_quadrilaterals.as_ref().is_none_or(|own| own.field.is_polynomial())
    }

    /// The friction work ∫ τ̄ |j_t| as its model integrates it.
    fn friction_work(&self, problem: &Problem) -> f64 {
        let coefficients = self.higher.as_ref().filter(|_| self.degree > 2);
        let value = |node: usize| coefficients.map_or_else(|| self.value(node), |field| field.values()[node]);
        slides::work(problem, self.degree, value)
    }

    /// The largest component of all displacements.
    pub fn largest(&self) -> f64 {
        self.vertex.iter().chain(&self.middle).flatten().fold(0.0, |m, v| m.max(v.abs()))
    }
}

/// Variationally consistent contact reactions on one interface, thickness included.
#[derive(Debug, Clone, PartialEq)]
pub struct Reactions {
    /// Vertices of the first side.
    pub vertices: Vec<usize>,
    /// R ≥ 0 conjugate to the jump at each of them.
    pub vertex: Vec<f64>,
    /// R ≥ 0 conjugate to the inner Bernstein coefficients of each pair (degree k from 2 on): k − 1, or k where the direction
    /// of contact turns.
    pub edge: Option<Vec<Vec<f64>>>,
    /// Friction forces on the first side, if there is friction.
    pub friction: Option<FrictionForces>,
    /// Force on the first side.
    pub resultant: [f64; 2],
}

/// Variationally consistent forces of friction on the first side of an interface along t̂, thickness included.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionForces {
    /// At each of [`Reactions::vertices`].
    pub vertex: Vec<f64>,
    /// Conjugate to the inner Bernstein coefficients of the tangential jump of each pair.
    pub edge: Option<Vec<Vec<f64>>>,
}

/// A candidate after it was evaluated.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The candidate as delivered.
    pub candidate: Candidate,
    /// The field as delivered, or the polynomials on triangles that have its values.
    pub field: UpperBound,
    /// The energy of the field as delivered; for a solution with friction as its model integrates it.
    pub own: Potential,
    /// The violation of supports and contact by the field as delivered.
    pub violation: Violation,
    /// The nearest admissible field; its energy is the upper bound.
    pub admissible: UpperBound,
    /// Equilibrium in its own space, if it is meant to be a solution.
    pub balance: Option<Balance>,
    /// Ratio of the field to the largest size that a solution can have; 1 if it is not larger.
    pub larger: f64,
}

/// Solvers meet supports and contact to their own accuracy; a field this close to an admissible one counts as admissible.
pub const ADMISSIBLE: f64 = 1e-9;

impl Judged {
    /// Evaluates a candidate; `extent` limits the size of a solution.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other or the contact.
    pub fn new(
        problem: &Problem,
        dual: &DualSolution,
        candidate: Candidate,
        extent: Extent,
    ) -> Result<Self, NoUpperBound> {
        let (mended, violation) = candidate.nearest_admissible(problem)?;
        let field = match &candidate.higher {
            Some(plain) => plain.split(&problem.mesh),
            None => Displacement::from_p2(&problem.mesh, &candidate.vertex, &candidate.middle),
        };
        let cells = &candidate.cells;
        let (field, admissible) = if cells.is_empty() {
            (UpperBound::new(problem, dual, field), UpperBound::new(problem, dual, mended))
        } else {
            let admissible = UpperBound::of_mended_cells(problem, dual, cells, (&field, mended));
            (UpperBound::of_cells(problem, dual, cells, field), admissible)
        };
        let mut own = match &candidate.on_quadrilaterals {
            Some(own) if !own.field.is_polynomial() => own.forces(problem).1,
            // Integrals over a body of revolution are rational, and a model's those of its rule.
            _ if problem.section().is_revolved() && candidate.is_solution => {
                turned::forces(problem, &candidate, Rule::OWN).1
            }
            _ => field.potential,
        };
        if candidate.is_solution && problem.has_friction() {
            own.friction = candidate.friction_work(problem);
        }
        let balance = candidate
            .is_solution
            .then(|| Balance::new(problem, &candidate, field.potential.stored() + initial_energy(problem)));
        let larger = extent.larger(candidate.largest());
        Ok(Judged { admissible, balance: balance.transpose()?, larger, own, field, violation, candidate })
    }

    /// True if the field as delivered is admissible to the accuracy of a solver.
    pub fn is_admissible(&self) -> bool {
        self.violation.largest() <= ADMISSIBLE.min(PART * MISTAKE / self.larger)
    }

    /// Guaranteed relative energy-norm error of the stress of the admissible field.
    pub fn relative_error(&self, bracket: &Bracket) -> f64 {
        bracket.relative_error(self.admissible.upper())
    }
}
