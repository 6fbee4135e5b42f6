//! Material of a body: `young` and `poisson`, `orthotropic`, `stiffness` or `compliance`.

use super::range::{RawNumber, ends, no_range};
use crate::elasticity::{Anisotropic, Elasticity, Initial, Matrix, MatrixKind, Orthotropic};
use crate::scene::Kinematics;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, Pair, RawBody, RawExpansion, RawOrthotropic, RawTemperature, Table};
use crate::scene::reading::source::Source;

/// Numbers of an orthotropic table.
const THREE: &str = "write three numbers, for axes 1, 2 and 3, which is out of the plane";
/// Rows of a matrix.
const ROWS: &str = "write six rows of six numbers in the order 11, 22, 33, 23, 13, 12, or in plane stress three rows of three for 11, 22, 12";

/// The material of the body whose table is `label`; `whole` is the place of the table.
pub(in crate::scene) fn elasticity(
    raw: &RawBody,
    label: &str,
    whole: std::ops::Range<usize>,
    kinematics: Kinematics,
    source: &Source,
) -> Result<Elasticity, SceneError> {
    let laws = [
        raw.orthotropic.as_ref().map(|law| ("orthotropic", law.span())),
        raw.stiffness.as_ref().map(|law| ("stiffness", law.span())),
        raw.compliance.as_ref().map(|law| ("compliance", law.span())),
        raw.young.as_ref().map(|law| ("young", law.span())),
        raw.poisson.as_ref().map(|law| ("poisson", law.span())),
    ];
    let mut given = laws.into_iter().flatten();
    let first = given.next();
    if let (Some((first, _)), Some((key, span))) = (&first, given.next())
        && *first != "young"
    {
        let other = match *first {
            "orthotropic" => "`orthotropic`",
            "stiffness" => "`stiffness`",
            _ => "`compliance`",
        };
        let remedy =
            "a body has one material: keep `young` and `poisson`, or `orthotropic`, or `stiffness`, or `compliance`";
        return Err(source.error(span, Fault::Misplaced { key, table: label.to_owned(), other, remedy }));
    }
    let law = match (&raw.orthotropic, &raw.stiffness, &raw.compliance) {
        (Some(law), _, _) => orthotropic(law, label, source)?,
        (_, Some(rows), _) => matrix(MatrixKind::Stiffness, rows, label, source)?,
        (_, _, Some(rows)) => matrix(MatrixKind::Compliance, rows, label, source)?,
        _ => {
            if let Some(angle) = &raw.angle {
                let remedy = "delete `angle`: an isotropic body is the same in all directions";
                let other = "`young` and `poisson`";
                let fault = Fault::Misplaced { key: "angle", table: label.to_owned(), other, remedy };
                return Err(source.error(angle.span(), fault));
            }
            return isotropic(raw, label, whole, source);
        }
    };
    let law = match (&raw.angle, law) {
        (Some(angle), Elasticity::Orthotropic(_)) => {
            let other = "`orthotropic`, whose table has an `angle` of its own";
            let remedy = "write it inside: orthotropic = { …, angle = 30.0 }";
            let fault = Fault::Misplaced { key: "angle", table: label.to_owned(), other, remedy };
            return Err(source.error(angle.span(), fault));
        }
        (Some(angle), law) => law.turned(source.number(angle, (label, "angle"), |_| true, ANGLE)?),
        (None, law) => law,
    };
    let span = first.map_or(whole, |(_, span)| span);
    if law.is_plane_stress_only() && kinematics != Kinematics::PlaneStress {
        let (key, found) = (if raw.stiffness.is_some() { "stiffness" } else { "compliance" }, "three rows".to_owned());
        let fault =
            Fault::Count { key: key.into(), table: label.to_owned(), found, expected: "6".into(), remedy: ROWS };
        return Err(source.error(span, fault));
    }
    if let Some(flaw) = law.flaw() {
        let (found, table) = (flaw.found.to_string(), label.to_owned());
        let fault = Fault::Number { key: flaw.key, table, found, rule: flaw.rule, remedy: flaw.remedy };
        return Err(source.error(span, fault));
    }
    Ok(law)
}

const ANGLE: (&str, &str) = ("an angle is a number of degrees", "write degrees from x to axis 1, anticlockwise");

