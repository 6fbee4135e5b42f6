//! Elastic contact: penetration beyond the gap against a pressure that is in proportion to it.
//!
//! Its law is φ(j) = ½ k (j − g)₊², with the conjugate φ*(q) = q²/2k + q g for q = −t ≥ 0. Two views of it serve two sides. That of
//! stresses is a contact with a spring behind it: with a stretch s of energy ½ k s², a free unknown, j − s ≤ g is the law of contact, and
//! φ(j) the least of ½ k s². That of displacements is springs that do not pull ([`Problem::softened`]): nothing bounds the jump.

use std::borrow::Cow;

use crate::mesh::Triangulation;
use crate::problem::{Bed, BedPair, Condition, Interface, Problem, ProblemError};
use crate::scene::Contact;

impl Problem {
    /// True if a contact is elastic.
    pub fn has_elastic_contact(&self) -> bool {
        self.pairs().any(|pair| pair.stiffness.is_some())
    }

    /// This problem with its elastic contacts replaced by springs that do not pull, listed after all other springs. The interfaces
    /// keep their places, without pairs.
    pub fn softened(&self) -> Cow<'_, Problem> {
        if !self.has_elastic_contact() {
            return Cow::Borrowed(self);
        }
        let mut soft = self.clone();
        for index in 0..soft.interfaces.len() {
            let of = |pair| BedPair::of_contact(pair, soft.section(), &soft.mesh);
            let springs: Option<Vec<_>> = soft.interfaces[index].pairs.iter().map(of).collect();
            let Some(springs) = springs.filter(|springs| !springs.is_empty()) else { continue };
            let (bed, stiffness) = (soft.beds.len(), springs[0].1);
            let pairs: Vec<BedPair> = springs.into_iter().map(|(pair, _)| pair).collect();
            for (pair, edges) in pairs.iter().enumerate() {
                edges.sides().for_each(|(side, e)| soft.conditions[e] = Condition::Elastic { bed, pair, side });
            }
            let name = soft.interfaces[index].name.clone();
            soft.beds.push(Bed { name, stiffness, pairs });
            soft.interfaces[index].pairs.clear();
        }
        Cow::Owned(soft)
    }
}

/// Refuses what elastic contact does not have.
pub(in crate::problem) fn refuse(
    contact: &Contact,
    matched: &Interface,
    mesh: &Triangulation,
) -> Result<(), ProblemError> {
    if contact.stiffness.is_none() {
        return Ok(());
    }
    let fault = |what: &str, remedy: &str| {
        Err(ProblemError::Contact { contact: contact.name(), what: what.into(), remedy: remedy.into() })
    };
    if matched.pairs.iter().any(|pair| !pair.direction.is_constant()) {
        let what = "`stiffness` is given, and the direction of contact turns along its edges";
        return fault(what, "write normals = \"facets\", or straight obstacles and sides");
    }
    if matched.pairs.iter().any(|pair| pair.direction.shares != [1.0; 2] || !coincide(pair, mesh)) {
        let what = "`stiffness` is given, and the sides do not coincide";
        return fault(what, "draw the sides on each other, and give their distance as `gap`");
    }
    Ok(())
}

/// True if the two sides of a pair coincide.
fn coincide(pair: &crate::problem::ContactPair, mesh: &Triangulation) -> bool {
    pair.second.is_none_or(|second| (0..2).all(|end| mesh.points[second[end]] == mesh.points[pair.first[end]]))
}
