//! Whether the tolerance keeps its promise, and at what price: the largest error of the pressure and of every
//! stress on the standard curves, against a resolution far finer, in tolerances.
//!
//! `cargo bench --bench promise -- hold [SCENES]` measures scenes that no search has seen, at every decade;
//! `-- search KIND TOLERANCE [STEPS]` looks for the cheapest resolution (KIND: endless, finite, singular) that
//! keeps the promise on scenes of its own, by small random steps from the present one. The table in
//! `src/body/axes.rs` is made from what it prints.
//!
//! Left out: 0.1 C around a singular corner, 0.03 C around the contact's edge on the surface, where the tangent
//! of the pressure is vertical, and the same around a flush end.

use edgeline::base::{BodyKind, PerBody, StressTensor};
use edgeline::body::{EdgeModel, Resolution};
use edgeline::solve::{Scene, SceneBody, SolvedScene};
use edgeline::stress::curves::curves_on;
use edgeline::stress::{CurveSpec, away_from_edge};
use std::process::ExitCode;

/// Left out around a singular corner, and around the edge of the contact on the surface (C).
const CORNER: f64 = 0.1;
const RIM: f64 = 0.03;

/// What the finest resolution is made of.
const LIMIT: Resolution = Resolution {
    order: 8,
    corner: 1e-3,
    corner_ratio: 2.3,
    ratio: 1.9,
    modes: 8,
    spacing: 0.02,
    k_max: 500.0,
    k_order: 6,
    k_step: 3.0,
    k_min: 0.004,
    k_ratio: 2.0,
    images: 2,
    face_reach: 20.0,
    reach: 20.0,
};

/// The same of half-spaces: smaller panels at their ends, where the pressure is known but for a polynomial, add noise.
const ENDLESS_LIMIT: Resolution = Resolution { corner: 5e-3, ..LIMIT };

/// The tolerances that are held.
const TOLERANCES: [f64; 6] = [1e-1, 3e-2, 1e-2, 5e-3, 1e-3, 1e-4];

/// Part of the tolerance that a search leaves to scenes that it has not seen.
const RESERVE: f64 = 0.8;

/// What a scene's ends are to a resolution.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Endless,
    Finite,
    Singular,
}

/// The `index`-th scene of Kronecker's sequence over the box of the promise: S_l 2 to 100, L_r 1 or 0.1 to 0.98,
/// Poisson's ratios up to 0.45, moduli that differ by up to 3.
fn scene(kind: Kind, index: usize) -> Scene {
    let u: [f64; 5] = kronecker(index);
    let log = |u: f64, low: f64, high: f64| low * (high / low).powf(u);
    let slenderness = log(u[0], 2.0, 100.0);
    let nu = [0.45 * u[1], 0.45 * u[2]];
    let moduli = log(u[3], 1.0 / 3.0, 3.0);
    let soft = [(1.0 - nu[0] * nu[0]) / moduli, 1.0 - nu[1] * nu[1]];
    let share = soft.map(|s| s / (soft[0] + soft[1]));
    let length_ratio = if kind == Kind::Finite { 1.0 } else { log(u[4], 0.1, 0.98) };
    let model = if kind == Kind::Endless { EdgeModel::HalfSpace } else { EdgeModel::QuarterSpace };
    let bodies = PerBody {
        block: SceneBody::straight(slenderness / length_ratio, nu[0], share[0]),
        roller: SceneBody::straight(slenderness, nu[1], share[1]),
    };
    Scene::symmetric(bodies, model, 1e-3)
}

impl Kind {
    /// The resolution that scenes of the kind are compared with.
    fn limit(self) -> &'static Resolution {
        if self == Self::Endless { &ENDLESS_LIMIT } else { &LIMIT }
    }
}

/// Depth (C) from which the approach is counted, and what its relative error counts.
const DEEP: f64 = 30.0;
const APPROACH: f64 = 2.0;

/// Columns of points inside each body, off its planes of symmetry, up to this distance (C) beyond the contact's end.
const COLUMNS: usize = 6;
const DEPTHS: usize = 5;
const BEYOND: f64 = 3.0;

/// The `index`-th point of Kronecker's sequence.
fn kronecker<const N: usize>(index: usize) -> [f64; N] {
    let mut root = 1.5f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (N + 1) as f64);
    }
    std::array::from_fn(|d| (0.5 + (index + 1) as f64 * root.powi(-(d as i32 + 1))).fract())
}

