//! Quadrature of values at an axis's nodes against a kernel that peaks at a target.

use crate::base::{Panels, crowded_legendre, gauss_legendre};
use crate::kernels::wave::WAVES;
use multiversion::multiversion;
use nalgebra::DMatrix;
use std::ops::Range;

/// A copy of the axis: the point s of the axis acts at `sign` s + `shift` with the factor `weight`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image {
    /// 1, or -1 for a mirror image.
    pub sign: f64,
    /// Position of the axis's origin.
    pub shift: f64,
    /// Factor of its effect.
    pub weight: f64,
}

/// An axis as sources: its panels, and clusters of neighbouring panels that replace them for a far
/// target.
///
/// A smooth kernel is interpolated over a cluster through its few Gauss nodes, so the panels act
/// like charges at those nodes: distant fine panels cost no more than one coarse panel.
#[derive(Debug, Clone)]
pub struct Sources {
    /// The axis.
    pub axis: Panels,
    clusters: Vec<Cluster>,
    /// Positions of the charges, `order` per cluster.
    places: Vec<f64>,
    /// Charges (columns) per value at the axis's nodes (rows): quadrature weights times the
    /// clusters' polynomials.
    charges: DMatrix<f64>,
    /// Gauss's rules for a piece of a panel, and for one with a logarithm at its end.
    piece_rule: (Vec<f64>, Vec<f64>),
    steep_rule: Vec<(f64, f64)>,
}

/// A run of panels; the first cluster is the whole axis.
#[derive(Debug, Clone)]
struct Cluster {
    panels: Range<usize>,
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
/// A cluster replaces its panels from this distance, r = 6.5.
const CLUSTER_DISTANCE: f64 = 3.3;

/// A panel's own Gauss nodes are used from this distance, r = 3.3.
const PANEL_DISTANCE: f64 = 1.8;

/// The Gauss nodes of a piece of a panel are used from this distance, r = 2.6.
/// Panels that double have their middle nodes at a distance of exactly 1.5 from their neighbours,
/// and rounding would decide.
const PIECE_DISTANCE: f64 = 1.49;

/// The least number of these for the kernels of loads, which are logarithms and peaks.
pub(super) const PIECE_NODES: usize = 4;

impl Sources {
    /// Clusters of an axis's panels, whose pieces have `piece_nodes` Gauss nodes.
    pub fn new(axis: Panels, piece_nodes: usize) -> Self {
        let order = axis.order();
        let mut clusters = vec![Cluster {
            panels: 0..axis.panel_count(),
            ends: [axis.breaks()[0], axis.end()],
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
        let mut charges = DMatrix::zeros(axis.len(), order * clusters.len());
        for (i, cluster) in clusters.iter().enumerate() {
            let own = Panels::new(cluster.ends.to_vec(), order);
            places.extend_from_slice(own.nodes());
            for node in cluster.panels.start * order..cluster.panels.end * order {
                for (m, b) in own.polynomials(0, axis.nodes()[node]).enumerate() {
                    charges[(node, i * order + m)] = axis.weights()[node] * b;
                }
            }
        }
        let (piece_rule, steep_rule) =
            (gauss_legendre(piece_nodes), crowded_legendre(order + MORE_NODES, POWER));
        Self { axis, clusters, places, charges, piece_rule, steep_rule }
    }

    /// Charges of functions from their `values` at the axis's nodes, one function per row in both.
    pub fn charges(&self, values: &DMatrix<f64>) -> DMatrix<f64> {
        let mut charges = DMatrix::zeros(values.nrows(), self.charge_count());
        let own = charges.as_mut_slice().chunks_exact_mut(values.nrows().max(1));
        for (charge, own) in own.enumerate() {
            let (nodes, shares) = self.shares(charge);
            add_all(shares, &values.as_slice()[nodes.start * own.len()..], own);
        }
        charges
    }

    /// Adds columns over the charges, one after the other, to columns over the axis's first nodes.
    /// A target knows few of the charges.
    pub fn scatter(&self, charges: &[f64], nodes: &mut DMatrix<f64>) {
        let first = nodes.nrows();
        let columns = charges.chunks_exact(self.charge_count());
        for (charges, column) in columns.zip(nodes.as_mut_slice().chunks_exact_mut(first)) {
            scatter(self, charges, column);
        }
    }

    /// The nodes of the axis in the cluster of a `charge`, and the charge per value at each.
    fn shares(&self, charge: usize) -> (Range<usize>, &[f64]) {
        let (order, column) = (self.axis.order(), charge * self.axis.len());
        let Range { start, end } = self.clusters[charge / order].panels;
        let (start, end) = (start * order, end * order);
        (start..end, &self.charges.as_slice()[column + start..column + end])
    }

    /// Number of charges.
    pub fn charge_count(&self) -> usize {
        self.places.len()
    }
}

/// Adds the `charges` of one target to the values of the first nodes.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn scatter(sources: &Sources, charges: &[f64], nodes: &mut [f64]) {
    for (charge, value) in charges.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        let (own, shares) = sources.shares(charge);
        let own = nodes.iter_mut().skip(own.start);
        own.zip(shares).for_each(|(sum, share)| *sum += value * share);
    }
}

/// Adds functions, each with a factor, to `sum`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn add_all(factors: &[f64], functions: &[f64], sum: &mut [f64]) {
    for (factor, function) in factors.iter().zip(functions.chunks_exact(sum.len())) {
        sum.iter_mut().zip(function).for_each(|(sum, value)| *sum += factor * value);
    }
}

