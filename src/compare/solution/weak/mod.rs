//! Contact that holds in the mean and not at nodes.
//!
//! Mortar methods require ∫ψ(j − g) ≤ 0 for every shape function ψ of their multiplier, Nitsche's method balances a penetration with
//! the normal stress, an augmented Lagrangian with quadrature does the one or the other. A field of such a method correctly penetrates
//! at some nodes and opens at others. The law is recognised from the contact forces alone, without information from the program.

mod least;
mod mortar;
mod nitsche;
mod stations;

pub use mortar::Multiplier;
pub use nitsche::{Point, longest, nitsche};
pub use stations::{Rows, Shape, Station};

use super::{SOLVER, Solution};

/// Error by the quadrature rule of another program where contact begins or ends inside an edge, relative to the contact forces.
pub const OF_THE_RULE: f64 = 0.02;
/// Forces below this fraction of all others count as zero.
const NO_FORCE: f64 = 1e-6;
/// Number of rounded displacements in the force of a node: all may be off in the same direction.
const MEETING: f64 = 16.0;

/// The law that contact forces follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Multipliers whose conditions are met.
    Mortar(Multiplier),
    /// Multipliers whose conditions are met except where contact ends inside an edge.
    Augmented(Multiplier),
    /// Nitsche's.
    Nitsche {
        /// One for the symmetric method, zero for the incomplete one, minus one for the skew one.
        theta: f64,
        /// (j − g)/γ is the pressure of a penetration.
        gamma: f64,
        /// True if γ is a multiple of a length of the mesh.
        per_length: bool,
    },
}

/// The law by which a contact holds in the mean, with its errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Weak {
    /// The law.
    pub law: Law,
    /// The largest mean penetration over a shape function of the multiplier.
    pub penetration: f64,
    /// Contact forces that do not follow the law, relative to all forces of this contact.
    pub misfit: f64,
    /// Sum of the forces of the multiplier that pull.
    pub pulling: f64,
    /// Forces that the law exerts at nodes in addition to pressures.
    pub(super) terms: Vec<(usize, [f64; 2])>,
}

/// Values that count as zero along one contact.
pub struct Limits {
    /// A length.
    pub length: f64,
    /// A force.
    pub force: f64,
    /// A fraction of the contact forces.
    pub part: f64,
}

impl Weak {
    /// The law in words.
    pub fn in_words(&self) -> String {
        let space = |multiplier: Multiplier| match multiplier {
            Multiplier::Edges => "every edge",
            Multiplier::Hats => "the linear shape functions of a multiplier",
            Multiplier::Quadratic => "the quadratic shape functions of a multiplier",
            Multiplier::Dual => "the dual shape functions of a multiplier",
        };
        match self.law {
            Law::Mortar(multiplier) => format!("in the mean over {}, as of a mortar method", space(multiplier)),
            Law::Augmented(multiplier) => {
                format!(
                    "in the mean over {}, as of an augmented Lagrangian evaluated at quadrature points",
                    space(multiplier)
                )
            }
            Law::Nitsche { theta, gamma, per_length } => {
                let of = if per_length { "lengths of an edge or element" } else { "units of length over stress" };
                format!("in the sense of Nitsche's method (θ = {theta:.3}, γ = {gamma:.4e} {of})")
            }
        }
    }
}

