//! The cells of the mesh file: which pairs of triangles are the halves of one of its quadrilaterals.
//!
//! Stresses live on triangles. A displacement model on the cells of the file, and pictures of them, need to know which two
//! triangles were one cell. A quadrilateral stays one as long as both halves are there as they were cut: where a contact puts a
//! vertex into one of its sides, or bisection cuts a half, its triangles are cells of their own; quartering makes four of it.

use crate::mesh::{Map, Triangulation};

/// Pairs of triangles that are the halves of a quadrilateral; every other triangle is a cell itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FileCells {
    pairs: Vec<[usize; 2]>,
}

/// A quadrilateral of the mesh file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadrilateral {
    /// Its vertices, counter-clockwise; the diagonal joins the second and the fourth.
    pub corners: [usize; 4],
    /// The triangle at its first corner, and the one at its third.
    pub triangles: [usize; 2],
    /// The edge between them.
    pub diagonal: usize,
    /// The edges from each corner to the next.
    pub sides: [usize; 4],
}

impl FileCells {
    /// Finds the two halves of each of the quadrilaterals `corners` among `triangles`; one that lost a half is none.
    pub fn find(corners: &[[usize; 4]], triangles: &[[usize; 3]]) -> Self {
        if corners.is_empty() {
            return FileCells::default();
        }
        let sorted = |mut corners: [usize; 3]| {
            corners.sort_unstable();
            corners
        };
        let mut number: Map<[usize; 3], usize> =
            triangles.iter().enumerate().map(|(t, corners)| (sorted(*corners), t)).collect();
        let mut pairs = Vec::with_capacity(corners.len());
        for &[a, b, c, d] in corners {
            for halves in [[[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]] {
                let [one, other] = halves.map(sorted);
                if let (Some(&t), Some(&u)) = (number.get(&one), number.get(&other)) {
                    pairs.push([t, u]);
                    // A cell that is listed twice is one.
                    number.remove(&one);
                    number.remove(&other);
                }
            }
        }
        FileCells { pairs }
    }

    /// The pairs of which both triangles are left, numbered anew: triangle t is `now(t)`.
    pub(in crate::mesh) fn kept(&self, now: impl Fn(usize) -> Option<usize>) -> Self {
        let pairs = self.pairs.iter().filter_map(|[t, u]| Some([now(*t)?, now(*u)?])).collect();
        FileCells { pairs }
    }

    /// Number of quadrilaterals.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// True if all cells are triangles.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }
}

impl Quadrilateral {
    /// The corner coordinates.
    pub fn points(&self, mesh: &Triangulation) -> [[f64; 2]; 4] {
        self.corners.map(|v| mesh.points[v])
    }

    /// True if all angles are below 180°, so that the square is mapped onto it one to one.
    pub fn is_convex(&self, mesh: &Triangulation) -> bool {
        let p = self.points(mesh);
        (0..4).all(|i| {
            let [a, b, c] = [0, 1, 2].map(|k| p[(i + k) % 4]);
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]) > 0.0
        })
    }

    /// True if opposite sides are parallel and of one length, to the digits of the coordinates.
    pub fn is_parallelogram(&self, mesh: &Triangulation) -> bool {
        let [a, b, c, d] = self.points(mesh);
        let size = [a, b, c, d].iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        (0..2).all(|k| ((a[k] - b[k]) + (c[k] - d[k])).abs() <= 8.0 * f64::EPSILON * size)
    }
}

impl Triangulation {
    /// Forgets pairs of triangles that are not bonded along an edge, or are in two bodies.
    pub(in crate::mesh) fn drop_parted_cells(&mut self) {
        let bonded = |[t, u]: &[usize; 2]| {
            let shared = |e: &usize| self.edges[*e].triangles.iter().flatten().any(|other| other == u);
            self.body[*t] == self.body[*u] && self.triangle_edges[*t].iter().any(shared)
        };
        self.cells.pairs.retain(bonded);
    }

