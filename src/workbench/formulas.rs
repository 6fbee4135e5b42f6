//! Stiffness matrices of the isoparametric family, by quadrature: what shipped elements are made of, and what a matrix is held against.

mod dilatation;
mod enhanced;
pub mod ring;

use nalgebra::{DMatrix, Matrix3};

use super::displacement::DisplacementElement;
use super::material::Material;
use super::outline::Outline;
use crate::element::polynomial::quadrature::{segment_rule, triangle_rule};
use crate::scene::Kinematics;

pub use dilatation::Split;
pub(super) use dilatation::{one_sided, with_rows};
pub use enhanced::Correction;

/// Shape functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Linear triangle: its corners.
    P1,
    /// Quadratic triangle: corners, then the middles of (0, 1), (1, 2), (2, 0).
    P2,
    /// Bilinear quadrilateral: its corners, counter-clockwise.
    Q4,
    /// Serendipity quadrilateral: corners, then the middles of (0, 1), (1, 2), (2, 3), (3, 0).
    Q8,
    /// Biquadratic quadrilateral: those of Q8, then the centre.
    Q9,
}

/// The standard form of an element, alternatives to it, and mistakes in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Variant {
    /// As it must be.
    #[default]
    Right,
    /// One quadrature point in the middle.
    OnePoint,
    /// n × n quadrature points of Gauss on a quadrilateral, where two (three of Q8 and Q9) are the rule. The integrand is no polynomial on a distorted one, so that
    /// the matrix is another one, and as good.
    Points(usize),
    /// The Jacobian where its transpose belongs: ∇N = J⁻¹ ∇̂N in place of J⁻ᵀ ∇̂N.
    Transposed,
    /// The quadratic triangle with its three points inside and not in the middles of the sides: the same matrix by other points.
    Inner,
    /// Q4 with the incompatible modes 1 − ξ² and 1 − η² of Wilson, condensed, by n × n points.
    Incompatible(Correction, usize),
    /// Q4 whose volume change is that of the middle: B-bar, mean dilatation, or selective integration.
    Dilatation(Split),
    /// Q4 of Pian and Sumihara: five stresses beside the displacements.
    Hybrid,
}

/// A quadrature point of an element.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// Its place on the reference shape.
    pub at: [f64; 2],
    /// Its weight.
    pub weight: f64,
    /// |det J|.
    pub det: f64,
    /// J, rows x and y, columns along the local directions.
    pub jacobian: [[f64; 2]; 2],
    /// Gradients of the shape functions.
    pub gradients: Vec<[f64; 2]>,
}

/// Slopes of the shape functions at a place of the reference shape, one row a node.
pub(super) type Slopes<'a> = &'a dyn Fn([f64; 2]) -> Vec<[f64; 2]>;

impl Point {
    /// Its part Bᵀ D B w |det J| of the stiffness matrix per unit thickness.
    pub fn stiffness(&self, d: &Matrix3<f64>) -> DMatrix<f64> {
        let b = strains(&self.gradients);
        b.transpose() * d * b * (self.weight * self.det)
    }

    /// Sign of det J.
    pub fn sign(&self) -> f64 {
        det(&self.jacobian).signum()
    }
}

/// B: strains (xx, yy, γ) of unknowns with these gradients, x and y of each in turn.
fn strains(gradients: &[[f64; 2]]) -> DMatrix<f64> {
    let mut b = DMatrix::zeros(3, 2 * gradients.len());
    for (i, &[x, y]) in gradients.iter().enumerate() {
        (b[(0, 2 * i)], b[(1, 2 * i + 1)]) = (x, y);
        (b[(2, 2 * i)], b[(2, 2 * i + 1)]) = (y, x);
    }
    b
}

fn det(j: &[[f64; 2]; 2]) -> f64 {
    j[0][0] * j[1][1] - j[0][1] * j[1][0]
}

/// J⁻ᵀ g.
fn gradient(j: &[[f64; 2]; 2], g: &[f64; 2]) -> [f64; 2] {
    let det = det(j);
    [(j[1][1] * g[0] - j[1][0] * g[1]) / det, (j[0][0] * g[1] - j[0][1] * g[0]) / det]
}

