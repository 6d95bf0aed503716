//! A scene on uniform cells of constant pressure.

use super::scene::{Scene, SceneBody};
use crate::base::BodyKind;
use crate::cells::{
    CellField, CellPressure, CellProblem, FieldEnd, FreeBody, FreeEnds, Grid, Images,
};
use std::sync::Arc;

/// Most applications of the compliance.
const MOST_ITERATIONS: usize = 1000;

impl Scene {
    /// The scene's contact on the cells of `grid`, whose half-length is the scene's, to the
    /// relative residual `tolerance`.
    pub fn on_cells(&self, grid: Grid, tolerance: f64) -> CellProblem {
        let (mut images, mut free) = (Vec::new(), Vec::new());
        for kind in BodyKind::ALL {
            let (&SceneBody { half, nu, share, .. }, end) = (&self.bodies[kind], self.end(kind));
            images.extend(end.image_weight.map(|weight| Images { half, weight: share * weight }));
            free.extend(end.freed.then_some(FreeBody { half, nu, share }));
        }
        let load = self.load;
        let free = (!free.is_empty()).then(|| Arc::new(FreeEnds::new(self.half_length, &free)));
        CellProblem { grid, images, free, load, tolerance, most_iterations: MOST_ITERATIONS }
    }

    /// The stresses of a body under the pressures of cells; none where its ends are free of
    /// traction, which takes more than Love's sums.
    pub fn cell_field(&self, kind: BodyKind, pressure: &CellPressure) -> Option<CellField> {
        let (body, end) = (&self.bodies[kind], self.end(kind));
        let ends =
            FieldEnd { half: body.half, mirrored: end.image_weight.is_some(), gamma: end.gamma };
        (!end.freed).then(|| CellField::new(pressure, ends, body.nu))
    }
}
