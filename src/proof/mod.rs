//! Data for verifying a bracket without this program: `proof.npz`, described in `docs/proof.md`.
//!
//! The file holds the scene as written, the meshes, and two fields in the numbers of this machine: the tractions of λ_h on every
//! edge, and the displacement v. Neither is exactly admissible, and nothing here claims it. The checker (`checker/`), which shares
//! nothing with this crate, finds the nearby fields that are so exactly, encloses their energies, and compares them with the claim.

mod arrays;
mod known;
mod npz;

use serde::Serialize;
use sha2::{Digest, Sha256};

pub use self::known::unknown;
use self::npz::Archive;
use crate::dual::DualSolution;
use crate::element::Displacement;
use crate::problem::Problem;

/// Name of the file.
pub const NAME: &str = "proof.npz";

/// How the file begins, whatever is in it: signature, version and method of its first member.
pub const BEGINS: &[u8] = b"PK\x03\x04\x14\x00\x00\x00\x08\x00\x00\x00\x21\x00";

/// Version of the format.
const FORMAT: u32 = 1;

/// Two fields and the bracket that follows from them.
#[derive(Debug, Clone, Copy)]
pub struct Fields<'a> {
    /// The problem of the stresses, and λ_h.
    pub stress: (&'a Problem, &'a DualSolution),
    /// The problem of the displacement, and v.
    pub displacement: (&'a Problem, &'a Displacement),
    /// The lower and the upper bound of the report.
    pub claim: [f64; 2],
    /// Where the upper one comes from.
    pub upper_from: &'a str,
    /// The adjoint fields that intervals of quantities follow from.
    pub adjoints: &'a [Adjoint<'a>],
}

/// The fields of a problem with a unit load along a quantity, on the same mesh.
#[derive(Debug, Clone, Copy)]
pub struct Adjoint<'a> {
    /// Name of the quantity.
    pub name: &'a str,
    /// Its interval in the report.
    pub claim: [f64; 2],
    /// The multiple of the load at which energies are compared.
    pub step: f64,
    /// Its problem and fields.
    pub problem: &'a Problem,
    /// Its stress.
    pub dual: &'a DualSolution,
    /// Its displacement.
    pub displacement: &'a Displacement,
}

/// Why there is no proof.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    /// The scene file cannot be read again.
    #[error("{path}, which is to be part of the proof, cannot be read again: {reason}")]
    Scene {
        /// The file.
        path: String,
        /// Why.
        reason: String,
    },
    /// The scene file is another one than when the run began.
    #[error("{path} was changed while it was solved; a proof is for the scene as it was: run it again")]
    Changed {
        /// The file.
        path: String,
    },
}

/// Origin and claims of the arrays.
#[derive(Serialize)]
struct Manifest<'a> {
    format: u32,
    program: String,
    scene: &'a str,
    /// SHA-256 of the scene file.
    scene_sha256: String,
    /// The point from which coordinates count, in those of the scene file.
    origin: [f64; 2],
    bodies: Vec<&'a str>,
    contacts: Vec<String>,
    claim: Claim<'a>,
    quantities: Vec<QuantityClaim<'a>>,
    /// Remarks on the data, where this program represents them by others.
    notes: Vec<&'a str>,
    mesh_files: Vec<MeshFile>,
}

#[derive(Serialize)]
struct Claim<'a> {
    lower: f64,
    upper: f64,
    upper_from: &'a str,
}

#[derive(Serialize)]
struct QuantityClaim<'a> {
    name: &'a str,
    lower: f64,
    upper: f64,
    step: f64,
}

#[derive(Serialize)]
struct MeshFile {
    name: String,
    sha256: String,
}

/// The proof of a bracket, as the bytes of `proof.npz`.
///
/// # Errors
/// [`ProofError`].
pub fn proof<'a>(fields: &Fields<'a>) -> Result<Vec<u8>, ProofError> {
    let (problem, dual) = fields.stress;
    let scene = &problem.scene;
    let path = scene.path.display().to_string();
    let text =
        std::fs::read(&scene.path).map_err(|e| ProofError::Scene { path: path.clone(), reason: e.to_string() })?;
    let again = std::str::from_utf8(&text).ok().and_then(|text| crate::scene::Scene::parse(text, &scene.path).ok());
    let same = |again: crate::scene::Scene| {
        let again = if scene.origin == [0.0; 2] { again } else { again.counted_from(scene.origin) };
        let conditions = again.supports == scene.supports && again.tractions == scene.tractions;
        conditions && again.bodies == scene.bodies && again.contacts == scene.contacts
    };
    if !again.is_some_and(same) {
        return Err(ProofError::Changed { path });
    }
    let claim =
        |&Adjoint { name, claim: [lower, upper], step, .. }: &Adjoint<'a>| QuantityClaim { name, lower, upper, step };
    let manifest = Manifest {
        format: FORMAT,
        program: format!("hypercircle {}", env!("CARGO_PKG_VERSION")),
        scene: &scene.name,
        scene_sha256: hex(&text),
        origin: scene.origin,
        bodies: scene.bodies.iter().map(|body| body.name.as_str()).collect(),
        contacts: problem.interfaces.iter().map(|interface| interface.name.clone()).collect(),
        claim: Claim { lower: fields.claim[0], upper: fields.claim[1], upper_from: fields.upper_from },
        quantities: fields.adjoints.iter().map(claim).collect(),
        notes: problem.notes.iter().filter(|note| note.weakens_guarantee).map(|note| note.text.as_str()).collect(),
        mesh_files: mesh_files(problem),
    };
    let mut archive = Archive::default();
    let manifest = serde_json::to_vec(&manifest).unwrap_or_default();
    archive.array("manifest", &manifest, 0);
    archive.array("scene", &text, 0);
    arrays::mesh(&mut archive, "stress", problem);
    arrays::stress(&mut archive, "", problem, dual);
    let (problem, v) = fields.displacement;
    arrays::mesh(&mut archive, "displacement", problem);
    arrays::displacement(&mut archive, "", problem, v);
    for (i, adjoint) in fields.adjoints.iter().enumerate() {
        let of = format!("quantity{i}_");
        arrays::stress(&mut archive, &of, adjoint.problem, adjoint.dual);
        arrays::displacement(&mut archive, &of, adjoint.problem, adjoint.displacement);
    }
    Ok(archive.finish())
}

/// The mesh files of the scene, those that can still be read.
fn mesh_files(problem: &Problem) -> Vec<MeshFile> {
    use crate::scene::MeshSource;
    let paths = match &problem.scene.mesh {
        MeshSource::File(path) => vec![path.as_path()],
        MeshSource::Parts(parts) => parts.iter().map(|part| part.file.as_path()).collect(),
        MeshSource::Geometry { .. } => Vec::new(),
    };
    let file = |path: &std::path::Path| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        Some(MeshFile { name, sha256: hex(&std::fs::read(path).ok()?) })
    };
    paths.into_iter().filter_map(file).collect()
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
