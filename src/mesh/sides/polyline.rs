//! The edges of a contact side in order, with their arc length.

use std::collections::BTreeMap;

use crate::scene::keys::polygon::area;

/// A point as a key: equal bits, and 0 equal to −0.
pub(crate) type Key = [u64; 2];

/// The key of a point.
pub(crate) fn key(p: [f64; 2]) -> Key {
    p.map(|x| (x + 0.0).to_bits())
}

/// The point of a key.
pub(crate) fn point(key: Key) -> [f64; 2] {
    key.map(f64::from_bits)
}

/// One edge on the way along a side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Link {
    /// Index of the edge in the argument of [`chain`].
    pub edge: usize,
    /// True if it is passed from its second end to its first.
    pub reversed: bool,
    /// Arc length at its two ends, in the order in which they are passed.
    pub arc: [f64; 2],
}

/// Orders edges into pieces, each from the end that comes first in (x, y) order; the pieces follow one another by
/// these ends, and the arc length goes on from one to the next. A closed piece starts at its first point in (x, y)
/// order and runs anticlockwise, however its edges are divided.
///
/// # Errors
/// A point at which more than two edges meet.
pub(crate) fn chain(edges: &[[[f64; 2]; 2]]) -> Result<Vec<Link>, [f64; 2]> {
    let order = |a: &Key, b: &Key| {
        let (a, b) = (point(*a), point(*b));
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    };
    let mut at: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
    for (i, ends) in edges.iter().enumerate() {
        ends.iter().for_each(|p| at.entry(key(*p)).or_default().push(i));
    }
    if let Some((crossing, _)) = at.iter().find(|(_, meeting)| meeting.len() > 2) {
        return Err(point(*crossing));
    }
    let mut starts: Vec<Key> = at.keys().copied().collect();
    starts.sort_by(order);
    let closed_last = |k: &Key| at[k].len() != 1;
    starts.sort_by_key(closed_last);

    let mut done = vec![false; edges.len()];
    let mut pieces: Vec<(Key, Vec<(usize, bool)>)> = Vec::new();
    for start in starts {
        let mut piece = Vec::new();
        let mut here = start;
        let other = |i: usize, from: Key| key(if key(edges[i][0]) == from { edges[i][1] } else { edges[i][0] });
        while let Some(next) = at[&here].iter().copied().find(|&i| !done[i]) {
            done[next] = true;
            piece.push((next, key(edges[next][0]) != here));
            here = other(next, here);
        }
        let corners: Vec<[f64; 2]> = piece.iter().map(|&(i, reversed)| edges[i][usize::from(reversed)]).collect();
        if here == start && !corners.is_empty() && area(&corners) < 0.0 {
            piece.reverse();
            piece.iter_mut().for_each(|(_, reversed)| *reversed = !*reversed);
        }
        if !piece.is_empty() {
            pieces.push((start, piece));
        }
    }
    pieces.sort_by(|a, b| order(&a.0, &b.0));
    let mut arc = 0.0;
    let links = pieces.into_iter().flat_map(|(_, piece)| piece).map(|(edge, reversed)| {
        let [a, b] = edges[edge];
        let from = arc;
        arc += (b[0] - a[0]).hypot(b[1] - a[1]);
        Link { edge, reversed, arc: [from, arc] }
    });
    Ok(links.collect())
}

/// Part of the length of a side within which two positions count as the same.
pub(crate) const SAME: f64 = 1e-9;

/// The distance along a side within which two positions count as the same.
pub(crate) fn same(links: &[Link]) -> f64 {
    SAME * links.last().map_or(0.0, |last| last.arc[1])
}

/// Part of an edge beside its ends in which no vertex is put: the triangles there would be too flat to carry a digit.
const SLIVER: f64 = 1e-6;

/// The points of a side at the arc lengths `breaks` that are not at an end of an edge: (edge, point). Where they are within
/// a millionth of an edge of its ends, or of a point at an earlier one of `breaks`, no point is put, and what bends there is
/// linear on the edge as it is.
pub(crate) fn inner_points(edges: &[[[f64; 2]; 2]], links: &[Link], breaks: &[f64]) -> Vec<(usize, [f64; 2])> {
    let mut found = Vec::new();
    // The arc lengths of the points put so far, ascending.
    let mut put: Vec<f64> = Vec::new();
    let close = same(links);
    for &s in breaks {
        for link in links {
            let length = link.arc[1] - link.arc[0];
            let t = (s - link.arc[0]) / length;
            let close = close.max(SLIVER * length);
            let place = put.partition_point(|&other| other < s);
            let beside = |other: Option<&f64>| other.is_some_and(|other| (other - s).abs() <= close);
            let taken = beside(put.get(place)) || place > 0 && beside(put.get(place - 1));
            if s - link.arc[0] > close && link.arc[1] - s > close && !taken {
                let [a, b] = edges[link.edge];
                let t = if link.reversed { 1.0 - t } else { t };
                found.push((link.edge, [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]));
                put.insert(place, s);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_follow_one_another_from_their_first_ends() {
        let edges = [[[1.0, 0.0], [0.5, 0.0]], [[3.0, 1.0], [2.0, 1.0]], [[0.0, 0.0], [0.5, 0.0]]];
        let links = chain(&edges).expect("no branches");
        let passed: Vec<(usize, bool, [f64; 2])> = links.iter().map(|l| (l.edge, l.reversed, l.arc)).collect();
        assert_eq!(passed, [(2, false, [0.0, 0.5]), (0, true, [0.5, 1.0]), (1, true, [1.0, 2.0])]);
        assert_eq!(inner_points(&edges, &links, &[0.5, 0.75, 9.0]), [(0, [0.75, 0.0])]);
        // gmsh puts vertices on arcs to about 1e-9 of their length.
        assert_eq!(inner_points(&edges, &links, &[0.5 - 4e-7, 1.0 + 1e-8]), []);
    }

    #[test]
    fn a_loop_is_passed_once_and_anticlockwise_however_it_is_divided() {
        let corners = [[0.0, 0.0], [1.0, -0.4], [1.5, 0.3], [1.0, 0.4]];
        // Which neighbour of the first corner is nearer depends on the edge that is divided.
        for divided in [None, Some(0), Some(3)] {
            let mut points = Vec::new();
            for (i, a) in corners.into_iter().enumerate() {
                let b = corners[(i + 1) % 4];
                points.push(a);
                if divided == Some(i) {
                    points.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
                }
            }
            let n = points.len();
            for clockwise in [false, true] {
                let edge = |i: usize| {
                    if clockwise { [points[(i + 1) % n], points[i]] } else { [points[i], points[(i + 1) % n]] }
                };
                let edges: Vec<_> = (0..n).map(edge).collect();
                for links in [chain(&edges), chain(&edges.iter().rev().copied().collect::<Vec<_>>())] {
                    let links = links.expect("no branches");
                    let ends = links[0].arc[1] - links[0].arc[0];
                    let first = (points[1][0] - points[0][0]).hypot(points[1][1] - points[0][1]);
                    assert!((ends - first).abs() < 1e-15, "{divided:?} {clockwise}: {ends} is not {first}");
                    assert!(links.iter().all(|link| link.reversed == clockwise));
                    assert_eq!(links.iter().map(|l| l.edge).collect::<std::collections::BTreeSet<_>>().len(), n);
                }
            }
        }
    }

    #[test]
    fn a_branch_is_an_error() {
        let edges = [[[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 0.0], [-1.0, 0.0]]];
        assert_eq!(chain(&edges), Err([0.0, 0.0]));
    }
}
