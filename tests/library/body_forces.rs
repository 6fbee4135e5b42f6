//! Body forces that are not the same everywhere: equilibrium by a quadrature of the tests' own, the bracket, closed solutions.

use crate::support::random::Random;
use crate::support::scenes::stack::{slanted, varying};
use crate::support::theory::quadrature::gauss;
use crate::support::toml::Toml;
use hypercircle::dual::{Condensed, Options};
use hypercircle::element::{Elements, block};
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::Scene;
use hypercircle::study::{Certified, StudyError, certify};

fn problem(toml: &Toml) -> Problem {
    let text = toml.text();
    let scene = Scene::parse(&text, "force.toml".as_ref()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Problem::load(scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn solved(problem: &Problem, degree: usize) -> Result<Certified, StudyError> {
    let options = Options { elements: Elements::Uniform(block(degree)), ..Options::default() };
    certify(problem.clone(), &Condensed::default(), &options)
}

fn upper(certified: &Certified) -> f64 {
    certified.bracket.free.as_ref().expect("an upper bound").upper()
}

/// ∫ λ:∇w − ∫ f·w − ∫ (λn)·w over the body, with w of degree 3, relative to the sum of the sizes of its terms. Where λ balances f
/// inside and its tractions are continuous nothing is left.
fn left_of_virtual_work(certified: &Certified, coefficients: &[[f64; 10]; 2]) -> f64 {
    let (problem, stress) = (&certified.problem, &certified.dual.stress);
    let mesh = &problem.mesh;
    let field = |[x, y]: [f64; 2]| {
        let powers = [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y];
        let dx = [0.0, 1.0, 0.0, 2.0 * x, y, 0.0, 3.0 * x * x, 2.0 * x * y, y * y, 0.0];
        let dy = [0.0, 0.0, 1.0, 0.0, x, 2.0 * y, 0.0, x * x, 2.0 * x * y, 3.0 * y * y];
        let sum = |c: &[f64; 10], by: &[f64; 10]| c.iter().zip(by).map(|(c, p)| c * p).sum::<f64>();
        coefficients.map(|c| [sum(&c, &powers), sum(&c, &dx), sum(&c, &dy)])
    };
    let (mut sum, mut size) = (0.0, 0.0_f64);
    let mut add = |value: f64| {
        sum += value;
        size += value.abs();
    };
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        let centre = [0, 1].map(|i| (a[i] + b[i] + c[i]) / 3.0);
        let force = &problem.scene.bodies[mesh.body[t]].body_force;
        for (sub, [p, q]) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
            let twice = (q[0] - p[0]) * (centre[1] - p[1]) - (q[1] - p[1]) * (centre[0] - p[0]);
            for (s, v) in gauss(6) {
                for (r, w) in gauss(6) {
                    let l = [(1.0 - s) * (1.0 - r), s * (1.0 - r), r];
                    let x = [0, 1].map(|i| l[0] * p[i] + l[1] * q[i] + l[2] * centre[i]);
                    let weight = v * w * (1.0 - r) * twice;
                    let ([xx, yy, xy], [u, v], f) = (stress.at(t, sub, l), field(x), force.at(x));
                    add(weight * (xx * u[1] + yy * v[2] + xy * (u[2] + v[1])));
                    add(-weight * (f[0] * u[0] + f[1] * v[0]));
                }
            }
        }
        for i in 0..3 {
            let e = mesh.triangle_edges[t][i];
            if mesh.edges[e].triangles[1].is_some() {
                continue;
            }
            let corners = mesh.corners(t);
            let (p, q) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let along = [q[0] - p[0], q[1] - p[1]];
            for (s, w) in gauss(6) {
                let x = [0, 1].map(|c| p[c] + s * along[c]);
                let ([xx, yy, xy], [u, v]) = (stress.at(t, i, [1.0 - s, s, 0.0]), field(x));
                let traction = [xx * along[1] - xy * along[0], xy * along[1] - yy * along[0]];
                if let Condition::Traction(ends) = problem.conditions[e] {
                    // The stress meets the traction that is given, from end to end.
                    let [first, last] =
                        if mesh.points[mesh.edges[e].vertices[0]] == p { ends } else { [ends[1], ends[0]] };
                    let length = along[0].hypot(along[1]);
                    for c in 0..2 {
                        let given = length * (first[c] + s * (last[c] - first[c]));
                        assert!((traction[c] - given).abs() < 1e-9 * (1.0 + given.abs()), "{traction:?} {given}");
                    }
                }
                add(-w * (traction[0] * u[0] + traction[1] * v[0]));
            }
        }
    }
    sum.abs() / size
}

#[test]
fn stresses_balance_the_force_and_energies_agree_with_local_terms() {
    let mut random = Random::new(46);
    let mut solved_scenes = 0;
    while solved_scenes < 12 {
        let (affine, only) = (random.below(3), random.below(2));
        let mut toml = slanted(&mut random);
        for (k, body) in ["base", "middle", "top"].into_iter().enumerate() {
            if k == affine || only == 0 {
                toml = toml.loaded(body, &varying(&mut random));
            }
        }
        let given = problem(&toml.size(0.5));
        let own = match solved(&given, 1 + random.below(3)) {
            Ok(own) => own,
            Err(StudyError::NoEquilibrium { .. }) => continue,
            Err(error) => panic!("{error}\n{}", given.scene.to_toml()),
        };
        solved_scenes += 1;
        let mut number = || std::array::from_fn(|_| random.between(-1.0, 1.0));
        let field = [number(), number()];
        let left = left_of_virtual_work(&own, &field);
        assert!(left < 1e-12, "{left:e}\n{}", given.scene.to_toml());
        assert!(own.dual.equilibrium.residual() < 1e-11, "{:?}", own.dual.equilibrium);
        let free = own.bracket.free.as_ref().expect("an upper bound");
        let gap = upper(&own) - own.bracket.lower();
        let (local, scale) = (free.local.total, own.bracket.complementary.magnitude);
        assert!((gap - local).abs() < 1e-9 * scale, "{gap} {local}\n{}", given.scene.to_toml());
        assert!(gap > 0.0);
        // A bracket of a finer mesh, whose sides are the same, lies inside.
        let fine = solved(&own.problem.refine_uniform(1).expect("a finer mesh"), 2).expect("a solution");
        let slack = 1e-12 * scale;
        assert!(own.bracket.lower() <= upper(&fine) + slack && fine.bracket.lower() <= upper(&own) + slack);
        if own.dual.stress.largest_degree() <= 2 {
            assert!(fine.bracket.lower() >= own.bracket.lower() - slack);
        }
    }
}

/// A quarter of a square that turns about its middle, in the plane.
fn turning(keys: &str) -> Toml {
    Toml::default()
        .size(0.34)
        .model("plane-stress", 2.0)
        .polygon("plate", &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], ["foot", "", "", "side"])
        .loaded("plate", keys)
        .roller("foot")
        .roller("side")
}

