//! The content of a displacement file, or of the arrays of a program, checked number by number.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use serde::Deserialize;

use super::{FieldArrays, FieldError, ForeignField, cells, digits};
use crate::mesh::files::meshio;
use crate::mesh::files::plane::upright;
use crate::study::dossier::provenance::hash;

const SCRIPT: &str = concat!(
    include_str!("../../mesh/files/readers/lean.py"),
    include_str!("../../mesh/files/readers/found.py"),
    include_str!("../../mesh/files/readers/xdmf.py"),
    include_str!("../../mesh/files/readers/vtk.py"),
    include_str!("../../mesh/files/readers/unv.py"),
    include_str!("../../mesh/files/readers/text.py"),
    include_str!("../../mesh/files/readers/exodus.py"),
    include_str!("../../mesh/files/readers/med.py"),
    include_str!("../../mesh/files/readers/frd.py"),
    include_str!("../../mesh/files/readers/dat.py"),
    include_str!("../../mesh/files/readers/choose.py"),
    include_str!("own.py"),
    include_str!("node_data.py"),
    include_str!("read.py")
);
const INSTEAD: &str = "write it as VTU, with triangles or quadrilaterals and the displacement as point data";
/// Names that programs give a displacement, in lower case.
const USUAL: [&str; 3] = ["displacement", "u", "disp"];
/// Largest third component, in parts of the largest displacement, that counts as none.
const FLAT: f64 = 1e-9;

#[derive(Deserialize)]
struct Content {
    points: Vec<Vec<Option<f64>>>,
    single: bool,
    /// True for a file of this program, where a linear field has no values at the middles of edges.
    #[serde(default)]
    own: bool,
    cells: Vec<Vec<usize>>,
    others: Vec<String>,
    fields: BTreeMap<String, Data>,
    /// What a file of this program has on quadrilaterals.
    #[serde(default)]
    on_quadrilaterals: Option<OnQuadrilaterals>,
}

#[derive(Deserialize)]
struct OnQuadrilaterals {
    points: Vec<Vec<Option<f64>>>,
    cells: Vec<Vec<usize>>,
    fields: BTreeMap<String, Data>,
}

#[derive(Deserialize)]
struct Data {
    values: Option<Vec<Vec<Option<f64>>>>,
    single: bool,
}

impl ForeignField {
    /// Reads triangles and displacement of `file`, in any format that meshio reads. `name` is the name of the point
    /// data; without it, point data called `displacement`, `u` or `disp` in any case is looked for, and the exact
    /// `displacement` has precedence. meshio is given at most `limit`.
    ///
    /// # Errors
    /// [`FieldError`] when the file cannot be read, or does not hold one plane displacement on triangles.
    pub fn read(file: &Path, name: Option<&str>, limit: Duration) -> Result<Self, FieldError> {
        let fault = |what: String, remedy: &str| FieldError { file: file.into(), what, remedy: remedy.into() };
        let kind = std::fs::metadata(file)
            .map_err(|e| fault(format!("cannot be opened: {e}"), "check the path given with --displacement"))?;
        if kind.is_dir() {
            return Err(fault("this is a directory".into(), "give the path of the file in it"));
        }
        if !kind.is_file() {
            return Err(fault("this is not a regular file".into(), "write the field into a file"));
        }
        let bytes = std::fs::read(file).map_err(|e| fault(format!("cannot be read: {e}"), "check its permissions"))?;
        let text = meshio::run(SCRIPT, file, INSTEAD, limit).map_err(|f| fault(f.what, &f.remedy))?;
        Self::parse(&text, file, hash(&bytes), name)
    }

    /// The field in the arrays of `file` as meshio gave them, in JSON; `sha256` is that of the file.
    ///
    /// # Errors
    /// As [`ForeignField::read`], without those of the file.
    pub fn parse(text: &[u8], file: &Path, sha256: String, name: Option<&str>) -> Result<Self, FieldError> {
        let fault = |what: String, remedy: &str| FieldError { file: file.into(), what, remedy: remedy.into() };
        let content =
            serde_json::from_slice(text).map_err(|e| fault(format!("meshio gave no cells ({e})"), INSTEAD))?;
        Self::checked(content, file, sha256, name)
    }

