//! Every format but Gmsh's, through meshio, in a Python process of its own.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde::Deserialize;

use super::gmsh::content::{Content, Element, Kind};
use super::{MeshError, RawMesh};
use crate::scene::Note;

const SCRIPT: &str = include_str!("foreign.py");
/// Exit code of the script when the interpreter has no meshio.
const NO_MESHIO: i32 = 44;
const PATIENCE: Duration = Duration::from_secs(120);

#[derive(Deserialize)]
struct Converted {
    points: Vec<Vec<f64>>,
    blocks: Vec<Block>,
}

#[derive(Deserialize)]
struct Block {
    shape: String,
    nodes: Vec<Vec<u64>>,
    groups: Vec<Vec<String>>,
}

/// Reads `file` with the first interpreter that has meshio: `HYPERCIRCLE_PYTHON`, `python3`, `/usr/bin/python3`.
///
/// # Errors
/// [`MeshError::File`] when there is none, or when meshio cannot read the file or takes too long.
pub fn read(file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let folder = tempfile::tempdir()
        .map_err(|e| MeshError::file(file, format!("no temporary folder: {e}"), "set TMPDIR to a folder with space"))?;
    let target = folder.path().join("mesh.json");
    let chosen = std::env::var("HYPERCIRCLE_PYTHON").ok();
    for python in chosen.iter().map(String::as_str).chain(["python3", "/usr/bin/python3"]) {
        let mut command = Command::new(python);
        command.args(["-c", SCRIPT]).arg(file).arg(&target);
        let Ok(child) = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn() else {
            continue;
        };
        match finish(child, PATIENCE) {
            Finished::Code(Some(0), _) => return convert(file, &target),
            Finished::Code(Some(NO_MESHIO), _) => {}
            Finished::Code(_, log) => {
                let end: Vec<&str> = log.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
                let what = format!("meshio cannot read it: {}", end.last().unwrap_or(&"no message"));
                return Err(MeshError::file(file, what, "check the file, or convert it to Gmsh's format (.msh)"));
            }
            Finished::TimeOut => {
                let what = format!("meshio did not finish in {} s", PATIENCE.as_secs());
                return Err(MeshError::file(file, what, "convert it to Gmsh's format (.msh)"));
            }
        }
    }
    Err(MeshError::file(
        file,
        "this format is read through meshio, and no Python interpreter here has it",
        "install it (pip install meshio, or apt-get install python3-meshio), set HYPERCIRCLE_PYTHON to an interpreter \
         that has it, or convert the file to Gmsh's format (.msh)",
    ))
}

enum Finished {
    Code(Option<i32>, String),
    TimeOut,
}

/// Waits for the process, at most for `patience`; what it writes to its error stream is read meanwhile.
fn finish(mut child: Child, patience: Duration) -> Finished {
    let stream = child.stderr.take();
    let reader = std::thread::spawn(move || {
        let mut log = Vec::new();
        // What cannot be read is missing from a message, no more.
        let _ = stream.map(|mut s| s.read_to_end(&mut log));
        String::from_utf8_lossy(&log).into_owned()
    });
    let start = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Finished::Code(status.code(), reader.join().unwrap_or_default()),
            Ok(None) if start.elapsed() < patience => std::thread::sleep(Duration::from_millis(10)),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return Finished::TimeOut;
            }
        }
    }
}

/// The script's output as a mesh.
fn convert(file: &Path, target: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let fault = |what: String| MeshError::file(file, what, "convert it to Gmsh's format (.msh)");
    let text = std::fs::read(target).map_err(|e| fault(format!("meshio's result cannot be read: {e}")))?;
    let found: Converted =
        serde_json::from_slice(&text).map_err(|e| fault(format!("meshio gave numbers that are not finite ({e})")))?;
    let mut content = Content::default();
    for (tag, p) in (0..).zip(&found.points) {
        let coordinate = |k: usize| p.get(k).copied().unwrap_or(0.0);
        content.nodes.insert(tag, [coordinate(0), coordinate(1), coordinate(2)]);
    }
    // Group names become physical tags, as if a Gmsh file had been read.
    let mut names: Vec<String> = found.blocks.iter().flat_map(|b| b.groups.iter().flatten().cloned()).collect();
    names.sort_unstable();
    names.dedup();
    for (tag, name) in (1..).zip(&names) {
        content.names.extend([((1, tag), name.clone()), ((2, tag), name.clone())]);
    }
    let tag_of = |name: &String| names.binary_search(name).map_or(0, |i| i as i32 + 1);
    let mut tag = 0;
    for block in found.blocks {
        let kind = match block.shape.as_str() {
            "line" => Kind::Line,
            "triangle" => Kind::Triangle,
            other => {
                let what = format!("it has cells of the kind '{other}'");
                return Err(MeshError::file(file, what, "mesh the plane surfaces with straight triangles"));
            }
        };
        for (nodes, groups) in block.nodes.into_iter().zip(block.groups) {
            tag += 1;
            content.elements.push(Element { kind, tag, nodes, physical: groups.iter().map(tag_of).collect() });
        }
    }
    content.into_raw(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_that_hangs_is_ended() {
        let child = Command::new("sleep").arg("60").stderr(Stdio::piped()).spawn().expect("sleep exists");
        let start = Instant::now();
        assert!(matches!(finish(child, Duration::from_millis(50)), Finished::TimeOut));
        assert!(start.elapsed() < Duration::from_secs(10));
    }
}
