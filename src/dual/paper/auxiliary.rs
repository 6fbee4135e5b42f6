//! The auxiliary field λ̄ = λ⁽¹⁾ + λ⁽²⁾ of Section 3.
//!
//! λ⁽¹⁾ = (−F1 x1, −F2 x2, 0) solves (1.18), integrated about a point of each body; λ⁽²⁾ ∈ N_h(Ω) has the parameters
//! Ŝ of least norm that satisfy (3.16)–(3.19). The undetermined tractions on Γ_0 and Γ_u come out by themselves. Where
//! the reaction of the examples cannot be balanced (a constant reaction that leaves a moment), the least-norm choice
//! takes its place: by Remark 2.1 any equilibrated field will do.

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};

use super::constraints::{Constraints, Meaning, TractionShape};
use super::dependence::Dependence;
use super::reaction::Reaction;
use super::rows::SparseRows;
use crate::dual::DualError;
use crate::problem::Problem;

/// λ̄.
#[derive(Debug, Clone)]
pub struct Auxiliary {
    /// Origin of λ⁽¹⁾ in each body.
    pub origins: Vec<[f64; 2]>,
    /// F of each body.
    pub forces: Vec<[f64; 2]>,
    /// Parameters Ŝ of λ⁽²⁾.
    pub parameters: Vec<f64>,
    /// Choice of λ̄ on Γ_K.
    pub reaction: Reaction,
    /// T_n of λ̄ at the contact ends.
    pub normal_traction: Vec<f64>,
    /// D-rows of λ̄ minus their targets: zero but for the shear of Example 2 (and rounding).
    pub excess: Vec<f64>,
    /// Notes on the choice, for the reader of a report.
    pub notes: Vec<String>,
}

/// Work of the loads on a motion that nothing resists, relative to the sizes of both, that counts as none.
const BALANCED: f64 = 1e-9;

impl Auxiliary {
    /// Constructs λ̄ for `problem`; `dependences` are those of `constraints`.
    ///
    /// # Errors
    /// [`DualError::Infeasible`] where no field balances the loads, whatever the sign of T_n.
    pub fn new(problem: &Problem, constraints: &Constraints, dependences: &[Dependence]) -> Result<Self, DualError> {
        let mesh = &problem.mesh;
        let bodies = problem.scene.bodies.len();
        let forces: Vec<[f64; 2]> = problem.scene.bodies.iter().map(|b| b.body_force.given().value).collect();
        let mut origins = vec![[0.0; 2]; bodies];
        for t in (0..mesh.triangles.len()).rev() {
            origins[mesh.body[t]] = mesh.points[mesh.triangles[t][0]];
        }
        let first = |e: usize, side: usize| lambda_1_traction(problem, &origins, &forces, e, side);
        let (d1, e1) = constraints.evaluate(first);
        let d_rest: Vec<f64> = constraints.d_target.iter().zip(&d1).map(|(target, own)| target - own).collect();

        let mut notes = Vec::new();
        let mut reaction = Reaction::of(problem);
        let mut parameters = None;
        if let Some(normal) = reaction.normal() {
            let mut d = d_rest.clone();
            for (value, meaning) in d.iter_mut().zip(&constraints.d_meaning) {
                if matches!(meaning, Meaning::ContactShear { basis: TractionShape::Mean, .. }) {
                    *value += reaction.shear();
                }
            }
            let e: Vec<f64> = e1.iter().map(|own| normal - own).collect();
            let balanced = |dependence: &Dependence| {
                let [work, size] = dependence.work(&d, &e);
                work.abs() <= BALANCED * size
            };
            if dependences.iter().all(balanced) {
                d.extend(e);
                parameters = Some(least_norm(&constraints.d.stack(&constraints.e), &d)?);
            } else {
                notes.push(format!(
                    "the constant reaction of Example {} leaves a moment that nothing balances; the auxiliary field has \
                     the reaction of least norm instead",
                    reaction.example().unwrap_or(0)
                ));
                reaction = Reaction::Free;
            }
        }
        let parameters = match parameters {
            Some(x) => x,
            None => {
                balance(problem, constraints, dependences, &d_rest)?;
                least_norm(&constraints.d, &d_rest)?
            }
        };
        let excess = constraints.d.multiply(&parameters).iter().zip(&d_rest).map(|(own, rest)| own - rest).collect();
        let normal_traction = constraints.e.multiply(&parameters).iter().zip(&e1).map(|(a, b)| a + b).collect();
        Ok(Auxiliary { origins, forces, parameters, reaction, normal_traction, excess, notes })
    }

