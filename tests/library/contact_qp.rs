//! The bound-constrained problem on Γ_K against enumeration of all contact states and against projected Gauss–Seidel.

use crate::setup::{Role, Setup, lift_off, two_blocks};
use faer::Mat;
use hypercircle::dual::{self, Condensed, DualMethod, DualSolution, Motion, Options};
use hypercircle::optimise::{self, Law, Program, Quadratic, State};
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

/// Jumps, which of them are at their bound, and the steps that it took.
struct Found {
    jumps: Vec<f64>,
    closed: Vec<bool>,
    steps: usize,
}

fn laws(g: &[f64]) -> Vec<Law> {
    g.iter().map(|g| Law::AtMost { bound: *g }).collect()
}

fn states(closed: &[bool]) -> Vec<State> {
    closed.iter().map(|closed| if *closed { State::Held } else { State::Below }).collect()
}

fn solve(s: &Mat<f64>, c: &[f64], g: &[f64], start: Option<&[bool]>) -> Found {
    let laws = laws(g);
    let found = optimise::solve(&Program { form: s, load: c, laws: &laws }, start.map(states)).expect("a minimum");
    let closed = found.states.iter().map(|state| *state == State::Held).collect();
    Found { jumps: found.x, closed, steps: found.steps }
}

/// Jumps with the closed ones at their bound and the others in equilibrium, where these are determined.
fn with_closed(s: &Mat<f64>, c: &[f64], g: &[f64], closed: &[bool]) -> Option<Vec<f64>> {
    let laws = laws(g);
    Program { form: s, load: c, laws: &laws }.solved_in_state(&states(closed), None, 0.0)
}

/// The search of Lawson and Hanson from closed contact: the end under the largest tension opens, and what stops the way to the
/// new equilibrium closes.
fn one_by_one(s: &Mat<f64>, c: &[f64], g: &[f64]) -> Found {
    let (mut jumps, mut closed) = (g.to_vec(), vec![true; g.len()]);
    let rounding = 1e-12 * c.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    for steps in 1.. {
        loop {
            let target = with_closed(s, c, g, &closed).expect("a definite matrix");
            let ratio = |i: usize| (g[i] - jumps[i]) / (target[i] - jumps[i]);
            let beyond = (0..g.len()).filter(|&i| !closed[i] && target[i] > g[i]);
            let stop = beyond.min_by(|a, b| ratio(*a).total_cmp(&ratio(*b)));
            let part = stop.map_or(1.0, ratio);
            jumps.iter_mut().zip(&target).for_each(|(j, t)| *j += part * (t - *j));
            let Some(i) = stop else { break };
            (closed[i], jumps[i]) = (true, g[i]);
        }
        let tension = s.gradient(c, &jumps);
        let worst = (0..g.len()).filter(|&i| closed[i]).max_by(|a, b| tension[*a].total_cmp(&tension[*b]));
        match worst.filter(|&i| tension[i] > rounding) {
            Some(i) => closed[i] = false,
            None => return Found { jumps, closed, steps },
        }
    }
    unreachable!()
}

fn energy(s: &Mat<f64>, c: &[f64], j: &[f64]) -> f64 {
    let tension = s.gradient(c, j);
    j.iter().zip(&tension).zip(c).map(|((j, t), c)| 0.5 * j * (t - c)).sum()
}

/// Violation of j ≤ g, T ≤ 0, T (g − j) = 0, relative to `c`.
fn violation(s: &Mat<f64>, c: &[f64], g: &[f64], j: &[f64]) -> f64 {
    let scale = c.iter().fold(1e-300_f64, |m, v| m.max(v.abs()));
    let tension = s.gradient(c, j);
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
        if let Some(j) = with_closed(s, c, g, &closed)
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

/// True if plain block pivoting from closed contact returns to an earlier state.
fn block_pivoting_cycles(s: &Mat<f64>, c: &[f64], g: &[f64]) -> bool {
    let mut closed = vec![true; c.len()];
    let mut seen = Vec::new();
    loop {
        let Some(j) = with_closed(s, c, g, &closed) else { return false };
        let tension = s.gradient(c, &j);
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
        let found = solve(&s, &c, &g, None);
        assert!(violation(&s, &c, &g, &found.jumps) < 1e-8, "trial {trial}");
        let best = enumerated(&s, &c, &g);
        assert!((energy(&s, &c, &found.jumps) - best).abs() <= 1e-9 * (1.0 + best.abs()), "trial {trial}");
        let careful = one_by_one(&s, &c, &g);
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
        let found = solve(&s, &c, &g, None);
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
    let cold = solve(&s, &c, &g, None);
    let warm = solve(&s, &c, &g, Some(&cold.closed));
    assert_eq!((warm.steps, &warm.closed), (1, &cold.closed));
    let opposite: Vec<bool> = cold.closed.iter().map(|c| !c).collect();
    assert_eq!(solve(&s, &c, &g, Some(&opposite)).closed, cold.closed);
}

#[test]
fn a_multiplier_of_exactly_zero_settles() {
    // Both ends sit at their bound without traction: c = S g.
    let s = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { -1.0 });
    let found = solve(&s, &[0.5, 0.5], &[0.5, 0.5], None);
    assert!(found.jumps.iter().all(|j| (j - 0.5).abs() < 1e-15));
    let open = solve(&s, &[0.5, 0.5], &[0.5, 0.5], Some(&[false, false]));
    assert!(open.jumps.iter().all(|j| (j - 0.5).abs() < 1e-15));
}

#[test]
fn a_body_that_only_contact_holds() {
    // Two springs between ground and a free body: S is singular, the load presses both ends together or one of them.
    let s = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 } else { -1.0 });
    for (c, closed) in [([0.3, 0.2], [true, true]), ([2.0, -1.0], [true, false])] {
        let found = solve(&s, &c, &[0.0, 0.0], None);
        assert_eq!(found.closed, closed);
        assert!(violation(&s, &c, &[0.0, 0.0], &found.jumps) < 1e-12);
        let open = solve(&s, &c, &[0.0, 0.0], Some(&[false, false]));
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
    let block = solve(&s, &c, &g, None);
    let careful = one_by_one(&s, &c, &g);
    let open = block.closed.iter().filter(|c| !**c).count();
    println!("block {} steps, one by one {}, {open} open", block.steps, careful.steps);
    assert_eq!(block.closed, careful.closed);
    assert!(block.steps < 15 && careful.steps <= 2 * open + 2);
}

#[test]
fn no_contact_at_all() {
    let found = solve(&Mat::zeros(0, 0), &[], &[], None);
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
