//! `[[boundaries]]` and the cells of bodies: parts of a mesh that the scene names.

use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawBody, RawBoundary, RawScene, Table};
use crate::scene::reading::source::Source;
use crate::scene::{Body, MeshSource};

/// Half of the right angle within which `normal` takes edges where no `angle` is given, in degrees.
const ANGLE: f64 = 30.0;

/// Cells or edges of a mesh file that it holds together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Group {
    /// A set, group or surface by its name.
    Set(String),
    /// A physical group, or where there is none of this number an elementary entity.
    Tag(i32),
}

/// The cells that make a body, where it is not its name that says so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BodyCells {
    /// Index of the body.
    pub body: usize,
    /// Its cells.
    pub group: Group,
}

/// A name for a part of the outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// The name.
    pub name: String,
    /// Index of the body on whose outline it lies, where that is said.
    pub body: Option<usize>,
    /// Its edges.
    pub edges: Edges,
}

/// Edges of the outline of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub enum Edges {
    /// Those on a segment.
    Line([[f64; 2]; 2]),
    /// Those inside a box with these opposite corners.
    Box([[f64; 2]; 2]),
    /// Those whose ends lie on a circle.
    Circle {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
    },
    /// Those whose outward normal is within an angle of a direction.
    Normal {
        /// The direction, of length one.
        direction: [f64; 2],
        /// The angle, in degrees.
        angle: f64,
    },
    /// Those of a group of the file.
    Group(Group),
}

impl Edges {
    /// Counts coordinates from `origin`.
    pub(in crate::scene) fn shift(&mut self, origin: [f64; 2]) {
        let moved = |p: &mut [f64; 2]| *p = [p[0] - origin[0], p[1] - origin[1]];
        match self {
            Edges::Line(ends) | Edges::Box(ends) => ends.iter_mut().for_each(moved),
            Edges::Circle { centre, .. } => moved(centre),
            Edges::Normal { .. } | Edges::Group(_) => {}
        }
    }
}

/// Checks `[[boundaries]]`, in the order of the file.
pub(in crate::scene) fn boundaries(
    raw: &RawScene,
    mesh: &MeshSource,
    bodies: &[Body],
    source: &Source,
) -> Result<Vec<Boundary>, SceneError> {
    let each = raw.boundaries.iter().enumerate();
    each.map(|(i, raw)| boundary(raw, &format!("[[boundaries]] number {}", i + 1), mesh, bodies, source)).collect()
}

fn boundary(
    raw: &At<Table<RawBoundary>>,
    table: &str,
    mesh: &MeshSource,
    bodies: &[Body],
    source: &Source,
) -> Result<Boundary, SceneError> {
    let (whole, Table(raw)) = (raw.span(), &raw.value);
    let name = source.name(&raw.name, (table, "name"), "give the boundary the name that conditions use")?;
    let body = match &raw.body {
        None => None,
        Some(of) => {
            let known = || crate::scene::reading::fault::names(bodies.iter().map(|body| body.name.as_str()));
            let fault = || Fault::NoSuchBody { name: of.value.clone(), table: table.to_owned(), known: known() };
            let found = bodies.iter().position(|body| body.name == of.value);
            Some(found.ok_or_else(|| source.error(of.span(), fault()))?)
        }
    };
    let given = [
        ("line", raw.line.as_ref().map(At::span)),
        ("box", raw.inside.as_ref().map(At::span)),
        ("circle", raw.circle.as_ref().map(At::span)),
        ("normal", raw.normal.as_ref().map(At::span)),
        ("set", raw.set.as_ref().map(At::span)),
        ("tag", raw.tag.as_ref().map(At::span)),
    ];
    let mut given = given.into_iter().filter_map(|(key, span)| Some((key, span?)));
    let Some((first, _)) = given.next() else {
        let remedy = "say which edges it has: by `line`, `box`, `circle`, `normal`, `set` or `tag`".into();
        return Err(source.error(whole, Fault::MissingKey { key: "line".into(), table: table.to_owned(), remedy }));
    };
    let misplaced = |key, span, other| {
        let remedy = "keep one of the two, or write a table for each; tables of one name are one boundary";
        Err(source.error(span, Fault::Misplaced { key, table: table.to_owned(), other, remedy }))
    };
    if let Some((key, span)) = given.next() {
        return misplaced(key, span, quoted(first));
    }
    if let (Some(angle), None) = (&raw.angle, &raw.normal) {
        return misplaced("angle", angle.span(), quoted(first));
    }
    if let (MeshSource::Geometry { .. }, Some(span)) =
        (mesh, raw.set.as_ref().map(At::span).or(raw.tag.as_ref().map(At::span)))
    {
        let remedy = "polygons have no sets and tags: choose edges by `line`, `box`, `circle` or `normal`";
        return Err(
            source.error(span, Fault::Misplaced { key: first, table: table.to_owned(), other: "[geometry]", remedy })
        );
    }
    let ends =
        |list: &At<Vec<crate::scene::reading::raw::Pair>>, key: &'static str| -> Result<[[f64; 2]; 2], SceneError> {
            let points: Result<Vec<[f64; 2]>, _> = list.value.iter().map(|p| source.point(p, (table, key))).collect();
            let points = points?;
            <[[f64; 2]; 2]>::try_from(points).map_err(|points| {
                let (found, expected) = (crate::scene::reading::source::counted(points.len(), "point"), "2".to_owned());
                let remedy = "write two points, [[x0, y0], [x1, y1]]";
                let fault = Fault::Count { key: key.to_owned(), table: table.to_owned(), found, expected, remedy };
                source.error(list.span(), fault)
            })
        };
    let edges = if let Some(line) = &raw.line {
        let [a, b] = ends(line, "line")?;
        if a == b {
            let remedy = "write the two ends of the segment";
            let fault = Fault::Misplaced { key: "line", table: table.to_owned(), other: "two equal points", remedy };
            return Err(source.error(line.span(), fault));
        }
        Edges::Line([a, b])
    } else if let Some(list) = &raw.inside {
        Edges::Box(ends(list, "box")?)
    } else if let Some(circle) = &raw.circle {
        let Table(circle) = &circle.value;
        let words = ("a radius must be positive", "write the radius of the circle on which the edges lie");
        Edges::Circle {
            centre: source.point(&circle.centre, (table, "circle.centre"))?,
            radius: source.positive(&circle.radius, (table, "circle.radius"), words)?,
        }
    } else if let Some(normal) = &raw.normal {
        let direction = source.unit(normal, (table, "normal"), "write the outward normal of the edges")?;
        let words = ("an angle lies above 0 and up to 180 degrees", "leave `angle` out for 30 degrees");
        let angle = match &raw.angle {
            None => ANGLE,
            Some(angle) => source.number(angle, (table, "angle"), |a| a > 0.0 && a <= 180.0, words)?,
        };
        Edges::Normal { direction, angle }
    } else {
        match group(raw.set.as_ref(), raw.tag.as_ref(), table, source)? {
            Some(group) => Edges::Group(group),
            // One of the six keys is there.
            None => return misplaced("line", whole, "nothing"),
        }
    };
    Ok(Boundary { name, body, edges })
}

