//! Arguments of each tool.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

/// What `solve` takes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solve {
    /// The scene: the text of a TOML file. Mesh files are named relative to the folder of the server.
    pub scene: String,
    /// Polynomial degree of the stresses, from 1.
    #[serde(default)]
    pub degree: Option<u32>,
    /// Uniform refinements of the mesh before solving.
    #[serde(default)]
    pub refine: Option<u32>,
    /// Refine adaptively until the guaranteed relative energy-norm error is below this, for instance 0.01.
    #[serde(default)]
    pub tolerance: Option<f64>,
    /// Refine adaptively until the half-width of the interval of each quantity that is named here is below this part of its value.
    #[serde(default)]
    pub tolerance_of: BTreeMap<String, f64>,
    /// Triangles beyond which no mesh is refined.
    #[serde(default)]
    pub max_triangles: Option<usize>,
    /// Seconds after which no finer mesh is begun.
    #[serde(default)]
    pub max_seconds: Option<f64>,
}

/// What `verify` takes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Verify {
    /// The scene: the text of a TOML file. Mesh files are named relative to the folder of the server.
    pub scene: String,
    /// Polynomial degree of the stresses, from 1.
    #[serde(default)]
    pub degree: Option<u32>,
    /// Uniform refinements of the mesh before solving.
    #[serde(default)]
    pub refine: Option<u32>,
    /// Degrees of the displacement models; 1 and 2 where it is missing.
    #[serde(default)]
    pub primal_degree: Vec<u8>,
}

/// What `certify` takes: a field, as `file` or as `points`, `triangles` and `displacement`, or `values`, or both.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Certify {
    /// The scene: the text of a TOML file. Mesh files are named relative to the folder of the server.
    pub scene: String,
    /// A file with the displacement, relative to the folder of the server: VTU, VTK, FRD, UNV or MSH.
    #[serde(default)]
    pub file: Option<String>,
    /// Name of the point data that is the displacement.
    #[serde(default)]
    pub field: Option<String>,
    /// Points of a field without a file: x and y of each.
    #[serde(default)]
    pub points: Option<Vec<Vec<f64>>>,
    /// Its cells, by indices of points from 0: three or six of a triangle (corners, then the middles of (0, 1), (1, 2), (2, 0)); four, eight or nine of a quadrilateral.
    #[serde(default)]
    pub triangles: Option<Vec<Vec<usize>>>,
    /// Its displacement: two components at each point.
    #[serde(default)]
    pub displacement: Option<Vec<Vec<f64>>>,
    /// Claim that the field is the discrete solution of its mesh, and hold it to that.
    #[serde(default)]
    pub solution: bool,
    /// Values of quantities of the scene, from elsewhere, to hold against their intervals.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
    /// Refine the stresses until their guaranteed relative error is below this. It sharpens what is told of the field, and is no limit of the
    /// error of the field, which is `primal[0].relative_error_bound`.
    #[serde(default)]
    pub tolerance: Option<f64>,
}

/// What `diagnose` takes: a field, as `file` or as `points`, `triangles` and `displacement`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Diagnose {
    /// The scene: the text of a TOML file. Mesh files are named relative to the folder of the server.
    pub scene: String,
    /// A file with the displacement, relative to the folder of the server: VTU, VTK, FRD, UNV or MSH.
    #[serde(default)]
    pub file: Option<String>,
    /// Name of the point data that is the displacement.
    #[serde(default)]
    pub field: Option<String>,
    /// Points of a field without a file: x and y of each.
    #[serde(default)]
    pub points: Option<Vec<Vec<f64>>>,
    /// Its cells, by indices of points from 0, as in `certify`.
    #[serde(default)]
    pub triangles: Option<Vec<Vec<usize>>>,
    /// Its displacement: two components at each point.
    #[serde(default)]
    pub displacement: Option<Vec<Vec<f64>>>,
}

impl From<Diagnose> for Certify {
    fn from(asked: Diagnose) -> Self {
        let Diagnose { scene, file, field, points, triangles, displacement } = asked;
        let (solution, values, tolerance) = (true, BTreeMap::new(), None);
        Certify { scene, file, field, points, triangles, displacement, solution, values, tolerance }
    }
}

/// What `element` takes: the `name` of an element that comes with the program, or a `matrix` with its `nodes`; neither lists those that
/// there are.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Element {
    /// An element that comes with the program.
    #[serde(default)]
    pub name: Option<String>,
    /// A stiffness matrix, two rows a node.
    #[serde(default)]
    pub matrix: Option<Vec<Vec<f64>>>,
    /// Its nodes: x and y of each.
    #[serde(default)]
    pub nodes: Option<Vec<[f64; 2]>>,
    /// Young's modulus that the matrix is for.
    #[serde(default)]
    pub young: Option<f64>,
    /// Poisson's ratio that it is for.
    #[serde(default)]
    pub poisson: Option<f64>,
    /// Thickness that it is for; 1 where it is missing.
    #[serde(default)]
    pub thickness: Option<f64>,
    /// The plane state that it is for.
    #[serde(default)]
    pub kinematics: Option<PlaneState>,
    /// How its rows are numbered; x and y of the first node come first where it is missing.
    #[serde(default)]
    pub order: Option<Numbering>,
    /// How exact its entries are, relative to the largest.
    #[serde(default)]
    pub precision: Option<f64>,
}

impl Element {
    /// True if something is said of a matrix or of its material.
    pub fn is_of_matrix(&self) -> bool {
        let numbers = [self.young, self.poisson, self.thickness, self.precision];
        let others = self.nodes.is_some() || self.kinematics.is_some() || self.order.is_some();
        others || numbers.iter().any(Option::is_some)
    }
}

/// A plane state.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PlaneState {
    /// No strain across the plane.
    PlaneStrain,
    /// No stress across the plane.
    PlaneStress,
}

/// How the unknowns of a matrix are numbered.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Numbering {
    /// x0, y0, x1, …
    Interleaved,
    /// x0, x1, …, y0, …
    Blocked,
}
