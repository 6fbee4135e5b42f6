//! The places where contact acts on the nodes of a displacement model: matched nodes and the direction between them.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};

use crate::bounds::{Hold, Holds};
use crate::problem::Problem;
use crate::sets::DisjointSets;
use crate::statics::cone::balanced;
use crate::vector::{cross, dot};

/// Directions whose cross product is smaller are parallel.
const PARALLEL: f64 = 1e-9;
/// Rows shorter than this after projection, by supports and other rows, are linearly dependent.
const SPENT: f64 = 1e-9;

/// Nodes that face each other, or one that faces a rigid obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Index into [`Problem::interfaces`].
    pub interface: usize,
    /// Node of the first side: vertices, then the midpoint of every edge.
    pub first: usize,
    /// Node of the second side.
    pub second: Option<usize>,
    /// Direction of contact, out of the first side.
    pub normal: [f64; 2],
    /// Gap there.
    pub gap: f64,
    /// ∫φ ds of the node's shape function along the contact, ∫φ r ds of a body of revolution.
    pub weight: f64,
    /// A second direction at a midpoint, if the direction turns along the edge.
    turned: Option<[f64; 2]>,
    /// t̂, if friction resists sliding.
    pub tangent: Option<[f64; 2]>,
}

impl Site {
    /// (v' − v'')·n̂ − g: a penetration if positive, an opening if negative.
    pub fn excess(&self, value: impl Fn(usize) -> [f64; 2]) -> f64 {
        self.jump(self.normal, value) - self.gap
    }

    /// (v' − v'')·t̂, zero without friction.
    pub fn slip(&self, value: impl Fn(usize) -> [f64; 2]) -> f64 {
        self.tangent.map_or(0.0, |t| self.jump(t, value))
    }

    /// The component of v' − v'' along a direction.
    pub fn jump(&self, direction: [f64; 2], value: impl Fn(usize) -> [f64; 2]) -> f64 {
        dot(value(self.first), direction) - self.second.map_or(0.0, |s| dot(value(s), direction))
    }

    /// The nodes of both sides, each with its sign in the jump.
    fn nodes(&self) -> impl Iterator<Item = (usize, f64)> {
        [(Some(self.first), 1.0), (self.second, -1.0)].into_iter().filter_map(|(node, sign)| Some((node?, sign)))
    }
}

/// All places of contact, and those that belong to each edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Sites {
    /// The places, interface by interface.
    pub list: Vec<Site>,
    /// The places of every pair of edges with one direction.
    pub spans: Vec<Span>,
    /// The places of every pair of edges, also where the direction turns.
    pub edges: Vec<Span>,
    groups: Vec<Group>,
}

/// The places of one pair of edges, as indices into [`Sites::list`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// At its ends.
    pub ends: [usize; 2],
    /// At its midpoint, for nodes of degree 2.
    pub middle: Option<usize>,
    /// Its length.
    pub length: f64,
    /// Index into [`Problem::interfaces`].
    pub interface: usize,
    /// The pair of this interface.
    pub pair: usize,
}

/// Places that share nodes, with an orthonormal basis of the forces that contact can exert there.
#[derive(Debug, Clone, PartialEq)]
struct Group {
    nodes: Vec<usize>,
    sites: Vec<usize>,
    rows: DMatrix<f64>,
    tangents: Vec<Option<DVector<f64>>>,
    basis: Vec<DVector<f64>>,
}

impl Sites {
    /// The places of `problem` for nodes of the given degree; above degree 2, for nodes of degree 2.
    pub fn new(problem: &Problem, degree: usize, holds: &Holds) -> Self {
        let vertices = problem.mesh.points.len();
        let mut sites = Sites { list: Vec::new(), spans: Vec::new(), edges: Vec::new(), groups: Vec::new() };
        for (interface, contact) in problem.interfaces.iter().enumerate() {
            let mut known: BTreeMap<(usize, Option<usize>), Vec<usize>> = BTreeMap::new();
            for (number, pair) in contact.pairs.iter().enumerate() {
                let part = pair.length / if degree > 1 { 6.0 } else { 2.0 };
                // ∫ φ r ds of bodies of revolution.
                let [from, to] = pair.first.map(|v| problem.section().weight(problem.mesh.points[v]));
                let mean = 0.5 * (from + to);
                let at_end = |own: f64| if degree > 1 { own } else { (own + 2.0 * mean) / 3.0 };
                let mut at_ends = [0; 2];
                for (end, at) in at_ends.iter_mut().enumerate() {
                    let (first, second) = (pair.first[end], pair.second.map(|s| s[end]));
                    let weight = part * at_end([from, to][end]);
                    let normal = pair.direction.ends[end];
                    let tangent = pair.friction.map(|friction| friction.tangent.ends[end]);
                    let same = known.entry((first, second)).or_default();
                    let found = same.iter().copied().find(|s| cross(sites.list[*s].normal, normal).abs() < PARALLEL);
                    *at = found.unwrap_or(sites.list.len());
                    match found {
                        Some(s) => {
                            sites.list[s].weight += weight;
                            sites.list[s].tangent = sites.list[s].tangent.or(tangent);
                        }
                        None => {
                            same.push(sites.list.len());
                            let gap = pair.gap[end];
                            sites.list.push(Site {
                                interface,
                                first,
                                second,
                                normal,
                                gap,
                                weight,
                                turned: None,
                                tangent,
                            });
                        }
                    }
                }
                let middle = (degree > 1 && pair.edges[0].is_some()).then_some(sites.list.len());
                let turned = !pair.direction.is_constant();
                let span = Span { ends: at_ends, middle, length: pair.length, interface, pair: number };
                sites.edges.push(span);
                if !turned {
                    sites.spans.push(span);
                }
                let (2.., Some(own)) = (degree, pair.edges[0]) else { continue };
                let [n, m] = pair.direction.ends;
                let turned = turned.then(|| [m[0] - n[0], m[1] - n[1]]);
                sites.list.push(Site {
                    interface,
                    first: vertices + own,
                    second: pair.edges[1].map(|e| vertices + e),
                    normal: pair.direction.at(0.5),
                    gap: pair.gap_at(0.5),
                    weight: 4.0 * part * mean,
                    turned,
                    tangent: pair.friction.map(|friction| friction.tangent.at(0.5)),
                });
            }
        }
        sites.groups = groups(&sites.list, holds);
        sites
    }

