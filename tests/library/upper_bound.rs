//! The free upper bound of every degree: one more than the stresses, on edges of degrees that differ.

use std::sync::Arc;

use crate::arcs::Arcs;
use crate::support::Blocks;
use crate::support::scenes::sample;
use hypercircle::bounds::{Bracket, NodalValues, Nodes, openings, potential};
use hypercircle::dual::{self, Condensed, DualSolution, Options};
use hypercircle::element::displacement::SplitNodes;
use hypercircle::element::polynomial::{side, triangle};
use hypercircle::element::{Displacement, Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::{Gap, Scene};
use hypercircle::stability::REGIMES;
use hypercircle::study::{Adapt, Goal, adapt, certify};

/// The energy of two unit blocks with lift-off, from far finer meshes.
const EXACT_A: f64 = -1.796_413_41;

/// Gaps below this part of the energy are rounding.
const EXACT: f64 = 1e-9;

/// Cases with more triangles take too long in every degree.
const MOST_TRIANGLES: usize = 800;

const DEGREES: std::ops::RangeInclusive<usize> = 1..=8;

fn solve(problem: &Problem, elements: Elements) -> DualSolution {
    let options = Options { elements, ..Options::default() };
    dual::solve(&Condensed::default(), problem, &[], &options).expect("solves")
}

fn bracket(problem: &Problem, elements: Elements) -> Bracket {
    Bracket::new(problem, &solve(problem, elements))
}

fn uniform(p: usize) -> Elements {
    Elements::Uniform(block(p))
}

/// Degrees 1 to `most`, one triangle's beside another's.
fn mixed(problem: &Problem, most: usize) -> Elements {
    let degree = |t: usize| (1 + (7 * t + t / 3) % most) as u8;
    Elements::Blocks((0..problem.mesh.triangles.len()).map(degree).collect::<Arc<[u8]>>())
}

/// Straight and curved, open and closed contact, with a gap and an interference.
fn scenes() -> Vec<(&'static str, Problem)> {
    let arcs = |arcs: Arcs| {
        let scene = Scene::parse(&arcs.text(), "arcs.toml".as_ref()).expect("a scene");
        Problem::load(scene).expect("a problem")
    };
    let blocks = |gap: f64| Blocks { n: 2, gap: Gap::Constant(gap), ..Blocks::default() }.problem();
    vec![
        ("lift-off", blocks(0.0)),
        ("gap", blocks(0.3)),
        ("interference", blocks(-0.1)),
        ("nearly incompressible", Blocks { n: 2, materials: [(1.0, 0.4999); 2], ..Blocks::default() }.problem()),
        ("arc", arcs(Arcs { n: 4, ..Arcs::default() })),
    ]
}

/// 𝓛(v) + Π(λ) from the two energies, and from its local terms.
#[test]
fn the_gap_is_the_sum_of_its_local_terms_in_every_degree() {
    for (name, problem) in scenes() {
        let mut fields: Vec<(String, Elements)> = DEGREES.map(|p| (format!("p = {p}"), uniform(p))).collect();
        fields.push(("mixed".to_string(), mixed(&problem, 5)));
        for (degree, elements) in fields {
            let start = std::time::Instant::now();
            let dual = solve(&problem, elements);
            let solved = start.elapsed();
            let bracket = Bracket::new(&problem, &dual);
            let free = bracket.free.as_ref().expect("an upper bound");
            let strain = bracket.complementary.strain;
            let gap = free.potential.total() - bracket.complementary.lower();
            println!(
                "{name}, {degree}: lower {:.9} gap {:.2e}, local terms less by {:.1e}, rounding {:.1e} {:?} {:?}",
                bracket.complementary.lower(),
                gap / strain,
                (gap - free.local.total) / strain,
                (free.widening + bracket.lower_widening) / strain,
                solved,
                start.elapsed() - solved,
            );
            let left = problem.scene.thickness * dual.equilibrium.work;
            assert!((gap - free.local.total).abs() < 1e-12 * strain + left, "{name}, {degree}");
            let terms = free.local.triangles.iter().chain(free.local.pairs.iter().flatten());
            assert!(terms.fold(0.0_f64, |m, t| m.min(*t)) > -1e-12 * strain, "{name}, {degree}");
        }
    }
}

/// Every degree has a sharper bound than the one before: both spaces grow.
#[test]
fn a_higher_degree_gives_a_sharper_bracket() {
    for (name, problem) in scenes() {
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        for p in 1..=5 {
            let bracket = bracket(&problem, uniform(p));
            let free = bracket.free.as_ref().expect("an upper bound");
            let gap = upper - lower;
            assert!(bracket.lower() >= lower - 1e-9, "{name}: lower bound for p = {p}");
            assert!(free.upper() <= upper + 0.01 * gap, "{name}: upper bound for p = {p}");
            (lower, upper) = (bracket.lower(), free.upper());
        }
    }
}

/// Between sides of a contact that do not coincide, 10⁻⁵ m apart, and in a fan whose triangles are 10⁶ times as long as high: what such
/// slivers tie has to move together in every degree.
#[test]
fn a_higher_degree_is_sharper_on_slivers() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/cylinder_on_block.toml");
    let cylinder = Problem::load(Scene::read(&path).expect("valid")).expect("valid");
    let fan = REGIMES.iter().copied().flatten().find(|row| row.id == "fan").expect("a row");
    for (name, problem) in [("cylinder", cylinder), ("fan", fan.problem(1e-6).expect("a problem"))] {
        let gaps = [3, 5, 7].map(|p| {
            let bracket = bracket(&problem, uniform(p));
            bracket.free.as_ref().expect("an upper bound").upper() - bracket.lower()
        });
        assert!(gaps[0] > 1.5 * gaps[1] && gaps[1] > 1.5 * gaps[2], "{name}: {gaps:?}");
    }
}

