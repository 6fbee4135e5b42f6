//! A problem divided among ranks, and the displacement of what they find.

use std::collections::BTreeMap;

use super::cut::{Cut, place};
use super::traffic::Traffic;
use super::{Found, Part};
use crate::bounds::UpperBound;
use crate::bounds::rounding::terms::{LowerTerms, UpperTerms};
use crate::bounds::upper::admissible::holds::{Holds, holds};
use crate::bounds::upper::admissible::nodes::{NodalValues, Nodes};
use crate::bounds::upper::admissible::rows::rows;
use crate::bounds::upper::energy::energies::similar;
use crate::bounds::upper::energy::interior;
use crate::bounds::upper::relaxation::fronts::Fronts;
use crate::bounds::upper::relaxation::groups::Group;
use crate::bounds::upper::relaxation::patches::{grouped, size};
use crate::bounds::upper::relaxation::share::Whole;
use crate::bounds::upper::{NoUpperBound, Sliding, restricted};
use crate::element::displacement::split_len;
use crate::element::{Displacement, SideValues, StressField, parts, starts};
use crate::problem::Problem;

/// Who makes what.
pub struct Division<'a> {
    problem: &'a Problem,
    /// The rank that counts the energy of each triangle.
    owner: &'a [usize],
    nodes: Nodes,
    holds: Holds,
    groups: Vec<Group>,
    /// The rank and the front of each group. One without triangles moves nothing, and is nobody's.
    of_group: Vec<Option<(usize, usize)>>,
    of_vertex: Vec<usize>,
    fronts: usize,
    /// The first triangle of the shape of each.
    like: Vec<usize>,
    /// Triangles at contact.
    at_contact: Vec<bool>,
    /// Nodes whose values go from one rank to another after a front, and those that a rank gives to another when all are to be up to
    /// date.
    after: BTreeMap<(usize, usize, usize), Vec<usize>>,
    all: BTreeMap<(usize, usize), Vec<usize>>,
}

impl<'a> Division<'a> {
    /// For the displacement of a dual solution with these moments; `owner` has a rank below `ranks` for each triangle.
    ///
    /// # Errors
    /// [`NoUpperBound::SupportsDisagree`].
    pub fn new(
        problem: &'a Problem,
        moments: &SideValues<[f64; 2]>,
        owner: &'a [usize],
        ranks: usize,
    ) -> Result<Self, NoUpperBound> {
        let mesh = &problem.mesh;
        let nodes = Nodes::new(mesh.points.len(), moments.iter().map(<[_]>::len));
        let (groups, of_vertex) = grouped(problem, &nodes);
        let fronts = Fronts::new(problem, &groups, &of_vertex);
        let mut of_group = vec![None; groups.len()];
        for (front, groups_of_front) in fronts.iter().enumerate() {
            for k in groups_of_front {
                of_group[*k] = groups[*k].triangles.first().map(|t| (owner[*t], front));
            }
        }
        let (class, first) = similar(problem, &nodes);
        let mut at_contact = vec![false; mesh.triangles.len()];
        for e in problem.pairs().flat_map(|pair| pair.edges).flatten() {
            mesh.edges[e].triangles.iter().flatten().for_each(|t| at_contact[*t] = true);
        }
        let mut division = Division {
            problem,
            owner,
            holds: holds(problem)?,
            fronts: fronts.iter().len(),
            like: class.iter().map(|class| first[*class as usize]).collect(),
            nodes,
            groups,
            of_group,
            of_vertex,
            at_contact,
            after: BTreeMap::new(),
            all: BTreeMap::new(),
        };
        division.find_traffic(ranks);
        Ok(division)
    }

    /// The ranks that count or move something on triangle `t`; some of them several times.
    fn near(&self, t: usize) -> [usize; 4] {
        let own = self.owner[t];
        let [a, b, c] = self.problem.mesh.triangles[t].map(|v| self.rank_of(v).unwrap_or(own));
        [own, a, b, c]
    }

    /// The rank that a vertex belongs to.
    fn rank_of(&self, v: usize) -> Option<usize> {
        self.of_group[self.of_vertex[v]].map(|(rank, _)| rank)
    }

    /// The rank that counts each contact pair.
    fn ranks_of_pairs(&self) -> impl Iterator<Item = Option<usize>> {
        self.problem.pairs().map(|pair| self.rank_of(pair.first[0]))
    }

