//! Reported contact reactions against those in equilibrium with the stresses of a displacement solution.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use super::higher::Asked;
use super::{End, HELD, Solution, dot, inner_reactions};
use crate::bounds::Hold;
use crate::compare::candidate::Reactions;
use crate::compare::contact::slides::{Slide, inside};
use crate::problem::{ContactPair, Interface};

impl Solution<'_> {
    /// The largest error of the reported reactions of an interface, at the vertices where only this contact acts, and of the
    /// reported resultant against their sum. `rest` are the forces that supports leave at the vertices, without those of the
    /// middle coefficients; `left` are all of them.
    pub(super) fn misreported(
        &self,
        index: usize,
        interface: &Interface,
        reported: &Reactions,
        rest: &[[f64; 2]],
        left: &[[f64; 2]],
    ) -> f64 {
        let vertices = self.problem.mesh.points.len();
        let mut worst = 0.0_f64;
        let mut sum = [0.0; 2];
        let mut add = |force: [f64; 2]| sum = [sum[0] + force[0], sum[1] + force[1]];
        for (k, pair) in interface.pairs.iter().enumerate() {
            if let (Some(edge), Some(e)) = (&reported.edge, pair.edges[0]) {
                let r = edge.get(k).map_or(&[][..], Vec::as_slice);
                let asked = match self.candidate.degree {
                    2 => asked_in_the_middle(pair, left[vertices + e]),
                    degree => self.asked_inside(pair, degree, left),
                };
                // With friction along a direction that turns a node does not tell which of its forces is which.
                let told = pair.friction.is_none() || pair.direction.is_constant();
                for (i, asked) in asked.into_iter().enumerate() {
                    let r = r.get(i).copied().unwrap_or(0.0);
                    worst = worst.max(if told { (r - asked.reaction).abs() } else { 0.0 });
                    add(asked.moved.map(|n| -r * n));
                }
            }
        }
        if let Some(friction) = &reported.friction {
            let inside = interface.pairs.iter().zip(friction.edge.iter().flatten());
            for (pair, forces) in inside {
                let asked = self.asked_of_friction(pair, left);
                let Some(friction) = pair.friction else { continue };
                let steps = (forces.len() + 1) as f64;
                for (i, force) in forces.iter().enumerate() {
                    let told = pair.direction.is_constant();
                    worst = worst.max(if told { (force - asked.get(i).copied().unwrap_or(0.0)).abs() } else { 0.0 });
                    add(friction.tangent.at((i + 1) as f64 / steps).map(|t| force * t));
                }
            }
        }
        let rubbed = self.rubbed(index, reported, rest);
        worst = worst.max(rubbed.worst);
        let mut meetings = self.meetings(index, interface);
        let mut comparable = true;
        for (v, &r) in reported.vertices.iter().zip(&reported.vertex) {
            let Some(meeting) = meetings.remove(v) else {
                // A force where there is no contact.
                worst = worst.max(r.abs());
                continue;
            };
            match meeting {
                Meeting::One { end, alone } => {
                    if alone {
                        worst = worst.max((r - self.asked(&end, rest)).abs());
                    }
                    add(end.normal.map(|n| -r * n));
                    add(rubbed.at.get(v).copied().unwrap_or_default());
                }
                // The force on a vertex that nothing else holds is that of the contact, whatever its directions.
                Meeting::Several if self.holds.vertices[*v] == Hold::Free => add(rest[*v]),
                Meeting::Several => comparable = false,
            }
        }
        // A vertex that is left out carries nothing, or the report is not whole.
        for meeting in meetings.into_values() {
            if let Meeting::One { end, alone: true } = meeting {
                worst = worst.max(self.asked(&end, rest).abs());
            }
        }
        if comparable {
            worst = worst.max((reported.resultant[0] - sum[0]).hypot(reported.resultant[1] - sum[1]));
        }
        worst
    }

    /// The [`Meeting`] of an interface with each vertex of its first side.
    fn meetings(&self, index: usize, interface: &Interface) -> HashMap<usize, Meeting> {
        let others = self.problem.interfaces.iter().enumerate().filter(|(other, _)| *other != index);
        let ends = others.flat_map(|(_, other)| &other.pairs).flat_map(End::of);
        let mut elsewhere: HashSet<usize> = ends.flat_map(|end| [Some(end.first), end.second]).flatten().collect();
        // Where friction does not act for itself, what presses cannot be told from what rubs.
        elsewhere.extend(self.slides.iter().filter(|(_, coupled)| *coupled).map(|(slide, _)| slide.first));
        let mut meetings: HashMap<usize, Meeting> = HashMap::new();
        let mut facing: HashMap<usize, usize> = HashMap::new();
        for end in interface.pairs.iter().flat_map(End::of) {
            // Two vertices of the first side over one of the second.
            let shared = end.second.is_some_and(|w| *facing.entry(w).or_insert(end.first) != end.first);
            let alone = !shared && ![Some(end.first), end.second].iter().flatten().any(|v| elsewhere.contains(v));
            match meetings.entry(end.first) {
                Entry::Vacant(place) => drop(place.insert(Meeting::One { end, alone })),
                Entry::Occupied(mut place) => {
                    let square = dot(end.normal, end.normal);
                    let parallel = |other: &End| dot(other.normal, end.normal) > (1.0 - HELD) * square;
                    let same = |other: &End| parallel(other) && other.second == end.second;
                    if !matches!(place.get(), Meeting::One { end, .. } if same(end)) {
                        place.insert(Meeting::Several);
                    }
                }
            }
        }
        meetings
    }

    /// The reaction at an end that no other contact shares: the one that balances both vertices best. Zero where supports hold them.
    fn asked(&self, end: &End, rest: &[[f64; 2]]) -> f64 {
        let (mut pull, mut square) = (0.0, 0.0);
        for (v, sign) in [(Some(end.first), 1.0), (end.second, -1.0)] {
            let Some(v) = v else { continue };
            let d = self.holds.vertices[v].project(end.normal);
            pull += sign * dot(rest[v], d);
            square += dot(d, d);
        }
        if square > HELD * HELD { -pull / square } else { 0.0 }
    }
}

