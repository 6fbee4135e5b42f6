//! Every format but Gmsh's and Abaqus's, in a Python process of its own: by the readers beside this, or through meshio.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

use serde::Deserialize;

use super::content::{Content, Element, Kind};
use super::meshio;
use crate::mesh::cells::solids::solid_kind;
use crate::mesh::{MeshError, RawMesh};
use crate::scene::{Kinematics, Note};

const SCRIPT: &str = concat!(
    include_str!("readers/lean.py"),
    include_str!("readers/found.py"),
    include_str!("readers/xdmf.py"),
    include_str!("readers/vtk.py"),
    include_str!("readers/unv.py"),
    include_str!("readers/text.py"),
    include_str!("readers/exodus.py"),
    include_str!("readers/med.py"),
    include_str!("readers/frd.py"),
    include_str!("readers/choose.py"),
    include_str!("readers/nastran.py"),
    include_str!("readers/mapdl.py"),
    include_str!("readers/dyna.py"),
    include_str!("readers/comsol.py"),
    include_str!("foreign.py")
);
const INSTEAD: &str = "convert it to Gmsh's format (.msh)";

#[derive(Deserialize)]
struct Converted {
    points: Vec<Vec<f64>>,
    blocks: Vec<CellBlock>,
    #[serde(default)]
    node_sets: BTreeMap<String, Vec<u64>>,
    /// Dimension, number and name of each group that has a number.
    #[serde(default)]
    numbers: Vec<(i32, i32, String)>,
    /// What the file lacks and can do without.
    #[serde(default)]
    notes: Vec<String>,
    /// Kinematics by its name, and the name of an element that is made for it.
    #[serde(default)]
    made_for: Vec<(String, String)>,
}

#[derive(Deserialize)]
struct CellBlock {
    shape: String,
    nodes: Vec<Vec<u64>>,
    groups: Vec<Vec<String>>,
}

/// Reads `file` through [`meshio`], which is given at most `limit`.
///
/// # Errors
/// [`MeshError::File`] when no interpreter has meshio, or when it cannot read the file or takes too long.
pub fn read(file: &Path, limit: Duration) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let text = meshio::run(SCRIPT, file, INSTEAD, limit).map_err(|f| MeshError::file(file, f.what, f.remedy))?;
    parse(&text, file)
}

/// The mesh in what the script writes, which is JSON; `file` is for messages.
///
/// # Errors
/// [`MeshError::File`] when it is no mesh of triangles.
pub fn parse(text: &[u8], file: &Path) -> Result<(RawMesh, Vec<Note>), MeshError> {
    let found: Converted = serde_json::from_slice(text)
        .map_err(|e| MeshError::file(file, format!("meshio gave no mesh of finite numbers ({e})"), INSTEAD))?;
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
    content.numbers = Some(found.numbers.into_iter().map(|(dimension, tag, name)| ((dimension, tag), name)).collect());
    content.node_sets = found.node_sets.into_iter().collect();
    // Cells of the same groups share one list of them.
    let mut lists: HashMap<Vec<String>, Rc<[i32]>> = HashMap::new();
    let mut physical_of = |groups: Vec<String>| match lists.get(&groups) {
        Some(list) => Rc::clone(list),
        None => Rc::clone(lists.entry(groups).or_insert_with_key(|groups| groups.iter().map(tag_of).collect())),
    };
    let mut tag = 0;
    for block in found.blocks {
        let kind = match block.shape.as_str() {
            "line" => Kind::Line,
            "triangle" => Kind::Triangle,
            "quadrilateral" => Kind::Quadrilateral,
            other if solid_kind(other).is_some() => {
                let kind = solid_kind(other).unwrap_or_default();
                block.nodes.iter().for_each(|nodes| content.solid(kind, nodes));
                continue;
            }
            other => {
                let what = format!("it has cells of the kind '{other}'");
                let remedy =
                    "this program is plane: mesh surfaces with triangles or quadrilaterals of first or second order";
                return Err(MeshError::file(file, what, remedy));
            }
        };
        let odd = block.nodes.iter().find(|nodes| !kind.takes(nodes.len()));
        if let Some(nodes) = odd {
            let what = format!("meshio gave a cell of the kind '{}' with {} nodes", block.shape, nodes.len());
            return Err(MeshError::file(file, what, INSTEAD));
        }
        if block.groups.len() != block.nodes.len() {
            let what = format!("meshio gave {} cells and groups of {}", block.nodes.len(), block.groups.len());
            return Err(MeshError::file(file, what, INSTEAD));
        }
        for (nodes, groups) in block.nodes.into_iter().zip(block.groups) {
            tag += 1;
            content.elements.push(Element { kind, tag, nodes, physical: physical_of(groups), entity: None });
        }
    }
    let (mut raw, mut notes) = content.into_raw(file)?;
    let made_for = found.made_for.into_iter();
    raw.sets.made_for = made_for.filter_map(|(name, element)| Some((Kinematics::named(&name)?, element))).collect();
    notes.extend(found.notes.into_iter().map(|text| Note { weakens_guarantee: false, text }));
    Ok((raw, notes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_the_wrong_number_of_nodes_are_refused() {
        for (shape, nodes, groups) in [
            ("triangle", "[[0, 1]]", "[[]]"),
            ("triangle", "[[]]", "[[]]"),
            ("line", "[[0]]", "[[]]"),
            ("line", "[[0, 1, 2, 3]]", "[[]]"),
            ("triangle", "[[0, 1, 2], [0, 1, 2]]", "[[]]"),
        ] {
            let block = format!(r#"{{"shape": "{shape}", "nodes": {nodes}, "groups": {groups}}}"#);
            let text = format!(r#"{{"points": [[0, 0], [1, 0], [0, 1]], "blocks": [{block}]}}"#);
            let error = parse(text.as_bytes(), Path::new("mesh.vtu")).expect_err("not a mesh").to_string();
            assert!(error.contains("mesh.vtu") && error.contains("meshio gave"), "{error}");
        }
    }
}
