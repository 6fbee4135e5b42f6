//! Scenes at the limits of the numbers: contact that touches without force, and triangles so flat that rounding leaves
//! nothing of a pivot. Forces are held against statics.

use hypercircle::dual::{Condensed, Options};
use hypercircle::stability;
use hypercircle::study::{Certified, Goal, adapt};

fn refined(id: &str, value: f64, most: usize) -> Certified {
    let problem = stability::regime(id).expect("a regime").problem(value).expect("a problem");
    let goal = Goal { max_triangles: Some(most), ..Goal::new(0.02) };
    let adapted = adapt(problem, &Condensed::default(), &Options::default(), &goal, |_| ());
    adapted.unwrap_or_else(|e| panic!("{id} {value:e}: {e}")).certified
}

/// The force across the only contact, from its tractions.
fn force(found: &Certified) -> f64 {
    let pairs = found.problem.interfaces[0].pairs.iter().zip(found.dual.contact_traction[0].iter());
    pairs.map(|(pair, t)| 0.5 * pair.length * (t[0] + t[1])).sum()
}

#[test]
fn contact_that_touches_without_force_is_solved() {
    for load in [1e-9, 1e-12, 0.0] {
        let found = refined("loss", load, 5000);
        let residual = found.dual.equilibrium.residual();
        assert!(residual < 1e-11, "{load:e}: {residual:.1e}");
        assert!((force(&found) + load).abs() < 1e-11, "{load:e}: {:e}", force(&found));
    }
}

#[test]
fn flat_triangles_are_no_mechanism() {
    for (id, aspect, exact) in [("slivers", 1e5, -0.5), ("slivers-exact", 1e6, -0.625)] {
        let found = refined(id, aspect, 3000);
        let residual = found.dual.equilibrium.residual();
        println!("{id}: {} triangles, residual {residual:.1e}", found.problem.mesh.triangles.len());
        assert!(residual < 1e-9, "{id}: {residual:.1e}");
        assert!((force(&found) - exact).abs() < 1e-9, "{id}: {:e}", force(&found));
    }
}
