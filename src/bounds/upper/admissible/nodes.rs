//! The nodes that make a continuous displacement: one at each vertex, and k − 1 inside each edge of degree k.
//!
//! The value of a node at a vertex is that of the displacement; the values inside an edge are its Bernstein coefficients
//! from the first vertex to the second ([`crate::element::polynomial::side`]). Each edge has a degree of its own, and a triangle the
//! largest of its three: the coefficients of the others are elevated, so that different degrees meet without a gap.

use crate::element::displacement;
use crate::element::polynomial::side;
use crate::mesh::Triangulation;

/// The numbers of the nodes: vertices, then edge by edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Nodes {
    vertices: usize,
    /// The first node of each edge, and one past the last.
    start: Vec<usize>,
}

impl Nodes {
    /// Of one degree on all edges of a mesh.
    pub fn of_degree(mesh: &Triangulation, degree: usize) -> Self {
        Nodes::new(mesh.points.len(), std::iter::repeat_n(degree, mesh.edges.len()))
    }

    /// For edges of the given degrees, at least one.
    pub fn new(vertices: usize, degrees: impl IntoIterator<Item = usize>) -> Self {
        let mut start = vec![vertices];
        let mut next = vertices;
        start.extend(degrees.into_iter().map(|k| {
            next += k - 1;
            next
        }));
        Nodes { vertices, start }
    }

    /// Number of nodes.
    pub fn count(&self) -> usize {
        self.start[self.start.len() - 1]
    }

    /// Number of vertices, whose nodes come first.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Number of edges.
    pub fn edges(&self) -> usize {
        self.start.len() - 1
    }

    /// The nodes inside edge `e`, from its first vertex to its second.
    pub fn inside(&self, e: usize) -> std::ops::Range<usize> {
        self.start[e]..self.start[e + 1]
    }

    /// The degree of edge `e`.
    pub fn degree(&self, e: usize) -> usize {
        self.start[e + 1] - self.start[e] + 1
    }

    /// The highest degree of an edge, one where there is none.
    pub fn highest(&self) -> usize {
        (0..self.edges()).map(|e| self.degree(e)).max().unwrap_or(1)
    }

    /// The degree of triangle `t`: the largest of its edges.
    pub fn triangle_degree(&self, mesh: &Triangulation, t: usize) -> usize {
        mesh.triangle_edges[t].iter().map(|&e| self.degree(e)).max().unwrap_or(1)
    }

    /// All k + 1 nodes of edge `e`, beginning with the vertex `from`.
    pub fn along(&self, mesh: &Triangulation, e: usize, from: usize) -> impl ExactSizeIterator<Item = usize> + use<> {
        let ([a, b], inside) = (mesh.edges[e].vertices, self.inside(e));
        let last = inside.len() + 1;
        (0..last + 1).map(move |i| match if a == from { i } else { last - i } {
            0 => a,
            i if i == last => b,
            i => inside.start + i - 1,
        })
    }

    /// The nodes on the boundary of triangle `t`: its corners, then those inside the sides opposite them,
    /// counter-clockwise.
    pub fn of_triangle(&self, mesh: &Triangulation, t: usize) -> impl Iterator<Item = usize> {
        let corners = mesh.triangles[t];
        let inside = (0..3).flat_map(move |i| {
            let e = mesh.triangle_edges[t][i];
            let (range, turned) = (self.inside(e), mesh.edges[e].vertices[0] != corners[(i + 1) % 3]);
            let (first, count) = (range.start, range.len());
            (0..count).map(move |n| if turned { first + count - 1 - n } else { first + n })
        });
        corners.into_iter().chain(inside)
    }
}

/// Values at the nodes of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalValues {
    /// The numbers of the nodes.
    pub nodes: Nodes,
    /// The value of each.
    pub values: Vec<[f64; 2]>,
}

impl NodalValues {
    /// On no nodes.
    pub fn none() -> Self {
        Self::zeros(Nodes::new(0, []))
    }

    /// All zero.
    pub fn zeros(nodes: Nodes) -> Self {
        NodalValues { values: vec![[0.0; 2]; nodes.count()], nodes }
    }

    /// All times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        NodalValues { nodes: self.nodes.clone(), values: self.values.iter().map(|v| v.map(|v| factor * v)).collect() }
    }

    /// The quadratic displacement with these values at vertices and edge midpoints.
    pub fn quadratic(mesh: &Triangulation, vertex: &[[f64; 2]], middle: &[[f64; 2]]) -> Self {
        let nodes = Nodes::new(vertex.len(), std::iter::repeat_n(2, middle.len()));
        let coefficient = |(edge, middle): (&crate::mesh::Edge, &[f64; 2])| {
            let [a, b] = edge.vertices.map(|v| vertex[v]);
            displacement::inner_coefficient(a, *middle, b)
        };
        let values = vertex.iter().copied().chain(mesh.edges.iter().zip(middle).map(coefficient)).collect();
        NodalValues { nodes, values }
    }

    /// The values at the vertices.
    pub fn vertices(&self) -> &[[f64; 2]] {
        &self.values[..self.nodes.vertices]
    }

    /// Mutable access to [`Self::vertices`].
    pub fn vertices_mut(&mut self) -> &mut [[f64; 2]] {
        &mut self.values[..self.nodes.vertices]
    }

    /// The coefficients of edge `e` from its first vertex to its second.
    pub fn edge(&self, mesh: &Triangulation, e: usize) -> Vec<[f64; 2]> {
        self.nodes.along(mesh, e, mesh.edges[e].vertices[0]).map(|n| self.values[n]).collect()
    }

    /// This displacement on the nodes `other`: elevated where an edge has a higher degree there, and interpolated at equal steps where it
    /// has a lower one.
    pub fn on(self, mesh: &Triangulation, other: &Nodes) -> Self {
        if self.nodes == *other {
            return self;
        }
        let mut out = NodalValues::zeros(other.clone());
        out.values[..self.nodes.vertices].copy_from_slice(self.vertices());
        for e in 0..other.edges() {
            let own = self.edge(mesh, e);
            let (from, to) = (own.len() - 1, other.degree(e));
            let raised = if to >= from {
                elevated(&own, to)
            } else {
                let at = |i: usize| {
                    let s = i as f64 / to as f64;
                    let weights = (0..=from).map(|k| side::bernstein(from, k, s));
                    weights.zip(&own).fold([0.0; 2], |sum, (w, u)| [sum[0] + w * u[0], sum[1] + w * u[1]])
                };
                displacement::through(&(0..=to).map(at).collect::<Vec<_>>())
            };
            out.values[other.inside(e)].copy_from_slice(&raised[1..to]);
        }
        out
    }
}

/// Coefficients of degree `k` of the polynomial with the given ones.
pub fn elevated(coefficients: &[[f64; 2]], k: usize) -> Vec<[f64; 2]> {
    let p = coefficients.len() - 1;
    if k == p {
        return coefficients.to_vec();
    }
    let row = |j: usize| {
        let weights = (0..=p).map(|i| side::elevation(p, k, j, i));
        weights.zip(coefficients).fold([0.0; 2], |sum, (w, u)| [sum[0] + w * u[0], sum[1] + w * u[1]])
    };
    (0..=k).map(row).collect()
}
