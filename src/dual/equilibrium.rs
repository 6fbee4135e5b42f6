//! Equilibrium, measured on the stresses themselves.

use nalgebra::DMatrix;

use super::contact::moments::columns_of_pair;
use super::resultants::work_within;
use super::system::applied;
use crate::element::{SideValues, StressField};
use crate::problem::{BedPair, Condition, ContactPair, Problem, Scales};
use crate::vector::long::largest;
use crate::vector::norm;

/// How well a stress field balances the loads.
///
/// Remainders of traction are relative to the applied load, or to the largest stress in the triangles at the edge where that is
/// larger: a body that rests on a millionth of its side has a million times its load there, and its rounding errors.
/// Rounding of prescribed displacements ([`Scales::stress_round_off`]) is taken off first: where they
/// cause no stress, remainders and stresses are both nothing else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Largest jump of traction across an interior edge or a closed pair, and largest shear on rollers and contacts.
    pub jump: f64,
    /// Largest difference between traction and applied traction.
    pub applied: f64,
    /// Largest resultant of boundary tractions and body force on any body, relative to the sum of their sizes.
    pub resultant: f64,
    /// Largest tension on a contact.
    pub tension: f64,
    /// The size of the applied load, as a traction.
    pub scale: f64,
    /// ∫ |what is left of equilibrium · displacement|, on edges and of triangles by themselves: by how much the lower bound can be off, per unit thickness.
    pub work: f64,
}

impl Equilibrium {
    /// The largest of the four.
    pub fn residual(&self) -> f64 {
        self.jump.max(self.applied).max(self.resultant).max(self.tension)
    }

    /// Measures `stress` on `problem`; `moments` are those of the displacement that the remainders are weighed with.
    pub fn measure(problem: &Problem, stress: &StressField, moments: &SideValues<[f64; 2]>) -> Self {
        let scales = Scales::new(problem);
        let scale = load_scale(&scales, || stress.clone());
        let measured = Measured { problem, stress, moments, relative: Relative::new(problem, stress, &scales, scale) };
        let mut found = Equilibrium {
            jump: 0.0,
            applied: 0.0,
            resultant: largest_resultant(problem, stress, moments, &scales),
            tension: 0.0,
            scale,
            work: work_within(problem, stress, moments),
        };
        (0..problem.mesh.edges.len()).for_each(|e| measured.edge(e, &mut found));
        problem.pairs().for_each(|pair| measured.pair(pair, &mut found));
        found
    }
}

/// Remainders of traction relative to what is there.
struct Relative<'a> {
    problem: &'a Problem,
    scale: f64,
    /// The largest stress on each triangle.
    stressed: Vec<f64>,
    /// Rounding of prescribed displacements on each.
    rounding: Vec<f64>,
}

impl<'a> Relative<'a> {
    fn new(problem: &'a Problem, stress: &StressField, scales: &Scales, scale: f64) -> Self {
        let all = 0..stress.len();
        Relative {
            problem,
            scale,
            stressed: all.clone().map(|t| largest(stress.block(t).as_flattened())).collect(),
            rounding: all.map(|t| scales.stress_round_off(problem, t, stress.degree(t))).collect(),
        }
    }

    /// `left` on edge `e`.
    fn of(&self, left: f64, e: usize) -> f64 {
        let at = self.problem.mesh.edges[e].triangles.iter().flatten();
        let weight = self.problem.largest_weight(e);
        let near = at.clone().fold(weight * self.scale, |m, &t| m.max(self.stressed[t]));
        let left = left - weight * at.fold(0.0_f64, |m, &t| m.max(self.rounding[t]));
        if left <= 0.0 {
            0.0
        } else if near > 0.0 {
            left / near
        } else {
            left
        }
    }
}

/// A stress that is measured.
struct Measured<'a> {
    problem: &'a Problem,
    stress: &'a StressField,
    moments: &'a SideValues<[f64; 2]>,
    relative: Relative<'a>,
}

