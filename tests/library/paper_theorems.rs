//! Theorems 2.1 and 2.2: one field for every load in equilibrium, its bound c(α), and the mapping r_h.

use crate::support::theory::constant::{self, Row, equilibrium, triangle_with_angles};
use crate::support::theory::contact::Solution;
use crate::support::theory::fields::FIELDS;
use crate::support::theory::meshes::Family;
use crate::support::theory::quadrature::{area, gauss, sub_corners};
use hypercircle::element::{
    Block, EquilibriumElement, Material, interpolant, parameters_from_tractions, side_projection,
};
use hypercircle::load::BodyForce;
use hypercircle::scene::Kinematics;
use nalgebra::{DMatrix, DVector, SVector};
use proptest::prelude::*;

type Triangle = [[f64; 2]; 3];

/// Angles from 3° up, any position of the frame.
fn triangle() -> impl Strategy<Value = Triangle> {
    (3.0..60.0_f64, 0.0..1.0_f64, 0.0..360.0_f64)
        .prop_map(|(alpha, s, theta)| triangle_with_angles(alpha, alpha + s * (180.0 - 3.0 * alpha), theta))
}

/// The row of traction component `c` at `x` on a side with normal `n`, in the seven β of M(K).
fn traction_row(x: [f64; 2], n: [f64; 2], c: usize) -> [f64; 7] {
    let tau = [[1.0, x[0], x[1], 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, x[0], x[1], 0.0]];
    let shear = [0.0, -x[1], 0.0, 0.0, 0.0, -x[0], 1.0];
    std::array::from_fn(
        |k| if c == 0 { tau[0][k] * n[0] + shear[k] * n[1] } else { shear[k] * n[0] + tau[1][k] * n[1] },
    )
}

fn normal(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    [(b[1] - a[1]) / length, (a[0] - b[0]) / length]
}

/// The definition of N(K) and of the load, without any basis: 12 conditions of continuity on the segments 0a_i and 12
/// traction values, for the 21 parameters β of the three subtriangles.
fn conditions(p: Triangle) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(24, 21);
    for i in 0..3 {
        let q = sub_corners(p, i);
        for (end, x) in [q[0], q[1]].into_iter().enumerate() {
            for c in 0..2 {
                for (k, v) in traction_row(x, normal(q[0], q[1]), c).into_iter().enumerate() {
                    rows[(12 + 4 * i + 2 * end + c, 7 * i + k)] = v;
                }
            }
        }
        // Subtriangles i and i + 1 share the segment from a_{i+2} to the centroid.
        let next = (i + 1) % 3;
        for (end, x) in [q[1], q[2]].into_iter().enumerate() {
            for c in 0..2 {
                for (k, v) in traction_row(x, normal(q[1], q[2]), c).into_iter().enumerate() {
                    rows[(4 * i + 2 * end + c, 7 * i + k)] = v;
                    rows[(4 * i + 2 * end + c, 7 * next + k)] = -v;
                }
            }
        }
    }
    rows
}

/// Stresses at the corners of the subtriangles from the β of [`conditions`], nine nodes.
fn nodal(p: Triangle, beta: &DVector<f64>) -> Vec<[f64; 3]> {
    let value = |i: usize, x: [f64; 2]| {
        let b = |k: usize| beta[7 * i + k];
        [b(0) + b(1) * x[0] + b(2) * x[1], b(3) + b(4) * x[0] + b(5) * x[1], b(6) - b(5) * x[0] - b(1) * x[1]]
    };
    (0..3).flat_map(|i| sub_corners(p, i).map(|x| value(i, x))).collect()
}

/// A load with entries in [−1, 1], made self-equilibrated.
fn balanced(p: Triangle, raw: [f64; 12]) -> [f64; 12] {
    let g = equilibrium(p);
    let t = SVector::<f64, 12>::from_column_slice(&raw);
    let gram = (g * g.transpose()).try_inverse().expect("three independent conditions");
    let t = t - g.transpose() * (gram * (g * t));
    let largest = t.amax().max(1.0);
    std::array::from_fn(|i| t[i] / largest)
}

fn block_field(p: Triangle, t: &[f64; 12]) -> (Vec<[f64; 3]>, f64) {
    let modes = Block.modes(p, &Material::isotropic(Kinematics::PlaneStrain, 1.0, 0.3), &BodyForce::NONE);
    let (s, left) = parameters_from_tractions(&modes, t).expect("a triangle");
    let mut out = vec![[0.0; 3]; 9];
    Block.stresses(p, &BodyForce::NONE, &modes, &s, 0.0, &mut out);
    (out, left)
}

