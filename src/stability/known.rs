//! Facts that are known about an answer before anything is solved.

/// Facts about one problem of a regime.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// True if there is an equilibrium.
    pub solvable: bool,
    /// Exact energy and 𝒮 of the exact stress, from a closed solution.
    pub energy: Option<[f64; 2]>,
    /// Force on the first side of each contact; NaN for a component that is not known.
    pub resultants: Vec<[f64; 2]>,
    /// Equilibrium alone does not determine these forces: they are as good as the stresses that they are integrals of.
    pub indeterminate: bool,
    /// Size of the applied forces: what deviations of resultants are relative to.
    pub load: f64,
    /// Total variation of the exact pressure on each contact, where it is known.
    pub variation: Vec<f64>,
    /// Factors of energy and force against the first problem of the regime, where one follows from the other.
    pub scale: Option<[f64; 2]>,
    /// Components of forces may have the other sign.
    pub mirrored: bool,
}

impl Known {
    /// An equilibrium exists and the forces on each contact are these.
    pub fn forces(resultants: Vec<[f64; 2]>, load: f64) -> Self {
        Known {
            solvable: true,
            energy: None,
            resultants,
            indeterminate: false,
            load,
            variation: Vec::new(),
            scale: None,
            mirrored: false,
        }
    }

    /// The forces come from an exact solution, and not from equilibrium alone.
    pub fn indeterminate(mut self) -> Self {
        self.indeterminate = true;
        self
    }

    /// No equilibrium exists.
    pub fn none() -> Self {
        Known { solvable: false, ..Known::forces(Vec::new(), 1.0) }
    }

    /// The answer is that of the first problem with energies and forces multiplied.
    pub fn scaled(mut self, energy: f64, force: f64) -> Self {
        self.scale = Some([energy, force]);
        self
    }

    /// The answer is one in a mirror.
    pub fn mirrored(mut self) -> Self {
        self.mirrored = true;
        self
    }
}
