//! Nitsche's method: the pressure is [(j − g)/γ − σ_n]₊, and σ_n(φ) is tested against θ max(j − g, γσ_n).
//!
//! With v_n the jump of a displacement, ∫ σ(u):e(v) − L(v) = −∫ [(j − g)/γ − σ_n]₊ v_n + θ ∫ max(j − g, γσ_n) σ_n(v), where γ is a
//! constant times a length of the mesh. The constant is sought on a line, θ follows from it by least squares.

use std::collections::BTreeMap;

use super::super::Solution;
use super::stations::{Rows, Shape, Station};
use super::{Law, Limits, Weak};
use crate::vector::{distance, dot};

/// Degrees of the rules that are tried; the first is used to choose everything else.
const RULES: [usize; 6] = [4, 0, 2, 6, 8, 24];
/// Powers of ten of γE over a length, and the step between those that are tried.
const POWERS: [f64; 3] = [-5.0, 1.0, 0.125];
/// Steps of the golden section.
const STEPS: usize = 60;
/// Largest misfit of the forces with which a law is considered before its rule is known.
const NEAR: f64 = 0.2;

/// The misfit without penetrations, or without normal stresses, has to be this many times as large.
const MATTERS: f64 = 10.0;

/// A quadrature point along a contact, on the nodes of the field.
pub struct Point {
    /// ds times the thickness.
    pub weight: f64,
    /// (v' − v'')·n̂ − g.
    pub excess: f64,
    /// Lengths that γ may be proportional to: those of an edge and of an element of either side.
    pub lengths: [f64; 4],
    /// True if the edge carries a force.
    pub carries: bool,
    /// Shape functions of the jump.
    pub jump: Rows,
    /// n̂·σ(φ)n̂ of the shape functions of either side.
    pub stress: [Rows; 2],
}

/// Data of all quadrature points along a contact, on the nodes involved.
struct Terms {
    /// For every point: weight, excess, normal stress, length, and a flag that is true if the edge carries a force.
    points: Vec<(f64, f64, f64, f64, bool)>,
    /// Shape functions of the jump and of the normal stress: (entry of the vectors, value).
    jumps: Vec<Vec<(usize, f64)>>,
    stresses: Vec<Vec<(usize, f64)>>,
    /// Nodes, whose entries are 2i and 2i + 1.
    nodes: Vec<usize>,
    /// Projected nodal forces, each over √K_ii.
    wanted: Vec<f64>,
}

/// A law of the family.
#[derive(Clone, Copy)]
struct Fit {
    power: f64,
    theta: f64,
    misfit: f64,
}

/// A variant of the law: the length in γ, the shares of the two sides in the normal stress, and the pressure used.
#[derive(Clone, Copy)]
struct Variant {
    /// Index into [`Point::lengths`], if γ is proportional to a length.
    size: Option<usize>,
    shares: [f64; 2],
    signed: bool,
    shape: Shape,
}

/// Nitsche's law nearest to the forces along a contact; `points` gives its points for the degree of a rule and the shape of the gap.
pub fn nitsche(
    solution: &Solution<'_>,
    limits: &Limits,
    shapes: &[Shape],
    points: impl Fn(usize, Shape) -> Vec<Point>,
) -> Option<Weak> {
    let mut best: Option<(Variant, Fit)> = None;
    for &shape in shapes {
        let points = points(RULES[0], shape);
        let rigid = points.iter().all(|point| point.stress[1].is_empty());
        let shares: &[[f64; 2]] = if rigid { &[[1.0, 0.0]] } else { &[[0.5, 0.5], [1.0, 0.0], [0.0, 1.0]] };
        for signed in [false, true] {
            for size in sizes(&points) {
                for &shares in shares {
                    let variant = Variant { size, shares, signed, shape };
                    let terms = Terms::new(solution, &points, variant);
                    let fit = terms.fit(solution, signed);
                    if best.as_ref().is_none_or(|(_, known)| fit.misfit < known.misfit) {
                        best = Some((variant, fit));
                    }
                    if fit.misfit <= limits.part {
                        return weak(solution, terms, variant, fit);
                    }
                }
            }
        }
    }
    let (variant, _) = best.filter(|(_, fit)| fit.misfit <= NEAR)?;
    let fit = |rule: usize| {
        let terms = Terms::new(solution, &points(rule, variant.shape), variant);
        let fit = terms.fit(solution, variant.signed);
        (terms, fit)
    };
    let (terms, fit) = RULES.map(fit).into_iter().min_by(|a, b| a.1.misfit.total_cmp(&b.1.misfit))?;
    weak(solution, terms, variant, fit)
}

