//! Made-up solutions for tests: smooth closed forms of the right shape, different for each model.

use crate::base::{Error, HertzScales, Result, StressTensor};
use crate::body::{EdgeModel, Resolution};
use crate::case::{Case, Study};
use crate::fem::{self, Code, MeshResult};
use crate::solve::{CellDetails, Details, PressureCell, Seconds, Solution, Summary};
use crate::stress::{BodyKind, Curves, PressureLine, StressCurve, curves};
use crate::study::bench::{FemMeshes, Mesh, MeshOf};
use crate::study::run::{Provenance, Reference, StudyRun, StudySetup, Timed, run as run_study};
use crate::study::timing::Timing;
use crate::study::{Engine, Models, Range};
use std::f64::consts::PI;

/// Difference of the made-up FEM curves from those of quarter-space (p0).
pub const SHIFT: f64 = 0.003;

/// The share of the end effect in pressure and stress for each model.
fn end_share(method: EdgeModel) -> f64 {
    match method {
        EdgeModel::HalfSpace => 1.0,
        EdgeModel::Mirror => 0.1,
        EdgeModel::Guilbault => -0.25,
        EdgeModel::QuarterSpace => -0.3,
    }
}

/// A solution of `case` whose end effect is `share`; `shift` (p0) is added to all normal stresses
/// and the pressure, so that a reference differs from a model.
fn solution(case: &Case, method: EdgeModel, share: f64, shift: f64) -> Solution {
    let half = case.factors().slenderness;
    let end = |y: f64| share * (-(half - y).abs() / 0.8).exp();
    let pressure = |x: f64, y: f64| {
        if y.abs() > half { 0.0 } else { (1.0 - x * x).max(0.0).sqrt() * (1.0 + end(y)) + shift }
    };
    let stress = |x: f64, y: f64, z: f64| {
        let root = (1.0 + z * z).sqrt();
        let here = if y > half { (-(y - half)).exp() } else { 1.0 } * (-x * x).exp();
        let zz = -here * (1.0 + end(y)) / root;
        let xx = zz * (root - z).powi(2);
        StressTensor {
            xx: xx + shift,
            yy: 0.3 * (xx + zz) * (1.0 - (-(half - y).abs()).exp()) + shift,
            zz: zz + shift,
            xy: 0.0,
            xz: 0.1 * x * z * here,
            yz: 0.2 * end(y) * z * (-z).exp(),
        }
    };
    let stress_curves = BodyKind::ALL
        .into_iter()
        .flat_map(|body| {
            let body_half = match body {
                BodyKind::Block => half / case.factors().length_ratio,
                BodyKind::Roller => half,
            };
            curves::standard_curves(body, half, body_half)
        })
        .map(|spec| StressCurve {
            body: spec.body,
            name: spec.name.to_string(),
            stress: spec.points.iter().map(|p| stress(p[0], p[1], p[2])).collect(),
            at: spec.points,
            own_error: None,
        })
        .collect();
    let (along, across) = (curves::contact_line(half), curves::across_contact());
    let lines = PressureLine::standard(along, across, 0.0, |[x, y]| pressure(x, y));
    let (p_centre, p_end) = (pressure(0.0, 0.0), pressure(0.0, half));
    let p_max_y = if p_end > p_centre { half } else { 0.0 };
    Solution {
        summary: summary(case, method, p_centre, (p_centre.max(p_end), p_max_y)),
        curves: Curves { hertz: case.hertz(), pressure: lines, stress: stress_curves },
        cells: vec![PressureCell { x: 0.0, y: 0.0, dx: 2.0, dy: 2.0 * half, p: PI / 4.0 }],
        line_loads: Vec::new(),
        points: Vec::new(),
    }
}

