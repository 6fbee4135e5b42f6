//! Faults that are no mistakes get no name: noise, smooth errors and random residuals on scenes by seed. Planted mistakes on the same
//! scenes are named.

use std::collections::BTreeMap;
use std::path::Path;

use crate::support::random::Random;
use hypercircle::bounds::Hold;
use hypercircle::compare::{Candidate, Solution};
use hypercircle::diagnose::{Diagnosis, Energies, diagnose};
use hypercircle::mesh::{RawMesh, Triangulation};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use nalgebra::{DMatrix, DVector};

/// A scene by seed: one or two bodies that are bonded, clamped or on rollers, under tractions and weight.
fn scene(random: &mut Random) -> String {
    let kinematics = random.pick(&["plane-strain", "plane-stress"]);
    let mut text = format!("[model]\nkinematics = \"{kinematics}\"\n[mesh]\nfile = \"made.msh\"\n");
    let body = |name: &str, random: &mut Random| {
        let (young, poisson) = (random.magnitude(0.0, 4.0), random.between(0.05, 0.4));
        let weight = if random.chance(0.4) { random.between(-0.5, 0.5) } else { 0.0 };
        format!("[bodies.{name}]\nyoung = {young}\npoisson = {poisson}\nbody_force = [0.0, {weight}]\n")
    };
    if random.chance(0.5) {
        text += &body("high", random);
    }
    text += &body("low", random);
    text += "[[supports]]\non = \"foot\"\ntype = \"clamped\"\n";
    if random.chance(0.3) {
        text += "[[supports]]\non = \"left\"\ntype = \"roller\"\n";
    }
    let [x, y, slope] = [(); 3].map(|()| random.between(-1.0, 1.0));
    text += &format!("[[tractions]]\non = \"top\"\nvalue = [{x}, {y}]\ngradient = [[0.0, 0.0], [{slope}, 0.0]]\n");
    if random.chance(0.5) {
        text += &format!("[[tractions]]\non = \"side\"\nvalue = [{}, 0.2]\n", random.between(-1.0, 1.0));
    }
    text
}

/// The scene on n × n quadrilaterals cut in two, with points inside moved at random by `seed`.
fn problem(text: &str, seed: u64) -> Problem {
    let random = &mut Random::new(seed);
    let n = 4 + random.below(3);
    let mut raw = RawMesh::default();
    let inside = |k: usize| 0 < k && k < n;
    for j in 0..=n {
        for i in 0..=n {
            let moved = if inside(i) && inside(j) { 0.2 } else { 0.0 };
            let at = |k: usize, random: &mut Random| (k as f64 + moved * random.between(-1.0, 1.0)) / n as f64;
            raw.points.push([at(i, random), 1.3 * at(j, random)]);
        }
    }
    let two = text.contains("[bodies.high]");
    let at = |i: usize, j: usize| j * (n + 1) + i;
    for j in 0..n {
        for i in 0..n {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            let cut = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            let body = if two && 2 * j >= n { "high" } else { "low" };
            raw.triangles.extend(cut.map(|t| (t, body.to_string())));
        }
    }
    for k in 0..n {
        let edges = [(at(k, 0), at(k + 1, 0), "foot"), (at(k, n), at(k + 1, n), "top")];
        let sides = [(at(0, k), at(0, k + 1), "left"), (at(n, k), at(n, k + 1), "side")];
        raw.segments.extend(edges.into_iter().chain(sides).map(|(a, b, name)| ([a, b], name.to_string())));
    }
    let scene = Scene::parse(text, Path::new("scene.toml")).expect("a scene");
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a mesh");
    Problem::new(scene, mesh, notes).expect("a problem")
}

