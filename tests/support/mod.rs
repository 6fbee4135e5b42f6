//! Scenes that several tests share, built without the mesher of the library.
#![allow(dead_code)]

pub mod asked;
pub mod blocks;
pub mod double_double;
pub mod element;
pub mod planted;
pub mod random;
pub mod scenes;
pub mod theory;
pub mod toml;
pub mod trial;

use hypercircle::mesh::Triangulation;
use hypercircle::problem::Problem;
use hypercircle::scene::*;

/// Parameters of a two-block scene.
#[derive(Clone)]
pub struct Blocks {
    /// Squares per side of each block.
    pub n: usize,
    pub kinematics: Kinematics,
    /// E and ν of the left and the right block.
    pub materials: [(f64, f64); 2],
    /// P = value + slope · y on x = 0, along x.
    pub load: (f64, f64),
    pub gap: Gap,
    /// Length of a block's side.
    pub size: f64,
}

impl Default for Blocks {
    fn default() -> Self {
        Blocks {
            n: 4,
            kinematics: Kinematics::PlaneStrain,
            materials: [(1.0, 0.3); 2],
            load: (4.0, -7.0),
            gap: Gap::Constant(0.0),
            size: 1.0,
        }
    }
}

impl Blocks {
    /// Left block [0,1]², right block [1,2]×[0,1] (times `size`): roller below the left block, traction on its left
    /// side, the right block clamped at its right side, contact between. Names as in [`blocks::grid`].
    pub fn problem(&self) -> Problem {
        let n = self.n;
        let h = 1.0 / n as f64;
        let raw = blocks::grid(n, |block, i, j| [self.size * (block as f64 + i as f64 * h), self.size * j as f64 * h]);
        let scene = self.scene();
        let (mesh, notes) = Triangulation::new(raw, &scene).expect("a valid mesh");
        Problem::new(scene, mesh, notes).expect("a valid problem")
    }

    pub fn scene(&self) -> Scene {
        let body = |name: &str, (young, poisson): (f64, f64)| Body::isotropic(name, young, poisson);
        let draft = Draft {
            bodies: vec![body("left", self.materials[0]), body("right", self.materials[1])],
            supports: vec![
                Support { on: "right_east".to_string(), kind: SupportKind::CLAMPED },
                Support { on: "left_south".to_string(), kind: SupportKind::ROLLER },
            ],
            tractions: vec![Traction {
                on: "left_west".to_string(),
                load: Load::Affine(Affine {
                    value: [self.load.0, 0.0],
                    gradient: [[0.0, self.load.1 / self.size], [0.0, 0.0]],
                }),
                terms: Vec::new(),
            }],
            contacts: vec![Contact::new(
                ContactSides::Between(["left_east".to_string(), "right_west".to_string()]),
                self.gap.clone(),
            )],
            ..Draft::new("two_blocks", self.kinematics, MeshSource::File("made".into()))
        };
        Scene::new(draft).expect("a valid scene")
    }
}
