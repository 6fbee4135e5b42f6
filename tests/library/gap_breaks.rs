//! Gap tables beside the vertices that they mean, and tables that stand for curves.

use crate::support::toml::Toml;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

/// A block 10 wide with a vertex at `vertex` on its foot, above an obstacle.
fn foot(vertex: f64, gap: &str) -> Problem {
    let corners = [[0.0, 0.0], [vertex, 0.0], [10.0, 0.0], [10.0, 3.0], [0.0, 3.0]];
    let text = Toml::default()
        .polygon("block", &corners, ["foot", "foot", "", "top", "axis"])
        .roller("axis")
        .pressure("top", 0.01)
        .table(&format!("[[contacts]]\non = \"foot\"\ngap = {gap}"))
        .text();
    let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).expect("a problem")
}

fn weakened(problem: &Problem) -> bool {
    problem.notes.iter().any(|note| note.weakens_guarantee)
}

/// gmsh writes 6.1999999999897 for 6.2.
#[test]
fn a_break_point_a_rounding_error_from_a_vertex_is_that_vertex_and_stays_it() {
    let coarse = foot(6.1999999999897, "[[0.0, 0.0], [6.2, 0.0], [10.0, 0.038]]");
    let mut marked = coarse.clone();
    let mut refinement = hypercircle::mesh::refinement::bisect::RefinementEdges::longest(&marked.mesh);
    for _ in 0..3 {
        let all: Vec<usize> = (0..marked.mesh.triangles.len()).collect();
        (marked, refinement, _) = marked.bisect(&refinement, &all).expect("refines");
    }
    for problem in [coarse.refine_uniform(2).expect("refines"), marked, coarse] {
        assert!(!weakened(&problem), "{:?}", problem.notes);
        let pairs = &problem.interfaces[0].pairs;
        assert!(pairs.iter().all(|pair| pair.length > 0.1));
        let after = pairs.iter().find(|pair| (pair.arc[0] - 6.2).abs() < 1e-9).expect("a vertex at the break point");
        assert_eq!(after.gap[0], 0.0);
        for pair in pairs {
            for (s, g) in pair.arc.into_iter().zip(pair.gap) {
                assert!((g - 0.01 * (s - 6.2).max(0.0)).abs() < 1e-12, "{g} at {s}");
            }
        }
    }
}

/// Farther away it is another point, but no mesh can show both.
#[test]
fn a_break_point_beside_a_vertex_makes_no_sliver_and_costs_the_guarantee() {
    let problem = foot(6.2 - 1e-7, "[[0.0, 0.0], [6.2, 0.0], [10.0, 0.038]]");
    assert!(problem.interfaces[0].pairs.iter().all(|pair| pair.length > 1e-3));
    assert!(weakened(&problem), "{:?}", problem.notes);
    let apart = foot(6.2 - 1e-2, "[[0.0, 0.0], [6.2, 0.0], [10.0, 0.038]]");
    assert!(!weakened(&apart) && apart.interfaces[0].pairs.iter().any(|pair| pair.length < 0.011));
}

/// Sides that are matched along a direction interpolate a gap as those that coincide do, and say so.
#[test]
fn a_break_point_beside_a_vertex_costs_the_guarantee_along_a_direction_too() {
    for (vertex, costs) in [(6.2 - 1e-7, true), (6.2, false), (6.2 - 1e-2, false)] {
        let text = Toml::default()
            .polygon(
                "block",
                &[[0.0, 0.0], [vertex, 0.0], [10.0, 0.0], [10.0, 3.0], [0.0, 3.0]],
                ["foot", "foot", "", "top", "axis"],
            )
            .polygon("base", &[[0.0, -3.0], [10.0, -3.0], [10.0, 0.0], [0.0, 0.0]], ["ground", "", "seat", ""])
            .clamp("ground")
            .roller("axis")
            .pressure("top", 0.01)
            .table("[[contacts]]\nbetween = [\"foot\", \"seat\"]\ndirection = [0, -1]")
            .table("gap = [[0.0, 0.0], [6.2, 0.0], [10.0, 0.038]]")
            .text();
        let scene = Scene::parse(&text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let problem = Problem::load(scene).expect("a problem");
        assert_eq!(weakened(&problem), costs, "{vertex}: {:?}", problem.notes);
        let told = problem.notes.iter().any(|note| note.text.contains("the break points of the gap at s = 6.2"));
        assert_eq!(told, costs, "{vertex}: {:?}", problem.notes);
    }
}

#[test]
fn a_table_whose_kinks_the_mesh_sees_is_told_about_circle_and_parabola() {
    let rows: Vec<String> = (0..=10).map(|k| format!("[{k}.0, {:?}]", f64::from(k * k) / 100.0)).collect();
    let coarse = foot(5.0, &format!("[{}]", rows.join(", ")));
    let said = |problem: &Problem| {
        problem.notes.iter().any(|n| n.text.contains("circle = R") && n.text.contains("parabola = R"))
    };
    assert!(!said(&coarse));
    assert!(said(&coarse.refine_uniform(2).expect("refines")));
}

/// A curve is kept between vertices, a table that bends there is not.
#[test]
fn a_circle_or_a_parabola_costs_no_guarantee_and_a_bend_between_vertices_does() {
    for gap in ["{ circle = 50, at = 5 }", "{ parabola = 50, at = 5 }", "{ circle = 50, at = 4.3 }", "0.1"] {
        let coarse = foot(5.0, gap);
        let finer = coarse.refine_uniform(2).expect("refines");
        assert!(!weakened(&coarse) && !weakened(&finer), "{:?}", finer.notes);
    }
    assert!(weakened(&foot(6.2 - 1e-7, "[[0.0, 0.0], [6.2, 0.0], [10.0, 0.038]]")));
}
