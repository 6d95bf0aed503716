//! Scenes over the whole legal range and beyond it: each has a solution that satisfies every law of
//! contact or, only outside that range, is refused.
//!
//! `EDGELINE_SCENES=20000 cargo test --release --test numerics scenes::every -- --nocapture` runs
//! 20,000 and writes `results/scenes/`; with `5000..6000` those run, without the variable a few
//! hundred, and nothing is written.

use crate::common::{apart, sequence, wanted_scenes, worse};
use edgeline::base::{Error, Material, StressTensor};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Factors};
use edgeline::kernels::strip;
use edgeline::solve::{Scene, SolvedScene};
use edgeline::stress::BodyKind;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Number of scenes without the environment variable, and their distance in the sequence.
const FEW: usize = 400;
const STRIDE: usize = 53;

/// One of so many solutions is compared with that of a finer grid.
const COMPARED: usize = 89;

/// Distance from the contact's end within which pressure and gap are not checked (C).
const CORNER: f64 = 0.2;

/// Distance from the contact's end within which stresses of the loose tolerances are less accurate
/// (C).
const NEAR: f64 = 0.5;

/// Drawn numbers of a scene.
const DIMENSIONS: usize = 8;

/// A point of the sequence.
#[derive(Debug, Clone)]
struct Draw {
    index: usize,
    model: EdgeModel,
    factors: Factors,
    roller: Material,
    block: Material,
    radius_m: f64,
    tolerance: f64,
}

impl Draw {
    /// The `index`-th point of the sequence.
    fn new(index: usize) -> Self {
        let u: [f64; DIMENSIONS] = sequence(index);
        let log = |u: f64, low: f64, high: f64| low * (high / low).powf(u);
        // A quarter flush, a quarter next to it, and ratios of all sizes.
        let length_ratio = match u[1] {
            u if u < 0.25 => 1.0,
            u if u < 0.5 => 1.0 - log(4.0 * u - 1.0, 1e-9, 0.1),
            u => log(2.0 * u - 1.0, 0.01, 1.0),
        };
        let young_pa = 210e9;
        Self {
            index,
            model: EdgeModel::ALL[index % EdgeModel::ALL.len()],
            factors: Factors {
                load: log(u[2], 1e-9, 0.1),
                slenderness: log(u[0], 0.5, 1e3),
                length_ratio,
            },
            roller: Material { young_pa, poisson: 0.499 * u[3] },
            block: Material { young_pa: young_pa * log(u[5], 1e-3, 1e3), poisson: 0.499 * u[4] },
            radius_m: log(u[6], 1e-6, 10.0),
            tolerance: match u[7] {
                u if u < 0.8 => 1e-2,
                u if u < 0.97 => 5e-3,
                _ => 1e-3,
            },
        }
    }

    /// The case, if it is legal.
    fn case(&self) -> edgeline::base::Result<Case> {
        let case =
            Case::from_factors("scene", self.radius_m, self.roller, self.block, self.factors)
                .with_tolerance(self.tolerance);
        case.check().map(|()| case)
    }

    fn row(&self) -> String {
        format!(
            "{},{},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:e}",
            self.index,
            self.model.name(),
            self.factors.load,
            self.factors.slenderness,
            self.factors.length_ratio,
            self.roller.poisson,
            self.block.poisson,
            self.block.young_pa / self.roller.young_pa,
            self.radius_m,
            self.tolerance
        )
    }
}

/// The laws, in the order of [`LAWS`].
#[derive(Clone, Copy)]
enum Law {
    Load,
    Tension,
    Gap,
    Penetration,
    Mirror,
    Exchange,
    Units,
    Perturbed,
    Traction,
    Approach,
    Finer,
    FinerNear,
}

/// The largest violation of each law in units of its limit.
const LAWS: [(&str, f64); 12] = [
    ("load (relative)", 1e-9),
    ("tension (tolerances)", 1.0),
    ("gap under the pressure (tolerances)", 3.0),
    ("penetration (tolerances)", 1.0),
    ("mirror symmetry (p0)", 1e-9),
    ("exchange of the bodies (p0)", 1e-8),
    ("units (relative)", 2e-12),
    ("inputs 1e-12 off (p0)", 1e-6),
    ("traction on the end faces (tolerances)", 8.0),
    ("approach against the load", 0.0),
    ("finer grid (tolerances)", 1.0),
    ("finer grid near the end (tolerances)", 2.0),
];

/// The outcome of a scene.
enum Outcome {
    Answer { broken: [f64; LAWS.len()], iterations: usize, condition: f64, seconds: f64 },
    Error(&'static str, String),
}

fn kind(error: &Error) -> &'static str {
    match error {
        Error::File { .. } | Error::Value { .. } => "refused",
        Error::NotConverged { .. } => "not converged",
        Error::Unsound { .. } => "unsound",
        other => panic!("no error that a scene ends in: {other}"),
    }
}

