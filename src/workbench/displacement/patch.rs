//! The patch test: a constant strain is met exactly, in energy, in nodal forces, and as the solution on a patch.
//!
//! For u = ε x the stress is σ = c ε throughout, so that 2 · energy = t |A| σ:ε and the nodal forces are K u = t ∮ σn N_i ds. The
//! traces N_i on a straight side are the Lagrange polynomials through its nodes whatever the element does inside.

use nalgebra::{DMatrix, Matrix3};

use super::{DisplacementElement, largest, mesh::Patch, shapes};
use crate::report::text::number::{percent, significant};
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::material::Material;
use crate::workbench::outline::Outline;

pub const ENERGY: Property<DisplacementElement> =
    Property { name: "patch-energy", asks: "a constant strain stores t·A·½ σ:ε", usual: true, measure: energy };

pub const FORCES: Property<DisplacementElement> = Property {
    name: "patch-forces",
    asks: "a constant strain gives the nodal forces t·∮ σn N ds of its stress",
    usual: true,
    measure: forces,
};

pub const DISTORTED: Property<DisplacementElement> = Property {
    name: "patch-distorted",
    asks: "energy and nodal forces of a constant strain on distorted shapes",
    usual: true,
    measure: distorted,
};

pub const SOLVED: Property<DisplacementElement> = Property {
    name: "patch-solved",
    asks: "a patch of distorted elements, moved on its boundary by a constant strain, has that strain inside",
    usual: true,
    measure: solved,
};

/// Nodal displacements of the strains (1, 0, 0), (0, 1, 0) and γ = 1, one a column, about the first node.
pub fn strains(nodes: &[[f64; 2]]) -> DMatrix<f64> {
    let mut u = DMatrix::zeros(2 * nodes.len(), 3);
    for (n, x) in nodes.iter().enumerate() {
        let [x, y] = [x[0] - nodes[0][0], x[1] - nodes[0][1]];
        u[(2 * n, 0)] = x;
        u[(2 * n + 1, 1)] = y;
        (u[(2 * n, 2)], u[(2 * n + 1, 2)]) = (0.5 * y, 0.5 * x);
    }
    u
}

/// Hooke's law times thickness as K shows it under constant strains.
pub fn hooke_seen(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline) -> Matrix3<f64> {
    let u = strains(nodes);
    let g = u.tr_mul(&(k * &u)) / outline.area;
    Matrix3::from_fn(|i, j| g[(i, j)])
}

/// How far the nodal forces of constant strains are from those of the stresses `hooke` gives, relative to the largest.
fn forces_off(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline, hooke: &Matrix3<f64>) -> f64 {
    let found = k * strains(nodes);
    let (mut off, mut size) = (0.0_f64, 0.0_f64);
    for (j, found) in found.column_iter().enumerate() {
        let exact = outline.nodal_forces(nodes, [hooke[(0, j)], hooke[(1, j)], hooke[(2, j)]]);
        for (a, b) in found.iter().zip(exact) {
            off = off.max((a - b).abs());
            size = size.max(b.abs());
        }
    }
    off / size.max(f64::MIN_POSITIVE)
}

/// True if nodal forces of constant strains are those of the material, or of the one that K shows where none is given.
pub fn is_exact(e: &DisplacementElement) -> bool {
    let hooke = match e.material {
        Some(m) => m.hooke() * m.thickness,
        None => hooke_seen(&e.matrix, &e.nodes, &e.outline),
    };
    forces_off(&e.matrix, &e.nodes, &e.outline, &hooke) <= e.precision
}

fn energy_off(k: &DMatrix<f64>, nodes: &[[f64; 2]], outline: &Outline, material: &Material) -> f64 {
    let exact = material.hooke() * material.thickness;
    (hooke_seen(k, nodes, outline) - exact).amax() / exact.amax()
}

/// Describes the material that K shows as Hooke's law times thickness; `None` if it is not isotropic.
pub fn material_words(seen: &Matrix3<f64>) -> Option<String> {
    let (a, b, g) = (0.5 * (seen[(0, 0)] + seen[(1, 1)]), 0.5 * (seen[(0, 1)] + seen[(1, 0)]), seen[(2, 2)]);
    let isotropic = Matrix3::new(a, b, 0.0, b, a, 0.0, 0.0, 0.0, 0.5 * (a - b));
    if a <= 0.0 || (seen - isotropic).amax() > 1e-6 * a {
        return None;
    }
    let (nu, state) = (b / a, "plane stress");
    let stress = format!("E t = {} and ν = {} in {state}", significant(2.0 * g * (1.0 + nu), 6), significant(nu, 6));
    let nu = b / (a + b);
    let strain =
        format!("E t = {} and ν = {} in plane strain", significant(2.0 * g * (1.0 + nu), 6), significant(nu, 6));
    Some(format!("{strain}, or {stress}"))
}

