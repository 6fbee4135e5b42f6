//! Fields that `certify` has to carry to the mesh of the scene, or to put together from several files.

use crate::claimed::{check, scene};
use crate::command::{ended, hypercircle, run, script};
use crate::fields::{Cells, FieldFile};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use serde_json::Value;

/// Two blocks whose contact sides have vertices of their own: one is meshed in halves, the other in thirds.
const UNEQUAL: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "blocks.msh"
[bodies.left]
young = 1.0
poisson = 0.25
[bodies.right]
young = 2.0
poisson = 0.25
[[supports]]
on = "wall"
type = "clamped"
[[supports]]
on = "bottom"
type = "roller"
[[tractions]]
on = "load"
pressure = 1.0
[[contacts]]
between = ["left_face", "right_face"]
"#;
const BLOCKS: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n7\n1 1 \"load\"\n1 2 \"bottom\"\n1 3 \"left_face\"\n\
1 4 \"right_face\"\n1 5 \"wall\"\n2 6 \"left\"\n2 7 \"right\"\n$EndPhysicalNames\n$Nodes\n13\n1 0 0 0\n2 1 0 0\n3 1 0.5 0\n4 1 1 0\n\
5 0 1 0\n6 0 0.5 0\n7 1 0 0\n8 2 0 0\n9 2 0.5 0\n10 2 1 0\n11 1 1 0\n12 1 0.375 0\n13 1 0.75 0\n$EndNodes\n$Elements\n21\n\
1 1 2 1 1 5 6\n2 1 2 1 1 6 1\n3 1 2 2 2 1 2\n4 1 2 3 3 2 3\n5 1 2 3 3 3 4\n6 1 2 4 4 7 12\n7 1 2 4 4 12 13\n8 1 2 4 4 13 11\n\
9 1 2 5 5 8 9\n10 1 2 5 5 9 10\n11 1 2 2 2 7 8\n12 2 2 6 6 1 2 3\n13 2 2 6 6 1 3 6\n14 2 2 6 6 6 3 4\n15 2 2 6 6 6 4 5\n\
16 2 2 7 7 7 8 12\n17 2 2 7 7 8 9 12\n18 2 2 7 7 12 9 13\n19 2 2 7 7 9 10 13\n20 2 2 7 7 13 10 11\n21 1 2 5 5 8 9\n$EndElements\n";

/// The mesh of `BLOCKS` with a quadratic field that closes the contact exactly.
fn unequal() -> FieldFile {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut cells = Vec::new();
    let mut section = "";
    for line in BLOCKS.lines() {
        let numbers: Vec<f64> = line.split(' ').filter_map(|w| w.parse().ok()).collect();
        match line {
            "$Nodes" | "$Elements" => section = line,
            _ if section == "$Nodes" && numbers.len() == 4 => points.push([numbers[1], numbers[2]]),
            _ if section == "$Elements" && numbers.len() == 8 => {
                cells.push(numbers[5..].iter().map(|n| *n as usize - 1).collect::<Vec<usize>>());
            }
            _ => {}
        }
    }
    for cell in &mut cells {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [points[cell[i]], points[cell[j]]];
            cell.push(points.len());
            points.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        }
    }
    let values = points.iter().map(|[x, y]| [(2.0 - x) * (0.4 + 0.1 * y), 0.1 * x * y * (2.0 - x)]).collect();
    FieldFile { points, cells, values }
}

#[test]
fn a_field_is_carried_to_vertices_that_contacts_need() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), UNEQUAL).expect("writable");
    std::fs::write(folder.join("blocks.msh"), BLOCKS).expect("writable");
    std::fs::write(folder.join("field.vtk"), unequal().vtk()).expect("writable");
    let arguments = ["certify", "scene.toml", "--displacement", "field.vtk", "--quiet", "--out", "out"];
    let output = run(hypercircle(folder, arguments));
    ended("certify", &output, 0, &[]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.join("out/report.json")).expect("a report")).expect("JSON");
    assert!(report["notes"].to_string().contains("vertices of the scene's mesh"), "{}", report["notes"]);
    assert_eq!(report["primal"][0]["degree"], 2);
    // The energy of the quadratic field by quadrature of this test, on the triangles of the file.
    let energy = report["primal"][0]["energy"].as_f64().expect("a number");
    assert!((energy - quadratic_energy()).abs() < 1e-12, "{energy} for {}", quadratic_energy());
    let output = run(hypercircle(folder, arguments.iter().chain(&["--solution"])));
    // Held to the equations of its own triangles, which the contact does not cut.
    ended("certify --solution", &output, 1, &[]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.join("out/report.json")).expect("a report")).expect("JSON");
    let residual = report["checks"].as_array().expect("checks").iter().find(|c| c["name"] == "solution/residual");
    assert_eq!(residual.expect("the check")["passed"], false);
}

