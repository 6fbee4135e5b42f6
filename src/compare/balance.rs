//! Checks that a displacement is the solution it claims to be: the minimiser of 𝓛 over the admissible fields of its space.
//!
//! This holds if and only if, for every basis function φ of the space, the stresses σ(u_h) balance the loads, the supports and
//! contact forces that only push where contact is closed:
//!
//! ∫ σ(u_h):e(φ) − L(φ) + Σ_r R_r b_r(φ) ∈ forces of the supports,  R_r ≥ 0,  R_r = 0 where b_r(u_h) < g_r,
//!
//! with b_r the bounded coefficients of v_n' + v_n'': its values at the vertices of degree 1, its Bernstein coefficients
//! of higher degrees. Friction adds forces of its own there (`slides`). From degree 3 on the φ are Bernstein polynomials too.
//! Nothing of this is estimated: loads and stresses are polynomials and integrated exactly, and the remainder consists of the
//! solver's residual and the rounding of the displacements. A wrong modulus, load, thickness, support or
//! contact leaves far more, however small its effect on the energy is.

mod cones;
mod higher;
mod jointly;
mod reported;
mod rubbing;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use nalgebra::DVector;

use super::candidate::Candidate;
use super::contact::slides::{EndSlide, at_ends};
use super::forces::NodalForces;
use super::forces::turned;
use super::forces::turned::Rule;
use crate::bounds::{Holds, NoUpperBound, bernstein, holds};
use crate::problem::{ContactPair, Problem};
use crate::sets::DisjointSets;
use crate::statics::cone::balanced;
use crate::vector::dot;

/// A coefficient this close below its bound, relative to the largest displacement, is closed.
const CLOSED: f64 = 1e-9;
/// Relative rounding error of each product of a stiffness entry with a displacement: about twenty of them meet in a node.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Directions shorter than this after projection onto the free directions of supports are held by supports.
const HELD: f64 = 1e-9;

/// Equilibrium of a claimed solution in its own space.
#[derive(Debug, Clone)]
pub struct Balance {
    /// √Σ |r_i|²/K_ii over the nodes, with r the force that neither supports nor contact can take.
    pub left: f64,
    /// This norm of the loads, plus √(2·½a(u,u)): the scale that `left` is relative to.
    pub scale: f64,
    /// This norm of the loads alone.
    pub load: f64,
    /// This norm of the forces that supports and contacts have to carry.
    pub supported: f64,
    /// This norm of the residual that rounding of the displacements can leave.
    pub rounding: f64,
    /// Possible error, by rounding of the displacements, of an energy summed from nodal forces.
    pub energy_rounding: f64,
    /// The node with the largest remainder: its coordinates, and the force that is left.
    pub worst: Option<([f64; 2], [f64; 2])>,
    /// This node, or the one nearest to it: vertices, then edge midpoints.
    pub worst_node: Option<usize>,
    /// Largest error of a reported reaction, or resultant, against that required by the displacement; one for each interface.
    pub reactions: Vec<f64>,
    /// Possible rounding error of a reaction, interface by interface.
    pub reaction_rounding: Vec<f64>,
    /// Σ of the magnitudes of the forces at the nodes of each interface.
    pub carried: Vec<f64>,
    /// Σ of the magnitudes of the remainders that the solver left at these nodes.
    pub unbalanced: Vec<f64>,
}

impl Balance {
    /// Possible error of a reaction of interface `index` by rounding of the displacements and by the residual of their solver.
    pub fn reaction_tolerance(&self, index: usize) -> f64 {
        let of = |values: &[f64]| values.get(index).copied().unwrap_or(0.0);
        of(&self.reaction_rounding) + 4.0 * of(&self.unbalanced)
    }
}

impl Balance {
    /// Measures a candidate; `strain` is ½a(u, u) of its field.
    ///
    /// # Errors
    /// [`NoUpperBound`] where supports contradict each other.
    pub fn new(problem: &Problem, candidate: &Candidate, strain: f64) -> Result<Self, NoUpperBound> {
        let forces = match (&candidate.on_quadrilaterals, &candidate.higher) {
            _ if problem.section().is_revolved() => turned::forces(problem, candidate, Rule::OWN).0,
            (Some(own), _) => own.forces(problem).0,
            (None, Some(field)) => NodalForces::of_coefficients(problem, field),
            (None, None) => NodalForces::new(problem, candidate.degree, &candidate.vertex, &candidate.middle),
        };
        Self::of_forces(problem, candidate, strain, &forces)
    }

