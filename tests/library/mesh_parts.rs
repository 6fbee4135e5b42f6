//! Several mesh files in one scene: prefixes, scale and place, and names that clash.

use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use tempfile::TempDir;

/// A unit square of two triangles; the bottom is a physical curve 7, the square the physical surface 3 called `block`.
fn square(named: bool) -> String {
    let names = "$PhysicalNames\n2\n1 7 \"foot\"\n2 3 \"block\"\n$EndPhysicalNames\n";
    let (names, group) = if named { (names, "3") } else { ("", "0") };
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n\
         $Elements\n3\n1 1 2 7 7 1 2\n2 2 2 {group} 3 1 2 3\n3 2 2 {group} 3 1 3 4\n$EndElements\n"
    )
}

fn load(folder: &TempDir, mesh: &str, rest: &str) -> Result<Problem, String> {
    let text = format!("model.kinematics = \"plane-strain\"\n{rest}\n{mesh}");
    let scene = Scene::parse(&text, &folder.path().join("scene.toml")).map_err(|e| format!("{e} {}", e.remedy()))?;
    Problem::load(scene).map_err(|e| e.to_string())
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.msh"), square(true)).expect("a file");
    std::fs::write(folder.path().join("b.msh"), square(false)).expect("a file");
    folder
}

const MATERIAL: &str = "young = 1.0, poisson = 0.3";

#[test]
fn parts_are_scaled_and_placed_and_meet_in_a_contact() {
    let folder = folder();
    let parts = "[[mesh.parts]]\nfile = \"a.msh\"\nprefix = \"low_\"\nscale = 2.0\ntranslate = [-0.5, -2.0]\n\
                 [[mesh.parts]]\nfile = \"a.msh\"\nprefix = \"high_\"\n";
    let rest = format!(
        "bodies.low_block = {{ {MATERIAL} }}\nbodies.high_block = {{ {MATERIAL} }}\n\
         supports = [{{ on = \"low_foot\", type = \"clamped\" }}]\n\
         boundaries = [{{ name = \"seat\", body = \"low_block\", line = [[-0.5, 0], [1.5, 0]] }},\n\
                       {{ name = \"lid\", body = \"high_block\", line = [[0, 1], [1, 1]] }}]\n\
         tractions = [{{ on = \"lid\", pressure = 1.0 }}]\n\
         contacts = [{{ between = [\"seat\", \"high_foot\"], direction = [0, 1] }}]"
    );
    let problem = load(&folder, parts, &rest).expect("a problem");
    let area = |body: usize| -> f64 {
        let mesh = &problem.mesh;
        let own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body).map(|t| mesh.corners(t));
        own.map(|[p, q, r]| 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))).sum()
    };
    let of = |name: &str| problem.scene.bodies.iter().position(|body| body.name == name).expect("a body");
    assert!((area(of("low_block")) - 4.0).abs() < 1e-12 && (area(of("high_block")) - 1.0).abs() < 1e-12);
    let [edge] = *problem.mesh.boundary("low_foot") else { panic!("one edge") };
    let mut ends = problem.mesh.edges[edge].vertices.map(|v| problem.scene.as_written(problem.mesh.points[v]));
    ends.sort_by(|p, q| p[0].total_cmp(&q[0]));
    assert_eq!(ends, [[-0.5, -2.0], [1.5, -2.0]]);
}

#[test]
fn cells_without_a_name_are_called_by_the_prefix_and_tags_are_those_of_the_file() {
    let folder = folder();
    let parts =
        "[[mesh.parts]]\nfile = \"a.msh\"\n[[mesh.parts]]\nfile = \"b.msh\"\nprefix = \"pad_\"\ntranslate = [3, 0]\n";
    let rest = |on: &str| {
        format!(
            "bodies.block = {{ {MATERIAL} }}\nbodies.pad = {{ {MATERIAL} }}\n\
             supports = [{{ on = \"foot\", type = \"clamped\" }}, {{ on = \"{on}\", type = \"clamped\" }}]"
        )
    };
    let problem = load(&folder, parts, &rest("pad_7")).expect("a problem");
    assert_eq!((problem.mesh.boundary("foot").len(), problem.mesh.boundary("pad_7").len()), (1, 1));
    let error = load(&folder, parts, &rest("pad_foot")).expect_err("no such boundary");
    assert!(error.contains("pad_7") && error.contains("hypercircle mesh FILE"), "{error}");
    let alone = "[[mesh.parts]]\nfile = \"b.msh\"\nprefix = \"pad_\"\n";
    let by_tag = format!(
        "bodies.block = {{ {MATERIAL}, tag = 3 }}\nboundaries = [{{ name = \"foot\", tag = 7 }}]\n\
         supports = [{{ on = \"foot\", type = \"clamped\" }}]"
    );
    assert_eq!(load(&folder, alone, &by_tag).expect("a problem").mesh.boundary("foot").len(), 1);
}

#[test]
fn what_is_not_clear_is_refused() {
    let folder = folder();
    let two = |keys: &str| {
        format!(
            "[[mesh.parts]]\nfile = \"a.msh\"\nprefix = \"one_\"\n[[mesh.parts]]\nfile = \"a.msh\"\ntranslate = [2, 0]\n{keys}\n"
        )
    };
    let bodies = |extra: &str| format!("bodies.one_block = {{ {MATERIAL} }}\nbodies.block = {{ {MATERIAL} }}\n{extra}");
    let foot = "supports = [{ on = \"foot\", type = \"clamped\" }]";
    for (mesh, rest, expected) in [
        (two("prefix = \"one_\""), bodies(foot), vec!["'one_block'", "a.msh", "`prefix`"]),
        (
            two(""),
            bodies("boundaries = [{ name = \"x\", tag = 7 }]\nsupports = [{ on = \"x\", type = \"clamped\" }]"),
            vec!["tag 7", "`set`"],
        ),
        (
            "[mesh]\nfile = \"a.msh\"\n[[mesh.parts]]\nfile = \"a.msh\"\n".into(),
            bodies(""),
            vec!["`file`", "[[mesh.parts]]"],
        ),
        ("[mesh]\n".into(), bodies(""), vec!["`file`", "[[mesh.parts]]"]),
        (two("scale = 0"), bodies(foot), vec!["scale", "number 2", "positive"]),
        (two("").replace("[2, 0]", "[1]"), bodies(foot), vec!["translate", "number 2"]),
        (two("offset = 1"), bodies(foot), vec!["offset"]),
        (two("").replace("a.msh", "c.msh"), bodies(foot), vec!["c.msh", "cannot be opened"]),
    ] {
        let error = load(&folder, &mesh, &rest).expect_err(&mesh);
        assert!(expected.iter().all(|word| error.contains(word)), "{expected:?}: {error}");
    }
    load(&folder, &two(""), &bodies(foot)).expect("nothing clashes");
}
