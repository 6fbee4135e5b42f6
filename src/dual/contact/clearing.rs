//! S cleared of what rounding has left of the motions that it does not resist.

use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, MatRef, Par};

/// Remainders of a vector beside others are round-off below this part of its length.
const DEPENDENT: f64 = 1e-10;

/// (I − QQᵀ) S (I − QQᵀ) with an orthonormal basis Q of what the `motions` span; nothing where they all vanish.
pub fn cleared(s: &Mat<f64>, motions: impl Iterator<Item = Vec<f64>>) -> Option<Mat<f64>> {
    let unit: Vec<Vec<f64>> = motions.filter_map(of_length_one).collect();
    let m = s.nrows();
    if unit.is_empty() {
        return None;
    }
    let q = basis(&Mat::from_fn(m, unit.len(), |i, k| unit[k][i])).unwrap_or_else(|| {
        let independent = orthonormal(unit);
        Mat::from_fn(m, independent.len(), |i, k| independent[k][i])
    });
    Some(without(s, q.as_ref()))
}

fn of_length_one(mut v: Vec<f64>) -> Option<Vec<f64>> {
    let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    v.iter_mut().for_each(|v| *v /= length);
    (length > 0.0).then_some(v)
}

/// An orthonormal basis of the columns, where none depends on those before it.
fn basis(columns: &Mat<f64>) -> Option<Mat<f64>> {
    let rank = columns.ncols();
    if rank > columns.nrows() {
        return None;
    }
    let qr = columns.qr();
    let r = qr.thin_R();
    (0..rank).all(|k| r[(k, k)].abs() > DEPENDENT).then(|| qr.compute_thin_Q())
}

/// An orthonormal basis of what vectors of length one span, one by one.
fn orthonormal(vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut v in vectors {
        // Twice is enough.
        for q in basis.iter().chain(&basis) {
            let part = dot(q, &v);
            v.iter_mut().zip(q).for_each(|(v, q)| *v -= part * q);
        }
        let left = dot(&v, &v).sqrt();
        if left > DEPENDENT {
            v.iter_mut().for_each(|v| *v /= left);
            basis.push(v);
        }
    }
    basis
}

/// S − QWᵀ − WQᵀ for W = SQ − ½ Q(QᵀSQ): the same as (I − QQᵀ) S (I − QQᵀ).
fn without(s: &Mat<f64>, q: MatRef<'_, f64>) -> Mat<f64> {
    let mut w = s * q;
    let both = q.transpose() * &w;
    matmul(&mut w, Accum::Add, q, &both, -0.5, Par::Seq);
    let mut out = s.clone();
    for [a, b] in [[q, w.as_ref()], [w.as_ref(), q]] {
        triangular::matmul(
            &mut out,
            BlockStructure::TriangularLower,
            Accum::Add,
            a,
            BlockStructure::Rectangular,
            b.transpose(),
            BlockStructure::Rectangular,
            -1.0,
            Par::Seq,
        );
    }
    for k in 0..out.ncols() {
        for i in k + 1..out.nrows() {
            out[(k, i)] = out[(i, k)];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_meet_no_resistance_and_what_is_at_right_angles_to_them_the_same() {
        let entry = |i: usize, k: usize| ((3 * i + 5 * k + i * k) as f64).sin();
        let s = Mat::from_fn(7, 7, |i, k| (0..7).map(|j| entry(i, j) * entry(k, j)).sum());
        let [a, b] = [1, 2].map(|seed| (0..7).map(|i| entry(seed, i)).collect::<Vec<f64>>());
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - 2.0 * b).collect();
        for motions in [vec![a.clone(), b.clone()], vec![vec![0.0; 7], a.clone(), sum.clone(), b.clone(), sum]] {
            let cleared = cleared(&s, motions.iter().cloned()).expect("motions");
            let times = |m: &Mat<f64>, v: &[f64]| -> Vec<f64> {
                (0..7).map(|i| (0..7).map(|k| m[(i, k)] * v[k]).sum()).collect()
            };
            for v in motions {
                assert!(times(&cleared, &v).iter().all(|t| t.abs() < 1e-12));
            }
            // What lies at right angles to both: of a vector without its parts along them.
            let basis = orthonormal([a.clone(), b.clone()].into_iter().filter_map(of_length_one).collect());
            let projected = |v: Vec<f64>| {
                basis.iter().fold(v, |v, q| {
                    let part: f64 = v.iter().zip(q).map(|(v, q)| v * q).sum();
                    v.iter().zip(q).map(|(v, q)| v - part * q).collect()
                })
            };
            let v = projected((0..7).map(|i| entry(4, i)).collect());
            let [full, own] = [times(&s, &v), times(&cleared, &v)];
            assert!(projected(full).iter().zip(&own).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
