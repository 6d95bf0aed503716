//! A contact line folded about the middle of a body: the even and the odd part of what acts on it.

use crate::base::{Corner, Panels, Parity};
use nalgebra::DMatrix;

/// Breaks that differ by less than this part of the line are one.
const SAME: f64 = 1e-9;

/// Panels towards a corner whose power the loads of the axis do not have: each is this part of the
/// one before.
const STEP: f64 = 0.2;
const STEPS: i32 = 4;

/// The contact line as a body sees it, y being the distance from the body's middle.
///
/// A pressure p(y) has an even and an odd part, (p(|y|) +- p(-|y|)) / 2, on an axis of |y| whose
/// panels end at all breaks of the line on either side. So the parts are polynomials on the axis's
/// panels, and their sum is again p, exactly but next to a corner.
#[derive(Debug, Clone)]
pub struct Fold {
    axis: Panels,
    /// Whether the line is one half of a contact that is symmetric about the body's middle.
    symmetric: bool,
    /// For each node of the axis the values at +y and at -y: nodes of the line, with weights.
    sides: Vec<[Vec<(usize, f64)>; 2]>,
    /// For each node of the line whether it lies at y < 0, and the value there: nodes of the axis,
    /// with weights.
    places: Vec<(bool, Vec<(usize, f64)>)>,
}

impl Fold {
    /// Folds the contact `line` of a body whose middle is at `middle`. A `symmetric` line begins at
    /// the middle and is one half of the contact; it has no odd part.
    pub fn new(line: &Panels, middle: f64, symmetric: bool) -> Self {
        let local: Vec<f64> = line.breaks().iter().map(|y| y - middle).collect();
        let [from, to] = [local[0], local[local.len() - 1]];
        let same = SAME * (to - from);
        let mut breaks: Vec<f64> = local.iter().map(|y| y.abs()).collect();
        if from < -same && to > same {
            breaks.push(0.0);
        }
        let (corners, further) = corners(line, middle, symmetric);
        breaks.extend(further);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|b, a| *b - *a <= same);
        if breaks[0] < same {
            breaks[0] = 0.0;
        }
        let axis = Panels::new(breaks, line.order()).with_corners(&corners);
        let within = |y: f64| (from..=to).contains(&y);
        let value = |y: f64| match within(y) {
            true => load_interpolation(line, y + middle),
            false => Vec::new(),
        };
        let sides = axis.nodes().iter().map(|&y| [value(y), value(-y)]).collect();
        let place = |y: &f64| (*y < middle, interpolation(&axis, (y - middle).abs()));
        let places = line.nodes().iter().map(place).collect();
        Self { axis, symmetric, sides, places }
    }

    /// The axis of |y|.
    pub fn axis(&self) -> &Panels {
        &self.axis
    }

    /// The parts that a pressure on the line can have.
    pub fn parities(&self) -> &'static [Parity] {
        if self.symmetric { &[Parity::Even] } else { &Parity::BOTH }
    }

    /// One part of functions on the line, in columns over the line's nodes, at the axis's nodes.
    pub fn part(&self, parity: Parity, values: &DMatrix<f64>) -> DMatrix<f64> {
        if self.symmetric {
            return values.clone();
        }
        DMatrix::from_fn(values.nrows(), self.axis.len(), |row, node| {
            self.shares(parity, node).map(|(j, w)| w * values[(row, j)]).sum()
        })
    }

    /// The nodes of the line, with weights, that make one part at a `node` of the axis.
    fn shares(&self, parity: Parity, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let [own, other] = &self.sides[node];
        let sign = parity.sign();
        let own = own.iter().map(|(j, w)| (*j, 0.5 * w));
        own.chain(other.iter().map(move |(j, w)| (*j, 0.5 * sign * w)))
    }

    /// Adds `factor` times the response of one part to `total`, a matrix over the nodes of the
    /// line: `response` is the same over the nodes of the axis.
    pub fn add(
        &self,
        parity: Parity,
        response: &DMatrix<f64>,
        factor: f64,
        total: &mut DMatrix<f64>,
    ) {
        if self.symmetric {
            total.zip_apply(response, |sum, own| *sum += factor * own);
            return;
        }
        // From the line to the axis.
        let mut spread = DMatrix::zeros(response.nrows(), self.places.len());
        for node in 0..self.axis.len() {
            for (j, w) in self.shares(parity, node) {
                let mut column = spread.column_mut(j);
                column.axpy(w, &response.column(node), 1.0);
            }
        }
        // And back.
        let mut back: Vec<(usize, usize, f64)> = Vec::new();
        for (i, (beyond, weights)) in self.places.iter().enumerate() {
            let sign = if *beyond { factor * parity.sign() } else { factor };
            back.extend(weights.iter().map(|(node, w)| (i, *node, sign * w)));
        }
        let columns = total.as_mut_slice().chunks_exact_mut(self.places.len());
        for (column, spread) in columns.zip(spread.as_slice().chunks_exact(response.nrows())) {
            for (i, node, weight) in &back {
                column[*i] += weight * spread[*node];
            }
        }
    }
}

