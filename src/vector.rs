//! Vectors of the plane, and long ones.

/// a · b.
pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// a × b: twice the area of the triangle that they span, positive where b lies to the left of a.
pub fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// a − b.
pub fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// |v|, without overflow on the way.
pub fn norm(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}

/// |a − b|.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    norm(minus(a, b))
}

/// Long vectors.
pub mod long {
    /// The largest absolute value; zero where there is none.
    pub fn largest(values: &[f64]) -> f64 {
        values.iter().fold(0.0, |m, v| m.max(v.abs()))
    }

    /// a · b.
    pub fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// Adds a x to y.
    pub fn axpy(y: &mut [f64], a: f64, x: &[f64]) {
        y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x);
    }
}
