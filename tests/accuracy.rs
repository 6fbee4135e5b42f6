//! Equilibrium to round-off where naive formulas lose it, and what each step of the method wins.

mod setup;

use hypercircle::bounds::complementary;
use hypercircle::dual::{self, Condensed, DualError, DualSolution, Equilibrium, Motion, Options};
use hypercircle::element::subtriangle::{Moments, flexibility, side_map};
use hypercircle::element::{Block, Compliance, EquilibriumElement};
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::Kinematics;
use hypercircle::statics;
use nalgebra::{DMatrix, DVector};
use setup::{Role, Setup, lift_off};

const ALLOWED: f64 = 1e-11;

fn motions(problem: &Problem) -> Vec<Motion> {
    let found = statics::check(problem).expect("statics are decided");
    found.held.iter().map(|m| m.at_vertices(problem, &found.components)).collect()
}

fn solved(problem: &Problem, method: Condensed) -> DualSolution {
    dual::solve(&method, problem, &motions(problem), &Options::default()).expect("a solution")
}

fn residual(e: &Equilibrium) -> f64 {
    e.jump.max(e.applied).max(e.resultant).max(e.tension)
}

/// Equilibrium of the solution, allowed to be off by round-off only.
fn equilibrated(what: &str, problem: &Problem) {
    let found = solved(problem, Condensed::default());
    let plain = solved(problem, Condensed { most_refinements: 0, ..Condensed::default() });
    println!(
        "{what}: {:.1e} (resultant {:.1e}), without refinement {:.1e}",
        residual(&found.equilibrium),
        found.equilibrium.resultant,
        residual(&plain.equilibrium)
    );
    assert!(residual(&found.equilibrium) <= ALLOWED, "{what}: {:?}", found.equilibrium);
}

/// Two blocks of `cells` squares each with E and ν of both, tilted apart by the load; `map` moves the points.
fn blocks(materials: [(f64, f64); 2], cells: [usize; 2], load: fn([f64; 2]) -> [f64; 2]) -> Setup {
    let [(e, n), (f, m)] = materials;
    Setup::default()
        .material("left", [0.0, 0.0], [1.0, 1.0], cells, e, n, [0.0; 2])
        .material("right", [1.0, 0.0], [2.0, 1.0], cells, f, m, [0.0; 2])
        .on("left.left", Role::Load(load))
        .on("left.bottom", Role::Roller)
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
}

fn tilting([_, y]: [f64; 2]) -> [f64; 2] {
    [4.0 - 7.0 * y, 0.0]
}

#[test]
fn every_poisson_ratio() {
    for nu in [0.0, 0.3, 0.49, 0.4999, 0.499999] {
        equilibrated(&format!("ν = {nu}"), &blocks([(1.0, nu); 2], [12, 12], tilting).build());
    }
}

#[test]
fn every_stiffness_ratio() {
    for (left, right) in [(1e4, 1.0), (1e8, 1.0), (1.0, 1e8), (1.0, 1e4)] {
        let problem = blocks([(left, 0.3), (right, 0.3)], [12, 12], tilting).build();
        equilibrated(&format!("E = {left:e} on {right:e}"), &problem);
    }
}

#[test]
fn every_system_of_units() {
    for size in [1e-3, 1e3] {
        let problem = scaled(&lift_off(12), size, 1e6, 2.1e11);
        equilibrated(&format!("E = 2.1e11, length {size:e}"), &problem);
    }
}

#[test]
fn stretched_triangles() {
    for stretch in [1e2, 1e4] {
        let flat = |p: [f64; 2]| [p[0], p[1] / stretch];
        let strip = blocks([(1.0, 0.3); 2], [12, 12], |_| [1.0, 0.0]).on("right.bottom", Role::Roller);
        equilibrated(&format!("flat by {stretch:e} on a roller"), &strip.map(flat).build());
        let layer = |p: [f64; 2]| [if p[0] > 1.0 { 1.0 + (p[0] - 1.0) / stretch } else { p[0] }, p[1]];
        equilibrated(
            &format!("layer thin by {stretch:e}"),
            &blocks([(1.0, 0.3); 2], [12, 12], tilting).map(layer).build(),
        );
        let both = blocks([(1.0, 0.499999), (1e4, 0.3)], [12, 12], tilting).map(layer).build();
        equilibrated(&format!("thin by {stretch:e}, nearly incompressible on stiff"), &both);
    }
}

