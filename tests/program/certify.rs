//! `certify` on fields that are known: an exact solution, spoilt in known ways, and a solution of FEniCSx.

use std::path::Path;
use std::process::Output;

use crate::command::{case, ended, hypercircle, run, said};
use crate::fields::{Cells, FieldFile};
use hypercircle::primal::{self, PrimalError};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use serde_json::Value;

/// Two blocks of plane stress pushed together and against a wall by the pressure 1, free to widen: σ_xx = −1 alone,
/// u = ((2 − x)/E, ν y/E), and 𝓛(u) = −½ · 2/E.
const PRESSED: &str = r#"
[model]
kinematics = "plane-stress"
[geometry]
size = 0.5
[[geometry.polygons]]
body = "left"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = ["left_bottom", "left_face", "", "load"]
[[geometry.polygons]]
body = "right"
points = [[1, 0], [2, 0], [2, 1], [1, 1]]
edges = ["right_bottom", "wall", "", "right_face"]
[bodies.left]
young = 2.0
poisson = 0.25
[bodies.right]
young = 2.0
poisson = 0.25
[[supports]]
on = "left_bottom"
type = "roller"
[[supports]]
on = "right_bottom"
type = "roller"
[[supports]]
on = "wall"
type = "roller"
[[tractions]]
on = "load"
pressure = 1.0
[[contacts]]
between = ["left_face", "right_face"]
"#;
const ENERGY: f64 = -0.5;

fn exact([x, y]: [f64; 2]) -> [f64; 2] {
    [(2.0 - x) / 2.0, 0.25 * y / 2.0]
}

fn load(folder: &Path, text: &str) -> Problem {
    std::fs::write(folder.join("scene.toml"), text).expect("writable");
    Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh")
}

fn certify(folder: &Path, arguments: &[&str]) -> Output {
    let usual = ["certify", "scene.toml", "--quiet", "--out", "out"];
    run(hypercircle(folder, usual.iter().chain(arguments)))
}

fn report(folder: &Path, field: &FieldFile, exit: i32) -> Value {
    std::fs::write(folder.join("field.vtk"), field.vtk()).expect("writable");
    let output = certify(folder, &["--displacement", "field.vtk"]);
    let message = said(&output);
    let text = std::fs::read(folder.join("out/report.json")).unwrap_or_else(|_| panic!("no report: {message}"));
    let report: Value = serde_json::from_slice(&text).expect("JSON");
    let failed = failed(&report);
    assert_eq!(output.status.code(), Some(exit), "{failed:?}\n{message}");
    assert_eq!(report["status"], if exit == 0 { "agree" } else { "disagree" });
    report
}

fn failed(report: &Value) -> Vec<String> {
    let checks = report["checks"].as_array().expect("checks").iter();
    checks.filter(|c| c["passed"] == false).map(|c| c["name"].as_str().unwrap_or_default().to_string()).collect()
}

fn check<'a>(report: &'a Value, name: &str) -> &'a Value {
    of(report, "checks", name)
}

fn of<'a>(report: &'a Value, list: &str, name: &str) -> &'a Value {
    let checks = report[list].as_array().expect("a list");
    checks.iter().find(|c| c["name"] == name).unwrap_or_else(|| panic!("no check {name}"))
}

#[test]
fn the_exact_field_closes_the_bracket_in_any_numbering() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    let plain = FieldFile::new(&problem, Cells::Linear, |_, p| exact(p));
    let quadratic = FieldFile::new(&problem, Cells::Quadratic, |_, p| exact(p));
    let fields =
        [plain.clone(), plain.clone().reversed(), plain.clone().merged(), plain.split(), quadratic.clone().reversed()];
    for field in fields {
        let report = report(folder.path(), &field, 0);
        let energy = &report["energy"];
        for key in ["lower", "upper"] {
            assert!((energy[key].as_f64().expect("a number") - ENERGY).abs() < 1e-12, "{energy}");
        }
        assert!((report["primal"][0]["energy"].as_f64().expect("a number") - ENERGY).abs() < 1e-13);
        assert_eq!(report["primal"][0]["degree"], if field.is_quadratic() { 2 } else { 1 });
        assert_eq!(report["primal"][0]["name"], "field.vtk");
    }
}

#[test]
fn the_files_of_dolfinx_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    for cells in [Cells::Linear, Cells::Quadratic] {
        let field = FieldFile::new(&problem, cells, |_, p| exact(p)).reversed();
        std::fs::write(folder.path().join("u.vtu"), field.vtu()).expect("writable");
        let output = certify(folder.path(), &["--displacement", "u.vtu"]);
        ended("u.vtu", &output, 0, &[]);
    }
}

