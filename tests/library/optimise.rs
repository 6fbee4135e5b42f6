//! Quadratic programs with every law of the interface table: optimality by Fenchel's gap, the interior point alone and with active
//! sets, dense and sparse, and against the conic solver.

use std::sync::Arc;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SupportedConeT};
use faer::Mat;
use hypercircle::optimise::{self, Law, Program, Quadratic, Solution, SparseForm, State, Structure};

/// Numbers in (−1, 1) from a linear congruence.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn positive(&mut self) -> f64 {
        self.next().abs() + 1e-3
    }

    fn law(&mut self) -> Law {
        match ((self.next() + 1.0) * 3.5) as usize {
            0 => Law::Free,
            1 => Law::AtMost { bound: self.next() },
            2 => Law::AtMost { bound: f64::INFINITY },
            3 => Law::Between { lower: -self.positive(), upper: self.next().abs() },
            4 => Law::Spring { stiffness: self.positive() },
            5 => Law::Elastic { gap: self.next(), stiffness: 10.0 * self.positive() },
            _ => Law::Friction { threshold: self.next().abs(), centre: self.next() },
        }
    }

    /// A Aᵀ with A of `rank` columns.
    fn gram(&mut self, m: usize, rank: usize) -> Mat<f64> {
        let a = Mat::from_fn(m, rank, |_, _| self.next());
        &a * a.transpose()
    }
}

/// A load for which a minimum exists: b = Ax + q with q ∈ ∂φ(x).
fn planted(random: &mut Random, a: &dyn Quadratic, laws: &[Law]) -> Vec<f64> {
    let mut x = Vec::new();
    let mut q = Vec::new();
    for law in laws {
        let (free, force) = (random.next(), random.positive());
        let at_kink = random.next() > 0.0;
        let (own, of) = match *law {
            Law::AtMost { bound } if at_kink && bound.is_finite() => (bound, force),
            Law::AtMost { bound } => (free.min(bound - 0.1), 0.0),
            Law::Between { lower, .. } if at_kink => (lower, -force),
            Law::Between { lower, upper } => (0.5 * (lower + upper), 0.0),
            Law::Spring { stiffness } => (free, stiffness * free),
            Law::Elastic { gap, stiffness } => (free, stiffness * (free - gap).max(0.0)),
            Law::Friction { threshold, centre } if at_kink => (centre, threshold * free),
            Law::Friction { threshold, centre } => (centre + free, threshold.copysign(free)),
            Law::Free => (free, 0.0),
        };
        x.push(own);
        q.push(of);
    }
    a.apply(&x).iter().zip(&q).map(|(a, q)| a + q).collect()
}

/// By how much values and forces miss their laws: what must be changed of them, and φ(x) + φ*(q) − xq after that.
fn miss(law: Law, x: f64, q: f64) -> f64 {
    let (near, force) = match law {
        Law::Free => (x, 0.0),
        Law::AtMost { bound } => (x.min(bound), q.max(0.0)),
        Law::Between { lower, upper } => (x.clamp(lower, upper), q),
        Law::Spring { .. } => (x, q),
        Law::Elastic { .. } => (x, q.max(0.0)),
        Law::Friction { threshold, .. } => (x, q.clamp(-threshold, threshold)),
    };
    // An unknown that is not bounded carries no force.
    let force = if law == (Law::AtMost { bound: f64::INFINITY }) { 0.0 } else { force };
    let gap = law.value(near) + law.conjugate(force) - near * force;
    (near - x).abs().max((force - q).abs()).max(gap.abs())
}

fn worst(program: &Program<'_>, x: &[f64]) -> f64 {
    let tension = program.form.gradient(program.load, x);
    let all = program.laws.iter().zip(x).zip(&tension);
    all.fold(0.0, |m, ((law, x), t)| m.max(miss(*law, *x, -t)))
}

fn energy(program: &Program<'_>, x: &[f64]) -> f64 {
    let product = program.form.apply(x);
    (0..x.len()).map(|i| x[i] * (0.5 * product[i] - program.load[i])).sum()
}

#[test]
fn every_law_is_met_at_the_minimum_whatever_the_rank() {
    let mut random = Random(11);
    let mut without = 0;
    for trial in 0..600 {
        let m = 2 + trial % 13;
        let a = random.gram(m, [m, m.div_ceil(2), 1][trial % 3]);
        let laws: Vec<Law> = (0..m).map(|_| random.law()).collect();
        let load = planted(&mut random, &a, &laws);
        let program = Program { form: &a, load: &load, laws: &laws };
        let inner = optimise::interior_point(&program, 1e-12).unwrap_or_else(|| panic!("trial {trial}: {laws:?}"));
        assert!(worst(&program, &inner.x) < 1e-4, "trial {trial}: {:e} {laws:?}", worst(&program, &inner.x));
        let found = optimise::solve(&program, None).unwrap_or_else(|| panic!("trial {trial}: {laws:?}"));
        let left = worst(&program, &found.x);
        assert!(left < if found.settled { 1e-8 } else { 1e-4 }, "trial {trial}: {left:e} {laws:?}");
        without += usize::from(!found.settled);
    }
    assert!(without < 60, "{without} of 600 have not settled");
}

