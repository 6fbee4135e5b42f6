//! How many fields there are, and how many tractions they tell apart.

use nalgebra::{DMatrix, DVector};

use super::fields::{Fields, side};
use super::{StressElement, usual};
use crate::workbench::displacement::spurious;
use crate::workbench::finding::{Measured, Property};
use crate::workbench::picture;

pub const DIMENSION: Property<dyn StressElement> = Property {
    name: "dimension",
    asks: "dim N(K) = 6(p + 1) − 3: one field for every traction in equilibrium",
    usual: true,
    measure: |e| {
        let fields = usual(e)?;
        let (p, found) = (fields.degree, rank(&fields.columns(&fields.fields)));
        let wanted = 6 * (p + 1) - 3;
        let text = format!(
            "{} fields, of which {found} are independent, for {wanted} tractions of degree {p} in equilibrium.",
            fields.fields.len()
        );
        Ok(Measured::count(found.abs_diff(wanted) + fields.fields.len() - found, text))
    },
};

pub const TRACTIONS: Property<dyn StressElement> = Property {
    name: "traction-rank",
    asks: "every traction in equilibrium has a field: K = T Tᵀ has no zero-energy motions of the sides but the rigid ones",
    usual: true,
    measure: |e| {
        let fields = usual(e)?;
        let silent = silent(&fields);
        let (wanted, missing) = (6 * (fields.degree + 1) - 3, silent.ncols());
        let without = fields.fields.len().saturating_sub(rank(&fields.forces()));
        let unseen = match without {
            0 => String::new(),
            n => format!(" {n} fields have no traction at all."),
        };
        if missing == 0 {
            let text =
                format!("All {wanted} tractions in equilibrium have a field; there are no spurious modes.{unseen}");
            return Ok(Measured::count(0, text));
        }
        let text = format!(
            "{missing} of {wanted} tractions in equilibrium have no field: that many spurious motions of the sides, which are \
             not rigid, store nothing.{unseen}"
        );
        let drawn =
            picture::side_motions("spurious motions of the sides", fields.corners, &side_panels(&fields, &silent));
        Ok(Measured::count(missing, text).drawn(Some(drawn)))
    },
};

/// Singular values below this part of the largest are zero.
const ZERO: f64 = 1e-9;

fn rank(m: &DMatrix<f64>) -> usize {
    let s = m.singular_values();
    s.iter().filter(|x| **x > ZERO * s.max()).count()
}

/// Largest over smallest singular value of the tractions of the modes, each mode in units of its own size.
pub fn traction_condition(fields: &Fields) -> f64 {
    let mut t = fields.forces();
    for mut column in t.column_iter_mut() {
        let norm = column.norm();
        column /= norm;
    }
    let s = t.singular_values();
    s.max() / s.min()
}

/// Moments of side displacements that no traction of the element works on, orthogonal to the rigid ones.
fn silent(fields: &Fields) -> DMatrix<f64> {
    let t = fields.forces();
    let rigid = rigid(fields).qr().q();
    spurious(&t.transpose().resize_vertically(t.nrows().max(t.ncols()), 0.0), &rigid, ZERO)
}

/// Moments ∫ u B_k ds / ℓ of the rigid motions.
fn rigid(fields: &Fields) -> DMatrix<f64> {
    let n = fields.degree + 1;
    let mut r = DMatrix::zeros(6 * n, 3);
    for s in 0..3 {
        let side = side(fields.corners, s);
        for k in 0..n {
            let (row, x) = (2 * (s * n + k), (k + 1) as f64 / (n + 1) as f64);
            let at = [0, 1].map(|c| side.start[c] + x * (side.end[c] - side.start[c]));
            (r[(row, 0)], r[(row + 1, 1)]) = (1.0, 1.0);
            (r[(row, 2)], r[(row + 1, 2)]) = (-at[1], at[0]);
        }
    }
    r
}

/// The linear side displacements with the first and last moments of each panel.
fn side_panels(fields: &Fields, silent: &DMatrix<f64>) -> Vec<[[[f64; 2]; 2]; 3]> {
    let n = fields.degree + 1;
    // Lengths of sides are in the moments: ∫ u B_k ds / ℓ of a linear u is a mean about the place (k + 1)/(n + 1).
    let ends = |m: &DVector<f64>, s: usize| {
        let moment = |k: usize, c: usize| m[2 * (s * n + k) + c];
        let slope = |c: usize| (moment(n - 1, c) - moment(0, c)) * (n + 1) as f64 / (n - 1).max(1) as f64;
        let middle = |c: usize| 0.5 * (moment(n - 1, c) + moment(0, c));
        [-0.5, 0.5].map(|x| [0, 1].map(|c| middle(c) + x * slope(c)))
    };
    silent.column_iter().take(6).map(|m| [0, 1, 2].map(|s| ends(&m.into_owned(), s))).collect()
}
