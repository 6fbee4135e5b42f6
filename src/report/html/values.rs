//! The values of all maps in a compact form, for the script of the page.
//!
//! A mesh of few triangles is there as it is; of a finer one there are the cells of a grid, each with the triangle that has the largest
//! value of the first map in it. Numbers keep four digits; everything is compressed together.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use crate::problem::Problem;
use crate::report::Map;
use crate::report::deflate::deflated;
use crate::report::figure::map::{self, Scale, WIDTH};
use crate::report::figure::raster::raster;
use crate::report::figure::viridis::{LEVELS, colour};
use crate::report::text::number::clean;
use crate::report::vtu::shortened;

/// Page length of a cell of the grid.
const CELL: f64 = 4.0;
/// Page coordinates are kept in steps of the width divided by this.
const STEPS: f64 = 65_535.0;

/// Data of the map that the script needs.
#[derive(Debug, Serialize)]
pub(super) struct Values {
    /// True if items are the cells of a grid rather than triangles.
    cells: bool,
    /// Number of items.
    items: usize,
    /// Number of points; 0 for cells.
    points: usize,
    /// Page length of a cell.
    cell: f64,
    width: f64,
    height: f64,
    /// Page units of a step of coordinates.
    step: f64,
    /// x = (X − plane[1])/plane[0], y = (plane[2] − Y)/plane[0] from page coordinates X, Y.
    plane: [f64; 3],
    bodies: Vec<String>,
    colours: Vec<String>,
    maps: Vec<Shown>,
    /// Little-endian, compressed with zlib, in base64.
    data: String,
}

/// One map.
#[derive(Debug, Serialize)]
struct Shown {
    key: String,
    kind: &'static str,
    title: String,
    from: f64,
    to: f64,
    log: bool,
}

/// Puts the values together; `maps` with the scale of each, the one that is shown first in front.
pub(super) fn values(problem: &Problem, maps: &[(&Map, Scale)]) -> Values {
    let (view, height) = map::view(problem);
    let step = WIDTH.max(height) / STEPS;
    let at = |p: [f64; 2]| view.at(p).map(|x| (x / step).round().clamp(0.0, STEPS) as u16);
    let cells = map::is_coarsened(problem);
    let mesh = &problem.mesh;
    let mut bytes = Vec::new();
    let triangles: Vec<usize> = if cells {
        let first = maps.first().map_or([].as_slice(), |(map, _)| map.values.as_slice());
        let grid = raster(mesh, first, &view, WIDTH, height, CELL);
        let filled: Vec<usize> = (0..grid.values.len()).filter(|i| grid.values[*i].is_finite()).collect();
        push(&mut bytes, filled.iter().map(|i| ((i % grid.columns) as u16).to_le_bytes()));
        push(&mut bytes, filled.iter().map(|i| ((i / grid.columns) as u16).to_le_bytes()));
        let of: Vec<usize> = filled.iter().map(|i| grid.triangles[*i]).collect();
        planes(&mut bytes, &of.iter().map(|t| *t as u32).collect::<Vec<_>>(), [2, 1, 0]);
        of
    } else {
        (0..2).for_each(|c| push(&mut bytes, mesh.points.iter().map(|p| at(*p)[c].to_le_bytes())));
        (0..3).for_each(|k| push(&mut bytes, mesh.triangles.iter().map(|t| (t[k] as u16).to_le_bytes())));
        (0..mesh.triangles.len()).collect()
    };
    push(&mut bytes, triangles.iter().map(|t| [mesh.body[*t].min(255) as u8]));
    for (map, _) in maps {
        let of = |t: &usize| shortened(map.values.get(*t).copied().unwrap_or(f64::NAN) as f32).to_bits();
        planes(&mut bytes, &triangles.iter().map(of).collect::<Vec<_>>(), [3, 2, 1]);
    }
    let [x, y] = view.at(problem.scene.origin.map(|x| -x));
    Values {
        cells,
        items: triangles.len(),
        points: if cells { 0 } else { mesh.points.len() },
        cell: CELL,
        width: WIDTH,
        height,
        step,
        plane: [view.scale, x, y],
        bodies: problem.scene.bodies.iter().map(|body| clean(&body.name)).collect(),
        colours: (0..LEVELS).map(colour).collect(),
        maps: maps.iter().map(|(map, scale)| shown(map, scale)).collect(),
        data: STANDARD.encode(deflated(&bytes, 9)),
    }
}

fn shown(map: &Map, scale: &Scale) -> Shown {
    let Scale { from, to, log } = *scale;
    Shown { key: map.key.clone(), kind: map.kind.in_words(), title: clean(&map.title), from, to, log }
}

fn push<const N: usize>(bytes: &mut Vec<u8>, values: impl Iterator<Item = [u8; N]>) {
    values.for_each(|value| bytes.extend(value));
}

/// The given bytes of each number, those of one place together: they are alike, and compress well.
fn planes(bytes: &mut Vec<u8>, numbers: &[u32], places: [usize; 3]) {
    for place in places {
        bytes.extend(numbers.iter().map(|n| n.to_le_bytes()[place]));
    }
}
