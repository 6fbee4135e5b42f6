//! The inside of each triangle: the coefficients that minimise the local energy with the boundary fixed.

use rayon::prelude::*;

use super::energies::TriangleEnergy;
use super::model::Model;
use crate::bounds::upper::admissible::nodes::{NodalValues, elevated};
use crate::element::Displacement;
use crate::element::displacement::{SplitNodes, divided, inner_coefficient, side_nodes};
use crate::element::polynomial::{side, triangle};
use crate::problem::Problem;

/// Completes values at the nodes to a displacement on the split triangles, with what `model` has eliminated. It is the same for
/// triangles of nearly the same shape; energies at their minimum are no different to the last digit.
pub fn fill(problem: &Problem, field: &NodalValues, model: &Model) -> Displacement {
    completed(problem, field, |t, k, block| inside(k, model.energies.of(t), model.translations, block))
}

/// As [`fill`], with coefficients inside each triangle that `fill` found elsewhere.
pub fn filled_with<'a>(
    problem: &Problem,
    field: &NodalValues,
    found: impl Fn(usize) -> &'a [[f64; 2]] + Sync,
) -> Displacement {
    completed(problem, field, |t, k, block| {
        let (boundary, inside) = block.split_at_mut(3 * k);
        // There and back, as there: not a digit is another.
        let base = boundary[0];
        let base = [0, 1].map(|c| problem.section().translations()[c] * base[c]);
        about(base, boundary);
        back(base, boundary);
        inside.copy_from_slice(found(t));
    })
}

/// The displacement with the sides of `field`, its inside set by `inside`, which is given triangle, degree and coefficients.
fn completed(
    problem: &Problem,
    field: &NodalValues,
    inside: impl Fn(usize, usize, &mut [[f64; 2]]) + Sync,
) -> Displacement {
    let mesh = &problem.mesh;
    let degree = |t: usize| field.nodes.triangle_degree(mesh, t);
    let mut displacement = Displacement::zeros((0..mesh.triangles.len()).map(degree));
    displacement.blocks_mut().into_par_iter().enumerate().with_min_len(32).for_each(|(t, block)| {
        let k = degree(t);
        for i in 0..3 {
            let from = mesh.triangles[t][(i + 1) % 3];
            let nodes = field.nodes.along(mesh, mesh.triangle_edges[t][i], from);
            let raised = nodes.len() <= k;
            let own = nodes.map(|n| field.values[n]);
            if raised {
                let own: Vec<[f64; 2]> = own.collect();
                side_nodes(k, i).zip(elevated(&own, k)).for_each(|(n, value)| block[n] = value);
            } else {
                side_nodes(k, i).zip(own).for_each(|(n, value)| block[n] = value);
            }
        }
        inside(t, k, block);
    });
    displacement
}

/// Sets the inner coefficients, those on the boundary being given. Where nothing could be eliminated there is no unique minimum,
/// and the quadratic is as good as any.
fn inside(k: usize, energy: Option<TriangleEnergy<'_>>, translations: [f64; 2], block: &mut [[f64; 2]]) {
    let base = [0, 1].map(|c| translations[c] * block[0][c]);
    about(base, &mut block[..3 * k]);
    match energy {
        Some(energy) => {
            let (boundary, inside) = block.as_flattened_mut().split_at_mut(6 * k);
            energy.inside(boundary, inside);
        }
        None => quadratic(k, block),
    }
    back(base, block);
}

/// Counts values from that at the first corner: rigid translations cost no digits.
fn about(base: [f64; 2], values: &mut [[f64; 2]]) {
    values.iter_mut().for_each(|v| *v = [v[0] - base[0], v[1] - base[1]]);
}

fn back(base: [f64; 2], values: &mut [[f64; 2]]) {
    values.iter_mut().for_each(|v| *v = [v[0] + base[0], v[1] + base[1]]);
}

