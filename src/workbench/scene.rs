//! The scene that elements are solved on: a square on rollers, pulled unevenly. Its exact energy is enclosed by the program itself.

use std::path::Path;

use super::finding::Fault;
use super::material::Material;
use crate::dual::{Condensed, Options};
use crate::element::{Elements, EquilibriumElement, block};
use crate::problem::Problem;
use crate::scene::Scene;
use crate::study::{Certified, certify};

/// The degree of the stresses that enclose the exact energy.
const DEGREE: usize = 5;

/// The traction along x on the side x = 1 of the unit square; x = 0 and y = 0 are rollers, y = 1 is free. Extended by symmetry,
/// the solution is smooth up to a kink of the load.
pub fn load(y: f64) -> f64 {
    1.0 - 1.5 * y
}

/// Lower bound −Π(λ_h), upper bound, and 𝒮(λ_h) of the scene, which all lie within a millionth or so.
#[derive(Debug, Clone, Copy)]
pub struct Exact {
    /// No displacement has less.
    pub lower: f64,
    /// The exact energy is no larger.
    pub upper: f64,
    /// ½∫ a λ:λ.
    pub strain: f64,
}

/// The scene in a material, meshed with edges of about `size`.
///
/// # Errors
/// The library refuses its own scene.
pub fn problem(material: &Material, size: f64) -> Result<Problem, Fault> {
    let Material { kinematics, young, poisson, thickness } = material;
    let kinematics = kinematics.name();
    let [value, slope] = [load(0.0), load(1.0) - load(0.0)];
    let text = format!(
        "model = {{ kinematics = \"{kinematics}\", thickness = {thickness:e} }}\n\
         geometry.size = {size}\n\
         bodies.square = {{ young = {young:e}, poisson = {poisson:e} }}\n\
         supports = [{{ on = \"left\", type = \"roller\" }}, {{ on = \"below\", type = \"roller\" }}]\n\
         tractions = [{{ on = \"right\", value = [{value:?}, 0.0], gradient = [[0.0, {slope:?}], [0.0, 0.0]] }}]\n\
         [[geometry.polygons]]\n\
         body = \"square\"\n\
         points = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
         edges = [\"below\", \"right\", \"\", \"left\"]\n"
    );
    let scene = Scene::parse(&text, Path::new("square.toml")).map_err(|e| Fault::Failed(e.to_string()))?;
    Problem::load(scene).map_err(|e| Fault::Failed(e.to_string()))
}

/// The scene solved with `element` on a mesh of about that size.
///
/// # Errors
/// There is no solution.
pub fn solved(material: &Material, size: f64, element: &'static dyn EquilibriumElement) -> Result<Certified, Fault> {
    let options = Options { elements: Elements::Uniform(element), ..Options::default() };
    certify(problem(material, size)?, &Condensed::default(), &options).map_err(|e| Fault::Failed(e.to_string()))
}

/// What encloses the exact energy.
///
/// # Errors
/// The library cannot solve its own scene.
pub fn exact(material: &Material) -> Result<Exact, Fault> {
    let Certified { bracket, .. } = solved(material, 0.2, block(DEGREE))?;
    let upper = bracket.free.as_ref().map_err(|e| Fault::Failed(e.to_string()))?.upper();
    Ok(Exact { lower: bracket.lower(), upper, strain: bracket.complementary.strain })
}

impl Exact {
    /// √(gap / 𝒮): how far a displacement with this energy can be from the exact one, relative to it, in the energy norm.
    pub fn guaranteed(&self, energy: f64) -> f64 {
        ((energy - self.lower).max(0.0) / self.strain).sqrt()
    }
}
