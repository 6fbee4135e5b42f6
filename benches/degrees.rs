//! Cost of a higher degree, and gain of a second thread.
//!
//! `cargo bench --bench degrees -- [unknowns]`
//!
//! The two blocks on squares, for every degree on a mesh that gives about as many unknowns: seconds of the factorisation for each
//! million unknowns, beside those of linear stresses; then the whole solve with its bracket on one thread and on two, phase by
//! phase, the least of three runs side by side.

#[path = "../tests/support/mod.rs"]
mod support;

use std::time::Instant;

use hypercircle::dual::{Condensed, Options, Phases};
use hypercircle::element::{Elements, block};
use hypercircle::study::certify;
use support::Blocks;

const REPEATS: usize = 3;

/// Unknowns of the first table.
const UNKNOWNS: usize = 200_000;

/// Squares per side of the second table, and degrees.
const SHARED: [(usize, usize); 5] = [(72, 1), (140, 1), (36, 3), (70, 3), (35, 6)];

/// The least whole seconds of a few runs, with their phases and unknowns.
fn run(n: usize, degree: usize, threads: usize) -> (f64, Phases, usize) {
    let options = Options { elements: Elements::Uniform(block(degree)), threads, ..Options::default() };
    let once = || {
        let problem = Blocks { n, ..Blocks::default() }.problem();
        let start = Instant::now();
        let certified = certify(problem, &Condensed::default(), &options).expect("an answer");
        (start.elapsed().as_secs_f64(), certified.dual.seconds, certified.dual.unknowns)
    };
    let runs = (0..REPEATS).map(|_| once());
    runs.min_by(|a, b| a.0.total_cmp(&b.0)).expect("some runs")
}

fn main() {
    let wanted = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(UNKNOWNS);
    println!("one thread; factorisation by unknown");
    println!(
        "{:>6} {:>9} {:>9} {:>9} {:>9} {:>12} {:>11} {:>11}",
        "degree", "triangles", "unknowns", "factor s", "solve s", "µs / unknown", "÷ degree 1", "whole ÷ 1"
    );
    let mut linear = None;
    for degree in 1..=8 {
        // Six edges for four triangles, two unknowns for each coefficient.
        let n = ((wanted as f64 / (12.0 * (degree + 1) as f64)).sqrt() as usize).max(2);
        let (whole, phases, unknowns) = run(n, degree, 1);
        let [each, all] = [phases.factor, whole].map(|seconds| 1e6 * seconds / unknowns as f64);
        let (first, first_all) = *linear.get_or_insert((each, all));
        println!(
            "{degree:>6} {:>9} {unknowns:>9} {:>9.3} {whole:>9.3} {each:>12.2} {:>11.2} {:>11.2}",
            4 * n * n,
            phases.factor,
            each / first,
            all / first_all
        );
    }
    println!("\none thread and two, seconds");
    println!(
        "{:>6} {:>9} {:>15} {:>15} {:>15} {:>15} {:>15} {:>15} {:>6}",
        "degree", "triangles", "assemble", "factor", "contact", "recover", "bracket, rest", "whole", "gain"
    );
    for (n, degree) in SHARED {
        let (one, first, _) = run(n, degree, 1);
        let (two, second, _) = run(n, degree, 2);
        let rest = |whole: f64, p: &Phases| whole - p.assemble - p.factor - p.contact - p.recover;
        let pair = |a: f64, b: f64| format!("{a:.3} {b:.3}");
        println!(
            "{degree:>6} {:>9} {:>15} {:>15} {:>15} {:>15} {:>15} {:>15} {:>6.2}",
            4 * n * n,
            pair(first.assemble, second.assemble),
            pair(first.factor, second.factor),
            pair(first.contact, second.contact),
            pair(first.recover, second.recover),
            pair(rest(one, &first), rest(two, &second)),
            pair(one, two),
            one / two
        );
    }
}