/// A scene's values: the pressure on its three lines, the approach, and the stresses on both bodies' curves and inside them.
struct Values {
    pressure: Vec<f64>,
    approach: f64,
    stress: Vec<Vec<StressTensor>>,
    inside: Vec<Vec<StressTensor>>,
}

/// Where a scene's values are compared.
struct Places {
    line: Vec<[f64; 2]>,
    curves: Vec<CurveSpec>,
    /// Columns of points off the planes of symmetry.
    inside: Vec<CurveSpec>,
}

impl Places {
    fn new(scene: &Scene) -> Self {
        let length = scene.half_length;
        let line = (0..=60).flat_map(|i| {
            let s = RIM * (length / RIM).powf(f64::from(i) / 60.0);
            [0.0, 0.4, 0.8].map(|x| [x, length - s])
        });
        let curves = BodyKind::ALL
            .into_iter()
            .flat_map(|kind| curves_on(kind, &scene.span(), scene.bodies[kind].ends()));
        let inside = BodyKind::ALL.into_iter().flat_map(|kind| {
            let far = scene.bodies[kind].half.min(length + BEYOND);
            let columns = (0..COLUMNS).map(move |i| {
                let u: [f64; 3] = kronecker(i + COLUMNS * kind as usize);
                // Every other column is near the end.
                let y = if i % 2 == 0 { far * u[0] } else { (length + 2.0 * u[0] - 1.0).min(far) };
                let points = (0..DEPTHS).map(|j| {
                    let z = 6.0 * ((j as f64 + u[2]) / DEPTHS as f64).powi(2);
                    [3.0 * u[1] * u[1], y.max(0.0), z]
                });
                CurveSpec { body: kind, name: "inside", points: points.collect() }
            });
            columns.collect::<Vec<_>>()
        });
        Self { line: line.collect(), curves: curves.collect(), inside: inside.collect() }
    }
}

fn stresses(solved: &SolvedScene, curves: &[CurveSpec]) -> Vec<Vec<StressTensor>> {
    let found = solved.stresses(curves, &[]);
    found.curves.iter().map(|c| c.iter().map(|s| s.flat.pressure).collect()).collect()
}

/// The values beside the stresses on curves, which are known.
fn values(solved: &SolvedScene, places: &Places, stress: Vec<Vec<StressTensor>>) -> Values {
    Values {
        pressure: places.line.iter().map(|[x, y]| solved.pressure.at(*x, *y)).collect(),
        approach: solved.approach(DEEP),
        stress,
        inside: stresses(solved, &places.inside),
    }
}

/// A scene with its limit.
struct Known {
    name: String,
    scene: Scene,
    places: Places,
    limit: Values,
    /// The half-width at places along the line, of the limit.
    solved: SolvedScene,
}

impl Known {
    fn new(kind: Kind, index: usize) -> Option<Self> {
        let scene = scene(kind, index);
        let places = Places::new(&scene);
        let [block, roller] = [&scene.bodies.block, &scene.bodies.roller];
        let name = format!(
            "{kind:?} {index}: S_l {:.2} L_r {:.3} nu {:.3} {:.3} share {:.3}",
            scene.half_length,
            scene.half_length / block.half,
            block.nu,
            roller.nu,
            block.share
        );
        let fine = Scene { tolerance: 1e-4, ..scene.clone() };
        match SolvedScene::with_resolution(&fine, kind.limit()) {
            Ok(solved) => {
                let limit = values(&solved, &places, stresses(&solved, &places.curves));
                Some(Self { name, scene, places, limit, solved })
            }
            Err(error) => {
                println!("{name}: no limit: {error}");
                None
            }
        }
    }

    /// Whether a point on a body's curve counts.
    fn counts(&self, [x, y, z]: [f64; 3]) -> bool {
        let s = self.scene.half_length - y;
        let singular = self.scene.corner_exponent().is_some();
        let corner = if singular { CORNER } else { RIM };
        away_from_edge([x, y, z], self.scene.half_length, corner)
            && (z >= RIM || s < 0.0 || (x.abs() - self.half_width(y)).abs() >= RIM)
    }

    /// The half-width at the limit's node that is next to `y`.
    fn half_width(&self, y: f64) -> f64 {
        let nodes = self.solved.pressure.axis().nodes();
        let next = nodes.partition_point(|node| *node < y).min(nodes.len() - 1);
        self.solved.contact.half_widths[next]
    }

