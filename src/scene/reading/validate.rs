//! TOML types → [`Scene`]: everything that can be judged without a mesh.

use std::path::Path;

use super::error::{Fault, SceneError};
use super::raw::{At, RawModel, RawScene, Table};
use super::source::Source;
use crate::scene::keys::body_force::body_force;
use crate::scene::keys::conditions::{Conditions, conditions, edge_names};
use crate::scene::keys::material::{elasticity, initial};
use crate::scene::keys::range::ranges;
use crate::scene::keys::{files, geometry, selection};
use crate::scene::quantity::quantities;
use crate::scene::{Body, BodyCells, Draft, Kinematics, MeshSource, Scene};

/// Checks the whole scene; the first fault found is the error.
pub(in crate::scene) fn validate(raw: RawScene, text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Source { text, path };
    let name = scene_name(path);
    let (kinematics, thickness) = model(&raw.model, &source)?;
    let (bodies, cells) = bodies(&raw, kinematics, &source)?;
    let mesh = mesh(&raw, &bodies, &source)?;
    selection::only_of_files(&raw, &mesh, &source)?;
    let boundaries = selection::boundaries(&raw, &mesh, &bodies, &source)?;
    let edges = edge_names(&mesh, &boundaries);
    let conditions = conditions(&raw, edges.clone(), &source)?;
    let quantities = quantities(&raw, edges, &bodies, &conditions, &source)?;
    let Conditions { supports, tractions, contacts, bonds } = conditions;
    let ranges = ranges(&raw, &bodies);
    let title = raw.title.unwrap_or_else(|| name.clone());
    let path = path.to_owned();
    Ok(Scene::unchecked(Draft {
        name,
        title,
        path,
        origin: [0.0; 2],
        kinematics,
        thickness,
        mesh,
        bodies,
        cells,
        boundaries,
        supports,
        tractions,
        contacts,
        bonds,
        quantities,
        ranges,
    }))
}

/// The stem of the file, where it can be the name of a folder: `...toml` has the stem `..`.
pub fn scene_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if stem.trim_matches('.').is_empty() { "scene".to_owned() } else { stem }
}

fn model(raw: &At<Table<RawModel>>, source: &Source) -> Result<(Kinematics, f64), SceneError> {
    let table = "[model]";
    let Table(model) = &raw.value;
    let Some(kinematics) = Kinematics::named(&model.kinematics.value) else {
        let known = [Kinematics::PlaneStrain, Kinematics::PlaneStress, Kinematics::Axisymmetric]
            .map(|k| k.name().to_owned())
            .to_vec();
        let found = model.kinematics.value.clone();
        let fault = Fault::UnknownWord { key: "kinematics", table: table.into(), found, known };
        return Err(source.error(model.kinematics.span(), fault));
    };
    let thickness = match &model.thickness {
        None => kinematics.measure(),
        Some(number) if kinematics == Kinematics::Axisymmetric => {
            let words = (
                "a body of revolution has no thickness: its forces and energies are those of the full turn",
                "leave `thickness` out",
            );
            source.number(number, (table, "thickness"), |_| false, words)?
        }
        Some(number) => {
            let words = ("a thickness must be positive", "write a positive number, or leave `thickness` out for 1");
            source.positive(number, (table, "thickness"), words)?
        }
    };
    Ok((kinematics, thickness))
}

fn bodies(raw: &RawScene, kinematics: Kinematics, source: &Source) -> Result<(Vec<Body>, Vec<BodyCells>), SceneError> {
    if raw.bodies.is_empty() {
        return Err(source.error(0..0, Fault::NoBodies));
    }
    let mut bodies: Vec<_> = raw.bodies.iter().collect();
    bodies.sort_by_key(|(name, _)| name.start);
    let mut cells = Vec::new();
    let body = |(index, (name, table)): (usize, (&At<String>, &At<Table<super::raw::RawBody>>))| {
        let Table(raw) = &table.value;
        let label = format!("[bodies.{}]", name.value);
        let name =
            source.name(name, ("the scene", "bodies"), "give the body the name that the mesh or a polygon uses")?;
        let elasticity = elasticity(raw, &label, table.span(), kinematics, source)?;
        let body_force = body_force(raw, &label, kinematics, source)?;
        cells.extend(selection::cells(raw, &label, index, source)?);
        let initial = initial(raw, &label, &elasticity, kinematics, source)?;
        Ok(Body { name, elasticity, initial, body_force })
    };
    let bodies = bodies.into_iter().enumerate().map(body).collect::<Result<_, SceneError>>()?;
    Ok((bodies, cells))
}

fn mesh(raw: &RawScene, bodies: &[Body], source: &Source) -> Result<MeshSource, SceneError> {
    let one_of = |both| Fault::OneOf { table: "the scene".into(), first: "[mesh]", second: "[geometry]", both };
    match (&raw.mesh, &raw.geometry) {
        (Some(mesh), Some(geometry)) => {
            let (early, late) = if mesh.start < geometry.start {
                (mesh.span(), geometry.span())
            } else {
                (geometry.span(), mesh.span())
            };
            Err(source.error(late, one_of(true)).with_related(early, "the other one"))
        }
        (None, None) => Err(source.error(0..0, one_of(false))),
        (Some(mesh), None) => files::files(mesh, source),
        (None, Some(geometry)) => geometry::geometry(geometry, raw, bodies, source),
    }
}