/// Quadrature of sum over images of int kernel(target - s', depth) f(s) ds, with f given at the
/// nodes of an axis. Panels near the target are divided into pieces about as long as their distance
/// from it, with f interpolated. The kernels' peaks (ln r, or a peak as wide as the depth) are then
/// resolved for any target. Distant panels act as clusters.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    /// Offsets target - source: of the far charges, then of points inside near panels.
    offsets: Vec<f64>,
    /// The charges: index, weight.
    far: Vec<(u32, f64)>,
    /// The near points: the panel's first node.
    near: Vec<u32>,
    /// Weights of the near points on their panel's nodes, `order` per point.
    near_weights: Vec<f64>,
    order: usize,
}

/// The singularity of a kernel at a target on the axis's line itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Peak {
    /// It grows like ln r.
    Logarithm,
    /// It has at most a kink.
    Kink,
}

/// Position of a [`Stencil`]'s target, and the kernel's singularity there; see [`Stencil::new`].
struct TargetLine {
    depth: f64,
    shortest: f64,
    peak: Peak,
}

/// Positions that differ by less than this fraction of a panel are equal.
const SAME: f64 = 1e-9;

/// Power n of the map t^n that concentrates Gauss nodes at a logarithm, and the number of nodes
/// beyond the panel's order: t^(n-1) ln t is integrated to 1e-5 or better.
const POWER: i32 = 3;
const MORE_NODES: usize = 5;

impl Stencil {
    /// Stencil for a `target` coordinate on the axis's line, at `depth` >= 0 from it. On the line
    /// itself the kernel has a `peak` and otherwise does not vary over lengths below `shortest`.
    pub fn new(
        sources: &Sources,
        images: &[Image],
        target: f64,
        depth: f64,
        shortest: f64,
        peak: Peak,
    ) -> Self {
        let order = sources.axis.order();
        let mut stencil = Self {
            offsets: Vec::with_capacity(128),
            far: Vec::with_capacity(64),
            near: Vec::with_capacity(64),
            near_weights: Vec::with_capacity(64 * order),
            order,
        };
        let near = stencil.add_far(sources, images, target, depth);
        let line = TargetLine { depth, shortest, peak };
        let mut pieces = Vec::with_capacity(32);
        for (image, own, panel) in near {
            stencil.add_near(sources, &line, image, own, panel, &mut pieces);
        }
        stencil
    }

