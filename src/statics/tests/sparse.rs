//! Groups of many pieces: sparse elimination against the dense one, and chains whose statics can be told by hand.

use super::build::{Build, transformed};
use super::scenes::cases;
use crate::problem::Problem;
use crate::statics::balance::{Cone, Verdict};
use crate::statics::cone::few::DenseCone;
use crate::statics::cone::many::SparseCone;
use crate::statics::cone::sparse::{Row, Triangular, dense, least_squares};
use crate::statics::openings::Ties;
use crate::statics::{Components, LoadResultants, MotionKind, Solvability, Statics, check, check_after, restraint};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

#[test]
fn sparse_and_dense_cones_give_the_same_verdicts() {
    for case in cases() {
        for excess in [-0.3, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.5] {
            for angle in [0.0, 0.7] {
                let problem = transformed((case.scene)(excess), angle, 1.0, 1.0, [0.0; 2]);
                let components = Components::new(&problem);
                let loads = LoadResultants::new(&problem, &components);
                let runs = restraint::runs(&problem, &components, &|_| 1);
                let clamped = restraint::clamped(&problem, &components);
                for group in restraint::groups(&components, &clamped, &runs) {
                    let few = Verdict::from_cones(&problem, &group, &loads, &[], |rows, points| {
                        Box::new(DenseCone::new(&group, rows, points, Ties::Vertices)) as Box<dyn Cone>
                    });
                    let many = Verdict::from_cones(&problem, &group, &loads, &[], |rows, points| {
                        Box::new(SparseCone::new(&group, rows, points, Ties::Vertices)) as Box<dyn Cone>
                    });
                    let (few, many) = (few.unwrap(), many.unwrap());
                    let what = format!("{} at {excess}, turned by {angle}", case.name);
                    assert_eq!(few.held.len(), many.held.len(), "{what}");
                    assert_eq!(few.one_way.is_some(), many.one_way.is_some(), "{what}");
                    assert_eq!(few.beyond_mesh.is_some(), many.beyond_mesh.is_some(), "{what}");
                    let work = |found: &Verdict| found.driven.as_ref().map_or(0.0, |driven| driven.work);
                    let (a, b) = (work(&few), work(&many));
                    assert!((a > 0.0) == (b > 0.0) && (a - b).abs() <= 1e-6 * a, "{what}: {a:e} {b:e}");
                }
            }
        }
    }
}

#[test]
fn what_a_coarser_mesh_told_changes_no_verdict() {
    let kind = |statics: &Statics| match &statics.equilibrium {
        Solvability::Possible { one_way, beyond_mesh, .. } => (true, one_way.is_some(), beyond_mesh.is_some()),
        Solvability::Impossible { .. } => (false, false, false),
    };
    for case in cases() {
        for excess in [-0.3, -1e-6, 0.0, 1e-6, 0.5] {
            let given = (case.scene)(excess);
            let finer = given.refine_uniform(1).unwrap();
            let anew = check(&finer).unwrap();
            // From the same scene, from one that is loaded otherwise, and from one that is turned.
            let turned = transformed((case.scene)(excess), 0.7, 1.0, 1.0, [0.0; 2]);
            for coarser in [given, (case.scene)(-0.2), (case.scene)(0.4), turned] {
                let found = check_after(&finer, &|_| 1, Some(&check(&coarser).unwrap())).unwrap();
                let what = format!("{} at {excess}", case.name);
                assert_eq!(kind(&found), kind(&anew), "{what}");
                assert_eq!(found.held.len(), anew.held.len(), "{what}");
                assert_eq!(found.notes, anew.notes, "{what}");
            }
        }
    }
}

/// `n` blocks beside each other on rollers, the last one clamped, pushed with 1 at the left and with `back` at the top of
/// the one in the middle, to the left.
fn row_of_blocks(n: usize, back: f64) -> Problem {
    let mut build = Build::default();
    let names: Vec<_> = (0..n).map(|i| format!("b{i}")).collect();
    for (i, name) in names.iter().enumerate() {
        let x = i as f64;
        build.block(name, [x, 0.0], [x + 1.0, 1.0], 1);
    }
    // Lines are looked for among all edges: rollers and contacts body by body would take long.
    for name in &names {
        let x = name[1..].parse::<f64>().unwrap();
        build.roller(name, [[x, 0.0], [x + 1.0, 0.0]]);
    }
    for (i, pair) in names.windows(2).enumerate() {
        let x = i as f64 + 1.0;
        build.contact(&pair[0], &pair[1], [[x, 0.0], [x, 1.0]]);
    }
    let (middle, end) = ((n / 2) as f64, n as f64);
    build.push("b0", [[0.0, 0.0], [0.0, 1.0]], [1.0, 0.0]);
    build.push(&names[n / 2], [[middle, 1.0], [middle + 1.0, 1.0]], [-back, 0.0]);
    build.clamp(&names[n - 1], [[end, 0.0], [end, 1.0]]);
    build.problem()
}

#[test]
fn rows_of_blocks_stand_until_one_is_pushed_off() {
    let n = 120;
    for back in [0.0, 0.5, 1.0 - 1e-7] {
        let statics = check(&row_of_blocks(n, back)).unwrap();
        assert!(matches!(statics.equilibrium, Solvability::Possible { .. }), "{back}");
        assert!(statics.held.is_empty());
    }
    for back in [1.0 + 1e-6, 3.0] {
        let statics = check(&row_of_blocks(n, back)).unwrap();
        let Solvability::Impossible { bodies, sentence, work, .. } = &statics.equilibrium else { panic!("{back}") };
        assert_eq!(bodies[0].bodies, ["b60"]);
        assert_eq!(bodies.len(), n / 2 + 1);
        assert!(matches!(bodies[0].kind, MotionKind::LiftsOff { centre: None }), "{sentence}");
        // All that is left of the middle moves by one.
        assert!((work - (back - 1.0)).abs() < 1e-9, "{work}");
    }
}

proptest! {
    #[test]
    fn null_vectors_span_what_no_row_sees(
        entries in proptest::collection::vec((0usize..9, 0usize..6, -1.0..1.0f64), 1..30),
    ) {
        let matrix = entries.iter().fold(DMatrix::<f64>::zeros(9, 6), |mut all, (i, k, v)| {
            all[(*i, *k)] = *v;
            all
        });
        let row = |i: usize| (0..6).map(|k| (k, matrix[(i, k)])).filter(|e| e.1 != 0.0).collect::<Row>();
        let rows: Vec<Row> = (0..9).map(row).collect();
        let smallest = matrix.singular_values().iter().copied().filter(|s| *s > 1e-12).fold(1.0, f64::min);
        prop_assume!(smallest > 1e-4);
        let null = Triangular::of(6, &rows).null_vectors();
        prop_assert_eq!(null.len(), 6 - matrix.rank(1e-8));
        for vector in &null {
            prop_assert!((&matrix * dense(vector, 6)).amax() < 1e-9 * dense(vector, 6).amax());
        }
        // The rest of a least-squares problem is orthogonal to all columns.
        let b: Vec<f64> = (0..9).map(|i| (i as f64 * 0.7).sin()).collect();
        let (_, rest) = least_squares(&rows, 6, &b);
        prop_assert!((matrix.transpose() * DVector::from_vec(rest)).amax() < 1e-12);
    }
}
