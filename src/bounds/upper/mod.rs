//! The free upper bound: an admissible displacement from the dual solve alone, of one degree more than its stresses.
//!
//! The edge moments of the dual solve say how every edge moves on average, its stresses how every triangle strains.
//! From these: vertex values by a local fit ([`fit`]); the inside of every edge such that it has the moments of the dual
//! solution, so that every triangle changes its volume as the dual solution says and nothing locks ([`edges`]); jumps on Γ_K
//! restricted by their Bernstein coefficients, so that they are admissible between the nodes too ([`ends`], [`contact`]);
//! relaxation, patch by patch ([`relaxation`]); and the inside of each triangle by minimising its energy on the three subtriangles
//! ([`energy::interior`]). Quadratics and higher degrees on that split can follow an incompressible field (Arnold & Qin 1992), which
//! keeps the bound uniform as ν → ½.

mod admissible;
mod energy;
mod groundwork;
mod part;
mod prepared;
mod relaxation;

pub use self::admissible::holds::{Hold, Holds, holds, holds_at, supports_agree};
pub use self::admissible::nearest::Nearest;
pub use self::admissible::nodes::{NodalValues, Nodes};
pub use self::admissible::rows::{Row, bernstein, of_pair, sides};
use self::admissible::sliding::Sliding;
pub(super) use self::admissible::yielded::yielded;
use self::admissible::{contact, edges, ends, fit, lift, nodes, rows};
pub use self::energy::pull::{Beside, Pull};
pub use self::groundwork::Groundwork;
pub use self::part::{Division, Found, Part};
pub use self::prepared::Prepared;
pub use self::relaxation::Until;
use self::relaxation::share::{Share, Whole};
use super::energy::potential;
use crate::dual::DualSolution;
use crate::element::{Displacement, PlainDisplacement, SideValues, StressField};
use crate::problem::Problem;

/// Why no admissible displacement could be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoUpperBound {
    /// Supports that meet in a vertex prescribe different displacements there.
    #[error(
        "the supports that meet at ({x}, {y}) prescribe different displacements, which no displacement of finite energy \
         can follow"
    )]
    SupportsDisagree {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
    /// Supports hold a contact apart from what the gap allows.
    #[error("the supports force a penetration of {by:.3e} at ({x}, {y})")]
    ForcedPenetration {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
        /// How deep.
        by: f64,
    },
    /// A contact asks for an interference where both its sides are one point.
    #[error(
        "a contact asks for an interference of {by:.3e} at ({x}, {y}), where its sides are one point, the tip of a crack or the end of \
         a bond, which no displacement of finite energy can give"
    )]
    PressedInside {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
        /// How much.
        by: f64,
    },
}

/// Builds the displacement; `floor`, a lower bound of its energy, says when relaxing it further is not worth the time,
/// and `start` gives another displacement to begin from where its energy is lower than that of the local fit.
///
/// # Errors
/// [`NoUpperBound`] where supports contradict each other or the contact.
pub fn admissible(
    problem: &Problem,
    dual: &DualSolution,
    floor: f64,
    start: Option<NodalValues>,
) -> Result<Displacement, NoUpperBound> {
    let degrees = dual.moments.iter().map(|moments| moments.len() - 1);
    Ok(admissible_on(Groundwork::new(problem, degrees)?, problem, dual, floor, start, false)?.0)
}

/// Does the same from what is there already, and keeps what serves others on this mesh where that is asked for.
///
/// # Errors
/// As [`admissible`].
pub fn admissible_on(
    ground: Groundwork,
    problem: &Problem,
    dual: &DualSolution,
    floor: f64,
    start: Option<NodalValues>,
    keep: bool,
) -> Result<(Displacement, Prepared), NoUpperBound> {
    let mut ground = ground;
    let problem = &*problem.softened();
    let relaxed = relaxed(&mut ground, problem, (&dual.stress, &dual.moments), floor, start, &Whole)?;
    let sliding = Sliding::of(problem, &dual.stress, &dual.moments);
    let Groundwork { holds, rows, made, .. } = ground;
    let field = restricted(problem, (&holds, &rows, &sliding), relaxed, &Whole)?.0;
    let displacement = energy::interior::fill(problem, &field, &made.model);
    let prepared = if keep { Prepared::holding(made) } else { Prepared::default() };
    Ok((displacement, prepared))
}

