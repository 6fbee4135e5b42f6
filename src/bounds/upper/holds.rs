//! What the supports leave free at each vertex.

use super::NoUpperBound;
use crate::problem::{Condition, Problem};

/// The support of one vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Hold {
    /// Not held.
    Free,
    /// u · normal = value.
    Line {
        /// Unit vector.
        normal: [f64; 2],
        /// Prescribed component.
        value: f64,
    },
    /// u = value.
    Fixed([f64; 2]),
}

impl Hold {
    /// The nearest displacement that the support allows.
    pub fn impose(&self, u: [f64; 2]) -> [f64; 2] {
        match *self {
            Hold::Free => u,
            Hold::Line { normal: n, value } => {
                let off = u[0] * n[0] + u[1] * n[1] - value;
                [u[0] - off * n[0], u[1] - off * n[1]]
            }
            Hold::Fixed(value) => value,
        }
    }

    /// The part of a change that the support allows.
    pub fn project(&self, d: [f64; 2]) -> [f64; 2] {
        match *self {
            Hold::Free => d,
            Hold::Line { normal: n, .. } => {
                let off = d[0] * n[0] + d[1] * n[1];
                [d[0] - off * n[0], d[1] - off * n[1]]
            }
            Hold::Fixed(_) => [0.0; 2],
        }
    }

    /// Adds a condition u · normal = value; `None` where it contradicts what holds already.
    fn with_line(self, normal: [f64; 2], value: f64, size: f64) -> Option<Hold> {
        const PARALLEL: f64 = 1e-10;
        match self {
            Hold::Free => Some(Hold::Line { normal, value }),
            Hold::Line { normal: n, value: w } => {
                let cross = n[0] * normal[1] - n[1] * normal[0];
                if cross.abs() > PARALLEL {
                    let u = [(w * normal[1] - value * n[1]) / cross, (value * n[0] - w * normal[0]) / cross];
                    return Some(Hold::Fixed(u));
                }
                let sign = n[0] * normal[0] + n[1] * normal[1];
                ((w * sign - value).abs() <= PARALLEL * size).then_some(self)
            }
            Hold::Fixed(u) => {
                let off = u[0] * normal[0] + u[1] * normal[1] - value;
                (off.abs() <= PARALLEL * size).then_some(self)
            }
        }
    }

    fn with_point(self, u0: [f64; 2], size: f64) -> Option<Hold> {
        self.with_line([1.0, 0.0], u0[0], size)?.with_line([0.0, 1.0], u0[1], size)?;
        Some(Hold::Fixed(u0))
    }
}

/// The hold of every vertex.
///
/// # Errors
/// [`NoUpperBound::SupportsDisagree`].
pub fn holds(problem: &Problem) -> Result<Vec<Hold>, NoUpperBound> {
    let mesh = &problem.mesh;
    // Prescribed displacements are compared with each other, on the scale of the largest.
    let size = problem
        .conditions
        .iter()
        .filter_map(|c| if let Condition::Clamped(u) = c { Some(u[0].abs().max(u[1].abs())) } else { None })
        .fold(0.0, f64::max);
    let mut holds = vec![Hold::Free; mesh.points.len()];
    for (e, condition) in problem.conditions.iter().enumerate() {
        let (_, normal) = mesh.edge_frame(e);
        for v in mesh.edges[e].vertices {
            let next = match condition {
                Condition::Clamped(u0) => holds[v].with_point(*u0, size),
                Condition::Roller => holds[v].with_line(normal, 0.0, size),
                _ => continue,
            };
            let [x, y] = mesh.points[v];
            holds[v] = next.ok_or(NoUpperBound::SupportsDisagree { x, y })?;
        }
    }
    Ok(holds)
}
