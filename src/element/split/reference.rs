//! The self-equilibrated stresses of degree p on one split triangle, found once for all.
//!
//! A triangle K is the image of the equilateral one under x = A ξ, and τ = A τ̂ Aᵀ is self-equilibrated exactly if τ̂ is: div τ = A div τ̂,
//! and a traction is A τ̂ n̂ but for its length. So are fields without traction on a side. The reference triangle has its corners
//! on the unit circle about the centroid; its side 0, called the base, runs along ξ_1.
//!
//! Stresses on each subtriangle are written in orthonormal polynomials. What is wanted are null spaces, one inside the other:
//! without divergence, with continuous tractions on the inner segments, without traction on the base, without any traction.
//! They come from Householder factors, so every basis is orthonormal in L² and obeys its conditions to rounding.

use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector, DVectorView};

use super::polynomials::{self, Jet};
use crate::element::MAX_DEGREE;
use crate::element::lattice;
use crate::element::polynomial::quadrature::{segment_rule, triangle_rule};
use crate::element::polynomial::side;

/// Corners of the reference triangle.
const CORNERS: [[f64; 2]; 3] = [[0.0, 1.0], [-HALF_SIDE, -0.5], [HALF_SIDE, -0.5]];
/// Half the length of its sides, √3/2.
const HALF_SIDE: f64 = 0.866_025_403_784_438_6;

/// Ratio of τ_12 to its coefficient while null spaces are found: squares then add up to τ:τ.
const SHEAR: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Where a rule on a side, or a node, is in a subtriangle.
type Path = fn(f64) -> [f64; 3];
/// The side of a subtriangle that belongs to the triangle.
const OUTER: Path = |s| [1.0 - s, s, 0.0];
/// The inner segments, from the corners to the centroid: of the first corner of the subtriangle, and of the second.
const FROM_FIRST: Path = |s| [1.0 - s, 0.0, s];
const FROM_SECOND: Path = |s| [0.0, 1.0 - s, s];

/// A field of the basis, in arrays over subtriangles.
///
/// Components are (11, 22, 12), polynomials as in [`polynomials`], nodes as in
/// [`StressField::block`](crate::element::StressField::block).
pub struct Field {
    /// Coefficient m of component c on subtriangle i, at `(3i + c) modes + m`.
    pub coefficients: Vec<f64>,
    /// Node by node.
    pub nodal: Vec<[f64; 3]>,
    /// Bernstein coefficients of the traction, side by side.
    pub traction: Vec<[f64; 2]>,
}

/// Data shared by all split triangles of one degree.
pub struct Reference {
    /// Number of polynomials on a subtriangle.
    pub modes: usize,
    /// Fields without traction.
    pub free: Vec<Field>,
    /// Fields with traction but none on the base: a complement of the free ones and of τ̂_11 = 1.
    pub off_base: Vec<Field>,
    /// Points of a subtriangle that determine a polynomial of degree p.
    pub points: Vec<[f64; 3]>,
    /// Weight of the value at point q in coefficient m, at `q modes + m`.
    pub from_points: Vec<f64>,
    /// Nodes of a subtriangle.
    pub nodes: Vec<[f64; 3]>,
    /// Points of a side that determine a polynomial of degree p.
    pub side_points: Vec<f64>,
    /// Weight of the value at point q in Bernstein coefficient k, at `q (p + 1) + k`.
    pub from_side_points: Vec<f64>,
}

