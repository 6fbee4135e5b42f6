//! Properties that every equilibrium element must have, as the workbench measures them with derivatives of its own; energies and elastic
//! solutions against quadrature and closed formulas of these tests.

use hypercircle::element::polynomial::side;
use hypercircle::element::{block, parameters_from_tractions};
use hypercircle::scene::Kinematics;
use hypercircle::workbench::stress;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use crate::support::element::{Case, Material, Setting, longest_side, setting};
use crate::support::theory::airy::{self, Jet};
use crate::support::theory::quadrature::{gauss, point, sub_corners};

/// Degrees, and on how many random triangles they are held against each property.
const SWEEPS: [(std::ops::RangeInclusive<usize>, u32); 3] = [(1..=1, 256), (2..=4, 64), (5..=8, 4)];

/// Runs a check on random triangles, materials and body forces.
fn sweep(check: impl Fn(&Case) -> Result<(), TestCaseError>) {
    for (degrees, cases) in SWEEPS {
        let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
        let outcome = TestRunner::new(config).run(&setting(), |setting| {
            degrees.clone().try_for_each(|degree| check(&Case::new(block(degree), setting)))
        });
        if let Err(failure) = outcome {
            panic!("{failure}");
        }
    }
}

/// How far a case is from what it should be, every figure relative to the size of the fields.
mod figures {
    use super::*;

