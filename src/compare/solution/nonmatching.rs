//! A claimed solution on the triangles of its own file, where contact sides have different vertices.
//!
//! Its test functions are those of the file. Whatever the method, mortar, node to segment or quadrature, contact is a pressure
//! λ ≥ 0 along the direction of contact, the same on both sides: on the parts of edges between the vertices of either side, λ does on
//! the jump what forces ≥ 0 do on its Bernstein coefficients there. What such forces cannot balance of the nodal forces is the residual;
//! that they do no work on the opening is asked by the energy identity. Where contact is closed a method may decide at the nodes of
//! one side, or in the mean with the functions of one side, plain or dual, or edge by edge: the least penetration among these counts.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::Solution;
use super::weak::{OF_THE_RULE, Point, Rows, Shape, Weak, longest, nitsche};
use crate::compare::Basis;
use crate::compare::candidate::Candidate;
use crate::compare::{Allowances, Check};
use crate::element::polynomial::quadrature::segment_rule;
use crate::problem::{ContactPair, Interface, Problem, Scales};
use crate::sets::DisjointSets;
use crate::statics::cone::balanced;
use crate::vector::{distance, dot};

/// Weights of shape functions below this are zero: a vertex that lies on an edge lies there to round-off.
const BESIDE: f64 = 1e-6;
/// Above so many coefficients of one contact the forces are not looked for.
const MOST_ROWS: usize = 1500;

/// Parts of shape functions of the file: (node, weight).
type Weights = Vec<(usize, f64)>;

/// A contact condition on the nodes of a file.
struct Row {
    /// The direction of contact with the weight of every node, those of the second side negative.
    terms: Vec<(usize, [f64; 2])>,
    gap: f64,
    /// What its force works on beside the gap: the penetration of a method whose contact is no condition on the jump.
    overlap: f64,
}

/// The solution with its contact.
pub struct Nonmatching<'a> {
    /// The solution on its own triangles.
    pub solution: Solution<'a>,
    /// The problem whose sides were made to match.
    glued: &'a Problem,
    /// Which contacts have more coefficients than can be decided.
    too_many: Vec<usize>,
    /// Of every contact Nitsche's law, where its forces follow it.
    laws: Vec<Option<Weak>>,
}

impl<'a> Nonmatching<'a> {
    /// `solution` is on the mesh of `glued` before contact cut it.
    pub fn new(mut solution: Solution<'a>, glued: &'a Problem) -> Self {
        let space = Space::new(solution.problem, glued, solution.candidate.degree);
        let mut rows: Vec<Vec<Row>> = glued.interfaces.iter().map(|contact| space.rows(&contact.pairs)).collect();
        let too_many: Vec<usize> = (0..rows.len()).filter(|i| rows[*i].len() > MOST_ROWS).collect();
        let law = |i: usize| {
            let pairs = &glued.interfaces[i].pairs;
            let limits = solution.limits(i);
            let points = |rule: usize, _: Shape| space.points(&solution, pairs, rule);
            let found = nitsche(&solution, &limits, &[Shape::Chords], points)?;
            (found.misfit <= solution.weak_part(i)).then_some(found)
        };
        let laws: Vec<Option<Weak>> =
            (0..rows.len()).map(|i| if too_many.contains(&i) { None } else { law(i) }).collect();
        for row in laws.iter().zip(&mut rows).filter(|(law, _)| law.is_some()).flat_map(|(_, rows)| rows) {
            row.overlap = row.excess(solution.candidate);
        }
        solution.beside.resize(solution.rest.len(), [0.0; 2]);
        for (node, force) in laws.iter().flatten().flat_map(|law| &law.terms) {
            let force = solution.hold(*node).project(*force);
            (0..2).for_each(|c| {
                solution.rest[*node][c] -= force[c];
                solution.beside[*node][c] += force[c];
            });
        }
        let all: Vec<&Row> = rows.iter().flatten().collect();
        for group in groups(&all, solution.rest.len()) {
            if group.len() <= MOST_ROWS {
                let rows: Vec<&Row> = group.into_iter().map(|row| all[row]).collect();
                let [on_gaps, force] = take(&rows, &mut solution);
                solution.on_gaps += on_gaps;
                let deepest = rows.iter().map(|row| row.excess(solution.candidate)).fold(0.0, f64::max);
                solution.of_the_rule += solution.rule() * force * deepest;
            }
        }
        Nonmatching { solution, glued, too_many, laws }
    }

