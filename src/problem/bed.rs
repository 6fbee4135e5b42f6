//! Boundaries on springs, and elastic layers between two sides.
//!
//! The law of such an interface is φ(j) = ½ k j² in each of two directions, j being the displacement of the first side less that
//! of the second, or of the ground: the traction on the first side is −k j. Its conjugate φ*(q) = q²/2k is what the complementary
//! energy has of it, with q = −t, and φ(j) + φ*(q) − q j = (k j − q)²/2k is what it adds to the gap.

use super::ProblemError;
use crate::mesh::Triangulation;
use crate::mesh::bonded::opposite;
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
}

impl BedPair {
    fn new(mesh: &Triangulation, edge: usize, opposite: Option<usize>) -> Self {
        let (length, [x, y]) = mesh.edge_frame(edge);
        BedPair { edge, opposite, axes: [[x, y], [-y, x]], length }
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

    /// Whether it has a second side.
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
