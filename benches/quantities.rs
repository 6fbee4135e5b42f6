//! Cost of the interval of a quantity relative to the bracket of the energy.
//!
//! `cargo bench --bench quantities -- [squares per side …]`
//!
//! The mean displacement of the loaded edge of the two blocks, linear stresses, n × n squares each, so 4n² triangles; one
//! thread, the least of five runs side by side. The added cost is the time of bracket and interval together, where the interval reuses
//! data of the bracket, less that of a bracket alone.

#[path = "../tests/support/mod.rs"]
mod support;

use std::time::Instant;

use hypercircle::bounds::Bracket;
use hypercircle::dual::{Condensed, Options};
use hypercircle::scene::{Extent, Target};
use hypercircle::study::{Certified, answers, certify};
use support::Blocks;
use support::asked::{ask, quantity};

const REPEATS: usize = 5;

fn main() {
    let given: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let sizes = if given.is_empty() { vec![32, 64, 96] } else { given };
    println!("{:>9} {:>9} {:>9} {:>6} {:>11}", "triangles", "bracket s", "added s", "ratio", "half-width");
    for n in sizes {
        let mut problem = Blocks { n, ..Blocks::default() }.problem();
        let of = Extent::Boundary("left_west".to_string());
        ask(&mut problem, vec![quantity("tip", Target::Displacement { of, direction: [1.0, 0.0] })]);
        let options = Options { keep_factor: true, ..Options::default() };
        let mut certified = certify(problem, &Condensed::default(), &options).expect("an answer");
        let (mut bracket, mut both, mut width) = (f64::INFINITY, f64::INFINITY, 0.0);
        for _ in 0..REPEATS {
            let Certified { problem, dual, .. } = &certified;
            let start = Instant::now();
            options.on_threads(|| std::hint::black_box(Bracket::new(problem, dual)));
            bracket = start.elapsed().as_secs_f64().min(bracket);
            let start = Instant::now();
            certified.bracket = options.on_threads(|| Bracket::from_start(problem, dual, None, true));
            width = answers(&certified, &options, |_| true)[0].interval.half_width();
            both = start.elapsed().as_secs_f64().min(both);
        }
        let added = both - bracket;
        println!("{:>9} {bracket:>9.3} {added:>9.3} {:>6.2} {width:>11.2e}", 4 * n * n, added / bracket);
    }
}
