//! Contact pressure of both models, averaged with the same weights: the one comparison of pressures that has a bound.
//!
//! Let φ be the hat function of a vertex of Γ_K, n the direction of contact there, and w = φ n the displacement that moves
//! this vertex alone. Where supports and other contacts allow w, both models are in equilibrium with it:
//!
//! ∫ λ_h : e(w) = L(w) + ∫_{ΓK} t φ n·n̂,   ∫ σ(u_h) : e(w) = L(w) − R(φ),
//!
//! with R(φ) the work of the reactions on w; φ n·n̂ is φ where n̂ does not turn. The difference of the two pressures is therefore the
//! work of the difference of the stresses in the triangles around the vertex, bounded by Cauchy–Schwarz:
//!
//! ∫ (−t) φ n·n̂ − R(φ) = −∫ (λ_h − σ(u_h)) : e(w),   |∫ (−t) φ n·n̂ − R(φ)| ≤ Σ_T ‖λ_h − σ(u_h)‖_T ‖e(w)‖_T.
//!
//! Of a solution on quadrilaterals φ is the function of degree 1 in each coordinate; the rest is the same on parallelograms.
//!
//! The equation holds to round-off for a correct solution, the inequality bounds its two sides. Both hold for unbounded pressures
//! too, as under the edge of a punch, where neither a maximum nor an L² norm converges.

use std::collections::{HashMap, HashSet};

use super::pressure::Piece;
use crate::compare::candidate::{Judged, Reactions};
use crate::compare::on_quadrilaterals::hat_gradient;
use crate::compare::stress::primal_means;
use crate::dual::DualSolution;
use crate::element::displacement::bilinear::Bilinear;
use crate::element::geometry::sub_corners;
use crate::element::{Samples, Strains, contraction, elastic_degree};
use crate::problem::{Condition, Interface, Problem};
use crate::vector::dot;

/// Mean pressures at a vertex of Γ_K, weighted by its hat function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodalPressure {
    /// The vertex, of the first side.
    pub vertex: usize,
    /// ∫ φ ds.
    pub weight: f64,
    /// ∫ (−t) φ n·n̂ / ∫ φ of the dual solution.
    pub dual: f64,
    /// R(φ) / ∫ φ of the displacement solution, per thickness.
    pub primal: f64,
    /// −∫ (λ_h − σ(u_h)) : e(w) / ∫ φ, per thickness: the exact value of dual − primal.
    pub explained: f64,
    /// Upper bound of this difference, from the norm of λ_h − σ(u_h).
    pub allowed: f64,
}

/// Comparison of two nodal pressures over a whole interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodalDifference {
    /// L² norm of the dual ones.
    pub norm: f64,
    /// L² norm of the differences.
    pub l2: f64,
    /// L² norm of the allowed differences.
    pub l2_allowed: f64,
    /// Largest force that the stresses leave unexplained, per thickness.
    pub unexplained: f64,
    /// Largest of each model.
    pub largest: [f64; 2],
    /// By how much these two may differ.
    pub largest_allowed: f64,
}