impl Reference {
    /// The reference of degree `p`, which is worked out once.
    pub fn of(p: usize) -> &'static Reference {
        static REFERENCES: [OnceLock<Reference>; MAX_DEGREE + 1] = [const { OnceLock::new() }; MAX_DEGREE + 1];
        REFERENCES[p].get_or_init(|| Reference::new(p))
    }

    fn new(p: usize) -> Reference {
        let modes = (p + 1) * (p + 2) / 2;
        let all = self_equilibrated(p);
        let (_, without_base) = null_space(&(boundary_traction(p, 0) * &all));
        let off_base = &all * without_base;
        let conditions =
            stacked(&[boundary_traction(p, 1), beyond_equilibrium(p) * boundary_traction(p, 2)]) * &off_base;
        let (with, without) = null_space(&conditions);
        let (free, with_traction) = (&off_base * without, &off_base * with);
        // τ̂_11 = 1 is one of them, and the element has the uniform pressure in its place.
        let along = DMatrix::from_fn(1, 9 * modes, |_, row| f64::from(row % (3 * modes) == 0));
        let (_, others) = null_space(&(along * &with_traction));
        let with_traction = with_traction * others;

        let rule = triangle_rule(2 * p);
        let nodes: Vec<[f64; 3]> = lattice(p).collect();
        let psi: Vec<Vec<f64>> = nodes.iter().map(|&l| polynomials::values(p, l)).collect();
        let tractions = [0, 1, 2].map(|i| boundary_traction(p, i));
        let from_legendre = from_legendre(p);
        let stresses = |column: &[f64]| -> Vec<f64> {
            column.iter().enumerate().map(|(i, c)| if i / modes % 3 == 2 { SHEAR * c } else { *c }).collect()
        };
        let fields = |basis: &DMatrix<f64>| -> Vec<Field> {
            let field = |column: DVectorView<'_, f64>| Field {
                coefficients: stresses(column.as_slice()),
                nodal: stresses(column.as_slice())
                    .chunks_exact(3 * modes)
                    .flat_map(|sub| psi.iter().map(|psi| at(sub, psi)))
                    .collect(),
                traction: tractions.iter().flat_map(|t| bernstein(&from_legendre, &(t * column))).collect(),
            };
            basis.column_iter().map(field).collect()
        };
        let mut off_base = fields(&with_traction);
        off_base.iter_mut().for_each(|field| field.traction[..=p].fill([0.0; 2]));
        let line = segment_rule(2 * p);
        Reference {
            modes,
            free: fields(&free),
            off_base,
            points: rule.iter().map(|(l, _)| *l).collect(),
            from_points: rule
                .iter()
                .flat_map(|&(l, w)| polynomials::values(p, l).into_iter().map(move |v| w * v))
                .collect(),
            nodes,
            side_points: line.iter().map(|(s, _)| *s).collect(),
            from_side_points: line
                .iter()
                .flat_map(|&(s, w)| {
                    let moments: Vec<f64> = (0..=p).map(|k| w * side::bernstein(p, k, s)).collect();
                    side::from_moments(&moments)
                })
                .collect(),
        }
    }
}

/// A stress on a subtriangle, from its coefficients and the values of the polynomials.
fn at(sub: &[f64], psi: &[f64]) -> [f64; 3] {
    let n = psi.len();
    [0, 1, 2].map(|c| sub[c * n..(c + 1) * n].iter().zip(psi).map(|(a, b)| a * b).sum())
}

/// An orthonormal basis of the row space of a matrix of full row rank, and one of its null space.
fn null_space(conditions: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let (rank, n) = conditions.shape();
    let mut square = DMatrix::zeros(n, n);
    square.columns_mut(0, rank).tr_copy_from(conditions);
    let q = square.qr().q();
    (q.columns(0, rank).into_owned(), q.columns(rank, n - rank).into_owned())
}

/// Matrices one below the other.
fn stacked(parts: &[DMatrix<f64>]) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(parts.iter().map(|m| m.nrows()).sum(), parts[0].ncols());
    let mut row = 0;
    for part in parts {
        out.rows_mut(row, part.nrows()).copy_from(part);
        row += part.nrows();
    }
    out
}

