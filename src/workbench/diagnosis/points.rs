//! Mistakes at quadrature points: K = Σ wᵢ Kᵢ with weights that are not the right ones.

use nalgebra::DMatrix;

use super::{Reference, Trial, fit};
use crate::report::text::number::significant;
use crate::workbench::formulas::{Family, Point, Variant};

/// How far a fitted weight may be from the one a mistake makes, where K has all its digits.
const NEAR: f64 = 1e-4;
/// Upper limit of this distance, where K has few digits.
const NEAR_AT_MOST: f64 = 0.02;

/// One point, det J, weights, shear at fewer points.
pub(super) fn trials(k: &DMatrix<f64>, precision: f64, r: &Reference) -> Vec<Trial> {
    if !r.is_isoparametric() {
        return Vec::new();
    }
    let mut all = variants(r);
    let mut rules = vec![r.points()];
    if r.family == Family::P2 {
        rules.extend(r.family.points(&r.nodes, Variant::Inner).ok());
    }
    for points in rules {
        let each: Vec<DMatrix<f64>> = points.iter().map(|p| r.placed(&p.stiffness(&r.hooke))).collect();
        all.extend(measures(&points, &each));
        let near = (30.0 * precision).clamp(NEAR, NEAR_AT_MOST);
        all.extend(fitted(k, r, &points, &each, near));
    }
    all.extend(shear(r));
    all
}

/// Σ wᵢ Kᵢ.
fn sum(each: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
    each.iter().zip(weights).map(|(k, w)| k * *w).sum()
}

/// Quadrature and Jacobian.
fn variants(r: &Reference) -> Vec<Trial> {
    let of = |(rank, cause, variant, sentence): (usize, &'static str, Variant, &str)| {
        let matrix = r.variant(&r.hooke, variant).ok()?;
        Some(Trial { rank, cause, sentence: sentence.into(), matrix })
    };
    let list = [
        (1, "one-point-quadrature", Variant::OnePoint, "K is integrated with one point in the middle"),
        (
            1,
            "transposed-jacobian",
            Variant::Transposed,
            "the Jacobian stands where its transpose belongs: gradients are J⁻¹∇N in place of J⁻ᵀ∇N",
        ),
    ];
    let reduced =
        (1, "reduced-quadrature", Variant::Points(2), "K is integrated with 2 × 2 points, and bends have no energy");
    list.into_iter().chain((r.family == Family::Q9).then_some(reduced)).filter_map(of).collect()
}

/// det J omitted, squared, of the middle. Where it is the same at all points, these are factors.
fn measures(points: &[Point], each: &[DMatrix<f64>]) -> Vec<Trial> {
    // On [−1, 1]², as most programs have it.
    let dets: Vec<f64> = points.iter().map(|p| 0.25 * p.det).collect();
    let Some(first) = dets.first() else { return Vec::new() };
    if dets.iter().all(|d| (d / first - 1.0).abs() <= NEAR) {
        return Vec::new();
    }
    let mean = points.iter().map(|p| p.weight * p.det).sum::<f64>() / points.iter().map(|p| p.weight).sum::<f64>();
    let list: [(_, _, &dyn Fn(f64) -> f64); 3] = [
        ("det-omitted", "det J is missing in the quadrature", &|d| 1.0 / d),
        ("det-squared", "det J is squared in the quadrature", &|d| d),
        ("det-of-centre", "det J is taken in the middle for all quadrature points", &|d| 0.25 * mean / d),
    ];
    let of = |(cause, text, factor): (&'static str, &str, &dyn Fn(f64) -> f64)| {
        let weights: Vec<f64> = dets.iter().map(|d| factor(*d)).collect();
        Trial { rank: 2, cause, sentence: text.into(), matrix: sum(each, &weights) }
    };
    list.map(of).into()
}

/// Fits the weights of the points, relative to the right ones, and names what they show.
fn fitted(k: &DMatrix<f64>, r: &Reference, points: &[Point], each: &[DMatrix<f64>], near: f64) -> Option<Trial> {
    // The contributions of more points to the few entries of Q4 explain too much.
    let most = if matches!(r.family, Family::Q8 | Family::Q9) { 9 } else { 4 };
    if each.len() < 2 || each.len() > most {
        return None;
    }
    let w = fit::nearest(k, each);
    let one = |value: f64| {
        let at = w.iter().position(|x| (x - value).abs() < near)?;
        w.iter().enumerate().all(|(i, x)| i == at || (x - 1.0).abs() < near).then_some(at)
    };
    let is_quad = r.family.corners() == 4;
    let place = |i: usize| {
        let [x, y] = points[i].at.map(|x| significant(if is_quad { 2.0 * x - 1.0 } else { x }, 4));
        format!("({x}, {y})")
    };
    let axes = format!("(ξ, η), ξ from node {} to node {}", r.order[0], r.order[1]);
    let round = |w: f64| format!("{}", (w * 1e4).round() / 1e4 + 0.0);
    let (rank, cause, sentence) = if let Some(i) = one(0.0) {
        (3, "lost-point", format!("the quadrature point at {} = {axes} is lost", place(i)))
    } else if let Some(i) = one(-1.0) {
        (3, "det-sign", format!("det J or its weight has the wrong sign at {} = {axes}", place(i)))
    } else {
        let list: Vec<String> = w.iter().enumerate().map(|(i, w)| format!("{} at {}", round(*w), place(i))).collect();
        let list = list.join(", ");
        (8, "weights", format!("the quadrature weights are wrong, these times the right ones: {list} = {axes}"))
    };
    Some(Trial { rank, cause, sentence, matrix: sum(each, &w) })
}

/// Shear by fewer points, the rest at all.
fn shear(r: &Reference) -> Vec<Trial> {
    let (mut normal, mut shear) = (r.hooke, r.hooke * 0.0);
    normal[(2, 2)] = 0.0;
    shear[(2, 2)] = r.hooke[(2, 2)];
    let mut list = vec![(Variant::OnePoint, "one point in the middle")];
    if matches!(r.family, Family::Q8 | Family::Q9) {
        list.push((Variant::Points(2), "2 × 2 points"));
    }
    let of = |(variant, words): (Variant, &str)| {
        let (a, b) = (r.variant(&normal, Variant::Right).ok()?, r.variant(&shear, variant).ok()?);
        let sentence = format!("shear is integrated with {words}, the rest with all");
        Some(Trial { rank: 2, cause: "reduced-shear", sentence, matrix: a + b })
    };
    list.into_iter().filter_map(of).collect()
}