/// A cantilever whose free end is in contact. Here the body is badly conditioned and not its triangles: the round-off of
/// a traction acts on the long sides, the load on the short ones.
#[test]
fn slender_cantilever() {
    for slenderness in [1e2, 3e2] {
        let rod = blocks([(1.0, 0.3); 2], [12, 12], |_| [1.0, 0.0]).map(|p| [p[0], p[1] / slenderness]).build();
        equilibrated(&format!("slender by {slenderness:e}"), &rod);
    }
}

/// A block pressed into a corner of two rigid obstacles: nothing but contact holds it.
fn cornered(young: f64) -> Problem {
    Setup::default()
        .material("block", [0.0, 0.0], [1.0, 1.0], [8, 8], young, 0.3, [0.3, -1.0])
        .on("block.top", Role::Load(|[x, _]| [0.0, -1.0 - x]))
        .on("block.left", Role::Load(|[_, y]| [1.0 - 0.9 * y, 0.0]))
        .contact("block.bottom", None, |_| 0.0)
        .contact("block.right", None, |_| 0.0)
        .build()
}

/// A free block between the load and a clamped one.
fn sliding() -> Problem {
    Setup::default()
        .rectangle("left", [0.0, 0.0], [1.0, 1.0], 8)
        .rectangle("right", [1.0, 0.0], [2.0, 1.0], 8)
        .on("left.left", Role::Load(|[_, y]| [3.0 * y, 0.0]))
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
        .build()
}

#[test]
fn bodies_that_contact_alone_holds() {
    equilibrated("in a corner", &cornered(1.0));
    equilibrated("in a corner, stiff", &cornered(2.1e11));
    equilibrated("free to slide", &sliding());
}

/// A stiff punch on a soft foundation: it moves as a rigid body, and its strains are what is left of that motion.
#[test]
fn refinement_on_the_stresses_wins_what_a_rigid_motion_hides() {
    let punch = |young: f64| {
        Setup::default()
            .material("soft", [0.0, 0.0], [1.0, 1.0], [12, 12], 1.0, 0.3, [0.0; 2])
            .material("stiff", [0.0, 1.0], [1.0, 2.0], [12, 12], young, 0.3, [0.0; 2])
            .on("soft.bottom", Role::Clamped([0.0; 2]))
            .on("stiff.top", Role::Load(|[x, _]| [0.2, -1.0 - x]))
            .on("stiff.left", Role::Load(|[_, y]| [0.1 * y, 0.0]))
            .on("stiff.right", Role::Roller)
            .contact("soft.top", Some("stiff.bottom"), |_| 0.0)
            .build()
    };
    for young in [1e4, 1e8] {
        let problem = punch(young);
        let residuals: Vec<f64> = (0..4)
            .map(|most_refinements| {
                residual(&solved(&problem, Condensed { most_refinements, ..Condensed::default() }).equilibrium)
            })
            .collect();
        println!("E = {young:e}: {residuals:?}");
        assert!(residuals[3] <= ALLOWED);
        assert!(residuals[0] > 1e-17 * young && residuals[0] > 30.0 * residuals[3], "{residuals:?}");
    }
}

