//! From values at an axis's nodes to an integral against a kernel that peaks at a target.

use crate::base::{Panels, gauss_legendre};
use nalgebra::{DMatrix, DVector};

/// A copy of the axis: the point s of the axis acts at `sign` s + `shift`, `weight` times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image {
    pub sign: f64,
    pub shift: f64,
    pub weight: f64,
}

/// An axis as sources: its panels, and clusters of neighbouring panels that stand for them where
/// the target is far.
///
/// A smooth kernel over a cluster is its interpolant through the cluster's few Gauss nodes, so the
/// panels act like charges at those nodes: far fine panels cost as little as one coarse panel.
#[derive(Debug, Clone)]
pub struct Sources {
    /// The axis.
    pub axis: Panels,
    clusters: Vec<Cluster>,
    /// Places of the charges, `order` a cluster.
    places: Vec<f64>,
    /// Charges per value at the axis's nodes: quadrature weights times the clusters' polynomials.
    charges: DMatrix<f64>,
}

/// A run of panels; the first cluster is the whole axis.
#[derive(Debug, Clone)]
struct Cluster {
    panels: std::ops::Range<usize>,
    ends: [f64; 2],
    /// The two halves; none for a single panel.
    halves: Option<[usize; 2]>,
}

/// Sum of the distances of a target from the two ends of an interval, in its lengths: (r + 1/r) / 2
/// with r the parameter of Bernstein's ellipse through the target, where kernels have their pole. A
/// function that is analytic within it is interpolated by n nodes to about r^-n and integrated by
/// Gauss's rule to about r^-2n (Trefethen, Approximation Theory and Approximation Practice, 2013,
/// theorems 8.2 and 19.3).
///
/// A cluster of several panels stands for them from here on, r = 6.5.
const CLUSTER_DISTANCE: f64 = 3.3;

/// A panel's own Gauss nodes serve from here on, r = 3.3.
const PANEL_DISTANCE: f64 = 1.8;

/// The four Gauss nodes or more of a piece of a panel, r = 2.6. Panels that double have their middle
/// nodes at a distance of 1.5 from their neighbours, and rounding would decide.
const PIECE_DISTANCE: f64 = 1.49;

impl Sources {
    /// Clusters of an axis's panels.
    pub fn new(axis: Panels) -> Self {
        let order = axis.order();
        let mut clusters = vec![Cluster {
            panels: 0..axis.panel_count(),
            ends: [axis.breaks()[0], axis.breaks()[axis.panel_count()]],
            halves: None,
        }];
        let mut next = 0;
        while next < clusters.len() {
            let Cluster { panels, ends: [a, b], .. } = clusters[next].clone();
            if panels.len() > 1 {
                // Cut at the break nearest to the middle.
                let middle = 0.5 * (a + b);
                let cut = (panels.start + 1..panels.end)
                    .min_by(|&i, &j| {
                        let off = |i: usize| (axis.breaks()[i] - middle).abs();
                        off(i).total_cmp(&off(j))
                    })
                    .expect("two panels or more");
                let at = axis.breaks()[cut];
                clusters[next].halves = Some([clusters.len(), clusters.len() + 1]);
                clusters.push(Cluster { panels: panels.start..cut, ends: [a, at], halves: None });
                clusters.push(Cluster { panels: cut..panels.end, ends: [at, b], halves: None });
            }
            next += 1;
        }
        let mut places = Vec::with_capacity(order * clusters.len());
        let mut charges = DMatrix::zeros(order * clusters.len(), axis.len());
        let mut basis = vec![0.0; order];
        for (i, cluster) in clusters.iter().enumerate() {
            let own = Panels::new(cluster.ends.to_vec(), order);
            places.extend_from_slice(own.nodes());
            for node in cluster.panels.start * order..cluster.panels.end * order {
                own.basis(0, axis.nodes()[node], &mut basis);
                for (m, b) in basis.iter().enumerate() {
                    charges[(i * order + m, node)] = axis.weights()[node] * b;
                }
            }
        }
        Self { axis, clusters, places, charges }
    }

    /// Charges of the values at the axis's first nodes; the others are zero.
    pub fn charges(&self, values: &[f64]) -> Vec<f64> {
        let values = DVector::from_column_slice(values);
        (self.charges.columns(0, values.len()) * values).data.into()
    }

    /// Adds a row over the charges to one over the axis's first nodes.
    pub fn scatter(&self, charges: &[f64], nodes: &mut [f64]) {
        let order = self.axis.order();
        for (i, cluster) in self.clusters.iter().enumerate() {
            let row = &charges[i * order..(i + 1) * order];
            if row.iter().all(|r| *r == 0.0) {
                continue;
            }
            let end = (cluster.panels.end * order).min(nodes.len());
            let start = (cluster.panels.start * order).min(end);
            for (node, value) in nodes[..end].iter_mut().enumerate().skip(start) {
                let column = self.charges.column(node);
                let own = &column.as_slice()[i * order..(i + 1) * order];
                *value += row.iter().zip(own).map(|(r, c)| r * c).sum::<f64>();
            }
        }
    }

