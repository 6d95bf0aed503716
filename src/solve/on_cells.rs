//! A scene on uniform cells of constant pressure, whose middle is that of the bodies' overlap.

use super::scene::{Scene, SceneBody, Tilt};
use crate::base::BodyKind;
use crate::cells::{
    CellField, CellPressure, CellProblem, CellTilt, FieldEnd, FreeBody, FreeEnds, Grid, Images,
};
use crate::contact::Shaped;
use std::sync::Arc;

/// Most applications of the compliance.
const MOST_ITERATIONS: usize = 1000;

impl Scene {
    /// The scene's contact on the cells of `grid`, whose half-length is the scene's, to the
    /// relative residual `tolerance`. A tilt that is held is that of far points.
    pub fn on_cells(&self, grid: Grid, tolerance: f64) -> CellProblem {
        let images = BodyKind::ALL.into_iter().filter_map(|kind| {
            let SceneBody { half, middle, share, .. } = self.bodies[kind];
            let middle = self.off_middle(middle);
            let of_weight = |weight| Images { half, middle, weight: share * weight };
            self.end(kind).image_weight.map(of_weight)
        });
        let images = images.collect();
        let even = grid.nx.is_multiple_of(2) && grid.ny.is_multiple_of(2);
        let free = self.free_ends(self.span().symmetric && even);
        let tilt = match self.tilt {
            Tilt::Held(tilt) => CellTilt::Held(tilt),
            Tilt::Free(arm) => CellTilt::Free(self.off_middle(arm)),
        };
        let (load, most_iterations) = (self.load, MOST_ITERATIONS);
        CellProblem { grid, images, free, load, tilt, tolerance, most_iterations }
    }

    /// What free end faces add to cells and their images, under pressures that are even in x and y
    /// if they are `symmetric`; none where no end face is free of traction.
    pub(super) fn free_ends(&self, symmetric: bool) -> Option<Arc<FreeEnds>> {
        let freed = BodyKind::ALL.into_iter().filter(|kind| self.end(*kind).freed);
        let free: Vec<FreeBody> = freed.map(|kind| self.free_body(kind)).collect();
        let ends = || {
            let (gap, exponents) = (self.gap_on_cells(), self.end_exponents());
            FreeEnds::new(self.half_length, &free, symmetric, exponents, &gap.generatrix())
        };
        (!free.is_empty()).then(|| Arc::new(ends()))
    }

    /// The exponents m of the pressure s^-m at the overlap's ends, zero where it is finite.
    pub(super) fn end_exponents(&self) -> [f64; 2] {
        self.corner_exponents().map(|exponent| exponent.unwrap_or(0.0))
    }

    /// The smooth gap over cells, counted from the overlap's middle.
    pub(super) fn gap_on_cells(&self) -> Shaped {
        self.gap().counted_from(self.middle)
    }

    /// A place along the contact, counted from the overlap's middle.
    pub(super) fn off_middle(&self, y: f64) -> f64 {
        y - self.middle
    }

    /// The stresses of a body under the pressures of cells; none where its ends are free of
    /// traction, which takes more than Love's sums.
    pub fn cell_field(&self, kind: BodyKind, pressure: &CellPressure) -> Option<CellField> {
        (!self.end(kind).freed).then(|| self.mirrored_field(kind, pressure))
    }

    /// The stresses of a body under the pressures of cells and their images.
    pub(super) fn mirrored_field(&self, kind: BodyKind, pressure: &CellPressure) -> CellField {
        CellField::new(pressure, self.field_end(kind), self.bodies[kind].nu)
    }

    /// What the end faces of a body do to the stresses of cells and images.
    pub(super) fn field_end(&self, kind: BodyKind) -> FieldEnd {
        let (body, end) = (&self.bodies[kind], self.end(kind));
        FieldEnd {
            half: body.half,
            middle: self.off_middle(body.middle),
            mirrored: end.image_weight.is_some(),
            gamma: end.gamma,
        }
    }

    /// A body as those with free ends are described.
    pub(super) fn free_body(&self, kind: BodyKind) -> FreeBody {
        let SceneBody { half, middle, nu, share, .. } = self.bodies[kind];
        let (curvature, felt) = (self.curvatures[kind], self.felt[kind]);
        FreeBody { half, middle: self.off_middle(middle), nu, share, curvature, felt }
    }
}
