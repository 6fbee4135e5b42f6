//! One mesh of an adaptive run: refined, made able to express the contact pressure, solved.

use super::trend::Way;
use super::warm_start::{carried, closed_coefficients};
use crate::dual::{DualMethod, Options, Size, contact_coefficients};
use crate::element::{Elements, MAX_DEGREE};
use crate::mesh::refinement::bisect::RefinementEdges;
use crate::problem::{Note, Problem, Refinement};
use crate::study::certified::{Balanced, Certified, StudyError, admit, carrying_loads, solve_balanced};
use crate::study::curves::divide_evenly_what_slides;

/// Solves and brackets `problem`, on a mesh that is divided at the ends of contact where the loads press on less than its
/// own edges there can express. Edges and gaps that stand for a curve stay as they are.
///
/// # Errors
/// [`StudyError`].
pub fn certify_divided(problem: Problem, method: &dyn DualMethod, options: &Options) -> Result<Certified, StudyError> {
    let (problem, options) = carrying_loads(problem, options)?;
    let options = &options;
    admit(&problem, method, options)?;
    let balanced = Balanced::new(&problem, &options.elements, None)?;
    if !balanced.statics.is_beyond_mesh() {
        return solve_balanced(problem, balanced, method, options, None);
    }
    let (given, refinement) = (problem.mesh.triangles.len(), problem.refinement);
    let edges = RefinementEdges::longest(&problem.mesh);
    let kept = Problem { refinement: Refinement::KeepsEdges, ..problem };
    let (Stage { mut problem, elements, .. }, statics) =
        Stage::new(kept, edges, options.elements.clone()).expressible(balanced)?;
    let options = Options { elements, ..options.clone() };
    problem.refinement = refinement;
    problem.notes.push(Note {
        weakens_guarantee: false,
        text: format!(
            "the loads press on so little of a contact that edges of the mesh as given cannot express it: the mesh was \
             divided at the ends of contact, from {given} to {} triangles",
            problem.mesh.triangles.len()
        ),
    });
    solve_balanced(problem, statics, method, &options, None)
}

/// Bisections of the ends of contact before giving up on a load that presses on less than the last edges can express.
const MOST_AT_ENDS: usize = 60;

/// In so many of them edges are divided along which the direction of contact turns, too.
const MOST_WHERE_IT_TURNS: usize = 6;

/// A mesh to solve on.
pub struct Stage {
    pub problem: Problem,
    pub refinement: RefinementEdges,
    /// For each triangle, the one of the mesh solved last that it lies in.
    pub parent: Vec<usize>,
    /// The element of each triangle.
    pub elements: Elements,
    /// The way to refine each triangle if its term is large.
    pub ways: Vec<Way>,
}

/// A mesh that was solved, with all but the problem of its stage.
pub struct Solved {
    pub certified: Certified,
    pub refinement: RefinementEdges,
    pub parent: Vec<usize>,
    pub elements: Elements,
    pub ways: Vec<Way>,
}

impl Stage {
    /// The first mesh.
    pub fn new(problem: Problem, refinement: RefinementEdges, elements: Elements) -> Self {
        let count = problem.mesh.triangles.len();
        Stage { parent: (0..count).collect(), problem, refinement, elements, ways: vec![Way::Bisect; count] }
    }

    /// How large it is.
    pub fn size(&self) -> Size {
        Size::of_degrees(&self.problem, &self.elements)
    }

    /// True if triangle `t` is to have a higher degree, and may have one.
    pub fn rises(&self, t: usize) -> bool {
        self.ways[t] == Way::Raise && self.elements.degree(t) < MAX_DEGREE
    }

    /// With the marked triangles bisected, and the triangle of this stage that each one lies in.
    pub fn bisect(&self, marked: &[usize]) -> Result<(Stage, Vec<usize>), StudyError> {
        let (problem, refinement, within) = self.problem.bisect(&self.refinement, marked)?;
        let parent = within.iter().map(|&t| self.parent[t]).collect();
        let elements = self.elements.within(&within);
        let ways = within.iter().map(|&t| self.ways[t]).collect();
        Ok((Stage { problem, refinement, parent, elements, ways }, within))
    }

    /// Solves, on a mesh bisected at the ends of contact where the load asks for it, from what was found `before`.
    pub fn solved(
        self,
        method: &dyn DualMethod,
        options: &Options,
        before: Option<&Certified>,
    ) -> Result<Solved, StudyError> {
        let balanced = Balanced::new(&self.problem, &self.elements, before.map(|solved| &solved.statics))?;
        let (stage, statics) = self.expressible(balanced)?;
        let mut options = Options { elements: stage.elements.clone(), ..options.clone() };
        let mut start = None;
        if let Some(Certified { problem, dual, bracket, .. }) = before {
            let counts = contact_coefficients(&stage.problem, &stage.elements);
            options.closed = Some(closed_coefficients(problem, &dual.closed, &stage.problem, &counts));
            // What is wrong with a displacement of a coarser mesh is smooth, and no relaxing takes it away; for linear stresses
            // the fit is worse, of higher degree it is better.
            let linear = stage.elements.largest_degree() == 1;
            let free = bracket.free.as_ref().ok().filter(|_| linear);
            start = free.map(|free| carried(problem, &free.displacement, &stage.problem, &stage.parent));
        }
        let certified = solve_balanced(stage.problem, statics, method, &options, start)?;
        let Stage { refinement, parent, elements, ways, .. } = stage;
        Ok(Solved { certified, refinement, parent, elements, ways })
    }

    /// Bisects the ends of contact until the mesh can express the pressure that balances the loads, as `balanced` tells for this
    /// one.
    fn expressible(mut self, mut balanced: Balanced) -> Result<(Stage, Balanced), StudyError> {
        for round in 0..MOST_AT_ENDS {
            divide_evenly_what_slides(&mut self.problem, &balanced.statics);
            if !balanced.statics.is_beyond_mesh() {
                break;
            }
            self = self.bisect(&contact_ends(&self.problem, round < MOST_WHERE_IT_TURNS))?.0;
            let finer = Balanced::new(&self.problem, &self.elements, Some(&balanced.statics))?;
            balanced = Balanced { seconds: balanced.seconds + finer.seconds, ..finer };
        }
        Ok((self, balanced))
    }
}

/// The triangles at the first and last edge of every stretch of contact without a corner, and `turning` those at edges
/// along which the direction of contact turns: the outermost direction acts at one end of such an edge alone.
fn contact_ends(problem: &Problem, turning: bool) -> Vec<usize> {
    let mut marked = Vec::new();
    for interface in &problem.interfaces {
        let pairs = &interface.pairs;
        for (k, pair) in pairs.iter().enumerate() {
            let straight_on = |other: Option<usize>| {
                other.and_then(|o| pairs.get(o)).is_some_and(|o| {
                    [[0, 1], [1, 0]].into_iter().any(|[mine, its]| {
                        let (n, m) = (pair.direction.ends[mine], o.direction.ends[its]);
                        pair.first[mine] == o.first[its] && (n[0] - m[0]).hypot(n[1] - m[1]) < 1e-9
                    })
                })
            };
            let turns = turning && !pair.direction.is_constant();
            if !turns && straight_on(k.checked_sub(1)) && straight_on(Some(k + 1)) {
                continue;
            }
            marked.extend(pair.edges.iter().flatten().filter_map(|&e| problem.mesh.edges[e].triangles[0]));
        }
    }
    marked.sort_unstable();
    marked.dedup();
    marked
}
