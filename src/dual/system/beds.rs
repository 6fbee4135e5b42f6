//! Springs and elastic layers in the hybrid form.
//!
//! Along one of its two directions a spring of stiffness k has the energy ½ k ∫ j² of the jump j of its edge, which in the moments
//! m = ∫ j B_k is ½ (k/l) mᵀM⁻¹m, M being the Gram matrix of the Bernstein polynomials on an edge of length one. With M = LLᵀ it is
//! one more element whose modes have unit energy: parameters s = √(k/l) L⁻¹ m, forces √(k/l) L⁻ᵀ s.
//!
//! Parameters of springs follow those of the triangles, and are refined with them: no digit of a small force on stiff springs, or of
//! a stress on soft ones, is lost to the size of the other.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use super::pattern::Pattern;
use super::unknowns::{Component, EdgeMoments, Unknowns};
use crate::element::displacement::MOST;
use crate::element::polynomial::side;
use crate::element::revolved::{ROUGH, SidePoint, side_rule, vanishes};
use crate::problem::{BedPair, EdgeWeight, Problem};

/// An edge on springs or on a side of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct BedEdge {
    /// First unknown: of the jump on the first side, of the moments of the edge on the second; along both axes for one moment after
    /// the other.
    first: usize,
    /// First unknown of the other side, whose moments run against those of this one.
    opposite: Option<usize>,
    /// 0 on the first side, 1 on the second.
    side: usize,
    degree: usize,
    /// Normal and tangent of the first side.
    axes: [[f64; 2]; 2],
}

impl BedEdge {
    /// The edge on side `side` of `pair`.
    pub fn new(pair: &BedPair, side: usize, degree: usize, first: usize, opposite: Option<usize>) -> Self {
        BedEdge { first, opposite, side, degree, axes: pair.axes }
    }

    /// Its first unknown.
    pub fn first(&self) -> usize {
        self.first
    }

    /// The first of the unknowns of the second side that the moments of this one are made of, too.
    pub fn second(&self) -> Option<usize> {
        self.opposite.filter(|_| self.side == 0)
    }

    /// Moment `k` of the edge along two axes at right angles.
    pub fn components(&self, k: usize) -> [Component; 2] {
        [0, 1].map(|c| {
            let own = (self.first + 2 * k + c, 1.0);
            match self.second() {
                Some(second) => Component::sum(self.axes[c], &[own, (second + 2 * (self.degree - k) + c, 1.0)], 1),
                None => Component::sum(self.axes[c], &[own], 1),
            }
        })
    }

    /// Adds to the unknowns `x` what moment `k` of the edge contributes to them.
    pub fn project(&self, k: usize, m: [f64; 2], x: &mut [f64]) {
        for (c, axis) in self.axes.iter().enumerate() {
            let along = m[0] * axis[0] + m[1] * axis[1];
            x[self.first + 2 * k + c] += along;
            if let (1, Some(jump)) = (self.side, self.opposite) {
                x[jump + 2 * (self.degree - k) + c] -= along;
            }
        }
    }
}

/// One direction of one pair.
#[derive(Debug, Clone)]
struct Spring {
    /// First unknown of its jump, or of the stretch of an elastic contact.
    first: usize,
    /// Places from one of these unknowns to the next.
    step: usize,
    degree: usize,
    /// k/l.
    stiffness: f64,
    /// Its first parameter, behind those of the triangles.
    parameter: usize,
    /// L⁻¹ beside an axis of revolution.
    turned: Option<DMatrix<f64>>,
}

/// All springs.
#[derive(Debug, Clone, Default)]
pub struct Springs {
    all: Vec<Spring>,
    parameters: usize,
}

impl Springs {
    /// Those of `problem`.
    pub fn new(problem: &Problem, unknowns: &Unknowns) -> Self {
        let mut springs = Springs::default();
        for (pair, stiffness) in problem.bed_pairs() {
            let EdgeMoments::Elastic(edge) = &unknowns.edges[pair.edge] else { continue };
            for (c, k) in stiffness.into_iter().enumerate().filter(|(_, k)| *k > 0.0) {
                springs.all.push(Spring {
                    first: edge.first() + c,
                    step: 2,
                    degree: edge.degree,
                    stiffness: k / pair.length,
                    parameter: springs.parameters,
                    turned: pair.weight.radii().map(|radii| turned_inverse(radii, edge.degree)),
                });
                springs.parameters += edge.degree + 1;
            }
        }
        for pair in problem.pairs() {
            let (Some(k), Some(e)) = (pair.stiffness, pair.edges[0]) else { continue };
            let EdgeMoments::Contact(edge) = &unknowns.edges[e] else { continue };
            let Some(stretch) = edge.stretch else { continue };
            let (parameter, stiffness) = (springs.parameters, k / pair.length);
            let weight = EdgeWeight::of_pair(problem.section(), &problem.mesh, pair);
            springs.all.push(Spring {
                first: stretch,
                step: 1,
                degree: edge.degree,
                stiffness,
                parameter,
                turned: weight.radii().map(|radii| turned_inverse(radii, edge.degree)),
            });
            springs.parameters += edge.degree + 1;
        }
        springs
    }

