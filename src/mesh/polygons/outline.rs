//! The divided boundaries of the polygons, equal bit for bit where two of them touch.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::grade::grade;
use crate::mesh::cells::overlap::cross_over;
use crate::mesh::error::at;
use crate::mesh::sides::polyline::{chain, inner_points, key};
use crate::mesh::topology::boxes::{BoxTree, around};
use crate::scene::{Circle, Polygon, Scene};

/// Part of the size of the whole geometry within which two corners are the same, or a corner lies on an edge.
const CLOSE: f64 = 1e-9;

/// A piece of the boundary, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Piece {
    /// From, to.
    pub ends: [[f64; 2]; 2],
    /// Name of the edge it comes from.
    pub name: String,
}

/// Index of the polygon at fault; what was found, and the remedy.
type Fault = (usize, (String, String));

/// The boundary pieces of every polygon, no longer than `size`.
pub(super) fn divide(scene: &Scene, polygons: &[Polygon], size: Option<f64>) -> Result<Vec<Vec<Piece>>, Fault> {
    for (number, polygon) in polygons.iter().enumerate() {
        well_formed(scene, polygon).map_err(|text| (number, text))?;
    }
    let drawn = polygons;
    let polygons: Vec<Polygon> = polygons.iter().map(|polygon| faceted(polygon, size)).collect();
    let polygons = polygons.as_slice();
    let every: Vec<[f64; 2]> = polygons.iter().flat_map(|p| p.points.iter().copied()).collect();
    let bounds = around(&every, 0.0);
    let close = CLOSE * (bounds[1][0] - bounds[0][0]).max(bounds[1][1] - bounds[0][1]);
    let mut outlines = snapped(scene, polygons, close)?;
    insert_touching(scene, &mut outlines, close)?;
    check_overlap(scene, &outlines, polygons)?;
    insert_breaks(&mut outlines, scene);
    let length: f64 = outlines.iter().flatten().map(|p| distance(p.ends)).sum();
    if let Some(size) = size {
        let affordable = length / size <= super::fill::MOST;
        if !affordable {
            let what = format!("would need about {:.1e} boundary vertices at geometry.size = {size}", length / size);
            return Err((0, (what, "choose a larger size".into())));
        }
        for outline in &mut outlines {
            *outline = outline.iter().flat_map(|piece| subdivided(piece, size)).collect();
        }
    } else {
        grade(&mut outlines, scene, drawn);
    }
    divide_short_cuts(&mut outlines, drawn);
    Ok(outlines)
}

/// Divides every cut inside a body that is one edge long: its sides share both ends, and without a vertex between them they would be one.
fn divide_short_cuts(outlines: &mut [Vec<Piece>], polygons: &[Polygon]) {
    type Key = [[u64; 2]; 2];
    let mut all: HashMap<Key, (&str, bool)> = HashMap::new();
    for (outline, polygon) in outlines.iter().zip(polygons) {
        all.extend(outline.iter().map(|p| (p.ends.map(key), (polygon.body.as_str(), !p.name.is_empty()))));
    }
    // Edges that two polygons of one body name, and points of the outline of what all polygons cover.
    let is_cut = |[a, b]: Key| match (all.get(&[a, b]), all.get(&[b, a])) {
        (Some((body, named)), Some((other, also))) => body == other && *named && *also,
        _ => false,
    };
    let mut ends: HashMap<[u64; 2], usize> = HashMap::new();
    for [a, b] in all.keys().copied() {
        let outside = !all.contains_key(&[b, a]);
        for end in [a, b] {
            *ends.entry(end).or_default() += if outside { 2 } else { usize::from(is_cut([a, b])) };
        }
    }
    // Both sides of a cut count at each of its ends.
    let alone = |ends_of: Key| is_cut(ends_of) && ends_of.iter().all(|end| ends.get(end) == Some(&2));
    let short: Vec<Vec<(usize, [f64; 2])>> = outlines
        .iter()
        .map(|outline| {
            let middle = |[a, b]: [[f64; 2]; 2]| [0, 1].map(|c| 0.5 * (a[c] + b[c]));
            let of = outline.iter().enumerate().filter(|(_, piece)| alone(piece.ends.map(key)));
            of.map(|(i, piece)| (i, middle(piece.ends))).collect()
        })
        .collect();
    for (outline, points) in outlines.iter_mut().zip(short) {
        insert(outline, points);
    }
}

