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
}

impl EndSearch {
    /// A search for the end in the direction `outward` along y.
    pub fn new(outward: f64) -> Self {
        Self { outward, secants: Secants::falling() }
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
        self.outward * (next / STEP).round() * STEP
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
