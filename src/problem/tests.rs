//! Conditions and contact pairs on small meshes.

use super::{Condition, Problem};
use crate::mesh::Triangulation;
use crate::mesh::refinement::bisect::RefinementEdges;
use crate::mesh::testing::*;
use crate::scene::{Affine, Contact, ContactSides, Gap, Load, Scene, Support, SupportKind};

fn two_blocks(gap: Gap, n: usize) -> Scene {
    let polygons = vec![rectangle("a", [0.0; 2], [1.0; 2]), rectangle("b", [1.0, 0.0], [2.0, 1.0])];
    let scene = geometry(scene(&["a", "b"]), Some(1.0 / n as f64), polygons);
    let scene = load(
        clamp(scene, "b_right"),
        "a_left",
        Load::Affine(Affine { value: [4.0, 0.0], gradient: [[0.0, -7.0], [0.5, 0.0]] }),
    );
    let mut scene = load(scene, "a_top", Load::Pressure(2.0));
    scene.draft.supports.push(Support { on: "a_bottom".into(), kind: SupportKind::ROLLER });
    contact(scene, "a_right", "b_left", gap)
}

/// Asserts the invariants of every problem: each contact edge in one pair, the sides opposite, the normal outward.
fn assert_paired(problem: &Problem) {
    let mesh = &problem.mesh;
    let mut met = 0;
    for (i, interface) in problem.interfaces.iter().enumerate() {
        for (p, pair) in interface.pairs.iter().enumerate() {
            for (side, edge) in pair.edges.iter().enumerate() {
                let Some(e) = edge else { continue };
                assert_eq!(problem.conditions[*e], Condition::Contact { interface: i, pair: p, side });
                met += 1;
            }
            if let Some(second) = pair.second {
                assert_eq!(pair.first.map(|v| mesh.points[v]), second.map(|v| mesh.points[v]));
                let opposite = mesh.edge_frame(pair.edges[1].expect("a second side")).1;
                assert_eq!(pair.normal, opposite.map(|n| -n));
            }
            assert!((pair.arc[1] - pair.arc[0] - pair.length).abs() < 1e-14);
        }
        for two in interface.pairs.windows(2) {
            assert_eq!(two[0].arc[1], two[1].arc[0]);
        }
    }
    assert_eq!(met, problem.conditions.iter().filter(|c| matches!(c, Condition::Contact { .. })).count());
}

#[test]
fn conditions_follow_the_names() {
    let problem = Problem::load(two_blocks(Gap::Constant(0.25), 4)).expect("a good scene");
    assert_paired(&problem);
    let mesh = &problem.mesh;
    for (e, edge) in mesh.edges.iter().enumerate() {
        let middle = [0, 1].map(|k| 0.5 * edge.vertices.iter().map(|&v| mesh.points[v][k]).sum::<f64>());
        match problem.conditions[e] {
            Condition::Interior => assert!(!edge.is_boundary()),
            Condition::Axis => panic!("no axis in the plane"),
            Condition::Clamped(u) => assert_eq!((middle[0], u), (2.0, [[0.0; 2]; 2])),
            Condition::Roller { .. } => assert!(middle[1] == 0.0 && middle[0] < 1.0),
            Condition::Contact { .. } => assert_eq!(middle[0], 1.0),
            Condition::Elastic { .. } => panic!("no springs here"),
            Condition::Traction(p) if middle[0] == 0.0 => {
                for (v, p) in edge.vertices.iter().zip(p) {
                    assert_eq!(p, [4.0 - 7.0 * mesh.points[*v][1], 0.5 * mesh.points[*v][0]]);
                }
            }
            Condition::Traction(p) if middle[1] == 1.0 && middle[0] < 1.0 => assert_eq!(p, [[0.0, -2.0]; 2]),
            Condition::Traction(p) => assert_eq!(p, [[0.0; 2]; 2]),
        }
    }
    let pairs = &problem.interfaces[0].pairs;
    assert_eq!((pairs.len(), pairs[0].arc, pairs[0].gap), (4, [0.0, 0.25], [0.25; 2]));
    assert_eq!(mesh.points[pairs[0].first[0]], [1.0, 0.0]);
    assert!(pairs.iter().all(|p| p.normal == [1.0, 0.0]));
}

