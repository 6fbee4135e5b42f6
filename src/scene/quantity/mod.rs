//! The numbers a scene is solved for: linear functionals of displacement, contact pressure and stress.
//!
//! Each is a bounded functional of the energy norm, so that an interval can be guaranteed for it, values at points inside a homogeneous
//! body among them. The largest pressure and a force between two sharp ends are none, and the format has no words for them.

mod check;
mod fault;
mod parts;
mod point;
mod raw;

pub(super) use check::quantities;
pub use fault::QuantityFault;
pub(super) use raw::RawQuantity;

use super::{Kinematics, Scene};

/// A number the scene is solved for.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its name, unlike that of every other quantity; without `=` and control characters.
    pub name: String,
    /// Its definition.
    pub target: Target,
}

/// Definition of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// Mean displacement along a direction.
    Displacement {
        /// Where the mean is taken.
        of: Extent,
        /// Unit vector.
        direction: [f64; 2],
    },
    /// The force of a contact: the normal one that presses its sides together, positive in compression, or that of friction.
    ContactForce {
        /// Index into [`Draft::contacts`](super::Draft::contacts).
        contact: usize,
        /// The force of friction on the first side, positive along its arc length, in place of the normal force.
        tangential: bool,
        /// [s0, s1, s2, s3], a weight in the arc length s of the first side, counted as for [`super::Gap::Table`]: 0 up to
        /// s0 and from s3 on, 1 from s1 to s2, linear between. s0 ≤ s1 ≤ s2 < s3 with s0 < s1, or s1 ≤ 0: then the weight
        /// is 1 from the beginning of the side. `None` weights everything by 1.
        window: Option<[f64; 4]>,
    },
    /// The force along a direction that a support exerts on the bodies.
    SupportForce {
        /// Index into [`Draft::supports`](super::Draft::supports).
        support: usize,
        /// Unit vector.
        direction: [f64; 2],
    },
    /// The moment, counter-clockwise, of the forces that a contact exerts on its first side, or a support on the bodies.
    Moment {
        /// The contact or support that exerts them.
        of: Holder,
        /// The point the moment is taken about, counted from [`Draft::origin`](super::Draft::origin).
        about: [f64; 2],
    },
    /// Mean of a stress component over a region of a body.
    Stress {
        /// Index into [`Draft::bodies`](super::Draft::bodies).
        body: usize,
        /// The region; whether it lies inside the body only the mesh can tell.
        region: Region,
        /// The component.
        component: Component,
    },
    /// A value at a point inside a body.
    Point {
        /// Index into [`Draft::bodies`](super::Draft::bodies).
        body: usize,
        /// The point, counted from [`Draft::origin`](super::Draft::origin); whether it lies inside the body only the mesh can tell.
        at: [f64; 2],
        /// The value.
        value: PointValue,
        /// n of the weight (1 − s)ⁿ (1 − (n + 3)s/2) of the mean that is the value, at most [`PointValue::SMOOTHEST`].
        smoothness: usize,
    },
    /// The stress intensity at the tip of a crack.
    StressIntensity {
        /// Opening or sliding.
        mode: Mode,
        /// The tip, counted from [`Draft::origin`](super::Draft::origin).
        tip: [f64; 2],
    },
}

/// How a crack opens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// The faces move apart.
    I,
    /// The faces slide in the plane.
    II,
}

impl Mode {
    /// The word of the format.
    pub fn word(self) -> &'static str {
        match self {
            Mode::I => "KI",
            Mode::II => "KII",
        }
    }
}

/// The value wanted at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PointValue {
    /// The displacement along a unit vector.
    Displacement([f64; 2]),
    /// A component of the stress.
    Stress(Component),
    /// A number that the three components determine.
    Invariant(Invariant),
}

impl PointValue {
    /// The largest smoothness.
    pub const SMOOTHEST: usize = 6;

    /// The smoothness where none is given: one that makes narrow intervals.
    pub fn smoothness(&self) -> usize {
        match self {
            PointValue::Displacement(_) => 4,
            PointValue::Stress(_) | PointValue::Invariant(_) => 2,
        }
    }
}

/// A number that the components of a stress determine, whatever the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Invariant {
    /// Von Mises' equivalent stress, the stress across the plane included.
    VonMises,
    /// The larger principal stress in the plane.
    LargestPrincipal,
    /// The smaller principal stress in the plane.
    SmallestPrincipal,
}

impl Invariant {
    /// All of them.
    pub const ALL: [Invariant; 3] = [Invariant::VonMises, Invariant::LargestPrincipal, Invariant::SmallestPrincipal];

