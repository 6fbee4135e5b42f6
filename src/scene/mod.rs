//! The scene: what the user wrote in `scene.toml`, once it has been checked.
//!
//! A [`Scene`] that exists is valid in everything that can be judged without a mesh: every number is finite, every
//! material is admissible, no boundary carries two conditions, every key is known. What only the mesh can tell
//! (whether the named boundaries exist, whether contact sides coincide) is checked by [`crate::mesh`] and
//! [`crate::problem`].

mod centre;
mod draft;
pub(crate) mod keys;
mod quantity;
pub mod reading;

use std::path::PathBuf;

use crate::elasticity::{Elasticity, Initial};

pub use crate::load::Affine;
use crate::load::BodyForce;
pub use draft::Draft;
pub(crate) use draft::{key as toml_key, quoted as toml_string};
pub use keys::bonds::Bond;
pub(crate) use keys::bonds::Joint;
pub use keys::circle::Circle;
pub use keys::files::Part;
pub use keys::friction::FrictionBound;
pub use keys::obstacle::{Obstacle, Shape};
pub use keys::range::{DataRange, Ranged};
pub use keys::selection::{BodyCells, Boundary, Edges, Group};
pub use quantity::{Component, Extent, Holder, Invariant, Mode, PointValue, Quantity, Region, Target};
pub use reading::error::{Fault, SceneError};
pub use reading::raw::schema;
pub use reading::read::BoundaryUse;
pub use reading::source::{capital, counted};
pub use reading::validate::scene_name;

/// Most bytes a scene file may have; a device that never ends is not read for ever.
const MAX_BYTES: u64 = 64 << 20;

/// A valid scene: a [`Draft`] that was checked, whose fields are read as if they were its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    pub(crate) draft: Draft,
}

/// The plane state, which fixes the compliance constants α, β, γ after (3.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Kinematics {
    /// No strain across the plane: ε_33 = 0
    PlaneStrain,
    /// No stress across the plane: σ_33 = 0
    PlaneStress,
    /// A body of revolution: points are (r, z)
    Axisymmetric,
}

impl Kinematics {
    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Kinematics::PlaneStrain => "plane-strain",
            Kinematics::PlaneStress => "plane-stress",
            Kinematics::Axisymmetric => "axisymmetric",
        }
    }

    /// The one of this name.
    pub fn named(name: &str) -> Option<Self> {
        <Self as clap::ValueEnum>::value_variants().iter().copied().find(|k| k.name() == name)
    }

    /// Its name in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Kinematics::PlaneStrain => "plane strain",
            Kinematics::PlaneStress => "plane stress",
            Kinematics::Axisymmetric => "a body of revolution",
        }
    }

    /// Factor of integrals over the figure where no thickness is given: the whole turn for a body of revolution.
    pub fn measure(self) -> f64 {
        if self == Kinematics::Axisymmetric { std::f64::consts::TAU } else { 1.0 }
    }
}

/// `[mesh]` or `[geometry]`.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A mesh file, path already resolved against the scene's folder.
    File(PathBuf),
    /// Several mesh files that together are the mesh.
    Parts(Vec<Part>),
    /// Polygons, meshed by the program.
    Geometry {
        /// Target edge length; `None` asks for the coarsest mesh that represents geometry and data.
        size: Option<f64>,
        /// The polygons in the order of the file.
        polygons: Vec<Polygon>,
    },
}

/// One simple polygon of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Name of the body it belongs to.
    pub body: String,
    /// Corners, in either orientation.
    pub points: Vec<[f64; 2]>,
    /// Name of the edge from corner i to corner i + 1; empty means free and unnamed.
    pub edges: Vec<String>,
    /// Edges that are arcs of circles.
    pub arcs: Vec<Arc>,
}

/// An edge of a polygon that is an arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The edge, from 0.
    pub edge: usize,
    /// A point that the arc passes through between the ends of the edge.
    pub through: [f64; 2],
}

/// A homogeneous body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its name, equal to the physical surface or `geometry.polygons.body`.
    pub name: String,
    /// Its material.
    pub elasticity: Elasticity,
    /// Its strains and stresses without load.
    pub initial: Initial,
    /// Body force F (force per volume).
    pub body_force: BodyForce,
}

impl Body {
    /// A body with Young's modulus E > 0 and Poisson's ratio ν in (−1, ½), without body force.
    pub fn isotropic(name: impl Into<String>, young: f64, poisson: f64) -> Self {
        Body {
            name: name.into(),
            elasticity: Elasticity::Isotropic { young, poisson },
            initial: Initial::default(),
            body_force: BodyForce::NONE,
        }
    }
}

/// A supported boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// Name of the boundary.
    pub on: String,
    /// The kind of support.
    pub kind: SupportKind,
}

/// Γ_u or Γ_0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SupportKind {
    /// u = displacement.
    Clamped {
        /// u0.
        displacement: Affine,
    },
    /// One component of u is prescribed, and there is no traction across it.
    Roller {
        /// Unit vector; the outward normal where it is `None`.
        direction: Option<[f64; 2]>,
        /// The prescribed component.
        displacement: f64,
    },
    /// Springs to the ground: traction −k u.
    Spring {
        /// Force per area and displacement, normal and tangential: neither below zero, one of them above.
        stiffness: [f64; 2],
    },
}

impl SupportKind {
    /// Clamped where it is.
    pub const CLAMPED: Self =
        SupportKind::Clamped { displacement: Affine { value: [0.0; 2], gradient: [[0.0; 2]; 2] } };
    /// Rollers along the boundary.
    pub const ROLLER: Self = SupportKind::Roller { direction: None, displacement: 0.0 };
}

