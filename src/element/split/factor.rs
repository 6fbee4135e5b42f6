//! The Householder factor of the fields of a triangle in their energy.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch, recommended_block_size};
use faer::{Mat, Par, Spec};

use super::Triangle;
use super::across::Across;
use super::reference::Field;
use crate::element::{Material, Roots};
use crate::lanes::wide;

/// R of A = QR. The square of a column of A is three times the energy of a field on a triangle of area one where moduli are in units of [`Material::unit`].
pub struct Factor {
    r: Mat<f64>,
}

impl Factor {
    /// The factor of the columns listed in the page of the module, the last only where there is a body force.
    pub fn new(triangle: &Triangle, material: &Material) -> Self {
        let reference = triangle.reference;
        let roots = triangle.shape.frame.roots(material);
        let (modes, p) = (reference.modes, triangle.degree);
        let across = 1 + reference.free.len() + reference.off_base.len();
        let balancing = across + Across::len(p);
        let loaded = triangle.is_loaded();
        let mut r = Mat::<f64>::zeros(9 * modes, balancing + usize::from(loaded));
        for sub in 0..3 {
            // No deviator: nothing of it may drown κ.
            r[(3 * sub * modes, 0)] = roots.of_pressure();
        }
        for (i, field) in reference.free.iter().chain(&reference.off_base).enumerate() {
            fill(r.col_as_slice_mut(1 + i), modes, field, triangle, &roots);
        }
        let fields = Across::new(&triangle.shape, p);
        let mut values = vec![[0.0; 2]; Across::len(p)];
        for sub in 0..3 {
            let weights = reference.from_points.chunks_exact(modes);
            for (&l, weights) in reference.points.iter().zip(weights) {
                let point = triangle.shape.point(sub, l);
                fields.at(point, |i, value| values[i] = value);
                for (i, [yy, xy]) in values.iter().enumerate() {
                    let parts = roots.apply([0.0, *yy, *xy]);
                    scatter(r.col_as_slice_mut(across + i), 3 * sub * modes, weights, parts);
                }
                if loaded {
                    let parts = roots.apply(triangle.balancing(point));
                    scatter(r.col_as_slice_mut(balancing), 3 * sub * modes, weights, parts);
                }
            }
        }
        triangularise(&mut r);
        Factor { r }
    }

    /// Solves R x = b in place, for as many columns as b is long.
    pub fn solve(&self, b: &mut [f64]) {
        backward(&self.r, b);
    }

    /// Components of the last column along the columns of Q.
    pub fn overlaps(&self) -> &[f64] {
        self.r.col_as_slice(self.r.ncols() - 1)
    }
}

wide! {
    /// b = R⁻¹ b, for as many columns as b is long.
    fn backward(r: &Mat<f64>, b: &mut [f64]) {
        for k in (0..b.len()).rev() {
            let column = &r.col_as_slice(k)[..=k];
            let (before, own) = b.split_at_mut(k);
            own[0] /= column[k];
            let x = own[0];
            if x != 0.0 {
                before.iter_mut().zip(column).for_each(|(b, r)| *b -= x * r);
            }
        }
    }
}

/// Writes the coefficients of a field of the reference triangle, mapped, into its column.
fn fill(column: &mut [f64], modes: usize, field: &Field, triangle: &Triangle, roots: &Roots) {
    for (out, own) in column.chunks_exact_mut(3 * modes).zip(field.coefficients.chunks_exact(3 * modes)) {
        for m in 0..modes {
            let stress = triangle.shape.stress([own[m], own[modes + m], own[2 * modes + m]]);
            let parts = roots.apply(stress);
            (out[m], out[modes + m], out[2 * modes + m]) = (parts[0], parts[1], parts[2]);
        }
    }
}

/// Adds to the coefficients of a subtriangle what a value at one point has in them.
fn scatter(column: &mut [f64], first: usize, weights: &[f64], parts: [f64; 3]) {
    for (own, part) in column[first..].chunks_exact_mut(weights.len()).zip(parts) {
        if part != 0.0 {
            own.iter_mut().zip(weights).for_each(|(o, w)| *o += part * w);
        }
    }
}

/// A = QR, R in place of A.
fn triangularise(a: &mut Mat<f64>) {
    let (rows, columns) = (a.nrows(), a.ncols());
    let block = recommended_block_size::<f64>(rows, columns);
    let mut coefficients = Mat::<f64>::zeros(block, columns);
    let params = Spec::default();
    let mut memory = MemBuffer::new(qr_in_place_scratch::<f64>(rows, columns, block, Par::Seq, params));
    qr_in_place(a.as_mut(), coefficients.as_mut(), Par::Seq, MemStack::new(&mut memory), params);
}
