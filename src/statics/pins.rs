//! Points to hold so that the motions nothing else holds are taken away.
//!
//! The loads do no work on these motions, so a pin carries no force: it only chooses one displacement among those that
//! differ by the motion. Pins are picked by pivoting, the one that holds the remaining motions best first.

use super::StaticsError;
use super::balance::RANK;
use super::components::Components;
use super::cone::span::Span;
use super::cone::sparse::{Row, Triangular, dense};
use super::restraint::{Group, along};
use crate::problem::{Condition, Problem};
use nalgebra::DVector;
use std::collections::BTreeMap;

/// A vertex to hold: u(vertex) · direction = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexPin {
    /// Vertex index.
    pub vertex: usize,
    /// A coordinate direction wherever the vertex lies on no support and no contact; otherwise the tangent there.
    pub direction: [f64; 2],
    /// True if the motion is free only where contact holds vertices alone.
    pub of_vertices: bool,
}

/// An edge moment to hold: m_{e,p} · direction = 0 with m_{e,p} = ∫_e v q_p ds, q_p the hat function of the end p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgePin {
    /// Edge index.
    pub edge: usize,
    /// Which end, in the order of [`crate::mesh::Edge::vertices`].
    pub end: usize,
    /// A coordinate direction on interior and loaded edges. Only where a piece has no such edge that would serve, an edge
    /// on a roller or a contact is taken, with its tangent.
    pub direction: [f64; 2],
}

/// A pin that holds less than this, of displacements of size 1, holds nothing.
const WEAKEST: f64 = 1e-7;

/// A pin that holds more than this holds well.
const WELL_HELD: f64 = 0.1;

/// More motions than this are pinned piece by piece.
const MANY: usize = 24;

/// Somewhere a pin could go.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Vertex, or edge and end.
    index: (usize, usize),
    component: usize,
    /// Where the displacement is taken.
    point: [f64; 2],
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Both components are free unknowns.
    Free,
    /// Only this direction is.
    Along([f64; 2]),
    /// Contacts or rollers of several directions meet here.
    Corner,
}

impl Kind {
    /// How much worse a place of this kind may hold a free one and still be passed over.
    fn weight(self) -> f64 {
        match self {
            Kind::Free => 1.0,
            Kind::Along(_) => 0.05,
            Kind::Corner => 0.0025,
        }
    }

    fn directions(self) -> Vec<[f64; 2]> {
        match self {
            Kind::Along(tangent) => vec![tangent],
            Kind::Free | Kind::Corner => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }
}

/// One vertex pin per motion of `held`, which they take away together, and one for each motion more of `at_vertices`, the motions that
/// contact at vertices leaves free, those of `held` among them.
pub(super) fn vertex_pins(
    problem: &Problem,
    group: &Group,
    held: &[DVector<f64>],
    at_vertices: &[DVector<f64>],
) -> Result<Vec<VertexPin>, StaticsError> {
    let mut pins = pins_at_vertices(problem, group, held)?;
    if at_vertices.len() > held.len() {
        let left = unpinned(problem, group, at_vertices, &pins);
        let more = pins_at_vertices(problem, group, &left)?;
        pins.extend(more.into_iter().map(|pin| VertexPin { of_vertices: true, ..pin }));
    }
    Ok(pins)
}

/// What `pins` leave free of `motions`.
fn unpinned(problem: &Problem, group: &Group, motions: &[DVector<f64>], pins: &[VertexPin]) -> Vec<DVector<f64>> {
    let mut left = motions.to_vec();
    for pin in pins {
        let component = group.components.of_vertex[pin.vertex];
        let Some(row) = group.displacement(component, problem.mesh.points[pin.vertex], pin.direction) else { continue };
        let moved = |motion: &DVector<f64>| along(&row, motion);
        let most = (0..left.len()).max_by(|a, b| moved(&left[*a]).abs().total_cmp(&moved(&left[*b]).abs()));
        let Some(taken) = most.map(|most| left.swap_remove(most)).filter(|taken| moved(taken) != 0.0) else { continue };
        for motion in &mut left {
            let factor = moved(motion) / moved(&taken);
            motion.axpy(-factor, &taken, 1.0);
        }
    }
    left
}

fn pins_at_vertices(problem: &Problem, group: &Group, held: &[DVector<f64>]) -> Result<Vec<VertexPin>, StaticsError> {
    if held.is_empty() {
        return Ok(Vec::new());
    }
    let components = group.components;
    let mesh = &problem.mesh;
    let mut kinds = vec![Some(Kind::Free); mesh.points.len()];
    for (e, condition) in problem.conditions.iter().enumerate() {
        let tangent = tangent(problem, e);
        for v in mesh.edges[e].vertices {
            kinds[v] = match (condition, kinds[v]) {
                (Condition::Clamped(_), _) | (_, None) => None,
                (Condition::Interior | Condition::Traction(_), kind) => kind,
                (Condition::Axis, _) => Some(Kind::Along([0.0, 1.0])),
                (_, Some(Kind::Free)) => Some(Kind::Along(tangent)),
                (_, Some(Kind::Along(t))) if (t[0] * tangent[1] - t[1] * tangent[0]).abs() < 1e-6 => kinds[v],
                _ => Some(Kind::Corner),
            };
        }
    }
    // A vertex where two pieces touch belongs to both: holding it would hold the wrong one as well.
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for v in triangle {
            if components.of_vertex[*v] != components.of_triangle[t] {
                kinds[*v] = None;
            }
        }
    }
    let places = kinds.iter().enumerate().filter_map(|(v, kind)| {
        let component = components.of_vertex[v];
        group.member(component)?;
        Some(Place { index: (v, 0), component, point: mesh.points[v], kind: (*kind)? })
    });
    let chosen = choose(places, group, held)?;
    let pin = |(place, direction): (Place, _)| VertexPin { vertex: place.index.0, direction, of_vertices: false };
    Ok(chosen.into_iter().map(pin).collect())
}

