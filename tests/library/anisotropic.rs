//! Bodies of any elastic material: exact solutions, invariance, and both bounds.

use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::bounds::Bracket;
use hypercircle::dual::{Condensed, Options};
use hypercircle::elasticity::{Elasticity, Orthotropic};
use hypercircle::element::{Elements, block};
use hypercircle::problem::{Problem, Refinement};
use hypercircle::scene::{Kinematics, Scene};
use hypercircle::study::{Certified, certify};

fn problem(text: &str) -> Problem {
    let scene = Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: Problem, degree: usize) -> Certified {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify(problem, &Condensed::default(), &options).expect("a solution")
}

fn ends(bracket: &Bracket) -> [f64; 2] {
    [bracket.lower(), bracket.free.as_ref().expect("an upper bound").upper()]
}

/// A random material with three planes of symmetry; `soft` is how far it is from being incompressible.
fn ply(random: &mut Random, stiff: f64, soft: Option<f64>) -> Orthotropic {
    let angle = random.between(-90.0, 90.0);
    let shear = random.between(0.2, 1.0);
    if let Some(soft) = soft {
        // Without change of volume 1 − nu12 = nu13 E1/…: the rows of the compliance add up to nothing.
        let young = [1.0, random.between(0.8, 1.5), random.between(0.8, 1.5)].map(|e| stiff * e);
        let s = young.map(|e| 1.0 / e);
        let off = |i: usize, j: usize, k: usize| 0.5 * (s[i] + s[j] - s[k]) * (1.0 - soft);
        let poisson = [off(0, 1, 2) / s[0], off(0, 2, 1) / s[0], off(1, 2, 0) / s[1]];
        return Orthotropic { young, poisson, shear, angle };
    }
    let young = [stiff, random.between(0.5, 2.0), random.between(0.5, 2.0)];
    let most = |i: usize, j: usize| (young[i] / young[j]).sqrt();
    let poisson = [0.4 * most(0, 1), 0.3 * most(0, 2), 0.35 * most(1, 2)].map(|nu: f64| nu * random.between(-0.5, 1.0));
    Orthotropic { young, poisson, shear, angle }
}

fn keys(law: &Orthotropic) -> String {
    let Orthotropic { young, poisson, shear, angle } = law;
    format!("orthotropic = {{ young = {young:?}, poisson = {poisson:?}, shear = {shear:?}, angle = {angle:?} }}")
}

/// The 6 × 6 compliance of a material in its axes.
fn compliance(law: &Orthotropic) -> [[f64; 6]; 6] {
    let Orthotropic { young: [e1, e2, e3], poisson: [nu12, nu13, nu23], shear, .. } = *law;
    let mut s = [[0.0; 6]; 6];
    s[0][..3].copy_from_slice(&[1.0 / e1, -nu12 / e1, -nu13 / e1]);
    s[1][..3].copy_from_slice(&[-nu12 / e1, 1.0 / e2, -nu23 / e2]);
    s[2][..3].copy_from_slice(&[-nu13 / e1, -nu23 / e2, 1.0 / e3]);
    (s[3][3], s[4][4], s[5][5]) = (1.0, 1.0, 1.0 / shear);
    s
}

/// Two blocks in contact, loaded along and across, in axes turned by `turn` degrees.
fn pressed(laws: [&str; 2], kinematics: &str, turn: f64) -> Toml {
    let (sin, cos) = turn.to_radians().sin_cos();
    let at = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
    Toml::default()
        .model(kinematics, 1.0)
        .size(0.3)
        .polygon("a", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(at), ["foot", "face", "", "load"])
        .polygon("b", &[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]].map(at), ["", "wall", "", "seat"])
        .matter("a", laws[0])
        .matter("b", laws[1])
        .force("a", at([0.1, -0.2]))
        .clamp("wall")
        .roller("foot")
        .traction("load", at([1.0, 0.3]))
        .contact("face", "seat")
}

