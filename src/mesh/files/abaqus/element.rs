//! Shapes of cells by the names of Abaqus and CalculiX elements.

use super::Kind;
use crate::scene::Kinematics;

/// Treatment of the elements of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    /// A cell of the mesh, with so many nodes.
    Plane(Kind, usize),
    /// The same, whose sides are counted behind its two faces.
    Shell(Kind, usize),
    /// A cell that is rigid, unless a deck has no others: there the type is what a program writes for want of a better one.
    Rigid(Kind, usize),
    /// No part of the mesh: springs, masses, connectors.
    Idle,
    /// A user's element or a surface, whose shape nobody knows.
    Shapeless,
    /// A cell in space.
    Space,
    /// A name that is not known.
    Unknown,
}

const PLANE: [&str; 8] = ["CPEG", "CPE", "CPS", "CGAX", "CAX", "DC2D", "DCAX", "WARP2D"];
const SHELL: [&str; 3] = ["M3D", "STRI", "S"];
const SPACE: [&str; 8] = ["C3D", "DC3D", "AC3D", "CIN3D", "EC3D", "SC6", "SC8", "CSS8"];
/// Trusses, beams, shells of revolution, rigid and surface lines, with the number of their nodes behind.
const LINE: [&str; 14] =
    ["B2", "B3", "PIPE2", "PIPE3", "T2D", "T3D", "R2D", "RAX", "SAX", "MAX", "SFMAX", "RB2D", "RB3D", "F2D"];
/// Springs, masses, connectors and joints, layers of glue and gaskets, infinite cells, networks of fluid.
const IDLE: [&str; 32] = [
    "SPRING", "DASHPOT", "MASS", "ROTARYI", "GAP", "CONN", "DCOUP", "UNI", "DISTC", "ITS", "ELBOW", "COH", "JOINT",
    "CINPE", "CINPS", "CINAX", "ACIN", "GK2D", "GKPE", "GKPS", "GKAX", "GK3D", "DRAG", "PSI", "HEATCAP", "FRAME",
    "DC1D", "INTER", "DINTER", "ISL", "IRS", "SFMGAX",
];
/// Elements of users, and surfaces.
const SHAPELESS: [&str; 2] = ["SFM3D", "U"];
/// The networks of fluid of CalculiX, and line springs: names that others begin with.
const IDLE_ALONE: [&str; 3] = ["D", "LS3S", "LS6"];

/// The family of elements called `name`.
pub(super) fn family(name: &str) -> Family {
    let name = name.trim().to_ascii_uppercase();
    if SPACE.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Space;
    }
    if IDLE.iter().any(|prefix| name.starts_with(prefix)) || IDLE_ALONE.contains(&name.as_str()) {
        return Family::Idle;
    }
    if SHAPELESS.iter().any(|prefix| name.starts_with(prefix)) {
        return Family::Shapeless;
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
    match (shape(&name, &PLANE), shape(&name, &SHELL)) {
        (Some((kind, nodes)), _) => Family::Plane(kind, nodes),
        (None, Some((kind, nodes))) => Family::Shell(kind, nodes),
        (None, None) => Family::Unknown,
    }
}

/// The kinematics that elements called `name` are made for, where it says so.
pub(super) fn made_for(name: &str) -> Option<Kinematics> {
    let name = name.trim().to_ascii_uppercase();
    let of = [
        ("CPE", Kinematics::PlaneStrain),
        ("CPS", Kinematics::PlaneStress),
        ("CAX", Kinematics::Axisymmetric),
        ("CGAX", Kinematics::Axisymmetric),
    ];
    let found = of.into_iter().find(|(prefix, _)| shape(&name, &[prefix]).is_some());
    found.map(|(_, kinematics)| kinematics)
}

/// Shape and number of nodes behind one of the `prefixes`: the first figure, as in CPS4R, S8R5, and STRI65, a triangle with six.
fn shape(name: &str, prefixes: &[&str]) -> Option<(Kind, usize)> {
    let rest = prefixes.iter().find_map(|prefix| {
        let rest = name.strip_prefix(prefix)?;
        rest.starts_with(|c: char| c.is_ascii_digit()).then_some(rest)
    });
    Some(match rest?.chars().next()? {
        '3' => (Kind::Triangle, 3),
        '4' => (Kind::Quadrilateral, 4),
        '6' => (Kind::Triangle, 6),
        '8' => (Kind::Quadrilateral, 8),
        '9' => (Kind::Quadrilateral, 9),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plane_elements_of_any_integration_are_cells() {
        for (names, kind, nodes) in [
            ("CPE3 CPS3 CAX3 CPEG3 cps3 CPE3H DC2D3", Kind::Triangle, 3),
            ("CPE4 CPE4R CPS4I CPE4RH CAX4R CPEG4", Kind::Quadrilateral, 4),
            ("CPE6 CPE6M CPS6 CAX6 CPE6MH", Kind::Triangle, 6),
            ("CPE8 CPE8R CPS8R CAX8 CPE8RH", Kind::Quadrilateral, 8),
        ] {
            for name in names.split(' ') {
                assert_eq!(family(name), Family::Plane(kind, nodes), "{name}");
            }
        }
        for (names, kind, nodes) in [
            ("S3 S3R M3D3", Kind::Triangle, 3),
            ("S4 S4R5 M3D4R", Kind::Quadrilateral, 4),
            ("STRI65 S6", Kind::Triangle, 6),
            ("S8R5 S8 S8R", Kind::Quadrilateral, 8),
            ("S9R5 M3D9", Kind::Quadrilateral, 9),
        ] {
            for name in names.split(' ') {
                assert_eq!(family(name), Family::Shell(kind, nodes), "{name}");
            }
        }
        for name in ["C3D8R", "SC8R", "sc6r", "CIN3D8"] {
            assert_eq!(family(name), Family::Space, "{name}");
        }
        assert_eq!(family("R3D4"), Family::Rigid(Kind::Quadrilateral, 4));
        for (names, nodes) in
            [("B21 B21H B31 T2D2 T3D2 R2D2 RAX2 SAX1 MAX1 PIPE21", 2), ("B22 B32 B32R T3D3 T2D3 SAX2", 3)]
        {
            for name in names.split(' ') {
                assert_eq!(family(name), Family::Plane(Kind::Line, nodes), "{name}");
            }
        }
        for name in
            ["SPRING1", "MASS", "CONN2D2", "GAPUNI", "D", "COH2D4", "COHAX4", "JOINT2D", "CINPE4", "CINAX5R", "GKPS4"]
        {
            assert_eq!(family(name), Family::Idle, "{name}");
        }
        for name in ["U1", "u12", "SFM3D4R"] {
            assert_eq!(family(name), Family::Shapeless, "{name}");
        }
        for name in ["", "CPE", "CPX4", "CPE7", "DX4", "SX8"] {
            assert_eq!(family(name), Family::Unknown, "{name}");
        }
    }
}