/// The corners of the axis of |y| whose powers its loads have, and breaks of the axis towards the
/// other corners of the `line`.
///
/// Next to a corner of one side of the body's middle the other side's load has no power, unless it
/// has a like corner at the same place or ends before. Smaller panels resolve a corner without one.
fn corners(line: &Panels, middle: f64, symmetric: bool) -> (Vec<Corner>, Vec<f64>) {
    let [from, to] = [line.breaks()[0] - middle, line.end() - middle];
    let same = SAME * (to - from);
    let folded = |c: &Corner| {
        let at = c.at - middle;
        let is_beyond = at < 0.0 && !symmetric;
        Corner { at: at.abs(), side: if is_beyond { -c.side } else { c.side }, ..*c }
    };
    let (mut corners, mut further) = (Vec::new(), Vec::new());
    for own in line.corners() {
        let corner = folded(own);
        let is_like = |other: &Corner| {
            let apart = (other.at - corner.at).abs();
            apart <= same && other.side == corner.side && other.growth == corner.growth
        };
        // How far the other side's load reaches on the axis.
        let other = if own.at < middle { to } else { -from };
        let alone = if symmetric || other <= 0.0 { f64::INFINITY } else { corner.at - other };
        let others = line.corners().iter().filter(|c| c.at != own.at);
        if others.map(folded).any(|other| is_like(&other)) {
            corners.push(corner);
        } else if alone > same {
            corners.push(Corner { reach: corner.reach.min(alone), ..corner });
        } else {
            let [a, b] = line.panel(line.panel_of(own.at + own.side * same));
            let sizes = (1..=STEPS).map(|i| (b - a) * STEP.powi(i));
            further.extend(sizes.map(|size| corner.at + corner.side * size));
        }
    }
    corners.dedup_by(|b, a| (b.at - a.at).abs() <= same);
    (corners, further)
}

/// A response at `y` from its values at the nodes of `axis`, with weights.
fn interpolation(axis: &Panels, y: f64) -> Vec<(usize, f64)> {
    node_at(axis, y).unwrap_or_else(|| axis.interpolation(y).collect())
}

/// The same of a load.
fn load_interpolation(axis: &Panels, y: f64) -> Vec<(usize, f64)> {
    node_at(axis, y).unwrap_or_else(|| {
        let panel = axis.panel_of(y);
        (panel * axis.order()..).zip(axis.loads(panel, y)).collect()
    })
}

