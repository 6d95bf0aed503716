//! Made-up solutions for tests: smooth closed forms of the right shape, different for each model.

use crate::base::{Material, StressTensor};
use crate::body::EdgeModel;
use crate::case::{Block, Case, Roller};
use crate::solve::{Critical, Curve, PressureCell, PressureLine, Seconds, Solution};
use crate::stress::{BodyKind, curves};
use std::f64::consts::PI;

const STEEL: Material = Material { young_pa: 210e9, poisson: 0.3 };

/// A case with the given factors: steel on steel, R = 10 mm.
pub fn case(load: f64, slenderness: f64, length_ratio: f64) -> Case {
    let radius_m = 0.01;
    let c_m = 2.0 * radius_m * (load / PI).sqrt();
    let length_m = 2.0 * slenderness * c_m;
    Case {
        name: format!("W{load:.0e}-S{slenderness}-L{length_ratio}"),
        roller: Roller { radius_m, length_m, material: STEEL },
        block: Block { length_m: length_m / length_ratio, material: STEEL },
        force_n: load * STEEL.contact_modulus(&STEEL) * radius_m * length_m,
        tolerance: Case::DEFAULT_TOLERANCE,
    }
}

/// How much a model makes of the ends: a share of the end effect in pressure and stress.
fn end_share(method: EdgeModel) -> f64 {
    match method {
        EdgeModel::HalfSpace => 1.0,
        EdgeModel::Mirror => 0.1,
        EdgeModel::Guilbault => -0.25,
        EdgeModel::QuarterSpace => -0.3,
    }
}

/// A solution of `case` whose end effect has the size of the model's; `shift` (p0) is added to all
/// normal stresses and the pressure, to tell a "reference" from a method.
pub fn solution(case: &Case, method: EdgeModel, shift: f64) -> Solution {
    let hertz = case.hertz();
    let (c, p0) = (hertz.c_m, hertz.p0_pa);
    let half = case.factors().slenderness;
    let share = end_share(method);
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
    let curves: Vec<Curve> = BodyKind::ALL
        .into_iter()
        .flat_map(|body| {
            let body_half = match body {
                BodyKind::Block => half / case.factors().length_ratio,
                BodyKind::Roller => half,
            };
            curves::standard_curves(body, half, body_half)
        })
        .map(|spec| Curve {
            body: spec.body,
            name: spec.name,
            stress_pa: spec.points.iter().map(|p| stress(p[0], p[1], p[2]) * p0).collect(),
            at_m: spec.points.iter().map(|p| p.map(|v| v * c)).collect(),
        })
        .collect();
    let line = |name, at: Vec<[f64; 2]>| PressureLine {
        name,
        p_pa: at.iter().map(|a| pressure(a[0], a[1]) * p0).collect(),
        at_m: at.iter().map(|a| a.map(|v| v * c)).collect(),
    };
    let lines = vec![
        line("along-y", curves::contact_line(half).into_iter().map(|y| [0.0, y]).collect()),
        line("along-x", curves::across_contact().into_iter().map(|x| [x, 0.0]).collect()),
    ];
    let cells = vec![PressureCell {
        x_m: 0.0,
        y_m: 0.0,
        dx_m: 2.0 * c,
        dy_m: case.roller.length_m,
        p_pa: case.force_n / (2.0 * c * case.roller.length_m),
    }];
    let (p_centre_pa, p_end_pa) = (pressure(0.0, 0.0) * p0, pressure(0.0, half) * p0);
    let end_is_peak = p_end_pa > p_centre_pa;
    Solution {
        case: case.name.clone(),
        method,
        hertz,
        load_n: case.force_n,
        approach_m: 0.7 * c * c / case.roller.radius_m,
        p_centre_pa,
        p_max_pa: p_centre_pa.max(p_end_pa),
        p_max_at_m: [0.0, if end_is_peak { half * c } else { 0.0 }],
        converged: true,
        iterations: 12,
        load_error_rel: 1e-12,
        seconds: Seconds { setup: 0.004, contact: 0.002, stress: 0.003, total: 0.009 },
        critical: Some(Critical {
            body: BodyKind::Block,
            measure: "von_mises",
            value_pa: 0.6 * p0,
            at_m: [0.0, 0.0, 0.7 * c],
        }),
        cells,
        lines,
        curves,
        points: Vec::new(),
        details: serde_json::json!({ "evaluations": { "done": 100, "skipped": 40 } }),
    }
}
