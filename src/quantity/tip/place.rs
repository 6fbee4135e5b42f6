//! Where the tip of a crack is on a mesh, and the triangles about it.

use std::collections::HashSet;

use crate::problem::{Condition, Problem};
use crate::quantity::point::distance;
use crate::scene::Mode;
use crate::sets::DisjointSets;

/// Part of the radius up to which η is one.
const INNER: f64 = 0.3;

/// The least distance of a triangle from the tip over its longest side, on which w is integrated.
const NEAREST: f64 = 0.5;

/// Angles below this are none.
const STRAIGHT: f64 = 1e-7;

/// Distances below this part of the size of the body are none.
const ON: f64 = 1e-9;
/// Distances below this part of it are rounding.
const SAME: f64 = 1e-14;

/// Why a point is no tip of a crack on a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoTip {
    /// Not a vertex.
    #[error(
        "no vertex of the mesh lies at the tip ({x}, {y}); write the end of the crack as the polygons or the mesh have it"
    )]
    NoVertex {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
    },
    /// Something else than a crack meets the point.
    #[error("({x}, {y}) is no tip of a crack: {what}")]
    Other {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// The geometry found there instead.
        what: &'static str,
    },
    /// Too few triangles.
    #[error(
        "the mesh is too coarse about the tip ({x}, {y}): triangles there have to be much smaller than {radius}; refine, or give a smaller `size`"
    )]
    Coarse {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// The distance of the next boundary.
        radius: String,
        /// Number of the body.
        body: usize,
    },
    /// An initial strain.
    #[error(
        "body '{body}' has a temperature or an initial stress, and the stress intensity is bounded for bodies without one"
    )]
    Strained {
        /// Name of the body.
        body: String,
    },
    /// Another law of elasticity.
    #[error(
        "body '{body}' is not isotropic: the field that extracts a stress intensity is known for isotropic bodies only"
    )]
    Anisotropic {
        /// Name of the body.
        body: String,
    },
}

/// A tip with its neighbourhood.
#[derive(Debug, Clone)]
pub struct Place {
    /// Body that is cracked.
    pub body: usize,
    /// The tip.
    pub at: [f64; 2],
    /// The direction of growth, and the one across it, into the body where that is half a model.
    pub axes: [[f64; 2]; 2],
    /// True if the body ends at a roller ahead of the tip.
    pub half: bool,
    /// Triangles outside P with η at their corners, not all zero.
    pub triangles: Vec<(usize, [f64; 3])>,
    /// Triangles of P.
    pub inner: Vec<(usize, [f64; 3])>,
    /// Edges of P inside the body, with the sign that turns their normal into P.
    pub edges: Vec<(usize, f64)>,
}

/// The role of an edge of the outline for a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Face,
    Ahead,
    Other,
}

