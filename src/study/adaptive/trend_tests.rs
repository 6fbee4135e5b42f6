//! Choices between bisection and a higher degree where the terms of triangles are squares of true approximation errors: of a smooth
//! field, and of fields with a singular corner.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::forecast::Forecast;
use super::indicators::Indicators;
use super::trend::{Seen, Way, inherited, learnt, raised};
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::{Elements, MAX_DEGREE, block};
use crate::mesh::refinement::bisect::{Bisected, RefinementEdges, bisect};
use crate::mesh::{RawMesh, Triangulation};
use crate::scene::{Body, Draft, Kinematics, MeshSource, Scene};

type Field = fn([f64; 2]) -> f64;

fn smooth([x, y]: [f64; 2]) -> f64 {
    (1.5 * x + 0.8 * y).exp()
}

/// Like the stress at the edge of a flat punch.
fn infinite([x, y]: [f64; 2]) -> f64 {
    x.hypot(y).powf(-0.5) * (0.5 * y.atan2(x)).cos()
}

/// Like the stress at the end of contact.
fn rooted([x, y]: [f64; 2]) -> f64 {
    x.hypot(y).sqrt() * (0.5 * y.atan2(x)).cos()
}

/// The unit square in right isosceles triangles, with a vertex in the singular point.
fn square() -> Triangulation {
    let corner = |i: usize, j: usize| 5 * j + i;
    let halves = |i: usize, j: usize| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]].map(|corners| (corners, "a".to_string()))
    };
    let all = |n: usize| (0..n).flat_map(move |j| (0..n).map(move |i| [i, j]));
    let raw = RawMesh {
        points: all(5).map(|at| at.map(|k| 0.25 * k as f64)).collect(),
        triangles: all(4).flat_map(|[i, j]| halves(i, j)).collect(),
        ..RawMesh::default()
    };
    let draft = Draft::new("test", Kinematics::PlaneStrain, MeshSource::File("test.msh".into()));
    let scene = Scene::unchecked(Draft { bodies: vec![Body::isotropic("a", 1.0, 0.3)], ..draft });
    Triangulation::new(raw, &scene).expect("a good mesh").0
}

/// Every triangle cut in four, its edges in halves, and the triangle that each one lies in.
fn halved(mesh: &Triangulation) -> (Triangulation, Vec<usize>) {
    let all = |mesh: &Triangulation| (0..mesh.triangles.len()).collect::<Vec<_>>();
    let once = bisect(mesh, &RefinementEdges::longest(mesh), &all(mesh), &[], &Default::default());
    let Bisected { mesh, parent, .. } =
        bisect(&once.mesh, &once.refinement, &all(&once.mesh), &[], &Default::default());
    (mesh, parent.iter().map(|&p| once.parent[p]).collect())
}

/// The square of the distance of `field` from the polynomials of degree `degree` in L² of a triangle.
fn distance(mut corners: [[f64; 2]; 3], degree: usize, field: Field) -> f64 {
    // The rule is collapsed into the first corner, and bears a singularity there.
    let first =
        (0..3).min_by(|&a, &b| corners[a][0].hypot(corners[a][1]).total_cmp(&corners[b][0].hypot(corners[b][1])));
    corners.rotate_left(first.expect("three corners"));
    let [a, b, c] = corners;
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    let rule = triangle_rule(2 * degree + 20);
    let powers: Vec<(i32, i32)> =
        (0..=degree as i32).flat_map(|total| (0..=total).map(move |i| (i, total - i))).collect();
    let root = |k: usize| (rule[k].1 * area).sqrt();
    let basis = DMatrix::from_fn(rule.len(), powers.len(), |k, j| {
        let ([_, s, t], (m, n)) = (rule[k].0, powers[j]);
        root(k) * (2.0 * s - 0.7).powi(m) * (2.0 * t - 0.7).powi(n)
    });
    let values = DVector::from_fn(rule.len(), |k, _| {
        let l = rule[k].0;
        root(k) * field([0, 1].map(|i| l[0] * a[i] + l[1] * b[i] + l[2] * c[i]))
    });
    let q = basis.qr().q();
    (&values - &q * (q.transpose() * &values)).norm_squared()
}

fn terms(mesh: &Triangulation, degree: usize, field: Field) -> Indicators {
    (0..mesh.triangles.len()).map(|t| distance(mesh.corners(t), degree, field)).collect()
}

fn uniform(degree: usize) -> Elements {
    Elements::Uniform(block(degree))
}