fn candidate(problem: &Problem, degree: usize, values: &[f64]) -> Candidate {
    let vertices = problem.mesh.points.len();
    let pairs: Vec<[f64; 2]> = values.chunks_exact(2).map(|u| [u[0], u[1]]).collect();
    let vertex = pairs[..vertices].to_vec();
    let middle = match degree {
        2 => pairs[vertices..].to_vec(),
        _ => problem
            .mesh
            .edges
            .iter()
            .map(|e| [0, 1].map(|c| 0.5 * (vertex[e.vertices[0]][c] + vertex[e.vertices[1]][c])))
            .collect(),
    };
    Candidate {
        name: "field".into(),
        solver: "test".into(),
        version: String::new(),
        degree,
        vertex,
        middle,
        higher: None,
        reported: None,
        reported_strain: None,
        is_solution: true,
        reactions: None,
        iterations: None,
        unknowns: Some(values.len()),
        cells: Vec::new(),
        on_quadrilaterals: None,
        seconds: BTreeMap::new(),
        precision: f64::EPSILON,
        numbering: None,
    }
}

/// A displacement method that has its matrix from the nodal forces of unit displacements.
struct Method {
    problem: Problem,
    degree: usize,
    stiffness: DMatrix<f64>,
    load: DVector<f64>,
    /// Columns span what supports leave free.
    free: DMatrix<f64>,
}

impl Method {
    fn new(problem: Problem, degree: usize) -> Self {
        let nodes = problem.mesh.points.len() + if degree == 2 { problem.mesh.edges.len() } else { 0 };
        let size = 2 * nodes;
        let forces = |values: &[f64]| -> Vec<f64> {
            let field = candidate(&problem, degree, values);
            let forces = hypercircle::compare::NodalForces::new(&problem, degree, &field.vertex, &field.middle);
            forces.left.iter().flatten().copied().collect()
        };
        let zero = DVector::from_vec(forces(&vec![0.0; size]));
        let mut stiffness = DMatrix::zeros(size, size);
        let mut unit = vec![0.0; size];
        for k in 0..size {
            unit[k] = 1.0;
            stiffness.set_column(k, &(DVector::from_vec(forces(&unit)) - &zero));
            unit[k] = 0.0;
        }
        let at_rest = candidate(&problem, degree, &vec![0.0; size]);
        let solution = Solution::new(&problem, &at_rest, 0.0).expect("supports that agree");
        let mut columns = Vec::new();
        for node in 0..nodes {
            let directions: &[[f64; 2]] = &match solution.hold(node) {
                Hold::Free => vec![[1.0, 0.0], [0.0, 1.0]],
                Hold::Line { normal, .. } => vec![[-normal[1], normal[0]]],
                Hold::Fixed(_) => Vec::new(),
            };
            for direction in directions {
                let mut column = DVector::zeros(size);
                (column[2 * node], column[2 * node + 1]) = (direction[0], direction[1]);
                columns.push(column);
            }
        }
        let free = DMatrix::from_columns(&columns);
        drop(solution);
        Method { load: -zero, problem, degree, stiffness, free }
    }

    /// The displacement under `load`.
    fn solve(&self, load: &DVector<f64>) -> DVector<f64> {
        let matrix = self.free.transpose() * &self.stiffness * &self.free;
        let right = self.free.transpose() * load;
        &self.free * matrix.cholesky().expect("a held body").solve(&right)
    }

    /// The diagnosis of `values` as a solution of `problem`, which has the mesh of this method.
    fn diagnosed(&self, problem: &Problem, values: &DVector<f64>) -> Option<Diagnosis> {
        let field = candidate(problem, self.degree, values.as_slice());
        let strain = 0.5 * values.dot(&(&self.stiffness * values));
        let solution = Solution::new(problem, &field, strain).expect("supports that agree");
        diagnose(&solution, Energies { own: 0.0, admissible: None, reported: None })
    }

    /// Projection of a field onto those that the supports allow.
    fn projected(&self, values: DVector<f64>) -> DVector<f64> {
        &self.free * (self.free.transpose() * values)
    }
}

fn names(diagnosis: Option<&Diagnosis>) -> Vec<&str> {
    diagnosis.map_or(Vec::new(), |d| d.findings.iter().map(|f| f.name.as_str()).collect())
}

