//! Shapes of cells by the names of Abaqus and CalculiX elements.

use super::Kind;

/// Treatment of the elements of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    /// A cell of the mesh, with so many nodes.
    Plane(Kind, usize),
    /// A cell that is rigid, unless a deck has no others: there the type is what a program writes for want of a better one.
    Rigid(Kind, usize),
    /// No part of the mesh: springs, masses, connectors.
    Idle,
    /// A cell in space.
    Space,
    /// A name that is not known.
    Unknown,
}

const PLANE: [&str; 12] = ["CPEG", "CPE", "CPS", "CGAX", "CAX", "DC2D", "DCAX", "M3D", "STRI", "SC", "S", "WARP2D"];
const SPACE: [&str; 5] = ["C3D", "DC3D", "AC3D", "CIN3D", "EC3D"];
/// Trusses, beams, shells of revolution, rigid and surface lines, with the number of their nodes behind.
const LINE: [&str; 14] =
    ["B2", "B3", "PIPE2", "PIPE3", "T2D", "T3D", "R2D", "RAX", "SAX", "MAX", "SFMAX", "RB2D", "RB3D", "F2D"];
const IDLE: [&str; 13] =
    ["SPRING", "DASHPOT", "MASS", "ROTARYI", "GAP", "CONN", "SFM3D", "DCOUP", "UNI", "DISTC", "ITS", "ELBOW", "U"];

/// The family of elements called `name`.
pub(super) fn family(name: &str) -> Family {
    let name = name.trim().to_ascii_uppercase();
    if SPACE.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Space;
    }
    if IDLE.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Idle;
    }
    match name.strip_prefix("R3D") {
        Some("3") => return Family::Rigid(Kind::Triangle, 3),
        Some("4") => return Family::Rigid(Kind::Quadrilateral, 4),
        Some(_) => return Family::Idle,
        None => {}
    }
    if let Some(rest) = LINE.iter().find_map(|prefix| name.strip_prefix(prefix)) {
        // SAX1 has two nodes and SAX2 three; all others have their number.
        let order = name.starts_with("SAX") || name.starts_with("MAX") || name.starts_with("SFMAX");
        return match rest.chars().next() {
            Some('1') => Family::Plane(Kind::Line, 2),
            Some('2') => Family::Plane(
                Kind::Line,
                if order || name.starts_with('B') || name.starts_with("PIPE") { 3 } else { 2 },
            ),
            Some('3') => Family::Plane(Kind::Line, 3),
            _ => Family::Idle,
        };
    }
    let rest = PLANE.iter().find_map(|prefix| {
        let rest = name.strip_prefix(prefix)?;
        rest.starts_with(|c: char| c.is_ascii_digit()).then_some(rest)
    });
    // Nodes are the first figure: CPS4R, S8R5, and STRI65, a triangle with six.
    match rest.and_then(|rest| rest.chars().next()) {
        Some('3') => Family::Plane(Kind::Triangle, 3),
        Some('4') => Family::Plane(Kind::Quadrilateral, 4),
        Some('6') => Family::Plane(Kind::Triangle, 6),
        Some('8') => Family::Plane(Kind::Quadrilateral, 8),
        Some('9') => Family::Plane(Kind::Quadrilateral, 9),
        _ => Family::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plane_elements_of_any_integration_are_cells() {
        for (names, kind, nodes) in [
            ("CPE3 CPS3 CAX3 S3 S3R CPEG3 cps3 CPE3H M3D3 DC2D3", Kind::Triangle, 3),
            ("CPE4 CPE4R CPS4I CPE4RH CAX4R S4 S4R5 CPEG4 M3D4R", Kind::Quadrilateral, 4),
            ("CPE6 CPE6M CPS6 CAX6 STRI65 CPE6MH", Kind::Triangle, 6),
            ("CPE8 CPE8R CPS8R CAX8 S8R5 S8 CPE8RH", Kind::Quadrilateral, 8),
            ("S9R5 M3D9", Kind::Quadrilateral, 9),
        ] {
            for name in names.split(' ') {
                assert_eq!(family(name), Family::Plane(kind, nodes), "{name}");
            }
        }
        assert_eq!(family("C3D8R"), Family::Space);
        assert_eq!(family("R3D4"), Family::Rigid(Kind::Quadrilateral, 4));
        for (names, nodes) in
            [("B21 B21H B31 T2D2 T3D2 R2D2 RAX2 SAX1 MAX1 PIPE21", 2), ("B22 B32 B32R T3D3 T2D3 SAX2", 3)]
        {
            for name in names.split(' ') {
                assert_eq!(family(name), Family::Plane(Kind::Line, nodes), "{name}");
            }
        }
        for name in ["SPRING1", "MASS", "CONN2D2", "GAPUNI"] {
            assert_eq!(family(name), Family::Idle, "{name}");
        }
        for name in ["", "CPE", "CPX4", "CPE7"] {
            assert_eq!(family(name), Family::Unknown, "{name}");
        }
    }
}
