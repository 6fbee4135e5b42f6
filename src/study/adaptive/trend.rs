//! Where to bisect and where to raise the degree, learnt from what the last step of each was worth.
//!
//! Where the solution is smooth, bisecting a triangle of degree p leaves (½)^{p + 1} of its term of the gap, and a degree
//! more leaves a fixed part of it; at a singular point bisecting leaves a power of the area that knows nothing of p, and a
//! degree more leaves nearly all. So a triangle goes on with what served it: after a step that brought what a smooth
//! solution promises the degree is raised next, after one that did not the triangle is bisected (Melenk & Wohlmuth 2001).

use super::forecast::Forecast;
use super::indicators::Indicators;
use crate::dual::spread;
use crate::element::{Elements, MAX_DEGREE};
use crate::mesh::Triangulation;

/// The way to refine a triangle whose term is large.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Bisect it.
    Bisect,
    /// Raise its degree.
    Raise,
}

/// Part of the promised decay, as a logarithm, from which a bisected triangle counts as smooth.
const KEPT: f64 = 0.6;

/// Part of the term that one degree more leaves at most where the solution is smooth.
const BY_DEGREE: f64 = 0.25;

/// Part that it is expected to leave.
pub const EXPECTED: f64 = 0.1;

/// A mesh with its degrees and the terms of the gap on it.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The mesh.
    pub mesh: &'a Triangulation,
    /// The degrees.
    pub elements: &'a Elements,
    /// The terms.
    pub terms: &'a Indicators,
}

/// The way of every triangle of `now`, whose triangle t lies in triangle `parent[t]` of `before`, from the `ways` there.
pub fn learnt(now: Seen<'_>, before: Seen<'_>, parent: &[usize], ways: &[Way]) -> Vec<Way> {
    let count = before.mesh.triangles.len();
    // Of every triangle before: what is left of its term, what a smooth solution would leave, and the steps made there.
    let (mut left, mut promised) = (vec![0.0; count], vec![0.0; count]);
    let (mut bisected, mut raised) = (vec![false; count], vec![0; count]);
    for (t, &old) in parent.iter().enumerate() {
        let part = now.mesh.area(t) / before.mesh.area(old);
        let degree = before.elements.degree(old);
        left[old] += now.terms.of(t);
        promised[old] += part.powi(degree as i32 + 2);
        bisected[old] |= part < 0.9;
        raised[old] = raised[old].max(now.elements.degree(t) - degree);
    }
    let judged = |old: usize| {
        let kept = left[old] / before.terms.of(old);
        if !kept.is_finite() {
            return ways[old];
        }
        let promised = match (bisected[old], raised[old]) {
            (false, 0) => return ways[old],
            (false, by) => BY_DEGREE.powi(by as i32),
            (true, by) => (promised[old] * BY_DEGREE.powi(by as i32)).powf(KEPT),
        };
        if kept <= promised { Way::Raise } else { Way::Bisect }
    };
    let judged: Vec<Way> = (0..count).map(judged).collect();
    parent.iter().map(|&old| judged[old]).collect()
}

/// The way of every triangle of `fine`, whose triangle t lies in triangle `parent[t]` of `coarse`: of a triangle that was
/// bisected for a singular point, only the pieces at that point go on being bisected.
pub fn inherited(
    forecast: &Forecast,
    ways: &[Way],
    coarse: &Triangulation,
    fine: &Triangulation,
    parent: &[usize],
) -> Vec<Way> {
    let way = |(t, &p): (usize, &usize)| match (ways[p], forecast.singular(coarse.triangles[p])) {
        (Way::Bisect, Some((v, _))) if !fine.triangles[t].contains(&v) => Way::Raise,
        (way, _) => way,
    };
    parent.iter().enumerate().map(way).collect()
}

/// The degrees with those of the `marked` triangles raised by one, and of others so far that neighbours differ by one at
/// most, and the two at edges that are `facing` each other across a contact not at all: on the side of a lower degree no stress
/// would feel the sliding and the jumps beyond that degree.
pub fn raised(mesh: &Triangulation, facing: &[[usize; 2]], elements: &Elements, marked: &[usize]) -> Elements {
    let mut degree: Vec<u8> = (0..mesh.triangles.len()).map(|t| elements.degree(t) as u8).collect();
    marked.iter().for_each(|&t| degree[t] = (degree[t] + 1).min(MAX_DEGREE as u8));
    spread(mesh, facing, &mut degree, marked.to_vec());
    Elements::Blocks(degree.into())
}
