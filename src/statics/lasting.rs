//! The part of a verdict that a finer mesh does not change: how the loads rest on supports and contacts that have not changed.
//!
//! A mesh only says how close to the ends of contact its pressures can act. Everything else follows from where straight
//! contacts begin and end, from supports and from the sums of the loads.

use nalgebra::DVector;

use super::restraint::{Group, Part};
use crate::vector::long::largest;

/// Numbers that differ by less, relative to the largest of their kind, are those of the same scene: sums over other triangles
/// round differently. The threshold of a balanced load is a hundred times larger.
const SAME: f64 = 1e-12;

/// A verdict without what depends on the mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lasting {
    pub question: Question,
    /// The motions allowed both ways.
    pub held: Vec<DVector<f64>>,
    /// The borderline motion.
    pub one_way: Option<DVector<f64>>,
}

impl Lasting {
    /// True if it is also the verdict on `question`.
    pub fn answers(&self, question: &Question) -> bool {
        let own = &self.question;
        let alike = |a: &[f64], b: &[f64], size: f64| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * size)
        };
        own.names == question.names
            && alike(&own.directions, &question.directions, 1.0)
            && alike(&own.lengths, &question.lengths, largest(&own.lengths))
            && alike(&own.load, &question.load, own.total)
    }
}

/// The data that determine a verdict.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Question {
    /// Members, sides of runs and whether their direction turns, and the members that rows of rollers belong to.
    names: Vec<usize>,
    directions: Vec<f64>,
    /// Ends of runs, centres and sizes of members.
    lengths: Vec<f64>,
    load: Vec<f64>,
    /// The sum of all loads.
    total: f64,
}

impl Question {
    pub fn new(group: &Group, rollers: &[Part], load: &DVector<f64>, total: f64) -> Self {
        let (mut names, mut directions, mut lengths) = (group.members.clone(), Vec::new(), Vec::new());
        for run in &group.runs {
            names.extend([run.interface, usize::from(run.turning.is_some())]);
            names.extend(run.sides.map(|side| side.map_or(0, |c| c + 1)));
            directions.extend(run.normal);
            directions.extend(run.turning.iter().flatten().flatten());
            lengths.extend(run.ends.as_flattened());
        }
        for (m, row) in rollers {
            names.push(*m);
            directions.extend(row.iter());
        }
        for c in &group.members {
            lengths.extend(group.components.centre[*c]);
            lengths.push(group.components.size[*c]);
        }
        Question { names, directions, lengths, load: load.as_slice().to_vec(), total }
    }
}
