//! Equilibrium blocks of degree p: stresses of degree p on the three subtriangles.
//!
//! Self-equilibrated stresses with continuous tractions on the inner segments are second derivatives of C¹ piecewise polynomials of
//! degree k = p + 2 on the triangle split at its centroid (Clough & Tocher), so that there are (3k² − 3k)/2 of them: 9, 18, 30, 45, … They meet every
//! traction of degree p whose force and moment vanish: 6(p + 1) − 3 of them are determined by their tractions, the others, from
//! p = 2 on, have no traction at all. The latter carry nothing from one triangle to the next, so the least energy decides about
//! them on each triangle alone:
//!
//! N(K) = self-equilibrated fields that have the least energy among those with their tractions.
//!
//! They are orthogonal in energy to all fields without traction, and so is λ̄. With dim N(K) = 6(p + 1) − 3 there is one field for every
//! traction in equilibrium, as in Theorem 2.1; for p = 1 it is the space of [`Block`](super::Block).
//!
//! Fields without traction on the longest side come from the reference triangle (`reference.rs`), the others are written down in the frame
//! of the triangle (`across.rs`): with each kind of stress by itself, flat triangles lose no digits. The orthonormal basis comes from the
//! Householder factor of the coefficients of all fields, times a root of a (`factor.rs`); the matrix of energies is never formed,
//! for its condition would be the square. Columns of R are, in this order,
//!
//! 1. the uniform pressure, soft as ν → ½ and orthogonal to all fields without traction;
//! 2. the fields without traction;
//! 3. the other fields without traction on the longest side;
//! 4. those without stress along the longest side;
//! 5. a field that balances the body force.
//!
//! Modes are what is left of 1, 3 and 4 by the columns before them; λ̄ is what is left of 5.

mod across;
mod factor;
pub mod polynomials;
mod reference;
mod shape;

use self::across::Across;
use self::factor::Factor;
use self::reference::{Field, Reference};
use self::shape::Shape;
use super::{EquilibriumElement, MAX_DEGREE, Material, Modes, ModesMut, lattice_len};
use crate::lanes::wide;
use crate::load::{Affine, BodyForce, balancing};

/// The block of degree p.
#[derive(Debug, Clone, Copy)]
pub struct Split {
    degree: usize,
}

impl Split {
    /// The block of the given degree, 1 to [`MAX_DEGREE`].
    pub const fn new(degree: usize) -> Self {
        Split { degree }
    }

    /// Number of fields without traction.
    fn free(&self) -> usize {
        3 * self.degree * (self.degree - 1) / 2
    }

    fn triangle(&self, corners: [[f64; 2]; 3], force: &BodyForce) -> Triangle {
        let shape = Shape::new(corners);
        let force = shape.frame.force_to_local(force.about_centroid(corners));
        Triangle { degree: self.degree, reference: Reference::of(self.degree), shape, force }
    }
}

