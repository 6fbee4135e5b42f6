//! Time by phase: one bar for each method.

use super::data::{Plot, Run, SceneChart};
use crate::measure::Method;
use crate::plot::{Bar, PlotError, bars};
use crate::report::text::number::grouped;

/// Phases in the order of a run; `contact` is the solution itself where a method has only one phase for it.
const ORDER: [&str; 12] = [
    "start-up",
    "read",
    "exchange",
    "import",
    "mesh",
    "compile",
    "assemble",
    "factor",
    "contact",
    "recover",
    "coarser meshes",
    "statics and bounds",
];

/// A bar of phases for every method, at the finest level that all uniform methods with numbers reached; adaptive
/// methods at the run whose true error is nearest to that of the first of them.
///
/// # Errors
/// [`PlotError`] of the drawing library.
pub fn phase_figure(scene: &SceneChart) -> Result<String, PlotError> {
    let finest = |m: Method| scene.done(m).map(|(run, _)| run.level).max();
    let [adaptive, uniform] = [true, false].map(|wanted| Method::all().filter(move |m| m.is_adaptive() == wanted));
    let level = uniform.clone().filter_map(finest).min().unwrap_or(0);
    let mut chosen: Vec<(&Run, &Plot)> = Vec::new();
    for method in uniform {
        chosen.extend(scene.done(method).filter(|(run, _)| run.level == level));
    }
    let wanted = chosen.first().and_then(|(_, plot)| plot.true_error).unwrap_or(0.0);
    let distance = |plot: &Plot| plot.true_error.map_or(f64::INFINITY, |e| (e / wanted).ln().abs());
    let nearest = |method| scene.done(method).min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    chosen.extend(adaptive.filter_map(nearest));
    let parts: Vec<String> = ORDER.iter().map(ToString::to_string).collect();
    let list: Vec<Bar> = chosen
        .iter()
        .map(|(run, plot)| Bar {
            label: format!("{}, {} unknowns", run.name(), grouped(plot.unknowns)),
            parts: plot
                .phases
                .iter()
                .filter_map(|(name, s)| Some((ORDER.iter().position(|o| o == name)?, *s)))
                .collect(),
        })
        .collect();
    bars(&format!("Seconds by phase, level {level}: {}", scene.name), &parts, &list, 1040)
}
