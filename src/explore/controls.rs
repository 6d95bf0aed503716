//! What the page needs to make its fields: every key of a case with its meaning and range, the
//! flags, the profiles, the models and the built-in cases. A key or a flag that is added to a case
//! has its field without a further word here.

use super::answer::described;
use super::files::FILES;
use crate::base::BodyKind;
use crate::body::EdgeModel;
use crate::case::{BUILTIN_CASES, Case, FLAGS, Flag, Form, KEYS, Key, ProfileKind};
use crate::stress::curves::CURVE_NAMES;
use crate::stress::{EDGE, Quantity};
use serde_json::{Value, json};
use std::path::Path;

/// A slider covers this many times its example, up and down, where the legal range is wider.
const REACH: f64 = 30.0;

/// The fields, for the page.
pub fn controls(own: &Case) -> Value {
    let builtin =
        BUILTIN_CASES.iter().filter_map(|(name, text)| Case::parse(text, Path::new(name)).ok());
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "keys": KEYS.iter().filter(|key| is_shown(key)).map(key).collect::<Vec<_>>(),
        "flags": FLAGS.iter().map(flag).collect::<Vec<_>>(),
        "profiles": ProfileKind::ALL.map(|kind| json!({ "kind": kind.name(), "keys": kind.keys() })),
        "models": EdgeModel::ALL.map(|model| json!({ "name": model.name(), "misses": misses(model) })),
        "bodies": BodyKind::ALL.map(BodyKind::name),
        "curves": CURVE_NAMES,
        "quantities": Quantity::ALL.map(Quantity::name),
        "edge_c": EDGE,
        "start": described(own),
        "cases": builtin.map(|case| described(&case)).collect::<Vec<_>>(),
        "files": FILES,
        "quick_tolerance": QUICK,
    })
}

/// The tolerance while a slider moves.
const QUICK: f64 = 5e-3;

/// Whether the page has a field for a key. Of those that exclude each other it has the force.
fn is_shown(key: &Key) -> bool {
    !key.is_one_of_several() || key.path == "load.force_n"
}

fn key(key: &Key) -> Value {
    let example: f64 = key.example.parse().expect("an example is a number");
    json!({
        "path": key.path,
        "table": key.table(),
        "leaf": key.leaf(),
        "what": key.what.trim_end_matches(','),
        "range": [key.range.0, key.range.1],
        "slider": slider(key, example),
        "example": example,
        "required": key.is_required() || key.is_one_of_several(),
        "forms": { "load": key.is_of(Form::Load), "factors": key.is_of(Form::Factors) },
    })
}

fn flag(flag: &Flag) -> Value {
    json!({ "path": flag.path, "table": flag.table(), "leaf": flag.leaf(), "what": flag.what })
}

/// The range of a key's slider, and its scale: logarithmic where the legal range spans decades; of
/// either sign beyond a gap about zero where values are; and otherwise even, about zero.
fn slider(key: &Key, example: f64) -> Value {
    let (low, high) = key.range;
    let near = |scale: &str, size: f64| json!({ "scale": scale, "low": (size / REACH).max(low), "high": (size * REACH).min(high) });
    match example {
        _ if low > 0.0 && high / low > 1e3 => near("log", example),
        _ if low >= 0.0 && high <= 1e3 => json!({ "scale": "even", "low": low, "high": high }),
        e if low < 0.0 && e != 0.0 => {
            json!({ "scale": "signed", "low": e.abs() / REACH, "high": e.abs() * REACH })
        }
        e if low >= 0.0 => json!({ "scale": "even", "low": 0.0, "high": 4.0 * e }),
        // Places go as far as the bodies, angles as far as the alignment of machines.
        _ if key.leaf().ends_with("_m") => json!({ "scale": "length" }),
        _ => json!({ "scale": "even", "low": 0.02 * low, "high": 0.02 * high }),
    }
}

/// What a model leaves out.
fn misses(model: EdgeModel) -> &'static str {
    match model {
        EdgeModel::HalfSpace => "ignores free ends: both bodies go on for ever",
        EdgeModel::Mirror => "frees the end face of shear, and doubles its normal stress",
        EdgeModel::Guilbault => {
            "weighs the mirrored pressure: the load is right on average, stresses at the end are not"
        }
        EdgeModel::QuarterSpace => "frees both end faces of all traction: the model to use",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::builtin_case;
    use toml::{Table, Value as Entry};

    /// The keys of a case file that are not tables, by their paths.
    fn paths(table: &Table, prefix: &str) -> Vec<String> {
        let below = |(key, entry): (&String, &Entry)| match entry {
            Entry::Table(table) => paths(table, &format!("{prefix}{key}.")),
            _ => vec![format!("{prefix}{key}")],
        };
        table.iter().flat_map(below).collect()
    }

    /// What has no field is neither solved nor downloaded.
    #[test]
    fn the_page_has_a_field_for_all_that_a_case_file_has() {
        let mut cases: Vec<Case> = BUILTIN_CASES
            .iter()
            .map(|(name, _)| builtin_case(name).unwrap().unwrap())
            .filter(|case| case.surface.is_none())
            .collect();
        cases[0].accuracy.first_order = true;
        for case in cases {
            let page = controls(&case);
            for path in paths(&case.to_toml().parse().unwrap(), "") {
                // Words have fields of their own.
                if path == "name" || path.ends_with(".profile.kind") {
                    continue;
                }
                let has = |list: &str| {
                    page[list].as_array().unwrap().iter().any(|field| field["path"] == path)
                };
                let start = &page["start"];
                let number = has("keys") && start["load"][&path].is_number();
                let flag = has("flags") && start["flags"][&path] == true;
                assert!(number || flag, "{}: {path}", case.name);
            }
        }
    }
}