    /// The field in `arrays`, which have no file: `name` stands in its place.
    ///
    /// # Errors
    /// As [`ForeignField::read`], without those of the file.
    pub fn of_arrays(name: &str, arrays: FieldArrays) -> Result<Self, FieldError> {
        let finite = |rows: Vec<Vec<f64>>| -> Vec<Vec<Option<f64>>> {
            rows.into_iter().map(|row| row.into_iter().map(|x| Some(x).filter(|x| x.is_finite())).collect()).collect()
        };
        let FieldArrays { points, triangles, displacement, single } = arrays;
        let numbers = points.iter().chain(&displacement).flatten().flat_map(|x| x.to_le_bytes());
        let indices = triangles.iter().flatten().flat_map(|n| (*n as u64).to_le_bytes());
        let sha256 = hash(&numbers.chain(indices).collect::<Vec<u8>>());
        let values = finite(displacement);
        if let Some(i) = values.iter().position(|row| ![2, 3].contains(&row.len())) {
            let what = format!("the displacement has {} components at point {}", values[i].len(), i + 1);
            let remedy = "give one row of two or three components for every point".to_string();
            return Err(FieldError { file: name.into(), what, remedy });
        }
        let fields = BTreeMap::from([("displacement".to_string(), Data { values: Some(values), single })]);
        let content = Content {
            points: finite(points),
            single: false,
            own: false,
            cells: triangles,
            others: Vec::new(),
            fields,
            on_quadrilaterals: None,
        };
        Self::checked(content, Path::new(name), sha256, None)
    }

    fn checked(mut content: Content, file: &Path, sha256: String, name: Option<&str>) -> Result<Self, FieldError> {
        let fault = |what: String, remedy: &str| FieldError { file: file.into(), what, remedy: remedy.into() };
        if let Some(kind) = content.others.first() {
            let what = format!("it has cells of the kind '{kind}'");
            return Err(fault(
                what,
                "write the field on triangles with three or six nodes, or quadrilaterals with four, eight or nine",
            ));
        }
        if content.cells.is_empty() {
            return Err(fault("there is no triangle and no quadrilateral in it".into(), INSTEAD));
        }
        lay_down(&mut content);
        let wanted = |on: &mut OnQuadrilaterals| {
            content.fields.is_empty() || name.is_some_and(|name| on.fields.contains_key(name))
        };
        if let Some(on) = content.on_quadrilaterals.take_if(wanted) {
            (content.points, content.cells, content.fields) = (on.points, on.cells, on.fields);
        }
        let (name, data) = choose(&content.fields, name).map_err(|(what, remedy)| fault(what, remedy))?;
        let rows = data.values.as_deref().unwrap_or_default();
        if content.own && rows.len() < content.points.len() {
            // A linear field: vertices come first.
            content.points.truncate(rows.len());
            content.cells.iter_mut().for_each(|nodes| nodes.truncate(if nodes.len() == 6 { 3 } else { 4 }));
        }
        let points: Option<Vec<[f64; 2]>> = content.points.iter().map(|p| plane(p)).collect();
        let Some(points) = points else {
            return Err(fault("a point has no finite coordinates".into(), "write the file again"));
        };
        if rows.len() != points.len() {
            let what = format!("'{name}' has {} values for {} points", rows.len(), points.len());
            return Err(fault(what, "write one value for every point"));
        }
        if let Some(nodes) = content.cells.iter().find(|nodes| ![3, 4, 6, 8, 9].contains(&nodes.len())) {
            let what = format!("it has a cell with {} nodes", nodes.len());
            return Err(fault(what, INSTEAD));
        }
        let damaged = content.cells.iter().position(|nodes| nodes.iter().any(|&n| n >= points.len()));
        if let Some(t) = damaged {
            let what = format!("cell {} refers to a point beyond the {} of the file", t + 1, points.len());
            return Err(fault(what, "write the file again"));
        }
        let triangles = cells::parts(&mut content.cells, &points).map_err(|what| fault(what, cells::REMEDY))?;
        let size = rows.iter().flatten().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        if let Some(i) = rows.iter().position(|r| matches!(r.get(2), Some(Some(w)) if w.abs() > FLAT * size)) {
            let what = format!("'{name}' has a third component at point {} that is not zero", i + 1);
            return Err(fault(what, "this program is plane: write a displacement in the plane z = 0"));
        }
        let far = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let third = || content.points.iter().filter_map(|p| p.get(2).copied().flatten());
        let (low, high) = third().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(z), b.max(z)));
        let extent = third().fold(far, |m, z| m.max(z.abs()));
        if high - low > if content.single { f64::from(f32::EPSILON) } else { FLAT } * extent {
            let what = format!("its points are not in one plane z = constant: z goes from {low} to {high}");
            return Err(fault(what, "this program is plane: write the field in the plane z = 0"));
        }
        let values: Vec<Option<[f64; 2]>> = rows.iter().map(|row| plane(row)).collect();
        let single = data.single || content.single;
        let numbers = values.iter().flatten().flatten().copied();
        let of_format = if single { 0.0 } else { digits::of_format(file) };
        let precision = digits::precision(numbers, single).max(of_format);
        let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        Ok(ForeignField {
            files: vec![(name, [0; 2])],
            file: file.into(),
            sha256,
            points,
            triangles,
            cells: content.cells,
            values,
            single,
            precision,
            far,
        })
    }
}

/// The first two of some numbers, where all of them are finite.
fn plane(numbers: &[Option<f64>]) -> Option<[f64; 2]> {
    let all: Option<Vec<f64>> = numbers.iter().copied().collect();
    all.and_then(|all| all.get(..2)?.try_into().ok())
}

