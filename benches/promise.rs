//! Whether the tolerance keeps its promise, and at what price: the largest error of the pressure
//! and of every stress on the standard curves, against a resolution far finer, in tolerances.
//!
//! `cargo bench --bench promise -- hold SCENES [KIND] [TOLERANCES]` measures scenes that no search
//! has seen: a number of them or FROM..TO, of one kind or of straight and centred ones, at every
//! decade or at tolerances such as 1e-2,1e-3. The kind `real` has rollers with profiles, eccentric
//! loads and offsets, `tips` such ones whose contact ends well before its bodies do. `-- causes
//! KIND TOLERANCE SCENE` tells the errors of one scene when one part of its resolution after the
//! other is the limit's, and `-- limit SCENES` what the limit itself is worth. `-- search KIND
//! TOLERANCE STEPS [PARTS]` looks for the cheapest resolution that keeps the promise on scenes of
//! its own, by small random steps from the present one, with PARTS such as order=4,corner=0.01
//! changed at first: from some places small steps lead nowhere. `-- try KIND TOLERANCE SCENES PARTS
//! ...` shows errors and time of scenes (10003,10009) with each of such changes. The table in
//! `src/body/axes.rs` is made from these.
//!
//! Errors are parts of p0, for `tips` of the largest pressure where that is more. Left out: 0.1 C
//! around a singular corner, 0.03 C around the contact's edge on the surface, where the tangent of
//! the pressure is vertical, and the same around a flush end.

use edgeline::base::{BodyKind, Material, PerBody, StressTensor};
use edgeline::body::{EdgeModel, Resolution};
use edgeline::case::{Case, Factors, ProfileKind, ProfileSpec};
use edgeline::solve::{Scene, SceneBody, SolvedScene};
use edgeline::stress::CurveSpec;
use edgeline::stress::curves::curves_on;
use std::ops::Range;
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
    spacing: [0.01; 2],
    k_max: 600.0,
    k_order: 6,
    k_across: 4.0,
    k_min: 0.004,
    k_ratio: 2.0,
    images: 8,
    face_reach: 24.0,
    reach: 24.0,
};

/// The tolerance that it is solved for.
const LIMIT_TOLERANCE: f64 = 1e-5;

/// The same of half-spaces: smaller panels at their ends, where the pressure is known but for a
/// polynomial, add noise.
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
    /// With a profile, a load or a body beside the middle, or all of them: the contact may end
    /// before its bodies.
    Real,
    /// The same with profiles so steep that the contact ends well inside.
    Tips,
}

/// The kinds of straight and centred rollers.
const STRAIGHT: [Kind; 3] = [Kind::Endless, Kind::Finite, Kind::Singular];

/// A number between `low` and `high`, even in its logarithm.
fn log(u: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(u)
}

/// The `index`-th real roller: straight, crowned, relieved or logarithmic with a drop of 0.1 to 5
/// C^2/(2R) at its ends, S_l 3 to 50, L_r 1 or 0.3 to 3, a load up to a tenth of the line off its
/// middle, every other block offset by up to a tenth. For `tips` rollers are crowned or
/// logarithmic, with a drop of 5 to 300 C^2/(2R), and S_l is up to 200.
fn real_scene(index: usize, tips: bool) -> Scene {
    let mut u: [f64; 10] = kronecker(index);
    let (longest, drops) = if tips { (200.0, [5.0, 300.0]) } else { (50.0, [0.1, 5.0]) };
    if tips {
        u[7] = if u[7] < 0.5 { 0.3 } else { 0.8 };
    }
    let young_pa = 210e9;
    let roller = Material { young_pa, poisson: 0.45 * u[3] };
    let block = Material { young_pa: young_pa * log(u[5], 1.0 / 3.0, 3.0), poisson: 0.45 * u[4] };
    let factors = Factors {
        load: log(u[2], 1e-5, 3e-3),
        slenderness: log(u[0], 3.0, longest),
        length_ratio: if u[1] < 0.3 { 1.0 } else { log((u[1] - 0.3) / 0.7, 0.3, 3.0) },
    };
    let mut case = Case::from_factors("scene", 0.01, roller, block, factors);
    let half = 0.5 * case.roller.length_m;
    let drop = log(u[6], drops[0], drops[1]) * case.gap_unit_m();
    let arc = |curved: f64| Some(ProfileSpec::arc_radius_m(curved, drop));
    let spec = |kind| ProfileSpec::new(kind);
    case.roller.profile = match (4.0 * u[7]) as usize {
        0 => None,
        1 => Some(ProfileSpec { radius_m: arc(half), ..spec(ProfileKind::Crown) }),
        2 => Some(ProfileSpec {
            straight_m: Some(1.4 * half),
            radius_m: arc(0.3 * half),
            ..spec(ProfileKind::Relief)
        }),
        _ => Some(ProfileSpec {
            k: Some(0.98),
            amplitude_m: Some(drop / 0.02f64.ln().abs()),
            ..spec(ProfileKind::Logarithmic)
        }),
    };
    if u[8] < 0.5 {
        case.pose.offset_m = 0.1 * (4.0 * u[8] - 1.0) * half;
    }
    let [from, to] = case.overlap_m();
    case.load.eccentricity_m = Some(0.5 * (from + to) + 0.1 * (2.0 * u[9] - 1.0) * (to - from));
    Scene::new(&case, EdgeModel::QuarterSpace, None)
}

