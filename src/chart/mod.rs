//! Accuracy against time: every method on every refinement of a scene, measured in processes of their own.
//!
//! [`Campaign`] makes the runs and saves `chart.json` after each of them; [`write()`] turns the data into `chart.csv`,
//! `chart.md`, `chart.html` and figures. The true error of a run is that of its energy, √(|E − E_run| / 𝒮), against a much tighter
//! bracket of the same scene; without contact it is the relative energy-norm error.

mod campaign;
mod choice;
mod csv;
mod data;
mod figure;
mod judge;
mod markdown;
mod page;
mod phases;
mod reference;
mod store;

pub use campaign::{Campaign, CampaignError, Plan};
pub use choice::{Choice, Of, fastest, pareto, slope};
pub use csv::csv;
pub use data::{Chart, Cold, Plot, Reference, Run, SceneChart, Spread, Status};
pub use figure::{Cost, error_figure};
pub use judge::judge;
pub use markdown::markdown;
pub use page::page;
pub use phases::phase_figure;
pub use reference::{REFERENCE_ADAPTIVE, REFERENCE_PRIMAL, from_runs};
pub(crate) use store::put;
pub use store::{StoreError, read, save, write};
