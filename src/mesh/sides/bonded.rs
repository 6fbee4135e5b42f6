//! The two sides of a bond become one: triangles on both share its vertices.

use std::collections::HashMap;

use super::polyline::key;
use crate::mesh::error::at;
use crate::mesh::{MeshError, Triangulation};
use crate::scene::{Joint, Scene};
use crate::sets::DisjointSets;

/// Closes the bonds of `scene`, whose sides match vertex for vertex. Returns the number that each vertex has afterwards, too.
///
/// # Errors
/// [`MeshError::Contact`] with an edge of one side that has none of the other opposite.
pub(in crate::mesh) fn bond(mesh: Triangulation, scene: &Scene) -> Result<(Triangulation, Vec<usize>), MeshError> {
    let mut sets = DisjointSets::new(mesh.points.len());
    let mut closed = Vec::new();
    for bond in scene.bonds.iter().filter(|bond| bond.stiffness.is_none()) {
        for [e, f] in opposite(&mesh, scene, bond.joint())? {
            let ([a, b], [c, d]) = (mesh.edges[e].vertices, mesh.edges[f].vertices);
            sets.join(a, d);
            sets.join(b, c);
            closed.extend([e, f]);
        }
    }
    if closed.is_empty() {
        let same = (0..mesh.points.len()).collect();
        return Ok((mesh, same));
    }
    let (now, count) = sets.labels();
    let mut points = vec![[0.0; 2]; count];
    // The first of several stays, as its number does.
    for (v, point) in mesh.points.iter().enumerate().rev() {
        points[now[v]] = *point;
    }
    let triangles: Vec<[usize; 3]> = mesh.triangles.iter().map(|corners| corners.map(|v| now[v])).collect();
    if let Some(t) = triangles.iter().position(|[a, b, c]| a == b || b == c || c == a) {
        let [x, y, z] = mesh.corners(t).map(|p| at(scene, p));
        let what = format!("the triangle {x}, {y}, {z} has both sides of a bond");
        return Err(MeshError::cells(
            scene,
            what,
            "the sides of a bond belong to different triangles: correct the names",
        ));
    }
    let mut label = mesh.label();
    for e in closed {
        let [a, b] = mesh.edges[e].vertices;
        label.remove(&crate::mesh::topology::labels::pair(a, b));
    }
    let label =
        label.into_iter().map(|([a, b], name)| (crate::mesh::topology::labels::pair(now[a], now[b]), name)).collect();
    let mut bonded = Triangulation::connect(points, triangles, mesh.body, mesh.names, &label);
    bonded.cells = mesh.cells;
    Ok((bonded, now))
}

/// The edges of the first side, each with that of the second that it coincides with.
///
/// # Errors
/// [`MeshError::Contact`] with an edge of one side that has none of the other opposite.
pub(crate) fn opposite(mesh: &Triangulation, scene: &Scene, joint: Joint) -> Result<Vec<[usize; 2]>, MeshError> {
    let ends = |e: usize| mesh.edges[e].vertices.map(|v| mesh.points[v]);
    let [first, second] = joint.sides;
    let mut facing: HashMap<_, usize> = mesh.boundary(second).into_iter().map(|e| (ends(e).map(key), e)).collect();
    let fault = |what: String, remedy: &str| MeshError::contact(scene, joint.quoted(), what, remedy);
    let lone = |e: usize, other: &str| {
        let [a, b] = ends(e).map(|p| at(scene, p));
        fault(format!("'{other}' has no edge opposite {a} to {b}"), "make the two sides coincide")
    };
    let mut pairs = Vec::new();
    for e in mesh.boundary(first) {
        let [a, b] = ends(e);
        match facing.remove(&[key(b), key(a)]) {
            Some(f) => pairs.push([e, f]),
            None if facing.contains_key(&[key(a), key(b)]) => {
                let what = format!("both bodies lie on the same side of the edge {} to {}", at(scene, a), at(scene, b));
                return Err(fault(what, "the bodies of a bond face each other and do not overlap"));
            }
            // What has nothing opposite along a direction is free.
            None if joint.direction.is_some() => {}
            None => return Err(lone(e, second)),
        }
    }
    match facing.values().min().filter(|_| joint.direction.is_none()) {
        Some(e) => Err(lone(*e, first)),
        None => Ok(pairs),
    }
}
