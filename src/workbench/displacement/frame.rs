//! Nothing depends on where the element lies, how large it is, and how its nodes are numbered.

use nalgebra::DMatrix;

use super::{DisplacementElement, nodes_on, shapes};
use crate::workbench::finding::{Fault, Measured, Property};

pub const ROTATION: Property<DisplacementElement> = Property {
    name: "rotation",
    asks: "turning the element turns K: K(Qx) = Q K(x) Qᵀ",
    usual: true,
    measure: |e| moved(e, "A rotation by 37°", turn(37.0_f64.to_radians()), 1.0),
};

pub const REFLECTION: Property<DisplacementElement> = Property {
    name: "reflection",
    asks: "the mirror image of the element has the mirror image of K",
    usual: true,
    measure: reflected,
};

pub const SCALING: Property<DisplacementElement> = Property {
    name: "scaling",
    asks: "K is the same for an element of another size in another place: plane elements scale with thickness alone",
    usual: true,
    measure: |e| moved(e, "Another size and place", [[1.0, 0.0], [0.0, 1.0]], 1e3),
};

pub const RENUMBERING: Property<DisplacementElement> = Property {
    name: "renumbering",
    asks: "beginning with another corner permutes K and does nothing else",
    usual: true,
    measure: renumbered,
};

pub(in crate::workbench) type Turn = [[f64; 2]; 2];

fn turn(angle: f64) -> Turn {
    let (s, c) = angle.sin_cos();
    [[c, -s], [s, c]]
}

fn apply(q: Turn, x: [f64; 2]) -> [f64; 2] {
    q.map(|row| row[0] * x[0] + row[1] * x[1])
}

/// Q K Qᵀ, with node `from[n]` in the place of node n.
fn carried(k: &DMatrix<f64>, q: Turn, from: &[usize]) -> DMatrix<f64> {
    let size = k.nrows();
    let mut matrix = DMatrix::zeros(size, size);
    for (n, &m) in from.iter().enumerate() {
        for (i, row) in q.iter().enumerate() {
            (0..2).for_each(|j| matrix[(2 * n + i, 2 * m + j)] = row[j]);
        }
    }
    &matrix * k * matrix.transpose()
}

fn compare(e: &DisplacementElement, what: &str, found: &DMatrix<f64>, expected: &DMatrix<f64>) -> Measured {
    let value = (found - expected).amax() / expected.amax();
    let sentence = match value <= e.precision {
        true => format!("{what} changes nothing but the frame, relative to the largest entry of K"),
        false => format!("{what} changes K itself, relative to its largest entry"),
    };
    Measured::new(value, e.precision, sentence)
}

fn moved(e: &DisplacementElement, what: &str, q: Turn, factor: f64) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let nodes = nodes_on(&layout, &shapes::irregular(e.outline.corners.len()));
    let there: Vec<[f64; 2]> = nodes.iter().map(|x| apply(q, [factor * x[0] + 2.0, factor * x[1] - 1.0])).collect();
    let same: Vec<usize> = (0..nodes.len()).collect();
    let expected = carried(&e.stiffness(&nodes, &material)?, q, &same);
    Ok(compare(e, what, &e.stiffness(&there, &material)?, &expected))
}

fn renumbered(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material, corners) = (e.layout()?, e.material()?, e.outline.corners.len());
    // Rings lie beside their axis.
    let at: Vec<[f64; 2]> = shapes::irregular(corners).into_iter().map(|[x, y]| [x + 1.0, y]).collect();
    let begun: Vec<[f64; 2]> = (0..corners).map(|k| at[(k + 1) % corners]).collect();
    let (nodes, there) = (nodes_on(&layout, &at), nodes_on(&layout, &begun));
    let from = places(&there, &nodes)?;
    let expected = carried(&e.stiffness(&nodes, &material)?, turn(0.0), &from);
    Ok(compare(e, "Another first corner", &e.stiffness(&there, &material)?, &expected))
}

/// For each of the points `there` the number of the same point among `nodes`.
///
/// # Errors
/// A point is not among them.
fn places(there: &[[f64; 2]], nodes: &[[f64; 2]]) -> Result<Vec<usize>, Fault> {
    let near = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-9;
    let found: Option<Vec<usize>> = there.iter().map(|x| nodes.iter().position(|y| near(x, y))).collect();
    found.ok_or_else(|| Fault::NotMade("the nodes do not lie alike on all sides".into()))
}

fn reflected(e: &DisplacementElement) -> Result<Measured, Fault> {
    mirrored(e, &shapes::irregular(e.outline.corners.len()), [[-1.0, 0.0], [0.0, 1.0]])
}

/// Whether the mirror image of the element on these corners has the mirror image of K.
///
/// # Errors
/// There is no formula, or it fails.
pub(in crate::workbench) fn mirrored(
    e: &DisplacementElement,
    at: &[[f64; 2]],
    mirror: Turn,
) -> Result<Measured, Fault> {
    e.formula()?;
    let (layout, material, corners) = (e.layout()?, e.material()?, at.len());
    // Counter-clockwise again: the corners in reverse.
    let image: Vec<[f64; 2]> = (0..corners).map(|k| apply(mirror, at[(corners - k) % corners])).collect();
    let (nodes, there) = (nodes_on(&layout, at), nodes_on(&layout, &image));
    let back: Vec<[f64; 2]> = there.iter().map(|x| apply(mirror, *x)).collect();
    let from = places(&back, &nodes)?;
    let expected = carried(&e.stiffness(&nodes, &material)?, mirror, &from);
    Ok(compare(e, "A mirror image", &e.stiffness(&there, &material)?, &expected))
}