    /// As [`Balance::new`], with the nodal forces of the candidate in its own space.
    ///
    /// # Errors
    /// As [`Balance::new`].
    pub fn of_forces(
        problem: &Problem,
        candidate: &Candidate,
        strain: f64,
        forces: &NodalForces,
    ) -> Result<Self, NoUpperBound> {
        // What stands for quadrilaterals is no displacement of the model.
        let higher = candidate.higher.as_ref().filter(|_| candidate.cells.is_empty());
        let holds = holds(problem)?;
        let nodes = higher::nodes(problem, candidate.degree);
        let mut rest = forces.unsupported(&holds, &nodes);
        let slides = at_ends(problem, candidate.degree);
        let coupled = rubbing::coupled(problem, &holds, &slides);
        let slides = slides.into_iter().zip(coupled).collect();
        let solution = Solution { problem, candidate, holds: &holds, slides };
        let at_vertices = if solution.is_ambiguous() {
            solution.take_all(&mut rest);
            rest.clone()
        } else {
            solution.slide_inside(&mut rest);
            solution.press_and_slide_inside(&mut rest);
            match (&candidate.on_quadrilaterals, higher) {
                (None, Some(field)) => solution.take_inside(field, &mut rest),
                _ => solution.take_middles(&mut rest),
            }
            let at_vertices = rest.clone();
            solution.slide_at_vertices(&mut rest);
            solution.take_vertices(&mut rest);
            at_vertices
        };
        let nodal = |i: usize| rest[i][0].hypot(rest[i][1]);
        let weighed = |i: usize| nodal(i) / forces.stiffness[i].max(f64::MIN_POSITIVE).sqrt();
        let worst = (0..rest.len()).max_by(|&a, &b| weighed(a).total_cmp(&weighed(b)));
        let value = |i: usize| match (&candidate.on_quadrilaterals, higher) {
            (Some(own), _) => own.field.values()[i],
            (None, Some(field)) => field.values()[i],
            (None, None) => solution.value(i),
        };
        let (mut reactions, mut reaction_rounding) = (Vec::new(), Vec::new());
        let (mut carried, mut unbalanced) = (Vec::new(), Vec::new());
        for (index, interface) in problem.interfaces.iter().enumerate() {
            let reported = candidate.reactions.as_ref().and_then(|r| r.get(index));
            reactions
                .push(reported.map_or(0.0, |r| solution.misreported(index, interface, r, &at_vertices, &forces.left)));
            let first = || interface.pairs.iter().flat_map(|p| p.first);
            reaction_rounding.push(ROUNDING * first().map(|v| forces.size[v]).sum::<f64>());
            let ends = interface.pairs.iter().flat_map(|p| p.first.into_iter().chain(p.second.into_iter().flatten()));
            let inside = interface.pairs.iter().flat_map(|p| p.edges).flatten().flat_map(|e| nodes.inside(e));
            unbalanced.push(ends.chain(inside).map(nodal).sum::<f64>());
            carried.push(first().map(|v| forces.left[v][0].hypot(forces.left[v][1])).sum::<f64>());
        }
        let load = forces.energy_size(|i| forces.load[i][0].hypot(forces.load[i][1]));
        Ok(Balance {
            left: forces.energy_size(nodal),
            load,
            supported: forces.energy_size(|i| forces.left[i][0].hypot(forces.left[i][1])),
            scale: load + (2.0 * strain).sqrt(),
            rounding: ROUNDING * forces.energy_size(|i| forces.size[i]),
            energy_rounding: ROUNDING
                * (0..rest.len()).map(|i| forces.size[i] * value(i)[0].hypot(value(i)[1])).sum::<f64>(),
            worst: worst.map(|i| (higher::place(problem, candidate.degree, i), rest[i])),
            worst_node: worst.map(|i| higher::near(problem, candidate.degree, i)),
            reactions,
            reaction_rounding,
            carried,
            unbalanced,
        })
    }
}

/// A claimed solution with the supports of its problem.
struct Solution<'a> {
    problem: &'a Problem,
    candidate: &'a Candidate,
    holds: &'a Holds,
    /// Tangential jumps at vertices, each with a flag that is true if its law is coupled with others.
    slides: Vec<(EndSlide, bool)>,
}

