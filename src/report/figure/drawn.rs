//! How large a displacement is drawn, and where: so that bodies do not seem to penetrate that do not.

use crate::bounds::{openings, side_coefficients};
use crate::element::Displacement;
use crate::problem::{ContactPair, Interface, Problem};

/// Overlap that a reader does not see, in sizes of the scene.
const UNSEEN: f64 = 0.004;
/// Points of the first side of a contact that are looked at.
const POINTS: usize = 160;

/// A displacement is drawn `scale` times as large, every body moved by its entry of `apart` first: a gap that
/// separates bodies is drawn as many times as wide as the displacements that close it.
pub struct Drawn {
    pub scale: f64,
    /// True if bodies are moved apart, so that gaps are drawn scaled.
    pub gaps_scaled: bool,
    /// True if a larger scale would show bodies overlapping that do not.
    pub held_back: bool,
    apart: Vec<[f64; 2]>,
}

impl Drawn {
    /// The factor 1, 2 or 5 times a power of ten that makes the largest of `fields` about an eighth of the size of the scene,
    /// or the largest one, at least 1, at which no picture shows an overlap that is none.
    pub fn of(problem: &Problem, fields: &[&Displacement]) -> Self {
        let fits: Vec<&Displacement> =
            fields.iter().copied().filter(|f| f.len() == problem.mesh.triangles.len()).collect();
        let nodes = fits.iter().flat_map(|f| (0..f.len()).flat_map(|t| f.block(t)));
        let largest = nodes.map(|u| u[0].hypot(u[1])).filter(|d| d.is_finite()).fold(0.0, f64::max);
        let wanted = round_down(0.13 * size(problem) / largest);
        let mut scale = wanted;
        loop {
            let apart = apart(problem, scale);
            let gaps_scaled = apart.iter().any(|&d| d != [0.0; 2]);
            let drawn = Drawn { scale, gaps_scaled, held_back: scale < wanted, apart };
            if scale <= 1.0 || !fits.iter().any(|field| drawn.overlap(problem, field)) {
                return drawn;
            }
            scale = round_down(0.9 * scale).max(1.0);
        }
    }

    /// How far `body` is moved before it is displaced.
    pub fn apart(&self, body: usize) -> [f64; 2] {
        self.apart.get(body).copied().unwrap_or_default()
    }

    /// Where a point of triangle `t` is drawn that is at `point` and moves by `u`.
    pub fn place(&self, problem: &Problem, t: usize, point: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        let apart = self.apart(problem.mesh.body[t]);
        [0, 1].map(|c| point[c] + apart[c] + self.scale * u[c])
    }

    /// True if sides in contact are drawn farther inside each other than they are.
    fn overlap(&self, problem: &Problem, field: &Displacement) -> bool {
        problem.interfaces.iter().any(|interface| self.deepest(problem, interface, field) > UNSEEN * size(problem))
    }

    /// How far the first side of a contact is drawn inside the second, less what its penetration is at this scale.
    fn deepest(&self, problem: &Problem, interface: &Interface, field: &Displacement) -> f64 {
        let within = interface.pairs.iter().flat_map(|pair| openings(problem, field, pair)).fold(0.0, f64::min);
        let other: Vec<([[f64; 2]; 2], [f64; 2])> = interface
            .pairs
            .iter()
            .filter_map(|pair| Some((self.side(problem, field, pair, 1)?, pair.direction.unit(0))))
            .collect();
        let step = interface.pairs.len().div_ceil(POINTS / 2).max(1);
        let own = interface.pairs.iter().step_by(step).filter_map(|pair| self.side(problem, field, pair, 0)).flatten();
        own.filter_map(|p| depth(p, &other)).fold(0.0, f64::max) + self.scale * within
    }

    /// Both ends of one side of a pair as drawn; nothing where it is a rigid obstacle.
    fn side(&self, problem: &Problem, field: &Displacement, pair: &ContactPair, side: usize) -> Option<[[f64; 2]; 2]> {
        let ends = if side == 0 { pair.first } else { pair.second? };
        let edge = &problem.mesh.edges[pair.edges[side]?];
        let u = side_coefficients(problem, field, pair.edges[side]?);
        let (first, last) = (*u.first()?, *u.last()?);
        let u = if edge.vertices[0] == ends[0] { [first, last] } else { [last, first] };
        Some([0, 1].map(|k| self.place(problem, edge.triangles[0].unwrap_or(0), problem.mesh.points[ends[k]], u[k])))
    }
}

