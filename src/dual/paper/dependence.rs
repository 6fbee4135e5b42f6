//! Which constraint rows depend on each other. The paper needs rank B = p1 + p2.
//!
//! Bᵀz = 0 means that the edge moments z do no work on any self-equilibrated field of any block. By Theorem 2.1 the
//! tractions of a block are all those in equilibrium, so z is then a rigid motion on the boundary of every triangle; the
//! four moments that two triangles share make it the same one, and so on through everything that hangs together. Rows
//! are dependent exactly by the rigid motions that Γ_u and Γ_0 leave to a part of the mesh, one dependence for each.
//!
//! A motion that opens or closes no contact makes an equality superfluous. One that does ties the reactions T_n to each
//! other (their resultant is given, as in Example 1); no row is superfluous then, and the multiplier is bounded because
//! the loads press the bodies together, (1.16) and (2.4).

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::constraints::{Constraints, Meaning, TractionShape};
use crate::problem::{Condition, Problem};

/// One vector z with Bᵀz = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Dependence {
    /// Velocity of every vertex; zero outside the moving part. The fastest vertex has speed one.
    pub motion: Vec<[f64; 2]>,
    /// Coefficients of the rows of D.
    pub z_d: Vec<f64>,
    /// Coefficients of the rows of E.
    pub z_e: Vec<f64>,
}

impl Dependence {
    /// True if rows of E take part, so that no row of D is superfluous.
    pub fn involves_contact(&self) -> bool {
        let largest = |z: &[f64]| z.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        largest(&self.z_e) > STILL * largest(&self.z_d)
    }

    /// Bodies that move.
    pub fn bodies(&self, problem: &Problem) -> Vec<usize> {
        let mesh = &problem.mesh;
        let moves = |t: usize| mesh.triangles[t].iter().any(|&v| self.motion[v].iter().any(|u| u.abs() > STILL));
        let mut bodies: Vec<usize> = (0..mesh.triangles.len()).filter(|&t| moves(t)).map(|t| mesh.body[t]).collect();
        bodies.sort_unstable();
        bodies.dedup();
        bodies
    }

    /// The work Σ z_i r_i of right-hand sides on the motion, and the product |z||r| it is small against.
    pub fn work(&self, r_d: &[f64], r_e: &[f64]) -> [f64; 2] {
        let (mut work, mut z2, mut r2) = (0.0, 0.0, 0.0);
        for (z, r) in self.z_d.iter().zip(r_d).chain(self.z_e.iter().zip(r_e)) {
            work += z * r;
            z2 += z * z;
            r2 += r * r;
        }
        [work, (z2 * r2).sqrt()]
    }
}

/// Fraction of the fastest motion that counts as none.
const STILL: f64 = 1e-10;

/// Eigenvalues of the hold on a part below this fraction of the largest count as none: an angle of 1e-7.
const NO_HOLD: f64 = 1e-14;

/// Finds all dependences of `constraints`: a basis of the null space of Bᵀ in which as many vectors as possible leave the
/// contact alone.
pub fn dependences(problem: &Problem, constraints: &Constraints) -> Vec<Dependence> {
    let mesh = &problem.mesh;
    let (parts, count) = parts(problem);
    let mut found = Vec::new();
    for part in 0..count {
        let triangles: Vec<usize> = (0..parts.len()).filter(|&t| parts[t] == part).collect();
        let mut inside = vec![false; mesh.points.len()];
        triangles.iter().flat_map(|&t| mesh.triangles[t]).for_each(|v| inside[v] = true);
        let vertices: Vec<usize> = (0..inside.len()).filter(|&v| inside[v]).collect();
        let mut centre = [0.0; 2];
        for &v in &vertices {
            for (sum, x) in centre.iter_mut().zip(mesh.points[v]) {
                *sum += x / vertices.len() as f64;
            }
        }
        let offset = |v: usize| [0, 1].map(|c| mesh.points[v][c] - centre[c]);
        let size = vertices.iter().map(|&v| offset(v)[0].hypot(offset(v)[1])).fold(f64::MIN_POSITIVE, f64::max);
        // Work of a hold along n at x on the motion (a1 − ω y, a2 + ω x), ω in units of 1/size.
        let row = |v: usize, n: [f64; 2]| {
            let [x, y] = offset(v);
            Vector3::new(n[0], n[1], (n[1] * x - n[0] * y) / size)
        };
        let mut hold = Matrix3::zeros();
        for (e, condition) in problem.conditions.iter().enumerate() {
            if mesh.edges[e].triangles[0].is_none_or(|t| parts[t] != part) {
                continue;
            }
            let directions: &[[f64; 2]] = match condition {
                Condition::Clamped(_) => &[[1.0, 0.0], [0.0, 1.0]],
                Condition::Roller { direction, .. } => &[*direction],
                _ => &[],
            };
            for v in mesh.edges[e].vertices {
                for &direction in directions {
                    let r = row(v, direction);
                    hold += r * r.transpose();
                }
            }
        }
        let eigen = hold.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        for k in (0..3).filter(|&k| eigen.eigenvalues[k] <= NO_HOLD * largest) {
            let a = eigen.eigenvectors.column(k);
            let mut motion = vec![[0.0; 2]; mesh.points.len()];
            for &v in &vertices {
                let [x, y] = offset(v);
                motion[v] = [a[0] - a[2] * y / size, a[1] + a[2] * x / size];
            }
            found.push(motion);
        }
    }
    separate(problem, constraints, &found)
}

