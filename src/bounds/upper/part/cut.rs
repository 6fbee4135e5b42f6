//! A problem on some of its triangles.

use crate::bounds::upper::admissible::holds::Holds;
use crate::bounds::upper::admissible::nodes::Nodes;
use crate::bounds::upper::relaxation::groups::Group;
use crate::element::{SideValues, StressField};
use crate::mesh::{Edge, FileCells, Triangulation};
use crate::problem::{ContactPair, Interface, Problem};

/// Which triangles, edges, vertices and nodes of a problem there are, each kind in the order that it has there.
pub struct Cut {
    pub triangles: Vec<usize>,
    pub edges: Vec<usize>,
    pub vertices: Vec<usize>,
    pub nodes: Vec<usize>,
}

/// The place of `number` among numbers in order that have it.
pub fn place(numbers: &[usize], number: usize) -> usize {
    numbers.partition_point(|n| *n < number)
}

fn in_order(mut numbers: Vec<usize>) -> Vec<usize> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

impl Cut {
    /// With the given triangles, in order.
    pub fn new(problem: &Problem, nodes: &Nodes, triangles: Vec<usize>) -> Self {
        let mesh = &problem.mesh;
        let edges = in_order(triangles.iter().flat_map(|t| mesh.triangle_edges[*t]).collect());
        let vertices = in_order(triangles.iter().flat_map(|t| mesh.triangles[*t]).collect());
        let nodes = vertices.iter().copied().chain(edges.iter().flat_map(|e| nodes.inside(*e))).collect();
        Cut { triangles, edges, vertices, nodes }
    }

    /// The problem. All contact pairs have to be there. An edge on the border keeps its condition, its direction, and the side
    /// that its one triangle is on.
    pub fn problem(&self, problem: &Problem) -> Problem {
        let mesh = &problem.mesh;
        let vertex = |v| place(&self.vertices, v);
        let edge = |e: &usize| {
            let Edge { vertices, triangles, name } = mesh.edges[*e];
            let triangle = |t: Option<usize>| t.and_then(|t| self.triangles.binary_search(&t).ok());
            Edge { vertices: vertices.map(vertex), triangles: triangles.map(triangle), name }
        };
        let pair = |pair: &ContactPair| ContactPair {
            edges: pair.edges.map(|e| e.map(|e| place(&self.edges, e))),
            first: pair.first.map(vertex),
            second: pair.second.map(|second| second.map(vertex)),
            ..*pair
        };
        let of = |interface: &Interface| Interface {
            name: interface.name.clone(),
            pairs: interface.pairs.iter().map(pair).collect(),
            centre: interface.centre,
        };
        Problem {
            scene: problem.scene.clone(),
            mesh: Triangulation {
                points: self.vertices.iter().map(|v| mesh.points[*v]).collect(),
                triangles: self.triangles.iter().map(|t| mesh.triangles[*t].map(vertex)).collect(),
                body: self.triangles.iter().map(|t| mesh.body[*t]).collect(),
                edges: self.edges.iter().map(edge).collect(),
                triangle_edges: (self.triangles.iter())
                    .map(|t| mesh.triangle_edges[*t].map(|e| place(&self.edges, e)))
                    .collect(),
                names: mesh.names.clone(),
                cells: FileCells::default(),
            },
            conditions: self.edges.iter().map(|e| problem.conditions[*e]).collect(),
            interfaces: problem.interfaces.iter().map(of).collect(),
            beds: Vec::new(),
            notes: Vec::new(),
            refinement: problem.refinement,
            counted: problem.counted,
            uncut: None,
        }
    }

    /// The nodal supports there.
    pub fn holds(&self, holds: &Holds) -> Holds {
        Holds {
            vertices: self.vertices.iter().map(|v| holds.vertices[*v]).collect(),
            edges: self.edges.iter().map(|e| holds.edges[*e]).collect(),
        }
    }

    /// A group all of whose triangles are there.
    pub fn group(&self, group: &Group) -> Group {
        Group {
            vertices: group.vertices.iter().map(|v| place(&self.vertices, *v)).collect(),
            triangles: group.triangles.iter().map(|t| place(&self.triangles, *t)).collect(),
        }
    }

    /// The stresses.
    pub fn stress(&self, stress: &StressField) -> StressField {
        let mut own = StressField::of_degrees(self.triangles.iter().map(|t| stress.degree(*t)));
        for (own, t) in own.blocks_mut().into_iter().zip(&self.triangles) {
            own.copy_from_slice(stress.block(*t));
        }
        own
    }

    /// The moments on the edges.
    pub fn moments(&self, moments: &SideValues<[f64; 2]>) -> SideValues<[f64; 2]> {
        self.edges.iter().map(|e| moments.of(*e)).collect()
    }
}
