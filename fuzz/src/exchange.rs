//! Results of the displacement model: read, and where they are accepted, compared and reported.

use hypercircle::primal::Space;
use hypercircle::primal::exchange::parse_solution;
use hypercircle::study::candidates;

use super::setting::{certified, judge};

/// A refusal has to say something; everything else has to end in a report.
pub fn run(bytes: &[u8]) {
    let certified = certified();
    for degree in [1, 2] {
        match parse_solution(bytes, Space::on_triangles(degree), &certified.problem) {
            Ok(solution) => judge(certified, candidates(&certified.problem, vec![solution])),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}