/// Nearly equilateral, with singular values that nearly coincide.
#[test]
fn the_norm_is_attained_where_the_triangle_is_nearly_symmetric() {
    let p = [[0.0, 0.0], [-0.9996667647802614, 0.025813937974777074], [-0.5226176523323474, -0.8519131872350232]];
    let (norm, worst) = constant::norm(p);
    let mut given = DVector::zeros(24);
    given.rows_mut(12, 12).copy_from_slice(&worst);
    let beta = conditions(p).svd(true, true).solve(&given, 0.0).expect("factors");
    let found = nodal(p, &beta).iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!((found - norm).abs() < 1e-6 * norm, "{found} for {norm}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// Existence and uniqueness, from the definition of N(K): 21 parameters, 24 conditions of which three are implied
    /// by equilibrium. The block element finds the same field.
    #[test]
    fn one_field_meets_every_load_in_equilibrium(p in triangle(), raw in prop::array::uniform12(-1.0..1.0_f64)) {
        let t = balanced(p, raw);
        let system = conditions(p);
        let svd = system.clone().svd(true, true);
        let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
        prop_assert!(smallest > 1e-6 * largest, "more than one field: {smallest:e} of {largest:e}");

        let mut given = DVector::zeros(24);
        given.rows_mut(12, 12).copy_from_slice(&t);
        let beta = svd.solve(&given, 0.0).expect("factors");
        let left = (system * &beta - given).amax();
        prop_assert!(left < 1e-10, "no field: {left:e}");

        let (expected, (found, left)) = (nodal(p, &beta), block_field(p, &t));
        prop_assert!(left < 1e-10);
        let size = expected.iter().flatten().fold(1.0_f64, |m, v| m.max(v.abs()));
        for (e, f) in expected.iter().flatten().zip(found.iter().flatten()) {
            prop_assert!((e - f).abs() < 1e-9 * size, "{e} and {f}");
        }
    }

    /// Without equilibrium there is no field.
    #[test]
    fn no_field_meets_a_load_out_of_equilibrium(p in triangle(), motion in 0..3_usize) {
        let g = equilibrium(p);
        let row = g.row(motion).transpose();
        let t: [f64; 12] = std::array::from_fn(|i| row[i] / row.amax());
        prop_assert!(block_field(p, &t).1 > 1e-3);
    }

    /// The operator norm behind c(α) is attained by a load that the definition of N(K) knows, and exceeded by none.
    #[test]
    fn the_norm_is_attained_and_not_exceeded(p in triangle(), raw in prop::array::uniform12(-1.0..1.0_f64)) {
        let (norm, worst) = constant::norm(p);
        let g = equilibrium(p);
        prop_assert!(worst.iter().all(|v| v.abs() < 1.0 + 1e-7));
        prop_assert!((g * SVector::<f64, 12>::from_column_slice(&worst)).amax() < 1e-9);
        let largest = |t: &[f64; 12]| {
            let mut given = DVector::zeros(24);
            given.rows_mut(12, 12).copy_from_slice(t);
            let beta = conditions(p).svd(true, true).solve(&given, 0.0).expect("factors");
            nodal(p, &beta).iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()))
        };
        prop_assert!((largest(&worst) - norm).abs() < 1e-6 * norm, "{} for {norm}", largest(&worst));
        prop_assert!(largest(&balanced(p, raw)) <= norm * (1.0 + 1e-9));
    }

    /// The projection leaves a remainder that no linear function sees.
    #[test]
    fn side_projections_are_orthogonal(
        a in prop::array::uniform2(-1.0..1.0_f64), d in prop::array::uniform2(-0.4..0.4_f64), k in 0.0..3.0_f64,
    ) {
        // Short enough for the rule of the library to be exact to round-off.
        let b = [a[0] + d[0], a[1] + d[1]];
        let f = |x: [f64; 2]| [(k * x[0]).exp() * x[1].sin(), (k * x[0] - x[1]).cos()];
        let [first, second] = side_projection(a, b, f);
        for hat in 0..2 {
            let mut left = [0.0; 2];
            for (s, w) in gauss(12) {
                let q = if hat == 0 { 1.0 - s } else { s };
                let value = f([0, 1].map(|i| a[i] + s * (b[i] - a[i])));
                for c in 0..2 {
                    left[c] += w * q * (value[c] - (1.0 - s) * first[c] - s * second[c]);
                }
            }
            prop_assert!(left[0].abs() < 1e-9 && left[1].abs() < 1e-9, "{left:?}");
        }
    }
}

#[derive(serde::Deserialize)]
struct Table {
    rows: Vec<Row>,
}