    /// Number of charges.
    pub fn charge_count(&self) -> usize {
        self.places.len()
    }
}

/// Quadrature of sum over images of int kernel(target - s', depth) f(s) ds, with f given at the
/// nodes of an axis. Panels that the target is near are cut into pieces about as long as their
/// distance from it, with f interpolated: the kernels' peaks (ln r, or a spread of the width of the
/// depth) are then resolved, wherever the target lies. Panels far away act as clusters.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    /// Charges far enough: offset target - source, index of the charge, weight.
    far: Vec<(f64, u32, f64)>,
    /// Points inside near panels: offset, the panel's first node.
    near: Vec<(f64, u32)>,
    /// Weights of the near points on their panel's nodes, `order` a point.
    near_weights: Vec<f64>,
    order: usize,
}

/// For a target on the axis's line pieces are not cut below this part of their panel: what an
/// integrable singularity of ln r leaves in such a piece is below 1e-4 of the panel's own share.
/// Off the line the depth bounds the pieces by itself. No power of two, which halves of a panel would
/// meet but for rounding.
const SMALLEST_PIECE: f64 = 1.0 / 500.0;

/// Nor in a long panel below this length (C), a tenth of the shortest wave at least.
const SHORTEST_PIECE: f64 = 0.004;

impl Stencil {
    /// Stencil for a `target` coordinate on the axis's line, at `depth` >= 0 from it, for kernels that
    /// peak at the target.
    pub fn new(sources: &Sources, images: &[Image], target: f64, depth: f64) -> Self {
        Self::resolving(sources, images, target, depth, 0.0)
    }

    /// [`Stencil::new`] for kernels that do not vary over lengths below `shortest`.
    pub fn resolving(
        sources: &Sources,
        images: &[Image],
        target: f64,
        depth: f64,
        shortest: f64,
    ) -> Self {
        let order = sources.axis.order();
        let mut stencil = Self {
            far: Vec::with_capacity(64),
            near: Vec::with_capacity(64),
            near_weights: Vec::with_capacity(64 * order),
            order,
        };
        let piece_rule = gauss_legendre(order.max(4));
        let mut basis = vec![0.0; order];
        for image in images {
            // The target seen from the axis's own coordinate.
            let own = image.sign * (target - image.shift);
            let mut open = vec![0];
            while let Some(index) = open.pop() {
                let cluster = &sources.clusters[index];
                let [a, b] = cluster.ends;
                let far = distances(a, b, own, depth);
                let factor =
                    if cluster.halves.is_some() { CLUSTER_DISTANCE } else { PANEL_DISTANCE };
                if far >= factor * (b - a) {
                    for charge in index * order..(index + 1) * order {
                        let offset = image.sign * (own - sources.places[charge]);
                        stencil.far.push((offset, charge as u32, image.weight));
                    }
                } else if let Some(halves) = cluster.halves {
                    open.extend(halves);
                } else {
                    let panel = cluster.panels.start;
                    stencil.add_near(
                        &sources.axis,
                        image,
                        panel,
                        own,
                        depth,
                        shortest,
                        &piece_rule,
                        &mut basis,
                    );
                }
            }
        }
        stencil
    }

    /// Cuts a near panel into pieces.
    #[allow(clippy::too_many_arguments)]
    fn add_near(
        &mut self,
        axis: &Panels,
        image: &Image,
        panel: usize,
        own: f64,
        depth: f64,
        shortest: f64,
        piece_rule: &(Vec<f64>, Vec<f64>),
        basis: &mut [f64],
    ) {
        let [a, b] = axis.panel(panel);
        let singular =
            if depth > 0.0 { 0.0 } else { (SMALLEST_PIECE * (b - a)).min(SHORTEST_PIECE) };
        let smallest = singular.max(shortest);
        // Cut at the target first, so that pieces end there.
        let mut pieces = if a < own && own < b { vec![[a, own], [own, b]] } else { vec![[a, b]] };
        while let Some([c, d]) = pieces.pop() {
            let length = d - c;
            if distances(c, d, own, depth) < PIECE_DISTANCE * length && length > smallest {
                let mid = 0.5 * (c + d);
                pieces.extend([[c, mid], [mid, d]]);
                continue;
            }
            for (t, w) in piece_rule.0.iter().zip(&piece_rule.1) {
                let s = 0.5 * (c + d + length * t);
                axis.basis(panel, s, basis);
                self.near.push((image.sign * (own - s), (panel * self.order) as u32));
                let weight = image.weight * 0.5 * length * w;
                self.near_weights.extend(basis.iter().map(|b| weight * b));
            }
        }
    }