/// Combines motions so that those without a jump on Γ_K stand apart: the eigenvectors of the Gram matrix of their z_E.
fn separate(problem: &Problem, constraints: &Constraints, motions: &[Vec<[f64; 2]>]) -> Vec<Dependence> {
    if motions.is_empty() {
        return Vec::new();
    }
    let jumps: Vec<Vec<f64>> = motions.iter().map(|m| multipliers(problem, constraints, m).1).collect();
    let gram = DMatrix::from_fn(motions.len(), motions.len(), |i, k| {
        jumps[i].iter().zip(&jumps[k]).map(|(a, b)| a * b).sum::<f64>()
    });
    let vectors = gram.symmetric_eigen().eigenvectors;
    (0..motions.len())
        .map(|k| {
            let mut motion = vec![[0.0; 2]; problem.mesh.points.len()];
            for (i, own) in motions.iter().enumerate() {
                for (sum, u) in motion.as_flattened_mut().iter_mut().zip(own.as_flattened()) {
                    *sum += vectors[(i, k)] * u;
                }
            }
            let fastest = motion.iter().fold(f64::MIN_POSITIVE, |m, u| m.max(u[0].hypot(u[1])));
            motion.as_flattened_mut().iter_mut().for_each(|u| *u /= fastest);
            let (z_d, z_e) = multipliers(problem, constraints, &motion);
            Dependence { motion, z_d, z_e }
        })
        .collect()
}

/// Numbers the parts of the mesh that hang together by edges: part of each triangle, and how many there are.
fn parts(problem: &Problem) -> (Vec<usize>, usize) {
    let mesh = &problem.mesh;
    let mut parts = vec![usize::MAX; mesh.triangles.len()];
    let mut count = 0;
    for start in 0..parts.len() {
        if parts[start] != usize::MAX {
            continue;
        }
        parts[start] = count;
        let mut open = vec![start];
        while let Some(t) = open.pop() {
            for neighbour in mesh.triangle_edges[t].iter().flat_map(|&e| mesh.edges[e].triangles).flatten() {
                if parts[neighbour] == usize::MAX {
                    parts[neighbour] = count;
                    open.push(neighbour);
                }
            }
        }
        count += 1;
    }
    (parts, count)
}

/// Multipliers that stand for a displacement given at the vertices and linear along edges.
pub fn multipliers(problem: &Problem, constraints: &Constraints, motion: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
    let mesh = &problem.mesh;
    // ∫ u ds and ∫ p u ds of a component.
    let integral = |length: f64, [a, b]: [f64; 2], basis: TractionShape| match basis {
        TractionShape::Mean => 0.5 * length * (a + b),
        TractionShape::Slope => length * (b - a) / 6.0,
    };
    let ends = |edge: usize| mesh.edges[edge].vertices.map(|v| motion[v]);
    let along = |u: [f64; 2], n: [f64; 2]| u[0] * n[0] + u[1] * n[1];
    let value = |meaning: &Meaning| match *meaning {
        Meaning::Continuity { edge, component, basis } | Meaning::Applied { edge, component, basis } => {
            integral(mesh.edge_frame(edge).0, ends(edge).map(|u| u[component]), basis)
        }
        Meaning::RollerShear { edge, basis } | Meaning::ContactShear { edge, basis } => {
            let (length, n) = mesh.edge_frame(edge);
            integral(length, ends(edge).map(|u| along(u, [-n[1], n[0]])), basis)
        }
        Meaning::ContactEquality { interface, pair, basis } => {
            let pair = &problem.interfaces[interface].pairs[pair];
            let (Some(first), Some([a, b])) = (pair.edges[0], pair.second) else { return 0.0 };
            let opposite = [a, b].map(|v| along(motion[v], pair.normal));
            let runs_along = mesh.edges[first].vertices[0] == pair.first[0];
            let [p, q] = opposite;
            integral(pair.length, if runs_along { [p, q] } else { [q, p] }, basis)
        }
        Meaning::Reaction { interface, pair, end } => {
            let pair = &problem.interfaces[interface].pairs[pair];
            let jump = [0, 1].map(|i| {
                let other = pair.second.map_or([0.0; 2], |second| motion[second[i]]);
                let own = motion[pair.first[i]];
                along([own[0] - other[0], own[1] - other[1]], pair.normal)
            });
            pair.length * (2.0 * jump[end] + jump[1 - end]) / 6.0
        }
    };
    (constraints.d_meaning.iter().map(value).collect(), constraints.e_meaning.iter().map(value).collect())
}