#[test]
fn uniform_refinement_keeps_everything_but_the_size() {
    let gap = Gap::Table(vec![[0.0, 0.0], [0.3, 0.2], [1.0, 0.2]]);
    let coarse = Problem::load(two_blocks(gap.clone(), 2)).expect("a good scene");
    let fine = coarse.refine_uniform(2).expect("refines");
    assert_consistent(&fine.mesh);
    assert_paired(&fine);
    assert_eq!(fine.mesh.triangles.len(), 16 * coarse.mesh.triangles.len());
    assert!((total_area(&fine.mesh) - 2.0).abs() < 1e-14);
    assert_eq!((euler(&fine.mesh), lengths(&fine.mesh)), (2, lengths(&coarse.mesh)));
    assert_eq!(fine.notes, coarse.notes);
    for pair in &fine.interfaces[0].pairs {
        for k in 0..2 {
            assert_eq!(pair.arc[k], fine.mesh.points[pair.first[k]][1]);
            assert!((pair.gap[k] - gap.at(pair.arc[k])).abs() < 1e-15);
        }
    }
    assert!(smallest_angle(&fine.mesh) > smallest_angle(&coarse.mesh) - 1e-9);
}

#[test]
fn arc_length_goes_on_over_the_pieces_of_a_side() {
    // The teeth of a comb rest on the ground; the left one comes first.
    let mut scene = scene(&["a"]);
    let mut raw = both(grid("a", [2.0, 0.0], [3.0, 1.0], [2, 1]), grid("a", [0.0, 0.0], [1.0, 1.0], [4, 1]));
    raw.segments.retain(|s| s.1 == "a_bottom");
    scene.draft.contacts.push(Contact::new(
        ContactSides::Rigid("a_bottom".into()),
        Gap::Table(vec![[0.0, 0.0], [1.25, 0.5], [2.0, 0.5]]),
    ));
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a good mesh");
    let problem = Problem::new(scene, mesh, notes).expect("a good scene");
    assert_paired(&problem);
    let interface = &problem.interfaces[0];
    let arcs: Vec<f64> = interface.pairs.iter().map(|p| p.arc[0]).collect();
    assert_eq!((interface.name.as_str(), arcs), ("a_bottom|rigid", vec![0.0, 0.25, 0.5, 0.75, 1.0, 1.5]));
    assert_eq!(problem.mesh.points[interface.pairs[4].first[0]], [2.0, 0.0]);
    assert!(interface.pairs.iter().all(|p| p.normal == [0.0, -1.0] && p.second.is_none()));
    let weak: Vec<_> = problem.notes.iter().filter(|n| n.weakens_guarantee).collect();
    assert_eq!(weak.len(), 1);
    assert!(weak[0].text.contains("at s = 1.25 are no vertices"));
}

#[test]
fn sides_that_do_not_match_are_refused() {
    let raw = both(grid("a", [0.0; 2], [1.0; 2], [2, 2]), grid("b", [1.0, 0.0], [2.0, 1.0], [2, 3]));
    let scene = contact(scene(&["a", "b"]), "a_right", "b_left", Gap::Constant(0.0));
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a good mesh");
    let message = Problem::new(scene, mesh, notes).expect_err("sides differ").to_string();
    for fragment in ["contact 'a_right|b_left'", "no edge opposite", "make the two sides coincide"] {
        assert!(message.contains(fragment), "{message}");
    }
}

#[test]
fn bisection_keeps_the_contact_matched() {
    let mut problem = Problem::load(two_blocks(Gap::Constant(0.0), 3)).expect("a good scene");
    let mut refinement = RefinementEdges::longest(&problem.mesh);
    for round in 0..6 {
        // Only triangles of the first body are marked; the second has to follow along the contact.
        let at_contact = |t: &usize| {
            let conditions = problem.mesh.triangle_edges[*t].map(|e| problem.conditions[e]);
            conditions.iter().any(|c| matches!(c, Condition::Contact { side: 0, .. }))
        };
        let marked: Vec<usize> = (0..problem.mesh.triangles.len()).filter(at_contact).collect();
        let before = problem.interfaces[0].pairs.len();
        let parent;
        (problem, refinement, parent) = problem.bisect(&refinement, &marked).expect("refines");
        assert_eq!(parent.len(), problem.mesh.triangles.len());
        assert_consistent(&problem.mesh);
        assert_paired(&problem);
        assert!(round < 2 || problem.interfaces[0].pairs.len() > before);
        assert!((total_area(&problem.mesh) - 2.0).abs() < 1e-13);
    }
}
