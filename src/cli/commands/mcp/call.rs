//! One call of a tool, answered in this process.

use std::path::{Path, PathBuf};

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::answer::Answer;
use super::arguments::{Certify, Diagnose, Element, Numbering, PlaneState, Solve, Verify};
use super::inside;
use crate::cli::commands::certify::{judged, read, stress_side};
use crate::cli::commands::{certify, solve, verify};
use crate::cli::conclude::Particulars;
use crate::cli::given::field::FieldFrom;
use crate::cli::given::options::{Limits, MOST_REFINEMENTS, NamedTolerance, SolveOptions, as_tolerance};
use crate::cli::given::threads;
use crate::cli::session::{Session, refuse_unknown};
use crate::cli::{CliError, Exit, options_of};
use crate::element::MAX_DEGREE;
use crate::primal::HIGHEST_DEGREE;
use crate::scene::{Kinematics, Scene};
use crate::study::{FieldArrays, ForeignField, GivenValue};
use crate::workbench::{self, DisplacementElement, Material, Options, Order, SHIPPED, Subject};

/// Part of the time of a call after which no finer mesh is begun: what is there then has to be told.
const REFINING: f64 = 0.6;

/// A call, as the server hands it to the process that answers it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Call {
    /// Name of the tool.
    pub tool: String,
    /// Its arguments.
    pub arguments: Value,
    /// Seconds that it may take.
    pub seconds: f64,
    /// Threads that it may use.
    pub threads: u32,
    /// Bytes that it may take; four fifths of what is available where it is missing.
    pub memory: Option<u64>,
}

impl Call {
    /// The answer; meshes and fields are read from the current folder alone.
    pub fn answer(&self) -> Answer {
        let answer = match self.tool.as_str() {
            "solve" => self.taken().and_then(|asked| self.solved(asked)),
            "verify" => self.taken().and_then(|asked| self.verified(asked)),
            "certify" => self.taken().and_then(|asked| self.certified(asked)),
            "diagnose" => self.taken::<Diagnose>().and_then(|asked| self.certified(asked.into())),
            "element" => self.taken().and_then(examined),
            other => Err(bad(format!("there is no tool '{other}'"), "")),
        };
        answer.unwrap_or_else(|error| Answer::refused(&error))
    }

    fn taken<T: for<'de> Deserialize<'de>>(&self) -> Result<T, CliError> {
        T::deserialize(&self.arguments).map_err(|error| bad(format!("the arguments of {}: {error}", self.tool), ""))
    }

    fn solved(&self, asked: Solve) -> Result<Answer, CliError> {
        let Solve { scene, degree, refine, tolerance, tolerance_of, max_triangles, max_seconds } = asked;
        let mut args: solve::Args = defaults(&[])?;
        self.stresses(&mut args.solve, degree, refine)?;
        args.solve.tolerance = tolerance.map(|value| tolerable("tolerance", value)).transpose()?;
        let named = |(name, value): (String, f64)| {
            let value = tolerable(&format!("tolerance_of {name}"), value)?;
            Ok(NamedTolerance { name, value })
        };
        args.solve.tolerance_of = tolerance_of.into_iter().map(named).collect::<Result<_, CliError>>()?;
        args.limits = self.limits(max_triangles, max_seconds)?;
        let session = self.session("solve", opened(&scene)?, &args.solve)?;
        let solve::Solved { run, comparison, answers } = solve::solved(&args, &session, None)?;
        let particulars = Particulars { answers, ..Particulars::default() };
        Ok(session.with_dossier(&run, &comparison, particulars, |dossier| Answer::of_report(&dossier.report)))
    }

    fn verified(&self, asked: Verify) -> Result<Answer, CliError> {
        let Verify { scene, degree, refine, primal_degree } = asked;
        let mut args: verify::Args = defaults(&[])?;
        self.stresses(&mut args.solve, degree, refine)?;
        args.limits = self.limits(None, None)?;
        if !primal_degree.is_empty() {
            let is_known = |degree: &u8| (1..=HIGHEST_DEGREE).contains(degree);
            if let Some(degree) = primal_degree.iter().find(|degree| !is_known(degree)) {
                return Err(bad(
                    format!("primal_degree has {degree}"),
                    &format!("use degrees from 1 to {HIGHEST_DEGREE}"),
                ));
            }
            args.primal_degree = primal_degree;
        }
        let session = self.session("verify", opened(&scene)?, &args.solve)?;
        let verify::Verified { run, comparison, particulars, failure } = verify::verified(&args, &session, None)?;
        match failure {
            Some(error) => Err(verify::unanswered(&error)),
            None => {
                Ok(session.with_dossier(&run, &comparison, particulars, |dossier| Answer::of_report(&dossier.report)))
            }
        }
    }