fn energy(e: &DisplacementElement) -> Result<Measured, Fault> {
    let seen = hooke_seen(&e.matrix, &e.nodes, &e.outline);
    let Some(material) = e.material else {
        let text = match material_words(&seen) {
            Some(words) => format!("no material is given; constant strains store energy as with {words}"),
            None => "no material is given, and constant strains store energy as in no isotropic one".into(),
        };
        return Err(Fault::NotMade(text));
    };
    let exact = material.hooke() * material.thickness;
    let value = energy_off(&e.matrix, &e.nodes, &e.outline, &material);
    let allowed = allowed(e, value, &exact)?;
    let sentence = if value <= allowed {
        "Constant strains store what they must".to_string()
    } else {
        let ratio = |i: usize| percent(seen[(i, i)] / exact[(i, i)]);
        format!(
            "Stretching along x, along y and shear store {}, {} and {} of what they must",
            ratio(0),
            ratio(1),
            ratio(2)
        )
    };
    Ok(Measured::new(value, allowed, sentence))
}

/// By how much the products are larger than their sum in an element that is not thin, at most.
const WELL_SHAPED: f64 = 10.0;
/// Nothing is told from a matrix in which this part of what constant strains store is rounding.
const TOO_THIN: f64 = 1e-3;

/// What rounding of the entries may change of the energies of constant strains, relative to the largest: in a thin element they are small
/// differences of large products. A larger `value` says nothing of an element whose area and traces its nodes do not tell, which are read
/// off them as if its sides were straight and their nodes evenly spaced.
fn allowed(e: &DisplacementElement, value: f64, exact: &Matrix3<f64>) -> Result<f64, Fault> {
    let u = strains(&e.nodes).abs();
    // A matrix that is far too large is not thin.
    let stored = exact.amax().max(hooke_seen(&e.matrix, &e.nodes, &e.outline).amax());
    let size = u.tr_mul(&(e.matrix.abs() * &u)).amax() / (e.outline.area * stored);
    let allowed = e.precision * (size / WELL_SHAPED).max(1.0);
    if allowed > TOO_THIN {
        return Err(Fault::NotMade(
            "the element is so thin that rounding of the entries hides its constant strains".into(),
        ));
    }
    if value <= allowed || e.outline.is_regular(&e.nodes) {
        return Ok(allowed);
    }
    Err(Fault::NotMade(
        "nodes of its sides are not evenly spaced on straight lines: what constant strains do depends on the curve, or on the coordinate, \
         in which the element has its traces, and the matrix does not tell them. Give it with straight sides and nodes in their middles"
            .into(),
    ))
}

fn forces(e: &DisplacementElement) -> Result<Measured, Fault> {
    let seen = hooke_seen(&e.matrix, &e.nodes, &e.outline);
    let (hooke, of) = match e.material {
        Some(m) => (m.hooke() * m.thickness, "of the material"),
        None => (seen, "that its energies show"),
    };
    let value = forces_off(&e.matrix, &e.nodes, &e.outline, &hooke);
    let allowed = allowed(e, value, &hooke)?;
    let sentence = match value <= allowed {
        true => format!("Nodal forces of constant strains are those of the stress {of}"),
        false if e.material.is_some() && forces_off(&e.matrix, &e.nodes, &e.outline, &seen) <= allowed => {
            "Nodal forces of constant strains are those of another material".to_string()
        }
        false => {
            format!("Nodal forces of constant strains are not those of the stress {of}: they sit on the wrong nodes")
        }
    };
    Ok(Measured::new(value, allowed, sentence))
}

fn distorted(e: &DisplacementElement) -> Result<Measured, Fault> {
    let corners = e.outline.corners.len();
    let shapes = shapes::sweep(corners).into_iter().chain(shapes::rotations(corners));
    let (value, worst, count) = largest(e, shapes, |k, nodes, outline, material| {
        let hooke = material.hooke() * material.thickness;
        energy_off(k, nodes, outline, material).max(forces_off(k, nodes, outline, &hooke))
    })?;
    let sentence = match value <= e.precision {
        true => format!("Energy and nodal forces of constant strains are right on {count} shapes"),
        false => format!("Energy or nodal forces of constant strains are wrong on the element {worst}"),
    };
    Ok(Measured::new(value, e.precision, sentence))
}

fn solved(e: &DisplacementElement) -> Result<Measured, Fault> {
    e.formula()?;
    let material = e.material()?;
    let patch = Patch::new(e, 3, 0.2)?;
    let given = strains(&patch.nodes);
    let k = patch.assembled(e, &material)?;
    let inside: Vec<usize> = patch.inside().into_iter().flat_map(|n| [2 * n, 2 * n + 1]).collect();
    let held: Vec<usize> = (0..given.nrows()).filter(|i| !inside.contains(i)).collect();
    let load = k.select_rows(&inside).select_columns(&held) * given.select_rows(&held);
    let Some(found) = k.select_rows(&inside).select_columns(&inside).lu().solve(&-load) else {
        return Err(Fault::Failed("the patch has no solution: motions inside it store nothing".into()));
    };
    let exact = given.select_rows(&inside);
    let value = (found - &exact).amax() / exact.amax();
    let allowed = 1e3 * e.precision;
    let sentence = match value <= allowed {
        true => "A patch of 3 × 3 distorted cells has the constant strain inside, relative to the largest displacement",
        false => {
            "A patch of 3 × 3 distorted cells misses the constant strain inside, relative to the largest displacement"
        }
    };
    Ok(Measured::new(value, allowed, sentence))
}
