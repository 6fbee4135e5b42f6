//! The minimum of a small quadratic energy under linear inequalities.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::cholesky;

/// Pivots below this part of their diagonal entry are round-off: the patch can move as a whole.
const PIVOT: f64 = 1e-15;
/// Violations below this part of the largest are round-off.
const SETTLED: f64 = 1e-12;

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

/// The same with rows B and s ≥ 0 (so that x = 0 is allowed); Bx exceeds s by `slack` at most.
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
    let pressure = pressures(&(b * &moves), &over);
    // Kx, with the forces that hold the inequalities.
    let force = &f - b.tr_mul(&pressure);
    let mut x = force.clone();
    cholesky::solve(k, x.as_mut_slice());
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
            let inner = DMatrix::from_fn(active.len(), active.len(), |i, j| w[(active[i], active[j])]);
            let rhs = DVector::from_fn(active.len(), |i, _| r[active[i]]);
            let sound = |c: &Cholesky<f64, Dyn>| {
                c.l_dirty().diagonal().iter().zip(&active).all(|(l, i)| l * l > SETTLED * w[(*i, *i)])
            };
            let Some(z) = Cholesky::new(inner).filter(sound).map(|c| c.solve(&rhs)) else {
                barred[worst] = true;
                active.retain(|i| *i != worst);
                mu[worst] = 0.0;
                break;
            };
            // As far towards z as no pressure turns into tension.
            let reach = |(i, z): (&usize, &f64)| if *z > 0.0 { 1.0 } else { mu[*i] / (mu[*i] - z) };
            let part = active.iter().zip(z.iter()).map(reach).fold(1.0, f64::min);
            for (i, z) in active.iter().zip(z.iter()) {
                mu[*i] += part * (z - mu[*i]);
            }
            let all_pressed = z.iter().all(|z| *z > 0.0);
            if all_pressed {
                break;
            }
            let before = active.len();
            active.retain(|i| mu[*i] > 0.0);
            for i in (0..m).filter(|i| !active.contains(i)) {
                mu[i] = 0.0;
            }
            if active.len() == before || active.is_empty() {
                break;
            }
        }
    }
    mu
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
