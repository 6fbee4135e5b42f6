//! The patches of triangles that relaxing moves one after the other, and what is kept of them.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::fronts::Fronts;
use super::groups::{Group, groups};
use super::patch::{Factors, Move, Patch, add};
use super::share::Share;
use crate::bounds::upper::admissible::nodes::Nodes;
use crate::bounds::upper::energy::model::Model;
use crate::problem::Problem;
use crate::process::stop_if_unwanted;

/// Patches with more unknowns than this for quadratics, at vertices with scores of triangles, are left as they are.
const MOST_IN_PATCH: usize = 300;

/// Numbers of kept factors for each vertex at most, for quadratics: where patches are larger on average, some factors are
/// computed anew in every sweep.
const KEPT_BY_VERTEX: usize = 512;

/// As many patches for quadratics are moved before another thread has begun …
const SHARED_FROM: f64 = 24.0;
/// … and no fewer than this of any degree.
const LEAST_SHARED: usize = 4;

/// No more than so many threads share them: a front has scores of patches, and each thread's memory grows with the mesh.
const MOST_SHARING: usize = 8;

/// How many unknowns a patch has, relative to quadratics.
pub fn size(nodes: &Nodes) -> f64 {
    let of_quadratics = nodes.vertices() + nodes.edges();
    nodes.count() as f64 / of_quadratics.max(1) as f64
}

/// Data of a mesh for relaxation, whatever the loads.
pub struct Patches {
    groups: Vec<Group>,
    factors: Factors,
    /// Gain of each patch when it was moved last.
    gained: Vec<f64>,
    /// Memory for the patch at hand, for each thread that shares them.
    patches: Vec<Mutex<Patch>>,
    /// Patches that threads move at the same time, where there is more than one thread.
    fronts: Option<Fronts>,
    /// So many of them are moved by the same thread.
    together: usize,
}

impl Patches {
    /// Groups the vertices of a mesh; factors are computed when they are needed first, or by [`Self::factorise`].
    pub fn new(problem: &Problem, nodes: &Nodes) -> Self {
        let (groups, of_vertex) = grouped(problem, nodes);
        let fronts = (rayon::current_num_threads() > 1).then(|| Fronts::new(problem, &groups, &of_vertex));
        Self::of(nodes, size(nodes), groups, fronts)
    }

    /// Those of given groups, `size` being that of a patch relative to quadratics; with `fronts` they can be moved front by front.
    pub fn of(nodes: &Nodes, size: f64, groups: Vec<Group>, fronts: Option<Fronts>) -> Self {
        let patch = || Mutex::new(Patch::new(nodes.count(), (MOST_IN_PATCH as f64 * size) as usize));
        let threads = rayon::current_num_threads();
        Patches {
            factors: Factors::new(groups.len(), (KEPT_BY_VERTEX as f64 * size * size) as usize * nodes.vertices()),
            gained: vec![0.0; groups.len()],
            patches: (0..threads.min(MOST_SHARING)).map(|_| patch()).collect(),
            fronts,
            together: ((SHARED_FROM / (size * size)) as usize).max(LEAST_SHARED),
            groups,
        }
    }

    /// Makes the factors of all patches, on this thread alone: one that waits in what goes on beside would take half of them,
    /// and be missed there.
    pub fn factorise(&mut self, model: &Model) {
        let Patches { groups, factors, patches, .. } = self;
        let Some(patch) = patches.first_mut() else { return };
        let patch = patch.get_mut().unwrap_or_else(PoisonError::into_inner);
        groups.iter().enumerate().for_each(|(k, group)| patch.prepare(model, group, k, factors));
    }

    /// How many they are.
    pub fn count(&self) -> usize {
        self.groups.len()
    }

    /// Moves all patches, or those of `which` in order, from the first one on or from the last one `back`, each to its minimum, and
    /// gives the energy gained. Threads and processes share them: not a digit of the values is another.
    pub fn sweep(
        &mut self,
        model: &Model,
        which: Option<&[usize]>,
        back: bool,
        slack: f64,
        values: &mut [[f64; 2]],
        share: &dyn Share,
    ) -> f64 {
        stop_if_unwanted();
        let all: Vec<usize>;
        let which_of_all = match which {
            Some(which) => which,
            None => {
                all = (0..self.count()).collect();
                &all
            }
        };
        if let Some(fronts) = self.fronts.take() {
            let mut moves = vec![which.is_none(); self.count()];
            which.iter().copied().flatten().for_each(|k| moves[*k] = true);
            let mut along = |(number, front): (usize, &[usize])| {
                let front: Vec<usize> = front.iter().copied().filter(|k| moves[*k]).collect();
                self.move_front(model, &front, slack, values);
                share.hand_on(number, values);
            };
            if back {
                fronts.iter().enumerate().rev().for_each(&mut along)
            } else {
                fronts.iter().enumerate().for_each(&mut along)
            }
            self.fronts = Some(fronts);
        } else if back {
            self.move_each(model, which_of_all.iter().rev().copied(), slack, values);
        } else {
            self.move_each(model, which_of_all.iter().copied(), slack, values);
        }
        // In the order of one patch after the other.
        let gains = which_of_all.iter().map(|k| self.gained[*k]);
        share.total(if back { gains.rev().sum() } else { gains.sum() })
    }