#[test]
fn a_field_of_the_wrong_size_is_measured_exactly() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    // 𝓛(su) − 𝓛(u) = (s − 1)² 𝒮 for the exact u, so the guaranteed error is |s − 1|.
    for (scale, usual) in [(0.5, false), (1.1, true), (-1.0, false)] {
        let field = FieldFile::new(&problem, Cells::Linear, |_, p| exact(p).map(|u| scale * u));
        let report = report(folder.path(), &field, 0);
        let remark = of(&report, "remarks", "certified/field.vtk/energy-error");
        let error = remark["value"].as_f64().expect("a number");
        assert!((error - f64::abs(scale - 1.0)).abs() < 1e-6, "{scale}: {error}");
        assert_eq!(remark["passed"], usual);
        assert!(failed(&report).is_empty());
        // How wrong a field may be is for its owner to say.
        for (allowed, exit) in [(1.01, 0), (0.99, 1)] {
            let allowance = format!("energy-error={}", allowed * f64::abs(scale - 1.0));
            let output = certify(folder.path(), &["--displacement", "field.vtk", "--allow", &allowance]);
            assert_eq!(output.status.code(), Some(exit), "{scale} with {allowance}");
        }
    }
}

#[test]
fn a_field_that_penetrates_or_leaves_its_support_is_not_admissible_and_its_repair_is_bounded() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    let depth = 1e-3;
    let shift = |body: usize, p: [f64; 2], by: [f64; 2]| {
        let u = exact(p);
        if body == 0 { [u[0] + by[0], u[1] + by[1]] } else { u }
    };
    let mut sabotaged = vec![
        FieldFile::new(&problem, Cells::Linear, |b, p| shift(b, p, [depth, 0.0])),
        FieldFile::new(&problem, Cells::Linear, |b, p| shift(b, p, [0.0, depth])),
    ];
    // Only one midpoint of a contact edge: nothing shows at the vertices.
    let mut bulge = FieldFile::new(&problem, Cells::Quadratic, |_, p| exact(p));
    bulge.at(&problem, problem.interfaces[0].pairs[0].edges[0].expect("an edge"))[0] += depth;
    sabotaged.push(bulge);
    for (number, field) in sabotaged.iter().enumerate() {
        let report = report(folder.path(), field, 1);
        assert_eq!(failed(&report), ["admissible/field.vtk"], "{number}");
        let violation = check(&report, "admissible/field.vtk")["value"].as_f64().expect("a number");
        let factor = [1.0, 1.0, 2.0][number];
        let expected = factor * depth / field.largest();
        assert!((violation - expected).abs() < 1e-6 * expected, "{number}: {violation} for {expected}");
        assert_eq!(report["primal"][0]["admissible"], false);
        if number == 0 {
            let why = check(&report, "admissible/field.vtk")["why"].to_string();
            assert!(why.contains("left_face|right_face") && why.contains("of the file, at (1, "), "{why}");
        }
        let upper = report["energy"]["upper"].as_f64().expect("a number");
        assert!(upper >= ENERGY && check(&report, "energy/lower-below/field.vtk")["passed"] == true);
        let notes = report["notes"].to_string();
        assert!(notes.contains("nearest admissible field"), "{notes}");
    }
}

#[test]
fn a_solution_of_fenicsx_keeps_its_energy_through_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(case("two_blocks")).expect("the case");
    let problem = load(folder.path(), &text.replace("size = 0.125", "size = 0.3"));
    let solutions = match primal::run(&problem, &[], &primal::Options::default()) {
        Err(PrimalError::NotInstalled(reason)) => return eprintln!("skipped: {reason}"),
        outcome => outcome.expect("a solution"),
    };
    let solution = solutions.iter().find(|s| s.degree == 2).expect("P2");
    let own = solution.energy.expect("told");
    let mut field = FieldFile::new(&problem, Cells::Quadratic, |_, _| [0.0; 2]);
    let middle = solution.edge_displacement.as_ref().expect("degree 2");
    field.values = solution.vertex_displacement.iter().chain(middle).copied().collect();
    let report = report(folder.path(), &field.reversed(), 0);
    let energy = report["primal"][0]["energy"].as_f64().expect("a number");
    assert!((energy - own).abs() < 1e-10, "{energy} for {own}");
    // The free bound, whose triangles are split, may be the lower one.
    let upper = report["energy"]["upper"].as_f64().expect("a number");
    assert!(upper < own + 1e-7, "{upper} for {own}");
    assert_eq!(report["primal"][0]["admissible"], true);
    assert_eq!(check(&report, "energy/lower-below/field.vtk")["passed"], true);
}

