//! The scene on a mesh: every edge with its condition, every contact as a list of matched edge pairs.

mod bed;
mod build;
mod contact;
mod error;
mod polynomial;
mod scales;
#[cfg(test)]
mod tests;

pub(crate) use bed::facing_vertices;
pub use bed::{Bed, BedPair, EdgeWeight, OneSided};
pub use contact::bow::Bow;
pub use contact::coulomb::follows_coulomb;
pub use contact::direction::Direction;
pub use contact::friction::Friction;
pub use error::ProblemError;
pub use polynomial::{Counted, Oscillation};
pub use scales::{ROUND_OFF, Scales, Sizes, amplified};

use std::sync::Arc;

use crate::element::revolved::vanishes;
use crate::element::{Material, Section};
use crate::load::{BodyForce, OnTriangle};
use crate::mesh::{Triangulation, Uncut};
pub use crate::scene::Note;
use crate::scene::{Extent, Scene, Target};

/// A scene and a mesh that fit together.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The scene as written.
    pub scene: Scene,
    /// The triangles.
    pub mesh: Triangulation,
    /// Condition on each edge of the mesh.
    pub conditions: Vec<Condition>,
    /// Contacts, in scene order.
    pub interfaces: Vec<Interface>,
    /// Springs, in the order of the supports, then elastic layers in that of the bonds.
    pub beds: Vec<Bed>,
    /// Remarks for the reader of the report on how the mesh and the data were represented.
    pub notes: Vec<Note>,
    /// Treatment of curves in refinement.
    pub refinement: Refinement,
    /// What nodal forces of displacements have of polynomial tractions.
    pub counted: Counted,
    /// The mesh as it was read or made, where contacts changed it; none of a mesh that was refined.
    pub uncut: Option<Arc<Uncut>>,
}

impl Problem {
    /// Material of each body of the scene.
    pub fn materials(&self) -> Vec<Material> {
        (0..self.scene.bodies.len()).map(|body| self.material(body)).collect()
    }

    /// Material of one body of the scene.
    pub fn material(&self, body: usize) -> Material {
        let (kinematics, body) = (self.scene.kinematics, &self.scene.bodies[body]);
        let material = Material::new(kinematics, &body.elasticity);
        if body.initial.is_none() {
            return material;
        }
        material.with_initial(kinematics, &body.elasticity, &body.initial)
    }

    /// The first of the notes for which bounds are not guaranteed for the scene as it is written.
    pub fn weakened(&self) -> Option<&Note> {
        self.notes.iter().find(|note| note.weakens_guarantee)
    }

    /// The body force on triangle `t`.
    pub fn body_force(&self, t: usize) -> &BodyForce {
        &self.scene.bodies[self.mesh.body[t]].body_force
    }

    /// The body force on triangle `t`.
    pub fn force_on(&self, t: usize) -> OnTriangle {
        self.body_force(t).on(self.mesh.corners(t))
    }

    /// The least degree of stresses on triangle `t` that balance its loads.
    pub fn least_degree(&self, t: usize) -> usize {
        if !self.section().is_revolved() {
            return self.body_force(t).stress_degree();
        }
        // Beside the axis loads count times the distance from it: an axial weight, or a traction that is not the same along its edge.
        let [_, axial] = self.section().forces(self.body_force(t));
        let of_edge = |e: &usize| match self.conditions[*e] {
            Condition::Traction(ends) => self.weighted(*e, ends).len() - 1,
            // Along a direction that turns the pressure is of one degree less, and on the axis it has no coefficient: of degree 1 there is none.
            Condition::Contact { interface, pair, .. } => {
                let pair = &self.interfaces[interface].pairs[pair];
                let on_axis = pair.first.iter().any(|v| self.section().on_axis(self.mesh.points[*v]));
                if on_axis && !pair.direction.is_constant() { 2 } else { 1 }
            }
            _ => 1,
        };
        // A mean displacement of the body along the axis has such a weight as its own load.
        let own = self.mesh.body[t];
        let asked = self.scene.quantities.iter().any(|quantity| {
            matches!(quantity.target, Target::Displacement { of: Extent::Body(body), direction } if body == own && direction[1] != 0.0)
        });
        let of_edges = self.mesh.triangle_edges[t].iter().map(of_edge).max().unwrap_or(1);
        of_edges.max(if axial == 0.0 && !asked { 1 } else { 2 })
    }

    /// The section that the plane figure stands for.
    pub fn section(&self) -> Section {
        build::section(&self.scene)
    }

    /// Bernstein coefficients of a traction on edge `e`, given by its values at the ends, times the weight of the section.
    pub fn weighted(&self, e: usize, ends: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        self.section().weighted(self.mesh.edges[e].vertices.map(|v| self.mesh.points[v]), ends)
    }

    /// True if coefficient `k` of `degree` of the traction on edge `e` belongs to a point of the axis of revolution, where there is none.
    pub fn vanishes(&self, e: usize, k: usize, degree: usize) -> bool {
        vanishes(self.mesh.edges[e].vertices.map(|v| self.section().on_axis(self.mesh.points[v])), k, degree)
    }

    /// Largest weight of the ends of edge `e`.
    pub fn largest_weight(&self, e: usize) -> f64 {
        self.mesh.edges[e].vertices.iter().fold(0.0, |m, v| self.section().weight(self.mesh.points[*v]).max(m))
    }