    /// Moves patches, one after the other.
    fn move_each(&mut self, model: &Model, which: impl Iterator<Item = usize>, slack: f64, values: &mut [[f64; 2]]) {
        let Patches { groups, factors, gained, patches, .. } = self;
        let Some(patch) = patches.first_mut() else { return };
        let patch = patch.get_mut().unwrap_or_else(PoisonError::into_inner);
        for k in which {
            let step = patch.step(model, &groups[k], k, factors, slack, values);
            gained[k] = step.as_ref().map_or(0.0, |step| step.gain);
            step.iter().flat_map(|step| patch.moves(step)).for_each(|(node, by)| add(&mut values[node], by));
        }
    }

    /// Moves patches that do not touch each other.
    fn move_front(&mut self, model: &Model, front: &[usize], slack: f64, values: &mut [[f64; 2]]) {
        if front.len() < 2 * self.together {
            self.move_each(model, front.iter().copied(), slack, values);
            return;
        }
        let Patches { groups, factors, patches, together, .. } = &*self;
        let found: Vec<(f64, Vec<Move>)> = {
            let values = &*values;
            let of = |&k: &usize| {
                let own = rayon::current_thread_index().unwrap_or(0) % patches.len();
                let mut patch = patches[own].lock().unwrap_or_else(PoisonError::into_inner);
                let step = patch.step(model, &groups[k], k, factors, slack, values);
                step.map_or((0.0, Vec::new()), |step| (step.gain, patch.moves(&step).collect()))
            };
            front.par_iter().with_min_len(*together).map(of).collect()
        };
        for (k, (gain, moves)) in front.iter().zip(found) {
            self.gained[*k] = gain;
            moves.into_iter().for_each(|(node, by)| add(&mut values[node], by));
        }
    }

    /// The patches that gained more than `quiet` when they were moved last, and those beside them, in order.
    pub fn to_move(&self, problem: &Problem, model: &Model, quiet: f64, share: &dyn Share) -> Vec<usize> {
        // The gain of the patch of each vertex, where other processes move it too.
        let mut gains = vec![[0.0; 2]; model.free.len()];
        for (group, gained) in self.groups.iter().zip(&self.gained) {
            group.vertices.iter().for_each(|v| gains[*v] = [*gained, 0.0]);
        }
        share.refresh(&mut gains);
        let gains = |t: &usize| problem.mesh.triangles[*t].iter().any(|v| gains[*v][0] > quiet);
        (0..self.count()).filter(|k| self.groups[*k].triangles.iter().any(gains)).collect()
    }

    /// As [`Self::to_move`], with the patches that contact bounds.
    pub fn to_move_or_bounded(&self, problem: &Problem, model: &Model, quiet: f64, share: &dyn Share) -> Vec<usize> {
        let bounded = |k: &usize| self.groups[*k].vertices.iter().any(|v| !model.rows_at[*v].is_empty());
        let mut few = self.to_move(problem, model, quiet, share);
        few.extend((0..self.count()).filter(bounded));
        few.sort_unstable();
        few.dedup();
        few
    }
}

/// The vertices of a mesh in groups, and the group of each; of one that is in none, the first.
pub fn grouped(problem: &Problem, nodes: &Nodes) -> (Vec<Group>, Vec<usize>) {
    let groups = groups(problem, nodes.highest());
    let mut of_vertex = vec![0; nodes.vertices()];
    for (number, group) in groups.iter().enumerate() {
        group.vertices.iter().for_each(|v| of_vertex[*v] = number);
    }
    (groups, of_vertex)
}

#[cfg(test)]
pub(in crate::bounds::upper) mod tests {
    use super::*;
    use crate::bounds::upper::admissible::holds::holds;
    use crate::bounds::upper::admissible::nodes::NodalValues;
    use crate::bounds::upper::admissible::rows::rows;
    use crate::bounds::upper::energy::pull::Pull;
    use crate::bounds::upper::relaxation::share::Whole;
    use crate::scene::Scene;