/// How far `p` is beyond the nearest of `segments` in the direction beside it; nothing where that is nearest at an end.
fn depth(p: [f64; 2], segments: &[([[f64; 2]; 2], [f64; 2])]) -> Option<f64> {
    let beyond = |([a, b], n): &([[f64; 2]; 2], [f64; 2])| {
        let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let part = (to[0] * along[0] + to[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let near = part.clamp(0.0, 1.0);
        let off = [0, 1].map(|c| to[c] - near * along[c]);
        (off[0].hypot(off[1]), (part == near).then_some(off[0] * n[0] + off[1] * n[1]))
    };
    segments.iter().map(beyond).min_by(|a, b| a.0.total_cmp(&b.0))?.1
}

/// How far every body is moved in a drawing so that the least gap of a contact is `scale` times as wide as it is (in the mesh
/// both sides are in one place): from the first body of every group on.
fn apart(problem: &Problem, scale: f64) -> Vec<[f64; 2]> {
    let mesh = &problem.mesh;
    let mut apart: Vec<Option<[f64; 2]>> = vec![None; problem.scene.bodies.len()];
    let body = |e: usize| Some(mesh.body[mesh.edges[e].triangles[0]?]);
    let wider = |interface: &Interface| {
        let [first, second] = interface.pairs.first()?.edges;
        let [x, y] = interface.pairs.first()?.direction.unit(0);
        let straight = |n: [f64; 2]| n[0] * x + n[1] * y > 0.999;
        // Around a corner or along a curve no one motion of a body widens the gap everywhere.
        let all =
            interface.pairs.iter().all(|pair| [0, 1].map(|end| pair.direction.unit(end)).into_iter().all(straight));
        let gaps = interface.pairs.iter().flat_map(|pair| pair.gap);
        let least = if all { gaps.fold(f64::INFINITY, f64::min).max(0.0) } else { 0.0 };
        Some(([body(first?)?, body(second?)?], [scale * least * x, scale * least * y]))
    };
    let bonded = mesh.edges.iter().filter_map(|edge| match edge.triangles.map(|t| t.map(|t| mesh.body[t])) {
        [Some(a), Some(b)] if a != b => Some(([a, b], [0.0; 2])),
        _ => None,
    });
    // The narrowest first: bodies that are one, or touch somewhere, are not drawn apart for what separates them elsewhere.
    let mut wider: Vec<([usize; 2], [f64; 2])> = problem.interfaces.iter().filter_map(wider).chain(bonded).collect();
    wider.sort_by(|(_, a), (_, b)| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
    for root in 0..apart.len() {
        apart[root].get_or_insert([0.0; 2]);
        while let Some((n, d)) = wider.iter().find_map(|&([a, b], by)| match (apart[a], apart[b]) {
            (Some(from), None) => Some((b, [0, 1].map(|c| from[c] + by[c]))),
            (None, Some(from)) => Some((a, [0, 1].map(|c| from[c] - by[c]))),
            _ => None,
        }) {
            apart[n] = Some(d);
        }
    }
    apart.into_iter().map(Option::unwrap_or_default).collect()
}

/// Largest extent of the scene.
pub(super) fn size(problem: &Problem) -> f64 {
    let extent = |c: usize| {
        let (low, high) =
            problem.mesh.points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[c]), h.max(p[c])));
        high - low
    };
    extent(0).max(extent(1))
}

fn round_down(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(x.log10().floor());
    power * [5.0, 2.0, 1.0].into_iter().find(|m| m * power <= x * 1.000001).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    /// Two unit squares side by side with a gap, the first one moved to the right.
    fn closing(gap: f64, by: f64) -> (Sample, Displacement) {
        let mut sample = Sample::new(2, Verdict::Agree);
        sample.problem.interfaces[0].pairs.iter_mut().for_each(|pair| pair.gap = [gap; 2]);
        let mesh = &sample.problem.mesh;
        let mut field = Displacement::from_p1(mesh, &vec![[0.0; 2]; mesh.points.len()]);
        for t in (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == 0) {
            field.block_mut(t).fill([by, 0.0]);
        }
        (sample, field)
    }

    #[test]
    fn the_scale_is_round_and_keeps_the_picture_readable() {
        let sample = Sample::new(2, Verdict::Agree);
        let dossier = sample.dossier();
        let fields: Vec<&Displacement> = dossier.displacements.iter().map(|d| d.1).collect();
        // The largest displacement of the formula is hypot(1.8, …) < 2.5 in a scene of size 2.
        assert_eq!(Drawn::of(&sample.problem, &fields).scale, 0.1);
        assert_eq!(Drawn::of(&sample.problem, &[]).scale, 1.0);
        assert_eq!([0.3, 1000.0].map(round_down), [0.2, 1000.0]);
    }

    #[test]
    fn a_gap_is_drawn_as_the_displacements_that_close_it() {
        let (sample, field) = closing(0.001, 0.001);
        let drawn = Drawn::of(&sample.problem, &[&field]);
        assert!(drawn.scale == 200.0 && drawn.gaps_scaled && !drawn.held_back);
        // The mesh has no gap between its sides: both are drawn 0.2 further on, and touch.
        let [first, second] =
            [0, 1].map(|side| drawn.side(&sample.problem, &field, &sample.problem.interfaces[0].pairs[0], side));
        let [first, second] = [first, second].map(|s| s.expect("two bodies")[0][0]);
        assert!((second - first).abs() < 1e-12 && first > 1.19, "{first} {second}");
    }

    #[test]
    fn what_does_penetrate_is_drawn_so_and_what_does_not_is_not() {
        // No gap, and one side in the other: shown at full size.
        let (sample, field) = closing(0.0, 0.001);
        let drawn = Drawn::of(&sample.problem, &[&field]);
        assert!(drawn.scale == 200.0 && !drawn.held_back);
        // A gap that is wide at one end and closed at the other cannot be undone by moving a body: the scale is less.
        let (mut sample, field) = closing(0.0, 0.0);
        let mut field = field;
        let pairs = &mut sample.problem.interfaces[0].pairs;
        let count = pairs.len() as f64;
        for (n, pair) in pairs.iter_mut().enumerate() {
            pair.gap = [n as f64, n as f64 + 1.0].map(|n| 0.04 * (n / count - 0.5).abs());
        }
        let mesh = &sample.problem.mesh;
        for t in (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == 0) {
            for k in 0..3 {
                let y = mesh.corners(t)[k][1];
                field.block_mut(t)[k] = [0.04 * (y - 0.5).abs(), 0.0];
            }
        }
        let drawn = Drawn::of(&sample.problem, &[&field]);
        // The sides touch in the middle, and are not drawn apart there.
        assert!(!drawn.gaps_scaled && drawn.apart == [[0.0; 2]; 2]);
        assert!(drawn.held_back && drawn.scale >= 1.0 && drawn.scale < 10.0, "{}", drawn.scale);
    }
}
