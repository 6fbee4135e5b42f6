//! Strains and stresses that a body has before it is loaded.

use super::{Elasticity, Plane, Revolution};

/// Initial state of a body without any load: e = a σ + ε0 with ε0 = α ΔT − a σ0.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Initial {
    /// Thermal expansion along axes 1, 2 and 3 of the body.
    pub expansion: [f64; 3],
    /// Temperature at the origin of coordinates, above the one without stress.
    pub temperature: f64,
    /// Its gradient.
    pub gradient: [f64; 2],
    /// Initial stress xx, yy, xy and zz, the last of which is out of the plane.
    pub stress: [f64; 4],
}

/// An initial strain in the plane, affine in x, and the σ_33 that it causes where there is no stress in the plane.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct InitialStrain {
    /// ε0 (xx, yy, xy) at the origin, with the tensor component in the last place.
    pub value: [f64; 3],
    /// Its gradient.
    pub gradient: [[f64; 2]; 3],
    /// σ_33 at the origin where there is no stress in the plane.
    pub transverse: f64,
    /// Its gradient.
    pub transverse_gradient: [f64; 2],
    /// ε0_θθ of a body of revolution at the origin; nothing in the plane.
    pub hoop: f64,
    /// Its gradient.
    pub hoop_gradient: [f64; 2],
}

impl Initial {
    /// True if the body has no initial strain or stress.
    pub fn is_none(&self) -> bool {
        let warm = self.temperature != 0.0 || self.gradient != [0.0; 2];
        self.stress == [0.0; 4] && !(warm && self.expansion != [0.0; 3])
    }

    /// All of it as a list of numbers.
    pub fn to_numbers(&self) -> [f64; 10] {
        let ([a, b, c], [x, y], [xx, yy, xy, zz]) = (self.expansion, self.gradient, self.stress);
        [a, b, c, self.temperature, x, y, xx, yy, xy, zz]
    }

    /// From such a list.
    pub fn from_numbers(&[a, b, c, temperature, x, y, xx, yy, xy, zz]: &[f64; 10]) -> Self {
        Initial { expansion: [a, b, c], temperature, gradient: [x, y], stress: [xx, yy, xy, zz] }
    }

    /// The temperature at a point.
    pub fn temperature_at(&self, [x, y]: [f64; 2]) -> f64 {
        self.temperature + (self.gradient[0] * x + self.gradient[1] * y)
    }

    /// Counts coordinates from `point`.
    #[must_use]
    pub fn about(self, point: [f64; 2]) -> Self {
        Initial { temperature: self.temperature_at(point), ..self }
    }
}

impl InitialStrain {
    /// None at all.
    pub const NONE: Self = InitialStrain {
        value: [0.0; 3],
        gradient: [[0.0; 2]; 3],
        transverse: 0.0,
        transverse_gradient: [0.0; 2],
        hoop: 0.0,
        hoop_gradient: [0.0; 2],
    };

    /// True if there is no strain in the plane, nor around an axis.
    pub fn is_none(&self) -> bool {
        self.value == [0.0; 3] && self.hoop == 0.0 && self.is_constant()
    }

    /// True if the strain is uniform.
    pub fn is_constant(&self) -> bool {
        self.gradient == [[0.0; 2]; 3] && self.hoop_gradient == [0.0; 2]
    }

    /// ε0 (rr, zz, tt, rz) of a body of revolution at a point.
    pub fn around(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let [rr, zz, rz] = self.at([x, y]);
        [rr, zz, self.hoop + (self.hoop_gradient[0] * x + self.hoop_gradient[1] * y), rz]
    }

    /// ε0 at a point.
    pub fn at(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|c| self.value[c] + (self.gradient[c][0] * x + self.gradient[c][1] * y))
    }

    /// σ_33 without stress in the plane, at a point.
    pub fn transverse_at(&self, [x, y]: [f64; 2]) -> f64 {
        self.transverse + (self.transverse_gradient[0] * x + self.transverse_gradient[1] * y)
    }

    /// A displacement that has this strain, at `point`; it vanishes at `from` together with its rotation.
    pub fn displacement(&self, from: [f64; 2], point: [f64; 2]) -> [f64; 2] {
        const PLACE: [[usize; 2]; 2] = [[0, 2], [2, 1]];
        let (e, y) = (self.at(from), [point[0] - from[0], point[1] - from[1]]);
        // w_i,jk = ∂_k e_ij + ∂_j e_ik − ∂_i e_jk.
        let second = |i: usize, j: usize, k: usize| {
            let of = |a: usize, b: usize, c: usize| self.gradient[PLACE[a][b]][c];
            of(i, j, k) + of(i, k, j) - of(j, k, i)
        };
        [0, 1].map(|i| {
            let linear = e[PLACE[i][0]] * y[0] + e[PLACE[i][1]] * y[1];
            let pairs = [(0, 0), (0, 1), (1, 0), (1, 1)].into_iter();
            linear + 0.5 * pairs.map(|(j, k)| second(i, j, k) * y[j] * y[k]).sum::<f64>()
        })
    }
}

