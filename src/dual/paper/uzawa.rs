//! Uzawa's iteration z ← P_Λ[z + ϱ(Bs + G)], As = −b − Bᵀz.
//!
//! It climbs the concave dual function of the multipliers z with steps ϱ, and converges for ϱ in (0, 2/‖BA⁻¹Bᵀ‖). The rows
//! of B are scaled by the square roots of the diagonal of BA⁻¹Bᵀ, which changes neither the set Λ nor the solution but
//! makes one ϱ fit triangles of all sizes and bodies of all stiffnesses. The number of plain steps grows like h⁻²; with
//! Nesterov's extrapolation, restarted when it points downhill, it grows like h⁻¹.

use std::time::Instant;

use super::program::Program;
use super::rows::SparseRows;
use crate::dual::equilibrium::{Equilibrium, LEAST_STRESS};
use crate::dual::methods::method::{contact_alone, plane_only};
use crate::dual::{DualError, DualMethod, Found, Motion, Options, Phases, Size};
use crate::element::SideValues;
use crate::element::polynomial::side;
use crate::problem::{ContactPair, Problem, Sizes};
use crate::process::stop_if_unwanted;

/// The paper's method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uzawa {
    /// ϱ for the scaled rows; from an estimate of ‖BA⁻¹Bᵀ‖ where it is not given.
    pub step_length: Option<f64>,
    /// Limit of iterations.
    pub most_iterations: usize,
    /// Violation of the constraints and duality product at which it stops, relative to the loads and the energy.
    pub tolerance: f64,
    /// Extrapolate between steps; without it the iteration is exactly that of Section 3.
    pub accelerate: bool,
}

impl Default for Uzawa {
    fn default() -> Self {
        Uzawa { step_length: None, most_iterations: 200_000, tolerance: 1e-7, accelerate: true }
    }
}

impl Uzawa {
    /// The iteration of Section 3 as it stands.
    pub fn plain() -> Self {
        Uzawa { accelerate: false, ..Self::default() }
    }
}

/// Bytes for each triangle: blocks with their matrices, rows, and what finds the dependences between them.
const EACH: f64 = 42_000.0;

/// Iterations between two looks at the residual.
const LOOK_EVERY: usize = 25;
/// Growth of the residual that is no longer a transient.
const DIVERGED: f64 = 1e6;

impl DualMethod for Uzawa {
    fn name(&self) -> &'static str {
        "uzawa"
    }

    fn accuracy(&self) -> f64 {
        // The stopping test weighs all rows together, the residual is the worst of them, where few rows carry the load.
        1000.0 * self.tolerance
    }

    fn memory(&self, size: Size) -> f64 {
        size.linear(EACH)
    }

    fn solve(&self, problem: &Problem, _motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        let start = Instant::now();
        expressible(problem, options, self.name())?;
        let program = Program::new(problem)?;
        let mut notes = notes(problem, &program);
        seconds.assemble = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let iteration = Iteration::new(&program);
        let norm = iteration.norm();
        let step = self.step_length.unwrap_or(if self.accelerate { 1.0 } else { 1.9 } / norm);
        notes.push(format!("uzawa: step length {step:.4e}, largest allowed {:.4e}", 2.0 / norm));
        let report = |k: usize, r: f64| {
            stop_if_unwanted();
            if let Some(progress) = &options.progress {
                progress(k, r);
            }
        };
        let end = iteration.run(self, step, program.traction_scale(problem), &report)?;
        seconds.contact = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let p1 = program.constraints.d.len();
        let stress = program.stress(problem, &end.s);
        let moments = moments(problem, &program, &end.z);
        let pairs: usize = problem.interfaces.iter().map(|interface| interface.pairs.len()).sum();
        let closed = end.z[p1..].iter().map(|&z| z == 0.0).collect();
        let closed = SideValues::new(vec![2; pairs], closed);
        // The stopping test sees rows that carry nothing among rows that carry much; what the stresses miss is the answer.
        let residual = Equilibrium::measure(problem, &stress, &moments).residual();
        if !residual.is_finite() || residual > self.accuracy() {
            return Err(DualError::NotConverged {
                method: self.name(),
                iterations: end.iterations,
                residual,
                wanted: self.accuracy(),
                advice: "the iteration settled beside equilibrium; use the condensed method".to_string(),
            });
        }
        seconds.recover = start.elapsed().as_secs_f64();
        Ok(Found {
            stress,
            moments,
            closed,
            unknowns: program.parameters(),
            iterations: end.iterations,
            seconds,
            notes,
            factorised: None,
            divided: None,
        })
    }
}

