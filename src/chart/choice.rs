//! Which method, which mesh: Pareto front, slopes, and the fastest run for a wanted accuracy.

use super::data::{Plot, Run, SceneChart, distances};
use crate::measure::{Asked, Method};

/// Relative errors that tables of fastest choices name.
pub(super) const WANTED: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];

/// A run that is good enough.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice<'a> {
    /// The run.
    pub run: &'a Run,
    /// Its numbers.
    pub plot: &'a Plot,
    /// The error by which it was chosen.
    pub error: f64,
}

/// The value whose error is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of<'a> {
    /// The solution, in the energy norm.
    Energy,
    /// The quantity of this name, relative to its value.
    Quantity(&'a str),
}

/// Subjects of the tables of fastest choices, each with the heading of its column of wanted errors.
pub(super) fn asked(scene: &SceneChart) -> Vec<(Of<'_>, String)> {
    let of_quantities = scene.quantities().into_iter().map(|name| (Of::Quantity(name), format!("wanted of {name}")));
    std::iter::once((Of::Energy, "wanted".to_string())).chain(of_quantities).collect()
}

/// The run that takes the least whole time with an error of at most `wanted`: by the guaranteed error, or by the true
/// one, which only the reference bracket knows, and not better than to its own width.
pub fn fastest<'a>(scene: &'a SceneChart, of: Of<'_>, wanted: f64, guaranteed: bool) -> Option<Choice<'a>> {
    // Errors in energy are roots of differences: the exact one is at most √(measured² + resolution²).
    let unsure = match (of, &scene.reference) {
        (Of::Energy, Ok(reference)) if !guaranteed => reference.resolution(),
        _ => 0.0,
    };
    scene
        .runs
        .iter()
        .filter_map(|run| {
            let plot = run.plot.as_ref()?;
            let error = scene.error(plot, of, guaranteed)?;
            (error.hypot(unsure) <= wanted).then_some(Choice { run, plot, error })
        })
        .min_by(|a, b| a.plot.whole.median.total_cmp(&b.plot.whole.median))
}

/// Indices of the points (cost, error) that no other point beats in both, by increasing cost.
pub fn pareto(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])));
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i][1] < best;
        best = best.min(points[i][1]);
        better
    });
    order
}

/// Least-squares slope of log y over log x; `None` for fewer than two different x.
pub fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let logs: Vec<[f64; 2]> =
        points.iter().filter(|p| p[0] > 0.0 && p[1] > 0.0).map(|p| [p[0].ln(), p[1].ln()]).collect();
    let n = logs.len() as f64;
    let mean = [0, 1].map(|i| logs.iter().map(|p| p[i]).sum::<f64>() / n);
    let spread: f64 = logs.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    let product: f64 = logs.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum();
    (spread > 1e-9).then(|| product / spread)
}

impl SceneChart {
    /// The error that a run guarantees, or its true one: for a quantity the largest that the bounds of all runs together allow.
    pub fn error(&self, plot: &Plot, of: Of<'_>, guaranteed: bool) -> Option<f64> {
        match of {
            Of::Energy if guaranteed => plot.guaranteed,
            Of::Energy => plot.true_error,
            Of::Quantity(name) if guaranteed => {
                let Asked { value, lower, upper, .. } = plot.quantities.iter().find(|q| q.name == name)?;
                Some(0.5 * ((*upper)? - (*lower)?) / (*value)?.abs()).filter(|error| error.is_finite())
            }
            Of::Quantity(_) => self.errors(plot, of).map(|[_, most]| most),
        }
    }

    /// Smallest and largest true error of a run that the reference, or the bounds of all runs together, allow.
    pub fn errors(&self, plot: &Plot, of: Of<'_>) -> Option<[f64; 2]> {
        match of {
            Of::Energy => Some(self.reference.as_ref().ok()?.errors(plot.lower.or(plot.upper)?)),
            Of::Quantity(name) => {
                let value = plot.quantities.iter().find(|q| q.name == name)?.value?;
                let relative = distances(self.known(name)?, value).map(|distance| distance / value.abs());
                Some(relative).filter(|[_, most]| most.is_finite())
            }
        }
    }

    /// Interval of a quantity that all runs together guarantee.
    pub fn known(&self, name: &str) -> Option<[f64; 2]> {
        let asked = self.runs.iter().filter_map(|run| run.plot.as_ref()?.quantities.iter().find(|q| q.name == name));
        let ends = asked.filter_map(|asked| Some([asked.lower?, asked.upper?]));
        ends.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])])
    }

    /// Names of the quantities that runs were asked for.
    pub fn quantities(&self) -> Vec<&str> {
        let first = self.runs.iter().filter_map(|run| run.plot.as_ref()).find(|plot| !plot.quantities.is_empty());
        first.map_or(Vec::new(), |plot| plot.quantities.iter().map(|q| q.name.as_str()).collect())
    }

    /// Points (cost, error) of a method, coarse to fine; points without an error above zero are left out, a logarithmic
    /// axis has no place for them.
    pub fn points(
        &self,
        method: Method,
        cost: impl Fn(&Plot) -> f64,
        error: impl Fn(&Plot) -> Option<f64>,
    ) -> Vec<[f64; 2]> {
        self.done(method)
            .filter_map(|(_, plot)| Some([cost(plot), error(plot)?]))
            .filter(|p| p.iter().all(|v| v.is_finite() && *v > 0.0))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_leaves_out_what_is_beaten() {
        let points = [[1.0, 1.0], [2.0, 0.5], [3.0, 0.7], [4.0, 0.1], [2.0, 0.6], [f64::NAN, 0.0]];
        assert_eq!(pareto(&points), [0, 1, 3]);
        assert_eq!(pareto(&[]), [0; 0]);
    }

    #[test]
    fn a_power_law_has_its_exponent_as_slope() {
        let points: Vec<[f64; 2]> = [1.0, 2.0, 5.0, 9.0].iter().map(|&x: &f64| [x, 7.0 * x.powf(-0.75)]).collect();
        assert!((slope(&points).expect("four points") + 0.75).abs() < 1e-12);
        assert_eq!(slope(&points[..1]), None);
        assert_eq!(slope(&[[1.0, 1.0], [1.0, 2.0]]), None);
    }
}
