//! Sides of elements by the labels of `*SURFACE`.

use super::scope::Cell;
use crate::mesh::files::content::Kind;

/// Which part of its elements a surface is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Label {
    /// All sides: without a label it is the free surface of the elements.
    Free,
    /// `S1` to `S6`: a side of a plane element; of a shell S1 and S2 are its faces, as CalculiX counts them.
    Face(usize),
    /// `E1` to `E4`: an edge of a shell.
    Edge(usize),
    /// A face of a shell, which lies in the plane.
    Flat,
    /// An end of a line.
    End,
}

impl Label {
    /// The label in `text`, if it is one.
    pub fn parse(text: &str) -> Option<Label> {
        let text = text.to_ascii_uppercase();
        match text.as_str() {
            "" | "EDGE" => return Some(Label::Free),
            "SPOS" | "SNEG" | "SP" | "SN" => return Some(Label::Flat),
            "END1" | "END2" => return Some(Label::End),
            _ => {}
        }
        let number = |prefix: char| text.strip_prefix(prefix)?.parse::<usize>().ok();
        match (number('S'), number('E')) {
            (Some(n @ 1..=6), _) => Some(Label::Face(n)),
            (_, Some(n @ 1..=4)) => Some(Label::Edge(n)),
            _ => None,
        }
    }

    /// The sides of `cell` that this label names, as pairs of nodes: none where it names a face or an end.
    ///
    /// # Errors
    /// Says that the element has no such side.
    pub fn sides(self, cell: &Cell) -> Result<Vec<[u64; 2]>, String> {
        let corners = &cell.nodes[..cell.kind.corners()];
        if let [a, b] = *corners {
            return Ok(if self == Label::End { Vec::new() } else { vec![[a, b]] });
        }
        let side = |i: usize| [corners[i], corners[(i + 1) % corners.len()]];
        let number = match self {
            Label::Free => return Ok((0..corners.len()).map(side).collect()),
            Label::Flat | Label::End => return Ok(Vec::new()),
            Label::Face(1 | 2) if cell.shell => return Ok(Vec::new()),
            Label::Face(n) if cell.shell => n - 2,
            Label::Face(n) | Label::Edge(n) => n,
        };
        match number <= corners.len() {
            true => Ok(vec![side(number - 1)]),
            false => Err(format!("element {} is {} and has no such side", cell.tag, shape(cell.kind, cell.shell))),
        }
    }
}

fn shape(kind: Kind, shell: bool) -> &'static str {
    match (kind, shell) {
        (Kind::Line, _) => "a line",
        (Kind::Triangle, false) => "a triangle",
        (Kind::Triangle, true) => "a triangular shell",
        (Kind::Quadrilateral, false) => "a quadrilateral",
        (Kind::Quadrilateral, true) => "a quadrilateral shell",
    }
}

/// The labels that there are, for messages.
pub(super) const LABELS: &str =
    "sides are S1 to S4, those of shells E1 to E4 (Abaqus) or S3 to S6 (CalculiX); SPOS and SNEG are faces";
