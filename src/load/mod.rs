//! Loads on bodies: polynomial force fields, with everything that depends on their degree.
//!
//! A [`BodyForce`] is a force per volume that is affine in x: what is given, f = value + gradient · x, and the centrifugal force
//! ϱω²(x − c) of a rotation. What acts on one triangle is [`OnTriangle`]: values, integrals against polynomials, resultant, moment, and a
//! stress that balances it. Nothing outside this module asks for the degree of the field; it asks for the degree that a stress needs
//! to balance it ([`BodyForce::stress_degree`]).
//!
//! An affine force in general has no potential that a piecewise linear stress could follow to the boundary: even where f = −∇V, V is
//! quadratic, and so is the traction that balances it on every edge that is loaded, free or in contact. Stresses of degree 2 balance every
//! affine force exactly ([`balancing`]), whether it has a potential or not.

mod affine;
mod on_triangle;

pub use affine::Affine;
pub use on_triangle::{OnTriangle, balancing};

use crate::vector::norm;

/// A force per volume on a body.
///
/// ```
/// # use hypercircle_core as hypercircle;
/// use hypercircle::load::{BodyForce, Rotation};
///
/// let turning = BodyForce::constant([0.0, -1.0]).with_rotation(Rotation { density: 2.0, omega: 3.0, about: [1.0, 0.0] });
/// assert_eq!(turning.at([2.0, 0.5]), [18.0, 8.0]);
/// assert_eq!(turning.stress_degree(), 2);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BodyForce {
    given: Affine,
    rotation: Option<Rotation>,
    /// True if it turns about the line through its centre along y, and not about the centre.
    about_line: bool,
}

/// A body that turns with its frame: in it the force ϱω²(x − c) acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// Mass per volume ϱ.
    pub density: f64,
    /// Angular velocity ω, in radians per time.
    pub omega: f64,
    /// The point c that stays at rest.
    pub about: [f64; 2],
}

impl Rotation {
    /// ϱω², the gradient of the force.
    pub fn stiffness(&self) -> f64 {
        self.density * self.omega * self.omega
    }
}

impl From<[f64; 2]> for BodyForce {
    fn from(force: [f64; 2]) -> Self {
        BodyForce::constant(force)
    }
}

impl BodyForce {
    /// No force.
    pub const NONE: BodyForce =
        BodyForce { given: Affine { value: [0.0; 2], gradient: [[0.0; 2]; 2] }, rotation: None, about_line: false };

    /// A uniform force.
    pub fn constant(force: [f64; 2]) -> Self {
        BodyForce::affine(Affine::constant(force))
    }

    /// value + gradient · x.
    pub fn affine(given: Affine) -> Self {
        BodyForce { given, ..BodyForce::NONE }
    }

    /// This force with a constant one added.
    #[must_use]
    pub fn plus(mut self, force: [f64; 2]) -> Self {
        (0..2).for_each(|c| self.given.value[c] += force[c]);
        self
    }

    /// With the centrifugal force of a rotation, in place of any other.
    pub fn with_rotation(self, rotation: Rotation) -> Self {
        BodyForce { rotation: Some(rotation), ..self }
    }

    /// This force with its rotation about the line through the centre along y, as in a body of revolution: ϱω²(x − c_x) along x.
    #[must_use]
    pub fn about_line(self) -> Self {
        BodyForce { about_line: true, ..self }
    }

    /// True if its rotation is about a line, as in a body of revolution.
    pub fn is_about_line(&self) -> bool {
        self.about_line
    }

    /// The force as it was given, without that of a rotation.
    pub fn given(&self) -> Affine {
        self.given
    }

    /// The rotation.
    pub fn rotation(&self) -> Option<Rotation> {
        self.rotation
    }

    /// True if there is no force anywhere.
    pub fn is_none(&self) -> bool {
        self.given == Affine::default() && self.turning() == 0.0
    }

    /// True if it is uniform.
    pub fn is_constant(&self) -> bool {
        self.gradient() == [[0.0; 2]; 2]
    }

    /// The least degree of stresses that balance it.
    pub fn stress_degree(&self) -> usize {
        if self.is_constant() { 1 } else { 2 }
    }

    /// Its value at `point`.
    pub fn at(&self, point: [f64; 2]) -> [f64; 2] {
        let mut force = if self.given.is_constant() { self.given.value } else { self.given.at(point) };
        if let Some(rotation) = self.rotation {
            (0..if self.about_line { 1 } else { 2 })
                .for_each(|c| force[c] += rotation.stiffness() * (point[c] - rotation.about[c]));
        }
        force
    }

