//! The modes of the element on one triangle.

use nalgebra::DMatrix;

use super::fields::{Fields, Raw, Split};
use super::law::Law;
use super::rule::rule;
use super::stress::to_bernstein;
use super::{Held, ROUGH};
use crate::element::field::{self, lattice};
use crate::element::geometry::{from_centroid, gradients};
use crate::element::polynomial::triangle;
use crate::element::{Layout, Modes, ModesMut, lattice_len};

/// A triangle beside the axis.
#[derive(Debug, Clone)]
pub struct Ring {
    pub(super) degree: usize,
    /// Corners as seen from the centroid.
    pub(super) corners: [[f64; 2]; 3],
    radii: [f64; 3],
    /// √area.
    pub(super) unit: f64,
}

impl Ring {
    /// The triangle with these counter-clockwise corners, for stresses of degree `degree`; r = 0 where the first coordinate is `axis`.
    pub fn new(degree: usize, axis: f64, corners: [[f64; 2]; 3]) -> Self {
        let local = from_centroid(corners);
        let [a, b, c] = local;
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        Ring { degree, corners: local, radii: corners.map(|p| p[0] - axis), unit: area.sqrt() }
    }

    /// Distances from the axis of the corners of subtriangle `sub`.
    pub fn sub_radii(&self, sub: usize) -> [f64; 3] {
        let centre = (self.radii[0] + self.radii[1] + self.radii[2]) / 3.0;
        [self.radii[(sub + 1) % 3], self.radii[(sub + 2) % 3], centre]
    }

    /// Sizes of what [`Self::compute`] writes.
    pub fn layout(&self) -> Layout {
        let parameters = self.met() - 1;
        let kept = (parameters + 1) * 9 * lattice_len(self.degree);
        Layout { parameters, tractions: 6 * (self.degree + 1), kept }
    }

    /// The number of corners on the axis.
    pub(super) fn ends_on_axis(&self) -> usize {
        self.radii.iter().filter(|r| **r == 0.0).count()
    }

    /// The number of traction coefficients that do not vanish on the axis.
    pub(super) fn met(&self) -> usize {
        (0..3).map(|side| 2 * (0..=self.degree).filter(|k| !self.vanishes(side, *k)).count()).sum()
    }

    /// True if coefficient `k` of the traction on a side belongs to the axis.
    pub(super) fn vanishes(&self, side: usize, k: usize) -> bool {
        let ends = [self.radii[(side + 1) % 3] == 0.0, self.radii[(side + 2) % 3] == 0.0];
        super::vanishes(ends, k, self.degree)
    }

    /// Computes tractions, particular field and nodal values of Σ.
    ///
    /// The body force is (a + b r, `axial`), `radial` being a and b; `held` is an initial strain.
    pub fn compute(&self, law: &Law, (radial, axial): ([f64; 2], f64), held: Option<Held>, out: ModesMut<'_>) {
        let raw = Raw::new(self);
        let fields = Fields::new(self, &raw);
        let loaded = radial != [0.0; 2] || axial != 0.0 || held.is_some();
        let balancing = self.balancing(axial);
        let given = Given { balancing: &balancing, radial, held };
        let triangle = self.triangle(law, &raw, &fields.columns, loaded.then_some(given));
        let (count, free) = (fields.columns.ncols(), fields.free);
        let unit = law.unit().sqrt();
        // Modes are what is left of uniform pressure and of the fields with traction by those before.
        let parameters = count - free;
        let mut x = DMatrix::zeros(count, parameters);
        for k in 0..parameters {
            let last = if k == 0 { 0 } else { free + k };
            x[(last, k)] = unit;
            backward(&triangle, x.column_mut(k).as_mut_slice(), last + 1);
        }
        let repair = fields.inside.repair(&raw);
        let mut nodal = &raw.nodal * (&fields.columns * x);
        repair.apply(&mut nodal);
        out.traction.copy_from_slice(self.tractions(&nodal).as_slice());
        let size = nodal.nrows();
        out.kept[..nodal.len()].copy_from_slice(nodal.as_slice());
        let particular = &mut out.kept[parameters * size..];
        particular.fill(0.0);
        out.particular_traction.fill(0.0);
        *out.particular_energy = 0.0;
        if loaded {
            let mut y: Vec<f64> = (0..count).map(|i| -triangle[(i, count)]).collect();
            backward(&triangle, &mut y, count);
            let given = DMatrix::from_column_slice(size, 1, balancing.as_flattened());
            let mut nodal = given + &raw.nodal * (&fields.columns * DMatrix::from_vec(count, 1, y));
            repair.apply(&mut nodal);
            particular.copy_from_slice(nodal.as_slice());
            out.particular_traction.copy_from_slice(self.tractions(&nodal).as_slice());
            *out.particular_energy = (triangle[(count, count)] / unit).powi(2);
        }
    }

