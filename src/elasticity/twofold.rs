//! Numbers of twice the precision of `f64`, for the few sums in which a nearly incompressible material cancels.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// An unevaluated sum `high + low` with |low| at most half a unit in the last place of `high`: about 106 bits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Twofold {
    high: f64,
    low: f64,
}

/// a + b and what rounding left of it.
fn two_sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    let part = high - a;
    Twofold { high, low: (a - (high - part)) + (b - part) }
}

impl Twofold {
    /// Zero.
    pub const ZERO: Self = Twofold { high: 0.0, low: 0.0 };

    /// The nearest `f64`.
    pub fn value(self) -> f64 {
        self.high
    }

    /// The square root of a positive number.
    pub fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        let left = self - Twofold::from(root) * Twofold::from(root);
        two_sum(root, left.high / (2.0 * root))
    }
}

impl From<f64> for Twofold {
    fn from(high: f64) -> Self {
        Twofold { high, low: 0.0 }
    }
}

impl Add for Twofold {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (sum, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let first = two_sum(sum.high, sum.low + low.high);
        two_sum(first.high, first.low + low.low)
    }
}

impl Neg for Twofold {
    type Output = Self;
    fn neg(self) -> Self {
        Twofold { high: -self.high, low: -self.low }
    }
}

impl Sub for Twofold {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twofold {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let left = self.high.mul_add(other.high, -high);
        two_sum(high, left + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Twofold {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let left = self - other * first.into();
        let second = left.high / other.high;
        let last = (left - other * second.into()).high / other.high;
        Twofold::from(first) + Twofold::from(second) + Twofold::from(last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_products_and_roots_have_twice_the_digits() {
        let third = Twofold::from(1.0) / Twofold::from(3.0);
        let left = third * Twofold::from(3.0) - Twofold::from(1.0);
        assert!(left.value().abs() < 1e-31);
        let root = Twofold::from(2.0).sqrt();
        assert!((root * root - Twofold::from(2.0)).value().abs() < 1e-30);
        let small = Twofold::from(1.0) + Twofold::from(1e-25) - Twofold::from(1.0);
        assert!((small.value() / 1e-25 - 1.0).abs() < 1e-6);
    }
}
