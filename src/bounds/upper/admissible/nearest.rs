//! The displacement of least energy under any pull with homogeneous supports and jumps at most given bounds: z of an adjoint
//! pair, near to the stress that pulls at it.
//!
//! It is built as the free upper bound is: fit, edge moments, bounds by coefficients, relaxation over patches, inside last.

use std::cell::RefCell;

use super::fit::Added;
use super::nodes::{NodalValues, Nodes};
use super::rows::{Row, rows};
use super::{edges, fit};
use crate::bounds::upper::energy::interior;
use crate::bounds::upper::energy::model::Model;
use crate::bounds::upper::prepared::{Made, Prepared};
use crate::bounds::upper::relaxation::patches::Patches;
use crate::bounds::upper::relaxation::share::Whole;
use crate::bounds::upper::{Holds, NoUpperBound, Pull, Sliding, Until, holds_at, relaxation, restricted};
use crate::element::revolved::Tensor;
use crate::element::{Displacement, SideValues, StressField};
use crate::problem::Problem;

/// Data that all displacements near stresses on one mesh share.
pub struct Nearest<'a> {
    problem: &'a Problem,
    holds: Holds,
    nodes: Nodes,
    rows: Vec<Vec<Row>>,
    /// Stiffness and factors, from the first displacement on.
    made: RefCell<Option<Box<Made>>>,
}

impl<'a> Nearest<'a> {
    /// For displacements of one degree more than edge moments `like` these; `prepared` is what the upper bound with such moments on
    /// this mesh has left.
    ///
    /// # Errors
    /// None: supports that hold nothing in place agree.
    pub fn new(problem: &'a Problem, like: &SideValues<[f64; 2]>, prepared: &Prepared) -> Result<Self, NoUpperBound> {
        let degree = |moments: &[[f64; 2]]| problem.section().displacement_degree(moments.len() - 1);
        let nodes = Nodes::new(problem.mesh.points.len(), like.iter().map(degree));
        let rows = rows(problem, &nodes);
        let holds = holds_at(problem, |_, _| [0.0; 2])?;
        let made = prepared.take().filter(|made| made.model.is_free_as(&holds, &nodes));
        Ok(Nearest { problem, holds, nodes, rows, made: RefCell::new(made) })
    }

    /// The number of coefficients that bound the jump on each pair, one interface after the other.
    pub fn counts(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().map(Vec::len)
    }

    /// The displacement that has edge moments `moments` and nearly the strain of `stress` with what is `added`, in values at nodes: what
    /// [`Self::to`] begins with.
    pub fn start(
        &self,
        stress: &StressField,
        moments: &SideValues<[f64; 2]>,
        added: &[(usize, Tensor)],
    ) -> NodalValues {
        let values = fit::vertex_values(self.problem, stress, moments, Added::Constant(added));
        let mut field = NodalValues::zeros(self.nodes.clone());
        field.vertices_mut().copy_from_slice(&values);
        for (value, hold) in field.vertices_mut().iter_mut().zip(&self.holds.vertices) {
            *value = hold.impose(*value);
        }
        for e in 0..self.problem.mesh.edges.len() {
            let ends = self.problem.mesh.edges[e].vertices.map(|v| field.values[v]);
            let own = &mut field.values[self.nodes.inside(e)];
            let length = self.problem.mesh.edge_frame(e).0;
            let inside = edges::inside_of(own.len() + 1, moments.of(e), length, ends);
            let held = self.holds.inside(e, own.len());
            for ((value, found), hold) in own.iter_mut().zip(inside).zip(held) {
                *value = hold.impose(found);
            }
        }
        field
    }

    /// The displacement of least energy under `pull` whose jumps (v' − v'')·n̂ have coefficients of at most `bounds` on every
    /// pair, and its values at nodes; it begins with `start`.
    ///
    /// # Errors
    /// [`NoUpperBound::ForcedPenetration`] where supports leave no room for the bounds.
    pub fn to(
        &self,
        pull: Pull<'_>,
        bounds: &[Vec<f64>],
        start: NodalValues,
        until: Until,
    ) -> Result<(Displacement, NodalValues), NoUpperBound> {
        let bounded = |(rows, bounds): (&Vec<Row>, &Vec<f64>)| {
            rows.iter().cloned().zip(bounds).map(|(row, bound)| row.bounded(*bound)).collect()
        };
        let rows: Vec<Vec<Row>> = self.rows.iter().zip(bounds).map(bounded).collect();
        let admissible = |field: NodalValues| {
            Ok(restricted(self.problem, (&self.holds, &rows, &Sliding::default()), field, &Whole)?.0)
        };
        let candidates = vec![admissible(start)?];
        let at_rest = || admissible(NodalValues::zeros(self.nodes.clone()));
        self.pulled(pull, &rows, |model, patches| {
            let relaxed = relaxation::relax(self.problem, model, patches, until, candidates, at_rest, &Whole)?;
            let relaxed = admissible(relaxed)?;
            Ok((interior::fill(self.problem, &relaxed, model), relaxed))
        })
    }

    /// Values at nodes as a displacement, the inside of triangles of least energy under `pull`.
    pub fn filled(&self, values: &NodalValues, pull: Pull<'_>) -> Displacement {
        self.pulled(pull, &self.rows, |model, _| interior::fill(self.problem, values, model))
    }

    /// The energy under `pull` of the displacement with these values at nodes, the inside of triangles of least energy.
    pub fn energy(&self, values: &NodalValues, pull: Pull<'_>) -> f64 {
        self.pulled(pull, &self.rows, |model, _| model.energy(&values.values, &Whole) + model.energy_at_rest())
    }

    /// Result of `ask` on the energy under `pull` with jumps bounded by `rows`.
    fn pulled<T>(&self, pull: Pull<'_>, rows: &[Vec<Row>], ask: impl FnOnce(&Model, &mut Patches) -> T) -> T {
        let mut made = self.made.borrow_mut();
        if let Some(made) = made.as_mut() {
            made.model.with(self.problem, &self.nodes, rows, pull);
        }
        let Made { model, patches } = &mut **made.get_or_insert_with(|| {
            let model = Model::new(self.problem, &self.holds, &self.nodes, rows, pull);
            Box::new(Made { model, patches: Patches::new(self.problem, &self.nodes) })
        });
        ask(model, patches)
    }
}
