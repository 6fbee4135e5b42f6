//! Element matrices of all triangles, congruent ones computed once.

use std::collections::HashMap;

use rayon::prelude::*;

use crate::element::{Compliance, EquilibriumElement, Layout, Modes, StressField};
use crate::problem::Problem;

/// The modes of every triangle.
#[derive(Clone)]
pub struct ModeTable {
    element: &'static dyn EquilibriumElement,
    layout: Layout,
    class: Vec<u32>,
    /// The first triangle of each class.
    representatives: Vec<usize>,
    data: Vec<f64>,
    materials: Vec<Compliance>,
}

/// Two triangles are congruent when their edge vectors agree to this fraction of their size: well above what rounding
/// of the coordinates does, well below what equilibrium could notice.
const CONGRUENT: f64 = 1.0 / (1_u64 << 42) as f64;

impl std::fmt::Debug for ModeTable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ModeTable").field("element", &self.element.name()).field("classes", &self.classes()).finish()
    }
}

impl ModeTable {
    /// Computes the modes of `element` on every triangle of `problem`.
    pub fn new(problem: &Problem, element: &'static dyn EquilibriumElement) -> Self {
        let materials = materials(problem);
        let mesh = &problem.mesh;
        let mut seen: HashMap<[i64; 6], u32> = HashMap::new();
        let mut representatives: Vec<usize> = Vec::new();
        let class = (0..mesh.triangles.len())
            .map(|t| {
                let next = representatives.len() as u32;
                *seen.entry(key(mesh.corners(t), mesh.body[t])).or_insert_with(|| {
                    representatives.push(t);
                    next
                })
            })
            .collect();
        let layout = element.layout();
        let mut data = vec![0.0; layout.len() * representatives.len()];
        data.par_chunks_exact_mut(layout.len()).zip(&representatives).with_min_len(64).for_each(|(out, &t)| {
            let body = mesh.body[t];
            let force = problem.scene.bodies[body].body_force;
            element.compute(mesh.corners(t), &materials[body], force, layout.split(out));
        });
        ModeTable { element, layout, class, representatives, data, materials }
    }

    /// Modes of triangle `t`.
    pub fn of(&self, t: usize) -> Modes<'_> {
        let start = self.class[t] as usize * self.layout.len();
        Modes::view(self.layout, &self.data[start..start + self.layout.len()])
    }

    /// Number of triangles that are not congruent to an earlier one.
    pub fn classes(&self) -> usize {
        self.representatives.len()
    }

    /// The stress field λ̄ + Σ S_k τ_k with mode parameters `s`, triangle by triangle.
    pub fn stresses(&self, problem: &Problem, s: &[f64]) -> StressField {
        let mesh = &problem.mesh;
        let mut field = StressField::zeros(self.element.degree(), mesh.triangles.len());
        let (n, stride) = (self.element.parameters(), field.stride());
        let blocks = field.values_mut().par_chunks_exact_mut(stride).zip(s.par_chunks_exact(n));
        blocks.enumerate().with_min_len(256).for_each(|(t, (block, s))| {
            // What was kept belongs to the triangle that it was computed on.
            let corners = mesh.corners(self.representatives[self.class[t] as usize]);
            let force = problem.scene.bodies[mesh.body[t]].body_force;
            self.element.stresses(corners, force, &self.of(t), s, 1.0, block);
        });
        field
    }

    /// Compliance of each body.
    pub fn materials(&self) -> &[Compliance] {
        &self.materials
    }
}

/// Compliance of each body of the scene.
pub fn materials(problem: &Problem) -> Vec<Compliance> {
    let scene = &problem.scene;
    scene.bodies.iter().map(|b| Compliance::new(scene.kinematics, b.young, b.poisson)).collect()
}

/// Edge vectors in units of the triangle's size (rounded up to a power of two), that size, and the body.
fn key([a, b, c]: [[f64; 2]; 3], body: usize) -> [i64; 6] {
    let sides = [b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]];
    let largest = sides.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    let exponent = largest.log2().ceil();
    let unit = exponent.exp2() * CONGRUENT;
    let [p, q, r, s] = sides.map(|v| (v / unit).round() as i64);
    [p, q, r, s, exponent as i64, body as i64]
}
