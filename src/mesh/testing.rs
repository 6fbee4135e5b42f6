//! Scenes and properties for the tests of this module and its users.

use std::collections::HashMap;

use super::{RawMesh, Triangulation};
use crate::scene::{
    Body, Contact, ContactSides, Draft, Gap, Kinematics, Load, MeshSource, Polygon, Scene, Support, SupportKind,
    Traction,
};

/// A scene with the named bodies, without conditions, whose mesh is meant to come from a file.
pub(crate) fn scene(bodies: &[&str]) -> Scene {
    let body = |name: &&str| Body::isotropic(*name, 1.0, 0.3);
    let mesh = MeshSource::File("test.msh".into());
    let bodies = bodies.iter().map(body).collect();
    Scene::unchecked(Draft { bodies, ..Draft::new("test", Kinematics::PlaneStrain, mesh) })
}

pub(crate) fn clamp(mut scene: Scene, on: &str) -> Scene {
    scene.draft.supports.push(Support { on: on.into(), kind: SupportKind::CLAMPED });
    scene
}

pub(crate) fn load(mut scene: Scene, on: &str, load: Load) -> Scene {
    scene.draft.tractions.push(Traction { on: on.into(), load, terms: Vec::new() });
    scene
}

pub(crate) fn contact(mut scene: Scene, first: &str, second: &str, gap: Gap) -> Scene {
    let sides = ContactSides::Between([first.into(), second.into()]);
    scene.draft.contacts.push(Contact::new(sides, gap));
    scene
}

pub(crate) fn geometry(mut scene: Scene, size: Option<f64>, polygons: Vec<Polygon>) -> Scene {
    scene.draft.mesh = MeshSource::Geometry { size, polygons };
    scene
}

/// An axis-parallel rectangle whose edges are called `<body>_bottom`, `_right`, `_top`, `_left`.
pub(crate) fn rectangle(body: &str, lower: [f64; 2], upper: [f64; 2]) -> Polygon {
    Polygon {
        body: body.into(),
        points: vec![lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]],
        edges: ["bottom", "right", "top", "left"].map(|side| format!("{body}_{side}")).into(),
        arcs: Vec::new(),
    }
}

/// The rectangle as a raw mesh of `nx` by `ny` cells, two triangles each, with the same names.
pub(crate) fn grid(body: &str, lower: [f64; 2], upper: [f64; 2], [nx, ny]: [usize; 2]) -> RawMesh {
    let mut raw = RawMesh::default();
    let lerp = |k: usize, i: usize, n: usize| lower[k] + (upper[k] - lower[k]) * (i as f64 / n as f64);
    for j in 0..=ny {
        raw.points.extend((0..=nx).map(|i| [lerp(0, i, nx), lerp(1, j, ny)]));
    }
    let v = |i: usize, j: usize| j * (nx + 1) + i;
    for j in 0..ny {
        for i in 0..nx {
            raw.triangles.push(([v(i, j), v(i + 1, j), v(i + 1, j + 1)], body.into()));
            raw.triangles.push(([v(i, j), v(i + 1, j + 1), v(i, j + 1)], body.into()));
        }
    }
    for i in 0..nx {
        raw.segments.push(([v(i, 0), v(i + 1, 0)], format!("{body}_bottom")));
        raw.segments.push(([v(i, ny), v(i + 1, ny)], format!("{body}_top")));
    }
    for j in 0..ny {
        raw.segments.push(([v(0, j), v(0, j + 1)], format!("{body}_left")));
        raw.segments.push(([v(nx, j), v(nx, j + 1)], format!("{body}_right")));
    }
    raw
}

/// Both meshes in one, without shared vertices.
pub(crate) fn both(mut one: RawMesh, other: RawMesh) -> RawMesh {
    let shift = one.points.len();
    one.points.extend(other.points);
    one.triangles.extend(other.triangles.into_iter().map(|(t, name)| (t.map(|v| v + shift), name)));
    one.segments.extend(other.segments.into_iter().map(|(s, name)| (s.map(|v| v + shift), name)));
    one.quadrilaterals.extend(other.quadrilaterals.into_iter().map(|q| q.map(|v| v + shift)));
    one
}

/// Pairs the triangles of a grid as the halves of quadrilaterals.
pub(crate) fn of_quadrilaterals(mut grid: RawMesh) -> RawMesh {
    let pairs = grid.triangles.chunks(2).filter_map(|pair| match pair {
        [([a, b, c], _), ([_, _, d], _)] => Some([*a, *b, *c, *d]),
        _ => None,
    });
    grid.quadrilaterals = pairs.collect();
    grid
}

pub(crate) fn total_area(mesh: &Triangulation) -> f64 {
    (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum()
}

/// V − E + F of the triangles: the number of discs minus the number of holes in them.
pub(crate) fn euler(mesh: &Triangulation) -> i64 {
    mesh.points.len() as i64 - mesh.edges.len() as i64 + mesh.triangles.len() as i64
}

/// Length of the boundary by name.
pub(crate) fn lengths(mesh: &Triangulation) -> HashMap<String, f64> {
    let mut lengths = HashMap::new();
    for (e, edge) in mesh.edges.iter().enumerate() {
        if let Some(name) = edge.name {
            *lengths.entry(mesh.names[name].clone()).or_insert(0.0) += mesh.edge_frame(e).0;
        }
    }
    lengths
}

/// The smallest angle, in degrees.
pub(crate) fn smallest_angle(mesh: &Triangulation) -> f64 {
    let angle = |t: usize| {
        let p = mesh.corners(t);
        let at = |i: usize| {
            let [u, v] = [1, 2].map(|k| [0, 1].map(|d| p[(i + k) % 3][d] - p[i][d]));
            (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).to_degrees()
        };
        (0..3).map(at).fold(f64::INFINITY, f64::min)
    };
    (0..mesh.triangles.len()).map(angle).fold(f64::INFINITY, f64::min)
}

/// Asserts the invariants of a triangulation: counter-clockwise cells, edges that agree with them, no loose vertex.
pub(crate) fn assert_consistent(mesh: &Triangulation) {
    let mut met = vec![false; mesh.points.len()];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        assert!(mesh.area(t) > 0.0, "triangle {t}");
        for i in 0..3 {
            met[corners[i]] = true;
            let edge = &mesh.edges[mesh.triangle_edges[t][i]];
            let ends = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
            let expected =
                if edge.triangles[0] == Some(t) { edge.vertices } else { [edge.vertices[1], edge.vertices[0]] };
            assert_eq!(ends, expected);
            assert!(edge.triangles.contains(&Some(t)));
        }
    }
    assert!(met.iter().all(|m| *m), "a vertex without a triangle");
    let counted: usize = mesh.edges.iter().map(|e| e.triangles.iter().flatten().count()).sum();
    assert_eq!(counted, 3 * mesh.triangles.len());
    assert!(mesh.edges.iter().all(|e| e.is_boundary() || e.name.is_none()));
}

/// The (directed) edges of a boundary as coordinates, sorted.
pub(crate) fn side(mesh: &Triangulation, name: &str, turned: bool) -> Vec<[[u64; 2]; 2]> {
    let ends = |e: usize| {
        let [a, b] = mesh.edges[e].vertices.map(|v| mesh.points[v].map(f64::to_bits));
        if turned { [b, a] } else { [a, b] }
    };
    let mut edges: Vec<_> = mesh.boundary(name).into_iter().map(ends).collect();
    edges.sort_unstable();
    edges
}
