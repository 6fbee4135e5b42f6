//! Contact along arcs that the two sides divide differently: of one circle, of two about one centre, and of no circle.

use std::f64::consts::PI;
use std::path::Path;

use crate::arcs::PRESSED;
use crate::lame::Rings;
use hypercircle::bounds::Bracket;
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::problem::{Problem, ProblemError};
use hypercircle::scene::Scene;

/// One ring of a quarter, by its inner and outer curve, divided into cells across and along.
struct Ring {
    curves: [Box<dyn Fn(f64) -> [f64; 2]>; 2],
    cells: [usize; 2],
}

fn circle(radius: f64) -> Box<dyn Fn(f64) -> [f64; 2]> {
    Box::new(move |angle: f64| [radius * angle.cos(), radius * angle.sin()])
}

/// Both rings as a file of Gmsh, with rollers on the cuts and pressure inside.
fn quarter(
    folder: &Path,
    rings: &[Ring; 2],
    young: [f64; 2],
    pressure: f64,
    contact: &str,
) -> Result<Problem, ProblemError> {
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for (body, Ring { curves, cells: [across, along] }) in rings.iter().enumerate() {
        let first = points.len() + 1;
        for j in 0..=*along {
            let angle = 0.5 * PI * j as f64 / *along as f64;
            let [inner, outer] = curves.each_ref().map(|curve| curve(angle));
            for i in 0..=*across {
                let t = i as f64 / *across as f64;
                let mut p = [0, 1].map(|c| inner[c] + t * (outer[c] - inner[c]));
                if j == *along {
                    p[0] = 0.0;
                }
                points.push(p);
            }
        }
        let v = |i: usize, j: usize| first + j * (across + 1) + i;
        for j in 0..*along {
            for i in 0..*across {
                for [a, b, c] in [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]] {
                    cells.push(format!("2 2 {0} {0} {a} {b} {c}", body + 1));
                }
            }
            let [west, east] = [3 + 4 * body, 4 + 4 * body];
            cells.push(format!("1 2 {west} 1 {} {}", v(0, j), v(0, j + 1)));
            cells.push(format!("1 2 {east} 1 {} {}", v(*across, j), v(*across, j + 1)));
        }
        for i in 0..*across {
            let [south, north] = [5 + 4 * body, 6 + 4 * body];
            cells.push(format!("1 2 {south} 1 {} {}", v(i, 0), v(i + 1, 0)));
            cells.push(format!("1 2 {north} 1 {} {}", v(i, *along), v(i + 1, *along)));
        }
    }
    let mut text = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n10\n2 1 \"in\"\n2 2 \"out\"\n");
    for (k, body) in ["in", "out"].iter().enumerate() {
        for (i, side) in ["west", "east", "south", "north"].iter().enumerate() {
            text += &format!("1 {} \"{body}_{side}\"\n", 3 + 4 * k + i);
        }
    }
    text += &format!("$EndPhysicalNames\n$Nodes\n{}\n", points.len());
    for (i, [x, y]) in points.iter().enumerate() {
        text += &format!("{} {x:?} {y:?} 0\n", i + 1);
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", cells.len());
    for (i, cell) in cells.iter().enumerate() {
        text += &format!("{} {cell}\n", i + 1);
    }
    std::fs::write(folder.join("rings.msh"), text + "$EndElements\n").expect("writable");
    let mut scene = format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = \"rings.msh\"\n[[contacts]]\n{contact}\n\
         [[tractions]]\non = \"in_west\"\npressure = {pressure:?}\n"
    );
    for (body, young) in ["in", "out"].iter().zip(young) {
        scene += &format!("[bodies.{body}]\nyoung = {young:?}\npoisson = {:?}\n", PRESSED.poisson);
        for side in ["south", "north"] {
            scene += &format!("[[supports]]\non = \"{body}_{side}\"\ntype = \"roller\"\n");
        }
    }
    Problem::load(Scene::parse(&scene, &folder.join("rings.toml")).unwrap_or_else(|e| panic!("{e}\n{scene}")))
}

const BETWEEN: &str = "between = [\"in_east\", \"out_west\"]";

fn rings(clearance: f64, cells: [[usize; 2]; 2]) -> [Ring; 2] {
    let [a, b, c] = PRESSED.radii;
    [
        Ring { curves: [circle(a), circle(b)], cells: cells[0] },
        Ring { curves: [circle(b + clearance), circle(c)], cells: cells[1] },
    ]
}

/// Relative errors of the pressure in the mean square and in the mean, of the lower and the upper bound.
fn errors(problem: &Problem, exact: f64, energy: f64) -> [f64; 4] {
    let dual = dual::solve(&Condensed::default(), problem, &[], &Options::default()).expect("solves");
    let bracket = Bracket::new(problem, &dual);
    let (mut square, mut mean, mut length) = (0.0, 0.0, 0.0);
    for (k, pair) in problem.interfaces[0].pairs.iter().enumerate() {
        // One value on an edge along which the direction turns.
        let values = dual.contact_traction[0].of(k);
        let off = -values.iter().sum::<f64>() / values.len() as f64 / exact - 1.0;
        square += off * off * pair.length;
        mean += off * pair.length;
        length += pair.length;
    }
    let free = bracket.free.as_ref().expect("an upper bound");
    assert!(bracket.lower() <= free.upper());
    let [lower, upper] = [bracket.lower(), free.upper()].map(|e| e / energy - 1.0);
    [(square / length).sqrt(), (mean / length).abs(), lower.abs(), upper.abs()]
}