/// The effectivity √(gap/d) on the cases, d = 𝓛(u) + Π(λ_h) being enclosed by two degrees more on the same mesh. Set
/// `HYPERCIRCLE_DEGREE` for more degrees than 1 and 2.
#[test]
fn the_bound_of_every_degree_is_less_than_twice_the_error_on_every_case() {
    let highest = std::env::var("HYPERCIRCLE_DEGREE").ok().map_or(2, |p| p.parse().expect("a degree"));
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut compared = 0;
    for entry in std::fs::read_dir(folder).expect("cases") {
        let path = entry.expect("readable").path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let name = path.display();
        let problem = Problem::load(Scene::read(&path).expect("valid")).expect("valid");
        if problem.mesh.triangles.len() > MOST_TRIANGLES {
            continue;
        }
        let bounds = |p: usize| {
            let options = Options { elements: uniform(p), ..Options::default() };
            let start = std::time::Instant::now();
            let found = certify(problem.clone(), &Condensed::default(), &options);
            let bracket = found.unwrap_or_else(|e| panic!("{name}, p = {p}: {e}")).bracket;
            let upper = bracket.free.as_ref().expect("an upper bound").upper();
            println!(
                "{name} p = {p} {} triangles: {:.2e} in {:?}",
                problem.mesh.triangles.len(),
                (upper - bracket.lower()) / bracket.complementary.strain,
                start.elapsed()
            );
            (bracket.lower(), upper, bracket.complementary.strain)
        };
        let (least, most, strain) = bounds(highest + 2);
        for p in 1..=highest {
            let (lower, upper, _) = bounds(p);
            let gap = upper - lower;
            if gap < EXACT * strain {
                continue;
            }
            let [worst, best] = [least, most].map(|exact| (gap / (exact - lower)).sqrt());
            println!("{name}, p = {p}: between {best:.2} and {worst:.2}");
            assert!((1.0..2.0).contains(&best), "{name}, p = {p}: {best}");
            compared += 1;
        }
    }
    assert!(compared >= 6 * highest, "{compared}");
}

#[test]
fn nothing_locks_in_any_degree() {
    for p in DEGREES {
        let gaps = [0.3, 0.4999, 0.499999].map(|nu| {
            let problem = Blocks { n: 2, materials: [(1.0, nu); 2], ..Blocks::default() }.problem();
            let bracket = bracket(&problem, uniform(p));
            (bracket.free.as_ref().expect("an upper bound").upper() - bracket.lower()) / bracket.complementary.strain
        });
        println!("p = {p}: {gaps:?}");
        assert!(gaps[2] < 1.5 * gaps[1] && gaps[2] < 8.0 * gaps[0], "p = {p}: {gaps:?}");
    }
}

