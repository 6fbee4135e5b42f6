//! Deformed shapes: a displacement of the bodies, or the rigid motion of a scene without equilibrium.

use std::fmt::Write;

use super::drawn::{Drawn, size};
use super::mark::{Mark, draw};
use super::outline::{View, loops, outline, polyline};
use super::svg::{Svg, look, px};
use super::symbols;
use crate::element::polynomial::side;
use crate::element::{Displacement, displacement};
use crate::problem::Problem;

const WIDTH: f64 = 560.0;
/// Up to this many triangles their edges are drawn.
const MESH_SHOWN: usize = 1500;

/// The bodies displaced by `field` as `drawn` says, over their undeformed outlines. All pictures with equal `drawn` and
/// `all` (the fields that have to fit) have the same frame, so that they can be laid side by side.
pub fn deformed(
    problem: &Problem,
    name: &str,
    field: &Displacement,
    all: &[&Displacement],
    drawn: &Drawn,
    marks: &[Mark],
) -> String {
    let mesh = &problem.mesh;
    let bodies = problem.scene.bodies.len();
    let moved = |t: usize, k: usize, f: &Displacement| drawn.place(problem, t, mesh.corners(t)[k], f.corner(t, k));
    let curved = |e: usize, t: usize| {
        let i = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
        let [a, b] = [1, 2].map(|n| mesh.corners(t)[(i + n) % 3]);
        let k = field.degree(t);
        let at = |(j, u): (usize, [f64; 2])| {
            let s = j as f64 / k as f64;
            drawn.place(problem, t, [0, 1].map(|c| (1.0 - s) * a[c] + s * b[c]), u)
        };
        pieces(&field.side(t, i).enumerate().map(at).collect::<Vec<_>>())
    };
    let fits = |f: &&&Displacement| f.len() == mesh.triangles.len();
    let corners = all
        .iter()
        .filter(fits)
        .flat_map(|f| (0..mesh.triangles.len()).flat_map(move |t| (0..3).map(move |k| moved(t, k, f))));
    let apart = |t: usize| drawn.apart(mesh.body[t]);
    let before = (0..mesh.triangles.len()).flat_map(|t| mesh.corners(t).map(|p| [0, 1].map(|c| p[c] + apart(t)[c])));
    let (view, height) = View::fit(before.chain(corners), WIDTH, 460.0, 14.0);
    let mut svg = Svg::new(WIDTH, height, format!("Deformed shape, {name}, displacements times {}", drawn.scale));
    if field.len() != mesh.triangles.len() {
        return svg.finish();
    }
    for body in 0..bodies {
        let d = curved_outline(problem, body, &view, curved);
        let look = look::BODIES[body % look::BODIES.len()];
        svg.path(look, r#"fill-opacity="0.75" fill-rule="evenodd""#, &d);
    }
    if mesh.triangles.len() <= MESH_SHOWN {
        let mut d = String::new();
        let corner = |t: usize, v: usize| mesh.triangles[t].iter().position(|w| *w == v).unwrap_or(0);
        let mut cell = |corners: &[(usize, usize)]| {
            let points: Vec<[f64; 2]> = corners.iter().map(|(t, k)| view.at(moved(*t, *k, field))).collect();
            d.push_str(&polyline(&points));
            d.push('z');
        };
        for quadrilateral in mesh.quadrilaterals() {
            let ([a, b, c, e], [t, u]) = (quadrilateral.corners, quadrilateral.triangles);
            cell(&[(t, corner(t, a)), (t, corner(t, b)), (u, corner(u, c)), (t, corner(t, e))]);
        }
        for t in mesh.lone_triangles() {
            cell(&[0, 1, 2].map(|k| (t, k)));
        }
        svg.path(look::MESH, r#"stroke-width="0.6""#, &d);
    }
    for body in 0..bodies {
        svg.path(
            look::LINE,
            r#"stroke-width="0.8" stroke-dasharray="3 4" stroke-opacity="0.55""#,
            &outline(mesh, body, &view.moved(drawn.apart(body))),
        );
        let d = curved_outline(problem, body, &view, curved);
        svg.path(look::LINE, r#"stroke-width="1.1""#, &d);
    }
    for side in 0..2 {
        let mut d = String::new();
        for pair in problem.pairs() {
            if let Some((e, t)) = pair.edges[side].and_then(|e| Some((e, mesh.edges[e].triangles[0]?))) {
                let _ = write!(d, "{}", curve(&curved(e, t), &view, true));
            }
        }
        let dash = if side == 0 { "" } else { r#" stroke-dasharray="7 3""# };
        svg.path(look::CONTACT, &format!(r#"stroke-width="2.4"{dash}"#), &d);
    }
    draw(&mut svg, marks, |mark| view.at(displaced(problem, field, drawn, mark)));
    svg.finish()
}

/// Where a mark is once its triangle has been displaced.
fn displaced(problem: &Problem, field: &Displacement, drawn: &Drawn, mark: &Mark) -> [f64; 2] {
    let Some(t) = mark.triangle.filter(|t| *t < field.len()) else { return mark.at };
    let [a, b, c] = problem.mesh.corners(t);
    let twice = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let area = twice(a, b, c);
    let u = field.at(t, [twice(mark.at, b, c) / area, twice(a, mark.at, c) / area, twice(a, b, mark.at) / area]);
    drawn.place(problem, t, mark.at, u)
}

/// The rigid motion that nothing stops: outlines before and after, and arrows.
pub fn motion(problem: &Problem, motion: &[[f64; 2]]) -> String {
    let mesh = &problem.mesh;
    if motion.len() != mesh.points.len() {
        return Svg::new(WIDTH, 10.0, "No motion").finish();
    }
    let largest = motion.iter().map(|u| u[0].hypot(u[1])).filter(|d| d.is_finite()).fold(0.0, f64::max);
    let scale = if largest > 0.0 { 0.2 * size(problem) / largest } else { 1.0 };
    let moved = |v: usize| [0, 1].map(|c| mesh.points[v][c] + scale * motion[v][c]);
    let (view, height) =
        View::fit(mesh.points.iter().copied().chain((0..mesh.points.len()).map(moved)), WIDTH, 460.0, 24.0);
    let mut svg =
        Svg::new(WIDTH, height, "The motion that supports and contact do not stop: before (dashed) and after");
    for body in 0..problem.scene.bodies.len() {
        svg.path(look::LINE, r#"stroke-width="1" stroke-dasharray="4 4""#, &outline(mesh, body, &view));
        let rings = loops(mesh, body);
        let start = |(e, t): (usize, usize)| mesh.edges[e].vertices[usize::from(mesh.edges[e].triangles[0] != Some(t))];
        let d: String = rings
            .iter()
            .map(|ring| polyline(&ring.iter().map(|&s| view.at(moved(start(s)))).collect::<Vec<_>>()) + "z")
            .collect();
        svg.path(
            look::BODIES[body % look::BODIES.len()],
            r##"fill-opacity="0.8" fill-rule="evenodd" stroke="#57606a""##,
            &d,
        );
        for ring in &rings {
            for &s in ring.iter().step_by(ring.len().div_ceil(12).max(1)) {
                let (v, u) = (start(s), motion[start(s)]);
                let k = view.scale * scale;
                symbols::arrow(&mut svg, look::LOAD, view.at(mesh.points[v]), [k * u[0], -k * u[1]], true);
            }
        }
    }
    svg.finish()
}

/// A side with the given Bernstein coefficients as quadratic Bézier curves, one after the other: one that is exact for a
/// quadratic displacement, and k − 1 that meet it at their ends and in their middles for degree k.
fn pieces(coefficients: &[[f64; 2]]) -> Vec<[[f64; 2]; 3]> {
    let k = coefficients.len() - 1;
    if let [a, control, b] = *coefficients {
        return vec![[a, control, b]];
    }
    let count = (k - 1).max(1);
    let at = |half: usize| {
        let s = half as f64 / (2 * count) as f64;
        let weights = (0..=k).map(|j| side::bernstein(k, j, s));
        weights.zip(coefficients).fold([0.0; 2], |sum, (w, c)| [sum[0] + w * c[0], sum[1] + w * c[1]])
    };
    let piece = |n: usize| {
        let [a, middle, b] = [2 * n, 2 * n + 1, 2 * n + 2].map(at);
        [a, displacement::inner_coefficient(a, middle, b), b]
    };
    (0..count).map(piece).collect()
}

/// Path data of a side from where the pen is, or from its beginning; straight where the bow cannot be seen.
fn curve(pieces: &[[[f64; 2]; 3]], view: &View, begin: bool) -> String {
    let mut d = String::new();
    for (n, piece) in pieces.iter().enumerate() {
        let [a, q, b] = piece.map(|p| view.at(p));
        if begin && n == 0 {
            let _ = write!(d, "M{} {}", px(a[0]), px(a[1]));
        }
        let bow = [0, 1].map(|c| q[c] - 0.5 * (a[c] + b[c]));
        if bow[0].hypot(bow[1]) < 0.2 {
            let _ = write!(d, "L{} {}", px(b[0]), px(b[1]));
        } else {
            let _ = write!(d, "Q{} {} {} {}", px(q[0]), px(q[1]), px(b[0]), px(b[1]));
        }
    }
    d
}

fn curved_outline(
    problem: &Problem,
    body: usize,
    view: &View,
    side: impl Fn(usize, usize) -> Vec<[[f64; 2]; 3]>,
) -> String {
    let mut d = String::new();
    for ring in loops(&problem.mesh, body) {
        for (i, &(e, t)) in ring.iter().enumerate() {
            d.push_str(&curve(&side(e, t), view, i == 0));
        }
        d.push('z');
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed, with_quadrilaterals};

    #[test]
    fn both_sides_of_a_contact_are_marked() {
        let sample = Sample::new(2, Verdict::Agree);
        let dossier = sample.dossier();
        let fields: Vec<&Displacement> = dossier.displacements.iter().map(|d| d.1).collect();
        let drawn = Drawn::of(&sample.problem, &fields);
        let text = deformed(&sample.problem, "<free>", fields[0], &fields, &drawn, &[]);
        assert_well_formed(&text);
        assert_eq!(text.matches("class=\"contact\"").count(), 2);
    }

    #[test]
    fn quadrilaterals_are_drawn_without_their_diagonals() {
        let mut sample = Sample::new(3, Verdict::Agree);
        let drawn = |sample: &Sample| {
            let dossier = sample.dossier();
            let fields: Vec<&Displacement> = dossier.displacements.iter().map(|d| d.1).collect();
            let drawn = Drawn::of(&sample.problem, &fields);
            let text = deformed(&sample.problem, "free", fields[0], &fields, &drawn, &[]);
            assert_well_formed(&text);
            text.matches('z').count()
        };
        let triangles = drawn(&sample);
        with_quadrilaterals(&mut sample.problem.mesh);
        assert_eq!(sample.problem.mesh.cells.len(), 18);
        assert_eq!(triangles - drawn(&sample), 18);
    }

    #[test]
    fn a_quadratic_edge_becomes_its_curve() {
        let sample = Sample::new(1, Verdict::Agree);
        let mesh = &sample.problem.mesh;
        let edge = vec![[0.0, 0.5]; mesh.edges.len()];
        let field = Displacement::from_p2(mesh, &vec![[0.0; 2]; mesh.points.len()], &edge);
        let text = deformed(&sample.problem, "bow", &field, &[&field], &Drawn::of(&sample.problem, &[&field]), &[]);
        assert!(text.contains('Q'));
    }

    #[test]
    fn a_motion_is_drawn_with_arrows() {
        let sample = Sample::new(2, Verdict::Infeasible);
        let dossier = sample.dossier();
        let text = motion(&sample.problem, dossier.motion.as_ref().unwrap());
        assert_well_formed(&text);
        assert!(text.contains("class=\"load\""));
        assert_well_formed(&motion(&sample.problem, &[]));
    }
}
