//! Loads transmitted by friction: forces along contacts, and the moments of all tractions that a contact with friction exerts.
//!
//! With a displacement w̃ that moves the vertices of one side alone, the traction T on the first side has
//! ∫_{ΓK} T·w̃ = ∫ τ:e(w̃) − F(w̃) − ∫ t j_n(w̃), the last integral over the part of the normal traction that is not asked for.

use super::supports::add_strains;
use super::{Functional, Kind, NotBounded};
use crate::bounds::{holds_at, jumps, jumps_along, work};
use crate::element::Displacement;
use crate::element::polynomial::side;
use crate::problem::{ContactPair, Direction, Friction, Interface, Problem};
use crate::vector::{dot, norm};

/// Differences of motions that are rounding, relative to the largest.
const ROUNDING: f64 = 1e-12;

/// ∫ ψ t_t, the traction of friction on the first side weighted by ψ(s).
pub fn tangential_force(
    problem: &Problem,
    contact: usize,
    weight: impl Fn(f64) -> f64,
) -> Result<Functional, NotBounded> {
    let along = |pair: &ContactPair, end: usize| {
        let Some(friction) = pair.friction else { return [0.0; 2] };
        let t = friction.tangent.ends[end];
        let by = weight(pair.arc[end]) / dot(t, t);
        t.map(|t| by * t)
    };
    let motion = Motion { contact, along: &along, normal: false };
    let mut functional = motion.functional(problem, Kind::Force)?;
    let most = |pair: &ContactPair| {
        let Friction { bound, .. } = pair.friction?;
        let weights = pair.arc.map(|s| weight(s).abs());
        Some(pair.length * side::integral(&weights, &bound))
    };
    let most: f64 = (1.0 + ROUNDING) * motion.pairs(problem).filter_map(most).sum::<f64>();
    functional.within = [-most, most];
    Ok(functional)
}

/// The moment about a point of all that a contact exerts on its first side.
pub fn moment_on_first(problem: &Problem, contact: usize, about: [f64; 2]) -> Result<Functional, NotBounded> {
    let turned = |pair: &ContactPair, end: usize| {
        let [x, y] = problem.mesh.points[pair.first[end]];
        [about[1] - y, x - about[0]]
    };
    Motion { contact, along: &turned, normal: true }.functional(problem, Kind::Moment)
}

/// The motion of the first side of a contact that what is asked for does work on.
struct Motion<'a> {
    contact: usize,
    /// At the ends of pairs.
    along: &'a dyn Fn(&ContactPair, usize) -> [f64; 2],
    /// True if the normal traction is asked for too.
    normal: bool,
}

