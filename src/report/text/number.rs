//! Numbers and user text as a reader sees them, the same in every output for people.

/// `x` with `digits` significant digits: plain where that is short, with a power of ten elsewhere; an en dash for a
/// number that is none.
pub(crate) fn significant(x: f64, digits: usize) -> String {
    let digits = digits.clamp(1, 17);
    if !x.is_finite() {
        return "–".to_string();
    }
    if x == 0.0 {
        return "0".to_string();
    }
    // Rounding first: 9.9996 with four digits is 10.00, whose exponent is one larger.
    let scientific = format!("{x:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let text = if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim_zeros(&format!("{x:.decimals$}"))
    } else {
        format!("{}×10{}", trim_zeros(mantissa), superscript(exponent))
    };
    text.replace('-', "−")
}

/// The end of an interval with `digits` significant digits, rounded away from the interval: what is written encloses
/// what is known.
pub(crate) fn outward(x: f64, digits: usize, upwards: bool) -> String {
    let digits = digits.clamp(1, 17);
    if !x.is_finite() || x == 0.0 {
        return significant(x, digits);
    }
    let nearest = format!("{x:.*e}", digits - 1);
    let exponent = nearest.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    let nearest: f64 = nearest.parse().unwrap_or(x);
    let step = 10f64.powi(exponent + 1 - digits as i32);
    let outer = match upwards {
        true if nearest < x => nearest + step,
        false if nearest > x => nearest - step,
        _ => nearest,
    };
    // A step down from a power of ten has one digit more.
    if outer.abs() < 10f64.powi(exponent) { significant(outer, digits + 1) } else { significant(outer, digits) }
}

/// The ends of an interval with `digits` significant digits, both [`outward`].
pub(crate) fn enclosing([lower, upper]: [f64; 2], digits: usize) -> [String; 2] {
    [outward(lower, digits, false), outward(upper, digits, true)]
}

/// A number that may be missing.
pub(crate) fn optional(x: Option<f64>, digits: usize) -> String {
    x.map_or_else(|| "–".to_string(), |x| significant(x, digits))
}

/// A ratio in per cent, with three significant digits.
pub(crate) fn percent(x: f64) -> String {
    if x.is_finite() { format!("{} %", significant(100.0 * x, 3)) } else { "–".to_string() }
}

/// As [`percent`], for what a ratio is at most: rounded up.
pub(crate) fn at_most_percent(x: f64) -> String {
    if x.is_finite() { format!("{} %", outward(100.0 * x, 3, true)) } else { "–".to_string() }
}

/// A vector in parentheses.
pub(crate) fn vector(v: [f64; 2], digits: usize) -> String {
    format!("({}, {})", significant(v[0], digits), significant(v[1], digits))
}

/// As many digits as are needed to tell `a` from `b`, and two more.
pub(crate) fn digits_to_tell(a: f64, b: f64) -> usize {
    let ratio = a.abs().max(b.abs()) / (a - b).abs();
    if ratio.is_finite() && ratio > 1.0 { (ratio.log10().ceil() as usize + 2).clamp(5, 15) } else { 6 }
}

/// Digits in groups of three.
pub(crate) fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Seconds, short.
pub(crate) fn seconds(s: f64) -> String {
    if s.is_finite() && s < 0.001 && s > 0.0 { "< 1 ms".to_string() } else { format!("{} s", significant(s, 3)) }
}

/// User text without the control characters that neither XML nor a terminal should meet, nor those that turn the direction
/// of what follows: each is shown as `\u{fffd}`.
pub(crate) fn clean(text: &str) -> String {
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let hidden = |c: char| c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{fffe}' | '\u{ffff}') || turns(c);
    text.chars().map(|c| if hidden(c) { '\u{fffd}' } else { c }).collect()
}

/// A power as superscript digits.
pub(crate) fn superscript(n: i32) -> String {
    n.to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect()
}

fn trim_zeros(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(significant(-1.796419, 5), "−1.7964");
        assert_eq!(significant(9.9996, 4), "10");
        assert_eq!((percent(0.201006), at_most_percent(0.201006)), ("20.1 %".to_string(), "20.2 %".to_string()));
        assert_eq!(enclosing([-1.403816, -1.400852], 5), ["−1.4039", "−1.4008"]);
        assert_eq!(significant(1.0e-9, 3), "1×10⁻⁹");
        assert_eq!(significant(2.1e11, 3), "2.1×10¹¹");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(significant(0.00012, 3), "0.00012");
        assert_eq!(percent(0.0523), "5.23 %");
        assert_eq!(percent(f64::INFINITY), "–");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(grouped(123), "123");
    }

    #[test]
    fn digits_tell_two_numbers_apart() {
        let (a, b) = (-1.7964189504, -1.7964083583);
        let n = digits_to_tell(a, b);
        assert_ne!(significant(a, n), significant(b, n));
        assert!(n < 10);
        assert_eq!(digits_to_tell(1.0, 1.0), 6);
        assert_eq!(digits_to_tell(f64::NAN, 1.0), 6);
    }

    #[test]
    fn what_is_written_of_an_interval_encloses_it() {
        let read = |text: &str| text.replace('−', "-").parse::<f64>().unwrap();
        for x in [0.785_796_1, 0.808_001_6, -1.0e-4, 9.999_96, 0.999_999_99, -0.584_34, 1.0, 123_456.7, 1.0 / 3.0] {
            for x in [x, -x] {
                for digits in [3, 5, 9] {
                    let [low, high] = [false, true].map(|upwards| read(&outward(x, digits, upwards)));
                    assert!(low <= x && x <= high, "{low} {x} {high}");
                    assert!(high - low <= 2.0 * x.abs() * 10f64.powi(1 - digits as i32), "{low} {x} {high}");
                }
            }
        }
        assert_eq!((outward(0.80801, 4, true).as_str(), outward(-0.5, 6, false).as_str()), ("0.8081", "−0.5"));
        assert_eq!((outward(0.0, 6, true).as_str(), outward(f64::INFINITY, 6, true).as_str()), ("0", "–"));
    }

    #[test]
    fn control_characters_are_replaced() {
        assert_eq!(clean("a\u{1}b\nc\u{202e}d"), "a\u{fffd}b\nc\u{fffd}d");
    }
}
