//! The bound-constrained problem on Γ_K against enumeration of all contact states and against projected Gauss–Seidel.

use crate::setup::{Role, Setup, lift_off, two_blocks};
use faer::Mat;
use hypercircle::dual::{self, Condensed, DualMethod, DualSolution, Motion, Options, qp};
use hypercircle::problem::Problem;
use hypercircle::statics;

/// Numbers in (−1, 1) from a linear congruence.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, m: usize) -> Vec<f64> {
        (0..m).map(|_| self.next()).collect()
    }

    /// A Aᵀ with A of `rank` columns, plus `shift` on the diagonal.
    fn gram(&mut self, m: usize, rank: usize, shift: f64) -> Mat<f64> {
        let a = Mat::from_fn(m, rank, |_, _| self.next());
        let mut s = &a * a.transpose();
        for i in 0..m {
            s[(i, i)] += shift;
        }
        s
    }
}

fn energy(s: &Mat<f64>, c: &[f64], j: &[f64]) -> f64 {
    let tension = qp::gradient(s, c, j);
    j.iter().zip(&tension).zip(c).map(|((j, t), c)| 0.5 * j * (t - c)).sum()
}

/// Violation of j ≤ g, T ≤ 0, T (g − j) = 0, relative to `c`.
fn violation(s: &Mat<f64>, c: &[f64], g: &[f64], j: &[f64]) -> f64 {
    let scale = c.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
    let tension = qp::gradient(s, c, j);
    (0..c.len())
        .map(|i| {
            let open = g[i] - j[i];
            let pressing = -tension[i] / scale;
            (-open).max(-pressing).max(open.min(pressing).abs())
        })
        .fold(0.0, f64::max)
}

/// The best of all contact states that are feasible.
fn enumerated(s: &Mat<f64>, c: &[f64], g: &[f64]) -> f64 {
    let m = c.len();
    let mut best = f64::INFINITY;
    for state in 0..1_u32 << m {
        let closed: Vec<bool> = (0..m).map(|i| state >> i & 1 == 1).collect();
        if let Some(j) = qp::with_closed(s, c, g, &closed)
            && j.iter().zip(g).all(|(j, g)| *j <= g + 1e-12)
        {
            best = best.min(energy(s, c, &j));
        }
    }
    best
}

/// Projected Gauss–Seidel until nothing moves.
fn gauss_seidel(s: &Mat<f64>, c: &[f64], g: &[f64]) -> Vec<f64> {
    let m = c.len();
    let mut j = g.to_vec();
    for _ in 0..200_000 {
        let mut moved = 0.0_f64;
        for i in 0..m {
            let rest: f64 = (0..m).filter(|&k| k != i).map(|k| s[(i, k)] * j[k]).sum();
            let next = ((c[i] - rest) / s[(i, i)]).min(g[i]);
            moved = moved.max((next - j[i]).abs());
            j[i] = next;
        }
        if moved < 1e-14 {
            break;
        }
    }
    j
}

/// Whether plain block pivoting from closed contact comes back to a state it has been in.
fn block_pivoting_cycles(s: &Mat<f64>, c: &[f64], g: &[f64]) -> bool {
    let mut closed = vec![true; c.len()];
    let mut seen = Vec::new();
    loop {
        let Some(j) = qp::with_closed(s, c, g, &closed) else { return false };
        let tension = qp::gradient(s, c, &j);
        let next: Vec<bool> = (0..c.len()).map(|i| if closed[i] { tension[i] <= 0.0 } else { j[i] > g[i] }).collect();
        if next == closed {
            return false;
        }
        if seen.contains(&next) {
            return true;
        }
        seen.push(closed);
        closed = next;
    }
}

#[test]
fn reaches_the_least_energy_of_all_states_even_where_block_pivoting_cycles() {
    let mut random = Random(7);
    let mut cycles = 0;
    for trial in 0..3000 {
        let m = 1 + trial % 8;
        let shift = [1.0, 1e-2, 1e-5][trial % 3];
        let s = random.gram(m, m, shift);
        let (c, g) = (random.vector(m), random.vector(m).iter().map(|g| g.abs()).collect::<Vec<_>>());
        cycles += usize::from(block_pivoting_cycles(&s, &c, &g));
        let found = qp::solve(&s, &c, &g, None).expect("a contact state");
        assert!(violation(&s, &c, &g, &found.jumps) < 1e-8, "trial {trial}");
        let best = enumerated(&s, &c, &g);
        assert!((energy(&s, &c, &found.jumps) - best).abs() <= 1e-9 * (1.0 + best.abs()), "trial {trial}");
        let careful = qp::one_by_one(&s, &c, &g, None).expect("a contact state");
        assert!((energy(&s, &c, &careful.jumps) - best).abs() <= 1e-9 * (1.0 + best.abs()), "trial {trial}");
    }
    println!("{cycles} of 3000 make block pivoting cycle");
    assert!(cycles > 0, "none of these matrices tests the guard against cycling");
}

#[test]
fn agrees_with_projected_gauss_seidel() {
    let mut random = Random(21);
    for m in [20, 60] {
        let s = random.gram(m, m, 0.3 * m as f64);
        let (c, g) = (random.vector(m), vec![0.0; m]);
        let found = qp::solve(&s, &c, &g, None).expect("a contact state");
        let other = gauss_seidel(&s, &c, &g);
        for (a, b) in found.jumps.iter().zip(&other) {
            assert!((a - b).abs() < 1e-10);
        }
    }
}

