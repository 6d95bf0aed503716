//! Panels of the contact line: graded towards its ends and the kinks of the gap, and split where
//! the gap does more between their nodes than they can follow.

use super::axes::{LAW, Resolution};
use crate::base::{Corner, Growth, Kink, Panels, Parity};
use std::f64::consts::PI;

/// Largest size of the panels beside a kink of the gap, in those at a corner: the pressure is
/// smooth there but for s ln s times the jump of the gap's second derivative. The size times that
/// jump is at most `SHARP` of those at a corner.
const KINK: f64 = 40.0;
const SHARP: f64 = 10.0;

/// The narrowest panel between two features, as a part of those at a corner.
const SLIVER: f64 = 0.5;

/// Shortest panel beside a kink, or of those that are split, in terms of the modes' number squared
/// over the largest wavenumber. What nodes nearer to each other do to each other is known for a few
/// modes only: higher ones would be noise.
const SHORTEST: f64 = 0.35;

/// Most nodes of a line whose panels are split further.
const MOST_NODES: usize = 300;

/// The gap along the line before it is loaded.
pub struct Generatrix<'a> {
    /// The gap at a place (C^2 / (2 R)).
    pub drop: Box<dyn Fn(f64) -> f64 + 'a>,
    /// Where its curvature jumps.
    pub kinks: Vec<Kink>,
    /// The points between which it is interpolated, if it is.
    pub points: Vec<f64>,
}

impl Generatrix<'_> {
    /// What panel `i` of a line leaves out of the pressure (p0): a wave of the gap of the amplitude
    /// e and the wavenumber k adds k e / 2 (Johnson 1985, section 13.2), and what n nodes in the
    /// length l miss is taken for as long as they are apart, k = 2 pi n / l.
    pub fn missed(&self, line: &Panels, i: usize) -> f64 {
        let ([from, to], n) = (line.panel(i), line.order());
        let at_nodes: Vec<f64> =
            line.nodes()[i * n..(i + 1) * n].iter().map(|y| (self.drop)(*y)).collect();
        let off = |y: f64| {
            let between: f64 = line.polynomials(i, y).zip(&at_nodes).map(|(w, own)| w * own).sum();
            (between - (self.drop)(y)).abs()
        };
        let even = (0..n).map(|part| from + (to - from) * (part as f64 + 0.5) / n as f64);
        let points = self.points.iter().copied().filter(|y| (from..=to).contains(y));
        let amplitude = even.chain(points).map(off).fold(0.0, f64::max);
        PI * n as f64 / (to - from) * amplitude
    }

    /// Where a panel is split into parts of `least` length or more: at the point next to its
    /// middle, if there is one, else there.
    fn split(&self, [from, to]: [f64; 2], least: f64) -> f64 {
        let middle = 0.5 * (from + to);
        let inner = self.points.iter().filter(|y| **y - from >= least && to - **y >= least);
        // Mirror images of a line are split at mirror images.
        let order = |a: &&f64, b: &&f64| {
            let distance = |y: f64| (y - middle).abs();
            distance(**a).total_cmp(&distance(**b)).then(a.abs().total_cmp(&b.abs()))
        };
        inner.min_by(order).copied().unwrap_or(middle)
    }
}

impl Resolution {
    /// Panels on [0, `half_length`] of the contact line, graded towards its end.
    pub fn contact_axis(&self, half_length: f64) -> Panels {
        let features = [0.0, half_length].map(|at| (at, self.corner));
        self.between_features(&features, Parity::Even)
    }

    /// The contact line between its `ends`, or one half of it if all is `symmetric`, with panels
    /// graded towards the ends and the `kinks` of the gap; and the parity that its wavenumbers have
    /// to serve. Loads grow with the `exponents`, if any, towards the ends.
    pub fn contact_line(
        &self,
        ends: [f64; 2],
        exponents: [Option<f64>; 2],
        kinks: &[Kink],
        symmetric: bool,
    ) -> (Panels, Parity) {
        let parity = if symmetric { Parity::Even } else { Parity::Odd };
        let from = if symmetric { 0.0 } else { ends[0] };
        let mut features = vec![(from, self.corner)];
        let mut inner = kinks.to_vec();
        inner.sort_by(|a, b| a.at.total_cmp(&b.at));
        // What lies closer together than the panels are wide is one feature.
        let apart = SLIVER * self.corner;
        for Kink { at, jump } in inner {
            if at - features[features.len() - 1].0 > apart && ends[1] - at > apart {
                let [sharp, most] = [SHARP / jump.abs(), KINK].map(|size| size * self.corner);
                features.push((at, sharp.max(self.corner).max(self.shortest()).min(most)));
            }
        }
        features.push((ends[1], self.corner));
        let reach = LAW.min(0.5 * (ends[1] - ends[0]));
        let [first, last] = [(0, 1.0), (1, -1.0)].map(|(i, side)| {
            exponents[i].map(|m| Corner { at: ends[i], side, growth: Growth::Power(m), reach })
        });
        let corners: Vec<Corner> = first.filter(|_| !symmetric).into_iter().chain(last).collect();
        (self.between_features(&features, parity).with_corners(&corners), parity)
    }

