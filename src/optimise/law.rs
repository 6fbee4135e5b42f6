//! The convex term of one unknown, as a function with kinks between smooth pieces.
//!
//! A law φ is what theory knows of an interface in one direction: with x the relative displacement, the force q = b − Ax of the
//! smooth rest must lie in ∂φ(x). On a piece φ' is affine; at a kink x stays where it is, and q anywhere between the slopes of
//! the pieces beside it. A contact state is the choice of a piece or a kink for each unknown.

/// φ of one unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// φ = 0.
    Free,
    /// φ = 0 for x ≤ `bound`, else ∞: contact with a gap. An infinite bound is none.
    AtMost {
        /// Largest value.
        bound: f64,
    },
    /// φ = 0 for `lower` ≤ x ≤ `upper`, else ∞.
    Between {
        /// Least value.
        lower: f64,
        /// Largest value.
        upper: f64,
    },
    /// φ = ½ `stiffness` x²: a spring bed.
    Spring {
        /// Stiffness, positive.
        stiffness: f64,
    },
    /// φ = ½ `stiffness` (x − `gap`)₊²: elastic contact.
    Elastic {
        /// Where resistance begins.
        gap: f64,
        /// Stiffness, positive.
        stiffness: f64,
    },
    /// φ = `threshold` |x − `centre`|: friction with a given bound.
    Friction {
        /// The largest force, not negative.
        threshold: f64,
        /// Where it holds.
        centre: f64,
    },
}

/// Where an unknown is on its law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum State {
    /// On the piece below all kinks.
    Below,
    /// At the first kink, or the only one.
    Held,
    /// Between two kinks.
    Between,
    /// At the second kink.
    HeldAbove,
    /// On the piece above all kinks.
    Above,
}

/// A smooth piece: φ' = `stiffness` x + `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// φ''.
    pub stiffness: f64,
    /// φ' at x = 0.
    pub offset: f64,
}

impl Law {
    /// The state to begin with where nothing is known: the one that resists most.
    pub fn stiffest(self) -> State {
        match self {
            Law::AtMost { bound } if bound.is_finite() => State::Held,
            Law::Free | Law::Spring { .. } | Law::AtMost { .. } => State::Below,
            Law::Between { upper, .. } if upper.is_finite() => State::HeldAbove,
            Law::Between { lower, .. } if lower.is_finite() => State::Held,
            Law::Between { .. } => State::Between,
            Law::Elastic { .. } => State::Above,
            Law::Friction { .. } => State::Held,
        }
    }

    /// The kink at which `state` holds the unknown; none where it moves.
    pub fn kink(self, state: State) -> Option<f64> {
        match (self, state) {
            (Law::AtMost { bound }, State::Held) => Some(bound),
            (Law::Between { lower, .. }, State::Held) => Some(lower),
            (Law::Between { upper, .. }, State::HeldAbove) => Some(upper),
            (Law::Friction { centre, .. }, State::Held) => Some(centre),
            _ => None,
        }
    }

    /// φ' on the piece of `state`.
    pub fn piece(self, state: State) -> Piece {
        match (self, state) {
            (Law::Spring { stiffness }, _) => Piece { stiffness, offset: 0.0 },
            (Law::Elastic { gap, stiffness }, State::Above) => Piece { stiffness, offset: -stiffness * gap },
            (Law::Friction { threshold, .. }, State::Above) => Piece { stiffness: 0.0, offset: threshold },
            (Law::Friction { threshold, .. }, State::Below) => Piece { stiffness: 0.0, offset: -threshold },
            _ => Piece { stiffness: 0.0, offset: 0.0 },
        }
    }

