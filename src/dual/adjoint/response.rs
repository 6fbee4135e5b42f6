//! Stresses in equilibrium with other loads, from the factor of the problem that was solved.
//!
//! A quantity of interest has an adjoint stress σ_z: in equilibrium with a load of its own, without shear on Γ_0 and Γ_K, its
//! normal traction s on Γ_K of either sign where the contact presses, zero where it is open. It solves the hybrid form with the
//! same K and the jumps of closed contact held, or let go where s is at a bound ([`Loaded::respond`]).

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;

use super::loaded::{Loaded, Start};
use crate::dual::contact::rigid::unsupported;
use crate::dual::contact::schur::Schur;
use crate::dual::hybrid::{Motion, residual};
use crate::dual::modes::ModeTable;
use crate::dual::system::reduced::Reduced;
use crate::dual::system::{Structured, System, add_edge_loads, jump_moments, load_of_tractions};
use crate::dual::{DualError, Options};
use crate::elasticity::Initial;
use crate::element::polynomial::side;
use crate::element::revolved::Tensor;
use crate::element::{Samples, SideValues, StressField, contraction, lattice_len, weighed};
use crate::load::BodyForce;
use crate::problem::Problem;

/// K and its factor, ready for further loads.
#[derive(Debug)]
pub struct Factorised {
    system: System,
    reduced: Reduced,
}

impl Factorised {
    /// From a system and its condensed form at the end of a solve.
    pub(in crate::dual) fn of(system: System, reduced: Reduced) -> Self {
        Factorised { system, reduced }
    }

    /// Assembles and factorises; `motions` as in [`crate::dual::solve`].
    ///
    /// # Errors
    /// [`DualError::Factorisation`], [`DualError::TooLarge`].
    pub fn new(problem: &Problem, motions: &[Motion], options: &Options) -> Result<Self, DualError> {
        let Structured { mut system, structure, .. } = System::structured(problem, options);
        let reduced = Reduced::new(problem, &mut system, structure?, motions, options)?;
        Ok(Factorised { system, reduced })
    }

    /// The responses to other loads on `problem`, which K belongs to, per unit thickness. Contacts of up to `longest_dense`
    /// jumps have a dense Schur complement; remainders are weighed with the displacement whose edge moments are `moments`.
    pub fn responses<'a>(
        &'a self,
        problem: &'a Problem,
        moments: &SideValues<[f64; 2]>,
        longest_dense: usize,
        options: &Options,
    ) -> Responses<'a> {
        let contact = Schur::new(&self.system, &self.reduced, longest_dense, options.budget, |most| {
            unsupported(problem, &self.system.unknowns, most)
        });
        let displaced = self.system.unknowns.project(|e, k| moments.of(e)[k]);
        Responses { problem, factorised: self, contact, displaced }
    }
}

/// A load beside that of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Body force of each body.
    pub force: Vec<BodyForce>,
    /// Tractions at the two ends of boundary edges, in the order of their vertices, whatever condition holds there.
    pub tractions: Vec<(usize, [[f64; 2]; 2])>,
    /// Initial strains χ (xx, yy, xy), constant on the triangles that have one: the stress wanted is σ̂ + cχ with σ̂ in
    /// equilibrium with the rest of the load.
    pub strains: Vec<(usize, [f64; 3])>,
    /// Initial strains of any shape, beside the constant ones.
    pub shaped: Vec<ShapedStrain>,
    /// Initial strains (rr, zz, tt, rz) of a body of revolution, constant on the triangles that have one.
    pub turned: Vec<(usize, Tensor)>,
    /// Tractions along edges of any kind, interior ones too, by their Bernstein coefficients in the degree of the edge.
    pub edges: Vec<(usize, Vec<[f64; 2]>)>,
    /// The Bernstein coefficients of φ on every contact pair, one interface after the other, empty where it vanishes: closed
    /// contact is held at the jump −φ.
    pub weights: Vec<Vec<f64>>,
}

/// An initial strain that is a polynomial on each subtriangle of one triangle: the projection of one of any shape, in a degree no
/// lower than those of all fields that it is multiplied with.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapedStrain {
    /// The triangle.
    pub triangle: usize,
    /// (xx, yy, xy) as a field on this triangle alone.
    pub strain: StressField,
}