/// Reported friction forces on the vertices of an interface, and their largest error against those the displacement requires.
struct Rubbed {
    at: HashMap<usize, [f64; 2]>,
    worst: f64,
}

impl Solution<'_> {
    /// The friction forces at vertices; where the friction law is coupled with others they are summed but not compared.
    fn rubbed(&self, index: usize, reported: &Reactions, rest: &[[f64; 2]]) -> Rubbed {
        let mut rubbed = Rubbed { at: HashMap::new(), worst: 0.0 };
        let Some(friction) = &reported.friction else { return rubbed };
        let forces: HashMap<usize, f64> =
            reported.vertices.iter().copied().zip(friction.vertex.iter().copied()).collect();
        for (slide, coupled) in self.slides.iter().filter(|(slide, _)| slide.interface == index) {
            let force = forces.get(&slide.first).copied().unwrap_or(0.0);
            let end = End { first: slide.first, second: slide.second, normal: slide.tangent, gap: 0.0 };
            if !coupled {
                rubbed.worst = rubbed.worst.max((force + self.asked(&end, rest)).abs());
            }
            rubbed.at.insert(slide.first, slide.tangent.map(|t| force * t));
        }
        rubbed
    }

    /// The friction forces inside a pair that balance the forces on the nodes of its first side.
    fn asked_of_friction(&self, pair: &ContactPair, left: &[[f64; 2]]) -> Vec<f64> {
        let degree = self.candidate.degree;
        let first = pair.edges[0].map_or(0..0, |e| {
            let begin = self.problem.mesh.points.len() + e * (degree - 1);
            begin..begin + degree - 1
        });
        let asked = |slide: Slide| {
            let own = || slide.row.terms().iter().filter(|(node, _)| first.contains(node));
            let pull: f64 = own().map(|(node, factor)| dot(left[*node], *factor)).sum();
            let square: f64 = own().map(|(_, factor)| dot(*factor, *factor)).sum();
            if square > 0.0 { pull / square } else { 0.0 }
        };
        inside(self.problem, pair, degree).into_iter().map(asked).collect()
    }
}

/// The reactions of degree 2 inside a pair that balance the force `left` at the midpoint of its first side.
fn asked_in_the_middle(pair: &ContactPair, left: [f64; 2]) -> Vec<Asked> {
    let [m, n] = pair.direction.ends;
    if pair.direction.is_constant() {
        return vec![Asked { reaction: -0.5 * dot(left, n), moved: n }];
    }
    let moved = [[m, n], [n, m]].map(|[m, n]| [0, 1].map(|c| (2.0 * m[c] + n[c]) / 3.0));
    let both = inner_reactions(pair, left, [true; 2]).into_iter().zip(moved);
    both.map(|(reaction, moved)| Asked { reaction, moved }).collect()
}

/// Directions of an interface at a vertex of its first side: one, with no other contact there if it is `alone`,
/// or several.
enum Meeting {
    One { end: End, alone: bool },
    Several,
}