    fn certified(&self, asked: Certify) -> Result<Answer, CliError> {
        let Certify { scene, file, field, points, triangles, displacement, solution, values, tolerance } = asked;
        let arrays = match (points, triangles, displacement) {
            (Some(points), Some(triangles), Some(displacement)) => {
                Some(FieldArrays { points, triangles, displacement, single: false })
            }
            (None, None, None) => None,
            _ => return Err(bad("a field is points, triangles and displacement", "give all three")),
        };
        if arrays.is_some() && file.is_some() || arrays.is_none() && file.is_none() && values.is_empty() {
            let remedy = "give a file, or points, triangles and displacement, or (to certify) values";
            return Err(bad("one thing has to be certified", remedy));
        }
        FieldFrom::of(file.is_some(), arrays.is_some()).refuse_unheard(field.is_some(), solution)?;
        // An option in the place of what is set below.
        let mut args: certify::Args = defaults(&["--displacement=displacement"])?;
        self.stresses(&mut args.solve, None, None)?;
        args.displacement = file.map(PathBuf::from).into_iter().collect();
        (args.field, args.solution) = (field, solution);
        args.values.value = values.into_iter().map(|(name, value)| GivenValue::new(name, value)).collect();
        args.solve.tolerance = tolerance.map(|value| tolerable("tolerance", value)).transpose()?;
        args.limits = self.limits(None, None)?;
        let mut session = self.session("certify", opened(&scene)?, &args.solve)?;
        let given = args.values.all(&mut session.scene)?;
        refuse_unknown(&session.scene, given.iter().map(|value| value.name.as_str()))?;
        args.displacement.iter().try_for_each(|file| inside::field(file))?;
        let field = match arrays {
            Some(arrays) => {
                let field = ForeignField::of_arrays("displacement", arrays);
                Some(field.map_err(|error| bad(error.what, &error.remedy))?)
            }
            None if args.displacement.is_empty() => None,
            None => Some(read(&args, &session)?),
        };
        let run = session.solve(&stress_side(&args, field.is_some()), &args.limits, None)?;
        let (comparison, particulars) = judged(&args, &session, &run, field.as_ref(), &given, 0.0)?;
        Ok(session.with_dossier(&run, &comparison, particulars, |dossier| Answer::of_report(&dossier.report)))
    }

    /// How the stress side is solved, within what the server allows.
    fn stresses(&self, options: &mut SolveOptions, degree: Option<u32>, refine: Option<u32>) -> Result<(), CliError> {
        if let Some(degree) = degree.filter(|degree| !(1..=MAX_DEGREE as u32).contains(degree)) {
            return Err(bad(format!("degree is {degree}"), &format!("use one from 1 to {MAX_DEGREE}")));
        }
        if let Some(refine) = refine.filter(|refine| *refine > MOST_REFINEMENTS) {
            return Err(bad(format!("refine is {refine}"), &format!("use at most {MOST_REFINEMENTS}")));
        }
        (options.degree, options.refine) = (degree, refine.unwrap_or(0));
        options.memory.max_memory = self.memory;
        Ok(())
    }

    fn limits(&self, max_triangles: Option<usize>, max_seconds: Option<f64>) -> Result<Limits, CliError> {
        if max_triangles == Some(0) || max_seconds.is_some_and(|seconds| seconds <= 0.0) {
            return Err(bad("max_triangles and max_seconds are above zero", "leave them out, or give larger ones"));
        }
        let most = REFINING * self.seconds;
        Ok(Limits { max_triangles, max_seconds: Some(max_seconds.map_or(most, |seconds| seconds.min(most))) })
    }

    fn session(&self, command: &'static str, scene: Scene, solve: &SolveOptions) -> Result<Session, CliError> {
        Session::new(command, scene, threads::start(self.threads), solve, true)
    }
}

