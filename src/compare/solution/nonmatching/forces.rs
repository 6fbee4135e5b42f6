//! Contact conditions on the nodes of a file, and the forces that keep them.

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::compare::candidate::Candidate;
use crate::compare::solution::Solution;
use crate::sets::DisjointSets;
use crate::statics::cone::balanced;
use crate::vector::dot;

/// A contact condition on the nodes of a file.
pub struct Row {
    /// The direction of contact with the weight of every node, those of the second side negative.
    pub terms: Vec<(usize, [f64; 2])>,
    pub gap: f64,
    /// Distance on which its force does work in addition to the gap: the penetration, if the contact law is not a condition on the jump.
    pub overlap: f64,
}

impl Row {
    /// (v' − v'')·n̂ − g.
    pub fn excess(&self, candidate: &Candidate) -> f64 {
        self.terms.iter().map(|(node, d)| dot(*d, candidate.value(*node))).sum::<f64>() - self.gap
    }

    /// 2 · `self` − ½ (`a` + `b`): the middle Bernstein coefficient of a jump with the value `self` in the middle.
    pub fn bernstein(self, [a, b]: [&Row; 2]) -> Row {
        let mut terms: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (row, factor) in [(&self, 2.0), (a, -0.5), (b, -0.5)] {
            for (node, d) in &row.terms {
                let sum = terms.entry(*node).or_default();
                *sum = [sum[0] + factor * d[0], sum[1] + factor * d[1]];
            }
        }
        Row { terms: terms.into_iter().collect(), gap: 2.0 * self.gap - 0.5 * (a.gap + b.gap), overlap: 0.0 }
    }
}

/// Rows that share nodes, as indices.
pub fn groups(rows: &[&Row], nodes: usize) -> Vec<Vec<usize>> {
    let mut sets = DisjointSets::new(nodes);
    for row in rows {
        for (node, _) in &row.terms {
            sets.join(row.terms[0].0, *node);
        }
    }
    let (label, _) = sets.labels();
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| !row.terms.is_empty()) {
        groups.entry(label[row.terms[0].0]).or_default().push(index);
    }
    groups.into_values().collect()
}

/// Removes from the nodal forces of `solution` the part that forces ≥ 0 on `rows` can balance; returns their work on the gaps, and
/// their sum. Where forces of closed rows do, no other has one: several rows may stand for one nodal force.
pub fn take(rows: &[&Row], solution: &mut Solution<'_>) -> [f64; 2] {
    let open = -solution.sticks_below();
    let closed: Vec<&Row> = rows.iter().copied().filter(|row| row.excess(solution.candidate) >= open).collect();
    let mut nodes: Vec<usize> = rows.iter().flat_map(|row| row.terms.iter().map(|(node, _)| *node)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    let enough = solution.allowed() * solution.scale;
    let of_closed = (closed.len() < rows.len()).then(|| balance(&closed, &nodes, solution)).flatten();
    let found = of_closed.filter(|found| found.left <= enough).or_else(|| balance(rows, &nodes, solution));
    // Where the working set does not settle, the whole force is left over and the check fails in the open.
    let Some(found) = found else { return [0.0; 2] };
    found.rest.into_iter().for_each(|(node, rest)| solution.rest[node] = rest);
    found.works
}

/// What forces ≥ 0 on some rows leave of the nodal forces.
struct Balanced {
    /// The rest at each of the nodes.
    rest: Vec<(usize, [f64; 2])>,
    /// Its size, as a residual is weighed.
    left: f64,
    /// The work of the forces on the gaps, and their sum.
    works: [f64; 2],
}

/// The forces on `rows` that leave least of the forces of `solution` at `nodes`, in order.
fn balance(rows: &[&Row], nodes: &[usize], solution: &Solution<'_>) -> Option<Balanced> {
    // Forces are weighed as the residual is.
    let root = |node: usize| solution.forces.stiffness[node].max(f64::MIN_POSITIVE).sqrt();
    let mut units = Vec::new();
    let mut works = Vec::new();
    for row in rows {
        let mut unit = DVector::<f64>::zeros(2 * nodes.len());
        for (node, d) in &row.terms {
            let Ok(place) = nodes.binary_search(node) else { continue };
            let d = solution.hold(*node).project(*d);
            (0..2).for_each(|c| unit[2 * place + c] += d[c] / root(*node));
        }
        let length = unit.norm();
        if length > f64::MIN_POSITIVE {
            units.push(unit / length);
            works.push([(row.gap + row.overlap) / length, 1.0 / length]);
        }
    }
    let load = nodes.iter().flat_map(|node| solution.rest[*node].map(|x| -x / root(*node)));
    let load = DVector::from_iterator(2 * nodes.len(), load);
    let (rest, forces) = balanced(&load, &units).ok()?;
    let at = |(place, node): (usize, &usize)| (*node, [0, 1].map(|c| rest[2 * place + c] * root(*node)));
    Some(Balanced {
        rest: nodes.iter().enumerate().map(at).collect(),
        left: rest.norm(),
        works: forces.into_iter().fold([0.0; 2], |sum, (row, force)| [0, 1].map(|i| sum[i] + force * works[row][i])),
    })
}
