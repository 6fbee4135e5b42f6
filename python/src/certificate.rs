//! A field, or values of quantities, held against guaranteed bounds.

use std::path::{Path, PathBuf};

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::aside::{aside, threads};
use crate::beside;
use crate::errors::{fault, told};
use crate::line::Line;
use hypercircle::cli::commands::certify::{Args, judged, read, stress_side};
use hypercircle::cli::commands::verify;
use hypercircle::cli::given::field::FieldFrom;
use hypercircle::cli::session::{DualRun, Session, refuse_unknown};
use hypercircle::cli::{CliError, Exit};
use hypercircle::report::{self, Dossier};
use hypercircle::scene::Scene;
use hypercircle::study::{FieldArrays, FieldError, ForeignField};

/// The arguments of `certify`.
#[derive(Default)]
pub struct Claims<'a, 'py> {
    /// Points, triangles, displacement.
    pub arrays: [Option<Bound<'py, PyAny>>; 3],
    /// In their place, a file.
    pub file: Option<PathBuf>,
    /// Name of the point data in the file.
    pub field: Option<&'a str>,
    /// Name of the arrays in messages and checks.
    pub name: &'a str,
    /// True if the field claims to be a discrete solution.
    pub solution: bool,
    /// Values of quantities.
    pub values: Option<&'a Bound<'py, PyDict>>,
    /// Tolerances of checks.
    pub allow: Option<&'a Bound<'py, PyDict>>,
    /// The guaranteed relative error of the stresses below which their refinement ends.
    pub tolerance: Option<f64>,
    /// Folder of the report.
    pub out: Option<PathBuf>,
}

/// The arguments in the form of the command.
pub struct Claimed {
    /// Its options.
    pub args: Args,
    arrays: Option<(String, FieldArrays)>,
}

impl Claims<'_, '_> {
    /// Reads the arguments; `how` says how to solve.
    ///
    /// # Errors
    /// `InputError`.
    pub fn made(self, how: Line) -> PyResult<Claimed> {
        let arrays = match &self.arrays {
            [Some(points), Some(triangles), Some(displacement)] => {
                let (points, _) = arrays::table("points", points)?;
                let triangles = arrays::indices("triangles", triangles)?;
                let (displacement, single) = arrays::table("displacement", displacement)?;
                Some((self.name.to_string(), FieldArrays { points, triangles, displacement, single }))
            }
            [None, None, None] => None,
            _ => return Err(fault("a field is points, triangles and displacement; give all three")),
        };
        let claims_values = self.values.is_some_and(|values| !values.is_empty());
        if arrays.is_some() == self.file.is_some() && (arrays.is_some() || !claims_values) {
            return Err(fault(
                "one thing has to be certified; give points, triangles and displacement, or a file, or values",
            ));
        }
        let from = FieldFrom::of(self.file.is_some(), arrays.is_some());
        from.refuse_unheard(self.field.is_some(), self.solution).map_err(told)?;
        let line = how
            .path("displacement", self.file.as_deref())
            .value("displacement", arrays.as_ref().map(|(name, _)| name))
            .value("field", self.field)
            .flag("solution", self.solution)
            .items("value", self.values)?
            .items("allow", self.allow)?
            .value("tolerance", self.tolerance)
            .path("out", self.out.as_deref());
        Ok(Claimed { args: line.parsed()?, arrays })
    }
}

/// Holds what is claimed against the bounds of `solved`, or of a solve on the mesh as given.
///
/// # Errors
/// `InputError`, `InfeasibleError`, `SolveError`.
pub fn certify(py: Python<'_>, scene: &Scene, claimed: Claimed, solved: Option<&DualRun>) -> PyResult<Certificate> {
    let count = threads(claimed.args.solve.threads);
    let (text, residual) = aside(py, count, || held(scene, claimed, solved, count))?.map_err(told)?;
    Ok(Certificate { report: super::from_json(py, Ok(text))?.unbind(), residual })
}

/// Solves `scene` twice and compares, with the options of `hypercircle verify`.
///
/// # Errors
/// `InputError`, `InfeasibleError`, `SolveError`.
pub fn verify(py: Python<'_>, scene: &Scene, how: Line) -> PyResult<Certificate> {
    let args: verify::Args = how.parsed()?;
    let count = threads(args.solve.threads);
    let text = aside(py, count, || {
        let session = Session::new("verify", scene.clone(), count, &args.solve, true)?;
        let folder = args.run.out.is_some().then(|| args.run.report_folder(scene)).transpose()?;
        args.judge.refuse_early(scene, args.fields(), &args.job)?;
        let verify::Verified { run, comparison, particulars, failure } =
            verify::verified(&args, &session, folder.as_deref())?;
        let text = session.with_dossier(&run, &comparison, particulars, |dossier| written(&dossier, folder.as_deref()));
        failure.map_or(text, |error| Err(verify::unanswered(&error)))
    })?;
    let text = text.map_err(told)?;
    Ok(Certificate { report: super::from_json(py, Ok(text))?.unbind(), residual: None })
}

/// The report as text, and in `folder`, where there is one.
fn written(dossier: &Dossier<'_>, folder: Option<&Path>) -> Result<String, CliError> {
    let failed = |error: String| CliError::stopped(Exit::Failed, error, "");
    if let Some(folder) = folder {
        report::write(dossier, folder).map_err(|error| failed(error.to_string()))?;
    }
    serde_json::to_string(&dossier.report).map_err(|error| failed(error.to_string()))
}

fn held(
    scene: &Scene,
    claimed: Claimed,
    solved: Option<&DualRun>,
    count: usize,
) -> Result<(String, Option<Vec<f64>>), CliError> {
    let Claimed { args, arrays } = claimed;
    let mut session = Session::new("certify", scene.clone(), count, &args.solve, true)?;
    let given = args.values.all(&mut session.scene)?;
    // Points of a table are quantities that a run from before does not have.
    let solved = solved.filter(|_| session.scene.quantities.len() == scene.quantities.len());
    let scene = &session.scene;
    refuse_unknown(scene, given.iter().map(|value| value.name.as_str()))?;
    let folder = args.run.out.is_some().then(|| args.run.report_folder(scene)).transpose()?;
    let field = match arrays {
        Some((name, arrays)) => Some(ForeignField::of_arrays(&name, arrays).map_err(refused)?),
        None if args.displacement.is_empty() => None,
        None => Some(read(&args, &session)?),
    };
    args.judge.refuse_early(scene, Some(field.iter().map(ForeignField::name).collect()), &args.job)?;
    let own;
    let run = match solved {
        Some(run) => run,
        None => {
            own = session.solve(&stress_side(&args, field.is_some()), &args.limits, folder.as_deref())?;
            &own
        }
    };
    let (comparison, particulars) = judged(&args, &session, run, field.as_ref(), &given, 0.0)?;
    let residual = particulars.residual.clone();
    session.with_dossier(run, &comparison, particulars, |dossier| {
        let text = written(&dossier, folder.as_deref())?;
        Ok((text, residual))
    })
}

fn refused(FieldError { file, what, remedy }: FieldError) -> CliError {
    CliError::stopped(Exit::BadInput, format!("{}: {what}", file.display()), remedy)
}

/// What a field, values, or the displacement models of `Scene.verify` are worth.
#[pyclass(frozen, module = "hypercircle")]
pub struct Certificate {
    report: Py<PyAny>,
    residual: Option<Vec<f64>>,
}

impl Certificate {
    /// A copy of an entry.
    fn entry<'py>(&self, py: Python<'py>, keys: &[&str]) -> PyResult<Bound<'py, PyAny>> {
        beside::copied(&keys.iter().try_fold(self.report.bind(py).clone(), |entry, key| entry.get_item(*key))?)
    }

    fn first<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.entry(py, &[key])?.try_iter()?.next().transpose()
    }
}