/// One edge pin per motion of `held`, which they take away together.
pub(super) fn edge_pins(problem: &Problem, group: &Group, held: &[DVector<f64>]) -> Result<Vec<EdgePin>, StaticsError> {
    if held.is_empty() {
        return Ok(Vec::new());
    }
    let mesh = &problem.mesh;
    let places = problem.conditions.iter().enumerate().flat_map(|(e, condition)| {
        let kind = match condition {
            Condition::Interior | Condition::Traction(_) => Some(Kind::Free),
            Condition::Clamped(_) | Condition::Axis | Condition::Elastic { .. } => None,
            Condition::Roller { .. } | Condition::Contact { .. } => Some(Kind::Along(tangent(problem, e))),
        };
        let component = mesh.edges[e].triangles[0].map(|t| group.components.of_triangle[t]);
        let component = component.filter(|c| group.member(*c).is_some());
        let ends = mesh.edges[e].vertices.map(|v| mesh.points[v]);
        // ∫_e v q_p ds of a linear v is half the length times v a third of the way from p to the other end.
        let third = move |p: usize| [0, 1].map(|i| (2.0 * ends[p][i] + ends[1 - p][i]) / 3.0);
        [0, 1]
            .into_iter()
            .filter_map(move |p| Some(Place { index: (e, p), component: component?, point: third(p), kind: kind? }))
    });
    let chosen = choose(places, group, held)?;
    let pin = |(place, direction): (Place, _)| EdgePin { edge: place.index.0, end: place.index.1, direction };
    Ok(chosen.into_iter().map(pin).collect())
}

/// Along edge `e`, or across the direction of its rollers.
fn tangent(problem: &Problem, e: usize) -> [f64; 2] {
    let n = match problem.conditions[e] {
        Condition::Roller { direction, .. } => direction,
        _ => problem.mesh.edge_frame(e).1,
    };
    [-n[1], n[0]]
}

/// The best places for the `held` motions, by pivoted elimination.
fn choose(
    places: impl Iterator<Item = Place>,
    group: &Group,
    held: &[DVector<f64>],
) -> Result<Vec<(Place, [f64; 2])>, StaticsError> {
    let rank = held.len();
    if rank > MANY {
        let candidates = candidates(places, group, held);
        return choose_by_piece(&candidates, rank).ok_or_else(|| nothing_to_pin(group));
    }
    // Lengths say how well a pin holds only in an orthonormal basis.
    let mut motions = Span::empty(group.dimension());
    motions.extend(held, RANK);
    let candidates = candidates(places, group, &motions.basis);
    let candidates: Vec<_> = candidates.into_iter().map(|c| (c.place, c.direction, dense(&c.row, rank))).collect();
    let mut taken = Span::empty(rank);
    let mut chosen = Vec::new();
    while chosen.len() < rank {
        let mut best: Option<(f64, f64, usize)> = None;
        for (i, (place, _, row)) in candidates.iter().enumerate() {
            let hold = taken.residual(row).norm();
            let merit = hold * place.kind.weight();
            if best.is_none_or(|(leading, _, _)| merit > leading * (1.0 + 1e-6)) {
                best = Some((merit, hold, i));
            }
        }
        let Some((_, _, i)) = best.filter(|(_, hold, _)| *hold > WEAKEST) else {
            return Err(nothing_to_pin(group));
        };
        let (place, direction, row) = &candidates[i];
        chosen.push((*place, *direction));
        taken.extend(std::slice::from_ref(row), 1e-3 * WEAKEST);
    }
    Ok(chosen)
}

