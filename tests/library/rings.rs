//! A ring in another one, pressed together by a pressure inside or by an interference fit, against Lamé's formulas.

use std::f64::consts::PI;

use crate::arcs::PRESSED;
use crate::lame::Rings;
use crate::support::blocks::grid;
use hypercircle::bounds::Bracket;
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::mesh::Triangulation;
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

const SHRUNK: Rings = Rings { inside: 0.0, depth: 0.01, ..PRESSED };

/// Cells of each ring across and along its quarter.
const MESHES: [usize; 4] = [12, 24, 48, 96];

/// A quarter on rollers, n × n cells in each ring.
fn quarter(rings: &Rings, n: usize) -> Problem {
    let mut text = format!(
        "[model]\nkinematics = \"plane-strain\"\n[geometry]\n\
         [[contacts]]\nbetween = [\"left_east\", \"right_west\"]\ngap = {:?}\n\
         [[tractions]]\non = \"left_west\"\npressure = {:?}\n",
        -rings.depth, rings.inside
    );
    for (body, young) in ["left", "right"].iter().zip(rings.young) {
        // Only names matter here, the triangles come from the grid.
        text += &format!(
            "[[geometry.polygons]]\nbody = \"{body}\"\npoints = [[0, 0], [1, 0], [1, 1], [0, 1]]\n\
             edges = [\"{body}_south\", \"{body}_east\", \"{body}_north\", \"{body}_west\"]\n\
             [bodies.{body}]\nyoung = {young:?}\npoisson = {:?}\n",
            rings.poisson
        );
        for side in ["south", "north"] {
            text += &format!("[[supports]]\non = \"{body}_{side}\"\ntype = \"roller\"\n");
        }
    }
    let scene = Scene::parse(&text, "rings.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let raw = grid(n, |ring, i, j| {
        let radius = rings.radii[ring] + (rings.radii[ring + 1] - rings.radii[ring]) * i as f64 / n as f64;
        let angle = 0.5 * PI * j as f64 / n as f64;
        if j == n { [0.0, radius] } else { [radius * angle.cos(), radius * angle.sin()] }
    });
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a mesh");
    Problem::new(scene, mesh, notes).expect("a problem")
}

/// Relative errors of the largest and the mean contact pressure, of the largest displacement of a vertex, of lower and upper bound.
fn errors(rings: &Rings, n: usize) -> [f64; 5] {
    let problem = quarter(rings, n);
    let dual = dual::solve(&Condensed::default(), &problem, &[], &Options::default()).expect("solves");
    let bracket = Bracket::new(&problem, &dual);
    let exact = rings.pressure();
    let pressures = dual.contact_traction[0].values();
    let largest = pressures.iter().fold(0.0_f64, |m, t| m.max((-t / exact - 1.0).abs()));
    let mean = -pressures.iter().sum::<f64>() / pressures.len() as f64;
    let free = bracket.free.as_ref().expect("an upper bound");
    let mut away = 0.0_f64;
    let mut size = 0.0_f64;
    for t in 0..problem.mesh.triangles.len() {
        let ring = usize::from(t >= problem.mesh.triangles.len() / 2);
        for (k, [x, y]) in problem.mesh.corners(t).into_iter().enumerate() {
            let r = x.hypot(y);
            let mut corner = [0.0; 3];
            corner[k] = 1.0;
            let [ux, uy] = free.displacement.at(t, corner);
            let u = rings.displacement(ring, r);
            away = away.max((ux - u * x / r).hypot(uy - u * y / r));
            size = size.max(u.abs());
        }
    }
    let energy = rings.energy();
    let [lower, upper] = [bracket.lower(), free.upper()].map(|e| (e / energy - 1.0).abs());
    [largest, (mean / exact - 1.0).abs(), away / size, lower, upper]
}

#[track_caller]
fn fall_like_the_square(rings: &Rings) {
    let table = MESHES.map(|n| errors(rings, n));
    for row in &table {
        println!("{row:?}");
    }
    for quantity in 0..5 {
        let column = table.map(|row| row[quantity]);
        // One constant times h² on all meshes, with what coarse ones add to it; the last step has the rate.
        let scaled: Vec<f64> = column.iter().zip(MESHES).map(|(error, n)| error * (n * n) as f64).collect();
        let (least, most) = scaled.iter().fold((f64::MAX, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
        assert!(most < 3.0 * least, "quantity {quantity}: {column:?} are {scaled:?} times h²");
        let rate = (column[2] / column[3]).log2();
        assert!(rate > 1.85, "quantity {quantity}: {column:?} falls like h^{rate}");
        assert!(column[3] < 1e-4, "quantity {quantity}: {column:?}");
    }
}

#[test]
fn pressed_together_from_inside() {
    fall_like_the_square(&PRESSED);
}

#[test]
fn held_together_by_interference() {
    fall_like_the_square(&SHRUNK);
}
