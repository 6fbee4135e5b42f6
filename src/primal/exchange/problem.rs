//! The problem as the displacement model reads it.

use serde::Serialize;

use crate::element::polynomial::quadrature::even_rule;
use crate::load::{Affine, BodyForce};
use crate::mesh::Quadrilateral;
use crate::primal::HIGHEST_DEGREE;
use crate::problem::{Condition, ContactPair, Pin, Problem};

/// The content of [`super::PROBLEM_FILE`].
#[derive(Serialize)]
pub(super) struct ProblemFile<'a> {
    format: &'static str,
    version: u32,
    kinematics: &'static str,
    thickness: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    revolution: Option<RevolutionEntry>,
    bodies: Vec<BodyEntry<'a>>,
    points: &'a [[f64; 2]],
    triangles: &'a [[usize; 3]],
    body: &'a [usize],
    edges: Vec<[usize; 2]>,
    triangle_edges: &'a [[usize; 3]],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    quadrilaterals: Vec<QuadrilateralEntry>,
    clamped: Vec<ClampedEntry>,
    roller: Vec<RollerEntry>,
    tractions: Vec<TractionEntry>,
    contacts: Vec<ContactEntry<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    springs: Vec<SpringEntry>,
    pins: Vec<PinEntry>,
}

/// The first coordinate of the axis, and the rule for integrals over triangles: points in the triangle (0, 0), (1, 0), (0, 1), weights that sum
/// to one half.
#[derive(Serialize)]
struct RevolutionEntry {
    axis: f64,
    points: Vec<[f64; 2]>,
    weights: Vec<f64>,
}

impl RevolutionEntry {
    fn new(problem: &Problem) -> Option<Self> {
        let axis = problem.section().weight([0.0; 2]);
        let rule = problem.section().is_revolved().then(even_rule)?;
        Some(RevolutionEntry {
            axis: 0.0 - axis,
            points: rule.iter().map(|(l, _)| [l[1], l[2]]).collect(),
            weights: rule.iter().map(|(_, weight)| 0.5 * weight).collect(),
        })
    }
}

#[derive(Serialize)]
struct BodyEntry<'a> {
    name: &'a str,
    #[serde(flatten)]
    material: MaterialEntry,
    #[serde(skip_serializing_if = "Option::is_none")]
    initial_strain: Option<Vec<[f64; 3]>>,
    body_force: Force,
}

/// A constant, or value + gradient · x.
#[derive(Serialize)]
#[serde(untagged)]
enum Force {
    Constant([f64; 2]),
    Affine { value: [f64; 2], gradient: [[f64; 2]; 2] },
}

impl From<&BodyForce> for Force {
    fn from(force: &BodyForce) -> Self {
        let Affine { value, gradient } = force.as_affine();
        if force.is_constant() { Force::Constant(value) } else { Force::Affine { value, gradient } }
    }
}

/// An isotropic body by its constants, any other by its stiffness in the plane.
#[derive(Serialize)]
#[serde(untagged)]
enum MaterialEntry {
    Isotropic {
        young: f64,
        poisson: f64,
    },
    General {
        stiffness: [[f64; 3]; 3],
    },
    /// rr, zz, tt and 2 rz of a body of revolution.
    Revolved {
        stiffness: [[f64; 4]; 4],
    },
}

impl MaterialEntry {
    fn new(problem: &Problem, body: usize) -> Self {
        match problem.scene.bodies[body].elasticity.isotropic() {
            Some([young, poisson]) => MaterialEntry::Isotropic { young, poisson },
            None if problem.section().is_revolved() => {
                let law = problem.material(body).revolved();
                let unit = |i: usize| {
                    [0, 1, 2, 3].map(|j| {
                        if i != j {
                            0.0
                        } else if i < 3 {
                            1.0
                        } else {
                            0.5
                        }
                    })
                };
                let columns = [0, 1, 2, 3].map(|i| law.stress(unit(i)));
                let symmetric = |i: usize| [0, 1, 2, 3].map(|j| 0.5 * (columns[i][j] + columns[j][i]));
                MaterialEntry::Revolved { stiffness: [0, 1, 2, 3].map(symmetric) }
            }
            None => {
                let material = problem.material(body);
                let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]].map(|e| material.stress(e));
                let symmetric = |i: usize| [0, 1, 2].map(|j| 0.5 * (columns[i][j] + columns[j][i]));
                MaterialEntry::General { stiffness: [0, 1, 2].map(symmetric) }
            }
        }
    }
}

/// ε_xx, ε_yy and ε_xy of a body without stress, in a body of revolution ε_tt behind them, each by its value at the origin and its derivatives
/// along x and y.
fn initial_strain(problem: &Problem, body: usize) -> Option<Vec<[f64; 3]>> {
    let material = problem.material(body);
    let strain = material.initial();
    let row = |c: usize| [strain.value[c], strain.gradient[c][0], strain.gradient[c][1]];
    let hoop = [strain.hoop, strain.hoop_gradient[0], strain.hoop_gradient[1]];
    let turned = problem.section().is_revolved().then_some(hoop);
    (!strain.is_none()).then(|| (0..3).map(row).chain(turned).collect())
}

#[derive(Serialize)]
struct QuadrilateralEntry {
    corners: [usize; 4],
    triangles: [usize; 2],
}

#[derive(Serialize)]
struct ClampedEntry {
    edge: usize,
    displacement: Prescribed,
}

/// One value for both ends of an edge, or one value each.
#[derive(Serialize)]
#[serde(untagged)]
enum Prescribed {
    Constant([f64; 2]),
    Linear([[f64; 2]; 2]),
}