/// The values that relaxing leaves, which differ from admissible ones by rounding; `found` are the stresses of the dual solve and
/// the moments of its displacement.
fn relaxed(
    ground: &mut Groundwork,
    problem: &Problem,
    (stress, moments): (&StressField, &SideValues<[f64; 2]>),
    floor: f64,
    start: Option<NodalValues>,
    share: &dyn Share,
) -> Result<NodalValues, NoUpperBound> {
    let mesh = &problem.mesh;
    let Groundwork { nodes, holds, rows, made } = ground;
    let sliding = Sliding::of(problem, stress, moments);
    made.model.rub(problem, nodes, &sliding);
    let mut field = NodalValues::zeros(nodes.clone());
    field.vertices_mut().copy_from_slice(&fit::vertex_values(problem, stress, moments, fit::Added::Scene));
    share.refresh(&mut field.values);
    energy::beds::draw(problem, stress, &mut field);
    let vertex = field.vertices_mut();
    for (value, hold) in vertex.iter_mut().zip(&holds.vertices) {
        *value = hold.impose(*value);
    }
    let mut near = ends::ends_near(problem, moments, nodes);
    near.extend(sliding.ends(problem));
    ends::draw(&near, &holds.vertices, vertex, share);
    ends::restrict(problem, rows, &holds.vertices, vertex, share)?;
    for e in 0..mesh.edges.len() {
        let ends = mesh.edges[e].vertices.map(|v| field.values[v]);
        let own = &mut field.values[nodes.inside(e)];
        let degree = moments.of(e).len() - 1;
        // On the axis of revolution the dual solution says nothing.
        let unknown = problem.vanishes(e, 0, degree) || problem.vanishes(e, degree, degree);
        let inside = if unknown {
            let linear = nodes::elevated(&ends, own.len() + 1);
            linear[1..=own.len()].to_vec()
        } else {
            edges::inside_of(own.len() + 1, moments.of(e), mesh.edge_frame(e).0, ends)
        };
        let held = holds.inside(e, own.len());
        for ((value, found), hold) in own.iter_mut().zip(inside).zip(held) {
            *value = hold.impose(found);
        }
    }
    contact::match_means(problem, moments, &mut field);
    sliding.settle(problem, holds, &mut field);
    contact::restrict_inside(problem, rows, &mut field, share);
    // Where the dual solve leaves a body's motion open the fit may put it anywhere; bodies at rest are nowhere wild.
    let at_rest = || Ok(restricted(problem, (holds, rows, &sliding), NodalValues::zeros(nodes.clone()), share)?.0);
    let mut candidates = vec![field];
    if let Some(start) = start {
        candidates.push(restricted(problem, (holds, rows, &sliding), start.on(mesh, nodes), share)?.0);
    }
    let floor = floor / problem.scene.thickness;
    let stored = made.model.touch(&candidates[0].values);
    let near = |stored| Until::Near(floor - stored);
    let mut relaxed =
        relaxation::relax(problem, &made.model, &mut made.patches, near(stored), candidates, at_rest, share)?;
    if problem.beds.iter().flat_map(|bed| &bed.pairs).all(|pair| pair.contact.is_none()) {
        return Ok(relaxed);
    }
    let mut energy = made.model.energy(&relaxed.values, share) + stored;
    for _ in 0..TOUCHES {
        let stored = made.model.touch(&relaxed.values);
        let again = vec![relaxed.clone()];
        let next = relaxation::relax(problem, &made.model, &mut made.patches, near(stored), again, at_rest, share)?;
        let lower = made.model.energy(&next.values, share) + stored;
        relaxed = next;
        if energy - lower <= WORTH_A_TOUCH * (lower - floor).abs() {
            break;
        }
        energy = lower;
    }
    Ok(relaxed)
}

/// How often springs take the place of an elastic contact anew at most, and the part of the gap between the bounds that makes once more
/// worth it.
const TOUCHES: usize = 12;
const WORTH_A_TOUCH: f64 = 0.01;

/// The nearest values that supports and contact allow, and the largest distance of a value from what supports allow.
fn restricted(
    problem: &Problem,
    (holds, rows, sliding): (&Holds, &[Vec<Row>], &Sliding),
    mut field: NodalValues,
    share: &dyn Share,
) -> Result<(NodalValues, f64), NoUpperBound> {
    share.refresh(&mut field.values);
    let mut farthest = 0.0_f64;
    for (value, hold) in field.values.iter_mut().zip(holds.of_nodes(&field.nodes)) {
        let held = hold.impose(*value);
        farthest = farthest.max((held[0] - value[0]).hypot(held[1] - value[1]));
        *value = held;
    }
    if problem.has_friction() {
        let ends: Vec<_> = sliding.ends(problem).collect();
        ends::draw(&ends, &holds.vertices, field.vertices_mut(), share);
        sliding.settle(problem, holds, &mut field);
    }
    ends::restrict(problem, rows, &holds.vertices, field.vertices_mut(), share)?;
    contact::restrict_inside(problem, rows, &mut field, share);
    Ok((field, farthest))
}

