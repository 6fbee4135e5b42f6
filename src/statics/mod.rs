//! Existence of an equilibrium under the loads, and the rigid motions that nothing holds.
//!
//! Equilibrium is possible only if L(y) ≤ 0 for every rigid motion y that supports and contacts allow: u = 0 on Γ_u,
//! u_n = 0 on Γ_0, v_n' + v_n'' ≤ 0 on Γ_K (1.16). Initial gaps do not enter: a body falls through any gap until it is
//! held. The allowed motions form a cone in few unknowns, three per piece of the mesh, so the question is settled before
//! anything is solved: the loads are split into a part the contact forces can balance and the motion they drive
//! (see `cone`). A motion allowed both ways must see no work at all; it then leaves the stress unique and the displacement
//! not, and pins choose one displacement.
//!
//! With friction L(y) may be as large as ∫ τ̄ |y_t' − y_t''|, the work absorbed by a given bound of the traction (see `friction`), and a
//! motion that slides against friction is not free.

mod balance;
mod components;
pub(crate) mod cone;
mod coulomb;
mod friction;
mod gaps;
mod lasting;
mod loads;
mod openings;
mod pins;
mod reach;
mod restraint;
mod words;

#[cfg(test)]
mod tests;

pub use components::{Components, RigidMotion};
pub use coulomb::{Wedged, friction_can_balance, wedged};
pub use loads::LoadResultants;
pub use pins::{EdgePin, VertexPin};
pub use words::{MotionKind, Moving};

use crate::problem::Problem;
use balance::Verdict;
use lasting::Lasting;
use nalgebra::DVector;
use restraint::Group;

/// Free motions described one by one; any more are only counted.
const MOST_NOTES: usize = 6;

/// Rigid statics of a problem.
#[derive(Debug, Clone, PartialEq)]
pub struct Statics {
    /// The pieces of the mesh.
    pub components: Components,
    /// The loads on each piece.
    pub loads: LoadResultants,
    /// A basis of the motions allowed both ways: no displacement on Γ_u, no normal displacement on Γ_0, no jump on Γ_K, where its direction
    /// turns at vertices. Each has largest displacement 1, and as
    /// many pieces and rotations as possible are at rest in each (displacement: that of the centroid plus size times rotation).
    pub held: Vec<RigidMotion>,
    /// A basis of those that open nothing between vertices either: the null vectors of the stiffness with all contacts held closed.
    pub held_along_edges: Vec<RigidMotion>,
    /// One vertex pin per motion of `held`; those of no motion along edges are for models whose contact holds vertices alone.
    pub vertex_pins: Vec<VertexPin>,
    /// One edge pin per motion of `held_along_edges`.
    pub edge_pins: Vec<EdgePin>,
    /// The answer.
    pub equilibrium: Solvability,
    /// Remarks for a report: motions that stay free, borderline loads, pressure too concentrated for the mesh.
    pub notes: Vec<String>,
    /// Parts of the verdicts on groups of pieces that stay valid on a finer mesh.
    lasting: Vec<Lasting>,
}

impl Statics {
    /// True if no pressure on this mesh balances the loads, though there is an equilibrium.
    pub fn is_beyond_mesh(&self) -> bool {
        matches!(self.equilibrium, Solvability::Possible { beyond_mesh: Some(_), .. })
    }

    /// The motions of `held` as displacements of every vertex.
    pub fn held_at_vertices(&self, problem: &Problem) -> Vec<Vec<[f64; 2]>> {
        self.at_vertices(problem, &self.held)
    }

    /// Those of `held_along_edges` as displacements of every vertex: the ones that a method in stresses has to hold.
    pub fn null_motions(&self, problem: &Problem) -> Vec<Vec<[f64; 2]>> {
        self.at_vertices(problem, &self.held_along_edges)
    }

    fn at_vertices(&self, problem: &Problem, motions: &[RigidMotion]) -> Vec<Vec<[f64; 2]>> {
        motions.iter().map(|motion| motion.at_vertices(problem, &self.components)).collect()
    }
}

