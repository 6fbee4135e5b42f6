//! Parts of the upper bound that can be made before the dual solution is known.

use super::admissible::holds::{Holds, holds};
use super::admissible::nodes::Nodes;
use super::admissible::rows::{Row, rows};
use super::energy::model::Model;
use super::prepared::Made;
use super::relaxation::patches::Patches;
use super::{NoUpperBound, Pull};
use crate::problem::Problem;

/// Supports, contact and stiffness for displacements on one mesh, each edge with a degree of its own.
///
/// It holds nothing of a solution, so that another thread can make it beside the dual solve.
pub struct Groundwork {
    pub(super) nodes: Nodes,
    pub(super) holds: Holds,
    pub(super) rows: Vec<Vec<Row>>,
    pub(super) made: Made,
}

impl Groundwork {
    /// For displacements that go with stresses whose degree on every edge is given.
    ///
    /// # Errors
    /// [`NoUpperBound::SupportsDisagree`].
    pub fn new(problem: &Problem, degrees: impl IntoIterator<Item = usize>) -> Result<Self, NoUpperBound> {
        let problem = &*problem.softened();
        let holds = holds(problem)?;
        let nodes = Nodes::new(
            problem.mesh.points.len(),
            degrees.into_iter().map(|p| problem.section().displacement_degree(p)),
        );
        let rows = rows(problem, &nodes);
        let model = Model::new(problem, &holds, &nodes, &rows, Pull::SCENE);
        let patches = Patches::new(problem, &nodes);
        Ok(Groundwork { nodes, holds, rows, made: Made { model, patches } })
    }

    /// As [`Self::new`], with the factors of all patches, which otherwise the first sweep makes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn factorised(problem: &Problem, degrees: impl IntoIterator<Item = usize>) -> Result<Self, NoUpperBound> {
        let mut ground = Self::new(problem, degrees)?;
        ground.made.patches.factorise(&ground.made.model);
        Ok(ground)
    }
}