    /// All checks; `scales` says what counts as no force and no energy, `allow` what was asked for.
    pub fn checks(&self, scales: &Scales, allow: &Allowances) -> Vec<Check> {
        let mut checks = self.solution.checks(scales, &Allowances::default());
        if let Some(first) = self.too_many.first() {
            let name = &self.glued.interfaces[*first].name;
            let why = format!(
                "The sides of contact {name} have different vertices, more than {MOST_ROWS} together, and the forces between them were \
                 not looked for; give both sides the same vertices."
            );
            let forces = ["solution/residual", "solution/reactions", "solution/energy-identity"];
            for check in checks.iter_mut().filter(|check| forces.contains(&check.name.as_str())) {
                *check = Check::not_made(&check.name, check.allowed, check.basis, why.as_str());
            }
        }
        checks.extend((0..self.glued.interfaces.len()).map(|index| self.penetration_check(index)));
        if let Some(contact) = self.glued.interfaces.iter().find(|contact| self.bends(contact)) {
            let why = format!(
                "The sides of contact {} divide a curve differently. What lies between their edges and along which normals forces act \
                 there each program decides for itself, and no field of its own is a solution for the edges of this report. Give both \
                 sides the same vertices.",
                contact.name
            );
            let of_contact = |check: &&mut Check| !check.passed && check.decides() && check.name != "solution/supports";
            for check in checks.iter_mut().filter(of_contact) {
                *check = Check::not_made(&check.name, check.allowed, check.basis, why.as_str());
            }
        }
        allow.apply(&mut checks);
        checks
    }

    /// Whether vertices of the other side were put beside edges that stand for a curve.
    fn bends(&self, contact: &Interface) -> bool {
        let Some(uncut) = &self.glued.uncut else { return false };
        let mesh = &self.glued.mesh;
        let is_cut = |e: &usize| mesh.edges[*e].triangles[0].is_some_and(|t| uncut.is_cut(mesh, t));
        contact.pairs.iter().any(|pair| !pair.direction.is_constant() && pair.edges.iter().flatten().any(is_cut))
    }

    /// What is left at the triangles of `glued`: of each that of the triangle that it is a part of.
    pub fn by_triangle(&self) -> Vec<f64> {
        let own = self.solution.by_triangle();
        match &self.glued.uncut {
            Some(uncut) => uncut.parent.iter().map(|parent| own[*parent]).collect(),
            None => own,
        }
    }

    fn penetration_check(&self, index: usize) -> Check {
        let contact = &self.glued.interfaces[index];
        let (way, depth) = self.penetration(&contact.pairs);
        let depth = depth.max(0.0);
        let deepest = self.excesses(&contact.pairs).into_iter().flatten().fold(0.0, f64::max);
        let name = format!("solution/contact/{}/penetration", contact.name);
        if let Some(law) = &self.laws[index] {
            let why = format!(
                "The sides have different vertices, and contact holds {}: what of the contact forces does not follow this law, relative \
                 to all of this contact. The sides overlap by up to {deepest:.3e}, which is no mistake of such a method; the bounds of \
                 this report are those of the field made admissible.",
                law.in_words()
            );
            return Check::at_most(&name, law.misfit, 0.0, self.solution.weak_part(index), Basis::Claimed, why);
        }
        let why = format!(
            "The sides have different vertices, and nothing penetrates {way}, relative to the largest displacement. Between these \
             places the deepest penetration is {deepest:.3e}."
        );
        let mut allowance = self.solution.of_displacements(2.0);
        let of_the_rule = |part: f64| part * self.solution.relative(deepest).min(allowance.ceiling);
        let claimable = self.solution.relative(depth) <= of_the_rule(OF_THE_RULE);
        allowance.exact += of_the_rule(self.solution.rule());
        let mut check = self.solution.claimed(&name, self.solution.relative(depth), allowance, why);
        if !check.passed && claimable {
            check.why += " A method that integrates contact by a rule of its own leaves as little; with --contact weak the field \
                          may say that it comes from one.";
        }
        check
    }

    /// Excess of the jump above the gap at the two ends and in the middle of every pair.
    fn excesses(&self, pairs: &[ContactPair]) -> Vec<[f64; 3]> {
        let candidate = self.solution.candidate;
        let space = Space::new(self.solution.problem, self.glued, candidate.degree);
        let of = |pair: &ContactPair| [0.0, 1.0, 0.5].map(|at| space.row(pair, at).excess(candidate));
        pairs.iter().map(of).collect()
    }

