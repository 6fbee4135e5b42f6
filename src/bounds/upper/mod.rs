//! The free upper bound: an admissible displacement from the dual solve alone.
//!
//! The edge moments of the dual solve say how every edge moves on average, its stresses how every triangle strains.
//! From these: vertex values by a local fit ([`fit`]); edge midpoints such that ∫_e u ds is the dual one, so that every
//! triangle changes its volume as the dual solution says and nothing locks; vertex jumps on Γ_K restricted so that the
//! quadratic jump stays admissible between its nodes too ([`contact`]); relaxation, patch by patch
//! ([`relax`]); and the inside of each triangle by minimising its energy on the three subtriangles ([`interior`]). Quadratics on that split can follow an incompressible field
//! (Arnold & Qin 1992), which keeps the bound uniform as ν → ½.

mod cholesky;
mod contact;
mod fit;
mod groups;
mod holds;
mod interior;
mod model;
mod momentum;
mod patch;
mod relax;
mod sets;
mod split;
mod stiffness;

pub use self::contact::{Row, bernstein};
pub use self::holds::{Hold, Holds, holds, supports_agree};
use crate::dual::DualSolution;
use crate::element::Displacement;
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
}

/// Values at the vertices and edge midpoints of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalValues {
    /// At the vertices.
    pub vertex: Vec<[f64; 2]>,
    /// At the midpoints.
    pub middle: Vec<[f64; 2]>,
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
    let mesh = &problem.mesh;
    let holds = holds(problem)?;
    let mut vertex = fit::vertex_values(problem, dual);
    for (value, hold) in vertex.iter_mut().zip(&holds.vertices) {
        *value = hold.impose(*value);
    }
    contact::draw(&contact::ends_near(problem, dual), &holds.vertices, &mut vertex);
    contact::restrict_vertices(problem, &holds.vertices, &mut vertex)?;
    let mut middle: Vec<[f64; 2]> = (0..mesh.edges.len())
        .map(|e| {
            let (length, _) = mesh.edge_frame(e);
            let [a, b] = mesh.edges[e].vertices.map(|v| vertex[v]);
            let (ma, mb) = (dual.moments.of(e)[0], dual.moments.of(e)[1]);
            // Simpson: l/6 (u_a + 4 u_mid + u_b) = m_a + m_b.
            holds.middles[e].impose([0, 1].map(|c| 1.5 * (ma[c] + mb[c]) / length - 0.25 * (a[c] + b[c])))
        })
        .collect();
    contact::match_means(problem, dual, &vertex, &mut middle);
    contact::restrict_middles(problem, &vertex, &mut middle);
    // Where the dual solve leaves a body's motion open the fit may put it anywhere; bodies at rest are nowhere wild.
    let at_rest = NodalValues { vertex: vec![[0.0; 2]; vertex.len()], middle: vec![[0.0; 2]; middle.len()] };
    let at_rest = restricted(problem, &holds, at_rest)?.0;
    let mut candidates = vec![NodalValues { vertex, middle }];
    if let Some(start) = start {
        candidates.push(restricted(problem, &holds, start)?.0);
    }
    let relaxed = relax::relax(problem, &holds, floor / problem.scene.thickness, candidates, at_rest);
    let NodalValues { vertex, middle } = restricted(problem, &holds, relaxed)?.0;
    Ok(interior::fill(problem, &vertex, &middle))
}

/// The nearest values that supports and contact allow, and the largest distance of a value from what supports allow.
fn restricted(problem: &Problem, holds: &Holds, start: NodalValues) -> Result<(NodalValues, f64), NoUpperBound> {
    let NodalValues { mut vertex, mut middle } = start;
    let mut farthest = 0.0_f64;
    for (value, hold) in vertex.iter_mut().zip(&holds.vertices).chain(middle.iter_mut().zip(&holds.middles)) {
        let held = hold.impose(*value);
        farthest = farthest.max((held[0] - value[0]).hypot(held[1] - value[1]));
        *value = held;
    }
    contact::restrict_vertices(problem, &holds.vertices, &mut vertex)?;
    contact::restrict_middles(problem, &vertex, &mut middle);
    Ok((NodalValues { vertex, middle }, farthest))
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

/// The nearest admissible continuous quadratic field to one given by its values at vertices and edge midpoints, and how
/// far from admissible that was.
///
/// # Errors
/// [`NoUpperBound`] as for [`admissible`].
pub fn repaired(
    problem: &Problem,
    vertex: &[[f64; 2]],
    middle: &[[f64; 2]],
) -> Result<(Displacement, Violation), NoUpperBound> {
    let holds = holds(problem)?;
    let size = vertex.iter().chain(middle).flatten().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let [penetration, at_vertices] = contact::penetration(problem, vertex, middle).map(|depth| depth / size);
    let start = NodalValues { vertex: vertex.to_vec(), middle: middle.to_vec() };
    let (NodalValues { vertex, middle }, farthest) = restricted(problem, &holds, start)?;
    let violation = Violation { support: farthest / size, penetration, at_vertices };
    Ok((Displacement::from_p2(&problem.mesh, &vertex, &middle), violation))
}
