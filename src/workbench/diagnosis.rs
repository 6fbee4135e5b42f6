//! Which mistake explains a stiffness matrix.
//!
//! With R the matrix of the isoparametric element of the same nodes, every mistake of the list makes a matrix M, and what it explains
//! of K − R is 1 − |K − M|² / |K − R|². The simplest one that explains all but rounding is named.

mod points;
mod slopes;
mod whole;

use nalgebra::{DMatrix, Matrix3};
use schemars::JsonSchema;
use serde::Serialize;

use super::displacement::{DisplacementElement, Order};
use super::formulas::{Family, Point, Variant};
use crate::report::number::{percent, significant};

/// Of |K − R|², what an explanation may leave.
const LEFT: f64 = 1e-8;
/// Part of the difference below which the nearest mistake is not named.
const WORTH_NAMING: f64 = 0.5;
/// The cause where none is found.
const UNEXPLAINED: &str = "unexplained";
/// Of all entries, how many may be wrong for them to be listed.
const FEW: usize = 4;

/// What is wrong with a matrix.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// Stable name of the mistake; `unexplained` where none is found.
    pub cause: String,
    /// Part of the squared difference from the reference that it explains.
    pub explained: f64,
    /// In words.
    pub sentence: String,
}

/// The matrix of the isoparametric element of the same nodes and material, numbered as the element is.
pub struct Reference {
    family: Family,
    rule: Variant,
    matrix: DMatrix<f64>,
    /// Node i of the family is node `order[i]` of the element.
    order: Vec<usize>,
    nodes: Vec<[f64; 2]>,
    /// Hooke's law times thickness.
    hooke: Matrix3<f64>,
}

impl Reference {
    /// The reference for an element. Where its material is not known it is the one that constant strains show. More points of
    /// quadrature are another matrix on a distorted quadrilateral, and no mistake: of 2 × 2 to 5 × 5 the first that gives K, or 2 × 2.
    ///
    /// # Errors
    /// Why there is none.
    pub fn of(e: &DisplacementElement) -> Result<Self, String> {
        let mut all = Self::all(e)?;
        let same = all.iter().position(|r| r.off(&e.matrix) <= e.precision).unwrap_or(0);
        Ok(all.swap_remove(same))
    }

    /// The references for an element, one for each rule of quadrature that is right; never none.
    fn all(e: &DisplacementElement) -> Result<Vec<Self>, String> {
        let none = || format!("no element of the textbooks has {} nodes that lie like these", e.nodes.len());
        let (family, order) = Family::of(&e.outline, &e.nodes).ok_or_else(none)?;
        let hooke = match e.material {
            Some(m) => m.hooke() * m.thickness,
            None => super::displacement::hooke_seen(&e.matrix, &e.nodes, &e.outline),
        };
        let nodes: Vec<[f64; 2]> = order.iter().map(|&n| e.nodes[n]).collect();
        let finer = if family == Family::Q4 { 3..6 } else { 0..0 };
        let of = |rule| {
            let (order, nodes) = (order.clone(), nodes.clone());
            let mut reference = Reference { family, rule, matrix: DMatrix::zeros(0, 0), order, nodes, hooke };
            reference.matrix = reference.variant(&hooke, Variant::Right)?;
            Ok(reference)
        };
        std::iter::once(Variant::Right).chain(finer.map(Variant::Points)).map(of).collect()
    }

    /// What it is called, with the points of its quadrature where they are others than usual.
    pub fn words(&self) -> String {
        match self.rule {
            Variant::Points(n) => format!("{} with {n} × {n} points", self.family.words()),
            _ => self.family.words().into(),
        }
    }

    /// How far a matrix is from it, relative to the largest entry.
    pub fn off(&self, k: &DMatrix<f64>) -> f64 {
        (k - &self.matrix).amax() / self.matrix.amax().max(f64::MIN_POSITIVE)
    }

