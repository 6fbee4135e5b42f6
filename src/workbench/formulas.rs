//! Stiffness matrices of the isoparametric family, by quadrature: what shipped elements are made of, and what a matrix is held against.

use nalgebra::{DMatrix, Matrix3};

use super::displacement::DisplacementElement;
use super::material::Material;
use super::outline::Outline;
use crate::element::quadrature::{segment_rule, triangle_rule};

/// Shape functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Linear triangle: its corners.
    P1,
    /// Quadratic triangle: corners, then the middles of (0, 1), (1, 2), (2, 0).
    P2,
    /// Bilinear quadrilateral: its corners, counter-clockwise.
    Q4,
}

/// What may be done otherwise than right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Variant {
    /// As it must be.
    #[default]
    Right,
    /// One quadrature point in the middle.
    OnePoint,
    /// n × n quadrature points of Gauss on a quadrilateral, where two are the rule. The integrand is no polynomial on a distorted one, so that
    /// the matrix is another one, and as good.
    Points(usize),
    /// The Jacobian where its transpose belongs: ∇N = J⁻¹ ∇̂N in place of J⁻ᵀ ∇̂N.
    Transposed,
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
    /// Gradients of the shape functions.
    pub gradients: Vec<[f64; 2]>,
}

impl Point {
    /// Its part Bᵀ D B w |det J| of the stiffness matrix per unit thickness.
    pub fn stiffness(&self, d: &Matrix3<f64>) -> DMatrix<f64> {
        let mut b = DMatrix::zeros(3, 2 * self.gradients.len());
        for (i, &[x, y]) in self.gradients.iter().enumerate() {
            (b[(0, 2 * i)], b[(1, 2 * i + 1)]) = (x, y);
            (b[(2, 2 * i)], b[(2, 2 * i + 1)]) = (y, x);
        }
        b.transpose() * d * b * (self.weight * self.det)
    }
}

/// Barycentric or bilinear place, and weight.
type Rule = Vec<([f64; 2], f64)>;

impl Family {
    /// All of them.
    pub const ALL: [Family; 3] = [Family::P1, Family::P2, Family::Q4];

    /// What it is called.
    pub fn words(self) -> &'static str {
        match self {
            Family::P1 => "linear triangle P1",
            Family::P2 => "quadratic triangle P2",
            Family::Q4 => "bilinear quadrilateral Q4",
        }
    }

    /// Its nodes on the reference shape.
    pub fn nodes(self) -> Vec<[f64; 2]> {
        match self {
            Family::P1 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            Family::P2 => vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]],
            Family::Q4 => vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        }
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
        match (outline.corners.len(), nodes.len(), middles) {
            (3, 3, _) => Some((Family::P1, outline.corners.clone())),
            (4, 4, _) => Some((Family::Q4, outline.corners.clone())),
            (3, 6, Some(middles)) if outline.sides.iter().all(|s| is_middle(s)) => {
                Some((Family::P2, [outline.corners.clone(), middles].concat()))
            }
            _ => None,
        }
    }

    /// Gradients of the shape functions on the reference shape.
    fn slopes(self, [s, t]: [f64; 2]) -> Vec<[f64; 2]> {
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
        }
    }

    fn rule(self, variant: Variant) -> Rule {
        match (self, variant) {
            (Family::Q4, Variant::OnePoint) => vec![([0.5, 0.5], 1.0)],
            (_, Variant::OnePoint) => vec![([1.0 / 3.0, 1.0 / 3.0], 0.5)],
            (Family::Q4, variant) => {
                let points = if let Variant::Points(n) = variant { n.max(1) } else { 2 };
                let line = segment_rule(2 * points - 1);
                line.iter().flat_map(|&(s, v)| line.iter().map(move |&(t, w)| ([s, t], v * w))).collect()
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
        Ok(points.iter().fold(DMatrix::zeros(2 * n, 2 * n), |k, p| k + p.stiffness(d) * thickness))
    }

    /// The quadrature points with the gradients there, nodes in the order of the family.
    ///
    /// # Errors
    /// The Jacobian vanishes at one of them.
    pub(super) fn points(self, nodes: &[[f64; 2]], variant: Variant) -> Result<Vec<Point>, String> {
        let mut points = Vec::new();
        for (at, weight) in self.rule(variant) {
            let slopes = self.slopes(at);
            let jacobian = |c: usize, a: usize| nodes.iter().zip(&slopes).map(|(x, g)| x[c] * g[a]).sum::<f64>();
            let j = [[jacobian(0, 0), jacobian(0, 1)], [jacobian(1, 0), jacobian(1, 1)]];
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            if det == 0.0 || !det.is_finite() {
                return Err("the Jacobian vanishes at a quadrature point".into());
            }
            let (p, q) = if variant == Variant::Transposed { (j[0][1], j[1][0]) } else { (j[1][0], j[0][1]) };
            // J⁻ᵀ: x from (y_t, −y_s), y from (−x_t, x_s).
            let gradient = |g: &[f64; 2]| [(j[1][1] * g[0] - p * g[1]) / det, (j[0][0] * g[1] - q * g[0]) / det];
            points.push(Point { at, weight, det: det.abs(), gradients: slopes.iter().map(gradient).collect() });
        }
        Ok(points)
    }

    /// The element with its formula, on the reference shape.
    ///
    /// # Errors
    /// As [`DisplacementElement::of_formula`].
    pub fn element(self, name: &str, material: Material, variant: Variant) -> Result<DisplacementElement, String> {
        let formula = move |nodes: &[[f64; 2]], m: &Material| self.stiffness(nodes, &m.hooke(), m.thickness, variant);
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
