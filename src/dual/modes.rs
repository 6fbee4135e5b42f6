//! Element matrices of all triangles, congruent ones computed once.

use std::ops::Range;

use rayon::prelude::*;

use crate::element::{Elements, Layout, Material, Modes, StressField, congruent, parts, starts};
use crate::problem::Problem;

/// The modes of every triangle.
#[derive(Clone)]
pub struct ModeTable {
    elements: Elements,
    class: Vec<u32>,
    classes: Vec<Class>,
    data: Vec<f64>,
    /// The first mode parameter of each triangle, and the end.
    first_parameter: Vec<usize>,
    materials: Vec<Material>,
}

/// Congruent triangles of one degree.
#[derive(Debug, Clone, Copy)]
struct Class {
    /// The first of them.
    triangle: usize,
    layout: Layout,
    /// Where its data begin.
    start: usize,
}

impl std::fmt::Debug for ModeTable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ModeTable").field("elements", &self.elements).field("classes", &self.classes()).finish()
    }
}

impl ModeTable {
    /// Computes the modes of `elements` on every triangle of `problem`.
    pub fn new(problem: &Problem, elements: Elements) -> Self {
        let materials = problem.materials();
        let mesh = &problem.mesh;
        let section = problem.section();
        let place = |t: usize| section.place(mesh.corners(t));
        // A force that is not the same everywhere differs on triangles that are congruent, and so does a strain that elements count in.
        let differs = |t: usize| {
            let strained = section.is_revolved() && !materials[mesh.body[t]].initial().is_constant();
            strained || !problem.body_force(t).is_constant()
        };
        let own = |t: usize| differs(t).then_some(t);
        let key = |t: usize| (congruent::shape(mesh.corners(t)), mesh.body[t], elements.degree(t), own(t), place(t));
        let (class, first) = congruent::classes((0..mesh.triangles.len()).map(key));
        let mut end = 0;
        let classes: Vec<Class> = first
            .into_iter()
            .map(|t| {
                let layout = section.layout(elements.of(t), mesh.corners(t));
                let start = end;
                end += layout.len();
                Class { triangle: t, layout, start }
            })
            .collect();
        let mut data = vec![0.0; end];
        let of_classes = parts(&mut data, &starts(classes.iter().map(|class| class.layout.len())));
        of_classes.into_par_iter().zip(&classes).with_min_len(64).for_each(|(out, class)| {
            let t = class.triangle;
            let body = mesh.body[t];
            let out = class.layout.split(out);
            section.compute(elements.of(t), mesh.corners(t), &materials[body], problem.body_force(t), out);
        });
        let first_parameter = starts(class.iter().map(|&c| classes[c as usize].layout.parameters));
        ModeTable { elements, class, classes, data, first_parameter, materials }
    }

    /// Modes of triangle `t`.
    pub fn of(&self, t: usize) -> Modes<'_> {
        let Class { layout, start, .. } = self.classes[self.class[t] as usize];
        Modes::view(layout, &self.data[start..start + layout.len()])
    }

    /// The degree of triangle `t`.
    pub fn degree(&self, t: usize) -> usize {
        self.elements.degree(t)
    }

    /// The elements.
    pub fn elements(&self) -> &Elements {
        &self.elements
    }

    /// Where the mode parameters of triangle `t` are among those of all triangles.
    pub fn parameters_of(&self, t: usize) -> Range<usize> {
        self.first_parameter[t]..self.first_parameter[t + 1]
    }

    /// Number of mode parameters of all triangles.
    pub fn parameters(&self) -> usize {
        self.first_parameter.last().copied().unwrap_or(0)
    }

    /// The parts of `values`, one number for each mode parameter, that belong to each triangle.
    pub fn split_parameters<'a>(&self, values: &'a mut [f64]) -> Vec<&'a mut [f64]> {
        parts(values, &self.first_parameter)
    }

    /// The class of congruent triangles that triangle `t` belongs to, below [`Self::classes`].
    pub fn class_of(&self, t: usize) -> usize {
        self.class[t] as usize
    }

    /// Number of triangles that are not congruent to an earlier one of their degree.
    pub fn classes(&self) -> usize {
        self.classes.len()
    }

    /// The stress field λ̄ + Σ S_k τ_k with mode parameters `s`, triangle by triangle.
    pub fn stresses(&self, problem: &Problem, s: &[f64]) -> StressField {
        let mesh = &problem.mesh;
        let mut field = StressField::of_degrees((0..mesh.triangles.len()).map(|t| self.degree(t)));
        field.blocks_mut().into_par_iter().enumerate().with_min_len(256).for_each(|(t, block)| {
            // What was kept belongs to the triangle that it was computed on.
            let corners = mesh.corners(self.classes[self.class[t] as usize].triangle);
            let force = problem.body_force(t);
            let (modes, s) = (self.of(t), &s[self.parameters_of(t)]);
            problem.section().stresses(self.elements.of(t), corners, force, &modes, s, block);
        });
        field
    }

    /// Nodal stresses of every mode of triangle `t`.
    pub fn mode_stresses(&self, problem: &Problem, t: usize) -> Vec<Vec<[f64; 3]>> {
        let corners = problem.mesh.corners(self.classes[self.class[t] as usize].triangle);
        problem.section().mode_stresses(self.elements.of(t), corners, &self.of(t))
    }

    /// Nodal stresses of an orthonormal basis of the fields without traction on triangle `t`.
    pub fn unloaded(&self, problem: &Problem, t: usize) -> Vec<Vec<[f64; 3]>> {
        problem.section().unloaded(self.elements.of(t), problem.mesh.corners(t), &self.materials[problem.mesh.body[t]])
    }

    /// Material of each body.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }
}
