//! Results of CalculiX 2.20, as it writes them, on the deck that they were computed from.

use std::path::Path;

use crate::command::{ended, hypercircle, run};

const DECK: &str = "\
*NODE, NSET=NALL
1,0,0,0
2,1,0,0
3,2,0,0
4,0,1,0
5,1,1,0
6,2,1,0
*ELEMENT, TYPE=CPE3, ELSET=PLATE
1,1,2,5
2,1,5,4
3,2,3,6
4,2,6,5
*NSET,NSET=WALL
1,4
*NSET,NSET=LOAD
3,6
*MATERIAL,NAME=M
*ELASTIC
1000.,0.3
*SOLID SECTION,ELSET=PLATE,MATERIAL=M
1.
*BOUNDARY
WALL,1,2
*STEP
*STATIC
*DLOAD
3,P2,10.
*NODE FILE, OUTPUT=2D
U
*EL FILE
S
*NODE PRINT,NSET=NALL
U
*END STEP
";

const SCENE: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "p.inp"
[bodies.PLATE]
young = 1000.0
poisson = 0.3
[[supports]]
on = "WALL"
type = "clamped"
[[tractions]]
on = "LOAD"
pressure = 10.0
"#;

const FRD: &str = "    1C
    2C                             6                                     1
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E+00 0.00000E+00 0.00000E+00
 -1         3 2.00000E+00 0.00000E+00 0.00000E+00
 -1         4 0.00000E+00 1.00000E+00 0.00000E+00
 -1         5 1.00000E+00 1.00000E+00 0.00000E+00
 -1         6 2.00000E+00 1.00000E+00 0.00000E+00
 -3
    3C                             4                                     1
 -1         1    7    0    1
 -2         1         2         5
 -1         2    7    0    1
 -2         1         5         4
 -1         3    7    0    1
 -2         2         3         6
 -1         4    7    0    1
 -2         2         6         5
 -3
    1PSTEP                         1           1           1          
  100CL  101 1.000000000           6                     0    1           1
 -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2-9.30675E-03-2.96874E-03 0.00000E+00
 -1         3-1.84103E-02-5.15111E-03 0.00000E+00
 -1         4 0.00000E+00 0.00000E+00 0.00000E+00
 -1         5-7.18623E-03 8.48210E-04 0.00000E+00
 -1         6-1.62456E-02-1.25464E-03 0.00000E+00
 -3
 9999
";

const DAT: &str = " displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  0.000000E+00  0.000000E+00  0.000000E+00
         2 -9.306751E-03 -2.968736E-03  0.000000E+00
         3 -1.841029E-02 -5.151110E-03  0.000000E+00
         4  0.000000E+00  0.000000E+00  0.000000E+00
         5 -7.186226E-03  8.482102E-04  0.000000E+00
         6 -1.624558E-02 -1.254644E-03  0.000000E+00
";

/// Runs `certify` on a field and holds its exit code and what it says.
#[track_caller]
fn certified(folder: &Path, field: &str, text: &str, code: i32, fragments: &[&str]) {
    std::fs::write(folder.join(field), text).expect("writable");
    let arguments = ["certify", "job.toml", "--displacement", field, "--solution"];
    ended(field, &run(hypercircle(folder, arguments)), code, fragments);
}

#[test]
fn results_of_calculix_are_its_solutions() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("job.toml"), SCENE).expect("writable");
    std::fs::write(folder.path().join("p.inp"), DECK).expect("writable");
    certified(folder.path(), "p.frd", FRD, 0, &[]);
    certified(folder.path(), "p.dat", DAT, 0, &[]);
    // A displacement of one node that CalculiX did not compute.
    certified(folder.path(), "p.frd", &FRD.replace("2-9.30675E-03", "2-9.50675E-03"), 1, &[]);
    certified(folder.path(), "p.dat", &DAT.replace("-9.306751E-03", "-9.506751E-03"), 1, &[]);
}