/// The summary of a made-up solution with these pressures (p0) at the centre and at most, there at
/// y (C).
fn summary(case: &Case, method: EdgeModel, p_centre: f64, p_max: (f64, f64)) -> Summary {
    let hertz = case.hertz();
    let HertzScales { c_m, p0_pa, .. } = hertz;
    Summary {
        case: case.name.clone(),
        method,
        hertz,
        load_n: case.load.force_n,
        approach_m: 0.7 * c_m * c_m / case.roller.radius_m,
        tilt_rad: 0.0,
        p_centre_pa: p_centre * p0_pa,
        p_max_pa: p_max.0 * p0_pa,
        p_max_at_m: [0.0, p_max.1 * c_m],
        centre_of_pressure_m: [0.0; 2],
        contact_y_m: [-0.5, 0.5].map(|s| s * case.shorter_m()),
        converged: true,
        iterations: 12,
        load_error_rel: 1e-12,
        seconds: Seconds { setup: 0.004, contact: 0.002, stress: 0.003, total: 0.009 },
        critical: None,
        details: Details {
            tolerance: case.accuracy.tolerance,
            resolution: Resolution::for_tolerance(case.accuracy.tolerance),
            wavenumbers: [20, 100],
            contact_nodes: 30,
            edge: None,
            edge_neg: None,
            coarser: None,
            profile_residual: None,
            edge_residual: 1e-6,
            condition: 10.0,
            bodies_shared: false,
            work: None,
            approach_reference_m: case.roller.radius_m,
            roller_diametral_tension_pa: 0.5 * c_m / case.roller.radius_m * p0_pa,
            stiffness: None,
        },
    }
}

/// Solutions that are off by their tolerance.
pub fn solve_to_tolerance(cases: &[Case], method: EdgeModel) -> Vec<Result<Solution>> {
    cases.iter().map(|c| Ok(solution(c, method, end_share(method), c.accuracy.tolerance))).collect()
}

/// What made-up cells are off by (p0), beside the model's own error.
pub fn cells_shift(across: usize) -> f64 {
    1.0 / across as f64
}

/// Solutions of the published method that are off by [`cells_shift`].
pub fn solve_on_cells(case: &Case, counts: Option<[usize; 2]>) -> Result<Solution<CellDetails>> {
    let cells = counts.unwrap_or([64, 128]);
    let method = EdgeModel::Guilbault;
    let found = solution(case, method, end_share(method), cells_shift(cells[0]));
    Ok(found.map_details(|details| CellDetails {
        engine: "cells".to_string(),
        cells,
        half_width_m: 1.25 * case.hertz().c_m,
        tolerance: 1e-8,
        residual: 1e-9,
        contact_area_m2: 1e-6,
        mean_gap_m: 0.0,
        approach_reference_m: details.approach_reference_m,
        roller_diametral_tension_pa: details.roller_diametral_tension_pa,
    }))
}

/// What a made-up mesh is off by (p0): its size squared.
pub fn mesh_shift(size: f64) -> f64 {
    SHIFT * size * size
}

/// Made-up meshes of these sizes, on record and live.
pub fn fem_meshes(case: &Case, recorded: &[f64], live: &[f64]) -> FemMeshes {
    let mesh = |size: f64| {
        let method = EdgeModel::QuarterSpace;
        let solved = solution(case, method, end_share(method), mesh_shift(size));
        let summary = serde_json::json!({
            "versions": { "processor": "a made-up processor" },
            "ranks": 1,
            "unknowns": (1e5 / size.powi(3)) as u64,
            "load_error_rel": 0.0,
            "equilibrium_residual": 0.0,
            "complementarity_residual": 0.0,
            "approach_m": solved.summary.approach_m,
            "p_centre_pa": solved.summary.p_centre_pa,
            "p_max_pa": solved.summary.p_max_pa,
            "seconds": { "total": 30.0 / size.powi(3) },
            "peak_memory_mib": 100.0,
        });
        MeshResult {
            size,
            summary: serde_json::from_value(summary).unwrap(),
            curves: solved.curves,
        }
    };
    let timed = |size: f64| {
        let result = mesh(size);
        let seconds = result.summary.total_seconds();
        Mesh { timing: Timing::new(1, &[0.9 * seconds, 1.1 * seconds]), result }
    };
    FemMeshes {
        recorded: (!recorded.is_empty()).then(|| fem::FemResults {
            case: case.clone(),
            source: "recorded",
            meshes: recorded.iter().rev().map(|&size| mesh(size)).collect(),
            errors: Vec::new(),
        }),
        live: live
            .iter()
            .map(|&size| (MeshOf { code: Code::Fenicsx, size }, Ok(timed(size))))
            .collect(),
    }
}

/// Another reference than FEniCSx.
pub fn second_engine() -> Engine {
    serde_json::from_value("another-code".into()).unwrap()
}