fn nothing_to_pin(group: &Group) -> StaticsError {
    StaticsError::NothingToPin { bodies: super::words::all_names(group) }
}

/// A pin that could be chosen.
struct Candidate {
    place: Place,
    direction: [f64; 2],
    /// The displacement there in each motion.
    row: Row,
}

fn candidates(places: impl Iterator<Item = Place>, group: &Group, held: &[DVector<f64>]) -> Vec<Candidate> {
    let mut moved = vec![Row::new(); group.dimension()];
    for (h, motion) in held.iter().enumerate() {
        motion.iter().enumerate().filter(|(_, v)| **v != 0.0).for_each(|(i, v)| moved[i].push((h, *v)));
    }
    let mut all = Vec::new();
    for place in outermost(places, group.components) {
        for direction in place.kind.directions() {
            let Some((m, part)) = group.displacement(place.component, place.point, direction) else { continue };
            let mut row = BTreeMap::new();
            for i in 0..3 {
                moved[3 * m + i].iter().for_each(|(h, v)| *row.entry(*h).or_default() += part[i] * v);
            }
            all.push(Candidate { place, direction, row: row.into_iter().collect() });
        }
    }
    all
}

/// Pins for many motions: piece after piece takes what holds best there, first where that holds well, then where it holds
/// at all.
fn choose_by_piece(candidates: &[Candidate], rank: usize) -> Option<Vec<(Place, [f64; 2])>> {
    let mut by_piece: BTreeMap<usize, Vec<&Candidate>> = BTreeMap::new();
    candidates.iter().for_each(|c| by_piece.entry(c.place.component).or_default().push(c));
    let mut taken = Triangular::new(rank);
    let mut chosen = Vec::new();
    for weakest in [WELL_HELD, WEAKEST] {
        for own in by_piece.values() {
            while chosen.len() < rank {
                let held = own.iter().map(|c| (taken.remainder(&c.row), c)).filter(|(hold, _)| *hold > weakest);
                let merit = |(hold, c): &(f64, &&Candidate)| hold * c.place.kind.weight();
                let Some((_, best)) = held.max_by(|a, b| merit(a).total_cmp(&merit(b))) else { break };
                taken.insert(best.row.clone());
                chosen.push((best.place, best.direction));
            }
        }
    }
    (taken.rank() == rank).then_some(chosen)
}

/// For each piece and kind of place, the places farthest out in eight directions: no others can hold it much better, and
/// the choice stays cheap on large meshes.
fn outermost(places: impl Iterator<Item = Place>, components: &Components) -> Vec<Place> {
    let directions = std::array::from_fn::<[f64; 2], 8, _>(|i| {
        let angle = 0.2 + std::f64::consts::FRAC_PI_4 * i as f64;
        [angle.cos(), angle.sin()]
    });
    let mut best: Vec<Option<(f64, Place)>> = vec![None; 24 * components.count()];
    for place in places {
        let kind = match place.kind {
            Kind::Free => 0,
            Kind::Along(_) => 1,
            Kind::Corner => 2,
        };
        for (i, d) in directions.iter().enumerate() {
            let reach = place.point[0] * d[0] + place.point[1] * d[1];
            let slot = &mut best[24 * place.component + 8 * kind + i];
            if slot.is_none_or(|(leading, _)| reach > leading) {
                *slot = Some((reach, place));
            }
        }
    }
    let mut kept: Vec<Place> = best.into_iter().flatten().map(|(_, place)| place).collect();
    kept.sort_by_key(|place| place.index);
    kept.dedup_by_key(|place| place.index);
    kept
}
