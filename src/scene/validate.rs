//! TOML types → [`Scene`]: everything that can be judged without a mesh.

use std::ops::Range;
use std::path::Path;

use super::conditions::{Conditions, conditions};
use super::error::{Fault, SceneError};
use super::quantity::quantities;
use super::raw::{At, RawModel, RawScene, Table};
use super::{Body, Draft, Kinematics, MeshSource, Scene, geometry};

/// The text under examination; makes errors that point into it.
pub(super) struct Source<'a> {
    pub text: &'a str,
    pub path: &'a Path,
}

impl Source<'_> {
    pub fn error(&self, span: Range<usize>, fault: Fault) -> SceneError {
        SceneError::at(self.path, self.text, span, fault)
    }

    /// The value as the user wrote it, cut if long.
    pub fn written(&self, span: Range<usize>) -> String {
        let text = self.text.get(span).unwrap_or_default().trim();
        if text.chars().count() > 40 { text.chars().take(39).chain(['…']).collect() } else { text.to_owned() }
    }

    /// The line of a byte, from 1.
    pub fn line(&self, at: usize) -> usize {
        self.text.bytes().take(at).filter(|&b| b == b'\n').count() + 1
    }

    /// `number`, if it is finite and `holds`; the error says that `rule` does not hold.
    pub fn number(
        &self,
        number: &At<f64>,
        (table, key): (&str, &str),
        holds: impl Fn(f64) -> bool,
        (rule, remedy): (&'static str, &'static str),
    ) -> Result<f64, SceneError> {
        let value = number.value;
        let (rule, remedy) = match () {
            _ if !value.is_finite() => NOT_FINITE,
            _ if value.abs() > LARGEST => OVERFLOWS,
            _ if !holds(value) => (rule, remedy),
            _ => return Ok(value),
        };
        let (table, key, found) = (table.to_owned(), key.to_owned(), self.written(number.span()));
        Err(self.error(number.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// `number`, if it is positive and its reciprocal is no larger than numbers may be.
    pub fn positive(
        &self,
        number: &At<f64>,
        key: (&str, &str),
        words: (&'static str, &'static str),
    ) -> Result<f64, SceneError> {
        let value = self.number(number, key, |x| x > 0.0, words)?;
        self.number(number, key, |_| value >= 1.0 / LARGEST, UNDERFLOWS)
    }

    /// `N` finite numbers whose energies do not overflow.
    pub fn vector<const N: usize>(&self, list: &At<Vec<f64>>, place: (&str, &str)) -> Result<[f64; N], SceneError> {
        let vector = self.point(list, place)?;
        if vector.iter().all(|x| x.abs() <= LARGEST) {
            return Ok(vector);
        }
        let ((table, key), (rule, remedy)) = (place, OVERFLOWS);
        let (table, key, found) = (table.to_owned(), key.to_owned(), self.written(list.span()));
        Err(self.error(list.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// `N` finite numbers.
    pub fn point<const N: usize>(
        &self,
        list: &At<Vec<f64>>,
        (table, key): (&str, &str),
    ) -> Result<[f64; N], SceneError> {
        let (table, key) = (table.to_owned(), key.to_owned());
        let Ok(vector) = <[f64; N]>::try_from(list.value.as_slice()) else {
            let found = counted(list.value.len(), "component");
            let remedy = "write one number per direction, [x, y]; in a gap table, [s, g]";
            return Err(self.error(list.span(), Fault::Count { key, table, found, expected: N.to_string(), remedy }));
        };
        if vector.iter().all(|x| x.is_finite()) {
            return Ok(vector);
        }
        let (rule, remedy) = NOT_FINITE;
        let found = self.written(list.span());
        Err(self.error(list.span(), Fault::Number { key, table, found, rule, remedy }))
    }

    /// The unit vector along a direction of any length but zero.
    pub fn unit(&self, list: &At<Vec<f64>>, place: (&str, &str), remedy: &'static str) -> Result<[f64; 2], SceneError> {
        let vector = self.vector::<2>(list, place)?;
        let length = vector[0].hypot(vector[1]);
        let number = At { value: length, start: list.start, end: list.end };
        self.number(&number, place, |length| length > 0.0, ("a direction has a length", remedy))?;
        self.number(&number, place, |length| length >= 1.0 / LARGEST, UNDERFLOWS)?;
        Ok(vector.map(|x| x / length))
    }

    /// A non-empty name.
    pub fn name(
        &self,
        name: &At<String>,
        (table, key): (&str, &str),
        remedy: &'static str,
    ) -> Result<String, SceneError> {
        if name.value.trim().is_empty() {
            let (table, key) = (table.to_owned(), key.to_owned());
            return Err(self.error(name.span(), Fault::EmptyName { key, table, remedy }));
        }
        Ok(name.value.clone())
    }
}

/// Largest number in a scene: the square of a load, over a modulus, times an area and a thickness of such sizes is still
/// a number.
const LARGEST: f64 = 1e30;
const OVERFLOWS: (&str, &str) =
    ("energies of numbers beyond 1e30 overflow", "choose units in which the numbers are ordinary ones");
const UNDERFLOWS: (&str, &str) =
    ("energies overflow where this is below 1e-30", "choose units in which the numbers are ordinary ones");

const NOT_FINITE: (&str, &str) = ("every number must be finite", "write a finite number");

/// `1 point`, `3 points`.
pub(super) fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// Checks the whole scene; the first fault found is the error.
pub(super) fn validate(raw: RawScene, text: &str, path: &Path) -> Result<Scene, SceneError> {
    let source = Source { text, path };
    let name = scene_name(path);
    let (kinematics, thickness) = model(&raw.model, &source)?;
    let bodies = bodies(&raw, &source)?;
    let mesh = mesh(&raw, &bodies, &source)?;
    let conditions = conditions(&raw, &mesh, &source)?;
    let quantities = quantities(&raw, &mesh, &bodies, &conditions, &source)?;
    let Conditions { supports, tractions, contacts } = conditions;
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
        supports,
        tractions,
        contacts,
        quantities,
    }))
}

/// The stem of the file, where it can be the name of a folder: `...toml` has the stem `..`.
pub(crate) fn scene_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    if stem.trim_matches('.').is_empty() { "scene".to_owned() } else { stem }
}

fn model(raw: &At<Table<RawModel>>, source: &Source) -> Result<(Kinematics, f64), SceneError> {
    let table = "[model]";
    let Table(model) = &raw.value;
    let Some(kinematics) = Kinematics::named(&model.kinematics.value) else {
        let known = [Kinematics::PlaneStrain, Kinematics::PlaneStress].map(|k| k.name().to_owned()).to_vec();
        let found = model.kinematics.value.clone();
        let fault = Fault::UnknownWord { key: "kinematics", table: table.into(), found, known };
        return Err(source.error(model.kinematics.span(), fault));
    };
    let thickness = match &model.thickness {
        None => 1.0,
        Some(number) => {
            let words = ("a thickness must be positive", "write a positive number, or leave `thickness` out for 1");
            source.positive(number, (table, "thickness"), words)?
        }
    };
    Ok((kinematics, thickness))
}

fn bodies(raw: &RawScene, source: &Source) -> Result<Vec<Body>, SceneError> {
    if raw.bodies.is_empty() {
        return Err(source.error(0..0, Fault::NoBodies));
    }
    let mut bodies: Vec<_> = raw.bodies.iter().collect();
    bodies.sort_by_key(|(name, _)| name.start);
    let body = |(name, table): (&At<String>, &At<Table<super::raw::RawBody>>)| {
        let Table(raw) = &table.value;
        let label = format!("[bodies.{}]", name.value);
        let name =
            source.name(name, ("the scene", "bodies"), "give the body the name that the mesh or a polygon uses")?;
        let words = ("Young's modulus must be positive", "write a positive number, in units of stress");
        let young = source.positive(&raw.young, (&label, "young"), words)?;
        let words = poisson_words(raw.poisson.value);
        let poisson = source.number(&raw.poisson, (&label, "poisson"), |nu| -1.0 < nu && nu < 0.5, words)?;
        let body_force = match &raw.body_force {
            None => [0.0; 2],
            Some(force) => source.vector(force, (&label, "body_force"))?,
        };
        Ok(Body { name, young, poisson, body_force })
    };
    bodies.into_iter().map(body).collect()
}

/// Why a Poisson's ratio outside (−1, ½) is none.
fn poisson_words(nu: f64) -> (&'static str, &'static str) {
    if nu == 0.5 {
        ("ν must lie in (−1, 0.5): at 0.5 the body is incompressible", "write a value below 0.5, for instance 0.4999")
    } else if nu > 0.5 {
        (
            "ν must lie in (−1, 0.5): beyond the incompressible limit 0.5 the strain energy is not positive",
            "write a value below 0.5, for instance 0.3",
        )
    } else {
        (
            "ν must lie in (−1, 0.5): at −1 and below the strain energy is not positive",
            "write a value above −1, for instance 0.3",
        )
    }
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
        (Some(mesh), None) => {
            let Table(raw) = &mesh.value;
            let file = source.name(&raw.file, ("[mesh]", "file"), "name the mesh file, relative to the scene")?;
            Ok(MeshSource::File(source.path.parent().unwrap_or(Path::new("")).join(file)))
        }
        (None, Some(geometry)) => geometry::geometry(geometry, raw, bodies, source),
    }
}