/// The lengths to try: those of the second side only if they differ from those of the first.
fn sizes(points: &[Point]) -> impl Iterator<Item = Option<usize>> {
    let differ = |size: usize| points.iter().any(|point| point.lengths[size] != point.lengths[size - 2]);
    let second = [2, 3].into_iter().filter(|size| differ(*size)).map(Some).collect::<Vec<_>>();
    [Some(0), Some(1), None].into_iter().chain(second)
}

fn weak(solution: &Solution<'_>, terms: Terms, variant: Variant, fit: Fit) -> Option<Weak> {
    let gamma = 10.0_f64.powf(fit.power);
    if MATTERS * fit.misfit > terms.misfit_of_less(solution) {
        return None;
    }
    let (_, against) = terms.vectors(gamma, variant.signed);
    let forces = terms
        .nodes
        .iter()
        .enumerate()
        .map(|(i, node)| (*node, [fit.theta * against[2 * i], fit.theta * against[2 * i + 1]]));
    let pulling = terms.points.iter().map(|point| point.0 * (-pressure(point, gamma, variant.signed)).max(0.0)).sum();
    Some(Weak {
        law: Law::Nitsche { theta: fit.theta, gamma, per_length: variant.size.is_some() },
        penetration: 0.0,
        misfit: fit.misfit,
        pulling,
        terms: forces.collect(),
    })
}

/// [(j − g)/γ − σ_n]₊, or without the bracket where the edge carries a force.
fn pressure(&(_, excess, stress, length, carries): &(f64, f64, f64, f64, bool), gamma: f64, signed: bool) -> f64 {
    let pressed = excess / (gamma * length) - stress;
    match signed {
        true if carries => pressed,
        true => 0.0,
        false => pressed.max(0.0),
    }
}

impl Terms {
    fn new(solution: &Solution<'_>, points: &[Point], variant: Variant) -> Self {
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        let mut nodes = Vec::new();
        let mut entries = |rows: &mut dyn Iterator<Item = (usize, [f64; 2])>| {
            let mut list = Vec::new();
            for (node, value) in rows {
                let next = known.len();
                let i = *known.entry(node).or_insert(next);
                if i == next {
                    nodes.push(node);
                }
                list.extend([(2 * i, value[0]), (2 * i + 1, value[1])]);
            }
            list
        };
        let (mut found, mut jumps, mut stresses) = (Vec::new(), Vec::new(), Vec::new());
        for point in points {
            let sides = point.stress.iter().zip(variant.shares).filter(|(_, share)| *share != 0.0);
            let rows: Rows = sides
                .flat_map(|(rows, share)| rows.iter().map(move |(node, row)| (*node, row.map(|x| share * x))))
                .collect();
            let stress = rows.iter().map(|(node, row)| dot(*row, solution.candidate.value(*node))).sum();
            let length = variant.size.map_or(1.0, |size| point.lengths[size]);
            found.push((point.weight, point.excess, stress, length, point.carries));
            jumps.push(entries(&mut point.jump.iter().copied()));
            stresses.push(entries(&mut rows.into_iter()));
        }
        let forces: Vec<f64> = nodes.iter().flat_map(|node| solution.unsupported[*node]).collect();
        let mut terms = Terms { points: found, jumps, stresses, nodes, wanted: Vec::new() };
        terms.wanted = terms.weighed(solution, &forces);
        terms
    }

    /// Nodal forces that supports do not take, each over √K_ii.
    fn weighed(&self, solution: &Solution<'_>, forces: &[f64]) -> Vec<f64> {
        let of = |(i, node): (usize, &usize)| {
            let free = solution.hold(*node).project([forces[2 * i], forces[2 * i + 1]]);
            free.map(|f| f / solution.forces.stiffness[*node].max(f64::MIN_POSITIVE).sqrt())
        };
        self.nodes.iter().enumerate().flat_map(of).collect()
    }

    /// Nodal forces of the pressure, and those that θ multiplies.
    fn vectors(&self, gamma: f64, signed: bool) -> (Vec<f64>, Vec<f64>) {
        let (mut pressed, mut against) = (vec![0.0; 2 * self.nodes.len()], vec![0.0; 2 * self.nodes.len()]);
        for ((point, jump), stress) in self.points.iter().zip(&self.jumps).zip(&self.stresses) {
            let &(weight, excess, normal, length, carries) = point;
            let p = weight * pressure(point, gamma, signed);
            jump.iter().for_each(|(i, value)| pressed[*i] -= p * value);
            let tested = match signed {
                true => {
                    if carries {
                        excess
                    } else {
                        0.0
                    }
                }
                false => excess.max(gamma * length * normal),
            };
            stress.iter().for_each(|(i, value)| against[*i] += weight * tested * value);
        }
        (pressed, against)
    }