fn isotropic(
    raw: &RawBody,
    label: &str,
    whole: std::ops::Range<usize>,
    source: &Source,
) -> Result<Elasticity, SceneError> {
    let missing = |key: &str| {
        let remedy = match key {
            "young" => {
                "add Young's modulus, for instance young = 2.1e11; or `orthotropic`, `stiffness` or `compliance` in its place"
            }
            _ => "add Poisson's ratio, for instance poisson = 0.3",
        };
        source
            .error(whole.clone(), Fault::MissingKey { key: key.into(), table: label.to_owned(), remedy: remedy.into() })
    };
    let young = raw.young.as_ref().ok_or_else(|| missing("young"))?;
    let words = ("Young's modulus must be positive", "write a positive number, in units of stress");
    let (low, high) = ends(young, (label, "young"), source)?;
    high.map(|high| source.positive(&high, (label, "young"), words)).transpose()?;
    // Of a range the end of the lowest energy.
    let young = source.positive(&low, (label, "young"), words)?;
    let poisson = raw.poisson.as_ref().ok_or_else(|| missing("poisson"))?;
    let poisson = no_range(poisson, (label, "poisson"), source)?;
    let words = poisson_words(poisson.value);
    let poisson = source.number(&poisson, (label, "poisson"), |nu| -1.0 < nu && nu < 0.5, words)?;
    Ok(Elasticity::Isotropic { young, poisson })
}