/// The `index`-th scene of Kronecker's sequence over the box of the promise: S_l 2 to 100, L_r 1 or
/// 0.1 to 0.98, Poisson's ratios up to 0.45, moduli that differ by up to 3.
fn scene(kind: Kind, index: usize) -> Scene {
    if let Kind::Real | Kind::Tips = kind {
        return real_scene(index, kind == Kind::Tips);
    }
    let u: [f64; 5] = kronecker(index);
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

/// Depth (C) of the points whose approach is compared.
const DEEP: f64 = 30.0;

/// Columns of points inside each body, off its planes of symmetry, up to this distance (C) beyond
/// the contact's end.
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

/// A scene's values: the pressure on its three lines, the approach, and the stresses on both
/// bodies' curves and inside them.
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
    /// Those of a scene, beside these ends of its line.
    fn new(scene: &Scene, [first, last]: [f64; 2]) -> Self {
        let sides =
            if scene.is_symmetric() { vec![(last, 1.0)] } else { vec![(last, 1.0), (first, -1.0)] };
        let line = sides.into_iter().flat_map(|(end, outward)| {
            (0..=60).flat_map(move |i| {
                let s = RIM * (0.5 * (last - first) / RIM).powf(f64::from(i) / 60.0);
                [0.0, 0.4, 0.8].map(|x| [x, end - outward * s])
            })
        });
        let curves = BodyKind::ALL
            .into_iter()
            .flat_map(|kind| curves_on(kind, &scene.span(), scene.bodies[kind].ends()));
        let inside = BodyKind::ALL.into_iter().flat_map(|kind| {
            let [low, high] = scene.bodies[kind].ends();
            let symmetric = scene.is_symmetric();
            let from = if symmetric { 0.0 } else { low.max(first - BEYOND) };
            let to = high.min(last + BEYOND);
            let columns = (0..COLUMNS).map(move |i| {
                let u: [f64; 3] = kronecker(i + COLUMNS * kind as usize);
                // Every other column is near an end.
                let end = if symmetric || i % 4 == 1 { last } else { first };
                let y = if i % 2 == 0 { from + (to - from) * u[0] } else { end + 2.0 * u[0] - 1.0 };
                let points = (0..DEPTHS).map(|j| {
                    let z = 6.0 * ((j as f64 + u[2]) / DEPTHS as f64).powi(2);
                    [3.0 * u[1] * u[1], y.clamp(from, to), z]
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
    /// The largest pressure (p0) where the contact ends well inside, else 1: what errors are parts
    /// of.
    largest: f64,
    /// The half-width at places along the line, of the limit.
    solved: SolvedScene,
}

impl Known {
    fn new(kind: Kind, index: usize) -> Option<Self> {
        let scene = scene(kind, index);
        let [block, roller] = [&scene.bodies.block, &scene.bodies.roller];
        let name = format!(
            "{kind:?} {index}: S_l {:.2} L_r {:.3} nu {:.3} {:.3} share {:.3}",
            scene.half_length,
            scene.half_length / block.half,
            block.nu,
            roller.nu,
            block.share
        );
        let fine = Scene { tolerance: LIMIT_TOLERANCE, ..scene.clone() };
        match SolvedScene::with_resolution(&fine, kind.limit()) {
            Ok(solved) if solved.contact.coarser.is_some() => {
                println!("{name}: no limit: its contact is one of a later attempt");
                None
            }
            Ok(solved) => {
                let ends = if kind == Kind::Tips { solved.ends() } else { scene.overlap() };
                let places = Places::new(&scene, ends);
                let limit = values(&solved, &places, stresses(&solved, &places.curves));
                let pressures = limit.pressure.iter().copied().filter(|_| kind == Kind::Tips);
                let largest = pressures.fold(1.0, f64::max);
                Some(Self { name, scene, places, limit, largest, solved })
            }
            Err(error) => {
                println!("{name}: no limit: {error}");
                None
            }
        }
    }

    /// Whether a point counts.
    fn counts(&self, [x, y, z]: [f64; 3]) -> bool {
        let exponents = self.scene.corner_exponents();
        let away = self.scene.overlap().iter().zip(exponents).all(|(end, exponent)| {
            let least = if exponent.is_some() { CORNER } else { RIM };
            (y - end).hypot(z) >= least * (1.0 - 1e-9)
        });
        // On the surface the contact's edge, across and along the line.
        let beside: Vec<f64> =
            [-RIM, 0.0, RIM].map(|dy| x.abs() - self.half_width(y + dy)).to_vec();
        let inside = beside.iter().all(|d| *d < -RIM);
        away && (z >= RIM || inside || beside.iter().all(|d| *d > RIM))
    }

    /// The limit's half-width at `y`; zero beyond the contact.
    fn half_width(&self, y: f64) -> f64 {
        let y = if self.scene.is_symmetric() { y.abs() } else { y };
        let nodes = self.solved.pressure.axis().nodes();
        let [from, to] = self.solved.ends();
        let next = nodes.partition_point(|node| *node < y).clamp(1, nodes.len() - 1);
        let share = ((y - nodes[next - 1]) / (nodes[next] - nodes[next - 1])).clamp(0.0, 1.0);
        let [before, after] = [next - 1, next].map(|j| self.solved.contact.half_widths[j]);
        if (from..=to).contains(&y) { before + share * (after - before) } else { 0.0 }
    }

    /// The scene at a resolution: errors of pressure and stresses in tolerances, and the processor
    /// time (s); none if it fails or is solved coarser than asked.
    fn tried(&self, resolution: &Resolution, tolerance: f64) -> Option<([f64; 2], f64)> {
        let scene = Scene { tolerance, ..self.scene.clone() };
        let began = processor_time();
        let solved = SolvedScene::with_resolution(&scene, resolution).ok()?;
        let stress = stresses(&solved, &self.places.curves);
        let time = processor_time() - began;
        let (pressure, stress, _) = self.errors_of(&values(&solved, &self.places, stress));
        let same = solved.contact.coarser.is_none();
        same.then_some(([pressure, stress].map(|error| error / tolerance), time))
    }

    /// The largest errors of pressure and stresses, and where they are.
    fn errors(&self, solved: &SolvedScene) -> (f64, f64, String) {
        let stress = stresses(solved, &self.places.curves);
        self.errors_of(&values(solved, &self.places, stress))
    }

    /// [`Known::errors`] of values that are known.
    fn errors_of(&self, found: &Values) -> (f64, f64, String) {
        let mut pressure = (found.approach / self.limit.approach - 1.0).abs();
        let mut at_pressure = [f64::NAN; 2];
        for ((at, a), b) in self.places.line.iter().zip(&found.pressure).zip(&self.limit.pressure) {
            let off: f64 = (a - b).abs() / self.largest;
            if off > pressure && self.counts([at[0], at[1], 0.0]) {
                pressure = off;
                at_pressure = *at;
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
                    let off: f64 = (a - b).abs() / self.largest;
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
        (pressure, stress, format!("{place}; pressure at {at_pressure:.3?}"))
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

/// The largest error of any of the `scenes`, in tolerances, and the processor time; none if one
/// fails or the cost exceeds `most`.
fn price(
    scenes: &[Known],
    resolution: &Resolution,
    tolerance: f64,
    most: f64,
) -> Option<(f64, f64)> {
    let (mut worst, mut time) = (0.0f64, 0.0);
    for known in scenes {
        let ([pressure, stress], own) = known.tried(resolution, tolerance)?;
        time += own;
        worst = worst.max(pressure).max(stress);
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
                4 => next.spacing = next.spacing.map(|apart| factor * apart),
                5 => next.k_max *= factor,
                6 => next.k_order = step(next.k_order, 2, up),
                7 => next.k_across *= factor,
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

/// The present resolution of a scene with `parts` changed, such as order=4,corner=0.01; none if a
/// part is not one of it.
fn changed(scene: &Scene, tolerance: f64, parts: &str) -> Option<Resolution> {
    let own = SolvedScene::new(&Scene { tolerance, ..scene.clone() }).ok()?.resolution;
    let mut all = serde_json::to_value(own).ok()?;
    for part in parts.split(',').filter(|part| !part.is_empty()) {
        let (name, value) = part.split_once('=')?;
        let value: serde_json::Value = value.parse().ok()?;
        let place = all.get_mut(name)?;
        *place = if place.is_array() { [value.clone(), value].into() } else { value };
    }
    serde_json::from_value(all).ok()
}

/// Errors of pressure and stresses of `scenes` in tolerances, and the mean time, with each of these
/// changes of the present resolution.
fn attempt(kind: Kind, tolerance: f64, scenes: &[usize], changes: &[&str]) -> Option<()> {
    let scenes: Vec<Known> = scenes.iter().filter_map(|i| Known::new(kind, *i)).collect();
    for parts in changes {
        let (mut time, mut errors) = (0.0, String::new());
        for known in &scenes {
            let resolution = changed(&known.scene, tolerance, parts)?;
            let Some(([pressure, stress], own)) = known.tried(&resolution, tolerance) else {
                errors += " none";
                continue;
            };
            time += own;
            errors += &format!(" {pressure:.2}/{stress:.2}");
        }
        println!("{parts}:{errors}, {:.1} ms", 1e3 * time / scenes.len() as f64);
    }
    Some(())
}

fn search(kind: Kind, tolerance: f64, steps: usize, parts: &str) -> Option<()> {
    let count = if tolerance < 5e-4 { 10 } else { 24 };
    let scenes: Vec<Known> = (0..count).filter_map(|i| Known::new(kind, 10_000 + i)).collect();
    let mut best = changed(&scenes[0].scene, tolerance, parts)?;
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
    Some(())
}

fn hold(scenes: Range<usize>, kinds: &[Kind], tolerances: &[f64]) {
    println!("kind,scene,tolerance,pressure,stress,attempt,seconds,where");
    let mut shares = vec![Vec::new(); tolerances.len()];
    for index in scenes {
        let kind = kinds[index % kinds.len()];
        let Some(known) = Known::new(kind, index) else { continue };
        for (tolerance, shares) in tolerances.iter().zip(&mut shares) {
            let scene = Scene { tolerance: *tolerance, ..known.scene.clone() };
            let began = processor_time();
            match SolvedScene::new(&scene) {
                Ok(solved) => {
                    let (pressure, stress, place) = known.errors(&solved);
                    let same = solved.contact.coarser.is_none();
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
    for (tolerance, shares) in tolerances.iter().zip(shares) {
        for kind in kinds {
            let mut own: Vec<f64> = shares.iter().filter(|s| s.0 == *kind).map(|s| s.1).collect();
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

/// The resolution `own` with one part after the other from `finer`, and with all of them.
fn parts(own: Resolution, finer: Resolution) -> [(&'static str, Resolution); 9] {
    [
        ("order", Resolution { order: finer.order, ..own }),
        ("corner", Resolution { corner: finer.corner, corner_ratio: finer.corner_ratio, ..own }),
        ("ratio", Resolution { ratio: finer.ratio, ..own }),
        ("modes", Resolution { modes: finer.modes, ..own }),
        ("spacing", Resolution { spacing: finer.spacing, ..own }),
        ("k_max", Resolution { k_max: finer.k_max, ..own }),
        (
            "k panels",
            Resolution {
                k_order: finer.k_order,
                k_across: finer.k_across,
                k_ratio: finer.k_ratio,
                k_min: finer.k_min,
                ..own
            },
        ),
        (
            "extents",
            Resolution {
                images: finer.images,
                face_reach: finer.face_reach,
                reach: finer.reach,
                ..own
            },
        ),
        ("all", finer),
    ]
}

/// The errors of a scene when one part of its resolution after the other is that of the limit, all
/// of it, or the tolerance of iterations and sums.
fn causes(kind: Kind, tolerance: f64, index: usize) {
    let Some(known) = Known::new(kind, index) else { return };
    let limit = kind.limit();
    let scene = Scene { tolerance, ..known.scene.clone() };
    let show = |what: &str, solved: edgeline::base::Result<SolvedScene>| match solved {
        Ok(solved) => {
            let (pressure, stress, place) = known.errors(&solved);
            let [pressure, stress] = [pressure, stress].map(|error| error / tolerance);
            println!(
                "{what:12} {pressure:8.3} {stress:8.3} {place} ends {:.4?} of {:.4?}, {} {:?}",
                solved.ends(),
                known.solved.ends(),
                solved.pressure.axis().len(),
                solved.contact.coarser
            );
            solved.resolution
        }
        Err(error) => panic!("{what}: {error}"),
    };
    println!("{}", known.name);
    let own = show("own", SolvedScene::new(&scene));
    println!("{own:?}");
    for (what, resolution) in parts(own, *limit) {
        show(what, SolvedScene::with_resolution(&scene, &resolution));
    }
    let tighter = Scene { tolerance: LIMIT_TOLERANCE, ..scene };
    show("tolerance", SolvedScene::with_resolution(&tighter, &own));
}

/// What the limit itself is worth: its change when every panel is halved and every extent doubled,
/// when that is done to one part after the other, and when it is solved for a tighter tolerance.
fn limit(count: usize) {
    for kind in STRAIGHT {
        for index in 0..count {
            let Some(known) = Known::new(kind, index) else { continue };
            println!("{}", known.name);
            let (own, finer) = (*kind.limit(), kind.limit().refined());
            let usual = |(what, resolution)| (what, resolution, LIMIT_TOLERANCE);
            let tighter = ("tolerance", own, 0.1 * LIMIT_TOLERANCE);
            let all = parts(own, finer).into_iter().map(usual);
            for (what, resolution, tolerance) in all.chain([tighter]) {
                let scene = Scene { tolerance, ..known.scene.clone() };
                match SolvedScene::with_resolution(&scene, &resolution) {
                    Ok(solved) => {
                        let (pressure, stress, place) = known.errors(&solved);
                        let coarser = solved.contact.coarser;
                        println!("{what:12} {pressure:.1e}, {stress:.1e} {place} {coarser:?}");
                    }
                    Err(error) => println!("{what:12} {error}"),
                }
            }
        }
    }
}

fn usage() -> ExitCode {
    eprintln!(
        "error: give hold SCENES [KIND] [TOLERANCES], limit SCENES, causes KIND TOLERANCE SCENE, \
         search KIND TOLERANCE STEPS [PARTS], or try KIND TOLERANCE SCENES PARTS ...; the kinds are \
         endless, finite, singular, real and tips"
    );
    ExitCode::from(2)
}

/// The scenes of a number of them, or of FROM..TO.
fn range(word: &str) -> Option<Range<usize>> {
    let Some((from, to)) = word.split_once("..") else {
        return word.parse().ok().map(|count| 0..count);
    };
    Some(from.parse().ok()?..to.parse().ok()?)
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
        "real" => Some(Kind::Real),
        "tips" => Some(Kind::Tips),
        _ => None,
    };
    let number = |word: &str| word.parse::<f64>().ok();
    match words.as_slice() {
        ["causes", of, tolerance, index] if kind(of).is_some() => {
            let numbers = (number(tolerance), index.parse::<usize>().ok());
            let (Some(of), (Some(tolerance), Some(index))) = (kind(of), numbers) else {
                return usage();
            };
            causes(of, tolerance, index);
        }
        [] => hold(0..12, &STRAIGHT, &TOLERANCES),
        ["hold", scenes, rest @ ..] if range(scenes).is_some() => {
            let scenes = range(scenes).unwrap_or_default();
            let own = rest.first().and_then(|word| kind(word));
            let kinds = own.map_or(STRAIGHT.to_vec(), |kind| vec![kind]);
            let tolerances = match &rest[usize::from(own.is_some())..] {
                [] => Some(TOLERANCES.to_vec()),
                [list] => list.split(',').map(number).collect(),
                _ => None,
            };
            let Some(tolerances) = tolerances else { return usage() };
            hold(scenes, &kinds, &tolerances);
        }
        ["limit", count] if number(count).is_some() => limit(number(count).unwrap_or(0.0) as usize),
        ["search", of, tolerance, steps, parts @ ..] if parts.len() < 2 => {
            let numbers = (number(tolerance), number(steps));
            let (Some(of), (Some(tolerance), Some(steps))) = (kind(of), numbers) else {
                return usage();
            };
            let parts = parts.first().copied().unwrap_or_default();
            if search(of, tolerance, steps as usize, parts).is_none() {
                return usage();
            }
        }
        ["try", of, tolerance, scenes, changes @ ..] => {
            let scenes: Option<Vec<usize>> = scenes.split(',').map(|i| i.parse().ok()).collect();
            let (Some(of), Some(tolerance), Some(scenes)) = (kind(of), number(tolerance), scenes)
            else {
                return usage();
            };
            if attempt(of, tolerance, &scenes, changes).is_none() {
                return usage();
            }
        }
        _ => return usage(),
    }
    ExitCode::SUCCESS
}
