//! The plane in which the cells of a mesh file lie.

use std::collections::HashMap;
use std::path::Path;

use super::content::{Content, Element};
use crate::mesh::MeshError;
use crate::scene::Note;

/// Deviation from the plane, in parts of the coordinates, that is none: files have seven digits, and what it changes is of second order.
const FLAT: f64 = 1e-6;

/// A plane z = `height`.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    height: f64,
    /// The largest coordinate of the file.
    size: f64,
}

impl Plane {
    /// The plane in which the nodes of all cells lie, or z = 0 where they lie in none.
    pub fn of(elements: &[Element], index: &HashMap<u64, usize>, position: &[[f64; 3]]) -> Self {
        let size = position.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut used = elements.iter().flat_map(|e| &e.nodes).filter_map(|tag| Some(position[*index.get(tag)?]));
        let height = match used.next() {
            Some([_, _, first]) if used.all(|p| (p[2] - first).abs() <= FLAT * size) => first,
            _ => 0.0,
        };
        Plane { height, size }
    }

    /// True if these nodes lie in it.
    pub fn holds(self, nodes: &[usize], position: &[[f64; 3]]) -> bool {
        nodes.iter().all(|&n| (position[n][2] - self.height).abs() <= FLAT * self.size)
    }

    /// Says which elements have nodes outside the plane, how many they are, and how far it goes.
    pub fn left(
        self,
        elements: &[Element],
        file: &Path,
        index: &HashMap<u64, usize>,
        position: &[[f64; 3]],
    ) -> MeshError {
        let height = self.height;
        let (mut count, mut first, mut low, mut high) = (0_usize, None, height, height);
        for element in elements {
            let nodes: Vec<usize> = element.nodes.iter().filter_map(|tag| index.get(tag).copied()).collect();
            let heights = nodes.iter().map(|&n| position[n][2]);
            (low, high) = heights.fold((low, high), |(low, high), z| (low.min(z), high.max(z)));
            if self.holds(&nodes, position) {
                continue;
            }
            count += 1;
            let farthest = |a: &&usize, b: &&usize| {
                (position[**a][2] - height).abs().total_cmp(&(position[**b][2] - height).abs())
            };
            let place = nodes.iter().max_by(farthest).map_or([0.0; 3], |&n| position[n]);
            first.get_or_insert((element.tag, place));
        }
        let (tag, [x, y, z]) = first.unwrap_or_default();
        let what = format!(
            "element {tag} has a node at ({x}, {y}, {z}), outside the plane z = {height}; so have {count} of {} elements, and z \
             goes from {low} to {high}",
            elements.len()
        );
        MeshError::file(file, what, "put the geometry into one plane, z = 0")
    }
}

/// The axes that become x, y and z where points stand, `within` a distance, in a plane of constant y or x, with that constant: x, z, y, or
/// y, z, x.
pub fn upright(points: impl Iterator<Item = [f64; 3]>, within: f64) -> Option<([usize; 3], f64)> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        low = [0, 1, 2].map(|c| low[c].min(point[c]));
        high = [0, 1, 2].map(|c| high[c].max(point[c]));
    }
    match [0, 1, 2].map(|c| high[c] - low[c] <= within) {
        [false, true, false] => Some(([0, 2, 1], low[1])),
        [true, false, false] => Some(([1, 2, 0], low[0])),
        _ => None,
    }
}

impl Content {
    /// Turns a mesh that stands in a plane of constant y or x into that of x and y, and says so.
    pub(super) fn laid_down(&mut self) -> Option<Note> {
        let size = self.nodes.values().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let used = self.elements.iter().flat_map(|e| &e.nodes).filter_map(|tag| self.nodes.get(tag));
        let (axes, constant) = upright(used.copied(), FLAT * size)?;
        self.nodes.values_mut().for_each(|p| *p = axes.map(|c| p[c]));
        let [first, second, name] = axes.map(|c| ["x", "y", "z"][c]);
        let text = format!(
            "The mesh lies in the plane {name} = {constant}: {first} and {second} of the file are x and y here."
        );
        Some(Note { weakens_guarantee: false, text })
    }
}
