//! Scene A and B: two unit blocks, with and without lift-off, against an independent numpy model of the same elements.

use crate::support::Blocks;
use hypercircle::bounds::{admissible, complementary, local_gap, potential};
use hypercircle::dual::{self, ActiveSet, Condensed, DualMethod, Options};

const SCENE_A: [(usize, f64, usize); 6] = [
    (2, -1.8477439265, 1),
    (4, -1.8051124296, 3),
    (8, -1.7972865675, 6),
    (16, -1.7965370927, 13),
    (32, -1.7964445688, 25),
    (64, -1.7964236307, 51),
];
const SCENE_B: [(usize, f64); 4] = [(2, -0.4299880678), (4, -0.4275808346), (8, -0.4269994402), (16, -0.4268857928)];

fn bracket(blocks: &Blocks, method: &dyn DualMethod) -> (f64, f64, f64, usize, f64) {
    let problem = blocks.problem();
    let dual = dual::solve(method, &problem, &[], &Options::default()).expect("solves");
    let c = complementary(&problem, &dual.stress);
    let v = admissible(&problem, &dual, c.lower(), None).expect("admissible");
    let upper = potential(&problem, &v).total();
    let local = local_gap(&problem, &dual.stress, &v).total;
    assert!(
        (upper - c.lower() - local).abs() <= 1e-9 * c.strain,
        "gap {} from energies, {local} from local terms",
        upper - c.lower()
    );
    let open = dual.closed.values().iter().filter(|c| !**c).count();
    println!(
        "{} n={} lower {:.10} upper {:.10} open {open} eq {:.1e} steps {} {:?}",
        dual.method,
        blocks.n,
        c.lower(),
        upper,
        dual.equilibrium.residual(),
        dual.iterations,
        dual.seconds
    );
    (c.lower(), upper, c.strain, open, dual.equilibrium.residual())
}

#[test]
fn scene_a_reproduces_the_independent_energies() {
    for method in [&Condensed::default() as &dyn DualMethod, &ActiveSet::default()] {
        for (n, energy, open_ends) in SCENE_A {
            let (lower, upper, _, open, residual) = bracket(&Blocks { n, ..Blocks::default() }, method);
            assert!((lower - energy).abs() < 1e-9, "{} at n = {n}: {lower} for {energy}", method.name());
            assert!(upper > lower);
            assert_eq!(open, open_ends);
            assert!(residual < 1e-11);
        }
    }
}

#[test]
fn scene_b_stays_closed() {
    for (n, energy) in SCENE_B {
        let (lower, _, _, open, _) =
            bracket(&Blocks { n, load: (1.5, -1.8), ..Blocks::default() }, &Condensed::default());
        assert!((lower - energy).abs() < 1e-9);
        assert_eq!(open, 0);
    }
}

#[test]
fn the_bracket_does_not_widen_towards_incompressibility() {
    for n in [8, 16] {
        let gaps = [0.3, 0.49, 0.4999, 0.499999].map(|nu| {
            let (lower, upper, strain, _, _) =
                bracket(&Blocks { n, materials: [(1.0, nu); 2], ..Blocks::default() }, &Condensed::default());
            (upper - lower) / strain
        });
        println!("{gaps:?}");
        assert!(gaps[3] < 1.5 * gaps[2] && gaps[3] < 6.0 * gaps[0]);
    }
}
