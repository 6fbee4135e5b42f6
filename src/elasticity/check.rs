//! Checks that elastic constants are those of a material.

use super::matrix::cholesky;
use super::{Anisotropic, Elasticity, Matrix, MatrixKind, Orthotropic};

/// Tolerance on asymmetry and on entries that must vanish, relative to the geometric mean of the diagonal entries concerned: the error
/// of printing with six digits.
const SYMMETRIC: f64 = 1e-5;

/// Why constants are refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Flaw {
    /// The key inside the table of the body, with the place in a list.
    pub key: String,
    /// The value that breaks the rule.
    pub found: f64,
    /// The rule.
    pub rule: &'static str,
    /// The remedy.
    pub remedy: &'static str,
}

impl Flaw {
    fn new(key: impl Into<String>, found: f64, rule: &'static str, remedy: &'static str) -> Self {
        Flaw { key: key.into(), found, rule, remedy }
    }
}

impl Elasticity {
    /// The first flaw of constants that are no positive definite material, symmetric about the plane. Numbers are taken to be finite.
    pub fn flaw(&self) -> Option<Flaw> {
        match self {
            Elasticity::Isotropic { .. } => None,
            Elasticity::Orthotropic(constants) => orthotropic(constants),
            Elasticity::Anisotropic(Anisotropic { kind, matrix, .. }) => match matrix {
                Matrix::Three(rows) => symmetry(*kind, rows).or_else(|| definite(self, *kind, rows)),
                Matrix::Six(rows) => symmetry(*kind, rows)
                    .or_else(|| about_the_plane(*kind, rows))
                    .or_else(|| definite(self, *kind, rows)),
            },
        }
    }
}

fn orthotropic(constants: &Orthotropic) -> Option<Flaw> {
    const POSITIVE: (&str, &str) = ("moduli must be positive", "write a positive number, in units of stress");
    const NAMES: [&str; 3] = ["nu12", "nu13", "nu23"];
    const PAIR: (&str, &str) = (
        "the strain energy is positive only where nu_ij² < E_i/E_j",
        "check the order of the indices: nu_ij is the strain along j over the strain along i under stress along i, so nu_ji = nu_ij E_j/E_i",
    );
    const ALL: (&str, &str) = (
        "with the two other ratios the strain energy is not positive: 1 − nu12 nu21 − nu13 nu31 − nu23 nu32 − 2 nu21 nu32 nu13 must be above zero",
        "make the ratios smaller, or check the order of their indices",
    );
    let Orthotropic { young, poisson, shear, .. } = *constants;
    for (i, e) in young.into_iter().enumerate() {
        if e <= 0.0 {
            return Some(Flaw::new(format!("orthotropic.young[{i}] (E{})", i + 1), e, POSITIVE.0, POSITIVE.1));
        }
    }
    if shear <= 0.0 {
        return Some(Flaw::new("orthotropic.shear (G12)", shear, POSITIVE.0, POSITIVE.1));
    }
    let key = |k: usize| format!("orthotropic.poisson[{k}] ({})", NAMES[k]);
    for (k, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
        if poisson[k].abs() >= (young[i] / young[j]).sqrt() {
            return Some(Flaw::new(key(k), poisson[k], PAIR.0, PAIR.1));
        }
    }
    let s = super::of_constants(constants);
    cholesky(&s).err().map(|_| {
        // The ratio that is nearest to its own limit.
        let near = |k: usize| {
            let (i, j) = [(0, 1), (0, 2), (1, 2)][k];
            poisson[k].abs() / (young[i] / young[j]).sqrt()
        };
        let worst = (0..3).fold(0, |worst, k| if near(k) > near(worst) { k } else { worst });
        Flaw::new(key(worst), poisson[worst], ALL.0, ALL.1)
    })
}

fn place(kind: MatrixKind, i: usize, j: usize) -> String {
    format!("{}[{i}][{j}]", kind.key())
}

fn symmetry<const N: usize>(kind: MatrixKind, rows: &[[f64; N]; N]) -> Option<Flaw> {
    for (i, row) in rows.iter().enumerate() {
        if row[i] <= 0.0 {
            let rule = "entries on the diagonal must be positive";
            return Some(Flaw::new(place(kind, i, i), row[i], rule, "check the order of rows: 11, 22, 33, 23, 13, 12"));
        }
    }
    for i in 0..N {
        for j in 0..i {
            if (rows[i][j] - rows[j][i]).abs() > SYMMETRIC * (rows[i][i] * rows[j][j]).sqrt() {
                return Some(Flaw::new(
                    place(kind, i, j),
                    rows[i][j],
                    "the matrix must be symmetric, and the entry across the diagonal is another",
                    "write the same number in both places",
                ));
            }
        }
    }
    None
}

fn about_the_plane(kind: MatrixKind, rows: &[[f64; 6]; 6]) -> Option<Flaw> {
    for i in [3, 4] {
        for j in [0, 1, 2, 5] {
            if rows[i][j].abs() > SYMMETRIC * (rows[i][i] * rows[j][j]).sqrt() {
                return Some(Flaw::new(
                    place(kind, i, j),
                    rows[i][j],
                    "the material must be symmetric about the plane: rows 23 and 13 have zeros in columns 11, 22, 33 and 12",
                    "turn the material about axis 3 only; the order is 11, 22, 33, 23, 13, 12",
                ));
            }
        }
    }
    None
}

fn definite<const N: usize>(law: &Elasticity, kind: MatrixKind, rows: &[[f64; N]; N]) -> Option<Flaw> {
    const RULE: &str = "the matrix must be positive definite, and with the rows before it this one is not";
    const REMEDY: &str =
        "check signs, order (11, 22, 33, 23, 13, 12) and that shear entries belong to engineering shear strains";
    let place_of = |row: usize| if N == 6 { super::IN_PLANE[row] } else { [0, 1, 1, 2][row] };
    let flaw = |row: usize| Flaw::new(place(kind, row, row), rows[row][row], RULE, REMEDY);
    if N == 6 && rows[3][3] * rows[4][4] <= rows[3][4] * rows[4][3] {
        return Some(flaw(4));
    }
    let found = match law.compliance() {
        Err(row) => Some(row),
        Ok(s) if N == 6 => cholesky(&s).err(),
        Ok(s) => {
            let of = [0, 1, 3];
            cholesky::<3>(&std::array::from_fn(|i| std::array::from_fn(|j| s[of[i]][of[j]]))).err().map(|row| of[row])
        }
    };
    found.map(|row| flaw(place_of(row)))
}
