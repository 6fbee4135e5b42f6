//! Error against cost, log–log.

use super::choice::{Of, pareto, slope};
use super::data::{Plot, Reference, SceneChart, Status};
use crate::measure::Method;
use crate::plot::{PlotError, Scale, Series, Sheet, draw};
use crate::report::text::number::significant;

/// Cost that an error is plotted against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cost {
    /// Seconds of the whole process.
    Whole,
    /// Seconds without start-up and reading.
    Solve,
    /// Unknowns.
    Unknowns,
}

impl Cost {
    /// All of them, in the order of a page.
    pub const ALL: [Cost; 3] = [Cost::Whole, Cost::Solve, Cost::Unknowns];

    /// File name of the figure; quantities are numbered.
    pub(super) fn file(self, scene: &SceneChart, of: Of<'_>) -> String {
        let axis = match self {
            Cost::Whole => "whole",
            Cost::Solve => "solve",
            Cost::Unknowns => "unknowns",
        };
        let number = |name| scene.quantities().iter().position(|own| *own == name).map_or(0, |i| i + 1);
        match of {
            Of::Energy => format!("chart-{}-error-{axis}.svg", scene.name),
            Of::Quantity(name) => format!("chart-{}-quantity-{}-{axis}.svg", scene.name, number(name)),
        }
    }

    /// Heading, and what the axis is.
    pub(super) fn words(self) -> (&'static str, &'static str) {
        match self {
            Cost::Whole => ("Error against seconds, whole process", "seconds from start of the process to the answer"),
            Cost::Solve => {
                ("Error against seconds, solving only", "seconds without start-up, imports, compilation, reading")
            }
            Cost::Unknowns => ("Error against unknowns", "unknowns"),
        }
    }

    fn cost(self, plot: &Plot) -> f64 {
        match self {
            Cost::Whole => plot.whole.median,
            Cost::Solve => plot.solve.median,
            Cost::Unknowns => plot.unknowns as f64,
        }
    }

    fn spread(self, plot: &Plot) -> [f64; 2] {
        match self {
            Cost::Whole => [plot.whole.least, plot.whole.most],
            Cost::Solve => [plot.solve.least, plot.solve.most],
            Cost::Unknowns => [self.cost(plot); 2],
        }
    }
}

/// The figures of errors of a scene: the solution on every axis, every quantity against seconds.
pub(super) fn error_figures(scene: &SceneChart) -> Vec<(Cost, Of<'_>)> {
    let of_energy = Cost::ALL.map(|axis| (axis, Of::Energy));
    let of_quantities = scene.quantities().into_iter().map(|name| (Cost::Whole, Of::Quantity(name)));
    of_energy.into_iter().chain(of_quantities).collect()
}

/// Smallest true error that can be told from zero, with a note on it where a reference is known.
fn resolution(scene: &SceneChart, of: Of<'_>) -> (f64, Option<(f64, String)>) {
    let (least, words) = match of {
        Of::Energy => (scene.reference.as_ref().ok().map(Reference::resolution), "half the reference bracket"),
        Of::Quantity(name) => {
            let half = |[lower, upper]: [f64; 2]| (upper - lower) / (upper + lower).abs();
            (scene.known(name).map(half).filter(|half| half.is_finite()), "half of what all runs leave open")
        }
    };
    (least.unwrap_or(0.0), least.map(|least| (least, words.to_string())))
}

/// True error (full markers) and guaranteed error (hollow) of every method, with slopes and the Pareto front of the
/// true errors. A true error that the reference bracket does not tell from zero is drawn at the largest it can be, on the
/// line of the bracket, and has no part in the slope.
///
/// # Errors
/// [`PlotError`] of the drawing library.
pub fn error_figure(scene: &SceneChart, axis: Cost, of: Of<'_>) -> Result<String, PlotError> {
    let mut series = Vec::new();
    let mut notes = Vec::new();
    let (least, level) = resolution(scene, of);
    for method in Method::all() {
        for (secondary, name) in [(false, "true"), (true, "guaranteed")] {
            let error = |plot: &Plot| {
                let error = scene.error(plot, of, secondary);
                if secondary { error } else { error.map(|e| e.max(least)) }
            };
            let points = scene.points(method, |p| axis.cost(p), error);
            if points.is_empty() {
                continue;
            }
            // Two points have a slope, but not one that says anything.
            let known: Vec<[f64; 2]> = points.iter().copied().filter(|p| secondary || p[1] > least).collect();
            let fitted = slope(&known).filter(|_| known.len() > 2);
            let fitted = fitted.map_or(String::new(), |s| format!(", slope {}", significant(s, 2)));
            let drawn = scene.done(method).map(|(_, p)| p).filter(|p| error(p).is_some_and(|e| e > 0.0));
            let whiskers = drawn.map(|p| {
                let exact = [error(p).unwrap_or_default(); 2];
                (axis.spread(p), if secondary { exact } else { scene.errors(p, of).unwrap_or(exact) })
            });
            // A finer run may have been the quicker one: the line goes on from left to right all the same.
            let mut both: Vec<_> = points.into_iter().zip(whiskers).collect();
            both.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
            let (points, (spread, open)) = both.into_iter().unzip();
            series.push(Series {
                label: format!("{}, {name}{fitted}", scene.name_of(method)),
                ink: method.index(),
                secondary,
                spread,
                open,
                points,
            });
        }
        if let Some(run) = scene.runs.iter().find(|r| r.method == method && r.status == Status::OverBudget) {
            notes.push(format!("{}: over the budget at level {}", run.name(), run.level));
        }
    }
    let all: Vec<[f64; 2]> = series.iter().filter(|s| !s.secondary).flat_map(|s| s.points.clone()).collect();
    let front = pareto(&all).into_iter().map(|i| all[i]).collect();
    let (title, x) = axis.words();
    let (title, y) = match of {
        Of::Energy => (format!("{title}: {}", scene.name), "relative error in the energy norm".to_string()),
        Of::Quantity(name) => (format!("{title}: {}, {name}", scene.name), format!("relative error of {name}")),
    };
    draw(&Sheet {
        title,
        labels: [x.to_string(), y],
        x: Scale::Logarithmic,
        series,
        front,
        level,
        notes,
        size: [1040, 560],
    })
}
