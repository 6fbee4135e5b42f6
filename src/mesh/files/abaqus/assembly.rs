//! Instances of parts: their places, and their numbers beside those of others.

use std::collections::HashSet;

use super::keyword::{Keyword, Place};
use super::remarks::Remarks;
use super::resolve::{Resolved, resolve};
use super::scope::{Mesh, Scope};
use crate::mesh::MeshError;

/// A part in its place.
pub(super) struct Instance {
    pub name: String,
    pub part: String,
    pub scope: Scope,
    pub place: Place,
}

/// Where an instance lies: shifted first, then turned about an axis.
pub(super) struct Position {
    shift: Vec<f64>,
    /// Two points of the axis, and the angle in degrees.
    turn: Vec<f64>,
}

impl Position {
    /// Reads the data lines of `*INSTANCE`.
    ///
    /// # Errors
    /// A rotation out of the plane.
    pub fn read(keyword: &Keyword) -> Result<Position, MeshError> {
        let row = |i: usize| -> Result<Vec<f64>, MeshError> {
            let Some(line) = keyword.lines.get(i) else { return Ok(Vec::new()) };
            (0..line.fields.len()).map(|k| line.number(k)).collect()
        };
        let (shift, turn) = (row(0)?, row(1)?);
        if let [ax, ay, az, bx, by, bz, angle] = *turn.as_slice()
            && angle != 0.0
            && (bx - ax).hypot(by - ay) >= 1e-9 * (bz - az).abs()
        {
            let what = "the instance is turned about an axis that is not that of z";
            return Err(keyword.fault(what, "this program is plane: turn it in its plane"));
        }
        Ok(Position { shift, turn })
    }

    pub fn apply(&self, mesh: &mut Mesh) {
        for point in mesh.nodes.values_mut() {
            for (x, by) in point.iter_mut().zip(&self.shift) {
                *x += by;
            }
            if let [ax, ay, az, _, _, bz, angle] = *self.turn.as_slice() {
                let (sin, cos) = (angle.to_radians() * (bz - az).signum()).sin_cos();
                let (dx, dy) = (point[0] - ax, point[1] - ay);
                (point[0], point[1]) = (ax + cos * dx - sin * dy, ay + sin * dx + cos * dy);
            }
        }
    }
}

/// Numbers that are given to nodes and elements.
#[derive(Default)]
struct Taken {
    nodes: HashSet<u64>,
    elements: HashSet<u64>,
    highest: u64,
}

impl Taken {
    /// The mesh of `scope`, its numbers above all others where one of them is taken.
    fn give(&mut self, mut scope: Scope, place: Option<&Place>) -> Result<Scope, MeshError> {
        let mesh = std::mem::take(&mut scope.mesh);
        let clash = mesh.nodes.keys().any(|tag| self.nodes.contains(tag)) || !self.elements.is_disjoint(&mesh.elements);
        let by = if clash { self.highest } else { 0 };
        if let (None, Some(place)) =
            (mesh.highest().checked_add(by), place.or(mesh.cells.first().map(|cell| &cell.place)))
        {
            let what = format!("the number {} is too large beside those of other instances", mesh.highest());
            return Err(place.fault(what, "renumber nodes and elements"));
        }
        scope.mesh = mesh.above(by);
        self.nodes.extend(scope.mesh.nodes.keys());
        self.elements.extend(&scope.mesh.elements);
        self.highest = self.highest.max(scope.mesh.highest());
        Ok(scope)
    }
}

/// All instances, and behind them what stands outside all parts, with numbers that only one of them has.
///
/// # Errors
/// A member of a set or a surface that is not there.
pub(super) fn assembled(
    instances: Vec<Instance>,
    assembly: Scope,
    name: &str,
    remarks: &mut Remarks,
) -> Result<Vec<Resolved>, MeshError> {
    let (mut taken, mut all) = (Taken::default(), Vec::new());
    for Instance { name, part, scope, place } in instances {
        let scope = taken.give(scope, Some(&place))?;
        all.push(Resolved { name, part, ..resolve(scope, &[], "", remarks)? });
    }
    let scope = taken.give(assembly, None)?;
    let whole = resolve(scope, &all, name, remarks)?;
    all.push(whole);
    Ok(all)
}