    /// The least penetration by any of the ways in which a method may decide contact, and the words for it.
    fn penetration(&self, pairs: &[ContactPair]) -> (&'static str, f64) {
        let space = Space::new(self.solution.problem, self.glued, self.solution.candidate.degree);
        let excesses = self.excesses(pairs);
        let mut least = ("anywhere", f64::INFINITY);
        for side in 0..2 {
            let mut nodes: BTreeMap<usize, f64> = BTreeMap::new();
            // By node, in the mean with hat functions and with dual ones: ∫ψ e and ∫φ.
            let mut means: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
            let mut edges: BTreeMap<Vec<usize>, [f64; 2]> = BTreeMap::new();
            for (pair, [a, b, middle]) in pairs.iter().zip(&excesses) {
                let Some(ends) = [Some(pair.first), pair.second][side] else { continue };
                let weights = ends.map(|v| space.corners(v));
                for (v, e) in ends.into_iter().zip([a, b]) {
                    if v < space.vertices {
                        nodes.entry(v).and_modify(|most| *most = most.max(*e)).or_insert(*e);
                    }
                }
                let mut own: Vec<usize> = weights.iter().flatten().map(|(node, _)| *node).collect();
                own.sort_unstable();
                own.dedup();
                for node in &own {
                    let weight =
                        |end: usize| weights[end].iter().find(|(n, _)| n == node).map_or(0.0, |(_, weight)| *weight);
                    let [p, q] = [weight(0), weight(1)];
                    let simpson = |[f, g, h]: [f64; 3]| pair.length / 6.0 * (f * a + 4.0 * g * middle + h * b);
                    let mean = means.entry(*node).or_default();
                    mean[0] += simpson([p, 0.5 * (p + q), q]);
                    mean[1] += simpson([3.0 * p - 1.0, 1.5 * (p + q) - 1.0, 3.0 * q - 1.0]);
                    mean[2] += 0.5 * pair.length * (p + q);
                }
                let edge = edges.entry(own).or_default();
                edge[0] += pair.length / 6.0 * (a + 4.0 * middle + b);
                edge[1] += pair.length;
            }
            let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
            let of_means = |which: usize| most(&mut means.values().map(|mean| mean[which] / mean[2]));
            let words = WAYS[side];
            let ways = [
                (words[0], most(&mut nodes.values().copied())),
                (words[1], of_means(0)),
                (words[2], of_means(1)),
                (words[3], most(&mut edges.values().map(|edge| edge[0] / edge[1]))),
            ];
            // A side without values is rigid.
            for way in ways.into_iter().filter(|way| way.1.is_finite()) {
                if way.1.max(0.0) < least.1 {
                    least = (way.0, way.1.max(0.0));
                }
            }
        }
        least
    }
}

/// The ways to decide contact, by side.
const WAYS: [[&str; 4]; 2] = [
    [
        "at the vertices of the first side",
        "in the mean over the functions of the first side",
        "in the mean over the dual functions of the first side",
        "in the mean over the edges of the first side",
    ],
    [
        "at the vertices of the second side",
        "in the mean over the functions of the second side",
        "in the mean over the dual functions of the second side",
        "in the mean over the edges of the second side",
    ],
];

impl Row {
    /// (v' − v'')·n̂ − g.
    fn excess(&self, candidate: &Candidate) -> f64 {
        self.terms.iter().map(|(node, d)| dot(*d, candidate.value(*node))).sum::<f64>() - self.gap
    }

    /// 2 · `self` − ½ (`a` + `b`): the middle Bernstein coefficient of a jump with the value `self` in the middle.
    fn bernstein(self, [a, b]: [&Row; 2]) -> Row {
        let mut terms: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (row, factor) in [(&self, 2.0), (a, -0.5), (b, -0.5)] {
            for (node, d) in &row.terms {
                let sum = terms.entry(*node).or_default();
                *sum = [sum[0] + factor * d[0], sum[1] + factor * d[1]];
            }
        }
        Row { terms: terms.into_iter().collect(), gap: 2.0 * self.gap - 0.5 * (a.gap + b.gap), overlap: 0.0 }
    }
}

/// The shape functions of a file at places of the mesh that was made of it.
struct Space<'a> {
    own: &'a Problem,
    glued: &'a Problem,
    degree: usize,
    /// Vertices of the file.
    vertices: usize,
    /// Of every vertex of the mesh, a triangle at it.
    at: Vec<usize>,
}

impl<'a> Space<'a> {
    fn new(own: &'a Problem, glued: &'a Problem, degree: usize) -> Self {
        let mut at = vec![0; glued.mesh.points.len()];
        for (t, corners) in glued.mesh.triangles.iter().enumerate() {
            corners.iter().for_each(|v| at[*v] = t);
        }
        Space { own, glued, degree, vertices: own.mesh.points.len(), at }
    }

