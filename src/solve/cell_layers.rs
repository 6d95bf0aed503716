//! Stresses at layers of depth under all cells.

use super::extent::Extent;
use super::options::Options;
use super::scene::Scene;
use crate::base::{BodyKind, Result};
use crate::case::Case;
use crate::cells::{CellPressure, EndLoads, Layer, add_ends, layer};
use crate::host::check_memory;

/// Arrays of a layer's size that it takes: kernels and transforms of six components, and those of
/// all layers.
const WORK: f64 = 60.0;

/// The stresses of one body at one depth.
#[derive(Debug, Clone, PartialEq)]
pub struct CellLayer {
    /// The body.
    pub body: BodyKind,
    /// Depth (m).
    pub depth_m: f64,
    /// Stresses of the flat body (p0) under each cell.
    pub stress: Layer,
}

/// Refuses depths that no body of `options` has, and layers that do not fit into memory.
///
/// # Errors
/// [`crate::base::Error::Value`], [`crate::base::Error::Memory`].
pub fn check_layers(case: &Case, options: &Options, depths_m: &[f64], cells: usize) -> Result<()> {
    for body in &options.bodies {
        for (i, depth_m) in depths_m.iter().enumerate() {
            let inside = Extent::of(case, *body).check_axis(2, *depth_m);
            inside.map_err(|outside| outside.refused(format!("depth of layer {}", i + 1)))?;
        }
    }
    if depths_m.is_empty() {
        return Ok(());
    }
    let kept = 6.0 * (depths_m.len() * options.bodies.len()) as f64;
    let what = format!("{} layers of {cells} cells", depths_m.len());
    check_memory(&what, 8.0 * cells as f64 * (WORK + 2.0 * kept), "ask for fewer layers or cells")
}

/// The stresses of the bodies of `options` at depths (m) under the `pressure` that
/// [`super::solve_on_cells`] found for `case`, without what a round surface adds.
///
/// # Errors
/// As [`check_layers`].
pub fn layers_on_cells(
    case: &Case,
    options: &Options,
    pressure: &CellPressure,
    depths_m: &[f64],
) -> Result<Vec<CellLayer>> {
    let grid = &pressure.grid;
    check_layers(case, options, depths_m, grid.len())?;
    let scene = Scene::new(case, options.method, options.psi);
    // Ends for any pressure, whatever symmetry the scene has.
    let free = scene.free_ends(false);
    let loads = free.as_ref().map(|free| (free.axis(), EndLoads::new(free, pressure)));
    let c_m = case.hertz().c_m;
    let mut layers = Vec::new();
    for &body in &options.bodies {
        let end = scene.field_end(body);
        let ends = loads
            .as_ref()
            .map(|(axis, loads)| (*axis, loads.stress(&scene.free_body(body), scene.tolerance)));
        for &depth_m in depths_m {
            let z = depth_m / c_m;
            let mut stress = layer(pressure, end, scene.bodies[body].nu, z);
            if let Some((axis, ends)) = &ends {
                add_ends(&mut stress, grid, axis, ends, z);
            }
            layers.push(CellLayer { body, depth_m, stress });
        }
    }
    Ok(layers)
}