/// A matrix of a family, numbered as an element is whose node `order[i]` is node i of the family.
pub(super) fn placed(own: &DMatrix<f64>, order: &[usize]) -> DMatrix<f64> {
    let mut at = vec![0; order.len()];
    order.iter().enumerate().for_each(|(i, &n)| at[n] = i);
    let place = |i: usize| 2 * at[i / 2] + i % 2;
    DMatrix::from_fn(own.nrows(), own.ncols(), |i, j| own[(place(i), place(j))])
}

/// The functions of Q9 as products: of which numbers in [`quadratic`] along either direction.
const BIQUADRATIC: [(usize, usize); 9] = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)];

/// The quadratic functions on [0, 1] that are one at 0, ½ and 1.
fn quadratic(x: f64) -> [f64; 3] {
    [(1.0 - 2.0 * x) * (1.0 - x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)]
}

/// Their slopes.
fn quadratic_slopes(x: f64) -> [f64; 3] {
    [4.0 * x - 3.0, 4.0 - 8.0 * x, 4.0 * x - 1.0]
}

/// Barycentric or bilinear place, and weight.
type Rule = Vec<([f64; 2], f64)>;

impl Family {
    /// All of them.
    pub const ALL: [Family; 5] = [Family::P1, Family::P2, Family::Q4, Family::Q8, Family::Q9];

