//! Hooke's law between gradients of displacements.

/// c over an area.
#[derive(Debug, Clone, Copy)]
pub enum Stiffness {
    /// λ and μ times the area.
    Isotropic {
        /// μ.
        shear: f64,
        /// λ.
        bulk: f64,
    },
    /// Stresses (xx, yy, xy) of unit strains ε_xx, ε_yy and 2 ε_xy, times the area.
    General([[f64; 3]; 3]),
}

impl Stiffness {
    /// From the stress of a strain (xx, yy, xy).
    pub fn general(stress: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Stiffness::General([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]].map(stress))
    }

    /// c e(α x̂_p) : e(β x̂_q) for functions α and β with gradients `a` and `b`: xx, xy, yx, yy, p before q.
    pub fn between(&self, a: [f64; 2], b: [f64; 2]) -> [f64; 4] {
        match *self {
            Stiffness::Isotropic { shear, bulk } => {
                let both = shear * (a[0] * b[0] + a[1] * b[1]);
                let entry = |p: usize, q: usize| bulk * a[p] * b[q] + shear * a[q] * b[p];
                [entry(0, 0) + both, entry(0, 1), entry(1, 0), entry(1, 1) + both]
            }
            Stiffness::General([xx, yy, xy]) => {
                let stress = |e: [f64; 3]| [0, 1, 2].map(|i| e[0] * xx[i] + e[1] * yy[i] + e[2] * xy[i]);
                let (along_x, along_y) = (stress([b[0], 0.0, b[1]]), stress([0.0, b[1], b[0]]));
                let work = |s: [f64; 3]| [a[0] * s[0] + a[1] * s[2], a[1] * s[1] + a[0] * s[2]];
                let ([xx, yx], [xy, yy]) = (work(along_x), work(along_y));
                [xx, xy, yx, yy]
            }
        }
    }
}
