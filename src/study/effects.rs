//! What the factors of a study do to the errors: responses, their analysis, and it in words.

use super::factorial::{self, Analysis, Verdict};
use super::run::{CaseRun, MethodRun, Role, StudyRun};
use super::timing::Ratio;
use crate::base::number::{signed, significant};
use crate::body::EdgeModel;
use crate::stress::Quantity;

/// A number per case and method whose dependence on the factors is analysed.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// The name used in files, e.g. `von_mises_max`.
    pub name: String,
    /// What it is, in words.
    pub label: String,
    /// Its unit: `p0`, `C` or `decades`.
    pub unit: &'static str,
}

/// One response of one method, analysed.
#[derive(Debug, Clone)]
pub struct Effects {
    /// The method.
    pub method: EdgeModel,
    /// The response.
    pub response: Response,
    /// Its effects.
    pub analysis: Analysis,
    /// Response at each corner: coded levels and value, for interaction plots.
    pub corners: Vec<(Vec<i8>, f64)>,
    /// Response at the centre point.
    pub centre: Option<f64>,
}

/// All responses, in the order of the files.
pub fn responses() -> Vec<Response> {
    let response = |name: &str, label: &str, unit: &'static str| Response {
        name: name.to_string(),
        label: label.to_string(),
        unit,
    };
    let mut all = vec![
        response("pressure_rms", "RMS error of the pressure", "p0"),
        response("pressure_max", "largest error of the pressure", "p0"),
        response("stress_rms", "RMS error of the six stresses", "p0"),
        response("stress_max", "largest error of the six stresses", "p0"),
    ];
    for quantity in Quantity::ALL {
        let name = quantity.name();
        let words = match quantity {
            Quantity::Stress(_) => name,
            Quantity::VonMises => "the von Mises stress",
            Quantity::TauMax => "the largest shear stress",
        };
        all.push(response(&format!("{name}_rms"), &format!("RMS error of {words}"), "p0"));
        all.push(response(&format!("{name}_max"), &format!("largest error of {words}"), "p0"));
    }
    all.push(response("critical_value", "error of the largest von Mises stress", "p0"));
    all.push(response("critical_depth", "error of its depth", "C"));
    all.push(response("log10_speedup", "log10 of FEM time over method time", "decades"));
    all
}

/// How many times as long FEM takes as the method on one thread, with its uncertainty: from this run
/// where FEM ran in it, else from a record of both. Only times of one run on one machine are
/// divided.
pub fn speedup(case: &CaseRun, method: &MethodRun) -> Option<Ratio> {
    let fem = &case.reference.as_ref().ok()?.provenance;
    if fem.live {
        let spread = fem.seconds_spread.unwrap_or(0.0);
        return Some(Ratio::new((fem.seconds?, spread), method.timing.first()?.with_spread()));
    }
    let timed = fem.timed.as_ref()?;
    Some(Ratio::new(timed.seconds, *timed.methods.get(method.method.name())?))
}

/// Value of a response, where the case and method have one.
pub fn response_value(name: &str, case: &CaseRun, method: &MethodRun) -> Option<f64> {
    let answer = method.answer.as_ref().ok()?;
    let summary = answer.summary.as_ref()?;
    let pick = |pair: [f64; 2], name: &str| if name.ends_with("_max") { pair[0] } else { pair[1] };
    match name {
        "critical_value" => Some(answer.critical?.value - case.reference_critical?.value),
        "critical_depth" => Some(answer.critical?.at[2] - case.reference_critical?.at[2]),
        "log10_speedup" => Some(speedup(case, method)?.value.log10()),
        _ if name.starts_with("pressure") => Some(pick(*summary.pressure.first()?, name)),
        _ if name.starts_with("stress") => Some(pick(summary.stress, name)),
        _ => {
            let quantity = name.strip_suffix("_max").or_else(|| name.strip_suffix("_rms"))?;
            let index = Quantity::ALL.iter().position(|q| q.name() == quantity)?;
            Some(pick(summary.quantities[index], name))
        }
    }
}

