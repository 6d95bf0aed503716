//! The effects of a study's factors on errors and results, in words.

use super::study_summary::EffectText;
use crate::base::number::{signed, significant};
use crate::body::EdgeModel;
use crate::stress::{Quantity, Variable};
use crate::study::StudyRun;
use crate::study::effects::{Effects, NotAnalysed, term};
use crate::study::factorial::{Effect, Lenth, Verdict};
use crate::study::measure::{Measure, Of};
use crate::study::response::{Found, Response};

/// The responses that the report describes in words and plots, where models are compared.
const TOLD: [Response; 4] =
    [Response::PRESSURE_RMS, Response::STRESS_RMS, Response::VON_MISES_MAX, Response::Log10Speedup];

/// The responses of the report, those `analysed`; the models' own results where nothing was
/// compared.
pub fn told_of(analysed: impl Fn(Response) -> bool) -> Vec<Response> {
    let told: Vec<Response> = TOLD.into_iter().filter(|r| analysed(*r)).collect();
    match told.is_empty() {
        true => Found::ALL.map(Response::Found).into_iter().filter(|r| analysed(*r)).collect(),
        false => told,
    }
}

/// A response in words.
pub fn label(response: Response) -> String {
    match response {
        Response::Error(of, by) => {
            let by = match by {
                Measure::Rms => "RMS error",
                Measure::Max => "largest error",
                Measure::L1 => "mean error",
            };
            let of = match of {
                Of::Components => "the six stresses",
                Of::Variable(Variable::Pressure) => "the pressure",
                Of::Variable(Variable::Stress(Quantity::VonMises)) => "the von Mises stress",
                Of::Variable(Variable::Stress(Quantity::TauMax)) => "the largest shear stress",
                Of::Variable(component) => component.name(),
            };
            format!("{by} of {of}")
        }
        Response::CriticalValue => "error of the largest von Mises stress".to_string(),
        Response::CriticalDepth => "error of its depth".to_string(),
        Response::Log10Speedup => "log10 of FEM time over method time".to_string(),
        Response::Found(found) => match found {
            Found::CentrePressure => "pressure at the centre".to_string(),
            Found::LargestPressure => "largest pressure".to_string(),
            Found::CriticalStress => "largest von Mises stress".to_string(),
            Found::Approach => "approach".to_string(),
        },
    }
}

/// Why there is no analysis.
pub fn not_analysed(reason: &NotAnalysed) -> String {
    match reason {
        NotAnalysed::NoDesign => "Effects: the study is no two-level design (no factor has two \
                                  levels, or one has more)."
            .to_string(),
        NotAnalysed::NothingCompared => {
            "Effects on errors: not all corners could be compared with finite elements.".to_string()
        }
        NotAnalysed::Response(response, methods) => {
            let methods: Vec<&str> = methods.iter().copied().map(EdgeModel::name).collect();
            format!(
                "Effects on {} ({}): it has no value at one corner or more.",
                response.name(),
                methods.join(", ")
            )
        }
    }
}

/// The effects on the responses of [`told_of`] in words.
pub fn told(run: &StudyRun, effects: &[Effects]) -> Vec<EffectText> {
    let chosen = told_of(|response| effects.iter().any(|e| e.response == response));
    let told = effects.iter().filter(|e| chosen.contains(&e.response));
    told.map(|e| EffectText { method: e.method, response: e.response, text: words(run, e) })
        .collect()
}

/// The effects on one response in words.
fn words(run: &StudyRun, effects: &Effects) -> String {
    let (response, analysis) = (effects.response, &effects.analysis);
    let unit = response.unit();
    let mut text = format!(
        "{}: the {} is {} {unit} on average over the {} corners",
        effects.method,
        label(response),
        significant(analysis.mean, 3),
        effects.corners.len(),
    );
    let mut ranked: Vec<_> = analysis.effects.iter().collect();
    ranked.sort_by(|a, b| b.value.abs().total_cmp(&a.value.abs()));
    let describe = |e: &Effect| {
        let name = sum_of_terms(run, e);
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
    text.push_str(&outstanding(&ranked, &lenth, unit, &describe));
    if let Some(curvature) = analysis.curvature {
        let (beyond, so) = if curvature.abs() > lenth.me {
            ("beyond", "the response bends between the levels")
        } else {
            ("within", "no sign that the response bends between the levels")
        };
        text.push_str(&format!(
            ". The corners' mean less the centre point is {} {unit}, {beyond} the \
             margin of error: {so}",
            signed(curvature, 2)
        ));
    }
    text.push('.');
    text
}

/// The name of an effect with its aliases of up to two factors, which may be as large.
fn sum_of_terms(run: &StudyRun, effect: &Effect) -> String {
    let mut name = term(&run.factors, &effect.factors);
    for alias in effect.aliases.iter().filter(|alias| alias.len() <= 2) {
        let sign = if alias.sign() < 0 { "-" } else { "+" };
        name += &format!(" {sign} {}", term(&run.factors, &alias.factors()));
    }
    name
}

/// The effects, largest first, that exceed Lenth's limits, which are in `unit`.
fn outstanding(
    ranked: &[&Effect],
    lenth: &Lenth,
    unit: &str,
    describe: &dyn Fn(&Effect) -> String,
) -> String {
    let [me, sme] = [lenth.me, lenth.sme].map(|limit| format!("{} {unit}", significant(limit, 2)));
    let with = |verdict: Verdict| -> Vec<String> {
        let chosen = ranked.iter().filter(|e| lenth.verdict(e.value) == verdict);
        chosen.map(|e| describe(e)).collect()
    };
    let (active, likely) = (with(Verdict::Active), with(Verdict::Likely));
    match (active.is_empty(), likely.is_empty()) {
        (true, true) => format!(
            "; no effect stands out of the others by Lenth's margin of error ({me}), the \
             largest is that of {}",
            describe(ranked[0])
        ),
        (true, false) => format!(
            "; beyond Lenth's margin of error ({me}), though not beyond the simultaneous one, \
             is {}",
            likely.join(" and ")
        ),
        (false, none_likely) => {
            let text = format!(
                "; beyond Lenth's simultaneous margin of error ({sme}): {}",
                active.join(", ")
            );
            if none_likely {
                return text;
            }
            text + &format!("; beyond the single one ({me}): {}", likely.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Effect, Lenth, outstanding};

    /// Limits have the unit of the effects that they are compared with.
    #[test]
    fn limits_are_told_with_their_unit() {
        let effect = |value| Effect { factors: vec![0], value, aliases: Vec::new() };
        let said = |values: &[f64]| {
            let effects: Vec<Effect> = values.iter().map(|v| effect(*v)).collect();
            let lenth = Lenth { pse: 1e6, me: 2.5e6, sme: 6e6 };
            let ranked: Vec<&Effect> = effects.iter().collect();
            outstanding(&ranked, &lenth, "Pa", &|effect: &Effect| format!("{}", effect.value))
        };
        assert!(said(&[1e6]).contains("margin of error (2.5e6 Pa), the largest is that of"));
        assert!(said(&[3e6]).contains("margin of error (2.5e6 Pa), though not beyond"));
        let all = said(&[7e6, 3e6]);
        assert!(all.contains("simultaneous margin of error (6e6 Pa): 7000000"), "{all}");
        assert!(all.contains("beyond the single one (2.5e6 Pa): 3000000"), "{all}");
    }
}
