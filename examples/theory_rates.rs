//! Measures the rates and constants of the theory, writes them to `docs/data/`, and prints the tables of
//! `docs/theory.md`.
//!
//! `cargo run --release --example theory_rates`

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::Path;

use serde_json::json;
use support::theory::{constant, rates, tables};

const COMMAND: &str = "cargo run --release --example theory_rates";
const FINER: [usize; 5] = [8, 16, 32, 64, 128];
const SIZES: [usize; 5] = [4, 8, 16, 32, 64];
const OF_DEGREES: [usize; 4] = [4, 8, 16, 32];
/// The end of contact lies in the same place of its edge on all of them.
const CONTACT_ENDS: [usize; 4] = [4, 9, 19, 39];
const ANGLES: [f64; 10] = [60.0, 50.0, 40.0, 30.0, 20.0, 15.0, 10.0, 5.0, 2.0, 1.0];

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/data");
    std::fs::create_dir_all(&folder)?;
    let write = |name: &str, value: serde_json::Value| {
        std::fs::write(folder.join(name), format!("{:#}\n", value))?;
        println!("wrote docs/data/{name}");
        Ok::<(), std::io::Error>(())
    };

    let rows: Vec<_> = ANGLES.iter().map(|&angle| constant::worst(angle, 31, 500)).collect();
    write("element_constant.json", json!({ "command": COMMAND, "rows": rows }))?;
    let studies: Vec<_> = rates::interpolation(&FINER).into_iter().chain(rates::contact(&SIZES)).collect();
    write("rates.json", json!({ "command": COMMAND, "studies": studies }))?;

    let of_degrees: Vec<_> = (rates::interpolation_of_degrees(&OF_DEGREES).into_iter())
        .chain(rates::contact_end_of_degrees(&CONTACT_ENDS))
        .collect();
    write("rates_of_degrees.json", json!({ "command": COMMAND, "studies": of_degrees }))?;

    let tables = [
        tables::constants(&rows),
        tables::rates(&studies, &tables::INTERPOLATION),
        tables::rates(&studies, &tables::CONTACT),
        tables::rates_of_degrees(&of_degrees),
    ];
    for line in tables.concat() {
        println!("{line}");
    }
    Ok(())
}