/// The verdict on (1.16).
#[derive(Debug, Clone, PartialEq)]
pub enum Solvability {
    /// L(y) ≤ 0 for every allowed motion.
    Possible {
        /// A motion allowed one way only on which the loads do no work (to within 1e-7 of the loads): the borderline.
        one_way: Option<RigidMotion>,
        /// A motion that shows that no pressure of the degrees in use whose coefficients all press balances the loads on
        /// this mesh, though an equilibrium exists: the discrete dual set is empty until the ends of the contact are refined.
        beyond_mesh: Option<RigidMotion>,
    },
    /// Some allowed motion has L(y) > 0.
    Impossible {
        /// That motion; the largest displacement in each independent group of pieces is 1.
        motion: RigidMotion,
        /// L(motion) > 0, thickness included.
        work: f64,
        /// The pieces that move, those that drive the motion first.
        bodies: Vec<Moving>,
        /// One sentence per group of pieces that cannot be in equilibrium.
        sentence: String,
    },
}

/// Why the question could not be answered.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StaticsError {
    /// The active-set search did not settle.
    #[error(
        "the balance of {bodies} could not be decided: the contact forces that balance the loads best were not found. \
         Check the scene for contacts that are short against their distance from each other"
    )]
    Undecided {
        /// The bodies in question.
        bodies: String,
    },
    /// A motion that no vertex or no edge can take away.
    #[error(
        "{bodies} can move freely and the mesh offers no point to pin: refine it once, so that pieces have interior edges"
    )]
    NothingToPin {
        /// The bodies in question.
        bodies: String,
    },
}

/// Rigid statics of `problem`, for stresses that are linear on every triangle.
///
/// # Errors
/// As [`check_with_degrees`].
pub fn check(problem: &Problem) -> Result<Statics, StaticsError> {
    check_with_degrees(problem, &|_| 1)
}

/// Rigid statics of `problem`, for stresses that are of degree `degree(t)` on triangle t: the higher it is, the closer to an
/// end of contact its pressure can act.
///
/// # Errors
/// [`StaticsError`] where round-off or the mesh leaves the question open; no scene is known to lead there.
pub fn check_with_degrees(problem: &Problem, degree: &dyn Fn(usize) -> usize) -> Result<Statics, StaticsError> {
    check_after(problem, degree, None)
}