impl Motion<'_> {
    /// From the first side where that can be moved alone, or from the other one.
    fn functional(&self, problem: &Problem, kind: Kind) -> Result<Functional, NotBounded> {
        let first = self.on(problem, kind, 0);
        if first.is_ok() || self.pairs(problem).any(|pair| pair.second.is_none()) {
            return first;
        }
        self.on(problem, kind, 1).or(first)
    }

    fn pairs<'p>(&self, problem: &'p Problem) -> impl Iterator<Item = &'p ContactPair> + use<'p> {
        problem.interfaces[self.contact].pairs.iter()
    }

    fn on(&self, problem: &Problem, kind: Kind, of: usize) -> Result<Functional, NotBounded> {
        let vertex = self.vertices(problem, of)?;
        let size = vertex.iter().fold(0.0_f64, |m, u| m.max(norm(*u)));
        alone(problem, &vertex, size)?;
        let moved = Displacement::from_p1(&problem.mesh, &vertex);
        let mut functional = Functional::empty(problem, kind);
        let all = problem
            .interfaces
            .iter()
            .enumerate()
            .flat_map(|(i, Interface { pairs, .. })| pairs.iter().map(move |pair| (i, pair)));
        for ((i, pair), weights) in all.zip(&mut functional.load.weights) {
            let own = i == self.contact;
            let wanted = |direction: &Direction| self.wanted(pair, own, direction);
            if let Some(friction) = pair.friction {
                let slide = jumps_along(problem, &moved, pair, &friction.tangent).0;
                if !is_zero(&less(&slide, &wanted(&friction.tangent)), size) {
                    return Err(place(
                        problem,
                        pair.first[0],
                        "the contact ends in a body, turns, or meets another contact",
                    ));
                }
            }
            let across = jumps(problem, &moved, pair);
            let rest = if self.normal { less(&across, &wanted(&pair.direction)) } else { across };
            if !is_zero(&rest, size) {
                *weights = rest.into_iter().map(|j| -j).collect();
            }
        }
        functional.constant = -work(problem, &moved).value();
        add_strains(problem, &mut functional, &vertex, 1.0);
        Ok(functional)
    }

    /// The jump that the motion has along a direction at the ends of a pair.
    fn wanted(&self, pair: &ContactPair, own: bool, direction: &Direction) -> Vec<f64> {
        if !own {
            return vec![0.0; 2];
        }
        [0, 1].map(|end| dot((self.along)(pair, end), direction.ends[end])).to_vec()
    }

    /// The motion of the vertices of side `of`: turned round on the second side, whose traction is that of the first one turned round.
    fn vertices(&self, problem: &Problem, of: usize) -> Result<Vec<[f64; 2]>, NotBounded> {
        let mut vertex: Vec<Option<[f64; 2]>> = vec![None; problem.mesh.points.len()];
        let mut largest = 0.0_f64;
        for pair in self.pairs(problem) {
            let Some(ends) = [Some(pair.first), pair.second][of] else { continue };
            if pair.friction.is_none() && !self.normal {
                continue;
            }
            for (end, v) in ends.into_iter().enumerate() {
                let u = (self.along)(pair, end).map(|u| if of == 0 { u } else { -u });
                largest = largest.max(norm(u));
                let known = *vertex[v].get_or_insert(u);
                if norm([known[0] - u[0], known[1] - u[1]]) > ROUNDING * largest {
                    return Err(place(problem, v, "the contact has a corner"));
                }
            }
        }
        Ok(vertex.into_iter().map(Option::unwrap_or_default).collect())
    }
}

/// Refuses motions of vertices that a support holds, or that springs are fixed to.
fn alone(problem: &Problem, vertex: &[[f64; 2]], size: f64) -> Result<(), NotBounded> {
    let supported = "a support meets the contact";
    let holds = holds_at(problem, |_, _| [0.0; 2]).map_err(|_| place(problem, 0, supported))?;
    let mut springs = vec![false; vertex.len()];
    for (pair, _) in problem.bed_pairs() {
        let edges = [Some(pair.edge), pair.opposite];
        edges.into_iter().flatten().flat_map(|e| problem.mesh.edges[e].vertices).for_each(|v| springs[v] = true);
    }
    for (v, u) in vertex.iter().enumerate().filter(|(_, u)| norm(**u) > ROUNDING * size) {
        let held = holds.vertices[v].impose(*u);
        if springs[v] || norm([held[0] - u[0], held[1] - u[1]]) > ROUNDING * size {
            return Err(place(problem, v, supported));
        }
    }
    Ok(())
}

fn place(problem: &Problem, v: usize, what: &'static str) -> NotBounded {
    let [x, y] = problem.scene.as_written(problem.mesh.points[v]);
    NotBounded::Carried { x, y, what }
}

fn less(of: &[f64], other: &[f64]) -> Vec<f64> {
    let degree = of.len().max(other.len()) - 1;
    let [of, other] = [of, other].map(|c| side::elevate(c, degree));
    of.iter().zip(&other).map(|(a, b)| a - b).collect()
}

fn is_zero(jump: &[f64], size: f64) -> bool {
    jump.iter().all(|j| j.abs() <= ROUNDING * size)
}
