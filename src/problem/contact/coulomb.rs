//! Coulomb friction along a contact: a bound τ̄ of the tangential traction that goes with the pressure, |T_t| ≤ μ |T_n|.
//!
//! With τ̄ held the law is that of a given bound, and the problem is one of least energy. What holds it is a field of this problem: τ̄ is
//! linear on every pair, and jumps between them where pressures do. A finer mesh has the bound of the mesh that it was made of.

use std::borrow::Cow;

use super::normals::Coarser;
use crate::element::Section;
use crate::mesh::Triangulation;
use crate::problem::{ContactPair, Friction, Interface, Problem};
use crate::scene::Scene;

/// True if a scene has a contact with Coulomb friction.
pub fn follows_coulomb(scene: &Scene) -> bool {
    scene.contacts.iter().any(|contact| contact.coefficient.is_some_and(|mu| mu > 0.0))
}

impl Problem {
    /// Coulomb's coefficient of contact `interface`; `None` where it has none, or one of zero.
    pub fn coefficient(&self, interface: usize) -> Option<f64> {
        self.scene.contacts.get(interface)?.coefficient.filter(|mu| *mu > 0.0)
    }

    /// This problem with `bounds` on friction at the two ends of each pair, contact by contact, where contacts have Coulomb friction; other
    /// contacts keep theirs.
    pub fn with_friction_bounds(&self, bounds: &[Vec<[f64; 2]>]) -> Problem {
        let mut problem = self.clone();
        for (index, interface) in problem.interfaces.iter_mut().enumerate() {
            if self.coefficient(index).is_none() {
                continue;
            }
            for (pair, bound) in interface.pairs.iter_mut().zip(&bounds[index]) {
                pair.friction = Friction::within(*bound, pair, (&self.mesh, self.section()));
            }
        }
        problem
    }

    /// This problem with a bound of one where contacts have Coulomb friction, for what depends on where friction is and not on how large.
    pub fn where_friction_acts(&self) -> Cow<'_, Problem> {
        if !follows_coulomb(&self.scene) {
            return Cow::Borrowed(self);
        }
        let of = |interface: &Interface| vec![[1.0; 2]; interface.pairs.len()];
        Cow::Owned(self.with_friction_bounds(&self.interfaces.iter().map(of).collect::<Vec<_>>()))
    }

    /// This problem for a displacement whose friction is bounded by Coulomb's coefficient times its own contact forces.
    pub fn bounded_by_contact_forces(&self) -> Cow<'_, Problem> {
        let mut problem = self.where_friction_acts();
        if let Cow::Owned(own) = &mut problem {
            for index in 0..own.interfaces.len() {
                let coefficient = own.coefficient(index);
                let frictions = own.interfaces[index].pairs.iter_mut().filter_map(|pair| pair.friction.as_mut());
                frictions.for_each(|friction| friction.coefficient = coefficient);
            }
        }
        problem
    }

    /// Friction of `pair` with a bound of zero, which problems do not have.
    pub fn without_resistance(&self, pair: &ContactPair) -> Friction {
        Friction::without_resistance(pair, (&self.mesh, self.section()))
    }

    /// The bounds at the two ends of each pair, contact by contact.
    pub fn friction_bounds(&self) -> Vec<Vec<[f64; 2]>> {
        let of = |pair: &ContactPair| pair.friction.map_or([0.0; 2], |friction| friction.bound);
        self.interfaces.iter().map(|interface| interface.pairs.iter().map(of).collect()).collect()
    }
}

/// Gives the pairs of a finer mesh the bound of the coarser pairs that they are parts of.
pub(in crate::problem) fn inherit_bounds(
    pairs: &mut [ContactPair],
    place: (&Triangulation, Section),
    coarser: &Coarser,
    interface: usize,
) {
    let parent = coarser.parents(interface);
    for pair in pairs {
        let Some((parent, friction)) = parent(pair).and_then(|parent| Some((parent, parent.friction?))) else {
            continue;
        };
        let [a, b] = friction.bound;
        let of = |end: usize| {
            let kept = pair.first[end] == parent.first[end];
            if kept { friction.bound[end] } else { 0.5 * (a + b) }
        };
        let bound = [of(0), of(1)];
        pair.friction = Friction::within(bound, pair, place);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_mesh_has_the_bound_of_the_coarser_one() {
        let text = r#"
            model = { kinematics = "plane-strain" }
            geometry.polygons = [{ body = "b", points = [[0, 0], [2, 0], [2, 1], [0, 1]], edges = ["foot", "", "load", ""] }]
            geometry.size = 1
            bodies.b = { young = 1, poisson = 0.3 }
            contacts = [{ on = "foot", friction = { coefficient = 0.3 } }]
        "#;
        let problem = Problem::load(Scene::parse(text, "scene.toml".as_ref()).expect("a scene")).expect("a problem");
        assert!(follows_coulomb(&problem.scene) && !problem.has_friction());
        let at = |s: f64| if s < 1.0 { 1.0 - s } else { 0.5 * s };
        let bounds = |p: &Problem| {
            let of = |pair: &ContactPair| {
                let inside = |s: f64| s.clamp(pair.arc[0] + 1e-9, pair.arc[1] - 1e-9);
                pair.arc.map(|s| at(inside(s)))
            };
            vec![p.pairs().map(of).collect::<Vec<_>>()]
        };
        let held = problem.with_friction_bounds(&bounds(&problem));
        let finer = held.refine_uniform(2).expect("a finer mesh");
        for (found, wanted) in finer.friction_bounds()[0].iter().zip(&bounds(&finer)[0]) {
            assert!((0..2).all(|k| (found[k] - wanted[k]).abs() < 1e-8), "{found:?} {wanted:?}");
        }
        assert!(finer.pairs().all(|pair| pair.friction.expect("friction").tangent.ends == [[1.0, 0.0]; 2]));
    }
}