#[pymethods]
impl Certificate {
    /// Whether every check passed, and the bounds are sharp enough to tell.
    #[getter]
    fn passed(&self, py: Python<'_>) -> PyResult<bool> {
        self.entry(py, &["status"])?.eq("agree")
    }

    /// `agree`, `disagree` or `undecided`.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["status"])
    }

    /// One sentence.
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["verdict"])
    }

    /// The exact energy is no less.
    #[getter]
    fn lower<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["energy", "lower"])
    }

    /// The exact energy is no more.
    #[getter]
    fn upper<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["energy", "upper"])
    }

    /// The stress of the field is no further from the exact one, relative to it in the energy norm; `None` without a field.
    /// Where the field is not admissible, it is the nearest admissible one that is meant.
    #[getter]
    fn relative_error_bound<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.first(py, "primal")?.map(|field| field.get_item("relative_error_bound")).transpose()
    }

    /// Every check that decides: dictionaries with `name`, `value`, `reference`, `difference`, `allowed`, `passed`, `why`, ….
    #[getter]
    fn checks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["checks"])
    }

    /// What the checks that did not pass have in common: dictionaries with `sentence`, `suggests`, `remedy`, `place`, ….
    #[getter]
    fn causes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &["causes"])
    }

    /// Which mistake explains that the field is not the discrete solution it claims to be: a dictionary with `sentence`,
    /// `findings`, `explained`, `tried`; `None` where it is one, or claims nothing.
    #[getter]
    pub fn diagnosis<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.first(py, "diagnosis")
    }

    /// What equilibrium misses on each triangle, m numbers relative to the whole; `None` where the field claims nothing.
    #[getter]
    fn residual<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let there = this.get().residual.is_some();
        there.then(|| arrays::numbers(this, |own| own.residual.as_deref().unwrap_or_default())).transpose()
    }

    /// Everything that `report.json` holds, as a dictionary; `hypercircle schema report` describes it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, &[])
    }

    /// A list of the report as a dictionary of columns, as `pandas.DataFrame` takes it: `checks`, `remarks`, `quantities`, `contacts`,
    /// `primal`, `history`. Parts of an entry have dots in their names.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        beside::table(self.report.bind(py), name)
    }

    /// Verdict and intervals, for a notebook.
    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        beside::page(self.report.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("<Certificate: {}>", self.entry(py, &["verdict"])?.str()?))
    }
}
