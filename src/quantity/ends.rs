//! The two ends of an interval.

/// By how much `x` lies outside of an interval; zero inside, and no farther outside than `rounding`.
pub fn outside([lower, upper]: [f64; 2], rounding: f64, x: f64) -> f64 {
    let off = (lower - x).max(x - upper).max(0.0);
    if off <= rounding { 0.0 } else { off }
}

/// The rest of an interval for a value that is never below zero, or never above.
pub fn clipped([lower, upper]: [f64; 2], [no_less, no_more]: [bool; 2]) -> [f64; 2] {
    let lower = if no_less { lower.max(upper.min(0.0)) } else { lower };
    let upper = if no_more { upper.min(lower.max(0.0)) } else { upper };
    [lower, upper]
}
