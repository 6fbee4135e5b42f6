//! A test that a mesh fits into memory, made before it is solved on.

use crate::budget::{Budget, Excess};
use crate::dual::{DualMethod, Size};

/// A method and the memory that it may take.
#[derive(Clone, Copy)]
pub struct Admission<'a> {
    method: &'a dyn DualMethod,
    budget: Budget,
}

impl<'a> Admission<'a> {
    /// For solves with `method` within `budget`.
    pub fn new(method: &'a dyn DualMethod, budget: Budget) -> Self {
        Admission { method, budget }
    }

    /// Admits a mesh of that size if it can be solved on while the solution on a mesh of size `kept` stays in memory.
    ///
    /// # Errors
    /// [`Excess`] with both figures.
    pub fn admit(&self, size: Size, kept: Option<Size>) -> Result<(), Excess> {
        self.budget.admit(self.method.memory(size) + kept.map_or(0.0, Size::kept))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::{ActiveSet, Clarabel, Condensed, Uzawa};

    const MESH: Size = Size { triangles: 1000.0, distinct: 1000.0, contact_ends: 40.0 };

    #[test]
    fn larger_meshes_take_more_and_do_not_fit_from_some_size_on() {
        let methods: [&dyn DualMethod; 4] =
            [&Condensed::default(), &ActiveSet::default(), &Clarabel::default(), &Uzawa::default()];
        for method in methods {
            let admission = Admission::new(method, Budget::of(1_000_000_000));
            let admitted: Vec<bool> = (0..8).map(|n| admission.admit(MESH.refined(n), None).is_ok()).collect();
            assert!(admitted[0] && !admitted[7], "{}: {admitted:?}", method.name());
            assert!(admitted.is_sorted_by(|a, b| a >= b), "{}: {admitted:?}", method.name());
            assert!(Admission::new(method, Budget::UNLIMITED).admit(MESH.refined(500), None).is_ok());
        }
    }

    #[test]
    fn what_is_kept_counts() {
        let method = Condensed::default();
        let enough = method.memory(MESH);
        let admission = Admission::new(&method, Budget::of(enough.ceil() as u64));
        assert!(admission.admit(MESH, None).is_ok());
        let excess = admission.admit(MESH, Some(MESH)).expect_err("the solution before does not fit beside it");
        assert_eq!(excess.needed, enough + MESH.kept());
    }
}