    /// The word of the format.
    pub fn word(self) -> &'static str {
        match self {
            Invariant::VonMises => "von-mises",
            Invariant::LargestPrincipal => "largest-principal",
            Invariant::SmallestPrincipal => "smallest-principal",
        }
    }
}

/// Where a mean displacement is taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Extent {
    /// A boundary by its name, with or without a condition.
    Boundary(String),
    /// Index into [`Draft::bodies`](super::Draft::bodies).
    Body(usize),
}

/// A contact or support, which exerts forces on bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holder {
    /// Index into [`Draft::contacts`](super::Draft::contacts).
    Contact(usize),
    /// Index into [`Draft::supports`](super::Draft::supports).
    Support(usize),
}

/// Part of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// All of it.
    Whole,
    /// The inside of a simple polygon, counter-clockwise, its corners counted from [`Draft::origin`](super::Draft::origin); a box has four.
    Polygon(Vec<[f64; 2]>),
}

/// Factors of (σ_xx, σ_yy, σ_xy): [1, 0, 0], [0, 1, 0], [0, 0, 1], and [d0², d1², 2 d0 d1] for the normal stress d·σd
/// along a unit vector d; of a body of revolution those of (σ_rr, σ_zz, σ_rz), with one of the hoop stress behind them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component([f64; 4]);

impl Component {
    /// σ_xx.
    pub const XX: Component = Component([1.0, 0.0, 0.0, 0.0]);
    /// σ_yy.
    pub const YY: Component = Component([0.0, 1.0, 0.0, 0.0]);
    /// σ_xy.
    pub const XY: Component = Component([0.0, 0.0, 1.0, 0.0]);
    /// The hoop stress of a body of revolution.
    pub const HOOP: Component = Component([0.0, 0.0, 0.0, 1.0]);

    /// The three factors in the plane.
    pub fn factors(self) -> [f64; 3] {
        let [xx, yy, xy, _] = self.0;
        [xx, yy, xy]
    }

    /// That of the hoop stress.
    pub fn hoop(self) -> f64 {
        self.0[3]
    }

    /// d·σd.
    pub fn along([x, y]: [f64; 2]) -> Self {
        Component([x * x, y * y, 2.0 * x * y, 0.0])
    }

    /// The words for the components of a scene with the kinematics given.
    pub fn words(kinematics: Kinematics) -> &'static [(&'static str, Component)] {
        const PLANE: &[(&str, Component)] = &[("xx", Component::XX), ("yy", Component::YY), ("xy", Component::XY)];
        const REVOLVED: &[(&str, Component)] =
            &[("rr", Component::XX), ("zz", Component::YY), ("rz", Component::XY), ("tt", Component::HOOP)];
        match kinematics {
            Kinematics::Axisymmetric => REVOLVED,
            Kinematics::PlaneStrain | Kinematics::PlaneStress => PLANE,
        }
    }
}

impl Quantity {
    /// Counts coordinates from `origin`.
    pub(super) fn shift(&mut self, origin: [f64; 2]) {
        let points = match &mut self.target {
            Target::Moment { about: at, .. } | Target::Point { at, .. } | Target::StressIntensity { tip: at, .. } => {
                std::slice::from_mut(at)
            }
            Target::Stress { region: Region::Polygon(points), .. } => points.as_mut_slice(),
            _ => return,
        };
        points.iter_mut().for_each(|p| *p = [p[0] - origin[0], p[1] - origin[1]]);
    }
}

impl Scene {
    /// The arc lengths of the first side of `contacts[contact]` that have to be vertices: those of its gap
    /// ([`super::Gap::breaks`]), those of its friction, then those at which the windows of quantities bend.
    pub fn contact_breaks(&self, contact: usize) -> Vec<f64> {
        let mut breaks = self.contacts.get(contact).map_or_else(Vec::new, |contact| contact.gap.breaks());
        breaks.extend(self.friction_breaks(contact));
        breaks.extend(self.window_breaks(contact));
        breaks
    }

    /// The arc lengths at which the friction bound of `contacts[contact]` bends.
    pub(crate) fn friction_breaks(&self, contact: usize) -> Vec<f64> {
        let bound = self.contacts.get(contact).and_then(|contact| contact.friction.as_ref());
        bound.map_or_else(Vec::new, super::FrictionBound::breaks)
    }

    /// The arc lengths at which windows of quantities on `contacts[contact]` bend.
    pub(crate) fn window_breaks(&self, contact: usize) -> impl Iterator<Item = f64> + '_ {
        self.quantities.iter().flat_map(move |quantity| match quantity.target {
            Target::ContactForce { contact: on, window: Some(window), .. } if on == contact => window.to_vec(),
            _ => Vec::new(),
        })
    }
}
