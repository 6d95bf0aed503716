//! From values at an axis's nodes to an integral against a kernel that peaks at a target.

use crate::base::{Panels, gauss_legendre};

/// A copy of the axis: the point s of the axis acts at `sign` s + `shift`, `weight` times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image {
    pub sign: f64,
    pub shift: f64,
    pub weight: f64,
}

/// Quadrature of sum over images of int kernel(target - s', depth) f(s) ds, with f given at the
/// nodes of an axis. Panels that the target is near are cut into pieces no longer than their
/// distance from it, with f interpolated: the kernels' peaks (ln r, or a spread of the width of the
/// depth) are then resolved, wherever the target lies.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    /// Panels far enough for their own nodes: offset target - source, node, weight.
    far: Vec<(f64, usize, f64)>,
    /// Points inside near panels: offset, the panel's first node.
    near: Vec<(f64, usize)>,
    /// Weights of the near points on their panel's nodes, `order` a point.
    near_weights: Vec<f64>,
    order: usize,
}

/// For a target on the axis's line pieces are not cut below this part of their panel: what an
/// integrable singularity of ln r leaves in such a piece is below 1e-4 of the panel's own share.
/// Off the line the depth bounds the pieces by itself.
const SMALLEST_PIECE: f64 = 1.0 / 512.0;

impl Stencil {
    /// Stencil for a `target` coordinate on the axis's line, at `depth` >= 0 from it.
    pub fn new(axis: &Panels, images: &[Image], target: f64, depth: f64) -> Self {
        let order = axis.order();
        let mut stencil = Self { order, ..Self::default() };
        let piece_rule = gauss_legendre(order.max(4));
        let mut basis = vec![0.0; order];
        for image in images {
            // The target seen from the axis's own coordinate.
            let own = image.sign * (target - image.shift);
            for panel in 0..axis.panel_count() {
                let [a, b] = axis.panel(panel);
                let first = panel * order;
                if distance(a, b, own, depth) >= b - a {
                    for node in first..first + order {
                        let offset = image.sign * (own - axis.nodes()[node]);
                        stencil.far.push((offset, node, image.weight * axis.weights()[node]));
                    }
                    continue;
                }
                let smallest = if depth > 0.0 { 0.0 } else { SMALLEST_PIECE * (b - a) };
                let mut pieces = vec![[a, b]];
                // Cut at the target first, so that pieces end there.
                if a < own && own < b {
                    pieces = vec![[a, own], [own, b]];
                }
                while let Some([c, d]) = pieces.pop() {
                    let length = d - c;
                    let far = distance(c, d, own, depth) >= length;
                    if !far && length > smallest {
                        let mid = 0.5 * (c + d);
                        pieces.extend([[c, mid], [mid, d]]);
                        continue;
                    }
                    for (t, w) in piece_rule.0.iter().zip(&piece_rule.1) {
                        let s = 0.5 * (c + d + length * t);
                        axis.basis(panel, s, &mut basis);
                        stencil.near.push((image.sign * (own - s), first));
                        let weight = image.weight * 0.5 * length * w;
                        stencil.near_weights.extend(basis.iter().map(|b| weight * b));
                    }
                }
            }
        }
        stencil
    }

    /// Adds `kernel(offset)` times the weights to `row`, one entry a node. Offsets beyond `reach`
    /// are skipped: the kernel has faded there.
    pub fn add_row(&self, reach: f64, mut kernel: impl FnMut(f64) -> f64, row: &mut [f64]) {
        for &(u, node, w) in &self.far {
            if u.abs() < reach && node < row.len() {
                row[node] += w * kernel(u);
            }
        }
        for (&(u, first), w) in self.near.iter().zip(self.near_weights.chunks_exact(self.order)) {
            if u.abs() < reach && first < row.len() {
                let value = kernel(u);
                for (r, w) in row[first..first + self.order].iter_mut().zip(w) {
                    *r += w * value;
                }
            }
        }
    }

    /// Calls `act(offset, weighted value)` for every source point, with `values` at the nodes
    /// (a shorter list stands for zeros behind it).
    pub fn for_each(&self, reach: f64, values: &[f64], mut act: impl FnMut(f64, f64)) {
        for &(u, node, w) in &self.far {
            if u.abs() < reach && node < values.len() {
                act(u, w * values[node]);
            }
        }
        for (&(u, first), w) in self.near.iter().zip(self.near_weights.chunks_exact(self.order)) {
            if u.abs() < reach && first < values.len() {
                let local = &values[first..first + self.order];
                act(u, w.iter().zip(local).map(|(w, v)| w * v).sum());
            }
        }
    }

    /// Number of kernel evaluations that a full use takes.
    pub fn len(&self) -> usize {
        self.far.len() + self.near.len()
    }
}

/// Distance of the point (`own`, `depth`) from the segment [a, b].
fn distance(a: f64, b: f64, own: f64, depth: f64) -> f64 {
    let along = (a - own).max(own - b).max(0.0);
    along.hypot(depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_integrated_from_any_target() {
        let axis = Panels::new(vec![0.0, 0.5, 1.5, 3.0], 4);
        let direct = [Image { sign: 1.0, shift: 0.0, weight: 1.0 }];
        let mirrored = [Image { sign: -1.0, shift: 6.0, weight: 1.0 }];
        // int_0^3 -ln|y - s| ds for f = 1.
        let exact = |y: f64, a: f64, b: f64| {
            let part = |d: f64| if d == 0.0 { 0.0 } else { d * (d.abs().ln() - 1.0) };
            -(part(b - y) - part(a - y))
        };
        for y in [0.0, 0.01, 0.5, 1.0, 2.9, 3.0, 3.1] {
            for (images, a, b) in [(&direct, 0.0, 3.0), (&mirrored, 3.0, 6.0)] {
                let stencil = Stencil::new(&axis, images, y, 0.0);
                let mut row = vec![0.0; axis.len()];
                stencil.add_row(f64::INFINITY, |u| -u.abs().ln(), &mut row);
                let got: f64 = row.iter().sum();
                assert!((got - exact(y, a, b)).abs() < 1e-3, "{y}: {got} {}", exact(y, a, b));
                let mut sum = 0.0;
                stencil.for_each(f64::INFINITY, &vec![1.0; axis.len()], |u, w| {
                    sum -= w * u.abs().ln()
                });
                assert!((sum - got).abs() < 1e-12);
            }
        }
    }
}
