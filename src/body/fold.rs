//! A contact line folded about the middle of a body: the even and the odd part of what acts on it.

use crate::base::{Corner, Panels, Parity};
use nalgebra::DMatrix;

/// Breaks that differ by less than this part of the line are one.
const SAME: f64 = 1e-9;

/// The contact line as a body sees it, y being the distance from the body's middle.
///
/// A pressure p(y) has an even and an odd part, (p(|y|) +- p(-|y|)) / 2, on an axis of |y| whose
/// panels end at all breaks of the line on either side. So the parts are polynomials on the axis's
/// panels, and their sum is again p, exactly.
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
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|b, a| *b - *a <= same);
        if breaks[0] < same {
            breaks[0] = 0.0;
        }
        let corner = |c: &Corner| Corner { at: c.at - middle, ..*c };
        let corners: Vec<Corner> = line.corners().iter().map(corner).collect();
        // Loads that grow at one end alone have no power on the axis of |y|.
        debug_assert!(symmetric || corners.is_empty());
        let axis = Panels::new(breaks, line.order()).with_corners(&corners);
        let within = |y: f64| (from..=to).contains(&y);
        let value = |y: f64| match within(y) {
            true => interpolation(line, y + middle),
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
        for (i, (beyond, weights)) in self.places.iter().enumerate() {
            let sign = if *beyond { parity.sign() } else { 1.0 };
            for (node, w) in weights {
                let mut row = total.row_mut(i);
                row += spread.row(*node) * (factor * sign * w);
            }
        }
    }
}

/// The interpolation on `axis`, without the nodes that have no weight.
fn interpolation(axis: &Panels, y: f64) -> Vec<(usize, f64)> {
    // A node of one axis may be a rounding off that of another.
    let same = SAME * (axis.end() - axis.breaks()[0]);
    let after = axis.nodes().partition_point(|n| *n < y);
    let near = |i: &usize| axis.nodes().get(*i).is_some_and(|n| (n - y).abs() <= same);
    match [after, after.wrapping_sub(1)].into_iter().find(near) {
        Some(node) => vec![(node, 1.0)],
        None => axis.interpolation(y).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn a_half_of_a_symmetric_contact_is_its_even_part() {
        let line = Panels::new(vec![0.0, 0.4, 2.0], 3);
        let fold = Fold::new(&line, 0.0, true);
        assert_eq!((fold.axis(), fold.parities()), (&line, &[Parity::Even][..]));
        let values = DMatrix::from_fn(2, line.len(), |i, j| (i + 3 * j) as f64);
        assert_eq!(fold.part(Parity::Even, &values), values);
    }
}