    /// The largest errors of pressure and stresses, and where the latter is.
    fn errors(&self, solved: &SolvedScene) -> (f64, f64, String) {
        let stress = stresses(solved, &self.places.curves);
        self.errors_of(&values(solved, &self.places, stress))
    }

    /// [`Known::errors`] of values that are known.
    fn errors_of(&self, found: &Values) -> (f64, f64, String) {
        // The approach has less error than the pressure.
        let mut pressure = APPROACH * (found.approach / self.limit.approach - 1.0).abs();
        for ((at, a), b) in self.places.line.iter().zip(&found.pressure).zip(&self.limit.pressure) {
            if self.counts([at[0], at[1], 0.0]) {
                pressure = pressure.max((a - b).abs());
            }
        }
        let (mut stress, mut place) = (0.0, String::new());
        let on_curves = self.places.curves.iter().zip(&found.stress).zip(&self.limit.stress);
        let inside = self.places.inside.iter().zip(&found.inside).zip(&self.limit.inside);
        for ((curve, found), limit) in on_curves.chain(inside) {
            for ((at, a), b) in curve.points.iter().zip(found).zip(limit) {
                if !self.counts(*at) {
                    continue;
                }
                let pairs = a.components().into_iter().zip(b.components());
                for (component, (a, b)) in pairs.enumerate() {
                    let off: f64 = (a - b).abs();
                    if off > stress || off.is_nan() {
                        stress = off;
                        place = format!(
                            "{} {} {} at {at:.3?}",
                            curve.body.name(),
                            curve.name,
                            ["xx", "yy", "zz", "xy", "xz", "yz"][component]
                        );
                    }
                }
            }
        }
        (pressure, stress, place)
    }
}

/// Time of this process on all processors (s).
fn processor_time() -> f64 {
    let mut now = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `now` is a valid place for the answer.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut now) };
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// What exceeds the reserve costs its cube.
fn cost((worst, time): (f64, f64)) -> f64 {
    time * (worst / RESERVE).max(1.0).powi(3)
}

/// The largest error of any of the `scenes`, in tolerances, and the processor time; none if one fails or the cost
/// exceeds `most`.
fn price(
    scenes: &[Known],
    resolution: &Resolution,
    tolerance: f64,
    most: f64,
) -> Option<(f64, f64)> {
    let (mut worst, mut time) = (0.0f64, 0.0);
    for known in scenes {
        let scene = Scene { tolerance, ..known.scene.clone() };
        let began = processor_time();
        let solved = SolvedScene::with_resolution(&scene, resolution).ok()?;
        let stress = stresses(&solved, &known.places.curves);
        time += processor_time() - began;
        let found = values(&solved, &known.places, stress);
        if solved.contact.spacing != resolution.spacing {
            return None;
        }
        let (pressure, stress, _) = known.errors_of(&found);
        worst = worst.max(pressure / tolerance).max(stress / tolerance);
        if cost((worst, time)) > most {
            return None;
        }
    }
    Some((worst, time))
}

/// A generator of numbers in [0, 1) (xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// One to three entries changed.
    fn change(&mut self, from: &Resolution) -> Resolution {
        let mut next = *from;
        let count = 1 + (3.0 * self.next()) as usize;
        for _ in 0..count {
            let factor = 1.5f64.powf(2.0 * self.next() - 1.0);
            let step = |v: usize, low: usize, up: bool| if up { v + 1 } else { (v - 1).max(low) };
            let up = factor > 1.0;
            match (13.0 * self.next()) as usize {
                0 => next.order = step(next.order, 2, up),
                1 => next.corner *= factor * factor,
                2 => next.ratio = 1.0 + (next.ratio - 1.0) * factor,
                3 => next.modes = step(next.modes, 2, up),
                4 => next.spacing *= factor,
                5 => next.k_max *= factor,
                6 => next.k_order = step(next.k_order, 2, up),
                7 => next.k_step *= factor,
                8 => next.k_ratio = 1.0 + (next.k_ratio - 1.0) * factor,
                9 => next.k_min *= factor,
                10 => next.face_reach *= factor,
                11 => next.corner_ratio = 1.0 + (next.corner_ratio - 1.0) * factor,
                _ => next.reach *= factor,
            }
        }
        next
    }
}