/// The reason, without the place in the file and without the value.
fn reason(message: &str) -> String {
    let tail = message.split_once("is not valid: ").map_or(message, |(_, tail)| tail);
    let words = tail.split(';').next().unwrap_or(tail).split(' ');
    let mut after_becomes = false;
    let words = words.map(|word| {
        let value = std::mem::replace(&mut after_becomes, word == "becomes");
        if value { "a value" } else { word }
    });
    words.collect::<Vec<_>>().join(" ").replace('"', "'").replace('\n', " ")
}

/// Distances from the end of the line at which pressures are compared.
fn stations(half_length: f64) -> Vec<f64> {
    let inside = [CORNER, 0.4, 0.8, 1.6, 4.0, 20.0].into_iter().filter(|s| *s < half_length);
    inside.map(|s| half_length - s).chain([0.0, 0.4 * half_length]).collect()
}

/// Largest difference of the pressures of two solutions, relative to p0 and to the pressure.
fn pressures_apart(a: &SolvedScene, b: &SolvedScene) -> f64 {
    let mut off = 0.0;
    for y in stations(a.scene.half_length) {
        for x in [0.0, 0.5] {
            let (p, q) = (a.pressure.at(x, y), b.pressure.at(x, y));
            off = worse(off, (p - q).abs() / q.max(1.0));
        }
    }
    off
}

/// Largest differences of two solutions' stresses at places in the depth of both bodies: those at
/// least [`NEAR`] from the contact's end, and the others.
fn stresses_apart(a: &SolvedScene, b: &SolvedScene) -> [f64; 2] {
    let mut off = [0.0; 2];
    for kind in BodyKind::ALL {
        let (left, right) = (a.field(kind), b.field(kind));
        for y in stations(a.scene.half_length).into_iter().chain([a.scene.half_length]) {
            for z in [0.3, 0.8, 2.0] {
                for (s, t) in left.at(y, z, &[0.0]).iter().zip(right.at(y, z, &[0.0])) {
                    let near = usize::from((a.scene.half_length - y).hypot(z) < NEAR);
                    off[near] = worse(off[near], apart(s, &t));
                }
            }
        }
    }
    off
}