impl Solution<'_> {
    fn value(&self, node: usize) -> [f64; 2] {
        self.candidate.value(node)
    }

    /// The values that the coefficients inside pairs are functions of: at nodes of degree 2, coefficients above. None where what stands
    /// for quadrilaterals is no displacement of the model.
    fn inside_values(&self) -> Option<impl Fn(usize) -> [f64; 2] + Copy> {
        let degree = self.candidate.degree;
        let coefficients = self.candidate.higher.as_ref().filter(|_| degree > 2);
        let is_own = self.candidate.on_quadrilaterals.is_none() || degree <= 2;
        is_own.then_some(move |node: usize| coefficients.map_or_else(|| self.value(node), |field| field.values()[node]))
    }

    /// What rests on a held vertex of a pair is the support's.
    fn rest_on_supports(&self, pair: &ContactPair, rest: &mut [[f64; 2]]) {
        for v in pair.first.into_iter().chain(pair.second.into_iter().flatten()) {
            rest[v] = self.holds.vertices[v].project(rest[v]);
        }
    }

    /// The unit row of a force along `direction` between two vertices, with its length before; `None` where supports take it.
    fn unit_row(
        &self,
        (first, second): (usize, Option<usize>),
        direction: [f64; 2],
        slot: &HashMap<usize, usize>,
    ) -> Option<(DVector<f64>, f64)> {
        let mut row = DVector::<f64>::zeros(2 * slot.len());
        for (v, sign) in [(Some(first), 1.0), (second, -1.0)] {
            let Some(v) = v else { continue };
            let d = self.holds.vertices[v].project(direction);
            (0..2).for_each(|c| row[slot[&v] + c] += sign * d[c]);
        }
        let length = row.norm();
        (length > HELD).then(|| (row / length, length))
    }

    /// Coefficients this far below their bound are open.
    fn closed_within(&self) -> f64 {
        CLOSED * self.candidate.largest()
    }

    /// Removes the forces of the middle coefficients b1 = 2 j_mid − ½ (j_a + j_b) from `rest`, at the midpoints and at
    /// the vertices.
    fn take_middles(&self, rest: &mut [[f64; 2]]) {
        if self.candidate.degree != 2 {
            return;
        }
        let vertices = self.problem.mesh.points.len();
        let within = self.closed_within();
        for pair in self.problem.pairs().filter(|pair| !cones::follows_cone(pair)) {
            if !pair.direction.is_constant() {
                self.take_turning(pair, within, rest);
                continue;
            }
            let n = pair.direction.ends[0];
            let jump = |first: [f64; 2], second: Option<[f64; 2]>| dot(first, n) - second.map_or(0.0, |u| dot(u, n));
            let end = |k: usize| jump(self.value(pair.first[k]), pair.second.map(|s| self.value(s[k])));
            let middles = pair.edges.map(|e| e.map(|e| vertices + e));
            let Some(own) = middles[0] else { continue };
            let b1 = 2.0 * jump(self.value(own), middles[1].map(|m| self.value(m))) - 0.5 * (end(0) + end(1));
            if b1 < pair.gap_below(2)[1] - within {
                continue;
            }
            let pull = match middles[1] {
                Some(other) => 0.5 * (dot(rest[own], n) - dot(rest[other], n)),
                None => dot(rest[own], n),
            };
            let reaction = (-0.5 * pull).max(0.0);
            let mut add = |node: usize, factor: f64| {
                rest[node][0] += factor * reaction * n[0];
                rest[node][1] += factor * reaction * n[1];
            };
            add(own, 2.0);
            pair.first.into_iter().for_each(|v| add(v, -0.5));
            if let (Some(other), Some(second)) = (middles[1], pair.second) {
                add(other, -2.0);
                second.into_iter().for_each(|v| add(v, 0.5));
            }
            self.rest_on_supports(pair, rest);
        }
    }

    /// As [`Self::take_middles`], for a pair whose direction of contact turns, with two middle coefficients.
    fn take_turning(&self, pair: &ContactPair, within: f64, rest: &mut [[f64; 2]]) {
        let vertices = self.problem.mesh.points.len();
        let [Some(own), other] = pair.edges.map(|e| e.map(|e| vertices + e)) else { return };
        let pull = match other {
            Some(other) => [0, 1].map(|c| 0.5 * (rest[own][c] - rest[other][c])),
            None => rest[own],
        };
        let values = |node: usize| self.value(node);
        let rows = bernstein(pair, vertices);
        let inner = &rows[1..rows.len() - 1];
        let closed: Vec<bool> = inner.iter().map(|row| row.excess_at(values) >= -within).collect();
        let reactions = inner_reactions(pair, pull, [closed[0], closed[1]]);
        for (row, reaction) in inner.iter().zip(reactions) {
            for (node, factor) in row.terms() {
                rest[*node] = [0, 1].map(|c| rest[*node][c] + reaction * factor[c]);
            }
        }
        self.rest_on_supports(pair, rest);
    }

    /// Removes the forces of the vertex coefficients from `rest`, leaving the least remainder of each group of vertices that
    /// contacts tie together.
    fn take_vertices(&self, rest: &mut [[f64; 2]]) {
        let within = self.closed_within();
        for group in self.groups() {
            let slot: HashMap<usize, usize> = group.vertices.iter().enumerate().map(|(i, v)| (*v, 2 * i)).collect();
            let size = 2 * group.vertices.len();
            let mut rows = Vec::new();
            for end in &group.ends {
                if !self.is_closed(end, within) {
                    continue;
                }
                let own = self.directions(end);
                let own = own.into_iter().filter_map(|n| self.unit_row((end.first, end.second), n, &slot));
                rows.extend(own.map(|(row, _)| row));
            }
            let sticking = self.sticking(&group, &slot);
            if self.couples(&group) {
                let load = DVector::from_iterator(size, group.vertices.iter().flat_map(|v| rest[*v].map(|f| -f)));
                let left = rubbing::least(&load, &rows, &sticking);
                slot.into_iter().for_each(|(v, i)| rest[v] = [-left[i], -left[i + 1]]);
                continue;
            }
            let pushing = rows.len();
            rows.extend(sticking.iter().flat_map(|(row, _)| [row.clone(), -row]));
            let mut load = DVector::zeros(size);
            for (v, i) in &slot {
                (load[*i], load[*i + 1]) = (-rest[*v][0], -rest[*v][1]);
            }
            // Where the working set does not settle, the whole force is left over and the check fails in the open.
            let Ok((mut left, forces)) = balanced(&load, &rows) else { continue };
            for (row, force) in forces {
                if let Some((_, limit)) = row.checked_sub(pushing).map(|i| &sticking[i / 2]) {
                    // Friction carries no more than its bound.
                    left.axpy((force - limit).max(0.0), &rows[row], 1.0);
                }
            }
            for (v, i) in slot {
                rest[v] = [left[i], left[i + 1]];
            }
        }
    }

    /// True if the sides touch at an end of a pair, where jumps are zero `within` a distance.
    fn is_closed(&self, end: &End, within: f64) -> bool {
        let jump = dot(self.value(end.first), end.normal) - end.second.map_or(0.0, |v| dot(self.value(v), end.normal));
        jump >= end.gap - within
    }

    /// The vertices of Γ_K in groups that contacts tie together.
    fn groups(&self) -> Vec<Group> {
        let ends = || self.problem.pairs().flat_map(End::of);
        let mut sets = DisjointSets::new(self.problem.mesh.points.len());
        for end in ends() {
            if let Some(second) = end.second {
                sets.join(end.first, second);
            }
        }
        let (label, _) = sets.labels();
        let mut groups: BTreeMap<usize, Group> = BTreeMap::new();
        for end in ends() {
            let group = groups.entry(label[end.first]).or_default();
            group.vertices.extend([Some(end.first), end.second].into_iter().flatten());
            group.ends.push(end);
        }
        groups.into_values().collect()
    }
}

