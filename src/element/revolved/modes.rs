//! The modes of the element on one triangle.

use nalgebra::DMatrix;

use super::householder::range_and_rest;
use super::law::Law;
use super::rule::rule;
use super::stress::to_bernstein;
use super::{Held, ROUGH};
use crate::element::field::{from_equispaced, lattice};
use crate::element::geometry::{from_centroid, gradients};
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::polynomial::triangle;
use crate::element::split::polynomials::{Jet, values, with_derivatives};
use crate::element::{Layout, Modes, ModesMut, lattice_len};

/// A triangle beside the axis.
#[derive(Debug, Clone)]
pub struct Ring {
    degree: usize,
    /// Corners as seen from the centroid.
    corners: [[f64; 2]; 3],
    radii: [f64; 3],
    /// √area.
    unit: f64,
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

    /// The number of traction coefficients that do not vanish on the axis.
    fn met(&self) -> usize {
        (0..3).map(|side| 2 * (0..=self.degree).filter(|k| !self.vanishes(side, *k)).count()).sum()
    }

    /// True if coefficient `k` of the traction on a side belongs to the axis.
    fn vanishes(&self, side: usize, k: usize) -> bool {
        let ends = [self.radii[(side + 1) % 3] == 0.0, self.radii[(side + 2) % 3] == 0.0];
        super::vanishes(ends, k, self.degree)
    }

    /// Computes tractions, particular field and nodal values of Σ.
    ///
    /// The body force is (a + b r, `axial`), `radial` being a and b; `held` is an initial strain.
    pub fn compute(&self, law: &Law, (radial, axial): ([f64; 2], f64), held: Option<Held>, out: ModesMut<'_>) {
        let raw = Raw::new(self);
        let tractions = self.tractions(&raw);
        let fields = Fields::new(self, &raw, &tractions);
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
        let coefficients = &fields.columns * x;
        let of_modes = &tractions * &coefficients;
        out.traction.copy_from_slice(of_modes.as_slice());
        let nodal = &raw.nodal * &coefficients;
        let size = nodal.nrows();
        out.kept[..nodal.len()].copy_from_slice(nodal.as_slice());
        let particular = &mut out.kept[parameters * size..];
        particular.fill(0.0);
        out.particular_traction.fill(0.0);
        *out.particular_energy = 0.0;
        if loaded {
            let mut y: Vec<f64> = (0..count).map(|i| -triangle[(i, count)]).collect();
            backward(&triangle, &mut y, count);
            let coefficients = &fields.columns * DMatrix::from_vec(count, 1, y);
            let nodal = &raw.nodal * &coefficients;
            for ((out, own), given) in particular.iter_mut().zip(nodal.iter()).zip(balancing.as_flattened()) {
                *out = own + given;
            }
            let of_given = self.traction_of(&balancing);
            let of_fields = &tractions * coefficients;
            for ((out, own), given) in out.particular_traction.iter_mut().zip(of_fields.iter()).zip(of_given) {
                *out = own + given;
            }
            *out.particular_energy = (triangle[(count, count)] / unit).powi(2);
        }
    }

