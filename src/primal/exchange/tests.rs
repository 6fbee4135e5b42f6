use serde_json::{Value, json};

use super::*;
use crate::primal::fixture::pressed_square;
use crate::primal::{Options, Sabotage, run};
use crate::problem::Condition;

fn written(problem: &Problem, pins: &[Pin]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    write_problem(problem, pins, folder.path()).unwrap();
    serde_json::from_slice(&fs::read(folder.path().join(PROBLEM_FILE)).unwrap()).unwrap()
}

#[test]
fn conditions_become_entries_and_free_edges_none() {
    let mut problem = pressed_square();
    problem.conditions[3] = Condition::Clamped([[0.25, -0.5]; 2]);
    let pin = |vertex, of_vertices| Pin { vertex, direction: [0.0, 1.0], of_vertices };
    let pins = [pin(2, false), pin(1, true)];
    let file = written(&problem, &pins);
    assert_eq!(file["format"], "hypercircle-exchange");
    assert_eq!(file["kinematics"], "plane-stress");
    assert_eq!(file["roller"], json!([{"edge": 0, "normal": [0.0, -1.0], "displacement": 0.0}]));
    assert_eq!(file["clamped"], json!([{"edge": 3, "displacement": [0.25, -0.5]}]));
    assert_eq!(file["tractions"], json!([{"edge": 4, "values": [[2.0, 0.0], [2.0, 0.0]]}]));
    assert_eq!(file["contacts"][0]["name"], "right|rigid");
    assert_eq!(file["contacts"][0]["pairs"][0]["edges"], json!([1, null]));
    assert_eq!(file["contacts"][0]["pairs"][0]["second"], Value::Null);
    assert_eq!(file["edges"][2], json!([2, 0]));
    let told = json!([{"vertex": 2, "direction": [0.0, 1.0]}, {"vertex": 1, "direction": [0.0, 1.0], "degree": 1}]);
    assert_eq!(file["pins"], told);
    assert_eq!(written(&pressed_square(), &[])["tractions"].as_array().unwrap().len(), 1);
    assert_eq!(file["quadrilaterals"], Value::Null);
    problem.mesh.cells = crate::mesh::FileCells::find(&[[0, 1, 2, 3]], &problem.mesh.triangles);
    let cell = json!([{"corners": [1, 2, 3, 0], "triangles": [0, 1]}]);
    assert_eq!(written(&problem, &[])["quadrilaterals"], cell);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let error = write_problem(&pressed_square(), &[], &file.path().join("below")).unwrap_err();
    assert!(matches!(&error, PrimalError::Io { path, .. } if path.ends_with("below")), "{error}");
}

/// Uniform stress has a closed solution; see the fixture.
#[test]
fn fenicsx_solves_the_pressed_square() {
    for ranks in [None, Some(2)] {
        let solutions = match run(&pressed_square(), &[], &Options { ranks, ..Options::default() }) {
            Err(PrimalError::NotInstalled(reason)) => return eprintln!("skipped: {reason}"),
            outcome => outcome.unwrap(),
        };
        for (solution, degree) in solutions.iter().zip([1, 2]) {
            assert_eq!((solution.degree, solution.ranks), (degree, ranks.unwrap_or(1)));
            let [energy, strain] = [solution.energy, solution.strain_energy].map(Option::unwrap);
            assert!((energy + 1.0).abs() < 1e-12 && (strain - 1.0).abs() < 1e-12);
            assert!((solution.contacts.as_ref().unwrap()[0].resultant[0] + 1.0).abs() < 1e-12);
            for (point, u) in pressed_square().mesh.points.iter().zip(&solution.vertex_displacement) {
                assert!((u[0] - 2.0 * (1.0 - point[0])).abs() < 1e-12 && u[1].abs() < 1e-12);
            }
            assert_eq!(solution.admissible, Some(true));
        }
    }
}

#[test]
fn a_result_for_another_problem_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let options =
        Options { scratch: Some(folder.path().to_owned()), sabotage: Some(Sabotage::DropRow), ..Options::default() };
    let problem = pressed_square();
    match run(&problem, &[], &options) {
        Err(PrimalError::NotInstalled(reason)) => return eprintln!("skipped: {reason}"),
        outcome => assert!(outcome.unwrap()[0].energy.unwrap() < -1.0 - 1e-3),
    }
    let mut other = problem.clone();
    other.mesh.points.push([5.0, 5.0]);
    assert!(matches!(read_solution(folder.path(), Space::on_triangles(2), &other), Err(PrimalError::BadResult { .. })));
    let path = folder.path().join(solution_file(Space::on_triangles(1)));
    let mut told: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    assert!(told["energy_rounding"].as_f64().unwrap() < 1e-12);
    told["energy_rounding"] = json!(-1.0);
    fs::write(&path, told.to_string()).unwrap();
    let refused = read_solution(folder.path(), Space::on_triangles(1), &problem).unwrap_err().to_string();
    assert!(refused.contains("energy_rounding is -1"), "{refused}");
    told.as_object_mut().unwrap().remove("energy_rounding");
    fs::write(&path, told.to_string()).unwrap();
    assert_eq!(read_solution(folder.path(), Space::on_triangles(1), &problem).unwrap().energy_rounding, None);
    let mut other = problem;
    other.interfaces[0].name = "left|rigid".to_owned();
    assert!(matches!(read_solution(folder.path(), Space::on_triangles(1), &other), Err(PrimalError::BadResult { .. })));
}
