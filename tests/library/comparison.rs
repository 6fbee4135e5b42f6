//! The contact checks on a displacement field made by hand: uniform compression of two blocks, E = 1, ν = 0.

use std::collections::BTreeMap;

use crate::support::Blocks;
use hypercircle::bounds::Bracket;
use hypercircle::compare::{Allowances, Basis, Candidate, Check, Reactions, compare};
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::element::PlainDisplacement;
use hypercircle::mesh::Edge;
use hypercircle::problem::Problem;
use hypercircle::scene::Draft;

fn problem(n: usize) -> Problem {
    Blocks { n, materials: [(1.0, 0.0); 2], load: (1.0, 0.0), ..Blocks::default() }.problem()
}

/// u = (2 − x, 0) with its reactions: a pressure of 1 against hat functions, in Bernstein form.
fn exact(problem: &Problem) -> Candidate {
    let mesh = &problem.mesh;
    let u = |[x, _]: [f64; 2]| [2.0 - x, 0.0];
    let middle = |e: usize| {
        let [a, b] = mesh.edges[e].vertices.map(|v| mesh.points[v]);
        u([0.5 * (a[0] + b[0]), 0.0])
    };
    let pairs = &problem.interfaces[0].pairs;
    let third = pairs[0].length / 3.0;
    let mut vertices = vec![pairs[0].first[0]];
    vertices.extend(pairs.iter().map(|p| p.first[1]));
    let ends = [0, vertices.len() - 1];
    let vertex = (0..vertices.len()).map(|i| if ends.contains(&i) { third } else { 2.0 * third }).collect();
    Candidate {
        name: "by hand".to_string(),
        solver: "hand".to_string(),
        version: String::new(),
        degree: 2,
        vertex: mesh.points.iter().map(|p| u(*p)).collect(),
        middle: (0..mesh.edges.len()).map(middle).collect(),
        higher: None,
        cells: Vec::new(),
        on_quadrilaterals: None,
        reported: Some(-1.0),
        reported_strain: Some(1.0),
        is_solution: true,
        reactions: Some(vec![Reactions {
            vertices,
            vertex,
            edge: Some(vec![vec![third]; pairs.len()]),
            friction: None,
            resultant: [-1.0, 0.0],
        }]),
        iterations: Some(1),
        unknowns: Some(1),
        seconds: BTreeMap::new(),
        precision: f64::EPSILON,
        numbering: None,
    }
}

/// As [`exact`], in degree `k`: of a constant pressure, every coefficient on an edge has an equal share.
fn exact_of_degree(problem: &Problem, k: usize) -> Candidate {
    let mesh = &problem.mesh;
    let linear = exact(problem);
    let ends = |e: &Edge| e.vertices.map(|v| linear.vertex[v][0]);
    let along = |[a, b]: [f64; 2]| (1..k).map(move |i| [a + (b - a) * i as f64 / k as f64, 0.0]);
    let edge: Vec<[f64; 2]> = mesh.edges.iter().flat_map(|e| along(ends(e))).collect();
    let inside = mesh.triangles.iter().flat_map(|corners| {
        let [a, b, c] = corners.map(|v| linear.vertex[v][0]);
        let all = (1..k).rev().flat_map(move |i| (1..k).rev().map(move |j| (i, j)));
        let within = all.filter(move |(i, j)| i + j < k).map(move |(i, j)| (i, j, k - i - j));
        within.map(move |(i, j, l)| [(i as f64 * a + j as f64 * b + l as f64 * c) / k as f64, 0.0])
    });
    let inside: Vec<[f64; 2]> = inside.collect();
    let higher =
        PlainDisplacement::from_values(mesh, k, &linear.vertex, &edge, &inside).expect("the nodes of the mesh");
    let mut candidate = Candidate { degree: k, higher: Some(higher), ..linear };
    let part = problem.interfaces[0].pairs[0].length / (k + 1) as f64;
    let reported = reactions(&mut candidate);
    let last = reported.vertex.len() - 1;
    let shares = (0..=last).map(|i| if [0, last].contains(&i) { part } else { 2.0 * part });
    reported.vertex = shares.collect();
    reported.edge = Some(vec![vec![part; k - 1]; last]);
    candidate
}

fn checks(problem: &Problem, candidate: Candidate) -> Vec<Check> {
    let dual = dual::solve(&Condensed::default(), problem, &[], &Options::default()).expect("solves");
    let bracket = Bracket::new(problem, &dual);
    compare(problem, &dual, &bracket, vec![candidate], &Allowances::default()).checks
}