/// [`check_with_degrees`], with what is known from a coarser mesh of the same scene.
///
/// # Errors
/// As there.
pub fn check_after(
    problem: &Problem,
    degree: &dyn Fn(usize) -> usize,
    coarser: Option<&Statics>,
) -> Result<Statics, StaticsError> {
    let before = coarser.map_or(&[][..], |statics| &statics.lasting);
    let mut lasting = Vec::new();
    let components = Components::new(problem);
    let loads = LoadResultants::new(problem, &components);
    let runs = restraint::runs(problem, &components, degree);
    let clamped = restraint::clamped(problem, &components);

    let (mut held, mut held_along_edges) = (Vec::new(), Vec::new());
    let (mut vertex_pins, mut edge_pins) = (Vec::new(), Vec::new());
    let (mut both_ways, mut one_way, mut beyond_mesh, mut impossible) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for group in restraint::groups(&components, &clamped, &runs) {
        let mut found = Verdict::of(problem, &group, &loads, before)?;
        lasting.extend(found.lasting.take());
        let words = |motion: &RigidMotion| words::moving(problem, &group, &loads, motion);
        let along_edges = found.held_along_edges(problem, &group);
        vertex_pins.extend(pins::vertex_pins(problem, &group, &along_edges, &found.held)?);
        edge_pins.extend(pins::edge_pins(problem, &group, &along_edges)?);
        held_along_edges.extend(along_edges.iter().map(|direction| motion(&group, direction).0));
        for direction in &found.held {
            let motion = motion(&group, direction).0;
            // The others are only counted.
            let told = both_ways.len() < MOST_NOTES;
            both_ways.push(if told { words::free_both_ways(&components, &words(&motion)) } else { String::new() });
            held.push(motion);
        }
        let open = gaps::without_gaps(problem, &group);
        for (names, direction) in gaps::free_while_open(problem, &group, &loads, &found)? {
            let moving = words::moving(problem, &open, &loads, &motion(&group, &direction).0);
            both_ways.push(words::free_while_open(&components, &moving, &names));
        }
        if let Some(driven) = found.driven {
            let (motion, factor) = motion(&group, &driven.motion);
            // Summing force times displacement instead would lose small differences.
            let [work, resisted] = [driven.work, driven.resisted].map(|work| factor * work);
            let moving = words(&motion);
            let sentence = words::impossible(&components, &moving, work, resisted);
            impossible.push((motion, work, moving, sentence));
        }
        if let Some(direction) = &found.one_way {
            let motion = motion(&group, direction).0;
            let loaded = group.members.iter().any(|c| loads.magnitude[*c] > 0.0);
            one_way.push((words::free_one_way(&components, &words(&motion), loaded), motion));
        }
        if let Some(direction) = &found.beyond_mesh {
            let motion = motion(&group, direction).0;
            let degree = group.runs.iter().flat_map(|run| run.degree).max().unwrap_or(1);
            let note = words::beyond_mesh(&components, &words(&motion), found.one_way.is_some(), degree);
            beyond_mesh.push((note, motion));
        }
    }

    let (equilibrium, notes) = if impossible.is_empty() {
        let mut notes = both_ways;
        if notes.len() > MOST_NOTES {
            let more = match notes.len() - MOST_NOTES {
                1 => "One more rigid motion is free in the same way.".to_string(),
                more => format!("{more} more rigid motions are free in the same way."),
            };
            notes.truncate(MOST_NOTES);
            notes.push(more);
        }
        notes.extend(one_way.iter().chain(&beyond_mesh).map(|(note, _)| note.clone()));
        let sum = |all: Vec<(String, RigidMotion)>| together(all.into_iter().map(|(_, motion)| motion));
        (Solvability::Possible { one_way: sum(one_way), beyond_mesh: sum(beyond_mesh) }, notes)
    } else {
        let work = impossible.iter().map(|(_, work, _, _)| work).sum();
        let sentence = impossible.iter().map(|(_, _, _, sentence)| sentence.as_str()).collect::<Vec<_>>().join(" ");
        let bodies = impossible.iter().flat_map(|(_, _, moving, _)| moving.clone()).collect();
        let motion = together(impossible.into_iter().map(|(motion, ..)| motion))
            .unwrap_or(RigidMotion { component: vec![[0.0; 3]; components.count()] });
        (Solvability::Impossible { motion, work, bodies, sentence }, Vec::new())
    };
    Ok(Statics { components, loads, held, held_along_edges, vertex_pins, edge_pins, equilibrium, notes, lasting })
}

/// The motion of the pieces for a vector of group unknowns, scaled to largest displacement 1, and the factor that took.
fn motion(group: &Group, direction: &DVector<f64>) -> (RigidMotion, f64) {
    let reach = |m: usize| direction[3 * m].hypot(direction[3 * m + 1]) + direction[3 * m + 2].abs();
    let largest = (0..group.members.len()).map(reach).fold(f64::MIN_POSITIVE, f64::max);
    let mut component = vec![[0.0; 3]; group.components.count()];
    for (m, c) in group.members.iter().enumerate() {
        let [a, b, w] = [0, 1, 2].map(|i| direction[3 * m + i] / largest);
        component[*c] = [a, b, w / group.components.size[*c]];
    }
    (RigidMotion { component }, largest.recip())
}

fn together(mut motions: impl Iterator<Item = RigidMotion>) -> Option<RigidMotion> {
    let mut sum = motions.next()?;
    for motion in motions {
        for (total, part) in sum.component.iter_mut().zip(motion.component) {
            for i in 0..3 {
                total[i] += part[i];
            }
        }
    }
    Some(sum)
}
