//! Relaxation of the free upper bound: one patch of triangles after the other gives up energy.
//!
//! The local fit leaves an error that oscillates from triangle to triangle. Minimising the energy over the values at a
//! vertex and on the edges that meet there, with everything else fixed, removes most of it; the patches are large enough
//! to hold fields without change of volume, so that this works as ν → ½ as well. Jumps on Γ_K are kept as they are: two
//! sides in contact move together across it and freely along it. Every step stays admissible and lowers the energy.

use nalgebra::{Cholesky, DMatrix, DVector, SVector};

use super::holds::Hold;
use super::stiffness::{BOUNDARY, Condensed, condensed};
use crate::problem::{Condition, Problem};

/// A scalar unknown at up to two nodes: the nodes, and the direction of motion.
#[derive(Debug, Clone, Copy)]
struct Freedom {
    nodes: [usize; 2],
    direction: [f64; 2],
}

/// Nodes are vertices, then edges. Each has up to two freedoms.
struct Freedoms {
    all: Vec<Freedom>,
    at: Vec<[Option<usize>; 2]>,
}

impl Freedoms {
    fn new(problem: &Problem, holds: &[Hold]) -> Self {
        let mesh = &problem.mesh;
        let vertices = mesh.points.len();
        let mut freedoms = Freedoms { all: Vec::new(), at: vec![[None; 2]; vertices + mesh.edges.len()] };
        let opposite = opposite(problem);
        for (v, hold) in holds.iter().enumerate() {
            match (&opposite[v], hold) {
                (Facing::None, Hold::Free) => freedoms.free(v),
                (Facing::None, Hold::Line { normal, .. }) => freedoms.add([v, v], turned(*normal)),
                (Facing::None, Hold::Fixed(_)) => {}
                (Facing::Rigid(normal), Hold::Free) => freedoms.add([v, v], turned(*normal)),
                (Facing::Vertex(other, normal), Hold::Free) => {
                    let mutual = matches!(opposite[*other], Facing::Vertex(back, _) if back == v);
                    if v < *other && mutual && holds[*other] == Hold::Free {
                        freedoms.across(v, *other, *normal);
                    }
                }
                // Where a contact meets a support, another contact or a corner of its own, nothing moves.
                _ => {}
            }
        }
        for (e, condition) in problem.conditions.iter().enumerate() {
            let node = vertices + e;
            match condition {
                Condition::Interior | Condition::Traction(_) => freedoms.free(node),
                Condition::Roller => freedoms.add([node, node], turned(mesh.edge_frame(e).1)),
                Condition::Clamped(_) | Condition::Contact { .. } => {}
            }
        }
        for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
            match pair.edges {
                [Some(a), Some(b)] => freedoms.across(vertices + a, vertices + b, pair.normal),
                [Some(a), None] => freedoms.add([vertices + a; 2], turned(pair.normal)),
                _ => {}
            }
        }
        freedoms
    }

    fn add(&mut self, nodes: [usize; 2], direction: [f64; 2]) {
        let index = self.all.len();
        self.all.push(Freedom { nodes, direction });
        let count = if nodes[0] == nodes[1] { 1 } else { 2 };
        for &node in &nodes[..count] {
            let slot = usize::from(self.at[node][0].is_some());
            self.at[node][slot] = Some(index);
        }
    }

    fn free(&mut self, node: usize) {
        self.add([node, node], [1.0, 0.0]);
        self.add([node, node], [0.0, 1.0]);
    }

    /// Two nodes that move together along `normal` and each on its own across it.
    fn across(&mut self, first: usize, second: usize, normal: [f64; 2]) {
        self.add([first, second], normal);
        self.add([first, first], turned(normal));
        self.add([second, second], turned(normal));
    }
}

