//! The quadratic program (3.15): minimise ½ŜᵀAŜ + bᵀŜ subject to DŜ = 0, EŜ ≤ −g.

use super::auxiliary::Auxiliary;
use super::block::BlockMatrices;
use super::constraints::Constraints;
use super::dependence::{Dependence, dependences};
use super::rows::SparseRows;
use crate::dual::DualError;
use crate::element::StressField;
use crate::element::contraction;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::subtriangle::Matrix;
use crate::problem::{Problem, Scales};

/// The parts of a block that are kept once Q has been found.
#[derive(Debug, Clone)]
pub struct CompensatedBlock {
    /// Q_1, 21 × 9.
    pub q1: Matrix<21, 9>,
    /// Q_1ᵀ F Q_1.
    pub a: Matrix<9, 9>,
    /// Its inverse.
    pub a_inverse: Matrix<9, 9>,
    /// Centroid.
    pub centre: [f64; 2],
    /// √area.
    pub scale: f64,
}

/// The program in the parameters Ŝ of τ = λ − λ̄, nine per triangle.
#[derive(Debug, Clone)]
pub struct Program {
    /// The blocks; A is block diagonal with their `a`.
    pub blocks: Vec<CompensatedBlock>,
    /// D and E with their meaning.
    pub constraints: Constraints,
    /// Dependences between their rows.
    pub dependences: Vec<Dependence>,
    /// λ̄.
    pub auxiliary: Auxiliary,
    /// b = b(λ̄) less the work of the traction on u0 and on the gap g.
    pub b: Vec<f64>,
    /// B: the rows of D, then those of E.
    pub rows: SparseRows,
    /// G, so that the constraints read Bs + G = 0 for the rows of D and ≤ 0 for those of E.
    pub g: Vec<f64>,
    /// The sizes that the data stand for.
    pub scales: Scales,
    /// ∫ g q ds at the contact ends: the jump of displacement where contact closes.
    pub gap_moments: Vec<f64>,
}

impl Program {
    /// Sets up the program of `problem`.
    ///
    /// # Errors
    /// [`DualError`] where λ̄ cannot be found.
    pub fn new(problem: &Problem) -> Result<Self, DualError> {
        let mesh = &problem.mesh;
        let materials = problem.materials();
        let mut blocks = Vec::with_capacity(mesh.triangles.len());
        let mut external = Vec::with_capacity(mesh.triangles.len());
        for t in 0..mesh.triangles.len() {
            let block = BlockMatrices::new(mesh.corners(t), &materials[mesh.body[t]]);
            let a = block.condensed();
            let a_inverse = a.cholesky().map(|c| c.inverse()).ok_or_else(|| DualError::Factorisation {
                reason: format!("the flexibility of triangle {t} is not positive definite"),
            })?;
            external.push(block.external());
            blocks.push(CompensatedBlock { q1: block.q1(), a, a_inverse, centre: block.centre, scale: block.scale });
        }
        let constraints = Constraints::new(problem, &external);
        let dependences = dependences(problem, &constraints);
        let auxiliary = Auxiliary::new(problem, &constraints, &dependences)?;
        let rows = constraints.d.stack(&constraints.e);
        let mut g = auxiliary.excess.clone();
        g.extend(&auxiliary.normal_traction);
        let gap_moments =
            problem.pairs().flat_map(|p| p.gap_moments(1).into_iter().map(|moment| p.length * moment)).collect();
        let scales = Scales::new(problem);
        let b = Vec::new();
        let mut program = Program { blocks, constraints, dependences, auxiliary, b, rows, g, scales, gap_moments };
        program.b = program.linear_term(problem, &external);
        Ok(program)
    }

