//! The strain energy of a field on a quadrilateral of a body of revolution, enclosed.
//!
//! With r the distance from the axis, S the strain in the plane of the figure times the determinant d, and u the radial displacement,
//! density times r d is
//!
//! ½ S:c S r/d + u c_t:S + ½ c_tt u² d/r:
//!
//! a rational function with the denominator d, a polynomial, and one with the denominator r. Gauss rules err on both fractions by what
//! `enclosure.rs` has, with the least |d| and |r| on the ellipse; the polynomial is of degree 4 and integrated exactly. On a side along the axis
//! u = (1 ∓ ξ) w and r = (1 ∓ ξ) r', and the last fraction is that of w and r'. At a single corner on the axis, where |u| is at most
//! U_s x + U_t y and r at least R_s x + R_t y, x and y counted from it, u²/r is at most U_s² x/R_s + U_t² y/R_t; parts around it are halved
//! until that is next to nothing.

use super::enclosure::{CUTS, Enclosed, FEWEST, MOST, Part, WHOLE, chebyshev, least_along, sizes_on};
use crate::element::polynomial::quadrature::segment_rule;
use crate::element::revolved::{Law, work};
use crate::element::{Material, Quadrilateral};

/// Part of the energy at which its error is small enough.
const ENOUGH: f64 = 1e-15;

/// ½∫ c e(v):e(v) r, per radian, with the axis at the first coordinate `axis`. The error is infinite where a point of the axis leaves it.
pub fn strain_energy(cell: &Quadrilateral, material: &Material, axis: f64) -> Enclosed {
    let turned = Turned::new(cell, material.revolved(), axis);
    if turned.leaves_the_axis() {
        return Enclosed { error: f64::INFINITY, ..turned.by_rule(WHOLE, MOST) };
    }
    turned.part(WHOLE, CUTS)
}

/// ½∫ cε0:ε0 r − ∫ cε0:e(v) r over a quadrilateral, and the same with the sizes of all terms: polynomials of degree 5 at most along ξ and η.
pub fn of_initial(cell: &Quadrilateral, material: &Material, axis: f64) -> [f64; 2] {
    let (rule, law) = (segment_rule(7), material.revolved());
    let mut sum = [0.0; 2];
    for (s, v) in rule {
        for (t, w) in rule {
            let at = [2.0 * s - 1.0, 2.0 * t - 1.0];
            let (of_v, place, u) = (cell.at(at), cell.position(at), cell.value(at)[0]);
            let (radius, d) = (place[0] - axis, of_v.determinant);
            let initial = material.initial().around(place);
            let held = law.stress(initial);
            let [rr, zz, rz] = of_v.strain.map(|e| radius * e);
            let own = 0.5 * d * radius * work(initial, held);
            let size = held.iter().map(|s| s.abs()).sum::<f64>() * (radius * of_v.spread + d * u.abs());
            sum[0] += 4.0 * v * w * (own - work([rr, zz, d * u, rz], held));
            sum[1] += 4.0 * v * w * (own.abs() + size);
        }
    }
    sum
}

/// The side of the square that lies on the axis: the direction that leaves it, and where it is.
type Side = (usize, f64);

struct Turned<'a> {
    cell: &'a Quadrilateral,
    law: Law,
    axis: f64,
    side: Option<Side>,
}

impl<'a> Turned<'a> {
    fn new(cell: &'a Quadrilateral, law: Law, axis: f64) -> Self {
        let on_axis = cell.corners().map(|corner| corner[0] == axis);
        let sides = [(1, -1.0), (0, 1.0), (1, 1.0), (0, -1.0)];
        let side = (0..4).find(|&i| on_axis[i] && on_axis[(i + 1) % 4]).map(|i| sides[i]);
        Turned { cell, law, axis, side }
    }

    fn leaves_the_axis(&self) -> bool {
        let on = |i: usize| self.cell.corners()[i % 4][0] == self.axis;
        let mut there = (0..8).filter(|&i| if i < 4 { on(i) } else { on(i) && on(i + 1) });
        there.any(|i| self.cell.nine()[i][0] != 0.0)
    }

