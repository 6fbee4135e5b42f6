//! Hooke's law as data: isotropic, orthotropic, or any matrix that is symmetric about the plane.
//!
//! Compliances are those of strains (11, 22, 33, 12) under stresses of the same order, the last one the engineering shear strain
//! γ = 2 ε_12; the shears 23 and 13 have no part in a plane problem. Axis 3 is out of the plane: the hoop direction of a body of
//! revolution.
//!
//! A plane problem needs a factor, a = RᵀR. It is worked out in [`Twofold`] precision, and the pressure is its first unknown:
//! a nearly incompressible body has a small first row, and no difference of large numbers in place of it.

mod check;
mod initial;
mod matrix;
mod numbers;
mod reduce;
mod twofold;

pub use check::Flaw;
pub use initial::{Initial, InitialStrain};
pub use numbers::NUMBERS;
pub use reduce::{Plane, Revolution};

use self::matrix::Square;
use self::twofold::Twofold;

/// A linear elastic material, in axes of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it is copied, and a body has one")]
pub enum Elasticity {
    /// Equal in all directions.
    Isotropic {
        /// Young's modulus E > 0.
        young: f64,
        /// Poisson's ratio ν in (−1, ½).
        poisson: f64,
    },
    /// Three planes of symmetry.
    Orthotropic(Orthotropic),
    /// A matrix.
    Anisotropic(Anisotropic),
}

/// Engineering constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropic {
    /// E_1, E_2, E_3.
    pub young: [f64; 3],
    /// ν_12, ν_13, ν_23: ν_ij is the strain along j over that along i, with the sign turned, under a stress along i.
    pub poisson: [f64; 3],
    /// G_12.
    pub shear: f64,
    /// Degrees from x to axis 1, anticlockwise.
    pub angle: f64,
}

/// A matrix and its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropic {
    /// Stiffness or compliance.
    pub kind: MatrixKind,
    /// The matrix.
    pub matrix: Matrix,
    /// Degrees from x to axis 1, anticlockwise.
    pub angle: f64,
}

/// The map between strains and stresses that a matrix of elastic constants stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixKind {
    /// Strains to stresses.
    Stiffness,
    /// Stresses to strains.
    Compliance,
}

impl MatrixKind {
    /// Its key in a scene.
    pub fn key(self) -> &'static str {
        match self {
            MatrixKind::Stiffness => "stiffness",
            MatrixKind::Compliance => "compliance",
        }
    }
}

/// Rows of a matrix of elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "it is copied, and a body has one")]
pub enum Matrix {
    /// In the plane alone, 11, 22, 12: plane stress.
    Three([[f64; 3]; 3]),
    /// 11, 22, 33, 23, 13, 12.
    Six([[f64; 6]; 6]),
}

/// Where the components 11, 22, 33, 12 stand among six.
const IN_PLANE: [usize; 4] = [0, 1, 2, 5];

impl Elasticity {
    /// The angle from x to axis 1, in degrees.
    pub fn angle(&self) -> f64 {
        match self {
            Elasticity::Isotropic { .. } => 0.0,
            Elasticity::Orthotropic(Orthotropic { angle, .. }) | Elasticity::Anisotropic(Anisotropic { angle, .. }) => {
                *angle
            }
        }
    }

    /// Turns the material by `degrees`, anticlockwise.
    #[must_use]
    pub fn turned(mut self, degrees: f64) -> Self {
        if let Elasticity::Orthotropic(Orthotropic { angle, .. }) | Elasticity::Anisotropic(Anisotropic { angle, .. }) =
            &mut self
        {
            *angle += degrees;
        }
        self
    }

    /// Multiplies the moduli by `factor`.
    #[must_use]
    pub fn stiffened(mut self, factor: f64) -> Self {
        match &mut self {
            Elasticity::Isotropic { young, .. } => *young *= factor,
            Elasticity::Orthotropic(Orthotropic { young, shear, .. }) => {
                young.iter_mut().chain([shear]).for_each(|modulus| *modulus *= factor);
            }
            Elasticity::Anisotropic(Anisotropic { kind, matrix, .. }) => {
                let factor = if *kind == MatrixKind::Stiffness { factor } else { 1.0 / factor };
                let entries = match matrix {
                    Matrix::Three(rows) => rows.as_flattened_mut(),
                    Matrix::Six(rows) => rows.as_flattened_mut(),
                };
                entries.iter_mut().for_each(|entry| *entry *= factor);
            }
        }
        self
    }