#[test]
fn the_energy_is_that_of_the_conic_solver() {
    let mut random = Random(5);
    for trial in 0..40 {
        let m = 30;
        let a = random.gram(m, [30, 20][trial % 2]);
        let laws: Vec<Law> = (0..m).map(|_| Law::AtMost { bound: 0.1 + random.next().abs() }).collect();
        let load = planted(&mut random, &a, &laws);
        let program = Program { form: &a, load: &load, laws: &laws };
        let found = optimise::solve(&program, None).expect("a minimum");
        let upper: Vec<Vec<f64>> = (0..m).map(|k| (0..=k).map(|i| a[(i, k)]).collect()).collect();
        let starts = upper.iter().scan(0, |sum, c| {
            *sum += c.len();
            Some(*sum)
        });
        let starts: Vec<usize> = std::iter::once(0).chain(starts).collect();
        let rows: Vec<usize> = (0..m).flat_map(|k| 0..=k).collect();
        let p = CscMatrix::new(m, m, starts, rows, upper.concat());
        let q: Vec<f64> = load.iter().map(|b| -b).collect();
        let bound: Vec<f64> = laws.iter().map(|law| law.extent()).collect();
        let settings =
            DefaultSettings { verbose: false, tol_gap_rel: 1e-11, tol_gap_abs: 1e-11, ..DefaultSettings::default() };
        let cones = [SupportedConeT::NonnegativeConeT(m)];
        let mut solver =
            DefaultSolver::new(&p, &q, &CscMatrix::identity(m), &bound, &cones, settings).expect("a program");
        solver.solve();
        let (own, conic) = (energy(&program, &found.x), solver.solution.obj_val);
        assert!((own - conic).abs() < 1e-8 * conic.abs().max(1.0), "trial {trial}: {own} {conic}");
    }
}

#[test]
fn a_sparse_matrix_gives_what_the_dense_one_does() {
    let mut random = Random(3);
    for _ in 0..30 {
        let n = 24;
        let cliques: Vec<Vec<usize>> = (0..6).map(|c| (3 * c..(3 * c + 9).min(n)).collect()).collect();
        let structure = Arc::new(Structure::of_cliques(n, &cliques).expect("room"));
        let mut dense = Mat::zeros(n, n);
        for clique in &cliques {
            let own = random.gram(clique.len(), clique.len() - 1);
            for (i, &row) in clique.iter().enumerate() {
                for (k, &column) in clique.iter().enumerate() {
                    dense[(row, column)] += own[(i, k)];
                }
            }
        }
        let mut values = vec![0.0; structure.entries()];
        for k in 0..n {
            let (start, rows) = structure.column(k);
            rows.iter().enumerate().for_each(|(at, row)| values[start + at] = dense[(*row, k)]);
        }
        let sparse = SparseForm::new(structure, values);
        let laws: Vec<Law> = (0..n).map(|_| random.law()).collect();
        let load = planted(&mut random, &dense, &laws);
        let [one, other] = [&dense as &dyn Quadratic, &sparse]
            .map(|form| optimise::solve(&Program { form, load: &load, laws: &laws }, None).expect("a minimum"));
        let program = Program { form: &dense, load: &load, laws: &laws };
        assert!((energy(&program, &one.x) - energy(&program, &other.x)).abs() < 1e-7);
        assert!(worst(&program, &other.x) < 1e-4);
    }
}

#[test]
fn a_load_that_nothing_balances_has_no_minimum() {
    let a = Mat::from_fn(2, 2, |i, k| if i == k { 1.0 } else { -1.0 });
    let laws = [Law::AtMost { bound: 0.0 }, Law::AtMost { bound: 0.0 }];
    let found = optimise::solve(&Program { form: &a, load: &[-1.0, -1.0], laws: &laws }, None);
    assert!(found.is_none_or(|found| !found.settled), "both fall away for ever");
}

#[test]
fn what_is_loose_stays_away_from_its_bounds() {
    // Two pieces between walls, of which one is pressed: the other touches nothing.
    let a = Mat::from_fn(4, 4, |i, k| match (i / 2 == k / 2, i == k) {
        (true, true) => 1.0,
        (true, false) => -1.0,
        _ => 0.0,
    });
    let laws = [Law::AtMost { bound: 0.0 }; 4];
    let program = Program { form: &a, load: &[1.0, 0.5, 0.0, 0.0], laws: &laws };
    let Solution { x, states, .. } = optimise::interior_point(&program, 1e-12).expect("a minimum");
    assert_eq!(states, [State::Held, State::Held, State::Below, State::Below]);
    assert!(x[2] < -1e-3 && x[3] < -1e-3, "{x:?}");
}
