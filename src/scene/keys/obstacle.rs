//! A rigid obstacle with a place of its own.

use crate::scene::reading::error::SceneError;
use crate::scene::reading::fault::Fault;
use crate::scene::reading::raw::{At, RawContact, RawObstacle, Table};
use crate::scene::reading::source::Source;

/// The cosine between a motion and a line up to which the motion is across it, but for rounding.
const ALONG: f64 = 1e-12;

/// A rigid obstacle that lies where the scene puts it, whatever the shape of the boundary that meets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// Its outline before it moves.
    pub shape: Shape,
    /// By how much it moves.
    pub moved: [f64; 2],
}

/// The outline of an obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// The straight line through two points; the body lies on its left.
    Line([[f64; 2]; 2]),
    /// A circle.
    Circle {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
        /// True if the body lies inside.
        inside: bool,
    },
}

impl Obstacle {
    /// The unit vector from the body to the obstacle at `point`, and the distance along it, which is below zero where they
    /// overlap; `None` in the centre of a circle.
    pub fn seen_from(&self, point: [f64; 2]) -> Option<([f64; 2], f64)> {
        let (direction, distance) = match self.shape {
            Shape::Line([a, b]) => {
                let [x, y] = [b[0] - a[0], b[1] - a[1]];
                let length = x.hypot(y);
                let direction = [y / length, -x / length];
                (direction, (a[0] - point[0]) * direction[0] + (a[1] - point[1]) * direction[1])
            }
            Shape::Circle { centre, radius, inside } => {
                let [x, y] = [centre[0] - point[0], centre[1] - point[1]];
                let away = x.hypot(y);
                if away <= f64::EPSILON * radius {
                    return None;
                }
                let sign = if inside { -1.0 } else { 1.0 };
                ([sign * x / away, sign * y / away], sign * (away - radius))
            }
        };
        Some((direction, distance + self.moved[0] * direction[0] + self.moved[1] * direction[1]))
    }

    /// True if the direction of contact is the same everywhere.
    pub fn is_straight(&self) -> bool {
        matches!(self.shape, Shape::Line(_))
    }

    /// True if it moves along itself somewhere, which only friction notices.
    fn slides(&self) -> bool {
        let [x, y] = self.moved;
        match self.shape {
            Shape::Line([a, b]) => {
                let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
                (x * dx + y * dy).abs() > ALONG * x.hypot(y) * dx.hypot(dy)
            }
            Shape::Circle { .. } => self.moved != [0.0; 2],
        }
    }

    /// Counts coordinates from `origin`.
    pub(in crate::scene) fn shift(&mut self, origin: [f64; 2]) {
        let move_point = |p: &mut [f64; 2]| *p = [p[0] - origin[0], p[1] - origin[1]];
        match &mut self.shape {
            Shape::Line(ends) => ends.iter_mut().for_each(move_point),
            Shape::Circle { centre, .. } => move_point(centre),
        }
    }
}

/// The obstacle of a contact, if it has one.
pub(in crate::scene) fn obstacle(
    contact: &RawContact,
    table: &str,
    source: &Source,
) -> Result<Option<Obstacle>, SceneError> {
    let Some(raw) = &contact.obstacle else {
        return match &contact.moved {
            None => Ok(None),
            Some(moved) => {
                let remedy = "add obstacle = { line = [[x0, y0], [x1, y1]] }, or delete `move`";
                let (key, table, other) = ("move", table.to_owned(), "a missing `obstacle`, which is what it moves");
                Err(source.error(moved.span(), Fault::Misplaced { key, table, other, remedy }))
            }
        };
    };
    let elsewhere = |key: &'static str, other: &'static str, span: std::ops::Range<usize>| {
        let remedy = "delete it: the obstacle says where it is, and contact acts across it";
        source.error(span, Fault::Misplaced { key, table: table.to_owned(), other, remedy })
    };
    if let Some(between) = &contact.between {
        let remedy = "write on = \"…\", the boundary that meets the obstacle";
        let (key, table, other) = ("obstacle", table.to_owned(), "`between`, two bodies");
        let error = source.error(raw.span(), Fault::Misplaced { key, table, other, remedy });
        return Err(error.with_related(between.span(), "the two bodies"));
    }
    let with = "`obstacle`, which has a place of its own";
    if let Some(gap) = &contact.gap {
        return Err(elsewhere("gap", with, gap.span()));
    }
    if let Some(normals) = &contact.normals {
        return Err(elsewhere("normals", with, normals.span()));
    }
    if let Some(direction) = &contact.direction {
        return Err(elsewhere("direction", with, direction.span()));
    }
    let moved = contact.moved.as_ref().map(|moved| source.vector(moved, (table, "move"))).transpose()?;
    let own = Obstacle { shape: shape(raw, table, source)?, moved: moved.unwrap_or_default() };
    if let (Some(moved), Some(friction)) = (&contact.moved, &contact.friction)
        && own.slides()
    {
        let remedy = "move the obstacle across itself alone; in the place of what it moves along itself, move the supports of the body the other \
                      way";
        let other = "`friction`, which would resist that the obstacle moves along itself";
        let error =
            source.error(moved.span(), Fault::Misplaced { key: "move", table: table.to_owned(), other, remedy });
        return Err(error.with_related(friction.span(), "the friction"));
    }
    Ok(Some(own))
}

fn shape(raw: &At<Table<RawObstacle>>, table: &str, source: &Source) -> Result<Shape, SceneError> {
    let one_of =
        |both| Fault::OneOf { table: format!("obstacle of {table}"), first: "`line`", second: "`circle`", both };
    let Table(obstacle) = &raw.value;
    match (&obstacle.line, &obstacle.circle) {
        (Some(line), None) => {
            let [a, b] = line.value.as_slice() else {
                let (key, found) = ("obstacle.line".to_owned(), crate::scene::counted(line.value.len(), "point"));
                let (table, expected, remedy) =
                    (table.to_owned(), "2".to_owned(), "write two points, [[x0, y0], [x1, y1]]");
                return Err(source.error(line.span(), Fault::Count { key, table, found, expected, remedy }));
            };
            let ends = [source.vector(a, (table, "obstacle.line[0]"))?, source.vector(b, (table, "obstacle.line[1]"))?];
            if ends[0] == ends[1] {
                let (key, found) = ("obstacle.line".to_owned(), source.written(line.span()));
                let (rule, remedy) =
                    ("its two points must differ", "write two points of the line, the body on its left");
                let fault = Fault::Number { key, table: table.to_owned(), found, rule, remedy };
                return Err(source.error(line.span(), fault));
            }
            Ok(Shape::Line(ends))
        }
        (None, Some(circle)) => {
            let Table(raw) = &circle.value;
            let inside = match raw.side.as_ref().map(|side| (side.value.as_str(), side)) {
                None | Some(("outside", _)) => false,
                Some(("inside", _)) => true,
                Some((other, side)) => {
                    let known = ["inside", "outside"].map(String::from).to_vec();
                    let fault =
                        Fault::UnknownWord { key: "side", table: table.to_owned(), found: other.to_owned(), known };
                    return Err(source.error(side.span(), fault));
                }
            };
            const RADIUS: (&str, &str) = ("a radius must be positive", "write the radius of the obstacle");
            Ok(Shape::Circle {
                centre: source.vector(&raw.centre, (table, "obstacle.circle.centre"))?,
                radius: source.number(&raw.radius, (table, "obstacle.circle.radius"), |r| r > 0.0, RADIUS)?,
                inside,
            })
        }
        (line, _) => Err(source.error(raw.span(), one_of(line.is_some()))),
    }
}