    /// r at a point of the square.
    fn radius(&self, at: [f64; 2]) -> f64 {
        let of = |i: usize| self.cell.corners()[i][0] - self.axis;
        let [low, high] = [[0.5 * (1.0 - at[0]), 0.5 * (1.0 - at[1])], [0.5 * (1.0 + at[0]), 0.5 * (1.0 + at[1])]];
        low[0] * low[1] * of(0) + high[0] * low[1] * of(1) + high[0] * high[1] * of(2) + low[0] * high[1] * of(3)
    }

    /// u at a point of the square.
    fn radial(&self, at: [f64; 2]) -> f64 {
        self.cell.value(at)[0]
    }

    /// The distance from the side on the axis in the square, 1 where there is none.
    fn off(&self, at: [f64; 2]) -> f64 {
        self.side.map_or(1.0, |(direction, end)| 1.0 - end * at[direction])
    }

    /// u and r without the factor that vanishes along a side on the axis.
    fn divided(&self, at: [f64; 2]) -> [f64; 2] {
        let Some((direction, end)) = self.side else { return [self.radial(at), self.radius(at)] };
        let with = |place: f64| {
            let mut point = at;
            point[direction] = place;
            point
        };
        // u is 0, u(0) and u(−end) at three places, r linear.
        let [near, far] = [self.radial(with(0.0)), 0.5 * self.radial(with(-end))];
        [near + (far - near) * (-end * at[direction]), 0.5 * self.radius(with(-end))]
    }

    fn part(&self, part: Part, cuts: usize) -> Enclosed {
        let bound = Bound::new(self, part);
        let rough = self.by_rule(part, FEWEST);
        let enough = ENOUGH * rough.sensitivity;
        let points = (FEWEST..=MOST).find(|points| bound.error(*points) <= enough);
        // Where numbers overflow no rule helps.
        if points.is_none() && cuts > 0 && enough.is_finite() {
            let [one, other] = part.halves(bound.worse()).map(|half| self.part(half, cuts - 1));
            return one.and(other);
        }
        let points = points.unwrap_or(MOST);
        Enclosed { error: bound.error(points), ..self.by_rule(part, points) }
    }

    fn by_rule(&self, part: Part, points: usize) -> Enclosed {
        let rule = segment_rule(2 * points - 1);
        let mut sum = Enclosed::default();
        for (s, v) in rule {
            for (t, w) in rule {
                let place = part.at([2.0 * s - 1.0, 2.0 * t - 1.0]);
                let (at, radius) = (self.cell.at(place), self.radius(place));
                let (d, [own, reduced]) = (at.determinant, self.divided(place));
                let hoop = own / reduced;
                let e = [at.strain[0] / d, at.strain[1] / d, hoop, at.strain[2] / d];
                let weight = 4.0 * part.area() * v * w * d * radius;
                let stress: f64 = self.law.stress(e).iter().map(|s| s.abs()).sum();
                sum.value += 0.5 * weight * self.law.strain_product(e, e);
                sum.sensitivity += weight * stress * (at.spread / d + hoop.abs());
            }
        }
        sum
    }
}

/// Quantities that bound the error of rules on a part of the square.
struct Bound {
    /// |c_ij| in the plane, with the shear counted twice, and |c_tt|.
    moduli: [[f64; 3]; 3],
    hoop: f64,
    /// Chebyshev coefficients in size: of the strain times the determinant, component by component, and of u or w.
    strain: [[[f64; 3]; 3]; 3],
    radial: [[f64; 3]; 3],
    /// d, r, r or r', and the factor that vanishes along a side on the axis, as c₀ + c₁s + c₂t + c₃st.
    determinant: [f64; 4],
    radius: [f64; 4],
    reduced: [f64; 4],
    off: [f64; 4],
    /// No value of ½ c_tt u² d/r beside a corner on the axis is larger.
    corner: f64,
    area: f64,
}