/// Finer meshes of sides that are divided in the parts 4 : 3.
const CELLS: [[[usize; 2]; 2]; 3] = [[[4, 8], [4, 6]], [[8, 16], [8, 12]], [[16, 32], [16, 24]]];

/// Errors on all of [`CELLS`] fall as the cells get smaller.
#[track_caller]
fn meets(exact: &Rings, clearance: f64, contact: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let found = CELLS.map(|cells| {
        let problem =
            quarter(folder.path(), &rings(clearance, cells), exact.young, exact.inside, contact).expect("a mesh");
        let pairs = &problem.interfaces[0].pairs;
        // Every vertex of either side, but for the places that both have.
        assert_eq!(pairs.len(), 6 * cells[0][1] / 4);
        assert!(pairs.iter().all(|p| p.gap.iter().all(|g| (g - clearance).abs() < 1e-12)));
        assert!(problem.notes.iter().any(|n| n.weakens_guarantee), "{:?}", problem.notes);
        errors(&problem, exact.pressure(), exact.energy())
    });
    println!("{found:?}");
    let [_, coarse, fine] = found;
    assert!(fine[0] < 0.03 && fine[0] < 0.6 * coarse[0], "{found:?}");
    assert!(fine[1..].iter().all(|e| *e < 2e-3), "{found:?}");
    assert!(fine[2..].iter().zip(&coarse[2..]).all(|(f, c)| *f < 0.35 * c), "{found:?}");
}

#[test]
fn rings_that_divide_one_circle_differently_meet_lame() {
    meets(&PRESSED, 0.0, BETWEEN);
}

#[test]
fn a_clearance_between_rings_divided_differently_closes_as_lame_says() {
    // Small beside the radii, since Lamé's formulas have one for both sides, and still to be seen in the pressure.
    let clearance = 2e-4;
    let exact = Rings { inside: 1e-3 * PRESSED.inside, depth: -clearance, ..PRESSED };
    let part = exact.pressure() / Rings { depth: 0.0, ..exact }.pressure();
    assert!(part > 0.1 && part < 0.99, "{part}");
    meets(&exact, clearance, BETWEEN);
    meets(&exact, clearance, "between = [\"out_west\", \"in_east\"]");
}

#[test]
fn a_wide_gap_between_circles_stays_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = quarter(folder.path(), &rings(0.2, CELLS[0]), PRESSED.young, 1e-3, BETWEEN).expect("a mesh");
    let dual = dual::solve(&Condensed::default(), &problem, &[], &Options::default()).expect("solves");
    assert!(dual.contact_traction[0].values().iter().all(|t| t.abs() < 1e-14));
}

#[test]
fn an_ellipse_divided_differently_is_one_curve() {
    let folder = tempfile::tempdir().expect("a folder");
    let ellipse = |part: f64| Box::new(move |angle: f64| [1.6 * part * angle.cos(), part * angle.sin()]);
    let two = |shift: f64, cells: [usize; 2]| {
        [
            Ring { curves: [ellipse(0.5), ellipse(1.0)], cells: [6, cells[0]] },
            Ring { curves: [ellipse(1.0 + shift), ellipse(1.5)], cells: [6, cells[1]] },
        ]
    };
    let problem = quarter(folder.path(), &two(0.0, [16, 21]), [1.0, 1.0], 1.0, BETWEEN).expect("one curve");
    assert_eq!(problem.interfaces[0].pairs.len(), 36);
    // The same bodies divided alike have nearly the same energy.
    let energy = |problem: &Problem| {
        let dual = dual::solve(&Condensed::default(), problem, &[], &Options::default()).expect("solves");
        Bracket::new(problem, &dual).lower()
    };
    let alike = quarter(folder.path(), &two(0.0, [36, 36]), [1.0, 1.0], 1.0, BETWEEN).expect("one polyline");
    assert!(alike.notes.iter().all(|n| !n.weakens_guarantee));
    assert!((energy(&problem) / energy(&alike) - 1.0).abs() < 1e-2, "{} {}", energy(&problem), energy(&alike));
    // Two ellipses apart are not.
    let error = quarter(folder.path(), &two(0.02, [16, 21]), [1.0, 1.0], 1.0, BETWEEN).expect_err("apart");
    assert!(error.to_string().contains("does not lie on"), "{error}");
}

#[test]
fn an_arc_on_a_straight_side_is_no_common_curve() {
    let folder = tempfile::tempdir().expect("a folder");
    let straight = |far: f64| Box::new(move |angle: f64| [far * (1.0 - angle / PI * 2.0), far * angle / PI * 2.0]);
    for cells in [1, 2, 5] {
        let both = [
            Ring { curves: [circle(0.5), straight(1.0)], cells: [3, cells] },
            Ring { curves: [circle(1.0), circle(1.5)], cells: [3, 7] },
        ];
        let error = quarter(folder.path(), &both, [1.0, 1.0], 1.0, BETWEEN).expect_err("no common curve");
        assert!(error.to_string().contains("`direction`") || error.to_string().contains("does not lie on"), "{error}");
    }
}
