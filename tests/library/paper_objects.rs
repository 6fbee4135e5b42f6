//! The global objects of Section 3, each against something that does not use it: rank, tractions, hand calculation.

use crate::setup::{Role, Setup, lift_off, two_blocks};
use hypercircle::bounds::energy::complementary;
use hypercircle::dual::paper::{
    Auxiliary, BlockMatrices, Constraints, Iteration, Meaning, Program, Reaction, TractionShape, dependences,
    multipliers,
};
use hypercircle::element::subtriangle::Matrix;
use hypercircle::problem::{Condition, Problem};
use nalgebra::{DMatrix, SymmetricEigen};

fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, v: f64| m.max(v.abs()))
}

/// A problem with everything: body force, prescribed displacement, gap, roller, contact, applied traction.
fn with_everything() -> Problem {
    Setup::default()
        .material("left", [0.0, 0.0], [1.0, 1.0], [2, 3], 2.0, 0.3, [0.3, -0.7])
        .material("right", [1.0, 0.0], [2.0, 1.0], [3, 3], 5.0, 0.2, [-0.1, 0.4])
        .on("left.left", Role::Load(|[_, y]| [4.0 - 7.0 * y, 0.5 + y]))
        .on("left.bottom", Role::Roller)
        .on("right.right", Role::Clamped([0.02, -0.05]))
        .contact("left.right", Some("right.left"), |s| 0.1 + 0.05 * s)
        .build()
}

fn blocks(problem: &Problem) -> Vec<BlockMatrices> {
    (0..problem.mesh.triangles.len())
        .map(|t| {
            let material = problem.material(problem.mesh.body[t]);
            BlockMatrices::new(problem.mesh.corners(t), &material)
        })
        .collect()
}

fn constraints(problem: &Problem) -> Constraints {
    Constraints::new(problem, &blocks(problem).iter().map(BlockMatrices::external).collect::<Vec<_>>())
}

fn auxiliary(problem: &Problem) -> Auxiliary {
    let rows = constraints(problem);
    Auxiliary::new(problem, &rows, &dependences(problem, &rows)).expect("a field")
}

/// Reproducible numbers in (−1, 1).
fn numbers(n: usize) -> Vec<f64> {
    (0..n).map(|i| 2.0 * ((i as f64 + 1.0) * 0.618_033_988_749_895).fract() - 1.0).collect()
}

#[test]
fn constant_stress_satisfies_the_continuity_rows() {
    let problem = with_everything();
    let rows = constraints(&problem);
    let tau = [1.3, -0.4, 0.8];
    let parameters: Vec<f64> = blocks(&problem)
        .iter()
        .flat_map(|block| {
            let s = Matrix::<21, 1>::from_fn(|i, _| if i % 7 < 3 { tau[i % 7] } else { 0.0 });
            let own = block.q1().transpose() * s;
            assert!((block.q1() * own - s).amax() < 1e-13, "constants are in N(K)");
            own.iter().copied().collect::<Vec<_>>()
        })
        .collect();
    let (d, e) = (rows.d.multiply(&parameters), rows.e.multiply(&parameters));
    for (value, meaning) in d.iter().zip(&rows.d_meaning) {
        let expected = match *meaning {
            Meaning::Applied { edge, component, basis: TractionShape::Mean } => {
                let (_, n) = problem.mesh.edge_frame(edge);
                [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]][component]
            }
            // n = (0, −1), t = (1, 0); n = (±1, 0), t = (0, ±1).
            Meaning::RollerShear { basis: TractionShape::Mean, .. } => -tau[2],
            Meaning::ContactShear { basis: TractionShape::Mean, .. } => tau[2],
            _ => 0.0,
        };
        assert!((value - expected).abs() < 1e-12, "{meaning}: {value} for {expected}");
    }
    assert!(e.iter().all(|v| (v - tau[0]).abs() < 1e-12));
}

