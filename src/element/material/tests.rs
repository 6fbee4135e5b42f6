use super::*;
use crate::elasticity::Orthotropic;

/// λ and μ of the textbook Hooke's law c e = λ tr(e) I + 2μ e.
fn textbook(kinematics: Kinematics, young: f64, nu: f64, e: [f64; 3]) -> [f64; 3] {
    let mu = young / (2.0 * (1.0 + nu));
    let lambda = match kinematics {
        Kinematics::PlaneStrain | Kinematics::Axisymmetric => young * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        Kinematics::PlaneStress => young * nu / (1.0 - nu * nu),
    };
    let tr = e[0] + e[1];
    [lambda * tr + 2.0 * mu * e[0], lambda * tr + 2.0 * mu * e[1], 2.0 * mu * e[2]]
}

/// The isotropic material as one of the general kind.
fn as_general(kinematics: Kinematics, young: f64, poisson: f64) -> Material {
    let shear = young / (2.0 * (1.0 + poisson));
    let law = Orthotropic { young: [young; 3], poisson: [poisson; 3], shear, angle: 27.0 };
    Material::new(kinematics, &Elasticity::Orthotropic(law))
}

#[test]
fn agrees_with_lame_constants() {
    for kinematics in [Kinematics::PlaneStrain, Kinematics::PlaneStress] {
        for nu in [-0.9, 0.0, 0.3, 0.49] {
            for c in [Material::isotropic(kinematics, 7.0, nu), as_general(kinematics, 7.0, nu)] {
                let (e, d) = ([0.3, -1.1, 0.4], [2.0, 0.7, -0.9]);
                let (stress, expected) = (c.stress(e), textbook(kinematics, 7.0, nu, e));
                let back = c.strain(stress);
                for i in 0..3 {
                    assert!((stress[i] - expected[i]).abs() < 1e-12 * expected[i].abs().max(1.0));
                    assert!((back[i] - e[i]).abs() < 1e-13);
                }
                let work = stress[0] * d[0] + stress[1] * d[1] + 2.0 * stress[2] * d[2];
                assert!((c.strain_product(e, d) - work).abs() < 1e-11 * work.abs());
                assert!((c.product(stress, c.stress(d)) - work).abs() < 1e-11 * work.abs());
                let squares: f64 = c.roots().apply(stress).iter().map(|x| x * x).sum();
                assert!((squares / c.unit() / c.product(stress, stress) - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn members_agree_on_all_that_is_asked_of_them() {
    for kinematics in [Kinematics::PlaneStrain, Kinematics::PlaneStress] {
        let nu = 0.3;
        let (a, b) = (Material::isotropic(kinematics, 7.0, nu), as_general(kinematics, 7.0, nu));
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-12 * x.abs().max(1.0), "{x} {y}");
        near(a.uniaxial(), b.uniaxial());
        // In plane strain the general member has that of a strip held across the plane.
        let of_strip = if kinematics == Kinematics::PlaneStrain { 1.0 - nu * nu } else { 1.0 };
        (0..2).for_each(|i| near(a.young()[i], of_strip * b.young()[i]));
        let s = [0.4, -1.3, 0.8];
        near(a.out_of_plane(s, [0.0; 2]), b.out_of_plane(s, [0.0; 2]));
        near(a.von_mises(s, [0.0; 2]), b.von_mises(s, [0.0; 2]));
        let pair = |m: &Material| m.stiffness(0.3).between([0.3, -2.0], [1.1, 0.7]);
        (0..4).for_each(|i| near(pair(&a)[i], pair(&b)[i]));
    }
}

#[test]
fn a_nearly_incompressible_body_keeps_its_pressure_whatever_its_member() {
    let nu = 0.5 - 1e-12;
    let (a, b) = [Material::isotropic, as_general].map(|of| of(Kinematics::PlaneStrain, 3.0, nu)).into();
    let stress = [1.0, 1.0, 0.0];
    assert!((a.product(stress, stress) / b.product(stress, stress) - 1.0).abs() < 1e-9);
    let e = [0.3, 0.2, 0.0];
    assert!((a.strain_product(e, e) / b.strain_product(e, e) - 1.0).abs() < 1e-9);
}

#[test]
fn a_frame_changes_components_and_no_energy() {
    let law = Orthotropic { young: [40.0, 2.0, 3.0], poisson: [0.3, 0.1, 0.4], shear: 1.5, angle: 20.0 };
    let turn = |angle: f64| {
        let law = Elasticity::Orthotropic(Orthotropic { angle: law.angle + angle, ..law });
        Material::new(Kinematics::PlaneStrain, &law)
    };
    let (sin, cos) = 35.0_f64.to_radians().sin_cos();
    let (own, expected) = (turn(0.0).in_frame([cos, sin]), turn(-35.0));
    let s = [0.4, -1.3, 0.8];
    assert!((own.product(s, s) - expected.product(s, s)).abs() < 1e-13);
    assert!((own.out_of_plane(s, [0.0; 2]) - expected.out_of_plane(s, [0.0; 2])).abs() < 1e-13);
    let (found, exact) = (own.stress(s), expected.stress(s));
    (0..3).for_each(|i| assert!((found[i] - exact[i]).abs() < 1e-12 * expected.uniaxial()));
    let between = expected.stiffness(1.0).between([1.0, 0.0], [1.0, 0.0]);
    assert!((between[0] - expected.stress([1.0, 0.0, 0.0])[0]).abs() < 1e-12 * between[0]);
}