impl Elasticity {
    /// The initial strain in plane strain or plane stress. In plane strain it includes the effect of the restrained transverse strain.
    pub fn initial_strain(&self, strain: bool, initial: &Initial) -> InitialStrain {
        if initial.is_none() {
            return InitialStrain::NONE;
        }
        let Some(plane) = self.plane(strain) else { return InitialStrain::NONE };
        let [warm, out] = self.of_unit_temperature(&plane, initial);
        let [cold, stress_out] = of_stress(&plane, strain, initial.stress);
        let components =
            |[trace, across, shear]: [f64; 3]| [0.5 * (trace + across), 0.5 * (trace - across), 0.5 * shear];
        let (warm, cold) = (components(warm), components(cold));
        let slope = |c: usize| initial.gradient.map(|g| warm[c] * g);
        InitialStrain {
            value: [0, 1, 2].map(|c| warm[c] * initial.temperature + cold[c]),
            gradient: [0, 1, 2].map(slope),
            transverse: out[0] * initial.temperature + stress_out[0],
            transverse_gradient: initial.gradient.map(|g| out[0] * g),
            ..InitialStrain::NONE
        }
    }

    /// The initial strain of a body of revolution; `initial.stress` is rr, zz, rz and tt.
    pub fn initial_strain_around(&self, initial: &Initial) -> InitialStrain {
        if initial.is_none() {
            return InitialStrain::NONE;
        }
        let Some(law) = self.revolution() else { return InitialStrain::NONE };
        let [first, second, third] = initial.expansion;
        let [c, s] = self.double_angle();
        let (sum, apart) = (first + second, first - second);
        let warm = [0.5 * (sum + apart * c), 0.5 * (sum - apart * c), third, 0.5 * apart * s];
        let cold = of_stress_around(&law, initial.stress);
        let slope = |c: usize| initial.gradient.map(|g| warm[c] * g);
        let value = [0, 1, 2, 3].map(|c| warm[c] * initial.temperature + cold[c]);
        InitialStrain {
            value: [value[0], value[1], value[3]],
            gradient: [slope(0), slope(1), slope(3)],
            hoop: value[2],
            hoop_gradient: slope(2),
            ..InitialStrain::NONE
        }
    }

    /// Trace, difference and shear of the strain of a unit of temperature, and the remaining σ_33.
    fn of_unit_temperature(&self, plane: &Plane, initial: &Initial) -> [[f64; 3]; 2] {
        let [first, second, third] = initial.expansion;
        let [c, s] = self.double_angle();
        let own = [first + second, (first - second) * c, (first - second) * s];
        let all = [0, 1, 2].map(|j| own[j] + plane.transverse[j] * third);
        [all, [-plane.transverse_stiffness * third, 0.0, 0.0]]
    }
}

/// Trace, difference and shear of −a σ0, and the remaining σ_33.
fn of_stress(plane: &Plane, strain: bool, [xx, yy, xy, zz]: [f64; 4]) -> [[f64; 3]; 2] {
    let own = [0.5 * (xx + yy), 0.5 * (xx - yy), xy];
    let root = plane.factor.map(|row| row[0] * own[0] + row[1] * own[1] + row[2] * own[2]);
    let product = [0, 1, 2].map(|j| (0..3).map(|i| plane.factor[i][j] * root[i]).sum::<f64>());
    if strain {
        let held = (0..3).map(|j| plane.transverse[j] * own[j]).sum::<f64>();
        return [product.map(|e| -e), [zz - held, 0.0, 0.0]];
    }
    [[0, 1, 2].map(|j| -(product[j] + plane.cross[j] * zz)), [0.0; 3]]
}

/// −a σ0 (rr, zz, tt, rz) of a stress rr, zz, rz and tt of a body of revolution.
fn of_stress_around(law: &Revolution, [rr, zz, rz, tt]: [f64; 4]) -> [f64; 4] {
    let own = Revolution::unknowns([rr, zz, tt, rz]);
    let root = law.factor.map(|row| (0..4).map(|j| row[j] * own[j]).sum::<f64>());
    let product = [0, 1, 2, 3].map(|j| (0..4).map(|i| law.factor[i][j] * root[i]).sum::<f64>());
    Revolution::components(product).map(|e| -e)
}

