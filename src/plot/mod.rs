//! Line figures as SVG, readable in black and white and by the colour-blind: every series has its own colour (Okabe and
//! Ito), marker and dash pattern.

mod axis;
mod bars;
mod ink;
mod sheet;

pub use axis::Scale;
pub use bars::{Bar, bars};
pub use ink::{Ink, MARKERS};
pub use sheet::{Series, Sheet, draw};

/// Why a figure could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct PlotError(String);

impl<E: std::error::Error + Send + Sync> From<plotters::drawing::DrawingAreaErrorKind<E>> for PlotError {
    fn from(error: plotters::drawing::DrawingAreaErrorKind<E>) -> Self {
        PlotError(error.to_string())
    }
}

/// Says to screen readers what a figure shows, and lets it scale with the page.
fn accessible(svg: &str, title: &str) -> String {
    let clean: String = title.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{clean}\" "), 1)
}