impl Bound {
    fn new(turned: &Turned<'_>, part: Part) -> Self {
        let unit = |i: usize| [0, 1, 2, 3].map(|j| if i == j { 1.0 } else { 0.0 });
        let columns = [0, 1, 3].map(|i| turned.law.stress(unit(i)));
        let counted = |i: usize| if i == 2 { 2.0 } else { 1.0 };
        let moduli = [0, 1, 2].map(|i| [0, 1, 3].map(|j| counted(i) * columns[i][j].abs()));
        let hoop = turned.law.stress(unit(2))[2].abs();
        let biquadratic = |of: &dyn Fn([f64; 2]) -> f64| {
            let samples = [-1.0, 0.0, 1.0].map(|s| [-1.0, 0.0, 1.0].map(|t| of(part.at([s, t]))));
            let along_t = samples.map(chebyshev);
            let columns = [0, 1, 2].map(|j| chebyshev(along_t.map(|row| row[j])));
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i].abs()))
        };
        let bilinear = |of: &dyn Fn([f64; 2]) -> f64| {
            let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|at| of(part.at(at)));
            [0.25 * (a + b + c + d), 0.25 * (b - a + c - d), 0.25 * (c - b + d - a), 0.25 * (a - b + c - d)]
        };
        let strain = [0, 1, 2].map(|c| biquadratic(&|at| turned.cell.at(at).strain[c]));
        let radial = biquadratic(&|at| turned.divided(at)[0]);
        let determinant = bilinear(&|at| turned.cell.at(at).determinant);
        let reduced = bilinear(&|at| turned.divided(at)[1]);
        let largest = |c: [f64; 4]| c.iter().map(|c| c.abs()).sum::<f64>();
        // The corner of least radius.
        let lowest = part.at([-reduced[1].signum(), -reduced[2].signum()]);
        let at_corner = if turned.radius(lowest) == 0.0 { beside_axis(radial, reduced) } else { f64::INFINITY };
        let corner = 0.5 * hoop * largest(determinant) * at_corner;
        Bound {
            moduli,
            hoop,
            strain,
            radial,
            determinant,
            radius: bilinear(&|at| turned.radius(at)),
            reduced,
            off: bilinear(&|at| turned.off(at)),
            corner,
            area: part.area(),
        }
    }

    /// By how much a rule with so many points in each direction can be off.
    fn error(&self, points: usize) -> f64 {
        let plane: f64 = [0, 1].map(|direction| self.of_plane(direction, points)).iter().sum();
        let hoop: f64 = [0, 1].map(|direction| self.of_hoop(direction, points)).iter().sum();
        // Integral and rule both lie between zero and what the largest value gives.
        2.0 * self.area * (plane + hoop.min(2.0 * self.corner))
    }

    /// The direction along which to halve: the one that errs most, or along which r or d changes most.
    fn worse(&self) -> usize {
        let errors = [0, 1].map(|direction| self.of_plane(direction, MOST) + self.of_hoop(direction, MOST));
        let share = |c: [f64; 4], direction: usize| (c[1 + direction].abs() + c[3].abs()) / c[0].abs();
        let changes = [0, 1].map(|i| share(self.determinant, i).max(share(self.reduced, i)));
        let [one, other] = if errors.iter().all(|e| e.is_infinite()) { changes } else { errors };
        usize::from(other > one)
    }

    fn of_plane(&self, direction: usize, points: usize) -> f64 {
        let numerator = |rho: f64| {
            let sizes = self.strain.map(|component| sizes_on(&component, direction, rho));
            let product = |i: usize, j: usize| self.moduli[i][j] * sizes[i] * sizes[j];
            let stored: f64 = (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| product(i, j)).sum();
            0.5 * stored * linear_on(self.radius, direction, rho)
        };
        least_along(denominator(self.determinant, direction), points, numerator)
    }

    fn of_hoop(&self, direction: usize, points: usize) -> f64 {
        let numerator = |rho: f64| {
            let factors = linear_on(self.determinant, direction, rho) * linear_on(self.off, direction, rho);
            0.5 * self.hoop * sizes_on(&self.radial, direction, rho).powi(2) * factors
        };
        least_along(denominator(self.reduced, direction), points, numerator)
    }
}

/// No value of a bilinear function on the ellipse of parameter `rho` along `direction` is larger.
fn linear_on(c: [f64; 4], direction: usize, rho: f64) -> f64 {
    let axis = 0.5 * (rho + 1.0 / rho);
    let (own, other) = if direction == 0 { (c[1], c[2]) } else { (c[2], c[1]) };
    let at = |end: f64| (c[0] + end * other).abs() + (own + end * c[3]).abs() * axis;
    at(-1.0).max(at(1.0))
}

/// A bilinear function at the two ends of the other direction: its value in the middle, and by how much it changes along `direction`.
fn denominator(c: [f64; 4], direction: usize) -> [[f64; 2]; 2] {
    let (own, other) = if direction == 0 { (c[1], c[2]) } else { (c[2], c[1]) };
    [-1.0, 1.0].map(|end| [c[0] + end * other, (own + end * c[3]).abs()])
}

