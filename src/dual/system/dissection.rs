//! Nested dissection: a fill-reducing ordering from the geometry of the mesh.
//!
//! Two halves of a set of triangles are coupled only through the edges between them. Eliminating those edges last keeps
//! the halves apart in the factor (George 1973), and so on inside each half, down to single triangles. A line cuts each
//! set at its median, in the direction in which it crosses the fewest edges.

use super::unknowns::Unknowns;
use crate::problem::Problem;

/// Normals of the lines tried, the coarser the set the more of them.
const NORMALS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.7, 0.7], [0.7, -0.7]];

/// Orders the blocks of unknowns before the jumps; the result lists block numbers.
pub fn nested_dissection(problem: &Problem, unknowns: &Unknowns) -> Vec<usize> {
    let mut dissection = Dissection::new(problem, unknowns);
    let mut triangles: Vec<u32> = (0..problem.mesh.triangles.len() as u32).collect();
    dissection.split(&mut triangles, 0);
    // Separators were listed before the halves they separate.
    dissection.order.reverse();
    dissection.order
}

/// No triangle.
const NONE: u32 = u32::MAX;

/// A block of unknowns at a triangle, and the triangle on its other side.
#[derive(Debug, Clone, Copy)]
struct Link {
    block: u32,
    other: u32,
}

struct Dissection {
    /// Centroids.
    centre: Vec<[f64; 2]>,
    /// Links of triangle t: `links[start[t]..start[t + 1]]`.
    links: Vec<Link>,
    start: Vec<u32>,
    /// The set each triangle belongs to at present, and the number of sets.
    part: Vec<u32>,
    parts: u32,
    /// Blocks, the last to be eliminated first.
    order: Vec<usize>,
}

impl Dissection {
    fn new(problem: &Problem, unknowns: &Unknowns) -> Self {
        let mesh = &problem.mesh;
        let count = unknowns.blocks.partition_point(|b| b.start < unknowns.first_jump);
        let block_of = unknowns.block_of();
        // A block touches one triangle or two: those on both sides of its edge, or of its contact pair.
        let mut sides = vec![[NONE; 2]; count];
        for (e, edge) in mesh.edges.iter().enumerate() {
            let (blocks, len) = unknowns.blocks_of_edge(e, &block_of);
            for &b in blocks[..len].iter().filter(|&&b| b < count) {
                for t in edge.triangles.iter().flatten() {
                    let free = usize::from(sides[b][0] != NONE);
                    sides[b][free] = *t as u32;
                }
            }
        }
        let mut start = vec![0_u32; mesh.triangles.len() + 1];
        for t in sides.as_flattened().iter().filter(|&&t| t != NONE) {
            start[*t as usize + 1] += 1;
        }
        for t in 0..mesh.triangles.len() {
            start[t + 1] += start[t];
        }
        let mut next = start.clone();
        let mut links = vec![Link { block: 0, other: NONE }; start[mesh.triangles.len()] as usize];
        for (b, &[first, second]) in sides.iter().enumerate() {
            for (own, other) in [(first, second), (second, first)] {
                if own != NONE {
                    links[next[own as usize] as usize] = Link { block: b as u32, other };
                    next[own as usize] += 1;
                }
            }
        }
        let centre = (0..mesh.triangles.len())
            .map(|t| {
                let [a, b, c] = mesh.corners(t);
                [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0]
            })
            .collect();
        Dissection {
            centre,
            links,
            start,
            part: vec![0; mesh.triangles.len()],
            parts: 1,
            order: Vec::with_capacity(count),
        }
    }

    fn links(&self, t: u32) -> &[Link] {
        &self.links[self.start[t as usize] as usize..self.start[t as usize + 1] as usize]
    }