impl Measured<'_> {
    fn traction(&self, e: usize, side: usize, degree: usize) -> Vec<[f64; 2]> {
        self.stress.edge_traction(&self.problem.mesh, e, side, degree)
    }

    /// Measures the remainder on an edge that is in no contact.
    fn edge(&self, e: usize, found: &mut Equilibrium) {
        let degree = self.moments.of(e).len() - 1;
        let own = self.traction(e, 0, degree);
        let condition = &self.problem.conditions[e];
        let left: Vec<[f64; 2]> = match condition {
            Condition::Interior => {
                own.iter().zip(self.traction(e, 1, degree)).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect()
            }
            Condition::Traction(ends) => {
                let applied = applied(self.problem, e, *ends, degree);
                own.iter().zip(applied).map(|(t, p)| [t[0] - p[0], t[1] - p[1]]).collect()
            }
            Condition::Axis => own,
            Condition::Roller { direction: [x, y], .. } => {
                let across = |[a, b]: &[f64; 2]| {
                    let across = b * x - a * y;
                    [-across * y, across * x]
                };
                own.iter().map(across).collect()
            }
            Condition::Elastic { bed, pair, side } => {
                let bed = &self.problem.beds[*bed];
                self.on_springs(&bed.pairs[*pair], bed.stiffness, *side, own)
            }
            Condition::Clamped(_) | Condition::Contact { .. } => Vec::new(),
        };
        let worst = if matches!(condition, Condition::Traction(_)) { &mut found.applied } else { &mut found.jump };
        for (left, moment) in left.iter().zip(self.moments.of(e)) {
            *worst = worst.max(self.relative.of(norm(*left), e));
            found.work += norm(*left) * norm(*moment);
        }
    }

    /// Remainder on a side of a layer, both of whose sides carry the same, and of a traction along which there are no springs.
    fn on_springs(&self, pair: &BedPair, stiffness: [f64; 2], side: usize, own: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        if let (1, degree) = (side, own.len() - 1) {
            let first = self.traction(pair.edge, 0, degree).into_iter().rev();
            return own.iter().zip(first).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
        }
        let slack = || pair.axes.iter().zip(stiffness).filter(|(_, k)| *k == 0.0).map(|(axis, _)| axis);
        let left = |t: &[f64; 2]| {
            slack().fold([0.0; 2], |sum, [x, y]| {
                let along = t[0] * x + t[1] * y;
                [sum[0] + along * x, sum[1] + along * y]
            })
        };
        own.iter().map(left).collect()
    }

    /// Measures the remainder of t n̂ on both sides of a contact pair, with friction of t n̂ and the part along t̂, and the tension or excess of t over
    /// the bound of friction.
    fn pair(&self, pair: &ContactPair, found: &mut Equilibrium) {
        let Some(a) = pair.edges[0] else { return };
        let degree = self.moments.of(a).len() - 1;
        let along = Along::new(pair, degree);
        let t = along.multiplier(&along.of_pair(self.problem, 0, &self.traction(a, 0, degree)));
        let own = along.of_pair(self.problem, 0, self.moments.of(a));
        let opposite = pair.edges[1].map(|b| along.of_pair(self.problem, 1, self.moments.of(b)));
        for (side, e) in pair.edges.into_iter().enumerate().filter_map(|(side, e)| Some((side, e?))) {
            // What is left of the traction of each side where that of the first is taken away.
            let carried = along.of_pair(self.problem, side, &self.traction(e, 0, degree));
            let held = along.traction(&t, side);
            let moments = if side == 0 { Some(&own) } else { opposite.as_ref() };
            for (k, (carried, held)) in carried.iter().zip(held).enumerate() {
                let left = norm([carried[0] - held[0], carried[1] - held[1]]);
                let near = pair.edges.iter().flatten().map(|&e| self.relative.of(left, e));
                found.jump = found.jump.max(near.fold(f64::INFINITY, f64::min));
                found.work += left * moments.map_or(0.0, |m| norm(m[k]));
            }
        }
        let jumps = along.along(&own, opposite.as_deref(), pair.direction.shares);
        let (normal, tangential) = t.split_at(along.normal);
        let gaps = pair.gap_moments(along.normal - 1);
        for ((t, opening), gap) in normal.iter().zip(&jumps).zip(gaps) {
            found.tension = found.tension.max(self.relative.of(*t, a));
            found.work += t.max(0.0) * (opening + pair.length * gap);
        }
        let Some(friction) = pair.friction else { return };
        for ((t, jump), bound) in tangential.iter().zip(&jumps).zip(friction.coefficients(tangential.len() - 1)) {
            let over = (t.abs() - bound).max(0.0);
            found.tension = found.tension.max(self.relative.of(over, a));
            found.work += over * jump;
        }
    }
}