/// No value of u²/r is larger on a part of which a corner lies on the axis, where u vanishes.
fn beside_axis(radial: [[f64; 3]; 3], radius: [f64; 4]) -> f64 {
    let [_, rs, rt, rst] = radius;
    // r = R_s x + R_t y + xy·twist, and xy ≤ x + y.
    let twist = rst * rs.signum() * rt.signum();
    let slopes = [rs.abs(), rt.abs()].map(|slope| slope - twist.max(0.0));
    if slopes.iter().any(|slope| *slope <= 0.0) {
        return f64::INFINITY;
    }
    let growth = |order: usize| [0.0, 1.0, 4.0][order];
    let steep = |direction: usize| {
        let term = |i: usize, j: usize| growth(if direction == 0 { i } else { j }) * radial[i][j];
        (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| term(i, j)).sum::<f64>()
    };
    2.0 * (0..2).map(|i| steep(i).powi(2) / slopes[i]).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elasticity::Elasticity;
    use crate::scene::Kinematics;

    fn material() -> Material {
        Material::new(Kinematics::Axisymmetric, &Elasticity::Isotropic { young: 2.0, poisson: 0.3 })
    }

    /// Values at so many nodes that vanish on the axis and are no polynomial of low degree.
    fn nodal(corners: &[[f64; 2]; 4], nodes: usize) -> Vec<[f64; 2]> {
        let place = |i: usize| match i {
            0..4 => corners[i][0],
            4..8 => 0.5 * (corners[i - 4][0] + corners[(i - 3) % 4][0]),
            _ => 1.0,
        };
        let value = |i: usize| [(1.3 * i as f64 + 0.5).sin(), (0.7 * i as f64 + 0.4).cos()];
        (0..nodes).map(|i| if place(i) == 0.0 { [0.0, value(i)[1]] } else { value(i) }).collect()
    }

    /// By rules on parts that are the smaller the nearer they are to the side or corner at (−1, −1).
    fn graded(turned: &Turned<'_>) -> f64 {
        let mut ends = vec![-1.0];
        ends.extend((0..40).rev().map(|k| -1.0 + 2.0 * 0.5_f64.powi(k)));
        let pieces = ends.windows(2).map(|e| [e[0], e[1]]).collect::<Vec<_>>();
        let part = |s: &[f64; 2], t: &[f64; 2]| Part {
            centre: [0.5 * (s[0] + s[1]), 0.5 * (t[0] + t[1])],
            half: [0.5 * (s[1] - s[0]), 0.5 * (t[1] - t[0])],
        };
        let of = |s: &[f64; 2]| pieces.iter().map(|t| turned.by_rule(part(s, t), 12).value).sum::<f64>();
        pieces.iter().map(of).sum()
    }

    #[test]
    fn energies_are_those_of_fine_rules_beside_the_axis_and_off_it() {
        let sections = [
            [[0.4, 0.0], [1.3, 0.1], [1.1, 1.2], [0.5, 0.9]],
            [[0.0, 0.0], [1.0, -0.2], [1.3, 1.1], [0.0, 0.8]],
            [[0.0, 0.0], [1.0, 0.1], [1.4, 1.2], [0.3, 1.0]],
            [[1e-6, 0.0], [1.0, 0.0], [1.0, 1.0], [1e-6, 1.0]],
        ];
        for (corners, nodes) in sections.into_iter().zip([4, 9, 4, 9]) {
            let cell = Quadrilateral::new(corners, &nodal(&corners, nodes)).expect("convex");
            let found = strain_energy(&cell, &material(), 0.0);
            let fine = graded(&Turned::new(&cell, material().revolved(), 0.0));
            assert!(found.error <= 1e-11 * found.value, "{corners:?} {nodes}: {found:?}");
            assert!((found.value - fine).abs() <= 1e-11 * fine, "{corners:?} {nodes}: {found:?} for {fine}");
        }
    }

    #[test]
    fn a_field_that_leaves_the_axis_has_no_energy() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let cell = Quadrilateral::new(corners, &[[1e-3, 0.0]; 4]).expect("convex");
        assert!(strain_energy(&cell, &material(), 0.0).error.is_infinite());
    }
}
