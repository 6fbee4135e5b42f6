//! Right displacements written in a wrong way: signs, axes, order.

use crate::diagnose::space::Space;
use crate::diagnose::{Finding, Trial};

/// Shifts of the numbering that are tried, either way.
const SHIFTS: usize = 3;

/// Undoes a mistake at one node.
type Undo = fn([f64; 2]) -> [f64; 2];

/// Every way that is known, undone.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let candidate = space.solution.candidate;
    let simple: [(&str, &str, Undo); 4] = [
        ("sign-x", "component x of the displacement has the opposite sign", |[x, y]| [-x, y]),
        ("sign-y", "component y of the displacement has the opposite sign", |[x, y]| [x, -y]),
        ("axes", "x and y of the displacement are exchanged", |[x, y]| [y, x]),
        ("turned", "the displacement is turned by a right angle", |[x, y]| [-y, x]),
    ];
    let mut trials: Vec<Trial> = simple
        .into_iter()
        .map(|(name, sentence, undo)| {
            let left = left(space, |node| undo(candidate.value(node)), &[]);
            Trial { rank: 0, left, findings: vec![Finding::new(format!("displacement/{name}"), None, None, sentence)] }
        })
        .collect();
    trials.extend(Order::new(space).map(|order| order.trials(space)).unwrap_or_default());
    trials
}

/// Part of the squared residual that is left with other displacements; nodes of triangles that touch `lost` do not count, and where these
/// are most of them nothing is explained.
fn left(space: &Space<'_>, value: impl Fn(usize) -> [f64; 2], lost: &[usize]) -> f64 {
    let problem = space.problem();
    let internal = space.column(space.own_forces(None, value));
    let loads = space.column(space.solution.forces.load.clone());
    let mut counted = vec![true; space.count()];
    for t in 0..if lost.is_empty() { 0 } else { problem.mesh.triangles.len() } {
        let nodes = space.nodes(t);
        if nodes.iter().any(|n| lost.contains(n)) {
            nodes.iter().for_each(|n| counted[*n] = false);
        }
    }
    if 2 * counted.iter().filter(|counted| !**counted).count() > counted.len() {
        return 1.0;
    }
    let term = |(k, (a, b)): (usize, (&f64, &f64))| if counted[k / 2] { (a - b).powi(2) } else { 0.0 };
    // What the other nodes leave of the residual is explained by nothing.
    let own: f64 = (0..space.count()).filter(|n| counted[*n]).map(|n| space.square_at(n)).sum();
    internal.iter().zip(&loads).enumerate().map(term).sum::<f64>() / space.whole().min(own)
}

/// Nodes in the order of the file.
struct Order {
    /// The node of every point.
    nodes: Vec<usize>,
    /// The point of every node.
    points: Vec<usize>,
}

impl Order {
    /// Where every node is one point, and every point one node.
    fn new(space: &Space<'_>) -> Option<Self> {
        let numbering = space.solution.candidate.numbering.as_ref()?;
        let points: Vec<usize> = numbering.nodes.iter().take(space.count()).copied().collect::<Option<_>>()?;
        let mut nodes = vec![usize::MAX; points.len()];
        for (node, point) in points.iter().enumerate() {
            *nodes.get_mut(*point).filter(|n| **n == usize::MAX)? = node;
        }
        Some(Order { nodes, points })
    }

    fn trials(&self, space: &Space<'_>) -> Vec<Trial> {
        let count = self.nodes.len();
        let at = |point: usize| space.solution.candidate.value(self.nodes[point]);
        let mut trials = Vec::new();
        for by in 1..=SHIFTS.min(count.saturating_sub(1)) {
            for forward in [true, false] {
                let source = |point: usize| if forward { (point + by) % count } else { (point + count - by) % count };
                let lost: Vec<usize> = if forward { count - by..count } else { 0..by }.map(|p| self.nodes[p]).collect();
                let left = left(space, |node| at(source(self.points[node])), &lost);
                let shift = if forward { by as f64 } else { -(by as f64) };
                let sentence = format!(
                    "the displacements are shifted against the points by {by}: point i has that of point i {} {by}",
                    if forward { '−' } else { '+' }
                );
                trials.push(Trial {
                    rank: 0,
                    left,
                    findings: vec![Finding::new("displacement/shifted", Some(shift), Some(0.0), sentence)],
                });
            }
        }
        // The components one after the other, as rows of two, or rows of two as if one after the other.
        let rows = |k: usize| at(k / 2)[k % 2];
        let blocks = |k: usize| if k < count { at(k)[0] } else { at(k - count)[1] };
        let blocked = left(space, |node| [rows(self.points[node]), rows(count + self.points[node])], &[]);
        let interleaved = left(space, |node| [0, 1].map(|c| blocks(2 * self.points[node] + c)), &[]);
        for (left, sentence) in [
            (blocked, "all x and then all y of the displacement were written as if they alternated"),
            (interleaved, "alternating x and y of the displacement were written as if all x came first"),
        ] {
            trials.push(Trial {
                rank: 0,
                left,
                findings: vec![Finding::new("displacement/order", None, None, sentence)],
            });
        }
        trials
    }
}