impl Solution<'_> {
    /// True if contact `interface` penetrates at no node.
    pub fn is_met(&self, interface: usize) -> bool {
        let limit = self.limits(interface).length;
        let own = self.sites.list.iter().zip(&self.excess).filter(|(site, _)| site.interface == interface);
        own.into_iter().all(|(_, excess)| *excess <= limit)
    }

    /// Looks for the law of every contact that does not hold at the nodes.
    pub(super) fn recognise(&mut self) {
        let of = |interface: usize| {
            let limits = self.limits(interface);
            // The laws known here are those of contact that slides freely.
            if self.problem.has_friction() || self.is_nodal(interface, &limits) {
                return None;
            }
            let shapes: &[Shape] =
                if self.is_curved(interface) { &[Shape::Chords, Shape::Curve] } else { &[Shape::Chords] };
            let points = |rule: usize, shape: Shape| self.points_along(interface, rule, shape, &limits);
            let mortar = shapes.iter().find_map(|shape| mortar::mortar(self, interface, &limits, *shape));
            let nitsche = mortar.is_none().then(|| nitsche(self, &limits, shapes, points)).flatten();
            let augmented = || shapes.iter().find_map(|shape| mortar::augmented(self, interface, &limits, *shape));
            let exact = nitsche.as_ref().is_some_and(|weak| weak.misfit <= limits.part);
            mortar.or_else(|| if exact { nitsche } else { augmented().or(nitsche) })
        };
        self.weak = (0..self.problem.interfaces.len()).map(of).collect();
    }

    /// Values that count as zero along contact `interface`.
    pub fn limits(&self, interface: usize) -> Limits {
        let part = (NO_FORCE + MEETING * self.rounding / self.scale).min(OF_THE_RULE);
        let total = self.applied().max(self.carried(interface));
        Limits { length: 2.0 * (SOLVER + self.candidate.precision) * self.reference, force: part * total, part }
    }

    /// The fraction of the forces of contact `interface` that need not follow its law.
    pub(super) fn weak_part(&self, interface: usize) -> f64 {
        let part = self.limits(interface).part;
        if self.claims_weak { part.max(OF_THE_RULE) } else { part }
    }

    /// Relative change of a penetration by the quadrature rule of another program, if contact is claimed to hold in the mean;
    /// otherwise zero.
    pub(super) fn rule(&self) -> f64 {
        if self.claims_weak { OF_THE_RULE } else { 0.0 }
    }

    /// True if contact is closed or open node by node, or in its Bernstein coefficients.
    fn is_nodal(&self, interface: usize, limits: &Limits) -> bool {
        let own: Vec<usize> =
            (0..self.sites.list.len()).filter(|s| self.sites.list[*s].interface == interface).collect();
        let met = |force: &[f64], depth: &[f64]| {
            own.iter()
                .all(|s| depth[*s] <= limits.length && (depth[*s] >= -limits.length || force[*s].abs() <= limits.force))
        };
        let (forces, distances) = self.sites.in_coefficients(&self.pressing, &self.excess);
        own.is_empty() || met(&self.pressing, &self.excess) || met(&forces, &distances)
    }

    /// Claims that contact holds in the mean over edges: its forces have to follow a law of such methods up to the error of the
    /// quadrature rule of another program.
    pub fn with_weak_contact(mut self, claimed: bool) -> Self {
        if claimed {
            self.claims_weak = true;
            self.accept();
        }
        self
    }

    /// The law of contact `interface`, if the field follows it to the accuracy of a solver, or as closely as is claimed.
    pub fn holds_weakly(&self, interface: usize) -> Option<&Weak> {
        let part = self.weak_part(interface);
        let carried = self.carried(interface);
        self.weak.get(interface)?.as_ref().filter(|weak| weak.misfit <= part && weak.pulling <= part * carried)
    }

    /// The law that contact forces nearly follow, whether or not that is close enough.
    pub fn nearly_weak(&self, interface: usize) -> Option<&Weak> {
        self.weak.get(interface)?.as_ref().filter(|weak| weak.misfit <= OF_THE_RULE)
    }

    /// Removes from the residual the forces that accepted laws exert in addition to pressures.
    pub(super) fn accept(&mut self) {
        let accepted: Vec<usize> = (0..self.weak.len()).filter(|i| self.holds_weakly(*i).is_some()).collect();
        let mut free = self.unsupported.clone();
        let terms = |i: &usize| self.weak[*i].iter().flat_map(|weak| weak.terms.iter());
        for (node, force) in accepted.iter().flat_map(terms) {
            let force = self.hold(*node).project(*force);
            (0..2).for_each(|c| free[*node][c] -= force[c]);
        }
        if accepted.is_empty() {
            return;
        }
        self.pressing = self.sites.pressing(&free);
        self.rest = free.clone();
        self.sites.take(&mut self.rest);
        let near =
            accepted.iter().filter(|i| self.weak[**i].as_ref().is_some_and(|w| w.misfit > self.limits(**i).part));
        // What the rule of the other program leaves where the law is only nearly met belongs to contact as well.
        for (node, _) in near.flat_map(terms).collect::<Vec<_>>() {
            let rest = self.rest[*node];
            (0..2).for_each(|c| free[*node][c] -= rest[c]);
            self.rest[*node] = [0.0; 2];
        }
        let beside = self.unsupported.iter().zip(&free).map(|(all, own)| [all[0] - own[0], all[1] - own[1]]);
        self.beside = beside.collect();
    }
}
