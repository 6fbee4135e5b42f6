//! The least change, in energy, that takes a displacement out of what it penetrates.
//!
//! Moving the nodes of a contact alone strains the triangles there by the penetration over their size, and costs energy that grows
//! without bound as meshes become finer. The change d of least energy ½a(d, d) that supports allow, with b_r(d) = −b_r(v) on the
//! coefficients b_r of the jump that v takes above the gap, costs what the penetration is worth. It is found with multipliers
//! of its own for these rows, added to the stiffness as a penalty so that bodies which contact alone holds are held.

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Col, Side};

use super::holds::{Hold, Holds};
use super::nodes::{NodalValues, Nodes};
use super::rows::{Row, bernstein, rows};
use crate::element::geometry::{gradients, shape_gradients};
use crate::problem::Problem;

/// The penalty beside the largest diagonal entry of the stiffness.
const PENALTY: f64 = 1e4;
/// Stiffness against motions that nothing else holds, relative to each diagonal entry.
const SLIGHT: f64 = 1e-10;
/// Steps of the multipliers, and rounds of rows that join because the change itself violates them.
const STEPS: usize = 4;
const ROUNDS: usize = 6;
/// Above so many nodes the change is not looked for.
const MOST_NODES: usize = 400_000;

/// The changed field of degree 1 or 2, to which the change belongs too; `None` where nothing penetrates or the change cannot be
/// computed. Values at edge midpoints are those of a quadratic field, a linear one has none of its own.
pub fn lifted(
    problem: &Problem,
    holds: &Holds,
    vertex: &[[f64; 2]],
    middle: &[[f64; 2]],
    degree: usize,
) -> Option<NodalValues> {
    let vertices = vertex.len();
    let quadratic = degree > 1;
    let linear = Nodes::new(vertices, std::iter::repeat_n(1, problem.mesh.edges.len()));
    let mut values: Vec<[f64; 2]> = vertex.iter().chain(middle.iter().filter(|_| quadratic)).copied().collect();
    if values.len() > MOST_NODES || values.iter().flatten().any(|x| !x.is_finite()) {
        return None;
    }
    let middles = (0..holds.edges.len()).map(|e| holds.middle(e));
    for (value, hold) in values.iter_mut().zip(holds.vertices.iter().copied().chain(middles)) {
        *value = hold.impose(*value);
    }
    let rows: Vec<Row> = match quadratic {
        true => problem.pairs().flat_map(|pair| bernstein(pair, vertices)).collect(),
        false => rows(problem, &linear).concat(),
    };
    let model = Elastic::new(problem, holds, quadratic);
    let size = values.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    let enough = 16.0 * f64::EPSILON * size;
    let mut active: Vec<usize> = Vec::new();
    let mut lifted = None;
    for _ in 0..ROUNDS {
        let now = lifted.as_ref().unwrap_or(&values);
        let violated: Vec<usize> =
            (0..rows.len()).filter(|r| !active.contains(r) && rows[*r].excess(now) > enough).collect();
        if violated.is_empty() {
            break;
        }
        active.extend(violated);
        lifted = Some(model.change(&rows, &active, &values)?);
    }
    let mut lifted = lifted?;
    if !quadratic {
        return Some(NodalValues { nodes: linear, values: lifted });
    }
    let middle = lifted.split_off(vertices);
    Some(NodalValues::quadratic(&problem.mesh, &lifted, &middle))
}

/// The stiffness of linear or quadratic displacements in the directions that supports leave free.
struct Elastic {
    quadratic: bool,
    /// First unknown of every node, and the directions of its unknowns.
    free: Vec<(usize, Vec<[f64; 2]>)>,
    count: usize,
    entries: Vec<Triplet<usize, usize, f64>>,
    largest: f64,
}

impl Elastic {
    fn new(problem: &Problem, holds: &Holds, quadratic: bool) -> Self {
        let mut count = 0;
        let directions = |hold: &Hold| match *hold {
            Hold::Free => vec![[1.0, 0.0], [0.0, 1.0]],
            Hold::Line { normal: [x, y], .. } => vec![[-y, x]],
            Hold::Fixed(_) => Vec::new(),
        };
        let free = holds
            .vertices
            .iter()
            .chain(holds.edges.iter().map(|[first, _]| first).filter(|_| quadratic))
            .map(|hold| {
                let own = directions(hold);
                count += own.len();
                (count - own.len(), own)
            })
            .collect();
        let mut model = Elastic { quadratic, free, count, entries: Vec::new(), largest: 0.0 };
        model.assemble(problem);
        model
    }