fn quoted(key: &'static str) -> &'static str {
    match key {
        "line" => "`line`",
        "box" => "`box`",
        "circle" => "`circle`",
        "normal" => "`normal`",
        "set" => "`set`",
        _ => "`tag`",
    }
}

fn group(
    set: Option<&At<String>>,
    tag: Option<&At<i32>>,
    table: &str,
    source: &Source,
) -> Result<Option<Group>, SceneError> {
    match (set, tag) {
        (Some(_), Some(tag)) => {
            let remedy = "keep one of the two";
            Err(source
                .error(tag.span(), Fault::Misplaced { key: "tag", table: table.to_owned(), other: "`set`", remedy }))
        }
        (Some(set), None) => {
            let name = source.name(set, (table, "set"), "write the name that the set has in the mesh file")?;
            Ok(Some(Group::Set(name)))
        }
        (None, Some(tag)) => Ok(Some(Group::Tag(tag.value))),
        (None, None) => Ok(None),
    }
}

/// The cells of a body, where `tag` or `set` says which.
pub(in crate::scene) fn cells(
    raw: &RawBody,
    label: &str,
    body: usize,
    source: &Source,
) -> Result<Option<BodyCells>, SceneError> {
    let group = group(raw.set.as_ref(), raw.tag.as_ref(), label, source)?;
    Ok(group.map(|group| BodyCells { body, group }))
}

/// Cells by group are those of a mesh file.
pub(in crate::scene) fn only_of_files(raw: &RawScene, mesh: &MeshSource, source: &Source) -> Result<(), SceneError> {
    let MeshSource::Geometry { .. } = mesh else { return Ok(()) };
    for (name, table) in &raw.bodies {
        let Table(body) = &table.value;
        let given = [("tag", body.tag.as_ref().map(At::span)), ("set", body.set.as_ref().map(At::span))];
        if let Some((key, span)) = given.into_iter().find_map(|(key, span)| Some((key, span?))) {
            let remedy = "polygons name their body themselves, by `body`";
            let table = format!("[bodies.{}]", name.value);
            return Err(source.error(span, Fault::Misplaced { key, table, other: "[geometry]", remedy }));
        }
    }
    Ok(())
}

/// As a scene file says it: the fields of a table.
pub(in crate::scene) fn written(group: &Group) -> String {
    match group {
        Group::Set(name) => format!("set = {}", crate::scene::draft::quoted(name)),
        Group::Tag(tag) => format!("tag = {tag}"),
    }
}
