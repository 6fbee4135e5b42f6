//! Rigid motions store nothing, and nodal forces balance.

use nalgebra::{DMatrix, DVector};

use super::{DisplacementElement, nodes_on, shapes};
use crate::workbench::finding::{Fault, Measured, Property};

pub const MOTIONS: Property<DisplacementElement> = Property {
    name: "rigid-motions",
    asks: "K R = 0: moving or turning the element as a whole takes no force, whichever way the element lies",
    usual: true,
    measure: annihilated,
};

pub const FORCES: Property<DisplacementElement> = Property {
    name: "self-equilibrium",
    asks: "Rᵀ K = 0: the nodal forces of every motion have neither a resultant nor a moment",
    usual: true,
    measure: balanced,
};

/// Orthonormal rigid motions of the nodes, one a column: along x, along y, rotation about the centre.
pub fn motions(nodes: &[[f64; 2]]) -> DMatrix<f64> {
    let count = nodes.len() as f64;
    let centre = [0, 1].map(|c| nodes.iter().map(|x| x[c]).sum::<f64>() / count);
    let mut r = DMatrix::zeros(2 * nodes.len(), 3);
    for (n, x) in nodes.iter().enumerate() {
        (r[(2 * n, 0)], r[(2 * n + 1, 1)]) = (1.0, 1.0);
        (r[(2 * n, 2)], r[(2 * n + 1, 2)]) = (centre[1] - x[1], x[0] - centre[0]);
    }
    r.column_iter_mut().for_each(|mut c| {
        c.normalize_mut();
    });
    r
}

/// The parts of the columns of `space` within the span of the orthonormal `within`, and what is left.
pub fn within(space: &DMatrix<f64>, span: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
    let inside = span * span.tr_mul(space);
    [inside.clone(), space - inside]
}

/// Name of rigid motion k.
pub fn motion_words(k: usize) -> &'static str {
    ["a shift along x", "a shift along y", "a rotation"][k.min(2)]
}

/// The largest entry of each column.
fn largest(m: &DMatrix<f64>) -> DVector<f64> {
    DVector::from_iterator(m.ncols(), m.column_iter().map(|c| c.amax()))
}

fn annihilated(e: &DisplacementElement) -> Result<Measured, Fault> {
    let found = largest(&(&e.matrix * motions(&e.nodes))) / e.size();
    let worst = found.imax();
    let mut value = found[worst];
    let mut sentence = match value <= e.precision {
        true => "Shifts and the rotation are annihilated, relative to the largest entry of K".to_string(),
        false => format!("K gives forces for {}, relative to its largest entry", motion_words(worst)),
    };
    if let (Ok(layout), Some(material), Ok(_)) = (e.layout(), e.material, e.formula()) {
        for shape in shapes::rotations(e.outline.corners.len()) {
            let nodes = nodes_on(&layout, &shape.corners);
            let k = e.stiffness(&nodes, &material)?;
            let off = (&k * motions(&nodes)).amax() / k.amax();
            if off > value.max(e.precision) {
                sentence = format!(
                    "On the element {} K gives forces for a rigid motion, relative to its largest entry",
                    shape.name
                );
            }
            value = value.max(off);
        }
    }
    Ok(Measured::new(value, e.precision, sentence))
}

fn balanced(e: &DisplacementElement) -> Result<Measured, Fault> {
    let found = largest(&(e.matrix.transpose() * motions(&e.nodes))) / e.size();
    let worst = found.imax();
    let value = found[worst];
    let what = ["a resultant along x", "a resultant along y", "a moment"][worst.min(2)];
    let sentence = match value <= e.precision {
        true => "Nodal forces balance, relative to the largest entry of K".to_string(),
        false => format!("Nodal forces have {what}, relative to the largest entry of K"),
    };
    Ok(Measured::new(value, e.precision, sentence))
}
