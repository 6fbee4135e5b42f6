//! Compensated summation.

/// A running sum that keeps what rounding would drop (Neumaier's variant of Kahan's method), with a bound on the error
/// that remains.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sum {
    sum: f64,
    carry: f64,
    magnitude: f64,
}

impl Sum {
    /// Adds one term.
    pub fn add(&mut self, term: f64) {
        let next = self.sum + term;
        self.carry += if self.sum.abs() >= term.abs() { (self.sum - next) + term } else { (term - next) + self.sum };
        self.sum = next;
        self.magnitude += term.abs();
    }

    /// The sum.
    pub fn value(&self) -> f64 {
        self.sum + self.carry
    }

    /// Σ |terms|: what rounding errors of the terms themselves are relative to.
    pub fn magnitude(&self) -> f64 {
        self.magnitude
    }
}

impl Extend<f64> for Sum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, terms: I) {
        terms.into_iter().for_each(|t| self.add(t));
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Sum::default();
        sum.extend(terms);
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn keeps_what_plain_addition_drops() {
        let terms = [1.0, 1e100, 1.0, -1e100];
        assert_eq!(terms.iter().sum::<f64>(), 0.0);
        assert_eq!(terms.into_iter().collect::<Sum>().value(), 2.0);
    }
}