    /// Adds the clusters of panels that are far enough from the target to act like charges. Returns
    /// the other panels: image, the target in the axis's own coordinate, and panel.
    fn add_far<'a>(
        &mut self,
        sources: &Sources,
        images: &'a [Image],
        target: f64,
        depth: f64,
    ) -> Vec<(&'a Image, f64, usize)> {
        let order = self.order;
        let mut near = Vec::with_capacity(32);
        let mut open = Vec::with_capacity(32);
        for image in images {
            let own = image.sign * (target - image.shift);
            open.push(0);
            while let Some(index) = open.pop() {
                let cluster = &sources.clusters[index];
                let [a, b] = cluster.ends;
                let far = distances(a, b, own, depth);
                // The weights of a panel at a corner integrate polynomials of less than its order.
                let coarse = cluster.halves.is_some()
                    || sources.axis.corner_of(cluster.panels.start).is_some();
                let factor = if coarse { CLUSTER_DISTANCE } else { PANEL_DISTANCE };
                if far >= factor * (b - a) {
                    for charge in index * order..(index + 1) * order {
                        self.offsets.push(image.sign * (own - sources.places[charge]));
                        self.far.push((charge as u32, image.weight));
                    }
                } else if let Some(halves) = cluster.halves {
                    open.extend(halves);
                } else {
                    near.push((image, own, cluster.panels.start));
                }
            }
        }
        near
    }

    /// Adds the points of a `panel` near the target, which is at `own` in the axis's coordinate.
    /// `pieces` is scratch space.
    fn add_near(
        &mut self,
        sources: &Sources,
        line: &TargetLine,
        image: &Image,
        own: f64,
        panel: usize,
        pieces: &mut Vec<[f64; 2]>,
    ) {
        let (axis, order) = (&sources.axis, self.order);
        let [a, b] = axis.panel(panel);
        let corner = axis.corner_of(panel).map(|c| c.at);
        let mut add = |s: f64, weight: f64| {
            self.offsets.push(image.sign * (own - s));
            self.near.push((panel * order) as u32);
            let weight = image.weight * weight;
            self.near_weights.extend(axis.loads(panel, s).map(|b| weight * b));
        };
        // Divided at the target first, so that pieces end there.
        if a < own && own < b {
            pieces.extend([[a, own], [own, b]]);
        } else {
            pieces.push([a, b]);
        }
        while let Some([c, d]) = pieces.pop() {
            let length = d - c;
            // Images of a panel's end differ from it by rounding.
            let touches = |end: f64| (end - own).abs() < SAME * (b - a);
            let touched = [c, d].into_iter().find(|end| touches(*end));
            let steep = touched.filter(|_| line.peak == Peak::Logarithm);
            let flat = steep.is_some() || line.peak == Peak::Kink;
            let short = line.depth == 0.0 && flat && length <= line.shortest;
            let corner = corner.filter(|at| *at == c || *at == d);
            // Nodes crowd at one end.
            let both = steep.is_some() && corner.is_some_and(|at| !touches(at));
            if both || !short && distances(c, d, own, line.depth) < PIECE_DISTANCE * length {
                let mid = 0.5 * (c + d);
                pieces.extend([[c, mid], [mid, d]]);
            } else if let Some(from) = corner.or(steep.filter(|_| short)) {
                let away = if from == c { length } else { -length };
                for (t, w) in &sources.steep_rule {
                    add(from + away * t, length * w);
                }
            } else {
                for (t, w) in sources.piece_rule.0.iter().zip(&sources.piece_rule.1) {
                    add(0.5 * (c + d + length * t), 0.5 * length * w);
                }
            }
        }
    }

    /// Offsets target - source of the source points.
    pub fn offsets(&self) -> &[f64] {
        &self.offsets
    }

    /// Moves [`Stencil::offsets`] out; no other method uses them.
    pub fn take_offsets(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.offsets)
    }

    /// Adds the kernel's `values` at the source points times the weights to a row over the charges
    /// and one over the first nodes.
    pub fn add_row(&self, values: &[f64], charges: &mut [f64], nodes: &mut [f64]) {
        let (far, near) = values.split_at(self.far.len());
        for (value, &(charge, w)) in far.iter().zip(&self.far) {
            charges[charge as usize] += w * value;
        }
        let weights = self.near_weights.chunks_exact(self.order);
        for ((value, &first), w) in near.iter().zip(&self.near).zip(weights) {
            let first = first as usize;
            if *value != 0.0 && first < nodes.len() {
                for (r, w) in nodes[first..first + self.order].iter_mut().zip(w) {
                    *r += w * value;
                }
            }
        }
    }

    /// Writes to `loads` the loads of the source points whose `distances`, of either sign, are
    /// below `limit`, from the `values` of functions at the axis's nodes and their `charges`.
    pub fn gather(
        &self,
        values: &[[f32; WAVES]],
        charges: &[[f32; WAVES]],
        distances: &[f32],
        limit: f32,
        loads: &mut [[f32; WAVES]],
    ) {
        gather(self, values, charges, distances, limit, loads);
    }
}