    fn at(&self, solution: &Solution<'_>, power: f64, signed: bool) -> Fit {
        let (pressed, against) = self.vectors(10.0_f64.powf(power), signed);
        let [pressed, against] = [pressed, against].map(|forces| self.weighed(solution, &forces));
        let left: Vec<f64> = self.wanted.iter().zip(&pressed).map(|(r, p)| r - p).collect();
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let square = sum(&against, &against);
        let theta = if square > 0.0 { sum(&left, &against) / square } else { 0.0 };
        let rest: f64 = left.iter().zip(&against).map(|(r, b)| (r - theta * b).powi(2)).sum();
        Fit { power, theta, misfit: (rest / sum(&self.wanted, &self.wanted)).sqrt() }
    }

    /// The smaller misfit of two simpler laws: without penetrations, where the pressure is the normal stress whatever the sides do, and
    /// without normal stresses, which is a penalty.
    fn misfit_of_less(&self, solution: &Solution<'_>) -> f64 {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let all = sum(&self.wanted, &self.wanted);
        let of = |pressure: fn(f64, f64) -> f64, free: bool| {
            let mut forces = vec![0.0; 2 * self.nodes.len()];
            for ((weight, excess, stress, ..), jump) in self.points.iter().zip(&self.jumps) {
                let p = weight * pressure(*excess, *stress);
                jump.iter().for_each(|(i, value)| forces[*i] -= p * value);
            }
            let forces = self.weighed(solution, &forces);
            let square = sum(&forces, &forces);
            let factor = if free && square > 0.0 { sum(&forces, &self.wanted) / square } else { 1.0 };
            let rest: f64 = self.wanted.iter().zip(&forces).map(|(r, f)| (r - factor * f).powi(2)).sum();
            (rest / all).sqrt()
        };
        of(|_, stress| (-stress).max(0.0), false).min(of(|excess, _| excess.max(0.0), true))
    }

    /// The γ that brings the forces nearest.
    fn fit(&self, solution: &Solution<'_>, signed: bool) -> Fit {
        let materials = solution.problem.materials();
        let young = materials.iter().map(|material| material.young()[0]).fold(f64::INFINITY, f64::min);
        let [low, high, step] = POWERS;
        let count = ((high - low) / step) as usize;
        let tried = (0..=count).map(|k| self.at(solution, low + step * k as f64 - young.log10(), signed));
        let worst = Fit { power: low - young.log10(), theta: 0.0, misfit: f64::INFINITY };
        let best = tried.fold(worst, |best, fit| if fit.misfit < best.misfit { fit } else { best });
        if best.misfit > 2.0 * NEAR {
            return best;
        }
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut a, mut b) = (best.power - step, best.power + step);
        let inner = |a: f64, b: f64| [b - golden * (b - a), a + golden * (b - a)];
        let mut fits = inner(a, b).map(|power| self.at(solution, power, signed));
        for _ in 0..STEPS {
            if fits[0].misfit < fits[1].misfit {
                b = fits[1].power;
                fits = [self.at(solution, inner(a, b)[0], signed), fits[0]];
            } else {
                a = fits[0].power;
                fits = [fits[1], self.at(solution, inner(a, b)[1], signed)];
            }
        }
        if fits[0].misfit < fits[1].misfit { fits[0] } else { fits[1] }
    }
}

impl Solution<'_> {
    /// The points of a rule along contact `interface`, whose sides match.
    pub(super) fn points_along(&self, interface: usize, rule: usize, shape: Shape, limits: &Limits) -> Vec<Point> {
        let point = |station: Station| {
            let pairs = &self.problem.interfaces[interface].pairs;
            let span = &self.sites.edges[station.edge];
            let n = pairs[span.pair].direction.at(station.at);
            let sides = |site: &(usize, f64)| {
                let (of, value) = (&self.sites.list[site.0], site.1);
                let node = |node: Option<usize>, sign: f64| Some((node?, n.map(|x| sign * value * x)));
                node(Some(of.first), 1.0).into_iter().chain(node(of.second, -1.0))
            };
            let lengths = [span.length, self.diameter(pairs[span.pair].edges[0], span.length)];
            Point {
                weight: station.weight,
                excess: station.excess,
                lengths: [lengths[0], lengths[1], lengths[0], lengths[1]],
                carries: station.sites.iter().all(|(site, _)| self.pressing[*site].abs() > limits.force),
                jump: station.sites.iter().flat_map(sides).collect(),
                stress: self.traces(&station),
            }
        };
        self.stations(interface, rule, shape).into_iter().map(point).collect()
    }

    /// The longest side of the triangle at an edge.
    fn diameter(&self, edge: Option<usize>, otherwise: f64) -> f64 {
        let mesh = &self.problem.mesh;
        edge.and_then(|e| mesh.edges[e].triangles[0]).map_or(otherwise, |t| longest(mesh.corners(t)))
    }
}

/// The longest side of a triangle.
pub fn longest([a, b, c]: [[f64; 2]; 3]) -> f64 {
    distance(a, b).max(distance(b, c)).max(distance(c, a))
}