/// Answers loads.
pub struct Responses<'a> {
    problem: &'a Problem,
    factorised: &'a Factorised,
    pub(in crate::dual) contact: Schur<'a>,
    /// The displacement that remainders are weighed with.
    pub(in crate::dual) displaced: Vec<f64>,
}

/// A stress in equilibrium with a load.
#[derive(Debug, Clone)]
pub struct Response {
    /// σ̂, without cχ.
    pub stress: Arc<StressField>,
    /// Moments of the displacement that belongs to it, as [`crate::dual::DualSolution::moments`].
    pub moments: Arc<SideValues<[f64; 2]>>,
    /// The coefficients of s on every contact pair, one interface after the other.
    pub contact: SideValues<f64>,
    /// Remainder of equilibrium, as work on the displacement that was given, per unit thickness: Σ |remainder · moment|.
    pub remainder: f64,
}

impl Responses<'_> {
    /// The factorised system.
    pub(in crate::dual) fn reduced(&self) -> &Reduced {
        &self.factorised.reduced
    }

    /// Prepares the answers to `load`.
    pub fn to(&self, load: &Load) -> Loaded<'_> {
        let Factorised { system, reduced } = self.factorised;
        let own = || self.problem.scene.bodies.iter().map(|body| body.body_force);
        // Elements of bodies of revolution have the initial strains of the scene, which no other load has.
        let strained = self.problem.section().is_revolved()
            && self.problem.scene.bodies.iter().any(|body| !body.initial.is_none());
        let (problem, modes) = if !strained && own().eq(load.force.iter().copied()) {
            (Cow::Borrowed(self.problem), system.modes.clone())
        } else {
            let mut other = self.problem.clone();
            for (body, force) in other.scene.draft.bodies.iter_mut().zip(&load.force) {
                body.body_force = *force;
                if strained {
                    body.initial = Initial::default();
                }
            }
            let modes = Arc::new(ModeTable::new(&other, system.modes.elements().clone()));
            (Cow::Owned(other), modes)
        };
        let mut external = load_of_tractions(&problem, &system.unknowns, load.tractions.iter().copied());
        add_edge_loads(&system.unknowns, &load.edges, &mut external);
        let mut system = System { modes, rhs: Vec::new(), external, initial: [].into(), ..system.clone() };
        let mut start = system.strained(&problem, &load.strains);
        let of_turned = system.turned(&problem, &load.turned, &mut start);
        let mut unloaded = system.shaped(&problem, &load.shaped, &mut start);
        unloaded.extend(of_turned);
        let r = residual(&problem, &system, &start);
        system.rhs.clone_from(&r);
        let (y, c) = reduced.condense(&r);
        let weights = load.weights.iter().map(Vec::as_slice);
        let held = jump_moments(&problem, &system.unknowns, weights).into_iter().map(|m| -m).collect();
        Loaded::new(self, problem, system, Start { s: start, y, c, held, unloaded })
    }
}

impl System {
    /// Mode parameters −∫ N_k : χ of the given constant strains: minus those of the moments of χx on the boundary.
    fn strained(&self, problem: &Problem, strains: &[(usize, [f64; 3])]) -> Vec<f64> {
        let mut out = vec![0.0; self.parameters()];
        for (t, [xx, yy, xy]) in strains {
            let corners = problem.mesh.corners(*t);
            let at = |i: usize| {
                let [x, y] = [0, 1].map(|c| corners[i % 3][c] - corners[0][c]);
                [xx * x + xy * y, xy * x + yy * y]
            };
            let p = self.modes.degree(*t);
            let mut moments = vec![0.0; 6 * (p + 1)];
            for (i, own) in moments.chunks_exact_mut(2 * (p + 1)).enumerate() {
                let [a, b] = [i + 1, i + 2].map(|j| corners[j % 3]);
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                for (c, (first, last)) in at(i + 1).into_iter().zip(at(i + 2)).enumerate() {
                    let along = side::moments(&[first, last], p);
                    own.iter_mut().skip(c).step_by(2).zip(along).for_each(|(m, v)| *m = -length * v);
                }
            }
            self.modes.of(*t).parameters_from_moments(&moments, &mut out[self.modes.parameters_of(*t)]);
        }
        out
    }

