//! Files of a chart, each whole or not at all.

use std::path::{Path, PathBuf};

use super::data::{Chart, SCHEMA_VERSION};
use super::figure::{error_figure, error_figures};
use super::{csv, markdown, page, phases};
use crate::report::folder::replace;

/// The reason why the files of a chart could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file or folder.
    #[error("{path}: {source}; choose another folder with --out")]
    Io {
        /// Which.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A `chart.json` that cannot be continued.
    #[error("{path} cannot be continued: {reason}; leave out --resume to begin anew")]
    Content {
        /// Which.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A figure could not be drawn.
    #[error("the figure {name} could not be drawn: {reason}")]
    Figure {
        /// Which.
        name: String,
        /// Why.
        reason: String,
    },
}

/// Writes `bytes` to `folder/name` in one step.
pub(crate) fn put(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
    let path = folder.join(name);
    let io = |source: std::io::Error| StoreError::Io { path: path.clone(), source };
    let (Some(parent), Some(file)) = (path.parent(), path.file_name().and_then(|name| name.to_str())) else {
        return Err(io(std::io::ErrorKind::InvalidInput.into()));
    };
    replace(parent, &[(file, bytes.to_vec())], &[]).map_err(|e| io(std::io::Error::other(e)))
}

/// Saves `chart.json`.
///
/// # Errors
/// [`StoreError::Io`].
pub fn save(chart: &Chart, folder: &Path) -> Result<(), StoreError> {
    let io = |e: serde_json::Error| StoreError::Io { path: folder.join("chart.json"), source: e.into() };
    let mut text = serde_json::to_string_pretty(chart).map_err(io)?;
    text.push('\n');
    put(folder, "chart.json", text.as_bytes())
}

/// Reads `chart.json`; `None` where there is none.
///
/// # Errors
/// [`StoreError`].
pub fn read(folder: &Path) -> Result<Option<Chart>, StoreError> {
    let path = folder.join("chart.json");
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(StoreError::Io { path, source }),
    };
    let content = |reason: String| StoreError::Content { path: path.clone(), reason };
    let chart: Chart = serde_json::from_str(&text).map_err(|e| content(e.to_string()))?;
    if chart.schema_version != SCHEMA_VERSION {
        return Err(content(format!("its version is {}, this program writes {SCHEMA_VERSION}", chart.schema_version)));
    }
    Ok(Some(chart))
}

/// Writes all files: `chart.json`, `chart.csv`, `chart.md`, `chart.html`, and the figures of every scene in
/// `figures/`.
///
/// # Errors
/// [`StoreError`].
pub fn write(chart: &Chart, folder: &Path) -> Result<(), StoreError> {
    let mut figures = Vec::new();
    for scene in &chart.scenes {
        for (axis, of) in error_figures(scene) {
            let name = axis.file(scene, of);
            let svg = error_figure(scene, axis, of)
                .map_err(|reason| StoreError::Figure { name: name.clone(), reason: reason.to_string() })?;
            figures.push((name, svg));
        }
        let name = format!("chart-{}-phases.svg", scene.name);
        let svg = phases::phase_figure(scene)
            .map_err(|reason| StoreError::Figure { name: name.clone(), reason: reason.to_string() })?;
        figures.push((name, svg));
    }
    save(chart, folder)?;
    put(folder, "chart.csv", csv::csv(chart).as_bytes())?;
    put(folder, "chart.md", markdown::markdown(chart).as_bytes())?;
    put(folder, "chart.html", page::page(chart, &figures).as_bytes())?;
    for (name, svg) in &figures {
        put(folder, &format!("figures/{name}"), svg.as_bytes())?;
    }
    Ok(())
}
