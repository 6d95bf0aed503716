//! Real rollers over the legal range: profiles of every kind on either body, raceways, loads and
//! blocks beside the middle, held tilts, rollers longer than the block, by all four models.
//!
//! `EDGELINE_SCENES=5000 cargo test --release --test numerics real_scenes -- --nocapture` runs
//! 5,000 and prints the worst of each law and every scene without an answer; with `5000..10000`,
//! the next 5,000. Without the variable sixty run.

use crate::common::{sequence, wanted_scenes, worse};
use edgeline::base::profile::Table;
use edgeline::base::{Error, Material};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Factors, ProfileKind, ProfileSpec};
use edgeline::kernels::strip;
use edgeline::solve::{Scene, SolvedScene, Tilt};
use edgeline::stress::BodyKind;
use rayon::prelude::*;
use std::sync::Arc;

/// Number of scenes without the environment variable, and their distance in the sequence.
const FEW: usize = 60;
const STRIDE: usize = 62;

/// Part of the scenes that may end without an answer, as an error that says so.
const MOST_ERRORS: f64 = 0.01;

/// One of so many solutions is compared with that of a tighter tolerance.
const COMPARED: usize = 10;

/// Drawn numbers of a scene.
const DIMENSIONS: usize = 14;

/// Kinds of profiles, two of ten scenes straight.
const KINDS: [Option<ProfileKind>; 10] = [
    None,
    None,
    Some(ProfileKind::Crown),
    Some(ProfileKind::Relief),
    Some(ProfileKind::Logarithmic),
    Some(ProfileKind::Lundberg),
    Some(ProfileKind::JohnsGohar),
    Some(ProfileKind::Iso16281),
    Some(ProfileKind::Fujiwara),
    Some(ProfileKind::Table),
];

fn log(u: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(u)
}

/// The profile of a body of half-length `half` (m) that drops by about `drop` (m) at its end.
fn profile(
    kind: ProfileKind,
    half: f64,
    drop: f64,
    force: f64,
    [shape, other]: [f64; 2],
) -> ProfileSpec {
    let arc = |curved: f64| Some(ProfileSpec::arc_radius_m(curved, drop));
    let mut spec = ProfileSpec::new(kind);
    match kind {
        ProfileKind::Crown => spec.radius_m = arc(half),
        ProfileKind::Relief => {
            let straight = (0.1 + 0.85 * shape) * half;
            (spec.straight_m, spec.radius_m) = (Some(2.0 * straight), arc(half - straight));
        }
        ProfileKind::Logarithmic => {
            let beyond = log(shape, 1e-6, 0.7);
            (spec.k, spec.amplitude_m) = (Some(1.0 - beyond), Some(drop / -beyond.ln()));
        }
        ProfileKind::Lundberg | ProfileKind::JohnsGohar => {
            spec.design_force_n = Some(force * log(shape, 0.2, 5.0));
        }
        ProfileKind::Iso16281 => {}
        ProfileKind::Fujiwara => {
            spec.design_force_n = Some(force * log(shape, 0.2, 5.0));
            (spec.k1, spec.k2) = (Some(log(other, 0.5, 5.0)), Some(0.1 + 0.9 * shape));
            spec.zm_m = Some(drop);
        }
        ProfileKind::Table => {
            let (power, skew) = (2.0 + 4.0 * shape, 0.4 * (other - 0.5));
            let places = (-20..=20).map(|i| f64::from(i) / 20.0);
            let (y, drops) =
                places.map(|t| (half * t, drop * (t.abs().powf(power) + skew * t))).unzip();
            spec.file = Some("drops.csv".into());
            spec.table = Some(Arc::new(Table::new(y, drops)));
        }
    }
    spec
}

/// The model and the case of the `index`-th point of the sequence.
fn draw(index: usize) -> (EdgeModel, Case) {
    let u: [f64; DIMENSIONS] = sequence(index);
    let young_pa = 210e9;
    let roller = Material { young_pa, poisson: 0.499 * u[3] };
    let block = Material { young_pa: young_pa * log(u[5], 0.1, 10.0), poisson: 0.499 * u[4] };
    let factors = Factors {
        load: log(u[2], 1e-6, 1e-2),
        slenderness: log(u[0], 2.0, 100.0),
        length_ratio: if u[1] < 0.3 { 1.0 } else { log((u[1] - 0.3) / 0.7, 0.3, 3.0) },
    };
    let mut case = Case::from_factors("scene", 0.01, roller, block, factors);
    if u[6] < 0.2 {
        let ratio = if u[6] < 0.1 { -log(10.0 * u[6], 1.5, 10.0) } else { log(u[6], 1.0, 10.0) };
        case.block.radius_m = Some(ratio * case.roller.radius_m);
        case.load.force_n *= case.equivalent_radius_m() / case.roller.radius_m;
    }
    let body = if u[9] < 0.8 { BodyKind::Roller } else { BodyKind::Block };
    let half = match body {
        BodyKind::Roller => 0.5 * case.roller.length_m,
        BodyKind::Block => 0.5 * case.block.length_m,
    };
    let drop = log(u[10], 0.05, 10.0) * case.gap_unit_m();
    let kind = KINDS[(u[8] * KINDS.len() as f64) as usize];
    // The standard's drop follows the diameter: it belongs on no disc.
    let fits = |kind: &ProfileKind| *kind != ProfileKind::Iso16281 || half > case.roller.radius_m;
    if let Some(kind) = kind.filter(fits) {
        let spec = profile(kind, half, drop, case.load.force_n, [u[11], u[9]]);
        match body {
            BodyKind::Roller => case.roller.profile = Some(spec),
            BodyKind::Block => case.block.profile = Some(spec),
        }
    }
    let shorter = case.roller.length_m.min(case.block.length_m);
    if u[12] < 0.4 {
        // Up to an overlap of 0.6 of the shorter body.
        let most = 0.5 * (case.roller.length_m + case.block.length_m) - 0.6 * shorter;
        case.pose.offset_m = (5.0 * u[12] - 1.0) * most;
    }
    let [from, to] = case.overlap_m();
    match u[13] {
        v if v < 0.5 => {
            // At 0.25 of the length the contact of straight bodies leaves a quarter of it.
            let arm = 0.25 * (4.0 * v - 1.0);
            case.load.eccentricity_m = Some(0.5 * (from + to) + arm * (to - from));
        }
        v if v < 0.65 => {
            let steepest = 3.0 * case.gap_unit_m() / (to - from);
            case.pose.tilt_rad = Some(((v - 0.5) / 0.075 - 1.0) * steepest);
        }
        _ => {}
    }
    let tolerance = match u[7] {
        u if u < 0.6 => 5e-3,
        u if u < 0.8 => 1e-2,
        _ => 1e-3,
    };
    (EdgeModel::ALL[index % EdgeModel::ALL.len()], case.with_tolerance(tolerance))
}

