//! The stiffness of a triangle for the nodes on its boundary, the inside minimised away.

use super::cholesky;
use super::split::Split;
#[cfg(test)]
use crate::element::Material;
use crate::element::polynomial::side::elevation;
use crate::lanes::wide;

/// K of ½ uᵀKu − fᵀu, u being x and y of the nodes on the boundary ([`crate::bounds::upper::Nodes::of_triangle`]), and what eliminates the
/// inside. In the plane it is the same for similar triangles.
#[derive(Debug)]
pub struct Stiffness {
    /// Unknowns on the boundary with sides of their own degrees, with sides of the degree of the triangle, and inside.
    pub size: usize,
    pub boundary: usize,
    pub inside: usize,
    /// Row by row.
    matrix: Box<[f64]>,
    /// L of K_ii = L Lᵀ, packed, and L⁻¹ K_ib row by row.
    factor: Box<[f64]>,
    across: Box<[f64]>,
    /// Factors from nodal values to coefficients of the boundary ([`raising`]); empty where the two are the same.
    raising: Vec<(usize, usize, f64)>,
}

impl Stiffness {
    /// That of a triangle of degree `k` with sides of degrees `degrees`; `None` where the inside has no unique minimum in
    /// numbers.
    #[cfg(test)]
    pub fn new(k: usize, degrees: [usize; 3], corners: [[f64; 2]; 3], material: &Material) -> Option<Self> {
        Self::of(k, degrees, Split::new(k, corners, material))
    }

    /// Eliminates the inside of the full stiffness of a triangle; `None` where the inside has no unique minimum in numbers.
    pub fn of(k: usize, degrees: [usize; 3], split: Split) -> Option<Self> {
        // With K_ii = L Lᵀ and Y = L⁻¹ K_ib, what is left is K_bb − YᵀY.
        let (boundary, inside) = (split.boundary, split.inside);
        let mut factor = split.inside();
        if !cholesky::factorise(&mut factor, inside, 0.0) {
            return None;
        }
        let rows = |rows: std::ops::Range<usize>| {
            let mut out = Vec::with_capacity(rows.len() * boundary);
            rows.for_each(|i| out.extend_from_slice(&split.row(i)[..boundary]));
            out
        };
        let mut across = rows(boundary..boundary + inside);
        cholesky::forward(&factor, &mut across, inside);
        let mut matrix = rows(0..boundary);
        eliminate(&mut matrix, &across, boundary);
        let raising = if degrees == [k; 3] { Vec::new() } else { raising(k, degrees) };
        let size = 6 + 2 * degrees.iter().map(|k| k - 1).sum::<usize>();
        if !raising.is_empty() {
            matrix = lowered(&matrix, boundary, size, &raising);
        }
        let [matrix, factor, across] = [matrix, factor, across].map(Vec::into_boxed_slice);
        Some(Stiffness { size, boundary, inside, matrix, factor, across, raising })
    }

    /// A row of K.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.matrix[i * self.size..(i + 1) * self.size]
    }

    /// Takes the forces on all coefficients of the triangle, those on the boundary first: f, to which what is on the boundary is
    /// added, and L⁻¹ f_i.
    pub fn condense(&self, forces: &[f64], load: &mut [f64], within: &mut [f64]) {
        let (boundary, inside) = forces.split_at(self.boundary);
        within.copy_from_slice(inside);
        cholesky::forward(&self.factor, within, self.inside);
        let eliminate = |load: &mut [f64]| {
            for (by, row) in within.iter().zip(self.across.chunks_exact(load.len())) {
                load.iter_mut().zip(row).for_each(|(f, v)| *f -= by * v);
            }
        };
        if self.raising.is_empty() {
            load.copy_from_slice(boundary);
            return eliminate(load);
        }
        let mut raised = boundary.to_vec();
        eliminate(&mut raised);
        load.fill(0.0);
        for (i, a, p) in &self.raising {
            (0..2).for_each(|c| load[2 * a + c] += p * raised[2 * i + c]);
        }
    }

    /// Turns L⁻¹ f_i into the coefficients inside, x and y of each, that minimise the energy where those on the boundary are
    /// `boundary`, in the degree of the triangle.
    pub fn inside(&self, boundary: &[f64], within: &mut [f64]) {
        for (f, row) in within.iter_mut().zip(self.across.chunks_exact(boundary.len())) {
            *f -= row.iter().zip(boundary).map(|(k, u)| k * u).sum::<f64>();
        }
        cholesky::backward(&self.factor, within);
    }

    /// uᵀKv.
    pub fn form(&self, u: &[f64], v: &[f64]) -> f64 {
        let row = |(row, u): (&[f64], &f64)| u * row.iter().zip(v).map(|(k, v)| k * v).sum::<f64>();
        self.matrix.chunks_exact(self.size).zip(u).map(row).sum()
    }

    /// f − Ku.
    pub fn residual(&self, load: &[f64], u: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(load);
        subtract(&self.matrix, u, out);
    }
}

