//! An element from the stresses that span it: beside them, all that it takes is linear algebra.
//!
//! The fields may be any that span the space, dependent ones among them. They are made orthonormal in complementary energy; those
//! without traction on the boundary are split off, and modes and λ̄ are what is left of the others by them, as in [`super::block`].
//! That they balance is not looked at here: the workbench measures it.

use std::sync::{Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use super::geometry::from_centroid;
use super::polynomial::quadrature::triangle_rule;
use super::{EquilibriumElement, Material, Modes, ModesMut, StressField, lattice, lattice_len};
use crate::load::{BodyForce, balancing};

/// Corners of a triangle, counter-clockwise.
pub type Corners = [[f64; 2]; 3];
/// A stress by its values (xx, yy, xy) at the lattice nodes of the three subtriangles, as in [`StressField::block`].
pub type Nodal = Vec<[f64; 3]>;
/// Stresses without divergence that span the space on a triangle, or why there are none.
pub type Spans = dyn Fn(Corners) -> Result<Vec<Nodal>, String> + Send + Sync;
/// A stress whose divergence is minus a body force, or why there is none.
pub type Balances = dyn Fn(Corners, [f64; 2]) -> Result<Nodal, String> + Send + Sync;

/// Of fields of energy one, what is smaller is rounding.
const ZERO: f64 = 1e-9;
/// A triangle without symmetry, on which modes are counted.
const USUAL: Corners = [[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]];

/// The element that some stresses span.
pub struct Spanned {
    name: &'static str,
    degree: usize,
    parameters: usize,
    spans: Box<Spans>,
    balances: Option<Box<Balances>>,
    fault: Mutex<Option<String>>,
}

/// Fields on one triangle: nodal values in columns, tractions and energies of each.
struct Fields {
    values: DMatrix<f64>,
    tractions: DMatrix<f64>,
    /// Columns whose products are energies ∫ a λ:μ.
    energies: DMatrix<f64>,
}

impl Spanned {
    /// The element of stresses and tractions of degree `degree` that `spans`; λ̄ is what `balances` gives, and −(F_x x, F_y y, 0) about
    /// the centroid without it.
    ///
    /// # Errors
    /// The fields on a plain triangle cannot be had, are of another degree, or none of them has a traction.
    pub fn new(
        name: &'static str,
        degree: usize,
        spans: Box<Spans>,
        balances: Option<Box<Balances>>,
    ) -> Result<Self, String> {
        let mut element = Spanned { name, degree, parameters: 0, spans, balances, fault: Mutex::new(None) };
        let material = Material::isotropic(crate::scene::Kinematics::PlaneStrain, 1.0, 0.3);
        let (modes, _) = element.basis(USUAL, &material, &BodyForce::NONE)?;
        element.parameters = modes.values.ncols();
        match element.parameters {
            0 => {
                Err("no field has a traction on the sides of the triangle; an element passes tractions on".to_string())
            }
            _ => Ok(element),
        }
    }

    /// The error that occurred on a triangle since the last call, if any.
    pub fn fault(&self) -> Option<String> {
        self.fault.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Modes, and λ̄ as fields of one column.
    fn basis(&self, corners: Corners, material: &Material, force: &BodyForce) -> Result<(Fields, Fields), String> {
        let given = (self.spans)(corners)?;
        let particular = match &self.balances {
            Some(balances) if force.is_constant() => balances(corners, force.on(corners).mean())?,
            Some(_) => return Err("it balances constant body forces, and this one is affine".to_string()),
            None => particular(corners, self.degree, force),
        };
        let expected = 3 * lattice_len(self.degree);
        for (k, field) in given.iter().chain([&particular]).enumerate() {
            let what = || if k < given.len() { format!("field {k}") } else { "the particular field".to_string() };
            if field.len() != expected {
                return Err(format!("{} has {} nodes, and degree {} has {expected}", what(), field.len(), self.degree));
            }
            if !field.as_flattened().iter().all(|x| x.is_finite()) {
                return Err(format!("{} is not finite", what()));
            }
        }
        let mut fields = self.measured(corners, material, &given).orthonormal();
        fields = fields.orthonormal();
        let mut particular = self.measured(corners, material, &[particular]);
        let shares = fields.energies.transpose() * &particular.energies;
        particular.values -= &fields.values * &shares;
        particular.tractions -= &fields.tractions * &shares;
        particular.energies -= &fields.energies * &shares;
        // The directions in which tractions are seen.
        let seen = fields.tractions.transpose().col_piv_qr();
        let rank = rank(&seen.r());
        Ok((fields.combined(&seen.q().columns(0, rank).into_owned()), particular))
    }

    fn measured(&self, corners: Corners, material: &Material, fields: &[Nodal]) -> Fields {
        let p = self.degree;
        let mut stress = StressField::zeros(p, fields.len());
        for (block, field) in stress.blocks_mut().into_iter().zip(fields) {
            block.copy_from_slice(field);
        }
        let area = 0.5
            * ((corners[1][0] - corners[0][0]) * (corners[2][1] - corners[0][1])
                - (corners[1][1] - corners[0][1]) * (corners[2][0] - corners[0][0]));
        let (roots, unit) = (material.roots(), material.unit());
        let rule = triangle_rule(2 * p);
        let energy = |k: usize| {
            let mut column = Vec::with_capacity(9 * rule.len());
            for sub in 0..3 {
                for &(l, weight) in rule {
                    let (tau, root) = (stress.at(k, sub, l), (weight * area / (3.0 * unit)).sqrt());
                    column.extend(roots.apply(tau).map(|x| root * x));
                }
            }
            DVector::from_vec(column)
        };
        let traction = |k: usize| {
            let mut column = Vec::with_capacity(6 * (p + 1));
            for side in 0..3 {
                let [a, b] = [corners[(side + 1) % 3], corners[(side + 2) % 3]];
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let [x, y] = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
                column.extend(stress.on_side(k, side).flat_map(|[xx, yy, xy]| [xx * x + xy * y, xy * x + yy * y]));
            }
            DVector::from_vec(column)
        };
        let matrix = |of: &dyn Fn(usize) -> DVector<f64>, rows: usize| {
            let columns: Vec<DVector<f64>> = (0..fields.len()).map(of).collect();
            if columns.is_empty() { DMatrix::zeros(rows, 0) } else { DMatrix::from_columns(&columns) }
        };
        let nodal = |k: usize| DVector::from_column_slice(fields[k].as_flattened());
        Fields {
            values: matrix(&nodal, 9 * lattice_len(p)),
            tractions: matrix(&traction, 6 * (p + 1)),
            energies: matrix(&energy, 9 * rule.len()),
        }
    }
}

impl Fields {
    /// Fields of energy one that span the same.
    fn orthonormal(mut self) -> Fields {
        for k in 0..self.energies.ncols() {
            let norm = self.energies.column(k).norm();
            let factor = if norm > 0.0 { 1.0 / norm } else { 0.0 };
            for matrix in [&mut self.values, &mut self.tractions, &mut self.energies] {
                matrix.column_mut(k).scale_mut(factor);
            }
        }
        let factored = self.energies.clone().col_piv_qr();
        let (r, order) = (factored.r(), factored.p());
        let rank = rank(&r);
        let leading = r.view((0, 0), (rank, rank)).transpose();
        let of = |mut matrix: DMatrix<f64>| {
            order.permute_columns(&mut matrix);
            let kept = matrix.columns(0, rank).transpose();
            leading.solve_lower_triangular(&kept).unwrap_or(kept).transpose()
        };
        Fields { values: of(self.values), tractions: of(self.tractions), energies: of(self.energies) }
    }

    fn combined(&self, by: &DMatrix<f64>) -> Fields {
        let of = |matrix: &DMatrix<f64>| matrix * by;
        Fields { values: of(&self.values), tractions: of(&self.tractions), energies: of(&self.energies) }
    }
}

/// How many rows of a pivoted R count.
fn rank(r: &DMatrix<f64>) -> usize {
    let of = |k: usize| r[(k, k)].abs();
    (0..r.nrows().min(r.ncols())).take_while(|&k| of(k) > ZERO * of(0)).count()
}

/// −(F_x x, F_y y, 0) about the centroid for a constant force; [`balancing`] for any other.
fn particular(corners: Corners, degree: usize, body_force: &BodyForce) -> Nodal {
    let affine = body_force.about_centroid(corners);
    let (force, corners) = (affine.value, from_centroid(corners));
    let of_sub = |sub: usize| {
        let ends = [corners[(sub + 1) % 3], corners[(sub + 2) % 3]];
        lattice(degree).map(move |l| {
            let [x, y] = [0, 1].map(|c| l[0] * ends[0][c] + l[1] * ends[1][c]);
            if affine.is_constant() { [-force[0] * x, -force[1] * y, 0.0] } else { balancing(&affine, [x, y]) }
        })
    };
    (0..3).flat_map(of_sub).collect()
}

impl EquilibriumElement for Spanned {
    fn name(&self) -> &'static str {
        self.name
    }

    fn degree(&self) -> usize {
        self.degree
    }

    fn parameters(&self) -> usize {
        self.parameters
    }

    /// The nodal values of all modes and of λ̄.
    fn kept(&self) -> usize {
        (self.parameters + 1) * 9 * lattice_len(self.degree)
    }

    /// Zeros, and a [`Spanned::fault`], where there are no modes to be had.
    fn compute(&self, corners: Corners, material: &Material, force: &BodyForce, out: ModesMut<'_>) {
        let found = self.basis(corners, material, force).and_then(|(modes, particular)| {
            match modes.values.ncols() == self.parameters {
                true => Ok((modes, particular)),
                false => Err(format!("{} fields have tractions, elsewhere {}", modes.values.ncols(), self.parameters)),
            }
        });
        let (modes, particular) = match found {
            Ok(found) => found,
            Err(reason) => {
                let text = format!("{} on the triangle {corners:?}: {reason}", self.name);
                self.fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
                [out.traction, out.particular_traction, out.kept].into_iter().for_each(|part| part.fill(0.0));
                *out.particular_energy = 0.0;
                return;
            }
        };
        out.traction.copy_from_slice(modes.tractions.as_slice());
        out.particular_traction.copy_from_slice(particular.tractions.as_slice());
        *out.particular_energy = particular.energies.norm_squared();
        let (kept, last) = out.kept.split_at_mut(modes.values.len());
        kept.copy_from_slice(modes.values.as_slice());
        last.copy_from_slice(particular.values.as_slice());
    }

    fn stresses(&self, _: Corners, _: &BodyForce, modes: &Modes<'_>, s: &[f64], particular: f64, out: &mut [[f64; 3]]) {
        let values = out.as_flattened_mut();
        let factors = s.iter().chain([&particular]);
        values.fill(0.0);
        for (field, factor) in modes.kept().chunks_exact(values.len()).zip(factors) {
            values.iter_mut().zip(field).for_each(|(v, f)| *v += factor * f);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Section, block};
    use super::*;

    /// The modes of the block, mixed and with one field twice, as if somebody had found them.
    fn mixed(degree: usize) -> Spanned {
        let material = Material::isotropic(crate::scene::Kinematics::PlaneStress, 3.0, 0.1);
        let spans = move |corners| {
            let modes = block(degree).modes(corners, &material, &BodyForce::NONE);
            let fields = Section::Slice.mode_stresses(block(degree), corners, &modes);
            let mix = |k: usize| {
                let add = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|c| 2.0 * a[c] - 0.3 * b[c]);
                fields[k].iter().zip(&fields[(k + 1) % fields.len()]).map(add).collect()
            };
            Ok((0..fields.len()).map(mix).chain([fields[0].clone()]).collect())
        };
        Spanned::new("mixed", degree, Box::new(spans), None).expect("an element")
    }

    /// The stiffness T Tᵀ belongs to the space, whatever spans it: for p = 1 no field is without traction.
    #[test]
    fn stiffness_and_loads_are_those_of_the_block() {
        let corners = [[0.3, 0.1], [1.9, -0.2], [0.8, 1.1]];
        let (material, force) =
            (Material::isotropic(crate::scene::Kinematics::PlaneStrain, 2.0, 0.4), BodyForce::constant([0.4, -0.7]));
        let (own, plain) = (mixed(1), block(1));
        assert_eq!(own.parameters(), plain.parameters());
        let [a, b] = [&own as &dyn EquilibriumElement, plain].map(|e| e.modes(corners, &material, &force));
        let stiffness = |modes: &Modes<'_>, i: usize, j: usize| modes.tractions().map(|t| t[i] * t[j]).sum::<f64>();
        for i in 0..plain.tractions() {
            for j in 0..plain.tractions() {
                let (x, y) = (stiffness(&a, i, j), stiffness(&b, i, j));
                assert!((x - y).abs() < 1e-11 * stiffness(&b, i, i).max(stiffness(&b, j, j)), "{i} {j}: {x} {y}");
            }
            let (x, y) = (a.particular_traction()[i], b.particular_traction()[i]);
            assert!((x - y).abs() < 1e-11, "{i}: {x} {y}");
        }
        assert!((a.particular_energy() - b.particular_energy()).abs() < 1e-12);
        assert_eq!(own.fault(), None);
    }

    #[test]
    fn what_is_no_element_is_told() {
        let of = |spans: Box<Spans>| Spanned::new("odd", 1, spans, None).err().unwrap_or_default();
        assert!(of(Box::new(|_| Err("no idea".into()))).contains("no idea"));
        assert!(of(Box::new(|_| Ok(vec![vec![[1.0; 3]; 4]]))).contains("field 0 has 4 nodes, and degree 1 has 9"));
        assert!(of(Box::new(|_| Ok(vec![vec![[f64::NAN; 3]; 9]]))).contains("field 0 is not finite"));
        assert!(of(Box::new(|_| Ok(Vec::new()))).contains("no field has a traction"));
        assert!(of(Box::new(|_| Ok(vec![vec![[0.0; 3]; 9]]))).contains("no field has a traction"));
        // On some triangles only: zeros, and the reason.
        let sometimes = |corners: Corners| match corners[0][0] < 0.5 {
            true => Ok(vec![vec![[1.0, 0.0, 0.0]; 9]]),
            false => Err("too far right".to_string()),
        };
        let element = Spanned::new("some", 1, Box::new(sometimes), None).expect("an element");
        let material = Material::isotropic(crate::scene::Kinematics::PlaneStrain, 1.0, 0.3);
        let modes = element.modes([[2.0, 0.0], [3.0, 0.0], [2.0, 1.0]], &material, &BodyForce::NONE);
        assert!(modes.traction().iter().all(|x| *x == 0.0));
        assert!(element.fault().is_some_and(|text| text.contains("too far right")) && element.fault().is_none());
    }
}
