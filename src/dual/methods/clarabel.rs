//! The quadratic program (3.15) by an interior-point method (Clarabel).
//!
//! The unknowns are the parameters S of the energy-orthonormal modes, so that A = I:
//!
//! minimise ½|S|² + qᵀS subject to traction balance on every free edge moment, T_n ≤ 0 at every contact end.
//!
//! The rows are those of the hybrid form; their multipliers are the edge moments. Rows are scaled to length one and the
//! data to size one, so that the units of the scene do not reach the solver. Dependent rows (rigid motions that
//! nothing resists) are left in; the solver's regularisation bears them.

use std::time::Instant;

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};

use super::method::{contact_alone, plane_only};
use crate::dual::equilibrium::Equilibrium;
use crate::dual::hybrid::{Motion, parameters, residual};
use crate::dual::system::System;
use crate::dual::system::rows::Sides;
use crate::dual::{DualError, DualMethod, Found, Options, Phases, Size};
use crate::problem::{Problem, Scales};

/// Interior point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clarabel {
    /// Duality gap and infeasibility at which it stops, relative to data of size one.
    pub tolerance: f64,
    /// Limit of iterations.
    pub most_iterations: u32,
}

/// Bytes for each triangle: rows, iterates, and the system of optimality with its factor.
const EACH: f64 = 18_000.0;

impl Default for Clarabel {
    fn default() -> Self {
        Clarabel { tolerance: 1e-11, most_iterations: 200 }
    }
}

/// Moments this many times what the data can cause have no meaning.
const BEYOND_MEASURE: f64 = 1e6;

impl DualMethod for Clarabel {
    fn name(&self) -> &'static str {
        "clarabel"
    }

    fn accuracy(&self) -> f64 {
        // An interior point comes near equilibrium and is not refined on the stresses. What it leaves is taken off the
        // lower bound.
        1e-6
    }

    fn memory(&self, size: Size) -> f64 {
        // The factor of the system of optimality grows like that of the condensed method.
        size.linear(EACH) + size.factorised(0)
    }

    fn solve(&self, problem: &Problem, _motions: &[Motion], options: &Options) -> Result<Found, DualError> {
        let mut seconds = Phases::default();
        plane_only(problem, self.name())?;
        let start = Instant::now();
        contact_alone(problem, self.name())?;
        let system = System::new(problem, options);
        let program = ConicProgram::new(problem, &system);
        seconds.assemble = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let n = program.q.len();
        let first_jump = system.unknowns.first_jump;
        let cones = [ZeroConeT(first_jump), NonnegativeConeT(system.unknowns.count - first_jump)];
        let settings = self.settings(options);
        let setup = |text: String| DualError::Factorisation { reason: text };
        let mut solver =
            DefaultSolver::new(&CscMatrix::identity(n), &program.q, &program.rows, &program.b, &cones, settings)
                .map_err(|e| setup(e.to_string()))?;
        solver.solve();
        seconds.contact = start.elapsed().as_secs_f64();

        let start = Instant::now();
        let solution = &solver.solution;
        let iterations = solution.iterations as usize;
        match solution.status {
            SolverStatus::Solved => {}
            SolverStatus::PrimalInfeasible => return Err(program.certificate(problem, &system, &solution.z)),
            status => {
                return Err(DualError::NotConverged {
                    method: self.name(),
                    iterations,
                    residual: solution.r_prim.max(solution.r_dual),
                    wanted: self.tolerance,
                    advice: format!("the interior-point method ended as {status}; use the condensed method"),
                });
            }
        }
        if let Some(progress) = &options.progress {
            progress(iterations, solution.r_prim.max(solution.r_dual));
        }
        let s: Vec<f64> = solution.x.iter().map(|v| v * program.size).collect();
        // The stationary point has S + q + Gᵀz = 0: moments are −z, jumps ∫ g q − z.
        let mut x: Vec<f64> = solution.z.iter().zip(&program.row_scale).map(|(z, d)| -z * d * program.size).collect();
        x[first_jump..].iter_mut().zip(&system.jump_bound).for_each(|(j, bound)| *j += bound);
        // Displacements that nothing resists may come out as any number, and those beyond measure are as good as none.
        let longest = (0..problem.mesh.edges.len()).fold(0.0_f64, |m, e| m.max(problem.mesh.edge_frame(e).0));
        let beyond = BEYOND_MEASURE * longest * Scales::new(problem).data.displacement;
        x.iter_mut().filter(|m| !m.is_finite() || m.abs() > beyond).for_each(|m| *m = 0.0);
        let contact = solution.s[first_jump..].iter().zip(&solution.z[first_jump..]);
        let closed = system.unknowns.by_pair(contact.map(|(s, z)| s >= z).collect());
        let stress = system.modes.stresses(problem, &s);
        let moments = system.unknowns.moments(&x);
        // The stopping test sees the largest row; what the stresses miss is the answer.
        let residual = Equilibrium::measure(problem, &stress, &moments).residual();
        if !residual.is_finite() || residual > self.accuracy() {
            return Err(DualError::NotConverged {
                method: self.name(),
                iterations,
                residual,
                wanted: self.accuracy(),
                advice: "the interior point came to rest beside equilibrium; use the condensed method".to_string(),
            });
        }
        seconds.recover = start.elapsed().as_secs_f64();
        Ok(Found {
            stress,
            moments,
            closed,
            unknowns: n,
            iterations,
            seconds,
            notes: Vec::new(),
            factorised: None,
            divided: None,
        })
    }
}

