//! A body as a stack of layers, one per wavenumber, for each part of the load.

use super::axes::{BENDS, Resolution};
use super::end::End;
use super::finite::{Body, Layer, Shape};
use super::fold::Fold;
use super::long_waves::LongWaves;
use super::part::Part;
use crate::base::{Panels, Parity, worse};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// A body under loads on a contact line that may lie beside its middle: the body at all
/// wavenumbers, for the even part of the load and, unless line and body are symmetric, for the odd
/// one.
#[derive(Debug)]
pub struct Stack {
    /// Place of the body's middle (C).
    pub middle: f64,
    /// The contact line from the body's middle.
    pub fold: Fold,
    parts: Vec<(Body, Vec<Layer>)>,
    /// The coarse wavenumbers of the layers.
    nodes: Vec<f64>,
    /// Those of the first panel, where they are not the ones of both bodies.
    long: Option<LongWaves>,
}

/// The contact line that loads a body.
#[derive(Debug, Clone, Copy)]
pub struct LoadedLine<'a> {
    /// Its nodes along y (C).
    pub axis: &'a Panels,
    /// Whether it begins at the middle of the body, and is one half of the contact.
    pub symmetric: bool,
    /// Whether it may carry a traction along x.
    pub slides: bool,
}

/// A body beside others.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// Place y of its middle (C).
    pub middle: f64,
    /// Its shape and material.
    pub shape: Shape,
    /// Its end faces.
    pub end: End,
}

impl Stack {
    /// A body under loads on `line`, at a `resolution`. Its layers are those of the `coarse`
    /// wavenumbers.
    pub fn new(line: LoadedLine, body: Placed, resolution: &Resolution, coarse: &Panels) -> Self {
        let LoadedLine { axis, symmetric, slides } = line;
        let Placed { middle, shape, end } = body;
        let fold = Fold::new(axis, middle, symmetric);
        let bends = end.freed && fold.parities().contains(&Parity::Odd);
        let long = if bends { LongWaves::new(coarse, shape.half) } else { None };
        let mut nodes = coarse.nodes().to_vec();
        if let Some(long) = &long {
            nodes[..long.nodes().len()].copy_from_slice(long.nodes());
        }
        let part = |&parity: &Parity| {
            let part = Part { parity, bends, slides };
            let body = Body::new(fold.axis(), shape, end, part, resolution);
            let layers = nodes.par_iter().map(|&k| body.layer(k)).collect();
            (body, layers)
        };
        let parts = fold.parities().iter().map(part).collect();
        Self { middle, fold, parts, nodes, long }
    }

    /// The body for each part of the load, with its layers.
    pub fn parts(&self) -> &[(Body, Vec<Layer>)] {
        &self.parts
    }

    /// What does not depend on the part of the load: half-length, end faces and material.
    pub fn body(&self) -> &Body {
        &self.parts[0].0
    }

    /// The wavenumbers of the layers.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// What belongs to the coarse wavenumbers of both bodies, in rows, for those of the layers.
    pub fn for_layers(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        self.long.as_ref().map_or_else(|| rows.clone(), |long| long.of_common(rows))
    }

    /// An interpolation from the coarse wavenumbers of both bodies, the first one and the weights,
    /// from those of the layers.
    pub fn interpolation(&self, common: (usize, &[f64])) -> (usize, Vec<f64>) {
        match &self.long {
            Some(long) => long.interpolation(common),
            None => (common.0, common.1.to_vec()),
        }
    }

