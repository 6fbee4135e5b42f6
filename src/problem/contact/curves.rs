//! Which edges stand for arcs of circles, so that refining puts new vertices on these.

use crate::mesh::Curved;
use crate::problem::{Condition, ContactPair, Note, Problem, Refinement};
use crate::scene::{Circle, FrictionBound, Gap, MeshSource, Normals, Scene, counted};

/// Part of the radius within which vertices of a contact lie on a circle.
const ON_CIRCLE: f64 = 1e-6;
/// Part of the radius within which vertices that were put on an arc of the scene lie on its circle.
const ON_ARC: f64 = 1e-9;
/// Directions of contact of two edges that differ by less meet without a corner.
const NO_CORNER: f64 = 1e-9;
/// Part of the radius by which the circles of two edges may differ, and are one.
const SAME_CIRCLE: f64 = 1e-5;
/// An edge that is longer than another of its circle by this factor was not divided with it.
const LONGER: f64 = 1.5;
/// Part of the height of a triangle by which its side may be moved.
const ROOM: f64 = 0.3;

/// The circles of all edges that stand for an arc: of those in `[geometry]`, and of contact sides of which three edges in
/// a row have their vertices on a circle. A contact with a gap along the arc length, or with a direction, keeps its edges.
pub(in crate::problem) fn curved(problem: &Problem) -> Curved {
    let mut found = Curved::default();
    if problem.refinement == Refinement::KeepsEdges {
        return found;
    }
    arcs(problem, &mut found);
    for (interface, contact) in problem.interfaces.iter().zip(&problem.scene.contacts) {
        let pairs = &interface.pairs;
        let stays = contact.normals == Normals::Facets
            || contact.direction.is_some()
            || contact.obstacle.is_some()
            || matches!(contact.friction, Some(FrictionBound::Table(_)))
            || !matches!(contact.gap, Gap::Constant(_));
        if stays {
            continue;
        }
        for (k, pair) in pairs.iter().enumerate() {
            let sides = pair.edges.iter().enumerate().filter_map(|(side, edge)| Some((side, (*edge)?)));
            let on_circles = sides.map(|(side, e)| Some((e, around(problem, pairs, k, side)?)));
            let Some(edges) = on_circles.collect::<Option<Vec<(usize, Circle)>>>() else { continue };
            if edges.iter().all(|(e, circle)| has_room(problem, *e, circle)) {
                found.extend(edges);
            }
        }
    }
    found
}

/// The first contact whose direction turns along an edge that stands for no circle: from the normals of the mesh that was
/// made, and another field on a finer one.
pub(in crate::problem) fn turned_by_the_mesh(problem: &Problem) -> Option<usize> {
    let on_circles = curved(problem);
    let from_the_mesh = |index: &usize| problem.scene.contacts[*index].obstacle.is_none();
    (0..problem.interfaces.len()).filter(from_the_mesh).find(|&index| {
        let interface = &problem.interfaces[index];
        let turns = |pair: &&ContactPair| !pair.direction.is_constant();
        let follows = |pair: &ContactPair| pair.edges.iter().flatten().all(|e| on_circles.contains_key(e));
        interface.pairs.iter().filter(turns).any(|pair| !follows(pair))
    })
}

/// The triangles at edges of a circle that are longer than others of it.
pub(in crate::problem) fn beside_long_edges(problem: &Problem) -> Vec<usize> {
    let mesh = &problem.mesh;
    let length = |e: usize| mesh.edge_frame(e).0;
    let mut edges: Vec<(usize, Circle)> = curved(problem).into_iter().collect();
    edges.sort_unstable_by_key(|(e, _)| *e);
    let mut circles: Vec<(Circle, f64)> = Vec::new();
    let same = |a: &Circle, b: &Circle| {
        let apart = (a.centre[0] - b.centre[0]).hypot(a.centre[1] - b.centre[1]) + (a.radius - b.radius).abs();
        apart <= SAME_CIRCLE * a.radius
    };
    for (e, circle) in &edges {
        match circles.iter_mut().find(|(other, _)| same(other, circle)) {
            Some((_, shortest)) => *shortest = shortest.min(length(*e)),
            None => circles.push((*circle, length(*e))),
        }
    }
    let is_long = |e: usize, circle: &Circle| {
        circles.iter().any(|(other, shortest)| same(other, circle) && length(e) > LONGER * shortest)
    };
    let long = edges.iter().filter(|(e, circle)| is_long(*e, circle));
    let mut triangles: Vec<usize> = long.flat_map(|(e, _)| mesh.edges[*e].triangles.into_iter().flatten()).collect();
    triangles.sort_unstable();
    triangles.dedup();
    triangles
}

