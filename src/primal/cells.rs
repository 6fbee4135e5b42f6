//! The cells of the displacement model: those of the mesh file, or triangles.

use serde::{Deserialize, Serialize};

use crate::element::displacement::on_quadrilaterals::{HIGHEST, can_carry};
use crate::mesh::Triangulation;

/// Which cells are wanted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum WantedCells {
    /// Q1 and Q2 where the mesh file has quadrilaterals alone, otherwise triangles
    #[default]
    File,
    /// P1, P2 and so on, on the triangles of the stresses
    Triangles,
}

/// The cells that a displacement solution lives on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cells {
    /// The triangles of the mesh: degree k is that of polynomials.
    #[default]
    Triangles,
    /// The quadrilaterals of the mesh file: degree k is that in each coordinate of a square.
    Quadrilaterals,
}

impl Cells {
    /// Their name in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Cells::Triangles => "triangles",
            Cells::Quadrilaterals => "quadrilaterals",
        }
    }

    /// The letter of the space: P or Q.
    pub fn letter(self) -> char {
        match self {
            Cells::Triangles => 'P',
            Cells::Quadrilaterals => 'Q',
        }
    }
}

/// A space of displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Space {
    /// Its cells.
    pub cells: Cells,
    /// Its degree k.
    pub degree: u8,
}

impl Space {
    /// P of this degree.
    pub fn on_triangles(degree: u8) -> Self {
        Space { cells: Cells::Triangles, degree }
    }
}

impl std::fmt::Display for Space {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.cells.letter(), self.degree)
    }
}

/// The spaces of `degrees` on `mesh`.
pub fn spaces(mesh: &Triangulation, wanted: WantedCells, degrees: &[u8]) -> Vec<Space> {
    let on_quadrilaterals = wanted == WantedCells::File && can_carry(mesh);
    let cells = |degree: u8| match on_quadrilaterals && usize::from(degree) <= HIGHEST {
        true => Cells::Quadrilaterals,
        false => Cells::Triangles,
    };
    degrees.iter().map(|&degree| Space { cells: cells(degree), degree }).collect()
}

/// A report's remark on the cells of the displacement model where the mesh file has quadrilaterals.
pub fn remark(mesh: &Triangulation, spaces: &[Space]) -> Option<String> {
    let count = mesh.cells.len();
    if count == 0 {
        return None;
    }
    let names = |cells: Cells| {
        let of: Vec<String> = spaces.iter().filter(|space| space.cells == cells).map(Space::to_string).collect();
        of.join(" and ")
    };
    let (on_file, on_triangles) = (names(Cells::Quadrilaterals), names(Cells::Triangles));
    let why = match mesh.is_quadrilateral() {
        false => format!("the mesh has {} triangles beside its {count} quadrilaterals", mesh.lone_triangles().len()),
        true if can_carry(mesh) => match on_file.is_empty() {
            true => "as was asked".to_string(),
            false => format!("degrees above {HIGHEST} are there alone"),
        },
        true => "some quadrilaterals are not convex".to_string(),
    };
    if on_file.is_empty() {
        return Some(format!("The displacement model is {on_triangles} on the triangles of the stresses: {why}."));
    }
    let distorted = mesh.quadrilaterals().filter(|cell| !cell.is_parallelogram(mesh)).count();
    let mut text = format!("The displacement model is {on_file} on the {count} quadrilaterals of the mesh file");
    if !on_triangles.is_empty() {
        text.push_str(&format!(", and {on_triangles} on triangles: {why}"));
    }
    text.push('.');
    if distorted > 0 {
        text.push_str(&format!(
            " {distorted} of them are no parallelograms: on these it is no polynomial, its energy is that of its Gauss rule and no upper \
             bound, and it is drawn, and its stresses compared, as the polynomials on triangles that have its values."
        ));
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::testing::{grid, of_quadrilaterals, scene};
    use crate::mesh::{RawMesh, Triangulation};

    fn mesh(raw: RawMesh) -> Triangulation {
        Triangulation::new(raw, &scene(&["a"])).expect("a good mesh").0
    }

    #[test]
    fn quadrilaterals_alone_carry_q1_and_q2() {
        let square = || of_quadrilaterals(grid("a", [0.0; 2], [1.0; 2], [2, 2]));
        let named = |mesh: &Triangulation, wanted| {
            let spaces = spaces(mesh, wanted, &[1, 2, 3]);
            let text = remark(mesh, &spaces).unwrap_or_default();
            (spaces.iter().map(Space::to_string).collect::<Vec<_>>().join(","), text)
        };
        let (spaces, text) = named(&mesh(square()), WantedCells::File);
        assert_eq!(spaces, "Q1,Q2,P3");
        assert!(text.contains("Q1 and Q2 on the 4 quadrilaterals") && text.contains("P3 on triangles"), "{text}");
        assert_eq!(named(&mesh(square()), WantedCells::Triangles).0, "P1,P2,P3");
        let mut mixed = square();
        mixed.quadrilaterals.pop();
        let (spaces, text) = named(&mesh(mixed), WantedCells::File);
        assert_eq!(spaces, "P1,P2,P3");
        assert!(text.contains("2 triangles beside its 3 quadrilaterals"), "{text}");
        let mut distorted = square();
        distorted.points[4] = [0.6, 0.55];
        assert!(named(&mesh(distorted), WantedCells::File).1.contains("4 of them are no parallelograms"));
        assert_eq!(
            named(&mesh(grid("a", [0.0; 2], [1.0; 2], [2, 2])), WantedCells::File),
            ("P1,P2,P3".into(), String::new())
        );
    }
}