fn turned([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

/// What a vertex faces across Γ_K.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Facing {
    None,
    Rigid([f64; 2]),
    Vertex(usize, [f64; 2]),
    Several,
}

fn opposite(problem: &Problem) -> Vec<Facing> {
    // Normals of short edges in line differ by rounding.
    const SAME: f64 = 1e-9;
    let mut facing = vec![Facing::None; problem.mesh.points.len()];
    let mut meet = |v: usize, found: Facing| {
        let same = |n: [f64; 2], m: [f64; 2]| (n[0] - m[0]).hypot(n[1] - m[1]) < SAME;
        facing[v] = match (facing[v], found) {
            (Facing::None, new) => new,
            (Facing::Rigid(n), Facing::Rigid(m)) if same(n, m) => facing[v],
            (Facing::Vertex(v, n), Facing::Vertex(w, m)) if v == w && same(n, m) => Facing::Vertex(v, n),
            _ => Facing::Several,
        };
    };
    for pair in problem.interfaces.iter().flat_map(|i| &i.pairs) {
        for end in 0..2 {
            match pair.second {
                None => meet(pair.first[end], Facing::Rigid(pair.normal)),
                Some(second) => {
                    meet(pair.first[end], Facing::Vertex(second[end], pair.normal));
                    meet(second[end], Facing::Vertex(pair.first[end], pair.normal));
                }
            }
        }
    }
    facing
}

/// Sweeps over all vertices. The first takes most of what there is to gain, at ν = 0.3 all of it; the third is worth
/// less than its time even at ν = 0.4999.
const SWEEPS: usize = 2;

/// More sweeps follow, up to this many, while one gains more than this part of the energy: slivers couple their vertices
/// so strongly that the local fit leaves errors far above the energy itself, which go down by a factor a sweep.
const MOST_SWEEPS: usize = 60;
const WORTH_A_SWEEP: f64 = 1e-3;

/// Patches with more unknowns than this, at vertices with scores of triangles, are left as they are.
const MOST_IN_PATCH: usize = 300;

/// Lowers the energy of the admissible field with the values `vertex` and `middle`.
pub fn relax(problem: &Problem, holds: &[Hold], vertex: &mut [[f64; 2]], middle: &mut [[f64; 2]]) {
    let elements = condensed(problem);
    let freedoms = Freedoms::new(problem, holds);
    let stars = Stars::new(problem);
    let opposite = opposite(problem);
    let order = by_place(problem);
    let mut patch = Patch { local: vec![usize::MAX; freedoms.all.len()], ..Patch::default() };
    let mut values: Vec<[f64; 2]> = vertex.iter().chain(middle.iter()).copied().collect();
    let mut gained = f64::INFINITY;
    for sweep in 0..MOST_SWEEPS {
        if sweep >= SWEEPS && gained <= WORTH_A_SWEEP * energy(problem, &elements, &values).abs() {
            break;
        }
        gained = 0.0;
        for k in 0..order.len() {
            // Back and forth: what one direction pushes ahead of it the other brings back.
            let v = order[if sweep % 2 == 0 { k } else { order.len() - 1 - k }];
            patch.triangles.clear();
            patch.triangles.extend_from_slice(stars.of(v));
            if let Facing::Vertex(other, _) = opposite[v] {
                if other < v {
                    continue;
                }
                patch.triangles.extend_from_slice(stars.of(other));
                patch.vertices = [v, other];
            } else {
                patch.vertices = [v, v];
            }
            gained += patch.minimise(problem, &elements, &freedoms, &mut values);
        }
    }
    vertex.copy_from_slice(&values[..vertex.len()]);
    middle.copy_from_slice(&values[vertex.len()..]);
}

/// All vertices by their place, so that the numbering of the mesh has no part in the result; where several share a place,
/// by their body.
fn by_place(problem: &Problem) -> Vec<usize> {
    let mesh = &problem.mesh;
    let mut body = vec![0; mesh.points.len()];
    for (corners, b) in mesh.triangles.iter().zip(&mesh.body) {
        corners.iter().for_each(|&v| body[v] = *b);
    }
    let mut order: Vec<usize> = (0..mesh.points.len()).collect();
    order.sort_by(|&v, &w| {
        let ([a, b], [c, d]) = (mesh.points[v], mesh.points[w]);
        a.total_cmp(&c).then(b.total_cmp(&d)).then(body[v].cmp(&body[w]))
    });
    order
}

/// 𝓛 of the values per unit thickness, without the triangles that have no unique minimum inside.
fn energy(problem: &Problem, elements: &[Option<Condensed>], values: &[[f64; 2]]) -> f64 {
    let of = |(t, element): (usize, &Condensed)| {
        let nodes = boundary_nodes(problem, t);
        let base = values[nodes[0]];
        let u = SVector::<f64, BOUNDARY>::from_fn(|i, _| values[nodes[i / 2]][i % 2]);
        let bent = SVector::<f64, BOUNDARY>::from_fn(|i, _| u[i] - base[i % 2]);
        0.5 * bent.dot(&(element.matrix * bent)) - element.load.dot(&u)
    };
    elements.iter().enumerate().filter_map(|(t, e)| Some(of((t, e.as_ref()?)))).sum()
}

/// The triangles at each vertex.
struct Stars {
    start: Vec<usize>,
    triangles: Vec<usize>,
}

impl Stars {
    fn new(problem: &Problem) -> Self {
        let mesh = &problem.mesh;
        let mut start = vec![0; mesh.points.len() + 1];
        for v in mesh.triangles.iter().flatten() {
            start[v + 1] += 1;
        }
        for v in 0..mesh.points.len() {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut triangles = vec![0; 3 * mesh.triangles.len()];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for &v in corners {
                triangles[next[v]] = t;
                next[v] += 1;
            }
        }
        Stars { start, triangles }
    }

    fn of(&self, v: usize) -> &[usize] {
        &self.triangles[self.start[v]..self.start[v + 1]]
    }
}

/// The triangles around a vertex, and around the one it faces.
#[derive(Default)]
struct Patch {
    triangles: Vec<usize>,
    vertices: [usize; 2],
    /// Number of each freedom in the patch, `usize::MAX` outside.
    local: Vec<usize>,
    inside: Vec<usize>,
}

impl Patch {
    /// Moves the freedoms inside the patch to the minimum of the energy, and gives the energy gained.
    fn minimise(
        &mut self,
        problem: &Problem,
        elements: &[Option<Condensed>],
        freedoms: &Freedoms,
        values: &mut [[f64; 2]],
    ) -> f64 {
        let mesh = &problem.mesh;
        let vertices = mesh.points.len();
        self.inside.clear();
        let whole = self.triangles.iter().all(|&t| elements[t].is_some());
        for &t in self.triangles.iter().filter(|_| whole) {
            for node in boundary_nodes(problem, t) {
                for f in freedoms.at[node].into_iter().flatten() {
                    let within = |node: usize| match node.checked_sub(vertices) {
                        None => self.vertices.contains(&node),
                        Some(e) => mesh.edges[e].vertices.iter().any(|v| self.vertices.contains(v)),
                    };
                    if self.local[f] == usize::MAX && freedoms.all[f].nodes.into_iter().all(within) {
                        self.local[f] = self.inside.len();
                        self.inside.push(f);
                    }
                }
            }
        }
        let n = if self.inside.len() <= MOST_IN_PATCH { self.inside.len() } else { 0 };
        let mut matrix = DMatrix::<f64>::zeros(n, n);
        let mut load = DVector::<f64>::zeros(n);
        for &t in self.triangles.iter().filter(|_| n > 0) {
            let Some(element) = &elements[t] else { continue };
            let nodes = boundary_nodes(problem, t);
            // About the first corner: translations carry no energy and should cost no digits.
            let base = values[nodes[0]];
            let u = SVector::<f64, BOUNDARY>::from_fn(|i, _| values[nodes[i / 2]][i % 2] - base[i % 2]);
            let residual = element.load - element.matrix * u;
            let terms = |node: usize| {
                freedoms.at[nodes[node]].into_iter().flatten().filter_map(|f| {
                    let local = self.local[f];
                    (local != usize::MAX).then_some((local, freedoms.all[f].direction))
                })
            };
            for a in 0..6 {
                for (i, p) in terms(a) {
                    load[i] += p[0] * residual[2 * a] + p[1] * residual[2 * a + 1];
                    for b in 0..6 {
                        let k = |c: usize, d: usize| element.matrix[(2 * a + c, 2 * b + d)];
                        let row = [p[0] * k(0, 0) + p[1] * k(1, 0), p[0] * k(0, 1) + p[1] * k(1, 1)];
                        for (j, q) in terms(b) {
                            matrix[(i, j)] += row[0] * q[0] + row[1] * q[1];
                        }
                    }
                }
            }
        }
        // A patch that is free to move as a whole stays where it is.
        let mut gained = 0.0;
        if n > 0
            && let Some(factor) = Cholesky::new(matrix)
        {
            let force = load.clone();
            factor.solve_mut(&mut load);
            gained = 0.5 * force.dot(&load).max(0.0);
            for (&f, step) in self.inside.iter().zip(load.iter()).filter(|(_, step)| step.is_finite()) {
                let Freedom { nodes, direction } = freedoms.all[f];
                let count = if nodes[0] == nodes[1] { 1 } else { 2 };
                for &node in &nodes[..count] {
                    values[node][0] += step * direction[0];
                    values[node][1] += step * direction[1];
                }
            }
        }
        for &f in &self.inside {
            self.local[f] = usize::MAX;
        }
        gained
    }
}

/// The six nodes on the boundary of triangle `t`: corners, then edges.
fn boundary_nodes(problem: &Problem, t: usize) -> [usize; 6] {
    let mesh = &problem.mesh;
    let ([a, b, c], [p, q, r]) = (mesh.triangles[t], mesh.triangle_edges[t]);
    let first = mesh.points.len();
    [a, b, c, first + p, first + q, first + r]
}
