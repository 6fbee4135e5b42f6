//! What every equilibrium element is held against: random triangles and materials, energies and derivatives with quadrature and shape
//! functions of their own.

use hypercircle::element::{Compliance, EquilibriumElement, Modes};
use hypercircle::scene::Kinematics;
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
    pub fn compliance(&self) -> Compliance {
        Compliance::new(self.kinematics, self.young, self.poisson)
    }

    /// a λ:λ is the sum of the squares of these times λ11 + λ22, λ11 − λ22 and λ12; from the constants after (3.2).
    pub fn roots(&self) -> [f64; 3] {
        let nu = self.poisson;
        // α + β, α − β and γ.
        let (sum, difference) = match self.kinematics {
            Kinematics::PlaneStress => (1.0 - nu, 1.0 + nu),
            Kinematics::PlaneStrain => ((1.0 + nu) * (1.0 - 2.0 * nu), 1.0 + nu),
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

/// A stress of degree p on the three subtriangles, by its values on the lattice.
pub struct Nodal {
    pub degree: usize,
    pub values: Vec<[f64; 3]>,
}

impl Nodal {
    /// The largest component at a node.
    pub fn largest(&self) -> f64 {
        self.values.as_flattened().iter().fold(0.0, |m, v| m.max(v.abs()))
    }

    /// The stress on subtriangle `sub`, and its derivatives by the first and by the second barycentric coordinate.
    pub fn jet(&self, sub: usize, l: [f64; 3]) -> [[f64; 3]; 3] {
        let p = self.degree;
        let nodes = (p + 1) * (p + 2) / 2;
        // Lagrange's factor of degree n in one coordinate, with its derivative.
        let factor = |n: usize, x: f64| {
            (0..n).fold((1.0, 0.0), |(value, slope), m| {
                let (f, d) = ((p as f64 * x - m as f64) / (n - m) as f64, p as f64 / (n - m) as f64);
                (value * f, slope * f + value * d)
            })
        };
        let mut out = [[0.0; 3]; 3];
        let mut node = sub * nodes;
        for i in (0..=p).rev() {
            for j in (0..=p - i).rev() {
                let (a, b, c) = (factor(i, l[0]), factor(j, l[1]), factor(p - i - j, l[2]));
                let weights = [a.0 * b.0 * c.0, (a.1 * c.0 - a.0 * c.1) * b.0, (b.1 * c.0 - b.0 * c.1) * a.0];
                for (out, w) in out.iter_mut().zip(weights) {
                    out.iter_mut().zip(&self.values[node]).for_each(|(o, v)| *o += w * v);
                }
                node += 1;
            }
        }
        out
    }

    pub fn at(&self, sub: usize, l: [f64; 3]) -> [f64; 3] {
        self.jet(sub, l)[0]
    }
}

/// An element on a triangle, with the fields of its modes.
pub struct Case {
    pub setting: Setting,
    pub element: &'static dyn EquilibriumElement,
    pub modes: Modes<'static>,
    pub fields: Vec<Nodal>,
    pub particular: Nodal,
}

impl Case {
    pub fn new(element: &'static dyn EquilibriumElement, setting: Setting) -> Self {
        let modes = element.modes(setting.corners, &setting.material.compliance(), setting.force);
        let degree = element.degree();
        let nodal = |values| Nodal { degree, values };
        let fields: Vec<Nodal> = element.mode_stresses(setting.corners, &modes).into_iter().map(nodal).collect();
        let mut values = vec![[0.0; 3]; 3 * (degree + 1) * (degree + 2) / 2];
        let zero = vec![0.0; element.parameters()];
        element.stresses(setting.corners, setting.force, &modes, &zero, 1.0, &mut values);
        Case { setting, element, modes, fields, particular: nodal(values) }
    }

    pub fn degree(&self) -> usize {
        self.element.degree()
    }

    /// Modes and λ̄, each with its traction coefficients.
    pub fn with_tractions(&self) -> impl Iterator<Item = (&Nodal, &[f64])> {
        let last = (&self.particular, self.modes.particular_traction());
        self.fields.iter().zip(self.modes.tractions()).chain([last])
    }

    /// The sum of the modes times `s`.
    pub fn sum(&self, s: &[f64]) -> Nodal {
        let mut values = vec![[0.0; 3]; self.particular.values.len()];
        for (field, s) in self.fields.iter().zip(s) {
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