    /// Nodal values of an orthonormal basis of the fields without traction.
    pub fn unloaded(&self, law: &Law) -> Vec<Vec<[f64; 3]>> {
        let raw = Raw::new(self);
        let fields = Fields::new(self, &raw);
        let triangle = self.triangle(law, &raw, &fields.columns, None);
        let (count, repair) = (fields.columns.ncols(), Split::unloaded(self, &raw).repair(&raw));
        let field = |k: usize| {
            let mut x = vec![0.0; count];
            x[k] = law.unit().sqrt();
            backward(&triangle, &mut x, k + 1);
            let mut nodal = &raw.nodal * (&fields.columns * DMatrix::from_vec(count, 1, x));
            repair.apply(&mut nodal);
            nodal.as_slice().as_chunks::<3>().0.to_vec()
        };
        (1..=fields.free).map(field).collect()
    }

    /// Nodal values `particular` · Σ̄ + Σ s_k Σ_k of the modes that were computed.
    pub fn stresses(modes: &Modes<'_>, s: &[f64], particular: f64, out: &mut [[f64; 3]]) {
        let size = 3 * out.len();
        let (of_modes, given) = modes.kept().split_at(s.len() * size);
        let out = out.as_flattened_mut();
        out.iter_mut().zip(given).for_each(|(o, v)| *o = particular * v);
        for (s, mode) in s.iter().zip(of_modes.chunks_exact(size)) {
            out.iter_mut().zip(mode).for_each(|(o, v)| *o += s * v);
        }
    }

    /// Nodal values of a Σ that balances an axial force: Σ_zz = −r z F_z, of degree two, and so without effect in degree one.
    fn balancing(&self, force: f64) -> Vec<[f64; 3]> {
        let mut out = vec![[0.0; 3]; 3 * lattice_len(self.degree)];
        if force != 0.0 && self.degree >= 2 {
            for (sub, out) in out.chunks_exact_mut(lattice_len(self.degree)).enumerate() {
                for (value, l) in out.iter_mut().zip(lattice(self.degree)) {
                    value[1] = -force * dot(self.sub_radii(sub), l) * self.height(sub, l);
                }
            }
        }
        out
    }

    /// z at a point of a subtriangle as seen from the centroid.
    fn height(&self, sub: usize, l: [f64; 3]) -> f64 {
        l[0] * self.corners[(sub + 1) % 3][1] + l[1] * self.corners[(sub + 2) % 3][1]
    }

    /// The corners of a subtriangle as seen from the centroid.
    pub(super) fn sub_corners(&self, sub: usize) -> [[f64; 2]; 3] {
        [self.corners[(sub + 1) % 3], self.corners[(sub + 2) % 3], [0.0; 2]]
    }

    /// Bernstein coefficients of the tractions of a stress given by nodal values.
    fn traction_of(&self, nodal: &[[f64; 3]]) -> Vec<f64> {
        let p = self.degree;
        let of_side = |side: usize| {
            let ([n, m], own) = (self.normal(side), &nodal[side * lattice_len(p)..]);
            let traction = move |(k, [rr, zz, rz]): (usize, [f64; 3])| {
                if self.vanishes(side, k) { [0.0; 2] } else { [rr * n + rz * m, rz * n + zz * m] }
            };
            field::to_bernstein(p, |j| own[j * (j + 1) / 2]).enumerate().map(traction)
        };
        (0..3).flat_map(of_side).flatten().collect()
    }

    /// Outward unit normal of a side.
    pub(super) fn normal(&self, side: usize) -> [f64; 2] {
        let [a, b, _] = self.sub_corners(side);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        [y / x.hypot(y), -x / x.hypot(y)]
    }

    /// Bernstein coefficients of the tractions of the fields with these nodal values, one column each.
    fn tractions(&self, nodal: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(6 * (self.degree + 1), nodal.ncols());
        for (i, field) in nodal.column_iter().enumerate() {
            let (values, _) = field.as_slice().as_chunks::<3>();
            out.column_mut(i).copy_from_slice(&self.traction_of(values));
        }
        out
    }