/// What the laws of contact are broken by at most: load and moment (relative), the traction that is
/// left on the end faces (tolerances and largest pressures), and the pressure inside against that
/// of a tighter tolerance (the same).
type Broken = [f64; 4];
const LIMITS: Broken = [1e-9, 1e-9, 10.0, 6.0];

fn run(index: usize) -> edgeline::base::Result<Broken> {
    let (model, case) = draw(index);
    case.check()?;
    let scene = Scene::new(&case, model, None);
    let solved = SolvedScene::new(&scene)?;
    let axis = solved.pressure.axis();
    let sides = if scene.is_symmetric() { 2.0 } else { 1.0 };
    let (mut load, mut moment) = (0.0, 0.0);
    for (j, (y, weight)) in axis.nodes().iter().zip(axis.weights()).enumerate() {
        let (a, modes) = solved.pressure.at_node(j);
        let line = sides * weight * strip::cumulative(a, modes, a);
        (load, moment) = (load + line, moment + line * y);
    }
    let [from, to] = solved.ends();
    // At a distance from the ends that every tolerance resolves.
    let inset = (0.1 * (to - from)).max(0.3).min(0.4 * (to - from));
    let places: Vec<f64> =
        (0..=10).map(|i| from + inset + (to - from - 2.0 * inset) * f64::from(i) / 10.0).collect();
    let pressures = |solved: &SolvedScene| {
        places.iter().map(|y| solved.pressure.at(0.0, *y)).collect::<Vec<_>>()
    };
    let own = pressures(&solved);
    let unit = scene.tolerance * own.iter().copied().fold(1.0, f64::max);

    let mut broken = [(load / scene.load - 1.0).abs(), 0.0, 0.0, 0.0];
    if let Tilt::Free(arm) = scene.tilt {
        broken[1] = (moment / scene.load - arm).abs() / scene.half_length;
    }
    if model == EdgeModel::QuarterSpace {
        for (kind, body) in BodyKind::ALL.into_iter().zip(scene.bodies.iter()) {
            for side in [-1.0, 1.0] {
                // On the face itself the tractions are set to zero; next to it they are computed.
                let y = body.middle + side * body.half * (1.0 - 2e-9);
                for z in [0.2, 0.7, 2.0, 6.0] {
                    for s in solved.field(kind).at(y, z, &[0.0, 0.7, 1.5]) {
                        let left = worse(s.yy.abs(), worse(s.xy.abs(), s.yz.abs()));
                        broken[2] = worse(broken[2], left / unit);
                    }
                }
            }
        }
    }
    if index.is_multiple_of(COMPARED) {
        let tighter = if scene.tolerance > 2e-3 { 1e-3 } else { 2e-4 };
        let finer = SolvedScene::new(&Scene { tolerance: tighter, ..scene.clone() })?;
        for (a, b) in own.iter().zip(pressures(&finer)) {
            broken[3] = worse(broken[3], (a - b).abs() / unit);
        }
    }
    Ok(broken)
}

#[test]
fn real_rollers_end_in_sound_answers_or_say_why_not() {
    let indices = wanted_scenes(FEW, STRIDE);
    let count = indices.len();
    let outcomes: Vec<(usize, edgeline::base::Result<Broken>)> =
        indices.into_par_iter().map(|i| (i, run(i))).collect();
    let mut worst: Broken = [0.0; 4];
    let (mut errors, mut refused, mut wrong) = (0, 0, Vec::new());
    for (index, outcome) in &outcomes {
        let what = || {
            let (model, case) = draw(*index);
            format!("{index}, {}:\n{}", model.name(), case.to_toml())
        };
        match outcome {
            Ok(broken) => {
                for (worst, (own, limit)) in worst.iter_mut().zip(broken.iter().zip(LIMITS)) {
                    *worst = worse(*worst, *own);
                    if own.is_nan() || *own > limit {
                        wrong.push(format!("{broken:.2?}: {}", what()));
                    }
                }
            }
            Err(Error::NotConverged { .. } | Error::Unsound { .. }) => {
                errors += 1;
                println!("{}: {}", outcome.as_ref().unwrap_err(), what());
            }
            Err(Error::Value { .. }) => refused += 1,
            Err(other) => panic!("no error that a scene ends in: {other}"),
        }
    }
    println!("{count} scenes, {errors} without an answer, {refused} refused; worst: {worst:?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(f64::from(errors) <= MOST_ERRORS * count as f64, "{errors} of {count}");
    assert!(refused * 50 <= count, "{refused} of {count}");
}
