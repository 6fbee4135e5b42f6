//! Q4 that does not lock: its volume change is that of the middle, which on a bilinear quadrilateral is the mean.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix4};

use super::{Point, strains};

/// Part of the strain that is taken as volume change; the rest is left as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// A third of the trace along x, y and z: the B-bar of Hughes, or mean dilatation.
    Thirds,
    /// Half of the trace along x and y.
    Halves,
    /// The part λ (tr ε)² of the energy: selective reduced integration.
    Lame,
}

/// Hooke's law of (xx, yy, γ, zz) from that of plane strain (xx, yy, γ).
fn solid(d: &Matrix3<f64>) -> Matrix4<f64> {
    let (a, b, g) = (d[(0, 0)], d[(0, 1)], d[(2, 2)]);
    Matrix4::new(a, b, 0.0, b, b, a, 0.0, b, 0.0, 0.0, g, 0.0, b, b, 0.0, a)
}

/// The row of the trace of the strain.
fn trace(p: &Point) -> DMatrix<f64> {
    let flat: Vec<f64> = p.gradients.iter().flatten().copied().collect();
    DMatrix::from_row_slice(1, flat.len(), &flat)
}

/// B of (xx, yy, γ, zz), and the same with this part of the missing volume change added to xx, yy and zz.
fn rows(p: &Point, middle: &Point, parts: [f64; 3]) -> [DMatrix<f64>; 2] {
    let b = strains(&p.gradients).insert_row(3, 0.0);
    let parts = DVector::from_column_slice(&[parts[0], parts[1], 0.0, parts[2]]);
    let changed = &b + parts * (trace(middle) - trace(p));
    [b, changed]
}

/// K with parts of the volume change of the middle in xx, yy and zz: all alike and of sum one is the B-bar that is right.
pub fn with_rows(points: &[Point], middle: &Point, d: &Matrix3<f64>, parts: [f64; 3]) -> DMatrix<f64> {
    let solid = solid(d);
    let of = |p: &Point| {
        let [_, b] = rows(p, middle, parts);
        b.transpose() * solid * b * (p.weight * p.det)
    };
    points.iter().map(of).sum()
}

/// K with B-bar on one side of Hooke's law only: Bᵀ D B̄.
pub fn one_sided(points: &[Point], middle: &Point, d: &Matrix3<f64>, parts: [f64; 3]) -> DMatrix<f64> {
    let solid = solid(d);
    let of = |p: &Point| {
        let [b, changed] = rows(p, middle, parts);
        b.transpose() * solid * changed * (p.weight * p.det)
    };
    points.iter().map(of).sum()
}

/// K with the volume change of the middle.
pub fn split(points: &[Point], middle: &Point, d: &Matrix3<f64>, split: Split) -> DMatrix<f64> {
    match split {
        Split::Thirds => with_rows(points, middle, d, [1.0 / 3.0; 3]),
        Split::Halves => with_rows(points, middle, d, [0.5, 0.5, 0.0]),
        Split::Lame => {
            let lame = d[(0, 1)];
            let rest = Matrix3::from_fn(|i, j| d[(i, j)] - if i < 2 && j < 2 { lame } else { 0.0 });
            let area: f64 = points.iter().map(|p| p.weight * p.det).sum();
            let t = trace(middle);
            points.iter().map(|p| p.stiffness(&rest)).sum::<DMatrix<f64>>() + t.transpose() * &t * (lame * area)
        }
    }
}
