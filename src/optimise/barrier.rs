//! The barrier of one unknown: room and force of each kink, which an interior point keeps positive.
//!
//! A bound x ≤ g has the room y = g − x and the force z with z y = 0; elastic contact is a bound that gives way by z / k. Friction
//! τ|x − c| is τu with |x − c| ≤ u, whose two forces add up to τ.

use super::law::{Law, State};

/// The part of the way to where a room or a force would vanish that a step goes.
const SHORT: f64 = 0.995;

/// One barrier.
#[derive(Debug, Clone, Copy)]
pub enum Barrier {
    /// `sign` · x ≤ bound + force · give.
    Face { sign: f64, bound: f64, give: f64, room: f64, force: f64, step: [f64; 2] },
    /// |x − c| ≤ u, with the rooms u ∓ (x − c) and the forces at them.
    Ridge { room: [f64; 2], force: [f64; 2], step: [f64; 4] },
}

/// The barriers of a law at x = 0, in the middle of what is possible; `size` is that of forces and values.
pub fn barriers(law: Law) -> impl Iterator<Item = Barrier> {
    let face = |sign: f64, bound: f64, give: f64| {
        (bound < f64::INFINITY).then(|| Barrier::Face {
            sign,
            bound,
            give,
            room: bound.max(1.0),
            force: 1.0,
            step: [0.0; 2],
        })
    };
    match law {
        Law::Free | Law::Spring { .. } => [None, None],
        Law::AtMost { bound } => [face(1.0, bound, 0.0), None],
        Law::Between { lower, upper } => [face(1.0, upper, 0.0), face(-1.0, -lower, 0.0)],
        Law::Elastic { gap, stiffness } => [face(1.0, gap, 1.0 / stiffness), None],
        // Without any threshold there is nothing to hold against.
        Law::Friction { threshold, centre } if threshold > 0.0 => {
            let (force, far) = ([0.5 * threshold; 2], 1.0 + centre.abs());
            [Some(Barrier::Ridge { room: [far + centre, far - centre], force, step: [0.0; 4] }), None]
        }
        Law::Friction { .. } => [None, None],
    }
    .into_iter()
    .flatten()
}

impl Barrier {
    /// Σ room · force, and the number of its terms.
    pub fn product(&self) -> (f64, f64) {
        match self {
            Barrier::Face { room, force, .. } => (room * force, 1.0),
            Barrier::Ridge { room: [a, b], force: [p, q], .. } => (a * p + b * q, 2.0),
        }
    }

    /// The force on the unknown.
    pub fn force(&self) -> f64 {
        match self {
            Barrier::Face { sign, force, .. } => sign * force,
            Barrier::Ridge { force: [p, q], .. } => p - q,
        }
    }

    /// How far the room of a face is from what x leaves of it.
    pub fn misfit(&self, x: f64) -> f64 {
        match self {
            Barrier::Face { sign, bound, give, room, force, .. } => sign * x + room - bound - give * force,
            Barrier::Ridge { .. } => 0.0,
        }
    }

    /// Its term on the diagonal of A.
    pub fn stiffness(&self) -> f64 {
        match self {
            Barrier::Face { room, force, give, .. } => force / (room + give * force),
            Barrier::Ridge { room: [a, b], force: [p, q], .. } => 4.0 * p * q / (p * b + q * a),
        }
    }

    /// Its force after a Newton step with dx = 0 towards room · force = `target`, less the products of the `last` step.
    pub fn offset(&self, x: f64, target: f64, second_order: bool) -> f64 {
        match self {
            Barrier::Face { sign, .. } => sign * self.base(x, target, second_order),
            Barrier::Ridge { force: [p, q], .. } => p - q + 2.0 * self.base(x, target, second_order),
        }
    }