/// By how much a displacement misses admissibility, relative to its size.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Violation {
    /// Largest distance from a prescribed displacement.
    pub support: f64,
    /// Deepest penetration, between nodes too (largest Bernstein coefficient of (v' − v'')·n̂ − g).
    pub penetration: f64,
    /// Deepest penetration at a vertex.
    pub at_vertices: f64,
}

impl Violation {
    /// The larger of the two.
    pub fn largest(&self) -> f64 {
        self.support.max(self.penetration)
    }
}

/// How a field that penetrates becomes admissible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Repair {
    /// By the values along the contact alone: enough for what a solver leaves.
    AtContact,
    /// By the change of least energy, wherever it costs less.
    OfLeastEnergy,
}

/// Penetrations up to this part of the displacement are what solvers leave, and cost no energy to speak of.
const WORTH_LIFTING: f64 = 1e-9;

/// The nearest admissible continuous quadratic field to one given by its values at vertices and edge midpoints, and how
/// far from admissible that was.
///
/// # Errors
/// [`NoUpperBound`] as for [`admissible`].
pub fn repaired(
    problem: &Problem,
    vertex: &[[f64; 2]],
    middle: &[[f64; 2]],
    repair: Repair,
) -> Result<(Displacement, Violation), NoUpperBound> {
    let holds = holds(problem)?;
    let size = vertex.iter().chain(middle).flatten().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let start = NodalValues::quadratic(&problem.mesh, vertex, middle);
    let [penetration, at_vertices] = contact::penetration(problem, &start).map(|depth| depth / size);
    let rows = rows::rows(problem, &start.nodes);
    let (field, farthest) = restricted(problem, (&holds, &rows, &Sliding::default()), start, &Whole)?;
    let violation = Violation { support: farthest / size, penetration, at_vertices };
    let nearest = quadratic(problem, field);
    if repair == Repair::OfLeastEnergy
        && penetration > WORTH_LIFTING
        && let Some(lifted) = lift::lifted(problem, &holds, vertex, middle, 2)
    {
        let lifted = quadratic(problem, restricted(problem, (&holds, &rows, &Sliding::default()), lifted, &Whole)?.0);
        if potential(problem, &lifted).total() < potential(problem, &nearest).total() {
            return Ok((lifted, violation));
        }
    }
    Ok((nearest, violation))
}

fn quadratic(problem: &Problem, field: NodalValues) -> Displacement {
    let (vertex, inner) = field.values.split_at(field.nodes.vertices());
    Displacement::quadratic(&problem.mesh, vertex, inner)
}

/// An admissible field of degree 1 or 2 as the given one, changed from it by little energy: what the minimiser of that space
/// lies below. `None` where nothing penetrates or the change cannot be computed.
///
/// # Errors
/// [`NoUpperBound`] as for [`admissible`].
pub fn lifted_within(
    problem: &Problem,
    vertex: &[[f64; 2]],
    middle: &[[f64; 2]],
    degree: usize,
) -> Result<Option<Displacement>, NoUpperBound> {
    let holds = holds(problem)?;
    let Some(lifted) = lift::lifted(problem, &holds, vertex, middle, degree) else { return Ok(None) };
    let rows = rows::rows(problem, &lifted.nodes);
    let field = restricted(problem, (&holds, &rows, &Sliding::default()), lifted, &Whole)?.0;
    let nodes = Nodes::new(field.nodes.vertices(), std::iter::repeat_n(2, field.nodes.edges()));
    Ok(Some(quadratic(problem, field.on(&problem.mesh, &nodes))))
}

/// The field whose values along the contact and on supports are the nearest that these allow, and how far from admissible
/// the given one was.
///
/// # Errors
/// [`NoUpperBound`] as for [`admissible`].
pub fn repaired_at_contact(
    problem: &Problem,
    field: &PlainDisplacement,
) -> Result<(Displacement, Violation), NoUpperBound> {
    let mesh = &problem.mesh;
    let holds = holds(problem)?;
    let size = field.values().iter().flatten().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let nodes = Nodes::of_degree(mesh, field.degree());
    let start = NodalValues { values: field.boundary().to_vec(), nodes };
    let [penetration, at_vertices] = contact::penetration(problem, &start).map(|depth| depth / size);
    let rows = rows::rows(problem, &start.nodes);
    let (nearest, farthest) = restricted(problem, (&holds, &rows, &Sliding::default()), start, &Whole)?;
    let violation = Violation { support: farthest / size, penetration, at_vertices };
    Ok((field.clone().with_boundary(&nearest.values).split(mesh), violation))
}