    /// Nodal values of an orthonormal basis of the fields without traction.
    pub fn unloaded(&self, law: &Law) -> Vec<Vec<[f64; 3]>> {
        let raw = Raw::new(self);
        let fields = Fields::new(self, &raw, &self.tractions(&raw));
        let triangle = self.triangle(law, &raw, &fields.columns, None);
        let count = fields.columns.ncols();
        let field = |k: usize| {
            let mut x = vec![0.0; count];
            x[k] = law.unit().sqrt();
            backward(&triangle, &mut x, k + 1);
            let nodal = &raw.nodal * (&fields.columns * DMatrix::from_vec(count, 1, x));
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
    fn sub_corners(&self, sub: usize) -> [[f64; 2]; 3] {
        [self.corners[(sub + 1) % 3], self.corners[(sub + 2) % 3], [0.0; 2]]
    }

    /// Bernstein coefficients of the tractions of a stress given by nodal values.
    fn traction_of(&self, nodal: &[[f64; 3]]) -> Vec<f64> {
        let p = self.degree;
        let matrix = from_equispaced(p);
        let mut out = vec![0.0; 6 * (p + 1)];
        for side in 0..3 {
            let [n, m] = self.normal(side);
            let own = &nodal[side * lattice_len(p)..];
            for k in (0..=p).filter(|k| !self.vanishes(side, *k)) {
                let at = 2 * (side * (p + 1) + k);
                for j in 0..=p {
                    let [rr, zz, rz] = own[j * (j + 1) / 2];
                    let weight = matrix[k * (p + 1) + j];
                    out[at] += weight * (rr * n + rz * m);
                    out[at + 1] += weight * (rz * n + zz * m);
                }
            }
        }
        out
    }

    /// Outward unit normal of a side.
    fn normal(&self, side: usize) -> [f64; 2] {
        let [a, b, _] = self.sub_corners(side);
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        [y / x.hypot(y), -x / x.hypot(y)]
    }

    /// Bernstein coefficients of the tractions of all raw fields, one column each.
    fn tractions(&self, raw: &Raw) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(6 * (self.degree + 1), raw.nodal.ncols());
        for (i, field) in raw.nodal.column_iter().enumerate() {
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

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
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

/// Σ_rr of degree p and χ of degree p + 1, without a constant, on each subtriangle by itself.
struct Raw {
    /// Number of fields of one subtriangle.
    fields: usize,
    /// Nodal values (rr, zz, rz) of all three subtriangles, one column a field.
    nodal: DMatrix<f64>,
}

impl Raw {
    fn new(ring: &Ring) -> Self {
        let p = ring.degree;
        let (n, of_sigma, of_chi) = (lattice_len(p), lattice_len(p), lattice_len(p + 1) - 1);
        let fields = of_sigma + of_chi;
        let mut nodal = DMatrix::zeros(9 * n, 3 * fields);
        for sub in 0..3 {
            let g = gradients(ring.sub_corners(sub));
            for (node, l) in lattice(p).enumerate() {
                let jets: [Jet; 3] = [0, 1, 2].map(|i| [l[i], ring.unit * g[i][0], ring.unit * g[i][1]]);
                let row = 3 * (n * sub + node);
                for (i, value) in values(p, l).into_iter().enumerate() {
                    nodal[(row, fields * sub + i)] = value;
                }
                for (i, [_, along, up]) in with_derivatives(p + 1, jets).into_iter().skip(1).enumerate() {
                    let column = fields * sub + of_sigma + i;
                    nodal[(row + 1, column)] = -along;
                    nodal[(row + 2, column)] = up;
                }
            }
        }
        Raw { fields, nodal }
    }

    /// The coefficients of uniform pressure: Σ_rr = r and χ = −r²/2, r counted from the centroid in the square.
    fn pressure(&self, ring: &Ring) -> Vec<f64> {
        let p = ring.degree;
        let of_sigma = lattice_len(p);
        let mut out = vec![0.0; 3 * self.fields];
        for (sub, out) in out.chunks_exact_mut(self.fields).enumerate() {
            let (radii, corners) = (ring.sub_radii(sub), ring.sub_corners(sub));
            let centre = radii[2];
            for &(l, weight) in triangle_rule(2 * p + 2) {
                let (x, r) = (dot(corners.map(|q| q[0]), l), dot(radii, l));
                let chi = -(centre * x + 0.5 * x * x) / ring.unit;
                for (out, value) in out.iter_mut().zip(values(p, l)) {
                    *out += weight * value * r;
                }
                for (out, value) in out[of_sigma..].iter_mut().zip(values(p + 1, l).into_iter().skip(1)) {
                    *out += weight * value * chi;
                }
            }
        }
        out
    }
}

/// The fields of the element, by their coefficients in the raw ones.
struct Fields {
    /// In the order of the columns.
    columns: DMatrix<f64>,
    /// Number of those without traction.
    free: usize,
}

impl Fields {
    fn new(ring: &Ring, raw: &Raw, tractions: &DMatrix<f64>) -> Self {
        let (all, kept) = range_and_rest(ring.conditions(raw).transpose(), usize::MAX);
        let space = all.columns(kept, all.ncols() - kept).into_owned();
        let (turned, met) = range_and_rest((tractions * &space).transpose(), ring.met() - 1);
        let ordered = &space * &turned;
        let free = ordered.ncols() - met;
        let pressure = DMatrix::from_vec(space.nrows(), 1, raw.pressure(ring)).normalize();
        let part = ordered.columns(0, met).transpose() * &pressure;
        let (others, _) = range_and_rest(part, 1);
        let mut columns = DMatrix::zeros(space.nrows(), met + free);
        columns.column_mut(0).copy_from(&pressure);
        columns.columns_mut(1, free).copy_from(&ordered.columns(met, free));
        columns.columns_mut(1 + free, met - 1).copy_from(&(ordered.columns(0, met) * others.columns(1, met - 1)));
        Fields { columns, free }
    }
}

impl Ring {
    /// Linear conditions on a field of the element: zero jumps of Σ n at the nodes of the inner segments, and zero Σ on the axis.
    fn conditions(&self, raw: &Raw) -> DMatrix<f64> {
        let p = self.degree;
        let n = lattice_len(p);
        let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
        for corner in 0..3 {
            let [x, y] = self.corners[corner];
            let (c, s) = (y / x.hypot(y), -x / x.hypot(y));
            // The segment is the second side of one subtriangle, and the third of the other.
            let (one, other) = ((corner + 1) % 3, (corner + 2) % 3);
            for k in 0..=p {
                let a = 3 * (n * one + triangle::number([0, p - k, k]));
                let b = 3 * (n * other + triangle::number([p - k, 0, k]));
                rows.push(vec![(a, c), (a + 2, s), (b, -c), (b + 2, -s)]);
                rows.push(vec![(a + 2, c), (a + 1, s), (b + 2, -c), (b + 1, -s)]);
            }
        }
        for sub in 0..3 {
            for (node, l) in lattice(p).enumerate() {
                if dot(self.sub_radii(sub), l) == 0.0 {
                    rows.extend((0..3).map(|c| vec![(3 * (n * sub + node) + c, 1.0)]));
                }
            }
        }
        let mut out = DMatrix::zeros(rows.len(), raw.nodal.ncols());
        for (i, row) in rows.iter().enumerate() {
            for &(at, weight) in row {
                for j in 0..raw.nodal.ncols() {
                    out[(i, j)] += weight * raw.nodal[(at, j)];
                }
            }
        }
        out
    }
}

#[cfg(test)]
#[path = "modes_tests.rs"]
mod tests;
