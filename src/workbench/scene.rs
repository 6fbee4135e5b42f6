//! The scene that elements are solved on: a square on rollers, pulled unevenly. Its exact energy is enclosed by the program itself.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

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

/// Encloses the exact energy. Energies scale with thickness over Young's modulus, so that a scene is solved once for each
/// plane state and Poisson's ratio, however many elements are examined.
///
/// # Errors
/// The library cannot solve its own scene.
pub fn exact(material: &Material) -> Result<Exact, Fault> {
    static FOUND: Mutex<Vec<(Material, Exact)>> = Mutex::new(Vec::new());
    let unit = Material { young: 1.0, thickness: 1.0, ..*material };
    let known = || FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = known().iter().find(|(of, _)| *of == unit).map(|(_, exact)| *exact);
    let exact = match kept {
        Some(exact) => exact,
        None => {
            let Certified { bracket, .. } = solved(&unit, 0.2, block(DEGREE))?;
            let upper = bracket.free.as_ref().map_err(|e| Fault::Failed(e.to_string()))?.upper();
            let exact = Exact { lower: bracket.lower(), upper, strain: bracket.complementary.strain };
            known().push((unit, exact));
            exact
        }
    };
    Ok(exact.scaled(material.thickness / material.young))
}

impl Exact {
    /// The enclosure for a scene with energies `factor` times as large.
    fn scaled(self, factor: f64) -> Self {
        Exact { lower: factor * self.lower, upper: factor * self.upper, strain: factor * self.strain }
    }

    /// √(gap / 𝒮): how far a displacement with this energy can be from the exact one, relative to it, in the energy norm.
    pub fn guaranteed(&self, energy: f64) -> f64 {
        ((energy - self.lower).max(0.0) / self.strain).sqrt()
    }

    /// Relative error in the energy norm, estimated from an energy on either side of the exact one: √(|𝓛(u_h) − 𝓛(u)| / 𝒮), which is
    /// no bound.
    pub fn apart(&self, energy: f64) -> f64 {
        ((energy - 0.5 * (self.lower + self.upper)).abs() / self.strain).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Kinematics;

    #[test]
    fn a_scene_that_is_known_encloses_what_one_solved_anew_encloses() {
        let material = Material::new(Kinematics::PlaneStress, 5.0, 0.27, 3.0).expect("a material");
        let Certified { bracket, .. } = solved(&material, 0.2, block(DEGREE)).expect("solves");
        exact(&Material::USUAL).expect("solves");
        for _ in 0..2 {
            let Exact { lower, upper, strain } = exact(&material).expect("solves");
            assert!((lower - bracket.lower()).abs() < 1e-12 * strain && lower < upper && upper - lower < 1e-5 * strain);
            assert!((strain - bracket.complementary.strain).abs() < 1e-12 * strain);
        }
    }
}
