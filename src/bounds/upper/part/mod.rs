//! The part of the upper bound that one of several ranks makes.
//!
//! Relaxing moves one patch after the other, and [`super::relaxation::fronts`] tells which of them may be moved at the same time. So ranks that
//! move their own patches front by front, and hand on what these moved before the next one, make the displacement of one process:
//! its values differ only where a sum over all triangles, which here is one of sums, decides about them.
//!
//! A rank has the triangles whose energy it counts, all triangles of its patches, and those at contact: what contact asks of
//! values at vertices goes from pair to pair along it, and every rank does that by itself, alike.

mod cut;
mod division;
mod file;
mod numbers;
#[cfg(test)]
mod tests;
mod traffic;

pub use self::division::Division;
use self::traffic::Traffic;
use super::admissible::holds::Holds;
use super::admissible::nodes::Nodes;
use super::admissible::rows::rows;
use super::energy::interior;
use super::energy::model::Model;
use super::prepared::Made;
use super::relaxation::fronts::Fronts;
use super::relaxation::groups::Group;
use super::relaxation::patches::Patches;
use super::relaxation::share::Share;
use super::{Groundwork, NoUpperBound, Pull, Sliding, relaxed, restricted};
use crate::bounds::ranks::Ranks;
use crate::bounds::rounding::counted::Counted;
use crate::bounds::rounding::sum::Sum;
use crate::bounds::rounding::terms::{LowerTerms, UpperTerms};
use crate::element::{SideValues, StressField};
use crate::problem::Problem;

/// Data of a problem and its dual solution that a rank needs.
#[derive(Debug, Clone)]
pub struct Part {
    /// The problem on the triangles that are there.
    problem: Problem,
    /// λ_h and the moments of its displacement.
    stress: StressField,
    moments: SideValues<[f64; 2]>,
    /// Nodal supports of the whole problem: a straight side may go on beyond the part.
    holds: Holds,
    /// Corners of the triangle whose stiffness each one has.
    like: Vec<[[f64; 2]; 3]>,
    /// The patches of this rank, and which of them each front has.
    groups: Vec<Group>,
    fronts: Vec<Vec<usize>>,
    /// Unknowns of a patch of the whole problem relative to quadratics.
    size: f64,
    /// Triangles and pairs that are counted here.
    own_triangles: Vec<bool>,
    own_pairs: Vec<bool>,
    /// Nodes whose values are the result of this rank.
    own_nodes: Vec<usize>,
    /// Values sent between ranks after each front, and those of all nodes.
    after: Vec<Traffic>,
    all: Traffic,
}

/// Results of a rank.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Found {
    /// Values of its nodes, as relaxing leaves them.
    pub values: Vec<[f64; 2]>,
    /// Coefficients inside its triangles, one triangle after the other.
    pub inside: Vec<[f64; 2]>,
    /// Its terms of the lower bound and of the energy of the displacement, as [`LowerTerms`] and [`UpperTerms`] number them.
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// The terms of the gap on its triangles and on its contact pairs.
    pub triangles: Vec<f64>,
    pub pairs: Vec<f64>,
}

impl Part {
    /// Makes this rank's part of the displacement, and of both sides of the bracket. Relaxing ends near `floor`, a lower bound of
    /// the energy: that of all ranks where none is given.
    ///
    /// # Errors
    /// [`NoUpperBound`], on all ranks alike.
    pub fn bracket(&self, floor: Option<f64>, ranks: &dyn Ranks) -> Result<Found, NoUpperBound> {
        let Part { problem, holds, stress, moments, own_triangles, own_pairs, .. } = self;
        let counted = Counted::of(own_triangles, own_pairs);
        let lower = LowerTerms::new(problem, stress, moments, counted).numbers();
        let floor = floor.unwrap_or_else(|| {
            let all = ranks.gather(&lower);
            LowerTerms::sum(all.iter().map(Vec::as_slice)).complementary.lower()
        });
        let nodes = Nodes::new(problem.mesh.points.len(), moments.iter().map(<[_]>::len));
        let rows = rows(problem, &nodes);
        let model = Model::shaped(problem, holds, &nodes, &rows, Pull::SCENE, |t| self.like[t]);
        let fronts = Some(Fronts::given(self.fronts.clone()));
        let mut patches = Patches::of(&nodes, self.size, self.groups.clone(), fronts);
        // Before the first sweep, in which ranks wait for each other.
        patches.factorise(&model);
        let own_rows = own_pairs.iter().zip(&rows).flat_map(|(own, rows)| rows.iter().map(|_| *own)).collect();
        let share = OfPart { part: self, own_rows, ranks };
        let made = Made { model, patches };
        let mut ground = Groundwork { nodes, holds: holds.clone(), rows, made };
        let field = relaxed(&mut ground, problem, (stress, moments), floor, None, &share)?;
        let values = self.own_nodes.iter().map(|node| field.values[*node]).collect();
        let field = restricted(problem, (holds, &ground.rows, &Sliding::default()), field, &share)?.0;
        let filled = interior::fill(problem, &field, &ground.made.model);
        let own = (0..filled.len()).filter(|t| own_triangles[*t]);
        let inside = own.flat_map(|t| &filled.block(t)[3 * filled.degree(t)..]).copied().collect();
        let terms = UpperTerms::new(problem, stress, &filled, counted);
        let upper = terms.numbers();
        let [triangles, pairs] = [(terms.triangles, own_triangles), (terms.pairs, own_pairs)].map(|(terms, own)| {
            let own = terms.into_iter().zip(own).filter(|(_, own)| **own);
            own.map(|(term, _)| term).collect()
        });
        Ok(Found { values, inside, lower: lower.into(), upper: upper.into(), triangles, pairs })
    }
}

/// The share that a part is.
struct OfPart<'a> {
    part: &'a Part,
    own_rows: Vec<bool>,
    ranks: &'a dyn Ranks,
}

impl OfPart<'_> {
    fn folded(&self, own: f64, fold: impl Fn(f64, f64) -> f64) -> f64 {
        self.ranks.gather(&[own]).iter().flatten().copied().fold(own, fold)
    }
}

impl Share for OfPart<'_> {
    fn has_triangle(&self, t: usize) -> bool {
        self.part.own_triangles[t]
    }

    fn has_row(&self, row: usize) -> bool {
        self.own_rows[row]
    }

    fn hand_on(&self, front: usize, values: &mut [[f64; 2]]) {
        self.part.after[front].pass(self.ranks, values);
    }

    fn refresh(&self, values: &mut [[f64; 2]]) {
        self.part.all.pass(self.ranks, values);
    }

    fn sum(&self, own: &mut [f64]) {
        let all = self.ranks.gather(own);
        for (i, own) in own.iter_mut().enumerate() {
            *own = all.iter().filter_map(|of_rank| of_rank.get(i).copied()).collect::<Sum>().value();
        }
    }

    fn largest(&self, own: f64) -> f64 {
        self.folded(own, f64::max)
    }

    fn least(&self, own: f64) -> f64 {
        self.folded(own, f64::min)
    }
}
