//! The fields of an element on one triangle, evaluated and differentiated by shape functions of their own.

use nalgebra::DMatrix;

use crate::element::geometry::sub_corners;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{EquilibriumElement, Material, Section, lattice_len};

/// A stress of degree p on every part of a triangle, by its values (xx, yy, xy) on the lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct Nodal {
    /// Degree p.
    pub degree: usize,
    /// (p + 1)(p + 2)/2 values on each part, as in [`crate::element::StressField::block`].
    pub values: Vec<[f64; 3]>,
}

impl Nodal {
    /// The largest component at a node.
    pub fn largest(&self) -> f64 {
        self.values.as_flattened().iter().fold(0.0, |m, v| m.max(v.abs()))
    }

    /// The stress on part `part` at barycentric `l`, and its derivatives by the first and by the second barycentric coordinate.
    pub fn jet(&self, part: usize, l: [f64; 3]) -> [[f64; 3]; 3] {
        let p = self.degree;
        // Lagrange's factor of degree n in one coordinate, with its derivative.
        let factor = |n: usize, x: f64| {
            (0..n).fold((1.0, 0.0), |(value, slope), m| {
                let (f, d) = ((p as f64 * x - m as f64) / (n - m) as f64, p as f64 / (n - m) as f64);
                (value * f, slope * f + value * d)
            })
        };
        let mut out = [[0.0; 3]; 3];
        let mut node = part * lattice_len(p);
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

    /// The stress on part `part` at barycentric `l`.
    pub fn at(&self, part: usize, l: [f64; 3]) -> [f64; 3] {
        self.jet(part, l)[0]
    }
}

/// λ̄ for a body force.
#[derive(Debug, Clone, PartialEq)]
pub struct Particular {
    /// The field.
    pub field: Nodal,
    /// Its traction coefficients.
    pub tractions: Vec<f64>,
    /// ∫ a λ̄:λ̄ as the element has it.
    pub energy: f64,
    /// The body force.
    pub force: [f64; 2],
}

/// All fields of an element on one triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields {
    /// Corners of the triangle.
    pub corners: [[f64; 2]; 3],
    /// Corners of its parts: the triangle itself, or the subtriangles (a_{i+1}, a_{i+2}, centroid).
    pub parts: Vec<[[f64; 2]; 3]>,
    /// Degree p.
    pub degree: usize,
    /// The modes.
    pub fields: Vec<Nodal>,
    /// 6(p + 1) traction coefficients of each mode, as in [`EquilibriumElement`].
    pub tractions: Vec<Vec<f64>>,
    /// λ̄, where the element has one.
    pub particular: Option<Particular>,
    /// a.
    pub material: Material,
}

impl Fields {
    /// The fields of an equilibrium element.
    pub fn of(element: &dyn EquilibriumElement, corners: [[f64; 2]; 3], material: &Material, force: [f64; 2]) -> Self {
        let (degree, modes) = (element.degree(), element.modes(corners, material, &force.into()));
        let nodal = |values| Nodal { degree, values };
        let mut values = vec![[0.0; 3]; 3 * lattice_len(degree)];
        element.stresses(corners, &force.into(), &modes, &vec![0.0; element.parameters()], 1.0, &mut values);
        let particular = Particular {
            field: nodal(values),
            tractions: modes.particular_traction().to_vec(),
            energy: modes.particular_energy(),
            force,
        };
        Fields {
            corners,
            parts: (0..3).map(|sub| sub_corners(corners, sub)).collect(),
            degree,
            fields: Section::Slice.mode_stresses(element, corners, &modes).into_iter().map(nodal).collect(),
            tractions: modes.tractions().map(<[f64]>::to_vec).collect(),
            particular: Some(particular),
            material: *material,
        }
    }

    /// True if every stress and traction is a finite number.
    pub fn is_finite(&self) -> bool {
        self.all().all(|(field, tractions, _)| {
            field.values.as_flattened().iter().chain(tractions).all(|x| x.is_finite() && x.abs() < 1e100)
        })
    }

    /// Modes and λ̄ with their tractions and body forces.
    pub fn all(&self) -> impl Iterator<Item = (&Nodal, &[f64], [f64; 2])> {
        let modes = self.fields.iter().zip(&self.tractions).map(|(f, t)| (f, t.as_slice(), [0.0; 2]));
        modes.chain(self.particular.iter().map(|p| (&p.field, p.tractions.as_slice(), p.force)))
    }

    /// The part that side `s` belongs to, and the barycentric place on it of the point at `x` from its first to its second end.
    pub fn on_side(&self, s: usize, x: f64) -> (usize, [f64; 3]) {
        if self.parts.len() == 3 {
            return (s, [1.0 - x, x, 0.0]);
        }
        let mut l = [0.0; 3];
        (l[(s + 1) % 3], l[(s + 2) % 3]) = (1.0 - x, x);
        (0, l)
    }

    /// Values of a stress given by part and barycentric place, as a column whose products are energies ∫ a λ:μ.
    pub fn column(&self, stress: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let (roots, unit) = (self.material.roots(), self.material.unit());
        let mut column = Vec::new();
        for (part, corners) in self.parts.iter().enumerate() {
            for &(l, w) in triangle_rule(2 * self.degree + 2) {
                let (tau, root) = (stress(part, l), (w * area(*corners) / unit).sqrt());
                column.extend(roots.apply(tau).map(|x| root * x));
            }
        }
        column
    }

    /// Columns of fields of this kind.
    pub fn columns<'a>(&self, fields: impl IntoIterator<Item = &'a Nodal>) -> DMatrix<f64> {
        let columns: Vec<Vec<f64>> = fields.into_iter().map(|f| self.column(|part, l| f.at(part, l))).collect();
        let rows = columns.first().map_or(0, Vec::len);
        DMatrix::from_fn(rows, columns.len(), |i, j| columns[j][i])
    }

    /// Tractions as forces, a column a mode: coefficients times the length of their side.
    pub fn forces(&self) -> DMatrix<f64> {
        let rows = 6 * (self.degree + 1);
        DMatrix::from_fn(rows, self.fields.len(), |i, k| self.tractions[k][i] * side(self.corners, 3 * i / rows).length)
    }
}

/// A side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Its first end.
    pub start: [f64; 2],
    /// Its second end.
    pub end: [f64; 2],
    /// The outward normal.
    pub normal: [f64; 2],
    /// Its length.
    pub length: f64,
}

/// Side s, opposite corner s.
pub fn side(p: [[f64; 2]; 3], s: usize) -> Side {
    let (start, end) = (p[(s + 1) % 3], p[(s + 2) % 3]);
    let (dx, dy) = (end[0] - start[0], end[1] - start[1]);
    let length = dx.hypot(dy);
    Side { start, end, normal: [dy / length, -dx / length], length }
}

/// τ n.
pub fn traction(tau: [f64; 3], n: [f64; 2]) -> [f64; 2] {
    [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]]
}

/// Area of a counter-clockwise triangle.
pub fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
}
