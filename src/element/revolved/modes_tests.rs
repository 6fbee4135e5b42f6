use super::*;
use crate::elasticity::Elasticity;
use crate::element::revolved::{NEAR, Weighted};

const SHAPES: [(&str, [[f64; 2]; 3], usize); 7] = [
    ("general", [[1.0, 0.2], [2.1, 0.1], [1.4, 1.3]], 0),
    ("side along the axis", [[1.0, 0.0], [2.0, 0.1], [2.0, 1.2]], 0),
    ("side across the axis", [[1.0, 0.0], [2.0, 0.0], [1.3, 1.2]], 0),
    ("sliver", [[1.0, 0.0], [2.0, 0.001], [1.5, 0.011]], 0),
    ("far away", [[1e4, 0.0], [1e4 + 1.0, 0.0], [1e4 + 0.5, 1.2]], 0),
    ("corner on the axis", [[0.0, 0.0], [1.1, 0.2], [0.3, 1.1]], 4),
    ("side on the axis", [[0.0, 0.0], [1.0, 0.3], [0.0, 1.0]], 0),
];

fn law(nu: f64) -> Law {
    Law::of(&Elasticity::Isotropic { young: 3.0, poisson: nu }).expect("a law")
}

fn modes(ring: &Ring, nu: f64, force: [f64; 2]) -> Modes<'static> {
    let layout = ring.layout();
    let mut data = vec![0.0; layout.len()];
    ring.compute(&law(nu), ([force[0], 0.0], force[1]), None, layout.split(&mut data));
    Modes::owned(layout, data)
}

/// ∫ aλ:μ r over the triangle of two fields by nodal values, with F_r of each.
fn energy(ring: &Ring, nu: f64, a: (&[[f64; 3]], f64), b: (&[[f64; 3]], f64)) -> f64 {
    let (law, n) = (law(nu), lattice_len(ring.degree));
    let mut sum = 0.0;
    for sub in 0..3 {
        let g = gradients(ring.sub_corners(sub));
        let [a, b] = [a, b].map(|(v, f)| Weighted::new(ring.degree, &v[n * sub..][..n], &g, [f, 0.0]));
        for point in rule(ring.sub_radii(sub), 2 * ring.degree + 4, NEAR) {
            let weight = point.weight * point.radius * ring.unit.powi(2) / 3.0;
            sum += weight * law.product(a.stress(&point).0, b.stress(&point).0);
        }
    }
    sum
}

fn nodal(ring: &Ring, modes: &Modes<'_>, k: usize) -> Vec<[f64; 3]> {
    let mut s = vec![0.0; modes.parameters()];
    s[k] = 1.0;
    let mut out = vec![[0.0; 3]; 3 * lattice_len(ring.degree)];
    Ring::stresses(modes, &s, 0.0, &mut out);
    out
}

#[test]
fn dimensions_and_ranks_are_those_of_theory() {
    for p in 1..=4 {
        for (name, corners, _) in SHAPES {
            let ring = Ring::new(p, 0.0, corners);
            let raw = Raw::new(&ring);
            let fields = Fields::new(&ring, &raw);
            let ends = corners.iter().filter(|q| q[0] == 0.0).count();
            let met = match ends {
                0 => 6 * (p + 1) - 1,
                1 => 6 * (p + 1) - 5,
                _ => 4 * (p + 1) - 5,
            };
            assert_eq!(ring.layout().parameters, met, "{name}, degree {p}");
            assert_eq!(fields.columns.ncols() - fields.free, met, "{name}, degree {p}");
            if ends == 0 {
                assert_eq!(fields.columns.ncols(), 3 * (p + 1) * (p + 1), "{name}, degree {p}");
            }
            // Every traction without a resultant along the axis is met.
            let of = ring.tractions(&raw.nodal) * &fields.columns;
            let singular = of.svd(false, false).singular_values;
            assert!(singular.as_slice()[met - 1] > 1e-8 * singular[0], "{name}, degree {p}: {singular}");
        }
    }
}

#[test]
fn modes_are_orthonormal_and_balanced_along_the_axis() {
    for p in [1, 3] {
        for (name, corners, _) in SHAPES {
            for nu in [0.49999] {
                let ring = Ring::new(p, 0.0, corners);
                let modes = modes(&ring, nu, [0.0; 2]);
                let all: Vec<Vec<[f64; 3]>> = (0..modes.parameters()).map(|k| nodal(&ring, &modes, k)).collect();
                let allowed = if name == "far away" || name == "sliver" { 1e-4 } else { 1e-7 };
                for (i, a) in all.iter().enumerate() {
                    for (j, b) in all.iter().enumerate().take(i + 1) {
                        let found = energy(&ring, nu, (a, 0.0), (b, 0.0));
                        assert!((found - f64::from(i == j)).abs() < allowed, "{name} {p} {nu}: {i} {j} {found}");
                    }
                }
                for traction in modes.tractions() {
                    let of_side = |side: usize| {
                        let [a, b, _] = ring.sub_corners(side);
                        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                        let own = &traction[2 * side * (p + 1)..][..2 * (p + 1)];
                        length * own.iter().skip(1).step_by(2).sum::<f64>()
                    };
                    let size = traction.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
                    assert!((0..3).map(of_side).sum::<f64>().abs() < 1e-11 * size, "{name} {p} {nu}");
                }
            }
        }
    }
}

