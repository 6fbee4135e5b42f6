//! Connected pieces of the mesh and their rigid motions.

use crate::problem::Problem;
use crate::sets::DisjointSets;

/// One rigid motion of every piece of the mesh.
///
/// Piece c with centroid (x_c, y_c) moves by u(x, y) = (a − ω (y − y_c), b + ω (x − x_c)).
#[derive(Debug, Clone, PartialEq)]
pub struct RigidMotion {
    /// (a, b, ω) of each piece: displacement of its centroid (length) and rotation (1).
    pub component: Vec<[f64; 3]>,
}

impl RigidMotion {
    /// Displacement of `point`, taken as a point of piece `component`.
    pub fn at(&self, components: &Components, component: usize, point: [f64; 2]) -> [f64; 2] {
        let [a, b, omega] = self.component[component];
        let centre = components.centre[component];
        [a - omega * (point[1] - centre[1]), b + omega * (point[0] - centre[0])]
    }

    /// Displacement of every vertex of the mesh, for pictures.
    pub fn at_vertices(&self, problem: &Problem, components: &Components) -> Vec<[f64; 2]> {
        let points = problem.mesh.points.iter().zip(&components.of_vertex);
        points.map(|(point, c)| if *c == usize::MAX { [0.0; 2] } else { self.at(components, *c, *point) }).collect()
    }
}

/// The connected pieces of the mesh. Triangles that share an edge belong together, and those on both sides of an elastic layer,
/// which resists every motion of one against the other: bonded bodies are one piece, and a
/// body may have several. Triangles that share nothing but a vertex are hinged at a point, which holds no stress, and
/// count as separate.
#[derive(Debug, Clone, PartialEq)]
pub struct Components {
    /// Piece of each triangle.
    pub of_triangle: Vec<usize>,
    /// Piece of each vertex (`usize::MAX` for a vertex no triangle uses; where two pieces touch in a point, one of them).
    pub of_vertex: Vec<usize>,
    /// Centroid of each piece.
    pub centre: Vec<[f64; 2]>,
    /// Largest distance of a vertex of the piece from its centroid.
    pub size: Vec<f64>,
    /// The point from which the coordinates count, in those of the scene as it was written.
    pub origin: [f64; 2],
    /// Names of the bodies of each piece, in scene order.
    pub bodies: Vec<Vec<String>>,
    /// True if the bodies of the piece have further pieces, so that their names alone do not identify it.
    pub one_of_several: Vec<bool>,
}

/// The piece of every triangle, and how many there are.
fn joined(problem: &Problem) -> (Vec<usize>, usize) {
    let mesh = &problem.mesh;
    let (of_triangle, count) = mesh.pieces();
    let mut sets = DisjointSets::new(count);
    for (pair, _) in problem.bed_pairs() {
        let mut sides = pair.sides().filter_map(|(_, e)| mesh.edges[e].triangles[0]).map(|t| of_triangle[t]);
        if let (Some(first), Some(second)) = (sides.next(), sides.next()) {
            sets.join(first, second);
        }
    }
    let (label, count) = sets.labels();
    (of_triangle.into_iter().map(|piece| label[piece]).collect(), count)
}

impl Components {
    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.centre.len()
    }

    /// Finds the pieces of the mesh of `problem`.
    pub fn new(problem: &Problem) -> Self {
        let mesh = &problem.mesh;
        let (of_triangle, count) = joined(problem);

        let mut of_vertex = vec![usize::MAX; mesh.points.len()];
        let mut in_piece: Vec<Vec<usize>> = vec![Vec::new(); count];
        // First moments about one vertex of the piece: coordinates far from the origin cost no digits.
        let mut origin = vec![None; count];
        let mut moment = vec![[0.0; 2]; count];
        let mut area = vec![0.0; count];
        for (t, &c) in of_triangle.iter().enumerate() {
            let corners = mesh.corners(t);
            let o = *origin[c].get_or_insert(corners[0]);
            let [p, q, r] = corners.map(|x| [x[0] - o[0], x[1] - o[1]]);
            let twice = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            area[c] += twice;
            for i in 0..2 {
                moment[c][i] += twice * ((p[i] + q[i] + r[i]) / 3.0);
            }
            for v in mesh.triangles[t] {
                of_vertex[v] = c;
            }
            if in_piece[c].last() != Some(&mesh.body[t]) {
                in_piece[c].push(mesh.body[t]);
            }
        }
        let mut pieces_of = vec![0; problem.scene.bodies.len()];
        for bodies in &mut in_piece {
            bodies.sort_unstable();
            bodies.dedup();
            bodies.iter().for_each(|b| pieces_of[*b] += 1);
        }
        let centre: Vec<[f64; 2]> = (0..count)
            .map(|c| {
                let o = origin[c].unwrap_or_default();
                [o[0] + moment[c][0] / area[c], o[1] + moment[c][1] / area[c]]
            })
            .collect();
        let mut size = vec![0.0f64; count];
        for (t, &c) in of_triangle.iter().enumerate() {
            for x in mesh.corners(t) {
                size[c] = size[c].max((x[0] - centre[c][0]).hypot(x[1] - centre[c][1]));
            }
        }
        let one_of_several = in_piece.iter().map(|bodies| bodies.iter().all(|b| pieces_of[*b] > 1)).collect();
        let name = |b: &usize| problem.scene.bodies[*b].name.clone();
        let bodies = in_piece.iter().map(|bodies| bodies.iter().map(name).collect());
        let origin = problem.scene.origin;
        Components { bodies: bodies.collect(), origin, of_triangle, of_vertex, centre, size, one_of_several }
    }
}
