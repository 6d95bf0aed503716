//! Where the time goes: kernels, compliance, contact, stresses and the complete solve, on one
//! thread.
//!
//! `cargo bench --bench solver`; a part by its name: `cargo bench --bench solver -- complete`.
//! Sizes stand on a logarithmic scale. `docs/performance.md` has the tables.

use criterion::{BenchmarkId, Criterion, Throughput};
use edgeline::base::{Material, Parity};
use edgeline::body::{Body, EdgeModel, Layer, Part, Resolution, Shape};
use edgeline::case::{Case, Factors};
use edgeline::contact::{self, Compliance, ContactSettings, Problem, Rotation, Straight};
use edgeline::kernels::wave::{Direction, Places, WAVES, Wanted, WaveTable};
use edgeline::kernels::{deflection, line_load, love};
use edgeline::solve::{Options, Scene, SolvedScene, solve};
use edgeline::stress::grid::on_grid;
use edgeline::stress::{BodyKind, Grid};
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Duration;

/// The allocator of the program.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Poisson's ratio of steel.
const NU: f64 = 0.3;

/// The tolerance of the measurements (p0).
const TOLERANCE: f64 = 5e-3;

/// A steel roller on a steel block, 10 mm in radius.
fn case(slenderness: f64, length_ratio: f64) -> Case {
    let steel = Material { young_pa: 210e9, poisson: NU };
    let factors = Factors { load: 1e-4, slenderness, length_ratio };
    let case = Case::from_factors("bench", 10e-3, steel, steel, factors);
    case.with_tolerance(TOLERANCE)
}

fn kernels(c: &mut Criterion) {
    let table = WaveTable::new(Direction::Into, NU);
    let mut group = c.benchmark_group("kernels");
    for n in [16usize, 256, 4096] {
        // Distances from a hundredth to ten half-widths, as in a field.
        let places: Vec<f64> = (0..n).map(|i| 0.01 * 1000f64.powf(i as f64 / n as f64)).collect();
        let (seen, loads) = (Places::new(places.clone(), 0.5, false), vec![[1.0; WAVES]; n]);
        group.throughput(Throughput::Elements(n as u64));
        group.bench_with_input(BenchmarkId::new("love_rectangle", n), &places, |b, places| {
            b.iter(|| {
                places.iter().map(|&y| love::stress(0.3, y, 0.5, 0.7, 0.4, NU).yy).sum::<f64>()
            });
        });
        group.bench_with_input(
            BenchmarkId::new("deflection_rectangle", n),
            &places,
            |b, places| {
                b.iter(|| {
                    places.iter().map(|&y| deflection::rectangle(0.3, y, 0.7, 0.4)).sum::<f64>()
                });
            },
        );
        group.bench_with_input(BenchmarkId::new("line_load_exact", n), &places, |b, places| {
            b.iter(|| places.iter().map(|&u| line_load::exact(1.3, NU, u, 0.5).xx).sum::<f64>());
        });
        group.bench_with_input(BenchmarkId::new("line_load_table", n), &places, |b, places| {
            b.iter(|| places.iter().map(|&u| table.line_load(1.3, u, 0.5).xx).sum::<f64>());
        });
        group.throughput(Throughput::Elements((n * WAVES) as u64));
        group.bench_with_input(BenchmarkId::new("line_load_table_sum", n), &seen, |b, seen| {
            b.iter(|| {
                table.sum(&[1.3; WAVES], black_box(seen), f64::INFINITY, &loads, Wanted::PLAIN)
            });
        });
    }
    group.bench_function("line_load_table_build", |b| {
        b.iter(|| WaveTable::new(Direction::Into, black_box(NU)))
    });
    group.finish();
}

/// The block of a scene and its layers, one per wavenumber.
fn layers(scene: &Scene, resolution: &Resolution) -> (Body, Vec<Layer>) {
    let block = &scene.bodies.block;
    let shape = Shape { half: block.half, nu: block.nu };
    let line = resolution.contact_axis(scene.half_length);
    let body = Body::new(&line, shape, scene.end(BodyKind::Block), Part::EVEN, resolution);
    let wavenumbers = resolution.wavenumbers(block.half, Parity::Even);
    let layers = wavenumbers.coarse().nodes().iter().map(|&k| body.layer(k)).collect();
    (body, layers)
}