    /// The quadrilaterals of the mesh file.
    pub fn quadrilaterals(&self) -> impl Iterator<Item = Quadrilateral> + '_ {
        self.cells.pairs.iter().filter_map(|&[t, u]| {
            let other = |e: usize| self.edges[e].triangles.iter().flatten().any(|v| *v == u);
            let i = (0..3).find(|&i| other(self.triangle_edges[t][i]))?;
            let diagonal = self.triangle_edges[t][i];
            let j = (0..3).find(|&j| self.triangle_edges[u][j] == diagonal)?;
            let corners = [
                self.triangles[t][i],
                self.triangles[t][(i + 1) % 3],
                self.triangles[u][j],
                self.triangles[t][(i + 2) % 3],
            ];
            let [first, second] = [(t, i), (u, j)].map(|(t, i)| {
                let edges = self.triangle_edges[t];
                [edges[(i + 2) % 3], edges[(i + 1) % 3]]
            });
            // Side (0, 1) lies opposite the corner after the next, (3, 0) opposite the next one.
            let sides = [first[0], second[1], second[0], first[1]];
            Some(Quadrilateral { corners, triangles: [t, u], diagonal, sides })
        })
    }

    /// True if every cell of the file is a quadrilateral.
    pub fn is_quadrilateral(&self) -> bool {
        !self.cells.is_empty() && 2 * self.cells.len() == self.triangles.len()
    }

    /// The triangles that are cells of the file themselves.
    pub fn lone_triangles(&self) -> Vec<usize> {
        let mut half = vec![false; self.triangles.len()];
        self.cells.pairs.iter().flatten().for_each(|t| half[*t] = true);
        (0..half.len()).filter(|t| !half[*t]).collect()
    }

    /// The number of the cell that each triangle is in: cells are numbered by their first triangle.
    pub fn cell_of_triangles(&self) -> Vec<usize> {
        let mut first: Vec<usize> = (0..self.triangles.len()).collect();
        for [t, u] in &self.cells.pairs {
            first[*t.max(u)] = *t.min(u);
        }
        let (mut number, mut next) = (Vec::with_capacity(first.len()), 0);
        for (t, &first) in first.iter().enumerate() {
            if first == t {
                number.push(next);
                next += 1;
            } else {
                number.push(number[first]);
            }
        }
        number
    }

    /// The quadrilaterals that quartering the triangles makes: four of each, with the middle of the diagonal in common. The
    /// triangles of triangle t are 4t … 4t + 3, the first three at its corners.
    pub(in crate::mesh) fn quartered_cells(&self) -> FileCells {
        let mut pairs = Vec::with_capacity(4 * self.cells.len());
        for cell in self.quadrilaterals() {
            let [t, u] = cell.triangles;
            let at = |t: usize, v: usize| Some(4 * t + self.triangles[t].iter().position(|w| *w == v)?);
            let [a, b, c, d] = cell.corners;
            let four =
                [[at(t, a), Some(4 * t + 3)], [at(t, b), at(u, b)], [at(u, c), Some(4 * u + 3)], [at(t, d), at(u, d)]];
            pairs.extend(four.into_iter().filter_map(|[one, other]| Some([one?, other?])));
        }
        FileCells { pairs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::refinement::bisect::{RefinementEdges, bisect};
    use crate::mesh::testing::*;
    use crate::mesh::{Curved, RawMesh};
    use crate::scene::Gap;
    use proptest::prelude::*;

    fn shaken(mut raw: RawMesh, amount: f64, seed: u64) -> RawMesh {
        let mut state = seed;
        for p in raw.points.iter_mut().filter(|p| p.iter().all(|x| x % 1.0 != 0.0)) {
            for x in p {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *x += amount * ((state >> 40) as f64 / f64::from(1 << 24) - 0.5);
            }
        }
        raw
    }

    fn area(p: [[f64; 2]; 4]) -> f64 {
        (0..4).map(|i| 0.5 * (p[i][0] * p[(i + 1) % 4][1] - p[i][1] * p[(i + 1) % 4][0])).sum()
    }

    /// Each quadrilateral is the union of its triangles, with the edges where it says.
    fn assert_whole(mesh: &Triangulation) {
        for cell in mesh.quadrilaterals() {
            let [t, u] = cell.triangles;
            assert!((area(cell.points(mesh)) - mesh.area(t) - mesh.area(u)).abs() < 1e-14);
            let ends = |e: usize| {
                let [a, b] = mesh.edges[e].vertices;
                [a.min(b), a.max(b)]
            };
            let between = |i: usize, j: usize| {
                let [a, b] = [cell.corners[i], cell.corners[j]];
                [a.min(b), a.max(b)]
            };
            assert_eq!(ends(cell.diagonal), between(1, 3));
            for i in 0..4 {
                assert_eq!(ends(cell.sides[i]), between(i, (i + 1) % 4), "side {i} of {cell:?}");
            }
            assert!(mesh.triangle_edges[t].contains(&cell.sides[0]) && mesh.triangle_edges[u].contains(&cell.sides[2]));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn quartering_makes_four_of_each(seed in any::<u64>(), amount in 0.0..0.3_f64, n in 1..4_usize) {
            let raw = shaken(of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [n, n + 1])), amount / n as f64, seed);
            let mesh = Triangulation::new(raw, &scene(&["a"])).expect("a good mesh").0;
            prop_assert!(mesh.is_quadrilateral());
            prop_assert_eq!(mesh.cells.len(), n * (n + 1));
            let finer = mesh.quartered(&Curved::default());
            prop_assert!(finer.is_quadrilateral());
            for m in [&mesh, &finer, &finer.quartered(&Curved::default())] {
                assert_whole(m);
                prop_assert!(m.quadrilaterals().all(|cell| cell.is_convex(m)));
                let numbers = m.cell_of_triangles();
                prop_assert_eq!(numbers.iter().max(), Some(&(m.cells.len() - 1)));
                prop_assert!(m.quadrilaterals().all(|cell| numbers[cell.triangles[0]] == numbers[cell.triangles[1]]));
            }
            prop_assert_eq!(mesh.quadrilaterals().all(|cell| cell.is_parallelogram(&mesh)), amount == 0.0 || n == 1);
        }

        #[test]
        fn bisection_leaves_those_whole_that_it_does_not_cut(marked in prop::collection::vec(0..32_usize, 0..6)) {
            let mesh = Triangulation::new(of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [4, 4])), &scene(&["a"]))
                .expect("a good mesh")
                .0;
            let finer = bisect(&mesh, &RefinementEdges::longest(&mesh), &marked, &[], &Curved::default());
            assert_whole(&finer.mesh);
            let cut = |t: usize| finer.parent.iter().filter(|p| **p == t).count() > 1;
            let whole = mesh.quadrilaterals().filter(|cell| !cell.triangles.iter().any(|t| cut(*t))).count();
            prop_assert_eq!(finer.mesh.cells.len(), whole);
            prop_assert_eq!(finer.mesh.lone_triangles().len() + 2 * whole, finer.mesh.triangles.len());
        }
    }

    #[test]
    fn a_side_that_a_contact_cuts_makes_triangles_of_its_cell() {
        let scene = contact(scene(&["a", "b"]), "a_right", "b_left", Gap::Constant(0.0));
        let sides = |n: usize| {
            let a = of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [2, 2]));
            let b = of_quadrilaterals(grid("b", [1.0, 0.0], [2.0, 1.0], [2, n]));
            let mesh = Triangulation::new(both(a, b), &scene).expect("a good mesh").0;
            crate::mesh::sides::glue::glue(mesh, &scene).expect("sides that match").mesh
        };
        assert_eq!(sides(2).cells.len(), 8);
        assert!(sides(2).is_quadrilateral());
        // The vertices of `b` at 1/3 and 2/3 cut both cells of `a`, that of `a` at 1/2 the middle one of `b`.
        let cut = sides(3);
        assert_eq!(cut.cells.len(), 4 + 6 - 2 - 1);
        assert_whole(&cut);
        assert!(!cut.is_quadrilateral());
    }

    #[test]
    fn bodies_part_a_cell() {
        let mut raw = of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [2, 1]));
        raw.triangles[0].1 = "b".to_string();
        let mesh = Triangulation::new(raw, &scene(&["a", "b"])).expect("a good mesh").0;
        assert_eq!(mesh.cells.len(), 1);
    }
}
