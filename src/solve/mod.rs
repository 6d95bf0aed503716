//! From a case and an edge model to a solved case, its solution, and the main results of many
//! cases.

mod approached;
mod cell_case;
mod cell_contact;
mod cell_deep;
mod cell_layers;
mod cell_stress;
mod cells;
mod deep;
pub mod edge;
mod end_search;
mod extent;
mod first_guess;
mod grid;
mod group;
mod key_results;
mod laminae;
mod lines;
mod on_cells;
mod options;
mod passage;
#[cfg(feature = "cli")]
mod peak;
mod scene;
mod shaping;
mod solved;
mod solved_scene;
mod stiffness;
mod summary;
mod trial;

#[cfg(test)]
mod tests;

pub use cell_case::{
    CellDetails, CellOptions, CellSolution, LoadStep, MOST_CELLS, check_cells, loads_on_cells,
    solve_on_cells, stress_on_cells,
};
pub use cell_layers::{CellLayer, check_layers, layers_on_cells};
pub use cell_stress::PEAK_CURVE;
pub use cells::PressureCell;
pub use extent::{Extent, Outside, check_points};
pub use grid::{MOST_GRID_POINTS, check_grid};
pub use group::{solve, solve_group};
pub use key_results::{END_DISTANCES, KeyResults, KeySolution};
pub use laminae::{Lamina, laminae};
pub use lines::Stresses;
pub use options::{Options, Point};
pub use passage::Passage;
#[cfg(feature = "cli")]
pub use peak::peak;
pub use scene::{Scene, SceneBody, SceneKey, Tilt};
pub use solved::{Solution, SolvedCase};
pub use solved_scene::{Seconds, SolvedScene};
pub use stiffness::stiffness;
pub use summary::{Avoided, CriticalSummary, Details, Measure, Stiffness, Summary, WorkSummary};
