//! The strain energy of a field on a quadrilateral, enclosed.
//!
//! Its density times the determinant of the map is N/d, N a polynomial of degree 4 along each of ξ and η and d affine. A Gauss rule
//! with n ≥ 2 points errs on [−1, 1] by at most
//!
//! (64/15) M ρ^(−2n)/(1 − ρ^(−2))
//!
//! where |f| ≤ M on the Bernstein ellipse of parameter ρ and its inside (from |a_k| ≤ 2Mρ^(−k) for the Chebyshev coefficients, of
//! which those from 2n on count), along ξ and along η. On the ellipse |T_k| ≤ (ρ^k + ρ^(−k))/2 bounds N, and |d| is least at
//! an end of the larger axis. Where d is nearly zero at a corner or along a side, the square is cut in two across the direction that errs most.

use crate::element::polynomial::quadrature::segment_rule;
use crate::element::{Material, Quadrilateral};

/// Numbers of points that are tried, and how often a part of the square is cut in two.
pub(super) const FEWEST: usize = 3;
pub(super) const MOST: usize = 16;
pub(super) const CUTS: usize = 80;
/// Part of the energy at which its error is small enough.
const ENOUGH: f64 = 1e-15;
/// Ellipses that are tried for each rule, up to a parameter beyond which nothing is gained.
const ELLIPSES: usize = 32;
const LARGEST: f64 = 1e6;

/// ½∫ c e(v):e(v), per unit thickness.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Enclosed {
    /// By the rule.
    pub value: f64,
    /// By how much the rule can be off.
    pub error: f64,
    /// Largest change caused by a relative error of one in every number that enters.
    pub sensitivity: f64,
}

impl Enclosed {
    pub(super) fn and(self, other: Enclosed) -> Enclosed {
        Enclosed {
            value: self.value + other.value,
            error: self.error + other.error,
            sensitivity: self.sensitivity + other.sensitivity,
        }
    }
}

/// A part of the square: its centre and half its sides.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

pub(super) const WHOLE: Part = Part { centre: [0.0; 2], half: [1.0; 2] };

impl Part {
    pub(super) fn at(&self, s: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|c| self.centre[c] + self.half[c] * s[c])
    }

    pub(super) fn halves(&self, direction: usize) -> [Part; 2] {
        [-1.0, 1.0].map(|side| {
            let mut part = *self;
            part.half[direction] *= 0.5;
            part.centre[direction] += side * part.half[direction];
            part
        })
    }

    pub(super) fn area(&self) -> f64 {
        self.half[0] * self.half[1]
    }
}

/// The energy of `cell` with as many points and parts as its error needs.
pub fn strain_energy(cell: &Quadrilateral, material: &Material) -> Enclosed {
    part_energy(cell, material, WHOLE, CUTS)
}

/// The energy by a rule of `points` in each direction on the whole square.
pub fn strain_energy_by(cell: &Quadrilateral, material: &Material, points: usize) -> Enclosed {
    let bound = Bound::new(cell, material, WHOLE);
    Enclosed { error: bound.error(points), ..by_rule(cell, material, WHOLE, points) }
}

fn part_energy(cell: &Quadrilateral, material: &Material, part: Part, cuts: usize) -> Enclosed {
    let bound = Bound::new(cell, material, part);
    let rough = by_rule(cell, material, part, FEWEST);
    let enough = ENOUGH * rough.sensitivity;
    let points = (FEWEST..=MOST).find(|points| bound.error(*points) <= enough);
    // Where numbers overflow no rule helps.
    if points.is_none() && cuts > 0 && enough.is_finite() {
        let worse = bound.worse();
        let [one, other] = part.halves(worse).map(|half| part_energy(cell, material, half, cuts - 1));
        return one.and(other);
    }
    let points = points.unwrap_or(MOST);
    Enclosed { error: bound.error(points), ..by_rule(cell, material, part, points) }
}

fn by_rule(cell: &Quadrilateral, material: &Material, part: Part, points: usize) -> Enclosed {
    let rule = segment_rule(2 * points - 1);
    let mut sum = Enclosed::default();
    for (s, v) in rule {
        for (t, w) in rule {
            let at = cell.at(part.at([2.0 * s - 1.0, 2.0 * t - 1.0]));
            let weight = 4.0 * part.area() * v * w / at.determinant;
            let stress = material.stress(at.strain);
            sum.value += 0.5 * weight * material.strain_product(at.strain, at.strain);
            sum.sensitivity += weight * stress.iter().map(|s| s.abs()).sum::<f64>() * at.spread;
        }
    }
    sum
}

/// Quantities that bound the error of rules on a part of the square.
struct Bound {
    /// |c_ij|, with the shear counted twice.
    moduli: [[f64; 3]; 3],
    /// Chebyshev coefficients of the strain times the determinant, in size: component, along s, along t.
    strain: [[[f64; 3]; 3]; 3],
    /// The determinant d₀ + d₁s + d₂t on the part.
    determinant: [f64; 3],
    area: f64,
}