/// Initial state, without load, of the body whose table is `label`.
pub(in crate::scene) fn initial(
    raw: &RawBody,
    label: &str,
    law: &Elasticity,
    kinematics: Kinematics,
    source: &Source,
) -> Result<Initial, SceneError> {
    let mut initial = Initial::default();
    let list = |values: Vec<f64>, start: usize, end: usize| At { value: values, start, end };
    if let Some(At { value, start, end }) = &raw.expansion {
        initial.expansion = match value {
            RawExpansion::Isotropic(alpha) => {
                source.vector(&list(vec![*alpha; 3], *start, *end), (label, "expansion"))?
            }
            RawExpansion::Axes(along) => three(&list(along.clone(), *start, *end), label, "expansion", source)?,
        };
    }
    if let Some(At { value, start, end }) = &raw.temperature {
        let (at, gradient) = match value {
            RawTemperature::Constant(value) => (*value, vec![0.0; 2]),
            RawTemperature::Affine(affine) => (affine.value, affine.gradient.clone()),
        };
        let any = ("a temperature is a number", "write degrees above the temperature without stress");
        initial.temperature =
            source.number(&At { value: at, start: *start, end: *end }, (label, "temperature"), |_| true, any)?;
        initial.gradient = source.vector(&list(gradient, *start, *end), (label, "temperature.gradient"))?;
        if raw.expansion.is_none() {
            let remedy = "add expansion = 1.2e-5, the strain for a degree, or delete `temperature`".to_owned();
            let fault = Fault::MissingKey { key: "expansion".into(), table: label.to_owned(), remedy };
            return Err(source.error(*start..*end, fault));
        }
    }
    if let Some(stress) = &raw.initial_stress {
        let mut padded = At { value: stress.value.clone(), start: stress.start, end: stress.end };
        if padded.value.len() == 3 {
            padded.value.push(0.0);
        }
        if padded.value.len() != 4 {
            let found = crate::scene::counted(stress.value.len(), "number");
            let (key, table) = ("initial_stress".to_owned(), label.to_owned());
            let remedy = match kinematics {
                Kinematics::Axisymmetric => "write rr, zz, rz, and the hoop stress tt where there is one",
                _ => "write xx, yy, xy, and where it is needed the stress out of the plane",
            };
            let fault = Fault::Count { key, table, found, expected: "3 or 4".into(), remedy };
            return Err(source.error(stress.span(), fault));
        }
        initial.stress = source.vector(&padded, (label, "initial_stress"))?;
        if initial.stress[3] != 0.0 && law.is_plane_stress_only() {
            let found = source.written(stress.span());
            let rule = "a matrix of three rows does not say what a stress out of the plane does";
            let remedy = "write three numbers, or a matrix of six rows";
            let (key, table) = ("initial_stress".to_owned(), label.to_owned());
            return Err(source.error(stress.span(), Fault::Number { key, table, found, rule, remedy }));
        }
    }
    if let Some(young) = raw.young.as_ref().filter(|_| initial.stress != [0.0; 4])
        && matches!(young.value, RawNumber::Range(_))
    {
        let rule =
            "with an `initial_stress` the energy neither grows nor falls with the modulus: the ends enclose nothing";
        let remedy = "write one number, or leave `initial_stress` out";
        let (key, table, found) = ("young".to_owned(), label.to_owned(), source.written(young.span()));
        return Err(source.error(young.span(), Fault::Number { key, table, found, rule, remedy }));
    }
    let strain = match kinematics {
        Kinematics::Axisymmetric => law.initial_strain_around(&initial),
        Kinematics::PlaneStrain | Kinematics::PlaneStress => {
            law.initial_strain(kinematics == Kinematics::PlaneStrain, &initial)
        }
    };
    let around = strain.hoop_gradient.iter().chain([&strain.hoop]);
    let numbers = strain.value.iter().chain(strain.gradient.as_flattened()).chain(around);
    if numbers.copied().any(|e| !e.is_finite()) {
        let (rule, remedy) = ("the initial strain overflows", "choose units in which the numbers are ordinary ones");
        let (key, table, found) = ("expansion".to_owned(), label.to_owned(), "too large".to_owned());
        return Err(source.error(0..0, Fault::Number { key, table, found, rule, remedy }));
    }
    Ok(initial)
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

/// Three finite numbers.
fn three(list: &Pair, label: &str, key: &str, source: &Source) -> Result<[f64; 3], SceneError> {
    if list.value.len() != 3 {
        let found = crate::scene::counted(list.value.len(), "number");
        let (key, table) = (key.to_owned(), label.to_owned());
        let fault = Fault::Count { key, table, found, expected: "3".into(), remedy: THREE };
        return Err(source.error(list.span(), fault));
    }
    source.vector(list, (label, key))
}

fn orthotropic(law: &At<Table<RawOrthotropic>>, label: &str, source: &Source) -> Result<Elasticity, SceneError> {
    let Table(raw) = &law.value;
    let young = three(&raw.young, label, "orthotropic.young", source)?;
    let poisson = three(&raw.poisson, label, "orthotropic.poisson", source)?;
    let any = ("a modulus is a number", "write a positive number, in units of stress");
    let shear = source.number(&raw.shear, (label, "orthotropic.shear"), |_| true, any)?;
    for modulus in young.into_iter().chain([shear]).filter(|modulus| *modulus > 0.0) {
        let number = At { value: modulus, start: law.start, end: law.end };
        source.positive(&number, (label, "orthotropic"), any)?;
    }
    let angle = match &raw.angle {
        Some(angle) => source.number(angle, (label, "orthotropic.angle"), |_| true, ANGLE)?,
        None => 0.0,
    };
    Ok(Elasticity::Orthotropic(Orthotropic { young, poisson, shear, angle }))
}

fn matrix(kind: MatrixKind, rows: &At<Vec<Pair>>, label: &str, source: &Source) -> Result<Elasticity, SceneError> {
    let count = |span: std::ops::Range<usize>, n: usize, noun: &str, expected: &str| {
        let (key, table, found) = (kind.key().to_owned(), label.to_owned(), crate::scene::counted(n, noun));
        source.error(span, Fault::Count { key, table, found, expected: expected.into(), remedy: ROWS })
    };
    fn read<const N: usize>(
        rows: &[Pair],
        place: (&str, &str),
        source: &Source,
        fault: &dyn Fn(&Pair) -> SceneError,
    ) -> Result<[[f64; N]; N], SceneError> {
        let mut out = [[0.0; N]; N];
        for (out, row) in out.iter_mut().zip(rows) {
            if row.value.len() != N {
                return Err(fault(row));
            }
            *out = source.vector(row, place)?;
        }
        Ok(out)
    }
    let n = rows.value.len();
    let fault = |row: &Pair| count(row.span(), row.value.len(), "number", &format!("{n} in each row"));
    let matrix = match n {
        3 => Matrix::Three(read(&rows.value, (label, kind.key()), source, &fault)?),
        6 => Matrix::Six(read(&rows.value, (label, kind.key()), source, &fault)?),
        _ => return Err(count(rows.span(), n, "row", "6 (or 3 in plane stress)")),
    };
    Ok(Elasticity::Anisotropic(Anisotropic { kind, matrix, angle: 0.0 }))
}
