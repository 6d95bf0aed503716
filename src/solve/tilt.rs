//! The tilt of the bodies, of lines at a depth below their surfaces.

use super::scene::Scene;
use crate::base::{BodyKind, Panels, StressTensor};
use crate::body::{EdgeModel, Shape};
use crate::contact::Gap;
use crate::stress::Field;
use std::f64::consts::PI;

/// Stresses of a body below (0, y), at each of some depths.
pub(super) type Below<'a> = dyn Fn(BodyKind, f64, &[f64]) -> Vec<StressTensor> + 'a;

/// What a tilt needs to know of the contact.
pub(super) struct Touch {
    /// Ends along y (C) of the line on which the gap is closed.
    pub ends: [f64; 2],
    /// The load's moment about y = 0 (C^3 p0).
    pub moment: f64,
}

/// [`tilt`] from the fields of the block and of the roller.
pub(super) fn of_fields(scene: &Scene, fields: [&Field; 2], touch: &Touch, depth: f64) -> f64 {
    let below = |kind: BodyKind, y: f64, zs: &[f64]| {
        let [block, roller] = fields;
        let field = if kind == BodyKind::Block { block } else { roller };
        field.down(&[0.0], y, zs).iter().map(|row| row[0].pressure).collect()
    };
    tilt(scene, &below, touch, depth)
}

/// Places along the contact.
const PLACES: usize = 6;

/// End of the first panel of the depths (C), and their nodes.
const FIRST: f64 = 0.25;
const ORDER: usize = 4;

/// Depth, in half-lengths of a body with free ends, from which on it bends as a plate. Stresses farther down are those of
/// waves so long that the equations of the faces are close to singular.
const AS_PLATE: f64 = 8.0;

/// The tilt of the lines x = 0 at `depth` below both surfaces, in units of C / (2 R), by least squares over
/// the line where they touch, from the stresses `below` it.
///
/// Where the bodies touch they have closed the gap. What the line approaches beyond that is the
/// shortening of both bodies above it, the integral of the strain (sigma_zz - nu (sigma_xx +
/// sigma_yy)) / E. No reference far away is needed, on which the tilt would depend. Deep below, a body between two free faces
/// is Kirchhoff's plate, loaded on its edge by the moment about its own middle: between two depths its
/// lines tilt by the logarithm of their ratio ([`Shape::turned`] over the wavenumbers across the contact).
pub(super) fn tilt(scene: &Scene, below: &Below, touch: &Touch, depth: f64) -> f64 {
    let Touch { ends, moment } = *touch;
    let gap = scene.gap();
    let along = Panels::new(ends.to_vec(), PLACES);
    let reach = |kind: BodyKind| match scene.model {
        EdgeModel::QuarterSpace => depth.min(AS_PLATE * scene.bodies[kind].half),
        _ => depth,
    };
    let columns = BodyKind::ALL.map(|kind| (kind, column(reach(kind))));
    let closed = |y: f64| -> f64 {
        let shortened = columns.iter().map(|(kind, down)| {
            let body = &scene.bodies[*kind];
            let column = below(*kind, y, down.nodes());
            let strains = column.iter().zip(down.weights());
            let strains = strains.map(|(s, weight)| weight * (body.nu * (s.xx + s.yy) - s.zz));
            // 1 / E in units of 1 / E*.
            strains.sum::<f64>() * body.share / (1.0 - body.nu * body.nu)
        });
        gap.at(0.0, y) + shortened.sum::<f64>()
    };
    let values: Vec<f64> = along.nodes().iter().map(|y| closed(*y)).collect();
    let middle = 0.5 * (ends[0] + ends[1]);
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        let all = along.nodes().iter().zip(along.weights()).zip(&values);
        all.map(|((y, w), value)| w * of(y - middle, *value)).sum()
    };
    let bent = BodyKind::ALL.map(|kind| {
        let body = &scene.bodies[kind];
        let turned = Shape { half: body.half, nu: body.nu }.turned() / (PI * PI);
        let own = moment - body.middle * scene.load;
        body.share * turned * own * (depth / reach(kind)).ln()
    });
    sum(&|u, value| u * value) / sum(&|u, _| u * u) + bent.iter().sum::<f64>()
}

/// The rule of a column of a body down to a depth.
fn column(depth: f64) -> Panels {
    let mut breaks = vec![0.0];
    let mut next = FIRST;
    while 1.5 * next < depth {
        breaks.push(next);
        next *= 2.0;
    }
    breaks.push(depth);
    Panels::new(breaks, ORDER)
}