/// The ways after the edges of the square were halved, and the square.
fn ways_of_halving(degree: usize, field: Field) -> (Vec<Way>, Triangulation) {
    let coarse = square();
    let (fine, parent) = halved(&coarse);
    let elements = uniform(degree);
    let [then, now] = [&coarse, &fine].map(|mesh| terms(mesh, degree, field));
    let before = Seen { mesh: &coarse, elements: &elements, terms: &then };
    let after = Seen { mesh: &fine, elements: &elements, terms: &now };
    (learnt(after, before, &parent, &vec![Way::Bisect; coarse.triangles.len()]), fine)
}

/// The ways after every degree of the square rose by one.
fn ways_of_raising(degree: usize, field: Field) -> (Vec<Way>, Triangulation) {
    let mesh = square();
    let count = mesh.triangles.len();
    let (old, new) = (uniform(degree), uniform(degree + 1));
    let (then, now) = (terms(&mesh, degree, field), terms(&mesh, degree + 1, field));
    let before = Seen { mesh: &mesh, elements: &old, terms: &then };
    let after = Seen { mesh: &mesh, elements: &new, terms: &now };
    let parent: Vec<usize> = (0..count).collect();
    (learnt(after, before, &parent, &vec![Way::Bisect; count]), mesh)
}

/// Distance of the triangle from the singular point.
fn nearest(mesh: &Triangulation, t: usize) -> f64 {
    mesh.corners(t).iter().fold(f64::INFINITY, |m, p| m.min(p[0].hypot(p[1])))
}

#[test]
fn where_the_solution_is_smooth_the_degree_rises_whatever_was_done() {
    for degree in 1..=4 {
        for (ways, _) in [ways_of_halving(degree, smooth), ways_of_raising(degree, smooth)] {
            assert!(ways.iter().all(|way| *way == Way::Raise), "{degree}: {ways:?}");
        }
    }
}

#[test]
fn at_a_singular_point_the_mesh_is_bisected_and_the_degree_rises_away_from_it() {
    for (field, degrees) in [(infinite as Field, 1..=4), (rooted, 2..=4)] {
        for degree in degrees {
            let (ways, mesh) = ways_of_halving(degree, field);
            for (t, way) in ways.iter().enumerate() {
                match nearest(&mesh, t) {
                    0.0 => assert_eq!(*way, Way::Bisect, "{degree}, at the corner"),
                    far if far > 0.6 => assert_eq!(*way, Way::Raise, "{degree}, {far} from the corner"),
                    _ => {}
                }
            }
        }
    }
    // A degree more leaves most of an infinite stress.
    for degree in 1..=4 {
        let (ways, mesh) = ways_of_raising(degree, infinite);
        for (t, way) in ways.iter().enumerate() {
            let far = nearest(&mesh, t);
            if far == 0.0 || far > 0.6 {
                assert_eq!(*way == Way::Bisect, far == 0.0, "{degree}, {far} from the corner");
            }
        }
    }
}

#[test]
fn triangles_that_nothing_was_done_with_keep_their_way() {
    let mesh = square();
    let count = mesh.triangles.len();
    let elements = uniform(2);
    let ways: Vec<Way> = (0..count).map(|t| if t % 3 == 0 { Way::Raise } else { Way::Bisect }).collect();
    let parent: Vec<usize> = (0..count).collect();
    let (then, now): (Indicators, Indicators) =
        ((0..count).map(|_| 1.0).collect(), (0..count).map(|t| 0.1 + t as f64).collect());
    let before = Seen { mesh: &mesh, elements: &elements, terms: &then };
    let after = Seen { mesh: &mesh, elements: &elements, terms: &now };
    assert_eq!(learnt(after, before, &parent, &ways), ways);
    // Nothing is learnt from a triangle without error, either.
    let nothing: Indicators = (0..count).map(|_| 0.0).collect();
    let higher = uniform(3);
    let before = Seen { mesh: &mesh, elements: &elements, terms: &nothing };
    let after = Seen { mesh: &mesh, elements: &higher, terms: &nothing };
    assert_eq!(learnt(after, before, &parent, &ways), ways);
}

