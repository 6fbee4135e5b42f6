//! The curve behind a row: errors and bounds over the swept values.
//!
//! Methods that agree would hide each other, so each stands a little beside the swept value.

use super::data::Row;
use crate::measure::Method;
use crate::plot::{PlotError, Scale, Series, Sheet, draw};

/// Smaller errors are round-off, and drawn at this value.
const FLOOR: f64 = 1e-8;
/// Distance of neighbouring methods, where the distance of neighbouring values is 1.
const BESIDE: f64 = 0.07;

/// Errors against the truth (full markers), guaranteed errors of the methods that deliver them (hollow).
///
/// # Errors
/// The error that the drawing library reported.
pub fn curve(row: &Row) -> Result<String, PlotError> {
    let mut series = Vec::new();
    let middle = 0.5 * (Method::all().count() - 1) as f64;
    for cell in &row.cells {
        let beside = BESIDE * (cell.method.index() as f64 - middle);
        for (secondary, words) in [(false, "true"), (true, "guaranteed")] {
            let points: Vec<[f64; 2]> = cell
                .steps
                .iter()
                .enumerate()
                .filter_map(|(i, step)| {
                    let value = if secondary { step.bound } else { step.error }?;
                    value.is_finite().then_some([i as f64 + beside, value.max(FLOOR)])
                })
                .collect();
            if !points.is_empty() {
                series.push(Series {
                    label: format!("{}, {words}", cell.name()),
                    ink: cell.method.index(),
                    secondary,
                    points,
                    spread: Vec::new(),
                    open: Vec::new(),
                });
            }
        }
    }
    draw(&Sheet {
        title: row.title.clone(),
        labels: [row.parameter.clone(), "relative error in the energy norm".to_string()],
        x: Scale::Ordinal(row.values.clone()),
        series,
        front: Vec::new(),
        level: None,
        notes: vec![format!("errors below {FLOOR:.0e} are drawn there")],
        size: [980, 420],
    })
}
