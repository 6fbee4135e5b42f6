//! Adaptive refinement by bisection of the longest edge.
//!
//! Every triangle has a refinement edge, its longest. Bisecting it joins the middle of that edge to the opposite vertex. No angle
//! becomes smaller than half the smallest of the first mesh, however often this is repeated (Rosenberg & Stenger 1975), and
//! stretched triangles fall into better ones, which the newest vertex alone, with its four similarity classes, would
//! leave as stretched as they are. Where the edge opposite the newest vertex is as long as any other it is the one: right
//! isosceles triangles stay such.

use super::quarter::middle;
use crate::mesh::topology::labels::{Pair, pair};
use crate::mesh::{Curved, Map, Triangulation};

/// For every triangle the local index of its refinement edge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefinementEdges(Vec<usize>);

impl RefinementEdges {
    /// The longest edge of every triangle; of equal ones that whose middle comes last in (x, y) order, which does not
    /// depend on the numbering.
    pub fn longest(mesh: &Triangulation) -> Self {
        RefinementEdges(mesh.triangles.iter().map(|corners| longest(&mesh.points, corners)).collect())
    }

    /// Local index of the refinement edge of triangle `t`.
    pub fn of(&self, t: usize) -> usize {
        self.0[t]
    }
}

/// Result of [`bisect`].
#[derive(Debug, Clone, PartialEq)]
pub struct Bisected {
    /// The finer mesh; old vertices keep their index.
    pub mesh: Triangulation,
    /// Its refinement edges.
    pub refinement: RefinementEdges,
    /// For each new triangle the old one that contains it.
    pub parent: Vec<usize>,
}

/// Bisects the triangles `marked`, and others as far as needed for a conforming mesh.
///
/// `facing` lists the edges that lie opposite each other in a contact: they are bisected together, so that both sides
/// keep the same vertices, bit for bit. Names of boundaries are kept. Edges in `curved` are divided on their circles.
pub fn bisect(
    mesh: &Triangulation,
    refinement: &RefinementEdges,
    marked: &[usize],
    facing: &[[usize; 2]],
    curved: &Curved,
) -> Bisected {
    let cut = close(mesh, refinement, marked, facing);
    let mut points = mesh.points.clone();
    let mut middles: Map<Pair, usize> = Map::default();
    let mut label = mesh.label();
    for (e, edge) in mesh.edges.iter().enumerate().filter(|(e, _)| cut[*e]) {
        let [a, b] = edge.vertices;
        let m = points.len();
        points.push(mesh.division(e, curved));
        middles.insert(pair(a, b), m);
        if let Some(name) = mesh.edges[e].name {
            label.remove(&pair(a, b));
            label.extend([(pair(a, m), name), (pair(m, b), name)]);
        }
    }
    let (mut triangles, mut edges, mut parent) = (Vec::new(), Vec::new(), Vec::new());
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let r = refinement.0[t];
        let [a, b, c] = [1, 2, 3].map(|k| corners[(r + k) % 3]);
        if middles.contains_key(&pair(a, b)) {
            let before = triangles.len();
            halve([a, b, c], &middles, &mut triangles);
            edges.extend(triangles[before..].iter().map(|corners| next_edge(&points, corners)));
            parent.resize(parent.len() + triangles.len() - before, t);
        } else {
            triangles.push(*corners);
            edges.push(r);
            parent.push(t);
        }
    }
    let body = parent.iter().map(|&t| mesh.body[t]).collect();
    // The new number of each triangle that is still whole.
    let mut number = vec![None; mesh.triangles.len()];
    for (new, &old) in parent.iter().enumerate() {
        number[old] = (triangles[new] == mesh.triangles[old]).then_some(new);
    }
    let cells = mesh.cells.kept(|t| number[t]);
    let mut mesh = Triangulation::connect(points, triangles, body, mesh.names.clone(), &label);
    mesh.cells = cells;
    Bisected { mesh, refinement: RefinementEdges(edges), parent }
}