/// [`Stencil::gather`], compiled for the processor's vector units.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+avx2+fma", "x86_64+avx2+fma"))]
fn gather(
    stencil: &Stencil,
    values: &[[f32; WAVES]],
    charges: &[[f32; WAVES]],
    distances: &[f32],
    limit: f32,
    loads: &mut [[f32; WAVES]],
) {
    let mut rows = loads.iter_mut().zip(distances);
    for (&(charge, w), (row, distance)) in stencil.far.iter().zip(&mut rows) {
        if distance.abs() < limit {
            *row = charges[charge as usize].map(|c| w as f32 * c);
        }
    }
    let weights = stencil.near_weights.chunks_exact(stencil.order);
    for ((&first, w), (row, distance)) in stencil.near.iter().zip(weights).zip(rows) {
        if distance.abs() < limit {
            let mut sum = [0.0; WAVES];
            for (w, own) in w.iter().zip(&values[first as usize..]) {
                for wave in 0..WAVES {
                    sum[wave] += *w as f32 * own[wave];
                }
            }
            *row = sum;
        }
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
    use crate::base::{Corner, Growth};

    #[test]
    fn logarithms_are_integrated_from_any_target() {
        let axis = Panels::new(vec![0.0, 2.0, 2.5, 2.8, 2.95, 3.0], 5);
        let sources = Sources::new(axis.clone(), axis.order().max(PIECE_NODES));
        let direct = [Image { sign: 1.0, shift: 0.0, weight: 1.0 }];
        let mirrored = [Image { sign: -1.0, shift: 6.0, weight: 1.0 }];
        // int_0^3 -ln|y - s| ds for f = 1.
        let exact = |y: f64, a: f64, b: f64| {
            let part = |d: f64| if d == 0.0 { 0.0 } else { d * (d.abs().ln() - 1.0) };
            -(part(b - y) - part(a - y))
        };
        let values = DMatrix::from_element(1, axis.len(), 1.0);
        let charges: Vec<[f32; WAVES]> =
            sources.charges(&values).iter().map(|v| [*v as f32; WAVES]).collect();
        let values = vec![[1.0; WAVES]; axis.len()];
        for y in [0.0, 0.01, 0.5, 1.0, 2.9, 3.0, 3.1, 7.0] {
            for (images, a, b) in [(&direct, 0.0, 3.0), (&mirrored, 3.0, 6.0)] {
                let stencil = Stencil::new(&sources, images, y, 0.0, 0.01, Peak::Logarithm);
                let mut row = DMatrix::zeros(axis.len(), 1);
                let mut charge_row = vec![0.0; sources.charge_count()];
                let kernel: Vec<f64> = stencil.offsets().iter().map(|u| -u.abs().ln()).collect();
                stencil.add_row(&kernel, &mut charge_row, row.as_mut_slice());
                sources.scatter(&charge_row, &mut row);
                let got = row.sum();
                assert!((got - exact(y, a, b)).abs() < 1e-3, "{y}: {got} {}", exact(y, a, b));
                // Loads beyond the limit keep their previous values.
                let mut loads = vec![[9.0; WAVES]; kernel.len()];
                let mut distances = vec![0.0; kernel.len()];
                distances[0] = 1.0;
                stencil.gather(&values, &charges, &distances, 1.0, &mut loads);
                assert_eq!(loads[0], [9.0; WAVES]);
                stencil.gather(&values, &charges, &distances, 1.1, &mut loads);
                let again: f64 = kernel.iter().zip(loads).map(|(k, l)| k * f64::from(l[0])).sum();
                assert!((again - got).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn loads_that_grow_towards_a_corner_are_integrated_against_logarithms() {
        let corner = Corner { at: 3.0, side: -1.0, growth: Growth::Power(0.4), reach: 1.0 };
        let breaks = vec![0.0, 1.2, 2.0, 2.5, 2.8, 3.0];
        let axis = Panels::new(breaks, 5).with_corners(&[corner]);
        let sources = Sources::new(axis.clone(), axis.order().max(PIECE_NODES));
        let f = |s: f64| if s < 2.0 { 0.0 } else { (3.0 - s).powf(-0.4) };
        let direct = [Image { sign: 1.0, shift: 0.0, weight: 1.0 }];
        for y in [0.5, 1.9, 2.4, 2.7, 2.95, 2.999, 3.0, 3.05, 4.0] {
            let stencil = Stencil::new(&sources, &direct, y, 0.0, 0.01, Peak::Logarithm);
            let mut row = DMatrix::zeros(axis.len(), 1);
            let mut charges = vec![0.0; sources.charge_count()];
            let kernel: Vec<f64> = stencil.offsets().iter().map(|u| -u.abs().ln()).collect();
            stencil.add_row(&kernel, &mut charges, row.as_mut_slice());
            sources.scatter(&charges, &mut row);
            let nodal = axis.nodes().iter().zip(row.iter());
            let got: f64 = nodal.map(|(s, r)| r * f(*s)).sum();
            // s = 3 - v^5 takes the singularity away; pieces end at the target.
            let top: f64 = 1.0;
            let cut = (3.0 - y).max(0.0).powf(0.2).min(top);
            let (nodes, weights) = gauss_legendre(60);
            let mut want = 0.0;
            for [from, to] in [[0.0, cut], [cut, top]] {
                for (t, w) in nodes.iter().zip(&weights) {
                    let t = 0.5 * (1.0 + t);
                    // Crowded at both ends of the piece.
                    let (u, du) = (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t));
                    let v: f64 = from + (to - from) * u;
                    let density = 5.0 * v.powi(2);
                    let log = -(y - 3.0 + v.powi(5)).abs().max(1e-300).ln();
                    want += 0.5 * w * du * (to - from) * density * log;
                }
            }
            assert!((got - want).abs() < 2e-3, "{y}: {got} {want}");
        }
    }

    #[test]
    fn a_few_columns_of_charges_are_added_as_many_are() {
        let sources = Sources::new(Panels::new(vec![0.0, 1.0, 1.5, 1.8], 3), PIECE_NODES);
        let (count, kept) = (sources.charge_count(), 7);
        let charge = |i: usize| ((7 * i + 3) % 11) as f64;
        let scattered = |columns: usize| {
            let charges: Vec<f64> = (0..columns * count).map(charge).collect();
            let mut nodes = DMatrix::from_element(kept, columns, 0.5);
            sources.scatter(&charges, &mut nodes);
            nodes
        };
        let many = scattered(9);
        for node in 0..kept {
            let sum: f64 = (0..count).map(|i| sources.charges[(node, i)] * charge(i)).sum();
            assert!((many[(node, 0)] - 0.5 - sum).abs() < 1e-12);
        }
        for columns in 1..9 {
            assert!((scattered(columns) - many.columns(0, columns)).amax() < 1e-12, "{columns}");
        }
    }
}