    /// Of a face, its force; of a ridge, the change of its first force; after a Newton step with dx = 0.
    fn base(&self, x: f64, target: f64, second_order: bool) -> f64 {
        let weight = if second_order { 1.0 } else { 0.0 };
        match self {
            Barrier::Face { room, force, give, step: [dy, dz], .. } => {
                // force dy + room dz = target − room force − dy dz, and dy = give dz − misfit − sign dx.
                let r = target - room * force - weight * dy * dz;
                force + (r + force * self.misfit(x)) / (room + give * force)
            }
            Barrier::Ridge { room: [a, b], force: [p, q], step: [da, db, dp, dq] } => {
                let r1 = target - a * p - weight * da * dp;
                let r2 = target - b * q - weight * db * dq;
                (q * r1 - p * r2) / (p * b + q * a)
            }
        }
    }

    /// Sets its part of the step for the step `dx` of the unknown.
    pub fn direct(&mut self, x: f64, dx: f64, target: f64, second_order: bool) {
        let base = self.base(x, target, second_order);
        let stiffness = self.stiffness();
        let misfit = self.misfit(x);
        let weight = if second_order { 1.0 } else { 0.0 };
        match self {
            Barrier::Face { sign, force, give, step, .. } => {
                let dz = base - *force + stiffness * *sign * dx;
                *step = [*give * dz - misfit - *sign * dx, dz];
            }
            Barrier::Ridge { room: [a, b], force: [p, q], step } => {
                let dp = base + 0.5 * stiffness * dx;
                let [da, db, last, other] = *step;
                // The larger force tells du with the fewer digits lost.
                let du = if p > q {
                    dx + (target - *a * *p - weight * da * last - *a * dp) / *p
                } else {
                    -dx + (target - *b * *q - weight * db * other + *b * dp) / *q
                };
                *step = [du - dx, du + dx, dp, -dp];
            }
        }
    }

    /// The largest part of the step that keeps rooms, and of that which keeps forces positive, at most one.
    pub fn reach(&self) -> f64 {
        let part = |v: f64, d: f64| if d < 0.0 { SHORT * (-v / d) } else { f64::INFINITY };
        let all = match self {
            Barrier::Face { room, force, step: [dy, dz], .. } => part(*room, *dy).min(part(*force, *dz)),
            Barrier::Ridge { room, force, step } => {
                let rooms = part(room[0], step[0]).min(part(room[1], step[1]));
                rooms.min(part(force[0], step[2])).min(part(force[1], step[3]))
            }
        };
        all.min(1.0)
    }

    /// Σ room · force after `part` of the step.
    pub fn product_after(&self, part: f64) -> f64 {
        let mut after = *self;
        after.advance(part);
        after.product().0
    }

    /// Goes `part` of the step.
    pub fn advance(&mut self, part: f64) {
        match self {
            Barrier::Face { room, force, step: [dy, dz], .. } => {
                *room += part * *dy;
                *force += part * *dz;
            }
            Barrier::Ridge { room, force, step } => {
                (0..2).for_each(|i| room[i] += part * step[i]);
                (0..2).for_each(|i| force[i] += part * step[2 + i]);
            }
        }
    }

    /// The state in which the larger of room and force does not vanish.
    pub fn state(&self, law: Law) -> State {
        match (self, law) {
            (Barrier::Face { room, force, .. }, Law::Between { .. }) if room >= force => State::Between,
            (Barrier::Face { sign, .. }, Law::Between { .. }) if *sign > 0.0 => State::HeldAbove,
            (Barrier::Face { room, force, .. }, _) if room >= force => State::Below,
            (Barrier::Face { .. }, Law::Elastic { .. }) => State::Above,
            (Barrier::Face { .. }, _) => State::Held,
            (Barrier::Ridge { room: [a, b], force: [p, q], .. }, _) => {
                // u − (x − c) has no room where x − c is positive, and the force there is all of the threshold.
                if b > q {
                    State::Above
                } else if a > p {
                    State::Below
                } else {
                    State::Held
                }
            }
        }
    }
}
