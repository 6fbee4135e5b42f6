//! Motions that store no energy: the three rigid ones, and no other.

use nalgebra::{DMatrix, DVector};

use super::{DisplacementElement, motions, within};
use crate::report::text::number::significant;
use crate::workbench::diagnosis::Reference;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::picture;

pub const RANK: Property<DisplacementElement> = Property {
    name: "rank",
    asks: "only rigid motions store no energy: the rank of K is 2n − 3",
    usual: true,
    measure,
};

/// Entries that are less exact may hide a soft motion.
const FEW_DIGITS: f64 = 1e-7;
/// What rounding leaves of the energy of a motion without any, relative to that of the stiffest, and what is far from it.
const NOTHING: f64 = 1e-15;
const FAR: f64 = 1e3;
/// A part of a motion that counts.
const PART: f64 = 0.1;

/// An orthonormal basis of the motions without forces: singular values up to this part of the largest one.
pub fn silent_motions(matrix: &DMatrix<f64>, zero: f64) -> DMatrix<f64> {
    let values = matrix.clone().singular_values();
    let count = values.iter().filter(|v| **v <= zero * values.max()).count();
    // Vectors of equal singular values are safer from the symmetric problem.
    let eigen = matrix.tr_mul(matrix).symmetric_eigen();
    let mut order: Vec<usize> = (0..matrix.ncols()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    eigen.eigenvectors.select_columns(&order[..count])
}

/// An orthonormal basis of the motions that store nothing and are orthogonal to the rigid ones.
pub fn spurious(matrix: &DMatrix<f64>, rigid: &DMatrix<f64>, zero: f64) -> DMatrix<f64> {
    let silent = silent_motions(matrix, zero);
    if silent.ncols() == 0 {
        return silent;
    }
    let [_, rest] = within(&silent, rigid);
    let svd = rest.svd(true, false);
    let Some(u) = svd.u else { return DMatrix::zeros(matrix.ncols(), 0) };
    let kept: Vec<usize> = (0..svd.singular_values.len()).filter(|&k| svd.singular_values[k] > PART).collect();
    u.select_columns(&kept)
}

/// The hourglass motions of a quadrilateral of four nodes: corners move to and fro in turn, along x and along y.
fn hourglass(e: &DisplacementElement) -> Option<DMatrix<f64>> {
    let corners = &e.outline.corners;
    (corners.len() == 4 && e.nodes.len() == 4).then(|| {
        let mut h = DMatrix::zeros(8, 2);
        for (k, &n) in corners.iter().enumerate() {
            let sign = if k % 2 == 0 { 0.5 } else { -0.5 };
            (0..2).for_each(|c| h[(2 * n + c, c)] = sign);
        }
        h
    })
}

fn measure(e: &DisplacementElement) -> Result<Measured, Fault> {
    let rigid = motions(&e.nodes);
    // What hides a motion of the element that is known to have no other hides one of this element too.
    if Reference::of(e).is_ok_and(|reference| spurious(reference.matrix(), &rigid, e.precision).ncols() > 0) {
        let why = if e.precision > FEW_DIGITS { "the entries have too few digits" } else { "the element is too thin" };
        let text = format!("{why} to tell motions that store little from those that store nothing");
        return Err(Fault::NotMade(text));
    }
    let found = spurious(&e.matrix, &rigid, e.precision);
    let singular = e.matrix.clone().singular_values();
    let stored = |m: &DMatrix<f64>| -> Vec<f64> {
        let of = |c: DVector<f64>| (c.dot(&(&e.matrix * &c)) / c.norm_squared() / singular.max()).abs();
        m.column_iter().map(|c| of(c.into_owned())).collect()
    };
    let of_rigid = stored(&rigid).into_iter().fold(NOTHING, f64::max);
    if found.ncols() > 0 && stored(&found).into_iter().all(|own| own > FAR * of_rigid) {
        return Err(Fault::NotMade(
            "the element is too thin to tell motions that store little from those that store nothing".into(),
        ));
    }
    let count = found.ncols();
    let mut sizes: Vec<f64> = singular.iter().map(|s| s / singular.max()).collect();
    sizes.sort_by(f64::total_cmp);
    if count == 0 {
        let next = sizes.into_iter().find(|s| *s > e.precision).unwrap_or(0.0);
        let text = format!(
            "Only rigid motions store no energy; the softest other motion stores {} times the energy of the stiffest.",
            significant(next, 3)
        );
        return Ok(Measured::count(0, text));
    }
    // Orthogonal to rigid motions, so that distortion of the shape plays no part.
    let to_and_fro = hourglass(e).map(|h| {
        let [_, mut h] = within(&h, &rigid);
        h.column_iter_mut().for_each(|mut c| {
            c.normalize_mut();
        });
        let [part, _] = within(&h, &found);
        part
    });
    let is_hourglass = to_and_fro.as_ref().is_some_and(|part| part.column_iter().all(|c| c.norm() > 0.7));
    let [motions, are] = if count == 1 { ["motion stores", "is"] } else { ["motions store", "are"] };
    let kind = if is_hourglass { "hourglass" } else { "spurious" };
    let text = format!("{count} {kind} {motions} nothing and {are} not rigid: the rank of K is too low by {count}.");
    // Along x and along y, rather than any two of their combinations.
    let shown = to_and_fro.filter(|_| is_hourglass && count == 2).unwrap_or(found);
    let panels: Vec<DVector<f64>> = shown.column_iter().map(|c| c.into_owned()).collect();
    let drawn = picture::motions(&format!("{kind} motions"), &e.nodes, &e.outline, &panels);
    Ok(Measured::count(count, text).drawn(Some(drawn)))
}