/// K of one triangle by eliminating the moments on its three inner segments from the stiffnesses of its subtriangles.
fn by_inner_segments(corners: [[f64; 2]; 3], material: &Compliance) -> DMatrix<f64> {
    let centre = [0, 1].map(|c| (corners[0][c] + corners[1][c] + corners[2][c]) / 3.0);
    let p = corners.map(|q| [q[0] - centre[0], q[1] - centre[1]]);
    let constants = [material.kappa + material.gamma / 4.0, material.kappa - material.gamma / 4.0, material.gamma];
    // Unknowns: 12 on the sides, then four on each segment 0a_k, from the centroid outwards.
    let mut k = DMatrix::<f64>::zeros(24, 24);
    for sub in 0..3 {
        let (j, l) = ((sub + 1) % 3, (sub + 2) % 3);
        let sides = [(p[j], p[l]), (p[l], [0.0; 2]), ([0.0; 2], p[j])];
        let moments = Moments::new([p[j], p[l], [0.0; 2]]);
        let mut traction = DMatrix::<f64>::zeros(12, 7);
        for (s, (a, b)) in sides.into_iter().enumerate() {
            let off = |q: [f64; 2]| [q[0] - moments.centre[0], q[1] - moments.centre[1]];
            let map = side_map(off(a), off(b));
            for column in 0..7 {
                for (end, sign) in [-1.0, 1.0].into_iter().enumerate() {
                    traction[(4 * s + 2 * end, column)] = map[(0, column)] + sign * map[(1, column)];
                    traction[(4 * s + 2 * end + 1, column)] = map[(2, column)] + sign * map[(3, column)];
                }
            }
        }
        let f = flexibility(&moments, constants) / material.young;
        let f = DMatrix::from_fn(7, 7, |a, b| f[(a, b)]);
        let own = &traction * f.try_inverse().expect("regular") * traction.transpose();
        let place: Vec<usize> = (0..12)
            .map(|i| match i {
                0..4 => 4 * sub + i,
                // Side a_l → 0 runs inwards, side 0 → a_j outwards.
                4..8 => 12 + 4 * l + [2, 3, 0, 1][i - 4],
                _ => 12 + 4 * j + (i - 8),
            })
            .collect();
        for a in 0..12 {
            for b in 0..12 {
                k[(place[a], place[b])] += own[(a, b)];
            }
        }
    }
    let (outer, inner, mixed) = (k.view((0, 0), (12, 12)), k.view((12, 12), (12, 12)), k.view((12, 0), (12, 12)));
    let eliminated = inner.clone_owned().svd(true, true).solve(&mixed.clone_owned(), 1e-300).expect("solves");
    outer - mixed.transpose() * eliminated
}

#[test]
fn orthonormal_modes_keep_what_inner_segments_lose() {
    let corners = [[0.0, 0.0], [1.0, 0.1], [0.3, 0.8]];
    let area = 0.5 * (1.0 * 0.8 - 0.1 * 0.3);
    // A displacement without change of volume: its energy knows nothing of κ → 0.
    let isochoric = moments(corners, |[x, y]| [x, -y]);
    for nu in [0.3, 0.4999, 0.499999] {
        let material = Compliance::new(Kinematics::PlaneStrain, 1.0, nu);
        let modes = Block.modes(corners, &material, [0.0; 2]);
        let t = DMatrix::from_row_slice(12, 9, modes.traction());
        let other = by_inner_segments(corners, &material);
        let apart = (&t * t.transpose() - &other).amax() / other.amax();
        assert!(apart < 1e-9, "the two are the same matrix");
        // Rigid motions give no stress.
        let rigid: [fn([f64; 2]) -> [f64; 2]; 3] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]| [-y, x]];
        for field in rigid {
            let r = moments(corners, field);
            assert!((t.transpose() * &r).amax() < 1e-15 * t.amax() * r.amax());
        }
        let energy = 4.0 * area / material.gamma;
        let own = ((t.transpose() * &isochoric).norm_squared() - energy).abs() / energy;
        let theirs = ((isochoric.transpose() * &other * &isochoric)[(0, 0)] - energy).abs() / energy;
        println!("ν = {nu}: energy off by {own:.1e} with modes, {theirs:.1e} by inner segments; K {apart:.1e} apart");
        assert!(own < 1e-14);
        if nu > 0.499 {
            assert!(theirs > 100.0 * own);
        }
    }
}