#[test]
fn a_guess_changes_the_steps_and_not_the_state() {
    let mut random = Random(3);
    let s = random.gram(40, 40, 5.0);
    let (c, g) = (random.vector(40), vec![0.1; 40]);
    let cold = qp::solve(&s, &c, &g, None).expect("a contact state");
    let warm = qp::solve(&s, &c, &g, Some(&cold.closed)).expect("a contact state");
    assert_eq!((warm.steps, &warm.closed), (1, &cold.closed));
    let opposite: Vec<bool> = cold.closed.iter().map(|c| !c).collect();
    assert_eq!(qp::solve(&s, &c, &g, Some(&opposite)).expect("a contact state").closed, cold.closed);
}

#[test]
fn a_multiplier_of_exactly_zero_settles() {
    // Both ends sit at their bound without traction: c = S g.
    let s = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { -1.0 });
    let found = qp::solve(&s, &[0.5, 0.5], &[0.5, 0.5], None).expect("a contact state");
    assert!(found.jumps.iter().all(|j| (j - 0.5).abs() < 1e-15));
    let open = qp::solve(&s, &[0.5, 0.5], &[0.5, 0.5], Some(&[false, false])).expect("a contact state");
    assert!(open.jumps.iter().all(|j| (j - 0.5).abs() < 1e-15));
}

#[test]
fn a_body_that_only_contact_holds() {
    // Two springs between ground and a free body: S is singular, the load presses both ends together or one of them.
    let s = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 } else { -1.0 });
    for (c, closed) in [([0.3, 0.2], [true, true]), ([2.0, -1.0], [true, false])] {
        let found = qp::solve(&s, &c, &[0.0, 0.0], None).expect("a contact state");
        assert_eq!(found.closed, closed);
        assert!(violation(&s, &c, &[0.0, 0.0], &found.jumps) < 1e-12);
        let open = qp::solve(&s, &c, &[0.0, 0.0], Some(&[false, false])).expect("a contact state");
        assert_eq!(open.closed, closed);
    }
}

#[test]
fn one_at_a_time_costs_about_one_solve_for_each_open_end() {
    // The half-plane operator |k| on a periodic line, pressed in the middle.
    let m = 120;
    let s = Mat::from_fn(m, m, |i, j| {
        let d = i.abs_diff(j);
        let near = d.min(m - d);
        if near == 0 {
            0.5 * m as f64
        } else if near % 2 == 1 {
            -2.0 / (m as f64 * (std::f64::consts::PI * near as f64 / m as f64).sin().powi(2))
        } else {
            0.0
        }
    });
    let s = Mat::from_fn(m, m, |i, j| s[(i, j)] + if i == j { 1.0 } else { 0.0 });
    let c: Vec<f64> = (0..m).map(|i| (std::f64::consts::TAU * i as f64 / m as f64).cos() - 0.2).collect();
    let g = vec![0.0; m];
    let block = qp::solve(&s, &c, &g, None).expect("a contact state");
    let careful = qp::one_by_one(&s, &c, &g, None).expect("a contact state");
    let open = block.closed.iter().filter(|c| !**c).count();
    println!("block {} steps, one by one {}, {open} open", block.steps, careful.steps);
    assert_eq!(block.closed, careful.closed);
    assert!(block.steps < 15 && careful.steps <= 2 * open + 2);
}

#[test]
fn no_contact_at_all() {
    let found = qp::solve(&Mat::zeros(0, 0), &[], &[], None).expect("a contact state");
    assert!(found.jumps.is_empty());
}

fn motions(problem: &Problem) -> Vec<Motion> {
    statics::check(problem).expect("statics are decided").held_at_vertices(problem)
}

fn run(method: &dyn DualMethod, problem: &Problem, options: &Options) -> DualSolution {
    dual::solve(method, problem, &motions(problem), options).expect("a solution")
}

#[test]
fn long_contacts_are_solved_without_a_dense_matrix() {
    let gap = two_blocks(12, |[_, y]| [4.0 - 7.0 * y, 0.0]).gap(|s| 0.2 * s + 0.3 * s * s).build();
    let pushed = Setup::default()
        .rectangle("left", [0.0, 0.0], [1.0, 1.0], 8)
        .rectangle("right", [1.0, 0.0], [2.0, 1.0], 8)
        .on("left.left", Role::Load(|[_, y]| [3.0 * y, 0.0]))
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
        .build();
    for (what, problem) in [("lift-off", lift_off(16)), ("gap", gap), ("held by contact alone", pushed)] {
        let dense = run(&Condensed::default(), &problem, &Options::default());
        let method = Condensed { longest_dense: 4, ..Condensed::default() };
        let long = run(&method, &problem, &Options::default());
        assert!(dense.notes.is_empty());
        assert!(long.notes.iter().any(|n| n.contains("MPRGP")), "{what}: {:?}", long.notes);
        assert_eq!(dense.closed, long.closed, "{what}");
        assert!(dense.closed.values().iter().any(|c| !c), "{what}: nothing opens");
        let largest = dense.stress.block(0).iter().flatten().fold(1.0_f64, |m, v| m.max(v.abs()));
        for t in 0..dense.stress.len() {
            for (a, b) in dense.stress.block(t).as_flattened().iter().zip(long.stress.block(t).as_flattened()) {
                assert!((a - b).abs() < 1e-10 * largest, "{what}");
            }
        }
        println!("{what}: {} dense steps, {} iterative", dense.iterations, long.iterations);
        assert!(long.equilibrium.residual() < 1e-11, "{what}: {:e}", long.equilibrium.residual());
        let warm = Options { closed: Some(dense.closed.clone()), ..Options::default() };
        assert_eq!(run(&Condensed::default(), &problem, &warm).iterations, 1, "{what}");
        assert_eq!(run(&method, &problem, &warm).iterations, 1, "{what}");
    }
}