    /// The `line` with its panels split until what they leave out of the pressure, because of what
    /// the `gap` does between their nodes, is at most `within` (p0), or their least length or most
    /// number is reached.
    #[must_use]
    pub fn resolving(&self, mut line: Panels, gap: &Generatrix, within: f64) -> Panels {
        let least = self.shortest();
        while line.len() < MOST_NODES {
            let wanted = |i: &usize| {
                let [from, to] = line.panel(*i);
                to - from > 2.0 * least && gap.missed(&line, *i) > within
            };
            let mut breaks = line.breaks().to_vec();
            let split = (0..line.panel_count()).filter(wanted);
            breaks.extend(split.map(|i| gap.split(line.panel(i), least)));
            if breaks.len() == line.breaks().len() {
                break;
            }
            breaks.sort_by(f64::total_cmp);
            line = Panels::new(breaks, line.order()).with_corners(line.corners());
        }
        line
    }

    /// See [`SHORTEST`].
    fn shortest(&self) -> f64 {
        SHORTEST * (self.modes * self.modes) as f64 / self.k_max
    }

    /// Panels from the first of the ascending `features` to the last, graded towards all of them,
    /// but not towards the first one of an even half. Each comes with the size of its panels.
    fn between_features(&self, features: &[(f64, f64)], parity: Parity) -> Panels {
        let mut breaks = vec![features[0].0];
        for (i, pair) in features.windows(2).enumerate() {
            let [(from, after), (to, before)] = [pair[0], pair[1]];
            let one_sided = i == 0 && parity == Parity::Even;
            let reach = if one_sided { 1.0 } else { 0.5 } * (to - from);
            if !one_sided {
                breaks.extend(self.graded(after, reach)[1..].iter().map(|s| from + s));
            }
            let towards = self.graded(before, reach);
            // The features themselves are exact.
            let inner = towards[1..towards.len() - 1].iter().rev().map(|s| to - s);
            breaks.extend(inner.chain([to]));
        }
        Panels::new(breaks, self.order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave of the gap is followed to the tolerance that is asked for, a straight gap needs
    /// nothing, and mirror images have mirror images of panels.
    #[test]
    fn panels_follow_the_gap() {
        let resolution = Resolution::for_tolerance(5e-3);
        let line = || resolution.contact_line([-18.0, 20.0], [None; 2], &[], false).0;
        let points = |side: f64| -> Vec<f64> {
            let ascending = (-80..=80).map(|i| 0.25 * f64::from(i) + 0.07 * side);
            ascending.collect()
        };
        let [own, mirrored] = [1.0, -1.0].map(points);
        let gap = |amplitude: f64, points: &[f64]| Generatrix {
            drop: Box::new(move |y| amplitude * (1.5 * y).cos()),
            kinks: Vec::new(),
            points: points.to_vec(),
        };
        let gap_of_wave = gap(0.03, &own);
        let missed = |line: &Panels| -> f64 {
            (0..line.panel_count()).map(|i| gap_of_wave.missed(line, i)).fold(0.0, f64::max)
        };
        assert!(missed(&line()) > 0.03);
        let counts = [5e-3, 1e-3].map(|within| {
            let found = resolution.resolving(line(), &gap_of_wave, within);
            assert!(missed(&found) <= within, "{}", missed(&found));
            // What was split is split at points.
            let added = found.breaks().iter().filter(|y| !line().breaks().contains(y));
            assert!(added.clone().all(|y| own.contains(y)), "{:?}", found.breaks());
            found.len()
        });
        assert!(line().len() < counts[0] && counts[0] < counts[1] && counts[1] < 300, "{counts:?}");
        let straight = resolution.resolving(line(), &gap(0.0, &[]), 1e-9);
        assert_eq!(straight.breaks(), line().breaks());
        let other = resolution.contact_line([-20.0, 18.0], [None; 2], &[], false).0;
        let other = resolution.resolving(other, &gap(0.03, &mirrored), 1e-3);
        let found = resolution.resolving(line(), &gap_of_wave, 1e-3);
        for (y, image) in found.breaks().iter().zip(other.breaks().iter().rev()) {
            assert!((y + image).abs() < 1e-12, "{y} {image}");
        }
    }

    /// The steeper a kink, the smaller the panels beside it, but none is shorter than nodes can
    /// tell from each other.
    #[test]
    fn panels_beside_a_kink_are_as_small_as_it_is_steep() {
        let resolution = Resolution::for_tolerance(1e-2);
        let beside = |jump: f64| {
            let kinks = [Kink { at: 3.0, jump }];
            let (line, _) = resolution.contact_line([0.0, 10.0], [None; 2], &kinks, true);
            let kink = line.breaks().iter().position(|y| *y == 3.0).unwrap();
            line.breaks()[kink + 1] - 3.0
        };
        assert!((beside(0.01) - KINK * resolution.corner).abs() < 1e-12);
        assert!((beside(1.0) - SHARP * resolution.corner).abs() < 1e-12);
        assert!((beside(100.0) - resolution.shortest()).abs() < 1e-12);
    }
}
