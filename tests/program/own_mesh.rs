//! Fields on the mesh of a scene whose contacts put vertices into it: the file has the triangles from before, in any numbering.

use std::path::Path;

use crate::command::{case, ended, hypercircle, run};
use crate::fields::FieldFile;
use crate::random::Random;
use hypercircle::mesh::files::gmsh;
use serde_json::Value;

/// Two blocks; contact puts a vertex into the lower one beside the middle of its side, 9e-6 from it.
const BESIDE: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "beside.msh"
[bodies.lower]
young = 1.0
poisson = 0.3
[bodies.upper]
young = 1.0
poisson = 0.3
[[supports]]
on = "ground"
type = "clamped"
[[tractions]]
on = "top"
pressure = 0.01
[[contacts]]
between = ["low", "up"]
"#;

/// A displacement that is not linear and does not depend on the body.
fn displacement([x, y]: [f64; 2]) -> [f64; 2] {
    [1e-3 * (x * y + 0.3 * y), -2e-3 * (1.0 + y) * (1.0 + 0.1 * x * x)]
}

/// The linear field on the points and triangles of a mesh file.
fn on_file(file: &Path) -> FieldFile {
    let bytes = std::fs::read(file).expect("a mesh");
    let (raw, _) = gmsh::parse(&bytes, file).expect("a mesh");
    let shared = raw.shared.iter().flat_map(|shared| shared.triangles.iter().copied());
    let cells = raw.triangles.iter().map(|(nodes, _)| *nodes).chain(shared).map(|nodes| nodes.to_vec()).collect();
    let values = raw.points.iter().map(|p| displacement(*p)).collect();
    FieldFile { points: raw.points, cells, values }
}

/// The field with points and triangles renumbered, and with cells turned and started elsewhere.
fn shuffled(field: &FieldFile, random: &mut Random) -> FieldFile {
    let mut shuffle = |count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        (1..count).for_each(|i| order.swap(i, random.below(i + 1)));
        order
    };
    let (points, cells) = (shuffle(field.points.len()), shuffle(field.cells.len()));
    let mut place = vec![0; points.len()];
    points.iter().enumerate().for_each(|(new, old)| place[*old] = new);
    let cell = |old: &usize| {
        let mut nodes: Vec<usize> = field.cells[*old].iter().map(|n| place[*n]).collect();
        nodes.rotate_left(random.below(3));
        if random.chance(0.5) {
            nodes.reverse();
        }
        nodes
    };
    FieldFile {
        cells: cells.iter().map(cell).collect(),
        points: points.iter().map(|old| field.points[*old]).collect(),
        values: points.iter().map(|old| field.values[*old]).collect(),
    }
}

/// The field with coordinates of six digits.
fn rounded(field: &FieldFile) -> FieldFile {
    let round = |x: f64| format!("{x:.5e}").parse().expect("a number");
    FieldFile { points: field.points.iter().map(|p| p.map(round)).collect(), ..field.clone() }
}

/// The energy that `certify` finds in a field.
fn energy(folder: &Path, field: &FieldFile) -> f64 {
    std::fs::write(folder.join("field.vtk"), field.vtk()).expect("writable");
    let output = run(hypercircle(
        folder,
        [
            "certify",
            "scene.toml",
            "--displacement",
            "field.vtk",
            "--quiet",
            "--allow",
            "admissible/field.vtk=1e9",
            "--out",
            "out",
        ],
    ));
    ended("certify", &output, 0, &[]);
    let text = std::fs::read_to_string(folder.join("out/report.json")).expect("a report");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    report["primal"][0]["energy"].as_f64().expect("an energy")
}

/// 𝓛 of a linear field on the scene `BESIDE`: λ = 0.3/0.52, μ = 1/2.6, and the pressure on y = 1.
fn energy_beside(field: &FieldFile) -> f64 {
    let (lambda, mu) = (0.3 / (1.3 * 0.4), 1.0 / 2.6);
    let mut energy = 0.0;
    for cell in &field.cells {
        let p = [0, 1, 2].map(|i| field.points[cell[i]]);
        let u = [0, 1, 2].map(|i| field.values[cell[i]]);
        let twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        let slope = |c: usize| {
            let [a, b] = [u[1][c] - u[0][c], u[2][c] - u[0][c]];
            [
                (a * (p[2][1] - p[0][1]) - b * (p[1][1] - p[0][1])) / twice,
                (b * (p[1][0] - p[0][0]) - a * (p[2][0] - p[0][0])) / twice,
            ]
        };
        let ([xx, xy], [yx, yy]) = (slope(0), slope(1));
        let shear = 0.5 * (xy + yx);
        let density = 0.5 * lambda * (xx + yy).powi(2) + mu * (xx * xx + yy * yy + 2.0 * shear * shear);
        energy += 0.5 * twice.abs() * density;
    }
    // Between the corners of the block above the field is linear.
    let [left, right] = [[0.0, 1.0], [1.0, 1.0]].map(|p| displacement(p)[1]);
    energy + 0.01 * 0.5 * (left + right)
}

#[test]
fn a_field_on_the_file_of_a_mesh_is_read_in_any_numbering() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut random = Random::new(17);
    for name in ["beside", "cylinder_on_block"] {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let (mesh, scene) = match name {
            "beside" => (root.join("tests/meshes/beside.msh"), BESIDE.to_string()),
            _ => (root.join(format!("cases/{name}.msh")), std::fs::read_to_string(case(name)).expect("the case")),
        };
        std::fs::write(folder.join("scene.toml"), scene).expect("writable");
        std::fs::copy(&mesh, folder.join(format!("{name}.msh"))).expect("writable");
        let field = on_file(&mesh);
        let first = energy(folder, &field);
        if name == "beside" {
            let own = energy_beside(&field);
            assert!((first - own).abs() < 1e-9 * own.abs(), "{first} for {own}");
        }
        let shuffled = shuffled(&field, &mut random);
        for (what, other) in [("rounded", rounded(&shuffled)), ("shuffled", shuffled)] {
            let found = energy(folder, &other);
            assert!((found - first).abs() < 1e-9 * first.abs(), "{name}, {what}: {found} for {first}");
        }
    }
}

#[test]
fn a_field_of_another_mesh_is_refused_with_its_triangle() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/beside.msh");
    std::fs::write(folder.join("scene.toml"), BESIDE).expect("writable");
    std::fs::copy(&mesh, folder.join("beside.msh")).expect("writable");
    let field = on_file(&mesh);
    let mut moved = field.clone();
    moved.points[2][1] += 0.05;
    let mut fewer = field;
    fewer.cells.pop();
    for (other, fragment) in [(moved, "is not in the mesh of the scene"), (fewer, "of the scene's mesh is not in it")] {
        std::fs::write(folder.join("field.vtk"), other.vtk()).expect("writable");
        let output = run(hypercircle(folder, ["certify", "scene.toml", "--displacement", "field.vtk", "--quiet"]));
        ended("certify", &output, 2, &[fragment, "name it as file under [mesh]"]);
    }
}
