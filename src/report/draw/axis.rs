//! An axis: its limits, its ticks, and where a value lies.

use super::letters;
use super::picture::TEXT;
use crate::base::number::{fixed, significant, with_minus_signs};

/// Least distance of numbers beside each other (px).
const GAP: f64 = 6.0;

/// An axis in pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    pub low: f64,
    pub high: f64,
    pub log: bool,
    /// Where `low` and `high` lie.
    pub from: f64,
    pub to: f64,
}

/// A place of an axis that has a grid line, and a number there if it is one of the main ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    pub value: f64,
    pub text: Option<String>,
}

impl Axis {
    /// Where a value lies.
    pub fn at(&self, value: f64) -> f64 {
        let share = if self.log {
            (value.max(1e-300).ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (value - self.low) / (self.high - self.low)
        };
        self.from + share * (self.to - self.from)
    }

    /// Whether a value has a place on the axis, within its limits or beyond.
    pub fn takes(&self, value: f64) -> bool {
        value.is_finite() && (!self.log || value > 0.0)
    }

    /// Whether a value lies within the limits, but for rounding.
    pub fn shows(&self, value: f64) -> bool {
        let slack = 1e-9 * (self.high - self.low);
        self.takes(value) && value >= self.low - slack && value <= self.high + slack
    }

    /// Grid lines and numbers, ascending; numbers have at least `room` pixels each.
    pub fn ticks(&self, room: f64) -> Vec<Tick> {
        if self.log { self.log_ticks() } else { self.linear_ticks(room) }
    }

    /// Whether numbers along x touch each other.
    pub fn is_crowded(&self, ticks: &[Tick]) -> bool {
        let numbers = ticks.iter().filter_map(|t| Some((self.at(t.value), t.text.as_ref()?)));
        let spans: Vec<[f64; 2]> = numbers
            .map(|(at, text)| {
                [-0.5, 0.5].map(|side| at + side * (letters::width(text, TEXT) + GAP))
            })
            .collect();
        spans.windows(2).any(|pair| pair[0][1] > pair[1][0])
    }

    fn linear_ticks(&self, room: f64) -> Vec<Tick> {
        let parts = ((self.to - self.from).abs() / room).clamp(2.0, 6.0);
        let step = round_step((self.high - self.low) / parts);
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        let values = (first..=last).map(|i| i as f64 * step);
        values.map(|value| Tick { value, text: Some(number(value, step)) }).collect()
    }

    /// Decades, and their parts: with numbers at 2 and 5 too where there are few decades, without
    /// numbers where there are many.
    fn log_ticks(&self) -> Vec<Tick> {
        let (low, high) = (self.low.log10(), self.high.log10());
        let numbered = if high - low > 2.5 { &[1][..] } else { &[1, 2, 5] };
        let parts = if high - low > 6.0 { 1 } else { 9 };
        let decades = low.floor() as i32..=high.floor() as i32;
        let all = decades.flat_map(|d| (1..=parts).map(move |part| (d, part)));
        let tick = |(decade, part): (i32, i32)| {
            let value = f64::from(part) * 10f64.powi(decade);
            let text = || with_minus_signs(&significant(value, 2));
            Tick { value, text: numbered.contains(&part).then(text) }
        };
        all.map(tick)
            .filter(|t| t.value >= self.low * 0.999 && t.value <= self.high * 1.001)
            .collect()
    }
}

/// A round step of at least about `rough`: 1, 2 or 5 times a power of ten.
pub fn round_step(rough: f64) -> f64 {
    let decade = 10f64.powf(rough.log10().floor());
    let limits = [(1.5, 1.0), (3.5, 2.0), (7.5, 5.0)];
    let factor = limits.iter().find(|(limit, _)| rough / decade < *limit);
    decade * factor.map_or(10.0, |(_, factor)| *factor)
}

/// One of a row of numbers a step apart: as many digits after the point as the step has.
pub fn number(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".to_string();
    }
    let digits = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
    let text =
        if digits > 5 || value.abs() >= 1e5 { significant(value, 3) } else { fixed(value, digits) };
    with_minus_signs(&text)
}

/// The smallest and the largest of some values; 0 and 1 where none is finite.
pub fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let finite = values.filter(|v| v.is_finite());
    let (low, high) = finite.fold(ends, |(low, high), v| (low.min(v), high.max(v)));
    if low > high { (0.0, 1.0) } else { (low, high) }
}

/// Limits that show some values with a margin; a log axis takes positive values only.
pub fn limits(values: impl Iterator<Item = f64>, log: bool) -> (f64, f64) {
    if log {
        let (low, high) = extent(values.filter(|v| *v > 0.0));
        return if low > 0.0 { (low / 1.6, high * 1.6) } else { (1.0, 10.0) };
    }
    let (low, high) = extent(values);
    // Nothing but rounding is between them, the stress sums' single precision included: a flat line
    // in the middle.
    if high - low < (1e-9 * high.abs()).max(1e-7) {
        let half = 0.1 * high.abs().max(1e-3);
        return (low - half, high + half);
    }
    let margin = 0.06 * (high - low);
    // A quantity that has no negative values gets no negative axis.
    (if low == 0.0 { 0.0 } else { low - margin }, high + margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks(60.0).into_iter().filter_map(|t| t.text).collect()
    }

    #[test]
    fn ticks_are_round_and_spelt_out() {
        let axis = Axis { low: -0.11, high: 0.42, log: false, from: 0.0, to: 360.0 };
        assert_eq!(texts(&axis), ["−0.1", "0", "0.1", "0.2", "0.3", "0.4"]);
        let small = Axis { low: 0.0, high: 4e-6, log: false, from: 0.0, to: 240.0 };
        assert_eq!(texts(&small), ["0", "1e−6", "2e−6", "3e−6", "4e−6"]);
        let log = Axis { low: 2e-5, high: 3.0, log: true, from: 0.0, to: 300.0 };
        assert_eq!(texts(&log), ["0.0001", "0.001", "0.01", "0.1", "1"]);
        assert!(log.ticks(60.0).len() > 40, "decades have their parts");
        let short = Axis { low: 0.9, high: 11.0, ..log };
        assert_eq!(texts(&short), ["1", "2", "5", "10"]);
    }

    #[test]
    fn long_numbers_beside_each_other_are_crowded() {
        let axis = Axis { low: 0.0, high: 1.34e-3, log: false, from: 0.0, to: 234.0 };
        let [near, far] = [60.0, 120.0].map(|room| axis.is_crowded(&axis.ticks(room)));
        assert!(near && !far);
    }

    #[test]
    fn values_lie_where_the_axis_says() {
        let log = Axis { low: 1.0, high: 100.0, log: true, from: 200.0, to: 0.0 };
        assert!((log.at(10.0) - 100.0).abs() < 1e-9);
        assert!(!log.takes(0.0) && log.takes(1e9) && !log.shows(1e9));
    }

    #[test]
    fn rounding_is_drawn_as_a_flat_line() {
        let (low, high) = limits([-2e-8, 0.0, 1e-8].into_iter(), false);
        assert!(low < -1e-5 && high > 1e-5);
        let (low, high) = limits([-2e-6, 0.0, 1e-6].into_iter(), false);
        assert!(low > -3e-6 && high < 2e-6);
    }
}
