//! Checks that a field is the discrete solution of a displacement method on this mesh, as it claims.
//!
//! Its stresses then balance the loads on every basis function of its space, node by node, together with forces of the
//! supports and forces along the contacts, whatever solver the other program used. The *residual* is the remainder of the nodal
//! forces after supports and contacts, pushing or pulling, open or closed, have taken their parts; the contact forces are then
//! checked for complementarity separately. A method may bound the jump at its nodes or in its Bernstein
//! coefficients, which differ at the end of contact: either of the two is accepted.

mod apart;
mod checks;
mod digits;
mod nonmatching;
mod places;
mod rubbing;
mod sites;
mod weak;

pub use nonmatching::Nonmatching;
pub use places::{place, written_place};
pub use rubbing::{Ask, Rubbed};
pub use sites::{Site, Sites, Span};
pub use weak::{Law, Shape, Station, Weak};

use super::balance::Balance;
use super::candidate::Candidate;
use super::forces::NodalForces;
use super::forces::cells;
use super::forces::turned;
use super::forces::turned::{Kind, Rule};
use crate::bounds::{Hold, Holds, NoUpperBound, Nodes, holds};
use crate::element::Material;
use crate::problem::Problem;

/// Residual that a solver may leave in its equations, relative to the forces they balance.
pub const SOLVER: f64 = 1e-6;

/// Numbers of the nodes and triangles of a mesh in the file that a field comes from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Numbering {
    /// For vertices, then edge midpoints: the number of the point, from zero.
    pub nodes: Vec<Option<usize>>,
    /// For triangles: the number of the triangle, from zero.
    pub triangles: Vec<Option<usize>>,
    /// If a field comes in several files: the name of each, and its first point and triangle.
    pub files: Vec<(String, [usize; 2])>,
    /// True if the file has the triangles of [`Problem::uncut`], from before contact cut some of them.
    pub uncut: bool,
    /// How far points of the file are from the vertices that they are, where that is more than round-off; else zero.
    pub off: f64,
}

impl Numbering {
    /// A point of the file, or a triangle, as a message names it: counted from one, in its own file.
    fn named(&self, kind: &str, which: usize, number: usize) -> String {
        let own = self.files.iter().rev().find(|(_, first)| first[which] <= number);
        match own.filter(|_| self.files.len() > 1) {
            Some((name, first)) => format!("{kind} {} of {name}", number - first[which] + 1),
            None => format!("{kind} {} of the file", number + 1),
        }
    }

    /// The point of a node, as a message names it.
    pub fn point(&self, node: usize) -> Option<String> {
        Some(self.named("point", 0, self.nodes.get(node).copied().flatten()?))
    }

    /// A triangle, as a message names it.
    pub fn triangle(&self, t: usize) -> Option<String> {
        Some(self.named("triangle", 1, self.triangles.get(t).copied().flatten()?))
    }
}