/// Under a uniform stress bodies of any material have a uniform strain: both bounds are the exact energy.
#[test]
fn a_uniform_stress_is_met_exactly() {
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let soft = (seed % 3 == 0).then(|| random.magnitude(-9.0, -1.0));
        let law = ply(&mut random, if seed % 3 == 1 { 1e4 } else { 3.0 }, soft);
        let kinematics = if seed % 2 == 0 { Kinematics::PlaneStrain } else { Kinematics::PlaneStress };
        let stress = [0, 1, 2].map(|_| random.between(-1.0, 1.0));
        let plane = Elasticity::Orthotropic(law).plane(kinematics == Kinematics::PlaneStrain).expect("a material");
        let own = [0.5 * (stress[0] + stress[1]), 0.5 * (stress[0] - stress[1]), stress[2]];
        let r = plane.factor.map(|row| row.iter().zip(own).map(|(r, x)| r * x).sum::<f64>());
        let strain = [0, 1, 2].map(|j| (0..3).map(|i| plane.factor[i][j] * r[i]).sum::<f64>());
        let (xx, yy, xy) = (0.5 * (strain[0] + strain[1]), 0.5 * (strain[0] - strain[1]), 0.5 * strain[2]);
        let wall = "[[supports]]\non = \"west\"\ntype = \"clamped\"";
        let toml = Toml::default()
            .model(kinematics.name(), 1.0)
            .size(0.5)
            .polygon("a", &[[0.0, 0.0], [1.0, 0.1], [1.2, 1.0], [0.0, 1.0]], ["south", "east", "north", "west"])
            .matter("a", &keys(&law))
            .clamp("west");
        let [sxx, syy, sxy] = stress;
        let on = |from: [f64; 2], to: [f64; 2]| {
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let [nx, ny] = [dy / dx.hypot(dy), -dx / dx.hypot(dy)];
            [sxx * nx + sxy * ny, sxy * nx + syy * ny]
        };
        let toml = toml
            .traction("south", on([0.0, 0.0], [1.0, 0.1]))
            .traction("east", on([1.0, 0.1], [1.2, 1.0]))
            .traction("north", on([1.2, 1.0], [0.0, 1.0]));
        let moved =
            format!("{wall}\ndisplacement = {{ value = [0.0, 0.0], gradient = [[{xx:?}, {xy:?}], [{xy:?}, {yy:?}]] }}");
        let text = toml.text().replace(wall, &moved);
        let area = 1.04;
        let density = sxx * xx + syy * yy + 2.0 * sxy * xy;
        // −Π = ∫_wall T·u0 − ½∫σ:ε, with T = −(σ_xx, σ_xy) and u0 = (ε_xy, ε_yy) y on the wall.
        let energy = -0.5 * (sxx * xy + sxy * yy) - 0.5 * density * area;
        for degree in [1, 2, 4] {
            let [lower, upper] = ends(&solved(problem(&text), degree).bracket);
            let close = 1e-9 * (density * area + energy.abs());
            assert!(
                (lower - energy).abs() < close && (upper - energy).abs() < close && lower <= upper,
                "seed {seed}, degree {degree}: {lower} {energy} {upper}"
            );
        }
    }
}

/// Turning a scene, its loads and the axes of its materials changes nothing but round-off.
#[test]
fn axes_may_be_turned() {
    for seed in 0..4 {
        let mut random = Random::new(100 + seed);
        let laws = [ply(&mut random, 10.0, None), ply(&mut random, 2.0, None)];
        let kinematics = random.pick(&["plane-strain", "plane-stress"]);
        let degree = 1 + seed as usize % 3;
        let of = |turn: f64| {
            let [a, b] = laws.map(|law| keys(&Orthotropic { angle: law.angle + turn, ..law }));
            let mut problem = problem(&pressed([&a, &b], kinematics, turn).text());
            problem.refinement = Refinement::KeepsEdges;
            problem
        };
        let turn = random.between(10.0, 80.0);
        let plain = of(0.0);
        // The mesh of the first, turned: a mesh generator may cut a square either way.
        let mut turned = of(turn);
        let (sin, cos) = turn.to_radians().sin_cos();
        if turned.mesh.triangles == plain.mesh.triangles {
            let near = turned.mesh.points.iter().zip(&plain.mesh.points);
            let apart = near.map(|(p, q)| (p[0] - cos * q[0] + sin * q[1]).hypot(p[1] - sin * q[0] - cos * q[1]));
            assert!(apart.fold(0.0, f64::max) < 1e-12);
            turned.mesh.points.truncate(plain.mesh.points.len());
            let [a, b] = [plain, turned].map(|problem| ends(&solved(problem, degree).bracket));
            assert!((a[0] - b[0]).abs() < 1e-11 * a[0].abs(), "seed {seed}: {a:?} {b:?}");
            assert!((a[1] - b[1]).abs() < 1e-6 * a[1].abs(), "seed {seed}: {a:?} {b:?}");
        } else {
            // Another triangulation: the brackets have the exact energy in common.
            let [a, b] = [plain, turned].map(|problem| ends(&solved(problem, degree).bracket));
            assert!(a[0] <= b[1] && b[0] <= a[1], "seed {seed}: {a:?} {b:?}");
        }
    }
}

/// A matrix says what engineering constants say, and of an isotropic body what E and ν say.
#[test]
fn one_material_in_other_words_is_the_same() {
    let (young, nu): (f64, f64) = (2.0, 0.31);
    let isotropic = Orthotropic { young: [young; 3], poisson: [nu; 3], shear: 0.5 * young / (1.0 + nu), angle: 40.0 };
    let mut random = Random::new(3);
    let other = keys(&ply(&mut random, 5.0, None));
    let plain = format!("young = {young:?}\npoisson = {nu:?}");
    let rows = compliance(&isotropic);
    let matrix = format!("compliance = {rows:?}\nangle = 40.0");
    for degree in [1, 3] {
        for kinematics in ["plane-strain", "plane-stress"] {
            let of =
                |law: &str| ends(&solved(problem(&pressed([law, &other], kinematics, 0.0).text()), degree).bracket);
            let exact = of(&plain);
            for law in [keys(&isotropic), matrix.clone()] {
                let found = of(&law);
                assert!((found[0] - exact[0]).abs() < 1e-12 * exact[0].abs(), "{found:?} {exact:?}");
                assert!((found[1] - exact[1]).abs() < 1e-6 * exact[1].abs(), "{found:?} {exact:?}");
            }
        }
    }
}