/// Turns a field in a plane of constant y or x into one of x and y, as the mesh of such a file is.
fn lay_down(content: &mut Content) {
    let tolerance = if content.single { f64::from(f32::EPSILON) } else { FLAT };
    let size = content.points.iter().flatten().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let points = content.points.iter().filter_map(|row| Some([(*row.first()?)?, (*row.get(1)?)?, (*row.get(2)?)?]));
    let Some((axes, _)) = upright(points, tolerance * size) else { return };
    let rows = content.fields.values_mut().filter_map(|data| data.values.as_mut()).flatten();
    let turned = content.points.iter_mut().chain(rows).filter(|row| row.len() == 3);
    turned.for_each(|row| *row = axes.iter().map(|c| row[*c]).collect());
}

type Chosen<'a> = (&'a str, &'a Data);

/// The point data that is the displacement.
fn choose<'a>(fields: &'a BTreeMap<String, Data>, wanted: Option<&str>) -> Result<Chosen<'a>, (String, &'static str)> {
    let all: Vec<&str> = fields.keys().map(String::as_str).collect();
    let listed = |names: &[&str]| if names.is_empty() { "none".to_string() } else { names.join(", ") };
    let vectors: Vec<Chosen> =
        fields.iter().filter(|(_, d)| d.values.is_some()).map(|(name, d)| (name.as_str(), d)).collect();
    let exact = wanted.unwrap_or("displacement");
    if let Some(found) = vectors.iter().find(|(name, _)| *name == exact) {
        return Ok(*found);
    }
    if let Some(wanted) = wanted {
        let what =
            format!("it has no point data '{wanted}' with two or three components (point data: {})", listed(&all));
        return Err((what, "give one of these with --field, or write the displacement as point data"));
    }
    let usual: Vec<Chosen> =
        vectors.into_iter().filter(|(name, _)| USUAL.contains(&name.to_lowercase().as_str())).collect();
    match usual.as_slice() {
        [one] => Ok(*one),
        [] => Err((
            format!("it has no vector field on points called displacement, u or disp (point data: {})", listed(&all)),
            "write the displacement as point data of that name with two or three components, or name it with --field",
        )),
        several => {
            let names: Vec<&str> = several.iter().map(|(name, _)| *name).collect();
            Err((format!("several fields may be the displacement: {}", names.join(", ")), "choose one with --field"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same field in the plane of x and y, of x and z, and of y and z.
    #[test]
    fn fields_in_other_planes_are_laid_down() {
        let placed = |axes: [usize; 2]| {
            let row = |[a, b]: [f64; 2], across: f64| {
                let mut row = [across; 3];
                (row[axes[0]], row[axes[1]]) = (a, b);
                format!("[{:?}, {:?}, {:?}]", row[0], row[1], row[2])
            };
            let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]].map(|p| row(p, 0.5)).join(", ");
            let values = [[0.0, 0.25], [0.5, 0.0], [0.125, -1.0]].map(|v| row(v, 0.0)).join(", ");
            let text = format!(
                r#"{{"points": [{points}], "single": false, "cells": [[0, 1, 2]], "others": [], "fields": {{"u": {{"values": [{values}], "single": false}}}}}}"#
            );
            ForeignField::parse(text.as_bytes(), Path::new("f.vtu"), String::new(), None).expect("a field")
        };
        let flat = placed([0, 1]);
        for axes in [[0, 2], [1, 2]] {
            let turned = placed(axes);
            assert_eq!((&turned.points, &turned.values), (&flat.points, &flat.values), "{axes:?}");
        }
    }

    fn named(names: &[(&str, bool)]) -> BTreeMap<String, Data> {
        let data = |vector: bool| Data { values: vector.then(Vec::new), single: false };
        names.iter().map(|(name, vector)| (name.to_string(), data(*vector))).collect()
    }

    #[test]
    fn the_displacement_is_found_by_name_and_doubt_is_told() {
        let choice = |names: &[(&str, bool)], wanted| choose(&named(names), wanted).map(|c| c.0.to_string());
        assert_eq!(choice(&[("U", true), ("p", false)], None), Ok("U".into()));
        assert_eq!(choice(&[("u", true), ("displacement", true)], None), Ok("displacement".into()));
        assert_eq!(choice(&[("u", true), ("f", true)], Some("f")), Ok("f".into()));
        let several = choice(&[("U", true), ("u", true), ("disp", true)], None).unwrap_err().0;
        assert!(several.contains("U, disp, u"), "{several}");
        for wanted in [None, Some("u")] {
            let (what, _) = choice(&[("u", false), ("traction", true)], wanted).unwrap_err();
            assert!(what.contains("traction, u"), "{what}");
        }
        assert!(choice(&[], None).unwrap_err().0.contains("none"));
    }
}