/// The committed table holds the worst of many triangles: few triangles come close to it and none goes beyond.
#[test]
fn the_table_of_c_alpha_is_the_worst_there_is() {
    let table: Table = serde_json::from_str(include_str!("../../docs/data/element_constant.json")).expect("a table");
    assert!(table.rows.len() >= 8);
    for row in &table.rows {
        let again = constant::worst(row.angle, 7, 20);
        assert!(again.constant <= 1.01 * row.constant, "{again:?} beyond {row:?}");
        assert!(again.constant >= 0.9 * row.constant, "{again:?} far from {row:?}");
        let [beta, theta] = row.worst;
        let own = constant::norm(triangle_with_angles(row.angle, beta, theta)).0;
        assert!((own - row.constant).abs() < 1e-6 * own);
        // What docs/theory.md says: c(α) grows like 1/sin²α and no faster.
        assert!((3.0..6.0).contains(&row.times_sin_squared), "{row:?}");
    }
}

#[test]
fn the_airy_fields_balance_themselves() {
    let d = 1e-5;
    for (name, stress) in FIELDS {
        for p in [[0.3, 0.4], [-0.7, 0.9], [0.1, 0.05]] {
            let slope = |c: usize, dx: f64, dy: f64| {
                (stress([p[0] + dx, p[1] + dy])[c] - stress([p[0] - dx, p[1] - dy])[c]) / (2.0 * d)
            };
            assert!((slope(0, d, 0.0) + slope(2, 0.0, d)).abs() < 1e-6, "{name}");
            assert!((slope(2, d, 0.0) + slope(1, 0.0, d)).abs() < 1e-6, "{name}");
        }
    }
}

/// r_h of a self-equilibrated linear field is that field, on any mesh.
#[test]
fn r_h_reproduces_linear_fields() {
    let mesh = Solution::grazing().problem(3, Family::Shaken).mesh;
    let stress = |x: [f64; 2]| [1.0 + 2.0 * x[0] - x[1], -0.5 + 0.3 * x[0] + 0.7 * x[1], 0.4 - 0.7 * x[0] - 2.0 * x[1]];
    let field = interpolant(&mesh, |_, x| stress(x));
    for t in 0..mesh.triangles.len() {
        for sub in 0..3 {
            for (value, x) in field.block(t)[3 * sub..].iter().zip(sub_corners(mesh.corners(t), sub)) {
                for (v, e) in value.iter().zip(stress(x)) {
                    assert!((v - e).abs() < 1e-11);
                }
            }
        }
    }
}

/// r_h τ has continuous tractions, no divergence, and on every edge the force and the moment of τ.
#[test]
fn r_h_lands_in_the_space_of_the_elements() {
    let mesh = Solution::grazing().problem(4, Family::Shaken).mesh;
    for (name, stress) in FIELDS {
        let field = interpolant(&mesh, |_, x| stress(x));
        for (e, edge) in mesh.edges.iter().enumerate() {
            let (length, n) = mesh.edge_frame(e);
            let [a, b] = edge.vertices.map(|v| mesh.points[v]);
            for t in edge.triangles.into_iter().flatten() {
                let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).expect("its edge");
                let turned = mesh.triangles[t][(sub + 1) % 3] != edge.vertices[0];
                let (mut force, mut moment) = ([0.0; 2], [0.0; 2]);
                for (s, w) in gauss(8) {
                    let bary = if turned { [s, 1.0 - s, 0.0] } else { [1.0 - s, s, 0.0] };
                    let (l, tau) = (field.at(t, sub, bary), stress([0, 1].map(|c| a[c] + s * (b[c] - a[c]))));
                    let d = [l[0] - tau[0], l[1] - tau[1], l[2] - tau[2]];
                    for (c, v) in [d[0] * n[0] + d[2] * n[1], d[2] * n[0] + d[1] * n[1]].into_iter().enumerate() {
                        force[c] += w * length * v;
                        moment[c] += w * length * s * v;
                    }
                }
                for v in force.into_iter().chain(moment) {
                    assert!(v.abs() < 1e-8, "{name}: {v:e} on edge {e}");
                }
            }
        }
        for t in 0..mesh.triangles.len() {
            for sub in 0..3 {
                let q = sub_corners(mesh.corners(t), sub);
                let v = &field.block(t)[3 * sub..3 * sub + 3];
                // Gradient of a linear function from its corner values.
                let slope = |c: usize, axis: usize| {
                    let y = |i: usize| q[i][1 - axis];
                    let sum: f64 = (0..3).map(|i| v[i][c] * (y((i + 1) % 3) - y((i + 2) % 3))).sum();
                    (if axis == 0 { sum } else { -sum }) / (2.0 * area(q))
                };
                assert!((slope(0, 0) + slope(2, 1)).abs() < 1e-9 && (slope(2, 0) + slope(1, 1)).abs() < 1e-9, "{name}");
            }
        }
    }
}
