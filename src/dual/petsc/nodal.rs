//! Displacements that are linear on triangles, in terms of the unknowns.
//!
//! On such a displacement K is the stiffness matrix of linear finite elements, for which multigrid is made.

use crate::dual::hybrid::moments_of_ends;
use crate::dual::system::unknowns::{EdgeMoments, Unknowns};
use crate::problem::Problem;

/// The map from the displacements of the vertices, x and y of one after the other, to the unknowns, unknown by unknown.
#[derive(Debug, Default)]
pub struct Nodal {
    /// Where the entries of each unknown begin, and the end.
    pub start: Vec<i64>,
    /// Components of the displacement.
    pub component: Vec<i64>,
    /// Their factors.
    pub weight: Vec<f64>,
}

impl Nodal {
    /// Computes the map; an entry may come in several parts.
    pub fn new(problem: &Problem, unknowns: &Unknowns) -> Self {
        let mesh = &problem.mesh;
        let block_of = unknowns.block_of();
        let mut x = vec![0.0; unknowns.count];
        let mut entries: Vec<(usize, usize, f64)> = Vec::new();
        for (e, edge) in mesh.edges.iter().enumerate() {
            let (blocks, len) = unknowns.blocks_of_edge(e, &block_of);
            let jump = match &unknowns.edges[e] {
                EdgeMoments::Contact(contact) => Some(block_of[contact.jump] as usize),
                _ => None,
            };
            let mut own = blocks[..len].to_vec();
            own.extend(jump.filter(|jump| !blocks[..len].contains(jump)));
            for (end, c) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for k in 0..=unknowns.degree(e) {
                    let mut m = [0.0; 2];
                    m[c] = moments_of_ends(problem, unknowns, e, k)[end];
                    unknowns.project_moment(e, k, m, &mut x);
                }
                for i in own.iter().map(|&b| unknowns.blocks[b]).flat_map(|b| b.start..b.start + b.len) {
                    let weight = std::mem::take(&mut x[i]);
                    if weight != 0.0 {
                        entries.push((i, 2 * edge.vertices[end] + c, weight));
                    }
                }
            }
        }
        entries.sort_by_key(|&(unknown, component, _)| (unknown, component));
        let mut start = vec![0_i64; unknowns.count + 1];
        entries.iter().for_each(|(unknown, ..)| start[unknown + 1] += 1);
        (0..unknowns.count).for_each(|i| start[i + 1] += start[i]);
        Nodal {
            start,
            component: entries.iter().map(|entry| entry.1 as i64).collect(),
            weight: entries.iter().map(|entry| entry.2).collect(),
        }
    }
}
