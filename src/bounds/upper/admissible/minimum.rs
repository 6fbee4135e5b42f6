//! The minimum of a small quadratic energy under linear inequalities.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::bounds::upper::energy::cholesky;

/// Pivots below this part of their diagonal entry are round-off: the patch can move as a whole.
const PIVOT: f64 = 1e-15;
/// Violations below this part of the largest are round-off.
const SETTLED: f64 = 1e-12;
/// Refinements of a step on its bounds.
const REFINEMENTS: usize = 2;

/// A step towards the minimum of ½xᵀKx − fᵀx under Bx ≤ s.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// x.
    pub x: DVector<f64>,
    /// By how much the energy falls.
    pub gain: f64,
}

/// Factorises the packed K of a patch; `false` where the patch can move as a whole.
pub fn factorise(k: &mut [f64], n: usize) -> bool {
    cholesky::factorise(k, n, PIVOT)
}

/// The minimum over x of ½xᵀKx − fᵀx, with the factor of K. `None` where there is nothing to gain.
pub fn free_minimum(k: &[f64], f: &[f64]) -> Option<Step> {
    let f = DVector::from_column_slice(f);
    let mut x = f.clone();
    cholesky::solve(k, x.as_mut_slice());
    let gain = 0.5 * f.dot(&x);
    (gain > 0.0 && gain.is_finite()).then_some(Step { x, gain })
}

/// As [`free_minimum`], under Bx ≤ s with s ≥ 0 (so that x = 0 is allowed); Bx exceeds s by `slack` at most.
pub fn minimum(k: &[f64], f: &[f64], b: &DMatrix<f64>, s: &DVector<f64>, slack: f64) -> Option<Step> {
    let free = free_minimum(k, f)?;
    let over = b * &free.x - s;
    if over.iter().all(|v| *v <= slack) {
        return Some(free);
    }
    let f = DVector::from_column_slice(f);
    // K⁻¹Bᵀ
    let mut moves = b.transpose();
    for mut column in moves.column_iter_mut() {
        cholesky::solve(k, column.as_mut_slice());
    }
    let w = b * &moves;
    let pressure = pressures(&w, &over);
    // Kx, with the forces that hold the inequalities.
    let mut force = &f - b.tr_mul(&pressure);
    let mut x = force.clone();
    cholesky::solve(k, x.as_mut_slice());
    // Flat triangles make K⁻¹ large, and its rounding errors exceed bounds by more than slack. What they are exceeded by is
    // solved for with the same matrices.
    let tight: Vec<usize> = (0..s.len()).filter(|i| pressure[*i] > 0.0).collect();
    if let Some(factor) = Cholesky::new(among(&w, &tight)) {
        for _ in 0..REFINEMENTS {
            let left = b * &x - s;
            let change = factor.solve(&DVector::from_fn(tight.len(), |i, _| left[tight[i]]));
            for (row, change) in tight.iter().zip(change.iter()) {
                x.axpy(-change, &moves.column(*row), 1.0);
                force.axpy(-change, &b.row(*row).transpose(), 1.0);
            }
        }
    }
    // Round-off may leave a row above its bound: the energy falls all the way from 0 to x.
    let mut part = 1.0_f64;
    for (value, room) in (b * &x).iter().zip(s.iter()) {
        if *value > room + slack {
            part = part.min((room + slack) / value);
        }
    }
    let gain = part * (f.dot(&x) - 0.5 * part * x.dot(&force));
    (gain > 0.0 && gain.is_finite()).then(|| Step { x: part * x, gain })
}

/// Multipliers μ ≥ 0 of the inequalities: the minimum of ½μᵀWμ − rᵀμ with W = B K⁻¹ Bᵀ, by Lawson and Hanson's active
/// sets. Rows that depend on others already in force are left out.
fn pressures(w: &DMatrix<f64>, r: &DVector<f64>) -> DVector<f64> {
    let m = r.len();
    let scale = w.diagonal().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 });
    let settled = SETTLED * r.component_mul(&scale).amax();
    let mut mu = DVector::zeros(m);
    let (mut active, mut barred) = (Vec::<usize>::new(), vec![false; m]);
    for _ in 0..3 * m + 10 {
        let left = (r - w * &mu).component_mul(&scale);
        let worst = (0..m)
            .filter(|i| !barred[*i] && !active.contains(i) && left[*i] > settled)
            .max_by(|a, c| left[*a].total_cmp(&left[*c]));
        let Some(worst) = worst else { break };
        active.push(worst);
        loop {
            let rhs = DVector::from_fn(active.len(), |i, _| r[active[i]]);
            let sound = |c: &Cholesky<f64, Dyn>| {
                c.l_dirty().diagonal().iter().zip(&active).all(|(l, i)| l * l > SETTLED * w[(*i, *i)])
            };
            let Some(z) = Cholesky::new(among(w, &active)).filter(sound).map(|c| c.solve(&rhs)) else {
                barred[worst] = true;
                active.retain(|i| *i != worst);
                mu[worst] = 0.0;
                break;
            };
            // As far towards z as no pressure turns into tension.
            let reach = |(i, z): (&usize, &f64)| mu[*i] / (mu[*i] - z);
            let pulls = active.iter().zip(z.iter()).enumerate().filter(|(_, (_, z))| **z <= 0.0);
            let first = pulls.map(|(place, end)| (place, reach(end))).min_by(|a, b| a.1.total_cmp(&b.1));
            let part = first.map_or(1.0, |(_, part)| part);
            for (i, z) in active.iter().zip(z.iter()) {
                mu[*i] += part * (z - mu[*i]);
            }
            let Some((place, _)) = first else { break };
            // Rounding may leave some of a pressure that has come to its end.
            mu[active.remove(place)] = 0.0;
            active.retain(|i| mu[*i] > 0.0);
            for i in (0..m).filter(|i| !active.contains(i)) {
                mu[i] = 0.0;
            }
            if active.is_empty() {
                break;
            }
        }
    }
    mu
}

