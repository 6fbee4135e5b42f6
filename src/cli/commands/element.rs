//! `hypercircle element`: the workbench.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nalgebra::DMatrix;

use crate::cli::given::options::RunOptions;
use crate::cli::words::say;
use crate::cli::{CliError, Exit};
use crate::report::{ReportError, folder};
use crate::scene::Kinematics;
use crate::workbench::read::{self, Array};
use crate::workbench::{self, DisplacementElement, Material, Order, Report, SHIPPED, Shipped, Subject};

/// Relative accuracy of a matrix in single precision.
const SINGLE: f64 = 1e-5;

/// Options of `element`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Without NAME and --matrix: the elements that come with the program, and what each claims.\n\
    With --matrix: K.npz (numpy.savez, array K; nodes, young, poisson, thickness and kinematics may lie beside it), K.npy, \
    K.mtx (MatrixMarket), or a table of numbers. What one matrix cannot tell, other shapes and solved scenes, is not made and \
    never passes; the Python function `workbench` takes a formula and makes all of it.\n\n\
    Exit code 1: a property that the element claims is missing.")]
pub struct Args {
    /// An element that comes with the program
    #[arg(value_name = "NAME", conflicts_with = "matrix")]
    pub name: Option<String>,
    /// File with a stiffness matrix
    #[arg(long, value_name = "FILE")]
    pub matrix: Option<PathBuf>,
    /// File with the nodes, x and y on each row: .npy, .csv or .txt
    #[arg(long, value_name = "FILE", requires = "matrix")]
    pub nodes: Option<PathBuf>,
    /// How the unknowns of the matrix are numbered
    #[arg(
        long,
        value_enum,
        requires = "matrix",
        help = "How the unknowns of the matrix are numbered [default: interleaved]"
    )]
    pub order: Option<Order>,
    /// Plane state of the material, or a body of revolution about x = 0, with K of the full turn
    #[arg(long, value_enum, requires = "matrix")]
    pub kinematics: Option<Kinematics>,
    /// Young's modulus
    #[arg(long, value_name = "E", requires = "matrix")]
    pub young: Option<f64>,
    /// Poisson's ratio
    #[arg(long, value_name = "NU", requires = "matrix", allow_negative_numbers = true)]
    pub poisson: Option<f64>,
    /// Thickness [default: 1]
    #[arg(long, value_name = "T", requires = "matrix")]
    pub thickness: Option<f64>,
    /// How exact the entries are, relative to the largest [default: 1e-9; 1e-5 for single precision]
    #[arg(long, value_name = "X", value_parser = precision, requires = "matrix")]
    pub precision: Option<f64>,
    /// A property that the element does not claim; may be repeated
    #[arg(long, value_name = "PROPERTY", value_parser = property)]
    pub waive: Vec<String>,
    /// A property that the element claims beside the usual ones, for instance reference; may be repeated
    #[arg(long, value_name = "PROPERTY", value_parser = property)]
    pub claim: Vec<String>,
    /// Where results go.
    #[command(flatten)]
    pub run: RunOptions,
}