/// The gap of energies is the sum of its local terms, and brackets of finer meshes lie in those of coarser ones.
#[test]
fn brackets_nest_and_their_gaps_are_local() {
    for seed in 0..8 {
        let mut random = Random::new(200 + seed);
        let soft = (seed % 4 == 3).then(|| random.magnitude(-6.0, -2.0));
        let stiff = if seed % 4 == 2 { 1e6 } else { 8.0 };
        let laws = [ply(&mut random, stiff, soft), ply(&mut random, 2.0, None)];
        let [a, b] = laws.map(|law| keys(&law));
        let kinematics = if seed % 4 == 3 { "plane-strain" } else { random.pick(&["plane-strain", "plane-stress"]) };
        let mut before: Option<[f64; 2]> = None;
        for degree in [1, 2, 3] {
            let found = solved(problem(&pressed([&a, &b], kinematics, 0.0).text()), degree);
            let free = found.bracket.free.as_ref().expect("an upper bound");
            let by_energies = free.potential.total() - found.bracket.complementary.lower();
            let off = (by_energies - free.local.total).abs();
            let own = ends(&found.bracket);
            assert!(off < 1e-9 * own[0].abs(), "seed {seed}, degree {degree}: {by_energies} {}", free.local.total);
            if let Some([lower, upper]) = before {
                assert!(own[0] >= lower - 1e-12 * lower.abs() && own[1] >= lower && own[0] <= upper, "seed {seed}");
            }
            before = Some(own);
        }
    }
}

/// Elastic constants that make no material are refused, with the constant that breaks it.
#[test]
fn constants_that_are_no_material_are_named() {
    let refused = |law: &str, kinematics: &str, fragment: &str| {
        let text = pressed([law, "young = 1.0\npoisson = 0.3"], kinematics, 0.0).text();
        let error = Scene::parse(&text, "scene.toml".as_ref()).expect_err(fragment).to_string();
        assert!(error.contains(fragment), "{error}");
    };
    let law = |young: &str, poisson: &str, shear: &str| {
        format!("orthotropic = {{ young = {young}, poisson = {poisson}, shear = {shear} }}")
    };
    let strain = "plane-strain";
    refused(&law("[1, 0, 1]", "[0, 0, 0]", "1"), strain, "orthotropic.young[1] (E2)");
    refused(&law("[1, 1, 1]", "[0, 0, 0]", "-1"), strain, "orthotropic.shear (G12)");
    refused(&law("[1, 100, 1]", "[0.3, 0, 0]", "1"), strain, "orthotropic.poisson[0] (nu12)");
    refused(&law("[1, 1, 100]", "[0, 0.2, 0]", "1"), strain, "orthotropic.poisson[1] (nu13)");
    refused(&law("[1, 1, 1]", "[0.6, 0.5, 0.4]", "1"), strain, "nu12 nu21");
    refused(&law("[1, 1]", "[0.6, 0.5, 0.4]", "1"), strain, "has 2 numbers, not 3");
    refused(&law("[1, 1, nan]", "[0, 0, 0]", "1"), strain, "finite");
    refused("stiffness = [[2, 1, 0], [1, 2, 0], [0, 0, 1]]", strain, "not 6");
    refused("stiffness = [[2, 1, 0], [1.5, 2, 0], [0, 0, 1]]", "plane-stress", "stiffness[1][0]");
    refused("compliance = [[2, 3, 0], [3, 2, 0], [0, 0, 1]]", "plane-stress", "positive definite");
    refused("young = 1.0", strain, "no `poisson`");
    refused("young = 1.0\npoisson = 0.3\nangle = 3.0", strain, "angle");
    refused(
        "young = 1.0\npoisson = 0.3\ncompliance = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
        "plane-stress",
        "does not go with",
    );
}

/// A scene made by a program keeps its materials.
#[test]
fn drafts_keep_materials() {
    let mut random = Random::new(5);
    let law = ply(&mut random, 4.0, None);
    let matrix = format!("compliance = {:?}\nangle = 12.5", compliance(&law));
    let text = pressed([&keys(&law), &matrix], "plane-strain", 0.0).text();
    let scene = Scene::parse(&text, "scene.toml".as_ref()).expect("a scene");
    let again = scene.changed(|_| ()).expect("the same scene");
    assert_eq!(scene.bodies, again.bodies);
}
