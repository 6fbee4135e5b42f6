//! `[geometry]`: polygons that bound regions, each with a body, and bodies that each have a polygon.

use super::polygon::{Defect, defect};
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::fault::names;
use crate::scene::reading::raw::{At, RawArc, RawGeometry, RawPolygon, RawScene, Table};
use crate::scene::reading::source::{Source, counted};
use crate::scene::{Arc, Body, Circle, MeshSource, Polygon};

pub(in crate::scene) fn geometry(
    raw: &At<Table<RawGeometry>>,
    scene: &RawScene,
    bodies: &[Body],
    source: &Source,
) -> Result<MeshSource, SceneError> {
    let Table(geometry) = &raw.value;
    let size = match &geometry.size {
        None => None,
        Some(number) => {
            let words = (
                "an edge length must be positive",
                "write a positive number, or leave `size` out for the coarsest mesh that fits",
            );
            Some(source.number(number, ("[geometry]", "size"), |h| h > 0.0, words)?)
        }
    };
    if geometry.polygons.value.is_empty() {
        let remedy = "add at least one [[geometry.polygons]] with `body`, `points` and `edges`".into();
        let fault = Fault::MissingKey { key: "polygons".into(), table: "[geometry]".into(), remedy };
        return Err(source.error(geometry.polygons.span(), fault));
    }
    let mut polygons = Vec::with_capacity(geometry.polygons.value.len());
    for (i, raw) in geometry.polygons.value.iter().enumerate() {
        polygons.push(polygon(&raw.value.0, i + 1, bodies, source)?);
    }
    every_body_has_a_polygon(scene, &polygons, source)?;
    Ok(MeshSource::Geometry { size, polygons })
}

fn polygon(raw: &RawPolygon, number: usize, bodies: &[Body], source: &Source) -> Result<Polygon, SceneError> {
    let table = format!("[[geometry.polygons]] number {number}");
    let body = source.name(&raw.body, (&table, "body"), "name the body that the polygon belongs to")?;
    if bodies.iter().all(|b| b.name != body) {
        let known = names(bodies.iter().map(|b| b.name.as_str()));
        return Err(source.error(raw.body.span(), Fault::UnknownBody { name: body, polygon: number, known }));
    }
    let mut points = Vec::with_capacity(raw.points.value.len());
    for (i, point) in raw.points.value.iter().enumerate() {
        points.push(source.point(point, (&table, &format!("points[{i}]")))?);
    }
    if let Some(defect) = defect(&points) {
        return Err(shape_error(raw, number, &points, defect, source));
    }
    if raw.edges.value.len() != points.len() {
        let (found, expected) = (counted(raw.edges.value.len(), "name"), format!("{}", points.len()));
        let remedy = "write one name per corner: edge i runs from corner i to corner i + 1; \"\" leaves it free";
        let fault = Fault::Count { key: "edges".into(), table, found, expected, remedy };
        return Err(source
            .error(raw.edges.span(), fault)
            .with_related(raw.points.span(), counted(points.len(), "corner")));
    }
    let edges = raw.edges.value.iter().map(|name| name.value.clone()).collect();
    let arcs = raw.arcs.iter().map(|raw| arc(raw, &table, &points, source)).collect::<Result<_, _>>()?;
    Ok(Polygon { body, points, edges, arcs })
}

fn arc(raw: &At<Table<RawArc>>, table: &str, points: &[[f64; 2]], source: &Source) -> Result<Arc, SceneError> {
    let Table(arc) = &raw.value;
    let through = source.vector(&arc.through, (table, "arcs.through"))?;
    let wrong = |problem: String, remedy: &'static str| {
        Err(source.error(raw.span(), Fault::Arc { table: table.to_owned(), problem, remedy }))
    };
    let edge = arc.edge.value;
    if edge >= points.len() {
        let problem = format!("is for edge {edge}, and the polygon has edges 0 to {}", points.len() - 1);
        return wrong(problem, "edge i runs from corner i to corner i + 1, counted from 0");
    }
    let [a, b] = [edge, (edge + 1) % points.len()].map(|i| points[i]);
    if through == a || through == b || Circle::through(a, through, b).is_none() {
        let problem = format!("passes through [{:?}, {:?}], on the line of its edge", through[0], through[1]);
        return wrong(problem, "give a point of the arc that lies beside the straight line between its ends");
    }
    Ok(Arc { edge, through })
}

fn shape_error(raw: &RawPolygon, number: usize, points: &[[f64; 2]], defect: Defect, source: &Source) -> SceneError {
    let edge = |i: usize| match raw.edges.value.get(i) {
        Some(name) if !name.value.is_empty() => format!("{} (\"{}\")", i + 1, name.value),
        _ => (i + 1).to_string(),
    };
    let span = defect.corner().map_or(raw.points.span(), |i| raw.points.value[i].span());
    let (problem, remedy) = (defect.problem(points, edge), defect.remedy(points));
    source.error(span, Fault::Polygon { polygon: number, body: raw.body.value.clone(), problem, remedy })
}

fn every_body_has_a_polygon(scene: &RawScene, polygons: &[Polygon], source: &Source) -> Result<(), SceneError> {
    let alone =
        scene.bodies.keys().filter(|key| polygons.iter().all(|p| p.body != key.value)).min_by_key(|key| key.start);
    match alone {
        None => Ok(()),
        Some(key) => {
            let known = names(polygons.iter().map(|p| p.body.as_str()));
            Err(source.error(key.span(), Fault::BodyWithoutPolygon { name: key.value.clone(), known }))
        }
    }
}