impl EquilibriumElement for Split {
    fn name(&self) -> &'static str {
        const NAMES: [&str; MAX_DEGREE] = [
            "equilibrium block, p = 1",
            "equilibrium block, p = 2",
            "equilibrium block, p = 3",
            "equilibrium block, p = 4",
            "equilibrium block, p = 5",
            "equilibrium block, p = 6",
            "equilibrium block, p = 7",
            "equilibrium block, p = 8",
        ];
        NAMES[self.degree - 1]
    }

    fn degree(&self) -> usize {
        self.degree
    }

    fn parameters(&self) -> usize {
        6 * (self.degree + 1) - 3
    }

    /// Number of coefficients of modes and λ̄ in the fields: see [`Kept`].
    fn kept(&self) -> usize {
        let (n, free) = (self.parameters(), self.free());
        n * (n + 1) / 2 + n * free + n + free
    }

    fn compute(&self, corners: [[f64; 2]; 3], material: &Material, force: &BodyForce, out: ModesMut<'_>) {
        let triangle = self.triangle(corners, force);
        let (n, free) = (self.parameters(), self.free());
        let factor = Factor::new(&triangle, material);
        // ∫ a τ:τ is the square of a column times area/(3E).
        let area = triangle.shape.frame.scale * triangle.shape.frame.scale;
        let unit = (3.0 * material.unit() / area).sqrt();
        let raw = triangle.tractions();
        let tractions = self.tractions();
        let (upper, rest) = out.kept.split_at_mut(n * (n + 1) / 2);
        let (of_free, particular) = rest.split_at_mut(n * free);
        let mut column = vec![0.0; n + free];
        out.traction.fill(0.0);
        for k in 0..n {
            let last = if k == 0 { 0 } else { free + k };
            column.fill(0.0);
            column[last] = unit;
            factor.solve(&mut column[..=last]);
            let own = &mut upper[k * (k + 1) / 2..][..=k];
            own[0] = column[0];
            own[1..].copy_from_slice(&column[free + 1..][..k]);
            of_free[k * free..][..free].copy_from_slice(&column[1..=free]);
            add(&mut out.traction[k * tractions..][..tractions], own, &raw);
        }
        particular.fill(0.0);
        out.particular_traction.fill(0.0);
        *out.particular_energy = 0.0;
        if !triangle.is_loaded() {
            return;
        }
        column.copy_from_slice(&factor.overlaps()[..n + free]);
        column.iter_mut().for_each(|c| *c = -*c);
        factor.solve(&mut column);
        particular[0] = column[0];
        particular[1..n].copy_from_slice(&column[free + 1..]);
        particular[n..].copy_from_slice(&column[1..=free]);
        out.particular_traction.copy_from_slice(&triangle.balancing_traction());
        add(out.particular_traction, &particular[..n], &raw);
        *out.particular_energy = (factor.overlaps()[n + free] / unit).powi(2);
    }

    fn stresses(
        &self,
        corners: [[f64; 2]; 3],
        force: &BodyForce,
        modes: &Modes<'_>,
        s: &[f64],
        particular: f64,
        out: &mut [[f64; 3]],
    ) {
        let (n, free) = (self.parameters(), self.free());
        let kept = Kept::new(modes.kept(), n, free);
        let mut own: Vec<f64> = kept.particular.iter().map(|c| particular * c).collect();
        for (k, s) in s.iter().enumerate() {
            own.iter_mut().zip(&kept.upper[k * (k + 1) / 2..][..=k]).for_each(|(o, c)| *o += s * c);
            own[n..].iter_mut().zip(&kept.free[k * free..][..free]).for_each(|(o, c)| *o += s * c);
        }
        self.triangle(corners, &force.times(particular)).stresses(&own[..n], &own[n..], out);
    }

    /// The second group of columns: the pressure before it is orthogonal to them.
    fn unloaded(&self, corners: [[f64; 2]; 3], material: &Material) -> Vec<Vec<[f64; 3]>> {
        let triangle = self.triangle(corners, &BodyForce::NONE);
        let factor = Factor::new(&triangle, material);
        let area = triangle.shape.frame.scale * triangle.shape.frame.scale;
        let unit = (3.0 * material.unit() / area).sqrt();
        let none = vec![0.0; self.parameters()];
        let field = |k: usize| {
            let mut column = vec![0.0; k + 1];
            column[k] = unit;
            factor.solve(&mut column);
            let mut own = none.clone();
            own[0] = column[0];
            let mut out = vec![[0.0; 3]; 3 * lattice_len(self.degree)];
            triangle.stresses(&own, &column[1..], &mut out);
            out
        };
        (1..=self.free()).map(field).collect()
    }
}

/// Coefficients kept for a triangle.
struct Kept<'a> {
    /// Coefficients of mode k in the first k + 1 fields with traction: a packed upper triangle, column by column.
    upper: &'a [f64],
    /// Coefficients of the modes in fields without traction, mode by mode.
    free: &'a [f64],
    /// Coefficients of λ̄ in fields with traction, then in those without.
    particular: &'a [f64],
}