impl Bound {
    fn new(cell: &Quadrilateral, material: &Material, part: Part) -> Self {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| material.stress(e));
        let counted = |i: usize| if i == 2 { 2.0 } else { 1.0 };
        let moduli = [0, 1, 2].map(|i| [0, 1, 2].map(|j| counted(i) * columns[j][i].abs()));
        let samples = [-1.0, 0.0, 1.0].map(|s| [-1.0, 0.0, 1.0].map(|t| cell.at(part.at([s, t])).strain));
        let strain = [0, 1, 2].map(|component| {
            let along_t = samples.map(|row| chebyshev(row.map(|e| e[component])));
            let columns = [0, 1, 2].map(|j| chebyshev(along_t.map(|row| row[j])));
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i].abs()))
        });
        let [d0, d1, d2] = cell.determinant();
        let [x, y] = part.centre;
        let determinant = [d0 + d1 * x + d2 * y, d1 * part.half[0], d2 * part.half[1]];
        Bound { moduli, strain, determinant, area: part.area() }
    }

    /// By how much a rule with so many points in each direction can be off.
    fn error(&self, points: usize) -> f64 {
        // Of the other direction the rule has weights that add up to two, and so has the integral.
        2.0 * self.area * (self.along(0, points) + self.along(1, points))
    }

    /// The direction along which the rule errs most; where neither is bounded, the one along which the determinant changes most.
    fn worse(&self) -> usize {
        let errors = [0, 1].map(|direction| self.along(direction, MOST));
        let changes = [self.determinant[1].abs(), self.determinant[2].abs()];
        let [one, other] = if errors.iter().all(|e| e.is_infinite()) { changes } else { errors };
        usize::from(other > one)
    }

    /// The least bound along one direction.
    fn along(&self, direction: usize, points: usize) -> f64 {
        let [d0, d1, d2] = self.determinant;
        let (own, other) = if direction == 0 { (d1.abs(), d2.abs()) } else { (d2.abs(), d1.abs()) };
        least_along([[d0 - other, own]; 2], points, |rho| 0.5 * self.numerator(direction, rho))
    }

    /// No value of N on the ellipse is larger.
    fn numerator(&self, direction: usize, rho: f64) -> f64 {
        let size = |component: usize| sizes_on(&self.strain[component], direction, rho);
        let sizes = [0, 1, 2].map(size);
        (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| self.moduli[i][j] * sizes[i] * sizes[j]).sum()
    }
}

/// The least bound of what a rule with so many points errs by along one direction, over ellipses: `numerator` is no smaller than that of the
/// function on the ellipse of a parameter, and the real denominator, linear along the direction, has at the two ends of the other one its
/// `middle` value and changes by `own` to either end.
pub(super) fn least_along(ends: [[f64; 2]; 2], points: usize, numerator: impl Fn(f64) -> f64) -> f64 {
    if ends.iter().any(|[middle, own]| middle <= own) {
        return f64::INFINITY;
    }
    // Where the denominator vanishes: half the larger axis of the largest ellipse.
    let axis = ends.iter().map(|[middle, own]| if *own > 0.0 { (middle / own).min(LARGEST) } else { LARGEST });
    let axis = axis.fold(LARGEST, f64::min);
    let largest = axis + (axis * axis - 1.0).sqrt();
    let of = |step: usize| {
        let rho = largest.powf(step as f64 / ELLIPSES as f64);
        let left =
            ends.iter().map(|[middle, own]| middle - 0.5 * own * (rho + 1.0 / rho)).fold(f64::INFINITY, f64::min);
        if left <= 0.0 {
            return f64::INFINITY;
        }
        64.0 / 15.0 * (numerator(rho) / left) * rho.powi(-2 * points as i32) / (1.0 - rho.powi(-2))
    };
    (1..ELLIPSES).map(of).fold(f64::INFINITY, f64::min)
}

/// No value of a polynomial with these Chebyshev coefficients, in size, is larger on the ellipse of parameter `rho` along `direction`.
pub(super) fn sizes_on(coefficients: &[[f64; 3]; 3], direction: usize, rho: f64) -> f64 {
    let grown = [0, 1, 2].map(|k| 0.5 * (rho.powi(k) + rho.powi(-k)));
    let own = |k: usize, l: usize| if direction == 0 { coefficients[k][l] } else { coefficients[l][k] };
    (0..3).map(|k| grown[k] * (0..3).map(|l| own(k, l)).sum::<f64>()).sum()
}

/// The Chebyshev coefficients of the quadratic polynomial with these values at −1, 0 and 1.
pub(super) fn chebyshev([left, middle, right]: [f64; 3]) -> [f64; 3] {
    let square = 0.25 * (left + right) - 0.5 * middle;
    [middle + square, 0.5 * (right - left), square]
}