#[test]
fn a_file_that_cannot_be_used_is_refused_in_one_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    let plain = FieldFile::new(&problem, Cells::Linear, |_, p| exact(p));
    let other = load(folder.path(), &PRESSED.replace("size = 0.5", "size = 0.25"));
    let other = FieldFile::new(&other, Cells::Linear, |_, p| exact(p));
    load(folder.path(), PRESSED);
    let spoilt = |change: &dyn Fn(&mut FieldFile)| {
        let mut field = plain.clone();
        change(&mut field);
        field.vtk()
    };
    let twice = format!("{}VECTORS U double\n{}", plain.vtk().replace("displacement", "u"), plain.rows());
    let cases: Vec<(String, &[&str])> = vec![
        (other.vtk(), &["triangle 1 with the corners", "not in the mesh", "[mesh]"]),
        (spoilt(&|f| drop(f.cells.pop())), &["of the scene's mesh is not in it", "[mesh]"]),
        (spoilt(&|f| f.cells.push(f.cells[0].clone())), &["there twice, as cell 1"]),
        (spoilt(&|f| f.values[3][1] = f64::NAN), &["no finite displacement at point 4 ("]),
        (spoilt(&|f| f.values[3] = [0.0, f64::INFINITY]), &["no finite displacement at point 4 ("]),
        (spoilt(&|f| f.points[2][0] += 0.01), &["is not in the mesh"]),
        (plain.clone().split().torn().vtk(), &["jumps inside a body, at ("]),
        (plain.vtk().replace("displacement", "velocity"), &["point data: velocity", "--field"]),
        (plain.vtk().replace("VECTORS displacement double", "SCALARS u double 1\nLOOKUP_TABLE default"), &["vtk"]),
        (twice, &["several fields", "U, u", "--field"]),
        ("garbage".to_string(), &["meshio cannot read it"]),
        (String::new(), &["meshio cannot read it"]),
    ];
    for (text, fragments) in &cases {
        std::fs::write(folder.path().join("field.vtk"), text).expect("writable");
        refused(folder.path(), &["--displacement", "field.vtk"], fragments);
    }
    std::fs::write(folder.path().join("field.vtk"), plain.vtk()).expect("writable");
    refused(folder.path(), &["--displacement", "nowhere.vtu"], &["nowhere.vtu", "cannot be opened"]);
    std::fs::write(folder.path().join("job.frd"), "    1C\n").expect("writable");
    refused(folder.path(), &["--displacement", "job.frd"], &["job.frd", "OUTPUT=2D", "ccx2paraview"]);
    refused(folder.path(), &["--displacement", "."], &["this is a directory"]);
    refused(folder.path(), &["--displacement", "field.vtk", "--field", "w"], &["no point data 'w'", "displacement"]);
    refused(folder.path(), &["--displacement", "field.vtk", "--refine", "1"], &["--refine", "--tolerance"]);
    refused(folder.path(), &["--displacement", "field.vtk", "--allow", "nonsense=1"], &["nonsense"]);
}

#[test]
fn pressure_that_no_edge_can_express_asks_for_another_mesh_and_another_field() {
    let folder = tempfile::tempdir().expect("a folder");
    let hard = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/pressed_at_the_end_of_a_contact.toml");
    let text = std::fs::read_to_string(hard).expect("a scene");
    let faceted = text.replace("gap = 0.0\n", "gap = 0.0\nnormals = \"facets\"\n");
    let problem = load(folder.path(), &faceted);
    let field = FieldFile::new(&problem, Cells::Linear, |_, _| [0.0; 2]);
    std::fs::write(folder.path().join("field.vtk"), field.vtk()).expect("writable");
    let output = certify(folder.path(), &["--displacement", "field.vtk"]);
    ended("certify", &output, 3, &["less than the last third of an edge", "of the finer one", "normals = \"smooth\""]);
    // What brings no field along is solved on a mesh that is divided there.
    let output = run(hypercircle(folder.path(), ["solve", "scene.toml", "--out", "out"]));
    ended("solve", &output, 0, &[]);
    let report = std::fs::read_to_string(folder.path().join("out/report.json")).expect("a report");
    assert!(report.contains("divided at the ends of contact"), "{report}");
}

fn refused(folder: &Path, arguments: &[&str], fragments: &[&str]) {
    ended(&arguments.join(" "), &certify(folder, arguments), 2, fragments);
    assert!(!folder.join("out").exists(), "{arguments:?}");
}

#[test]
fn a_baseline_is_written_and_held_against() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = load(folder.path(), PRESSED);
    let write = |scale: f64| {
        let field = FieldFile::new(&problem, Cells::Linear, |_, p| exact(p).map(|u| scale * u));
        std::fs::write(folder.path().join("field.vtk"), field.vtk()).expect("writable");
    };
    let arguments = ["--displacement", "field.vtk", "--baseline", "b.json"];
    write(1.1);
    assert_eq!(certify(folder.path(), &[&arguments[..], &["--accept"]].concat()).status.code(), Some(0));
    assert_eq!(certify(folder.path(), &arguments).status.code(), Some(0));
    write(1.11);
    assert_eq!(certify(folder.path(), &arguments).status.code(), Some(1));
}
