//! How time and memory grow with cells, accuracy, points and cases, with fitted exponents.
//!
//! `cargo bench --bench growth` prints one Markdown table for each; one thread. Takes a minute or
//! two. Memory is the largest number of bytes that were allocated at one time, counted by the
//! allocator; the size of the process would hide it.

use edgeline::base::{Material, Parity};
use edgeline::body::{EdgeModel, Resolution};
use edgeline::case::{Case, Factors};
use edgeline::solve::{Options, Scene, SolvedScene, solve, solve_group};
use edgeline::stress::grid::on_grid;
use edgeline::stress::{BodyKind, Grid};
use std::alloc::{GlobalAlloc, Layout, System};
use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

/// The system's allocator, which also counts what is in use.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator unchanged; only sizes are counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let now = NOW.fetch_add(layout.size(), Relaxed) + layout.size();
        MOST.fetch_max(now, Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Median time (s) of some runs after a first one, and the largest memory of a run (bytes).
fn cost<T>(work: impl Fn() -> T) -> (f64, usize) {
    drop(black_box(work()));
    let before = NOW.load(Relaxed);
    MOST.store(before, Relaxed);
    let mut seconds = Vec::new();
    let began = Instant::now();
    while seconds.len() < 3 || (seconds.len() < 15 && began.elapsed().as_secs_f64() < 0.5) {
        let start = Instant::now();
        let result = black_box(work());
        seconds.push(start.elapsed().as_secs_f64());
        drop(result);
    }
    seconds.sort_by(f64::total_cmp);
    (seconds[seconds.len() / 2], MOST.load(Relaxed) - before)
}

/// One table: sizes, times and memory, and the exponents that fit them best.
struct Growth {
    sizes: Vec<f64>,
    seconds: Vec<f64>,
    bytes: Vec<f64>,
}

impl Growth {
    fn new() -> Self {
        Self { sizes: Vec::new(), seconds: Vec::new(), bytes: Vec::new() }
    }

    fn row(&mut self, label: &str, size: usize, (seconds, bytes): (f64, usize)) {
        println!(
            "| {label} | {size} | {:.3} | {:.2} |",
            1e3 * seconds,
            bytes as f64 / f64::from(1 << 20)
        );
        self.sizes.push(size as f64);
        self.seconds.push(seconds);
        self.bytes.push(bytes as f64);
    }

    fn head(title: &str, label: &str, size: &str) -> Self {
        println!("\n{title}\n\n| {label} | {size} | time (ms) | memory (MiB) |\n|---|---|---|---|");
        Self::new()
    }

    fn end(&self) {
        println!(
            "\ntime grows like size^{:.2}, memory like size^{:.2}",
            exponent(&self.sizes, &self.seconds),
            exponent(&self.sizes, &self.bytes)
        );
    }
}

/// Slope of the least-squares line through the logarithms.
fn exponent(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len() as f64;
    let logs: Vec<(f64, f64)> = x.iter().zip(y).map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mean_x, mean_y) =
        (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum::<f64>()
        / logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum::<f64>()
}

/// A steel roller on a steel block, flush.
fn case(load: f64, slenderness: f64, tolerance: f64) -> Case {
    let steel = Material { young_pa: 210e9, poisson: 0.3 };
    let factors = Factors { load, slenderness, length_ratio: 1.0 };
    Case::from_factors("growth", 10e-3, steel, steel, factors).with_tolerance(tolerance)
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("it is the first pool");
    let model = EdgeModel::QuarterSpace;
    let options = Options::new(model);
    let nodes = |case: &Case| {
        let solved = SolvedScene::new(&Scene::new(case, model, None)).expect("it converges");
        solved.pressure.axis().len() * solved.wavenumbers.coarse().len()
    };

    let title =
        "Cells (nodes along the contact times wavenumbers): longer contacts, tolerance 5e-3";
    let mut growth = Growth::head(title, "S_l", "cells");
    for slenderness in [2.5, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0] {
        let case = case(1e-4, slenderness, 5e-3);
        growth.row(&slenderness.to_string(), nodes(&case), cost(|| solve(&case, &options)));
    }
    growth.end();

    let mut growth = Growth::head("Cells: tighter tolerances, S_l 5", "tolerance", "cells");
    for tolerance in [1e-1, 3e-2, 1e-2, 5e-3, 1e-3, 1e-4] {
        let case = case(1e-4, 5.0, tolerance);
        growth.row(&format!("{tolerance:e}"), nodes(&case), cost(|| solve(&case, &options)));
    }
    growth.end();

    let title = "Cells: every panel halved and every extent doubled, S_l 5, pressure only";
    let mut growth = Growth::head(title, "halved", "cells");
    let scene = Scene::new(&case(1e-4, 5.0, 1e-2), model, None);
    let mut resolution = Resolution::for_tolerance(scene.tolerance);
    for halved in 0..3 {
        let cells = resolution.contact_axis(scene.half_length).len()
            * resolution.wavenumbers(scene.bodies.block.half, Parity::Even).coarse().len();
        let work = || SolvedScene::with_resolution(&scene, &resolution).expect("it converges");
        growth.row(&halved.to_string(), cells, cost(work));
        resolution = resolution.refined();
    }
    growth.end();

    let title = "Points: the field of a body on n x n x n points, S_l 5, tolerance 5e-3";
    let mut growth = Growth::head(title, "n", "points");
    let scene = Scene::new(&case(1e-4, 5.0, 5e-3), model, None);
    let solved = SolvedScene::new(&scene).expect("it converges");
    for n in [4usize, 8, 16, 32, 64] {
        let axis = |most: f64| (0..n).map(|i| most * i as f64 / (n - 1) as f64).collect();
        let grid = Grid { x: axis(2.0), y: axis(5.0), z: axis(3.0) };
        let work = || on_grid(&solved.field(BodyKind::Block), &grid, None);
        growth.row(&n.to_string(), grid.len(), cost(work));
    }
    growth.end();

    for (title, similar) in [
        ("Cases that differ, tolerance 1e-2", false),
        ("Cases that differ in load only, which are one problem, tolerance 1e-2", true),
    ] {
        let mut growth = Growth::head(title, "", "cases");
        for count in [1usize, 4, 16, 64] {
            let cases: Vec<Case> = (0..count)
                .map(|i| {
                    let share = i as f64 / 64.0;
                    let (load, slenderness) = if similar {
                        (1e-4 * 10f64.powf(share), 5.0)
                    } else {
                        (1e-4, 5.0 * 4f64.powf(share))
                    };
                    case(load, slenderness, 1e-2)
                })
                .collect();
            growth.row("", count, cost(|| solve_group(&cases, &options)));
        }
        growth.end();
    }
}
