//! Figures as inline SVG, one function from data to text per figure.
//!
//! Every element carries a class beside its colours: alone the figure is for light paper, inside the page the style
//! sheet recolours it for a dark screen.

mod axis;
pub mod bracket;
pub mod deformed;
pub mod drawn;
pub mod friction;
pub mod history;
pub mod map;
pub mod mark;
pub mod mesh;
pub(crate) mod outline;
pub mod pressure;
pub mod quantity;
pub(crate) mod raster;
pub mod scene;
pub(crate) mod svg;
mod symbols;
pub(crate) mod viridis;

pub(crate) use svg::escape;