#[test]
fn rows_read_tractions_off_any_field() {
    let problem = with_everything();
    let program = Program::new(&problem).expect("a program");
    // λ̄ + τ of arbitrary parameters, less λ̄ itself.
    let s = numbers(program.parameters());
    let (with, bar) = (program.stress(&problem, &s), program.stress(&problem, &vec![0.0; s.len()]));
    let rows = &program.constraints;
    let (d, e) = rows.evaluate(|edge, side| {
        let (a, b) =
            (with.edge_traction(&problem.mesh, edge, side, 1), bar.edge_traction(&problem.mesh, edge, side, 1));
        [0, 1].map(|k| [0, 1].map(|c| a[k][c] - b[k][c]))
    });
    let difference = d.iter().zip(rows.d.multiply(&s)).chain(e.iter().zip(rows.e.multiply(&s))).map(|(a, b)| a - b);
    assert!(largest(difference) < 1e-12);
    // The same work, from moments on edge tractions: Σ z (Bs) = Σ m T with u on the left side of each edge.
    let z = numbers(rows.d.len() + rows.e.len());
    let (z_d, z_e) = z.split_at(rows.d.len());
    let moments = rows.moments(&problem, z_d, z_e);
    let mut work = 0.0;
    for (edge, m) in moments.iter().enumerate() {
        let sides = if problem.mesh.edges[edge].is_boundary() { 1 } else { 2 };
        for side in 0..sides {
            let (a, b) =
                (with.edge_traction(&problem.mesh, edge, side, 1), bar.edge_traction(&problem.mesh, edge, side, 1));
            work += (0..2)
                .flat_map(|i| (0..2).map(move |c| (i, c)))
                .map(|(i, c)| m[i][c] * (a[i][c] - b[i][c]))
                .sum::<f64>();
        }
    }
    let expected: f64 = program.rows.multiply(&s).iter().zip(&z).map(|(r, z)| r * z).sum();
    assert!((work - expected).abs() < 1e-11, "{work} for {expected}");
}

#[test]
fn functional_is_the_change_of_complementary_energy() {
    let problem = with_everything();
    let program = Program::new(&problem).expect("a program");
    let lower = |s: &[f64]| complementary(&problem, &program.stress(&problem, s)).lower();
    let s = numbers(program.parameters());
    let change = lower(&vec![0.0; s.len()]) - lower(&s);
    assert!((program.functional(&s) - change).abs() < 1e-10 * change.abs(), "{} for {change}", program.functional(&s));
}

fn rank(problem: &Problem) -> (usize, usize) {
    let rows = constraints(problem);
    let all = rows.d.stack(&rows.e);
    let mut dense = DMatrix::<f64>::zeros(all.len(), all.columns());
    for i in 0..all.len() {
        all.row(i).for_each(|(j, v)| dense[(i, j)] += v);
    }
    let values = dense.singular_values();
    (all.len(), values.iter().filter(|v| **v > 1e-9 * values.max()).count())
}

#[test]
fn every_dependence_is_found_and_is_one() {
    let free = Setup::default().rectangle("block", [0.0, 0.0], [1.0, 1.0], 2).build();
    let clamped = Setup::default()
        .rectangle("block", [0.0, 0.0], [1.0, 1.0], 2)
        .on("block.left", Role::Clamped([0.0; 2]))
        .build();
    let resting =
        Setup::default().rectangle("block", [0.0, 0.0], [1.0, 1.0], 2).contact("block.bottom", None, |_| 0.0).build();
    let inclined = Setup::default()
        .rectangle("block", [0.0, 0.0], [1.0, 1.0], 2)
        .contact("block.bottom", None, |_| 0.0)
        .map(|[x, y]| [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y])
        .build();
    let ring = Setup::default()
        .rectangle("ring", [0.0, 0.0], [3.0, 3.0], 3)
        .without(|[x, y]| (1.0..2.0).contains(&x) && (1.0..2.0).contains(&y))
        .on("ring.left", Role::Roller)
        .build();
    // (dependences, of which tie the reactions of the contact)
    for (what, problem, expected, contact) in [
        ("free", &free, 3, 0),
        ("clamped", &clamped, 0, 0),
        ("resting", &resting, 3, 2),
        ("inclined", &inclined, 3, 2),
        ("ring", &ring, 1, 0),
        ("two blocks", &lift_off(2), 1, 1),
        ("everything", &with_everything(), 1, 1),
    ] {
        let rows = constraints(problem);
        let found = dependences(problem, &rows);
        let (p, rank) = rank(problem);
        assert_eq!(p - rank, expected, "{what}: rank {rank} of {p}");
        assert_eq!(found.len(), expected, "{what}");
        for dependence in &found {
            let mut sum = rows.d.transposed_multiply(&dependence.z_d);
            rows.e.add_transposed(&dependence.z_e, &mut sum);
            assert!(largest(sum) < 1e-12, "{what}: Bᵀz is not zero");
            assert!(largest(dependence.z_d.iter().copied()) > 1e-2, "{what}");
        }
        let tied = DMatrix::from_fn(rows.e.len().max(1), found.len().max(1), |i, k| {
            found.get(k).and_then(|d| d.z_e.get(i)).copied().unwrap_or(0.0)
        });
        assert_eq!(tied.rank(1e-9), contact, "{what}: contact");
        assert_eq!(found.iter().filter(|d| d.involves_contact()).count(), contact, "{what}: separated");
    }
}