impl<'a> Kept<'a> {
    fn new(data: &'a [f64], n: usize, free: usize) -> Self {
        let (upper, rest) = data.split_at(n * (n + 1) / 2);
        let (of_free, particular) = rest.split_at(n * free);
        Kept { upper, free: of_free, particular }
    }
}

wide! {
    /// Adds Σ c_i rows_i.
    fn add(out: &mut [f64], c: &[f64], rows: &[f64]) {
        for (c, row) in c.iter().zip(rows.chunks_exact(out.len())) {
            out.iter_mut().zip(row).for_each(|(o, r)| *o += c * r);
        }
    }
}

/// A triangle with its fields. Fields with traction are numbered in the order of the columns.
struct Triangle {
    degree: usize,
    reference: &'static Reference,
    shape: Shape,
    /// Body force in the frame, times its unit of length.
    force: Affine,
}

impl Triangle {
    /// True if there is a body force.
    fn is_loaded(&self) -> bool {
        self.force != Affine::default()
    }

    /// A stress (xx, yy, xy) in the frame that balances the body force: none along the longest side.
    fn balancing(&self, point: [f64; 2]) -> [f64; 3] {
        if self.force.is_constant() {
            let ([fx, fy], [_, y]) = (self.force.value, point);
            return [0.0, -fy * y, -fx * y];
        }
        balancing(&self.force, point)
    }

    /// Traction coefficients of the fields with traction, field by field, in global components.
    fn tractions(&self) -> Vec<f64> {
        let (p, frame) = (self.degree, &self.shape.frame);
        let per_field = 6 * (p + 1);
        let off_base = &self.reference.off_base;
        let mut out = vec![0.0; (1 + off_base.len() + Across::len(p)) * per_field];
        for side in 0..3 {
            // Reference side 0 is the longest one.
            let place = 2 * (p + 1) * ((frame.base + side) % 3);
            let [nx, ny] = self.unit_normal(side);
            let mut put = |field: usize, k: usize, t: [f64; 2]| {
                let t = frame.vector_to_global(t);
                let at = field * per_field + place + 2 * k;
                out[at] += t[0];
                out[at + 1] += t[1];
            };
            for k in 0..=p {
                put(0, k, [nx, ny]);
                for (i, field) in off_base.iter().enumerate() {
                    put(1 + i, k, self.shape.traction(side, field.traction[side * (p + 1) + k]));
                }
            }
            let across = Across::new(&self.shape, p);
            let weights = self.reference.from_side_points.chunks_exact(p + 1);
            for (&s, weights) in self.reference.side_points.iter().zip(weights) {
                across.at(self.shape.point(side, [1.0 - s, s, 0.0]), |i, [yy, xy]| {
                    for (k, w) in weights.iter().enumerate() {
                        put(1 + off_base.len() + i, k, [w * xy * ny, w * (xy * nx + yy * ny)]);
                    }
                });
            }
        }
        out
    }

    /// Traction coefficients of the field that balances the body force, in global components.
    fn balancing_traction(&self) -> Vec<f64> {
        let (p, frame) = (self.degree, &self.shape.frame);
        let mut out = vec![0.0; 6 * (p + 1)];
        for side in 0..3 {
            let place = 2 * (p + 1) * ((frame.base + side) % 3);
            let [nx, ny] = self.unit_normal(side);
            let traction = |s: f64| {
                let [_, yy, xy] = self.balancing(self.shape.point(side, [1.0 - s, s, 0.0]));
                frame.vector_to_global([xy * ny, xy * nx + yy * ny])
            };
            if self.force.is_constant() {
                // Linear: its coefficients are its values at equal steps.
                for k in 0..=p {
                    out[place + 2 * k..][..2].copy_from_slice(&traction(k as f64 / p as f64));
                }
                continue;
            }
            let weights = self.reference.from_side_points.chunks_exact(p + 1);
            for (&s, weights) in self.reference.side_points.iter().zip(weights) {
                let t = traction(s);
                for (k, w) in weights.iter().enumerate() {
                    (0..2).for_each(|c| out[place + 2 * k + c] += w * t[c]);
                }
            }
        }
        out
    }

