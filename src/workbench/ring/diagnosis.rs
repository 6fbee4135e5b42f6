//! Which mistake explains the matrix of a ring.
//!
//! The integrand is no polynomial, so that there are several right matrices, one for each rule. A mistake is made with every rule, and
//! explains K where one of them gives it but for rounding; the simplest one is named.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix4};

use crate::report::text::number::{percent, significant};
use crate::scene::Kinematics;
use crate::workbench::diagnosis::Diagnosis;
use crate::workbench::displacement::DisplacementElement;
use crate::workbench::formulas::ring::{Points, Radius, Way, made, one_point, rules};
use crate::workbench::formulas::{Family, Variant, placed};
use crate::workbench::material::Material;

/// Of |K|², what an explanation may leave beside the rounding of K.
const LEFT: f64 = 1e-16;
/// A factor this close to one is none.
const SAME: f64 = 1e-6;

/// Mistakes in the radii: stable name, sentence, and the way.
const WAYS: [(&str, &str, Way); 6] = [
    ("hoop-left-out", "the hoop strain u_r/r is left out", Way { hoop: Radius::LeftOut, weight: Radius::AtPoint }),
    (
        "hoop-radius",
        "the hoop strain is u_r over the radius of the middle, and not over that of the point",
        Way { hoop: Radius::InTheMiddle, weight: Radius::AtPoint },
    ),
    (
        "hoop-radius",
        "the hoop strain is the sum of N u_r over the radii of the nodes, and not of the point",
        Way { hoop: Radius::AtNodes, weight: Radius::AtPoint },
    ),
    (
        "weight-radius",
        "the weight is 2π times the radius of the middle, and not of the point",
        Way { hoop: Radius::AtPoint, weight: Radius::InTheMiddle },
    ),
    (
        "middle-radius",
        "hoop strain and weight have the radius of the middle, and not of the point",
        Way { hoop: Radius::InTheMiddle, weight: Radius::InTheMiddle },
    ),
    ("radius-left-out", "the weight 2πr is without r", Way { hoop: Radius::AtPoint, weight: Radius::LeftOut }),
];

/// The right matrices of the nodes of an element.
pub struct Right {
    /// The family.
    pub family: Family,
    /// Node i of the family is node `order[i]` of the element.
    order: Vec<usize>,
    nodes: Vec<[f64; 2]>,
    hooke: Matrix4<f64>,
    rules: Vec<Points>,
}

impl Right {
    /// Those of an element whose material is known.
    ///
    /// # Errors
    /// Why there are none.
    pub fn of(e: &DisplacementElement) -> Result<Self, String> {
        let none = || format!("no element of the textbooks has {} nodes that lie like these", e.nodes.len());
        let (family, order) = Family::of(&e.outline, &e.nodes).ok_or_else(none)?;
        let material = e.material.ok_or("no material is given; say E and ν")?;
        let nodes = order.iter().map(|&n| e.nodes[n]).collect();
        Ok(Right { family, order, nodes, hooke: material.hooke_of_rings(), rules: rules(family) })
    }

    /// K by a rule and a way, numbered as the element is; `None` where there is none on these nodes.
    fn made(&self, hooke: &Matrix4<f64>, points: &Points, way: Way) -> Option<DMatrix<f64>> {
        Some(placed(&made(self.family, &self.nodes, hooke, points, way).ok()?, &self.order))
    }

    /// How far a matrix is from the nearest right one, relative to its largest entry, and what that is called.
    pub fn nearest(&self, k: &DMatrix<f64>) -> (f64, String) {
        let of = |points: &Points| {
            let own = self.made(&self.hooke, points, Way::RIGHT)?;
            Some(((k - &own).amax() / own.amax(), self.words(points)))
        };
        let all = self.rules.iter().filter_map(of);
        all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, self.family.words().to_string()))
    }

    fn words(&self, points: &Points) -> String {
        let plural = if points.count == 1 { "point" } else { "points" };
        format!("{} by {} {plural}", self.family.words(), points.count)
    }
}

/// A mistake after it was made.
struct Trial {
    /// The simpler the smaller.
    rank: usize,
    cause: &'static str,
    sentence: String,
    matrix: DMatrix<f64>,
}

