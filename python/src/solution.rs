//! The solution of a scene.

use std::path::{Path, PathBuf};

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyString};

use crate::answers::{ContactAnswer, Quantity};
use crate::arrays;
use crate::beside;
use crate::certificate::{Certificate, Claims, certify};
use crate::line::Line;
use hypercircle::cli::commands::solve::{Args, Solved};
use hypercircle::cli::conclude::Particulars;
use hypercircle::cli::given::options::SolveOptions;
use hypercircle::cli::session::Session;
use hypercircle::cli::{CliError, Exit};
use hypercircle::element::{SideValues, lattice};
use hypercircle::problem::Problem;
use hypercircle::report::{self, Dossier};
use hypercircle::study::{Certified, summaries};

/// The stress side of a scene: a stress in equilibrium, the interval that holds the exact energy, and the intervals of the
/// quantities. Arrays show its numbers in place: they are read-only.
#[pyclass(frozen, module = "hypercircle")]
pub struct Solution {
    args: Args,
    session: Session,
    solved: Solved,
    starts: Vec<i64>,
    report: PyOnceLock<Py<PyAny>>,
}

impl Solution {
    /// Scene and mesh that were solved on.
    pub fn problem(&self) -> &Problem {
        &self.solved.run.certified.problem
    }

    /// The solution that `session` found.
    pub fn new(args: Args, session: Session, solved: Solved) -> Self {
        let starts = solved.run.certified.dual.stress.starts().iter().map(|n| *n as i64).collect();
        Solution { args, session, solved, starts, report: PyOnceLock::new() }
    }

    /// Writes the report into `folder`.
    ///
    /// # Errors
    /// The files cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), CliError> {
        self.with_dossier(|dossier| report::write(&dossier, folder))
            .map_err(|error| CliError::stopped(Exit::Failed, error.to_string(), ""))
    }

    fn with_dossier<T>(&self, of: impl FnOnce(Dossier<'_>) -> T) -> T {
        let Solved { run, comparison, answers } = &self.solved;
        let particulars = Particulars { answers: answers.clone(), ..Particulars::default() };
        self.session.with_dossier(run, comparison, particulars, of)
    }

    fn entry<'py>(&self, py: Python<'py>, key: &str) -> PyResult<Bound<'py, PyAny>> {
        beside::copied(&self.own_report(py)?.get_item(key)?)
    }

    /// The report, made once.
    fn own_report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let made = || {
            let text = py.detach(|| self.with_dossier(|dossier| serde_json::to_string(&dossier.report)));
            super::from_json(py, text).map(Bound::unbind)
        };
        Ok(self.report.get_or_try_init(py, made)?.bind(py).clone())
    }
}

#[pymethods]
impl Solution {
    /// The exact energy 𝓛(u) is no less: −Π(λ_h), less what rounding can have cost.
    #[getter]
    fn lower(&self) -> f64 {
        self.solved.run.certified.bracket.lower()
    }

    /// The exact energy is no more; inf where there is no upper bound.
    #[getter]
    fn upper(&self) -> f64 {
        self.solved.run.certified.bracket.free.as_ref().map_or(f64::INFINITY, |free| free.upper())
    }

    /// √(gap/𝒮): neither stress is further from the exact one, relative to it in the energy norm.
    #[getter]
    fn relative_error_bound(&self) -> f64 {
        self.solved.run.certified.bracket.relative_error(self.upper())
    }

