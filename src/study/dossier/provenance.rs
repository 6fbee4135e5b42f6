//! Provenance of the numbers: versions, hashes and threads.

use std::collections::BTreeMap;
use std::hash::{BuildHasher, Hasher};

use sha2::{Digest, Sha256};

use crate::problem::Problem;
use crate::report::Provenance;

const LOCK: &str = include_str!("../../../Cargo.lock");
/// Libraries whose version can change a number.
const NUMERICAL: [&str; 5] = ["clarabel", "faer", "nalgebra", "private-gemm-x86", "spade"];

/// Versions, hashes and threads of a run on `problem`.
pub fn provenance(problem: &Problem, threads: usize) -> Provenance {
    let mut components = BTreeMap::new();
    for name in NUMERICAL {
        if let Some(version) = locked_version(name) {
            components.insert(name.to_string(), version);
        }
    }
    let scene = std::fs::read(&problem.scene.path).map(|bytes| hash(&bytes)).unwrap_or_default();
    Provenance {
        version: env!("CARGO_PKG_VERSION").to_string(),
        components,
        scene_sha256: scene,
        mesh_sha256: mesh_hash(problem),
        lock_sha256: hash(LOCK.as_bytes()),
        threads,
        command_line: String::new(),
        date: crate::study::accepted::date::today(),
        seconds: BTreeMap::new(),
    }
}

/// The version that the lock file pins for a package.
pub fn locked_version(name: &str) -> Option<String> {
    let start = LOCK.find(&format!("name = \"{name}\"\n"))?;
    let rest = &LOCK[start..];
    let version = rest.split_once("version = \"")?.1;
    version.split_once('"').map(|(v, _)| v.to_string())
}

/// Hash of points, triangles and bodies, as solved.
fn mesh_hash(problem: &Problem) -> String {
    let mut hasher = Sha256::new();
    for p in problem.mesh.points.as_flattened() {
        hasher.update(p.to_le_bytes());
    }
    for (t, body) in problem.mesh.triangles.iter().zip(&problem.mesh.body) {
        for v in t {
            hasher.update((*v as u64).to_le_bytes());
        }
        hasher.update((*body as u64).to_le_bytes());
    }
    hex(&hasher.finalize())
}

/// Sixteen hexadecimal digits that no other run has.
pub fn identifier() -> String {
    let mut hasher = Sha256::new();
    hasher.update(std::process::id().to_le_bytes());
    // Keys that the system draws for each process, and that differ from call to call.
    hasher.update(std::hash::RandomState::new().build_hasher().finish().to_le_bytes());
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    hasher.update(now.as_nanos().to_le_bytes());
    hex(&hasher.finalize()[..8])
}

/// SHA-256 of `bytes`, in hexadecimal digits.
pub fn hash(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// `bytes` in hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_runs_have_the_same_identifier() {
        let drawn: std::collections::HashSet<String> = (0..1000).map(|_| identifier()).collect();
        assert!(drawn.len() == 1000 && drawn.iter().all(|id| id.len() == 16));
    }

    #[test]
    fn the_lock_file_names_the_numerical_libraries() {
        for name in NUMERICAL {
            assert!(locked_version(name).is_some_and(|v| v.contains('.')), "{name}");
        }
    }
}
