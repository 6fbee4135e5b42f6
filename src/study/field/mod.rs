//! A displacement field from a file: read, and brought onto the mesh of a scene.

mod cells;
mod content;
mod curved;
mod digits;
mod displaced;
mod matching;
mod places;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::compare::Candidate;
use crate::problem::{Note, Problem};

/// A displacement file that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("displacement file {}: {what}; {remedy}", .file.display())]
pub struct FieldError {
    /// The file.
    pub file: PathBuf,
    /// The fault, with the point or triangle it concerns.
    pub what: String,
    /// The remedy.
    pub remedy: String,
}

/// A displacement on cells of its own: whatever program it comes from, nothing about it is taken on trust.
#[derive(Debug, Clone, PartialEq)]
pub struct ForeignField {
    file: PathBuf,
    sha256: String,
    /// Coordinates of every point.
    points: Vec<[f64; 2]>,
    /// Of every file its name and its first point and cell.
    files: Vec<(String, [usize; 2])>,
    /// Point indices of each cell, three or six of a triangle, four, eight or nine of a quadrilateral: corners, then the middles of
    /// (0, 1), (1, 2), …, then the centre.
    cells: Vec<Vec<usize>>,
    /// Triangles, and quadrilaterals cut along a diagonal.
    triangles: Vec<Part>,
    /// Displacement of every point; `None` where the file has no finite number.
    values: Vec<Option<[f64; 2]>>,
    /// True if the displacement is stored in single precision.
    single: bool,
    /// Rounding of the displacements relative to their size: that of the digits the file keeps.
    precision: f64,
    /// The largest coordinate of the file, which says how far single precision can be off.
    far: f64,
}

/// A triangle of a file, or a part of a quadrilateral.
#[derive(Debug, Clone, PartialEq)]
struct Part {
    /// The cell.
    cell: usize,
    /// Its nodes: of a triangle all of them, of a part of a quadrilateral its corners.
    nodes: Vec<usize>,
}

/// A displacement as a program hands it over.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FieldArrays {
    /// Two or three coordinates of every point.
    pub points: Vec<Vec<f64>>,
    /// Point indices of each cell, three or six of a triangle, four, eight or nine of a quadrilateral: corners, then the middles of
    /// (0, 1), (1, 2), …, then the centre.
    pub triangles: Vec<Vec<usize>>,
    /// Two or three components of the displacement of every point.
    pub displacement: Vec<Vec<f64>>,
    /// True if the displacement was kept in single precision.
    pub single: bool,
}

impl ForeignField {
    /// This field and that of another file, which has other bodies of the scene.
    pub fn and(mut self, other: ForeignField) -> Self {
        let first = [self.points.len(), self.cells.len()];
        let after = |nodes: Vec<usize>| nodes.iter().map(|n| n + first[0]).collect();
        self.files.extend(other.files.into_iter().map(|(name, at)| (name, [at[0] + first[0], at[1] + first[1]])));
        let triangles = other.triangles.into_iter();
        self.triangles.extend(triangles.map(|part| Part { cell: part.cell + first[1], nodes: after(part.nodes) }));
        self.cells.extend(other.cells.into_iter().map(after));
        self.points.extend(other.points);
        self.values.extend(other.values);
        self.single |= other.single;
        self.precision = self.precision.max(other.precision);
        self.far = self.far.max(other.far);
        self.sha256 = format!("{} {}", self.sha256, other.sha256);
        self
    }

    /// This field with coordinates counted from `origin`; `None` where they already are.
    fn about(&self, origin: [f64; 2]) -> Option<Self> {
        let points = || self.points.iter().map(|p| [p[0] - origin[0], p[1] - origin[1]]).collect();
        (origin != [0.0; 2]).then(|| ForeignField { points: points(), ..self.clone() })
    }

    /// The names of the files, by which reports and checks call the field.
    pub fn name(&self) -> String {
        self.files.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(" + ")
    }

    /// True if a file is a result of CalculiX.
    pub fn is_of_calculix(&self) -> bool {
        self.files.iter().any(|(name, _)| ["frd", "dat"].contains(&digits::ending(Path::new(name)).as_str()))
    }

    /// SHA-256 of the file.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// True if the file keeps only seven digits of the displacement, so that supports and contact can be met to seven digits at best.
    pub fn is_single_precision(&self) -> bool {
        self.single
    }

    /// The field on the mesh of `problem`, which must be the mesh of the field: the same triangles in any numbering and
    /// orientation.
    ///
    /// # Errors
    /// [`FieldError`] names the first triangle or point that does not fit.
    pub fn candidate(&self, problem: &Problem, seconds: f64) -> Result<Candidate, FieldError> {
        Ok(self.matched(problem, seconds)?.0)
    }

    /// As [`Self::candidate`], with remarks where points of the file are only nearly vertices of the mesh, or fewer than these.
    ///
    /// # Errors
    /// As [`Self::candidate`].
    pub fn matched(&self, problem: &Problem, seconds: f64) -> Result<(Candidate, Vec<Note>), FieldError> {
        let (matched, displaced) = displaced::onto(self, problem)?;
        let note = |text: String| Note { weakens_guarantee: false, text };
        let mut notes: Vec<Note> = displaced.into_iter().collect();
        if matched.inserted > 0 {
            notes.push(note(format!(
                "{} vertices of the scene's mesh, put into its edges where contacts and gaps ask for them, are no points of {}: its \
                 polynomials on the triangles of the file were taken over as they are.",
                matched.inserted,
                self.name()
            )));
        }
        notes.extend(matched.off.map(|off| {
            note(format!(
                "The coordinates of {} are up to {:.1e} of the largest coordinate away from the vertices of the scene's mesh, as if \
                 rounded when they were written. The displacements were taken for those of the vertices.",
                self.name(),
                off / self.far
            ))
        }));
        notes.extend(matched.curved.map(|curved| curved.told(&self.name())));
        let nodes = match &matched.higher {
            None => matched.vertex.len() + if matched.degree == 2 { matched.middle.len() } else { 0 },
            Some(_) => matched.numbering.nodes.iter().flatten().count(),
        };
        let candidate = Candidate {
            name: self.name(),
            solver: "displacement file".into(),
            version: String::new(),
            degree: matched.degree,
            vertex: matched.vertex,
            middle: matched.middle,
            higher: matched.higher,
            cells: matched.cells,
            on_quadrilaterals: None,
            reported: None,
            reported_strain: None,
            is_solution: false,
            reactions: None,
            iterations: None,
            unknowns: Some(2 * nodes),
            seconds: BTreeMap::from([("total".to_string(), seconds)]),
            precision: self.precision,
            numbering: Some(matched.numbering),
        };
        Ok((candidate, notes))
    }

    fn fault(&self, what: String, remedy: impl Into<String>) -> FieldError {
        FieldError { file: self.file.clone(), what, remedy: remedy.into() }
    }
}