    fn variant(&self, hooke: &Matrix3<f64>, variant: Variant) -> Result<DMatrix<f64>, String> {
        let variant = if variant == Variant::Right { self.rule } else { variant };
        Ok(self.placed(&self.family.stiffness(&self.nodes, hooke, 1.0, variant)?))
    }

    /// The quadrature points of the reference, of a quadrilateral alone where there are several; `None` for other shapes.
    fn points(&self) -> Option<Vec<Point>> {
        (self.family == Family::Q4).then(|| self.family.points(&self.nodes, self.rule).ok()).flatten()
    }

    /// A matrix of the family, numbered as the element is.
    fn placed(&self, own: &DMatrix<f64>) -> DMatrix<f64> {
        let mut at = vec![0; self.order.len()];
        self.order.iter().enumerate().for_each(|(i, &n)| at[n] = i);
        let place = |i: usize| 2 * at[i / 2] + i % 2;
        DMatrix::from_fn(own.nrows(), own.ncols(), |i, j| own[(place(i), place(j))])
    }
}

/// A mistake after it was made.
struct Trial {
    /// The simpler the smaller.
    rank: usize,
    cause: &'static str,
    sentence: String,
    matrix: DMatrix<f64>,
}

/// What explains that K is not that of the reference; `None` where it is, or where there is none.
pub fn diagnose(e: &DisplacementElement) -> Option<Diagnosis> {
    let all = Reference::all(e).ok()?;
    if all.iter().any(|r| r.off(&e.matrix) <= e.precision) {
        return None;
    }
    let mut found = all.iter().filter_map(|r| explanation(e, r));
    let first = found.next()?;
    if first.cause != UNEXPLAINED {
        return Some(first);
    }
    Some(found.find(|d| d.cause != UNEXPLAINED).unwrap_or(first))
}

/// The simplest mistake that explains the difference from one reference, or the nearest.
fn explanation(e: &DisplacementElement, reference: &Reference) -> Option<Diagnosis> {
    let (k, right) = (&e.matrix, &reference.matrix);
    let mut trials = materials(e, reference);
    trials.extend(variants(reference));
    trials.extend(numberings(e, right));
    trials.extend(slopes::trials(reference));
    trials.extend(whole::trials(reference));
    trials.extend(points::trials(k, reference));
    let scaled: Vec<Trial> = trials.iter().filter_map(|t| with_factor(k, t)).collect();
    trials.extend(scaled);
    trials.extend(fitted_hooke(k, reference));
    trials.extend(entries(e, right));
    let whole = (k - right).norm_squared();
    // What the digits of K leave is explained by nothing.
    let digits = (e.precision * right.amax()).powi(2) * k.len() as f64;
    let left = |t: &Trial| (k - &t.matrix).norm_squared() / whole;
    let enough = LEFT.max(digits / whole);
    if let Some(best) = trials.iter().filter(|t| left(t) <= enough).min_by_key(|t| t.rank) {
        let explained = 1.0 - left(best);
        let sentence = format!("The difference is explained to {} by this: {}.", percent(explained), best.sentence);
        return Some(Diagnosis { cause: best.cause.into(), explained, sentence });
    }
    let nearest = trials.iter().min_by(|a, b| left(a).total_cmp(&left(b)))?;
    let explained = (1.0 - left(nearest)).max(0.0);
    if explained < WORTH_NAMING {
        let sentence = format!("None of {} mistakes explains the difference.", trials.len());
        return Some(Diagnosis { cause: UNEXPLAINED.into(), explained, sentence });
    }
    let sentence = format!(
        "None of {} mistakes explains the difference; nearest, to {}, comes this one: {}.",
        trials.len(),
        percent(explained),
        nearest.sentence
    );
    Some(Diagnosis { cause: UNEXPLAINED.into(), explained, sentence })
}

