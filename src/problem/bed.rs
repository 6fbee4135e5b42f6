//! Boundaries on springs, and elastic layers between two sides.
//!
//! The law of such an interface is φ(j) = ½ k j² in each of two directions, j being the displacement of the first side less that
//! of the second, or of the ground: the traction on the first side is −k j. Its conjugate φ*(q) = q²/2k is what the complementary
//! energy has of it, with q = −t, and φ(j) + φ*(q) − q j = (k j − q)²/2k is what it adds to the gap.

use super::{ContactPair, ProblemError};
use crate::element::Section;
use crate::element::polynomial::side;
use crate::element::revolved::{NEAR, SidePoint, side_rule};
use crate::mesh::Triangulation;
use crate::mesh::sides::bonded::opposite;
use crate::scene::{Bond, Scene, Support, SupportKind};

/// An interface that is elastic.
#[derive(Debug, Clone, PartialEq)]
pub struct Bed {
    /// Name of the support, or `first|second` of a layer.
    pub name: String,
    /// Force per area and relative displacement, normal and tangential; where one is zero there is no traction along it.
    pub stiffness: [f64; 2],
    /// Its edges.
    pub pairs: Vec<BedPair>,
}

/// An edge on springs, or two edges with a layer between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BedPair {
    /// The edge of the first side.
    pub edge: usize,
    /// That of the second, where there is one.
    pub opposite: Option<usize>,
    /// The outward unit normal of the first, and its tangent: the directions of the two stiffnesses.
    pub axes: [[f64; 2]; 2],
    /// Length of the edge.
    pub length: f64,
    /// Weight of its points in integrals.
    pub weight: EdgeWeight,
    /// The elastic contact that it is, which resists along the first of the axes where the jump exceeds the gap, and pulls nowhere.
    pub contact: Option<OneSided>,
}

/// Weight of the points of an edge in integrals along it: one, or the distance from the axis of revolution, given at the two ends.
///
/// Tractions of a body of revolution are weighted with it, t̃ = r t; jumps are not.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EdgeWeight(Option<[f64; 2]>);

impl EdgeWeight {
    /// On an edge of the mesh.
    pub(super) fn on(section: Section, mesh: &Triangulation, edge: usize) -> Self {
        EdgeWeight::between(section, mesh, mesh.edges[edge].vertices)
    }

    /// On the first side of a pair, from its first end.
    pub fn of_pair(section: Section, mesh: &Triangulation, pair: &ContactPair) -> Self {
        EdgeWeight::between(section, mesh, pair.first)
    }

    fn between(section: Section, mesh: &Triangulation, vertices: [usize; 2]) -> Self {
        EdgeWeight(section.is_revolved().then(|| vertices.map(|v| section.weight(mesh.points[v]))))
    }

    /// At both of its ends.
    pub fn ends(&self) -> [f64; 2] {
        self.0.unwrap_or([1.0; 2])
    }

    /// At a part of the way from the first end to the second.
    pub fn at(&self, s: f64) -> f64 {
        self.0.map_or(1.0, |[a, b]| a + s * (b - a))
    }

    /// The larger one of its ends.
    pub fn largest(&self) -> f64 {
        self.0.map_or(1.0, |[a, b]| a.max(b))
    }

    /// The mean along the edge.
    pub fn mean(&self) -> f64 {
        self.0.map_or(1.0, |[a, b]| 0.5 * (a + b))
    }

    /// At one of its ends.
    pub fn at_end(&self, end: usize) -> f64 {
        self.0.map_or(1.0, |radii| radii[end])
    }

    /// The distances of the ends from the axis of revolution.
    pub fn radii(&self) -> Option<[f64; 2]> {
        self.0
    }

    /// Bernstein coefficients of a function times the weight.
    pub fn times(&self, f: &[f64]) -> Vec<f64> {
        self.0.map_or_else(|| f.to_vec(), |radii| side::times_linear(f, radii))
    }

    /// ∫ f² over the weight, from above, for a weighted function on an edge of length one.
    pub fn square_over(&self, f: &[f64]) -> f64 {
        if self.0.is_none() {
            return side::integral(f, f);
        }
        let square = |p: &SidePoint| p.weight * (1.0 + p.excess) * side::value(f, p.at).powi(2) / p.radius;
        self.rule([0.0, 1.0], 2 * (f.len() - 1)).iter().map(square).sum()
    }

    /// ∫ f g over the weight, for weighted functions on an edge of length one.
    pub fn product_over(&self, f: &[f64], g: &[f64]) -> f64 {
        if self.0.is_none() {
            return side::integral(f, g);
        }
        let product = |p: &SidePoint| p.weight * side::value(f, p.at) * side::value(g, p.at) / p.radius;
        self.rule([0.0, 1.0], f.len() + g.len() - 2).iter().map(product).sum()
    }

    /// A rule on a part of an edge of length one, exact for polynomials of degree `degree`, and with [`SidePoint::excess`] for those over the
    /// weight.
    pub fn rule(&self, [from, to]: [f64; 2], degree: usize) -> Vec<SidePoint> {
        let whole = |p: SidePoint| SidePoint { at: from + p.at * (to - from), weight: p.weight * (to - from), ..p };
        side_rule([from, to].map(|s| self.at(s)), degree, NEAR).into_iter().map(whole).collect()
    }