fn run(draw: &Draw, compare: bool) -> edgeline::base::Result<Outcome> {
    let case = draw.case()?;
    let scene = Scene::new(&case, draw.model, None);
    let start = Instant::now();
    let solved = SolvedScene::new(&scene)?;
    let seconds = start.elapsed().as_secs_f64();
    let half_length = scene.half_length;
    let axis = solved.pressure.axis();
    let mut broken = [0.0; LAWS.len()];
    let mut note = |law: Law, value: f64| broken[law as usize] = worse(broken[law as usize], value);

    let line = |j: usize| {
        let (a, c) = solved.pressure.at_node(j);
        axis.weights()[j] * strip::cumulative(a, c, a)
    };
    let carried: f64 = (0..axis.len()).map(line).sum();
    note(Law::Load, (carried / (0.5 * PI * half_length) - 1.0).abs());

    let places = [0.2, 0.55, 0.9, 1.1, 1.4, 2.5, 5.0];
    let outside = |j: &usize| half_length - axis.nodes()[*j] >= CORNER;
    for (t, gaps) in places.into_iter().zip(solved.gaps(&places)) {
        for j in (0..axis.len()).filter(outside) {
            let (a, c) = solved.pressure.at_node(j);
            let pressed = c.iter().any(|c| *c != 0.0);
            note(Law::Tension, -strip::pressure(a, c, a * t) / draw.tolerance);
            note(Law::Penetration, -gaps[j] / draw.tolerance);
            if t < 1.0 && pressed {
                note(Law::Gap, gaps[j].abs() / draw.tolerance);
            }
        }
    }

    for (kind, body) in BodyKind::ALL.into_iter().zip(scene.bodies.iter()) {
        let field = solved.field(kind);
        let (y, z) = (0.7 * half_length, 0.6);
        let [s, t] = [field.at(y, z, &[0.4])[0], field.at(-y, z, &[-0.4])[0]];
        let mirrored = StressTensor { xz: -t.xz, yz: -t.yz, ..t };
        note(Law::Mirror, apart(&s, &mirrored));
        if draw.model == EdgeModel::QuarterSpace {
            // On the face itself the tractions are set to zero; next to it they are computed.
            let y = body.half * (1.0 - 2e-9);
            for z in [0.2, 0.7, 2.0, 6.0] {
                for s in field.at(y, z, &[0.0, 0.7, 1.5]) {
                    let traction = worse(s.yy.abs(), worse(s.xy.abs(), s.yz.abs()));
                    note(Law::Traction, traction / draw.tolerance);
                }
            }
        }
    }

    if draw.factors.length_ratio == 1.0 {
        let mut exchanged = scene.clone();
        std::mem::swap(&mut exchanged.bodies.block, &mut exchanged.bodies.roller);
        note(Law::Exchange, pressures_apart(&solved, &SolvedScene::new(&exchanged)?));
    }

    // Other units of length and of stress.
    let (length, stress) = (7.3, 3.1);
    let mut other = case.clone();
    other.roller.radius_m *= length;
    other.roller.length_m *= length;
    other.block.length_m *= length;
    other.roller.material.young_pa *= stress;
    other.block.material.young_pa *= stress;
    other.load.force_n *= length * length * stress;
    let rescaled = Scene::new(&other, draw.model, None);
    // A scene has twelve digits of the case: the same ones, but where rounding takes the other
    // side.
    if rescaled.key() != scene.key() {
        note(Law::Perturbed, pressures_apart(&solved, &SolvedScene::new(&rescaled)?));
    }
    for (a, b) in scene.bodies.iter().zip(rescaled.bodies.iter()) {
        let pairs =
            [(a.half, b.half), (a.share, b.share), (scene.half_length, rescaled.half_length)];
        let off = pairs.into_iter().map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, worse);
        note(Law::Units, off);
    }

    // One part in 10^12 of every number.
    if draw.index % 8 < EdgeModel::ALL.len() {
        let mut other = scene.clone();
        other.half_length *= 1.0 + 1e-12;
        for body in other.bodies.iter_mut() {
            body.half *= 1.0 + 1e-12;
            body.nu *= 1.0 + 1e-12;
        }
        note(Law::Perturbed, pressures_apart(&solved, &SolvedScene::new(&other)?));
    }

    // More load, more approach.
    let mut heavier = case.clone();
    heavier.load.force_n *= 1.05;
    let pressed = SolvedScene::new(&Scene::new(&heavier, draw.model, None))?;
    let approach = |case: &Case, solved: &SolvedScene| {
        let (c, r) = (case.hertz().c_m, case.roller.radius_m);
        solved.approach(r / c) * c * c
    };
    let more = approach(&heavier, &pressed) - approach(&case, &solved);
    note(Law::Approach, if more > 0.0 { 0.0 } else { 1.0 });

    if compare {
        let tolerance = if draw.tolerance > 2e-3 { 1e-3 } else { 1e-4 };
        let finer = SolvedScene::new(&Scene { tolerance, ..scene.clone() })?;
        let [far, near] = stresses_apart(&solved, &finer);
        note(Law::Finer, worse(pressures_apart(&solved, &finer), far) / draw.tolerance);
        note(Law::FinerNear, near / draw.tolerance);
    }
    let (iterations, condition) = (solved.contact.iterations, solved.condition);
    Ok(Outcome::Answer { broken, iterations, condition, seconds })
}

/// Whether a case is in the legal range, as `cases/README.md` has it.
fn is_legal(draw: &Draw) -> bool {
    let case = Case::from_factors("scene", draw.radius_m, draw.roller, draw.block, draw.factors);
    let lengths = [case.roller.radius_m, case.roller.length_m, case.block.length_m];
    let moduli = [case.roller.material.young_pa, case.block.material.young_pa];
    (1e-12..=5e-2).contains(&draw.factors.load)
        && lengths.iter().all(|length| (1e-9..=1e4).contains(length))
        && moduli.iter().all(|young| (1e3..=1e14).contains(young))
        && (1e-12..=1e15).contains(&case.load.force_n)
}

/// Solutions and errors of scenes of one kind.
#[derive(Default)]
struct Group {
    counts: BTreeMap<&'static str, usize>,
    worst: [f64; LAWS.len()],
    iterations: usize,
    condition: f64,
    seconds: f64,
}