/// Sign, factor, plane state, shear.
fn materials(e: &DisplacementElement, r: &Reference) -> Vec<Trial> {
    let mut trials = Vec::new();
    let mut push = |rank, cause, sentence: String, matrix: Result<DMatrix<f64>, String>| {
        trials.extend(matrix.ok().map(|matrix| Trial { rank, cause, sentence, matrix }));
    };
    push(0, "sign", "K has the wrong sign".into(), Ok(-&r.matrix));
    let factor = e.matrix.dot(&r.matrix) / r.matrix.norm_squared();
    let text =
        format!("K is {} times what it must be, as with another Young's modulus or thickness", significant(factor, 6));
    push(4, "factor", text, Ok(&r.matrix * factor));
    if let Some(material) = e.material {
        if material.kinematics == crate::scene::Kinematics::PlaneStress && material.poisson.abs() > 1e-3 {
            let text = "E/(1 − ν) stands where E/(1 − ν²) belongs".into();
            push(1, "plane-stress-factor", text, Ok(&r.matrix * (1.0 + material.poisson)));
        }
        let other = material.in_other_kinematics();
        let text = format!("K is that of {} and not of {}", other.kinematics.words(), material.kinematics.words());
        push(1, "plane-state", text, r.variant(&(other.hooke() * other.thickness), Variant::Right));
    }
    // K is linear in D_33: how often does shear count?
    let mut only_shear = Matrix3::zeros();
    only_shear[(2, 2)] = r.hooke[(2, 2)];
    if let Ok(shear) = r.variant(&only_shear, Variant::Right) {
        let part = (&e.matrix - &r.matrix).dot(&shear) / shear.norm_squared();
        let text = format!(
            "shear counts {} times: γ_xy = 2 ε_xy and ε_xy are mixed up, or G is wrong",
            significant(1.0 + part, 6)
        );
        push(2, "shear", text, Ok(&r.matrix + shear * part));
    }
    trials
}

/// Quadrature and Jacobian.
fn variants(r: &Reference) -> Vec<Trial> {
    let of = |(rank, cause, variant, sentence): (usize, &'static str, Variant, &str)| {
        let matrix = r.variant(&r.hooke, variant).ok()?;
        Some(Trial { rank, cause, sentence: sentence.into(), matrix })
    };
    let list = [
        (1, "one-point-quadrature", Variant::OnePoint, "K is integrated with one point in the middle"),
        (
            1,
            "transposed-jacobian",
            Variant::Transposed,
            "the Jacobian stands where its transpose belongs: gradients are J⁻¹∇N in place of J⁻ᵀ∇N",
        ),
    ];
    list.into_iter().filter_map(of).collect()
}

/// Another order of nodes, unknowns or components.
fn numberings(e: &DisplacementElement, right: &DMatrix<f64>) -> Vec<Trial> {
    let n = e.nodes.len();
    let permuted = |place: &dyn Fn(usize) -> usize| DMatrix::from_fn(2 * n, 2 * n, |i, j| right[(place(i), place(j))]);
    let mut trials = Vec::new();
    let blocked = |i: usize| if i < n { 2 * i } else { 2 * (i - n) + 1 };
    let text = "all unknowns along x come before those along y; say so with the order blocked";
    trials.push(Trial { rank: 1, cause: "component-order", sentence: text.into(), matrix: permuted(&blocked) });
    let interleaved = |i: usize| Order::Blocked.place(n, i / 2, i % 2);
    let text = "the unknowns were taken for blocked and are interleaved: x and y of one node after the other";
    trials.push(Trial { rank: 1, cause: "component-order", sentence: text.into(), matrix: permuted(&interleaved) });
    let text = "x and y are exchanged in every node";
    trials.push(Trial { rank: 2, cause: "components-exchanged", sentence: text.into(), matrix: permuted(&|i| i ^ 1) });
    for order in orders(n) {
        let names: Vec<String> = order.iter().map(usize::to_string).collect();
        let sentence = format!(
            "the nodes are in another order: nodes 0 to {} of K are nodes {} of the list",
            n - 1,
            names.join(", ")
        );
        let matrix = permuted(&|i| 2 * order[i / 2] + i % 2);
        trials.push(Trial { rank: 3, cause: "node-order", sentence, matrix });
    }
    trials
}

