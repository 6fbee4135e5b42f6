//! Amounts of memory as people write and read them.

/// Units in decimal thousands, the largest first.
const UNITS: [(&str, f64); 4] = [("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)];

/// `text` in bytes: a number, alone or with k, M, G or T (thousands) or Ki, Mi, Gi or Ti (1024), and a B if liked.
///
/// # Errors
/// Parses a size such as `4G`; the error has the finding and the remedy.
pub fn parse(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let unit = unit.trim_start();
    let unit = unit.strip_suffix(['B', 'b']).unwrap_or(unit);
    let factor = match unit {
        "" => 1.0,
        "k" | "K" => 1e3,
        "m" | "M" => 1e6,
        "g" | "G" => 1e9,
        "t" | "T" => 1e12,
        "Ki" | "ki" => 1024.0,
        "Mi" | "mi" => 1024.0 * 1024.0,
        "Gi" | "gi" => 1024.0 * 1024.0 * 1024.0,
        "Ti" | "ti" => 1024.0 * 1024.0 * 1024.0 * 1024.0,
        _ => {
            return Err(format!("\"{text}\" is no amount of memory; write for instance 500M, 2G or a number of bytes"));
        }
    };
    match number.parse::<f64>() {
        Ok(number) if number * factor >= 1.0 => Ok((number * factor) as u64),
        Ok(_) => Err(format!("\"{text}\" is less than a byte")),
        Err(_) => Err(format!("\"{text}\" is no amount of memory; write for instance 500M, 2G or a number of bytes")),
    }
}

/// `bytes` to two digits, three from a hundred on.
pub fn words(bytes: f64) -> String {
    if bytes.is_infinite() {
        return "any amount".to_string();
    }
    if bytes >= 1e15 {
        return format!("{:.1e} GB", bytes / 1e9);
    }
    match UNITS.iter().find(|(_, size)| bytes >= 0.9995 * size) {
        Some((unit, size)) if bytes < 9.95 * size => {
            let text = format!("{:.1}", bytes / size);
            format!("{} {unit}", text.strip_suffix(".0").unwrap_or(&text))
        }
        Some((unit, size)) => format!("{:.0} {unit}", bytes / size),
        None => format!("{bytes:.0} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_are_read_as_they_are_written() {
        for (text, bytes) in [
            ("12345", 12_345),
            ("500M", 500_000_000),
            ("2G", 2_000_000_000),
            ("1.5 GB", 1_500_000_000),
            ("2GiB", 2 << 30),
            ("64k", 64_000),
            ("1Ti", 1 << 40),
        ] {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
        for text in ["", "M", "-1G", "two", "1X", "1e9", "0", "0.1", "1.2.3", "nan", "inf", "5GG"] {
            assert!(parse(text).is_err(), "{text}: {:?}", parse(text));
        }
        assert_eq!(parse("99999999999999999999T"), Ok(u64::MAX), "more than there is means no limit");
    }

    #[test]
    fn amounts_are_written_with_two_or_three_digits() {
        for (bytes, text) in [
            (12.0, "12 bytes"),
            (1500.0, "1.5 kB"),
            (999_900.0, "1 MB"),
            (34e9, "34 GB"),
            (123.4e9, "123 GB"),
            (2e13, "20 TB"),
            (3.2e21, "3.2e12 GB"),
            (f64::INFINITY, "any amount"),
        ] {
            assert_eq!(words(bytes), text, "{bytes}");
        }
    }
}