/// A field with its residual in the equations of a discrete solution.
#[derive(Debug, Clone)]
pub struct Solution<'a> {
    /// Scene and mesh.
    pub problem: &'a Problem,
    /// The field.
    pub candidate: &'a Candidate,
    /// Nodal forces: those of the stresses, less the loads.
    pub forces: NodalForces,
    /// Points in each direction of the rule on quadrilaterals, if there are any.
    pub points: Option<usize>,
    /// The rule of all cells, on a body of revolution.
    pub rule: Option<Rule>,
    /// The part of the nodal forces that supports and contacts cannot take, node by node.
    pub rest: Vec<[f64; 2]>,
    /// Supports at vertices, then at edge midpoints.
    pub holds: Holds,
    /// The places where contact acts.
    pub sites: Sites,
    /// For each of [`Self::sites`]: the force that presses the two sides together.
    pub pressing: Vec<f64>,
    /// For each of [`Self::sites`]: (v' − v'')·n̂ − g.
    pub excess: Vec<f64>,
    /// For each of [`Self::sites`]: the friction force on the first side along t̂, zero without friction.
    pub rubbing: Vec<f64>,
    /// For each of [`Self::sites`]: (v' − v'')·t̂, zero without friction.
    pub slip: Vec<f64>,
    /// The scale of the residual, as the root of an energy.
    pub scale: f64,
    /// The strain energy ½a(u, u).
    pub strain: f64,
    /// The largest component of the displacement.
    pub largest: f64,
    /// The scale of displacements: the largest one, or the largest that the problem allows if the field is larger.
    pub reference: f64,
    /// Work of contact on gaps in addition to that of the forces at [`Self::sites`].
    on_gaps: f64,
    /// Error in the energy identity that the rule of a method may leave if its contact holds in the mean.
    of_the_rule: f64,
    /// Factor that reduces the forces of the field to at most those of a solution.
    larger: f64,
    /// Largest part of the residual owing to rounding with which checks of forces still detect a mistake, relative to `scale`.
    ceiling: f64,
    /// The remainder after the closed Bernstein coefficients have taken forces that only push, relative to `scale`.
    pushed: f64,
    /// Residual that can come from rounding of the displacements to the digits of the file.
    pub rounding: f64,
    /// Nodal forces that supports do not take, including contact forces.
    unsupported: Vec<[f64; 2]>,
    /// Material of every body.
    materials: Vec<Material>,
    /// For every contact that holds in the mean but not at the nodes: its law.
    pub weak: Vec<Option<Weak>>,
    /// True if contact is claimed to hold in the mean.
    claims_weak: bool,
    /// Forces that contact in the mean exerts at nodes in addition to pressures.
    beside: Vec<[f64; 2]>,
}

impl<'a> Solution<'a> {
    /// Inserts `candidate`, of strain energy `strain`, into the equations of a solution of its degree.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other.
    pub fn new(problem: &'a Problem, candidate: &'a Candidate, strain: f64) -> Result<Self, NoUpperBound> {
        if problem.section().is_revolved() {
            return Self::by_best_rule(problem, candidate);
        }
        let made = |points| Self::by_rule(problem, candidate, strain, points);
        let tried = cells::rules(candidate).into_iter().map(made).collect::<Result<Vec<_>, _>>()?;
        let best = tried.into_iter().min_by(|a, b| a.residual().total_cmp(&b.residual()));
        let best = best.map_or_else(|| made(None), Ok)?;
        Self::with_loads_by_rule(best, strain)
    }

    /// `exact`, or that with body forces by the rule of another program where the equations hold with it and not with exact integrals.
    fn with_loads_by_rule(exact: Self, strain: f64) -> Result<Self, NoUpperBound> {
        let (problem, candidate) = (exact.problem, exact.candidate);
        let varies = problem.scene.bodies.iter().any(|body| !body.body_force.is_constant());
        if !varies || candidate.degree > 2 || exact.residual() <= exact.allowed() {
            return Ok(exact);
        }
        let mut own = Rule { points: exact.points.unwrap_or(Rule::OWN.points), ..Rule::OWN };
        let (points, mut best) = (exact.points, None::<Self>);
        for kind in [Kind::Triangles, Kind::Quadrilaterals] {
            // One point is too few for quadratic fields.
            let enough =
                |rule: &Rule| !rule.exact_loads && (candidate.degree < 2 || rule.triangles != Some(Rule::ONE_POINT));
            for rule in own.others(problem, candidate, kind).into_iter().filter(enough) {
                let made = Self::made_by(problem, candidate, strain, points, Some(rule))?;
                if best.as_ref().is_none_or(|best| made.residual() < best.residual()) {
                    (best, own) = (Some(made), rule);
                }
            }
        }
        // A field that is none by any rule is told by what exact integrals leave.
        Ok(best.filter(|best| best.residual() <= best.allowed()).unwrap_or(exact))
    }