    /// R of the columns in their energy, times the unit of the law; behind them a field with a radial force, where there is one.
    fn triangle(&self, law: &Law, raw: &Raw, columns: &DMatrix<f64>, given: Option<Given<'_>>) -> DMatrix<f64> {
        let p = self.degree;
        let (n, own, count) = (lattice_len(p), raw.fields, columns.ncols());
        let width = own + usize::from(given.is_some());
        let mut all = DMatrix::zeros(0, count + usize::from(given.is_some()));
        for sub in 0..3 {
            let g = gradients(self.sub_corners(sub));
            // Bernstein coefficients of all fields: nodes one after the other, components of each together.
            let mut nodal = DMatrix::zeros(3 * n, width);
            nodal.columns_mut(0, own).copy_from(&raw.nodal.view((3 * n * sub, own * sub), (3 * n, own)));
            if let Some(given) = &given {
                nodal.column_mut(own).copy_from_slice(given.balancing[n * sub..n * (sub + 1)].as_flattened());
            }
            let of_component = |c: usize| to_bernstein(p) * DMatrix::from_fn(n, width, |i, j| nodal[(3 * i + c, j)]);
            let [rr, zz, rz] = [0, 1, 2].map(of_component);
            let hoop_rows: Vec<[(usize, [f64; 2]); 3]> = triangle::indices(p - 1)
                .map(|beta| {
                    [0, 1, 2].map(|i| (triangle::number(triangle::raised(beta, i)), g[i].map(|x| p as f64 * x)))
                })
                .collect();
            let hoop = DMatrix::from_fn(hoop_rows.len(), width, |i, j| {
                hoop_rows[i].iter().map(|(at, [gr, gz])| gr * rr[(*at, j)] + gz * rz[(*at, j)]).sum::<f64>()
            });
            let points = rule(self.sub_radii(sub), 2 * p.max(3), ROUGH);
            let area = self.unit * self.unit / 3.0;
            let mut rows = DMatrix::zeros(4 * points.len(), width);
            for (q, point) in points.iter().enumerate() {
                let basis: Vec<f64> = triangle::basis(p, point.bary).collect();
                let lower: Vec<f64> = triangle::basis(p - 1, point.bary).collect();
                let weight = (point.weight * area * point.radius).sqrt();
                let sum = |values: &[f64], m: &DMatrix<f64>, j: usize| {
                    values.iter().zip(m.column(j).iter()).map(|(b, v)| b * v).sum::<f64>()
                };
                for j in 0..width {
                    let r = point.radius;
                    let given = given.as_ref().filter(|_| j == own);
                    let of_force = given.map_or(0.0, |given| r * (given.radial[0] + given.radial[1] * r));
                    let tensor = [
                        sum(&basis, &rr, j) / r,
                        sum(&basis, &zz, j) / r,
                        sum(&lower, &hoop, j) + of_force,
                        sum(&basis, &rz, j) / r,
                    ];
                    let mut roots = law.roots(tensor);
                    if let Some(held) = given.and_then(|given| given.held) {
                        let more = law.roots_of_strain(held.at(sub, point.bary));
                        (0..4).for_each(|c| roots[c] += more[c]);
                    }
                    (0..4).for_each(|c| rows[(4 * q + c, j)] = weight * roots[c]);
                }
            }
            let compressed = rows.qr().r();
            let height = compressed.nrows();
            let mut part = DMatrix::zeros(height, all.ncols());
            part.columns_mut(0, count).copy_from(&(compressed.columns(0, own) * columns.rows(own * sub, own)));
            if given.is_some() {
                part.column_mut(count).copy_from(&compressed.column(own));
            }
            let above = all.nrows();
            all = all.insert_rows(above, height, 0.0);
            all.rows_mut(above, height).copy_from(&part);
        }
        all.qr().r()
    }
}

/// Loads and initial strain of a triangle.
struct Given<'a> {
    /// Nodal values of a Σ that balances the axial force.
    balancing: &'a [[f64; 3]],
    /// a and b of the radial force a + b r.
    radial: [f64; 2],
    /// An initial strain.
    held: Option<Held>,
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Solves R x = b in place for the first `count` unknowns.
fn backward(r: &DMatrix<f64>, b: &mut [f64], count: usize) {
    for k in (0..count).rev() {
        b[k] /= r[(k, k)];
        let x = b[k];
        (0..k).for_each(|i| b[i] -= r[(i, k)] * x);
    }
}

#[cfg(test)]
#[path = "modes_tests.rs"]
mod tests;