/// All self-equilibrated fields of degree p, column by column.
fn self_equilibrated(p: usize) -> DMatrix<f64> {
    let (_, first) = null_space(&divergence(p));
    let (rows, n) = first.shape();
    // The other subtriangles are the first one turned by a third and by two thirds.
    let mut parts = DMatrix::zeros(3 * rows, 3 * n);
    for sub in 0..3 {
        let turned = turned(&first, sub);
        parts.view_mut((sub * rows, sub * n), (rows, n)).copy_from(&turned);
    }
    let segments: Vec<DMatrix<f64>> = (0..3).map(|corner| continuity(p, corner)).collect();
    let (_, continuous) = null_space(&(stacked(&segments) * &parts));
    parts * continuous
}

/// Fields of a subtriangle turned by `thirds` of a full turn.
fn turned(fields: &DMatrix<f64>, thirds: usize) -> DMatrix<f64> {
    let (sin, cos) = [(0.0, 1.0), (HALF_SIDE, -0.5), (-HALF_SIDE, -0.5)][thirds];
    let n = fields.nrows() / 3;
    let mut out = fields.clone();
    for (mut to, from) in out.column_iter_mut().zip(fields.column_iter()) {
        for m in 0..n {
            let (xx, yy, xy) = (from[m], from[n + m], SHEAR * from[2 * n + m]);
            to[m] = cos * cos * xx - 2.0 * cos * sin * xy + sin * sin * yy;
            to[n + m] = sin * sin * xx + 2.0 * cos * sin * xy + cos * cos * yy;
            to[2 * n + m] = (cos * sin * (xx - yy) + (cos * cos - sin * sin) * xy) / SHEAR;
        }
    }
    out
}

/// The divergence on subtriangle 0, in orthonormal polynomials of degree p − 1.
fn divergence(p: usize) -> DMatrix<f64> {
    let (n, lower) = ((p + 1) * (p + 2) / 2, p * (p + 1) / 2);
    // Corners (a_1, a_2, 0); the height of the subtriangle is ½.
    let gradients = [[-0.5 / HALF_SIDE, -1.0], [0.5 / HALF_SIDE, -1.0], [0.0, 2.0]];
    let mut out = DMatrix::zeros(2 * lower, 3 * n);
    for &(l, w) in triangle_rule(2 * p) {
        let jets: [Jet; 3] = [0, 1, 2].map(|i| [l[i], gradients[i][0], gradients[i][1]]);
        let (psi, tests) = (polynomials::with_derivatives(p, jets), polynomials::values(p - 1, l));
        for (t, test) in tests.iter().enumerate() {
            for (m, [_, dx, dy]) in psi.iter().enumerate() {
                out[(t, m)] += w * test * dx;
                out[(t, 2 * n + m)] += SHEAR * w * test * dy;
                out[(lower + t, 2 * n + m)] += SHEAR * w * test * dx;
                out[(lower + t, n + m)] += w * test * dy;
            }
        }
    }
    out
}

/// ∫ √(2n + 1) P_n ψ_m ds along a path in a subtriangle, P_n being Legendre's polynomials on it.
fn trace(p: usize, path: Path) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(p + 1, (p + 1) * (p + 2) / 2);
    for &(s, w) in segment_rule(2 * p) {
        for (m, psi) in polynomials::values(p, path(s)).into_iter().enumerate() {
            for n in 0..=p {
                out[(n, m)] += w * psi * legendre(n, s);
            }
        }
    }
    out
}

/// √(2n + 1) P_n(s).
fn legendre(n: usize, s: f64) -> f64 {
    ((2 * n + 1) as f64).sqrt() * side::value(&side::legendre(n), s)
}

/// Adds ± the traction on a path with the given normal: p + 1 Legendre coefficients along x, then along y.
fn add_traction(out: &mut DMatrix<f64>, trace: &DMatrix<f64>, sub: usize, normal: [f64; 2]) {
    let (rows, n) = trace.shape();
    let [x, y] = normal;
    for (row, component, factor) in [(0, 0, x), (0, 2, SHEAR * y), (rows, 2, SHEAR * x), (rows, 1, y)] {
        let mut block = out.view_mut((row, (3 * sub + component) * n), (rows, n));
        block += trace * factor;
    }
}

