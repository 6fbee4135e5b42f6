//! Made-up dossiers for the tests of the outputs: two unit squares in contact, fields from formulas.

use std::collections::BTreeMap;

pub(crate) use super::Status as Verdict;
use super::sample_numbers::report;
use super::*;
use crate::dual::{DualSolution, Equilibrium, Phases};
use crate::element::{Displacement, SideValues, StressField};
use crate::mesh::{Edge, Triangulation};
use crate::problem::{Bow, Condition, ContactPair, Direction, Interface, Note, Problem};
use crate::scene::*;

/// Of every phase of the stress side.
pub const SECONDS: Phases = Phases {
    read: 0.01,
    statics: 0.01,
    assemble: 0.02,
    factor: 0.05,
    contact: 0.01,
    recover: 0.02,
    bounds: 0.03,
    total: 0.15,
};

/// Something to make a dossier from.
pub(crate) struct Sample {
    pub problem: Problem,
    dual: DualSolution,
    displacements: Vec<(String, Displacement)>,
    verdict: Verdict,
}

impl Sample {
    /// Two blocks of n×n squares, four triangles for every two.
    pub fn new(n: usize, verdict: Verdict) -> Self {
        let problem = two_blocks(n);
        let dual = dual(&problem);
        let field = |factor: f64| {
            let nodes: Vec<[f64; 2]> =
                (0..problem.mesh.points.len()).map(|v| displacement(&problem, v, factor)).collect();
            Displacement::from_p1(&problem.mesh, &nodes)
        };
        let displacements = vec![("free".to_string(), field(1.0)), ("FEniCSx P2".to_string(), field(0.97))];
        Sample { problem, dual, displacements, verdict }
    }

    /// Puts numbers that are none into the fields.
    pub fn spoil(&mut self) {
        self.displacements[0].1.block_mut(0).fill([f64::NAN; 2]);
        self.displacements[1].1.block_mut(0).fill([f64::INFINITY; 2]);
        self.dual.stress.block_mut(0).fill([f64::NAN; 3]);
    }

    /// Stresses of degree 1, 2 and 3 in turn: xx = (x + 2y)^p, yy = p, xy = 0.
    pub fn raise(&mut self) {
        let mesh = &self.problem.mesh;
        let degree = |t: usize| 1 + t % 3;
        let mut stress = StressField::of_degrees((0..mesh.triangles.len()).map(degree));
        for t in 0..mesh.triangles.len() {
            let (p, a) = (degree(t), mesh.corners(t));
            let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0);
            let at = |sub: usize, i: usize, j: usize| {
                let weights = [i, j, p - i - j].map(|n| n as f64 / p as f64);
                let corners = [a[(sub + 1) % 3], a[(sub + 2) % 3], centre];
                let [x, y] = [0, 1].map(|c| (0..3).map(|k| weights[k] * corners[k][c]).sum::<f64>());
                [(x + 2.0 * y).powi(p as i32), p as f64, 0.0]
            };
            let nodes =
                (0..3).flat_map(|sub| (0..=p).rev().flat_map(move |i| (0..=p - i).rev().map(move |j| (sub, i, j))));
            stress.block_mut(t).iter_mut().zip(nodes).for_each(|(value, (sub, i, j))| *value = at(sub, i, j));
        }
        self.dual.stress = stress;
    }

    /// The dossier, with a rigid motion if infeasible.
    pub fn dossier(&self) -> Dossier<'_> {
        let mesh = &self.problem.mesh;
        let map = |key: &str, kind, title: &str, f: &dyn Fn(f64, f64) -> f64| {
            let centre = |t: usize| [0, 1].map(|c| mesh.corners(t).iter().map(|p| p[c]).sum::<f64>() / 3.0);
            Map {
                key: key.to_string(),
                title: title.to_string(),
                kind,
                values: (0..mesh.triangles.len()).map(centre).map(|[x, y]| f(x, y)).collect(),
            }
        };
        let infeasible = self.verdict == Verdict::Infeasible;
        Dossier {
            report: report(&self.problem, self.verdict),
            problem: &self.problem,
            dual: (!infeasible).then_some(&self.dual),
            given: Vec::new(),
            displacements: self.displacements.iter().map(|(name, field)| (name.clone(), field)).collect(),
            mid: None,
            stresses: Vec::new(),
            maps: vec![
                map("stress_difference", MapKind::Difference, "difference dual − FEniCSx P2 <a&b>", &|x, y| {
                    (x - 1.0).powi(2) + 0.1 * (9.0 * y).sin().abs()
                }),
                map("error_contribution", MapKind::GapShare, "free upper bound", &|x, y| {
                    1e-6 / ((x - 1.0).powi(2) + (y - 0.6).powi(2) + 1e-4)
                }),
            ],
            motion: infeasible
                .then(|| mesh.points.iter().map(|p| if p[0] < 1.0 { [-0.3, 0.05] } else { [0.0; 2] }).collect()),
            proof: None,
        }
    }
}