impl Clarabel {
    fn settings(&self, options: &Options) -> DefaultSettings<f64> {
        DefaultSettings {
            max_iter: self.most_iterations,
            verbose: false,
            tol_gap_abs: self.tolerance,
            tol_gap_rel: self.tolerance,
            tol_feas: self.tolerance,
            tol_infeas_abs: self.tolerance,
            tol_infeas_rel: self.tolerance,
            max_threads: options.threads as u32,
            // Rows and objective have unit size already.
            equilibrate_enable: false,
            ..DefaultSettings::default()
        }
    }
}

/// minimise ½|x|² + qᵀx, rows x + s = b, with s = 0 on free moments and s ≥ 0 on jumps.
struct ConicProgram {
    rows: CscMatrix<f64>,
    q: Vec<f64>,
    b: Vec<f64>,
    /// Factor of each row.
    row_scale: Vec<f64>,
    /// Size of the data: parameters are x times this.
    size: f64,
}

impl ConicProgram {
    fn new(problem: &Problem, system: &System) -> Self {
        let mesh = &problem.mesh;
        let count = system.unknowns.count;
        let columns = system.modes.parameters();
        let mut entries: Vec<Vec<(usize, f64)>> = vec![Vec::new(); columns];
        for t in 0..mesh.triangles.len() {
            let modes = system.modes.of(t);
            let sides = Sides::new(mesh, &system.unknowns, t, system.modes.degree(t));
            let mut raised = vec![0.0; sides.len() * modes.parameters()];
            for (out, mode) in raised.chunks_exact_mut(sides.len()).zip(modes.tractions()) {
                sides.raise(mode, out);
            }
            for (at, components) in sides.rows(&system.unknowns) {
                for component in components {
                    let [dx, dy] = component.direction;
                    for &(dof, c) in component.terms() {
                        let own = &mut entries[system.modes.parameters_of(t)];
                        for (column, mode) in own.iter_mut().zip(raised.chunks_exact(sides.len())) {
                            column.push((dof, c * (dx * mode[at] + dy * mode[at + 1])));
                        }
                    }
                }
            }
        }
        // All coefficients of an edge contribute to the same row where the direction of contact turns.
        for column in &mut entries {
            column.sort_unstable_by_key(|entry| entry.0);
            column.dedup_by(|next, kept| {
                let same = next.0 == kept.0;
                kept.1 += if same { next.1 } else { 0.0 };
                same
            });
        }
        let mut squares = vec![0.0; count];
        for &(dof, v) in entries.iter().flatten() {
            squares[dof] += v * v;
        }
        let row_scale: Vec<f64> = squares.iter().map(|&s: &f64| if s > 0.0 { 1.0 / s.sqrt() } else { 1.0 }).collect();

        // −q: the answer to u0 on Γ_u and to contact closed at the gap.
        let mut closed = vec![0.0; count];
        closed[system.unknowns.first_jump..].copy_from_slice(&system.jump_bound);
        let mut q = parameters(problem, system, &closed, true);
        q.iter_mut().for_each(|v| *v = -*v);
        let mut b = residual(problem, system, &vec![0.0; columns]);
        b.iter_mut().zip(&row_scale).for_each(|(b, d)| *b *= d);
        // Stresses are of the size of the loads, or of the prescribed displacements where there are none. A wide gap
        // makes q large at ends that never close and says nothing about the stresses.
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let size = [largest(&b), largest(&q)].into_iter().find(|&s| s > 0.0).unwrap_or(0.0);
        // Without any data the size stays zero, and makes the solution exactly that.
        if size > 0.0 {
            q.iter_mut().chain(&mut b).for_each(|v| *v /= size);
        }

        let (mut starts, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in &entries {
            for &(dof, v) in column {
                indices.push(dof);
                values.push(v * row_scale[dof]);
            }
            starts.push(indices.len());
        }
        ConicProgram { rows: CscMatrix::new(count, columns, starts, indices, values), q, b, row_scale, size }
    }

    /// The certificate z with Gᵀz = 0 and bᵀz < 0 is a motion −z on which the loads do the work −bᵀz.
    fn certificate(&self, problem: &Problem, system: &System, z: &[f64]) -> DualError {
        let x: Vec<f64> = z.iter().zip(&self.row_scale).map(|(z, d)| -z * d).collect();
        let work: f64 = -self.b.iter().zip(z).map(|(b, z)| b * z).sum::<f64>() * self.size;
        // Moments of u0 are no part of the motion.
        let mut motion = system.unknowns.moments(&x);
        let given = system.unknowns.moments(&vec![0.0; x.len()]);
        let values = motion.values_mut().as_flattened_mut().iter_mut();
        values.zip(given.values().as_flattened()).for_each(|(m, g)| *m -= g);
        DualError::infeasible(problem, motion, work)
    }
}
