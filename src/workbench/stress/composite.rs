//! Linear stresses by plain linear algebra, on one triangle or on its three subtriangles.
//!
//! Nodal values are the unknowns; continuity of tractions across inner segments, and where it is asked for div τ = 0, are equations in
//! them. Three parts without the second are the element of Johnson and Mercier (Numer. Math. 30 (1978) 103–116), dimension 15;
//! with it they are the block of degree 1, dimension 9. One part with it is the linear triangle of seven parameters (3.1), which has
//! no field for two of nine tractions in equilibrium.

use nalgebra::{DMatrix, DVector};

use super::StressElement;
use super::divergence::at_points;
use super::fields::{Fields, Nodal, side, traction};
use crate::element::Material;
use crate::element::geometry::sub_corners;

/// A space of linear stresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Composite {
    /// Its name.
    pub name: &'static str,
    /// Three subtriangles in place of one triangle.
    pub is_split: bool,
    /// div τ = 0.
    pub is_balanced: bool,
}

impl Composite {
    /// The single linear triangle without subdivision.
    pub const SINGLE: Composite = Composite { name: "single linear triangle", is_split: false, is_balanced: true };
    /// The element of Johnson and Mercier.
    pub const JOHNSON_MERCIER: Composite = Composite { name: "Johnson–Mercier", is_split: true, is_balanced: false };
}

impl StressElement for Composite {
    fn name(&self) -> &str {
        self.name
    }

    fn degree(&self) -> usize {
        1
    }

    fn fields(&self, corners: [[f64; 2]; 3], material: &Material, _: [f64; 2]) -> Fields {
        let parts: Vec<_> =
            if self.is_split { (0..3).map(|s| sub_corners(corners, s)).collect() } else { vec![corners] };
        let values = 9 * parts.len();
        let unit = |k: usize| {
            let mut field = vec![[0.0; 3]; values / 3];
            field[k / 3][k % 3] = 1.0;
            Nodal { degree: 1, values: field }
        };
        let mut space = Fields {
            corners,
            parts,
            degree: 1,
            fields: (0..values).map(unit).collect(),
            tractions: Vec::new(),
            particular: None,
            material: *material,
        };
        let columns: Vec<DVector<f64>> = space.fields.iter().map(|f| self.equations(&space, f)).collect();
        let free = null_space(&DMatrix::from_columns(&columns));
        // Orthonormal in energy.
        let r = (space.columns(&space.fields) * &free).qr().r();
        let modes = r.transpose().solve_lower_triangular(&free.transpose()).map_or(free, |m| m.transpose());
        space.fields = modes
            .column_iter()
            .map(|m| Nodal {
                degree: 1,
                values: (0..values / 3).map(|n| [m[3 * n], m[3 * n + 1], m[3 * n + 2]]).collect(),
            })
            .collect();
        let tractions = |field: &Nodal| {
            let mut all = Vec::new();
            for (s, x) in (0..3).flat_map(|s| [0.0, 1.0].map(|x| (s, x))) {
                let (part, l) = space.on_side(s, x);
                all.extend(traction(field.at(part, l), side(corners, s).normal));
            }
            all
        };
        space.tractions = space.fields.iter().map(tractions).collect();
        space
    }
}

impl Composite {
    /// Residuals of continuity and equilibrium, which have to vanish.
    fn equations(&self, space: &Fields, field: &Nodal) -> DVector<f64> {
        let mut rows = Vec::new();
        if self.is_balanced {
            let h = side(space.corners, 0).length;
            rows.extend(at_points(space, field).as_flattened().iter().map(|x| h * x));
        }
        for sub in 0..if self.is_split { 3 } else { 0 } {
            let q = space.parts[sub];
            let (dx, dy) = (q[2][0] - q[1][0], q[2][1] - q[1][1]);
            let n = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
            for s in [0.0, 1.0] {
                let here = traction(field.at(sub, [0.0, 1.0 - s, s]), n);
                let there = traction(field.at((sub + 1) % 3, [1.0 - s, 0.0, s]), n);
                rows.extend((0..2).map(|c| here[c] - there[c]));
            }
        }
        DVector::from_vec(rows)
    }
}

/// An orthonormal basis of the vectors that a matrix maps to zero.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = matrix.ncols();
    let svd = matrix.clone().resize_vertically(columns.max(matrix.nrows()), 0.0).svd(false, true);
    let least = 1e-9 * svd.singular_values.max();
    let kept: Vec<usize> = (0..columns).filter(|&k| svd.singular_values[k] <= least).collect();
    svd.v_t.map_or(DMatrix::zeros(columns, 0), |v| v.transpose().select_columns(&kept))
}