/// Asserts that `xml` can be read to its end with every element closed.
pub(crate) fn assert_well_formed(xml: &str) {
    let mut reader = quick_xml::Reader::from_str(xml);
    let mut depth = 0;
    loop {
        match reader.read_event() {
            Ok(quick_xml::events::Event::Start(start)) => {
                depth += 1;
                for attribute in start.attributes() {
                    attribute.unwrap().normalized_value(quick_xml::XmlVersion::Explicit1_0).unwrap();
                }
            }
            Ok(quick_xml::events::Event::Empty(start)) => {
                for attribute in start.attributes() {
                    attribute.unwrap().normalized_value(quick_xml::XmlVersion::Explicit1_0).unwrap();
                }
            }
            Ok(quick_xml::events::Event::End(_)) => depth -= 1,
            Ok(quick_xml::events::Event::Eof) => break,
            Ok(_) => {}
            Err(e) => panic!("{e} at {} in\n{}", reader.buffer_position(), &xml[..xml.len().min(2000)]),
        }
    }
    assert_eq!(depth, 0, "unclosed element");
    assert!(!xml.chars().any(|c| c.is_control() && !matches!(c, '\n' | '\t' | '\r')));
}

fn two_blocks(n: usize) -> Problem {
    let h = 1.0 / n as f64;
    let (mut points, mut triangles, mut body) = (Vec::new(), Vec::new(), Vec::new());
    for b in 0..2 {
        let first = points.len();
        for j in 0..=n {
            points.extend((0..=n).map(|i| [b as f64 + i as f64 * h, j as f64 * h]));
        }
        for j in 0..n {
            for i in 0..n {
                let [a, b1, c, d] =
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| first + j * (n + 1) + i);
                triangles.extend(if (i + j) % 2 == 0 { [[a, b1, c], [a, c, d]] } else { [[a, b1, d], [b1, c, d]] });
                body.extend([b, b]);
            }
        }
    }
    let mesh = topology(points, triangles, body);
    let pairs = (0..n).map(|k| pair(&mesh, n, k)).collect::<Vec<_>>();
    let mut conditions: Vec<Condition> = (0..mesh.edges.len()).map(|e| condition(&mesh, e)).collect();
    for (k, pair) in pairs.iter().enumerate() {
        for side in 0..2 {
            conditions[pair.edges[side].unwrap()] = Condition::Contact { interface: 0, pair: k, side };
        }
    }
    let notes =
        vec![Note { weakens_guarantee: true, text: "The gap was interpolated at <the vertices> & elsewhere.".into() }];
    Problem {
        scene: scene(),
        mesh,
        conditions,
        interfaces: vec![Interface { name: "left_face|right_face".into(), pairs, centre: None }],
        beds: Vec::new(),
        notes,
        refinement: crate::problem::Refinement::default(),
        counted: Default::default(),
        uncut: None,
    }
}

/// The halves of the squares become those of quadrilaterals of a mesh file.
pub(crate) fn with_quadrilaterals(mesh: &mut Triangulation) {
    let corners: Vec<[usize; 4]> =
        mesh.triangles.chunks(2).map(|half| [half[0][0], half[0][1], half[1][1], half[1][2]]).collect();
    mesh.cells = crate::mesh::FileCells::find(&corners, &mesh.triangles);
}

fn topology(points: Vec<[f64; 2]>, triangles: Vec<[usize; 3]>, body: Vec<usize>) -> Triangulation {
    let mut edges: Vec<Edge> = Vec::new();
    let mut index = BTreeMap::new();
    let mut triangle_edges = Vec::new();
    for (t, corners) in triangles.iter().enumerate() {
        triangle_edges.push([0, 1, 2].map(|i| {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            *index
                .entry((a.min(b), a.max(b)))
                .and_modify(|&mut e: &mut usize| edges[e].triangles[1] = Some(t))
                .or_insert_with(|| {
                    edges.push(Edge { vertices: [a, b], triangles: [Some(t), None], name: None });
                    edges.len() - 1
                })
        }));
    }
    let names = ["left_load", "wall", "floor <a&b>"].map(String::from).to_vec();
    Triangulation { points, triangles, body, edges, triangle_edges, names, cells: crate::mesh::FileCells::default() }
}

