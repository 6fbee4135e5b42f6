//! Made-up dossiers for the tests of the outputs: two unit squares in contact, fields from formulas.

use std::collections::BTreeMap;
use std::path::PathBuf;

pub(crate) use super::Status as Verdict;
use super::*;
use crate::compare::{Basis, Check};
use crate::dual::{DualSolution, Phases};
use crate::element::{Displacement, StressField};
use crate::mesh::{Edge, Triangulation};
use crate::problem::{Condition, ContactPair, Interface, Note, Problem};
use crate::scene::*;

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
        self.displacements[0].1.values[0] = [[f64::NAN; 2]; 10];
        self.displacements[1].1.values[0] = [[f64::INFINITY; 2]; 10];
        self.dual.stress.block_mut(0).fill([f64::NAN; 3]);
    }

    /// The dossier, with a rigid motion if infeasible.
    pub fn dossier(&self) -> Dossier<'_> {
        let mesh = &self.problem.mesh;
        let map = |key, title, f: &dyn Fn(f64, f64) -> f64| {
            let centre = |t: usize| [0, 1].map(|c| mesh.corners(t).iter().map(|p| p[c]).sum::<f64>() / 3.0);
            Map { key, title, values: (0..mesh.triangles.len()).map(centre).map(|[x, y]| f(x, y)).collect() }
        };
        let infeasible = self.verdict == Verdict::Infeasible;
        Dossier {
            report: report(&self.problem, self.verdict),
            problem: &self.problem,
            dual: (!infeasible).then_some(&self.dual),
            displacements: self.displacements.iter().map(|(name, field)| (name.clone(), field)).collect(),
            maps: vec![
                map("stress_difference", "Difference of the stresses", &|x, y| {
                    (x - 1.0).powi(2) + 0.1 * (9.0 * y).sin().abs()
                }),
                map("error_contribution", "Contribution to the error bound", &|x, y| {
                    1e-6 / ((x - 1.0).powi(2) + (y - 0.6).powi(2) + 1e-4)
                }),
            ],
            motion: infeasible
                .then(|| mesh.points.iter().map(|p| if p[0] < 1.0 { [-0.3, 0.05] } else { [0.0; 2] }).collect()),
        }
    }
}