#[test]
fn multipliers_of_a_motion_give_back_its_moments() {
    let problem = with_everything();
    let rows = constraints(&problem);
    let u = |p: [f64; 2]| [0.3 - 0.5 * p[1], 0.1 + 0.5 * p[0]];
    let motion: Vec<[f64; 2]> = problem.mesh.points.iter().map(|&p| u(p)).collect();
    let (z_d, z_e) = multipliers(&problem, &rows, &motion);
    for (e, m) in rows.moments(&problem, &z_d, &z_e).iter().enumerate() {
        if !matches!(problem.conditions[e], Condition::Clamped(_) | Condition::Roller { .. }) {
            let (length, _) = problem.mesh.edge_frame(e);
            let [a, b] = problem.mesh.edges[e].vertices.map(|v| motion[v]);
            for c in 0..2 {
                assert!((m[0][c] - length * (2.0 * a[c] + b[c]) / 6.0).abs() < 1e-14);
                assert!((m[1][c] - length * (a[c] + 2.0 * b[c]) / 6.0).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn auxiliary_field_balances_everything() {
    let problem = with_everything();
    let program = Program::new(&problem).expect("a program");
    // (2.3) by hand: ∫F1 = 0.3, ∫P1 = 0.5, ∫dx2 = 1.
    assert_eq!(program.auxiliary.reaction.example(), Some(1));
    let g = program.auxiliary.reaction.normal().expect("a reaction");
    assert!((g + 0.8).abs() < 1e-14);
    let bar = program.stress(&problem, &vec![0.0; program.parameters()]);
    // div λ̄ = −F by the flux through each subtriangle, Gauss on its sides.
    for t in 0..problem.mesh.triangles.len() {
        let corners = problem.mesh.corners(t);
        let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
        let force = problem.force_on(t).mean();
        for sub in 0..3 {
            let q = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], centre];
            let mut flux = [0.0; 2];
            for i in 0..3 {
                let (dx, dy) = (q[(i + 1) % 3][0] - q[i][0], q[(i + 1) % 3][1] - q[i][1]);
                let mut bary = [0.0; 3];
                (bary[i], bary[(i + 1) % 3]) = (0.5, 0.5);
                let tau = bar.at(t, sub, bary);
                flux[0] += tau[0] * dy - tau[2] * dx;
                flux[1] += tau[2] * dy - tau[1] * dx;
            }
            for c in 0..2 {
                assert!((flux[c] + force[c] * area(q)).abs() < 1e-12);
            }
        }
    }
    // (3.16)–(3.19), and continuity.
    let (mut on_contact, mut on_roller) = ([0.0; 2], 0.0);
    for (e, condition) in problem.conditions.iter().enumerate() {
        let own = bar.edge_traction(&problem.mesh, e, 0, 1);
        let (length, n) = problem.mesh.edge_frame(e);
        let left = problem.mesh.body[problem.mesh.edges[e].triangles[0].unwrap()] == 0;
        for end in 0..2 {
            let (tn, tt) = (own[end][0] * n[0] + own[end][1] * n[1], own[end][1] * n[0] - own[end][0] * n[1]);
            match condition {
                Condition::Interior => {
                    let other = bar.edge_traction(&problem.mesh, e, 1, 1);
                    assert!(largest([own[end][0] + other[end][0], own[end][1] + other[end][1]]) < 1e-11);
                }
                Condition::Traction(p) => assert!(largest([own[end][0] - p[end][0], own[end][1] - p[end][1]]) < 1e-11),
                Condition::Roller { .. } => assert!(tt.abs() < 1e-11),
                Condition::Contact { .. } => assert!((tn - g).abs() < 1e-11 && tt.abs() < 1e-11),
                Condition::Clamped(_) | Condition::Axis | Condition::Elastic { .. } => {}
            }
            match condition {
                Condition::Contact { .. } if left => (0..2).for_each(|c| on_contact[c] += 0.5 * length * own[end][c]),
                Condition::Roller { .. } => on_roller += 0.5 * length * own[end][1],
                _ => {}
            }
        }
    }
    // Lemma 2.1, (2.1), for Ω'' = left: ∫F + ∫P = (0.3 + 0.5, −0.7 + 1.0).
    assert!((on_contact[0] + 0.8).abs() < 1e-11);
    assert!((on_contact[1] + (-0.7 + 1.0) + on_roller).abs() < 1e-11);
}

#[test]
fn the_three_examples_are_recognised() {
    let upper = |load: fn([f64; 2]) -> [f64; 2]| {
        Setup::default()
            .rectangle("upper", [0.0, 1.0], [2.0, 2.0], 2)
            .rectangle("lower", [0.0, 0.0], [2.0, 1.0], 2)
            .on("upper.top", Role::Load(load))
            .on("lower.bottom", Role::Clamped([0.0; 2]))
            .contact("upper.bottom", Some("lower.top"), |_| 0.0)
    };
    // (2.6): V2 = −6 over a length of 2.
    let centred = upper(|_| [0.0, -3.0]).build();
    assert_eq!(Reaction::of(&centred), Reaction::Held { value: -3.0 });
    let field = auxiliary(&centred);
    assert!(field.notes.is_empty() && largest(field.normal_traction.iter().map(|t| t + 3.0)) < 1e-10);
    // Off the centre no constant reaction holds the moment.
    let tilted = upper(|[x, _]| [0.0, -1.0 - x]).build();
    let field = auxiliary(&tilted);
    assert_eq!(field.reaction, Reaction::Free);
    assert_eq!(field.notes.len(), 1);
    let force: f64 = field
        .normal_traction
        .chunks(2)
        .zip(&tilted.interfaces[0].pairs)
        .map(|(t, pair)| 0.5 * pair.length * (t[0] + t[1]))
        .sum();
    assert!((force + 4.0).abs() < 1e-10);
    // Example 2: a roller on top, Γ_K along it, V1 = 1·1 over ∫dx1 = 2: the shear g_1 takes it all.
    let sheared =
        upper(|_| [0.0; 2]).on("upper.top", Role::Roller).on("upper.left", Role::Load(|_| [1.0, 0.0])).build();
    assert_eq!(Reaction::of(&sheared).example(), Some(2));
    let rows = constraints(&sheared);
    let field = auxiliary(&sheared);
    // Outward normal of the upper body is (0, −1), its tangent (1, 0).
    assert!((field.reaction.shear() + 0.5).abs() < 1e-14);
    for (excess, meaning) in field.excess.iter().zip(&rows.d_meaning) {
        let mean = matches!(meaning, Meaning::ContactShear { basis: TractionShape::Mean, .. });
        assert!((excess - if mean { -0.5 } else { 0.0 }).abs() < 1e-10, "{meaning}: {excess}");
    }
    assert_eq!(Reaction::of(&two_blocks(2, |_| [1.0, 0.0]).build()), Reaction::Normal { value: -1.0 });
}

#[test]
fn norm_estimate_is_just_above_the_norm() {
    let problem = with_everything();
    let program = Program::new(&problem).expect("a program");
    let iteration = Iteration::new(&program);
    // Dense Δ B A⁻¹ Bᵀ Δ.
    let p = program.rows.len();
    let mut b = DMatrix::<f64>::zeros(p, program.parameters());
    for i in 0..p {
        program.rows.row(i).for_each(|(j, v)| b[(i, j)] += v * iteration.row_scale[i]);
    }
    let mut solved = b.clone();
    for i in 0..p {
        let row = program.solve_a(&b.row(i).iter().copied().collect::<Vec<_>>());
        row.iter().enumerate().for_each(|(j, v)| solved[(i, j)] = *v);
    }
    let dense = &b * solved.transpose();
    assert!((0..p).all(|i| (dense[(i, i)] - 1.0).abs() < 1e-12), "rows are scaled");
    let exact = SymmetricEigen::new(dense).eigenvalues.max();
    let estimate = iteration.norm();
    assert!(estimate >= exact * (1.0 - 1e-9) && estimate <= 1.02 * exact, "{estimate} for {exact}");
}
