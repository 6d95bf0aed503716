//! The rows of a study's tables, with their columns.

use super::study_summary::RoleName;
use super::table::{Short, by_name, columns};
use crate::base::BodyKind;
use crate::body::EdgeModel;
use crate::stress::{Quantity, Variable};
use crate::study::factorial::Verdict;
use crate::study::response::{Found, Response};
use crate::study::verification::{Convergence, Finding, Group, VerificationRow, Zone};
use crate::study::{ErrorRow, Range, Source};

by_name!(
    BodyKind,
    Convergence,
    EdgeModel,
    Finding,
    Group,
    Response,
    RoleName,
    Source,
    Variable,
    Verdict,
    Zone
);

/// A row of `study.csv`: one case by one model or reference. What a source does not have is `None`.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRow {
    /// The case.
    pub case: String,
    /// The model or reference.
    pub source: Source,
    /// The case's part in the study.
    pub role: RoleName,
    /// W.
    pub load: f64,
    /// S_l.
    pub slenderness: f64,
    /// L_r.
    pub length_ratio: f64,
    /// Half-width C (m).
    pub c_m: f64,
    /// Hertz pressure p0 (Pa).
    pub p0_pa: f64,
    /// Load (N).
    pub load_n: f64,
    /// Why there is no result.
    pub err: Option<String>,
    /// Whether the contact solver converged.
    pub converged: Option<bool>,
    /// Its iterations.
    pub iterations: Option<usize>,
    /// Relative error of the load.
    pub load_error_rel: Option<f64>,
    /// Approach of the bodies (m).
    pub approach_m: Option<f64>,
    /// Pressure at the centre (Pa).
    pub p_centre_pa: Option<f64>,
    /// Largest pressure (Pa).
    pub p_max_pa: Option<f64>,
    /// Where it is: x, y (m).
    pub p_max_at_m: [Option<f64>; 2],
    /// The body with the largest von Mises stress outside the range left out.
    pub critical_body: Option<BodyKind>,
    /// This stress (Pa).
    pub critical_von_mises_pa: Option<f64>,
    /// Where it is: x, y, z (m).
    pub critical_at_m: [Option<f64>; 3],
    /// [`Response::errors`] (p0; C for the depth).
    pub responses: Vec<Option<f64>>,
    /// Largest and RMS error of the pressure for each further range (p0).
    pub pressure_further: Vec<Option<f64>>,
    /// The reference's own error of a pressure (p0).
    pub fem_error_pressure: Option<f64>,
    /// The reference's own error of a stress (p0).
    pub fem_error_stress: Option<f64>,
    /// Median seconds on one thread; all stages of a FEM code.
    pub seconds: Option<f64>,
    /// Spread of the repeats (s).
    pub seconds_spread: Option<f64>,
    /// Seconds in a process of its own.
    pub seconds_cold: Option<f64>,
    /// Median seconds on all threads.
    pub seconds_all_threads: Option<f64>,
    /// Number of these threads.
    pub threads: Option<usize>,
    /// The reference's time over the model's.
    pub speedup: Option<f64>,
    /// Its uncertainty.
    pub speedup_spread: Option<f64>,
    /// Seconds to set up, to solve the contact and to sum the stresses.
    pub stages: [Option<f64>; 3],
    /// The machine of the times.
    pub timed_on: Option<String>,
    /// Unknowns of both bodies.
    pub unknowns: Option<u64>,
    /// The case's values of the factors that the study varies beside W, S_l and L_r.
    pub factors: Vec<Option<Short>>,
}

columns!(StudyRow, layout, {
    case,
    source,
    role,
    load as Short => ["W"],
    slenderness as Short => ["S_l"],
    length_ratio as Short => ["L_r"],
    c_m,
    p0_pa,
    load_n,
    err,
    converged,
    iterations,
    load_error_rel,
    approach_m,
    p_centre_pa,
    p_max_pa,
    p_max_at_m => ["p_max_x_m", "p_max_y_m"],
    critical_body,
    critical_von_mises_pa,
    critical_at_m => ["critical_x_m", "critical_y_m", "critical_z_m"],
    responses => Response::errors().map(Response::name),
    pressure_further => further(layout.range),
    fem_error_pressure,
    fem_error_stress,
    seconds,
    seconds_spread,
    seconds_cold,
    seconds_all_threads,
    threads,
    speedup,
    speedup_spread,
    stages => ["seconds_setup", "seconds_contact", "seconds_stress"],
    timed_on,
    unknowns,
    factors => layout.further.iter().cloned(),
});

/// The columns of the pressure's errors for each range but the first, which is that of the
/// responses.
fn further(range: &Range) -> Vec<String> {
    let names = |c: &f64| [format!("pressure_max_{c}C"), format!("pressure_rms_{c}C")];
    range.pressure_c.iter().skip(1).flat_map(names).collect()
}