fn failed(checks: &[Check]) -> Vec<&str> {
    checks.iter().filter(|c| !c.passed).map(|c| c.name.rsplit('/').next().unwrap_or(&c.name)).collect()
}

fn reactions(candidate: &mut Candidate) -> &mut Reactions {
    &mut candidate.reactions.as_mut().expect("reactions")[0]
}

#[test]
fn the_exact_field_passes_every_check() {
    let problem = problem(4);
    let checks = checks(&problem, exact(&problem));
    assert!(failed(&checks).is_empty(), "{:?}", failed(&checks));
    for last in ["reactions", "pressure-l2", "pressure-max", "resultant"] {
        let check = checks.iter().find(|c| c.name.ends_with(&format!("/{last}"))).expect("made");
        assert!(check.difference.expect("a number") < 1e-12 && check.basis != Basis::Chosen, "{check:?}");
    }
}

#[test]
fn force_at_the_wrong_vertex_is_noticed_though_the_resultant_is_right() {
    let problem = problem(4);
    let mut candidate = exact(&problem);
    reactions(&mut candidate).vertex[1] += 1e-4;
    reactions(&mut candidate).vertex[2] -= 1e-4;
    let checks = checks(&problem, candidate);
    assert_eq!(failed(&checks), ["by hand", "reactions", "pressure-l2", "pressure-max"]);
    assert!(checks.iter().any(|c| c.name == "primal/reactions/by hand" && !c.passed));
}

#[test]
fn reactions_that_do_not_belong_to_the_displacement_are_noticed() {
    let problem = problem(4);
    let mut candidate = exact(&problem);
    // Still admissible, and its energy is reported truly: only it is no solution.
    for u in candidate.vertex.iter_mut().chain(&mut candidate.middle) {
        u[0] *= 1.01;
    }
    candidate.reported_strain = Some(1.01_f64.powi(2));
    candidate.reported = Some(1.01_f64.powi(2) - 2.0 * 1.01);
    let checks = checks(&problem, candidate);
    assert_eq!(failed(&checks), ["by hand", "by hand", "by hand", "reactions"], "{checks:?}");
    for name in ["energy/identity/by hand", "primal/equilibrium/by hand", "primal/reactions/by hand"] {
        assert!(checks.iter().any(|c| c.name == name && !c.passed), "{name}");
    }
}

/// The relative remainder of the nodal forces of a claimed solution.
fn remainder(checks: &[Check]) -> f64 {
    let check = checks.iter().find(|c| c.name == "primal/equilibrium/by hand").expect("made");
    assert_eq!(check.passed, check.difference.expect("a number") <= check.allowed);
    check.difference.expect("a number")
}

#[test]
fn a_displacement_that_is_wrong_anywhere_is_out_of_balance() {
    let problem = problem(4);
    assert!(remainder(&checks(&problem, exact(&problem))) < 1e-13);
    let nodes = problem.mesh.points.len();
    for node in 0..nodes + problem.mesh.edges.len() {
        let held = |p: [f64; 2]| p[0] == 2.0 || p[1] == 0.0;
        let mut candidate = exact(&problem);
        match node.checked_sub(nodes) {
            None if held(problem.mesh.points[node]) => continue,
            None => candidate.vertex[node][1] += 1e-5,
            Some(e) if problem.mesh.edges[e].vertices.iter().all(|v| held(problem.mesh.points[*v])) => continue,
            Some(e) => candidate.middle[e][1] += 1e-5,
        }
        assert!(remainder(&checks(&problem, candidate)) > 1e-6, "node {node}");
    }
}

#[test]
fn solutions_of_higher_degree_pass_and_wrong_reactions_of_theirs_do_not() {
    let problem = problem(3);
    for k in [3, 4, 6] {
        let found = checks(&problem, exact_of_degree(&problem, k));
        assert!(failed(&found).is_empty(), "degree {k}: {:?}", failed(&found));
        assert!(remainder(&found) < 1e-12, "degree {k}: {}", remainder(&found));
        let mut candidate = exact_of_degree(&problem, k);
        reactions(&mut candidate).edge.as_mut().expect("inside")[1][k - 2] += 1e-4;
        let found = failed(&checks(&problem, candidate)).join(" ");
        assert!(found.contains("reactions"), "degree {k}: {found}");
    }
}

