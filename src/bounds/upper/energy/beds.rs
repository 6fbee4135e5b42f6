//! The energy of springs and elastic layers as a function of nodes.
//!
//! Of each direction d it is ½ k l jᵀMj, j being the Bernstein coefficients of (v' − v'')·d on an edge of length l and M their Gram
//! matrix. Jumps are taken before anything else, so that what both sides do together costs no digits.

use crate::bounds::springs::{OnSprings, spring_tractions};
use crate::bounds::upper::admissible::nodes::{NodalValues, Nodes};
use crate::element::StressField;
use crate::element::polynomial::side;
use crate::element::polynomial::side::product;
use crate::problem::{BedPair, EdgeWeight, Problem};
use crate::vector::dot;

/// One edge on springs, or two with a layer between them.
#[derive(Debug, Clone)]
pub struct BedEnergy {
    /// The nodes of the first side, and of the second in the same order.
    sides: [Vec<usize>; 2],
    axes: [[f64; 2]; 2],
    /// k l along both axes.
    stiffness: [f64; 2],
    /// Forces at the nodes of the first side; on those of the second they act the other way.
    load: Vec<[f64; 2]>,
    length: f64,
    weight: EdgeWeight,
    /// The gap of an elastic contact.
    gap: Option<Vec<f64>>,
    /// The energy that is counted beside all this.
    constant: f64,
}

/// Those of all pairs, one bed after the other.
pub fn energies(problem: &Problem, nodes: &Nodes) -> Vec<BedEnergy> {
    let mesh = &problem.mesh;
    let along = |e: usize, end: usize| nodes.along(mesh, e, mesh.edges[e].vertices[end]).collect();
    let of = |(pair, stiffness): (&BedPair, [f64; 2])| BedEnergy {
        sides: [along(pair.edge, 0), pair.opposite.map_or_else(Vec::new, |e| along(e, 1))],
        axes: pair.axes,
        stiffness: stiffness.map(|k| k * pair.length),
        load: Vec::new(),
        length: pair.length,
        weight: pair.weight,
        gap: pair.contact.map(|contact| contact.gap()),
        constant: 0.0,
    };
    problem.bed_pairs().map(of).collect()
}

/// Gives all of them what `springs` pull.
pub fn reload(beds: &mut [BedEnergy], springs: Option<&OnSprings>) {
    for (number, bed) in beds.iter_mut().enumerate() {
        bed.reload(springs.map(|f| &f[number]));
    }
}

impl BedEnergy {
    /// No springs, and the work ∫ f j of a force along a pair, x and y by their Bernstein coefficients.
    pub fn of_force(sides: [Vec<usize>; 2], length: f64, [x, y]: [Vec<f64>; 2]) -> Self {
        let k = sides[0].len() - 1;
        let along = |i: usize, f: &[f64]| -> f64 {
            let of = |(m, f): (usize, &f64)| f * product(k, i, x.len() - 1, m);
            length * f.iter().enumerate().map(of).sum::<f64>()
        };
        let load = (0..=k).map(|i| [along(i, &x), along(i, &y)]).collect();
        let axes = [[1.0, 0.0], [0.0, 1.0]];
        let weight = EdgeWeight::default();
        BedEnergy { sides, axes, stiffness: [0.0; 2], load, length, weight, gap: None, constant: 0.0 }
    }