/// One body's compliance, and the contact of two such bodies.
fn compliance_and_contact(c: &mut Criterion) {
    for slenderness in [2.5, 10.0, 40.0] {
        let scene = Scene::new(&case(slenderness, 1.0), EdgeModel::QuarterSpace, None);
        let resolution = Resolution::for_tolerance(scene.tolerance);
        c.bench_with_input(
            BenchmarkId::new("compliance/flush, S_l", slenderness),
            &scene,
            |b, scene| b.iter(|| layers(scene, &resolution)),
        );
        let (wavenumbers, axis) = (
            resolution.wavenumbers(slenderness, Parity::Even),
            resolution.contact_axis(scene.half_length),
        );
        let (_, layers) = layers(&scene, &resolution);
        let matrices: Vec<_> = layers.into_iter().map(|l| l.compliance).collect();
        let compliance = Compliance { wavenumbers: &wavenumbers, matrices: &matrices };
        let problem = Problem {
            compliance: &compliance,
            axis: &axis,
            both_ends: false,
            gap: &Straight,
            load: 0.5 * PI * axis.end(),
            rotation: Rotation::Held(0.0),
            open: [false; 2],
            recedes: [false; 2],
            turns: [f64::INFINITY; 2],
            guess: None,
        };
        let settings = ContactSettings {
            modes: resolution.modes,
            spacing: resolution.spacing,
            tolerance: 1e-2 * scene.tolerance,
            max_iterations: 40,
            soundness: 1e-2,
        };
        c.bench_function(&format!("contact/flush, S_l/{slenderness}"), |b| {
            b.iter(|| contact::solve(&problem, &settings).expect("it converges"));
        });
    }
    for model in EdgeModel::ALL {
        let scene = Scene::new(&case(5.0, 0.5), model, None);
        let resolution = Resolution::for_tolerance(scene.tolerance);
        c.bench_with_input(
            BenchmarkId::new("compliance/S_l 5, L_r 0.5", model),
            &scene,
            |b, scene| b.iter(|| layers(scene, &resolution)),
        );
    }
}

fn stress(c: &mut Criterion) {
    let scene = Scene::new(&case(5.0, 1.0), EdgeModel::QuarterSpace, None);
    let solved = SolvedScene::new(&scene).expect("it converges");
    let field = solved.field(BodyKind::Block);
    let mut group = c.benchmark_group("stress");
    for n in [1usize, 10, 100, 1000] {
        group.throughput(Throughput::Elements(n as u64));
        let places: Vec<f64> = (0..n).map(|i| 2.0 * (i as f64 + 0.5) / n as f64).collect();
        group.bench_with_input(BenchmarkId::new("across", n), &places, |b, xs| {
            b.iter(|| field.at(4.5, 0.5, xs));
        });
        group.bench_with_input(BenchmarkId::new("down", n), &places, |b, zs| {
            b.iter(|| field.down(&[0.0], 4.5, zs));
        });
    }
    for n in [8usize, 16, 32] {
        group.throughput(Throughput::Elements((n * n * n) as u64));
        let axis = |most: f64| (0..n).map(|i| most * i as f64 / (n - 1) as f64).collect();
        let grid = Grid { x: axis(2.0), y: axis(5.0), z: axis(3.0) };
        group.bench_with_input(BenchmarkId::new("grid", n * n * n), &grid, |b, grid| {
            b.iter(|| on_grid(&field, grid, None));
        });
    }
    group.finish();
}

/// Pressure and all standard curves of both bodies. `cold` also builds the kernels' table, which a
/// process builds once.
fn complete(c: &mut Criterion) {
    let options = Options::new(EdgeModel::QuarterSpace);
    for (slenderness, length_ratio) in [(5.0, 1.0), (5.0, 0.5), (20.0, 1.0), (20.0, 0.5)] {
        let case = case(slenderness, length_ratio);
        let name = format!("S_l {slenderness}, L_r {length_ratio}");
        c.bench_function(&format!("complete/warm/{name}"), |b| {
            b.iter(|| solve(&case, &options).expect("it converges"));
        });
        c.bench_function(&format!("complete/cold/{name}"), |b| {
            b.iter(|| {
                black_box(WaveTable::new(Direction::Into, black_box(NU)));
                solve(&case, &options).expect("it converges")
            });
        });
    }
}

/// The pressure alone of a half-space contact, the problem of general contact codes; within 1 % at
/// this tolerance (tests/numerics/verification.rs).
fn half_space(c: &mut Criterion) {
    let scene = Scene::new(&case(5.0, 1.0).with_tolerance(1e-2), EdgeModel::HalfSpace, None);
    c.bench_function("half-space/pressure, S_l 5", |b| {
        b.iter(|| SolvedScene::new(&scene).expect("it converges"));
    });
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("it is the first pool");
    let mut criterion = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    kernels(&mut criterion);
    compliance_and_contact(&mut criterion);
    stress(&mut criterion);
    complete(&mut criterion);
    half_space(&mut criterion);
    criterion.final_summary();
}