/// Both triangles of an edge give the same displacement on it, and the bodies open by what their sides say.
#[test]
fn degrees_that_differ_meet_without_a_gap() {
    for (name, problem) in scenes() {
        let bracket = bracket(&problem, mixed(&problem, 4));
        let v = &bracket.free.as_ref().expect("an upper bound").displacement;
        let degrees: Vec<usize> = (0..v.len()).map(|t| v.degree(t)).collect();
        assert!(degrees.iter().any(|k| *k != degrees[0]), "{name}: {degrees:?}");
        let size = (0..v.len()).map(|t| v.largest(t)).fold(0.0, f64::max);
        let mesh = &problem.mesh;
        for (e, edge) in mesh.edges.iter().enumerate() {
            for s in [0.0, 0.21, 0.5, 0.83, 1.0] {
                let on = |t: usize| {
                    let weight = |v: usize| match edge.vertices.iter().position(|w| *w == v) {
                        Some(0) => 1.0 - s,
                        Some(_) => s,
                        None => 0.0,
                    };
                    v.at(t, mesh.triangles[t].map(weight))
                };
                if let [Some(first), Some(second)] = edge.triangles {
                    let (a, b) = (on(first), on(second));
                    assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-13 * size, "{name}: edge {e} at {s}");
                }
            }
        }
        for pair in problem.pairs() {
            assert!(openings(&problem, v, pair).iter().all(|g| *g >= -1e-13 * size), "{name}");
        }
    }
}

/// u = ∇ Re z^m has neither divergence nor body force, in every material; its strain energy on [0, 2] × [0, 1] is
/// 2G m²(m − 1)² ∫ (x² + y²)^{m − 2}.
#[test]
fn energies_of_harmonic_polynomials_are_exact() {
    let binomial = |n: usize, k: usize| (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64);
    for nu in [0.3, 0.499999] {
        let problem = Blocks { n: 2, materials: [(1.0, nu); 2], load: (0.0, 0.0), ..Blocks::default() }.problem();
        for m in 3..=10 {
            let k = m - 1;
            let v = harmonic(&problem, k);
            let shear = 0.5 / (1.0 + nu);
            let integral: f64 = (0..=m - 2)
                .map(|i| {
                    let (a, b) = (2 * i, 2 * (m - 2 - i));
                    binomial(m - 2, i) * 2_f64.powi(a as i32 + 1) / ((a + 1) * (b + 1)) as f64
                })
                .sum();
            let exact = 2.0 * shear * ((m * k) as f64).powi(2) * integral;
            let found = potential(&problem, &v).strain;
            println!("ν {nu}, degree {k}: {found} for {exact}, off by {:.1e}", found / exact - 1.0);
            assert!((found / exact - 1.0).abs() < 1e-9);
        }
    }
}

/// m (Re z^k, −Im z^k): its coefficients are products of the corners as complex numbers.
fn harmonic(problem: &Problem, k: usize) -> Displacement {
    let mesh = &problem.mesh;
    let mut v = Displacement::zeros(std::iter::repeat_n(k, mesh.triangles.len()));
    let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        let centre = [0, 1].map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / 3.0);
        for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
            let q = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], centre];
            for (&node, alpha) in nodes.iter().zip(triangle::indices(k)) {
                let factors = (0..3).flat_map(|i| std::iter::repeat_n(q[i], alpha[i]));
                let [x, y] = factors.fold([(k + 1) as f64, 0.0], times);
                v.block_mut(t)[node] = [x, -y];
            }
        }
    }
    v
}

/// A run that refines begins from the displacement of the mesh before, whatever the degree.
#[test]
fn an_adaptive_run_carries_its_displacement_along() {
    for p in [2, 3] {
        let problem = Blocks { n: 2, ..Blocks::default() }.problem();
        let options = Options { elements: uniform(p), ..Options::default() };
        let adapted = adapt(problem, &Condensed::default(), &options, &Goal::new(2e-3), |_| ()).expect("refines");
        let bracket = &adapted.certified.bracket;
        let free = bracket.free.as_ref().expect("an upper bound");
        assert!(bracket.relative_error(free.upper()) < 2e-3);
        assert!(bracket.lower() < EXACT_A && free.upper() > EXACT_A, "{} {}", bracket.lower(), free.upper());
    }
}