/// Mean pressures at the vertices of `interface` (number `index`) where w is free to move; `own` is the dual pressure,
/// `reactions` those of the solution in `judged`.
pub fn nodal_pressures(
    problem: &Problem,
    (index, interface): (usize, &Interface),
    own: &[Piece],
    dual: &DualSolution,
    judged: &Judged,
    reactions: &Reactions,
) -> Vec<NodalPressure> {
    let normals = free_normals(problem, index, interface);
    let thickness = problem.scene.thickness;
    // Per vertex: ∫ φ and ∫ (−t) φ n·n̂.
    let mut sums: HashMap<usize, [f64; 2]> = HashMap::new();
    let mut force: HashMap<usize, f64> =
        reactions.vertices.iter().copied().zip(reactions.vertex.iter().copied()).collect();
    for pair in interface.pairs.iter().filter(|pair| !pair.direction.is_constant()) {
        for (v, n) in pair.first.into_iter().zip(pair.direction.ends) {
            // w moves the jump at its vertex by n·n.
            if let Some(at) = reactions.vertices.iter().position(|w| *w == v) {
                force.insert(v, reactions.vertex[at] * dot(n, n));
            }
        }
    }
    for (k, (pair, p)) in interface.pairs.iter().zip(own).enumerate() {
        for end in 0..2 {
            let v = pair.first[end];
            let n = pair.direction.ends[end];
            let turns = !pair.direction.is_constant();
            let [own, other] = if turns { [dot(n, n), dot(n, pair.direction.ends[1 - end])] } else { [1.0; 2] };
            let sum = sums.entry(v).or_default();
            sum[0] += 0.5 * pair.length;
            // φ n·n̂, both linear, from this end to the other.
            let mut weight = [own, 0.5 * other, 0.0];
            if end == 1 {
                weight.reverse();
            }
            sum[1] += pair.length * p.integral(&weight);
            let force = force.entry(v).or_default();
            let inner = reactions.edge.as_ref().and_then(|e| e.get(k)).map_or(&[][..], Vec::as_slice);
            // Bernstein coefficients of the jump φ n·n̂ on degree k, one more where n̂ turns, counted from this end.
            let degree = (inner.len() + 1) as f64;
            let from_here = |j: usize| (if end == 0 { j + 1 } else { inner.len() - j }) as f64 / degree;
            for (j, r) in inner.iter().enumerate() {
                let s = from_here(j);
                *force += r * if turns { turning_hat(s, degree, own, other) } else { 1.0 - s };
            }
        }
    }
    let works = match &judged.candidate.on_quadrilaterals {
        None => works(problem, dual, judged, &normals),
        Some(_) => works_on_quadrilaterals(problem, dual, judged, &normals),
    };
    let mut vertices: Vec<usize> = normals.into_keys().collect();
    vertices.sort_unstable();
    vertices
        .into_iter()
        .map(|v| {
            let [weight, pressure] = sums[&v];
            let [work, size] = works.get(&v).copied().unwrap_or_default();
            NodalPressure {
                vertex: v,
                weight,
                dual: pressure / weight,
                primal: force[&v] / (thickness * weight),
                explained: -work / weight,
                allowed: size / weight,
            }
        })
        .collect()
}

/// The Bernstein coefficient at `s` of φ n·n̂ in degree `k`: φ of degree k − 1 falls from 1 to 0, and n·n̂ goes from `own` to `other`.
fn turning_hat(s: f64, k: f64, own: f64, other: f64) -> f64 {
    let r = s * k;
    ((k - r) * (1.0 - r / (k - 1.0)) * own + r * (1.0 - (r - 1.0) / (k - 1.0)) * other) / k
}

/// Compares the mean pressures of one interface; `None` without any.
pub fn difference(nodes: &[NodalPressure]) -> Option<NodalDifference> {
    let l2 = |of: &dyn Fn(&NodalPressure) -> f64| nodes.iter().map(|n| n.weight * of(n).powi(2)).sum::<f64>().sqrt();
    let top = |of: fn(&NodalPressure) -> f64| nodes.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
    let (dual, primal) = (top(|n| n.dual)?, top(|n| n.primal)?);
    Some(NodalDifference {
        norm: l2(&|n| n.dual),
        l2: l2(&|n| n.dual - n.primal),
        l2_allowed: l2(&|n| n.allowed),
        unexplained: nodes.iter().fold(0.0, |m, n| m.max(n.weight * (n.dual - n.primal - n.explained).abs())),
        largest: [dual.dual, primal.primal],
        // max p − max q is at most p − q where p is largest, and at least p − q where q is.
        largest_allowed: dual.allowed.max(primal.allowed),
    })
}

/// The vertices of the first side at which w = φ n is admissible in both directions apart from this contact, with n.
fn free_normals(problem: &Problem, index: usize, interface: &Interface) -> HashMap<usize, [f64; 2]> {
    let mut normals: HashMap<usize, [f64; 2]> = HashMap::new();
    let mut held: HashSet<usize> = HashSet::new();
    for pair in &interface.pairs {
        for (v, direction) in pair.first.into_iter().zip(pair.direction.ends) {
            let n = *normals.entry(v).or_insert(direction);
            // Where t̂ turns, a motion along one n̂ is one along the sides too.
            let rubs = pair.friction.is_some() && !pair.direction.is_constant();
            if rubs || dot(n, direction) < (1.0 - ALIGNED) * dot(n, n) {
                held.insert(v);
            }
        }
    }
    for (e, condition) in problem.conditions.iter().enumerate() {
        for v in problem.mesh.edges[e].vertices {
            let Some(&n) = normals.get(&v) else { continue };
            let across = |d: [f64; 2]| dot(n, d).abs() > ALIGNED;
            let stops = match condition {
                Condition::Interior | Condition::Traction(_) => false,
                Condition::Clamped(_) | Condition::Axis | Condition::Elastic { .. } => true,
                Condition::Contact { interface, side: 0, .. } if *interface == index => false,
                Condition::Roller { direction, .. } => across(*direction),
                Condition::Contact { interface, pair, .. } => {
                    problem.interfaces[*interface].pairs[*pair].friction.is_some()
                        || across(problem.mesh.edge_frame(e).1)
                }
            };
            if stops {
                held.insert(v);
            }
        }
    }
    normals.retain(|v, _| !held.contains(v));
    normals
}

