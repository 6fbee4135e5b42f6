//! Common inputs of tests of equilibrium elements: random triangles and materials, and energies with an independent quadrature.

use hypercircle::element::{self, EquilibriumElement, Modes};
use hypercircle::scene::Kinematics;
use hypercircle::workbench::stress::{Fields, Nodal};
use proptest::prelude::*;

use super::theory::quadrature::{self, area, sub_corners};

/// A triangle, what it is made of, and what pulls at it.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    pub corners: [[f64; 2]; 3],
    pub material: Material,
    pub force: [f64; 2],
}

/// E, ν and the kinematics.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    pub kinematics: Kinematics,
    pub young: f64,
    pub poisson: f64,
}

impl Material {
    /// As the elements take it.
    pub fn compliance(&self) -> element::Material {
        element::Material::isotropic(self.kinematics, self.young, self.poisson)
    }

    /// a λ:λ is the sum of the squares of these times λ11 + λ22, λ11 − λ22 and λ12; from the constants after (3.2).
    pub fn roots(&self) -> [f64; 3] {
        let nu = self.poisson;
        // α + β, α − β and γ.
        let (sum, difference) = match self.kinematics {
            Kinematics::PlaneStress => (1.0 - nu, 1.0 + nu),
            Kinematics::PlaneStrain | Kinematics::Axisymmetric => ((1.0 + nu) * (1.0 - 2.0 * nu), 1.0 + nu),
        };
        [0.5 * sum, 0.5 * difference, 2.0 * (1.0 + nu)].map(|c| (c / self.young).sqrt())
    }
}

/// Counter-clockwise triangles of every size and direction, with an area of at least `flattest` times the square of the longest
/// side.
pub fn triangle(flattest: f64) -> impl Strategy<Value = [[f64; 2]; 3]> {
    (prop::array::uniform6(-1.0..1.0_f64), -3.0..3.0_f64, 0.0..6.3_f64)
        .prop_filter_map("too flat", move |(v, log_scale, angle)| {
            let mut p = [[v[0], v[1]], [v[2], v[3]], [v[4], v[5]]];
            if area(p) < 0.0 {
                p.swap(1, 2);
            }
            let (c, s, f) = (angle.cos(), angle.sin(), 10.0_f64.powf(log_scale));
            let longest = longest_side(p);
            (area(p) > flattest * longest * longest).then(|| p.map(|[x, y]| [f * (c * x - s * y), f * (s * x + c * y)]))
        })
        .boxed()
}

pub fn material() -> impl Strategy<Value = Material> {
    (prop::bool::ANY, -3.0..11.0_f64, -0.9..0.49_f64).prop_map(|(strain, e, poisson)| Material {
        kinematics: if strain { Kinematics::PlaneStrain } else { Kinematics::PlaneStress },
        young: 10.0_f64.powf(e),
        poisson,
    })
}

pub fn setting() -> impl Strategy<Value = Setting> {
    (triangle(1e-3), material(), prop::array::uniform2(-1.0..1.0_f64)).prop_map(|(corners, material, force)| Setting {
        corners,
        material,
        force,
    })
}

pub fn longest_side(p: [[f64; 2]; 3]) -> f64 {
    (0..3).map(|i| (p[i][0] - p[(i + 1) % 3][0]).hypot(p[i][1] - p[(i + 1) % 3][1])).fold(0.0, f64::max)
}

/// An element on a triangle, with the fields of its modes.
pub struct Case {
    pub setting: Setting,
    pub element: &'static dyn EquilibriumElement,
    pub modes: Modes<'static>,
    pub fields: Fields,
}

impl Case {
    pub fn new(element: &'static dyn EquilibriumElement, setting: Setting) -> Self {
        let material = setting.material.compliance();
        let modes = element.modes(setting.corners, &material, &setting.force.into());
        Case { setting, element, modes, fields: Fields::of(element, setting.corners, &material, setting.force) }
    }

    pub fn degree(&self) -> usize {
        self.element.degree()
    }

    /// The sum of the modes times `s`.
    pub fn sum(&self, s: &[f64]) -> Nodal {
        let modes = &self.fields.fields;
        let mut values = vec![[0.0; 3]; modes[0].values.len()];
        for (field, s) in modes.iter().zip(s) {
            values.as_flattened_mut().iter_mut().zip(field.values.as_flattened()).for_each(|(o, v)| *o += s * v);
        }
        Nodal { degree: self.degree(), values }
    }

    /// Visits points of the subtriangles with weights that integrate products of two stresses.
    pub fn visit(&self, mut each: impl FnMut(usize, [f64; 3], f64)) {
        let rule = quadrature::triangle(self.degree() + 2);
        for sub in 0..3 {
            let size = area(sub_corners(self.setting.corners, sub));
            rule.iter().for_each(|&(l, w)| each(sub, l, w * size));
        }
    }
}