/// Whether `xml` can be read to its end with every element closed.
pub(crate) fn assert_well_formed(xml: &str) {
    let mut reader = quick_xml::Reader::from_str(xml);
    let mut depth = 0;
    loop {
        match reader.read_event() {
            Ok(quick_xml::events::Event::Start(start)) => {
                depth += 1;
                for attribute in start.attributes() {
                    attribute.unwrap().unescape_value().unwrap();
                }
            }
            Ok(quick_xml::events::Event::Empty(start)) => {
                for attribute in start.attributes() {
                    attribute.unwrap().unescape_value().unwrap();
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
        interfaces: vec![Interface { name: "left_face|right_face".into(), pairs }],
        notes,
    }
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
    Triangulation { points, triangles, body, edges, triangle_edges, names }
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
        Condition::Clamped([0.0, 0.0])
    } else if left && both(1, 0.0) {
        Condition::Roller
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
        length: h,
        arc: [k as f64 * h, (k + 1) as f64 * h],
        gap: [0.0; 2],
    }
}

fn scene() -> Scene {
    let body = |name: &str| Body { name: name.into(), young: 1.0, poisson: 0.3, body_force: [0.0, 0.0] };
    Scene {
        name: "two_blocks".into(),
        title: "Two blocks <a&b>, \"eccentric\" traction".into(),
        path: PathBuf::from("two_blocks.toml"),
        kinematics: Kinematics::PlaneStrain,
        thickness: 1.0,
        mesh: MeshSource::Geometry { size: None, polygons: Vec::new() },
        bodies: vec![body("left <a&b>"), body("right")],
        supports: Vec::new(),
        tractions: Vec::new(),
        contacts: Vec::new(),
    }
}

/// p(y) = max(0, 2 − 4y): closed below, open above the middle, resultant ½.
fn contact_pressure(y: f64) -> f64 {
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
        moments: vec![[[0.0; 2]; 2]; mesh.edges.len()],
        contact_traction: vec![
            problem.interfaces[0].pairs.iter().map(|p| p.arc.map(|s| -contact_pressure(s))).collect(),
        ],
        unknowns: 4 * mesh.edges.len(),
        iterations: 3,
        equilibrium_residual: 3e-15,
        seconds: Phases { read: 0.01, assemble: 0.02, factor: 0.05, contact: 0.01, recover: 0.02, total: 0.11 },
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

fn report(problem: &Problem, verdict: Verdict) -> Report {
    let failed = verdict == Verdict::Disagree;
    let (lower, upper) = (-1.7972865675, -1.79391);
    let p2 = if failed { -1.8109 } else { -1.7958503770 };
    let complementary = 1.7972865675;
    let energy = Energy {
        lower,
        upper,
        gap: upper - lower,
        relative_error_bound: ((upper - lower) / complementary).sqrt(),
        upper_from: "free".into(),
        free_upper: Some(upper),
        gap_local: Some(upper - lower),
        complementary,
        widening: 3e-14,
        guaranteed: true,
    };
    let primal = |name: &str, degree, energy: f64| PrimalSummary {
        name: name.into(),
        solver: "FEniCSx".into(),
        version: "0.5.2".into(),
        degree,
        energy,
        admissible: true,
        relative_error_bound: (energy > lower).then(|| ((energy - lower) / complementary).sqrt()),
        iterations: 4,
        unknowns: 1234 * degree,
        seconds: BTreeMap::from([("assemble".into(), 0.3), ("solve".into(), 0.5), ("total".into(), 0.9)]),
    };
    let verdict_text = match verdict {
        Verdict::Agree => "The two models agree within everything the theory allows.",
        Verdict::Disagree => "The two models disagree: 2 of 4 checks failed.",
        Verdict::Infeasible => "No equilibrium: left <a&b> would fly off to the left.",
        Verdict::Failed => "The reference model stopped: SNES diverged.",
    };
    let solved = verdict != Verdict::Infeasible;
    Report {
        schema_version: 1,
        scene: problem.scene.name.clone(),
        title: problem.scene.title.clone(),
        command: "verify".into(),
        status: verdict,
        verdict: verdict_text.into(),
        energy: solved.then_some(energy),
        dual: solved.then(|| DualSummary {
            method: "condensed".into(),
            triangles: problem.mesh.triangles.len(),
            unknowns: 4 * problem.mesh.edges.len(),
            iterations: 3,
            equilibrium_residual: 3e-15,
            seconds: Phases { read: 0.01, assemble: 0.02, factor: 0.05, contact: 0.01, recover: 0.02, total: 0.11 },
        }),
        primal: vec![primal("FEniCSx P1", 1, -1.7321463913), primal("FEniCSx P2", 2, p2)],
        contact: vec![contact(failed)],
        stress: Some(StressSummary {
            against: "FEniCSx P2".into(),
            relative_energy_norm_difference: 0.0412,
            worst_triangle: 1,
            worst_at: [0.99, 0.61],
            worst_share: 0.083,
            von_mises_max: TwoSides { dual: 4.31, primal: Some(4.22) },
            component_l2_difference: ComponentDifference { xx: 0.011, yy: 0.008, xy: 0.004, von_mises: 0.012 },
        }),
        checks: checks(failed, lower, p2),
        notes: problem.notes.clone(),
        history: [(16, 1.1e-1), (120, 4.4e-2), (900, 1.3e-2), (5900, 4.1e-3)]
            .map(|(triangles, bound)| HistoryRow {
                triangles,
                unknowns: 6 * triangles,
                lower,
                upper,
                relative_error_bound: bound,
                seconds: 1e-5 * triangles as f64,
            })
            .to_vec(),
        provenance: Provenance {
            version: "0.1.0".into(),
            components: BTreeMap::from([("dolfinx".into(), "0.5.2".into()), ("faer".into(), "0.24.4".into())]),
            scene_sha256: "0123456789abcdef".repeat(4),
            mesh_sha256: "fedcba9876543210".repeat(4),
            lock_sha256: "00ff".repeat(16),
            threads: 1,
            seconds: BTreeMap::from([("dual".into(), 0.11), ("primal".into(), 1.9), ("total".into(), 2.1)]),
        },
    }
}

fn contact(failed: bool) -> ContactSummary {
    let steps: Vec<[f64; 2]> = (0..8)
        .flat_map(|k| [k, k + 1].map(|j| [f64::from(j) / 8.0, contact_pressure((f64::from(k) + 0.5) / 8.0)]))
        .collect();
    let factor = if failed { -0.6 } else { 1.0 };
    let smooth = (0..=16).map(|k| f64::from(k) / 16.0).map(|s| [s, factor * contact_pressure(s)]).collect();
    let trace = (0..=16)
        .map(|k| f64::from(k) / 16.0)
        .map(|s| [s, factor * contact_pressure(s) + 0.1 * (20.0 * s).sin()])
        .collect();
    let profile = |model: &str, points| Profile { model: model.into(), points };
    ContactSummary {
        name: "left_face|right_face".into(),
        resultant: TwoSides { dual: [-0.5, 0.0], primal: Some([-0.5 * factor, 0.0]) },
        moment: TwoSides { dual: 0.0833, primal: Some(0.0829) },
        pressure_max: TwoSides { dual: 2.01, primal: Some(1.97) },
        pressure_max_at: TwoSides { dual: [1.0, 0.0], primal: Some([1.0, 0.0]) },
        open_fraction: 0.375,
        open_fraction_primal: Some(0.375),
        contact_ends: vec![0.5],
        pressure_l2_difference: Some(0.034),
        length: 1.0,
        profiles: vec![
            profile("dual", steps),
            profile("FEniCSx P2 reactions", smooth),
            profile("FEniCSx P2 trace", trace),
        ],
    }
}

fn checks(failed: bool, lower: f64, p2: f64) -> Vec<Check> {
    let sign = if failed { -1.0 } else { 1.0 };
    vec![
        Check::at_most(
            "sharpness",
            0.0433,
            0.15,
            0.0,
            Basis::Chosen,
            "The bracket has to be sharp enough to tell a wrong model from a right one.",
        ),
        Check::at_most(
            "energy.order.P2",
            lower,
            p2,
            1e-9,
            Basis::Guaranteed,
            "An admissible displacement cannot have less energy than −Π(λ_h).",
        ),
        Check::equal(
            "contact.left_face|right_face.resultant <a&b>",
            -0.5,
            -0.5 * sign,
            1e-2,
            Basis::Guaranteed,
            "Both sides carry the same force.",
        ),
        Check::equal(
            "gap.local",
            0.0033765,
            0.0033765,
            1e-9,
            Basis::RoundOff,
            "The gap computed from energies and from local terms.",
        ),
    ]
}