/// Analyses every response of every method. The second list says what could not be analysed and
/// why, one sentence each.
pub fn analyse(run: &StudyRun) -> (Vec<Effects>, Vec<String>) {
    let (mut all, mut skipped) = (Vec::new(), Vec::new());
    if run.factors.is_empty() {
        skipped.push(
            "Effects: the study is no two-level design (no factor has two levels, or one has more)."
                .to_string(),
        );
        return (all, skipped);
    }
    // For each response the methods that have no value of it at some corner.
    let mut absent: Vec<(String, Vec<&str>)> = Vec::new();
    for &method in &run.methods {
        for response in responses() {
            let mut corners = Vec::new();
            let mut centre = None;
            for case in &run.cases {
                let Some(m) = case.methods.iter().find(|m| m.method == method) else { continue };
                let value = response_value(&response.name, case, m);
                match (&case.role, value) {
                    (Role::Corner(levels), Some(v)) => corners.push((levels.clone(), v)),
                    (Role::Centre, v) => centre = v,
                    _ => {}
                }
            }
            let (levels, values): (Vec<_>, Vec<_>) = corners.iter().cloned().unzip();
            match factorial::analyse(&levels, &values, centre) {
                Ok(analysis) => all.push(Effects { method, response, analysis, corners, centre }),
                Err(_) => match absent.iter_mut().find(|(name, _)| *name == response.name) {
                    Some((_, methods)) => methods.push(method.name()),
                    None => absent.push((response.name, vec![method.name()])),
                },
            }
        }
    }
    if absent.len() == responses().len() {
        skipped.push("Effects: no corner or not every one could be compared.".to_string());
    } else {
        for (response, methods) in absent {
            skipped.push(format!(
                "Effects on {response} ({}): it has no value at one corner or more.",
                methods.join(", ")
            ));
        }
    }
    (all, skipped)
}

/// Name of an effect, e.g. `W x S_l`.
pub fn term(run_factors: &[super::run::Factor], factors: &[usize]) -> String {
    factors.iter().map(|&i| run_factors[i].name).collect::<Vec<_>>().join(" x ")
}

/// What matters for one response, in words.
pub fn words(run: &StudyRun, effects: &Effects) -> String {
    let unit = effects.response.unit;
    let analysis = &effects.analysis;
    let mut text = format!(
        "{}: the {} is {} {unit} on average over the {} corners",
        effects.method,
        effects.response.label,
        significant(analysis.mean, 3),
        effects.corners.len(),
    );
    let mut ranked: Vec<_> = analysis.effects.iter().collect();
    ranked.sort_by(|a, b| b.value.abs().total_cmp(&a.value.abs()));
    let describe = |e: &factorial::Effect| {
        let name = term(&run.factors, &e.factors);
        match e.factors[..] {
            [i] => {
                let f = &run.factors[i];
                format!("{name} ({} {unit} from {} to {})", signed(e.value, 3), f.low, f.high)
            }
            _ => format!("{name} ({} {unit})", signed(e.value, 3)),
        }
    };
    let Some(lenth) = analysis.lenth else {
        text.push_str(&format!(
            "; the largest effect is that of {}, with too few effects for Lenth's limits.",
            describe(ranked[0])
        ));
        return text;
    };
    let with = |verdict: Verdict| -> Vec<String> {
        let chosen = ranked.iter().filter(|e| lenth.verdict(e.value) == verdict);
        chosen.map(|e| describe(e)).collect()
    };
    let (active, likely) = (with(Verdict::Active), with(Verdict::Likely));
    match (active.is_empty(), likely.is_empty()) {
        (true, true) => text.push_str(&format!(
            "; no effect stands out of the others by Lenth's margin of error ({}), the largest \
             is that of {}",
            significant(lenth.me, 2),
            describe(ranked[0])
        )),
        (true, false) => text.push_str(&format!(
            "; beyond Lenth's margin of error ({}), though not beyond the simultaneous one, is \
             {}",
            significant(lenth.me, 2),
            likely.join(" and ")
        )),
        (false, _) => {
            text.push_str(&format!(
                "; beyond Lenth's simultaneous margin of error ({}): {}",
                significant(lenth.sme, 2),
                active.join(", ")
            ));
            if !likely.is_empty() {
                text.push_str(&format!("; beyond the single one ({}): ", significant(lenth.me, 2)));
                text.push_str(&likely.join(", "));
            }
        }
    }
    if let Some(curvature) = analysis.curvature {
        let beyond = if curvature.abs() > lenth.me { "beyond" } else { "within" };
        text.push_str(&format!(
            ". The corners' mean less the centre point is {} {unit}, {beyond} the \
             margin of error: {}",
            signed(curvature, 2),
            if beyond == "beyond" {
                "the response bends between the levels"
            } else {
                "no sign that the response bends between the levels"
            }
        ));
    }
    text.push('.');
    text
}

/// The responses that the report puts into words.
pub const TOLD: [&str; 4] = ["pressure_rms", "stress_rms", "von_mises_max", "log10_speedup"];