    /// Removes from nodal forces all that contact along its direction can exert, pushing or pulling, open or closed.
    pub fn take(&self, forces: &mut [[f64; 2]]) {
        for group in &self.groups {
            let mut local = group.gather(forces);
            for row in &group.basis {
                let part = row.dot(&local);
                local.axpy(-part, row, 1.0);
            }
            for (i, node) in group.nodes.iter().enumerate() {
                forces[*node] = [local[2 * i], local[2 * i + 1]];
            }
        }
    }

    /// The force at each place that presses the two sides together, from the nodal forces that supports do not take.
    pub fn pressing(&self, forces: &[[f64; 2]]) -> Vec<f64> {
        self.acting(forces).0
    }

    /// The pressing forces as in [`Self::pressing`], and the friction forces on the first side along t̂.
    pub fn acting(&self, forces: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
        let (mut pressing, mut rubbing) = (vec![0.0; self.list.len()], vec![0.0; self.list.len()]);
        for group in &self.groups {
            let local = group.gather(forces);
            if let [site] = group.sites[..] {
                let row = group.rows.column(0);
                let square = row.norm_squared();
                pressing[site] = if square > SPENT * SPENT { -row.dot(&local) / square } else { 0.0 };
                if let Some(tangent) = group.tangents[0].as_ref().filter(|t| t.norm() > SPENT) {
                    // What a support leaves of both directions may be one.
                    let across = tangent.dot(&row) / tangent.norm_squared();
                    let left = if square > SPENT * SPENT {
                        1.0 - across * across * tangent.norm_squared() / square
                    } else {
                        1.0
                    };
                    if left > SPENT {
                        let own = tangent.dot(&local) / tangent.norm_squared();
                        let normal = if square > SPENT * SPENT { row.dot(&local) / square } else { 0.0 };
                        rubbing[site] = (own - across * normal) / left;
                        pressing[site] += rubbing[site] * tangent.dot(&row) / square.max(f64::MIN_POSITIVE);
                    }
                }
            } else if group.tangents.iter().any(Option::is_some) {
                group.share(&local, &mut pressing, &mut rubbing);
            } else if let Ok(found) = group.rows.clone().svd(true, true).solve(&local, SPENT) {
                group.sites.iter().zip(found.iter()).for_each(|(site, force)| pressing[*site] = -force);
            }
        }
        (pressing, rubbing)
    }

    /// Work on `value` of all `forces` at places of contact, less that of `pressing` along the one direction of each and of `rubbing`;
    /// `forces` and `value` without what supports take and prescribe.
    pub fn across(
        &self,
        forces: &[[f64; 2]],
        (pressing, rubbing): (&[f64], &[f64]),
        value: impl Fn(usize) -> [f64; 2] + Copy,
    ) -> f64 {
        let along = |(site, place): (usize, &Site)| {
            rubbing[site] * place.slip(value) - pressing[site] * place.jump(place.normal, value)
        };
        let all = self.groups.iter().flat_map(|group| &group.nodes).map(|node| dot(forces[*node], value(*node)));
        all.sum::<f64>() - self.list.iter().enumerate().map(along).sum::<f64>()
    }

    /// True if a place shares its friction force with nothing: supports leave both sides free to slide, and no other place has their nodes.
    pub fn rubs_alone(&self, site: usize) -> bool {
        let own = |group: &&Group| group.sites == [site];
        let group = self.groups.iter().find(own);
        group.is_some_and(|g| {
            g.tangents[0].as_ref().is_some_and(|t| t.norm() > SPENT && t.dot(&g.rows.column(0)).abs() < SPENT)
        })
    }

