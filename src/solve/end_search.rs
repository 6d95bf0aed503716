//! The search for an end of a contact.

use crate::base::Secants;
use crate::contact::ContactEnd;

/// On a line that is longer than the contact the last nodes carry nothing, and the others tell the
/// end: this part of what the line is too long farther out.
const OUT: f64 = 0.1;

/// What a line may be too long there, in [`ContactEnd::rise`]: the last nodes that carry something
/// are next to the end also on longer lines.
const LONG: f64 = 0.1;

/// Ends are tried in steps of this (C), far below their error: secants multiply rounding, and
/// mirror images of a contact are to have mirror images of its ends.
const STEP: f64 = 1.0 / 1048576.0;

/// The search for one end of a contact over lines that are tried.
pub(super) struct EndSearch {
    /// 1 at the end of larger y, else -1.
    outward: f64,
    secants: Secants,
    /// How far the last line may have been from the end that is sought (C).
    off: f64,
}

impl EndSearch {
    /// A search for the end in the direction `outward` along y.
    pub fn new(outward: f64) -> Self {
        Self { outward, secants: Secants::falling(), off: 0.0 }
    }

    /// The end to try after a line up to `tried`, on which the contact had this `end`.
    pub fn next(&mut self, tried: f64, end: ContactEnd) -> f64 {
        let [tried, at, beyond] = [tried, end.at, end.beyond].map(|y| self.outward * y);
        let next = if at < tried {
            let long = (tried - at).min(LONG * end.rise);
            self.secants.next_below(tried, at + OUT * long)
        } else {
            self.secants.next(tried, beyond)
        };
        let step = (next - tried).abs();
        // Lines that are all too short take cautious steps: the nodes tell a longer way.
        let told = if self.secants.width().is_finite() { 0.0 } else { beyond.abs() };
        self.off = step.max(told);
        self.outward * (next / STEP).round() * STEP
    }

    /// How far the last line that was tried may be from the contact's end (C).
    pub fn off(&self) -> f64 {
        self.off
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines that a search takes until one of them ends within `error` of where the contact
    /// does, if the nodes tell it as `told` does of a line up to there.
    fn lines(outward: f64, mut tried: f64, error: f64, told: impl Fn(f64) -> ContactEnd) -> usize {
        let mut search = EndSearch::new(outward);
        (1..20)
            .find(|_| {
                let next = search.next(outward * tried, {
                    let ContactEnd { at, beyond, rise } = told(tried);
                    ContactEnd { at: outward * at, beyond: outward * beyond, rise }
                });
                let found = (outward * next - tried).abs() <= error;
                tried = outward * next;
                found
            })
            .expect("an end")
    }

    /// Beside an end that nodes tell from a line that is too short the first step is half of what
    /// they tell, and its length is not what the line is short; between lines on both sides of the
    /// end it is.
    #[test]
    fn a_first_step_is_not_taken_for_the_error() {
        let told = |at: f64, beyond: f64| ContactEnd { at, beyond, rise: 4.5 };
        for outward in [1.0, -1.0] {
            let mut search = EndSearch::new(outward);
            let next = search.next(outward * 39.9366, told(outward * 39.9366, outward * 0.0359));
            assert!((outward * next - 39.9366).abs() < 0.02 && search.off() >= 0.0359);
            // From a line that is too long, and the next one that is too short.
            let mut search = EndSearch::new(outward);
            let next = search.next(outward * 40.0, told(outward * 39.98, 0.0));
            assert!((search.off() - 0.018).abs() < 1e-5);
            let after = search.next(next, told(next, outward * 4e-4));
            assert!((search.off() - (after - next).abs()).abs() < 1e-5);
        }
    }

    /// Nodes tell the end of a contact at 5 C within 0.002 C on lines that are longer. On shorter
    /// ones they tell an end beyond it, by some times what the line is too short, or at once by
    /// much.
    #[test]
    fn ends_are_found_from_lines_that_are_too_long_and_too_short() {
        let rise = 0.3;
        for (jump, times) in [(0.0, 0.5), (0.0, 4.0), (0.003, 0.0), (0.01, 1.0)] {
            let told = |tried: f64| match tried > 5.0 {
                true => {
                    ContactEnd { at: tried.min(4.998 + 0.1 * (tried - 5.0)), beyond: 0.0, rise }
                }
                false => {
                    ContactEnd { at: tried, beyond: jump + (1.0 + times) * (5.0 - tried), rise }
                }
            };
            for from in [4.7, 4.99, 4.9995, 5.001, 5.02, 5.5] {
                for outward in [1.0, -1.0] {
                    let taken = lines(outward, from, 1e-3, told);
                    assert!(taken <= 8, "{jump} {times} from {from}: {taken} lines");
                }
            }
        }
    }
}