#[derive(Serialize)]
struct RollerEntry {
    edge: usize,
    normal: [f64; 2],
    displacement: f64,
}

#[derive(Serialize)]
struct TractionEntry {
    edge: usize,
    values: [[f64; 2]; 2],
}

/// An edge on springs, or on a side of an elastic layer.
#[derive(Serialize)]
struct SpringEntry {
    edge: usize,
    opposite: Option<usize>,
    axes: [[f64; 2]; 2],
    stiffness: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    gap: Option<Vec<f64>>,
}

#[derive(Serialize)]
struct ContactEntry<'a> {
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    coefficient: Option<f64>,
    pairs: Vec<PairEntry>,
}

#[derive(Serialize)]
struct PairEntry {
    edges: [Option<usize>; 2],
    first: [usize; 2],
    second: Option<[usize; 2]>,
    normal: [f64; 2],
    direction: [[f64; 2]; 2],
    gap: [f64; 2],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    gap_below: Vec<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: Option<FrictionEntry>,
}

/// The friction of a pair.
#[derive(Serialize)]
struct FrictionEntry {
    bound: [f64; 2],
    tangent: [[f64; 2]; 2],
    length: f64,
}

impl FrictionEntry {
    /// Of contacts with Coulomb friction every pair has one.
    fn new(problem: &Problem, index: usize, pair: &ContactPair) -> Option<Self> {
        let none = || problem.coefficient(index).map(|_| problem.without_resistance(pair));
        let friction = pair.friction.or_else(none)?;
        Some(FrictionEntry { bound: friction.bound, tangent: friction.tangent.ends, length: pair.length })
    }
}

#[derive(Serialize)]
struct PinEntry {
    vertex: usize,
    direction: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    degree: Option<u8>,
}

impl<'a> ProblemFile<'a> {
    /// Of a problem whose rigid motions these pins hold.
    pub(super) fn new(problem: &'a Problem, pins: &[Pin]) -> Self {
        let (scene, mesh) = (&problem.scene, &problem.mesh);
        let (mut clamped, mut roller, mut tractions) = (Vec::new(), Vec::new(), Vec::new());
        for (edge, condition) in problem.conditions.iter().enumerate() {
            match *condition {
                Condition::Clamped(ends) => {
                    let displacement =
                        if ends[0] == ends[1] { Prescribed::Constant(ends[0]) } else { Prescribed::Linear(ends) };
                    clamped.push(ClampedEntry { edge, displacement });
                }
                Condition::Roller { direction, displacement } => {
                    roller.push(RollerEntry { edge, normal: direction, displacement });
                }
                Condition::Traction(values) if values != [[0.0; 2]; 2] => {
                    tractions.push(TractionEntry { edge, values })
                }
                Condition::Axis => roller.push(RollerEntry { edge, normal: [-1.0, 0.0], displacement: 0.0 }),
                Condition::Traction(_)
                | Condition::Interior
                | Condition::Contact { .. }
                | Condition::Elastic { .. } => {}
            }
        }
        ProblemFile {
            format: "hypercircle-exchange",
            version: 1,
            kinematics: scene.kinematics.name(),
            thickness: scene.thickness,
            revolution: RevolutionEntry::new(problem),
            bodies: scene
                .bodies
                .iter()
                .enumerate()
                .map(|(i, body)| BodyEntry {
                    name: &body.name,
                    material: MaterialEntry::new(problem, i),
                    initial_strain: initial_strain(problem, i),
                    body_force: Force::from(&body.body_force),
                })
                .collect(),
            points: &mesh.points,
            triangles: &mesh.triangles,
            body: &mesh.body,
            edges: mesh.edges.iter().map(|edge| edge.vertices).collect(),
            triangle_edges: &mesh.triangle_edges,
            quadrilaterals: mesh
                .quadrilaterals()
                .map(|Quadrilateral { corners, triangles, .. }| QuadrilateralEntry { corners, triangles })
                .collect(),
            clamped,
            roller,
            tractions,
            contacts: problem
                .interfaces
                .iter()
                .enumerate()
                .map(|(index, interface)| ContactEntry {
                    name: &interface.name,
                    coefficient: problem.coefficient(index),
                    pairs: interface
                        .pairs
                        .iter()
                        .map(|pair| PairEntry {
                            edges: pair.edges,
                            first: pair.first,
                            second: pair.second,
                            normal: pair.normal,
                            direction: pair.direction.ends,
                            gap: pair.gap,
                            gap_below: gap_below(pair),
                            friction: FrictionEntry::new(problem, index, pair),
                        })
                        .collect(),
                })
                .collect(),
            springs: problem
                .bed_pairs()
                .map(|(pair, stiffness)| SpringEntry {
                    edge: pair.edge,
                    opposite: pair.opposite,
                    axes: pair.axes,
                    stiffness,
                    gap: pair.contact.map(|contact| contact.gap()),
                })
                .collect(),
            pins: pins
                .iter()
                .map(|pin| PinEntry {
                    vertex: pin.vertex,
                    direction: pin.direction,
                    degree: pin.of_vertices.then_some(1),
                })
                .collect(),
        }
    }
}

/// Coefficients of degree 2, 3, … of polynomials that lie nowhere above a curved gap, the last of them the gap itself; none
/// of one that is linear.
fn gap_below(pair: &ContactPair) -> Vec<Vec<f64>> {
    let degrees = if pair.bow.is_none() { 0 } else { usize::from(HIGHEST_DEGREE) };
    (2..2 + degrees).map(|degree| pair.gap_below(degree)).collect()
}