    /// All nodes, with the sign that their values have in the jump, and their place along the edge.
    pub fn nodes(&self) -> impl Iterator<Item = (usize, f64, usize)> + '_ {
        let sides = self.sides.iter().zip([1.0, -1.0]);
        sides.flat_map(|(side, sign)| side.iter().enumerate().map(move |(i, node)| (*node, sign, i)))
    }

    /// Puts ∫ f j of the forces `f` along both axes in the place of what pulled before; none where there are none.
    fn reload(&mut self, f: Option<&[Vec<f64>; 2]>) {
        self.load.clear();
        let (Some(f), k) = (f, self.degree()) else { return };
        for i in 0..=k {
            let mut force = [0.0; 2];
            for (axis, f) in self.axes.iter().zip(f) {
                let degree = f.len().max(1) - 1;
                let along = f.iter().enumerate().map(|(j, f)| f * product(k, i, degree, j));
                let along = self.length * along.sum::<f64>();
                (0..2).for_each(|c| force[c] += along * axis[c]);
            }
            self.load.push(force);
        }
    }

    fn degree(&self) -> usize {
        self.sides[0].len() - 1
    }

    /// The coefficients of the jump.
    fn jump(&self, value: impl Fn(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
        let mut jump: Vec<[f64; 2]> = self.sides[0].iter().map(|node| value(*node)).collect();
        for (jump, node) in jump.iter_mut().zip(&self.sides[1]) {
            let other = value(*node);
            *jump = [jump[0] - other[0], jump[1] - other[1]];
        }
        jump
    }

    /// The forces on the nodes of the first side, of what pulls and of the springs; those on the second are the opposite.
    pub fn forces(&self, values: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut forces = self.elastic(values);
        forces.iter_mut().zip(&self.load).for_each(|(f, load)| *f = [f[0] + load[0], f[1] + load[1]]);
        forces
    }

    fn elastic(&self, values: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let (jump, k) = (self.jump(|node| values[node]), self.degree());
        let of = |i: usize| {
            let mut mean = [0.0; 2];
            for (j, u) in jump.iter().enumerate() {
                let weight = self.weight.product(k, i, j);
                (0..2).for_each(|c| mean[c] += weight * u[c]);
            }
            let mut force = [0.0; 2];
            for (axis, stiffness) in self.axes.iter().zip(self.stiffness) {
                let along = -stiffness * dot(mean, *axis);
                (0..2).for_each(|c| force[c] += along * axis[c]);
            }
            force
        };
        (0..=k).map(of).collect()
    }

    /// The stiffness between places `i` and `j` along the edge, on the same side, for two directions.
    pub fn entry(&self, (i, p): (usize, [f64; 2]), (j, q): (usize, [f64; 2])) -> f64 {
        let k = self.degree();
        let along = self.axes.iter().zip(self.stiffness);
        self.weight.product(k, i, j)
            * along.map(|(axis, stiffness)| stiffness * dot(*axis, p) * dot(*axis, q)).sum::<f64>()
    }

    /// ½ k l jᵀMj less the work of what pulls.
    pub fn energy(&self, values: &[[f64; 2]]) -> f64 {
        0.5 * self.form(values, values) - self.work(values)
    }

    /// Of an elastic contact, puts springs in its place that resist d = j − g less its negative part w at `values`: their energy
    /// ½ k (d − w)² is nowhere below ½ k d₊², and the same at these values but where d changes its sign. Gives what they store beside
    /// the energy that is counted.
    pub fn touch(&mut self, values: &[[f64; 2]]) -> f64 {
        let Some(gap) = &self.gap else { return 0.0 };
        let along: Vec<f64> = self.jump(|node| values[node]).iter().map(|j| dot(*j, self.axes[0])).collect();
        let degree = along.len().max(gap.len()) - 1;
        let [jump, gap] = [&along, gap].map(|f| side::elevate(f, degree));
        // g + w = min(j, g).
        let rest: Vec<f64> = jump.iter().zip(&gap).map(|(j, g)| j.min(*g)).collect();
        let k = self.stiffness[0] / self.length;
        let weighted = self.weight.times(&rest);
        self.reload(Some(&[weighted.iter().map(|w| k * w).collect(), Vec::new()]));
        self.constant = 0.5 * self.stiffness[0] * side::integral(&rest, &weighted);
        self.constant
    }

    /// The work of what pulls.
    pub fn work(&self, values: &[[f64; 2]]) -> f64 {
        if self.load.is_empty() {
            return 0.0;
        }
        let jump = self.jump(|node| values[node]);
        self.load.iter().zip(jump).map(|(f, j)| dot(*f, j)).sum()
    }

    /// k l jᵀM i of the jumps of two displacements.
    pub fn form(&self, one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
        let jump = self.jump(|node| other[node]);
        let forces = self.elastic(one);
        -forces.iter().zip(jump).map(|(f, j)| dot(*f, j)).sum::<f64>()
    }
}

/// Puts the jump of stiff springs where their traction in `stress` has it: next to it, what a fit says of a displacement is
/// wrong by much more than the springs give.
pub fn draw(problem: &Problem, stress: &StressField, field: &mut NodalValues) {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let vertex = field.vertices_mut();
    for (pair, stiffness) in problem.bed_pairs() {
        let young = |e: usize| mesh.edges[e].triangles[0].map_or(0.0, |t| materials[mesh.body[t]].young()[1]);
        let firm = pair.sides().map(|(_, e)| young(e)).fold(f64::INFINITY, f64::min);
        let tractions = spring_tractions(problem, stress, pair);
        for ((axis, k), t) in pair.axes.iter().zip(stiffness).zip(&tractions) {
            if k * pair.length <= firm {
                continue;
            }
            let [a, b] = mesh.edges[pair.edge].vertices;
            let opposite = pair.opposite.map(|e| mesh.edges[e].vertices);
            let gap = pair.contact.map(|contact| contact.gap());
            for (end, v, t) in [(0, a, t[0]), (1, b, t[t.len() - 1])] {
                let other = opposite.map(|ends| ends[1 - end]).filter(|w| *w != v);
                let now = dot(vertex[v], *axis) - other.map_or(0.0, |w| dot(vertex[w], *axis));
                // Where nothing presses on an elastic contact it is anywhere within its gap.
                let weight = pair.weight.at_end(end);
                if weight == 0.0 {
                    continue;
                }
                let t = t / weight;
                let off = match gap.as_ref().map(|gap| gap[end * (gap.len() - 1)]) {
                    None => -t / k - now,
                    Some(gap) if t < 0.0 => gap - t / k - now,
                    Some(gap) => (gap - now).min(0.0),
                };
                let part = if other.is_some() { 0.5 } else { 1.0 };
                (0..2).for_each(|c| vertex[v][c] += part * off * axis[c]);
                if let Some(w) = other {
                    (0..2).for_each(|c| vertex[w][c] -= part * off * axis[c]);
                }
            }
        }
    }
}
