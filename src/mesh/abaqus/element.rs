//! What the name of an Abaqus or CalculiX element says of its shape.

use super::Kind;

/// What is done with elements of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    /// A cell of the mesh, with so many nodes.
    Plane(Kind, usize),
    /// No part of the mesh: lines, springs, masses, connectors, rigid surfaces.
    Idle,
    /// A cell in space.
    Space,
    /// A name that is not known.
    Unknown,
}

const PLANE: [&str; 12] = ["CPEG", "CPE", "CPS", "CGAX", "CAX", "DC2D", "DCAX", "M3D", "STRI", "SC", "S", "WARP2D"];
const SPACE: [&str; 5] = ["C3D", "DC3D", "AC3D", "CIN3D", "EC3D"];
const IDLE: [&str; 24] = [
    "SPRING", "DASHPOT", "MASS", "ROTARYI", "GAP", "CONN", "GAPUNI", "B2", "B3", "PIPE", "T2D", "T3D", "R2D2", "R3D",
    "RAX2", "SAX", "MAX", "SFM", "DCOUP", "UNI", "DISTC", "ITS", "RB", "U",
];

/// The family of elements called `name`.
pub(super) fn family(name: &str) -> Family {
    let name = name.trim().to_ascii_uppercase();
    if SPACE.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Space;
    }
    if IDLE.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Idle;
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
        for name in ["SPRING1", "B21", "T2D2", "MASS", "CONN2D2", "R2D2", "GAPUNI"] {
            assert_eq!(family(name), Family::Idle, "{name}");
        }
        for name in ["", "CPE", "CPX4", "CPE7"] {
            assert_eq!(family(name), Family::Unknown, "{name}");
        }
    }
}
