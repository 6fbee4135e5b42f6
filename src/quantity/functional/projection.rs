//! Projection of a function on part of a triangle onto polynomials on its subtriangles.

use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector};

use crate::element::displacement::MOST;
use crate::element::geometry::sub_area;
use crate::element::{Material, Samples, StressField};
use crate::quantity::point::Spot;

/// The mean of products of the shape functions of a [`StressField`] of one degree, and its inverse.
struct Mass {
    matrix: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl Mass {
    fn of(degree: usize) -> &'static Mass {
        static KNOWN: [OnceLock<Mass>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
        KNOWN[degree].get_or_init(|| {
            let samples = Samples::of_stress(degree, degree);
            let count = samples.basis(0).len();
            let mut matrix = DMatrix::zeros(count, count);
            for (q, (_, weight)) in samples.points.iter().enumerate() {
                let basis = DVector::from_column_slice(samples.basis(q));
                matrix += *weight * &basis * basis.transpose();
            }
            // Regular, the functions being independent.
            let inverse = matrix.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(count, count));
            Mass { matrix, inverse }
        })
    }
}

/// A projection, and what it leaves.
pub struct Projection {
    /// On the triangle alone.
    pub field: StressField,
    /// ∫ c(χ − Πχ):(χ − Πχ).
    pub rest: f64,
}

/// The projection of the strain with the values `chi` at `spots` of a triangle, and zero elsewhere on it; `whole` where the spots are
/// those of all of it.
pub fn projected(
    corners: [[f64; 2]; 3],
    material: &Material,
    degree: usize,
    (spots, whole): (&[Spot], bool),
    chi: &[[f64; 3]],
) -> Projection {
    let area = sub_area(corners);
    let mass = Mass::of(degree);
    let count = mass.matrix.nrows();
    let mut field = StressField::zeros(degree, 1);
    let shapes: Vec<Vec<f64>> = spots.iter().map(|spot| StressField::shapes(degree, spot.l)).collect();
    for sub in 0..3 {
        let mut loads = DMatrix::zeros(count, 3);
        for ((spot, shapes), chi) in spots.iter().zip(&shapes).zip(chi).filter(|((spot, _), _)| spot.sub == sub) {
            for (i, shape) in shapes.iter().enumerate() {
                (0..3).for_each(|c| loads[(i, c)] += spot.weight / area * shape * chi[c]);
            }
        }
        let first = &mass.inverse * &loads;
        // Once more on what is left: the inverse has fewer digits than the functions.
        let values = &first + &mass.inverse * (loads - &mass.matrix * &first);
        for (i, value) in field.block_mut(0)[sub * count..][..count].iter_mut().enumerate() {
            *value = [0, 1, 2].map(|c| values[(i, c)]);
        }
    }
    let square = |e: [f64; 3]| material.strain_product(e, e);
    let mut rest = 0.0;
    for ((spot, shapes), chi) in spots.iter().zip(&shapes).zip(chi) {
        let own = &field.block(0)[spot.sub * count..][..count];
        let near = crate::element::weighed(own, shapes.iter().copied());
        rest += spot.weight * square([0, 1, 2].map(|c| chi[c] - near[c]));
        if !whole {
            rest -= spot.weight * square(near);
        }
    }
    if !whole {
        let samples = Samples::of_stress(degree, degree);
        for sub in 0..3 {
            for (q, (_, weight)) in samples.points.iter().enumerate() {
                rest += weight * area * square(field.sample(0, sub, samples, q));
            }
        }
    }
    Projection { field, rest: rest.max(0.0) }
}