    /// E and ν of an isotropic material.
    pub fn isotropic(&self) -> Option<[f64; 2]> {
        match *self {
            Elasticity::Isotropic { young, poisson } => Some([young, poisson]),
            _ => None,
        }
    }

    /// True if the matrix is one for plane stress alone.
    pub fn is_plane_stress_only(&self) -> bool {
        matches!(self, Elasticity::Anisotropic(Anisotropic { matrix: Matrix::Three(_), .. }))
    }

    /// cos 2θ and sin 2θ of the angle from x to axis 1, exact where it is a multiple of 45°.
    pub fn double_angle(&self) -> [f64; 2] {
        double_angle(self.angle())
    }

    /// A stress (xx, yy, xy) in the axes of the material: 11, 22, 12.
    pub fn in_own_axes(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        let ([c, s], mean, half) = (self.double_angle(), 0.5 * (xx + yy), 0.5 * (xx - yy));
        let turned = c * half + s * xy;
        [mean + turned, mean - turned, c * xy - s * half]
    }

    /// Compliances of the strains (11, 22, 33, 12) in the axes of the material. For a matrix of plane stress alone, the entries of axis 3
    /// are zero.
    fn compliance(&self) -> Result<Square<4>, usize> {
        match *self {
            Elasticity::Isotropic { young, poisson } => {
                let shear = 0.5 * young / (1.0 + poisson);
                let constants = Orthotropic { young: [young; 3], poisson: [poisson; 3], shear, angle: 0.0 };
                let mut s = of_constants(&constants);
                let two = Twofold::from(2.0);
                s[3][3] = two * (Twofold::from(1.0) + poisson.into()) / young.into();
                Ok(s)
            }
            Elasticity::Orthotropic(constants) => Ok(of_constants(&constants)),
            Elasticity::Anisotropic(Anisotropic { kind, matrix, .. }) => of_matrix(kind, &matrix),
        }
    }
}

/// cos 2θ and sin 2θ of an angle in degrees.
fn double_angle(degrees: f64) -> [f64; 2] {
    let double = (2.0 * degrees.rem_euclid(180.0)).rem_euclid(360.0);
    match double {
        0.0 => [1.0, 0.0],
        90.0 => [0.0, 1.0],
        180.0 => [-1.0, 0.0],
        270.0 => [0.0, -1.0],
        _ => [double.to_radians().cos(), double.to_radians().sin()],
    }
}

fn of_constants(Orthotropic { young, poisson, shear, .. }: &Orthotropic) -> Square<4> {
    let one = Twofold::from(1.0);
    let mut s = [[Twofold::ZERO; 4]; 4];
    (0..3).for_each(|i| s[i][i] = one / young[i].into());
    for ((i, j), nu) in [(0, 1), (0, 2), (1, 2)].into_iter().zip(poisson) {
        s[i][j] = -(Twofold::from(*nu) / young[i].into());
        s[j][i] = s[i][j];
    }
    s[3][3] = one / (*shear).into();
    s
}

fn of_matrix(kind: MatrixKind, matrix: &Matrix) -> Result<Square<4>, usize> {
    match matrix {
        Matrix::Six(rows) => {
            let own = symmetric(|i, j| rows[IN_PLANE[i]][IN_PLANE[j]]);
            if kind == MatrixKind::Stiffness { matrix::inverse(&own) } else { Ok(own) }
        }
        Matrix::Three(rows) => {
            const PLACES: [usize; 3] = [0, 1, 3];
            let own: Square<3> = symmetric(|i, j| rows[i][j]);
            let own =
                if kind == MatrixKind::Stiffness { matrix::inverse(&own).map_err(|row| PLACES[row])? } else { own };
            let mut s = [[Twofold::ZERO; 4]; 4];
            for (row, i) in own.iter().zip(PLACES) {
                row.iter().zip(PLACES).for_each(|(entry, j)| s[i][j] = *entry);
            }
            Ok(s)
        }
    }
}

/// Entries that mirror each other, by their mean.
fn symmetric<const N: usize>(entry: impl Fn(usize, usize) -> f64) -> Square<N> {
    let half = Twofold::from(0.5);
    std::array::from_fn(|i| std::array::from_fn(|j| half * (Twofold::from(entry(i, j)) + Twofold::from(entry(j, i)))))
}
