//! Congruent triangles share what was computed on the first of them, and the stresses are those of each.

use crate::support::{Blocks, blocks};
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::mesh::Triangulation;
use hypercircle::problem::Problem;

/// Two blocks leaning by 30°, so that half of the triangles are equilateral: rounding says which side is the longest.
fn leaning(n: usize, at: [f64; 2]) -> Problem {
    let scene = Blocks { n, load: (1.0, 0.0), ..Blocks::default() }.scene();
    let h = 1.0 / n as f64;
    let raw = blocks::grid(n, |block, i, j| {
        let (s, t) = (block as f64 + i as f64 * h, j as f64 * h);
        [at[0] + s + 0.5 * t, at[1] + 0.75_f64.sqrt() * t]
    });
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a valid mesh");
    Problem::new(scene, mesh, notes).expect("a valid problem")
}

#[test]
fn stresses_of_equilateral_triangles_are_in_equilibrium() {
    for at in [[0.0, 0.0], [1.0 / 3.0, 7.0 / 9.0], [-5.3, 2.1]] {
        let problem = leaning(8, at);
        let longest = |t: usize| {
            let sides = problem.mesh.triangle_edges[t].map(|e| problem.mesh.edge_frame(e).0);
            (0..3).max_by(|a, b| sides[*a].total_cmp(&sides[*b])).expect("three sides")
        };
        let equilateral = |t: &usize| {
            let sides = problem.mesh.triangle_edges[*t].map(|e| problem.mesh.edge_frame(e).0);
            sides.iter().all(|s| (s - sides[0]).abs() < 1e-12)
        };
        let found: Vec<usize> = (0..problem.mesh.triangles.len()).filter(equilateral).map(longest).collect();
        assert!(found.len() >= 64 && found.iter().any(|side| *side != found[0]), "no side is longest by rounding");
        let solved = dual::solve(&Condensed::default(), &problem, &[], &Options::default()).expect("solves");
        assert!(solved.equilibrium.residual() < 1e-12, "{at:?}: {:?}", solved.equilibrium);
    }
}