/// The rows (3.7) and (3.8) are those of normal tractions, linear on every pair of edges.
fn expressible(problem: &Problem, options: &Options, method: &'static str) -> Result<(), DualError> {
    plane_only(problem, method)?;
    if let Some(body) = problem.scene.bodies.iter().find(|body| !body.body_force.is_constant()) {
        return Err(DualError::NotExpressible {
            method,
            what: format!("the body force of {}, which is not constant", body.name),
            remedy: "use another method, whose stresses have degree 2 there",
        });
    }
    let degree = options.elements.largest_degree();
    if degree != 1 {
        return Err(DualError::NotExpressible {
            method,
            what: format!("stresses of degree {degree}"),
            remedy: "use another method, or --degree 1",
        });
    }
    contact_alone(problem, method)?;
    let normal = |pair: &ContactPair| pair.direction.is_constant() && pair.direction.ends[0] == pair.normal;
    let Some(interface) = problem.interfaces.iter().find(|i| !i.pairs.iter().all(normal)) else { return Ok(()) };
    Err(DualError::NotExpressible {
        method,
        what: format!("a direction of contact that is not the normal of each edge, as on {}", interface.name),
        remedy: "use another method, or write normals = \"facets\" for the contact of the facets themselves",
    })
}

/// Notes on the problem that the algorithm came upon.
fn notes(problem: &Problem, program: &Program) -> Vec<String> {
    let mut notes = program.auxiliary.notes.clone();
    let name = |bodies: &[usize]| {
        bodies.iter().map(|&b| problem.scene.bodies[b].name.as_str()).collect::<Vec<_>>().join(" and ")
    };
    for dependence in &program.dependences {
        let bodies = name(&dependence.bodies(problem));
        notes.push(if dependence.involves_contact() {
            format!(
                "the supports leave {bodies} a rigid motion that moves the contact: one dependent row in B, whose multiplier \
                 is bounded by the loads alone"
            )
        } else {
            format!(
                "the supports and contacts leave {bodies} a rigid motion: one superfluous row in D, whose multiplier stays \
                 zero"
            )
        });
    }
    notes
}

/// Edge moments from multipliers: those of the constraints, u0 on Γ_u, the gap where contact is closed.
fn moments(problem: &Problem, program: &Program, z: &[f64]) -> SideValues<[f64; 2]> {
    let p1 = program.constraints.d.len();
    // As + b = −Bᵀz, and the work of the edge displacement is +Σ m·T.
    let z_d: Vec<f64> = z[..p1].iter().map(|v| -v).collect();
    let z_e: Vec<f64> = z[p1..].iter().zip(&program.gap_moments).map(|(v, gap)| gap - v).collect();
    let mut moments = program.constraints.moments(problem, &z_d, &z_e);
    for (e, condition) in problem.conditions.iter().enumerate() {
        if let Some(ends) = condition.prescribed() {
            let given = side::linear_moments(ends, problem.mesh.edge_frame(e).0, 1);
            moments.of_mut(e).iter_mut().zip(given).for_each(|(m, of)| *m = [m[0] + of[0], m[1] + of[1]]);
        }
    }
    moments
}

