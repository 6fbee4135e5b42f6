//! The bytes of a Gmsh file: read, and where they are accepted and small, made a problem with the names in them.

use std::collections::BTreeSet;
use std::path::Path;

use hypercircle::mesh::files::gmsh;
use hypercircle::mesh::sides::glue;
use hypercircle::mesh::{RawMesh, Triangulation};
use hypercircle::problem::Problem;
use hypercircle::scene::Scene;

use super::setting::SMALL;

/// A refusal has to say something; a triangulation has to be counter-clockwise and non-degenerate.
pub fn run(bytes: &[u8]) {
    match gmsh::parse(bytes, Path::new("mesh.msh")) {
        Ok((raw, _)) => follow(raw),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

/// As a scene does that uses all the names of `raw`.
pub fn follow(raw: RawMesh) {
    let cells = raw.triangles.len() + raw.shared.iter().map(|s| s.triangles.len()).sum::<usize>();
    if cells > 4 * SMALL {
        return;
    }
    let Ok(scene) = Scene::parse(&scene_of(&raw), Path::new("scene.toml")) else { return };
    let Ok((mesh, notes)) = Triangulation::new(raw, &scene) else { return };
    assert!((0..mesh.triangles.len()).all(|t| mesh.area(t) > 0.0), "a triangle without area");
    let Ok(glue::Glued { mesh, .. }) = glue::glue(mesh, &scene) else { return };
    let _ = Problem::new(scene, mesh, notes);
}

/// Two names that end in `face` are in contact, or else the first one with an obstacle; the others are clamped in turn.
fn scene_of(raw: &RawMesh) -> String {
    let quoted = |name: &str| serde_json::Value::from(name).to_string();
    let shared = || raw.shared.iter();
    let bodies: BTreeSet<&String> = (raw.triangles.iter().map(|(_, name)| name))
        .chain(shared().filter(|s| !s.triangles.is_empty()).flat_map(|s| &s.names))
        .collect();
    let boundaries: BTreeSet<&String> = (raw.segments.iter().map(|(_, name)| name))
        .chain(shared().filter(|s| !s.segments.is_empty()).flat_map(|s| &s.names))
        .collect();
    let mut text = String::from("model.kinematics = \"plane-strain\"\nmesh.file = \"mesh.msh\"\n");
    for name in bodies.into_iter().take(20) {
        text += &format!("[bodies.{}]\nyoung = 1.0\npoisson = 0.3\n", quoted(name));
    }
    let (faces, others): (Vec<&String>, Vec<&String>) = boundaries.into_iter().partition(|name| name.ends_with("face"));
    match faces[..] {
        [] => {}
        [one] => text += &format!("[[contacts]]\non = {}\n", quoted(one)),
        [first, second, ..] => {
            text += &format!(
                "[[contacts]]\nbetween = [{}, {}]\ngap = [[0, 0], [0.3, 0.1]]\n",
                quoted(first),
                quoted(second)
            );
        }
    }
    for (i, name) in others.into_iter().take(20).enumerate() {
        let kind = ["clamped", "roller"][i % 2];
        text += &format!("[[supports]]\non = {}\ntype = \"{kind}\"\n", quoted(name));
    }
    text
}
