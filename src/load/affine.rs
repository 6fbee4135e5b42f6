//! Vector fields that are affine in x.

/// A vector field: value + gradient · x (gradient\[i\]\[j\] = ∂_j of component i).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Affine {
    /// Its value at the origin.
    pub value: [f64; 2],
    /// Its gradient.
    pub gradient: [[f64; 2]; 2],
}

impl Affine {
    /// A uniform field.
    pub fn constant(value: [f64; 2]) -> Self {
        Affine { value, gradient: [[0.0; 2]; 2] }
    }

    /// True if it is uniform.
    pub fn is_constant(&self) -> bool {
        self.gradient == [[0.0; 2]; 2]
    }

    /// Its value at `point`.
    pub fn at(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.value[i] + self.gradient[i][0] * point[0] + self.gradient[i][1] * point[1])
    }

    /// The difference from `other`.
    pub fn less(&self, other: &Self) -> Self {
        let less = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
        Affine {
            value: less(self.value, other.value),
            gradient: [0, 1].map(|i| less(self.gradient[i], other.gradient[i])),
        }
    }

    /// Every value times a factor.
    pub fn times(&self, factor: f64) -> Self {
        let scaled = |v: [f64; 2]| v.map(|x| factor * x);
        Affine { value: scaled(self.value), gradient: self.gradient.map(scaled) }
    }

    /// The value at (0, 0) of the coordinates that `origin` counts in, everywhere, and what the gradient adds to it from there.
    pub(crate) fn parts(&self, origin: [f64; 2]) -> [Self; 2] {
        let mut written = *self;
        written.shift(origin.map(|x| -x));
        let rest = [0, 1].map(|i| self.value[i] - written.value[i]);
        [Affine::constant(written.value), Affine { value: rest, gradient: self.gradient }]
    }

    /// The same value at (0, 0) of the coordinates that `origin` counts in, with rows and columns of the gradient exchanged.
    pub(crate) fn transposed(&self, origin: [f64; 2]) -> Self {
        let [Affine { value, .. }, _] = self.parts(origin);
        let [[xx, xy], [yx, yy]] = self.gradient;
        let mut turned = Affine { value, gradient: [[xx, yx], [xy, yy]] };
        turned.shift(origin);
        turned
    }

    /// Changes to coordinates that count from `middle`; the field stays the same.
    pub(crate) fn shift(&mut self, middle: [f64; 2]) {
        self.value = [0, 1].map(|i| value_at(self.value[i], self.gradient[i], middle));
    }
}

/// value + gradient · point, as if the sum were rounded once: its terms may cancel.
fn value_at(value: f64, gradient: [f64; 2], point: [f64; 2]) -> f64 {
    let products = [gradient[0] * point[0], gradient[1] * point[1]];
    let lost = [0, 1].map(|k| gradient[k].mul_add(point[k], -products[k]));
    let (mut sum, mut rest) = (value, 0.0);
    for term in products {
        let next = sum + term;
        let part = next - sum;
        rest += (sum - (next - part)) + (term - part);
        sum = next;
    }
    sum + (rest + (lost[0] + lost[1]))
}
