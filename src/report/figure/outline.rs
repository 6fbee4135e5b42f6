//! From the mesh to lines on the page: the view, outlines of bodies, chains of edges.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::svg::px;
use crate::mesh::Triangulation;

/// A box of the plane shown in a box of the page, equal scales, y upwards in the plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    /// Page units per unit of length.
    pub scale: f64,
    origin: [f64; 2],
}

impl View {
    /// Fits the finite ones of `points` into `width` × at most `height` page units behind a margin; returns the height used
    /// including both margins.
    pub fn fit(points: impl IntoIterator<Item = [f64; 2]>, width: f64, height: f64, margin: f64) -> (Self, f64) {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points.into_iter().filter(|p| p.iter().all(|x| x.is_finite())) {
            for c in 0..2 {
                low[c] = low[c].min(p[c]);
                high[c] = high[c].max(p[c]);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [1.0; 2]);
        }
        let inner = [width - 2.0 * margin, height - 2.0 * margin];
        let span = [0, 1].map(|c| high[c] - low[c]);
        let scale = [0, 1].map(|c| inner[c] / span[c]).into_iter().fold(f64::INFINITY, f64::min);
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let used = span[1] * scale + 2.0 * margin;
        let left = margin + 0.5 * (inner[0] - span[0] * scale);
        (View { scale, origin: [left - low[0] * scale, used - margin + low[1] * scale] }, used)
    }

    /// The view in which everything appears moved by `by` in the plane.
    pub fn moved(self, by: [f64; 2]) -> Self {
        let [x, y] = self.origin;
        View { origin: [x + self.scale * by[0], y - self.scale * by[1]], ..self }
    }

    /// Page coordinates of a point of the plane.
    pub fn at(&self, p: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + self.scale * p[0], self.origin[1] - self.scale * p[1]]
    }
}