/// The iteration in scaled rows B' = ΔB, G' = ΔG with multipliers z = Δz'.
#[derive(Debug)]
pub struct Iteration<'a> {
    program: &'a Program,
    rows: SparseRows,
    g: Vec<f64>,
    /// Δ: one over the square roots of the diagonal of BA⁻¹Bᵀ.
    pub row_scale: Vec<f64>,
}

/// Where an iteration arrived.
#[derive(Debug, Clone)]
pub struct Arrived {
    /// Parameters of τ.
    pub s: Vec<f64>,
    /// Multipliers of the rows of B, unscaled.
    pub z: Vec<f64>,
    /// Steps made.
    pub iterations: usize,
}

impl<'a> Iteration<'a> {
    /// Scales the rows of `program`.
    pub fn new(program: &'a Program) -> Self {
        let mut rows = program.rows.clone();
        let row_scale: Vec<f64> = (0..rows.len())
            .map(|i| {
                let entries: Vec<(usize, f64)> = rows.row(i).collect();
                let mut sum = 0.0;
                for &(j, vj) in &entries {
                    for &(k, vk) in entries.iter().filter(|(k, _)| k / 9 == j / 9) {
                        sum += vj * vk * program.blocks[j / 9].a_inverse[(j % 9, k % 9)];
                    }
                }
                if sum > 0.0 { 1.0 / sum.sqrt() } else { 1.0 }
            })
            .collect();
        rows.scale(&row_scale);
        let g = program.g.iter().zip(&row_scale).map(|(g, d)| g * d).collect();
        Iteration { program, rows, g, row_scale }
    }

    /// An upper estimate of ‖B'A⁻¹B'ᵀ‖: the largest Ritz value of forty Lanczos steps and its error bound.
    pub fn norm(&self) -> f64 {
        const STEPS: usize = 40;
        let n = self.rows.len();
        // Any start that no symmetry of the mesh makes orthogonal to the wanted vector.
        let mut v: Vec<f64> = (0..n).map(|i| ((i as f64 + 1.0) * 0.754_877_666).fract() - 0.5).collect();
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let length = norm(&v);
        v.iter_mut().for_each(|x| *x /= length);
        let mut previous = vec![0.0; n];
        let (mut alpha, mut beta) = (Vec::new(), Vec::new());
        for _ in 0..STEPS.min(n) {
            let mut w = self.rows.multiply(&self.program.solve_a(&self.rows.transposed_multiply(&v)));
            let a: f64 = w.iter().zip(&v).map(|(x, y)| x * y).sum();
            let b = beta.last().copied().unwrap_or(0.0);
            for i in 0..n {
                w[i] -= a * v[i] + b * previous[i];
            }
            alpha.push(a);
            let length = norm(&w);
            beta.push(length);
            if length <= 1e-12 * a {
                break;
            }
            w.iter_mut().for_each(|x| *x /= length);
            previous = std::mem::replace(&mut v, w);
        }
        let m = alpha.len();
        let tridiagonal = nalgebra::DMatrix::from_fn(m, m, |i, j| match i.abs_diff(j) {
            0 => alpha[i],
            1 => beta[i.min(j)],
            _ => 0.0,
        });
        let eigen = tridiagonal.symmetric_eigen();
        let top = eigen.eigenvalues.imax();
        eigen.eigenvalues[top] + beta[m - 1] * eigen.eigenvectors[(m - 1, top)].abs()
    }

    /// s(z) = −A⁻¹(b + B'ᵀz).
    fn minimiser(&self, z: &[f64]) -> Vec<f64> {
        let mut r = self.program.b.clone();
        self.rows.add_transposed(z, &mut r);
        let mut s = self.program.solve_a(&r);
        s.iter_mut().for_each(|v| *v = -*v);
        s
    }