/// W between the rows `which`.
fn among(w: &DMatrix<f64>, which: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(which.len(), which.len(), |i, j| w[(which[i], which[j])])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The minimum with K as a matrix.
    fn minimum_of(k: &DMatrix<f64>, f: &DVector<f64>, b: &DMatrix<f64>, s: &DVector<f64>) -> Option<Step> {
        let n = k.nrows();
        let mut packed: Vec<f64> = (0..n).flat_map(|j| (j..n).map(move |i| k[(i, j)])).collect();
        factorise(&mut packed, n).then(|| minimum(&packed, f.as_slice(), b, s, 1e-15))?
    }

    /// Optimality (Karush, Kuhn and Tucker), checked on the step itself.
    fn is_minimum(k: &DMatrix<f64>, f: &DVector<f64>, b: &DMatrix<f64>, s: &DVector<f64>, x: &DVector<f64>) {
        let room = s - b * x;
        assert!(room.iter().all(|v| *v > -1e-12), "{room}");
        // f − Kx = Bᵀμ with μ ≥ 0 on rows without room: no allowed direction goes down.
        let left = f - k * x;
        let tight: Vec<usize> = (0..s.len()).filter(|i| room[*i] < 1e-12).collect();
        let rows = DMatrix::from_fn(tight.len(), x.len(), |i, j| b[(tight[i], j)]);
        if tight.is_empty() {
            assert!(left.amax() < 1e-12);
            return;
        }
        let mu = (&rows * rows.transpose()).lu().solve(&(&rows * &left)).expect("independent rows");
        assert!(mu.iter().all(|v| *v > -1e-12), "{mu}");
        assert!((rows.tr_mul(&mu) - left).amax() < 1e-12);
    }

    #[test]
    fn the_step_is_the_minimum() {
        let k = DMatrix::from_row_slice(3, 3, &[4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0]);
        let b = DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 0.0, -0.5, 2.0, 0.0, 0.0, 1.0, -1.0]);
        let s = DVector::from_row_slice(&[0.1, 0.0, 0.3]);
        for f in [[1.0, 0.2, -2.0], [-1.0, -1.0, -1.0], [3.0, 3.0, 3.0], [0.0, 2.0, -3.0]] {
            let f = DVector::from_row_slice(&f);
            let step = minimum_of(&k, &f, &b, &s).expect("a minimum");
            is_minimum(&k, &f, &b, &s, &step.x);
            assert!((step.gain - (f.dot(&step.x) - 0.5 * step.x.dot(&(&k * &step.x)))).abs() < 1e-13);
        }
    }

    #[test]
    fn a_step_keeps_a_bound_that_rounding_of_a_soft_motion_exceeds() {
        // Both unknowns together move 10⁻¹¹ times as stiffly as one against the other.
        let k = DMatrix::from_row_slice(2, 2, &[1.0, 1e-11 - 1.0, 1e-11 - 1.0, 1.0]);
        let (b, s) = (DMatrix::from_row_slice(1, 2, &[1.0, -0.5]), DVector::zeros(1));
        let (f, along) = (DVector::from_row_slice(&[0.3, 0.2]), DVector::from_row_slice(&[0.5, 1.0]));
        let step = minimum_of(&k, &f, &b, &s).expect("a minimum");
        let expected = f.dot(&along).powi(2) / (2.0 * along.dot(&(&k * &along)));
        assert!((step.gain - expected).abs() < 1e-6 * expected, "{} {expected}", step.gain);
        assert!((&b * &step.x)[0] < 1e-14, "{}", step.x);
    }

    #[test]
    fn a_pressure_that_ends_in_rounding_leaves_its_place() {
        // Of two bodies with a curve between them: the second row comes in first, and carries nothing in the end.
        let rows = [
            [7.581210278074675, 2.73750236210681, 0.1130167979052138],
            [2.73750236210681, 2.5595470247612835, 1.6444048353465532],
            [0.1130167979052138, 1.6444048353465532, 1.6570351948037156],
        ];
        let w = DMatrix::from_fn(3, 3, |i, j| rows[i][j]);
        for r in [
            [0.05867293856090968, 0.043984196566440724, 0.030020454321634443],
            [0.05432566834445033, 0.04046646312356115, 0.027639128562525463],
        ] {
            let r = DVector::from_row_slice(&r);
            let left = &r - &w * pressures(&w, &r);
            assert!(left.max() < 1e-12, "{left}");
        }
    }

    #[test]
    fn rows_may_be_given_twice() {
        let k = DMatrix::identity(2, 2);
        let b = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 1.0, 0.0]);
        let step = minimum_of(&k, &DVector::from_row_slice(&[2.0, 1.0]), &b, &DVector::from_row_slice(&[0.5, 0.5]));
        let x = step.expect("a minimum").x;
        assert!((x[0] - 0.5).abs() < 1e-14 && (x[1] - 1.0).abs() < 1e-14, "{x}");
    }

    #[test]
    fn what_can_move_as_a_whole_has_no_minimum() {
        let k = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
        let none = DMatrix::zeros(0, 2);
        assert_eq!(minimum_of(&k, &DVector::from_row_slice(&[1.0, -1.0]), &none, &DVector::zeros(0)), None);
    }
}
