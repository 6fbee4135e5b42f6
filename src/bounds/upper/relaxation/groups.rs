//! Which vertices move together in a step of the relaxation, and the triangles around them.
//!
//! A vertex and the ones it faces across Γ_K or an elastic layer share a traction and belong together. So do the vertices that a flat
//! triangle ties to each other: moved alone, each would strain it by its whole displacement over its small height.

use crate::problem::{Problem, facing_vertices};
use crate::sets::DisjointSets;

/// Triangles whose height is below this part of their longest side are flat.
const FLAT: f64 = 0.15;
/// Below this part they are slivers: moved in two patches, what they tie is strained by its whole displacement over so small a height, and
/// sweeps hardly move it.
const SLIVER: f64 = 5e-3;

/// Slivers tie together no more vertices than this …
const MOST_VERTICES: usize = 12;
/// … and other flat triangles no more than this over the degree: patches grow with the square of both.
const MOST_VERTICES_BY_DEGREE: usize = 24;

/// One patch: the vertices that move, and every triangle at one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Vertices.
    pub vertices: Vec<usize>,
    /// Triangles, each once.
    pub triangles: Vec<usize>,
}

/// Divides the vertices into groups, ordered by place so that the numbering of the mesh has no part in what follows; `degree` is the
/// highest of the displacement.
pub fn groups(problem: &Problem, degree: usize) -> Vec<Group> {
    let mesh = &problem.mesh;
    let mut sets = DisjointSets::new(mesh.points.len());
    for pair in problem.pairs() {
        for (v, w) in pair.second.iter().flat_map(|second| pair.first.iter().zip(second)) {
            sets.join(*v, *w);
        }
    }
    for [v, w] in facing_vertices(mesh, &problem.beds) {
        sets.join(v, w);
    }
    let most = (MOST_VERTICES_BY_DEGREE / degree).min(MOST_VERTICES);
    for Tie { ends: [v, w], by_sliver, .. } in tied(problem) {
        sets.join_up_to(v, w, if by_sliver { MOST_VERTICES } else { most });
    }
    let mut number = vec![usize::MAX; mesh.points.len()];
    let mut groups: Vec<Group> = Vec::new();
    for v in by_place(problem) {
        let root = sets.root(v);
        if number[root] == usize::MAX {
            number[root] = groups.len();
            groups.push(Group { vertices: Vec::new(), triangles: Vec::new() });
        }
        groups[number[root]].vertices.push(v);
    }
    for (t, corners) in mesh.triangles.iter().enumerate() {
        for &v in corners {
            let triangles = &mut groups[number[sets.root(v)]].triangles;
            if triangles.last() != Some(&t) {
                triangles.push(t);
            }
        }
    }
    groups
}

/// Two vertices that a flat triangle ties together.
struct Tie {
    ends: [usize; 2],
    length: f64,
    /// Twice the point half way.
    place: [f64; 2],
    by_sliver: bool,
}

/// The ties of all flat triangles, the shortest first.
fn tied(problem: &Problem) -> Vec<Tie> {
    let mesh = &problem.mesh;
    let mut found = Vec::new();
    for (t, corners) in mesh.triangles.iter().enumerate() {
        let sides = mesh.triangle_edges[t].map(|e| mesh.edge_frame(e).0);
        let longest = sides.iter().copied().fold(0.0, f64::max);
        let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
        let height = 2.0 * mesh.area(t) / longest;
        if height > FLAT * longest {
            continue;
        }
        // A needle ties the ends of its short side; a cap, whose angles are all near 0° or 180°, ties all three.
        let cap = height < FLAT * shortest;
        for (side, length) in sides.into_iter().enumerate() {
            if cap || length == shortest {
                let ends = [corners[(side + 1) % 3], corners[(side + 2) % 3]];
                let [a, b] = ends.map(|v| mesh.points[v]);
                let place = [a[0] + b[0], a[1] + b[1]];
                found.push(Tie { ends, length, place, by_sliver: height < SLIVER * longest });
            }
        }
    }
    found.sort_by(|one: &Tie, other: &Tie| {
        let by_place = |c: usize| one.place[c].total_cmp(&other.place[c]);
        one.length.total_cmp(&other.length).then(by_place(0)).then(by_place(1))
    });
    found
}

/// All vertices by their place; where several share a place, by their body.
fn by_place(problem: &Problem) -> Vec<usize> {
    let mesh = &problem.mesh;
    let mut body = vec![0; mesh.points.len()];
    for (corners, b) in mesh.triangles.iter().zip(&mesh.body) {
        corners.iter().for_each(|&v| body[v] = *b);
    }
    let mut order: Vec<usize> = (0..mesh.points.len()).collect();
    order.sort_by(|&v, &w| {
        let ([a, b], [c, d]) = (mesh.points[v], mesh.points[w]);
        a.total_cmp(&c).then(b.total_cmp(&d)).then(body[v].cmp(&body[w]))
    });
    order
}
