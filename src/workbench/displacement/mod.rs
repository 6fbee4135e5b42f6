//! Displacement elements: a stiffness matrix K on nodes, and the formula that makes it, where there is one.

mod condition;
mod convergence;
pub(super) mod definite;
pub(super) mod frame;
mod incompressible;
mod mesh;
mod patch;
mod rank;
mod reference;
mod rigid;
mod shapes;
mod skyline;
pub(super) mod symmetry;

use std::cell::OnceCell;

use nalgebra::DMatrix;

pub(super) use patch::{hooke_seen, material_words};
pub(super) use rank::{silent_motions, spurious};
pub(super) use rigid::{motions, within};
pub(super) use shapes::{Shape, irregular, sweep};

use self::convergence::Level;
use super::finding::{Fault, Property};
use super::material::Material;
use super::outline::Outline;
use super::scene::Exact;
use crate::scene::Kinematics;

/// Properties checked on a displacement element, in the order of a report: one file each, one line each.
pub const PROPERTIES: &[Property<DisplacementElement>] = &[
    symmetry::SYMMETRY,
    rigid::MOTIONS,
    rigid::FORCES,
    rank::RANK,
    definite::DEFINITE,
    definite::SWEEP,
    patch::ENERGY,
    patch::FORCES,
    patch::DISTORTED,
    patch::SOLVED,
    frame::ROTATION,
    frame::REFLECTION,
    frame::SCALING,
    frame::RENUMBERING,
    incompressible::INCOMPRESSIBLE,
    condition::CONDITION,
    convergence::BOUND,
    convergence::RATE,
    reference::REFERENCE,
];

/// The name of the property that only conforming elements with exact integrals have.
pub const BOUND: &str = convergence::BOUND.name;

/// Default bound on the rounding of a matrix, relative to its largest entry.
pub const PRECISION: f64 = 1e-9;

/// The largest that may be said: entries of two digits tell no mistake from rounding.
const LARGEST_PRECISION: f64 = 1e-2;

/// How exact entries are said to be, relative to the largest one.
///
/// # Errors
/// It is none, or so large that nothing could fail.
pub fn precision(given: f64) -> Result<f64, String> {
    if given > 0.0 && given <= LARGEST_PRECISION {
        return Ok(given);
    }
    Err(format!(
        "a precision of {given}: give a number above 0 and at most {LARGEST_PRECISION}, relative to the largest entry; \
         entries of fewer than three digits do not tell a mistake from rounding"
    ))
}

/// How the unknowns of a matrix are numbered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Order {
    /// x and y of the first node, x and y of the second one, …
    #[default]
    Interleaved,
    /// x of all nodes, then y of all nodes
    Blocked,
}

impl Order {
    /// Where component c of node n stands among `count` nodes.
    pub fn place(self, count: usize, n: usize, c: usize) -> usize {
        match self {
            Order::Interleaved => 2 * n + c,
            Order::Blocked => c * count + n,
        }
    }
}

/// A formula: K at nodes (x, y) in a material, two rows a node (x, then y).
pub type Formula = dyn Fn(&[[f64; 2]], &Material) -> Result<DMatrix<f64>, String> + Send;

/// A displacement element under test.
pub struct DisplacementElement {
    /// Its name.
    pub name: String,
    /// Its nodes.
    pub nodes: Vec<[f64; 2]>,
    /// Its boundary.
    pub outline: Outline,
    /// Its material, where it is known.
    pub material: Option<Material>,
    /// K, two rows a node.
    pub matrix: DMatrix<f64>,
    /// How exact the entries are, relative to the largest one.
    pub precision: f64,
    formula: Option<Box<Formula>>,
    /// The solved scene, once it was asked for.
    solved: OnceCell<(Exact, Vec<Level>)>,
}

impl DisplacementElement {
    /// One matrix.
    ///
    /// # Errors
    /// The matrix or the nodes are invalid; the message gives the reason.
    pub fn of_matrix(
        name: &str,
        matrix: &DMatrix<f64>,
        nodes: Vec<[f64; 2]>,
        order: Order,
        material: Option<Material>,
    ) -> Result<Self, String> {
        let outline = outline_of(&nodes)?;
        beside_axis(&nodes, material)?;
        let matrix = ordered(matrix, nodes.len(), order)?;
        Ok(DisplacementElement {
            name: name.into(),
            nodes,
            outline,
            material,
            matrix,
            precision: PRECISION,
            formula: None,
            solved: OnceCell::new(),
        })
    }