    /// ∂_j of component i.
    pub fn gradient(&self) -> [[f64; 2]; 2] {
        let [[xx, xy], [yx, yy]] = self.given.gradient;
        let turning = self.turning();
        [[xx + turning, xy], [yx, if self.about_line { yy } else { yy + turning }]]
    }

    /// The whole force, rotation included, as one affine function of x.
    pub fn as_affine(&self) -> Affine {
        Affine { value: self.at([0.0; 2]), gradient: self.gradient() }
    }

    /// The whole force as an affine function of coordinates about the centroid of a triangle.
    pub fn about_centroid(&self, corners: [[f64; 2]; 3]) -> Affine {
        Affine { value: self.on(corners).mean(), gradient: self.gradient() }
    }

    /// The force on the triangle with these corners.
    pub fn on(&self, corners: [[f64; 2]; 3]) -> OnTriangle {
        OnTriangle::new(self, corners)
    }

    /// The largest size that it has on a rectangle, which it takes at a corner.
    pub fn largest_in(&self, [low, high]: [[f64; 2]; 2]) -> f64 {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        corners.map(|corner| norm(self.at(corner))).into_iter().fold(0.0, f64::max)
    }

    /// Its size times a factor.
    pub fn times(&self, factor: f64) -> Self {
        let scaled = |rotation: Rotation| Rotation { density: factor * rotation.density, ..rotation };
        BodyForce { given: self.given.times(factor), rotation: self.rotation.map(scaled), ..*self }
    }

    /// Changes to coordinates that count from `middle`; the force stays the same.
    pub(crate) fn shift(&mut self, middle: [f64; 2]) {
        self.given.shift(middle);
        if let Some(rotation) = &mut self.rotation {
            rotation.about = [0, 1].map(|c| rotation.about[c] - middle[c]);
        }
    }

    fn turning(&self) -> f64 {
        self.rotation.map_or(0.0, |rotation| rotation.stiffness())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GIVEN: Affine = Affine { value: [0.3, -0.7], gradient: [[1.0, 2.0], [-0.5, 0.25]] };

    #[test]
    fn a_rotation_about_a_point_is_an_affine_force() {
        let rotation = Rotation { density: 0.5, omega: 2.0, about: [3.0, -1.0] };
        let turning = BodyForce::affine(GIVEN).with_rotation(rotation);
        let Affine { value: [x, y], gradient: [[a, b], [c, d]] } = GIVEN;
        let plain = BodyForce::affine(Affine { value: [x - 6.0, y + 2.0], gradient: [[a + 2.0, b], [c, d + 2.0]] });
        assert_eq!(turning.as_affine(), plain.as_affine());
        for point in [[0.0, 0.0], [1.5, -2.0], [7.0, 0.25]] {
            let [p, q] = [turning.at(point), plain.at(point)];
            assert!((0..2).all(|i| (p[i] - q[i]).abs() < 1e-14), "{p:?} {q:?}");
        }
    }

    #[test]
    fn a_rotation_about_a_line_leaves_what_is_along_it() {
        let rotation = Rotation { density: 0.5, omega: 2.0, about: [3.0, -1.0] };
        let turning = BodyForce::constant([0.0, -1.0]).with_rotation(rotation).about_line();
        assert_eq!(turning.at([5.0, 7.0]), [4.0, -1.0]);
        assert_eq!(turning.gradient(), [[2.0, 0.0], [0.0, 0.0]]);
        assert_eq!(turning.times(0.5).at([5.0, 7.0]), [2.0, -0.5]);
    }

    #[test]
    fn a_gradient_of_zero_and_a_rotation_at_rest_leave_a_constant() {
        let still = Rotation { density: 1.0, omega: 0.0, about: [5.0, 5.0] };
        let force = BodyForce::constant([1.0, 2.0]).with_rotation(still);
        assert!(force.is_constant() && !force.is_none() && force.stress_degree() == 1);
        assert!(BodyForce::NONE.with_rotation(still).is_none());
    }

    #[test]
    fn coordinates_may_count_from_anywhere() {
        let rotation = Rotation { density: 0.5, omega: 2.0, about: [3.0, -1.0] };
        let force = BodyForce::affine(GIVEN).with_rotation(rotation);
        let (mut moved, middle) = (force, [64.0, -32.0]);
        moved.shift(middle);
        let point = [65.25, -31.5];
        let [p, q] = [force.at(point), moved.at([1.25, 0.5])];
        assert!((0..2).all(|i| (p[i] - q[i]).abs() < 1e-12), "{p:?} {q:?}");
    }
}