/// The polygon with facets in place of its arcs: equal ones, no longer than `size`, and three at least, which tell a contact its circle.
fn faceted(polygon: &Polygon, size: Option<f64>) -> Polygon {
    let mut all = Polygon { points: Vec::new(), edges: Vec::new(), arcs: Vec::new(), ..polygon.clone() };
    for (i, (start, name)) in polygon.points.iter().zip(&polygon.edges).enumerate() {
        all.points.push(*start);
        all.edges.push(name.clone());
        let Some(arc) = polygon.arcs.iter().find(|arc| arc.edge == i) else { continue };
        let end = polygon.points[(i + 1) % polygon.points.len()];
        let Some(circle) = Circle::through(*start, arc.through, end) else { continue };
        let angle = |p: [f64; 2]| (p[1] - circle.centre[1]).atan2(p[0] - circle.centre[0]);
        let [from, by, to] = [*start, arc.through, end].map(angle);
        let ahead = |a: f64| (a - from).rem_euclid(TAU);
        // Counter-clockwise where that meets the point between first.
        let sweep = if ahead(by) < ahead(to) { ahead(to) } else { ahead(to) - TAU };
        let longest = size.map_or(f64::INFINITY, |size| 2.0 * (0.5 * size / circle.radius).min(1.0).asin());
        let count = (sweep.abs() / longest.min(LARGEST) * (1.0 - CLOSE)).ceil().clamp(3.0, MOST_FACETS) as usize;
        for k in 1..count {
            let (sine, cosine) = (from + sweep * (k as f64 / count as f64)).sin_cos();
            let [x, y] = circle.centre;
            all.points.push([x + circle.radius * cosine, y + circle.radius * sine]);
            all.edges.push(name.clone());
        }
    }
    all
}

/// Largest angle of a facet: where the edges of a curve turn by 30° and more they would be taken for corners.
const LARGEST: f64 = TAU / 24.0;
/// No arc has more facets, whatever its size.
const MOST_FACETS: f64 = 1e6;

fn well_formed(scene: &Scene, polygon: &Polygon) -> Result<(), (String, String)> {
    let (corners, names) = (polygon.points.len(), polygon.edges.len());
    if corners < 3 {
        return Err((format!("has {corners} points"), "give at least three".into()));
    }
    if names != corners {
        let what = format!("has {corners} points and {names} edge names");
        return Err((what, "name every edge; \"\" for one without a name".into()));
    }
    match polygon.points.iter().find(|p| !p.iter().all(|x| x.is_finite())) {
        Some(p) => Err((format!("has the point {}, which is not finite", at(scene, *p)), "correct it".into())),
        None => Ok(()),
    }
}

