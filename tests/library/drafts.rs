//! Scenes made by a program: the same checks as those that are read, and the same scene back.

use std::path::{Path, PathBuf};

use hypercircle::elasticity::Elasticity;
use hypercircle::scene::{
    Affine, Body, Bond, Component, Contact, ContactSides, Draft, Extent, FrictionBound, Gap, Holder, Kinematics, Load,
    MeshSource, Polygon, Quantity, Region, Scene, SceneError, Support, SupportKind, Target, Term, Traction,
};

use crate::support::scenes::sample;

/// A clamped square with a load on top, that meets the ground.
fn square() -> Draft {
    let polygon = Polygon {
        body: "block \"a\"".into(),
        points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0], [0.0, 1.0]],
        edges: ["ground", "wall", "top", "left", "right"].map(String::from).to_vec(),
        arcs: Vec::new(),
    };
    let quantity = |name: &str, target| Quantity { name: name.into(), target };
    let side = Target::Displacement { of: Extent::Boundary("top".into()), direction: [0.6, -0.8] };
    let along = Component::along([0.8, -0.6]);
    Draft {
        title: "A \u{201c}square\u{201d}\\ \u{1}".into(),
        bodies: vec![Body { body_force: [0.0, -1e-300].into(), ..Body::isotropic("block \"a\"", 0.1 + 0.2, -0.25) }],
        supports: vec![Support {
            on: "wall".into(),
            kind: SupportKind::Clamped { displacement: Affine::constant([1.0 / 3.0, 0.0]) },
        }],
        tractions: vec![Traction {
            on: "top".into(),
            load: Load::Affine(Affine { value: [0.0, -1e20], gradient: [[0.0, 1.0], [2.0, -0.0]] }),
            terms: vec![Term { powers: [2, 1], value: [1e-3, -0.0] }],
        }],
        contacts: vec![Contact {
            friction: Some(FrictionBound::Table(vec![[0.0, 0.5], [0.75, 0.0]])),
            ..Contact::new(ContactSides::Rigid("ground".into()), Gap::Table(vec![[0.0, 0.1], [0.5, 0.0]]))
        }],
        bonds: vec![Bond {
            sides: ["left".into(), "right".into()],
            stiffness: Some([2.5, 0.1]),
            direction: Some([0.6, 0.8]),
        }],
        quantities: vec![
            quantity("side", side),
            quantity("all", Target::Displacement { of: Extent::Body(0), direction: [0.0, 1.0] }),
            quantity(
                "part",
                Target::ContactForce { contact: 0, tangential: false, window: Some([0.0, 0.0, 0.25, 0.5]) },
            ),
            quantity("whole", Target::ContactForce { contact: 0, tangential: false, window: None }),
            quantity("wall", Target::SupportForce { support: 0, direction: [1.0, 0.0] }),
            quantity("turn", Target::Moment { of: Holder::Contact(0), about: [0.5, 0.25] }),
            quantity("xy", Target::Stress { body: 0, region: Region::Whole, component: Component::XY }),
            quantity("along", Target::Stress { body: 0, region: Region::Whole, component: along }),
        ],
        ..Draft::new(
            "square",
            Kinematics::PlaneStress,
            MeshSource::Geometry { size: Some(0.3), polygons: vec![polygon] },
        )
    }
}

#[test]
fn a_scene_is_made_of_what_it_was_given() {
    let scene = Scene::new(square()).expect("a valid scene");
    let mut found = (*scene).clone();
    // The direction of a normal stress is known by its squares.
    let Some(Quantity { target: Target::Stress { component, .. }, .. }) = found.quantities.last_mut() else { panic!() };
    let [own, given] = [component.factors(), Component::along([0.8, -0.6]).factors()];
    assert!(own.iter().zip(given).all(|(a, b)| (a - b).abs() < 1e-15), "{own:?}");
    *component = Component::along([0.8, -0.6]);
    assert_eq!(found, square());
}

#[test]
fn parts_that_make_no_scene_are_refused_as_in_a_file() {
    let refused = |change: &dyn Fn(&mut Draft), fragment: &str| {
        let scene = Scene::new(square()).expect("a valid scene");
        let error: SceneError = scene.changed(change).expect_err(fragment);
        assert!(error.to_string().contains(fragment), "{error}");
    };
    refused(&|draft| draft.bodies[0].elasticity = Elasticity::Isotropic { young: 1.0, poisson: 0.5 }, "incompressible");
    refused(&|draft| draft.bodies[0].elasticity = Elasticity::Isotropic { young: f64::NAN, poisson: 0.3 }, "finite");
    refused(&|draft| draft.thickness = f64::INFINITY, "finite");
    refused(&|draft| draft.bodies.clear(), "bod");
    refused(&|draft| draft.supports[0].on = "ceiling".into(), "ceiling");
    refused(&|draft| draft.tractions[0].on = "wall".into(), "two conditions");
    refused(&|draft| draft.contacts[0].gap = Gap::Table(vec![[0.5, 0.0], [0.0, 0.0]]), "gap");
    refused(&|draft| draft.quantities[0].name = "a=b".into(), "the sign =");
    refused(
        &|draft| draft.quantities[3].target = Target::ContactForce { contact: 7, tangential: false, window: None },
        "force",
    );
}

/// The scenes of the repository, and random ones.
fn written() -> Vec<Scene> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scenes = Vec::new();
    for folder in ["cases", "tests/scenes"] {
        let entries =
            std::fs::read_dir(root.join(folder)).expect("a folder").map(|entry| entry.expect("readable").path());
        let files: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
        scenes.extend(files.iter().map(|path| Scene::read(path).unwrap_or_else(|e| panic!("{e}"))));
    }
    let folder = tempfile::tempdir().expect("a folder");
    scenes.extend((1..=200).map(|seed| Scene::read(&sample(seed).write(folder.path())).expect("a scene")));
    scenes
}

#[test]
fn every_scene_is_the_same_once_more() {
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-15;
    let scenes = written();
    assert!(scenes.len() > 220);
    for scene in scenes {
        let mut again = (*Scene::new((*scene).clone()).unwrap_or_else(|e| panic!("{}: {e}", scene.name))).clone();
        // Directions are made unit vectors once more.
        for (own, given) in again.contacts.iter_mut().zip(&scene.contacts) {
            if let (Some(a), Some(b)) = (own.direction, given.direction) {
                assert!(near(a, b));
                own.direction = Some(b);
            }
        }
        for (own, given) in again.quantities.iter_mut().zip(&scene.quantities) {
            use Target::{Displacement, SupportForce};
            match (&mut own.target, &given.target) {
                (Displacement { direction: a, .. }, Displacement { direction: b, .. })
                | (SupportForce { direction: a, .. }, SupportForce { direction: b, .. }) => {
                    assert!(near(*a, *b));
                    *a = *b;
                }
                _ => (),
            }
        }
        assert_eq!(again, *scene, "{}", scene.name);
    }
}