/// 𝓛 of the field of [`unequal`], interpolated by quadratics, with the pressure 1 on x = 0.
fn quadratic_energy() -> f64 {
    let field = unequal();
    let mut energy = 0.0;
    for cell in &field.cells {
        let p: Vec<[f64; 2]> = cell.iter().map(|n| field.points[*n]).collect();
        let u: Vec<[f64; 2]> = cell.iter().map(|n| field.values[*n]).collect();
        let [ax, ay] = [p[1][0] - p[0][0], p[1][1] - p[0][1]];
        let [bx, by] = [p[2][0] - p[0][0], p[2][1] - p[0][1]];
        let twice = ax * by - ay * bx;
        let young = if p[..3].iter().all(|q| q[0] <= 1.0) { 1.0 } else { 2.0 };
        let (mu, lambda) = (young / 2.5, young * 0.25 / (1.25 * 0.5));
        for middle in 0..3 {
            // Reference gradients of the quadratic shape functions at the midpoint of a side.
            let [s, t] = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]][middle];
            let r = 1.0 - s - t;
            let of_s = [1.0 - 4.0 * r, 4.0 * s - 1.0, 0.0, 4.0 * (r - s), 4.0 * t, -4.0 * t];
            let of_t = [1.0 - 4.0 * r, 0.0, 4.0 * t - 1.0, -4.0 * s, 4.0 * s, 4.0 * (r - t)];
            let gradient = |c: usize| {
                let [ds, dt] = [&of_s, &of_t].map(|d| (0..6).map(|i| d[i] * u[i][c]).sum::<f64>());
                [(by * ds - ay * dt) / twice, (ax * dt - bx * ds) / twice]
            };
            let ([xx, xy], [yx, yy]) = (gradient(0), gradient(1));
            let shear = 0.5 * (xy + yx);
            let density = 0.5 * lambda * (xx + yy).powi(2) + mu * (xx * xx + yy * yy + 2.0 * shear * shear);
            energy += twice / 6.0 * density;
        }
    }
    // ∫ u_x over x = 0 of 0.8 + 0.2 y.
    energy - 0.9
}

#[test]
fn each_body_may_have_a_file_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), scene()).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    let whole = FieldFile::new(&problem, Cells::Linear, |body, _| if body == 0 { [0.1, 0.0] } else { [0.0; 2] });
    for body in 0..2 {
        let mut part = whole.clone();
        let mut of = problem.mesh.body.iter();
        part.cells.retain(|_| of.next() == Some(&body));
        std::fs::write(folder.join(format!("{body}.vtk")), part.vtk()).expect("writable");
    }
    let files = ["--displacement", "1.vtk", "--displacement", "0.vtk"];
    let usual = ["certify", "scene.toml", "--quiet", "--out", "out"];
    // The first body is pushed into the second: the contact and a point of its file are named.
    let output = run(hypercircle(folder, usual.iter().chain(&files)));
    ended("two files", &output, 1, &[]);
    let text = std::fs::read_to_string(folder.join("out/report.json")).expect("a report");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let why = check(&report, "admissible/1.vtk + 0.vtk")["why"].as_str().expect("a sentence").to_string();
    assert!(why.contains("left_face|right_face is penetrated most") && why.contains("of 0.vtk, at (1, "), "{why}");
    ended("one file", &run(hypercircle(folder, usual.iter().chain(&files[..2]))), 2, &["scene's mesh is not in it"]);
}

#[test]
fn a_field_out_of_its_plane_and_a_missing_package_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("scene.toml"), scene()).expect("writable");
    let problem = Problem::load(Scene::read(&folder.join("scene.toml")).expect("a scene")).expect("a mesh");
    let field = FieldFile::new(&problem, Cells::Linear, |_, _| [0.0; 2]).vtk();
    let [x, y] = problem.mesh.points[3];
    let tilted = field.replacen(&format!("{x:?} {y:?} 0.0"), &format!("{x:?} {y:?} 0.25"), 1);
    assert!(tilted != field);
    std::fs::write(folder.join("field.vtk"), tilted).expect("writable");
    let arguments = ["certify", "scene.toml", "--displacement", "field.vtk", "--out", "out"];
    ended("tilted", &run(hypercircle(folder, arguments)), 2, &["not in one plane", "0.25", "z = 0"]);
    let mut command = hypercircle(folder, arguments);
    command.env("HYPERCIRCLE_PYTHON", script(folder.join("python"), "echo h5py >&2; exit 45"));
    ended("h5py", &run(command), 2, &["read with the Python package h5py", "pip install h5py", "python3-h5py"]);
}
