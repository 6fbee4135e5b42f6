//! Comparison of a space with the block of its degree.

use nalgebra::DMatrix;

use super::divergence::at_points;
use super::interpolation::orthonormal;
use super::{FORCE, SolverElement, StressElement, usual};
use crate::element::{MAX_DEGREE, block, lattice_len};
use crate::report::text::number::significant;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;

pub const SPAN: Property<dyn StressElement> = Property {
    name: "span",
    asks: "the self-equilibrated fields of the space are those of the block of that degree: angle zero between the subspaces",
    usual: false,
    measure,
};

/// Sines of angles below this are zero.
const ZERO: f64 = 1e-7;

fn measure(e: &dyn StressElement) -> Result<Measured, Fault> {
    let fields = usual(e)?;
    let p = fields.degree;
    if !(1..=MAX_DEGREE).contains(&p) {
        return Err(Fault::NotMade(format!("there is no block of degree {p}")));
    }
    let theirs = SolverElement(block(p)).fields(fields.corners, &Material::USUAL.compliance(), FORCE);
    // Evaluated at the same points: a field of one part is taken on the three.
    let columns: Vec<Vec<f64>> = fields
        .fields
        .iter()
        .map(|field| {
            theirs.column(|part, l| {
                if fields.parts.len() == 3 {
                    return field.at(part, l);
                }
                let mut whole = [l[2] / 3.0; 3];
                whole[(part + 1) % 3] += l[0];
                whole[(part + 2) % 3] += l[1];
                field.at(0, whole)
            })
        })
        .collect();
    let space = DMatrix::from_fn(columns[0].len(), columns.len(), |i, j| columns[j][i]);
    let balanced = balanced(&fields);
    let (Some(own), Some(reference)) =
        (orthonormal(&(space * &balanced)), orthonormal(&theirs.columns(&theirs.fields)))
    else {
        return Err(Fault::Failed("the space has no basis".into()));
    };
    let cosines = reference.tr_mul(&own).singular_values();
    let shared = cosines.iter().filter(|c| **c > 1.0 - ZERO).count();
    let sine = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b * b.tr_mul(a)).singular_values().max();
    let angle = sine(&reference, &own).max(sine(&own, &reference)).min(1.0).asin().to_degrees();
    let differing = own.ncols() + reference.ncols() - 2 * shared;
    let text = format!(
        "{} of its {} fields balance themselves; {shared} of the {} of the block of degree {p} are among them, the largest angle between the two \
         spaces is {}°.",
        balanced.ncols(),
        fields.fields.len(),
        reference.ncols(),
        significant(if differing == 0 { 0.0 } else { angle }, 3)
    );
    Ok(Measured::count(differing, text))
}

/// Combinations of the modes whose divergence vanishes, a column each.
fn balanced(fields: &super::Fields) -> DMatrix<f64> {
    let n = fields.fields.len();
    let rows = 2 * fields.parts.len() * 5;
    let mut div = DMatrix::zeros(rows.max(n), n);
    for (k, field) in fields.fields.iter().enumerate() {
        let size = field.largest().max(f64::MIN_POSITIVE);
        for (i, x) in at_points(fields, field).as_flattened().iter().enumerate() {
            div[(i, k)] = x / size;
        }
    }
    debug_assert!(fields.fields.iter().all(|f| f.values.len() == fields.parts.len() * lattice_len(f.degree)));
    let svd = div.svd(false, true);
    let Some(v_t) = svd.v_t else { return DMatrix::identity(n, n) };
    let kept: Vec<usize> = (0..n).filter(|&k| svd.singular_values[k] <= 1e-7).collect();
    let unit = v_t.transpose().select_columns(&kept);
    let sizes: Vec<f64> = fields.fields.iter().map(|f| f.largest().max(f64::MIN_POSITIVE)).collect();
    DMatrix::from_fn(n, kept.len(), |i, j| unit[(i, j)] / sizes[i])
}