    fn assemble(&mut self, problem: &Problem) {
        let mesh = &problem.mesh;
        let materials = problem.materials();
        let mut diagonal = vec![0.0; self.count];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            let material = &materials[mesh.body[t]];
            let g = gradients(mesh.corners(t));
            let middles = mesh.triangle_edges[t].map(|e| mesh.points.len() + e);
            let nodes: Vec<usize> =
                corners.iter().copied().chain(middles.into_iter().filter(|_| self.quadratic)).collect();
            let weight = mesh.area(t) / 3.0;
            let unknowns: Vec<(usize, usize, [f64; 2])> = nodes
                .iter()
                .enumerate()
                .flat_map(|(a, n)| {
                    let (first, directions) = &self.free[*n];
                    directions.iter().enumerate().map(move |(i, d)| (a, first + i, *d))
                })
                .collect();
            let mut local = vec![0.0; unknowns.len() * unknowns.len()];
            for at in 0..3 {
                let shape = if self.quadratic { shape_gradients(&g, at).to_vec() } else { g.to_vec() };
                let strain = |a: usize, d: [f64; 2]| {
                    let s = shape[a];
                    [s[0] * d[0], s[1] * d[1], 0.5 * (s[1] * d[0] + s[0] * d[1])]
                };
                let strains: Vec<[f64; 3]> = unknowns.iter().map(|(a, _, d)| strain(*a, *d)).collect();
                for (i, e) in strains.iter().enumerate() {
                    for (j, d) in strains.iter().enumerate() {
                        local[i * unknowns.len() + j] += weight * material.strain_product(*e, *d);
                    }
                }
            }
            for (i, (_, p, _)) in unknowns.iter().enumerate() {
                diagonal[*p] += local[i * unknowns.len() + i];
                for (j, (_, q, _)) in unknowns.iter().enumerate().filter(|(_, (_, q, _))| q <= p) {
                    self.entries.push(Triplet::new(*p, *q, local[i * unknowns.len() + j]));
                }
            }
        }
        self.largest = diagonal.iter().copied().fold(0.0, f64::max);
        self.entries.extend(diagonal.iter().enumerate().map(|(p, k)| Triplet::new(p, p, SLIGHT * k)));
    }

    /// `values` with the least change that brings the `active` rows to their bounds.
    fn change(&self, rows: &[Row], active: &[usize], values: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
        let in_unknowns = |row: &Row| {
            let mut terms: Vec<(usize, f64)> = Vec::new();
            for (node, factor) in row.terms() {
                let (first, directions) = &self.free[*node];
                for (i, d) in directions.iter().enumerate() {
                    let part = factor[0] * d[0] + factor[1] * d[1];
                    match terms.iter_mut().find(|(p, _)| *p == first + i) {
                        Some((_, known)) => *known += part,
                        None => terms.push((first + i, part)),
                    }
                }
            }
            terms
        };
        let active: Vec<(Vec<(usize, f64)>, f64)> =
            active.iter().map(|r| (in_unknowns(&rows[*r]), rows[*r].excess(values))).collect();
        let penalty = PENALTY * self.largest;
        let mut entries = self.entries.clone();
        for (terms, _) in &active {
            for (p, a) in terms {
                entries
                    .extend(terms.iter().filter(|(q, _)| q <= p).map(|(q, b)| Triplet::new(*p, *q, penalty * a * b)));
            }
        }
        let matrix = SparseColMat::try_new_from_triplets(self.count, self.count, &entries).ok()?;
        let factor = matrix.sp_cholesky(Side::Lower).ok()?;
        let mut forces: Vec<f64> = active.iter().map(|(_, excess)| penalty * excess).collect();
        let mut x = Col::<f64>::zeros(self.count);
        for _ in 0..STEPS {
            let mut load = Col::<f64>::zeros(self.count);
            for ((terms, _), force) in active.iter().zip(&forces) {
                terms.iter().for_each(|(p, a)| load[*p] -= force * a);
            }
            x = factor.solve(&load);
            for ((terms, excess), force) in active.iter().zip(&mut forces) {
                let moved: f64 = terms.iter().map(|(p, a)| a * x[*p]).sum();
                *force += penalty * (moved + excess);
            }
        }
        let moved = |(value, (first, directions)): (&[f64; 2], &(usize, Vec<[f64; 2]>))| {
            directions.iter().enumerate().fold(*value, |v, (i, d)| [0, 1].map(|c| v[c] + x[first + i] * d[c]))
        };
        let found: Vec<[f64; 2]> = values.iter().zip(&self.free).map(moved).collect();
        found.iter().flatten().all(|x| x.is_finite()).then_some(found)
    }
}
