//! The colour map viridis: perceptually uniform, and in order of lightness, so that it survives a black-and-white print.

/// Eleven equally spaced colours of viridis (Smith and van der Walt, matplotlib, CC0).
const STOPS: [[u8; 3]; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];

/// Number of colours a map is drawn with.
pub(crate) const LEVELS: usize = 48;

/// Level of `fraction` in [0, 1].
pub(crate) fn level(fraction: f64) -> usize {
    // A cast from NaN gives zero.
    ((fraction * LEVELS as f64) as usize).min(LEVELS - 1)
}

/// The colour of a level as `#rrggbb`.
pub(crate) fn colour(level: usize) -> String {
    let x = (level as f64 + 0.5) / LEVELS as f64 * (STOPS.len() - 1) as f64;
    let below = (x as usize).min(STOPS.len() - 2);
    let w = x - below as f64;
    let mix = |c: usize| (f64::from(STOPS[below][c]) * (1.0 - w) + f64::from(STOPS[below + 1][c]) * w).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_rises_with_the_level() {
        let lightness = |l: usize| {
            let text = colour(l);
            let part = |i: usize| f64::from(u8::from_str_radix(&text[i..i + 2], 16).unwrap());
            0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
        };
        assert!((1..LEVELS).all(|l| lightness(l) > lightness(l - 1)));
        assert_eq!(
            (level(-1.0), level(0.0), level(1.0), level(2.0), level(f64::NAN)),
            (0, 0, LEVELS - 1, LEVELS - 1, 0)
        );
    }
}