    /// The state that value `x` and force `q` ask for from `state` (the primal–dual step): forces within `slack` and values
    /// within `depth` of what a state allows are rounding, and keep it.
    pub fn next(self, state: State, x: f64, q: f64, slack: f64, depth: f64) -> State {
        use State::{Above, Below, Between, Held, HeldAbove};
        match (self, state) {
            (Law::AtMost { .. }, Held) if q < -slack => Below,
            (Law::AtMost { bound }, Below) if x > bound + depth => Held,
            (Law::Between { .. }, Held) if q > slack => Between,
            (Law::Between { .. }, HeldAbove) if q < -slack => Between,
            (Law::Between { lower, .. }, Between) if x < lower - depth => Held,
            (Law::Between { upper, .. }, Between) if x > upper + depth => HeldAbove,
            (Law::Elastic { gap, .. }, Below) if x > gap + depth => Above,
            (Law::Elastic { gap, .. }, Above) if x < gap - depth => Below,
            (Law::Friction { threshold, .. }, Held) if q > threshold + slack => Above,
            (Law::Friction { threshold, .. }, Held) if q < -threshold - slack => Below,
            (Law::Friction { centre, .. }, Above) if x < centre - depth => Held,
            (Law::Friction { centre, .. }, Below) if x > centre + depth => Held,
            _ => state,
        }
    }

    /// The law of s = x / `unit`, when forces on s are `unit` times those on x.
    pub fn in_unit(self, unit: f64) -> Self {
        match self {
            Law::Free => Law::Free,
            Law::AtMost { bound } => Law::AtMost { bound: bound / unit },
            Law::Between { lower, upper } => Law::Between { lower: lower / unit, upper: upper / unit },
            Law::Spring { stiffness } => Law::Spring { stiffness: stiffness * unit * unit },
            Law::Elastic { gap, stiffness } => Law::Elastic { gap: gap / unit, stiffness: stiffness * unit * unit },
            Law::Friction { threshold, centre } => Law::Friction { threshold: threshold * unit, centre: centre / unit },
        }
    }

    /// The sizes of the finite data that values are compared with.
    pub fn extent(self) -> f64 {
        let finite = |v: f64| if v.is_finite() { v.abs() } else { 0.0 };
        match self {
            Law::AtMost { bound } => finite(bound),
            Law::Between { lower, upper } => finite(lower).max(finite(upper)),
            Law::Elastic { gap, .. } => finite(gap),
            Law::Friction { centre, .. } => finite(centre),
            Law::Free | Law::Spring { .. } => 0.0,
        }
    }

    /// φ(x), infinite beyond a bound.
    pub fn value(self, x: f64) -> f64 {
        let unless = |beyond: bool| if beyond { f64::INFINITY } else { 0.0 };
        match self {
            Law::Free => 0.0,
            Law::AtMost { bound } => unless(x > bound),
            Law::Between { lower, upper } => unless(x > upper || x < lower),
            Law::Spring { stiffness } => 0.5 * stiffness * x * x,
            Law::Elastic { gap, stiffness } => 0.5 * stiffness * (x - gap).max(0.0).powi(2),
            Law::Friction { threshold, centre } => threshold * (x - centre).abs(),
        }
    }

    /// φ*(q), infinite where no x has the force q.
    pub fn conjugate(self, q: f64) -> f64 {
        // 0 · ∞ is zero here: a bound that is none costs nothing where nothing presses.
        let times = |q: f64, bound: f64| if q == 0.0 { 0.0 } else { q * bound };
        let unless = |beyond: bool, value: f64| if beyond { f64::INFINITY } else { value };
        match self {
            Law::Free => unless(q != 0.0, 0.0),
            Law::AtMost { bound } => unless(q < 0.0, times(q.max(0.0), bound)),
            Law::Between { lower, upper } => times(q, if q > 0.0 { upper } else { lower }),
            Law::Spring { stiffness } => 0.5 * q * q / stiffness,
            Law::Elastic { gap, stiffness } => unless(q < 0.0, 0.5 * q * q / stiffness + times(q.max(0.0), gap)),
            Law::Friction { threshold, centre } => unless(q.abs() > threshold, q * centre),
        }
    }
}