/// The edges to cut: the refinement edges of marked triangles, and with any edge of a triangle its refinement edge, and
/// with an edge of a contact the one opposite.
fn close(mesh: &Triangulation, refinement: &RefinementEdges, marked: &[usize], facing: &[[usize; 2]]) -> Vec<bool> {
    let mut opposite: Map<usize, usize> = Map::default();
    for &[e, f] in facing {
        opposite.extend([(e, f), (f, e)]);
    }
    let refinement_edge = |t: usize| mesh.triangle_edges[t][refinement.0[t]];
    let mut cut = vec![false; mesh.edges.len()];
    let mut open: Vec<usize> = marked.iter().map(|&t| refinement_edge(t)).collect();
    while let Some(e) = open.pop() {
        if !std::mem::replace(&mut cut[e], true) {
            open.extend(opposite.get(&e));
            open.extend(mesh.edges[e].triangles.iter().flatten().map(|&t| refinement_edge(t)));
        }
    }
    cut
}

/// Cuts a triangle, given with its refinement edge first, and its halves where their refinement edges are cut too.
fn halve([a, b, c]: [usize; 3], middles: &Map<Pair, usize>, into: &mut Vec<[usize; 3]>) {
    match middles.get(&pair(a, b)) {
        None => into.push([a, b, c]),
        Some(&m) => {
            halve([c, a, m], middles, into);
            halve([b, c, m], middles, into);
        }
    }
}

/// Edges whose squared lengths differ by less than this part are equally long.
const AS_LONG: f64 = 0.02;

/// Local index of the refinement edge of a triangle that a bisection made, whose newest vertex is its last corner.
fn next_edge(points: &[[f64; 2]], corners: &[usize; 3]) -> usize {
    const NEWEST: usize = 2;
    let longest = longest(points, corners);
    let [long, new] = [longest, NEWEST].map(|i| square(ends(points, corners, i)));
    if long > (1.0 + AS_LONG) * new { longest } else { NEWEST }
}

/// Local index of the longest edge; of equal ones that whose middle comes last in (x, y) order.
fn longest(points: &[[f64; 2]], corners: &[usize; 3]) -> usize {
    let rank = |i: usize| {
        let [a, b] = ends(points, corners, i);
        let [x, y] = middle(a, b);
        [square([a, b]), x, y]
    };
    let after = |i: usize, j: usize| rank(i).partial_cmp(&rank(j)) == Some(std::cmp::Ordering::Greater);
    (1..3).fold(0, |best, i| if after(i, best) { i } else { best })
}

/// The ends of the edge opposite corner `i`.
fn ends(points: &[[f64; 2]], corners: &[usize; 3], i: usize) -> [[f64; 2]; 2] {
    [1, 2].map(|k| points[corners[(i + k) % 3]])
}