    /// Adds `kernel(offset)` times the weights to a row over the charges and one over the first
    /// nodes. Offsets beyond `reach` are skipped: the kernel has faded there.
    pub fn add_row(
        &self,
        reach: f64,
        mut kernel: impl FnMut(f64) -> f64,
        charges: &mut [f64],
        nodes: &mut [f64],
    ) {
        for &(u, charge, w) in &self.far {
            if u.abs() < reach {
                charges[charge as usize] += w * kernel(u);
            }
        }
        for (&(u, first), w) in self.near.iter().zip(self.near_weights.chunks_exact(self.order)) {
            let first = first as usize;
            if u.abs() < reach && first < nodes.len() {
                let value = kernel(u);
                for (r, w) in nodes[first..first + self.order].iter_mut().zip(w) {
                    *r += w * value;
                }
            }
        }
    }

    /// Number of its source points.
    pub fn len(&self) -> usize {
        self.far.len() + self.near.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Appends every source point within `reach` to `loads`, with the `values` at the first nodes
    /// (zeros behind them) and their `charges`.
    pub fn gather(&self, reach: f64, values: &[f64], charges: &[f64], loads: &mut LineLoads) {
        for &(u, charge, w) in &self.far {
            if u.abs() < reach {
                loads.push(u, w * charges[charge as usize]);
            }
        }
        for (&(u, first), w) in self.near.iter().zip(self.near_weights.chunks_exact(self.order)) {
            let first = first as usize;
            if u.abs() < reach && first < values.len() {
                let local = &values[first..first + self.order];
                loads.push(u, w.iter().zip(local).map(|(w, v)| w * v).sum());
            }
        }
    }
}

/// Line loads as a target sees them.
#[derive(Debug, Clone, Default)]
pub struct LineLoads {
    /// Offsets target - source along the axis.
    pub offsets: Vec<f64>,
    /// Loads.
    pub loads: Vec<f64>,
}

impl LineLoads {
    /// Adds one.
    pub fn push(&mut self, offset: f64, load: f64) {
        self.offsets.push(offset);
        self.loads.push(load);
    }

    /// Leaves none.
    pub fn clear(&mut self) {
        self.offsets.clear();
        self.loads.clear();
    }

    /// Sum of `kernel(offset)` times the loads.
    pub fn sum(&self, kernel: impl Fn(f64) -> f64) -> f64 {
        self.offsets.iter().zip(&self.loads).map(|(&u, p)| p * kernel(u)).sum()
    }
}

/// Sum of the distances of the point (`own`, `depth`) from `a` and from `b`.
fn distances(a: f64, b: f64, own: f64, depth: f64) -> f64 {
    let square = depth * depth;
    ((own - a).powi(2) + square).sqrt() + ((own - b).powi(2) + square).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_integrated_from_any_target() {
        let axis = Panels::new(vec![0.0, 2.0, 2.5, 2.8, 2.95, 3.0], 5);
        let sources = Sources::new(axis.clone());
        let direct = [Image { sign: 1.0, shift: 0.0, weight: 1.0 }];
        let mirrored = [Image { sign: -1.0, shift: 6.0, weight: 1.0 }];
        // int_0^3 -ln|y - s| ds for f = 1.
        let exact = |y: f64, a: f64, b: f64| {
            let part = |d: f64| if d == 0.0 { 0.0 } else { d * (d.abs().ln() - 1.0) };
            -(part(b - y) - part(a - y))
        };
        let ones = vec![1.0; axis.len()];
        let charges = sources.charges(&ones);
        for y in [0.0, 0.01, 0.5, 1.0, 2.9, 3.0, 3.1, 7.0] {
            for (images, a, b) in [(&direct, 0.0, 3.0), (&mirrored, 3.0, 6.0)] {
                let stencil = Stencil::new(&sources, images, y, 0.0);
                let mut row = vec![0.0; axis.len()];
                let mut charge_row = vec![0.0; sources.charge_count()];
                let kernel = |u: f64| -u.abs().ln();
                stencil.add_row(f64::INFINITY, kernel, &mut charge_row, &mut row);
                sources.scatter(&charge_row, &mut row);
                let got: f64 = row.iter().sum();
                assert!((got - exact(y, a, b)).abs() < 1e-3, "{y}: {got} {}", exact(y, a, b));
                let mut loads = LineLoads::default();
                stencil.gather(f64::INFINITY, &ones, &charges, &mut loads);
                assert!((loads.sum(kernel) - got).abs() < 1e-12);
            }
        }
    }
}
