//! A scene, read and checked.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyType};

use crate::aside::{aside, threads};
use crate::beside;
use crate::certificate::{Certificate, Claims, certify, verify};
use crate::errors::{fault, told};
use crate::line::Line;
use crate::own_element::{balanced, spanned};
use crate::problem::{body_entry, list, problem_entry};
use crate::solution::Solution;
use hypercircle::cli::CliError;
use hypercircle::cli::commands::solve::{Args, solved};
use hypercircle::cli::given::options::MOST_REFINEMENTS;
use hypercircle::cli::session::Session;
use hypercircle::element::{Elements, MAX_DEGREE};
use hypercircle::problem::{Problem, ProblemError};
use hypercircle::scene;

/// Triangles of a mesh that is handed over, at most.
const MOST_TRIANGLES: usize = 20_000_000;

/// A scene: bodies, supports, tractions, contacts, and what it is solved for. `Scene(path)` reads a TOML file,
/// `Scene.from_text(text)` a text.
///
/// Raises `InputError` with the place in the file, what was found there, and what to do.
#[pyclass(frozen, module = "hypercircle")]
pub struct Scene {
    of: Arc<scene::Scene>,
}

#[pymethods]
impl Scene {
    #[new]
    fn new(path: PathBuf) -> PyResult<Self> {
        Ok(Scene { of: Arc::new(scene::Scene::read(&path).map_err(CliError::from).map_err(told)?) })
    }

    /// A scene from the text of its TOML file. Messages call it `name`; relative paths of mesh files start in `folder`, the
    /// current one where it is missing.
    #[classmethod]
    #[pyo3(signature = (text, name = "scene", folder = None))]
    fn from_text(_class: &Bound<'_, PyType>, text: &str, name: &str, folder: Option<PathBuf>) -> PyResult<Self> {
        let path = folder.unwrap_or_default().join(format!("{name}.toml"));
        Ok(Scene { of: Arc::new(scene::Scene::parse(text, &path).map_err(CliError::from).map_err(told)?) })
    }

    /// A scene from dictionaries and lists with the names that tables and keys have in the file: `{"model": {"kinematics": "plane-strain"},
    /// "bodies": {"block": {"young": 1.0, "poisson": 0.3}}, …}`. Arrays are lists, and what is `None` is left out.
    #[classmethod]
    #[pyo3(signature = (data, name = "scene", folder = None))]
    fn from_dict(
        class: &Bound<'_, PyType>,
        data: &Bound<'_, PyDict>,
        name: &str,
        folder: Option<PathBuf>,
    ) -> PyResult<Self> {
        Self::from_text(class, &beside::toml(data)?, name, folder)
    }

    /// Its name, that of the file.
    #[getter]
    fn name(&self) -> &str {
        &self.of.name
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.of.title
    }

    /// Its file.
    #[getter]
    fn path(&self) -> &Path {
        &self.of.path
    }

