//! Stress intensities: handbook values lie inside, meshes and models agree, energies of two lengths as well, and what is no tip is refused.

use std::f64::consts::PI;
use std::fmt::Write;

use crate::support::asked::{ask, of_degree, quantity};
use hypercircle::dual::Condensed;
use hypercircle::problem::Problem;
use hypercircle::scene::{Mode, Scene, Target};
use hypercircle::study::{Goal, Wanted, adapt, answers, certify_divided, refuse_quantities};

/// Half of a strip of width 1 with a crack of length `a` from its left side, which is free or held by a roller, pulled by 1.
fn strip(a: f64, size: f64, left: &str) -> Problem {
    let text = format!(
        "[model]\nkinematics = \"plane-strain\"\n[geometry]\nsize = {size}\n[[geometry.polygons]]\nbody = \"strip\"\n\
         points = [[0, 0], [{a}, 0], [1, 0], [1, 3], [0, 3]]\nedges = [\"crack\", \"ahead\", \"\", \"top\", \"left\"]\n\
         [bodies.strip]\nyoung = 1.0\npoisson = 0.3\n[[supports]]\non = \"ahead\"\ntype = \"roller\"\n{left}\n\
         [[tractions]]\non = \"top\"\nvalue = [0, 1]\n"
    );
    Problem::load(Scene::parse(&text, "strip.toml".as_ref()).expect("a scene")).expect("a problem")
}

const SYMMETRIC: &str = "[[supports]]\non = \"left\"\ntype = \"roller\"";

fn bounded(mut problem: Problem, mode: Mode, tip: [f64; 2], tolerance: f64) -> [f64; 2] {
    ask(&mut problem, vec![quantity("K", Target::StressIntensity { mode, tip })]);
    let wanted = vec![Wanted { name: "K".to_string(), tolerance }];
    let goal = Goal { wanted, max_triangles: Some(6000), ..Goal::new(f64::INFINITY) };
    let options = of_degree(1);
    let adapted = adapt(problem, &Condensed::default(), &options, &goal, |_| ()).expect("an answer");
    assert_eq!(adapted.stopped, None);
    answers(&adapted.certified, &options, |_| true)[0].interval.ends
}

#[test]
fn handbook_values_lie_within_their_stated_accuracy() {
    // A centre crack, F = (1 − 0.025α² + 0.06α⁴) √sec(πα/2), 0.1 %; an edge crack, better than 0.5 % (Tada, Paris & Irwin).
    let a: f64 = 0.5;
    let centre = (1.0 - 0.025 * a * a + 0.06 * a.powi(4)) / (0.5 * PI * a).cos().sqrt();
    let angle = 0.5 * PI * a;
    let edge = (angle.tan() / angle).sqrt() * (0.752 + 2.02 * a + 0.37 * (1.0 - angle.sin()).powi(3)) / angle.cos();
    for (factor, accuracy, left) in [(centre, 1e-3, SYMMETRIC), (edge, 5e-3, "")] {
        let k = factor * (PI * a).sqrt();
        let [low, high] = bounded(strip(a, 0.12, left), Mode::I, [a, 0.0], 0.01);
        assert!(low <= k * (1.0 + accuracy) && k * (1.0 - accuracy) <= high, "{k} and [{low}, {high}]");
        assert!(high - low < 0.021 * k, "{k} and [{low}, {high}]");
    }
}

/// [−1, 1]² between rollers, drawn apart, with a crack from (−1/4, 0) to (1/4, 0): in the whole both faces, in its upper half one and a
/// roller beside either tip. What extracts the intensity ends where the crack does.
#[test]
fn an_inner_crack_has_the_intensity_of_its_half() {
    let upper =
        "[[geometry.polygons]]\nbody = \"p\"\npoints = [[-1, 0], [-0.25, 0], [0.25, 0], [1, 0], [1, 1], [-1, 1]]\n";
    let lower = "[[geometry.polygons]]\nbody = \"p\"\npoints = [[-1, -1], [1, -1], [1, 0], [0.25, 0], [-0.25, 0], [-1, 0]]\n\
                 edges = [\"foot\", \"side\", \"\", \"low\", \"\", \"side\"]\n";
    let roller = |on: &str, by: f64| format!("[[supports]]\non = \"{on}\"\ntype = \"roller\"\ndisplacement = {by:?}\n");
    let problem = |polygons: String, supports: String| {
        let text = format!(
            "[model]\nkinematics = \"plane-strain\"\n[geometry]\nsize = 0.2\n{polygons}[bodies.p]\nyoung = 1.0\npoisson = 0.3\n{}{}{supports}",
            roller("top", 1.0),
            roller("side", 0.0)
        );
        Problem::load(Scene::parse(&text, "inner.toml".as_ref()).expect("a scene")).expect("a problem")
    };
    let whole = || {
        let edges = "edges = [\"\", \"high\", \"\", \"side\", \"top\", \"side\"]\n";
        problem(format!("{lower}{upper}{edges}"), roller("foot", 1.0))
    };
    let edges = "edges = [\"ahead\", \"\", \"ahead\", \"side\", \"top\", \"side\"]\n";
    let half = bounded(problem(format!("{upper}{edges}"), roller("ahead", 0.0)), Mode::I, [0.25, 0.0], 0.01);
    for tip in [0.25, -0.25] {
        let [low, high] = bounded(whole(), Mode::I, [tip, 0.0], 0.01);
        assert!(low <= half[1] && half[0] <= high, "{tip}: [{low}, {high}] and {half:?}");
    }
    let [low, high] = bounded(whole(), Mode::II, [0.25, 0.0], 0.01 / f64::EPSILON);
    assert!(low <= 0.0 && 0.0 <= high, "[{low}, {high}]");
}

