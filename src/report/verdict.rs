//! The verdict of a study in words, from its summary.

use crate::base::number::{duration, fixed, rounded, significant};
use serde_json::Value;

/// Sentences for the head of a report, the most important first.
pub fn sentences(summary: &Value) -> Vec<String> {
    let mut all = vec![gates(summary)];
    let excluded = &summary["range"]["stress_c"];
    let methods = summary["method_summary"].as_array().map(Vec::as_slice).unwrap_or_default();
    // The last method is the most complete one: the others are measured by how much they miss.
    if let Some((best, others)) = methods.split_last() {
        let name = best["method"].as_str().unwrap_or_default();
        let number = |key: &str| best[key].as_f64();
        match (number("pressure_rms"), number("stress_rms"), number("stress_max")) {
            (Some(p), Some(s), Some(max)) => all.push(format!(
                "{name} is off FEM by {} p0 RMS in pressure, {} p0 RMS in the stresses and {} p0 at \
                 most, in the worst of {} cases, more than {excluded} C from the roller's edge.",
                fraction(p),
                fraction(s),
                fraction(max),
                best["compared"],
            )),
            _ => all.push(format!("{name} could not be compared with FEM in any case.")),
        }
        let missed: Vec<String> = others
            .iter()
            .filter_map(|m| {
                let (p, s) = (m["pressure_max"].as_f64()?, m["stress_max"].as_f64()?);
                Some(format!(
                    "{} by up to {} p0 in pressure and {} p0 in a stress",
                    m["method"].as_str()?,
                    fraction(p),
                    fraction(s)
                ))
            })
            .collect();
        if !missed.is_empty() {
            all.push(format!("The simpler models miss: {}.", missed.join("; ")));
        }
    }
    all.extend(fem_error(summary));
    all.extend(time(summary, methods));
    all.extend(equal_error(summary));
    all
}

/// Four digits after the point; smaller numbers as such.
fn fraction(v: f64) -> String {
    if v != 0.0 && v.abs() < 5e-5 { significant(v, 1) } else { fixed(v, 4) }
}

fn gates(summary: &Value) -> String {
    let gates = summary["gates"].as_array().map(Vec::as_slice).unwrap_or_default();
    let failed: Vec<String> = gates
        .iter()
        .filter(|g| g["passed"] != true)
        .map(|g| {
            let text = |key: &str| g[key].as_str().unwrap_or_default().to_string();
            format!("{} ({})", text("name"), text("method"))
        })
        .collect();
    match (gates.len(), failed.len()) {
        (0, _) => "No accuracy gate was evaluated.".to_string(),
        (n, 0) => format!("All {n} accuracy gates hold."),
        (n, k) => format!("{k} of {n} accuracy gates fail: {}.", failed.join("; ")),
    }
}

/// The largest error that FEM states of itself.
fn fem_error(summary: &Value) -> Option<String> {
    let own = &summary["fem_error"];
    let (p, s) = (own["pressure"].as_f64()?, own["stress"].as_f64()?);
    Some(format!(
        "FEM itself changes by up to {} p0 in pressure and {} p0 in a stress from its second finest \
         mesh to the finest, over the same range.",
        fraction(p),
        fraction(s)
    ))
}

fn time(summary: &Value, methods: &[Value]) -> Option<String> {
    let best = methods.last()?;
    let seconds = best["seconds"].as_f64()?;
    let name = best["method"].as_str()?;
    let mut text =
        format!("{name} takes {} a case on one thread of this machine", duration(seconds));
    let cases = summary["cases"].as_array()?;
    let times: Vec<f64> = cases.iter().filter_map(|c| c["fem"]["seconds"].as_f64()).collect();
    let slowest = times.iter().copied().reduce(f64::max);
    let fastest = times.iter().copied().reduce(f64::min);
    if let (Some(slow), Some(fast)) = (slowest, fastest) {
        let live = summary["fem"] == "live";
        let whose = if live { "in this run" } else { "on the machine of the record" };
        text.push_str(&format!(
            "; FEM's finest meshes took {} to {} {whose}",
            duration(fast),
            duration(slow)
        ));
        let ratios = &best["speedup"];
        match (ratios["low"].as_f64(), ratios["high"].as_f64()) {
            (Some(low), Some(high)) if live => text.push_str(&format!(
                ", {} to {} times as long in one run on one machine",
                rounded(low),
                rounded(high)
            )),
            _ if !live => text.push_str(", which is not divided by a time of this one"),
            _ => {}
        }
    }
    text.push('.');
    Some(text)
}

/// What the record of times says at the smallest error that a FEM mesh of it reached.
fn equal_error(summary: &Value) -> Option<String> {
    let own = |s: &&Value| s["against"] == "limit";
    let all: Vec<&Value> = summary["speedups"].as_array()?.iter().filter(own).collect();
    let level = all.iter().filter_map(|s| s["level"].as_f64()).reduce(f64::min)?;
    let here: Vec<&&Value> = all.iter().filter(|s| s["level"].as_f64() == Some(level)).collect();
    let ratio =
        |s: &&&Value| Some((s["ratio"]["value"].as_f64()?, s["ratio"]["plus_minus"].as_f64()?));
    let low = here.iter().filter_map(ratio).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let high = here.iter().filter_map(ratio).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let cases = if here.len() == 1 { "case" } else { "cases" };
    Some(format!(
        "Timed in one run on one machine and each right to {level} p0 of its own limit, FEM took {} ± \
         {} to {} ± {} times as long as quarter-space ({} {cases}).",
        rounded(low.0),
        rounded(low.1),
        rounded(high.0),
        rounded(high.1),
        here.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn failed_gates_come_first_and_are_named() {
        let summary = json!({
            "gates": [
                { "name": "pressure", "method": "mirror", "passed": false, "note": "worst at a" },
                { "name": "stress", "method": "mirror", "passed": true, "note": "" },
            ],
            "range": { "stress_c": 0.1 },
            "method_summary": [{ "method": "mirror", "cases": 8, "compared": 0 }],
        });
        let text = sentences(&summary);
        assert_eq!(text[0], "1 of 2 accuracy gates fail: pressure (mirror).");
        assert_eq!(text[1], "mirror could not be compared with FEM in any case.");
        assert_eq!(text.len(), 2);
    }

    #[test]
    fn ratios_of_the_record_are_those_at_the_smallest_error() {
        let one = |level: f64, against: &str, value: f64| {
            json!({ "level": level, "against": against,
                    "ratio": { "value": value, "plus_minus": 0.02 * value } })
        };
        let speedups = [
            one(0.02, "limit", 9e4),
            one(0.005, "limit", 2100.0),
            one(0.005, "fem", 1.0),
            one(0.005, "limit", 8000.0),
        ];
        let text = equal_error(&json!({ "speedups": speedups })).unwrap();
        assert!(text.contains("right to 0.005 p0"), "{text}");
        assert!(text.contains("2,100 ± 42 to 8,000 ± 160 times as long"), "{text}");
        assert!(text.ends_with("(2 cases)."), "{text}");
        assert!(equal_error(&json!({ "speedups": [] })).is_none());
    }
}
