//! Data that displacements on one mesh share, whatever pulls at them: stiffness, and factors of patches.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use super::energy::model::Model;
use super::relaxation::patches::Patches;

/// A place for them: the upper bound leaves there what it made, and the next displacement on its mesh takes it.
#[derive(Clone, Default)]
pub struct Prepared(Arc<Mutex<Option<Box<Made>>>>);

/// The shared data of one mesh.
pub struct Made {
    /// Loads and bounds of others can take the place of its own.
    pub model: Model,
    /// With the factors that were needed.
    pub patches: Patches,
}

impl Prepared {
    /// The place with what was made.
    pub(super) fn holding(made: Made) -> Self {
        Prepared(Arc::new(Mutex::new(Some(Box::new(made)))))
    }

    /// Takes it away: it is large, and is to be freed after its next use.
    pub(super) fn take(&self) -> Option<Box<Made>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Prepared")
    }
}