    /// A weighted function over the weight at an end of the edge; on the axis of revolution, where both vanish, its limit.
    pub fn unweighted_at_end(&self, f: &[f64], end: usize) -> f64 {
        let (own, next) = if end == 0 { (0, 1) } else { (f.len() - 1, f.len().saturating_sub(2)) };
        match self.at_end(end) {
            0.0 if f.len() > 1 => (f.len() - 1) as f64 * f[next] / self.at_end(1 - end),
            weight => f[own] / weight,
        }
    }

    /// The ends of the linear function that has, times the weight, force and moment of `p`: for a weighted `p` the nearest one in the
    /// weighted mean square.
    pub fn linear(&self, p: &[f64]) -> [f64; 2] {
        let [[a, b], [_, d]] = [0, 1].map(|i| [0, 1].map(|j| self.product(1, i, j)));
        let moments = side::moments(p, 1);
        [d * moments[0] - b * moments[1], a * moments[1] - b * moments[0]].map(|x| x / (a * d - b * b))
    }

    /// ∫ of the linear function that is one at end `end` and zero at the other, times the weight.
    pub fn of_hat(&self, end: usize) -> f64 {
        self.product(1, end, 0) + self.product(1, end, 1)
    }

    /// ∫ B_i B_j times the weight, for polynomials of degree `k` on an edge of length one.
    pub fn product(&self, k: usize, i: usize, j: usize) -> f64 {
        let Some([a, b]) = self.0 else { return side::product(k, i, k, j) };
        let n = (k + 1) as f64;
        (n - j as f64) / n * a * side::product(k, i, k + 1, j)
            + (j + 1) as f64 / n * b * side::product(k, i, k + 1, j + 1)
    }
}

/// The gap of an elastic contact along its edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneSided {
    pair: ContactPair,
    reversed: bool,
}

impl OneSided {
    /// Bernstein coefficients of the gap, from the first vertex of the edge to its second.
    pub fn gap(&self) -> Vec<f64> {
        self.along_edge(self.pair.gap_polynomial())
    }

    /// Coefficients along the pair as those along the edge.
    fn along_edge(&self, mut coefficients: Vec<f64>) -> Vec<f64> {
        if self.reversed {
            coefficients.reverse();
        }
        coefficients
    }
}

impl BedPair {
    fn new(mesh: &Triangulation, edge: usize, opposite: Option<usize>) -> Self {
        let (length, [x, y]) = mesh.edge_frame(edge);
        let weight = EdgeWeight::default();
        BedPair { edge, opposite, axes: [[x, y], [-y, x]], length, weight, contact: None }
    }

    /// The springs that an elastic contact is where it is closed, and their stiffness; `None` of a rigid one.
    pub fn of_contact(pair: &ContactPair, section: Section, mesh: &Triangulation) -> Option<(Self, [f64; 2])> {
        let (k, edge) = (pair.stiffness?, pair.edges[0]?);
        let [x, y] = pair.direction.unit(0);
        let reversed = mesh.edges[edge].vertices[0] != pair.first[0];
        let contact = Some(OneSided { pair: *pair, reversed });
        let weight = EdgeWeight::on(section, mesh, edge);
        let own = BedPair { axes: [[x, y], [-y, x]], contact, weight, ..BedPair::new(mesh, edge, pair.edges[1]) };
        Some((own, [k, 0.0]))
    }

    /// The edges with the side that each is on.
    pub fn sides(&self) -> impl Iterator<Item = (usize, usize)> {
        [Some(self.edge), self.opposite].into_iter().enumerate().filter_map(|(side, e)| Some((side, e?)))
    }
}

impl Bed {
    /// The springs of a support, where they are ones.
    pub(super) fn of_support(support: &Support, mesh: &Triangulation) -> Option<Bed> {
        let SupportKind::Spring { stiffness } = support.kind else { return None };
        let pairs = mesh.boundary(&support.on).into_iter().map(|e| BedPair::new(mesh, e, None)).collect();
        Some(Bed { name: support.on.clone(), stiffness, pairs })
    }

    /// The layer of a bond, where it has one.
    ///
    /// # Errors
    /// Sides that do not match.
    pub(super) fn of_bond(bond: &Bond, scene: &Scene, mesh: &Triangulation) -> Result<Option<Bed>, ProblemError> {
        let Some(stiffness) = bond.stiffness else { return Ok(None) };
        let pairs = opposite(mesh, scene, bond.joint())?;
        let pairs = pairs.into_iter().map(|[e, f]| BedPair::new(mesh, e, Some(f))).collect();
        Ok(Some(Bed { name: bond.name(), stiffness, pairs }))
    }

    /// Sets the weights of its pairs to those of `section`.
    pub(super) fn of_section(mut self, section: Section, mesh: &Triangulation) -> Self {
        self.pairs.iter_mut().for_each(|pair| pair.weight = EdgeWeight::on(section, mesh, pair.edge));
        self
    }

    /// True if it has a second side.
    pub fn is_layer(&self) -> bool {
        self.pairs.iter().any(|pair| pair.opposite.is_some())
    }
}

/// The vertices of the second side opposite those of the first, for all layers.
pub(crate) fn facing_vertices<'a>(mesh: &'a Triangulation, beds: &'a [Bed]) -> impl Iterator<Item = [usize; 2]> + 'a {
    beds.iter().flat_map(|bed| &bed.pairs).flat_map(|pair| {
        let [a, b] = mesh.edges[pair.edge].vertices;
        let facing = pair.opposite.map(|f| mesh.edges[f].vertices);
        facing.into_iter().flat_map(move |[c, d]| [[a, d], [b, c]])
    })
}