/// The result as a layer of prisms between two faces at `height` of x on both sides, which move apart by `across` each (OUTPUT=3D).
fn in_space(height: impl Fn(f64) -> f64, across: f64) -> String {
    let (nodes, rest) = FRD.split_once(" -3\n").expect("a block of nodes");
    let (cells, values) = rest.split_once(" -3\n").expect("a block of cells");
    let doubled = |block: &str, last: &dyn Fn(f64) -> f64| -> String {
        let side = |line: &str, sign: f64| {
            let tag: usize = line[3..13].trim().parse().expect("a number");
            let first: f64 = line[13..25].trim().parse().expect("a number");
            let tag = if sign < 0.0 { tag } else { tag + 6 };
            format!(" -1{tag:>10}{}{:>12.7}\n", &line[13..37], sign * last(first))
        };
        let line = |line: &str| match line.starts_with(" -1") {
            true => side(line, -1.0) + &side(line, 1.0),
            false => format!("{line}\n"),
        };
        block.lines().map(line).collect()
    };
    let prism = |line: &str| match line.strip_prefix(" -2") {
        Some(tags) => {
            let high = tags.split_whitespace().map(|tag| tag.parse::<usize>().expect("a number") + 6);
            format!("{line}{}\n", high.map(|tag| format!("{tag:>10}")).collect::<String>())
        }
        None => line.replace("    7    0", "    2    0") + "\n",
    };
    let cells: String = cells.lines().map(prism).collect();
    [doubled(nodes, &height), cells, doubled(values, &|_| across)].join(" -3\n")
}

#[test]
fn layers_in_space_are_the_plane_between_their_faces() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("job.toml"), SCENE).expect("writable");
    std::fs::write(folder.path().join("p.inp"), DECK).expect("writable");
    certified(folder.path(), "p.frd", &in_space(|_| 0.5, 0.0), 0, &[]);
    // In plane stress the faces move apart.
    certified(folder.path(), "p.frd", &in_space(|_| 0.5, 1e-3), 0, &[]);
    // The wedge of axisymmetric elements.
    certified(folder.path(), "p.frd", &in_space(|x| x * 0.0174551, 0.0), 2, &["axisymmetric elements", "OUTPUT=2D"]);
}

#[test]
fn results_without_displacements_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("job.toml"), SCENE).expect("writable");
    std::fs::write(folder.path().join("p.inp"), DECK).expect("writable");
    certified(folder.path(), "p.frd", &FRD.replace("DISP", "FORC"), 2, &["no displacement at its nodes", "*NODE FILE"]);
    certified(folder.path(), "other.dat", DAT, 2, &["no other.inp beside it"]);
    let short = DAT.lines().take(5).collect::<Vec<_>>().join("\n");
    certified(folder.path(), "p.dat", &short, 2, &["no displacement of node"]);
    for cut in [30, 400, 800] {
        certified(folder.path(), "cut.frd", &FRD[..cut], 2, &["cut.frd"]);
    }
}

#[test]
fn points_that_are_displaced_are_moved_back() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("job.toml"), SCENE).expect("writable");
    std::fs::write(folder.path().join("p.inp"), DECK).expect("writable");
    let (nodes, rest) = FRD.split_once(" -3\n").expect("a block of nodes");
    let row = |line: &str| -> [f64; 2] { [13, 25].map(|at| line[at..at + 12].trim().parse().expect("a number")) };
    let values: Vec<[f64; 2]> = rest
        .lines()
        .skip_while(|line| !line.contains("DISP"))
        .filter(|line| line.starts_with(" -1"))
        .map(row)
        .collect();
    let moved = |factor: f64| {
        let mut values = values.iter();
        let move_line = |line: &str| match line.starts_with(" -1") {
            true => {
                let ([x, y], u) = (row(line), values.next().expect("a value"));
                format!("{}{:>12.6}{:>12.6} 0.00000E+00\n", &line[..13], x + factor * u[0], y + factor * u[1])
            }
            false => format!("{line}\n"),
        };
        nodes.lines().map(move_line).collect::<String>() + " -3\n" + rest
    };
    certified(folder.path(), "p.frd", &moved(1.0), 0, &[]);
    let report = std::fs::read_to_string(folder.path().join("out/job/report.html")).expect("a report");
    assert!(report.contains("The points of p.frd are displaced"), "no note");
    // A multiple of the displacement explains nothing.
    certified(folder.path(), "p.frd", &moved(2.0), 2, &["p.frd"]);
}
