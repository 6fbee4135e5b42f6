//! The curve behind a row: errors and bounds over the swept values.

use super::data::Row;
use crate::plot::{PlotError, Scale, Series, Sheet, draw};

/// Smaller errors are round-off, and drawn at this value.
const FLOOR: f64 = 1e-8;

/// Guaranteed errors of the methods that deliver them (full markers), errors against the truth of all of them (hollow).
///
/// # Errors
/// What the drawing library reported.
pub fn curve(row: &Row) -> Result<String, PlotError> {
    let mut series = Vec::new();
    for cell in &row.cells {
        for (secondary, words) in [(false, "guaranteed"), (true, "true")] {
            let points: Vec<[f64; 2]> = cell
                .steps
                .iter()
                .enumerate()
                .filter_map(|(i, step)| {
                    let value = if secondary { step.error } else { step.bound }?;
                    value.is_finite().then_some([i as f64, value.max(FLOOR)])
                })
                .collect();
            if !points.is_empty() {
                series.push(Series {
                    label: format!("{}, {words}", cell.method.name()),
                    ink: cell.method.index(),
                    secondary,
                    points,
                    spread: Vec::new(),
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
