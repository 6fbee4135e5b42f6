//! A material as a list of numbers of one length, for files between processes.

use super::{Anisotropic, Elasticity, Matrix, MatrixKind, Orthotropic};

/// Length of the list: the member, its angle, and up to 36 constants.
pub const NUMBERS: usize = 38;

impl Elasticity {
    /// The list.
    pub fn to_numbers(&self) -> [f64; NUMBERS] {
        let mut out = [0.0; NUMBERS];
        out[1] = self.angle();
        let mut put = |member: f64, constants: &mut dyn Iterator<Item = f64>| {
            out[0] = member;
            out[2..].iter_mut().zip(constants).for_each(|(place, constant)| *place = constant);
        };
        match self {
            Elasticity::Isotropic { young, poisson } => put(0.0, &mut [*young, *poisson].into_iter()),
            Elasticity::Orthotropic(Orthotropic { young, poisson, shear, .. }) => {
                put(1.0, &mut young.iter().chain(poisson).chain([shear]).copied());
            }
            Elasticity::Anisotropic(Anisotropic { kind, matrix, .. }) => {
                let stiffness = f64::from(*kind == MatrixKind::Stiffness);
                match matrix {
                    Matrix::Three(rows) => put(2.0 + stiffness, &mut rows.iter().flatten().copied()),
                    Matrix::Six(rows) => put(4.0 + stiffness, &mut rows.iter().flatten().copied()),
                }
            }
        }
        out
    }

    /// The material of a list.
    pub fn from_numbers(list: &[f64; NUMBERS]) -> Option<Self> {
        let ([member, angle], constants) = (list.first_chunk::<2>()?, &list[2..]);
        let (angle, at) = (*angle, |i: usize| constants[i]);
        let kind = |member: f64| if member % 2.0 == 1.0 { MatrixKind::Stiffness } else { MatrixKind::Compliance };
        Some(match *member {
            0.0 => Elasticity::Isotropic { young: at(0), poisson: at(1) },
            1.0 => Elasticity::Orthotropic(Orthotropic {
                young: [at(0), at(1), at(2)],
                poisson: [at(3), at(4), at(5)],
                shear: at(6),
                angle,
            }),
            member @ (2.0 | 3.0) => {
                let matrix = Matrix::Three(std::array::from_fn(|i| std::array::from_fn(|j| at(3 * i + j))));
                Elasticity::Anisotropic(Anisotropic { kind: kind(member), matrix, angle })
            }
            member @ (4.0 | 5.0) => {
                let matrix = Matrix::Six(std::array::from_fn(|i| std::array::from_fn(|j| at(6 * i + j))));
                Elasticity::Anisotropic(Anisotropic { kind: kind(member), matrix, angle })
            }
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_comes_back() {
        let rows = |n: usize| move |i: usize| std::array::from_fn(|j| (n * i + j) as f64 + 0.25);
        let six = Matrix::Six(std::array::from_fn(|i| std::array::from_fn(|j| (6 * i + j) as f64)));
        let three = Matrix::Three(std::array::from_fn(rows(3)));
        let made = |kind, matrix| Elasticity::Anisotropic(Anisotropic { kind, matrix, angle: 12.5 });
        let laws = [
            Elasticity::Isotropic { young: 2.0, poisson: 0.4 },
            Elasticity::Orthotropic(Orthotropic {
                young: [1.0, 2.0, 3.0],
                poisson: [0.1, 0.2, 0.3],
                shear: 4.0,
                angle: -7.0,
            }),
            made(MatrixKind::Compliance, three),
            made(MatrixKind::Stiffness, three),
            made(MatrixKind::Compliance, six),
            made(MatrixKind::Stiffness, six),
        ];
        for law in laws {
            assert_eq!(Elasticity::from_numbers(&law.to_numbers()), Some(law));
        }
        assert_eq!(Elasticity::from_numbers(&[9.0; NUMBERS]), None);
    }
}
