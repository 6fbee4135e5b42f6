//! Lemma 2.1 and (2.1)–(2.6): what λ_h transmits over Γ_K is what the loads on Ω″ ask for.
//!
//! Ω″ is the left block (the upper one in Example 3). All resultants of loads are worked out from the geometry here;
//! all resultants of λ_h are integrated over its stresses.

use crate::support::theory::contact::free_motions;
use crate::support::theory::meshes::{Family, blocks};
use crate::support::theory::quadrature::gauss;
use hypercircle::dual::{self, Condensed, Options};
use hypercircle::element::StressField;
use hypercircle::mesh::Triangulation;
use hypercircle::problem::Problem;
use hypercircle::scene::*;
use proptest::prelude::*;

/// P = value + gradient · x on a boundary.
type Parts = ([f64; 2], [[f64; 2]; 2]);

fn scene(supports: Vec<Support>, loads: &[(&str, Parts)], forces: [[f64; 2]; 2]) -> Scene {
    let body = |name: &str, young, poisson, force: [f64; 2]| Body {
        body_force: force.into(),
        ..Body::isotropic(name, young, poisson)
    };
    let draft = Draft {
        bodies: vec![body("left", 1.0, 0.3, forces[0]), body("right", 5.0, 0.1, forces[1])],
        supports,
        tractions: loads
            .iter()
            .map(|(on, (value, gradient))| Traction {
                on: on.to_string(),
                load: Load::Affine(Affine { value: *value, gradient: *gradient }),
                terms: Vec::new(),
            })
            .collect(),
        contacts: vec![Contact::new(
            ContactSides::Between(["left_east".to_string(), "right_west".to_string()]),
            Gap::Constant(0.0),
        )],
        ..Draft::new("reactions", Kinematics::PlaneStress, MeshSource::File("made".into()))
    };
    Scene::new(draft).expect("a valid scene")
}

fn solve(scene: Scene, shape: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> (Problem, StressField) {
    let raw = blocks(4, Family::Vaulted, shape);
    let (mesh, notes) = Triangulation::new(raw, &scene).expect("a valid mesh");
    let problem = Problem::new(scene, mesh, notes).expect("a valid problem");
    let found =
        dual::solve(&Condensed::default(), &problem, &free_motions(&problem), &Options::default()).expect("solves");
    (problem, found.stress)
}

/// ∫ T(λ_h) ds over a named side of a block, and the largest T_n and |T_t| at a quadrature point.
fn resultant(problem: &Problem, stress: &StressField, side: &str) -> ([f64; 2], f64, f64) {
    let mesh = &problem.mesh;
    let (mut sum, mut normal, mut shear) = ([0.0; 2], f64::NEG_INFINITY, 0.0_f64);
    for e in mesh.boundary(side) {
        let (length, n) = mesh.edge_frame(e);
        let t = mesh.edges[e].triangles[0].expect("a boundary edge has a triangle");
        let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).expect("its edge");
        for (s, w) in gauss(3) {
            let l = stress.at(t, sub, [1.0 - s, s, 0.0]);
            let traction = [l[0] * n[0] + l[2] * n[1], l[2] * n[0] + l[1] * n[1]];
            for c in 0..2 {
                sum[c] += w * length * traction[c];
            }
            normal = normal.max(traction[0] * n[0] + traction[1] * n[1]);
            shear = shear.max((traction[1] * n[0] - traction[0] * n[1]).abs());
        }
    }
    (sum, normal, shear)
}