fn search(kind: Kind, tolerance: f64, steps: usize) {
    let count = if tolerance < 5e-4 { 10 } else { 24 };
    let scenes: Vec<Known> = (0..count).filter_map(|i| Known::new(kind, 10_000 + i)).collect();
    let end = scenes[0].scene.end(BodyKind::Block);
    let mut best = Resolution::of(tolerance, &end, scenes[0].scene.corner_exponent());
    let first = price(&scenes, &best, tolerance, f64::INFINITY);
    println!("{kind:?} {tolerance:e}: at first {first:?}");
    let mut least = first.map_or(f64::INFINITY, cost);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for step in 0..steps {
        let next = random.change(&best);
        let Some(found) = price(&scenes, &next, tolerance, least) else { continue };
        if cost(found) < 0.98 * least {
            (best, least) = (next, cost(found));
            println!("{step}: worst {:.2}, {:.3} s: {best:?}", found.0, found.1);
        }
    }
}

fn hold(count: usize) {
    let kinds = [Kind::Endless, Kind::Finite, Kind::Singular];
    println!("kind,scene,tolerance,pressure,stress,attempt,seconds,where");
    let mut shares = vec![Vec::new(); TOLERANCES.len()];
    for index in 0..count {
        let kind = kinds[index % 3];
        let Some(known) = Known::new(kind, index) else { continue };
        for (tolerance, shares) in TOLERANCES.iter().zip(&mut shares) {
            let scene = Scene { tolerance: *tolerance, ..known.scene.clone() };
            let began = processor_time();
            match SolvedScene::new(&scene) {
                Ok(solved) => {
                    let (pressure, stress, place) = known.errors(&solved);
                    let same = solved.contact.spacing == solved.resolution.spacing;
                    println!(
                        "{kind:?},{},{tolerance:e},{:.3},{:.3},{},{:.3},{place}",
                        known.name,
                        pressure / tolerance,
                        stress / tolerance,
                        if same { "first" } else { "LATER" },
                        processor_time() - began,
                    );
                    shares.push((kind, pressure.max(stress) / tolerance));
                }
                Err(error) => println!("{},{tolerance:e}: FAILED {error}", known.name),
            }
        }
    }
    for (tolerance, shares) in TOLERANCES.iter().zip(shares) {
        for kind in kinds {
            let mut own: Vec<f64> = shares.iter().filter(|s| s.0 == kind).map(|s| s.1).collect();
            own.sort_by(f64::total_cmp);
            let at = |part: f64| own[((own.len() - 1) as f64 * part) as usize];
            println!(
                "{kind:?} {tolerance:e}: median {:.2}, 90 % {:.2}, largest {:.2} tolerances, {} scenes",
                at(0.5),
                at(0.9),
                at(1.0),
                own.len()
            );
        }
    }
}

/// What the limit itself is worth: its change when every panel is halved and every extent doubled.
fn limit(count: usize) {
    for kind in [Kind::Endless, Kind::Finite, Kind::Singular] {
        for index in 0..count {
            let Some(known) = Known::new(kind, index) else { continue };
            let fine = Scene { tolerance: 1e-5, ..known.scene.clone() };
            match SolvedScene::with_resolution(&fine, &kind.limit().refined()) {
                Ok(solved) => {
                    let (pressure, stress, place) = known.errors(&solved);
                    println!("{}: {pressure:.1e}, {stress:.1e} {place}", known.name);
                }
                Err(error) => println!("{}: {error}", known.name),
            }
        }
    }
}

fn main() -> ExitCode {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("it is the first pool");
    // Cargo passes --bench.
    let words: Vec<String> = std::env::args().skip(1).filter(|w| w != "--bench").collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let kind = |word: &str| match word {
        "endless" => Some(Kind::Endless),
        "finite" => Some(Kind::Finite),
        "singular" => Some(Kind::Singular),
        _ => None,
    };
    let number = |word: &str| word.parse::<f64>().ok();
    match words.as_slice() {
        [] => hold(12),
        ["hold", count] if number(count).is_some() => hold(number(count).unwrap_or(0.0) as usize),
        ["limit", count] if number(count).is_some() => limit(number(count).unwrap_or(0.0) as usize),
        ["search", of, tolerance, steps] if kind(of).is_some() => {
            let numbers = (number(tolerance), number(steps));
            let (Some(of), (Some(tolerance), Some(steps))) = (kind(of), numbers) else {
                return ExitCode::from(2);
            };
            search(of, tolerance, steps as usize);
        }
        _ => {
            eprintln!(
                "error: give hold SCENES, limit SCENES, or search endless|finite|singular TOLERANCE STEPS"
            );
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