/// The largest resultant of boundary tractions and body force on any body, relative to the sum of their sizes.
fn largest_resultant(problem: &Problem, stress: &StressField, moments: &SideValues<[f64; 2]>, scales: &Scales) -> f64 {
    let mesh = &problem.mesh;
    let bodies = problem.scene.bodies.len();
    let (mut force, mut gross, mut rounding) = (vec![[0.0; 2]; bodies], vec![0.0; bodies], vec![0.0; bodies]);
    for (e, edge) in mesh.edges.iter().enumerate() {
        // Interior edges between two bonded bodies count for both.
        let [Some(first), second] = edge.triangles else { continue };
        if second.is_some_and(|second| mesh.body[second] == mesh.body[first]) {
            continue;
        }
        let (length, _) = mesh.edge_frame(e);
        for (side, at) in edge.triangles.into_iter().enumerate().filter_map(|(side, at)| Some((side, at?))) {
            let (body, coefficients) = (mesh.body[at], moments.of(e).len());
            let share = length / coefficients as f64;
            for t in stress.edge_traction(mesh, e, side, coefficients - 1) {
                (0..2).for_each(|c| force[body][c] += share * t[c]);
                gross[body] += share * norm(t);
            }
            rounding[body] +=
                length * problem.largest_weight(e) * scales.stress_round_off(problem, at, stress.degree(at));
        }
    }
    for t in 0..mesh.triangles.len() {
        let body = mesh.body[t];
        if problem.section().is_revolved() {
            // A radial force has no resultant.
            let [_, axial] = problem.section().forces(problem.body_force(t));
            let volume = problem.section().volume(mesh.corners(t));
            force[body][1] += axial * volume;
            gross[body] += problem.force_on(t).largest() * volume;
            continue;
        }
        let f = problem.force_on(t).of_area(mesh.area(t));
        let whole = f.resultant();
        (0..2).for_each(|c| force[body][c] += whole[c]);
        gross[body] += f.largest() * mesh.area(t);
    }
    if problem.section().is_revolved() {
        // A radial force has no resultant.
        force.iter_mut().for_each(|force| force[0] = 0.0);
    }
    // A body without load carries nothing but rounding errors, which are not to be compared with each other.
    let least = 1e-3 * gross.iter().copied().fold(0.0, f64::max);
    let of = |b: usize| match norm(force[b]) - rounding[b] {
        left if left > 0.0 => left / f64::max(gross[b], least),
        _ => 0.0,
    };
    (0..bodies).map(of).fold(0.0, f64::max)
}

/// The tractions that a contact pair carries: t n̂, and with friction t̂ times another.
struct Along<'a> {
    pair: &'a ContactPair,
    degree: usize,
    /// Number of coefficients along n̂; those along t̂ follow.
    normal: usize,
    /// The coefficients of n̂ and t̂ times polynomials, where they turn.
    turning: Option<DMatrix<f64>>,
}

impl<'a> Along<'a> {
    fn new(pair: &'a ContactPair, degree: usize) -> Self {
        let turning = (!pair.direction.is_constant()).then(|| columns_of_pair(pair, degree));
        Along { pair, degree, normal: pair.direction.columns(degree), turning }
    }

    /// The directions that traction is carried along.
    fn axes(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let tangent = self.pair.friction.map(|friction| friction.tangent.ends[0]);
        [Some(self.pair.direction.ends[0]), tangent].into_iter().flatten()
    }

    /// Values of the edge on side `side`, from end to end of the pair.
    fn of_pair(&self, problem: &Problem, side: usize, values: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let start = if side == 0 { self.pair.first } else { self.pair.second.unwrap_or(self.pair.first) }[0];
        let along = self.pair.edges[side].is_none_or(|e| problem.mesh.edges[e].vertices[0] == start);
        if along { values.to_vec() } else { values.iter().rev().copied().collect() }
    }