/// The jump of the traction across the segment from the centroid to a corner.
fn continuity(p: usize, corner: usize) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(2 * (p + 1), 9 * (p + 1) * (p + 2) / 2);
    let [x, y] = CORNERS[corner];
    add_traction(&mut out, &trace(p, FROM_SECOND), (corner + 1) % 3, [y, -x]);
    add_traction(&mut out, &trace(p, FROM_FIRST), (corner + 2) % 3, [-y, x]);
    out
}

/// The traction on a side.
fn boundary_traction(p: usize, side: usize) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(2 * (p + 1), 9 * (p + 1) * (p + 2) / 2);
    // The outward normal points away from the corner opposite.
    add_traction(&mut out, &trace(p, OUTER), side, CORNERS[side].map(|x| -x));
    out
}

/// Rows that take from the Legendre coefficients of a traction on side 2 all but its force and moment.
///
/// Where two sides alone carry traction, force and moment on one follow from the other.
fn beyond_equilibrium(p: usize) -> DMatrix<f64> {
    let n = p + 1;
    let [x, y] = CORNERS[2].map(|x| -x);
    let mut out = DMatrix::zeros(2 * n - 3, 2 * n);
    // The linear part along the side has no moment.
    (out[(0, 1)], out[(0, n + 1)]) = (-y, x);
    for k in 2..n {
        out[(2 * k - 3, k)] = 1.0;
        out[(2 * k - 2, n + k)] = 1.0;
    }
    out
}

/// Weights of Legendre coefficients n in Bernstein coefficients k.
fn from_legendre(p: usize) -> DMatrix<f64> {
    let columns = (0..=p).map(|n| {
        let size = ((2 * n + 1) as f64).sqrt();
        DVector::from_vec(side::elevate(&side::legendre(n), p)) * size
    });
    DMatrix::from_columns(&columns.collect::<Vec<_>>())
}

/// Bernstein coefficients of a traction from those of Legendre.
fn bernstein(from_legendre: &DMatrix<f64>, traction: &DVector<f64>) -> Vec<[f64; 2]> {
    let n = from_legendre.nrows();
    let (x, y) = (from_legendre * traction.rows(0, n), from_legendre * traction.rows(n, n));
    x.iter().zip(y.iter()).map(|(x, y)| [*x, *y]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_counted_as_cubics_and_their_like() {
        for p in 1..=MAX_DEGREE {
            let k = p + 2;
            let reference = Reference::of(p);
            assert_eq!(self_equilibrated(p).ncols(), (3 * k * k - 3 * k) / 2, "C¹ on the split, less linear functions");
            assert_eq!(reference.free.len(), 3 * p * (p - 1) / 2);
            assert_eq!(reference.off_base.len(), 4 * p);
        }
    }

    #[test]
    fn fields_are_orthonormal_and_without_the_tractions_that_they_lack() {
        for p in [1, 2, 5, 8] {
            let reference = Reference::of(p);
            let fields: Vec<&Field> = reference.free.iter().chain(&reference.off_base).collect();
            for (i, a) in fields.iter().enumerate() {
                for (j, b) in fields.iter().enumerate() {
                    let pairs = a.coefficients.iter().zip(&b.coefficients).enumerate();
                    let product: f64 =
                        pairs.map(|(i, (a, b))| if i / reference.modes % 3 == 2 { 2.0 * a * b } else { a * b }).sum();
                    assert!((product - f64::from(i == j)).abs() < 1e-13, "degree {p}");
                }
            }
            let largest = |field: &Field| field.traction.as_flattened().iter().fold(0.0_f64, |m, t| m.max(t.abs()));
            assert!(reference.free.iter().all(|field| largest(field) < 1e-12), "degree {p}");
            assert!(reference.off_base.iter().all(|field| largest(field) > 0.1), "degree {p}");
        }
    }
}