#[test]
fn pieces_away_from_a_singular_point_are_freed_from_it() {
    let coarse = square();
    let (fine, _) = halved(&coarse);
    let (finer, parent) = halved(&fine);
    let mut forecast = Forecast::default();
    for mesh in [&coarse, &fine] {
        forecast.learn(mesh, &terms(mesh, 1, infinite));
    }
    let corner = fine.points.iter().position(|p| *p == [0.0; 2]).expect("a corner of the square");
    let ways = inherited(&forecast, &vec![Way::Bisect; fine.triangles.len()], &fine, &finer, &parent);
    let mut freed = 0;
    for (t, way) in ways.iter().enumerate() {
        let old = fine.triangles[parent[t]].contains(&corner);
        let raise = old && !finer.triangles[t].contains(&corner);
        assert_eq!(*way == Way::Raise, raise, "triangle {t}");
        freed += usize::from(raise);
    }
    assert!(freed > 0);
    // What rose goes on rising.
    let ways = inherited(&forecast, &vec![Way::Raise; fine.triangles.len()], &fine, &finer, &parent);
    assert!(ways.iter().all(|way| *way == Way::Raise));
}

/// Steps across edges from `start` to every triangle.
fn steps(mesh: &Triangulation, start: usize) -> Vec<usize> {
    let mut steps = vec![usize::MAX; mesh.triangles.len()];
    steps[start] = 0;
    for now in 0..mesh.triangles.len() {
        for t in (0..mesh.triangles.len()).filter(|&t| steps[t] == now).collect::<Vec<_>>() {
            for &other in mesh.triangle_edges[t].iter().flat_map(|&e| mesh.edges[e].triangles.iter().flatten()) {
                steps[other] = steps[other].min(now + 1);
            }
        }
    }
    steps
}

/// The least degrees with a difference of at most one between neighbours form cones around the marked triangles.
#[test]
fn degrees_rise_by_one_and_take_along_as_few_as_they_can() {
    let mesh = square();
    let count = mesh.triangles.len();
    let (peak, other) = (3, count - 2);
    let from = [peak, other].map(|t| steps(&mesh, t));
    let mut elements = Elements::Blocks(vec![1; count].into());
    for round in 1..=MAX_DEGREE + 2 {
        let marked: &[usize] = if round == 2 { &[peak, other] } else { &[peak] };
        elements = raised(&mesh, &[], &elements, marked);
        let heights = [(round + 1).min(MAX_DEGREE), if round > 1 { 2 } else { 1 }];
        let wanted = |t: usize| (0..2).map(|k| heights[k].saturating_sub(from[k][t])).max().unwrap_or(1).max(1);
        let found: Vec<usize> = (0..count).map(|t| elements.degree(t)).collect();
        assert_eq!(found, (0..count).map(wanted).collect::<Vec<_>>(), "round {round}");
    }
    assert_eq!(elements.largest_degree(), MAX_DEGREE);
    let same: Arc<[u8]> = (0..count).map(|t| elements.degree(t) as u8).collect();
    let kept = raised(&mesh, &[], &Elements::Blocks(same.clone()), &[]);
    assert!((0..count).all(|t| kept.degree(t) == usize::from(same[t])), "nothing marked, nothing raised");
}

/// As if the west of the square were in contact with its east.
#[test]
fn both_sides_of_a_contact_have_the_same_degree() {
    let mesh = square();
    let side = |x: f64| -> Vec<usize> {
        let on = |e: &usize| mesh.edges[*e].vertices.iter().all(|&v| mesh.points[v][0] == x);
        let mut edges: Vec<usize> = (0..mesh.edges.len()).filter(on).collect();
        edges.sort_by(|&a, &b| {
            mesh.points[mesh.edges[a].vertices[0]][1].total_cmp(&mesh.points[mesh.edges[b].vertices[0]][1])
        });
        edges
    };
    let facing: Vec<[usize; 2]> = side(0.0).into_iter().zip(side(1.0)).map(|(a, b)| [a, b]).collect();
    assert_eq!(facing.len(), 4);
    let at = |e: usize| mesh.edges[e].triangles[0].expect("a triangle");
    let mut elements = Elements::Blocks(vec![1; mesh.triangles.len()].into());
    for marked in [at(facing[1][0]), at(facing[3][1]), at(facing[1][0])] {
        elements = raised(&mesh, &facing, &elements, &[marked]);
        let degree = |e: usize| elements.degree(at(e));
        assert!(facing.iter().all(|&[a, b]| degree(a) == degree(b)));
        for edge in &mesh.edges {
            if let [Some(a), Some(b)] = edge.triangles {
                assert!(elements.degree(a).abs_diff(elements.degree(b)) <= 1);
            }
        }
    }
    assert_eq!(elements.degree(at(facing[1][1])), 3, "raised twice, by what it faces");
}
