//! The tables.

use crate::job::{Family, Measured};

const PHASES: [&str; 5] = ["assemble", "factor", "contact", "recover", "bracket"];

pub fn costs_head(family: Family) {
    match family {
        Family::Squares => println!("condensed method, lift-off, congruent triangles"),
        Family::Rough => println!("condensed method, lift-off, no two triangles congruent"),
    }
    let phases: String = PHASES.iter().map(|p| format!("{p:>9}")).collect();
    println!(
        "{:>9} {:>9} {phases} {:>8} {:>8} {:>8} {:>8} {:>6} {:>9}",
        "triangles", "unknowns", "seconds", "peak MiB", "faer s", "peak MiB", "ratio", "residual"
    );
}

pub fn costs_row(own: &Measured, plain: &Result<Measured, String>) {
    let seconds = own.get("seconds");
    let phases: String = PHASES.iter().map(|p| format!("{:>9.3}", own.get(p) * seconds)).collect();
    let plain_value = |name: &str| plain.as_ref().map_or(f64::NAN, |p| p.get(name));
    println!(
        "{:>9} {:>9} {phases} {seconds:>8.3} {:>8.0} {:>8.3} {:>8.0} {:>6.2} {:>9.1e}",
        own.get("triangles"),
        own.get("unknowns"),
        own.get("peak"),
        plain_value("seconds"),
        plain_value("peak"),
        seconds / plain_value("seconds"),
        own.get("residual")
    );
}

/// Growth of time with the number of triangles.
pub fn exponent(all: &[Measured]) {
    if let (Some(first), Some(last)) = (all.first(), all.last())
        && first.n < last.n
    {
        let growth =
            (last.get("seconds") / first.get("seconds")).ln() / (last.get("triangles") / first.get("triangles")).ln();
        println!("time grows like triangles^{growth:.2} from {} to {}", first.get("triangles"), last.get("triangles"));
    }
    println!();
}

pub fn others_head() {
    println!("other methods, congruent triangles (FEniCSx P2: seconds without start and compilation, wall clock)");
    println!("{:>11} {:>9} {:>9} {:>7} {:>13}", "method", "triangles", "seconds", "steps", "÷ condensed");
}

pub fn others_row(method: &str, own: &Measured, found: &Result<Measured, String>) {
    match found {
        Ok(found) => println!(
            "{method:>11} {:>9} {:>9.3} {:>7} {:>13.1}",
            own.get("triangles"),
            found.get("seconds"),
            found.get("steps"),
            found.get("seconds") / own.get("seconds")
        ),
        Err(reason) => println!("{method:>11} {:>9} {reason}", own.get("triangles")),
    }
}
