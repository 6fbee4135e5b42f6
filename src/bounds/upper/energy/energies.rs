//! The energy of every triangle as a function of the nodes on its boundary.

use rayon::prelude::*;

use super::pull::Pull;
use super::split::Split;
use super::stiffness::Stiffness;
use crate::bounds::upper::admissible::nodes::Nodes;
use crate::element::polynomial::side::product;
use crate::element::{congruent, parts, starts};
use crate::problem::Problem;

/// Of all triangles, per unit thickness.
#[derive(Debug)]
pub struct TriangleEnergies {
    /// One for similar triangles, and which of them each triangle has; `None` where the inside has no unique minimum.
    stiffness: Vec<Option<Stiffness>>,
    class: Vec<u32>,
    /// f of each triangle and L⁻¹ f_i behind it.
    loads: Vec<f64>,
    start: Vec<usize>,
}

/// ½ uᵀKu − fᵀu of one triangle, u being x and y of the nodes on its boundary ([`Nodes::of_triangle`]).
#[derive(Debug, Clone, Copy)]
pub struct TriangleEnergy<'a> {
    stiffness: &'a Stiffness,
    load: &'a [f64],
    within: &'a [f64],
}

impl TriangleEnergies {
    /// Those that `pull` pulls at; the first triangle of a shape has the stiffness of one with the corners `like`.
    pub fn new(problem: &Problem, nodes: &Nodes, pull: Pull<'_>, like: impl Fn(usize) -> [[f64; 2]; 3] + Sync) -> Self {
        let mesh = &problem.mesh;
        let materials = problem.materials();
        let (class, first) = similar(problem, nodes);
        let of = |t: &usize| {
            let (k, degrees) = (nodes.triangle_degree(mesh, *t), mesh.triangle_edges[*t].map(|e| nodes.degree(e)));
            let split = Split::of(problem.section(), k, like(*t), &materials[mesh.body[*t]]);
            Stiffness::of(k, degrees, split)
        };
        let stiffness: Vec<Option<Stiffness>> = first.par_iter().with_min_len(16).map(of).collect();
        let count = |c: &u32| stiffness[*c as usize].as_ref().map_or(0, |s| s.size + s.inside);
        let start = starts(class.iter().map(count));
        let loads = vec![0.0; start[class.len()]];
        let mut energies = TriangleEnergies { stiffness, class, loads, start };
        energies.reload(problem, nodes, pull);
        energies
    }

    /// Puts the load of `pull` in the place of the one before.
    pub fn reload(&mut self, problem: &Problem, nodes: &Nodes, pull: Pull<'_>) {
        let TriangleEnergies { stiffness, class, loads, start } = self;
        let loads = parts(loads, start).into_par_iter().zip(&*class).enumerate().with_min_len(64);
        loads.for_each(|(t, (out, class))| {
            let Some(stiffness) = &stiffness[*class as usize] else { return };
            let forces = pull.forces(problem, t, nodes.triangle_degree(&problem.mesh, t));
            let (load, within) = out.split_at_mut(stiffness.size);
            stiffness.condense(&forces, load, within);
            add_tractions(problem, nodes, pull, t, load);
        });
    }

    /// That of triangle `t`, where its inside has a unique minimum.
    pub fn of(&self, t: usize) -> Option<TriangleEnergy<'_>> {
        let stiffness = self.stiffness[self.class[t] as usize].as_ref()?;
        let (load, within) = self.loads[self.start[t]..self.start[t + 1]].split_at(stiffness.size);
        Some(TriangleEnergy::new(stiffness, load, within))
    }

    /// All of them with their triangles.
    pub fn iter(&self) -> impl Iterator<Item = (usize, TriangleEnergy<'_>)> {
        (0..self.class.len()).filter_map(|t| Some((t, self.of(t)?)))
    }
}

/// Which triangles share a stiffness: the class of each, and the first triangle of each class.
pub fn similar(problem: &Problem, nodes: &Nodes) -> (Vec<u32>, Vec<usize>) {
    let mesh = &problem.mesh;
    let degrees = |t: usize| mesh.triangle_edges[t].map(|e| nodes.degree(e));
    // In the plane similar triangles have the same stiffness.
    let place = |t: usize| problem.section().place(mesh.corners(t)).map(|at| (at, congruent::shape(mesh.corners(t)).1));
    let key = |t: usize| (congruent::shape(mesh.corners(t)).0, mesh.body[t], degrees(t), place(t));
    congruent::classes((0..mesh.triangles.len()).map(key))
}

impl<'a> TriangleEnergy<'a> {
    /// With f and L⁻¹ f_i, as [`Stiffness::condense`] makes them.
    pub fn new(stiffness: &'a Stiffness, load: &'a [f64], within: &'a [f64]) -> Self {
        TriangleEnergy { stiffness, load, within }
    }

    /// A row of K.
    pub fn row(&self, i: usize) -> &[f64] {
        self.stiffness.row(i)
    }

    /// f − Ku.
    pub fn residual(&self, u: &[f64], out: &mut Vec<f64>) {
        self.stiffness.residual(self.load, u, out);
    }

    /// uᵀKv.
    pub fn form(&self, u: &[f64], v: &[f64]) -> f64 {
        self.stiffness.form(u, v)
    }

    /// ½ uᵀKu − fᵀv, with the memory of another call for what is in between.
    pub fn energy(&self, u: &[f64], v: impl Iterator<Item = f64>, room: &mut Vec<f64>) -> f64 {
        self.residual(u, room);
        // uᵀKu = uᵀ(f − r).
        let strain: f64 = u.iter().zip(self.load).zip(room.iter()).map(|((u, f), r)| u * (f - r)).sum();
        0.5 * strain - self.load.iter().zip(v).map(|(f, v)| f * v).sum::<f64>()
    }

    /// −½ f_iᵀ K_ii⁻¹ f_i: the energy where the boundary has zero values.
    pub fn at_rest(&self) -> f64 {
        -0.5 * self.within.iter().map(|f| f * f).sum::<f64>()
    }

    /// The coefficients inside, x and y of each, that minimise the energy where those on the boundary are `boundary`, all in the
    /// degree of the triangle.
    pub fn inside(&self, boundary: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self.within);
        self.stiffness.inside(boundary, out);
    }
}

/// Adds the tractions on the boundary edges of triangle `t` to its load.
fn add_tractions(problem: &Problem, nodes: &Nodes, pull: Pull<'_>, t: usize, load: &mut [f64]) {
    let mesh = &problem.mesh;
    let degrees = mesh.triangle_edges[t].map(|e| nodes.degree(e));
    for (i, &e) in mesh.triangle_edges[t].iter().enumerate() {
        let Some(ends) = pull.traction(problem, e) else { continue };
        let applied = problem.weighted(e, ends);
        let last = applied.len() - 1;
        // A boundary edge runs from corner i + 1 to corner i + 2 of its triangle.
        let (length, _) = mesh.edge_frame(e);
        let first = 3 + degrees[..i].iter().map(|k| k - 1).sum::<usize>();
        let k = degrees[i];
        for j in 0..=k {
            let node = match j {
                0 => (i + 1) % 3,
                j if j == k => (i + 2) % 3,
                j => first + j - 1,
            };
            let weights = |i: usize| length * product(last, i, k, j);
            for c in 0..2 {
                load[2 * node + c] += (0..=last).map(|i| weights(i) * applied[i][c]).sum::<f64>();
            }
        }
    }
}