#[test]
fn the_bound_knows_no_units() {
    let relative = |size: f64| {
        let problem = Blocks { n: 2, size, ..Blocks::default() }.problem();
        let bracket = bracket(&problem, uniform(3));
        bracket.free.as_ref().expect("an upper bound").local.total / bracket.complementary.strain
    };
    let one = relative(1.0);
    for size in [1e-6, 1e6] {
        let gap = relative(size);
        assert!((gap / one - 1.0).abs() < 1e-6, "{gap} at {size} for {one}");
    }
}

/// A displacement on edges of a higher degree is the same displacement.
#[test]
fn values_go_from_one_degree_to_another() {
    let problem = Blocks { n: 2, ..Blocks::default() }.problem();
    let mesh = &problem.mesh;
    let nodes = |k: usize| Nodes::new(mesh.points.len(), std::iter::repeat_n(k, mesh.edges.len()));
    let mut field = NodalValues::zeros(nodes(3));
    field.values.iter_mut().enumerate().for_each(|(n, v)| *v = [(n as f64).sin(), (2.0 * n as f64).cos()]);
    let raised = field.clone().on(mesh, &nodes(7));
    let back = raised.clone().on(mesh, &nodes(3));
    for e in 0..mesh.edges.len() {
        let along = |field: &NodalValues, c: usize| field.edge(mesh, e).iter().map(|u| u[c]).collect::<Vec<_>>();
        for c in 0..2 {
            for s in [0.1, 0.6] {
                let value = side::value(&along(&field, c), s);
                assert!((side::value(&along(&raised, c), s) - value).abs() < 1e-12);
                assert!((side::value(&along(&back, c), s) - value).abs() < 1e-11);
            }
        }
    }
}

/// Beside a singular corner at the end of a roller triangles are so small that rounding of their corners turns the edges of the
/// roller against each other: what a displacement along one does across another is part of the bound.
#[test]
fn the_gap_is_its_local_terms_beside_tiny_edges_of_rollers() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = Scene::read(&sample(40009).write(folder.path())).expect("a scene");
    let problem = Problem::load(scene).expect("a problem");
    let options = Options { elements: Elements::Uniform(block(3)), ..Options::default() };
    let goal = Goal { adapt: Adapt::Hp, max_triangles: Some(1500), ..Goal::new(0.02) };
    let run = adapt(problem, &Condensed::default(), &options, &goal, |_| ()).expect("an answer");
    let (bracket, upper) = (&run.certified.bracket, run.certified.bracket.free.as_ref().expect("an upper bound"));
    let off = upper.potential.total() - bracket.complementary.lower() - upper.local.total;
    assert!(off.abs() <= bracket.lower_widening + upper.widening, "{off:e} of {:e}", upper.widening);
    assert!(upper.widening < 1e-4 * upper.local.total, "{:e} of {:e}", upper.widening, upper.local.total);
}

/// A plate whose roller has a kink, which alone stops it: one point holds it, less and less on finer meshes, and what stresses say
/// of displacements is far off.
const HELD_BY_A_KINK: &str = r#"
    [model]
    kinematics = "plane-strain"
    [geometry]
    size = 0.06
    [[geometry.polygons]]
    body = "plate"
    points = [[0, 0], [1, 0], [1, 1], [0.5, 1.01], [0, 1]]
    edges = ["", "", "over", "over", ""]
    [bodies.plate]
    young = 1.0
    poisson = 0.4999
    body_force = [1e-3, 1e-3]
    [[supports]]
    on = "over"
    type = "roller"
"#;

#[test]
fn no_upper_bound_is_above_that_of_a_body_at_rest() {
    let scene = Scene::parse(HELD_BY_A_KINK, "kink.toml".as_ref()).expect("a scene");
    let problem = Problem::load(scene).expect("a problem");
    for degree in [1, 3] {
        let upper = bracket(&problem, uniform(degree)).free.expect("an upper bound").upper();
        assert!(upper <= 0.0, "degree {degree}: {upper}");
    }
}
