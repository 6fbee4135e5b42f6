//! Notes on what a deck holds and this program leaves out.

use crate::scene::Note;

/// Names in one note; more are counted.
const LISTED: usize = 5;

/// Names of sets and surfaces with something to say about them.
#[derive(Default)]
pub(super) struct Remarks {
    /// Sets with numbers that are not there, and the first of them.
    strays: Vec<(String, u64)>,
    /// Surfaces that are faces in the plane.
    flat: Vec<String>,
    /// Surfaces without elements.
    rigid: Vec<String>,
    /// Types of rigid elements beside elastic ones.
    rigid_cells: Vec<String>,
    /// Types of elements without an area.
    left_out: Vec<String>,
    /// Names that more than one part has.
    common: Vec<String>,
    /// Names of a node set and of another surface of nodes.
    doubled: Vec<String>,
}

impl Remarks {
    pub fn stray(&mut self, set: &str, number: u64) {
        if self.strays.last().is_none_or(|(last, _)| last != set) {
            self.strays.push((set.to_owned(), number));
        }
    }

    pub fn flat(&mut self, surface: &str) {
        self.flat.push(surface.to_owned());
    }

    pub fn rigid(&mut self, surface: &str) {
        self.rigid.push(surface.to_owned());
    }

    pub fn rigid_cells(&mut self, kind: &str) {
        self.rigid_cells.push(kind.to_owned());
    }

    pub fn left_out(&mut self, kind: &str) {
        self.left_out.push(kind.to_owned());
    }

    pub fn common(&mut self, name: &str) {
        self.common.push(name.to_owned());
    }

    pub fn doubled(&mut self, name: &str) {
        self.doubled.push(name.to_owned());
    }

    pub fn notes(self) -> Vec<Note> {
        let Remarks { strays, flat, rigid, rigid_cells, left_out, common, doubled } = self;
        let strays = strays.into_iter().map(|(set, number)| format!("{set} ({number})")).collect();
        let kinds = [
            ("Numbers that are not in the deck are left out of these sets, the first in brackets: ", strays),
            ("These surfaces are faces of cells (SPOS, SNEG), which lie in the plane and have no edge: ", flat),
            ("These surfaces have no elements (analytical rigid ones and cuts) and are left out: ", rigid),
            (
                "Rigid elements of these types are left out, say obstacles and supports in the scene instead: ",
                rigid_cells,
            ),
            ("Elements of these types have no area here and are left out: ", left_out),
            ("Sets of several parts have these names, which stand for all of them together: ", common),
            ("A node set and a surface of other nodes have these names, which stand for the node set: ", doubled),
        ];
        let note = |(text, mut names): (&str, Vec<String>)| {
            names.sort();
            names.dedup();
            let text = match names.len() {
                0 => return None,
                n if n <= LISTED => format!("{text}{}.", names.join(", ")),
                n => format!("{text}{} and {} more.", names[..LISTED].join(", "), n - LISTED),
            };
            Some(Note { weakens_guarantee: false, text })
        };
        kinds.into_iter().filter_map(note).collect()
    }
}