fn bad(message: impl Into<String>, remedy: &str) -> CliError {
    CliError::stopped(Exit::BadInput, message, remedy)
}

fn tolerable(name: &str, value: f64) -> Result<f64, CliError> {
    as_tolerance(value).map_err(|error| bad(format!("{name}: {error}"), ""))
}

/// The options of a command as they are where nobody says otherwise.
fn defaults<A: clap::Args>(needed: &[&str]) -> Result<A, CliError> {
    let words = needed.iter().chain(&["--quiet", "--", "scene.toml"]);
    options_of(words.map(Into::into)).map_err(|error| CliError::stopped(Exit::Failed, error.to_string(), ""))
}

/// The scene in `text`, whose mesh files lie in the current folder.
fn opened(text: &str) -> Result<Scene, CliError> {
    let scene = Scene::parse(text, Path::new("scene.toml"))?;
    inside::meshes(&scene)?;
    Ok(scene)
}

fn examined(asked: Element) -> Result<Answer, CliError> {
    let refused = |what: String| bad(what, "");
    match (&asked.name, &asked.matrix) {
        (Some(_), Some(_)) => Err(bad("an element is a name or a matrix", "leave one of them out")),
        (name, None) if asked.is_of_matrix() => {
            let remedy =
                "leave nodes, order, young, poisson, thickness, kinematics and precision out, or give a matrix";
            Err(bad(
                match name {
                    Some(name) => format!("{name} comes with its nodes and its material"),
                    None => "nodes and a material belong to a matrix, and there is none".to_string(),
                },
                remedy,
            ))
        }
        (None, None) => Ok(Answer::list()),
        (Some(name), None) => {
            let remedy = || format!("choose from {}", SHIPPED.iter().map(|s| s.name).collect::<Vec<_>>().join(", "));
            let known =
                workbench::shipped(name).ok_or_else(|| bad(format!("there is no element '{name}'"), &remedy()))?;
            let subject = known.subject().map_err(|e| CliError::stopped(Exit::Failed, e, ""))?;
            let names = |list: &[&str]| list.iter().map(|name| name.to_string()).collect();
            let options = Options { waived: names(known.lacks), claimed: names(known.adds) };
            Ok(Answer::of_element(&subject.examine(&options)))
        }
        (None, Some(rows)) => {
            let element = element_of(&asked, rows).map_err(refused)?;
            Ok(Answer::of_element(&Subject::Displacement(Box::new(element)).examine(&Options::default())))
        }
    }
}

/// The element with the matrix of these rows.
fn element_of(asked: &Element, rows: &[Vec<f64>]) -> Result<DisplacementElement, String> {
    let nodes = asked.nodes.clone().ok_or("a matrix has nodes; give x and y of each")?;
    let columns = rows.first().map_or(0, Vec::len);
    if let Some(i) = rows.iter().position(|row| row.len() != columns) {
        return Err(format!("row {i} has {} numbers and row 0 has {columns}", rows[i].len()));
    }
    let matrix = DMatrix::from_row_slice(rows.len(), columns, &rows.concat());
    let order = match asked.order {
        None | Some(Numbering::Interleaved) => Order::Interleaved,
        Some(Numbering::Blocked) => Order::Blocked,
    };
    let state = asked.kinematics.map(|state| match state {
        PlaneState::PlaneStrain => Kinematics::PlaneStrain,
        PlaneState::PlaneStress => Kinematics::PlaneStress,
    });
    let material = match (asked.young, asked.poisson, state) {
        (Some(young), Some(poisson), Some(state)) => {
            Some(Material::new(state, young, poisson, asked.thickness.unwrap_or(1.0))?)
        }
        (None, None, None) if asked.thickness.is_none() => None,
        _ => {
            return Err(
                "a material is young, poisson and kinematics, with a thickness where it is not 1; give all three, \
                        or none of the four"
                    .into(),
            );
        }
    };
    let element = DisplacementElement::of_matrix("matrix", &matrix, nodes, order, material)?;
    let usual = element.precision;
    let precision = asked.precision.map(workbench::precision).transpose()?;
    Ok(element.with_precision(precision.unwrap_or(usual)))
}