    /// As [`Self::new`], with one of the rules that the program may have used on quadrilaterals.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other.
    pub fn by_rule(
        problem: &'a Problem,
        candidate: &'a Candidate,
        strain: f64,
        points: Option<usize>,
    ) -> Result<Self, NoUpperBound> {
        Self::made_by(problem, candidate, strain, points, None)
    }

    fn made_by(
        problem: &'a Problem,
        candidate: &'a Candidate,
        strain: f64,
        points: Option<usize>,
        loads: Option<Rule>,
    ) -> Result<Self, NoUpperBound> {
        let mut forces = NodalForces::by_rule(problem, candidate, points);
        if let Some(rule) = loads {
            forces.sample_body_forces(problem, candidate, rule);
        }
        // ½a(u, u), whatever strains the bodies have without load.
        let initial = problem.scene.bodies.iter().any(|body| !body.initial.is_none());
        let strain = if points.is_some() || initial { forces.stored(candidate) } else { strain };
        let mut solution = Self::made_of(problem, candidate, strain, (forces, points, None))?;
        // These laws are read off the stresses of triangles.
        if solution.points.is_none() {
            solution.recognise();
            solution.accept();
        }
        Ok(solution)
    }

    /// As [`Self::new`] on a body of revolution: with the rule of triangles, then of quadrilaterals, with which the equations hold best.
    fn by_best_rule(problem: &'a Problem, candidate: &'a Candidate) -> Result<Self, NoUpperBound> {
        let mut rule = Rule::OWN;
        let mut best = Self::turned(problem, candidate, rule)?;
        // What one kind of cells leaves beside the other shows once the rule of that one is found.
        let rounds = if candidate.cells.is_empty() { 1 } else { 2 };
        for kind in [Kind::Triangles, Kind::Quadrilaterals].repeat(rounds) {
            for other in rule.others(problem, candidate, kind) {
                let made = Self::turned(problem, candidate, other)?;
                if made.residual() < best.residual() {
                    best = made;
                }
            }
            rule = best.rule.unwrap_or(rule);
        }
        Ok(best)
    }

    /// As [`Self::new`] on a body of revolution, with one of the rules that the program may have used there.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other.
    pub fn turned(problem: &'a Problem, candidate: &'a Candidate, rule: Rule) -> Result<Self, NoUpperBound> {
        let forces = turned::forces(problem, candidate, rule).0;
        let strain = forces.stored(candidate);
        let points = (!candidate.cells.is_empty()).then_some(rule.points);
        Self::made_of(problem, candidate, strain, (forces, points, Some(rule)))
    }

    fn made_of(
        problem: &'a Problem,
        candidate: &'a Candidate,
        strain: f64,
        (forces, points, rule): (NodalForces, Option<usize>, Option<Rule>),
    ) -> Result<Self, NoUpperBound> {
        let holds = holds(problem)?;
        let nodes = Nodes::of_degree(&problem.mesh, candidate.degree);
        let sites = Sites::new(problem, candidate.degree, &holds);
        let mut rest = forces.unsupported(&holds, &nodes);
        let unsupported = rest.clone();
        let (pressing, rubbing) = sites.acting(&rest);
        sites.take(&mut rest);
        let value = |node: usize| candidate.value(node);
        let excess = sites.list.iter().map(|site| site.excess(value)).collect();
        let slip = sites.list.iter().map(|site| site.slip(value)).collect();
        let balance = Balance::of_forces(problem, candidate, strain, &forces)?;
        // A product is rounded several times, a value of the file once.
        let written = if candidate.precision > f64::EPSILON { candidate.precision } else { 0.0 };
        Ok(Solution {
            problem,
            candidate,
            rest,
            holds,
            pressing,
            excess,
            rubbing,
            slip,
            scale: balance.scale.max(f64::MIN_POSITIVE),
            strain,
            largest: candidate.largest(),
            reference: candidate.largest(),
            on_gaps: forces.on_gaps,
            of_the_rule: 0.0,
            larger: 1.0,
            ceiling: f64::INFINITY,
            pushed: balance.left / balance.scale.max(f64::MIN_POSITIVE),
            rounding: balance.rounding + written * forces.energy_size(|i| forces.size[i]),
            sites,
            points,
            rule,
            forces,
            unsupported,
            materials: problem.materials(),
            weak: Vec::new(),
            claims_weak: false,
            beside: Vec::new(),
        })
    }