    /// b: ∫ a τ:λ̄ + ∫ τ:ε0 − ∫_{Γu} T(τ)·u0 − ∫_{ΓK} T_n(τ) g.
    fn linear_term(&self, problem: &Problem, external: &[Matrix<12, 9>]) -> Vec<f64> {
        let mesh = &problem.mesh;
        let materials = problem.materials();
        let mut b = self.multiply_a(&self.auxiliary.parameters);
        for (t, block) in self.blocks.iter().enumerate() {
            let body = mesh.body[t];
            if self.auxiliary.forces[body] == [0.0, 0.0] {
                continue;
            }
            // (3.3) for λ⁽¹⁾; the integrand is quadratic.
            let corners = mesh.corners(t);
            for sub in 0..3 {
                let q = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], block.centre];
                for (bary, weight) in triangle_rule(2) {
                    let x = [0, 1].map(|c| bary[0] * q[0][c] + bary[1] * q[1][c] + bary[2] * q[2][c]);
                    let fixed = self.auxiliary.lambda_1(body, x);
                    let modes = block.stress_modes(sub, x);
                    let factor = weight * block.scale * block.scale / 3.0;
                    for k in 0..9 {
                        let own = [modes[(0, k)], modes[(1, k)], modes[(2, k)]];
                        b[9 * t + k] += factor * materials[body].product(own, fixed);
                    }
                }
            }
        }
        self.add_initial(problem, &mut b);
        for (e, condition) in problem.conditions.iter().enumerate() {
            let (Some(ends), Some(t)) = (condition.prescribed(), mesh.edges[e].triangles[0]) else { continue };
            let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
            let (length, _) = mesh.edge_frame(e);
            for k in 0..9 {
                // T = mean + p slope and u0 = middle + p half, p from −1 to 1.
                let work = (0..2).map(|c| {
                    let [middle, half] = [0.5 * (ends[0][c] + ends[1][c]), 0.5 * (ends[1][c] - ends[0][c])];
                    external[t][(4 * sub + 2 * c, k)] * middle + external[t][(4 * sub + 2 * c + 1, k)] * half / 3.0
                });
                b[9 * t + k] -= length * work.sum::<f64>();
            }
        }
        let gap: Vec<f64> = self.gap_moments.iter().map(|m| -m).collect();
        self.constraints.e.add_transposed(&gap, &mut b);
        b
    }

    /// Adds ∫ τ:ε0.
    fn add_initial(&self, problem: &Problem, b: &mut [f64]) {
        let mesh = &problem.mesh;
        let materials = problem.materials();
        for (t, block) in self.blocks.iter().enumerate() {
            let initial = materials[mesh.body[t]].initial();
            if initial.is_none() {
                continue;
            }
            let corners = mesh.corners(t);
            let factor = block.scale * block.scale / 3.0;
            for sub in 0..3 {
                let q = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], block.centre];
                for (bary, weight) in triangle_rule(2) {
                    let x = [0, 1].map(|c| bary[0] * q[0][c] + bary[1] * q[1][c] + bary[2] * q[2][c]);
                    let (modes, strain) = (block.stress_modes(sub, x), initial.at(x));
                    for k in 0..9 {
                        let own = [modes[(0, k)], modes[(1, k)], modes[(2, k)]];
                        b[9 * t + k] += factor * weight * contraction(own, strain);
                    }
                }
            }
        }
    }

    /// N, the number of parameters.
    pub fn parameters(&self) -> usize {
        9 * self.blocks.len()
    }

    /// A s.
    pub fn multiply_a(&self, s: &[f64]) -> Vec<f64> {
        self.blockwise(s, |block| &block.a)
    }

    /// A⁻¹ r.
    pub fn solve_a(&self, r: &[f64]) -> Vec<f64> {
        self.blockwise(r, |block| &block.a_inverse)
    }

    fn blockwise(&self, v: &[f64], matrix: impl Fn(&CompensatedBlock) -> &Matrix<9, 9>) -> Vec<f64> {
        let mut out = vec![0.0; v.len()];
        for ((block, x), y) in self.blocks.iter().zip(v.chunks_exact(9)).zip(out.chunks_exact_mut(9)) {
            let m = matrix(block).as_slice();
            for (column, &xk) in m.chunks_exact(9).zip(x) {
                for (value, c) in y.iter_mut().zip(column) {
                    *value += c * xk;
                }
            }
        }
        out
    }

    /// J(s) = ½ sᵀAs + bᵀs of (3.15).
    pub fn functional(&self, s: &[f64]) -> f64 {
        let a = self.multiply_a(s);
        s.iter().zip(&a).zip(&self.b).map(|((s, a), b)| s * (0.5 * a + b)).sum()
    }

    /// The stress λ̄ + τ with the parameters `s` of τ.
    pub fn stress(&self, problem: &Problem, s: &[f64]) -> StressField {
        let mesh = &problem.mesh;
        let mut field = StressField::zeros(1, mesh.triangles.len());
        for (t, block) in self.blocks.iter().enumerate() {
            let own = Matrix::<9, 1>::from_fn(|k, _| s[9 * t + k] + self.auxiliary.parameters[9 * t + k]);
            let corners = mesh.corners(t);
            for sub in 0..3 {
                for (node, point) in
                    [corners[(sub + 1) % 3], corners[(sub + 2) % 3], block.centre].into_iter().enumerate()
                {
                    let tau = block.stress_modes(sub, point) * own;
                    let fixed = self.auxiliary.lambda_1(mesh.body[t], point);
                    field.block_mut(t)[3 * sub + node] = [0, 1, 2].map(|c| tau[c] + fixed[c]);
                }
            }
        }
        field
    }

    /// The largest of the loads that tractions are compared with: P, λ̄ on the edges; one where there is none.
    pub fn traction_scale(&self, problem: &Problem) -> f64 {
        let bar = self.stress(problem, &vec![0.0; self.parameters()]);
        let mut scale = 0.0_f64;
        for e in 0..problem.mesh.edges.len() {
            for value in bar.edge_traction(&problem.mesh, e, 0, 1).as_flattened() {
                scale = scale.max(value.abs());
            }
        }
        scale
    }
}

impl CompensatedBlock {
    /// Stresses (xx, yy, xy) of the nine fields at a point of subtriangle `sub`, 3 × 9.
    pub fn stress_modes(&self, sub: usize, point: [f64; 2]) -> Matrix<3, 9> {
        let x = [0, 1].map(|c| (point[c] - self.centre[c]) / self.scale);
        crate::element::subtriangle::stress_map(x) * self.q1.fixed_view::<7, 9>(7 * sub, 0)
    }
}