    /// Number of their parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// Adds their energy to K.
    pub fn assemble(&self, pattern: &Pattern, values: &mut [f64]) {
        for spring in &self.all {
            let l = spring.lower();
            for i in 0..=spring.degree {
                for j in 0..=i {
                    let entry: f64 = (i..=spring.degree).map(|r| l[(r, i)] * l[(r, j)]).sum();
                    pattern.add(spring.at(i), spring.at(j), spring.stiffness * entry, values);
                }
            }
        }
    }

    /// Their parameters for the unknowns `x`.
    pub fn parameters_from(&self, x: &[f64], out: &mut [f64]) {
        for spring in &self.all {
            let (l, root) = (spring.lower(), spring.stiffness.sqrt());
            for i in 0..=spring.degree {
                let sum: f64 = (0..=i).map(|j| l[(i, j)] * x[spring.at(j)]).sum();
                out[spring.parameter + i] = root * sum;
            }
        }
    }

    /// Takes their forces, for these parameters, from the residual of every unknown.
    pub fn subtract_forces(&self, s: &[f64], r: &mut [f64]) {
        for spring in &self.all {
            let (l, root) = (spring.lower(), spring.stiffness.sqrt());
            for j in 0..=spring.degree {
                let sum: f64 = (j..=spring.degree).map(|i| l[(i, j)] * s[spring.parameter + i]).sum();
                r[spring.at(j)] -= root * sum;
            }
        }
    }
}

impl Spring {
    fn lower(&self) -> &DMatrix<f64> {
        self.turned.as_ref().unwrap_or_else(|| lower_inverse(self.degree))
    }

    fn at(&self, k: usize) -> usize {
        self.first + self.step * k
    }
}

/// L⁻¹ of M = LLᵀ for degree p.
fn lower_inverse(p: usize) -> &'static DMatrix<f64> {
    static KNOWN: [OnceLock<DMatrix<f64>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    KNOWN[p].get_or_init(|| {
        let gram = DMatrix::from_fn(p + 1, p + 1, |i, j| side::product(p, i, p, j));
        let lower = gram.cholesky().map(|factor| factor.l());
        lower.and_then(|l| l.try_inverse()).unwrap_or_else(|| DMatrix::identity(p + 1, p + 1))
    })
}

/// L⁻¹ of the matrix of ∫ B_i B_j/r on an edge of length one whose ends have these distances from the axis: forces are those of r t. At an end
/// on the axis there is no force.
fn turned_inverse(radii: [f64; 2], p: usize) -> DMatrix<f64> {
    let kept: Vec<usize> = (0..=p).filter(|k| !vanishes(radii.map(|r| r == 0.0), *k, p)).collect();
    let points = side_rule(radii, 2 * p, ROUGH);
    let unit = |i: usize, at: f64| {
        let mut one = vec![0.0; p + 1];
        one[i] = 1.0;
        side::value(&one, at)
    };
    let gram = DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
        let of = |point: &SidePoint| point.weight * unit(kept[i], point.at) * unit(kept[j], point.at) / point.radius;
        points.iter().map(of).sum::<f64>()
    });
    let lower = gram.cholesky().and_then(|factor| factor.l().try_inverse());
    let mut out = DMatrix::zeros(p + 1, p + 1);
    if let Some(lower) = lower {
        for (i, row) in kept.iter().enumerate() {
            for (j, column) in kept.iter().enumerate() {
                out[(*row, *column)] = lower[(i, j)];
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_have_the_energy_of_the_jump() {
        for p in 1..MOST {
            let jump: Vec<f64> = (0..=p).map(|k| ((3 * k + 1) as f64).cos()).collect();
            let moments = side::moments(&jump, p);
            let springs = Springs {
                all: vec![Spring { first: 0, step: 2, degree: p, stiffness: 4.0, parameter: 0, turned: None }],
                parameters: p + 1,
            };
            let x: Vec<f64> = moments.iter().flat_map(|m| [*m, 7.0]).collect();
            let mut s = vec![0.0; p + 1];
            springs.parameters_from(&x, &mut s);
            let energy: f64 = s.iter().map(|s| s * s).sum();
            assert!((energy - 4.0 * side::integral(&jump, &jump)).abs() < 1e-11, "degree {p}");
            // Forces are the coefficients of the traction k j.
            let mut r = vec![0.0; 2 * (p + 1)];
            springs.subtract_forces(&s, &mut r);
            let off = (0..=p).map(|k| (r[2 * k] + 4.0 * jump[k]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-9, "degree {p}: {off}");
        }
    }
}