    /// The residual of the whole field, relative to its scale.
    pub fn residual(&self) -> f64 {
        let all = self.forces.energy_size(|i| self.rest[i][0].hypot(self.rest[i][1])) / self.scale;
        all.min(if self.is_pushed() { self.pushed } else { f64::INFINITY })
    }

    /// The largest residual that is allowed if every equation is solved.
    pub fn allowed(&self) -> f64 {
        SOLVER + (self.rounding / self.scale).min(self.ceiling)
    }

    /// True if closed Bernstein coefficients that only push explain all contact forces.
    pub fn is_pushed(&self) -> bool {
        self.pushed <= self.allowed()
    }

    /// The nodes by the size of the residual there, the largest first.
    pub fn worst(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.rest.len()).collect();
        order.sort_by(|a, b| self.weighed(*b).total_cmp(&self.weighed(*a)));
        order
    }

    /// |r_i|/√K_ii.
    pub fn weighed(&self, node: usize) -> f64 {
        let [x, y] = self.rest[node];
        x.hypot(y) / self.forces.stiffness[node].max(f64::MIN_POSITIVE).sqrt()
    }

    /// The residual of every triangle for a map: the largest |r_i|/√K_ii of its nodes, relative to the scale of the whole field.
    pub fn by_triangle(&self) -> Vec<f64> {
        let mesh = &self.problem.mesh;
        let vertices = mesh.points.len();
        let largest = |t: usize| {
            let middles = mesh.triangle_edges[t].into_iter().map(|e| vertices + e).filter(|n| *n < self.rest.len());
            let nodes = mesh.triangles[t].into_iter().chain(middles);
            nodes.map(|n| self.weighed(n)).fold(0.0, f64::max) / self.scale
        };
        (0..mesh.triangles.len()).map(largest).collect()
    }

    /// The nodal support of a node.
    pub fn hold(&self, node: usize) -> Hold {
        let vertices = self.holds.vertices.len();
        if node < vertices { self.holds.vertices[node] } else { self.holds.middle(node - vertices) }
    }

    /// Coordinates of a node.
    pub fn place(&self, node: usize) -> [f64; 2] {
        place(self.problem, node)
    }

    /// A node as a message names it: its number in the file it comes from, from one, and its coordinates.
    pub fn named(&self, node: usize) -> String {
        self.candidate.named(self.problem, node)
    }

    /// Force of the supports on a node.
    pub fn supported(&self, node: usize) -> [f64; 2] {
        let force = self.forces.left[node];
        let free = self.hold(node).project(force);
        [force[0] - free[0], force[1] - free[1]]
    }

    /// Sum of the magnitudes of the forces that act along contact `interface`.
    pub fn carried(&self, interface: usize) -> f64 {
        let sites = self.sites.list.iter().zip(&self.pressing);
        sites.filter(|(s, _)| s.interface == interface).map(|(_, f)| f.abs()).sum()
    }

    /// The scale of forces: the larger of the loads and the support forces, the latter limited to those of a solution.
    pub fn applied(&self) -> f64 {
        let size = |f: [f64; 2]| f[0].hypot(f[1]);
        let loads: f64 = self.forces.load.iter().map(|f| size(*f)).sum();
        loads.max(self.larger * (0..self.rest.len()).map(|n| size(self.supported(n))).sum::<f64>())
    }
}
