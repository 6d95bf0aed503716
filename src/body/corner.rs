//! The exponent of the pressure at the contact's end.
//!
//! Next to the end the contact is plane, in y and z. A pressure s^-m on s > 0, s the distance from
//! the end, gives a half-plane's surface the slope u' = (2 / E') cot(pi m) s^-m, and a body that
//! ends at s = 0 a slope of the opposite sign. The exponent of the pressure is the m at which the
//! slopes of both bodies cancel (Dundurs and Lee, Journal of Elasticity 2, 1972): 1/2 between two
//! half-planes, 0.226 between a quarter-plane and a half-plane of the same material. Flush ends
//! have no such m > 0: the pressure is finite and approaches its limit like s ln(1/s).

use super::end::End;

/// The exponent m > 0 of the pressure s^-m at the contact's end; none if it is not singular. Each
/// of `bodies` has its share of the contact compliance and its end, [`End::ENDLESS`] if it
/// continues.
pub fn corner_exponent(bodies: &[(f64, End)]) -> Option<f64> {
    let sum = |m: f64| -> f64 { bodies.iter().map(|(share, end)| share * end.slope(m)).sum() };
    // The sum falls from + infinity at 0 if a body continues beyond the end; otherwise it is
    // negative.
    let (mut low, mut high) = (1e-6, 0.5);
    if sum(low) <= 0.0 {
        return None;
    }
    if sum(high) > -1e-12 {
        return Some(high);
    }
    for _ in 0..60 {
        let mid = 0.5 * (low + high);
        if sum(mid) > 0.0 { low = mid } else { high = mid }
    }
    Some(0.5 * (low + high))
}