impl Place {
    pub fn new(problem: &Problem, mode: Mode, tip: [f64; 2]) -> Result<Self, NoTip> {
        let mesh = &problem.mesh;
        let [x, y] = problem.scene.as_written(tip);
        let other = |what| NoTip::Other { x, y, what };
        let seen = |v: usize| [mesh.points[v][0] - tip[0], mesh.points[v][1] - tip[1]];
        let far = |v: usize| {
            let [x, y] = seen(v);
            x.hypot(y)
        };
        let size = (0..mesh.points.len()).map(far).fold(0.0, f64::max);
        let mut at: Vec<usize> = (0..mesh.points.len()).filter(|&v| far(v) <= ON * size).collect();
        // Where triangles about the tip are as small as that, the nearest of their vertices is meant.
        let nearest = at.iter().map(|&v| far(v)).fold(f64::INFINITY, f64::min);
        at.retain(|&v| far(v) <= nearest.max(SAME * size));
        let &[vertex] = at.as_slice() else {
            return Err(if at.is_empty() {
                NoTip::NoVertex { x, y }
            } else {
                other("several vertices lie there, of bodies or faces that are apart")
            });
        };
        let around: Vec<usize> = (0..mesh.triangles.len()).filter(|&t| mesh.triangles[t].contains(&vertex)).collect();
        let Some(body) = around.first().map(|&t| mesh.body[t]) else { return Err(NoTip::NoVertex { x, y }) };
        if around.iter().any(|&t| mesh.body[t] != body) {
            return Err(other("more than one body meets it; between bodies the field at the tip is another one"));
        }
        let own = |t: Option<usize>| t.is_some_and(|t| mesh.body[t] == body);
        let outline: Vec<usize> = (0..mesh.edges.len())
            .filter(|&e| {
                let [first, second] = mesh.edges[e].triangles.map(own);
                first != second
            })
            .collect();
        let at_tip: Vec<(usize, [f64; 2])> = outline
            .iter()
            .filter_map(|&e| {
                let end = mesh.edges[e].vertices.iter().position(|&v| v == vertex)?;
                let [x, y] = seen(mesh.edges[e].vertices[1 - end]);
                Some((e, [x / x.hypot(y), y / x.hypot(y)]))
            })
            .collect();
        let &[(e, p), (f, q)] = at_tip.as_slice() else {
            return Err(other(if at_tip.is_empty() {
                "it lies inside the body"
            } else {
                "more than two faces end there"
            }));
        };
        let free = |e: usize| problem.conditions[e] == Condition::Traction([[0.0; 2]; 2]);
        let roller = |e: usize, across: [f64; 2]| match problem.conditions[e] {
            Condition::Roller { direction, displacement } => {
                displacement == 0.0 && (direction[0] * across[1] - direction[1] * across[0]).abs() <= STRAIGHT
            }
            _ => false,
        };
        let cross = p[0] * q[1] - p[1] * q[0];
        let dot = p[0] * q[0] + p[1] * q[1];
        if cross.abs() > STRAIGHT {
            return Err(other("two boundaries meet there at an angle"));
        }
        let half = dot < 0.0;
        let (face, axes) = if half {
            let face = match (free(e), free(f)) {
                (true, false) => p,
                (false, true) => q,
                _ => return Err(other("it lies on a straight boundary, of which no free part meets a roller there")),
            };
            let growth = face.map(|d| -d);
            // Into the body, from the first edge there.
            let (_, normal) = mesh.edge_frame(e);
            let outward = if own(mesh.edges[e].triangles[0]) { normal } else { normal.map(|n| -n) };
            (face, [growth, outward.map(|n| -n)])
        } else {
            let growth = p.map(|d| -d);
            (p, [growth, [-growth[1], growth[0]]])
        };
        if half && mode == Mode::II {
            return Err(other("half a model has no sliding mode: a roller ahead of the tip is a line of symmetry"));
        }
        let along =
            |e: usize, of: [f64; 2]| {
                mesh.edges[e].vertices.map(seen).iter().all(|x| {
                    (x[0] * of[1] - x[1] * of[0]).abs() <= ON * size && x[0] * of[0] + x[1] * of[1] >= -ON * size
                })
            };
        let like_a_face = outline.iter().copied().filter(|&e| along(e, face) && (free(e) || touches(problem, e, mode)));
        // Beyond the other end of the crack the body is whole, and has other cracks perhaps.
        let faces = connected(problem, &like_a_face.collect::<Vec<_>>(), vertex);
        let role = |e: usize| {
            if faces.contains(&e) {
                Role::Face
            } else if half && along(e, axes[0]) && roller(e, axes[1]) {
                Role::Ahead
            } else {
                Role::Other
            }
        };
        for (e, _) in at_tip {
            if role(e) == Role::Other {
                return Err(other(match problem.conditions[e] {
                    Condition::Contact { .. } => {
                        "its faces may touch, and KI is that of faces without traction; KII is bounded where they slide without friction"
                    }
                    Condition::Traction(_) => "its faces are loaded",
                    _ => "its faces are held",
                }));
            }
        }
        let radius = outline
            .iter()
            .filter(|&&e| role(e) == Role::Other)
            .map(|&e| distance(seen(mesh.edges[e].vertices[0]), seen(mesh.edges[e].vertices[1])))
            .fold(f64::INFINITY, f64::min);
        let end = faces.iter().flat_map(|&e| mesh.edges[e].vertices).map(far).fold(0.0, f64::max);
        let radius = radius.min(end);
        let coarse = || NoTip::Coarse { x, y, radius: format!("{radius:.3e}"), body };
        let mut eta: Vec<f64> = (0..mesh.points.len()).map(|v| cut_off(far(v) / radius)).collect();
        let mut place =
            Place { body, at: mesh.points[vertex], axes, half, triangles: vec![], inner: vec![], edges: vec![] };
        let near: Vec<usize> = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body).collect();
        // Triangles that are large for their distance belong to P.
        for &t in &near {
            let corners = mesh.triangles[t];
            if place.away(mesh.corners(t)) < NEAREST && corners.iter().any(|&v| eta[v] > 0.0) {
                if corners.iter().any(|&v| far(v) >= radius) {
                    return Err(coarse());
                }
                corners.iter().for_each(|&v| eta[v] = 1.0);
            }
        }
        let mut inside = vec![false; mesh.triangles.len()];
        for &t in &near {
            let values = mesh.triangles[t].map(|v| eta[v]);
            if values == [1.0; 3] {
                inside[t] = true;
                place.inner.push((t, values));
            } else if values != [0.0; 3] {
                place.triangles.push((t, values));
            }
        }
        for &(t, _) in &place.inner {
            for e in mesh.triangle_edges[t] {
                let edge = &mesh.edges[e];
                if let [Some(a), Some(b)] = edge.triangles
                    && inside[a] != inside[b]
                    && mesh.body[a] == mesh.body[b]
                {
                    // The normal of the frame leaves the first triangle; here it has to enter P.
                    place.edges.push((e, if inside[b] { 1.0 } else { -1.0 }));
                }
            }
        }
        if place.edges.is_empty() { Err(coarse()) } else { Ok(place) }
    }

    /// A point as seen from the tip, in the axes of the crack.
    pub fn seen(&self, at: [f64; 2]) -> [f64; 2] {
        let d = [at[0] - self.at[0], at[1] - self.at[1]];
        self.axes.map(|axis| axis[0] * d[0] + axis[1] * d[1])
    }

    /// The distance of a triangle from the tip over its longest side.
    pub fn away(&self, corners: [[f64; 2]; 3]) -> f64 {
        let seen = corners.map(|p| [p[0] - self.at[0], p[1] - self.at[1]]);
        let (mut nearest, mut longest) = (f64::INFINITY, 0.0_f64);
        for i in 0..3 {
            let [a, b] = [seen[i], seen[(i + 1) % 3]];
            if a != b {
                nearest = nearest.min(distance(a, b));
                longest = longest.max((a[0] - b[0]).hypot(a[1] - b[1]));
            }
        }
        nearest / longest
    }
}

/// Those of `edges` from which a way along them leads to `vertex`.
fn connected(problem: &Problem, edges: &[usize], vertex: usize) -> HashSet<usize> {
    let mut sets = DisjointSets::new(problem.mesh.points.len());
    let ends = |e: usize| problem.mesh.edges[e].vertices;
    edges.iter().for_each(|&e| sets.join(ends(e)[0], ends(e)[1]));
    let root = sets.root(vertex);
    edges.iter().copied().filter(|&e| sets.root(ends(e)[0]) == root).collect()
}

/// True if an edge is one side of a frictionless contact across which w of this mode does not jump.
fn touches(problem: &Problem, e: usize, mode: Mode) -> bool {
    mode == Mode::II && matches!(problem.conditions[e], Condition::Contact { .. })
}

/// η of the distance over the radius.
fn cut_off(r: f64) -> f64 {
    let t = ((r - INNER) / (1.0 - INNER)).clamp(0.0, 1.0);
    1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}