    /// The pairs of all contacts, one interface after the other.
    pub fn pairs(&self) -> impl Iterator<Item = &ContactPair> + Clone {
        self.interfaces.iter().flat_map(|interface| &interface.pairs)
    }

    /// The pairs of all beds with their stiffness, one bed after the other.
    pub fn bed_pairs(&self) -> impl Iterator<Item = (&BedPair, [f64; 2])> + Clone {
        self.beds.iter().flat_map(|bed| bed.pairs.iter().map(|pair| (pair, bed.stiffness)))
    }

    /// The edges of Γ_τ, each with P at its two ends.
    pub fn tractions(&self) -> impl Iterator<Item = (usize, [[f64; 2]; 2])> + '_ {
        self.conditions.iter().enumerate().filter_map(|(e, condition)| match condition {
            Condition::Traction(ends) => Some((e, *ends)),
            _ => None,
        })
    }
}

/// Treatment, in refinement, of edges and gaps that stand for a curve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Refinement {
    /// New vertices lie on the curve: a finer mesh is another domain, with other admissible fields.
    #[default]
    FollowsCurves,
    /// As [`Refinement::FollowsCurves`], with all edges of one circle divided together, so that symmetry is preserved.
    FollowsCurvesEvenly,
    /// Polygon and gap stay as they are: fields of the mesh are fields of every finer one.
    KeepsEdges,
}

/// The condition on one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// Shared by two triangles: traction is continuous.
    Interior,
    /// T = P, given by its values at the two ends of the edge (in the order of [`crate::mesh::Edge::vertices`]).
    /// A free edge has P = 0.
    Traction([[f64; 2]; 2]),
    /// u = u0, given by its values at the two ends of the edge, linear between.
    Clamped([[f64; 2]; 2]),
    /// u · direction = displacement, and no traction across the direction.
    Roller {
        /// Unit vector; on most rollers the outward normal of the edge.
        direction: [f64; 2],
        /// The prescribed component.
        displacement: f64,
    },
    /// A side on the axis of revolution: u_r = 0, and no traction.
    Axis,
    /// Side 0 or 1 of `interfaces[interface].pairs[pair]`.
    Contact {
        /// Index into [`Problem::interfaces`].
        interface: usize,
        /// Index into [`Interface::pairs`].
        pair: usize,
        /// 0 for the first side, 1 for the second.
        side: usize,
    },
    /// Side 0 or 1 of `beds[bed].pairs[pair]`: the traction is that of springs.
    Elastic {
        /// Index into [`Problem::beds`].
        bed: usize,
        /// Index into [`Bed::pairs`].
        pair: usize,
        /// 0 for the first side, 1 for the second.
        side: usize,
    },
}

impl Condition {
    /// The displacement prescribed by a support at the two ends of its edge, linear between: all of u on a clamped edge, on rollers the
    /// component along their direction. `None` where nothing is held.
    pub fn prescribed(&self) -> Option<[[f64; 2]; 2]> {
        match *self {
            Condition::Clamped(ends) => Some(ends),
            Condition::Roller { direction, displacement } => Some([direction.map(|n| displacement * n); 2]),
            _ => None,
        }
    }

    /// True if a displacement other than zero is prescribed.
    pub fn is_moved(&self) -> bool {
        self.prescribed().is_some_and(|ends| ends != [[0.0; 2]; 2])
    }
}

/// One contact of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    /// `first|second` or `first|rigid`.
    pub name: String,
    /// Matched edges, ordered along the first side from the end that comes first in (x, y) order.
    pub pairs: Vec<ContactPair>,
    /// The centre of the circles that the sides lie on, where they are matched along its rays.
    pub centre: Option<[f64; 2]>,
}

/// Two edges that face each other, or one that faces a rigid obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPair {
    /// Edge of the first side, and of the second where it is a body.
    pub edges: [Option<usize>; 2],
    /// Vertices of the first side at the two ends of the pair, in the order of increasing arc length.
    pub first: [usize; 2],
    /// The vertices of the second side opposite `first`.
    pub second: Option<[usize; 2]>,
    /// Outward unit normal n' of the edge of the first side; n'' = −n'.
    pub normal: [f64; 2],
    /// The direction n̂ that contact acts along.
    pub direction: Direction,
    /// Length of the edge.
    pub length: f64,
    /// Arc length of the two ends.
    pub arc: [f64; 2],
    /// Gap g at the two ends.
    pub gap: [f64; 2],
    /// How far it lies below its chord between them.
    pub bow: Bow,
    /// Its friction, where sliding is resisted.
    pub friction: Option<Friction>,
    /// Force per area and penetration beyond the gap of an elastic contact; `None` where nothing penetrates.
    pub stiffness: Option<f64>,
}

impl ContactPair {
    /// The vertex that both sides share at one end of the pair: the tip of a crack, or where a rigid bond begins.
    pub fn shared(&self, end: usize) -> Option<usize> {
        self.second.map(|second| second[end]).filter(|v| *v == self.first[end])
    }
}

/// A constraint u(vertex) · direction = 0 that removes a rigid motion which neither supports nor contacts hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// Index into [`Triangulation::points`].
    pub vertex: usize,
    /// Unit vector.
    pub direction: [f64; 2],
    /// True if it is for models whose contact holds vertices alone.
    pub of_vertices: bool,
}
