//! Numbers of about 32 digits as unevaluated sums of two, for computing what rounding did to a result.

use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Debug, Clone, Copy, Default)]
pub struct Dd {
    pub high: f64,
    pub low: f64,
}

fn two_sum(a: f64, b: f64) -> Dd {
    let high = a + b;
    let part = high - a;
    Dd { high, low: (a - (high - part)) + (b - part) }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Self {
        Dd { high: x, low: 0.0 }
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, other: Dd) -> Dd {
        let high = two_sum(self.high, other.high);
        let low = two_sum(self.low, other.low);
        let sum = two_sum(high.high, high.low + low.high);
        two_sum(sum.high, sum.low + low.low)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd { high: -self.high, low: -self.low }
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, other: Dd) -> Dd {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, other: Dd) -> Dd {
        let product = self.high * other.high;
        let rest = self.high.mul_add(other.high, -product);
        two_sum(product, rest + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, other: Dd) -> Dd {
        let first = Dd::from(self.high / other.high);
        let rest = self - first * other;
        let second = Dd::from(rest.high / other.high);
        let rest = rest - second * other;
        first + second + Dd::from(rest.high / other.high)
    }
}

impl std::iter::Sum for Dd {
    fn sum<I: Iterator<Item = Dd>>(terms: I) -> Dd {
        terms.fold(Dd::default(), |a, b| a + b)
    }
}

#[test]
fn keeps_twice_the_digits() {
    let third = Dd::from(1.0) / Dd::from(3.0);
    let one = third + third + third;
    assert!((one - Dd::from(1.0)).high.abs() < 1e-31);
    let square = (Dd::from(1.0) + Dd::from(1e-20)) * (Dd::from(1.0) - Dd::from(1e-20));
    assert!((square - Dd::from(1.0) + Dd::from(1e-40)).high.abs() < 1e-31);
}