    /// Its name.
    pub fn words(self) -> &'static str {
        match self {
            Family::P1 => "linear triangle P1",
            Family::P2 => "quadratic triangle P2",
            Family::Q4 => "bilinear quadrilateral Q4",
            Family::Q8 => "serendipity quadrilateral Q8",
            Family::Q9 => "biquadratic quadrilateral Q9",
        }
    }

    /// Its nodes on the reference shape.
    pub fn nodes(self) -> Vec<[f64; 2]> {
        match self {
            Family::P1 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            Family::P2 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]],
            Family::Q4 => vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            Family::Q8 => {
                vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]]
            }
            Family::Q9 => [Family::Q8.nodes(), vec![[0.5, 0.5]]].concat(),
        }
    }

    /// How many of its nodes are corners: three, or four.
    pub fn corners(self) -> usize {
        match self {
            Family::P1 | Family::P2 => 3,
            Family::Q4 | Family::Q8 | Family::Q9 => 4,
        }
    }

    /// How many points of Gauss it has in each direction of a quadrilateral.
    fn usual_points(self) -> usize {
        if matches!(self, Family::Q8 | Family::Q9) { 3 } else { 2 }
    }

    /// The family that an outline belongs to, and its nodes in the order of the family.
    pub fn of(outline: &Outline, nodes: &[[f64; 2]]) -> Option<(Family, Vec<usize>)> {
        let middles: Option<Vec<usize>> = outline.sides.iter().map(|s| (s.len() == 3).then(|| s[1])).collect();
        let is_middle = |side: &[usize]| {
            (0..2).all(|c| {
                let middle = 0.5 * (nodes[side[0]][c] + nodes[side[2]][c]);
                (nodes[side[1]][c] - middle).abs() < 1e-6 * outline.size
            })
        };
        let is_centre = |inside: usize| {
            let mean = |c: usize| 0.25 * outline.corners.iter().map(|&n| nodes[n][c]).sum::<f64>();
            (0..2).all(|c| (nodes[inside][c] - mean(c)).abs() < 1e-6 * outline.size)
        };
        match (outline.corners.len(), nodes.len(), middles) {
            (3, 3, _) => Some((Family::P1, outline.corners.clone())),
            (4, 4, _) => Some((Family::Q4, outline.corners.clone())),
            (corners @ (3 | 4), count, Some(middles))
                if count == 2 * corners && outline.sides.iter().all(|s| is_middle(s)) =>
            {
                let family = if corners == 3 { Family::P2 } else { Family::Q8 };
                Some((family, [outline.corners.clone(), middles].concat()))
            }
            (4, 9, Some(middles)) if outline.sides.iter().all(|s| is_middle(s)) => match outline.inside[..] {
                [inside] if is_centre(inside) => {
                    Some((Family::Q9, [outline.corners.clone(), middles, vec![inside]].concat()))
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// Gradients of the shape functions on the reference shape.
    pub(super) fn slopes(self, [s, t]: [f64; 2]) -> Vec<[f64; 2]> {
        let (l, d) = ([1.0 - s - t, s, t], [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]);
        match self {
            Family::P1 => d.to_vec(),
            Family::P2 => {
                let corner = (0..3).map(|i| d[i].map(|d| (4.0 * l[i] - 1.0) * d));
                let middle = [(0, 1), (1, 2), (2, 0)]
                    .map(|(i, j): (usize, usize)| [0, 1].map(|c| 4.0 * (l[i] * d[j][c] + l[j] * d[i][c])));
                corner.chain(middle).collect()
            }
            Family::Q4 => vec![[t - 1.0, s - 1.0], [1.0 - t, -s], [t, s], [-t, 1.0 - s]],
            Family::Q8 => {
                let (x, y) = (2.0 * s - 1.0, 2.0 * t - 1.0);
                let corner = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]: [f64; 2]| {
                    let (p, q) = (1.0 + a * x, 1.0 + b * y);
                    [0.5 * a * q * (2.0 * a * x + b * y), 0.5 * b * p * (2.0 * b * y + a * x)]
                });
                let along = |b: f64| [-2.0 * x * (1.0 + b * y), b * (1.0 - x * x)];
                let across = |a: f64| [a * (1.0 - y * y), -2.0 * y * (1.0 + a * x)];
                [&corner[..], &[along(-1.0), across(1.0), along(1.0), across(-1.0)]].concat()
            }
            Family::Q9 => {
                let [(f, df), (g, dg)] = [s, t].map(|x| (quadratic(x), quadratic_slopes(x)));
                BIQUADRATIC.map(|(i, j)| [df[i] * g[j], f[i] * dg[j]]).into()
            }
        }
    }

    fn rule(self, variant: Variant) -> Rule {
        match (self.corners(), variant) {
            (4, Variant::OnePoint) => vec![([0.5, 0.5], 1.0)],
            (_, Variant::OnePoint) => vec![([1.0 / 3.0, 1.0 / 3.0], 0.5)],
            (4, variant) => {
                let points = match variant {
                    Variant::Points(n) | Variant::Incompatible(_, n) => n.max(1),
                    _ => self.usual_points(),
                };
                let line = segment_rule(2 * points - 1);
                line.iter().flat_map(|&(s, v)| line.iter().map(move |&(t, w)| ([s, t], v * w))).collect()
            }
            (_, Variant::Inner) => {
                [[1.0, 1.0], [4.0, 1.0], [1.0, 4.0]].map(|at| (at.map(|x| x / 6.0), 1.0 / 6.0)).into()
            }
            _ => triangle_rule(2).iter().map(|(l, w)| ([l[1], l[2]], 0.5 * w)).collect(),
        }
    }

    /// K = t ∫ Bᵀ D B for any 3 × 3 matrix D, nodes in the order of the family.
    ///
    /// # Errors
    /// The nodes enclose no area at a quadrature point.
    pub fn stiffness(
        self,
        nodes: &[[f64; 2]],
        d: &Matrix3<f64>,
        thickness: f64,
        variant: Variant,
    ) -> Result<DMatrix<f64>, String> {
        let n = self.nodes().len();
        if nodes.len() != n {
            return Err(format!("{} nodes, but the {} has {n}", nodes.len(), self.words()));
        }
        let points = self.points(nodes, variant)?;
        let k = match variant {
            Variant::Incompatible(correction, _) => {
                enhanced::incompatible(&points, &self.middle(nodes)?, d, correction)?
            }
            Variant::Hybrid => enhanced::hybrid(&points, &self.middle(nodes)?, d)?,
            Variant::Dilatation(split) => dilatation::split(&points, &self.middle(nodes)?, d, split),
            _ => points.iter().fold(DMatrix::zeros(2 * n, 2 * n), |k, p| k + p.stiffness(d)),
        };
        Ok(k * thickness)
    }

    /// The middle of the reference shape as a quadrature point.
    ///
    /// # Errors
    /// The Jacobian vanishes there.
    pub(super) fn middle(self, nodes: &[[f64; 2]]) -> Result<Point, String> {
        self.points(nodes, Variant::OnePoint).map(|mut points| points.swap_remove(0))
    }

    /// The quadrature points with the gradients there, nodes in the order of the family.
    ///
    /// # Errors
    /// The Jacobian vanishes at one of them.
    pub(super) fn points(self, nodes: &[[f64; 2]], variant: Variant) -> Result<Vec<Point>, String> {
        let slopes = |at| self.slopes(at);
        let mut points = self.points_by(nodes, variant, &slopes, &slopes)?;
        if variant == Variant::Transposed {
            for p in &mut points {
                let [[a, b], [c, d]] = p.jacobian;
                let slopes = self.slopes(p.at);
                p.gradients = slopes.iter().map(|g| gradient(&[[a, c], [b, d]], g)).collect();
            }
        }
        Ok(points)
    }

    /// The quadrature points by given slopes: those that make the Jacobian, and those that it carries to gradients.
    ///
    /// # Errors
    /// The Jacobian vanishes at a point.
    pub(super) fn points_by(
        self,
        nodes: &[[f64; 2]],
        variant: Variant,
        of_jacobian: Slopes,
        of_gradients: Slopes,
    ) -> Result<Vec<Point>, String> {
        points_at(nodes, self.rule(variant), of_jacobian, of_gradients)
    }
}

/// The points of a rule with Jacobians and gradients by given slopes.
fn points_at(nodes: &[[f64; 2]], rule: Rule, of_jacobian: Slopes, of_gradients: Slopes) -> Result<Vec<Point>, String> {
    let mut points = Vec::new();
    for (at, weight) in rule {
        let slopes = of_jacobian(at);
        let entry = |c: usize, a: usize| nodes.iter().zip(&slopes).map(|(x, g)| x[c] * g[a]).sum::<f64>();
        let jacobian = [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]];
        let det = det(&jacobian);
        if det == 0.0 || !det.is_finite() {
            return Err("the Jacobian vanishes at a quadrature point".into());
        }
        let gradients = of_gradients(at).iter().map(|g| gradient(&jacobian, g)).collect();
        points.push(Point { at, weight, det: det.abs(), jacobian, gradients });
    }
    Ok(points)
}

