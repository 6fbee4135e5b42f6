//! The targets of `fuzz/` on their corpora, and on some thousand changes of them that are the same in every run.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::support::random::Random;

#[path = "../../fuzz/src/lib.rs"]
mod fuzz;

/// Changed inputs for each target.
const CHANGED: usize = 6000;
/// Time limit of one input, on a busy machine.
const LIMIT: Duration = Duration::from_secs(5);

const WORDS: [&str; 24] = [
    "0",
    "-1",
    "1e308",
    "-1e-308",
    "1e999",
    "nan",
    "-inf",
    "4294967296",
    "-9223372036854775808",
    "[",
    "]",
    "{",
    "}",
    "[[",
    "\"",
    "\"\"",
    "=",
    ",",
    "\n",
    "null",
    "é",
    "\u{0}",
    "\u{1b}[2J",
    "\u{202e}",
];

/// Names and contents of a corpus, in the order of the names.
fn corpus(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let entries = std::fs::read_dir(folder).expect("the corpus is part of the repository");
    let mut files: Vec<(String, Vec<u8>)> = entries
        .map(|entry| {
            let path = entry.expect("readable").path();
            (path.file_name().expect("a file").to_string_lossy().into_owned(), std::fs::read(&path).expect("readable"))
        })
        .collect();
    files.sort();
    files
}

/// Where a run of digits, dots, signs and exponents that holds `at` begins and ends.
fn number(bytes: &[u8], at: usize) -> std::ops::Range<usize> {
    let part = |b: &u8| b.is_ascii_digit() || b"+-.eE".contains(b);
    let start = bytes[..at].iter().rposition(|b| !part(b)).map_or(0, |i| i + 1);
    let end = bytes[at..].iter().position(|b| !part(b)).map_or(bytes.len(), |i| at + i);
    start..end
}

/// One to six small changes; parts of `other` may come in.
fn changed(mut bytes: Vec<u8>, other: &[u8], random: &mut Random) -> Vec<u8> {
    for _ in 0..1 + random.below(6) {
        if bytes.is_empty() {
            return bytes;
        }
        let at = random.below(bytes.len());
        let end = (at + 1 + random.below(40)).min(bytes.len());
        match random.below(8) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.below(256) as u8,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            4 => drop(bytes.splice(at..at, random.pick(&WORDS).bytes())),
            5 => {
                // The next number, or what stands here where none follows.
                let digit = bytes[at..].iter().position(u8::is_ascii_digit).map_or(at, |i| at + i);
                drop(bytes.splice(number(&bytes, digit), random.pick(&WORDS).bytes()));
            }
            6 => {
                let lines: Vec<Vec<u8>> = bytes.split_inclusive(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
                let (from, to) = (random.below(lines.len()), random.below(lines.len() + 1));
                bytes = [&lines[..to], &lines[from..=from], &lines[to..]].concat().concat();
            }
            _ => {
                let from = random.below(other.len().max(1)).min(other.len());
                let part = &other[from..(from + 1 + random.below(200)).min(other.len())];
                bytes.splice(at..end, part.iter().copied());
            }
        }
    }
    bytes
}

/// Runs a target; a panic is told with the input that caused it, which is kept.
fn run(name: &str, target: fn(&[u8]), bytes: &[u8], what: &str) {
    let since = Instant::now();
    let outcome = std::panic::catch_unwind(|| target(bytes));
    let took = since.elapsed();
    if outcome.is_err() || took > LIMIT {
        let path = std::env::temp_dir().join(format!("fuzzed-{name}-{}", what.replace(' ', "-")));
        std::fs::write(&path, bytes).expect("writable");
        panic!(
            "{name}, {what}: {}, after {took:?}; the input is {}",
            if outcome.is_err() { "panic" } else { "slow" },
            path.display()
        );
    }
}

fn fuzz(target: usize) {
    let (name, function) = fuzz::TARGETS[target];
    let corpus = corpus(name);
    assert!(corpus.len() >= 20, "{name}: {} files", corpus.len());
    for (file, bytes) in &corpus {
        run(name, function, bytes, file);
    }
    for seed in 0..CHANGED {
        let mut random = Random::new((target * 1_000_000 + seed) as u64);
        let (_, bytes) = &corpus[random.below(corpus.len())];
        let (_, other) = &corpus[random.below(corpus.len())];
        run(name, function, &changed(bytes.clone(), other, &mut random), &format!("seed {seed}"));
    }
}

#[test]
fn scenes() {
    fuzz(0);
}

#[test]
fn gmsh_files() {
    fuzz(1);
}

#[test]
fn results_of_the_displacement_model() {
    fuzz(2);
}

#[test]
fn fields_and_meshes_from_meshio() {
    fuzz(3);
}

/// The targets go as deep as they claim: the honest files of the corpora are accepted, solved and reported.
#[test]
fn honest_inputs_are_accepted() {
    use hypercircle::primal::Space;
    use hypercircle::primal::exchange::parse_solution;
    use hypercircle::study::ForeignField;

    let problem = &fuzz::setting::certified().problem;
    let read = |target: &str, file: &str| {
        let (_, bytes) = corpus(target).into_iter().find(|(name, _)| name == file).expect("a file of the corpus");
        bytes
    };
    for (file, degree) in [("p1.json", 1), ("p2.json", 2)] {
        parse_solution(&read("exchange", file), Space::on_triangles(degree), problem).expect("an honest result");
    }
    for (file, degree) in [("linear.json", 1), ("quadratic.json", 2)] {
        let field =
            ForeignField::parse(&read("field", file), Path::new("f.vtu"), String::new(), None).expect("a field");
        assert_eq!(field.candidate(problem, 0.0).expect("on the mesh").degree, degree);
    }
}