/// The node of `axis` at `y`, if there is one: that of one axis may be a rounding off that of
/// another.
fn node_at(axis: &Panels, y: f64) -> Option<Vec<(usize, f64)>> {
    let same = SAME * (axis.end() - axis.breaks()[0]);
    let after = axis.nodes().partition_point(|n| *n < y);
    let near = |i: &usize| axis.nodes().get(*i).is_some_and(|n| (n - y).abs() <= same);
    let node = [after, after.wrapping_sub(1)].into_iter().find(near)?;
    Some(vec![(node, 1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Growth;

    #[test]
    fn the_parts_are_even_and_odd_and_their_sum_is_the_whole() {
        let line = Panels::new(vec![-1.0, -0.4, 0.3, 2.0], 4);
        for middle in [-2.0, -1.0, -0.4, 0.0, 0.17, 0.5, 2.0, 3.1] {
            let fold = Fold::new(&line, middle, false);
            // The identity, as response of both parts, gives back every value.
            let mut total = DMatrix::zeros(line.len(), line.len());
            for &parity in fold.parities() {
                let n = fold.axis().len();
                fold.add(parity, &DMatrix::identity(n, n), 1.0, &mut total);
            }
            let off = (&total - DMatrix::identity(line.len(), line.len())).amax();
            assert!(off < 1e-12, "middle {middle}: {off}");
            // A cubic within the line, zero beyond.
            let f = |y: f64| if (-1.0..=2.0).contains(&y) { y.powi(3) - y + 0.4 } else { 0.0 };
            let values = DMatrix::from_fn(1, line.len(), |_, j| f(line.nodes()[j]));
            for &parity in fold.parities() {
                let part = fold.part(parity, &values);
                for (y, got) in fold.axis().nodes().iter().zip(part.iter()) {
                    let want = 0.5 * (f(middle + y) + parity.sign() * f(middle - y));
                    assert!((got - want).abs() < 1e-12, "{middle} {parity:?} {y}: {got} {want}");
                }
            }
        }
    }

    /// Loads with the power of an end, once as they are and once folded: the same integrals against
    /// a smooth function, whichever end is nearer to the middle, with and without a like one at the
    /// same distance.
    #[test]
    fn folded_loads_keep_the_power_of_an_end() {
        let line = |exponents: [Option<f64>; 2]| {
            let breaks = vec![-2.0, -1.98, -1.9, -1.5, 0.0, 1.5, 1.9, 1.98, 2.0];
            let corner = |(at, side, m)| Corner { at, side, growth: Growth::Power(m), reach: 1.0 };
            let [first, last] = [(-2.0, 1.0, exponents[0]), (2.0, -1.0, exponents[1])]
                .map(|(at, side, exponent)| exponent.map(|m| corner((at, side, m))));
            let corners: Vec<Corner> = first.into_iter().chain(last).collect();
            Panels::new(breaks, 6).with_corners(&corners)
        };
        let smooth = |y: f64| (0.4 * y).sin() + 2.0;
        for exponents in
            [[Some(0.226); 2], [Some(0.5); 2], [Some(0.3), Some(0.1)], [None, Some(0.226)]]
        {
            let line = line(exponents);
            for middle in [-3.0, -0.7, -0.004, 0.0, 1e-5, 0.004, 0.7, 3.0] {
                let fold = Fold::new(&line, middle, false);
                for node in 0..line.len() {
                    let unit =
                        DMatrix::from_fn(1, line.len(), |_, j| f64::from(u8::from(j == node)));
                    let mut sum = 0.0;
                    for &parity in fold.parities() {
                        let part = fold.part(parity, &unit);
                        let axis = fold.axis();
                        for (j, (y, weight)) in axis.nodes().iter().zip(axis.weights()).enumerate()
                        {
                            let own = [1.0, parity.sign()].map(|sign| sign * part[(0, j)]);
                            let there = [y, &-y].map(|y| smooth(middle + y));
                            sum += weight * (own[0] * there[0] + own[1] * there[1]);
                        }
                    }
                    let want = line.weights()[node] * smooth(line.nodes()[node]);
                    let off = (sum - want).abs();
                    assert!(off < 2e-4, "{exponents:?}, {middle}, {node}: {sum}, not {want}");
                }
            }
        }
    }

    #[test]
    fn a_half_of_a_symmetric_contact_is_its_even_part() {
        let line = Panels::new(vec![0.0, 0.4, 2.0], 3);
        let fold = Fold::new(&line, 0.0, true);
        assert_eq!((fold.axis(), fold.parities()), (&line, &[Parity::Even][..]));
        let values = DMatrix::from_fn(2, line.len(), |i, j| (i + 3 * j) as f64);
        assert_eq!(fold.part(Parity::Even, &values), values);
    }
}