/// ∫ u q ds on the three sides, for a linear field u.
fn moments(corners: [[f64; 2]; 3], field: fn([f64; 2]) -> [f64; 2]) -> DVector<f64> {
    let mut m = DVector::zeros(12);
    for side in 0..3 {
        let (a, b) = (corners[(side + 1) % 3], corners[(side + 2) % 3]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let (ua, ub) = (field(a), field(b));
        for c in 0..2 {
            m[4 * side + c] = length * (2.0 * ua[c] + ub[c]) / 6.0;
            m[4 * side + 2 + c] = length * (ua[c] + 2.0 * ub[c]) / 6.0;
        }
    }
    m
}

/// The problem in other units: lengths, forces per area and E multiplied.
fn scaled(problem: &Problem, length: f64, force: f64, young: f64) -> Problem {
    let mut p = problem.clone();
    let displacement = length * force / young;
    p.mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x *= length);
    p.scene.bodies.iter_mut().for_each(|b| b.young *= young);
    p.scene.bodies.iter_mut().for_each(|b| b.body_force.iter_mut().for_each(|f| *f *= force / length));
    for condition in &mut p.conditions {
        match condition {
            Condition::Traction(t) => t.as_flattened_mut().iter_mut().for_each(|t| *t *= force),
            Condition::Clamped(u) => u.iter_mut().for_each(|u| *u *= displacement),
            _ => {}
        }
    }
    for pair in p.interfaces.iter_mut().flat_map(|i| &mut i.pairs) {
        pair.length *= length;
        pair.arc.iter_mut().for_each(|s| *s *= length);
        pair.gap.iter_mut().for_each(|g| *g *= displacement);
    }
    p
}

#[test]
fn powers_of_two_scale_every_bit() {
    for problem in [lift_off(8), cornered(1.0), sliding()] {
        let plain = solved(&problem, Condensed::default());
        let (length, force, young) = (2.0_f64.powi(-9), 2.0_f64.powi(13), 4.0_f64.powi(20));
        let other = solved(&scaled(&problem, length, force, young), Condensed::default());
        assert_eq!((plain.iterations, &plain.closed), (other.iterations, &other.closed));
        for t in 0..plain.stress.len() {
            for (a, b) in plain.stress.block(t).as_flattened().iter().zip(other.stress.block(t).as_flattened()) {
                assert_eq!((a * force).to_bits(), b.to_bits());
            }
        }
    }
}

#[test]
fn any_scale_leaves_the_dimensionless_answer() {
    let problem = lift_off(8);
    let energy = complementary(&problem, &solved(&problem, Condensed::default()).stress).lower();
    for (length, force, young) in
        [(1e9, 1.0, 1.0), (1e-9, 1.0, 1.0), (1.0, 1e9, 1.0), (1.0, 1e-9, 1e9), (1e-9, 1e9, 1e-9)]
    {
        let other = scaled(&problem, length, force, young);
        let found = solved(&other, Condensed::default());
        let value = complementary(&other, &found.stress).lower() * young / (force * length).powi(2);
        assert!((value - energy).abs() <= 1e-12 * energy.abs(), "{length:e} {force:e} {young:e}: {value} for {energy}");
        assert!(residual(&found.equilibrium) <= ALLOWED);
    }
}

/// A permutation of 0..n.
fn permutation(n: usize, seed: u64) -> Vec<usize> {
    let mut state = seed;
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        order.swap(i, (state >> 33) as usize % (i + 1));
    }
    order
}

/// The same problem with triangles, vertices and edges renumbered and the corners of each triangle turned by one;
/// `place[t]` is the new number of triangle t.
fn renumbered(problem: &Problem, seed: u64) -> (Problem, Vec<usize>) {
    let mut p = problem.clone();
    let vertex = permutation(p.mesh.points.len(), seed);
    let place = permutation(p.mesh.triangles.len(), seed + 1);
    let edge = permutation(p.mesh.edges.len(), seed + 2);
    for (old, &new) in vertex.iter().enumerate() {
        p.mesh.points[new] = problem.mesh.points[old];
    }
    for (old, &new) in place.iter().enumerate() {
        let [a, b, c] = problem.mesh.triangles[old].map(|v| vertex[v]);
        let [d, e, f] = problem.mesh.triangle_edges[old].map(|e| edge[e]);
        p.mesh.triangles[new] = [b, c, a];
        p.mesh.triangle_edges[new] = [e, f, d];
        p.mesh.body[new] = problem.mesh.body[old];
    }
    for (old, &new) in edge.iter().enumerate() {
        p.mesh.edges[new] = problem.mesh.edges[old];
        p.mesh.edges[new].vertices = problem.mesh.edges[old].vertices.map(|v| vertex[v]);
        p.mesh.edges[new].triangles = problem.mesh.edges[old].triangles.map(|t| t.map(|t| place[t]));
        p.conditions[new] = problem.conditions[old];
    }
    for pair in p.interfaces.iter_mut().flat_map(|i| &mut i.pairs) {
        pair.edges = pair.edges.map(|e| e.map(|e| edge[e]));
        pair.first = pair.first.map(|v| vertex[v]);
        pair.second = pair.second.map(|s| s.map(|v| vertex[v]));
    }
    (p, place)
}