/// Cosines this close to 0 or 1 count as 0 or 1.
const ALIGNED: f64 = 1e-9;

/// ∫ (λ_h − σ(u_h)) : e(φ n) and Σ_T ‖λ_h − σ(u_h)‖_T ‖e(φ n)‖_T for the hat function of each vertex, per thickness.
fn works(
    problem: &Problem,
    dual: &DualSolution,
    judged: &Judged,
    normals: &HashMap<usize, [f64; 2]>,
) -> HashMap<usize, [f64; 2]> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let means = primal_means(problem, judged);
    let mut sums: HashMap<usize, [f64; 2]> = HashMap::new();
    for (t, vertices) in mesh.triangles.iter().enumerate() {
        for (i, v) in vertices.iter().enumerate() {
            let Some(n) = normals.get(v) else { continue };
            let corners = mesh.corners(t);
            let (p, a, b) = (corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let area = mesh.area(t);
            // ∇φ is perpendicular to the opposite edge; twice the area, with the sign of the triangle's orientation.
            let twice = (a[0] - p[0]) * (b[1] - p[1]) - (a[1] - p[1]) * (b[0] - p[0]);
            let g = [(a[1] - b[1]) / twice, (b[0] - a[0]) / twice];
            let e = [n[0] * g[0], n[1] * g[1], 0.5 * (n[0] * g[1] + n[1] * g[0])];
            let (l, s) = (dual.stress.mean(t), means[t]);
            let d = [l[0] - s[0], l[1] - s[1], l[2] - s[2]];
            let stress = 2.0 * judged.field.local.triangles[t] / problem.scene.thickness;
            let motion = area * materials[mesh.body[t]].strain_product(e, e);
            let sum = sums.entry(*v).or_default();
            sum[0] += area * contraction(d, e);
            sum[1] += (stress * motion).sqrt();
        }
    }
    sums
}

/// As `works`, for the functions of degree 1 on quadrilaterals, which are parallelograms: all integrands are polynomials.
fn works_on_quadrilaterals(
    problem: &Problem,
    dual: &DualSolution,
    judged: &Judged,
    normals: &HashMap<usize, [f64; 2]>,
) -> HashMap<usize, [f64; 2]> {
    let mesh = &problem.mesh;
    let materials = problem.materials();
    let field = &judged.field.displacement;
    let mut strains = Strains::default();
    let mut sums: HashMap<usize, [f64; 2]> = HashMap::new();
    for cell in mesh.quadrilaterals().filter(|cell| cell.corners.iter().any(|v| normals.contains_key(v))) {
        let map = Bilinear::new(cell.points(mesh));
        for t in cell.triangles {
            let material = &materials[mesh.body[t]];
            let stress = 2.0 * judged.field.local.triangles[t] / problem.scene.thickness;
            let (of_field, own) = (elastic_degree(field.degree(t), material), dual.stress.degree(t));
            let (samples, shapes) = (Samples::of(of_field, own), Samples::of_stress(own, of_field));
            let mut parts = [[0.0; 2]; 4];
            for sub in 0..3 {
                strains.elastic(mesh.corners(t), field, t, sub, material);
                let corners = sub_corners(mesh.corners(t), sub);
                for (q, (l, weight)) in samples.points.iter().enumerate() {
                    let weight = weight * mesh.area(t) / 3.0;
                    let (own, other) =
                        (dual.stress.sample(t, sub, shapes, q), material.stress(strains.sample(samples, q)));
                    let d = [0, 1, 2].map(|c| own[c] - other[c]);
                    let p = [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum());
                    for (i, part) in parts.iter_mut().enumerate() {
                        let Some(n) = normals.get(&cell.corners[i]) else { continue };
                        let g = hat_gradient(&map, i, p);
                        let e = [n[0] * g[0], n[1] * g[1], 0.5 * (n[0] * g[1] + n[1] * g[0])];
                        part[0] += weight * contraction(d, e);
                        part[1] += weight * material.strain_product(e, e);
                    }
                }
            }
            for ([work, motion], v) in parts.into_iter().zip(cell.corners).filter(|(_, v)| normals.contains_key(v)) {
                let sum = sums.entry(v).or_default();
                sum[0] += work;
                sum[1] += (stress * motion).sqrt();
            }
        }
    }
    sums
}