/// A loaded boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Traction {
    /// Name of the boundary.
    pub on: String,
    /// The load.
    pub load: Load,
    /// Its terms beyond an affine load.
    pub terms: Vec<Term>,
}

/// A term value · xⁱ yʲ of a traction, in coordinates as written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// i and j.
    pub powers: [u8; 2],
    /// Its factor.
    pub value: [f64; 2],
}

impl Term {
    /// The highest degree of terms.
    pub const HIGHEST: u8 = 6;

    /// i + j.
    pub fn degree(&self) -> usize {
        usize::from(self.powers[0]) + usize::from(self.powers[1])
    }
}

/// Load on Γ_τ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// P(x).
    Affine(Affine),
    /// P = −pressure · n with the outward normal n.
    Pressure(f64),
}

/// A unilateral contact, without friction, with a given bound of the tangential traction, or with Coulomb friction.
#[derive(Debug, Clone, PartialEq)]
pub struct Contact {
    /// The two boundaries, or the one that meets a rigid obstacle.
    pub sides: ContactSides,
    /// Initial gap g; below zero only as one number, an interference fit.
    pub gap: Gap,
    /// Where the directions of contact come from.
    pub normals: Normals,
    /// Unit vector along which sides that need not coincide are matched, and contact acts.
    pub direction: Option<[f64; 2]>,
    /// A rigid obstacle that is not of the shape of the boundary.
    pub obstacle: Option<Obstacle>,
    /// Bound of the tangential traction; `None` without friction, and with Coulomb's.
    pub friction: Option<FrictionBound>,
    /// Coulomb's coefficient of friction; `None` without.
    pub coefficient: Option<f64>,
    /// Force per area and penetration beyond the gap of an elastic contact; `None` where nothing penetrates.
    pub stiffness: Option<f64>,
}

/// Where the directions of contact come from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Normals {
    /// From the vertices: edges that turn by up to 30° stand for a curve, see [`crate::problem::Direction`].
    #[default]
    Smooth,
    /// Every edge has its own normal.
    Facets,
}

/// The sides of one contact.
#[derive(Debug, Clone, PartialEq)]
pub enum ContactSides {
    /// Two boundaries that coincide as polylines; forces are reported on the first.
    Between([String; 2]),
    /// One boundary against a rigid, fixed obstacle of the same shape.
    Rigid(String),
}

impl Contact {
    /// Contact with directions from smooth normals.
    pub fn new(sides: ContactSides, gap: Gap) -> Self {
        let (normals, direction, obstacle) = (Normals::default(), None, None);
        Contact { sides, gap, normals, direction, obstacle, stiffness: None, friction: None, coefficient: None }
    }

    /// Name used in reports and check names: `first|second`, or `first|rigid`.
    pub fn name(&self) -> String {
        match &self.sides {
            ContactSides::Between([a, b]) => format!("{a}|{b}"),
            ContactSides::Rigid(a) => format!("{a}|rigid"),
        }
    }

    /// Name of the first side.
    pub fn first(&self) -> &str {
        match &self.sides {
            ContactSides::Between([a, _]) => a,
            ContactSides::Rigid(a) => a,
        }
    }
}

/// Initial gap along the first side.
#[derive(Debug, Clone, PartialEq)]
pub enum Gap {
    /// Uniform along the side.
    Constant(f64),
    /// Piecewise linear: (s, g) with s ascending, s being the arc length from the end of the first side that comes
    /// first in (x, y) order; all around a body anticlockwise, from its first vertex in that order. Constant beyond the
    /// first and the last entry.
    Table(Vec<[f64; 2]>),
    /// The distance of a circle that touches at an arc length; from where it turns away by 45° on, that of its tangent.
    Circle(Touching),
    /// As [`Gap::Circle`], with a parabola.
    Parabola(Touching),
}

/// A curve that touches a straight side from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touching {
    /// Radius of curvature at the point that touches, positive.
    pub radius: f64,
    /// Arc length of that point.
    pub at: f64,
}

impl Gap {
    /// g at arc length `s`.
    pub fn at(&self, s: f64) -> f64 {
        match self {
            Gap::Constant(g) => *g,
            Gap::Table(rows) => keys::table::at(rows, s),
            Gap::Circle(circle) => circle.distance(s - circle.at),
            Gap::Parabola(Touching { radius, at }) => (s - at).powi(2) / (2.0 * radius),
        }
    }
}

impl Touching {
    /// How far from where it touches a circle is taken as round: the tangent there leaves the side at 45°.
    pub fn round(&self) -> f64 {
        self.radius * std::f64::consts::FRAC_1_SQRT_2
    }

    /// The distance of a circle from the side, at `x` along it from where it touches.
    fn distance(&self, x: f64) -> f64 {
        let Touching { radius, .. } = self;
        let round = x.abs().min(self.round());
        // Without loss of digits near the point that touches.
        round * round / (radius + (radius * radius - round * round).sqrt()) + (x.abs() - round)
    }

    /// The slope of that distance.
    pub fn slope(&self, x: f64) -> f64 {
        let round = x.abs().min(self.round());
        (round / ((self.radius - round) * (self.radius + round)).sqrt()).copysign(x)
    }
}

impl Gap {
    /// The arc lengths at which the gap bends or touches, and which have to be vertices.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Gap::Constant(_) => Vec::new(),
            Gap::Table(rows) => rows.iter().map(|row| row[0]).collect(),
            Gap::Circle(touching) | Gap::Parabola(touching) => vec![touching.at],
        }
    }
}

/// A remark about how a scene was represented.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
pub struct Note {
    /// Whether it makes the bounds less than guaranteed for the scene as written.
    pub weakens_guarantee: bool,
    /// The remark, one sentence or two.
    pub text: String,
}