/// Sets the inner coefficients to those of the quadratic with the values of the boundary at corners and midpoints.
fn quadratic(k: usize, block: &mut [[f64; 2]]) {
    let inner = [0, 1, 2].map(|i| {
        let weights = (0..=k).map(|j| side::bernstein(k, j, 0.5));
        let side = side_nodes(k, i).map(|n| block[n]);
        let middle = weights.zip(side).fold([0.0; 2], |sum, (w, u)| [sum[0] + w * u[0], sum[1] + w * u[1]]);
        inner_coefficient(block[(i + 1) % 3], middle, block[(i + 2) % 3])
    });
    let (towards, centre) = divided([block[0], block[1], block[2]], inner);
    for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
        let (a, b) = ((sub + 1) % 3, (sub + 2) % 3);
        let quadratic = [block[a], inner[sub], towards[a], block[b], towards[b], centre];
        for (&node, alpha) in nodes.iter().zip(triangle::indices(k)) {
            if node >= 3 * k {
                let weights = triangle::indices(2).map(|beta| triangle::elevation(beta, alpha));
                block[node] =
                    weights.zip(quadratic).fold([0.0; 2], |sum, (w, u)| [sum[0] + w * u[0], sum[1] + w * u[1]]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::upper::energy::stiffness::Stiffness;
    use crate::element::Material;
    use crate::element::displacement::MOST;
    use crate::element::geometry::sub_corners;
    use crate::scene::Kinematics;

    const CORNERS: [[f64; 2]; 3] = [[0.3, -0.2], [1.1, 0.1], [0.4, 0.7]];

    fn times([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
        [a * c - b * d, a * d + b * c]
    }

    /// u = (Re z^k, −Im z^k) balances no force in any material. Its coefficients are products of the corners as complex
    /// numbers.
    #[test]
    fn harmonic_polynomials_are_found_from_their_boundary() {
        for nu in [0.3, 0.499999] {
            let material = Material::isotropic(Kinematics::PlaneStrain, 3.0, nu);
            // Volume changes resist 1/(1 − 2ν) times as much as shear, and digits go by that.
            let allowed = 1e-12 / (1.0 - 2.0 * nu);
            for k in 2..=MOST {
                let mut exact = Displacement::zeros([k]);
                for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
                    let q = sub_corners(CORNERS, sub);
                    for (&node, alpha) in nodes.iter().zip(triangle::indices(k)) {
                        let factors = (0..3).flat_map(|i| std::iter::repeat_n(q[i], alpha[i]));
                        let [x, y] = factors.fold([1.0, 0.0], times);
                        exact.block_mut(0)[node] = [x, -y];
                    }
                }
                let mut found = exact.block(0).to_vec();
                found[3 * k..].fill([7.0, -5.0]);
                let stiffness = Stiffness::new(k, [k; 3], CORNERS, &material).expect("a unique minimum");
                let (load, within) = (vec![0.0; stiffness.size], vec![0.0; stiffness.inside]);
                inside(k, Some(TriangleEnergy::new(&stiffness, &load, &within)), [1.0; 2], &mut found);
                for (a, b) in found.iter().zip(exact.block(0)) {
                    assert!((a[0] - b[0]).hypot(a[1] - b[1]) < allowed, "degree {k}: {a:?} is not {b:?}");
                }
            }
        }
    }
    #[test]
    fn without_a_unique_minimum_the_inside_follows_a_quadratic_on_the_boundary() {
        let along = |[x, y]: [f64; 2]| [0.3 + x * y - 2.0 * x, y * y - 0.5 * x * x + y];
        for k in 2..=MOST {
            let mut exact = Displacement::zeros([k]);
            for (sub, nodes) in SplitNodes::of(k).subs.iter().enumerate() {
                let q = sub_corners(CORNERS, sub);
                let middle = |i: usize, j: usize| [0, 1].map(|c| 0.5 * (q[i][c] + q[j][c]));
                let quadratic: Vec<[f64; 2]> = triangle::indices(2)
                    .map(|beta| match (0..3).filter(|i| beta[*i] > 0).collect::<Vec<_>>()[..] {
                        [i, j] => {
                            let (ends, between) = ([along(q[i]), along(q[j])], along(middle(i, j)));
                            [0, 1].map(|c| 2.0 * between[c] - 0.5 * (ends[0][c] + ends[1][c]))
                        }
                        ref one => along(q[one[0]]),
                    })
                    .collect();
                for (&node, alpha) in nodes.iter().zip(triangle::indices(k)) {
                    let weights = triangle::indices(2).map(|beta| triangle::elevation(beta, alpha));
                    exact.block_mut(0)[node] =
                        weights.zip(&quadratic).fold([0.0; 2], |sum, (w, u)| [sum[0] + w * u[0], sum[1] + w * u[1]]);
                }
            }
            let mut found = exact.block(0).to_vec();
            found[3 * k..].fill([7.0, -5.0]);
            inside(k, None, [1.0; 2], &mut found);
            for (a, b) in found.iter().zip(exact.block(0)) {
                assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-13, "degree {k}: {a:?} is not {b:?}");
            }
        }
    }
}