/// The outcomes of all scenes.
#[derive(Default)]
struct Tally {
    /// By model, slenderness and ends.
    groups: BTreeMap<(usize, &'static str, &'static str), Group>,
    /// Number of scenes with each kind and reason of an error, and the first of them.
    reasons: BTreeMap<(&'static str, String), (usize, usize)>,
    /// Violated laws with their scenes, refused legal scenes, and solved illegal ones.
    wrong: String,
}

impl Tally {
    fn add(&mut self, draw: &Draw, outcome: &Outcome) {
        let slenderness = match draw.factors.slenderness {
            s if s < 5.0 => "0.5 to 5",
            s if s < 50.0 => "5 to 50",
            _ => "50 to 1000",
        };
        let ends = match draw.factors.length_ratio {
            1.0 => "flush",
            l if l > 0.9 => "nearly flush",
            _ => "longer block",
        };
        let model = EdgeModel::ALL.iter().position(|m| *m == draw.model).expect("one of all");
        let group = self.groups.entry((model, slenderness, ends)).or_default();
        let mut name = match outcome {
            Outcome::Answer { broken, iterations, condition, seconds } => {
                group.condition = group.condition.max(*condition);
                group.iterations = group.iterations.max(*iterations);
                group.seconds = group.seconds.max(*seconds);
                let mut sound = true;
                for (i, (law, limit)) in LAWS.iter().enumerate() {
                    group.worst[i] = worse(group.worst[i], broken[i]);
                    if broken[i].is_nan() || broken[i] > *limit {
                        sound = false;
                        writeln!(self.wrong, "{},{law},{:.2e}", draw.row(), broken[i]).unwrap();
                    }
                }
                if sound { "answer" } else { "wrong" }
            }
            Outcome::Error(kind, message) => {
                let key = (*kind, reason(message));
                self.reasons.entry(key).or_insert((0, draw.index)).0 += 1;
                kind
            }
        };
        if (name == "refused") == is_legal(draw) {
            writeln!(self.wrong, "{},{name} against the legal range", draw.row()).unwrap();
            name = "wrong";
        }
        *group.counts.entry(name).or_default() += 1;
    }

    fn total(&self, name: &str) -> usize {
        self.groups.values().filter_map(|group| group.counts.get(name)).sum()
    }

    /// A row for each kind of scenes: numbers of outcomes, and the worst value of each law.
    fn table(&self) -> String {
        let laws: Vec<&str> = LAWS.iter().map(|l| l.0).collect();
        let (names, laws) = (NAMES.join(","), laws.join(","));
        let mut table = format!("model,S_l,ends,{names},{laws},iterations,condition,seconds\n");
        for ((model, slenderness, ends), group) in &self.groups {
            let counts: Vec<String> =
                NAMES.iter().map(|n| group.counts.get(n).unwrap_or(&0).to_string()).collect();
            let worst: Vec<String> = group.worst.iter().map(|w| format!("{w:.1e}")).collect();
            writeln!(
                table,
                "{},{slenderness},{ends},{},{},{},{:.1e},{:.3}",
                EdgeModel::ALL[*model].name(),
                counts.join(","),
                worst.join(","),
                group.iterations,
                group.condition,
                group.seconds
            )
            .unwrap();
        }
        table
    }

    /// A row for each reason of an error.
    fn errors(&self) -> String {
        let mut errors = String::from("outcome,scenes,first,reason\n");
        for ((kind, reason), (scenes, first)) in &self.reasons {
            writeln!(errors, "{kind},{scenes},{first},\"{reason}\"").unwrap();
        }
        errors
    }
}

/// How a scene may end.
const NAMES: [&str; 6] = ["answer", "refused", "not converged", "unsound", "wrong", "panic"];

#[test]
fn every_scene_ends_in_a_sound_answer_or_is_outside_the_legal_range() {
    // A small number of scenes is spread over the whole sequence.
    let indices = wanted_scenes(FEW, STRIDE);
    let (from, count) = (indices[0], indices.len());
    let outcomes: Vec<(Draw, Outcome)> = indices
        .into_par_iter()
        .enumerate()
        .map(|(i, index)| {
            let draw = Draw::new(index);
            let outcome = std::panic::catch_unwind(|| run(&draw, (from + i) % COMPARED == 0));
            let outcome = match outcome {
                Ok(Ok(outcome)) => outcome,
                Ok(Err(error)) => Outcome::Error(kind(&error), error.to_string()),
                Err(_) => Outcome::Error("panic", String::new()),
            };
            (draw, outcome)
        })
        .collect();
    let mut tally = Tally::default();
    for (draw, outcome) in &outcomes {
        tally.add(draw, outcome);
    }
    let (table, errors) = (tally.table(), tally.errors());
    println!("{table}");
    for name in NAMES {
        println!("{name}: {}", tally.total(name));
    }
    println!("{}\n{errors}", tally.wrong);
    if std::env::var_os("EDGELINE_SCENES").is_some() && from == 0 {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/scenes");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("outcomes.csv"), table).unwrap();
        std::fs::write(folder.join("errors.csv"), &errors).unwrap();
    }
    let refused = tally.total("refused");
    assert_eq!(tally.total("answer") + refused, count, "{}\n{errors}", tally.wrong);
    // One in ten of the recorded scenes is outside the legal range.
    assert!(refused * 100 <= count * 12, "{errors}");
}