impl Family {
    /// The element with its formula, on the reference shape.
    ///
    /// # Errors
    /// As [`DisplacementElement::of_formula`].
    pub fn element(self, name: &str, material: Material, variant: Variant) -> Result<DisplacementElement, String> {
        let formula = move |nodes: &[[f64; 2]], m: &Material| match m.kinematics {
            Kinematics::Axisymmetric => ring::stiffness(self, nodes, &m.hooke_of_rings(), variant),
            _ => self.stiffness(nodes, &m.hooke(), m.thickness, variant),
        };
        DisplacementElement::of_formula(name, self.nodes(), material, formula)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constant strain triangle of every textbook: plane stress, E = 1, ν = 0, right triangle of legs one.
    #[test]
    fn the_linear_triangle_is_that_of_the_textbook() {
        let material = Material { kinematics: crate::scene::Kinematics::PlaneStress, poisson: 0.0, ..Material::USUAL };
        let k = Family::P1.stiffness(&Family::P1.nodes(), &material.hooke(), 1.0, Variant::Right).expect("regular");
        let textbook = [
            [3.0, 1.0, -2.0, -1.0, -1.0, 0.0],
            [1.0, 3.0, 0.0, -1.0, -1.0, -2.0],
            [-2.0, 0.0, 2.0, 0.0, 0.0, 0.0],
            [-1.0, -1.0, 0.0, 1.0, 1.0, 0.0],
            [-1.0, -1.0, 0.0, 1.0, 1.0, 0.0],
            [0.0, -2.0, 0.0, 0.0, 0.0, 2.0],
        ];
        for (i, row) in textbook.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((k[(i, j)] - x / 4.0).abs() < 1e-14, "{i} {j}: {} and {}", k[(i, j)], x / 4.0);
            }
        }
    }

    #[test]
    fn families_are_recognised_in_any_order() {
        let nodes = [[0.5, 0.5], [0.0, 0.0], [0.0, 1.0], [0.0, 0.5], [1.0, 0.0], [0.5, 0.0]];
        let outline = Outline::of(&nodes).expect("a triangle");
        assert_eq!(Family::of(&outline, &nodes), Some((Family::P2, vec![1, 4, 2, 5, 0, 3])));
    }
}
