//! Figures as inline SVG, one function from data to text per figure.
//!
//! Every element carries a class beside its colours: alone the figure is for light paper, inside the page the style
//! sheet recolours it for a dark screen.

mod axis;
pub mod bracket;
pub mod deformed;
pub mod history;
pub mod map;
mod outline;
pub mod pressure;
pub mod quantity;
mod raster;
pub mod scene;
mod svg;
mod symbols;
mod viridis;

pub(crate) use svg::escape;