    /// Lists the blocks inside `set`, whose triangles make up part `own`.
    fn split(&mut self, set: &mut [u32], own: u32) {
        if let [t] = *set {
            let alone = self.links(t).iter().filter(|l| l.other == NONE).map(|l| l.block as usize);
            let alone: Vec<usize> = alone.collect();
            self.order.extend(alone);
            return;
        }
        if set.is_empty() {
            return;
        }
        let other = self.parts;
        self.parts += 1;
        let tries = match set.len() {
            0..=16 => 1,
            17..=2000 => 2,
            _ => 4,
        };
        let first = self.longer_axis(set);
        let normals = [NORMALS[first], NORMALS[1 - first], NORMALS[2], NORMALS[3]];
        let cuts = normals[..tries].iter().map(|&n| (self.cut(set, n, own, other), n));
        let cuts: Vec<_> = cuts.collect();
        let least = cuts.iter().map(|c| c.0).min();
        let normal = cuts.iter().find(|c| Some(c.0) == least).map_or(normals[0], |c| c.1);
        if tries > 1 && normal != normals[tries - 1] {
            self.cut(set, normal, own, other);
        }
        let (near, far) = set.split_at_mut(set.len() / 2);
        for &t in &*near {
            let across = self.start[t as usize] as usize..self.start[t as usize + 1] as usize;
            for link in &self.links[across] {
                if link.other != NONE && self.part[link.other as usize] == other {
                    self.order.push(link.block as usize);
                }
            }
        }
        self.split(far, other);
        self.split(near, own);
    }

    /// The axis along which the centroids of `set` spread more.
    fn longer_axis(&self, set: &[u32]) -> usize {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &t in set {
            let p = self.centre[t as usize];
            for c in 0..2 {
                low[c] = low[c].min(p[c]);
                high[c] = high[c].max(p[c]);
            }
        }
        usize::from(high[1] - low[1] > high[0] - low[0])
    }

    /// Cuts `set` in two across `normal`: the first half of it stays in part `own`, the rest becomes part `other`.
    /// Returns the number of blocks that the cut crosses.
    fn cut(&mut self, set: &mut [u32], normal: [f64; 2], own: u32, other: u32) -> usize {
        let height = |t: u32| {
            let p = self.centre[t as usize];
            normal[0] * p[0] + normal[1] * p[1]
        };
        let middle = set.len() / 2;
        set.select_nth_unstable_by(middle, |&a, &b| height(a).total_cmp(&height(b)).then(a.cmp(&b)));
        for (k, &t) in set.iter().enumerate() {
            self.part[t as usize] = if k < middle { own } else { other };
        }
        let crosses = |link: &&Link| link.other != NONE && self.part[link.other as usize] == other;
        set[..middle].iter().map(|&t| self.links(t).iter().filter(crosses).count()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Elements;
    use crate::mesh::{RawMesh, Triangulation};
    use crate::scene::{Body, Draft, Kinematics, MeshSource, Scene};

    #[test]
    fn every_block_is_ordered_once_and_a_strip_is_cut_across() {
        let n = 64;
        let mut raw = RawMesh::default();
        for i in 0..=n {
            raw.points.extend([[i as f64, 0.0], [i as f64, 1.0]]);
        }
        for i in 0..n {
            let (a, b, c, d) = (2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
            raw.triangles.extend([[a, b, c], [a, c, d]].map(|t| (t, "strip".to_string())));
        }
        let source = MeshSource::Geometry { size: None, polygons: Vec::new() };
        let bodies = vec![Body::isotropic("strip", 1.0, 0.3)];
        let scene = Scene::unchecked(Draft { bodies, ..Draft::new("strip", Kinematics::PlaneStrain, source) });
        let (mesh, notes) = Triangulation::new(raw, &scene).expect("a strip");
        let problem = Problem::new(scene, mesh, notes).expect("a problem");
        let unknowns = Unknowns::new(&problem, &Elements::Uniform(&crate::element::Block));
        let order = nested_dissection(&problem, &unknowns);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..unknowns.blocks.len()).collect::<Vec<_>>());
        // A strip falls apart when one edge is taken out: that in its middle comes last.
        let last = order[order.len() - 1];
        let middle = problem.mesh.edges.iter().position(|e| {
            let [a, b] = e.vertices.map(|v| problem.mesh.points[v]);
            0.5 * (a[0] + b[0]) == 0.5 * n as f64 && a[1] != b[1]
        });
        assert_eq!(Some(last), middle);
    }
}