/// The circle of pair `k` on one of its sides: through the vertices of three pairs in a row, of which it is one.
fn around(problem: &Problem, pairs: &[ContactPair], k: usize, side: usize) -> Option<Circle> {
    if pairs[k].direction.is_constant() {
        return None;
    }
    let point = |v: usize| problem.mesh.points[v];
    (k.saturating_sub(2)..=k).find_map(|from| {
        let [a, b, c] = pairs.get(from..from + 3)? else { return None };
        let [p, q, r] = [a, b, c].map(|pair| if side == 0 { Some(pair.first) } else { pair.second });
        let [p, q, r] = [p?, q?, r?];
        let joined = p[1] == q[0] && q[1] == r[0];
        let apart = |[x, y]: [f64; 2], [u, v]: [f64; 2]| (x - u).hypot(y - v);
        let smooth = [(a, b), (b, c)].iter().all(|(p, q)| apart(p.direction.ends[1], q.direction.ends[0]) < NO_CORNER);
        let circle = Circle::through(point(p[0]), point(q[0]), point(r[1]))?;
        (joined && smooth && circle.holds(point(q[1]), ON_CIRCLE)).then_some(circle)
    })
}

/// Boundary edges between two vertices on an arc of the scene that carries their name.
fn arcs(problem: &Problem, found: &mut Curved) {
    let arcs = scene_arcs(&problem.scene);
    if arcs.is_empty() {
        return;
    }
    let mesh = &problem.mesh;
    for (e, edge) in mesh.edges.iter().enumerate().filter(|(_, edge)| edge.is_boundary()) {
        let name = edge.name.map_or("", |n| mesh.names[n].as_str());
        let [a, b] = edge.vertices.map(|v| mesh.points[v]);
        let stands_for = |(own, circle, corners): &&(&str, Circle, [[f64; 2]; 2])| {
            *own == name
                && circle.holds(a, ON_ARC)
                && circle.holds(b, ON_ARC)
                // A chord from corner to corner is an edge of its own.
                && *corners != [a, b]
                && *corners != [b, a]
                && has_room(problem, e, circle)
        };
        let keeps = match problem.conditions[e] {
            Condition::Contact { interface, .. } => problem.scene.contacts[interface].obstacle.is_none(),
            Condition::Interior => true,
            _ => false,
        };
        if keeps {
            continue;
        }
        if let Some((_, circle, _)) = arcs.iter().find(stands_for) {
            found.insert(e, *circle);
        }
    }
}

/// Puts the remark on arcs of the outline in place of that of a coarser mesh, which stands where edges are kept.
pub(in crate::problem) fn remark(problem: &mut Problem) {
    const BEGINS: &str = "arcs of [geometry]: ";
    let mut found = Curved::default();
    arcs(problem, &mut found);
    let farthest = found.iter().map(|(e, circle)| beside(problem, *e, circle)).fold(0.0, f64::max);
    if farthest == 0.0 {
        return;
    }
    let edges = counted(found.len(), "edge");
    let stand = if found.len() == 1 { "stands" } else { "stand" };
    let text = format!(
        "{BEGINS}{edges} {stand} for them, up to {farthest:.1e} beside. The bounds are for the outline of straight edges; refinement puts \
         its vertices on the arcs"
    );
    problem.notes.retain(|note| !note.text.starts_with(BEGINS));
    problem.notes.push(Note { weakens_guarantee: false, text });
}

/// Name, circle and ends of the arcs in `[geometry]`.
fn scene_arcs(scene: &Scene) -> Vec<(&str, Circle, [[f64; 2]; 2])> {
    let MeshSource::Geometry { polygons, .. } = &scene.mesh else { return Vec::new() };
    let all = polygons.iter().flat_map(|polygon| {
        polygon.arcs.iter().filter_map(move |arc| {
            let ends = [arc.edge, (arc.edge + 1) % polygon.points.len()].map(|i| polygon.points[i]);
            let circle = Circle::through(ends[0], arc.through, ends[1])?;
            Some((polygon.edges[arc.edge].as_str(), circle, ends))
        })
    });
    all.collect()
}

/// The distance of the middle of an edge from the circle.
fn beside(problem: &Problem, e: usize, circle: &Circle) -> f64 {
    let [a, b] = problem.mesh.edges[e].vertices.map(|v| problem.mesh.points[v]);
    let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let to = circle.nearest(middle);
    (to[0] - middle[0]).hypot(to[1] - middle[1])
}

/// True if the triangles at an edge stay well shaped when its midpoint moves onto the circle.
fn has_room(problem: &Problem, e: usize, circle: &Circle) -> bool {
    let (mesh, moved) = (&problem.mesh, beside(problem, e, circle));
    let (length, _) = mesh.edge_frame(e);
    mesh.edges[e].triangles.iter().flatten().all(|&t| moved <= ROOM * 2.0 * mesh.area(t) / length)
}
