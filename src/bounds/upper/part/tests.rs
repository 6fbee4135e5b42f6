//! Parts on threads that talk through channels, held against the displacement of one process.

use std::sync::mpsc::{Receiver, Sender, channel};

use super::{Division, Found, Part};
use crate::bounds::ranks::Ranks;
use crate::bounds::rounding::terms::LowerTerms;
use crate::bounds::upper::admissible;
use crate::bounds::upper::admissible::nodes::Nodes;
use crate::bounds::upper::relaxation::groups::Group;
use crate::bounds::upper::relaxation::patches::grouped;
use crate::bounds::upper::relaxation::patches::tests::two_blocks;
use crate::bounds::{Bracket, Complementary, Potential, UpperBound};
use crate::dual::{self, Condensed, DualSolution, Options};
use crate::element::{Displacement, Elements, block};
use crate::problem::Problem;
use crate::scene::Scene;
use crate::statics;

/// A solved problem with the bracket of one process.
struct Solved {
    problem: Problem,
    dual: DualSolution,
    bracket: Bracket,
}

impl Solved {
    fn new(problem: Problem, elements: Elements) -> Self {
        let statics = statics::check_after(&problem, &|t| elements.degree(t), None).expect("an equilibrium");
        let options = Options { elements, ..Options::default() };
        let motions = statics.null_motions(&problem);
        let dual = dual::solve(&Condensed::default(), &problem, &motions, &options).expect("solves");
        let bracket = Bracket::new(&problem, &dual);
        Solved { problem, dual, bracket }
    }
}

/// A rank that is a thread.
struct Thread {
    to: Vec<Sender<Vec<f64>>>,
    from: Vec<Receiver<Vec<f64>>>,
}

impl Ranks for Thread {
    fn exchange(&self, to: &[(usize, Vec<f64>)], from: &[(usize, usize)]) -> Vec<Vec<f64>> {
        to.iter().for_each(|(rank, numbers)| self.to[*rank].send(numbers.clone()).expect("the other one lives"));
        let taken = |(rank, count): &(usize, usize)| {
            let numbers = self.from[*rank].recv().expect("the other one lives");
            assert_eq!(numbers.len(), *count);
            numbers
        };
        from.iter().map(taken).collect()
    }

    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>> {
        self.to.iter().for_each(|to| to.send(own.to_vec()).expect("the other one lives"));
        self.from.iter().map(|from| from.recv().expect("the other one lives")).collect()
    }
}

fn threads(count: usize) -> Vec<Thread> {
    let mut all: Vec<Thread> = (0..count).map(|_| Thread { to: Vec::new(), from: Vec::new() }).collect();
    for from in 0..count {
        for to in 0..count {
            let (sender, receiver) = channel();
            all[from].to.push(sender);
            all[to].from.push(receiver);
        }
    }
    all
}

/// The bracket that `ranks` threads make, the triangles being divided as `owner` says; relaxing ends near `floor`, or near the lower
/// bound that they find.
fn of_parts(of: &Solved, floor: Option<f64>, ranks: usize, owner: &[usize]) -> (LowerTerms, UpperBound) {
    let (problem, dual) = (&of.problem, &of.dual);
    let division = Division::new(problem, &dual.moments, owner, ranks).expect("supports agree");
    // As it goes to another process.
    let sent = |rank| {
        let mut file = Vec::new();
        division.part(rank, &dual.stress, &dual.moments).write(&mut file).expect("memory");
        Part::read(&file[..]).expect("what was written")
    };
    let parts: Vec<_> = (0..ranks).map(sent).collect();
    let found: Vec<Found> = std::thread::scope(|scope| {
        let started: Vec<_> = (parts.iter().zip(threads(ranks)))
            .map(|(part, thread)| scope.spawn(move || part.bracket(floor, &thread).expect("an upper bound")))
            .collect();
        started.into_iter().map(|thread| thread.join().expect("an end")).collect()
    });
    // As it comes back.
    let came = |found: &Found| {
        let mut file = Vec::new();
        found.write(&mut file).expect("memory");
        Found::read(&file[..]).expect("what was written")
    };
    let found: Vec<Found> = found.iter().map(came).collect();
    division.bracket(&found).expect("admissible").expect("what belongs there")
}