    /// Iterates from z = 0 until the constraints hold to `method.tolerance` relative to `scale`.
    ///
    /// # Errors
    /// [`DualError::NotConverged`] at the limit of iterations, and as soon as the residual grows without bound.
    pub fn run(
        &self,
        method: &Uzawa,
        step: f64,
        scale: f64,
        progress: &dyn Fn(usize, f64),
    ) -> Result<Arrived, DualError> {
        let p1 = self.program.constraints.d.len();
        let n = self.rows.len();
        let mut z = vec![0.0; n];
        let mut y = z.clone();
        let mut momentum = 1.0_f64;
        let mut r = vec![0.0; n];
        let (mut best, mut residual) = (f64::INFINITY, f64::INFINITY);
        for k in 0..=method.most_iterations {
            let s = self.minimiser(&y);
            self.rows.multiply_into(&s, &mut r);
            r.iter_mut().zip(&self.g).for_each(|(r, g)| *r += g);
            if k % LOOK_EVERY == 0 || k == method.most_iterations {
                residual = self.residual(&s, &y, &r, p1, scale);
                progress(k, residual);
                if residual <= method.tolerance {
                    let z = y.iter().zip(&self.row_scale).map(|(z, d)| z * d).collect();
                    return Ok(Arrived { s, z, iterations: k });
                }
                best = best.min(residual);
                if !residual.is_finite() || residual > DIVERGED * best {
                    return Err(self.stopped(method, k, residual, step));
                }
            }
            let mut next: Vec<f64> = y.iter().zip(&r).map(|(y, r)| y + step * r).collect();
            next[p1..].iter_mut().for_each(|z| *z = z.max(0.0));
            if method.accelerate {
                let uphill: f64 = r.iter().zip(next.iter().zip(&z)).map(|(r, (new, old))| r * (new - old)).sum();
                if uphill < 0.0 {
                    momentum = 1.0;
                }
                let grown = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
                let factor = (momentum - 1.0) / grown;
                momentum = grown;
                y = next.iter().zip(&z).map(|(new, old)| new + factor * (new - old)).collect();
                y[p1..].iter_mut().for_each(|z| *z = z.max(0.0));
            } else {
                y.copy_from_slice(&next);
            }
            z = next;
        }
        Err(self.stopped(method, method.most_iterations, residual, step))
    }

    /// The larger of: violation of a constraint relative to `scale`; zᵀ(Bs + G), which is what J(s) is off the dual
    /// value, relative to the energy.
    fn residual(&self, s: &[f64], z: &[f64], r: &[f64], p1: usize, scale: f64) -> f64 {
        let mut violation = 0.0_f64;
        for (i, (r, d)) in r.iter().zip(&self.row_scale).enumerate() {
            let own = r / d;
            violation = violation.max(if i < p1 { own.abs() } else { own });
        }
        let work: f64 = z.iter().zip(r).map(|(z, r)| (z * r).abs()).sum();
        let total: Vec<f64> = s.iter().zip(&self.program.auxiliary.parameters).map(|(a, b)| a + b).collect();
        let energy: f64 = 0.5 * self.program.multiply_a(&total).iter().zip(&total).map(|(a, s)| a * s).sum::<f64>();
        let relative = |x: f64, size: f64| if size > 0.0 { x / size } else { x };
        // Without loads the stresses themselves are the measure, or, where they vanish, those that the prescribed
        // displacements and gaps could cause.
        let least = match &self.program.scales {
            scales if scales.traction > 0.0 => Sizes::default(),
            scales => scales.data,
        };
        let largest = total.iter().fold(LEAST_STRESS * least.stress, |m: f64, v| m.max(v.abs()));
        relative(violation, scale.max(largest)).max(relative(work, energy.max(LEAST_STRESS * least.energy)))
    }

    fn stopped(&self, method: &Uzawa, iterations: usize, residual: f64, step: f64) -> DualError {
        let limit = 2.0 / self.norm();
        let advice = if step >= limit {
            format!("the step length {step:.4e} is not below {limit:.4e}, choose a smaller one")
        } else {
            "raise the limit of iterations, coarsen the mesh, or use the condensed method".to_string()
        };
        DualError::NotConverged { method: "uzawa", iterations, residual, wanted: method.tolerance, advice }
    }
}
