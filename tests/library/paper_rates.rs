//! Theorems 2.2 and 2.3 and the energies: the committed rates of `docs/data/rates.json`, measured again.

use crate::support::theory::constant::Row;
use crate::support::theory::rates::{self, Measured, Study, fitted};
use crate::support::theory::tables;

/// The meshes that a test can afford; the committed studies go on to finer ones.
const INTERPOLATION: [usize; 4] = [8, 16, 32, 64];
const CONTACT: [usize; 4] = [4, 8, 16, 32];

/// The resolution of a rate fitted over few meshes.
const RESOLUTION: f64 = 0.1;

#[derive(serde::Deserialize)]
struct Committed {
    command: String,
    studies: Vec<Study>,
}

fn committed() -> Committed {
    serde_json::from_str(include_str!("../../docs/data/rates.json")).expect("committed rates")
}

fn compare(measured: &[Study]) {
    let committed = committed().studies;
    for study in measured {
        let same =
            |s: &&Study| (&s.solution, &s.family, &s.quantity) == (&study.solution, &study.family, &study.quantity);
        let old = committed.iter().find(same).unwrap_or_else(|| panic!("{study:?} is not committed"));
        let label = format!("{}, {}, {}", study.solution, study.family, study.quantity);
        for (new, old) in study.meshes.iter().zip(&old.meshes) {
            assert_eq!(new.n, old.n);
            assert!((new.error - old.error).abs() < 1e-3 * old.error, "{label}, n = {}: {new:?}, {old:?}", new.n);
        }
        if let Some(promised) = study.promised {
            assert!((study.rate - old.rate).abs() < RESOLUTION, "{label}: {} and {}", study.rate, old.rate);
            assert!(study.rate > promised - RESOLUTION, "{label}: {} for {promised}", study.rate);
        }
    }
}

#[test]
fn interpolation_errors_are_the_committed_ones() {
    compare(&rates::interpolation(&INTERPOLATION));
}

#[test]
fn contact_errors_are_the_committed_ones() {
    compare(&rates::contact(&CONTACT));
}

/// The meshes of the studies of degrees that a test can afford.
const OF_DEGREES: [usize; 3] = [4, 8, 16];
const CONTACT_ENDS: [usize; 2] = [4, 9];

fn committed_of_degrees() -> Committed {
    serde_json::from_str(include_str!("../../docs/data/rates_of_degrees.json")).expect("committed rates")
}

#[test]
fn errors_of_every_degree_are_the_committed_ones() {
    let committed = committed_of_degrees().studies;
    let measured =
        [rates::interpolation_of_degrees(&OF_DEGREES), rates::contact_end_of_degrees(&CONTACT_ENDS)].concat();
    assert_eq!(measured.len(), committed.len());
    for study in &measured {
        let same =
            |s: &&Study| (&s.solution, &s.family, &s.quantity) == (&study.solution, &study.family, &study.quantity);
        let old = committed.iter().find(same).unwrap_or_else(|| panic!("{study:?} is not committed"));
        for (new, old) in study.meshes.iter().zip(&old.meshes) {
            assert!(new.n == old.n && (new.error - old.error).abs() < 1e-3 * old.error, "{new:?}, {old:?}");
        }
    }
    for study in &committed {
        assert!((study.rate - fitted(&study.meshes)).abs() < 1e-9, "{study:?}");
        let finest = study.meshes.last_chunk::<2>().map(|two| fitted(two)).expect("two meshes");
        match study.promised {
            // p + 1 where the stress is smooth.
            Some(promised) => assert!((finest - promised).abs() < RESOLUTION, "{study:?}"),
            // On its way to h^{3/2} at a root, whatever the degree.
            None => assert!(finest > 1.5 && finest < study.rate - 0.05 && finest < 1.9, "{study:?}"),
        }
    }
}

/// Every promise of a theorem is kept by the committed study, which has four meshes at least.
#[test]
fn committed_rates_keep_what_the_theorems_promise() {
    let Committed { command, studies } = committed();
    assert_eq!(command, "cargo run --release --example theory_rates");
    for study in &studies {
        assert!(study.meshes.len() >= 4);
        assert!((study.rate - fitted(&study.meshes)).abs() < 1e-9, "{study:?}");
        let Some(promised) = study.promised else { continue };
        assert!(study.rate > promised - RESOLUTION, "{study:?}");
        if promised == 1.5 {
            assert!(study.rate >= promised, "{study:?}");
        }
        // No saturation on the finest meshes.
        let last: [Measured; 2] = *study.meshes.last_chunk().expect("two meshes");
        assert!(last[1].error < 0.4 * last[0].error, "{study:?}");
    }
    // Both energies converge with twice the rate of the stress where the solution is smooth.
    for quantity in ["energy error of −Π(λ_h)", "energy error of the free upper bound"] {
        let of = studies.iter().filter(|s| s.quantity == quantity && !s.solution.contains("root"));
        assert_eq!(of.clone().count(), 4);
        for study in of {
            // The free bound is better than its rate on the coarsest meshes: the finest three show the rate.
            let finest: [Measured; 3] = *study.meshes.last_chunk().expect("three meshes");
            assert!(fitted(&finest) > 4.0 - RESOLUTION, "{study:?}");
        }
    }
}

#[derive(serde::Deserialize)]
struct Constants {
    rows: Vec<Row>,
}

/// The tables of the documentation show the committed numbers.
#[test]
fn the_documentation_shows_the_committed_numbers() {
    let page = include_str!("../../docs/theory.md");
    let studies = committed().studies;
    let constants: Constants =
        serde_json::from_str(include_str!("../../docs/data/element_constant.json")).expect("committed constants");
    let lines = [
        tables::constants(&constants.rows),
        tables::rates(&studies, &tables::INTERPOLATION),
        tables::rates(&studies, &tables::CONTACT),
        tables::rates_of_degrees(&committed_of_degrees().studies),
    ];
    for line in lines.concat() {
        assert!(page.lines().any(|l| l == line), "docs/theory.md lacks the line {line}");
    }
}