    /// λ⁽¹⁾ (xx, yy, xy) at a point of a body.
    pub fn lambda_1(&self, body: usize, point: [f64; 2]) -> [f64; 3] {
        lambda_1(self.origins[body], self.forces[body], point)
    }
}

fn lambda_1(origin: [f64; 2], force: [f64; 2], point: [f64; 2]) -> [f64; 3] {
    [-force[0] * (point[0] - origin[0]), -force[1] * (point[1] - origin[1]), 0.0]
}

/// Traction of λ⁽¹⁾ at the ends of an edge, as seen from one of its triangles.
fn lambda_1_traction(
    problem: &Problem,
    origins: &[[f64; 2]],
    forces: &[[f64; 2]],
    e: usize,
    side: usize,
) -> [[f64; 2]; 2] {
    let mesh = &problem.mesh;
    let edge = &mesh.edges[e];
    let Some(t) = edge.triangles[side] else { return [[0.0; 2]; 2] };
    let body = mesh.body[t];
    let (_, n) = mesh.edge_frame(e);
    let sign = if side == 0 { 1.0 } else { -1.0 };
    edge.vertices.map(|v| {
        let tau = lambda_1(origins[body], forces[body], mesh.points[v]);
        [sign * tau[0] * n[0], sign * tau[1] * n[1]]
    })
}

/// Least-norm x with B x = r, by x = Bᵀy and (BBᵀ + δ)-refinement: dependent rows do no harm as long as r respects them.
fn least_norm(b: &SparseRows, r: &[f64]) -> Result<Vec<f64>, DualError> {
    const SHIFT: f64 = 1e-10;
    const MOST_STEPS: usize = 60;
    let size = |v: &[f64]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut x = vec![0.0; b.columns()];
    let mut worst = size(r);
    if worst == 0.0 {
        return Ok(x);
    }
    let failed = |reason: String| DualError::Factorisation { reason };
    let mut triplets = Vec::new();
    for column in b.by_column() {
        for &(i, vi) in &column {
            triplets.extend(column.iter().filter(|(j, _)| *j <= i).map(|&(j, vj)| Triplet::new(i, j, vi * vj)));
        }
    }
    let diagonal = (0..b.len()).map(|i| b.row(i).map(|(_, v)| v * v).sum::<f64>()).fold(0.0, f64::max);
    triplets.extend((0..b.len()).map(|i| Triplet::new(i, i, SHIFT * diagonal)));
    let gram = SparseColMat::<usize, f64>::try_new_from_triplets(b.len(), b.len(), &triplets)
        .map_err(|e| failed(e.to_string()))?;
    let factor = gram.sp_cholesky(Side::Lower).map_err(|e| failed(format!("{e:?}")))?;
    let mut rest = r.to_vec();
    for _ in 0..MOST_STEPS {
        let mut y = faer::Col::from_fn(rest.len(), |i| rest[i]);
        factor.solve_in_place(y.as_mut());
        let mut trial = x.clone();
        b.add_transposed(&y.iter().copied().collect::<Vec<_>>(), &mut trial);
        let left: Vec<f64> = b.multiply(&trial).iter().zip(r).map(|(own, want)| want - own).collect();
        let now = size(&left);
        if now.is_nan() || now >= worst {
            break;
        }
        let done = now > 0.5 * worst;
        (x, rest, worst) = (trial, left, now);
        if done {
            break;
        }
    }
    Ok(x)
}

/// Refuses loads that do work on a motion which leaves the contact alone: no T_n can balance them.
fn balance(
    problem: &Problem,
    constraints: &Constraints,
    dependences: &[Dependence],
    load: &[f64],
) -> Result<(), DualError> {
    let mut z = vec![0.0; load.len()];
    let mut gained = 0.0;
    for dependence in dependences.iter().filter(|d| !d.involves_contact()) {
        let [work, size] = dependence.work(load, &[]);
        if work.abs() > BALANCED * size {
            gained += work * work;
            z.iter_mut().zip(&dependence.z_d).for_each(|(sum, own)| *sum += work * own);
        }
    }
    if gained == 0.0 {
        return Ok(());
    }
    Err(DualError::infeasible(problem, constraints.moments(problem, &z, &vec![0.0; constraints.e.len()]), gained))
}