#[test]
fn numbering_does_not_matter() {
    for problem in [lift_off(12), cornered(1.0), blocks([(1.0, 0.49), (50.0, 0.0)], [9, 14], tilting).build()] {
        let plain = solved(&problem, Condensed::default());
        let (other, place) = renumbered(&problem, 5);
        let found = solved(&other, Condensed::default());
        let (a, b) = (complementary(&problem, &plain.stress).lower(), complementary(&other, &found.stress).lower());
        assert!((a - b).abs() <= 1e-12 * a.abs(), "{a} and {b}");
        let largest =
            (0..place.len()).flat_map(|t| plain.stress.block(t).as_flattened()).fold(0.0_f64, |m, v| m.max(v.abs()));
        for (t, &new) in place.iter().enumerate() {
            for sub in 0..3 {
                for node in 0..3 {
                    let mut bary = [0.0; 3];
                    bary[node] = 1.0;
                    let (a, b) = (plain.stress.at(t, (sub + 1) % 3, bary), found.stress.at(new, sub, bary));
                    for c in 0..3 {
                        assert!((a[c] - b[c]).abs() <= 1e-12 * largest, "{a:?} and {b:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn one_thread_repeats_every_bit() {
    let problem = lift_off(16);
    let (a, b) = (solved(&problem, Condensed::default()), solved(&problem, Condensed::default()));
    for t in 0..a.stress.len() {
        for (x, y) in a.stress.block(t).as_flattened().iter().zip(b.stress.block(t).as_flattened()) {
            assert_eq!(x.to_bits(), y.to_bits());
        }
    }
    assert!(a.moments.as_flattened().as_flattened() == b.moments.as_flattened().as_flattened());
}

#[test]
fn nothing_to_solve_for_is_no_failure() {
    // Two triangles, all four sides clamped, and one of them alone: no unknown at all.
    let clamped = || {
        let sides = ["bottom", "right", "top", "left"];
        let square = Setup::default().material("body", [0.0; 2], [1.0; 2], [1, 1], 1.0, 0.3, [1.0, 2.0]);
        sides.into_iter().fold(square, |s, side| s.on(&format!("body.{side}"), Role::Clamped([0.0; 2])))
    };
    let two = solved(&clamped().build(), Condensed::default());
    assert_eq!((two.unknowns, two.closed.len()), (4, 0));
    assert!(residual(&two.equilibrium) <= ALLOWED);
    let mut one = clamped().without(|[x, y]| y > x).build();
    for condition in &mut one.conditions {
        *condition = Condition::Clamped([0.0; 2]);
    }
    let one = solved(&one, Condensed::default());
    assert_eq!(one.unknowns, 0);
    assert!(residual(&one.equilibrium) <= ALLOWED);
}

#[test]
fn a_body_without_hold_is_refused_or_balanced() {
    // The free motions are kept from the solver on purpose.
    let afloat = |load: fn([f64; 2]) -> [f64; 2]| {
        Setup::default()
            .rectangle("body", [0.0; 2], [1.0; 2], 4)
            .on("body.left", Role::Load(load))
            .on("body.right", Role::Load(|_| [1.0, 0.0]))
            .build()
    };
    let solve = |p: &Problem| dual::solve(&Condensed::default(), p, &[], &Options::default());
    match solve(&afloat(|_| [1.0, 0.0])) {
        Err(DualError::Factorisation { reason }) => println!("{reason}"),
        Err(other) => panic!("{other}"),
        Ok(found) => assert!(residual(&found.equilibrium) > 1e-3, "an unbalanced load cannot be balanced"),
    }
}