    /// The nodes in order, each with the rank that its value is the result of: that of its vertex, or of the first one of its edge.
    fn owned_nodes(&self) -> impl Iterator<Item = (usize, Option<usize>)> {
        let edges = self.problem.mesh.edges.iter().enumerate();
        let inside = edges.flat_map(|(e, edge)| self.nodes.inside(e).map(move |node| (node, edge.vertices[0])));
        let all = (0..self.nodes.vertices()).map(|v| (v, v)).chain(inside);
        all.map(|(node, v)| (node, self.rank_of(v)))
    }

    /// Works out which values go where.
    fn find_traffic(&mut self, ranks: usize) {
        let mesh = &self.problem.mesh;
        // The ranks of each node where there are several: most nodes have one.
        let mut one: Vec<Option<usize>> = vec![None; self.nodes.count()];
        let mut several: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut note = |node: usize, rank: usize| match one[node] {
            None => one[node] = Some(rank),
            Some(first) if first == rank => {}
            Some(first) => {
                let of_node = several.entry(node).or_insert_with(|| vec![first]);
                if !of_node.contains(&rank) {
                    of_node.push(rank);
                }
            }
        };
        for t in 0..mesh.triangles.len() {
            let near = self.near(t);
            self.nodes.of_triangle(mesh, t).for_each(|node| near.into_iter().for_each(|rank| note(node, rank)));
        }
        let mut after = BTreeMap::<_, Vec<usize>>::new();
        for (group, of_group) in self.groups.iter().zip(&self.of_group) {
            let Some((rank, front)) = *of_group else { continue };
            for t in &group.triangles {
                let edges = mesh.triangle_edges[*t].into_iter();
                let moves = |v: &usize| group.vertices.contains(v);
                let inside =
                    edges.filter(|e| mesh.edges[*e].vertices.iter().any(moves)).flat_map(|e| self.nodes.inside(e));
                for node in mesh.triangles[*t].into_iter().filter(moves).chain(inside) {
                    for other in several.get(&node).into_iter().flatten().filter(|other| **other != rank) {
                        after.entry((front, rank, *other)).or_default().push(node);
                    }
                }
            }
        }
        let mut everywhere = vec![false; self.nodes.count()];
        for t in (0..mesh.triangles.len()).filter(|t| self.at_contact[*t]) {
            self.nodes.of_triangle(mesh, t).for_each(|node| everywhere[node] = true);
        }
        let mut all = BTreeMap::<_, Vec<usize>>::new();
        for (node, rank) in self.owned_nodes().filter_map(|(node, rank)| Some((node, rank?))) {
            let mut give = |other: usize| all.entry((rank, other)).or_default().push(node);
            if everywhere[node] {
                (0..ranks).filter(|other| *other != rank).for_each(&mut give);
            } else if let Some(of_node) = several.get(&node) {
                of_node.iter().copied().filter(|other| *other != rank).for_each(&mut give);
            }
        }
        for nodes in after.values_mut() {
            nodes.sort_unstable();
            nodes.dedup();
        }
        (self.after, self.all) = (after, all);
    }

    /// The part of the problem that rank `rank` needs.
    pub fn part(&self, rank: usize, stress: &StressField, moments: &SideValues<[f64; 2]>) -> Part {
        let there = |t: &usize| self.at_contact[*t] || self.near(*t).contains(&rank);
        let cut = Cut::new(self.problem, &self.nodes, (0..self.owner.len()).filter(there).collect());
        let (mut groups, mut fronts) = (Vec::new(), vec![Vec::new(); self.fronts]);
        for (group, of_group) in self.groups.iter().zip(&self.of_group) {
            if let Some((_, front)) = of_group.filter(|(owner, _)| *owner == rank) {
                fronts[front].push(groups.len());
                groups.push(cut.group(group));
            }
        }
        let here = |nodes: &[usize]| nodes.iter().map(|node| place(&cut.nodes, *node)).collect();
        let mut after = vec![Traffic::default(); self.fronts];
        for ((front, from, to), nodes) in &self.after {
            if *from == rank {
                after[*front].to.push((*to, here(nodes)));
            } else if *to == rank {
                after[*front].from.push((*from, here(nodes)));
            }
        }
        let mut all = Traffic::default();
        for ((from, to), nodes) in &self.all {
            if *from == rank {
                all.to.push((*to, here(nodes)));
            } else if *to == rank {
                all.from.push((*from, here(nodes)));
            }
        }
        Part {
            problem: cut.problem(self.problem),
            stress: cut.stress(stress),
            moments: cut.moments(moments),
            holds: cut.holds(&self.holds),
            like: cut.triangles.iter().map(|t| self.problem.mesh.corners(self.like[*t])).collect(),
            groups,
            fronts,
            size: size(&self.nodes),
            own_triangles: cut.triangles.iter().map(|t| self.owner[*t] == rank).collect(),
            own_pairs: self.ranks_of_pairs().map(|of_pair| of_pair == Some(rank)).collect(),
            own_nodes: here(&self.nodes_of(rank)),
            after,
            all,
        }
    }

