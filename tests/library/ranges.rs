//! Data that are known as ranges: the bounds of the two ends enclose the energies of all data between.

use crate::support::random::Random;
use crate::support::scenes::stack::slanted;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::elasticity::Elasticity;
use hypercircle::problem::Problem;
use hypercircle::scene::{Gap, Ranged, Scene};
use hypercircle::study::{StudyError, certify};

fn scene(text: &str) -> Scene {
    Scene::parse(text, "ranges.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The bounds of the energy of a scene; `None` without an equilibrium that its mesh can express.
fn bounds(scene: Scene) -> Option<[f64; 2]> {
    let problem = Problem::load(scene).expect("a problem");
    match certify(problem, &Condensed::default(), &Options::default()) {
        Ok(own) => Some([own.bracket.lower(), own.bracket.free.as_ref().expect("an upper bound").upper()]),
        Err(StudyError::NoEquilibrium { .. } | StudyError::BeyondMesh { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn energies_of_data_between_lie_between() {
    let mut random = Random::new(17);
    let mut found = 0;
    while found < 6 {
        let given = slanted(&mut random).size(0.6).text();
        // Every modulus and every gap that is a number becomes a range that holds it.
        let ranged = |line: &str| match line.split_once(" = ") {
            Some((key @ ("young" | "gap"), value)) => match value.parse::<f64>() {
                Ok(value) => format!("{key} = [{:?}, {:?}]", 0.8 * value, 1.3 * value),
                Err(_) => line.to_string(),
            },
            _ => line.to_string(),
        };
        let text: String = given.lines().map(|line| ranged(line) + "\n").collect();
        let soft = scene(&text);
        assert!(soft.ranges.len() > 1, "{text}");
        let stiff = soft.of_highest_energy().expect("ranges");
        assert!(stiff.of_highest_energy().is_none());
        let (Some([lower, above]), Some([below, upper])) = (bounds(soft.clone()), bounds(stiff)) else { continue };
        found += 1;
        assert!(lower <= above && below <= upper && lower < below, "{text}");
        for _ in 0..3 {
            let mut between = soft.changed(|draft| draft.ranges.clear()).expect("a scene");
            for range in &soft.ranges {
                let value = random.between(range.low, range.high.max(range.low + 1e-12));
                between = between
                    .changed(|draft| match range.of {
                        Ranged::Young(body) => {
                            let poisson = draft.bodies[body].elasticity.isotropic().map_or(0.0, |[_, nu]| nu);
                            draft.bodies[body].elasticity = Elasticity::Isotropic { young: value, poisson };
                        }
                        Ranged::Gap(contact) => draft.contacts[contact].gap = Gap::Constant(value),
                        Ranged::Friction(_) | Ranged::Spring(..) | Ranged::Layer(..) | Ranged::Contact(_) => {
                            unreachable!("none here")
                        }
                    })
                    .expect("a scene");
            }
            let Some([low, high]) = bounds(between.clone()) else { continue };
            // The exact energy lies in both.
            assert!(low <= upper && lower <= high, "{low} {high} {lower} {upper}\n{}", between.to_toml());
            let slack = 1e-12 * (lower.abs() + upper.abs());
            // Bounds of one mesh are monotone themselves: each is that of a minimum over fields that know nothing of the data, or of less.
            assert!(low >= lower - slack, "{low} {lower}\n{}", between.to_toml());
        }
    }
}

#[test]
fn ranges_are_kept_in_the_file() {
    let text = Toml::default()
        .polygon("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "head", ""])
        .pressure("head", 1.0)
        .table("[[contacts]]\non = \"foot\"\ngap = [0.0, 0.25]")
        .text()
        .replace("young = 1.0", "young = [1.5, 2]");
    let own = scene(&text);
    let ends: Vec<_> = own.ranges.iter().map(|r| (r.of, r.low, r.high, r.softest(), r.stiffest())).collect();
    assert_eq!(ends, [(Ranged::Young(0), 1.5, 2.0, 1.5, 2.0), (Ranged::Gap(0), 0.0, 0.25, 0.25, 0.0)]);
    assert_eq!(own.bodies[0].elasticity.isotropic(), Some([1.5, 0.3]));
    assert_eq!(own.contacts[0].gap, Gap::Constant(0.25));
    let again = own.changed(|_| ()).expect("the same");
    assert_eq!(again.ranges, own.ranges);
    let stiff = own.of_highest_energy().expect("ranges");
    assert_eq!(stiff.bodies[0].elasticity.isotropic(), Some([2.0, 0.3]));
    assert_eq!(stiff.contacts[0].gap, Gap::Constant(0.0));
    assert_eq!(own.name_of(&own.ranges[0]), "Young's modulus of a");
}

/// Springs and layers: the exact energy of two springs in series under a unit force is −½ (1/k + 1/l) in the width 1.
#[test]
fn stiffnesses_may_be_ranges() {
    let text = Toml::default()
        .size(1.0)
        .model("plane-stress", 1.0)
        .polygon("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "seat", ""])
        .polygon("b", &[[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], ["under", "", "head", ""])
        .material("a", 1e9, 0.0)
        .material("b", 1e9, 0.0)
        .pressure("head", 1.0)
        .table("[[supports]]\non = \"foot\"\ntype = \"spring\"\nstiffness = [[1.0, 2.0], 5.0]")
        .table("[[bonds]]\nbetween = [\"seat\", \"under\"]\nstiffness = [[4.0, 8.0], [1.0, 3.0]]")
        .text();
    let soft = scene(&text);
    let names: Vec<String> = soft.ranges.iter().map(|range| soft.name_of(range)).collect();
    assert_eq!(names[0], "the normal stiffness of the springs on foot");
    assert_eq!(names[2], "the tangential stiffness of the layer seat|under");
    assert_eq!(soft.changed(|_| ()).expect("the same").ranges, soft.ranges);
    let stiff = soft.of_highest_energy().expect("ranges");
    let energy = |k: f64, l: f64| -0.5 * (1.0 / k + 1.0 / l);
    for (scene, exact) in [(soft, energy(1.0, 4.0)), (stiff, energy(2.0, 8.0))] {
        for bound in bounds(scene).expect("a solution") {
            assert!((bound - exact).abs() < 1e-7, "{bound} {exact}");
        }
    }
}
