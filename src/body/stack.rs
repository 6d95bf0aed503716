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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::EdgeModel;

    /// Whatever the ends of a line are, flush or not, on either side of a body's middle: the
    /// compliance of the mirror image of a line is the mirror image of the line's.
    #[test]
    fn compliances_of_mirror_images_are_mirror_images() {
        let resolution = Resolution::for_tolerance(3e-2);
        let wavenumbers = [0.02, 0.3, 2.0, 20.0];
        for (middle, half) in [(0.0, 5.0), (-1.7, 4.9), (-4.3988041801, 9.2915775857), (1.2, 11.0)] {
            for ends in [[-3.0, 2.0], [-0.8, 3.2 - 1e-9], [middle - half, middle + half], [middle - half, middle + 0.3]] {
                if ends[0] < middle - half || ends[1] > middle + half { continue; }
                for (model, nu) in [(EdgeModel::QuarterSpace, 0.1), (EdgeModel::HalfSpace, 0.1)] {
                    let matrices = [1.0, -1.0].map(|side| {
                        let own = if side > 0.0 { ends } else { [-ends[1], -ends[0]] };
                        let (line, _) = resolution.contact_line(own, [None; 2], &[], false);
                        let end = model.end(nu, None);
                        let shape = Shape { half, nu };
                        let stack = Stack::new(&line, (false, false), (side * middle, shape), end, (&resolution, &wavenumbers));
                        (0..wavenumbers.len()).map(|i| {
                            let mut total = DMatrix::zeros(line.len(), line.len());
                            stack.add_compliance(i, 1.0, &mut total);
                            total
                        }).collect::<Vec<_>>()
                    });
                    for (i, k) in wavenumbers.iter().enumerate() {
                        let (a, b) = (&matrices[0][i], &matrices[1][i]);
                        let n = a.nrows();
                        let turned = DMatrix::from_fn(n, n, |r, c| b[(n - 1 - r, n - 1 - c)]);
                        let off = (a - &turned).amax() / a.amax();
                        let worst = (0..n).max_by(|r, s| (a[(*r, *r)] - turned[(*r, *r)]).abs().total_cmp(&(a[(*s, *s)] - turned[(*s, *s)]).abs())).unwrap();
                        println!("{middle} {half} {ends:?} {model} k {k}: {off:.1e} at {worst} of {n}");
                    }
                }
            }
        }
    }
}
