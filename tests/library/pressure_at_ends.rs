//! How close to an end of contact a pressure of each degree can act: the resultant of one that presses with all its Bernstein
//! coefficients is no closer to an end of its edge than 1/(p + 2) of it.

use crate::support::toml::Toml;
use hypercircle::dual::{self, Clarabel, Condensed, DualMethod, Options};
use hypercircle::element::polynomial::side;
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::statics;
use hypercircle::study::{Certified, Goal, StudyError, adapt, certify};

/// A unit block that rests with a single edge on an obstacle, under a load of one whose line of action is at `x` = place.
fn block_on_an_edge(place: f64) -> Problem {
    // −(1 + k (½ − x)) has its centroid at ½ − k/12.
    let slope = 12.0 * (0.5 - place);
    let toml = Toml::default()
        .polygon("block", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", ""])
        .table(&format!(
            "[[tractions]]\non = \"top\"\nvalue = [0, {:?}]\ngradient = [[0, 0], [{slope:?}, 0]]",
            -1.0 - 0.5 * slope
        ))
        .rigid("foot");
    let problem =
        Problem::load(Scene::parse(&toml.text(), "block.toml".as_ref()).expect("a scene")).expect("a problem");
    assert_eq!(problem.interfaces[0].pairs.len(), 1, "one edge");
    problem
}

fn of_degree(p: usize) -> Options {
    Options { elements: Elements::Uniform(block(p)), ..Options::default() }
}

fn bounds(certified: &Certified) -> [f64; 2] {
    [certified.bracket.lower(), certified.bracket.free.as_ref().expect("an upper bound").upper()]
}

#[test]
fn a_load_between_a_quarter_and_a_third_asks_for_quadratic_stresses() {
    let problem = block_on_an_edge(0.29);
    let outcome = certify(problem.clone(), &Condensed::default(), &of_degree(1));
    assert!(matches!(outcome, Err(StudyError::BeyondMesh { .. })), "{outcome:?}");
    let found = certify(problem.clone(), &Condensed::default(), &of_degree(2)).expect("solved");
    let [low, high] = bounds(&found);
    // The truth, by linear stresses on finer meshes.
    let known = adapt(problem, &Condensed::default(), &of_degree(1), &Goal::new(0.02), |_| ()).expect("solved");
    assert_eq!(known.stopped, None);
    let [least, most] = bounds(&known.certified);
    assert!(low <= most && least <= high, "[{low}, {high}] and [{least}, {most}]");
}

#[test]
fn every_degree_reaches_its_part_of_the_edge_and_no_farther() {
    for p in 1..=5 {
        let reach = 1.0 / (p + 2) as f64;
        let within = block_on_an_edge(reach + 1e-3);
        let found = certify(within, &Condensed::default(), &of_degree(p)).unwrap_or_else(|e| panic!("{p}: {e}"));
        let pressure = found.dual.contact_traction[0].of(0);
        assert!(pressure.len() == p + 1 && pressure.iter().all(|t| *t <= 1e-9), "{p}: {pressure:?}");
        let force: f64 = pressure.iter().enumerate().map(|(k, t)| t * side::product(p, k, 0, 0)).sum();
        let moment: f64 = pressure.iter().enumerate().map(|(k, t)| t * side::product(p, k, 1, 1)).sum();
        let place = if found.problem.interfaces[0].pairs[0].first[0]
            == found.problem.mesh.points.iter().position(|q| *q == [0.0; 2]).expect("the corner")
        {
            moment / force
        } else {
            1.0 - moment / force
        };
        assert!((force + 1.0).abs() < 1e-9 && (place - reach - 1e-3).abs() < 1e-9, "{p}: {force} at {place}");

        let outside = block_on_an_edge(reach - 1e-3);
        let outcome = certify(outside.clone(), &Condensed::default(), &of_degree(p));
        assert!(matches!(outcome, Err(StudyError::BeyondMesh { .. })), "{p}: {outcome:?}");
        // Asked all the same, no method finds a stress: there is none.
        let held = statics::check(&outside).expect("decided");
        let motions = held.held_at_vertices(&outside);
        for method in [&Condensed::default() as &dyn DualMethod, &Clarabel::default()] {
            let outcome = dual::solve(method, &outside, &motions, &of_degree(p));
            assert!(outcome.is_err(), "{p}: {} found a stress", method.name());
        }
    }
}