#[test]
fn solutions_of_other_data_are_out_of_balance_by_the_size_of_the_change() {
    let problem = problem(3);
    for degree in [1, 2, 3, 5] {
        let candidate = || match degree {
            1 | 2 => Candidate { degree, reactions: None, ..exact(&problem) },
            _ => Candidate { reactions: None, ..exact_of_degree(&problem, degree) },
        };
        assert!(remainder(&checks(&problem, candidate())) < 1e-13);
        for change in [1e-2, 1e-4] {
            let with = |changed: &dyn Fn(&mut Draft)| Problem {
                scene: problem.scene.changed(changed).expect("a valid scene"),
                ..problem.clone()
            };
            let heavier = with(&|draft| draft.bodies[0].body_force = [0.0, change].into());
            let stiffer =
                with(&|draft| draft.bodies[0].elasticity = draft.bodies[0].elasticity.stiffened(1.0 + change));
            let thicker = with(&|draft| draft.thickness *= 1.0 + change);
            for other in [heavier, stiffer] {
                let left = remainder(&checks(&other, candidate()));
                assert!(left > 0.03 * change && left < 3.0 * change, "{left} for {change}");
            }
            // Loads and stiffness are both per thickness: the displacement is the same.
            assert!(remainder(&checks(&thicker, candidate())) < 1e-13);
        }
    }
}

#[test]
fn a_reaction_where_there_is_no_contact_is_noticed() {
    let problem = problem(4);
    let inside =
        (0..problem.mesh.points.len()).find(|v| !problem.interfaces[0].pairs.iter().any(|p| p.first.contains(v)));
    let mut candidate = exact(&problem);
    reactions(&mut candidate).vertices.push(inside.expect("a vertex off the contact"));
    reactions(&mut candidate).vertex.push(0.25);
    assert!(failed(&checks(&problem, candidate)).contains(&"reactions"));
    let mut candidate = exact(&problem);
    reactions(&mut candidate).resultant[0] -= 1e-4;
    assert!(failed(&checks(&problem, candidate)).contains(&"reactions"));
}

#[test]
fn what_this_program_chose_decides_only_where_it_is_asked_to() {
    let problem = problem(4);
    let mut candidate = exact(&problem);
    candidate.reactions = None;
    // A trace of another size: still admissible, with an energy that says so.
    candidate.is_solution = false;
    candidate.vertex.iter_mut().chain(&mut candidate.middle).flatten().for_each(|u| *u *= 0.5);
    let dual = dual::solve(&Condensed::default(), &problem, &[], &Options::default()).expect("solves");
    let bracket = Bracket::new(&problem, &dual);
    let against = |allow: Vec<(String, f64)>| {
        compare(
            &problem,
            &dual,
            &bracket,
            vec![Candidate { reported: None, reported_strain: None, ..candidate.clone() }],
            &Allowances::new(allow),
        )
    };
    let plain = against(Vec::new());
    let error = plain.checks.iter().find(|c| c.name.ends_with("/energy-error")).expect("made");
    assert!(!error.passed && !error.decides() && plain.agrees(), "{error:?}");
    assert!(!against(vec![("energy-error".to_string(), 0.4)]).agrees());
    assert!(against(vec![("energy-error".to_string(), 0.6)]).agrees());
}

#[test]
fn half_a_contact_that_carries_nothing_is_noticed() {
    let problem = problem(16);
    let mut candidate = exact(&problem);
    let own = reactions(&mut candidate);
    own.vertex[9..].fill(0.0);
    own.edge.as_mut().expect("degree 2")[8..].fill(vec![0.0]);
    let checks = checks(&problem, candidate);
    let open = checks.iter().find(|c| c.name.ends_with("open-length")).expect("made");
    assert!(!open.passed && (open.difference.expect("a number") - 7.0 / 16.0).abs() < 1e-9, "{open:?}");
}

#[test]
fn a_solution_without_reactions_is_compared_by_its_trace() {
    let problem = problem(4);
    let mut candidate = exact(&problem);
    candidate.reactions = None;
    let checks = checks(&problem, candidate);
    assert!(failed(&checks).is_empty(), "{:?}", failed(&checks));
    assert!(!checks.iter().any(|c| c.name.ends_with("/reactions") || c.name.ends_with("/resultant")));
    let l2 = checks.iter().find(|c| c.name.ends_with("/pressure-l2")).expect("made");
    assert_eq!((l2.basis, l2.allowed), (Basis::Chosen, 0.25));
}

#[test]
fn a_field_that_solves_nothing_promises_no_pressure() {
    let problem = problem(4);
    let mut candidate = exact(&problem);
    candidate.reactions = None;
    candidate.is_solution = false;
    let checks = checks(&problem, candidate);
    assert!(failed(&checks).is_empty(), "{:?}", failed(&checks));
    assert!(!checks.iter().any(|c| c.name.starts_with("contact/")), "{checks:?}");
}