/// [−1, 1]² with a crack from (−1, 0) to (a, 0), of n × n squares, as a mesh file with two vertices at each point of the crack behind the tip.
fn cracked(folder: &std::path::Path, n: usize, length: usize, load: &str) -> Problem {
    let m = n + 1;
    let node = |i: usize, j: usize, above: bool| {
        let doubled = 2 * j == n && i < length && above;
        if doubled { m * m + i + 1 } else { j * m + i + 1 }
    };
    let at = |i: usize| -1.0 + 2.0 * i as f64 / n as f64;
    let mut text = String::from(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"b\"\n1 2 \"foot\"\n1 3 \"top\"\n$EndPhysicalNames\n",
    );
    let _ = writeln!(text, "$Nodes\n{}", m * m + length);
    for (i, j) in (0..m).flat_map(|j| (0..m).map(move |i| (i, j))) {
        let _ = writeln!(text, "{} {} {} 0", node(i, j, false), at(i), at(j));
    }
    for i in 0..length {
        let _ = writeln!(text, "{} {} 0 0", m * m + i + 1, at(i));
    }
    let mut cells = Vec::new();
    for i in 0..n {
        cells.push(format!("1 2 2 2 {} {}", node(i, 0, false), node(i + 1, 0, false)));
        cells.push(format!("1 2 3 3 {} {}", node(i, n, false), node(i + 1, n, false)));
    }
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let above = 2 * j >= n;
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| node(i, j, above));
        let halves = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        cells.extend(halves.map(|[p, q, r]| format!("2 2 1 1 {p} {q} {r}")));
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", cells.len());
    for (k, cell) in cells.iter().enumerate() {
        let (kind, rest) = cell.split_once(' ').expect("a cell");
        let _ = writeln!(text, "{} {kind} {rest}", k + 1);
    }
    text += "$EndElements\n";
    std::fs::write(folder.join("cracked.msh"), text).expect("writable");
    let scene = format!(
        "[model]\nkinematics = \"plane-strain\"\n[mesh]\nfile = \"cracked.msh\"\n[bodies.b]\nyoung = 1.0\npoisson = 0.3\n\
         [[supports]]\non = \"foot\"\ntype = \"clamped\"\n[[tractions]]\non = \"top\"\nvalue = {load}\n"
    );
    std::fs::write(folder.join("cracked.toml"), scene).expect("writable");
    Problem::load(Scene::read(&folder.join("cracked.toml")).expect("a scene")).expect("a problem")
}

#[test]
fn both_modes_give_the_energy_that_a_longer_crack_sets_free() {
    let folder = tempfile::tempdir().expect("a folder");
    let load = "[0.7, 1]";
    let k = [Mode::I, Mode::II].map(|mode| bounded(cracked(folder.path(), 8, 4, load), mode, [0.0, 0.0], 0.02));
    // Irwin: −dΠ/da = (1 − ν²)/E (K_I² + K_II²), Π = 𝓛(u), by central differences of brackets.
    let energy = |length: usize| {
        let problem = cracked(folder.path(), 32, length, load);
        let goal = Goal { max_triangles: Some(9000), ..Goal::new(0.012) };
        let adapted = adapt(problem, &Condensed::default(), &of_degree(1), &goal, |_| ()).expect("an answer");
        let bracket = &adapted.certified.bracket;
        let upper = bracket.free.as_ref().expect("a bound").upper();
        [bracket.lower(), upper]
    };
    let (shorter, longer) = (energy(14), energy(18));
    let step = 4.0 * 2.0 / 32.0;
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    let rate = (middle(shorter) - middle(longer)) / step;
    let square =
        |[low, high]: [f64; 2]| [low.min(high).max(0.0).powi(2).min(high.powi(2)), low.powi(2).max(high.powi(2))];
    let [one, two] = k.map(square);
    let released = [0, 1].map(|end| 0.91 * (one[end] + two[end]));
    assert!(0.93 * released[0] < rate && rate < 1.07 * released[1], "{rate} and {released:?}, K {k:?}");
    assert!(k[0][0] > 0.0 && k[0][1] - k[0][0] < 0.05 * k[0][0], "{k:?}");
}

#[test]
fn what_is_no_tip_is_refused_in_words() {
    let refused = |mode, tip| {
        let mut problem = strip(0.5, 0.25, "");
        ask(&mut problem, vec![quantity("K", Target::StressIntensity { mode, tip })]);
        refuse_quantities(&problem).expect_err("no tip")
    };
    for (mode, tip, words) in [
        (Mode::I, [0.45, 0.0], "no vertex of the mesh lies at the tip (0.45, 0)"),
        (Mode::II, [0.5, 0.0], "line of symmetry"),
        (Mode::I, [0.0, 0.0], "at an angle"),
        (Mode::I, [0.0, 1.5], "no free part meets a roller"),
    ] {
        let text = refused(mode, tip);
        assert!(text.contains(words), "{text}");
    }
    // With two elements to the width there is no answer, and a reason.
    let mut problem = strip(0.5, 0.5, "");
    ask(&mut problem, vec![quantity("K", Target::StressIntensity { mode: Mode::I, tip: [0.5, 0.0] })]);
    refuse_quantities(&problem).expect("a tip");
    let certified = certify_divided(problem, &Condensed::default(), &of_degree(1)).expect("an answer");
    let found = answers(&certified, &of_degree(1), |_| true);
    let reason = found[0].interval.reasons[0].clone().unwrap_or_default();
    assert!(reason.contains("too coarse") || found[0].interval.half_width().is_finite(), "{reason}");
}