wide! {
    /// K − YᵀY, both with `columns` columns.
    fn eliminate(matrix: &mut [f64], across: &[f64], columns: usize) {
        for y in across.chunks_exact(columns) {
            for (by, row) in y.iter().zip(matrix.chunks_exact_mut(columns)) {
                row.iter_mut().zip(y).for_each(|(k, v)| *k -= by * v);
            }
        }
    }

    /// Takes Ku from `out`.
    fn subtract(matrix: &[f64], u: &[f64], out: &mut [f64]) {
        match out.len() {
            // The sizes of quadratics and cubics, whose loops are then of known length.
            12 => subtract_of::<12>(matrix, u, out),
            18 => subtract_of::<18>(matrix, u, out),
            size => {
                // K is symmetric: its rows are its columns.
                for (row, u) in matrix.chunks_exact(size).zip(u) {
                    out.iter_mut().zip(row).for_each(|(o, k)| *o -= u * k);
                }
            }
        }
    }
}

/// As [`subtract`], for N numbers.
#[inline(always)]
fn subtract_of<const N: usize>(matrix: &[f64], u: &[f64], out: &mut [f64]) {
    let (rows, _) = matrix.as_chunks::<N>();
    let (Some(u), Some(out)) = (u.first_chunk::<N>(), out.first_chunk_mut::<N>()) else { return };
    let mut sum = *out;
    for (row, u) in rows.iter().zip(u) {
        sum.iter_mut().zip(row).for_each(|(s, k)| *s -= u * k);
    }
    *out = sum;
}

/// K for sides of lower degrees, from that for sides of the degree of the triangle.
fn lowered(matrix: &[f64], boundary: usize, size: usize, raising: &[(usize, usize, f64)]) -> Vec<f64> {
    let mut out = vec![0.0; size * size];
    for (i, a, p) in raising {
        for c in 0..2 {
            let row = &matrix[(2 * i + c) * boundary..][..boundary];
            for (j, b, q) in raising {
                for d in 0..2 {
                    out[(2 * a + c) * size + 2 * b + d] += p * q * row[2 * j + d];
                }
            }
        }
    }
    out
}

/// Factors from nodal values to the boundary coefficients of degree `k` where the sides have the given degrees: coefficient i, node a and
/// the factor.
fn raising(k: usize, degrees: [usize; 3]) -> Vec<(usize, usize, f64)> {
    let mut entries: Vec<(usize, usize, f64)> = (0..3).map(|corner| (corner, corner, 1.0)).collect();
    let mut first = 3;
    for (i, own) in degrees.into_iter().enumerate() {
        let node = |j: usize| match j {
            0 => (i + 1) % 3,
            j if j == own => (i + 2) % 3,
            j => first + j - 1,
        };
        for j in 1..k {
            for m in 0..=own {
                let factor = elevation(own, k, j, m);
                if factor != 0.0 {
                    entries.push((3 + i * (k - 1) + j - 1, node(m), factor));
                }
            }
        }
        first += own - 1;
    }
    entries
}
