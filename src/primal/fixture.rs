//! A problem made by hand for the tests: one bar of two triangles pressed against a rigid wall.

use std::path::PathBuf;

use crate::mesh::{Edge, Triangulation};
use crate::problem::{Bow, Condition, ContactPair, Direction, Interface, Problem};
use crate::scene::{Body, Draft, Kinematics, MeshSource, Scene};

/// The unit square, pressure 2 on its left, a rigid wall on its right, rollers below; E = 1, ν = 0, thickness ½.
///
/// Uniform stress: 𝓛 = −½ · 2² / E · ½ = −1, and the wall pushes back with (−1, 0).
pub(crate) fn pressed_square() -> Problem {
    let edge = |vertices, left, right| Edge { vertices, triangles: [Some(left), right], name: None };
    let mesh = Triangulation {
        points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        body: vec![0, 0],
        edges: vec![
            edge([0, 1], 0, None),
            edge([1, 2], 0, None),
            edge([2, 0], 0, Some(1)),
            edge([2, 3], 1, None),
            edge([3, 0], 1, None),
        ],
        triangle_edges: vec![[1, 2, 0], [3, 4, 2]],
        names: Vec::new(),
        cells: crate::mesh::FileCells::default(),
    };
    let pair = ContactPair {
        edges: [Some(1), None],
        first: [1, 2],
        second: None,
        normal: [1.0, 0.0],
        direction: Direction::constant([1.0, 0.0]),
        length: 1.0,
        arc: [0.0, 1.0],
        gap: [0.0, 0.0],
        bow: Bow::default(),
        friction: None,
        stiffness: None,
    };
    Problem {
        scene: Scene::unchecked(Draft {
            thickness: 0.5,
            bodies: vec![Body::isotropic("square", 1.0, 0.0)],
            ..Draft::new("square", Kinematics::PlaneStress, MeshSource::File(PathBuf::from("square.msh")))
        }),
        mesh,
        conditions: vec![
            Condition::Roller { direction: [0.0, -1.0], displacement: 0.0 },
            Condition::Contact { interface: 0, pair: 0, side: 0 },
            Condition::Interior,
            Condition::Traction([[0.0, 0.0]; 2]),
            Condition::Traction([[2.0, 0.0]; 2]),
        ],
        interfaces: vec![Interface { name: "right|rigid".to_owned(), pairs: vec![pair], centre: None }],
        beds: Vec::new(),
        notes: Vec::new(),
        refinement: crate::problem::Refinement::default(),
        counted: Default::default(),
        uncut: None,
    }
}