    /// The rows of a contact: values of the jump at the ends of pairs, and of quadratic fields the coefficient between them.
    fn rows(&self, pairs: &[ContactPair]) -> Vec<Row> {
        let mut ends: BTreeMap<(usize, Option<usize>), Vec<[f64; 2]>> = BTreeMap::new();
        let mut rows = Vec::new();
        for pair in pairs {
            let of_ends = [0.0, 1.0].map(|at| self.row(pair, at));
            if self.degree > 1 {
                rows.push(self.row(pair, 0.5).bernstein([&of_ends[0], &of_ends[1]]));
            }
            for (end, row) in of_ends.into_iter().enumerate() {
                let normal = pair.direction.ends[end];
                let known = ends.entry((pair.first[end], pair.second.map(|second| second[end]))).or_default();
                if !known.contains(&normal) {
                    known.push(normal);
                    rows.push(row);
                }
            }
        }
        rows
    }

    /// The jump at a part `at` of a pair.
    fn row(&self, pair: &ContactPair, at: f64) -> Row {
        let direction = pair.direction.at(at);
        let side = |ends: [usize; 2]| match at {
            0.0 => self.nodes(self.at[ends[0]], self.glued.mesh.points[ends[0]]),
            1.0 => self.nodes(self.at[ends[1]], self.glued.mesh.points[ends[1]]),
            _ => {
                let [p, q] = ends.map(|v| self.glued.mesh.points[v]);
                let t = self.beside(ends);
                self.nodes(t, [p[0] + at * (q[0] - p[0]), p[1] + at * (q[1] - p[1])])
            }
        };
        let term = |sign: f64| move |(node, w): (usize, f64)| (node, direction.map(|d| sign * w * d));
        let mut terms: Vec<(usize, [f64; 2])> = side(pair.first).into_iter().map(term(1.0)).collect();
        terms.extend(pair.second.map(side).into_iter().flatten().map(term(-1.0)));
        Row { terms, gap: (1.0 - at) * pair.gap[0] + at * pair.gap[1], overlap: 0.0 }
    }

    /// The points of a rule on every pair, with the jump and the normal stresses in the nodes of the file.
    fn points(&self, solution: &Solution<'_>, pairs: &[ContactPair], rule: usize) -> Vec<Point> {
        let mut points = Vec::new();
        for pair in pairs {
            let sides = [Some(pair.first), pair.second].map(|ends| ends.map(|ends| (ends, self.beside(ends))));
            for (at, part) in segment_rule(rule) {
                let row = self.row(pair, *at);
                let mut lengths = [pair.length; 4];
                let mut stress: [Rows; 2] = Default::default();
                for (side, (ends, t)) in sides.into_iter().enumerate().filter_map(|(i, side)| Some((i, side?))) {
                    let [p, q] = ends.map(|v| self.glued.mesh.points[v]);
                    let point = [0, 1].map(|c| p[c] + at * (q[c] - p[c]));
                    let (parent, corners) = self.barycentric(t, point);
                    let vertices = self.own.mesh.triangles[parent];
                    let weight = |v: usize| corners.iter().find(|(w, _)| *w == v).map_or(0.0, |(_, weight)| *weight);
                    let l = vertices.map(weight);
                    stress[side] = solution.normal_stress(parent, l, pair.direction.at(*at));
                    let [a, b] = match corners[..] {
                        [(a, _), (b, _)] => [a, b].map(|v| self.own.mesh.points[v]),
                        _ => [p, q],
                    };
                    lengths[2 * side] = distance(a, b);
                    lengths[2 * side + 1] = longest(self.own.mesh.corners(parent));
                }
                if pair.second.is_none() {
                    lengths = [lengths[0], lengths[1], lengths[0], lengths[1]];
                }
                points.push(Point {
                    weight: self.own.scene.thickness * pair.length * part,
                    excess: row.excess(solution.candidate),
                    lengths,
                    carries: true,
                    jump: row.terms,
                    stress,
                });
            }
        }
        points
    }

    /// The triangle of the edge between two vertices.
    fn beside(&self, ends: [usize; 2]) -> usize {
        let has = |t: usize| ends.iter().all(|v| self.glued.mesh.triangles[t].contains(v));
        let edges = self.glued.pairs().flat_map(|pair| pair.edges).flatten();
        let mut triangles = edges.filter_map(|e| self.glued.mesh.edges[e].triangles[0]);
        triangles.find(|t| has(*t)).unwrap_or(self.at[ends[0]])
    }