    fn unit_normal(&self, side: usize) -> [f64; 2] {
        let [x, y] = self.shape.normal(side);
        [x / x.hypot(y), y / x.hypot(y)]
    }

    /// Nodal stresses of the fields with traction times `own`, those without times `free`, and what balances the body force.
    fn stresses(&self, own: &[f64], free: &[f64], out: &mut [[f64; 3]]) {
        let Reference { off_base, nodes, .. } = self.reference;
        let across = Across::new(&self.shape, self.degree);
        let mut reference = vec![[0.0; 3]; out.len()];
        let (of_off_base, of_across) = own[1..].split_at(off_base.len());
        let mut gather = |c: &f64, field: &Field| {
            let nodal = field.nodal.as_flattened();
            reference.as_flattened_mut().iter_mut().zip(nodal).for_each(|(r, v)| *r += c * v);
        };
        free.iter().zip(&self.reference.free).for_each(|(c, field)| gather(c, field));
        of_off_base.iter().zip(off_base).for_each(|(c, field)| gather(c, field));
        for (sub, reference) in reference.chunks_exact(nodes.len()).enumerate() {
            let place = (self.shape.frame.base + sub) % 3 * nodes.len();
            for (i, (l, reference)) in nodes.iter().zip(reference).enumerate() {
                let point = self.shape.point(sub, *l);
                let (mapped, balancing) = (self.shape.stress(*reference), self.balancing(point));
                let mut stress = [0, 1, 2].map(|c| mapped[c] + balancing[c]);
                stress[0] += own[0];
                stress[1] += own[0];
                across.at(point, |j, [yy, xy]| {
                    stress[1] += of_across[j] * yy;
                    stress[2] += of_across[j] * xy;
                });
                out[place + i] = self.shape.frame.tensor_to_global(stress);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::element::Block;
    use crate::scene::Kinematics;

    #[test]
    fn the_first_degree_is_the_element_of_the_paper() {
        let flat = [[0.0, 0.0], [1.0, 0.2], [0.4, 0.081]];
        for corners in [[[0.0, 0.0], [1.0, 0.1], [0.3, 0.8]], [[7.0, 3.0], [9.0, 3.5], [7.5, 8.0]], flat] {
            for nu in [0.0, 0.3, 0.499_999_9] {
                let material = Material::isotropic(Kinematics::PlaneStrain, 3.0, nu);
                let force = BodyForce::constant([2.0, -1.0]);
                let (first, second) =
                    (Block.modes(corners, &material, &force), Split::new(1).modes(corners, &material, &force));
                let stiffness = |modes: &Modes<'_>| {
                    let t = DMatrix::from_column_slice(12, 9, modes.traction());
                    &t * t.transpose()
                };
                let (a, b) = (stiffness(&first), stiffness(&second));
                assert!((&a - &b).amax() < 1e-10 * a.amax(), "ν = {nu}: {:.1e}", (&a - &b).amax() / a.amax());
                let apart = first.particular_energy() - second.particular_energy();
                assert!(apart.abs() < 1e-11 * first.particular_energy());
                let mut fields = [[[0.0; 3]; 9]; 2];
                Block.stresses(corners, &force, &first, &[0.0; 9], 1.0, &mut fields[0]);
                Split::new(1).stresses(corners, &force, &second, &[0.0; 9], 1.0, &mut fields[1]);
                let [first, second] = fields.map(|field| DMatrix::from_column_slice(27, 1, field.as_flattened()));
                assert!((&first - &second).amax() < 1e-10 * first.amax());
            }
        }
    }
}
