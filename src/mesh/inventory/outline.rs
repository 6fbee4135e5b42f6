//! The outline of the bodies of a mesh, divided into straight lines, arcs of circles and the rest.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::Region;
use crate::mesh::topology::labels::{Pair, pair};
use crate::scene::Circle;

/// Distance from a line or circle, in parts of the largest coordinate, that counts as on it: a tenth of what `[[boundaries]]` allow.
const ON: f64 = 1e-7;
/// Cosine of the largest turn between edges of one curve, 40 degrees.
const SMOOTH: f64 = 0.766;

/// Where the edges of a piece lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// On a segment.
    Line([[f64; 2]; 2]),
    /// On a circle.
    Circle {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
    },
    /// On some other curve within a box.
    Curve([[f64; 2]; 2]),
}

impl Shape {
    /// The key of `[[boundaries]]` that chooses it.
    pub fn key(&self) -> String {
        let point = |[x, y]: [f64; 2]| format!("[{x:?}, {y:?}]");
        match self {
            Shape::Line([a, b]) => format!("line = [{}, {}]", point(*a), point(*b)),
            Shape::Circle { centre, radius } => {
                format!("circle = {{ centre = {}, radius = {radius:?} }}", point(*centre))
            }
            Shape::Curve([low, high]) => format!("box = [{}, {}]", point(*low), point(*high)),
        }
    }
}

/// A piece of the outline of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// A name for it that the file does not have.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// Where its edges lie.
    pub shape: Shape,
    /// Its edges, with the body on their left.
    pub edges: Vec<[usize; 2]>,
    /// Sum of their lengths.
    pub length: f64,
    /// True if another body has these edges too.
    pub shared: bool,
    /// True if the file names all of its edges.
    pub named: bool,
    /// Number of other edges of the body that its box takes with it.
    pub others: usize,
}

/// An edge with a body on its left.
pub(super) struct Side {
    pub vertices: [usize; 2],
    pub body: usize,
    pub shared: bool,
}

pub(super) fn length([p, q]: [[f64; 2]; 2]) -> f64 {
    (q[0] - p[0]).hypot(q[1] - p[1])
}

/// The edges that one triangle has, and for each body those between two.
pub(super) fn sides(points: &[[f64; 2]], triangles: &[[usize; 3]], body: &[usize]) -> Vec<Side> {
    let mut of: HashMap<Pair, Vec<usize>> = HashMap::new();
    let mut all = Vec::with_capacity(3 * triangles.len());
    for (cell, &body) in triangles.iter().zip(body) {
        let [p, q, r] = cell.map(|v| points[v]);
        let left = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0.0;
        for i in 0..3 {
            let (a, b) = (cell[i], cell[(i + 1) % 3]);
            of.entry(pair(a, b)).or_default().push(body);
            all.push(Side { vertices: if left { [a, b] } else { [b, a] }, body, shared: false });
        }
    }
    let outer = |mut side: Side| match of[&pair(side.vertices[0], side.vertices[1])].as_slice() {
        [_] => Some(side),
        [a, b] if a != b => {
            side.shared = true;
            Some(side)
        }
        _ => None,
    };
    all.into_iter().filter_map(outer).collect()
}

/// The pieces, body by body, with names that are not among those `taken`.
pub(super) fn pieces(
    points: &[[f64; 2]],
    sides: &[Side],
    bodies: &[Region],
    of_file: &HashSet<Pair>,
    taken: &HashSet<&str>,
) -> Vec<Piece> {
    let near = ON * points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut names = Names { taken: taken.iter().map(|name| name.to_string()).collect() };
    names.taken.extend(bodies.iter().map(|region| region.body.clone()));
    let mut found = Vec::new();
    for (body, region) in bodies.iter().enumerate() {
        for shared in [false, true] {
            let own: Vec<[usize; 2]> =
                sides.iter().filter(|s| s.body == body && s.shared == shared).map(|s| s.vertices).collect();
            for (shape, edges) in
                gathered(chains(&own).iter().flat_map(|chain| runs(points, chain, near)).collect(), near)
            {
                let length = edges.iter().map(|e| length(e.map(|v| points[v]))).sum();
                let named = edges.iter().all(|[a, b]| of_file.contains(&pair(*a, *b)));
                let inside = |p: [f64; 2], [low, high]: [[f64; 2]; 2]| {
                    (0..2).all(|c| p[c] >= low[c] - near && p[c] <= high[c] + near)
                };
                let others = match shape {
                    Shape::Curve(extent) => {
                        let within =
                            |s: &&Side| s.body == body && s.vertices.iter().all(|&v| inside(points[v], extent));
                        sides.iter().filter(within).count().saturating_sub(edges.len())
                    }
                    _ => 0,
                };
                let name = names.of(&shape, region, bodies.len() > 1, near);
                found.push(Piece { name, body, shape, edges, length, shared, named, others });
            }
        }
    }
    found
}