/// The square of the distance between two points.
fn square([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).powi(2) + (b[1] - a[1]).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::RawMesh;
    use crate::mesh::testing::*;
    use proptest::prelude::*;

    /// Two bodies that face each other at x = 1, with the facing edges.
    fn blocks(jitter: f64) -> (Triangulation, crate::scene::Scene) {
        let scene = contact(scene(&["a", "b"]), "a_right", "b_left", crate::scene::Gap::Constant(0.0));
        let mut raw = both(grid("a", [0.0; 2], [1.0; 2], [3, 3]), grid("b", [1.0, 0.0], [2.0, 1.0], [2, 3]));
        // Inner vertices are moved so that no two triangles are alike.
        for (i, p) in raw.points.iter_mut().enumerate() {
            if p[0] != 1.0 && p[0] % 2.0 != 0.0 && p[1] % 1.0 != 0.0 {
                p[0] += jitter * (0.1 * i as f64).sin();
            }
        }
        (Triangulation::new(raw, &scene).expect("a good mesh").0, scene)
    }

    fn facing(mesh: &Triangulation) -> Vec<[usize; 2]> {
        let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
        let turned = |[a, b]: [[f64; 2]; 2]| [b, a];
        let seconds = mesh.boundary("b_left");
        let partner = |e: usize| seconds.iter().copied().find(|&f| ends(f) == turned(ends(e)));
        mesh.boundary("a_right").into_iter().map(|e| [e, partner(e).expect("an edge opposite")]).collect()
    }

    #[test]
    fn the_longest_edge_does_not_depend_on_the_numbering() {
        let (mesh, scene) = blocks(0.0);
        let mut raw = both(grid("b", [1.0, 0.0], [2.0, 1.0], [2, 3]), grid("a", [0.0; 2], [1.0; 2], [3, 3]));
        raw.triangles.iter_mut().for_each(|(t, _)| t.rotate_left(1));
        raw.triangles.reverse();
        let (other, _) = Triangulation::new(raw, &scene).expect("a good mesh");
        let chosen = |mesh: &Triangulation| {
            let edges = RefinementEdges::longest(mesh);
            let ends = |t: usize| mesh.edges[mesh.triangle_edges[t][edges.of(t)]].vertices.map(|v| mesh.points[v]);
            let mut all: Vec<String> = (0..mesh.triangles.len())
                .map(|t| {
                    let [p, q] = ends(t);
                    format!("{:?}", if p < q { [p, q] } else { [q, p] })
                })
                .collect();
            all.sort();
            all
        };
        assert_eq!(chosen(&mesh), chosen(&other));
    }

    #[test]
    fn one_marked_triangle_is_cut_once() {
        let (mesh, _) = blocks(0.0);
        let finer = bisect(&mesh, &RefinementEdges::longest(&mesh), &[0], &facing(&mesh), &Curved::default());
        assert_eq!(finer.mesh.triangles.len(), mesh.triangles.len() + 2, "the pair along the diagonal");
        assert_consistent(&finer.mesh);
    }

    #[test]
    fn stretched_triangles_fall_into_better_ones() {
        let scene = scene(&["a"]);
        let raw = RawMesh {
            points: vec![[0.0, 0.0], [1.0, -0.02], [1.03, 0.02]],
            triangles: vec![([0, 1, 2], "a".to_string())],
            ..RawMesh::default()
        };
        let mut mesh = Triangulation::new(raw, &scene).expect("a good mesh").0;
        let whole = mesh.area(0);
        let sharpest = smallest_angle(&mesh);
        let mut refinement = RefinementEdges::longest(&mesh);
        for _ in 0..12 {
            let all: Vec<usize> = (0..mesh.triangles.len()).collect();
            let finer = bisect(&mesh, &refinement, &all, &[], &Curved::default());
            (mesh, refinement) = (finer.mesh, finer.refinement);
        }
        assert!(smallest_angle(&mesh) >= 0.5 * sharpest - 1e-9);
        // Height over longest side: 0.04 for the whole, 0.5 for right isosceles triangles.
        let good = |t: usize| {
            let longest = mesh.triangle_edges[t].map(|e| mesh.edge_frame(e).0).into_iter().fold(0.0, f64::max);
            2.0 * mesh.area(t) > 0.25 * longest * longest
        };
        let part = (0..mesh.triangles.len()).filter(|t| good(*t)).map(|t| mesh.area(t)).sum::<f64>() / whole;
        assert!(part > 0.8, "{part}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn random_marking_keeps_angles_names_and_matching_sides(
            jitter in 0.0..0.15f64,
            rounds in prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 1..12), 12),
        ) {
            let (coarse, _) = blocks(jitter);
            let sharpest = smallest_angle(&coarse);
            let names = lengths(&coarse);
            let (mut mesh, mut refinement) = (coarse.clone(), RefinementEdges::longest(&coarse));
            for round in rounds {
                let marked: Vec<usize> = round.iter().map(|i| i.index(mesh.triangles.len())).collect();
                let finer = bisect(&mesh, &refinement, &marked, &facing(&mesh), &Curved::default());
                assert_consistent(&finer.mesh);
                let mut areas = vec![0.0; mesh.triangles.len()];
                for (t, &p) in finer.parent.iter().enumerate() {
                    areas[p] += finer.mesh.area(t);
                    prop_assert_eq!(finer.mesh.body[t], mesh.body[p]);
                }
                for (t, area) in areas.iter().enumerate() {
                    prop_assert!((area / mesh.area(t) - 1.0).abs() < 1e-12);
                }
                for t in marked {
                    prop_assert!(finer.parent.iter().filter(|p| **p == t).count() >= 2);
                }
                prop_assert_eq!(side(&finer.mesh, "a_right", false), side(&finer.mesh, "b_left", true));
                (mesh, refinement) = (finer.mesh, finer.refinement);
            }
            prop_assert!(smallest_angle(&mesh) >= 0.5 * sharpest - 1e-9);
            prop_assert_eq!(euler(&mesh), euler(&coarse));
            for (name, length) in lengths(&mesh) {
                prop_assert!((length - names[&name]).abs() < 1e-12);
            }
        }
    }
}
