//! A body as a stack of layers, one per wavenumber, for each part of the load.

use super::axes::Resolution;
use super::end::End;
use super::finite::{Body, Layer, Shape};
use super::fold::Fold;
use crate::base::{Panels, Parity};
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
}

impl Stack {
    /// A body of this `shape` whose middle is at `middle`, with end faces `end`, under loads on
    /// `line`; a `symmetric` line begins at the middle and is one half of the contact; where it
    /// `slides`, the line may carry a traction along x.
    pub fn new(
        line: &Panels,
        (symmetric, slides): (bool, bool),
        (middle, shape): (f64, Shape),
        end: End,
        (resolution, wavenumbers): (&Resolution, &[f64]),
    ) -> Self {
        let fold = Fold::new(line, middle, symmetric);
        let part = |&parity: &Parity| {
            let body = Body::new(fold.axis(), shape, end, (parity, slides), resolution);
            let layers = wavenumbers.par_iter().map(|&k| body.layer(k)).collect();
            (body, layers)
        };
        let parts = fold.parities().iter().map(part).collect();
        Self { middle, fold, parts }
    }

    /// The body for each part of the load, with its layers.
    pub fn parts(&self) -> &[(Body, Vec<Layer>)] {
        &self.parts
    }

    /// What does not depend on the part of the load: half-length, end faces and material.
    pub fn body(&self) -> &Body {
        &self.parts[0].0
    }

    /// Adds `factor` times the compliance at wavenumber number `i` to `total`, over the line's
    /// nodes.
    pub fn add_compliance(&self, i: usize, factor: f64, total: &mut DMatrix<f64>) {
        for (body, layers) in &self.parts {
            self.fold.add(body.parity, &layers[i].compliance, factor, total);
        }
    }

    /// The largest condition number of the layers' equations.
    pub fn condition(&self) -> f64 {
        let layers = self.parts.iter().flat_map(|(_, layers)| layers);
        let worse = |a: f64, b: f64| if b.is_nan() { f64::INFINITY } else { a.max(b) };
        layers.map(|layer| layer.condition).fold(1.0, worse)
    }
}