impl Args {
    /// Refuses what is said of a matrix for an element that comes with the program.
    fn refuse_of_matrix(&self, name: &str) -> Result<(), CliError> {
        let given = [
            ("--nodes", self.nodes.is_some()),
            ("--order", self.order.is_some()),
            ("--kinematics", self.kinematics.is_some()),
            ("--young", self.young.is_some()),
            ("--poisson", self.poisson.is_some()),
            ("--thickness", self.thickness.is_some()),
            ("--precision", self.precision.is_some()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => {
                let message = format!("{option} is about a matrix, and {name} comes with all that it needs");
                Err(bad(message, &format!("leave {option} out, or give your own matrix with --matrix")))
            }
            None => Ok(()),
        }
    }

    /// Refuses the claim of a property that was not looked at: it could not fail.
    fn refuse_unmade(&self, report: &Report) -> Result<(), CliError> {
        for name in &self.claim {
            if self.waive.contains(name) {
                return Err(bad(format!("{name} is claimed and waived"), "leave one of the two out"));
            }
            let why = match report.finding(name) {
                None => "it is a property of other elements".to_string(),
                Some(finding) if finding.passed.is_none() => finding.sentence.clone(),
                Some(_) => continue,
            };
            let remedy = format!("leave --claim {name} out, or give what it takes to look at it");
            return Err(bad(format!("{} cannot be held to {name}: {why}", report.element), &remedy));
        }
        Ok(())
    }
}

fn property(name: &str) -> Result<String, String> {
    let text = || "no property has this name; report.json lists them".to_string();
    workbench::is_property(name).then(|| name.to_string()).ok_or_else(text)
}

fn precision(text: &str) -> Result<f64, String> {
    let number = text.parse().map_err(|_| format!("'{text}' is no number"))?;
    workbench::precision(number)
}

fn bad(message: impl Into<String>, remedy: &str) -> CliError {
    CliError::stopped(Exit::BadInput, message, remedy)
}

/// Examines an element, or lists those that there are.
///
/// # Errors
/// There is no such element, the input is refused, or results cannot be written.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    let mut options = workbench::Options { waived: args.waive.clone(), claimed: args.claim.clone() };
    let (subject, name) = match (&args.matrix, &args.name) {
        (Some(file), _) => (Subject::Displacement(Box::new(matrix(args, file)?)), stem(file)),
        (None, Some(name)) => {
            args.refuse_of_matrix(name)?;
            let Shipped { name, lacks, adds, .. } = *known(name)?;
            options.waived.extend(lacks.iter().map(|name| name.to_string()));
            options.claimed.extend(adds.iter().map(|name| name.to_string()));
            (known(name)?.subject().map_err(|e| CliError::stopped(Exit::Failed, e, ""))?, name.to_string())
        }
        (None, None) => {
            if let Some(property) = args.claim.iter().chain(&args.waive).next() {
                return Err(bad(format!("of what element {property} is said, is missing"), "give NAME or --matrix"));
            }
            list();
            return Ok(Exit::Agree);
        }
    };
    let dir = args.run.folder_named(&format!("element-{name}"));
    folder::refuse(&dir, workbench::NAMES).map_err(|e| bad(e.to_string(), ""))?;
    let report = subject.examine(&options);
    args.refuse_unmade(&report)?;
    report.write(&dir).map_err(|e: ReportError| CliError::stopped(Exit::Failed, e.to_string(), ""))?;
    if !args.run.quiet {
        told(&report).iter().for_each(|line| say::line(line));
        if let Some(diagnosis) = &report.diagnosis {
            say::line(&format!("diagnosis: {}", diagnosis.sentence));
        }
        if let Some(hint) = &report.hint {
            say::line(&format!("hint: {hint}"));
        }
        if let Some(untold) = &report.untold {
            say::line(&format!("one shape: {untold}"));
        }
        say::line(&report.verdict);
        say::line(&format!("report: {}", dir.join("report.html").display()));
    }
    Ok(if report.passed { Exit::Agree } else { Exit::Disagree })
}

/// Lists the findings, a line each; then the checks that were not made, a line for each reason.
fn told(report: &Report) -> Vec<String> {
    let made = report.findings.iter().filter(|f| f.passed.is_some());
    let mut lines: Vec<String> = made.map(|f| f.in_words()).collect();
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for finding in report.findings.iter().filter(|f| f.passed.is_none()) {
        match reasons.iter_mut().find(|(reason, _)| *reason == finding.sentence) {
            Some((_, names)) => names.push(&finding.name),
            None => reasons.push((&finding.sentence, vec![&finding.name])),
        }
    }
    lines.extend(reasons.into_iter().map(|(reason, names)| format!("– not made: {}: {reason}", names.join(", "))));
    lines
}

fn stem(file: &Path) -> String {
    file.file_stem().map_or_else(|| "matrix".into(), |name| name.to_string_lossy().into_owned())
}