    /// A formula, with the nodes and the material to begin with.
    ///
    /// # Errors
    /// As [`Self::of_matrix`], or the error of the formula.
    pub fn of_formula(
        name: &str,
        nodes: Vec<[f64; 2]>,
        material: Material,
        formula: impl Fn(&[[f64; 2]], &Material) -> Result<DMatrix<f64>, String> + Send + 'static,
    ) -> Result<Self, String> {
        let outline = outline_of(&nodes)?;
        beside_axis(&nodes, Some(material))?;
        let matrix = ordered(&formula(&nodes, &material)?, nodes.len(), Order::Interleaved)?;
        Ok(DisplacementElement {
            name: name.into(),
            nodes,
            outline,
            material: Some(material),
            matrix,
            precision: PRECISION,
            formula: Some(Box::new(formula)),
            solved: OnceCell::new(),
        })
    }

    /// Sets the precision of the entries, relative to the largest one.
    pub fn with_precision(self, precision: f64) -> Self {
        DisplacementElement { precision, ..self }
    }

    /// True if it is one of a body of revolution.
    pub fn is_ring(&self) -> bool {
        self.material.is_some_and(|material| material.kinematics == Kinematics::Axisymmetric)
    }

    /// True if it has a formula, so that it can be examined on other shapes.
    pub fn has_formula(&self) -> bool {
        self.formula.is_some()
    }

    /// The element with its matrix alone, without a formula.
    pub(super) fn matrix_only(&self) -> Self {
        DisplacementElement {
            name: self.name.clone(),
            nodes: self.nodes.clone(),
            outline: self.outline.clone(),
            material: self.material,
            matrix: self.matrix.clone(),
            precision: self.precision,
            formula: None,
            solved: OnceCell::new(),
        }
    }

    /// Elements with matrices of the formula on two shapes without symmetry, of another size and place; none without formula or material,
    /// or where the formula fails.
    pub(super) fn elsewhere(&self) -> Vec<Self> {
        let (Ok(layout), Ok(material), Ok(_)) = (self.layout(), self.material(), self.formula()) else {
            return Vec::new();
        };
        let corners = self.outline.corners.len();
        let on = |corners: Vec<[f64; 2]>| {
            let nodes = nodes_on(&layout, &corners);
            let k = self.stiffness(&nodes, &material).ok()?;
            let there = Self::of_matrix(&self.name, &k, nodes, Order::Interleaved, Some(material)).ok()?;
            Some(there.with_precision(self.precision))
        };
        [shapes::irregular(corners), shapes::lopsided(corners)].into_iter().filter_map(on).collect()
    }

    /// True if K is symmetric and right for rigid motions and constant strains; without a material, for the one that K shows.
    pub(super) fn is_consistent(&self) -> bool {
        let is_symmetric = (&self.matrix - self.matrix.transpose()).amax() <= self.precision * self.size();
        is_symmetric
            && patch::is_exact(self)
            && (&self.matrix * motions(&self.nodes)).amax() <= self.precision * self.size()
    }

    /// The material.
    ///
    /// # Errors
    /// It is not known.
    pub(super) fn material(&self) -> Result<Material, Fault> {
        self.material.ok_or_else(|| Fault::NotMade("no material is given; say E and ν".into()))
    }

    /// The formula for other nodes and materials.
    ///
    /// # Errors
    /// There is one matrix only.
    pub(super) fn formula(&self) -> Result<&Formula, Fault> {
        let text = "one matrix says nothing about other shapes, materials and meshes; give the formula, from Python";
        self.formula.as_deref().ok_or_else(|| Fault::NotMade(text.into()))
    }

    /// K at other nodes, in another material.
    ///
    /// # Errors
    /// There is no formula, or it gives no matrix.
    pub(super) fn stiffness(&self, nodes: &[[f64; 2]], material: &Material) -> Result<DMatrix<f64>, Fault> {
        (self.formula()?)(nodes, material)
            .and_then(|k| ordered(&k, nodes.len(), Order::Interleaved))
            .map_err(|e| Fault::Failed(format!("the formula gives no matrix for nodes {nodes:?}: {e}")))
    }

