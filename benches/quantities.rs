//! What the interval of a quantity costs beside the bracket of the energy.
//!
//! `cargo bench --bench quantities -- [squares per side …]`
//!
//! The mean displacement of the loaded edge of the two blocks, linear stresses, n × n squares each, so 4n² triangles; one
//! thread, both ends of the interval, the least of three runs side by side.

#[path = "../tests/support/mod.rs"]
mod support;

use std::time::Instant;

use hypercircle::bounds::Bracket;
use hypercircle::dual::{Condensed, Options};
use hypercircle::scene::{Extent, Target};
use hypercircle::study::{answers, certify};
use support::Blocks;
use support::asked::{ask, quantity};

const REPEATS: usize = 3;

fn main() {
    let given: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let sizes = if given.is_empty() { vec![32, 64, 96] } else { given };
    println!("{:>9} {:>9} {:>9} {:>6} {:>11}", "triangles", "bracket s", "interval s", "ratio", "half-width");
    for n in sizes {
        let mut problem = Blocks { n, ..Blocks::default() }.problem();
        let of = Extent::Boundary("left_west".to_string());
        ask(&mut problem, vec![quantity("tip", Target::Displacement { of, direction: [1.0, 0.0] })]);
        let options = Options { keep_factor: true, ..Options::default() };
        let certified = certify(problem, &Condensed::default(), &options).expect("an answer");
        let (mut bracket, mut interval, mut width) = (f64::INFINITY, f64::INFINITY, 0.0);
        for _ in 0..REPEATS {
            let start = Instant::now();
            std::hint::black_box(Bracket::new(&certified.problem, &certified.dual));
            bracket = start.elapsed().as_secs_f64().min(bracket);
            let start = Instant::now();
            width = answers(&certified, &options, |_| true)[0].interval.half_width();
            interval = start.elapsed().as_secs_f64().min(interval);
        }
        println!("{:>9} {bracket:>9.3} {interval:>10.3} {:>6.2} {width:>11.2e}", 4 * n * n, interval / bracket);
    }
}