    /// Side s of the triangle: its ends, outward normal and length.
    pub fn side_of(p: [[f64; 2]; 3], s: usize) -> ([f64; 2], [f64; 2], [f64; 2], f64) {
        let (a, b) = (p[(s + 1) % 3], p[(s + 2) % 3]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        (a, b, [dy / length, -dx / length], length)
    }

    fn traction(tau: [f64; 3], n: [f64; 2]) -> [f64; 2] {
        [tau[0] * n[0] + tau[2] * n[1], tau[2] * n[0] + tau[1] * n[1]]
    }

    /// Points of a subtriangle.
    const POINTS: [[f64; 3]; 5] =
        [[0.2, 0.3, 0.5], [0.7, 0.1, 0.2], [1.0, 0.0, 0.0], [0.05, 0.05, 0.9], [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]];

    /// Energies of the workbench against those by the constants after (3.2).
    pub fn energy(case: &Case) -> f64 {
        let (own, theirs) = (energy_rows(case), case.fields.columns(case.fields.all().map(|(field, ..)| field)));
        let (own, theirs) = (own.tr_mul(&own), theirs.tr_mul(&theirs));
        (&own - theirs).amax() / own.amax()
    }

    /// Modes and λ̄ column by column, their products being energies.
    fn energy_rows(case: &Case) -> DMatrix<f64> {
        energies(case, case.fields.all().map(|(field, ..)| move |sub: usize, l: [f64; 3]| field.at(sub, l)))
    }

    /// Modes and λ̄ with fields that have no traction: (μ_i² q)'' on subtriangle i, see [`airy::without_traction`].
    pub fn least_energy(case: &Case) -> f64 {
        let p = case.degree();
        if p == 1 {
            return 0.0;
        }
        let corners = case.setting.corners;
        let others = airy::powers(p - 2).map(|exponents| {
            move |sub: usize, l: [f64; 3]| {
                // Barycentric coordinates of the triangle.
                let mut mu = [l[2] / 3.0; 3];
                mu[(sub + 1) % 3] += l[0];
                mu[(sub + 2) % 3] += l[1];
                airy::stress(airy::without_traction(airy::barycentric(corners, mu), sub, exponents))
            }
        });
        let mut free = energies(case, others);
        for mut column in free.column_iter_mut() {
            let norm = column.norm();
            column /= norm;
        }
        let mut own = energy_rows(case);
        for mut column in own.column_iter_mut() {
            let norm = column.norm();
            column /= norm.max(1e-300);
        }
        free.tr_mul(&own).amax()
    }

    /// Fields at quadrature points, as columns whose products are energies.
    fn energies(case: &Case, fields: impl Iterator<Item = impl Fn(usize, [f64; 3]) -> [f64; 3]>) -> DMatrix<f64> {
        let roots = case.setting.material.roots();
        let columns = fields.map(|field| {
            let mut column = Vec::new();
            case.visit(|sub, l, w| {
                let tau = field(sub, l);
                let parts = [tau[0] + tau[1], tau[0] - tau[1], tau[2]];
                column.extend((0..3).map(|c| w.sqrt() * roots[c] * parts[c]));
            });
            DVector::from_vec(column)
        });
        DMatrix::from_columns(&columns.collect::<Vec<_>>())
    }

    /// Tractions as forces, by mode.
    pub fn forces(case: &Case) -> DMatrix<f64> {
        let (rows, n) = (case.element.tractions(), case.modes.parameters());
        let mut t = DMatrix::from_column_slice(rows, n, case.modes.traction());
        for s in 0..3 {
            t.rows_mut(s * rows / 3, rows / 3).scale_mut(side_of(case.setting.corners, s).3);
        }
        t
    }

    /// Tractions of the stress of an Airy function, and what is left of them by the modes; then how far the field that has them
    /// is from the stress.
    pub fn patch(case: &Case, phi: impl Fn([Jet; 2]) -> Jet) -> (f64, f64) {
        let (p, corners) = (case.degree(), case.setting.corners);
        let (centre, h) = (sub_corners(corners, 0)[2], longest_side(corners));
        let stress = |x: [f64; 2]| {
            airy::stress(phi([
                airy::linear((x[0] - centre[0]) / h, [1.0, 0.0]),
                airy::linear((x[1] - centre[1]) / h, [0.0, 1.0]),
            ]))
        };
        let mut tractions = vec![0.0; case.element.tractions()];
        for s in 0..3 {
            let (a, b, n, _) = side_of(corners, s);
            let mut moments = [vec![0.0; p + 1], vec![0.0; p + 1]];
            for (x, w) in gauss(p + 2) {
                let t = traction(stress([0, 1].map(|c| a[c] + x * (b[c] - a[c]))), n);
                for (moments, t) in moments.iter_mut().zip(t) {
                    (0..=p).for_each(|k| moments[k] += w * side::bernstein(p, k, x) * t);
                }
            }
            for (c, moments) in moments.iter().enumerate() {
                for (k, t) in side::from_moments(moments).into_iter().enumerate() {
                    tractions[2 * (s * (p + 1) + k) + c] = t;
                }
            }
        }
        let (s, left) = parameters_from_tractions(&case.modes, &tractions).expect("regular");
        let own = case.sum(&s);
        let (mut apart, mut size) = (0.0_f64, 0.0_f64);
        for sub in 0..3 {
            let q = sub_corners(corners, sub);
            for l in POINTS {
                let (own, exact) = (own.at(sub, l), stress(point(q, l)));
                for c in 0..3 {
                    apart = apart.max((own[c] - exact[c]).abs());
                    size = size.max(exact[c].abs());
                }
            }
        }
        if size == 0.0 { (0.0, 0.0) } else { (left / size, apart / size) }
    }
}

#[test]
fn stresses_are_in_equilibrium_at_every_point() {
    sweep(|case| {
        let found = stress::divergence(&case.fields);
        prop_assert!(found < 1e-10, "p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

#[test]
fn tractions_are_continuous_inside() {
    sweep(|case| {
        let found = stress::inner_jump(&case.fields);
        prop_assert!(found < 1e-11, "p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

#[test]
fn traction_coefficients_belong_to_the_stresses() {
    sweep(|case| {
        let found = stress::coefficients(&case.fields);
        prop_assert!(found < 1e-11, "p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

/// So K = TTᵀ annihilates rigid motions.
#[test]
fn tractions_are_self_equilibrated() {
    sweep(|case| {
        let found = stress::resultant(&case.fields);
        prop_assert!(found < 1e-11, "p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

#[test]
fn modes_are_orthonormal_in_energy() {
    sweep(|case| {
        let found = stress::orthonormality(&case.fields);
        prop_assert!(found < 1e-9, "p = {}: {found:.1e}", case.degree());
        let found = stress::particular(&case.fields);
        prop_assert!(found < 1e-9, "λ̄, p = {}: {found:.1e}", case.degree());
        let found = figures::energy(case);
        prop_assert!(found < 1e-9, "by the constants, p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

/// A perturbation without traction raises the energy of every mode and of λ̄.
#[test]
fn energy_is_the_least_for_given_tractions() {
    sweep(|case| {
        let found = figures::least_energy(case);
        prop_assert!(found < 1e-9, "p = {}: {found:.1e}", case.degree());
        Ok(())
    });
}

/// Theorem 2.1, in every degree: as many modes as tractions in equilibrium, and independent.
#[test]
fn every_traction_in_equilibrium_has_one_field() {
    sweep(|case| {
        let (p, found) = (case.degree(), stress::traction_condition(&case.fields));
        prop_assert_eq!(case.fields.fields.len(), 6 * (p + 1) - 3);
        prop_assert!(found < 1e7, "p = {}: {:.1e}", p, found);
        Ok(())
    });
}

/// N(K) contains every stress of degree p with compatible strain: of all fields with its tractions it has the least energy.
#[test]
fn elastic_solutions_are_found() {
    sweep(|case| {
        // The parameters carry the rounding of the tractions as often as the tractions of the modes are ill-conditioned.
        let carried = 1e3 * f64::EPSILON * stress::traction_condition(&case.fields);
        for n in 2..=case.degree() + 2 {
            for kind in 0..4 {
                let (left, apart) = figures::patch(case, |x| airy::biharmonic(n, kind, x));
                prop_assert!(left < 1e-12, "p = {}, left {left:.1e}", case.degree());
                prop_assert!(apart < carried, "p = {}, apart {apart:.1e}, of rounding {carried:.1e}", case.degree());
            }
        }
        Ok(())
    });
}

/// Other polynomial stresses share their tractions with a field of N(K).
#[test]
fn tractions_of_polynomial_stresses_are_met() {
    sweep(|case| {
        let k = case.degree() + 2;
        for i in 0..=k {
            let (left, _) = figures::patch(case, |[x, y]| airy::times(airy::power(x, i), airy::power(y, k - i)));
            prop_assert!(left < 1e-12, "p = {}, left {left:.1e}", case.degree());
        }
        Ok(())
    });
}

/// Another place, direction and size, and another first corner, give the same stiffness.
#[test]
fn stiffness_goes_with_the_triangle() {
    sweep(|case| {
        let Setting { corners, material, force } = case.setting;
        let (p, (sin, cos)) = (case.degree(), 1.1_f64.sin_cos());
        let moved = corners.map(|[x, y]| [4.0 * (cos * x - sin * y), 4.0 * (sin * x + cos * y)]);
        let shifted = [moved[1], moved[2], moved[0]];
        let other = Case::new(case.element, Setting { corners: shifted, material, force });
        let (own, other) = (figures::forces(case), figures::forces(&other));
        let per_side = 2 * (p + 1);
        let turned = DMatrix::from_fn(own.nrows(), own.ncols(), |i, k| {
            let from = (i + per_side) % own.nrows();
            let (x, y) = (own[(from - from % 2, k)], own[(from - from % 2 + 1, k)]);
            if i % 2 == 0 { cos * x - sin * y } else { sin * x + cos * y }
        });
        let (own, other) = (&turned * turned.transpose(), &other * other.transpose());
        let apart = (&own - other).amax() / own.amax();
        prop_assert!(apart < 1e-9, "p = {p}: {apart:.1e}");
        Ok(())
    });
}

/// Refinement at a corner of a body comes to triangles that its coordinates resolve with few digits; what those say of their shape
/// is all the same exact, and the fields are those of the same triangle at the origin.
#[test]
fn a_small_triangle_far_from_the_origin_loses_no_digits() {
    for (size, place) in [(1e-13, [1e-3, -2e-3]), (1e-9, [0.3, 7.0]), (3e-10, [-40.0, 0.01])] {
        let far = [[0.0, 0.0], [1.0, 0.3], [0.2, 0.9]].map(|[x, y]| [place[0] + size * x, place[1] + size * y]);
        // Differences of neighbours are exact.
        let near = far.map(|p| [p[0] - far[0][0], p[1] - far[0][1]]);
        for degree in 1..=4 {
            let force = [0.6 / size, -1.0 / size];
            let material = Material { kinematics: Kinematics::PlaneStress, young: 7.0, poisson: 0.3 };
            let fields = [far, near].map(|corners| {
                let case = Case::new(block(degree), Setting { corners, material, force });
                let all = case.fields.all().map(|(field, ..)| {
                    (0..3).flat_map(|sub| [[1.0, 0.0, 0.0], [0.0, 0.3, 0.7]].map(|l| field.at(sub, l))).collect()
                });
                (figures::forces(&case), all.collect::<Vec<Vec<[f64; 3]>>>())
            });
            let [(own, stresses), (other, others)] = fields;
            assert!((&own - &other).amax() < 1e-11 * other.amax(), "p = {degree}: tractions at {place:?}");
            let largest =
                |all: &[Vec<[f64; 3]>]| all.concat().as_flattened().iter().fold(0.0_f64, |m, s| m.max(s.abs()));
            let apart = stresses.concat().into_iter().zip(others.concat());
            let apart: Vec<Vec<[f64; 3]>> = vec![apart.map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect()];
            assert!(largest(&apart) < 1e-11 * largest(&others), "p = {degree}: stresses at {place:?}");
        }
    }
}

/// Rounding errors of flat triangles, nearly incompressible materials and high degrees: they grow with the aspect ratio, for a corner
/// moved by rounding changes a flat triangle by as much. The field of given tractions is worse by the aspect ratio once more, as by (2.10)
/// c(α) ~ 1/sin²α.
#[test]
fn flat_and_nearly_incompressible_triangles() {
    const FIGURES: [(&str, Figure); 9] = [
        ("div", |case| stress::divergence(&case.fields)),
        ("jump", |case| stress::inner_jump(&case.fields)),
        ("coeff", |case| stress::coefficients(&case.fields)),
        ("force", |case| stress::resultant(&case.fields)),
        ("energy", |case| stress::orthonormality(&case.fields)),
        ("λ̄", |case| stress::particular(&case.fields)),
        ("least", figures::least_energy),
        ("cond", |case| stress::traction_condition(&case.fields)),
        ("own energy", figures::energy),
    ];
    println!("p  aspect  ν  {}  patch", FIGURES.map(|(name, _)| name).join("  "));
    let material = |poisson| Material { kinematics: Kinematics::PlaneStrain, young: 7.0, poisson };
    for (aspect, poisson) in [1.0, 1e2, 1e4].into_iter().flat_map(|aspect| [(aspect, 0.3), (aspect, 0.499_999_9)]) {
        for degree in [1, 2, 3, 5, 8] {
            let cases = [0.1, 0.45, 0.97].map(|apex| {
                Case::new(
                    block(degree),
                    Setting { corners: flat(apex, 1.0 / aspect), material: material(poisson), force: [0.6, -1.0] },
                )
            });
            let of = |figure: &dyn Fn(&Case) -> f64| cases.iter().map(figure).fold(0.0, f64::max);
            let found = FIGURES.map(|(_, figure)| of(&figure));
            let patch = of(&elastic_solutions);
            println!(
                "{degree}  {aspect:.0e}  {poisson}  {}  {patch:.1e}",
                found.map(|f| format!("{f:.1e}")).join("  ")
            );
            let rounding = 1e-11 + 1e-14 * aspect;
            // The Gram matrix of the first degree has the square of the condition.
            let energies = if degree == 1 { 1e-11 + 1e-11 * aspect } else { rounding };
            assert!(found[..4].iter().all(|f| *f < rounding), "equilibrium");
            assert!(found[4..7].iter().all(|f| *f < energies), "energies");
            assert!(found[7] < 1e5 * aspect, "tractions are independent");
            assert!(patch < 1e-11 * aspect * aspect, "elastic solutions");
        }
    }
}

type Figure = fn(&Case) -> f64;

/// A triangle with a longest side of one, turned and moved.
fn flat(apex: f64, height: f64) -> [[f64; 2]; 3] {
    let (sin, cos) = 0.7_f64.sin_cos();
    [[0.0, 0.0], [1.0, 0.0], [apex, height]].map(|[x, y]: [f64; 2]| [3.0 + cos * x - sin * y, sin * x + cos * y])
}

/// How far the fields with the tractions of elastic solutions are from these.
fn elastic_solutions(case: &Case) -> f64 {
    let kinds = (2..=case.degree() + 2).flat_map(|n| (0..4).map(move |kind| (n, kind)));
    kinds.map(|(n, kind)| figures::patch(case, |x| airy::biharmonic(n, kind, x)).1).fold(0.0, f64::max)
}
