//! Mistakes at quadrature points: K = Σ wᵢ Kᵢ with weights that are not the right ones.

use nalgebra::DMatrix;

use super::{Reference, Trial};
use crate::report::number::significant;

/// Points whose weights are fitted: more of them explain too much of a matrix of a quadrilateral.
const MOST_POINTS: usize = 4;
/// How far a fitted weight may be from the one a mistake makes.
const NEAR: f64 = 1e-4;

/// Fits the weights of the points, relative to the right ones, and names what they show.
pub(super) fn trials(k: &DMatrix<f64>, r: &Reference) -> Vec<Trial> {
    let Some(points) = r.points() else { return Vec::new() };
    let contribution = |p: &super::Point| r.placed(&p.stiffness(&r.hooke));
    let each: Vec<DMatrix<f64>> = points.iter().map(contribution).collect();
    let dets: Vec<f64> = points.iter().map(|p| p.det).collect();
    let sum = |w: &[f64]| each.iter().zip(w).fold(k * 0.0, |sum, (k, w)| sum + k * *w);
    let mut all = Vec::new();
    let mut push = |rank, cause, sentence: &str, matrix| {
        all.push(Trial { rank, cause, sentence: sentence.into(), matrix });
    };
    let varies = dets.iter().any(|d| (d / dets[0] - 1.0).abs() > NEAR);
    if varies {
        let w: Vec<f64> = dets.iter().map(|d| 1.0 / d).collect();
        push(2, "det-omitted", "det J is missing in the quadrature", sum(&w));
        push(2, "det-squared", "det J is squared in the quadrature", sum(&dets));
        let mean = dets.iter().sum::<f64>() / dets.len() as f64;
        let w: Vec<f64> = dets.iter().map(|d| mean / d).collect();
        push(2, "det-of-centre", "det J is taken in the middle for all quadrature points", sum(&w));
    }
    let system = DMatrix::from_fn(k.len(), each.len(), |row, c| each[c][row]);
    let given = DMatrix::from_column_slice(k.len(), 1, k.as_slice());
    let fitted = (each.len() <= MOST_POINTS).then(|| system.svd(true, true).solve(&given, 1e-12));
    if let Some(Ok(found)) = fitted {
        let w: Vec<f64> = found.iter().copied().collect();
        let one = |value: f64| {
            let at = w.iter().position(|x| (x - value).abs() < NEAR)?;
            w.iter().enumerate().all(|(i, x)| i == at || (x - 1.0).abs() < NEAR).then_some(at)
        };
        let place = |i: usize| {
            let [x, y] = points[i].at;
            format!("({}, {})", significant(x, 4), significant(y, 4))
        };
        if let Some(i) = one(0.0) {
            push(3, "lost-point", &format!("the quadrature point at {} is lost", place(i)), sum(&w));
        } else if let Some(i) = one(-1.0) {
            push(3, "det-sign", &format!("det J or its weight has the wrong sign at {}", place(i)), sum(&w));
        } else {
            let list: Vec<String> =
                w.iter().enumerate().map(|(i, w)| format!("{} at {}", significant(*w, 4), place(i))).collect();
            let text = format!("the quadrature weights are wrong, these times the right ones: {}", list.join(", "));
            push(8, "weights", &text, sum(&w));
        }
    }
    // Shear at the middle alone, the rest at all points.
    let (mut normal, mut shear) = (r.hooke, r.hooke * 0.0);
    normal[(2, 2)] = 0.0;
    shear[(2, 2)] = r.hooke[(2, 2)];
    let one = r.variant(&shear, crate::workbench::formulas::Variant::OnePoint);
    if let (Ok(a), Ok(b)) = (r.variant(&normal, crate::workbench::formulas::Variant::Right), one) {
        push(2, "reduced-shear", "shear is integrated with one point in the middle, the rest with all", a + b);
    }
    all
}