/// All orders of up to six nodes but the one they have; of more, those that begin elsewhere, forwards and backwards.
fn orders(n: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    if n <= 6 {
        for k in 0..n {
            all = all
                .into_iter()
                .flat_map(|order| (0..=k).map(move |at| [&order[..at], &[k], &order[at..]].concat()))
                .collect();
        }
    } else {
        all = (0..n)
            .flat_map(|k| [(0..n).map(|i| (i + k) % n).collect(), (0..n).map(|i| (n + k - i) % n).collect()])
            .collect();
    }
    all.retain(|order| order.iter().enumerate().any(|(i, &n)| i != n));
    all
}

/// The same mistake with a factor on top.
fn with_factor(k: &DMatrix<f64>, trial: &Trial) -> Option<Trial> {
    if matches!(trial.cause, "sign" | "factor" | "shear" | "weights" | "plane-stress-factor") {
        return None;
    }
    let factor = k.dot(&trial.matrix) / trial.matrix.norm_squared();
    let sentence = format!("{}, and K is {} times too large", trial.sentence, significant(factor, 6));
    factor.is_finite().then(|| Trial {
        rank: trial.rank + 5,
        cause: trial.cause,
        sentence,
        matrix: &trial.matrix * factor,
    })
}

/// Any Hooke's law: K is linear in its entries.
fn fitted_hooke(k: &DMatrix<f64>, r: &Reference) -> Option<Trial> {
    let places: Vec<(usize, usize)> = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).collect();
    let of = |&(i, j): &(usize, usize)| {
        let mut d = Matrix3::zeros();
        d[(i, j)] = 1.0;
        r.variant(&d, Variant::Right).ok()
    };
    let columns: Vec<DMatrix<f64>> = places.iter().map(of).collect::<Option<_>>()?;
    let system = DMatrix::from_fn(k.len(), 9, |row, c| columns[c][row]);
    let given = DMatrix::from_column_slice(k.len(), 1, k.as_slice());
    let found = system.svd(true, true).solve(&given, 1e-12).ok()?;
    let d = Matrix3::from_fn(|i, j| found[3 * i + j]);
    let matrix = r.variant(&d, Variant::Right).ok()?;
    let sentence = match super::displacement::material_words(&d) {
        Some(words) => format!("the material is another one: {words}"),
        None => {
            let row = |i: usize| (0..3).map(|j| significant(d[(i, j)], 4)).collect::<Vec<_>>().join(", ");
            format!("Hooke's law times thickness is no isotropic one: ({}; {}; {})", row(0), row(1), row(2))
        }
    };
    Some(Trial { rank: 6, cause: "material", sentence, matrix })
}

/// A few wrong entries, all others being right.
fn entries(e: &DisplacementElement, right: &DMatrix<f64>) -> Option<Trial> {
    let (k, rows) = (&e.matrix, e.matrix.nrows());
    let wrong: Vec<usize> = (0..k.len()).filter(|&at| (k[at] - right[at]).abs() > e.precision * right.amax()).collect();
    if wrong.is_empty() || wrong.len() * FEW > k.len() {
        return None;
    }
    let name = |at: &usize| {
        format!("({}, {}) = {} for {}", at % rows, at / rows, significant(k[*at], 4), significant(right[*at], 4))
    };
    let mut listed: Vec<String> = wrong.iter().take(6).map(name).collect();
    if wrong.len() > listed.len() {
        listed.push(format!("and {} more", wrong.len() - listed.len()));
    }
    let is_mutual = wrong.iter().all(|at| (k[*at] - k[(at / rows, at % rows)]).abs() <= e.precision * right.amax());
    let cause = if is_mutual { "entries" } else { "unsymmetric" };
    let sentence = format!("{} of {} entries are wrong, the others right: {}", wrong.len(), k.len(), listed.join(", "));
    Some(Trial { rank: 7, cause, sentence, matrix: k.clone() })
}