    /// True if supports hold both sides of a place along the direction of contact, so that its force cannot be determined.
    pub fn is_held(&self, site: usize) -> bool {
        let own = |group: &&Group| group.sites.binary_search(&site).is_ok();
        let row = self.groups.iter().find(own).and_then(|group| {
            let place = group.sites.binary_search(&site).ok()?;
            Some(group.rows.column(place).norm())
        });
        row.is_none_or(|length| length <= SPENT)
    }

    /// Forces and distances in Bernstein coefficients, in which every pressure ≥ 0 gives forces ≥ 0.
    pub fn in_coefficients(&self, pressing: &[f64], excess: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut forces, mut distances) = (pressing.to_vec(), excess.to_vec());
        for span in &self.spans {
            let ([first, last], Some(middle)) = (span.ends, span.middle) else { continue };
            forces[middle] = 0.5 * pressing[middle];
            forces[first] += 0.25 * pressing[middle];
            forces[last] += 0.25 * pressing[middle];
            distances[middle] = 2.0 * excess[middle] - 0.5 * (excess[first] + excess[last]);
        }
        (forces, distances)
    }
}

impl Group {
    /// Distributes forces over places that press and rub, as far as such forces can represent them; the remainder goes to the normal
    /// forces of all places, with either sign.
    fn share(&self, local: &DVector<f64>, pressing: &mut [f64], rubbing: &mut [f64]) {
        let mut rows: Vec<(usize, f64, DVector<f64>)> = Vec::new();
        for (place, site) in self.sites.iter().enumerate() {
            let normal = self.rows.column(place).into_owned();
            let tangent = self.tangents[place].iter().flat_map(|t| [(1.0, t.clone()), (-1.0, -t)]);
            rows.push((*site, 0.0, -normal));
            rows.extend(tangent.map(|(sign, t)| (*site, sign, t)));
        }
        rows.retain(|(_, _, row)| row.norm() > SPENT);
        let unit: Vec<DVector<f64>> = rows.iter().map(|(_, _, row)| row / row.norm()).collect();
        let mut left = local.clone();
        if let Ok((rest, forces)) = balanced(local, &unit) {
            left = rest;
            for (row, force) in forces {
                let (site, sign, own) = &rows[row];
                let force = force / own.norm();
                if *sign == 0.0 { pressing[*site] += force } else { rubbing[*site] += sign * force }
            }
        }
        if let Ok(found) = self.rows.clone().svd(true, true).solve(&left, SPENT) {
            self.sites.iter().zip(found.iter()).for_each(|(site, force)| pressing[*site] -= force);
        }
    }

    fn gather(&self, forces: &[[f64; 2]]) -> DVector<f64> {
        DVector::from_iterator(2 * self.nodes.len(), self.nodes.iter().flat_map(|n| forces[*n]))
    }
}

fn groups(list: &[Site], holds: &Holds) -> Vec<Group> {
    let middles = (0..holds.edges.len()).map(|e| holds.middle(e));
    let all: Vec<Hold> = holds.vertices.iter().copied().chain(middles).collect();
    let mut sets = DisjointSets::new(all.len());
    for site in list {
        if let Some(second) = site.second {
            sets.join(site.first, second);
        }
    }
    let (label, _) = sets.labels();
    let mut members: BTreeMap<usize, (BTreeSet<usize>, Vec<usize>)> = BTreeMap::new();
    for (number, site) in list.iter().enumerate() {
        let (nodes, sites) = members.entry(label[site.first]).or_default();
        nodes.extend(site.nodes().map(|(node, _)| node));
        sites.push(number);
    }
    let group = |(nodes, sites): (BTreeSet<usize>, Vec<usize>)| {
        let nodes: Vec<usize> = nodes.into_iter().collect();
        let row = |site: &Site, direction: [f64; 2]| {
            let mut row = DVector::zeros(2 * nodes.len());
            for (node, sign) in site.nodes() {
                let Ok(place) = nodes.binary_search(&node) else { continue };
                let d = all[node].project(direction);
                row[2 * place] += sign * d[0];
                row[2 * place + 1] += sign * d[1];
            }
            row
        };
        let columns: Vec<DVector<f64>> = sites.iter().map(|s| row(&list[*s], list[*s].normal)).collect();
        let rows = DMatrix::from_columns(&columns);
        let tangents: Vec<Option<DVector<f64>>> =
            sites.iter().map(|s| Some(row(&list[*s], list[*s].tangent?))).collect();
        let turned = sites.iter().filter_map(|s| Some(row(&list[*s], list[*s].turned?)));
        let mut basis: Vec<DVector<f64>> = Vec::new();
        for mut row in columns.into_iter().chain(turned).chain(tangents.iter().flatten().cloned()) {
            let long = row.norm();
            for known in &basis {
                let part = known.dot(&row);
                row.axpy(-part, known, 1.0);
            }
            let left = row.norm();
            if left > SPENT * long.max(SPENT) {
                basis.push(row / left);
            }
        }
        Group { nodes, sites, rows, tangents, basis }
    };
    members.into_values().map(group).collect()
}