    /// Shares of the layers in the loads of `body` at the wavenumbers `k`, each the first layer and
    /// the shares, as they grow under long waves; none where they are as given.
    pub(crate) fn grown<S: AsRef<[f64]>>(
        &self,
        body: &Body,
        k: &[f64],
        shares: &[(usize, S)],
    ) -> Option<Vec<(usize, Vec<f64>)>> {
        if self.long.is_none() || !bends(body) {
            return None;
        }
        let of_wave = |(k, (first, shares)): (&f64, &(usize, S))| {
            let grows = k * body.half < BENDS;
            let grown = |(node, share): (&f64, &f64)| if grows { share * node / k } else { *share };
            (*first, self.nodes[*first..].iter().zip(shares.as_ref()).map(grown).collect())
        };
        Some(k.iter().zip(shares).map(of_wave).collect())
    }

    /// Adds `factor` times the compliance at coarse wavenumber number `i` of both bodies to
    /// `total`, over the line's nodes.
    pub fn add_compliance(&self, i: usize, factor: f64, total: &mut DMatrix<f64>) {
        for (body, layers) in &self.parts {
            let mut add = |layer: &Layer, share: f64| {
                self.fold.add(body.parity, &layer.compliance, factor * share, total);
            };
            match &self.long {
                Some(long) if i < long.nodes().len() => {
                    for (j, layer) in layers[..long.nodes().len()].iter().enumerate() {
                        add(layer, long.displacement(i, j, bends(body)));
                    }
                }
                _ => add(&layers[i], 1.0),
            }
        }
    }

    /// The largest condition number of the layers' equations.
    pub fn condition(&self) -> f64 {
        let layers = self.parts.iter().flat_map(|(_, layers)| layers);
        layers.map(|layer| layer.condition).fold(1.0, worse)
    }
}

/// Whether the loads on a body bend it as a plate.
fn bends(body: &Body) -> bool {
    body.end.freed && body.parity == Parity::Odd
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::EdgeModel;

    /// The compliance of the mirror image of a line is the mirror image of the line's, whatever its
    /// ends are, on either side of a body's middle, flush or not.
    #[test]
    fn compliances_of_mirror_images_are_mirror_images() {
        let resolution = Resolution::for_tolerance(3e-2);
        let coarse = Panels::new(vec![0.0, 0.05, 0.5, 2.0, 20.0], 2);
        let flush = |middle: f64, half: f64| [middle - half, middle + half];
        for (middle, half, ends, exponents) in [
            (0.0, 5.0, [-3.0, 2.0], [Some(0.2); 2]),
            (0.0, 5.0, flush(0.0, 5.0), [None; 2]),
            (-1.7, 4.9, flush(-1.7, 4.9), [None; 2]),
            (-1.7, 4.9, [-0.8, 3.2 - 1e-9], [Some(0.2), None]),
            (1.2, 11.0, [-9.8, 1.5], [None, Some(0.3)]),
            (1.2, 11.0, [-3.0, 5.0], [Some(0.3), Some(0.1)]),
        ] {
            for model in EdgeModel::ALL {
                let total = |side: f64| {
                    let (mut ends, mut exponents) = (ends.map(|y| side * y), exponents);
                    if side < 0.0 {
                        ends.reverse();
                        exponents.reverse();
                    }
                    let (line, _) = resolution.contact_line(ends, exponents, &[], false);
                    let line = LoadedLine { axis: &line, symmetric: false, slides: false };
                    let (shape, end) = (Shape { half, nu: 0.1 }, model.end(0.1, None));
                    let placed = Placed { middle: side * middle, shape, end };
                    let stack = Stack::new(line, placed, &resolution, &coarse);
                    let mut total = DMatrix::zeros(line.axis.len(), line.axis.len());
                    for i in 0..coarse.len() {
                        stack.add_compliance(i, coarse.nodes()[i], &mut total);
                    }
                    total
                };
                let (own, other) = (total(1.0), total(-1.0));
                let n = own.nrows();
                let turned = DMatrix::from_fn(n, n, |i, j| other[(n - 1 - i, n - 1 - j)]);
                let off = (&own - turned).amax() / own.amax();
                assert!(off < 1e-9, "{middle} {half} {ends:?} {model}: {off:e}");
            }
        }
    }
}