impl StudyRow {
    /// The value of a response.
    pub fn response(&self, response: Response) -> Option<f64> {
        if let Response::Found(found) = response {
            return match found {
                Found::CentrePressure => self.p_centre_pa,
                Found::LargestPressure => self.p_max_pa,
                Found::CriticalStress => self.critical_von_mises_pa,
                Found::Approach => self.approach_m,
            };
        }
        let at = Response::errors().position(|r| r == response)?;
        self.responses.get(at).copied().flatten()
    }
}

/// A row of `curves.csv`: a source's stresses at a point of a standard curve.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveRow {
    /// The case.
    pub case: String,
    /// The model or reference.
    pub source: Source,
    /// The body.
    pub body: BodyKind,
    /// The curve.
    pub curve: String,
    /// The point (m).
    pub at_m: [f64; 3],
    /// [`Quantity::ALL`] (Pa).
    pub stress_pa: [f64; Quantity::ALL.len()],
}

columns!(CurveRow, _layout, {
    case,
    source,
    body,
    curve,
    at_m => ["x_m", "y_m", "z_m"],
    stress_pa => quantities(),
});

impl CurveRow {
    /// A scalar of the stress (Pa).
    pub fn stress(&self, quantity: Quantity) -> f64 {
        self.stress_pa[quantity.index()]
    }
}

/// The columns of all quantities of a stress.
fn quantities() -> Vec<String> {
    Quantity::ALL.iter().map(|quantity| format!("{}_pa", quantity.name())).collect()
}

/// A row of `pressure.csv`: a source's pressure at a point of a pressure line.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureRow {
    /// The case.
    pub case: String,
    /// The model or reference.
    pub source: Source,
    /// The line.
    pub line: String,
    /// The point (m).
    pub at_m: [f64; 2],
    /// The pressure (Pa).
    pub p_pa: f64,
}

columns!(PressureRow, _layout, {
    case,
    source,
    line,
    at_m => ["x_m", "y_m"],
    p_pa,
});

/// A row of `fem_error.csv`: a reference's own error at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnErrorRow {
    /// The case.
    pub case: String,
    /// The body, or [`crate::study::CONTACT`] for the pressure.
    pub body: String,
    /// The curve or pressure line.
    pub curve: String,
    /// The point (m).
    pub at_m: [f64; 3],
    /// The pressure's error (Pa).
    pub pressure_pa: Option<f64>,
    /// The errors of [`Quantity::ALL`] (Pa).
    pub stress_pa: [Option<f64>; Quantity::ALL.len()],
    /// The reference.
    pub source: Source,
}

columns!(OwnErrorRow, _layout, {
    case,
    body,
    curve,
    at_m => ["x_m", "y_m", "z_m"],
    pressure_pa,
    stress_pa => quantities(),
    source,
});

impl OwnErrorRow {
    /// The error of a scalar of the stress (Pa).
    pub fn stress(&self, quantity: Quantity) -> Option<f64> {
        self.stress_pa[quantity.index()]
    }
}

// `errors.csv`.
columns!(ErrorRow, _layout, {
    case,
    method,
    body,
    curve,
    variable => ["quantity"],
    excluded_c as Short,
    points,
    max,
    max_at => ["max_x_c", "max_y_c", "max_z_c"],
    rms,
    l1,
    peak,
    peak_at => ["peak_x_c", "peak_y_c", "peak_z_c"],
    peak_ref => ["peak_fem"],
    peak_ref_at => ["peak_fem_x_c", "peak_fem_y_c", "peak_fem_z_c"],
    ref_error_max => ["fem_error_max"],
    ref_error_rms => ["fem_error_rms"],
});

/// A row of `effects.csv`: one effect on one response of one model.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectRow {
    /// The model.
    pub method: EdgeModel,
    /// The response.
    pub response: Response,
    /// Its unit.
    pub unit: String,
    /// The factors of the effect.
    pub term: String,
    /// The effect.
    pub effect: f64,
    /// Half-normal quantile of its magnitude.
    pub half_normal_quantile: f64,
    /// Lenth's pseudo standard error.
    pub pse: Option<f64>,
    /// The margin of error of one effect.
    pub me: Option<f64>,
    /// The simultaneous margin of error.
    pub sme: Option<f64>,
    /// What the margins say.
    pub verdict: Option<Verdict>,
    /// Mean of the response over the corners.
    pub mean: f64,
    /// Its value at the centre point.
    pub centre: Option<f64>,
    /// Mean of the corners less the value at the centre.
    pub curvature: Option<f64>,
    /// In a fractional design the effects that this one cannot be told from, by the factors'
    /// letters.
    pub aliases: Vec<String>,
}

columns!(EffectRow, layout, {
    method,
    response,
    unit,
    term,
    effect,
    half_normal_quantile,
    pse,
    me,
    sme,
    verdict,
    mean,
    centre,
    curvature,
    aliases => layout.aliases.then_some("aliases"),
});

// `verification.csv`.
columns!(VerificationRow, _layout, {
    case,
    held_back,
    source,
    reference,
    group,
    zone,
    difference,
    sizes,
    order,
    convergence,
    safety,
    u_reference,
    u_source,
    u_num,
    finding,
});