const SEEDS: u64 = 10;

#[test]
fn noise_smooth_errors_and_random_residuals_have_no_name() {
    for seed in 0..SEEDS {
        let random = &mut Random::new(seed);
        let text = scene(random);
        let method = Method::new(problem(&text, seed), random.pick(&[1, 2]));
        let right = method.solve(&method.load);
        assert_eq!(names(method.diagnosed(&method.problem, &right).as_ref()), [""; 0], "{seed}: {text}");
        let size = right.len();
        let largest = right.amax();
        for power in -8..0 {
            let amplitude = largest * 10f64.powi(power);
            let noise = DVector::from_fn(size, |_, _| amplitude * random.between(-1.0, 1.0));
            let waves: Vec<[f64; 4]> = (0..3).map(|_| [(); 4].map(|()| random.between(-3.0, 3.0))).collect();
            let smooth = DVector::from_fn(size, |k, _| {
                let mesh = &method.problem.mesh;
                let [x, y] = match (k / 2).checked_sub(mesh.points.len()) {
                    None => mesh.points[k / 2],
                    Some(e) => [0, 1].map(|c| {
                        let [a, b] = mesh.edges[e].vertices.map(|v| mesh.points[v][c]);
                        0.5 * (a + b)
                    }),
                };
                let wave = |w: &[f64; 4]| w[2 + k % 2] * (w[0] * x + w[1] * y + w[3]).sin();
                amplitude * y * waves.iter().map(wave).sum::<f64>()
            });
            let scale = method.load.amax() * 10f64.powi(power);
            let residual = DVector::from_fn(size, |_, _| scale * random.between(-1.0, 1.0));
            let kinds = [
                ("noise", method.projected(noise)),
                ("smooth error", method.projected(smooth)),
                ("residual", method.solve(&residual)),
            ];
            for (kind, error) in kinds {
                let found = method.diagnosed(&method.problem, &(&right + error));
                let names = names(found.as_ref());
                assert!(names.is_empty(), "seed {seed}, {kind} of 1e{power}: {names:?} in {text}");
            }
        }
    }
}

/// Mistakes of one number and of two, which the field makes and the scene does not.
#[test]
fn planted_numbers_are_named() {
    for seed in 0..SEEDS {
        let random = &mut Random::new(1000 + seed);
        let text = scene(random);
        let right = problem(&text, seed);
        let degree = random.pick(&[1, 2]);
        let of_load = random.between(0.3, 2.5);
        let of_modulus = if random.chance(0.5) { random.between(0.3, 0.9) } else { random.between(1.1, 3.0) };
        let scaled = |key: &str, factor: f64, text: &str, from: usize| {
            let at = from + text[from..].find(key).expect("the key") + key.len();
            let end = at + text[at..].find('\n').expect("a line");
            let value: f64 = text[at..end].parse().expect("a number");
            format!("{}{}{}", &text[..at], factor * value, &text[end..])
        };
        let two = text.contains("[bodies.high]");
        let wrong = match two {
            true => scaled("young = ", of_modulus, &text, text.find("[bodies.high]").expect("a body")),
            false => text.clone(),
        };
        let method = Method::new(problem(&wrong, seed), degree);
        let load = if two { method.load.clone() } else { of_load * &method.load };
        let field = method.solve(&load);
        let found = method.diagnosed(&right, &field);
        let expected = |name: &str| match two {
            true => name == "body/high/young" || name == "stiffness/high",
            false => name == "loads" || name.starts_with("load/") || name.ends_with("/body_force"),
        };
        let findings = found.as_ref().map_or([].as_slice(), |d| d.findings.as_slice());
        assert!(findings.len() == 1 && expected(&findings[0].name), "seed {seed}: {findings:?} for {text}");
        let value = findings[0].value.expect("a number") / findings[0].expected.expect("a number");
        let planted = if two { of_modulus } else { of_load };
        assert!((value - planted).abs() < 1e-4 * planted, "seed {seed}: {value} for {planted}");
    }
}
