//! Contact along curves, against the formulas for the curves themselves: what a polygon leaves of them falls like h².

use super::run::{close, models, sound, with_reference};
use crate::lame::Rings;

#[test]
fn ring() {
    let report = sound("ring");
    let exact = Rings { radii: [1.0, 1.5, 2.0], young: [2.0, 1.0], poisson: 0.3, inside: 0.02, depth: 0.01 };
    for bound in ["lower", "upper"] {
        close(report.number(&format!("/energy/{bound}")), exact.energy(), 1e-3);
    }
    // The pressure on the quarter pushes the inner ring back along both axes.
    for model in models() {
        for c in 0..2 {
            let force = report.number(&format!("/contact/0/resultant/{model}/{c}"));
            close(force, -exact.pressure() * 1.5, 5e-4);
        }
    }
    // One number on each facet, which shows how the triangles lie.
    let points = report.profile(0, "dual");
    assert_eq!(points.len(), 2 * 48);
    for [_, pressure] in points {
        close(pressure, exact.pressure(), 1e-2);
    }
    if with_reference() {
        close(report.number("/primal/1/energy"), exact.energy(), 1e-3);
    }
    assert!(report.notes().contains("48 edges stand for a curve"), "{}", report.notes());
}