fn case(name: &str) -> String {
    std::fs::read_to_string(crate::in_repository(&format!("{name}.toml"))).expect("a scene")
}

/// Rings in coarse triangles.
fn ring() -> String {
    case("cases/ring").replace("size = 0.05", "size = 0.1")
}

fn solved(scene: &str, elements: impl Fn(usize) -> Elements) -> Solved {
    let scene = Scene::parse(scene, "scene.toml".as_ref()).expect("a scene");
    let problem = Problem::load(scene).expect("a problem");
    let elements = elements(problem.mesh.triangles.len());
    Solved::new(problem, elements)
}

fn of_degree(degree: usize) -> impl Fn(usize) -> Elements {
    move |_| Elements::Uniform(block(degree))
}

fn mixed(triangles: usize) -> Elements {
    Elements::Blocks((0..triangles).map(|t| 1 + (t * t % 3) as u8).collect())
}

/// Triangles in a row, from the first rank to the last one.
fn in_a_row(triangles: usize, ranks: usize) -> Vec<usize> {
    (0..triangles).map(|t| t * ranks / triangles).collect()
}

/// Triangles anywhere; a rank may have none.
fn anywhere(triangles: usize, ranks: usize, seed: u64) -> Vec<usize> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    (0..triangles).map(|_| next() % ranks).collect()
}

/// Long flat blocks, whose triangles tie vertices together.
fn flat() -> String {
    let lower = [[0.0, 0.0], [9.0, 0.0], [9.0, 0.2], [0.0, 0.2]];
    let upper = [[0.0, 0.2], [9.0, 0.2], [9.0, 0.3], [0.0, 0.3]];
    two_blocks(4.0, [lower, upper], [[0.0, 0.0], [9.0, 0.001]])
}

/// By how much two displacements differ at most, in the size of the first.
fn difference(a: &Displacement, b: &Displacement) -> f64 {
    let pairs = (0..a.len()).flat_map(|t| a.block(t).iter().zip(b.block(t)));
    let off = pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0_f64, f64::max);
    off / (0..a.len()).map(|t| a.largest(t)).fold(0.0, f64::max)
}

fn groups_of(problem: &Problem, degree: usize) -> Vec<Group> {
    let nodes = Nodes::new(problem.mesh.points.len(), problem.mesh.edges.iter().map(|_| degree));
    grouped(problem, &nodes).0
}

/// Without sums over all triangles, which are taken rank by rank.
#[test]
fn two_sweeps_of_any_ranks_end_with_every_digit_of_one_process() {
    let scenes: [(&str, &dyn Fn(usize) -> Elements); 3] = [
        (&case("cases/two_blocks"), &mixed),
        (&case("tests/scenes/three_that_meet_in_a_point"), &of_degree(3)),
        (&flat(), &of_degree(3)),
    ];
    for (number, (scene, elements)) in scenes.into_iter().enumerate() {
        let of = solved(scene, elements);
        let one = admissible(&of.problem, &of.dual, f64::MAX, None).expect("an upper bound");
        let n = one.len();
        for (ranks, owner) in [(2, in_a_row(n, 2)), (5, anywhere(n, 5, 7))] {
            let found = of_parts(&of, Some(f64::MAX), ranks, &owner).1.displacement;
            assert!(found == one, "scene {number} on {ranks} ranks: {:e}", difference(&one, &found));
        }
    }
}

/// Not in slivers: hundreds of sweeps end as far apart from moments that differ in their last digits.
#[test]
fn ranks_find_the_bounds_of_one_process() {
    let scenes: [(&str, &dyn Fn(usize) -> Elements); 4] = [
        (&case("cases/gravity"), &mixed),
        (&case("cases/inclined"), &of_degree(1)),
        (&ring(), &of_degree(1)),
        (&case("tests/scenes/three_that_meet_in_a_point"), &of_degree(1)),
    ];
    for (number, (scene, elements)) in scenes.into_iter().enumerate() {
        let of = solved(scene, elements);
        agree(&format!("scene {number}"), &of);
    }
}