/// Chains of edges, each beginning where the one before ends.
fn chains(edges: &[[usize; 2]]) -> Vec<Vec<[usize; 2]>> {
    let mut leaving: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (e, [from, _]) in edges.iter().enumerate() {
        leaving.entry(*from).or_default().push(e);
    }
    let arriving: HashSet<usize> = edges.iter().map(|e| e[1]).collect();
    let ends = edges.iter().map(|e| e[0]).filter(|v| !arriving.contains(v));
    let starts: Vec<usize> = ends.chain(edges.iter().map(|e| e[0])).collect();
    let mut chains = Vec::new();
    for start in starts {
        let (mut at, mut chain) = (start, Vec::new());
        while let Some(e) = leaving.get_mut(&at).and_then(Vec::pop) {
            chain.push(edges[e]);
            at = edges[e][1];
        }
        if !chain.is_empty() {
            chains.push(chain);
        }
    }
    chains
}

/// True if the second edge goes on where the first ends without a corner.
fn smooth(points: &[[f64; 2]], first: [usize; 2], second: [usize; 2]) -> bool {
    let along = |e: [usize; 2]| {
        let [p, q] = e.map(|v| points[v]);
        ([q[0] - p[0], q[1] - p[1]], length([p, q]))
    };
    let ((a, la), (b, lb)) = (along(first), along(second));
    first[1] == second[0] && a[0] * b[0] + a[1] * b[1] >= SMOOTH * la * lb
}

type Run = (Shape, Vec<[usize; 2]>);

/// A chain cut into straight runs, arcs, and what lies between.
fn runs(points: &[[f64; 2]], chain: &[[usize; 2]], near: f64) -> Vec<Run> {
    let n = chain.len();
    // A closed chain is cut first where it has a corner.
    let closed = n > 2 && chain[0][0] == chain[n - 1][1];
    let corner = (0..n).find(|&i| !smooth(points, chain[(i + n - 1) % n], chain[i]));
    let mut chain = chain.to_vec();
    match corner {
        Some(corner) if closed => chain.rotate_left(corner),
        // Without one it is cut where its first line or arc ends.
        None if closed => {
            let first = longest(&chain, |run| line(points, run, near).is_some()).max(longest_arc(points, &chain, near));
            chain.rotate_left(first % n);
        }
        _ => {}
    }
    let mut runs: Vec<Run> = Vec::new();
    let (mut start, mut loose) = (0, Vec::new());
    while start < n {
        let straight = longest(&chain[start..], |run| line(points, run, near).is_some());
        let arc = if straight > 1 { 0 } else { longest_arc(points, &chain[start..], near) };
        let end = start + straight.max(arc);
        let part = &chain[start..end];
        let shape = if arc > straight { circle(points, part, near) } else { line(points, part, near) };
        match shape {
            Some(shape) if part.len() > 1 => {
                flush(points, &mut loose, &mut runs);
                runs.push((shape, part.to_vec()));
            }
            _ => {
                if loose.last().is_some_and(|last| !smooth(points, *last, part[0])) {
                    flush(points, &mut loose, &mut runs);
                }
                loose.extend_from_slice(part);
            }
        }
        start = end;
    }
    flush(points, &mut loose, &mut runs);
    runs
}

/// Ends a run of edges that are on no line and no circle together.
fn flush(points: &[[f64; 2]], loose: &mut Vec<[usize; 2]>, runs: &mut Vec<Run>) {
    let edges = std::mem::take(loose);
    match edges.as_slice() {
        [] => {}
        [[a, b]] => runs.push((Shape::Line([points[*a], points[*b]]), edges)),
        _ => {
            let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
            for p in edges.iter().flatten().map(|&v| points[v]) {
                extent[0] = [extent[0][0].min(p[0]), extent[0][1].min(p[1])];
                extent[1] = [extent[1][0].max(p[0]), extent[1][1].max(p[1])];
            }
            runs.push((Shape::Curve(extent), edges));
        }
    }
}

