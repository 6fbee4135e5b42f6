//! `[mesh]`: a mesh file, or several with a prefix, a scale and a place each.

use std::path::{Path, PathBuf};

use crate::scene::MeshSource;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawMesh, RawPart, Table};
use crate::scene::reading::source::Source;

/// One of several mesh files of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// The file, path already resolved against the scene's folder.
    pub file: PathBuf,
    /// Stands before every name of this file.
    pub prefix: String,
    /// Factor on its coordinates.
    pub scale: f64,
    /// Added to its coordinates after scaling.
    pub translate: [f64; 2],
}

impl Part {
    /// Where a point of the file lies in the scene.
    pub fn place(&self, p: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|c| self.scale * p[c] + self.translate[c])
    }
}

pub(in crate::scene) fn files(mesh: &At<Table<RawMesh>>, source: &Source) -> Result<MeshSource, SceneError> {
    let Table(raw) = &mesh.value;
    let both = Fault::OneOf { table: "[mesh]".into(), first: "`file`", second: "[[mesh.parts]]", both: true };
    let folder = source.path.parent().unwrap_or(Path::new(""));
    match (&raw.file, raw.parts.as_slice()) {
        (Some(file), []) => {
            let file = source.name(file, ("[mesh]", "file"), "name the mesh file, relative to the scene")?;
            Ok(MeshSource::File(folder.join(file)))
        }
        (Some(file), [first, ..]) => Err(source.error(file.span(), both).with_related(first.span(), "the other one")),
        (None, []) => {
            let remedy = "name the mesh file, relative to the scene; several files go into [[mesh.parts]]".into();
            let fault = Fault::MissingKey { key: "file".into(), table: "[mesh]".into(), remedy };
            Err(source.error(mesh.span(), fault))
        }
        (None, parts) => {
            let each = parts.iter().enumerate();
            let part = |(i, raw): (usize, &At<Table<RawPart>>)| part(&raw.value.0, i + 1, folder, source);
            Ok(MeshSource::Parts(each.map(part).collect::<Result<_, _>>()?))
        }
    }
}

fn part(raw: &RawPart, number: usize, folder: &Path, source: &Source) -> Result<Part, SceneError> {
    let table = &format!("[[mesh.parts]] number {number}");
    let file = source.name(&raw.file, (table, "file"), "name the mesh file, relative to the scene")?;
    let words = ("a scale must be positive", "write the factor on the coordinates of the file, for instance 1e-3");
    Ok(Part {
        file: folder.join(file),
        prefix: raw.prefix.as_ref().map_or_else(String::new, |prefix| prefix.value.clone()),
        scale: raw.scale.as_ref().map_or(Ok(1.0), |scale| source.positive(scale, (table, "scale"), words))?,
        translate: raw.translate.as_ref().map_or(Ok([0.0; 2]), |by| source.point(by, (table, "translate")))?,
    })
}