fn known(name: &str) -> Result<&'static Shipped, CliError> {
    let names: Vec<&str> = SHIPPED.iter().map(|s| s.name).collect();
    let remedy = format!("choose from {}, or give a matrix with --matrix", names.join(", "));
    workbench::shipped(name).ok_or_else(|| bad(format!("there is no element '{name}'"), &remedy))
}

fn list() {
    for element in SHIPPED {
        say::line(&format!("{:16} {}", element.name, element.about));
        say::line(&format!("{:16} claims {}", "", element.claims().join(", ")));
    }
    say::line("`hypercircle element NAME` examines one of them, `hypercircle element --matrix K.npz` one of your own.");
}

/// The element of the files.
fn matrix(args: &Args, file: &Path) -> Result<DisplacementElement, CliError> {
    let refused = |e: read::ReadError| bad(format!("{}: {}", e.file.display(), e.what), &e.remedy);
    let about = |text: String| bad(format!("{}: {text}", file.display()), "check the file, and what is said of it");
    let arrays = read::arrays(file).map_err(refused)?;
    let Some(Array::Numbers(k, single)) = arrays.get("K") else {
        let names: Vec<&str> = arrays.keys().map(String::as_str).collect();
        return Err(bad(
            format!("{}: there is no array of numbers K in it, but {}", file.display(), names.join(", ")),
            "write it with numpy.savez(file, K=…, nodes=…)",
        ));
    };
    let nodes = match &args.nodes {
        Some(file) => {
            let arrays = read::arrays(file).map_err(refused)?;
            numbers(&arrays, "nodes").or(numbers(&arrays, "K")).cloned()
        }
        None => numbers(&arrays, "nodes").cloned(),
    };
    let nodes = nodes.ok_or_else(|| {
        bad("the nodes are not known", "give a file with x and y of a node on each row: --nodes FILE")
    })?;
    let nodes = read::points(&nodes).map_err(about)?;
    let material = material(args, &arrays).map_err(about)?;
    let element = DisplacementElement::of_matrix(&stem(file), k, nodes, args.order.unwrap_or_default(), material)
        .map_err(about)?;
    let usual = if *single { SINGLE } else { element.precision };
    Ok(element.with_precision(args.precision.unwrap_or(usual)))
}

fn numbers<'a>(arrays: &'a BTreeMap<String, Array>, name: &str) -> Option<&'a DMatrix<f64>> {
    arrays.get(name).and_then(Array::numbers)
}

/// The material of the options, or of the file; none where neither says E and ν.
fn material(args: &Args, arrays: &BTreeMap<String, Array>) -> Result<Option<Material>, String> {
    let of_file = |name: &str| arrays.get(name).and_then(Array::number);
    let (young, poisson) = (args.young.or(of_file("young")), args.poisson.or(of_file("poisson")));
    let thickness = args.thickness.or(of_file("thickness")).unwrap_or(1.0);
    let kinematics = match (args.kinematics, arrays.get("kinematics")) {
        (None, Some(Array::Text(text))) => Some(
            Kinematics::named(text)
                .ok_or_else(|| format!("kinematics is '{text}'; it is plane-strain, plane-stress or axisymmetric"))?,
        ),
        (given, _) => given,
    };
    let (young, poisson) = match (young, poisson) {
        (Some(young), Some(poisson)) => (young, poisson),
        (None, None) if kinematics == Some(Kinematics::Axisymmetric) => {
            return Err(
                "a matrix of a body of revolution is held against its material; say --young and --poisson".into()
            );
        }
        (None, None) => return Ok(None),
        (Some(_), None) => return Err("E is given without ν; say both, or neither".into()),
        (None, Some(_)) => return Err("ν is given without E; say both, or neither".into()),
    };
    let kinematics = kinematics.ok_or(
        "E and ν are given without the plane state; say --kinematics plane-strain, plane-stress or axisymmetric",
    )?;
    Material::new(kinematics, young, poisson, thickness).map(Some)
}