    /// The nodes whose values are the result of a rank.
    fn nodes_of(&self, rank: usize) -> Vec<usize> {
        self.owned_nodes().filter(|(_, owner)| *owner == Some(rank)).map(|(node, _)| node).collect()
    }

    /// The displacement of what the ranks found, one after the other, and both sides of the bracket; `None` where that is not what
    /// belongs there.
    ///
    /// # Errors
    /// [`NoUpperBound::ForcedPenetration`].
    pub fn bracket(&self, found: &[Found]) -> Result<Option<(LowerTerms, UpperBound)>, NoUpperBound> {
        let Some(displacement) = self.displacement(found)? else { return Ok(None) };
        let triangles = gathered(found.iter().map(|found| &found.triangles), self.owner.iter().map(|rank| Some(*rank)));
        let pairs = gathered(found.iter().map(|found| &found.pairs), self.ranks_of_pairs());
        let lower = LowerTerms::sum(found.iter().map(|found| &found.lower[..]));
        let Some((triangles, pairs)) = triangles.zip(pairs) else { return Ok(None) };
        let upper = UpperTerms::sum(found.iter().map(|found| &found.upper[..]), triangles, pairs);
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        let whole = finite(&lower.numbers()) && finite(&upper.numbers());
        Ok(whole.then(|| (lower, UpperBound::of_terms(self.problem, displacement, upper))))
    }

    /// The displacement. Whatever the numbers are, it is admissible: on contact and supports they are drawn to what these allow, as
    /// the ranks do with the same values.
    fn displacement(&self, found: &[Found]) -> Result<Option<Displacement>, NoUpperBound> {
        let mesh = &self.problem.mesh;
        let degree = |t: usize| self.nodes.triangle_degree(mesh, t);
        let inner = |t: usize| split_len(degree(t)) - 3 * degree(t);
        let start = starts((0..mesh.triangles.len()).map(inner));
        let mut inside = vec![[0.0; 2]; start[mesh.triangles.len()]];
        let mut blocks = parts(&mut inside, &start);
        let mut field = NodalValues::zeros(self.nodes.clone());
        for (rank, found) in found.iter().enumerate() {
            let nodes = self.nodes_of(rank);
            let own = || (0..mesh.triangles.len()).filter(|t| self.owner[*t] == rank);
            let is_finite = found.values.iter().chain(&found.inside).flatten().all(|x| x.is_finite());
            if !is_finite || found.values.len() != nodes.len() || found.inside.len() != own().map(inner).sum::<usize>()
            {
                return Ok(None);
            }
            nodes.iter().zip(&found.values).for_each(|(node, value)| field.values[*node] = *value);
            let mut rest = &found.inside[..];
            for t in own() {
                let (block, behind) = rest.split_at(inner(t));
                blocks[t].copy_from_slice(block);
                rest = behind;
            }
        }
        let field = restricted(
            self.problem,
            (&self.holds, &rows(self.problem, &self.nodes), &Sliding::default()),
            field,
            &Whole,
        )?
        .0;
        Ok(Some(interior::filled_with(self.problem, &field, |t| &inside[start[t]..start[t + 1]])))
    }
}

/// The terms that the ranks have, each its own in order, in the order of what `owners` says the ranks of; `None` where these are
/// not as many, or not finite.
fn gathered<'a>(
    found: impl Iterator<Item = &'a Vec<f64>>,
    owners: impl Iterator<Item = Option<usize>>,
) -> Option<Vec<f64>> {
    let mut own: Vec<_> = found.map(|terms| terms.iter()).collect();
    let all: Option<Vec<f64>> = owners.map(|rank| own.get_mut(rank?)?.next().copied()).collect();
    all.filter(|all| own.iter().all(|left| left.len() == 0) && all.iter().all(|term| term.is_finite()))
}