    /// The corners of the file at a vertex of the mesh.
    fn corners(&self, vertex: usize) -> Weights {
        self.barycentric(self.at[vertex], self.glued.mesh.points[vertex]).1
    }

    /// The nodes of the file at a point of triangle `t` of the mesh.
    fn nodes(&self, t: usize, point: [f64; 2]) -> Weights {
        let (parent, corners) = self.barycentric(t, point);
        if self.degree == 1 {
            return corners;
        }
        let mesh = &self.own.mesh;
        let weight = |v: usize| corners.iter().find(|(w, _)| *w == v).map_or(0.0, |(_, weight)| *weight);
        let l = mesh.triangles[parent].map(weight);
        let corner = (0..3).map(|i| (mesh.triangles[parent][i], l[i] * (2.0 * l[i] - 1.0)));
        let middle =
            (0..3).map(|i| (self.vertices + mesh.triangle_edges[parent][i], 4.0 * l[(i + 1) % 3] * l[(i + 2) % 3]));
        corner.chain(middle).filter(|(_, weight)| *weight != 0.0).collect()
    }

    /// The triangle of the file that triangle `t` of the mesh is a part of, and its corners with their barycentric coordinates.
    fn barycentric(&self, t: usize, point: [f64; 2]) -> (usize, Weights) {
        let parent = self.glued.uncut.as_ref().map_or(t, |uncut| uncut.parent[t]);
        let corners = self.own.mesh.triangles[parent];
        // Vertices that contact moved are where it moved them.
        let [a, b, c] = corners.map(|v| self.glued.mesh.points[v]);
        let area =
            |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let whole = area(a, b, c);
        let l = [area(point, b, c), area(a, point, c), area(a, b, point)].map(|part| part / whole);
        let l = l.map(|x| if x.abs() < BESIDE { 0.0 } else { x });
        let sum: f64 = l.iter().sum();
        (parent, corners.into_iter().zip(l).filter(|(_, x)| *x != 0.0).map(|(v, x)| (v, x / sum)).collect())
    }
}

/// Rows that share nodes, as indices.
fn groups(rows: &[&Row], nodes: usize) -> Vec<Vec<usize>> {
    let mut sets = DisjointSets::new(nodes);
    for row in rows {
        for (node, _) in &row.terms {
            sets.join(row.terms[0].0, *node);
        }
    }
    let (label, _) = sets.labels();
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| !row.terms.is_empty()) {
        groups.entry(label[row.terms[0].0]).or_default().push(index);
    }
    groups.into_values().collect()
}

/// Takes out of the nodal forces of `solution` what forces ≥ 0 on `rows` can balance; gives their work on the gaps, and their sum.
fn take(rows: &[&Row], solution: &mut Solution<'_>) -> [f64; 2] {
    let mut nodes: Vec<usize> = rows.iter().flat_map(|row| row.terms.iter().map(|(node, _)| *node)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    // Forces are weighed as the residual is.
    let root = |node: usize| solution.forces.stiffness[node].max(f64::MIN_POSITIVE).sqrt();
    let mut units = Vec::new();
    let mut works = Vec::new();
    for row in rows {
        let mut unit = DVector::<f64>::zeros(2 * nodes.len());
        for (node, d) in &row.terms {
            let Ok(place) = nodes.binary_search(node) else { continue };
            let d = solution.hold(*node).project(*d);
            (0..2).for_each(|c| unit[2 * place + c] += d[c] / root(*node));
        }
        let length = unit.norm();
        if length > f64::MIN_POSITIVE {
            units.push(unit / length);
            works.push([(row.gap + row.overlap) / length, 1.0 / length]);
        }
    }
    let load = nodes.iter().flat_map(|node| solution.rest[*node].map(|x| -x / root(*node)));
    let load = DVector::from_iterator(2 * nodes.len(), load);
    // Where the working set does not settle, the whole force is left over and the check fails in the open.
    let Ok((rest, forces)) = balanced(&load, &units) else { return [0.0; 2] };
    for (place, node) in nodes.iter().enumerate() {
        let root = solution.forces.stiffness[*node].max(f64::MIN_POSITIVE).sqrt();
        solution.rest[*node] = [rest[2 * place] * root, rest[2 * place + 1] * root];
    }
    forces.into_iter().fold([0.0; 2], |sum, (row, force)| [0, 1].map(|i| sum[i] + force * works[row][i]))
}