fn condition(mesh: &Triangulation, e: usize) -> Condition {
    let edge = mesh.edges[e];
    let [p, q] = edge.vertices.map(|v| mesh.points[v]);
    let both = |c: usize, value: f64| p[c] == value && q[c] == value;
    let left = mesh.body[edge.triangles[0].unwrap()] == 0;
    if !edge.is_boundary() {
        Condition::Interior
    } else if both(0, 0.0) {
        Condition::Traction([p, q].map(|x| [4.0 - 7.0 * x[1], 0.0]))
    } else if both(0, 2.0) {
        Condition::Clamped([[0.0; 2]; 2])
    } else if left && both(1, 0.0) {
        Condition::Roller { direction: [0.0, -1.0], displacement: 0.0 }
    } else {
        Condition::Traction([[0.0; 2]; 2])
    }
}

fn pair(mesh: &Triangulation, n: usize, k: usize) -> ContactPair {
    let second = (n + 1) * (n + 1);
    let first = [k, k + 1].map(|j| j * (n + 1) + n);
    let opposite = [k, k + 1].map(|j| second + j * (n + 1));
    let find = |ends: [usize; 2]| {
        let same = |e: &Edge| e.vertices == ends || e.vertices == [ends[1], ends[0]];
        mesh.edges.iter().position(same)
    };
    let h = 1.0 / n as f64;
    ContactPair {
        edges: [find(first), find(opposite)],
        first,
        second: Some(opposite),
        normal: [1.0, 0.0],
        direction: Direction::constant([1.0, 0.0]),
        length: h,
        arc: [k as f64 * h, (k + 1) as f64 * h],
        gap: [0.0; 2],
        bow: Bow::default(),
        friction: None,
        stiffness: None,
    }
}

fn scene() -> Scene {
    let body = |name: &str| Body::isotropic(name, 1.0, 0.3);
    let mesh = MeshSource::Geometry { size: None, polygons: Vec::new() };
    Scene::unchecked(Draft {
        title: "Two blocks <a&b>, \"eccentric\" traction".into(),
        bodies: vec![body("left <a&b>"), body("right")],
        ..Draft::new("two_blocks", Kinematics::PlaneStrain, mesh)
    })
}

/// p(y) = max(0, 2 − 4y): closed below, open above the middle, resultant ½.
pub(super) fn contact_pressure(y: f64) -> f64 {
    (2.0 - 4.0 * y).max(0.0)
}

fn dual(problem: &Problem) -> DualSolution {
    let mesh = &problem.mesh;
    let mut stress = StressField::zeros(1, mesh.triangles.len());
    for t in 0..mesh.triangles.len() {
        let a = mesh.corners(t);
        let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0);
        let kink = 0.05 * (t % 3) as f64;
        let nodes: Vec<[f64; 3]> = (0..3)
            .flat_map(|sub| [a[(sub + 1) % 3], a[(sub + 2) % 3], centre])
            .map(|[x, y]| [-(4.0 - 7.0 * y) * (1.0 - x).max(0.0) - contact_pressure(y), kink, 0.2 * x * y])
            .collect();
        stress.block_mut(t).copy_from_slice(&nodes);
    }
    DualSolution {
        method: "condensed",
        stress,
        moments: SideValues::filled(vec![2; mesh.edges.len()], [0.0; 2]),
        contact_traction: vec![
            problem.interfaces[0].pairs.iter().map(|p| p.arc.map(|s| -contact_pressure(s))).collect(),
        ],
        unknowns: 4 * mesh.edges.len(),
        iterations: 3,
        closed: SideValues::filled(vec![2; problem.interfaces[0].pairs.len()], true),
        equilibrium: Equilibrium { jump: 3e-15, applied: 1e-15, resultant: 0.0, tension: 0.0, scale: 4.0, work: 0.0 },
        accuracy: 1e-9,
        seconds: SECONDS,
        factorised: None,
        divided: None,
        notes: Vec::new(),
    }
}

fn displacement(problem: &Problem, v: usize, factor: f64) -> [f64; 2] {
    let [x, y] = problem.mesh.points[v];
    let left = v < problem.mesh.points.len() / 2;
    let squeeze = factor * (2.0 - x) * (0.9 - 0.3 * y);
    let lift = if left { factor * 0.8 * (y - 0.5).max(0.0) } else { 0.0 };
    [squeeze - lift, factor * 0.15 * y * (2.0 - x) * if left { 1.3 } else { 1.0 }]
}