/// The reactions R_k ≥ 0 of the middle coefficients of a pair along which the direction turns that balance the force
/// `pull` at the midpoint best; each moves the jump there by 4/3 of the direction at its end. Those not `closed` are zero.
fn inner_reactions(pair: &ContactPair, pull: [f64; 2], closed: [bool; 2]) -> [f64; 2] {
    let alone = |k: usize| {
        let n = pair.direction.ends[k];
        if closed[k] { (-0.75 * dot(pull, n) / dot(n, n)).max(0.0) } else { 0.0 }
    };
    if closed == [true; 2] {
        let [m, n] = pair.direction.ends;
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let both = [-0.75 * cross(pull, n) / cross(m, n), -0.75 * cross(m, pull) / cross(m, n)];
        match both.map(|r| r >= 0.0) {
            [true, true] => return both,
            [true, false] => return [alone(0), 0.0],
            [false, true] => return [0.0, alone(1)],
            [false, false] => return [0.0; 2],
        }
    }
    [alone(0), alone(1)]
}

/// Vertices tied by contacts, and the ends of pairs that tie them.
#[derive(Default)]
struct Group {
    vertices: BTreeSet<usize>,
    ends: Vec<End>,
}

/// One end of a contact pair.
struct End {
    first: usize,
    second: Option<usize>,
    normal: [f64; 2],
    gap: f64,
}

impl End {
    fn of(pair: &ContactPair) -> [End; 2] {
        [0, 1].map(|k| End {
            first: pair.first[k],
            second: pair.second.map(|s| s[k]),
            normal: pair.direction.ends[k],
            gap: pair.gap[k],
        })
    }
}
