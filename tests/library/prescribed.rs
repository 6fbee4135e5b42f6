//! Supports that move: affine displacements of clamped boundaries, and rollers along any direction.

use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;
use hypercircle::statics::{self, Solvability};
use hypercircle::study::{Certified, certify};

fn problem(text: &str) -> Problem {
    Problem::load(Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}")))
        .expect("a problem")
}

fn solved(text: &str) -> Certified {
    certify(problem(text), &Condensed::default(), &Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The bracket encloses `energy` and is round-off wide.
fn is_exact(certified: &Certified, energy: f64) {
    let (lower, upper) = (certified.bracket.lower(), certified.bracket.free.as_ref().expect("an upper bound").upper());
    let close = 1e-11 * energy.abs();
    assert!(
        lower <= energy + close && energy <= upper + close && upper - lower <= 2.0 * close,
        "{lower} {energy} {upper}"
    );
}

const QUAD: [[f64; 2]; 4] = [[0.2, 0.1], [1.3, -0.1], [1.5, 1.2], [0.1, 0.9]];

/// With u = A x + b all around, strain is uniform.
#[test]
fn an_affine_displacement_all_around_is_the_solution() {
    let gradient = [[0.01, -0.02], [0.005, 0.03]];
    let mut toml = Toml::default().size(0.5).polygon("b", &QUAD, ["s0", "s1", "s2", "s3"]).material("b", 7.0, 0.3);
    for k in 0..4 {
        toml = toml.table(&format!(
            "[[supports]]\non = \"s{k}\"\ntype = \"clamped\"\ndisplacement = {{ value = [0.1, -0.2], gradient = {gradient:?} }}"
        ));
    }
    let (e, nu) = (7.0, 0.3);
    let (lambda, mu) = (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)));
    let (xx, yy, xy) = (0.01, 0.03, 0.5 * (-0.02 + 0.005));
    let density = 0.5 * lambda * (xx + yy) * (xx + yy) + mu * (xx * xx + yy * yy + 2.0 * xy * xy);
    let area: f64 = (0..4).map(|i| (QUAD[i], QUAD[(i + 1) % 4])).map(|(p, q)| 0.5 * (p[0] * q[1] - p[1] * q[0])).sum();
    is_exact(&solved(&toml.text()), density * area);
}

/// A block between four rollers, one of which presses: wherever it lies and however it is turned.
#[test]
fn a_roller_that_presses_gives_a_uniform_stress() {
    for angle in [0.0, 0.4, 2.1_f64] {
        let turn = |[x, y]: [f64; 2]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()];
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(turn);
        for written in [true, false] {
            let pressed = match written {
                true => format!("direction = {:?}\ndisplacement = -0.01", turn([3.0, 0.0])),
                false => "displacement = -0.01".to_string(),
            };
            let text = Toml::default()
                .size(0.7)
                .polygon("b", &corners, ["low", "pressed", "", "back"])
                .material("b", 5.0, 0.25)
                .roller("low")
                .roller("back")
                .table(&format!("[[supports]]\non = \"pressed\"\ntype = \"roller\"\n{pressed}"))
                .text();
            // Uniaxial stress in plane strain: E' = E / (1 − ν²).
            let strain = 0.01 / 2.0;
            is_exact(&solved(&text), 0.5 * (5.0 / (1.0 - 0.0625)) * strain * strain * 2.0);
        }
    }
}

/// The edges of a block slide along themselves only, or not at all: shear that is known.
#[test]
fn a_roller_may_hold_along_its_boundary() {
    let side = |name: &str, displacement: f64| {
        format!(
            "[[supports]]\non = \"{name}\"\ntype = \"roller\"\ndirection = [1.0, 0.0]\ndisplacement = {displacement:?}"
        )
    };
    let normal = "[[supports]]\non = \"left\"\ntype = \"roller\"\ndirection = [0.0, 1.0]";
    let other = "[[supports]]\non = \"right\"\ntype = \"roller\"\ndirection = [0.0, 1.0]";
    let text = Toml::default()
        .size(0.5)
        .polygon("b", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "right", "top", "left"])
        .material("b", 3.0, 0.2)
        .table(&side("foot", 0.0))
        .table(&side("top", 0.02))
        .table(normal)
        .table(other)
        .text();
    // u = (0.02 y, 0): pure shear, which has no normal traction anywhere.
    is_exact(&solved(&text), 0.5 * (3.0 / 2.4) * 0.02 * 0.02);
}

#[test]
fn statics_knows_what_a_direction_leaves_free() {
    let scene = |load: &str, more: &str| {
        Toml::default()
            .size(1.0)
            .polygon("b", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "top", "left"])
            .table("[[supports]]\non = \"foot\"\ntype = \"roller\"\ndirection = [1.0, 0.0]")
            .table("[[supports]]\non = \"left\"\ntype = \"roller\"\ndirection = [1.0, 0.0]")
            .table(&format!("[[tractions]]\non = \"top\"\n{load}"))
            .table(more)
            .text()
    };
    let up = problem(&scene("value = [0.0, 1.0]", ""));
    let found = statics::check(&up).expect("statics").equilibrium;
    assert!(matches!(found, Solvability::Impossible { .. }), "nothing resists a force along y");
    let along = problem(&scene("value = [0.5, 0.0]", ""));
    assert!(
        statics::check(&along).is_ok_and(|s| !s.vertex_pins.is_empty()),
        "a motion along y stays free and costs nothing"
    );
}