/// Orders directed segments (from, to) into chains, each a list of indices; those that close come back to their start.
pub(crate) fn trace(segments: &[[usize; 2]]) -> Vec<Vec<usize>> {
    let mut leaving: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut arriving: BTreeMap<usize, usize> = BTreeMap::new();
    for (s, [from, to]) in segments.iter().enumerate() {
        leaving.entry(*from).or_default().push(s);
        *arriving.entry(*to).or_default() += 1;
    }
    leaving.values_mut().for_each(|list| list.reverse());
    let open_ends = segments.iter().map(|s| s[0]).filter(|v| !arriving.contains_key(v));
    let starts: Vec<usize> = open_ends.chain(segments.iter().map(|s| s[0])).collect();
    let mut chains = Vec::new();
    for start in starts {
        let mut at = start;
        let mut chain = Vec::new();
        while let Some(s) = leaving.get_mut(&at).and_then(Vec::pop) {
            chain.push(s);
            at = segments[s][1];
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// The edges around `body`, as (edge, triangle inside), counter-clockwise loop by loop.
pub(crate) fn loops(mesh: &Triangulation, body: usize) -> Vec<Vec<(usize, usize)>> {
    let inside = |t: Option<usize>| t.filter(|&t| mesh.body.get(t) == Some(&body));
    let mut around = Vec::new();
    let mut segments = Vec::new();
    for (e, edge) in mesh.edges.iter().enumerate() {
        let [a, b] = edge.vertices;
        match edge.triangles.map(inside) {
            [Some(t), None] => {
                around.push((e, t));
                segments.push([a, b]);
            }
            [None, Some(t)] => {
                around.push((e, t));
                segments.push([b, a]);
            }
            _ => {}
        }
    }
    trace(&segments).into_iter().map(|chain| chain.into_iter().map(|s| around[s]).collect()).collect()
}

/// The edges in chains, each in the order of walking with the body on the left.
pub(crate) fn edge_chains(mesh: &Triangulation, edges: &[usize]) -> Vec<Vec<usize>> {
    let segments: Vec<[usize; 2]> = edges.iter().map(|&e| mesh.edges[e].vertices).collect();
    trace(&segments).into_iter().map(|chain| chain.into_iter().map(|s| edges[s]).collect()).collect()
}

/// Chains of boundary edges, each as the polyline of its points with the body on the left.
pub(crate) fn chains(mesh: &Triangulation, edges: &[usize]) -> Vec<Vec<[f64; 2]>> {
    let points = |chain: Vec<usize>| {
        let first = chain.first().map(|&e| mesh.edges[e].vertices[0]);
        first.into_iter().chain(chain.iter().map(|&e| mesh.edges[e].vertices[1])).map(|v| mesh.points[v]).collect()
    };
    edge_chains(mesh, edges).into_iter().map(points).collect()
}

/// Path data of the outline of `body` in the undeformed state.
pub(crate) fn outline(mesh: &Triangulation, body: usize, view: &View) -> String {
    let mut d = String::new();
    for ring in loops(mesh, body) {
        let points: Vec<[f64; 2]> = ring
            .iter()
            .map(|&(e, t)| {
                let [a, b] = mesh.edges[e].vertices;
                view.at(mesh.points[if mesh.edges[e].triangles[0] == Some(t) { a } else { b }])
            })
            .collect();
        d.push_str(&polyline(&corners_only(&points)));
        d.push('z');
    }
    d
}

/// Path data of a polyline in page coordinates.
pub(crate) fn polyline(points: &[[f64; 2]]) -> String {
    let mut d = String::new();
    for (i, p) in points.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(d, "{}{} {}", if i == 0 { 'M' } else { 'L' }, px(p[0]), px(p[1]));
    }
    d
}

/// A ring without the points that lie on the straight line of their neighbours to a twentieth of a page unit.
fn corners_only(ring: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (i, p) in ring.iter().enumerate() {
        let (Some(a), b) = (kept.last(), ring[(i + 1) % ring.len()]) else {
            kept.push(*p);
            continue;
        };
        let (u, v) = ([p[0] - a[0], p[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
        let distance = (u[0] * v[1] - u[1] * v[0]).abs() / v[0].hypot(v[1]);
        let ahead = u[0] * v[0] + u[1] * v[1] > 0.0;
        if !(ahead && distance < 0.05) {
            kept.push(*p);
        }
    }
    kept
}

/// A point of a polyline, with the unit tangent there.
pub(crate) type Station = ([f64; 2], [f64; 2]);

/// Points at equal distances of about `spacing` along a polyline in page coordinates, half a step from its ends.
pub(crate) fn stations(points: &[[f64; 2]], spacing: f64) -> Vec<Station> {
    let lengths: Vec<f64> = points.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).collect();
    let total: f64 = lengths.iter().sum();
    if !total.is_finite() || total <= 0.0 {
        return Vec::new();
    }
    let count = (total / spacing).round().clamp(1.0, 400.0);
    let mut list = Vec::new();
    let mut before = 0.0;
    let mut next = 0.5;
    for (w, length) in points.windows(2).zip(&lengths) {
        while next < count && next * total / count <= before + length {
            let s = (next * total / count - before) / length;
            let tangent = [0, 1].map(|c| (w[1][c] - w[0][c]) / length);
            list.push(([0, 1].map(|c| w[0][c] + s * (w[1][c] - w[0][c])), tangent));
            next += 1.0;
        }
        before += length;
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn each_block_has_one_closed_outline_of_unit_area() {
        let mesh = Sample::new(3, Verdict::Agree).problem.mesh;
        for body in 0..2 {
            let rings = loops(&mesh, body);
            assert_eq!(rings.len(), 1);
            assert_eq!(rings[0].len(), 12);
            let area: f64 = rings[0]
                .iter()
                .map(|&(e, _)| {
                    let [p, q] = mesh.edges[e].vertices.map(|v| mesh.points[v]);
                    0.5 * (p[0] * q[1] - p[1] * q[0])
                })
                .sum();
            assert!((area - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn straight_sides_lose_their_inner_points() {
        let mesh = Sample::new(8, Verdict::Agree).problem.mesh;
        let (view, _) = View::fit(mesh.points.iter().copied(), 400.0, 300.0, 10.0);
        assert_eq!(outline(&mesh, 0, &view).matches(['M', 'L']).count(), 4);
    }

    #[test]
    fn chains_are_joined_from_their_open_end() {
        assert_eq!(trace(&[[1, 2], [0, 1], [5, 6], [2, 3]]), [vec![1, 0, 3], vec![2]]);
        assert_eq!(trace(&[[1, 2], [2, 1]]), [vec![0, 1]]);
        assert!(trace(&[]).is_empty());
    }

    #[test]
    fn stations_are_evenly_spaced() {
        let found = stations(&[[0.0, 0.0], [3.0, 0.0], [10.0, 0.0]], 2.0);
        let at: Vec<f64> = found.iter().map(|s| s.0[0]).collect();
        assert_eq!(at, [1.0, 3.0, 5.0, 7.0, 9.0]);
        assert!(stations(&[[0.0, 0.0], [0.0, 0.0]], 2.0).is_empty());
        assert!(stations(&[[f64::NAN, 0.0], [0.0, 0.0]], 2.0).is_empty());
    }

    #[test]
    fn the_view_keeps_everything_inside() {
        let points = [[-3.0, 2.0], [5.0, 2.5], [f64::NAN, 0.0]];
        let (view, height) = View::fit(points, 200.0, 100.0, 10.0);
        for p in &points[..2] {
            let [x, y] = view.at(*p);
            assert!((9.99..=190.01).contains(&x) && (9.99..=height - 9.99).contains(&y), "{x} {y} {height}");
        }
        let (view, _) = View::fit([[1.0, 1.0]], 200.0, 100.0, 10.0);
        assert!(view.scale.is_finite());
    }
}