/// Several ranks and one process find the same.
#[track_caller]
fn agree(scene: &str, of: &Solved) {
    let one = of.bracket.free.as_ref().expect("an upper bound");
    for ranks in [1, 3] {
        let (lower, upper) = of_parts(of, None, ranks, &anywhere(one.displacement.len(), ranks, 3));
        let off = difference(&one.displacement, &upper.displacement);
        let apart = (one.upper() - upper.upper()).abs() / one.potential.magnitude;
        assert!(ranks > 1 || upper.displacement == one.displacement, "{scene}: {off:e}");
        assert!(off < 1e-12 && apart < 1e-13, "{scene} on {ranks} ranks: {off:e} {apart:e}");
        // Energies and terms of the gap as one process evaluates them on the displacement of the ranks.
        let here = UpperBound::new(&of.problem, &of.dual, upper.displacement.clone());
        assert_eq!(upper.local, here.local, "{scene} on {ranks} ranks");
        let [of_ranks, of_one] = [&upper, &here].map(|upper| (upper.potential, upper.widening));
        let numbers = |(p, widening): (Potential, f64)| [p.strain, p.work, p.magnitude, p.sensitivity, widening];
        alike(numbers(of_ranks), numbers(of_one), of_one.0.magnitude);
        let bracket = Bracket::of_terms(&of.problem, &of.dual, lower, Ok(upper));
        let [of_ranks, of_one] = [&bracket, &of.bracket].map(|bracket| (bracket.complementary, bracket.lower_widening));
        let numbers = |(c, widening): (Complementary, f64)| {
            [c.strain, c.support_work, c.gap_work, c.magnitude, c.sensitivity, widening]
        };
        alike(numbers(of_ranks), numbers(of_one), of_one.0.magnitude);
    }
}

/// Checks that sums agree but for the order of their terms; the last two are sums of rounding errors.
#[track_caller]
fn alike<const N: usize>(a: [f64; N], b: [f64; N], magnitude: f64) {
    for (i, (a, b)) in a.into_iter().zip(b).enumerate() {
        let size = if i + 2 < N { magnitude } else { b.abs() };
        assert!((a - b).abs() <= 1e-13 * size, "number {i}: {a:e} is not {b:e}");
    }
}

#[test]
fn a_rank_that_lost_a_term_or_found_no_number_is_refused() {
    let of = solved(&case("cases/two_blocks"), of_degree(1));
    let owner = in_a_row(of.problem.mesh.triangles.len(), 1);
    let division = Division::new(&of.problem, &of.dual.moments, &owner, 1).expect("supports agree");
    let part = division.part(0, &of.dual.stress, &of.dual.moments);
    let whole = part.bracket(None, &threads(1).remove(0)).expect("an upper bound");
    let refused = |change: &dyn Fn(&mut Found)| {
        let mut found = whole.clone();
        change(&mut found);
        division.bracket(&[found]).expect("admissible").is_none()
    };
    assert!(!refused(&|_| {}));
    assert!(refused(&|found| found.triangles.truncate(1)));
    assert!(refused(&|found| found.pairs.push(0.0)));
    assert!(refused(&|found| found.upper[1] = f64::NAN));
    assert!(refused(&|found| found.lower.clear()));
    assert!(refused(&|found| found.values[0][1] = f64::INFINITY));
    assert!(refused(&|found| found.inside.truncate(1)));
}

/// Similar triangles have the stiffness of the first of them in the whole mesh, wherever that is; refining makes some that differ in
/// their last digits.
#[test]
fn parts_take_the_stiffness_of_the_whole() {
    let scene = Scene::parse(&ring(), "ring.toml".as_ref()).expect("a scene");
    let problem = Problem::load(scene).and_then(|problem| problem.refine_uniform(1)).expect("a finer mesh");
    let of = Solved::new(problem, Options::default().elements);
    let one = admissible(&of.problem, &of.dual, f64::MAX, None).expect("an upper bound");
    assert!(of_parts(&of, Some(f64::MAX), 2, &in_a_row(one.len(), 2)).1.displacement == one);
}

#[test]
fn flat_triangles_tie_vertices_together_across_contact() {
    let of = solved(&flat(), of_degree(1));
    let largest = groups_of(&of.problem, 2).iter().map(|group| group.vertices.len()).max();
    assert!(largest > Some(3), "{largest:?}");
}
