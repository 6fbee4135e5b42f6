//! `hypercircle mesh`: what a mesh file holds, and a scene to start from.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::cli::given::options::{RunOptions, positive};
use crate::cli::words::say;
use crate::cli::{CliError, Exit};
use crate::mesh::inventory::{Inventory, starting_scene};
use crate::report::folder::{self, replace_file};
use crate::report::inventory::{page, text};
use crate::scene::Scene;

/// The page.
const PAGE: &str = "mesh.html";

/// Options of `mesh`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Each line, circle and group comes with the lines that name it in a scene. The scene of --scene is complete \
    but for materials, supports and loads, of which it has examples."
)]
pub struct Args {
    /// The mesh file: Gmsh (.msh) and Abaqus or CalculiX (.inp) natively, anything else through meshio
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write a scene to start from to SCENE, which must not exist yet
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// Give meshio at most S seconds to read the file
    #[arg(long, value_name = "S", default_value_t = 120.0, value_parser = positive)]
    pub reading_seconds: f64,
    /// Where the page goes.
    #[command(flatten)]
    pub run: RunOptions,
}

fn bad(message: impl Into<String>, remedy: &str) -> CliError {
    CliError::stopped(Exit::BadInput, message, remedy)
}

/// Reads the file, writes the page and the scene, and prints what was found.
///
/// # Errors
/// The file cannot be read or holds no plane cells, or a result cannot be written.
pub fn run(args: &Args) -> Result<Exit, CliError> {
    if args.scene.is_some() && args.file.to_str().is_none() {
        let message =
            format!("{}: the name of the file is not Unicode, and a scene cannot name it", args.file.display());
        return Err(bad(message, "rename the file"));
    }
    if let Some(scene) = args.scene.as_deref().filter(|scene| scene.symlink_metadata().is_ok()) {
        return Err(bad(
            format!("{} exists already", scene.display()),
            "choose another name: a scene is not overwritten",
        ));
    }
    let stem = args.file.file_stem().map_or_else(|| "mesh".into(), |name| name.to_string_lossy().into_owned());
    let dir = args.run.folder_named(&format!("mesh-{stem}"));
    folder::refuse(&dir, [PAGE]).map_err(|e| bad(e.to_string(), ""))?;
    if let Some(path) = &args.scene {
        folder::refuse_file(path).map_err(|e| CliError::unwritable(path, &e))?;
    }
    let limit = Duration::try_from_secs_f64(args.reading_seconds).unwrap_or(Duration::MAX);
    let inventory = Inventory::read(&args.file, limit).map_err(|e| bad(e.to_string(), ""))?;
    let target = args.scene.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}.toml")));
    let scene = starting_scene(&inventory, &relative(&args.file, &target), &stem);
    // What is written is what a scene has to be, whatever names the file has.
    Scene::parse(&scene, &target).map_err(|e| {
        bad(
            format!("no scene can be made of what {} holds: {e}", args.file.display()),
            "check its cells, or write the mesh again",
        )
    })?;
    folder::replace(&dir, &[(PAGE, page(&inventory, &scene).into_bytes())], &[])
        .map_err(|e| CliError::stopped(Exit::Failed, e.to_string(), ""))?;
    if let Some(path) = &args.scene {
        replace_file(path, scene.into_bytes()).map_err(|e| CliError::unwritable(path, &e))?;
    }
    if !args.run.quiet {
        text(&inventory).iter().for_each(|line| say::line(line));
        say::line("");
        say::line(&format!("page: {}", dir.join(PAGE).display()));
        match &args.scene {
            Some(path) => say::line(&format!("scene: {}", path.display())),
            None => say::line("`--scene FILE` writes a scene to start from."),
        }
    }
    Ok(Exit::Agree)
}

/// The path of `file` as a scene at `scene` writes it.
fn relative(file: &Path, scene: &Path) -> String {
    let folder = scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let whole = (file.canonicalize(), folder.canonicalize());
    let (Ok(file_path), Ok(folder)) = whole else { return file.display().to_string() };
    let (mut one, mut other) = (file_path.components().peekable(), folder.components().peekable());
    while one.peek().is_some() && one.peek() == other.peek() {
        one.next();
        other.next();
    }
    let path: PathBuf = other.map(|_| std::path::Component::ParentDir).chain(one).collect();
    path.display().to_string()
}