#[test]
fn a_gradient_of_zero_changes_no_digit() {
    let energies = ["body_force = [0.3, -1.0]", "body_force = { value = [0.3, -1.0], gradient = [[0, 0], [0, 0]] }"]
        .map(|keys| solved(&problem(&turning(keys)), 1).expect("a solution"));
    let [a, b] = energies.map(|own| [own.bracket.lower(), upper(&own), own.dual.stress.largest_degree() as f64]);
    assert_eq!(a, b);
    assert_eq!(a[2], 1.0);
}

#[test]
fn a_rotation_about_a_point_is_the_affine_force() {
    let rotation = "rotation = { density = 0.5, omega = 2.0, about = [0.25, -0.5] }";
    let affine = "body_force = { value = [-0.5, 1.0], gradient = [[2, 0], [0, 2]] }";
    let both = "body_force = { value = [-1.0, 0.0], gradient = [[1, 0], [0, 1]] }\n\
                rotation = { density = 1.0, omega = 1.0, about = [-0.5, -1.0] }";
    let of = |keys: &str| solved(&problem(&turning(keys)), 3).expect("a solution");
    let [a, b, c] = [rotation, affine, both].map(|keys| of(keys).bracket.lower());
    assert!((a - b).abs() < 1e-14 * a.abs() && (a - c).abs() < 1e-14 * a.abs(), "{a} {b} {c}");
}

/// The bound of a scene that lies far from the origin is that of the scene at it, whose force is written for the other place.
#[test]
fn a_scene_may_lie_anywhere() {
    let near = turning("body_force = { value = [1.0, 0.0], gradient = [[1, 2], [0, -1]] }");
    let moved = Toml::default()
        .size(0.34)
        .model("plane-stress", 2.0)
        .polygon("plate", &[[1024.0, 0.0], [1025.0, 0.0], [1025.0, 1.0], [1024.0, 1.0]], ["foot", "", "", "side"])
        .loaded("plate", "body_force = { value = [-1023.0, 0.0], gradient = [[1, 2], [0, -1]] }")
        .roller("foot")
        .roller("side");
    let [a, b] = [near, moved].map(|toml| solved(&problem(&toml), 2).expect("a solution").bracket.lower());
    assert!((a - b).abs() < 1e-12 * a.abs(), "{a} {b}");
}

/// σ = −½ϱω²(a² − x²) … is too simple for a plane; along a bar without lateral strain it is the solution: u = (x − x³/3)·ϱω²/2 (E = 1, ν = 0).
#[test]
fn a_turning_bar_is_met_exactly_from_degree_two_on() {
    let bar = Toml::default()
        .size(0.5)
        .model("plane-stress", 1.0)
        .polygon("bar", &[[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]], ["foot", "", "head", "axis"])
        .material("bar", 1.0, 0.0)
        .loaded("bar", "body_force = { value = [0.0, 0.0], gradient = [[1, 0], [0, 0]] }")
        .roller("foot")
        .roller("head")
        .roller("axis");
    // 𝓛 = −½ ∫ σ²/E = −½ · ½ · ∫ (½(1 − x²))² dx.
    let exact = -0.25 * 0.25 * (1.0 - 2.0 / 3.0 + 1.0 / 5.0);
    for degree in [1, 2, 3] {
        let own = solved(&problem(&bar), degree).expect("a solution");
        assert!((own.bracket.lower() - exact).abs() < 1e-13, "{} {exact}", own.bracket.lower());
        assert!((upper(&own) - exact).abs() < 1e-13, "{} {exact}", upper(&own));
        assert_eq!(own.dual.stress.largest_degree(), degree.max(2));
    }
}