    /// `agree`, or `disagree` where a tolerance that was asked for was not reached.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, "status")
    }

    /// One sentence.
    #[getter]
    fn verdict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.entry(py, "verdict")
    }

    /// Everything that `report.json` holds, as a dictionary; `hypercircle schema report` describes it.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        beside::copied(&self.own_report(py)?)
    }

    /// The quantities of the scene by name, each with the interval that holds its exact value.
    #[getter]
    fn quantities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Solved { run, comparison, answers } = &self.solved;
        let problem = &run.certified.problem;
        let guaranteed = !problem.notes.iter().any(|note| note.weakens_guarantee);
        let data = report::Data::of(run.coulomb.is_some(), !problem.scene.ranges.is_empty());
        let firmness = report::firmness(guaranteed, data);
        let out = PyDict::new(py);
        for summary in summaries(&run.certified, answers, comparison) {
            let name = summary.name.clone();
            out.set_item(name, Bound::new(py, Quantity::new(summary, firmness))?)?;
        }
        Ok(out)
    }

    /// The contacts of the scene by name (`first|second`), with their pressures.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let out = PyDict::new(py);
        for contact in &self.solved.comparison.contacts {
            out.set_item(&contact.name, Bound::new(py, ContactAnswer::new(contact.clone()))?)?;
        }
        Ok(out)
    }

    /// Vertices of the mesh, n × 2.
    #[getter]
    fn points<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let problem = &this.get().solved.run.certified.problem;
        if problem.scene.origin == [0.0; 2] {
            return arrays::rows(this, |solution| &solution.solved.run.certified.problem.mesh.points);
        }
        let written = problem.mesh.points.iter().map(|p| problem.scene.as_written(*p)).collect();
        Ok(arrays::made(this.py(), written)?.into_any())
    }

    /// Vertices of each triangle counter-clockwise, m × 3.
    #[getter]
    fn triangles<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        arrays::signed(&arrays::rows(this, |solution| &solution.solved.run.certified.problem.mesh.triangles)?)
    }

    /// Body of each triangle, m indices into `Scene.bodies`.
    #[getter]
    fn body<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        arrays::signed(arrays::numbers(this, |solution| &solution.solved.run.certified.problem.mesh.body)?.as_any())
    }

    /// Stresses (xx, yy, xy) at the nodes of all triangles, k × 3; `stress_start` says which belong to which. Of a body of revolution
    /// (rr, zz, rz, tt), k × 4; on the axis those close by.
    #[getter]
    fn stress<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let Certified { problem, dual, .. } = &this.get().solved.run.certified;
        let Some(revolved) = problem.section().revolved() else {
            return arrays::rows(this, |solution| solution.solved.run.certified.dual.stress.values());
        };
        let own = &dual.stress;
        let of_triangle = |t: usize| {
            let (corners, force) = (problem.mesh.corners(t), problem.body_force(t));
            (0..3).flat_map(move |sub| {
                lattice(own.degree(t)).map(move |l| in_plane_first(revolved.stress_at(own, t, sub, corners, force, l)))
            })
        };
        Ok(arrays::made(this.py(), (0..own.len()).flat_map(of_triangle).collect())?.into_any())
    }

    /// m + 1 numbers: the rows of `stress` from `stress_start[t]` to `stress_start[t + 1]` are those of triangle t. A triangle of
    /// degree p has three parts, between two of its corners and the centroid, with (p + 1)(p + 2)/2 nodes each.
    #[getter]
    fn stress_start<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        arrays::numbers(this, |solution| &solution.starts)
    }

    /// The places (x, y) of the rows of `stress`, k × 2.
    #[getter]
    fn stress_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let certified = &self.solved.run.certified;
        let (mesh, scene) = (&certified.problem.mesh, &certified.problem.scene);
        let of_triangle = |t: usize| {
            let corners = mesh.corners(t);
            let centroid = [0, 1].map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / 3.0);
            (0..3).flat_map(move |sub| {
                let own = [corners[(sub + 1) % 3], corners[(sub + 2) % 3], centroid];
                let at = move |l: [f64; 3]| [0, 1].map(|c| (0..3).map(|i| l[i] * own[i][c]).sum());
                lattice(certified.dual.stress.degree(t)).map(move |l| scene.as_written(at(l)))
            })
        };
        Ok(arrays::made(py, (0..mesh.triangles.len()).flat_map(of_triangle).collect())?.into_any())
    }

    /// Mean stress (xx, yy, xy) of each triangle, m × 3; of a body of revolution (rr, zz, rz, tt), m × 4, by volume.
    #[getter]
    fn mean_stress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Certified { problem, dual, .. } = &self.solved.run.certified;
        let stress = &dual.stress;
        let all = 0..stress.len();
        Ok(match problem.section().revolved() {
            None => arrays::made(py, all.map(|t| stress.mean(t)).collect())?.into_any(),
            Some(revolved) => {
                let of = |t: usize| revolved.mean(stress, t, problem.mesh.corners(t), problem.body_force(t));
                arrays::made(py, all.map(|t| in_plane_first(of(t))).collect())?.into_any()
            }
        })
    }

    /// Polynomial degree of the stress on each triangle, m numbers.
    #[getter]
    fn degrees(&self) -> Vec<usize> {
        let stress = &self.solved.run.certified.dual.stress;
        (0..stress.len()).map(|t| stress.degree(t)).collect()
    }

    /// The admissible displacement behind `upper` at the vertices, n × 2; `None` where there is no upper bound.
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let certified = &self.solved.run.certified;
        let Ok(free) = &certified.bracket.free else { return Ok(None) };
        let mut values = vec![[0.0; 2]; certified.problem.mesh.points.len()];
        for (t, corners) in certified.problem.mesh.triangles.iter().enumerate() {
            for (i, vertex) in corners.iter().enumerate() {
                values[*vertex] = free.displacement.corner(t, i);
            }
        }
        Ok(Some(arrays::made(py, values)?.into_any()))
    }

    /// −Π(λ_h) as computed.
    #[getter]
    fn energy(&self) -> f64 {
        self.solved.run.certified.bracket.complementary.lower()
    }

    /// 𝒮(λ_h), the complementary energy ½∫ a λ:λ.
    #[getter]
    fn complementary(&self) -> f64 {
        self.solved.run.certified.bracket.complementary.strain
    }

    /// Bernstein coefficients of the contact traction, by interface, pair of edges and coefficient.
    #[getter]
    fn contact_traction(&self) -> Vec<Vec<Vec<f64>>> {
        let traction = |t: &SideValues<f64>| t.iter().map(<[f64]>::to_vec).collect();
        self.solved.run.certified.dual.contact_traction.iter().map(traction).collect()
    }

    /// Which of these coefficients belong to closed contact, one after the other.
    #[getter]
    fn closed<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        arrays::numbers(this, |solution| solution.solved.run.certified.dual.closed.values())
    }

    /// Moments of the edge displacements that keep tractions continuous, by edge, coefficient and component.
    #[getter]
    fn moments(&self) -> Vec<Vec<[f64; 2]>> {
        self.solved.run.certified.dual.moments.iter().map(<[[f64; 2]]>::to_vec).collect()
    }

    /// Largest violation of equilibrium relative to the applied load.
    #[getter]
    fn equilibrium_residual(&self) -> f64 {
        self.solved.run.certified.dual.equilibrium.residual()
    }

    /// Number of unknowns.
    #[getter]
    fn unknowns(&self) -> usize {
        self.solved.run.certified.dual.unknowns
    }

    /// Steps of the contact iteration.
    #[getter]
    fn iterations(&self) -> usize {
        self.solved.run.certified.dual.iterations
    }

    /// Holds a displacement field on the mesh of this solution, or values of quantities, against its bounds: as
    /// `Scene.certify`, without solving again.
    ///
    /// Raises as `Scene.solve` does.
    #[pyo3(signature = (points = None, triangles = None, displacement = None, *, file = None, field = None, name = "displacement",
        solution = false, values = None, allow = None, tolerance = None, out = None))]
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
        out: Option<PathBuf>,
    ) -> PyResult<Certificate> {
        let arrays = [points, triangles, displacement];
        let claims = Claims { arrays, file, field, name, solution, values, allow, tolerance, out };
        let mut claimed = claims.made(Line::default())?;
        let own = SolveOptions { tolerance_of: Vec::new(), refine: 0, ..self.args.solve.clone() };
        claimed.args.solve = SolveOptions { tolerance: claimed.args.solve.tolerance, ..own };
        claimed.args.limits = self.args.limits.clone();
        certify(py, &self.session.scene, claimed, Some(&self.solved.run))
    }

    /// Numbers on triangles, m of each by name: von Mises stresses of the means, and what each triangle adds to the gap and to the
    /// intervals of the quantities.
    #[getter]
    fn maps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let maps = py.detach(|| self.with_dossier(|dossier| dossier.maps));
        let out = PyDict::new(py);
        for map in maps {
            out.set_item(map.key, PyArray1::from_vec(py, map.values))?;
        }
        Ok(out)
    }

    /// A list of the report as a dictionary of columns, as `pandas.DataFrame` takes it: `checks`, `remarks`, `quantities`, `contacts`,
    /// `history`. Parts of an entry have dots in their names.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        beside::table(&self.own_report(py)?, name)
    }

    /// The mesh as a `pyvista.UnstructuredGrid`: the cell data are `body`, the mean stress by component (`stress_xx`, …) and the numbers in
    /// `maps`, the point data, where there is an upper bound, its `displacement`.
    ///
    /// Raises `ImportError` without PyVista.
    fn to_pyvista<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        beside::grid(this.as_any())
    }

    /// Draws a number on each triangle with matplotlib, and returns the axes: `value` is `xx`, `yy` or `xy` of the mean stress (of a body of
    /// revolution `rr`, `zz`, `rz` or `tt`), a name in `maps`, or an array of m numbers; the von Mises stress where it is missing. `deformed` is the scale of the displacement. More keywords go to `Axes.tripcolor`.
    ///
    /// Raises `ImportError` without matplotlib.
    #[pyo3(signature = (value = None, *, ax = None, deformed = 0.0, colorbar = true, **options))]
    fn plot<'py>(
        this: &Bound<'py, Self>,
        value: Option<&Bound<'py, PyAny>>,
        ax: Option<&Bound<'py, PyAny>>,
        deformed: f64,
        colorbar: bool,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let usual = PyString::new(this.py(), "von_mises_dual").into_any();
        beside::plot(this.as_any(), value.unwrap_or(&usual), ax, deformed, colorbar, options)
    }

    /// Verdict and intervals, for a notebook.
    fn _repr_html_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        beside::page(&self.own_report(py)?)
    }

    fn __repr__(&self) -> String {
        let percent = 100.0 * self.relative_error_bound();
        let (name, lower, upper) = (&self.session.scene.name, self.lower(), self.upper());
        format!("<Solution of {name}: energy in [{lower:?}, {upper:?}], guaranteed error {percent:.3} %>")
    }
}

/// (rr, zz, rz, tt) of (rr, zz, tt, rz): the hoop stress behind those of the plane, as in a scene.
fn in_plane_first([rr, zz, tt, rz]: [f64; 4]) -> [f64; 4] {
    [rr, zz, rz, tt]
}