    /// Two blocks with these corners, pressed together where a gap, in m at its ends, lets them.
    pub fn two_blocks(size: f64, [lower, upper]: [[[f64; 2]; 4]; 2], gap: [[f64; 2]; 2]) -> String {
        format!(
            r#"
            [model]
            kinematics = "plane-strain"
            [geometry]
            size = {size:?}
            [[geometry.polygons]]
            body = "a"
            points = {lower:?}
            edges = ["foot", "", "over", ""]
            [[geometry.polygons]]
            body = "b"
            points = {upper:?}
            edges = ["under", "", "top", "axis"]
            [bodies.a]
            young = 1.0
            poisson = 0.3
            [bodies.b]
            young = 2.0
            poisson = 0.45
            body_force = [0.2, -1.0]
            [[supports]]
            on = "foot"
            type = "clamped"
            [[supports]]
            on = "axis"
            type = "roller"
            [[contacts]]
            between = ["over", "under"]
            gap = {gap:?}
            "#
        )
    }

    fn problem() -> Problem {
        let lower = [[0.0, 0.0], [1.3, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let upper = [[0.0, 1.0], [1.0, 1.0], [1.0, 1.5], [0.0, 1.5]];
        let scene = two_blocks(0.03, [lower, upper], [[0.0, 0.0], [1.0, 0.1]]);
        Problem::load(Scene::parse(&scene, "blocks.toml".as_ref()).expect("a scene")).expect("a problem")
    }

    fn in_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
        rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("threads").install(work)
    }

    #[test]
    fn threads_move_patches_to_the_last_digit_as_one_after_the_other() {
        let problem = problem();
        let nodes = Nodes::new(problem.mesh.points.len(), problem.mesh.edges.iter().map(|_| 3));
        let rows = rows(&problem, &nodes);
        let held = holds(&problem).expect("supports agree");
        let model = Model::new(&problem, &held, &nodes, &rows, Pull::SCENE);
        let mut start = NodalValues::zeros(nodes.clone());
        for (n, (value, hold)) in start.values.iter_mut().zip(held.of_nodes(&nodes)).enumerate() {
            *value = hold.impose([1e-2 * (n as f64).sin(), 1e-2 * (3.0 * n as f64).cos()]);
        }
        let relaxed = |alone: bool| {
            let mut patches = Patches { together: LEAST_SHARED, ..Patches::new(&problem, &nodes) };
            assert!(patches.fronts.iter().flat_map(Fronts::iter).any(|front| front.len() >= 2 * patches.together));
            patches.fronts = patches.fronts.take().filter(|_| !alone);
            let mut values = start.values.clone();
            let gains: Vec<f64> =
                [false, true, false].map(|back| patches.sweep(&model, None, back, 1e-12, &mut values, &Whole)).into();
            (gains, values)
        };
        let (alone, shared) = in_threads(|| (relaxed(true), relaxed(false)));
        assert!(alone.0[0] > 0.0);
        assert_eq!(alone, shared);
    }

    /// By what patches read and move, node by node.
    #[test]
    fn patches_of_a_front_do_not_touch_and_neighbours_keep_their_order() {
        let problem = problem();
        let nodes = Nodes::new(problem.mesh.points.len(), problem.mesh.edges.iter().map(|_| 3));
        let rows = rows(&problem, &nodes);
        let model = Model::new(&problem, &holds(&problem).expect("supports agree"), &nodes, &rows, Pull::SCENE);
        let patches = in_threads(|| Patches::new(&problem, &nodes));
        let mut front = vec![usize::MAX; patches.count()];
        for (number, of) in patches.fronts.as_ref().expect("threads").iter().enumerate() {
            of.iter().for_each(|k| front[*k] = number);
        }
        let mut movers = vec![Vec::new(); nodes.count()];
        for (k, group) in patches.groups.iter().enumerate() {
            let on_triangles = group.triangles.iter().flat_map(|t| model.nodes(*t));
            let mut moved: Vec<usize> = on_triangles.copied().filter(|node| model.moves(*node, group)).collect();
            moved.sort_unstable();
            moved.dedup();
            moved.into_iter().for_each(|node| movers[node].push(k));
        }
        for (k, group) in patches.groups.iter().enumerate() {
            let of_contact = group.vertices.iter().flat_map(|v| &model.rows_at[*v]);
            let of_contact = of_contact.flat_map(|row| model.rows[*row].terms()).map(|(node, _)| *node);
            let read = group.triangles.iter().flat_map(|t| model.nodes(*t)).copied().chain(of_contact);
            for &j in read.flat_map(|node| &movers[node]).filter(|j| **j != k) {
                assert_eq!(front[k].cmp(&front[j]), k.cmp(&j), "patches {k} and {j}");
            }
        }
    }
}