    /// `plane-strain`, `plane-stress` or `axisymmetric`.
    #[getter]
    fn kinematics(&self) -> &'static str {
        self.of.kinematics.name()
    }

    /// The thickness, by which energies and forces are multiplied.
    #[getter]
    fn thickness(&self) -> f64 {
        self.of.thickness
    }

    /// Its bodies: `name`, `young`, `poisson`, `body_force`.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        list(py, &self.of.bodies, body_entry)
    }

    /// The names of its contacts.
    #[getter]
    fn contacts(&self) -> Vec<String> {
        self.of.contacts.iter().map(scene::Contact::name).collect()
    }

    /// The names of its quantities.
    #[getter]
    fn quantities(&self) -> Vec<String> {
        self.of.quantities.iter().map(|quantity| quantity.name.clone()).collect()
    }

    /// The scene on its mesh, refined uniformly `refine` times: `points` (n × 2), `triangles` (m × 3), `quadrilaterals` of the mesh file
    /// whose halves are among them (q × 4), `body` (m, index into `bodies`), `edges` (e × 2), `triangle_edges` (m × 3), `conditions` of the edges (a roller has its outward
    /// `normal`), `boundaries` (the name of each edge, or `None`), `interfaces` (each pair has the `direction` of contact at its two ends), `bodies`, `kinematics`,
    /// `thickness`.
    #[pyo3(signature = (refine = 0))]
    fn problem<'py>(&self, py: Python<'py>, refine: i64) -> PyResult<Bound<'py, PyDict>> {
        let times = u32::try_from(refine).ok().filter(|times| *times <= MOST_REFINEMENTS);
        let times = times.ok_or_else(|| fault(format!("refine = {refine} is not in 0..={MOST_REFINEMENTS}")))?;
        let refused = |error: ProblemError| fault(format!("{}: {error}", self.of.path.display()));
        let coarse = aside(py, 1, || Problem::load((*self.of).clone()))?.map_err(refused)?;
        let triangles = coarse.mesh.triangles.len() * 4_usize.pow(times);
        if triangles > MOST_TRIANGLES {
            return Err(fault(format!(
                "refine = {refine} makes {triangles} triangles, more than {MOST_TRIANGLES}; refine less"
            )));
        }
        let made = aside(py, 1, || coarse.refine_uniform(times as usize))?;
        problem_entry(py, made.map_err(refused)?)
    }

    /// Solves in stresses and brackets the energy, with the options of `hypercircle solve`. `degrees` has one degree for each
    /// triangle; `element` is an equilibrium element of your own, an object with `degree` and `stresses(corners)`, in place of the block; `tolerance_of` maps quantities to tolerances; `max_memory` is text such as `2G`. With `out`, the report goes into
    /// that folder. Other Python threads run meanwhile.
    ///
    /// Raises `InputError`, `InfeasibleError` where the scene has no equilibrium, `SolveError` where a solver gives no answer.
    #[pyo3(signature = (*, method = "condensed", degree = None, degrees = None, refine = 0, tolerance = None, tolerance_of = None,
        adapt = None, max_triangles = None, max_seconds = None, max_memory = None, threads = 1, element = None, out = None))]
    #[allow(clippy::too_many_arguments)]
    pub fn solve(
        &self,
        py: Python<'_>,
        method: &str,
        degree: Option<i64>,
        degrees: Option<Vec<i64>>,
        refine: i64,
        tolerance: Option<f64>,
        tolerance_of: Option<&Bound<'_, PyDict>>,
        adapt: Option<&str>,
        max_triangles: Option<i64>,
        max_seconds: Option<f64>,
        max_memory: Option<&str>,
        threads: i64,
        element: Option<&Bound<'_, PyAny>>,
        out: Option<PathBuf>,
    ) -> PyResult<Solution> {
        let line = Line::default()
            .value("method", Some(method))
            .value("degree", degree)
            .value("refine", Some(refine))
            .value("tolerance", tolerance)
            .items("tolerance-of", tolerance_of)?
            .value("adapt", adapt)
            .value("max-triangles", max_triangles)
            .value("max-seconds", max_seconds)
            .value("max-memory", max_memory)
            .value("threads", Some(threads))
            .path("out", out.as_deref());
        let mut args: Args = line.parsed()?;
        args.solve.elements = degrees.map(|degrees| each_known(&degrees, &args)).transpose()?;
        let Some(object) = element else { return self.solve_as(py, args) };
        if args.solve.degree.is_some() || args.solve.elements.is_some() || args.solve.is_adaptive() {
            return Err(fault("an element has a degree, and a tolerance makes other meshes; give element, or these"));
        }
        if self.of.kinematics == scene::Kinematics::Axisymmetric {
            return Err(fault(
                "an element has the stresses of the plane, and the scene is a body of revolution; leave element out",
            ));
        }
        let own = spanned(object)?;
        let refine = args.solve.refine as usize;
        args.solve.elements = Some(Elements::Uniform(own));
        let solved = self.solve_as(py, args);
        let outcome = match &solved {
            Ok(solution) => py.detach(|| balanced(own, solution.problem())),
            // Stresses that do not balance are the reason of whatever else goes wrong with them.
            Err(_) => match aside(py, 1, || Problem::load((*self.of).clone())?.refine_uniform(refine))? {
                Ok(problem) => py.detach(|| balanced(own, &problem)),
                Err(_) => Ok(()),
            },
        };
        outcome.map_err(fault)?;
        solved
    }

    /// Holds a displacement field, or values of quantities, against guaranteed bounds, as `hypercircle certify` does: the stress
    /// side is solved on the mesh as given, which must be that of the field.
    ///
    /// `points` (n × 2), `triangles` (m × 3, or m × 6 with the middles of (0, 1), (1, 2), (2, 0) after the corners) and
    /// `displacement` (n × 2) are arrays; in their place `file` is one that meshio reads, `field` the name of its point data.
    /// With `solution` the field claims to be the discrete solution of its mesh, is held to that, and diagnosed where it is none.
    /// `values` maps quantities to numbers, `allow` checks to tolerances. `tolerance` refines the stresses alone, until their
    /// guaranteed error is below it. With `out`, the report goes into that folder.
    ///
    /// Raises as `solve` does.
    #[pyo3(signature = (points = None, triangles = None, displacement = None, *, file = None, field = None, name = "displacement",
        solution = false, values = None, allow = None, tolerance = None, method = "condensed", degree = None, max_triangles = None,
        max_seconds = None, max_memory = None, threads = 1, out = None))]
    #[allow(clippy::too_many_arguments)]
    fn certify(
        &self,
        py: Python<'_>,
        points: Option<Bound<'_, PyAny>>,
        triangles: Option<Bound<'_, PyAny>>,
        displacement: Option<Bound<'_, PyAny>>,
        file: Option<PathBuf>,
        field: Option<&str>,
        name: &str,
        solution: bool,
        values: Option<&Bound<'_, PyDict>>,
        allow: Option<&Bound<'_, PyDict>>,
        tolerance: Option<f64>,
        method: &str,
        degree: Option<i64>,
        max_triangles: Option<i64>,
        max_seconds: Option<f64>,
        max_memory: Option<&str>,
        threads: i64,
        out: Option<PathBuf>,
    ) -> PyResult<Certificate> {
        let how = Line::default()
            .value("method", Some(method))
            .value("degree", degree)
            .value("max-triangles", max_triangles)
            .value("max-seconds", max_seconds)
            .value("max-memory", max_memory)
            .value("threads", Some(threads));
        let arrays = [points, triangles, displacement];
        let claims = Claims { arrays, file, field, name, solution, values, allow, tolerance, out };
        certify(py, &self.of, claims.made(how)?, None)
    }

    /// Solves twice, in stresses and with FEniCSx in displacements of each `primal_degree`, and compares, as `hypercircle verify` does.
    /// `allow` maps checks to tolerances; the other options are those of `solve`. With `out`, the report goes into that folder.
    ///
    /// Raises as `solve` does; `SolveError` also where FEniCSx is not installed.
    #[pyo3(signature = (*, primal_degree = vec![1, 2], allow = None, method = "condensed", degree = None, refine = 0, tolerance = None,
        tolerance_of = None, max_triangles = None, max_seconds = None, max_memory = None, threads = 1, out = None))]
    #[allow(clippy::too_many_arguments)]
    fn verify(
        &self,
        py: Python<'_>,
        primal_degree: Vec<i64>,
        allow: Option<&Bound<'_, PyDict>>,
        method: &str,
        degree: Option<i64>,
        refine: i64,
        tolerance: Option<f64>,
        tolerance_of: Option<&Bound<'_, PyDict>>,
        max_triangles: Option<i64>,
        max_seconds: Option<f64>,
        max_memory: Option<&str>,
        threads: i64,
        out: Option<PathBuf>,
    ) -> PyResult<Certificate> {
        let degrees: Vec<String> = primal_degree.iter().map(i64::to_string).collect();
        let line = Line::default()
            .value("primal-degree", Some(degrees.join(",")))
            .items("allow", allow)?
            .value("method", Some(method))
            .value("degree", degree)
            .value("refine", Some(refine))
            .value("tolerance", tolerance)
            .items("tolerance-of", tolerance_of)?
            .value("max-triangles", max_triangles)
            .value("max-seconds", max_seconds)
            .value("max-memory", max_memory)
            .value("threads", Some(threads))
            .path("out", out.as_deref());
        verify(py, &self.of, line)
    }

    /// Measures accuracy against time, method by method and refinement by refinement, as `hypercircle chart` does, each run in a process
    /// of its own: `methods` are names of its table, the usual ones where they are missing, `primal_degree` degrees of FEniCSx, `budget`
    /// the seconds that a run may take. The scene has to be in a file. Returns what `chart.json` holds, a dictionary, and leaves it and the
    /// page `chart.html` in the folder `out`; `resume` keeps the runs that are there.
    ///
    /// Raises `InputError`, `SolveError`. Ctrl-C ends the processes.
    #[pyo3(signature = (*, out, methods = Vec::new(), primal_degree = Vec::new(), refine = 3, repeats = 3, budget = None, resume = false,
        max_memory = None, threads = 1))]
    #[allow(clippy::too_many_arguments)]
    fn chart<'py>(
        &self,
        py: Python<'py>,
        out: PathBuf,
        methods: Vec<String>,
        primal_degree: Vec<i64>,
        refine: i64,
        repeats: i64,
        budget: Option<f64>,
        resume: bool,
        max_memory: Option<&str>,
        threads: i64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let path = &self.of.path;
        if !path.is_file() {
            return Err(fault(format!(
                "a chart runs the command on the file of the scene, and {} is none; write it",
                path.display()
            )));
        }
        let degrees: Vec<String> = primal_degree.iter().map(i64::to_string).collect();
        let line = Line::default()
            .value("primal-degree", (!degrees.is_empty()).then(|| degrees.join(",")))
            .value("refine", Some(refine))
            .value("repeats", Some(repeats))
            .value("budget", budget)
            .flag("resume", resume)
            .value("max-memory", max_memory)
            .value("threads", Some(threads));
        let line = methods.iter().fold(line, |line, method| line.value("method", Some(method)));
        beside::chart(py, path, &out, line)
    }

    /// Which mistake explains that a displacement is not the discrete solution of its mesh: a dictionary with `sentence`,
    /// `findings`, `explained` (part of the squared residual) and `tried`; `None` where it is one. The same as
    /// `certify(points, triangles, displacement, solution=True).diagnosis`.
    ///
    /// Raises as `solve` does.
    fn diagnose<'py>(
        &self,
        py: Python<'py>,
        points: Bound<'py, PyAny>,
        triangles: Bound<'py, PyAny>,
        displacement: Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let arrays = [Some(points), Some(triangles), Some(displacement)];
        let claims = Claims { arrays, solution: true, name: "displacement", ..Claims::default() };
        certify(py, &self.of, claims.made(Line::default())?, None)?.diagnosis(py)
    }

    fn __repr__(&self) -> String {
        let names: Vec<&str> = self.of.bodies.iter().map(|body| body.name.as_str()).collect();
        format!("<Scene {}: bodies {}; contacts {}>", self.of.name, names.join(", "), self.contacts().join(", "))
    }
}

