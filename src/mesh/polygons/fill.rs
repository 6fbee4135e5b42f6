//! One polygon with a divided boundary to triangles, by constrained Delaunay refinement.

use std::collections::HashSet;

use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, InsertionError, Point2, RefinementParameters, Triangulation,
};

/// Smallest angle that refinement aims at inside a polygon, in degrees.
const ANGLE: f64 = 27.0;

/// Smallest angle wanted without a size: refinement cannot mend a vertex at which many sharp angles meet.
const COARSE_ANGLE: f64 = 20.0;

/// Vertices inside per vertex of the outline that may be added without a size.
const COARSE_INSIDE: usize = 20;

/// Largest area in squares of the edge length: between an equilateral triangle (0.43) and two of them.
const AREA: f64 = 0.66;

/// Largest number of vertices that a size may ask for.
pub(super) const MOST: f64 = 2e7;

/// Triangles of one polygon.
pub(super) struct Filled {
    /// Vertices; the first ones are the boundary, in its order.
    pub points: Vec<[f64; 2]>,
    /// Vertex indices.
    pub triangles: Vec<[usize; 3]>,
    /// True if every triangle has the wanted size and angles, as far as the boundary permits.
    pub complete: bool,
}

/// Fills the polygon with the corners `boundary` (at least three, simple), without a vertex added on its edges.
///
/// `size` is the target edge length; `None` adds vertices only where sharp angles would be left.
pub(super) fn fill(boundary: &[[f64; 2]], size: Option<f64>) -> Result<Filled, (String, String)> {
    let fault = |what: String| (what, "scale the scene to ordinary numbers, or simplify the polygon".to_string());
    let local = |p: [f64; 2]| Point2::new(p[0], p[1]);
    let count = boundary.len();
    let edges = (0..count).map(|i| [i, (i + 1) % count]).collect();
    let mut conflicts = 0;
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
        boundary.iter().map(|p| local(*p)).collect(),
        edges,
        |_| conflicts += 1,
    )
    .map_err(|e: InsertionError| fault(format!("cannot be triangulated: {e}")))?;
    if conflicts > 0 || cdt.num_vertices() != count {
        return Err(fault("cannot be triangulated: two of its edges come too close to one another".into()));
    }
    let outline_area: f64 = (0..count).map(|i| cross(local(boundary[i]), local(boundary[(i + 1) % count]))).sum();
    let parameters = RefinementParameters::<f64>::new().exclude_outer_faces(true).keep_constraint_edges();
    let parameters = match size {
        None => parameters
            .with_angle_limit(AngleLimit::from_deg(COARSE_ANGLE))
            .with_max_additional_vertices(COARSE_INSIDE * count),
        Some(size) => {
            let expected = outline_area / (size * size);
            let affordable = expected <= MOST;
            if !affordable {
                return Err((
                    format!("would need about {expected:.1e} vertices at geometry.size = {size}"),
                    "choose a larger size".into(),
                ));
            }
            parameters
                .with_angle_limit(AngleLimit::from_deg(ANGLE))
                .with_max_allowed_area(AREA * size * size)
                .with_max_additional_vertices(1000 + 20 * count + (10.0 * expected) as usize)
        }
    };
    let result = cdt.refine(parameters);
    let outside: HashSet<_> = result.excluded_faces.into_iter().collect();
    let mut points = boundary.to_vec();
    points.extend(cdt.vertices().skip(count).map(|v| {
        let p = v.position();
        [p.x, p.y]
    }));
    let triangles = cdt
        .inner_faces()
        .filter(|face| !outside.contains(&face.fix()))
        .map(|face| face.vertices().map(|v| v.fix().index()))
        .collect();
    Ok(Filled { points, triangles, complete: size.is_none() || result.refinement_complete })
}

fn cross(a: Point2<f64>, b: Point2<f64>) -> f64 {
    0.5 * (a.x * b.y - a.y * b.x)
}
