//! Q4 with more than its shape functions: incompatible modes, and the stresses of Pian and Sumihara.

use nalgebra::{DMatrix, Matrix3};

use super::{Point, det, gradient, strains};

/// How the gradients of incompatible modes are made to integrate to zero, which the patch test needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Correction {
    /// J and det J of the middle, times det J₀ / det J (Taylor, Beresford and Wilson 1976).
    Taylor,
    /// Their mean is subtracted (Ibrahimbegovic and Wilson 1991).
    Mean,
    /// Not at all: Wilson's element of 1973, wrong on all shapes but parallelograms.
    None,
    /// J of the middle without the factor det J₀ / det J.
    WithoutRatio,
    /// The factor det J₀ / det J without J of the middle.
    RatioOnly,
}

/// Gradients of 1 − ξ² and 1 − η², up to a factor that condensation removes.
fn modes(p: &Point, middle: &Point, correction: Correction) -> DMatrix<f64> {
    let jacobian = match correction {
        Correction::Taylor | Correction::WithoutRatio => &middle.jacobian,
        _ => &p.jacobian,
    };
    let ratio = match correction {
        Correction::Taylor | Correction::RatioOnly => det(&middle.jacobian) / det(&p.jacobian),
        _ => 1.0,
    };
    let local = [[1.0 - 2.0 * p.at[0], 0.0], [0.0, 1.0 - 2.0 * p.at[1]]];
    strains(&local.map(|g| gradient(jacobian, &g))) * ratio
}

/// K with the incompatible modes condensed.
///
/// # Errors
/// The modes store no energy.
pub fn incompatible(
    points: &[Point],
    middle: &Point,
    d: &Matrix3<f64>,
    correction: Correction,
) -> Result<DMatrix<f64>, String> {
    let measure = |p: &Point| p.weight * p.det;
    let mut own: Vec<DMatrix<f64>> = points.iter().map(|p| modes(p, middle, correction)).collect();
    if correction == Correction::Mean {
        let area: f64 = points.iter().map(measure).sum();
        let mean: DMatrix<f64> = points.iter().zip(&own).map(|(p, b)| b * (measure(p) / area)).sum();
        own.iter_mut().for_each(|b| *b -= &mean);
    }
    let n = 2 * middle.gradients.len();
    let (mut uu, mut ua, mut aa) = (DMatrix::zeros(n, n), DMatrix::zeros(n, 4), DMatrix::zeros(4, 4));
    for (p, own) in points.iter().zip(&own) {
        let (b, w) = (strains(&p.gradients), measure(p));
        uu += b.transpose() * d * &b * w;
        ua += b.transpose() * d * own * w;
        aa += own.transpose() * d * own * w;
    }
    let inner = aa.lu().solve(&ua.transpose()).ok_or("incompatible modes store no energy")?;
    Ok(uu - ua * inner)
}

/// K of Pian and Sumihara (1984): stresses constant, and linear along each local direction on axes of the middle.
///
/// # Errors
/// The material has no inverse.
pub fn hybrid(points: &[Point], middle: &Point, d: &Matrix3<f64>) -> Result<DMatrix<f64>, String> {
    let compliance = d.try_inverse().ok_or("Hooke's law has no inverse")?;
    let [[a, c], [b, e]] = middle.jacobian;
    let n = 2 * middle.gradients.len();
    let (mut h, mut l) = (DMatrix::zeros(5, 5), DMatrix::zeros(5, n));
    for p in points {
        let (xi, eta, w) = (2.0 * p.at[0] - 1.0, 2.0 * p.at[1] - 1.0, p.weight * p.det);
        let stresses = DMatrix::from_row_slice(
            3,
            5,
            &[
                1.0,
                0.0,
                0.0,
                a * a * eta,
                c * c * xi,
                0.0,
                1.0,
                0.0,
                b * b * eta,
                e * e * xi,
                0.0,
                0.0,
                1.0,
                a * b * eta,
                c * e * xi,
            ],
        );
        h += stresses.transpose() * compliance * &stresses * w;
        l += stresses.transpose() * strains(&p.gradients) * w;
    }
    let inner = h.lu().solve(&l).ok_or("the stresses are not independent")?;
    Ok(l.transpose() * inner)
}