/// What is special about a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Twist {
    /// Nothing.
    None,
    /// One curve of both bodies of FEM is off by a factor in one case.
    FemCurve { case: String, curve: &'static str, factor: f64 },
    /// The shear stresses across z have the wrong sign in every method.
    ShearSign,
    /// One method's end effect is off by a factor.
    EndShare(EdgeModel, f64),
    /// There are no reference curves.
    NoReference,
    /// A second engine, [`second_engine`], has curves of its own.
    SecondReference,
    /// The published method takes part, too.
    Published,
    /// One method solves nothing.
    Unsolved(EdgeModel),
}

/// The made-up solution of a case by a model.
fn solve(case: &Case, method: EdgeModel, twist: &Twist) -> Result<Solution> {
    let mut share = end_share(method);
    match twist {
        Twist::Unsolved(m) if *m == method => {
            let remedy = "nothing helps".to_string();
            return Err(Error::NotConverged { iterations: 7, residual: 0.1, remedy });
        }
        Twist::EndShare(m, factor) if *m == method => share *= factor,
        _ => {}
    }
    let mut solution = solution(case, method, share, 0.0);
    if *twist == Twist::ShearSign {
        for s in solution.curves.stress.iter_mut().flat_map(|c| &mut c.stress) {
            (s.xz, s.yz) = (-s.xz, -s.yz);
        }
    }
    Ok(solution)
}

/// The made-up FEM curves of a case: those of quarter-space, shifted.
fn reference(case: &Case, twist: &Twist) -> std::result::Result<Reference, String> {
    if *twist == Twist::NoReference {
        return Err("there is no record".to_string());
    }
    let method = EdgeModel::QuarterSpace;
    let mut curves = solution(case, method, end_share(method), SHIFT).curves;
    for curve in &mut curves.stress {
        curve.own_error = Some(vec![[0.004; 8]; curve.at.len()]);
        match twist {
            Twist::FemCurve { case: name, curve: which, factor }
                if *name == case.name && curve.name == *which =>
            {
                curve.stress.iter_mut().for_each(|s| *s = *s * *factor);
            }
            _ => {}
        }
    }
    for line in &mut curves.pressure {
        line.own_error = Some(vec![0.002; line.at.len()]);
    }
    let coarser = [1.4, 2.0]
        .map(|size| (size, solution(case, method, end_share(method), mesh_shift(size)).curves));
    Ok(Reference { curves, provenance: provenance(case), size: Some(1.0), coarser: coarser.into() })
}

/// The made-up origin of the FEM curves.
fn provenance(case: &Case) -> Provenance {
    let fem_seconds = 15.0 * case.factors().slenderness / 5.0;
    let timed = Timed {
        date: "2026-01-01".to_string(),
        machine: "a made-up processor".to_string(),
        command: "edgeline bench --fem live".to_string(),
        size: 1.4,
        unknowns: 80_000,
        seconds: (fem_seconds, 0.3),
        error: Some(0.004),
        tolerance: case.accuracy.tolerance,
        methods: EdgeModel::ALL.map(|m| (m.name().to_string(), (0.01, 0.0004))).into(),
    };
    Provenance {
        date: Some("2026-01-01".to_string()),
        machine: Some("a made-up processor".to_string()),
        unknowns: Some(150_000),
        seconds: Some(4.0 * fem_seconds),
        timed: Some(timed),
        ..Default::default()
    }
}

/// The built-in study on made-up solutions.
pub fn run(twist: Twist) -> StudyRun {
    run_of(&Study::built_in(), twist)
}

/// A study on made-up solutions.
pub fn run_of(study: &Study, twist: Twist) -> StudyRun {
    let solver = |cases: &[Case], method: EdgeModel| {
        cases.iter().map(|case| solve(case, method, &twist)).collect()
    };
    let references = |case: &Case| {
        let mut all = vec![(Engine::fenicsx(), reference(case, &twist))];
        if twist == Twist::SecondReference {
            all.push((second_engine(), reference(case, &twist)));
        }
        all
    };
    run_study(
        study,
        &StudySetup {
            models: Models {
                methods: EdgeModel::ALL.to_vec(),
                repeats: 3,
                solver: &solver,
                cold: &|_, _, _| Some(0.02),
                published: (twist == Twist::Published).then_some(&solve_on_cells),
            },
            range: Range::default(),
            references: &references,
            progress: &|_, _, _| {},
        },
    )
}