    /// Adds the mode parameters −∫ N_k : χ r of constant strains of a body of revolution to `s`, and gives what fields without traction add,
    /// as [`Self::shaped`] does: with a hoop a constant strain is not that of any displacement.
    fn turned(&self, problem: &Problem, strains: &[(usize, Tensor)], s: &mut [f64]) -> Vec<(usize, Vec<[f64; 3]>)> {
        let Some(revolved) = problem.section().revolved() else { return Vec::new() };
        let parts: Vec<(Vec<f64>, Vec<[f64; 3]>)> = strains
            .par_iter()
            .with_min_len(16)
            .map(|(t, chi)| {
                let (p, corners) = (self.modes.degree(*t), problem.mesh.corners(*t));
                let work = |nodal: &Vec<[f64; 3]>| revolved.strained(p, nodal, corners, *chi);
                let of_modes = self.modes.mode_stresses(problem, *t).iter().map(work).collect();
                let mut own = vec![[0.0; 3]; 3 * lattice_len(p)];
                for field in self.modes.unloaded(problem, *t) {
                    let work = work(&field);
                    own.iter_mut().zip(&field).for_each(|(o, f)| (0..3).for_each(|c| o[c] -= work * f[c]));
                }
                (of_modes, own)
            })
            .collect();
        let mut unloaded = Vec::new();
        for ((t, _), (of_modes, own)) in strains.iter().zip(parts) {
            s[self.modes.parameters_of(*t)].iter_mut().zip(of_modes).for_each(|(s, work)| *s -= work);
            unloaded.push((*t, own));
        }
        unloaded
    }

    /// Adds the mode parameters −∫ N_k : χ of initial strains of any shape to `s`; fields without traction balance nothing, and their
    /// part in the stress of least energy, −Σ (∫ F_j : χ) F_j, is known at once: their nodal stresses, triangle by triangle.
    fn shaped(&self, problem: &Problem, strains: &[ShapedStrain], s: &mut [f64]) -> Vec<(usize, Vec<[f64; 3]>)> {
        let parts: Vec<(Vec<f64>, Vec<[f64; 3]>)> = strains
            .par_iter()
            .with_min_len(16)
            .map(|ShapedStrain { triangle: t, strain }| {
                let p = self.modes.degree(*t);
                let area = problem.mesh.area(*t) / 3.0;
                let works = |fields: &[Vec<[f64; 3]>]| works(fields, p, strain, area);
                let of_modes = works(&self.modes.mode_stresses(problem, *t));
                let fields = self.modes.unloaded(problem, *t);
                let mut own = vec![[0.0; 3]; if fields.is_empty() { 0 } else { 3 * lattice_len(p) }];
                for (field, work) in fields.iter().zip(works(&fields)) {
                    own.iter_mut().zip(field).for_each(|(o, f)| (0..3).for_each(|c| o[c] -= work * f[c]));
                }
                (of_modes, own)
            })
            .collect();
        let mut unloaded = Vec::new();
        for (ShapedStrain { triangle: t, .. }, (of_modes, own)) in strains.iter().zip(parts) {
            s[self.modes.parameters_of(*t)].iter_mut().zip(of_modes).for_each(|(s, work)| *s -= work);
            if !own.is_empty() {
                unloaded.push((*t, own));
            }
        }
        unloaded
    }
}

/// ∫ N : χ for stresses N of degree `p` by their nodal values, on a triangle whose three subtriangles have the area `area`.
fn works(fields: &[Vec<[f64; 3]>], p: usize, strain: &StressField, area: f64) -> Vec<f64> {
    let r = strain.degree(0);
    let half = p.max(r);
    let (of_stress, of_strain) = (Samples::of_stress(p, half), Samples::of_stress(r, half));
    let nodes = lattice_len(p);
    let mut out = vec![0.0; fields.len()];
    for sub in 0..3 {
        for (q, (_, weight)) in of_stress.points.iter().enumerate() {
            let chi = strain.sample(0, sub, of_strain, q);
            for (out, field) in out.iter_mut().zip(fields) {
                let stress = weighed(&field[sub * nodes..], of_stress.basis(q).iter().copied());
                *out += weight * area * contraction(stress, chi);
            }
        }
    }
    out
}
