//! Cells that lie over one another.
//!
//! Cells that are consistent along every edge can still overlap: by winding twice around a vertex, where two stretches
//! of boundary cross, or with one piece inside another. The three tests together need only vertices and boundary.

use std::f64::consts::TAU;

use crate::mesh::Triangulation;
use crate::mesh::error::{MeshError, at};
use crate::mesh::topology::boxes::{BoxTree, around};
use crate::mesh::topology::labels::contact_names;
use crate::scene::Scene;
use crate::vector::{cross, minus};

/// Part of the shorter edge by which the ends of one edge must lie on either side of another to cross it. What touches
/// within this distance is left to the gluing of contact sides.
const TOUCH: f64 = 1e-6;

pub(in crate::mesh) fn check(mesh: &Triangulation, scene: &Scene) -> Result<(), MeshError> {
    let place = winding(mesh).or_else(|| {
        let boundary: Vec<usize> = (0..mesh.edges.len()).filter(|&e| mesh.edges[e].is_boundary()).collect();
        crossing(mesh, scene, &boundary).or_else(|| inclusion(mesh, &boundary))
    });
    match place {
        None => Ok(()),
        Some(place) => Err(MeshError::cells(
            scene,
            format!("triangles overlap at {}", at(scene, place)),
            "bodies may touch but not overlap: correct the geometry and mesh it again",
        )),
    }
}

/// A vertex around which the angles add up to more than a full turn.
fn winding(mesh: &Triangulation) -> Option<[f64; 2]> {
    let mut angle = vec![0.0; mesh.points.len()];
    for t in 0..mesh.triangles.len() {
        let p = mesh.corners(t);
        for i in 0..3 {
            let (u, v) = (minus(p[(i + 1) % 3], p[i]), minus(p[(i + 2) % 3], p[i]));
            angle[mesh.triangles[t][i]] += cross(u, v).atan2(u[0] * v[0] + u[1] * v[1]);
        }
    }
    angle.iter().position(|&a| a > TAU + 1e-6).map(|v| mesh.points[v])
}

/// The middle of a boundary edge that another one crosses. Two contact sides may cross by the sag of a coarser
/// polyline; gluing judges them.
fn crossing(mesh: &Triangulation, scene: &Scene, boundary: &[usize]) -> Option<[f64; 2]> {
    let sides = contact_names(scene);
    let in_contact = |e: usize| mesh.edges[e].name.is_some_and(|n| sides.contains(&mesh.names[n].as_str()));
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let tree = BoxTree::new(boundary.iter().map(|&e| around(&ends(e), 0.0)).collect());
    for (i, &e) in boundary.iter().enumerate() {
        let [a, b] = ends(e);
        for j in tree.meeting(&around(&[a, b], 0.0)).into_iter().filter(|&j| j > i) {
            let f = boundary[j];
            let other = ends(f);
            if cross_over([a, b], other, TOUCH) && !(in_contact(e) && in_contact(f)) {
                return Some([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
            }
        }
    }
    None
}

/// True if two segments cross, with the ends of each clearly on either side of the other: by more than `touch` times
/// the length of the shorter one.
pub(in crate::mesh) fn cross_over(one: [[f64; 2]; 2], other: [[f64; 2]; 2], touch: f64) -> bool {
    let [u, v] = [one, other].map(|[a, b]| minus(b, a));
    let [lu, lv] = [u, v].map(|d| d[0].hypot(d[1]));
    let astride = |line: [[f64; 2]; 2], along: [f64; 2], length: f64, ends: [[f64; 2]; 2]| {
        let [s, t] = ends.map(|p| cross(along, minus(p, line[0])));
        let clear = touch * length * lu.min(lv);
        s.min(t) < -clear && s.max(t) > clear
    };
    astride(one, u, lu, other) && astride(other, v, lv, one)
}

/// The centroid of a triangle at the boundary that lies inside the boundary twice.
fn inclusion(mesh: &Triangulation, boundary: &[usize]) -> Option<[f64; 2]> {
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let tree = BoxTree::new(boundary.iter().map(|&e| around(&ends(e), 0.0)).collect());
    let centroids = boundary.iter().filter_map(|&e| mesh.edges[e].triangles[0]).map(|t| {
        let [a, b, c] = mesh.corners(t);
        [(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0]
    });
    centroids.into_iter().find(|p| {
        // Winding number of the boundary by the edges that a ray to the right meets.
        let layers: i32 = tree
            .meeting(&[*p, [f64::INFINITY, p[1]]])
            .into_iter()
            .map(|i| {
                let [a, b] = ends(boundary[i]);
                let left = cross(minus(b, a), minus(*p, a)) > 0.0;
                match (a[1] <= p[1], b[1] <= p[1]) {
                    (true, false) if left => 1,
                    (false, true) if !left => -1,
                    _ => 0,
                }
            })
            .sum();
        layers > 1
    })
}
