//! The files of a matrix.

use std::path::Path;

use super::data::Matrix;
use super::{curve, markdown, page};
use crate::chart::StoreError;
use crate::chart::put;

/// Writes `stability.json`, `stability.md`, `stability.html` and one curve a row in `figures/`.
///
/// # Errors
/// [`StoreError`].
pub fn write(matrix: &Matrix, folder: &Path) -> Result<(), StoreError> {
    let mut figures = Vec::new();
    for row in &matrix.rows {
        let name = format!("stability-{}.svg", row.id);
        let svg = curve::curve(row)
            .map_err(|reason| StoreError::Figure { name: name.clone(), reason: reason.to_string() })?;
        figures.push((name, svg));
    }
    let io = |e: serde_json::Error| StoreError::Io { path: folder.join("stability.json"), source: e.into() };
    let mut json = serde_json::to_string_pretty(matrix).map_err(io)?;
    json.push('\n');
    put(folder, "stability.json", json.as_bytes())?;
    put(folder, "stability.md", markdown::markdown(matrix).as_bytes())?;
    put(folder, "stability.html", page::page(matrix, &figures).as_bytes())?;
    for (name, svg) in &figures {
        put(folder, &format!("figures/{name}"), svg.as_bytes())?;
    }
    Ok(())
}