/// Explains why K is that of no right ring; `None` where it is one, or where none is known.
pub fn diagnose(e: &DisplacementElement) -> Option<Diagnosis> {
    let right = Right::of(e).ok()?;
    let (apart, _) = right.nearest(&e.matrix);
    if apart <= e.precision {
        return None;
    }
    let all = trials(e, &right);
    let size = e.matrix.norm_squared();
    // What the digits of K leave is explained by nothing.
    let enough = LEFT.max((e.precision * e.matrix.amax()).powi(2) * e.matrix.len() as f64 / size);
    let left = |t: &Trial| (&e.matrix - &t.matrix).norm_squared() / size;
    let found = all.iter().filter(|t| left(t) <= enough).min_by_key(|t| t.rank);
    if let Some(trial) = found {
        let sentence = format!("The difference is explained: {}.", trial.sentence);
        return Some(Diagnosis { cause: trial.cause.into(), explained: 1.0 - left(trial), sentence });
    }
    let sentence = format!(
        "None of {} mistakes explains the difference from every right ring, {} of the largest entry.",
        all.len(),
        percent(apart)
    );
    Some(Diagnosis { cause: "unexplained".into(), explained: 0.0, sentence })
}

/// All mistakes by all rules, also with a factor.
fn trials(e: &DisplacementElement, right: &Right) -> Vec<Trial> {
    let mut all = Vec::new();
    let mut push = |rank, cause, sentence: String, matrix: Option<DMatrix<f64>>| {
        all.extend(matrix.map(|matrix| Trial { rank, cause, sentence, matrix }));
    };
    let slice = e.material.map(|m| Material { kinematics: Kinematics::PlaneStrain, ..m }.hooke());
    let slice = slice.and_then(|d| right.family.stiffness(&right.nodes, &d, 1.0, Variant::Right).ok());
    let text = "K is that of a slice of unit thickness in plane strain";
    push(2, "plane-strain", text.into(), slice.map(|k| placed(&k, &right.order)));
    if right.family.corners() == 4 {
        let own = right.made(&right.hooke, &one_point(right.family), Way::RIGHT);
        let text = "there is one quadrature point, in the middle";
        push(3, "one-point", format!("{text}, and 2π is left out"), own.as_ref().map(|k| k / TAU));
        push(2, "one-point", text.into(), own);
    }
    for points in &right.rules {
        let own = right.made(&right.hooke, points, Way::RIGHT);
        push(0, "sign", "K has the wrong sign".into(), own.as_ref().map(|k| -k));
        let text = "K is that of one radian: 2π is left out".to_string();
        push(1, "per-radian", text, own.as_ref().map(|k| k / TAU));
        for (cause, words, way) in WAYS {
            let k = right.made(&right.hooke, points, way);
            push(3, cause, format!("{words}, and 2π is left out"), k.as_ref().map(|k| k / TAU));
            push(2, cause, words.to_string(), k);
        }
        let text =
            "the hoop stress is without the others: the law is one without ν between hoop and section".to_string();
        push(3, "hoop-law", text, right.made(&uncoupled(&right.hooke), points, Way::RIGHT));
        let shear = |times: f64| {
            let mut d = right.hooke;
            d[(3, 3)] *= times;
            right.made(&d, points, Way::RIGHT)
        };
        for (times, words) in
            [(2.0, "shear counts twice"), (0.5, "shear counts half"), (4.0, "shear counts four times")]
        {
            push(2, "shear", format!("{words}: γ_rz = 2 ε_rz and ε_rz are mixed up"), shear(times));
        }
        let Some(own) = own else { continue };
        let count = own.nrows() / 2;
        let blocked = |i: usize| if i < count { 2 * i } else { 2 * (i - count) + 1 };
        let text = "unknowns are numbered r of all nodes first, then z of all nodes: say --order blocked";
        push(1, "unknowns", text.into(), Some(permuted(&own, blocked)));
        push(1, "unknowns", "the unknowns of a node are z first, then r".into(), Some(permuted(&own, |i| i ^ 1)));
        let factor = e.matrix.dot(&own) / own.norm_squared();
        if (factor - 1.0).abs() > SAME {
            let text = format!("K is {} times that of the {}", significant(factor, 6), right.words(points));
            push(4, "factor", text, Some(own * factor));
        }
    }
    all
}

/// K with unknown `from(i)` in the place of unknown i.
fn permuted(k: &DMatrix<f64>, from: impl Fn(usize) -> usize) -> DMatrix<f64> {
    DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| k[(from(i), from(j))])
}

/// Hooke's law without what couples the hoop with the section.
fn uncoupled(d: &Matrix4<f64>) -> Matrix4<f64> {
    Matrix4::from_fn(|i, j| if (i == 2) != (j == 2) { 0.0 } else { d[(i, j)] })
}
