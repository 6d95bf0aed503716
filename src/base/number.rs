//! Numbers as text for people, one format for each purpose.
//!
//! Files that programs read are written elsewhere: a CSV cell by `report::table::number`. The
//! library alone has those that messages need.

/// At most `digits` significant digits, without trailing zeros; with an exponent below 1e-4 and
/// from 1e6, where plain digits are hard to count.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value.abs());
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    // The exponent after rounding: 9.99996 has four digits before the point less than 10.
    let magnitude: i32 = exponent.parse().unwrap_or(0);
    if !(-4..6).contains(&magnitude) {
        return format!("{}e{exponent}", without_trailing_zeros(mantissa));
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    without_trailing_zeros(&format!("{value:.decimals$}")).to_string()
}

/// A number in a message: all digits that people give, and none that rounding leaves.
pub fn stated(value: f64) -> String {
    significant(value, 10)
}

/// As [`significant`], with a sign whichever it is: a change.
#[cfg(feature = "cli")]
pub fn signed(value: f64, digits: usize) -> String {
    let sign = if value < 0.0 { "" } else { "+" };
    format!("{sign}{}", significant(value, digits))
}

/// A fixed number of digits after the point; a value that rounds to zero has no sign.
#[cfg(feature = "cli")]
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_string(),
        _ => text,
    }
}

/// A ratio or a count: one decimal below 10, otherwise two significant digits with thousands
/// separated.
#[cfg(feature = "cli")]
pub fn rounded(value: f64) -> String {
    if value < 9.95 {
        return without_trailing_zeros(&fixed(value, 1)).to_string();
    }
    to_place(value, value.log10().floor() as i32 - 1)
}

/// A ratio with its +-, both rounded at the second significant digit of the +-.
#[cfg(feature = "cli")]
pub fn ratio_with_spread(value: f64, spread: f64) -> String {
    if spread <= 0.0 {
        return format!("{} ± 0", rounded(value));
    }
    let place = (spread.log10().floor() as i32 - 1).max(-3);
    format!("{} ± {}", to_place(value, place), to_place(spread, place))
}

/// A number that is not negative, rounded to a multiple of 10^`place`, thousands separated.
#[cfg(feature = "cli")]
fn to_place(value: f64, place: i32) -> String {
    let text = if place > 0 {
        let scale = 10f64.powi(place);
        fixed((value / scale).round() * scale, 0)
    } else {
        fixed(value, place.unsigned_abs() as usize)
    };
    let (whole, decimals) = text.split_at(text.find('.').unwrap_or(text.len()));
    let groups: Vec<&str> =
        whole.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join(",") + decimals
}

/// Seconds in a suitable unit.
#[cfg(feature = "cli")]
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.0} µs", s * 1e6),
        s if s < 0.1 => format!("{:.1} ms", s * 1e3),
        s if s < 1.0 => format!("{:.0} ms", s * 1e3),
        s if s < 10.0 => format!("{s:.1} s"),
        s => format!("{s:.0} s"),
    }
}

/// Seconds with their +-, both in the unit of the value, to two digits of the +-.
#[cfg(feature = "cli")]
pub fn duration_with_spread(seconds: f64, spread: f64) -> String {
    let (unit, name) = match seconds {
        s if s < 1e-3 => (1e6, "µs"),
        s if s < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    let (value, spread) = (seconds * unit, spread * unit);
    let digits =
        if spread > 0.0 { (1.0 - spread.log10().floor()).clamp(0.0, 3.0) as usize } else { 1 };
    format!("{value:.digits$} ± {spread:.digits$} {name}")
}

/// A number's text with minus signs instead of hyphens.
#[cfg(feature = "cli")]
pub fn with_minus_signs(text: &str) -> String {
    text.replace('-', "−")
}

/// `1.50` as `1.5`, `2.0` as `2`; whole numbers as they are.
fn without_trailing_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_that_say_nothing_are_left_out() {
        let texts = [0.0, -0.0, 12.5, 123_456.7, -0.000_123_456, 99_999.96, 0.1 + 0.2]
            .map(|v| significant(v, 5));
        assert_eq!(texts, ["0", "0", "12.5", "123457", "-0.00012346", "100000", "0.3"]);
        let texts = [1e-5, 1.234e-5, -2.5e6, 999_999.9, 0.000_099_999_9].map(|v| significant(v, 3));
        assert_eq!(texts, ["1e-5", "1.23e-5", "-2.5e6", "1e6", "0.0001"]);
        let texts = [0.0, 1.0, 12.5e-3, 1.000_000_000_000_566_4e-7, 210e9].map(stated);
        assert_eq!(texts, ["0", "1", "0.0125", "1e-7", "2.1e11"]);
        assert_eq!([0.001_94, -0.139].map(|v| signed(v, 3)), ["+0.00194", "-0.139"]);
        assert_eq!([f64::NAN, f64::INFINITY].map(|v| significant(v, 3)), ["NaN", "inf"]);
    }

    #[test]
    fn what_rounds_to_zero_has_no_sign() {
        assert_eq!([-4e-5, -6e-5, 0.25].map(|v| fixed(v, 4)), ["0.0000", "-0.0001", "0.2500"]);
        assert_eq!(with_minus_signs(&fixed(-1.0, 1)), "−1.0");
    }

    #[test]
    fn times_and_ratios_read_well() {
        assert_eq!(
            [4.2e-5, 0.0123, 0.27, 3.21, 45.4].map(duration),
            ["42 µs", "12.3 ms", "270 ms", "3.2 s", "45 s"]
        );
        let pairs = [(7.7, 0.234), (0.163, 0.0588), (4.2e-5, 9e-7), (12.0, 0.0)];
        assert_eq!(
            pairs.map(|(seconds, spread)| duration_with_spread(seconds, spread)),
            ["7.70 ± 0.23 s", "163 ± 59 ms", "42.00 ± 0.90 µs", "12.0 ± 0.0 s"]
        );
        assert_eq!(
            [1_423_456.0, 14_234.0, 950.4, 99.6, 3.0, 0.24].map(rounded),
            ["1,400,000", "14,000", "950", "100", "3", "0.2"]
        );
        let pairs = [
            (1263.2, 12.9),
            (2799.6, 4.8),
            (14_234.0, 312.0),
            (3.214, 0.05),
            (950.4, 0.0),
            (8.0, 120.0),
        ];
        assert_eq!(
            pairs.map(|(ratio, spread)| ratio_with_spread(ratio, spread)),
            ["1,263 ± 13", "2,799.6 ± 4.8", "14,230 ± 310", "3.214 ± 0.050", "950 ± 0", "10 ± 120"]
        );
    }
}
