//! Where fields are sampled for `fields.vtu`: on each subtriangle the nodes of the lattice of its degree, and the triangles
//! between them.

use super::Dossier;
use crate::element::lattice;

/// The nodes of all subtriangles: triangle by triangle, subtriangle by subtriangle, from the first corner to the side opposite.
#[derive(Debug)]
pub(super) struct Lattice {
    /// p of each triangle: its subtriangles have (p + 1)(p + 2)/2 nodes and p² cells.
    pub degrees: Vec<usize>,
}

impl Lattice {
    /// As fine as the stresses are.
    pub fn new(dossier: &Dossier<'_>) -> Self {
        let triangles = dossier.problem.mesh.triangles.len();
        let stresses = [dossier.dual.map(|dual| &dual.stress), dossier.mid];
        let fitting = || stresses.iter().flatten().filter(|stress| stress.len() == triangles);
        let degree = |t: usize| fitting().map(|stress| stress.degree(t)).fold(1, usize::max);
        Lattice { degrees: (0..triangles).map(degree).collect() }
    }

    /// Number of cells of triangle `t`.
    pub fn cells(&self, t: usize) -> usize {
        3 * self.degrees[t] * self.degrees[t]
    }

    /// Number of nodes of triangle `t`.
    pub fn nodes(&self, t: usize) -> usize {
        let p = self.degrees[t];
        3 * (p + 1) * (p + 2) / 2
    }

    /// The value of a field at every node, from triangle, subtriangle and barycentric coordinates there.
    pub fn values<const N: usize>(&self, value: impl Fn(usize, usize, [f64; 3]) -> [f64; N]) -> Vec<f64> {
        let mut values = Vec::new();
        for (t, &p) in self.degrees.iter().enumerate() {
            for sub in 0..3 {
                for node in lattice(p) {
                    values.extend(value(t, sub, node));
                }
            }
        }
        values
    }

    /// Three nodes for every cell, counter-clockwise.
    pub fn connectivity(&self) -> impl Iterator<Item = i64> {
        let mut first = 0;
        self.degrees.iter().flat_map(|p| [*p; 3]).flat_map(move |p| {
            let before = first;
            first += ((p + 1) * (p + 2) / 2) as i64;
            cells(p).into_iter().flatten().map(move |node| before + node as i64)
        })
    }
}

/// The p² cells of a subtriangle: p(p + 1)/2 as it stands, the others between them turned by half a turn.
fn cells(p: usize) -> Vec<[usize; 3]> {
    // Node with the second and third of the barycentric coordinates times p.
    let node = |j: usize, k: usize| (j + k) * (j + k + 1) / 2 + k;
    let rows = |n: usize| (0..n).flat_map(|row| (0..=row).map(move |k| (row - k, k)));
    let upright = rows(p).map(|(j, k)| [node(j, k), node(j + 1, k), node(j, k + 1)]);
    let turned = rows(p - 1).map(|(j, k)| [node(j + 1, k + 1), node(j, k + 1), node(j + 1, k)]);
    upright.chain(turned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_the_triangle_each_the_same_way_round() {
        for p in 1..=8 {
            let all: Vec<[f64; 3]> = lattice(p).collect();
            assert_eq!(all.len(), (p + 1) * (p + 2) / 2);
            assert_eq!(cells(p).len(), p * p);
            for cell in cells(p) {
                // The part of the area, with its sign, is the determinant of the barycentric coordinates.
                let [a, b, c] = cell.map(|n| all[n]);
                let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
                let part = a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1);
                assert!((part - 1.0 / (p * p) as f64).abs() < 1e-14, "degree {p}: {cell:?} has {part}");
            }
        }
    }

    #[test]
    fn degree_one_is_the_triangle_itself() {
        assert_eq!(lattice(1).collect::<Vec<_>>(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(cells(1), [[0, 1, 2]]);
        let mixed = Lattice { degrees: vec![1, 2] };
        let first: Vec<i64> = mixed.connectivity().take(12).collect();
        assert_eq!(first, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
        assert_eq!((mixed.cells(0), mixed.cells(1), mixed.connectivity().count()), (3, 12, 45));
        assert_eq!(mixed.connectivity().max(), Some(9 + 18 - 1));
    }
}