#[cfg(test)]
mod tests {
    use super::super::Orthotropic;
    use super::*;

    #[test]
    fn an_isotropic_body_in_plane_strain_expands_by_one_plus_nu() {
        let law = Elasticity::Isotropic { young: 7.0, poisson: 0.3 };
        let warm = Initial { expansion: [1e-3; 3], temperature: 50.0, gradient: [2.0, -1.0], ..Initial::default() };
        let strain = law.initial_strain(true, &warm);
        assert!((strain.value[0] - 1.3 * 0.05).abs() < 1e-15 && (strain.value[1] - 1.3 * 0.05).abs() < 1e-15);
        assert!((strain.gradient[0][0] - 2.6e-3).abs() < 1e-16 && strain.value[2].abs() < 1e-18);
        assert!((strain.transverse + 7.0 * 0.05).abs() < 1e-13);
        let free = law.initial_strain(false, &warm);
        assert!((free.value[0] - 0.05).abs() < 1e-15 && free.transverse == 0.0);
    }

    #[test]
    fn a_body_that_is_held_has_its_initial_stress() {
        let law = Elasticity::Orthotropic(Orthotropic {
            young: [9.0, 3.0, 4.0],
            poisson: [0.3, 0.2, 0.25],
            shear: 1.5,
            angle: 35.0,
        });
        for strain in [true, false] {
            let stress = [0.3, -0.7, 0.2, if strain { 0.4 } else { 0.0 }];
            let found = law.initial_strain(strain, &Initial { stress, ..Initial::default() });
            // σ = −c ε0.
            let plane = law.plane(strain).expect("a material");
            let [xx, yy, xy] = found.value;
            let e = [xx + yy, xx - yy, 2.0 * xy];
            let root = plane.inverse.map(|row| row[0] * e[0] + row[1] * e[1] + row[2] * e[2]);
            let s = [0, 1, 2].map(|j| -(0..3).map(|i| plane.inverse[i][j] * root[i]).sum::<f64>());
            let back = [s[0] + s[1], s[0] - s[1], s[2]];
            (0..3).for_each(|c| assert!((back[c] - stress[c]).abs() < 1e-13, "{back:?}"));
            let zz = found.transverse + (0..3).map(|j| plane.transverse[j] * s[j]).sum::<f64>();
            assert!((zz - stress[3]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_body_of_revolution_that_is_held_has_its_initial_stress_and_expands_by_its_coefficients() {
        let law = Elasticity::Orthotropic(Orthotropic {
            young: [9.0, 3.0, 4.0],
            poisson: [0.3, 0.2, 0.25],
            shear: 1.5,
            angle: 35.0,
        });
        let stress = [0.3, -0.7, 0.2, 0.4];
        let [rr, zz, tt, rz] = law.initial_strain_around(&Initial { stress, ..Initial::default() }).around([0.0; 2]);
        let compliance = law.revolution().expect("a material").compliance;
        let held = [0.3, -0.7, 0.4, 0.2];
        for (row, e) in compliance.iter().zip([rr, zz, tt, 2.0 * rz]) {
            let strain: f64 = row.iter().zip(held).map(|(a, s)| a * s).sum();
            assert!((strain + e).abs() < 1e-14);
        }
        let warm = Initial { expansion: [1.0, 3.0, 2.0], gradient: [0.5, 0.0], ..Initial::default() };
        let found = law.turned(55.0).initial_strain_around(&warm).around([2.0, 7.0]);
        // The axes are turned by a right angle.
        let exact = [3.0, 1.0, 2.0, 0.0];
        (0..4).for_each(|c| assert!((found[c] - exact[c]).abs() < 1e-14, "{found:?}"));
    }

    #[test]
    fn an_affine_strain_is_that_of_its_displacement() {
        let strain = InitialStrain {
            value: [0.3, -0.2, 0.5],
            gradient: [[1.0, -2.0], [0.4, 0.7], [-0.6, 0.9]],
            ..InitialStrain::NONE
        };
        let (from, at, h) = ([0.2, -0.1], [0.9, 0.6], 1e-5);
        let slope = |c: usize, k: usize| {
            let moved = |by: f64| {
                let mut p = at;
                p[k] += by;
                strain.displacement(from, p)[c]
            };
            (moved(h) - moved(-h)) / (2.0 * h)
        };
        let found = [slope(0, 0), slope(1, 1), 0.5 * (slope(0, 1) + slope(1, 0))];
        (0..3).for_each(|c| assert!((found[c] - strain.at(at)[c]).abs() < 1e-9));
    }
}