/// The largest number of edges from the first on that `fit` together: found by doubling and halving.
fn longest(edges: &[[usize; 2]], fit: impl Fn(&[[usize; 2]]) -> bool) -> usize {
    let mut good = 1;
    while good < edges.len() && fit(&edges[..(2 * good).min(edges.len())]) {
        good = (2 * good).min(edges.len());
    }
    let mut step = good;
    while step > 0 {
        if good + step <= edges.len() && fit(&edges[..good + step]) {
            good += step;
        } else {
            step /= 2;
        }
    }
    good
}

/// The longest arc of at least three edges, or none.
fn longest_arc(points: &[[f64; 2]], edges: &[[usize; 2]], near: f64) -> usize {
    let Some(first) = edges.get(..3) else { return 0 };
    if circle(points, first, near).is_none() {
        return 0;
    }
    let further = longest(&edges[2..], |run| circle(points, &edges[..run.len() + 2], near).is_some());
    2 + further
}

fn line(points: &[[f64; 2]], run: &[[usize; 2]], near: f64) -> Option<Shape> {
    let (a, b) = (points[run.first()?[0]], points[run.last()?[1]]);
    let (dx, dy, l) = (b[0] - a[0], b[1] - a[1], length([a, b]));
    let mut before = 0.0;
    for p in run.iter().map(|e| points[e[1]]) {
        let (beside, along) =
            ((dx * (p[1] - a[1]) - dy * (p[0] - a[0])) / l, (dx * (p[0] - a[0]) + dy * (p[1] - a[1])) / l);
        if !(beside.abs() <= near && along > before) {
            return None;
        }
        before = along;
    }
    Some(Shape::Line([a, b]))
}

fn circle(points: &[[f64; 2]], run: &[[usize; 2]], near: f64) -> Option<Shape> {
    if run.windows(2).any(|w| !smooth(points, w[0], w[1])) {
        return None;
    }
    let (a, b) = (points[run.first()?[0]], points[run.last()?[1]]);
    let n = run.len();
    let (middle, last) = if a == b { (n / 3, points[run[2 * n / 3][0]]) } else { (n / 2, b) };
    let found = Circle::through(a, points[run[middle][0]], last)?;
    let (centre, radius) = (found.centre, found.radius);
    let on = |p: [f64; 2]| (length([centre, p]) - radius).abs() <= near;
    let short = |e: &[usize; 2]| length(e.map(|v| points[v])) < 1.4 * radius;
    run.iter().all(|e| on(points[e[1]]) && short(e)).then_some(Shape::Circle { centre, radius })
}

/// Runs of one body; all arcs of a circle are one piece, as one table of `[[boundaries]]` takes them all.
fn gathered(runs: Vec<Run>, near: f64) -> Vec<Run> {
    let mut whole: Vec<Run> = Vec::new();
    for (shape, edges) in runs {
        let same = |other: &&mut Run| match (&shape, &other.0) {
            (Shape::Circle { centre: a, radius: r }, Shape::Circle { centre: b, radius: s }) => {
                length([*a, *b]) <= 5.0 * near && (r - s).abs() <= 5.0 * near
            }
            _ => false,
        };
        match whole.iter_mut().find(same) {
            Some((_, all)) => all.extend(edges),
            None => whole.push((shape, edges)),
        }
    }
    whole
}

/// Names of pieces.
struct Names {
    taken: HashSet<String>,
}

impl Names {
    /// By the side of the body where a line lies, by kind otherwise; numbered where there are more.
    fn of(&mut self, shape: &Shape, region: &Region, several: bool, near: f64) -> String {
        let [low, high] = region.extent;
        let at = |c: usize, value: f64, line: &[[f64; 2]; 2]| line.iter().all(|p| (p[c] - value).abs() <= near);
        let kind = match shape {
            Shape::Line(line) if at(1, low[1], line) => "bottom",
            Shape::Line(line) if at(1, high[1], line) => "top",
            Shape::Line(line) if at(0, low[0], line) => "left",
            Shape::Line(line) if at(0, high[0], line) => "right",
            Shape::Line(_) => "line",
            Shape::Circle { .. } => "circle",
            Shape::Curve(_) => "curve",
        };
        let stem = if several { format!("{}_{kind}", region.body) } else { kind.to_string() };
        let free = (1..).map(|n| if n == 1 { stem.clone() } else { format!("{stem}_{n}") });
        let name = free.into_iter().find(|name| !self.taken.contains(name)).unwrap_or(stem);
        self.taken.insert(name.clone());
        name
    }
}