/// ∫ P ds over a straight side.
fn total((value, gradient): Parts, a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let (length, m) = ((b[0] - a[0]).hypot(b[1] - a[1]), [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    [0, 1].map(|c| length * (value[c] + gradient[c][0] * m[0] + gradient[c][1] * m[1]))
}

fn affine() -> impl Strategy<Value = Parts> {
    let part = || prop::array::uniform2(-1.0..1.0_f64);
    (part(), part(), part()).prop_map(|(value, x, y)| (value, [x, y]))
}

fn small(v: f64) -> bool {
    v.abs() < 1e-10
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Examples 1 and 2: Γ_0 below Ω″, Γ_K leaning from (1.2, 0) to (0.8, 1), so that n″ has two positive components.
    #[test]
    fn a_leaning_contact_takes_the_force_along_the_roller(
        west in affine(), north in affine(), far in affine(),
        own in prop::array::uniform2(-1.0..1.0_f64), other in prop::array::uniform2(-1.0..1.0_f64), extra in 0.05..2.0_f64,
    ) {
        let (foot, head) = ([1.2, 0.0], [0.8, 1.0]);
        let area = 1.0;
        let volume = |f: [f64; 2]| f.map(|v| v * area);
        // The push on the west side is raised until V_1 = `extra`, as (2.4) asks.
        let mut west = west;
        let sum = |west: Parts| {
            let parts = [volume(own), total(west, [0.0, 1.0], [0.0, 0.0]), total(north, head, [0.0, 1.0])];
            [0, 1].map(|c| parts.iter().map(|p| p[c]).sum::<f64>())
        };
        west.0[0] += extra - sum(west)[0];
        let v = sum(west);
        prop_assert!((v[0] - extra).abs() < 1e-12);

        let supports = vec![
            Support { on: "left_south".to_string(), kind: SupportKind::ROLLER },
            Support { on: "right_east".to_string(), kind: SupportKind::CLAMPED },
        ];
        let loads = [("left_west", west), ("left_north", north), ("right_north", far)];
        let contact = |t: f64| 1.2 - 0.4 * t;
        let (problem, stress) = solve(scene(supports, &loads, [own, other]), |block, [s, t]| {
            [if block == 0 { s * contact(t) } else { contact(t) + s * (2.0 - contact(t)) }, t]
        });

        let (on_contact, largest, shear) = resultant(&problem, &stress, "left_east");
        let (on_roller, _, roller_shear) = resultant(&problem, &stress, "left_south");
        prop_assert!(largest < 1e-10 && small(shear) && small(roller_shear) && small(on_roller[0]));
        // (2.1), both components.
        for c in 0..2 {
            prop_assert!(small(on_contact[c] + v[c] + on_roller[c]), "{on_contact:?} {v:?} {on_roller:?}");
        }
        // (2.3): the mean of T_n on the straight Γ_K is g = −V_1 / ∫ dx_2.
        let length = (head[0] - foot[0]).hypot(head[1] - foot[1]);
        let n = [(head[1] - foot[1]) / length, (foot[0] - head[0]) / length];
        let mean = (on_contact[0] * n[0] + on_contact[1] * n[1]) / length;
        let g = -v[0] / (head[1] - foot[1]);
        prop_assert!(small(mean - g) && g <= 0.0, "{mean} for {g}");
        // (2.5): the constant shear g_1 = −V_1 / ∫ dx_1 has the same resultant along the roller.
        let g1 = -v[0] / (head[0] - foot[0]);
        let t1 = (head[0] - foot[0]) / length;
        prop_assert!(small(g1 * t1 * length - on_contact[0]));
        // What Ω″ gives Ω′ receives.
        let back = resultant(&problem, &stress, "right_west").0;
        prop_assert!(small(back[0] + on_contact[0]) && small(back[1] + on_contact[1]));
    }

    /// Example 3: Ω″ = [0, 1] × [1, 2] stands on Ω′, held by nothing else.
    #[test]
    fn a_lying_contact_takes_the_weight(value in -3.0..0.0_f64, slope in -2.0..2.0_f64, weight in -3.0..0.0_f64) {
        let v2 = weight + value + 0.5 * slope;
        let place = (0.5 * weight + 0.5 * value + slope / 3.0) / v2;
        // A linear pressure that does not pull has its resultant a third of an edge inside the contact, or farther.
        let third = 1.0 / 12.0;
        prop_assume!(v2 < -0.1 && (third + 0.01..1.0 - third - 0.01).contains(&place));
        let supports = vec![Support { on: "right_east".to_string(), kind: SupportKind::CLAMPED }];
        let loads = [("left_west", ([0.0, value], [[0.0, 0.0], [slope, 0.0]]))];
        let (problem, stress) = solve(scene(supports, &loads, [[0.0, weight], [0.3, -0.2]]), |block, [s, t]| {
            [t, if block == 0 { 2.0 - s } else { 1.0 - s }]
        });
        let (on_contact, largest, shear) = resultant(&problem, &stress, "left_east");
        prop_assert!(largest < 1e-10 && small(shear));
        // (2.6): T_n(λ″) = −T_2(λ″), and its mean on the unit length of Γ_K is g = V_2.
        prop_assert!(small(on_contact[0]) && small(-on_contact[1] - v2), "{on_contact:?} for {v2}");
    }
}