#[test]
fn the_particular_field_balances_a_force_and_is_orthogonal_to_all_modes() {
    let force = [0.7, -1.3];
    for p in [2, 3] {
        for (name, corners, _) in SHAPES {
            if name == "far away" {
                continue;
            }
            let ring = Ring::new(p, 0.0, corners);
            let modes = modes(&ring, 0.3, force);
            let mut own = vec![[0.0; 3]; 3 * lattice_len(p)];
            Ring::stresses(&modes, &vec![0.0; modes.parameters()], 1.0, &mut own);
            let norm = energy(&ring, 0.3, (&own, force[0]), (&own, force[0]));
            assert!((norm / modes.particular_energy() - 1.0).abs() < 1e-7, "{name} {p}");
            for k in 0..modes.parameters() {
                let found = energy(&ring, 0.3, (&own, force[0]), (&nodal(&ring, &modes, k), 0.0));
                assert!(found.abs() < 1e-7 * norm.sqrt(), "{name} {p}: {found}");
            }
            let resultant: f64 = (0..3)
                .map(|side| {
                    let [a, b, _] = ring.sub_corners(side);
                    let own = &modes.particular_traction()[2 * side * (p + 1)..][..2 * (p + 1)];
                    (b[0] - a[0]).hypot(b[1] - a[1]) * own.iter().skip(1).step_by(2).sum::<f64>() / (p + 1) as f64
                })
                .sum();
            let volume = ring.unit * ring.unit * ring.radii.iter().sum::<f64>() / 3.0;
            assert!((resultant + force[1] * volume).abs() < 1e-11 * volume, "{name} {p}: {resultant}");
        }
    }
}

#[test]
fn uniform_pressure_is_the_first_mode() {
    let ring = Ring::new(1, 0.0, SHAPES[0].1);
    let modes = modes(&ring, 0.499999, [0.0; 2]);
    let first = nodal(&ring, &modes, 0);
    for sub in 0..3 {
        for (value, l) in first[3 * sub..].iter().zip(lattice(1)) {
            let r = dot(ring.sub_radii(sub), l);
            let scale = first[0][0] / ring.sub_radii(0)[0];
            assert!((value[0] / r - scale).abs() < 1e-9 * scale.abs(), "{value:?} at {r}");
            assert!((value[1] / r - scale).abs() < 1e-9 * scale.abs() && value[2].abs() < 1e-9 * scale.abs());
        }
    }
}

/// A mode is as good as its balance inside, whatever the shape: jumps of Σ n, by nodal values, are rounding of the largest term.
#[test]
fn flat_and_narrow_triangles_have_modes_without_jumps() {
    for p in [1, 2, 4] {
        for size in [[1.0, 1e-2], [1.0, 1e-4], [1.0, 1e-6], [1e-5, 1.0]] {
            for at in [0.0, 0.5, 30.0] {
                let [a, b, c] = [[0.0, 0.0], [1.0, 0.1], [0.7, 1.0]].map(|[x, y]| [at + x * size[0], y * size[1]]);
                let ring = Ring::new(p, 0.0, [a, b, c]);
                let modes = modes(&ring, 0.3, [0.0; 2]);
                for k in 0..modes.parameters() {
                    let nodal = nodal(&ring, &modes, k);
                    let (jump, largest) = jump(&ring, &nodal);
                    assert!(jump < 4e-15 * largest, "{p} {size:?} {at} {k}: {jump:e} of {largest:e}");
                }
            }
        }
    }
}

/// The largest jump of Σ n over the segments inside, and the largest of the products it is made of.
fn jump(ring: &Ring, nodal: &[[f64; 3]]) -> (f64, f64) {
    let (p, n) = (ring.degree, lattice_len(ring.degree));
    let (mut jump, mut largest) = (0.0_f64, 0.0_f64);
    for corner in 0..3 {
        let [dr, dz] = ring.corners[corner];
        for k in 0..=p {
            let a = nodal[(corner + 1) % 3 * n + triangle::number([0, p - k, k])];
            let b = nodal[(corner + 2) % 3 * n + triangle::number([p - k, 0, k])];
            for terms in
                [[a[0] * dz, -a[2] * dr, -b[0] * dz, b[2] * dr], [a[2] * dz, -a[1] * dr, -b[2] * dz, b[1] * dr]]
            {
                jump = jump.max(terms.iter().sum::<f64>().abs());
                largest = terms.iter().fold(largest, |m, x| m.max(x.abs()));
            }
        }
    }
    (jump, largest)
}