    /// The coefficients of t along n̂, then of that along t̂ where there is friction, from those of the traction of the first side.
    fn multiplier(&self, traction: &[[f64; 2]]) -> Vec<f64> {
        let share = self.pair.direction.shares[0];
        let Some(columns) = &self.turning else {
            let of = |n: [f64; 2]| traction.iter().map(move |t| (t[0] * n[0] + t[1] * n[1]) / share);
            return self.axes().flat_map(of).collect();
        };
        let traction = DMatrix::from_column_slice(2 * (self.degree + 1), 1, traction.as_flattened());
        let normal = columns.transpose() * columns;
        // Independent columns: the direction vanishes nowhere.
        let t = normal.lu().solve(&(columns.transpose() * traction));
        t.map_or_else(|| vec![0.0; columns.ncols()], |t| t.iter().map(|t| t / share).collect())
    }

    /// The coefficients of the traction that a side carries, per unit length of its edge.
    fn traction(&self, t: &[f64], side: usize) -> Vec<[f64; 2]> {
        let share = if side == 0 { self.pair.direction.shares[0] } else { -self.pair.direction.shares[1] };
        let Some(columns) = &self.turning else {
            let mut all = vec![[0.0; 2]; self.degree + 1];
            for (n, t) in self.axes().zip(t.chunks_exact(self.degree + 1)) {
                all.iter_mut().zip(t).for_each(|(all, t)| (0..2).for_each(|c| all[c] += share * t * n[c]));
            }
            return all;
        };
        let all = columns * DMatrix::from_column_slice(t.len(), 1, t) * share;
        all.as_slice().as_chunks::<2>().0.to_vec()
    }

    /// Bounds of the jump moments conjugate to t: of the part of the moments of both sides along n̂ where that is constant
    /// or turns.
    fn along(&self, own: &[[f64; 2]], opposite: Option<&[[f64; 2]]>, [c, d]: [f64; 2]) -> Vec<f64> {
        let difference = |k: usize| {
            let other = opposite.map_or([0.0; 2], |m| m[k]);
            norm([0, 1].map(|i| c * own[k][i] - d * other[i]))
        };
        let count = if self.turning.is_some() { self.degree } else { self.degree + 1 };
        (0..count)
            .map(|k| if self.turning.is_some() { difference(k) + difference(k + 1) } else { difference(k) })
            .collect()
    }
}

/// The coefficients of t on `pair`, from the traction t n̂ of its first side.
pub fn contact_traction(problem: &Problem, stress: &StressField, pair: &ContactPair) -> Vec<f64> {
    let [normal, _] = contact_tractions(problem, stress, pair);
    normal
}

/// Coefficients of the tractions along n̂ and along t̂, the latter empty without friction.
pub fn contact_tractions(problem: &Problem, stress: &StressField, pair: &ContactPair) -> [Vec<f64>; 2] {
    let Some(e) = pair.edges[0] else { return [Vec::new(), Vec::new()] };
    let degree = pair_degree(problem, stress, pair);
    let along = Along::new(pair, degree);
    let mut normal = along.multiplier(&along.of_pair(problem, 0, &stress.edge_traction(&problem.mesh, e, 0, degree)));
    let tangential = normal.split_off(along.normal);
    [normal, tangential]
}

/// The degree of the traction on a pair: the larger one of its sides.
pub fn pair_degree(problem: &Problem, stress: &StressField, pair: &ContactPair) -> usize {
    let of = |e: usize| problem.mesh.edges[e].triangles[0].map_or(1, |t| stress.degree(t));
    pair.edges.iter().flatten().map(|&e| of(e)).max().unwrap_or(1)
}

/// Stresses, relative to what prescribed displacements and gaps could cause, that are as good as none.
pub const LEAST_STRESS: f64 = 1e-3;

/// The largest applied traction: P on Γ_τ, or what a body force adds up to across its body; where nothing is applied
/// (prescribed displacements alone), the largest of the stresses that `stress` gives, or [`LEAST_STRESS`] where they
/// vanish.
pub fn load_scale(scales: &Scales, stress: impl FnOnce() -> StressField) -> f64 {
    if scales.traction > 0.0 {
        return scales.traction;
    }
    let stress = stress();
    let least = LEAST_STRESS * scales.data.stress;
    (0..stress.len()).fold(least, |m, t| m.max(largest(stress.block(t).as_flattened())))
}