impl Scene {
    fn solve_as(&self, py: Python<'_>, args: Args) -> PyResult<Solution> {
        let count = threads(args.solve.threads);
        let scene = Arc::clone(&self.of);
        let solved = aside(py, count, || {
            let folder = args.run.out.is_some().then(|| args.run.report_folder(&scene)).transpose()?;
            let session = Session::new("solve", (*scene).clone(), count, &args.solve, true)?;
            let solved = solved(&args, &session, folder.as_deref())?;
            let solution = Solution::new(args, session, solved);
            folder.map(|folder| solution.write(&folder)).transpose()?;
            Ok::<_, CliError>(solution)
        })?;
        solved.map_err(told)
    }
}

/// One degree for each triangle.
fn each_known(degrees: &[i64], args: &Args) -> PyResult<Elements> {
    if args.solve.degree.is_some() {
        return Err(fault("give degree or degrees, not both"));
    }
    if args.solve.is_adaptive() {
        return Err(fault("degrees belong to one mesh, and a tolerance makes others; give degree, or no tolerance"));
    }
    let known = |p: &i64| match u8::try_from(*p) {
        Ok(p) if (1..=MAX_DEGREE).contains(&p.into()) => Ok(p),
        _ => Err(fault(format!("degrees: {p} is not in 1..={MAX_DEGREE}; use one of these"))),
    };
    Ok(Elements::Blocks(degrees.iter().map(known).collect::<PyResult<_>>()?))
}