/// Counter-clockwise outlines; corners that are equal up to round-off get the coordinates of the first of them.
fn snapped(scene: &Scene, polygons: &[Polygon], close: f64) -> Result<Vec<Vec<Piece>>, Fault> {
    let every: Vec<[f64; 2]> = polygons.iter().flat_map(|p| p.points.iter().map(|p| p.map(|x| x + 0.0))).collect();
    let tree = BoxTree::new(every.iter().map(|p| [*p, *p]).collect());
    let first_near = |i: usize| {
        let near = tree.meeting(&around(&[every[i]], close));
        near.into_iter().find(|&j| distance([every[i], every[j]]) <= close).unwrap_or(i)
    };
    let mut start = 0;
    let mut outlines = Vec::new();
    for (number, polygon) in polygons.iter().enumerate() {
        let count = polygon.points.len();
        let corners: Vec<[f64; 2]> = (start..start + count).map(|i| every[first_near(i)]).collect();
        start += count;
        let mut sorted: Vec<_> = corners.iter().map(|p| key(*p)).collect();
        sorted.sort_unstable();
        if let Some(twice) = sorted.windows(2).find(|w| w[0] == w[1]) {
            let what = format!("has the corner {} twice", at(scene, twice[0].map(f64::from_bits)));
            return Err((number, (what, "a polygon passes every corner once".into())));
        }
        let piece = |i: usize, j: usize, name: usize| Piece {
            ends: [corners[i], corners[j]],
            name: polygon.edges[name].clone(),
        };
        let double_area: f64 = (1..count - 1)
            .map(|i| {
                let [a, b, c] = [corners[0], corners[i], corners[i + 1]];
                (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
            })
            .sum();
        outlines.push(if double_area > 0.0 {
            (0..count).map(|i| piece(i, (i + 1) % count, i)).collect()
        } else {
            (0..count).rev().map(|i| piece((i + 1) % count, i, i)).collect()
        });
    }
    Ok(outlines)
}

/// Puts every corner that lies on an edge of another polygon into that edge.
fn insert_touching(scene: &Scene, outlines: &mut [Vec<Piece>], close: f64) -> Result<(), Fault> {
    let corners: Vec<(usize, [f64; 2])> =
        outlines.iter().enumerate().flat_map(|(n, outline)| outline.iter().map(move |p| (n, p.ends[0]))).collect();
    let tree = BoxTree::new(corners.iter().map(|(_, p)| [*p, *p]).collect());
    for (number, outline) in outlines.iter_mut().enumerate() {
        let mut inserted = Vec::new();
        for (i, piece) in outline.iter().enumerate() {
            for j in tree.meeting(&around(&piece.ends, close)) {
                let (owner, corner) = corners[j];
                if !on(corner, piece.ends, close) {
                    continue;
                }
                if owner == number {
                    let [a, b] = piece.ends.map(|p| at(scene, p));
                    let what = format!("touches itself: the corner {} lies on the edge {a} to {b}", at(scene, corner));
                    return Err((number, (what, "give a simple polygon".into())));
                }
                inserted.push((i, corner));
            }
        }
        insert(outline, inserted);
    }
    Ok(())
}

/// True if `p` lies on the edge and apart from its ends.
fn on(p: [f64; 2], [a, b]: [[f64; 2]; 2], close: f64) -> bool {
    let length = distance([a, b]);
    let (d, w) = ([(b[0] - a[0]) / length, (b[1] - a[1]) / length], [p[0] - a[0], p[1] - a[1]]);
    let along = w[0] * d[0] + w[1] * d[1];
    (d[0] * w[1] - d[1] * w[0]).abs() <= close && along > close && along < length - close
}

/// Divides pieces of `outline` at points given as (piece, point); a point given twice counts once.
fn insert(outline: &mut Vec<Piece>, points: Vec<(usize, [f64; 2])>) {
    if points.is_empty() {
        return;
    }
    let mut result = Vec::with_capacity(outline.len() + points.len());
    for (i, piece) in outline.iter().enumerate() {
        let mut here: Vec<[f64; 2]> = points.iter().filter(|(j, _)| *j == i).map(|(_, p)| *p).collect();
        here.sort_by(|p, q| distance([piece.ends[0], *p]).total_cmp(&distance([piece.ends[0], *q])));
        here.dedup();
        let mut from = piece.ends[0];
        for to in here.into_iter().chain([piece.ends[1]]) {
            result.push(Piece { ends: [from, to], name: piece.name.clone() });
            from = to;
        }
    }
    *outline = result;
}

/// No edge crosses another one, and no polygon covers a part of another one.
fn check_overlap(scene: &Scene, outlines: &[Vec<Piece>], polygons: &[Polygon]) -> Result<(), Fault> {
    let pieces: Vec<(usize, &Piece)> =
        outlines.iter().enumerate().flat_map(|(n, outline)| outline.iter().map(move |p| (n, p))).collect();
    let tree = BoxTree::new(pieces.iter().map(|(_, p)| around(&p.ends, 0.0)).collect());
    let overlap = |n: usize, m: usize, place: [f64; 2]| {
        let what = format!("overlaps geometry.polygons[{m}] (body '{}') at {}", polygons[m].body, at(scene, place));
        Err((
            n,
            (what, "polygons may touch but not overlap; a hole has to be cut out by two polygons around it. Two sides that stand for \
             one curve need the same points, or `arcs`; where they do not coincide, move them apart and match them along a \
             `direction`, with a negative `gap`"
                .into()),
        ))
    };
    for (i, &(n, piece)) in pieces.iter().enumerate() {
        let [a, b] = piece.ends;
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        for j in tree.meeting(&around(&piece.ends, 0.0)).into_iter().filter(|&j| j > i) {
            let (m, other) = pieces[j];
            if cross_over(piece.ends, other.ends, CLOSE) {
                if n == m {
                    let what = format!("crosses itself near {}", at(scene, middle));
                    return Err((n, (what, "give a simple polygon".into())));
                }
                return overlap(n, m, middle);
            }
            if piece.ends == other.ends {
                return overlap(n, m, middle);
            }
        }
        // Winding number of each other polygon around the middle of the piece; a piece on its outline is not inside.
        let mut winding: Vec<(usize, i32)> = Vec::new();
        for j in tree.meeting(&[middle, [f64::INFINITY, middle[1]]]) {
            let (m, other) = pieces[j];
            let [c, d] = other.ends;
            let side = (d[0] - c[0]) * (middle[1] - c[1]) - (d[1] - c[1]) * (middle[0] - c[0]);
            let turn = match (c[1] <= middle[1], d[1] <= middle[1]) {
                (true, false) if side > 0.0 => 1,
                (false, true) if side < 0.0 => -1,
                _ => 0,
            };
            winding.push((m, turn));
        }
        winding.sort_unstable();
        for group in winding.chunk_by(|x, y| x.0 == y.0) {
            let m = group[0].0;
            let shared = || outlines[m].iter().any(|p| p.ends == [b, a]);
            if m != n && group.iter().map(|g| g.1).sum::<i32>() != 0 && !shared() {
                return overlap(n, m, middle);
            }
        }
    }
    Ok(())
}

/// Puts the break points of gaps and windows into the contact sides, so that the mesh represents both exactly.
fn insert_breaks(outlines: &mut [Vec<Piece>], scene: &Scene) {
    for (index, contact) in scene.contacts.iter().enumerate() {
        let breaks = scene.contact_breaks(index);
        if breaks.is_empty() {
            continue;
        }
        let pieces = outlines.iter().flatten().filter(|p| p.name == contact.first());
        let side: Vec<[[f64; 2]; 2]> = pieces.map(|p| p.ends).collect();
        // A side that branches is reported when the contact is matched.
        let Ok(links) = chain(&side) else { continue };
        let points = inner_points(&side, &links, &breaks);
        for outline in outlines.iter_mut() {
            let here = outline.iter().enumerate().flat_map(|(i, piece)| {
                let [a, b] = piece.ends;
                let lies = move |ends: [[f64; 2]; 2]| ends == [a, b] || ends == [b, a];
                let side = &side;
                points.iter().filter(move |(edge, _)| lies(side[*edge])).map(move |(_, p)| (i, *p))
            });
            let here = here.collect();
            insert(outline, here);
        }
    }
}

/// Equal parts of a piece, not longer than `size`, that do not depend on its direction.
fn subdivided(piece: &Piece, size: f64) -> Vec<Piece> {
    let [a, b] = piece.ends;
    let parts = (distance(piece.ends) / size * (1.0 - CLOSE)).ceil().max(1.0) as usize;
    let turned = (b[0], b[1]) < (a[0], a[1]);
    let [low, high] = if turned { [b, a] } else { [a, b] };
    let at = |i: usize| {
        let (i, t) = if turned { (parts - i, (parts - i) as f64) } else { (i, i as f64) };
        let t = t / parts as f64;
        match i {
            0 => low,
            _ if i == parts => high,
            _ => [low[0] + (high[0] - low[0]) * t, low[1] + (high[1] - low[1]) * t],
        }
    };
    (0..parts).map(|i| Piece { ends: [at(i), at(i + 1)], name: piece.name.clone() }).collect()
}

fn distance([a, b]: [[f64; 2]; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}