    /// The weights of the corners in the nodes, which carry the nodes to other shapes.
    ///
    /// # Errors
    /// It is neither a triangle nor a quadrilateral.
    pub(super) fn layout(&self) -> Result<DMatrix<f64>, Fault> {
        let text = || Fault::NotMade(format!("it has {} corners, not three or four", self.outline.corners.len()));
        self.outline.weights(&self.nodes).ok_or_else(text)
    }

    /// Scale of the products of K with vectors of length one, to tell which are zero: the largest entry of K.
    pub(super) fn size(&self) -> f64 {
        self.matrix.amax().max(f64::MIN_POSITIVE)
    }
}

/// The largest of a figure of K over shapes, the name of the shape where it is, and how many shapes enclose an area.
///
/// # Errors
/// There is no formula, or it fails.
pub(super) fn largest(
    e: &DisplacementElement,
    shapes: impl Iterator<Item = Shape>,
    figure: impl Fn(&DMatrix<f64>, &[[f64; 2]], &Outline, &Material) -> f64,
) -> Result<(f64, String, usize), Fault> {
    e.formula()?;
    let (layout, material) = (e.layout()?, e.material()?);
    let (mut value, mut worst, mut count) = (0.0_f64, String::new(), 0);
    for shape in shapes {
        let nodes = nodes_on(&layout, &shape.corners);
        let Some(outline) = Outline::of(&nodes) else { continue };
        let own = figure(&e.stiffness(&nodes, &material)?, &nodes, &outline, &material);
        if own > value || worst.is_empty() {
            worst = shape.name;
        }
        value = value.max(own);
        count += 1;
    }
    Ok((value, worst, count))
}

/// Nodes that lie as `layout` says between these corners.
pub(super) fn nodes_on(layout: &DMatrix<f64>, corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let at = |n: usize, c: usize| corners.iter().enumerate().map(|(k, p)| layout[(n, k)] * p[c]).sum();
    (0..layout.nrows()).map(|n| [at(n, 0), at(n, 1)]).collect()
}

fn outline_of(nodes: &[[f64; 2]]) -> Result<Outline, String> {
    if nodes.len() < 3 || nodes.len() > 100 {
        return Err(format!("{} nodes: an element in the plane has from 3 to 100", nodes.len()));
    }
    if let Some(n) = nodes.iter().position(|x| !x.iter().all(|x| x.is_finite() && x.abs() < 1e50)) {
        return Err(format!("node {n} is {:?}: coordinates are finite numbers", nodes[n]));
    }
    for i in 0..nodes.len() {
        if let Some(j) = nodes[..i].iter().position(|x| x == &nodes[i]) {
            return Err(format!("nodes {j} and {i} are in the same place, {:?}", nodes[i]));
        }
    }
    Outline::of(nodes).ok_or_else(|| {
        "the nodes lie on one line to six digits and enclose no area that could be told from none".into()
    })
}

/// Refuses nodes beyond the axis of a body of revolution.
fn beside_axis(nodes: &[[f64; 2]], material: Option<Material>) -> Result<(), String> {
    if material.is_none_or(|material| material.kinematics != Kinematics::Axisymmetric) {
        return Ok(());
    }
    match nodes.iter().position(|x| x[0] < 0.0) {
        Some(n) => Err(format!("node {n} has r = {}: a body of revolution lies at r ≥ 0", nodes[n][0])),
        None => Ok(()),
    }
}

/// The matrix with two rows a node.
fn ordered(matrix: &DMatrix<f64>, nodes: usize, order: Order) -> Result<DMatrix<f64>, String> {
    let (rows, columns) = matrix.shape();
    if rows != 2 * nodes || columns != 2 * nodes {
        return Err(format!("K is {rows} × {columns}, but {nodes} nodes have {0} × {0} entries", 2 * nodes));
    }
    if let Some(at) = matrix.iter().position(|x| !x.is_finite() || x.abs() > 1e150) {
        return Err(format!("entry ({}, {}) of K is {}", at % rows, at / rows, matrix[at]));
    }
    if matrix.amax() < 1e-150 {
        return Err("every entry of K is zero".into());
    }
    let place = |i: usize| order.place(nodes, i / 2, i % 2);
    Ok(DMatrix::from_fn(rows, columns, |i, j| matrix[(place(i), place(j))]))
}
