//! Bodies and boundaries by set, number and place, in meshes that name nothing themselves.

use std::path::{Path, PathBuf};

use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

/// A folder of its own with these files; gone with the value.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let path = std::env::temp_dir().join(format!("hypercircle-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a folder");
        for (file, text) in files {
            std::fs::write(path.join(file), text).expect("a file");
        }
        Folder(path)
    }

    fn load(&self, scene: &str) -> Result<Problem, String> {
        let scene = Scene::parse(scene, &self.0.join("scene.toml")).map_err(|e| e.to_string())?;
        Problem::load(scene).map_err(|e| e.to_string())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Two unit squares beside each other as quadrilaterals, entities 5 and 6, without physical groups.
const QUADS: &str = "$MeshFormat\n2.1 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 3\n2 1 0 3\n3 2 0 3\n4 0 1 3\n5 1 1 3\n6 2 1 3\n$EndNodes\n\
    $Elements\n3\n1 1 2 0 7 1 2\n2 3 2 0 5 1 2 5 4\n3 3 2 0 6 2 3 6 5\n$EndElements\n";

fn scene(bodies: &str, boundaries: &str, conditions: &str) -> String {
    format!("model.kinematics = \"plane-strain\"\nmesh.file = \"m.msh\"\n{bodies}\n{boundaries}\n{conditions}\n")
}

const ONE: &str = "bodies.block = { young = 1.0, poisson = 0.3 }";
const TWO: &str =
    "bodies.a = { young = 1.0, poisson = 0.3, tag = 5 }\nbodies.b = { young = 1.0, poisson = 0.3, tag = 6 }";
const FOOT: &str = "supports = [{ on = \"foot\", type = \"clamped\" }]";

/// Ends of the edges called `name`, sorted.
fn edges(problem: &Problem, name: &str) -> Vec<[[f64; 2]; 2]> {
    let mesh = &problem.mesh;
    let mut edges: Vec<[[f64; 2]; 2]> = mesh
        .boundary(name)
        .into_iter()
        .map(|e| {
            let mut ends = mesh.edges[e].vertices.map(|v| problem.scene.as_written(mesh.points[v]));
            ends.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
            ends
        })
        .collect();
    edges.sort_by(|p, q| p.partial_cmp(q).expect("finite"));
    edges
}

#[test]
fn every_way_to_choose_edges_finds_them() {
    let folder = Folder::new("ways", &[("m.msh", QUADS)]);
    let bottom = vec![[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [2.0, 0.0]]];
    for (choice, expected) in [
        ("line = [[0, 0], [2, 0]]", bottom.clone()),
        ("line = [[2, 0], [-1, 0]]", bottom.clone()),
        ("line = [[0, 0], [1, 0]]", bottom[..1].to_vec()),
        ("box = [[-1, -0.1], [3, 0.5]]", bottom.clone()),
        ("normal = [0, -3]", bottom.clone()),
        ("tag = 7", bottom[..1].to_vec()),
        (
            "normal = [1, 1], angle = 46",
            vec![[[0.0, 1.0], [1.0, 1.0]], [[1.0, 1.0], [2.0, 1.0]], [[2.0, 0.0], [2.0, 1.0]]],
        ),
        (
            "circle = { centre = [1, 0.5], radius = 1.118033988749895 }",
            vec![[[0.0, 0.0], [0.0, 1.0]], [[2.0, 0.0], [2.0, 1.0]]],
        ),
    ] {
        let boundaries = format!("boundaries = [{{ name = \"foot\", {choice} }}]");
        let problem = folder.load(&scene(ONE, &boundaries, FOOT)).unwrap_or_else(|e| panic!("{choice}: {e}"));
        assert_eq!(edges(&problem, "foot"), expected, "{choice}");
        assert_eq!(problem.mesh.triangles.len(), 4);
        assert!(problem.mesh.is_quadrilateral());
        assert!(problem.notes.iter().any(|note| note.text.contains("2 quadrilaterals")), "{choice}");
    }
}

#[test]
fn bodies_by_number_meet_in_a_contact_along_their_common_edge() {
    let folder = Folder::new("contact", &[("m.msh", QUADS)]);
    let sides = |a: &str, b: &str| {
        format!(
            "boundaries = [{{ name = \"foot\", line = [[0, 0], [0, 1]] }}, {{ name = \"{a}\", body = \"a\", line = [[1, 0], [1, 1]] }},\n\
             {{ name = \"{b}\", body = \"b\", line = [[1, 0], [1, 1]] }}, {{ name = \"end\", line = [[2, 0], [2, 1]] }}]"
        )
    };
    for between in [["left", "right"], ["right", "left"]] {
        let conditions = format!(
            "supports = [{{ on = \"foot\", type = \"clamped\" }}]\ntractions = [{{ on = \"end\", pressure = 1.0 }}]\n\
             contacts = [{{ between = [\"{}\", \"{}\"] }}]",
            between[0], between[1]
        );
        let problem = folder.load(&scene(TWO, &sides("left", "right"), &conditions)).expect("a problem");
        let mesh = &problem.mesh;
        assert_eq!(mesh.points.len(), 8, "each body has vertices of its own");
        assert!(mesh.is_quadrilateral());
        for (name, body) in [("left", 0), ("right", 1)] {
            let [edge] = *mesh.boundary(name) else { panic!("one edge is called {name}") };
            let [Some(triangle), None] = mesh.edges[edge].triangles else { panic!("an outer edge") };
            assert_eq!(mesh.body[triangle], body, "{name}");
        }
    }
}

#[test]
fn node_sets_and_surfaces_of_a_deck_are_boundaries_by_name() {
    let deck = "*NODE\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n*ELEMENT,TYPE=CPE4,ELSET=EALL\n1,1,2,5,4\n2,2,3,6,5\n\
        *NSET,NSET=foot\n1,2,3\n*ELSET,ELSET=last\n2\n*SURFACE,NAME=top\nEALL,S3\n";
    let folder = Folder::new("deck", &[("m.inp", deck)]);
    let text = scene(
        ONE,
        "",
        "supports = [{ on = \"foot\", type = \"clamped\" }]\ntractions = [{ on = \"top\", pressure = 1.0 }]",
    );
    let problem = folder.load(&text.replace("m.msh", "m.inp")).expect("a problem");
    assert_eq!((edges(&problem, "foot").len(), edges(&problem, "top").len()), (2, 2));
    assert!(edges(&problem, "top").iter().flatten().all(|p| p[1] == 1.0));
    let by_set = scene(ONE, "boundaries = [{ name = \"foot\", set = \"last\" }]", FOOT).replace("m.msh", "m.inp");
    assert_eq!(edges(&folder.load(&by_set).expect("a problem"), "foot").len(), 3, "the outline of the second cell");
    let by_name = scene(ONE, "", "supports = [{ on = \"last\", type = \"clamped\" }]").replace("m.msh", "m.inp");
    assert_eq!(edges(&folder.load(&by_name).expect("a problem"), "last").len(), 3, "the same without a table");
}

#[test]
fn polygons_take_names_for_parts_of_their_outline() {
    let text = "model.kinematics = \"plane-strain\"\nbodies.b = { young = 1.0, poisson = 0.3 }\n\
        boundaries = [{ name = \"foot\", normal = [0, -1] }]\nsupports = [{ on = \"foot\", type = \"clamped\" }]\n\
        [[geometry.polygons]]\nbody = \"b\"\nedges = [\"\", \"\", \"\", \"\"]\n\
        points = [[1000, 0], [1001, 0], [1001, 1], [1000, 1]]\n";
    let problem = Problem::load(Scene::parse(text, Path::new("p.toml")).expect("a scene")).expect("a problem");
    assert_eq!(edges(&problem, "foot"), [[[1000.0, 0.0], [1001.0, 0.0]]]);
    let moved = text.replace("normal = [0, -1]", "line = [[1000, 0], [1001, 0]]");
    let problem = Problem::load(Scene::parse(&moved, Path::new("p.toml")).expect("a scene")).expect("a problem");
    assert_eq!(edges(&problem, "foot"), [[[1000.0, 0.0], [1001.0, 0.0]]], "far from (0, 0)");
    let again = problem.scene.changed(|_| {}).expect("the same scene");
    assert_eq!(again.boundaries, problem.scene.boundaries);
}

#[test]
fn what_is_not_there_is_told_with_what_is() {
    let folder = Folder::new("wrong", &[("m.msh", QUADS)]);
    let refused = |bodies: &str, boundaries: &str, fragments: &[&str]| {
        let message = folder.load(&scene(bodies, boundaries, FOOT)).map(|_| ()).expect_err("refused");
        for fragment in fragments {
            assert!(message.contains(fragment), "'{fragment}' is not in: {message}");
        }
    };
    let one = |choice: &str| format!("boundaries = [{{ name = \"foot\", {choice} }}]");
    refused(ONE, &one("line = [[0, 5], [1, 5]]"), &["'foot'", "no edge", "(0, 0) and (2, 1)"]);
    refused(ONE, &one("tag = 8"), &["entity 8", "tags 7"]);
    refused(ONE, &one("set = \"x\""), &["set 'x'"]);
    refused(ONE, &one("tag = 7, line = [[0, 0], [1, 0]]"), &["`tag`", "`line`"]);
    refused(ONE, &one("body = \"c\", tag = 7"), &["body \"c\"", "block"]);
    refused(ONE, &one("angle = 3, tag = 7"), &["`angle`"]);
    refused(ONE, "boundaries = [{ name = \"foot\" }]", &["no `line`"]);
    refused(ONE, "", &["'foot'", "does not exist", "[[boundaries]]"]);
    refused(&TWO.replace("tag = 6", "tag = 9"), &one("tag = 7"), &["tag 9", "tags 5, 6"]);
    refused(&TWO.replace("tag = 6", "tag = 5"), &one("tag = 7"), &["'a'", "'b'"]);
}

#[test]
fn sides_that_are_curved_are_measured_and_weaken_the_guarantee() {
    // A quadrilateral with eight nodes; the one in the middle of its last side lies 0.01 beside it.
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.4 0 0\n6 1 0.5 0\n7 0.5 1 0\n\
        8 0.01 0.5 0\n$EndNodes\n$Elements\n1\n1 16 2 0 1 1 2 3 4 5 6 7 8\n$EndElements\n";
    let folder = Folder::new("curved", &[("m.msh", text)]);
    let foot = "boundaries = [{ name = \"foot\", normal = [0, -1] }]";
    let problem = folder.load(&scene(ONE, foot, FOOT)).expect("a problem");
    let note = problem.notes.iter().find(|note| note.weakens_guarantee).expect("a note");
    assert!(problem.mesh.is_quadrilateral());
    assert!(note.text.contains("1 curved side") && note.text.contains("1.00e-2"), "{}", note.text);
}
