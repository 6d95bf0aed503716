//! The page's data on verification: differences beside the uncertainty of both sides, and the box
//! of scenes.

use crate::report::study_files::StudyFiles;
use crate::report::table::name;
use crate::study::verification::{Convergence, Finding, Group, VerificationRow, Zone};
use serde_json::{Value, json};

/// What the page and its Markdown show; nothing where nothing was compared.
pub(super) fn data(files: &StudyFiles) -> Option<Value> {
    let rows = &files.verification;
    if rows.is_empty() {
        return None;
    }
    // Curves from files need not be of the quality of a record.
    let on_record = |r: &&VerificationRow| r.convergence != Convergence::Stated;
    let of_model = rows.iter().filter(|r| !r.source.is_engine());
    let of_model: Vec<&VerificationRow> = of_model.filter(on_record).collect();
    let count = |wanted: Finding| of_model.iter().filter(|r| r.finding == wanted).count();
    let largest = |zone: Zone, group: Group, held_back: bool| {
        let own =
            of_model.iter().filter(|r| (r.zone, r.group, r.held_back) == (zone, group, held_back));
        own.map(|r| r.difference).reduce(f64::max)
    };
    let largest = |held_back| {
        json!({
            "pressure_regular": largest(Zone::Regular, Group::Pressure, held_back),
            "pressure_near_end": largest(Zone::NearEnd, Group::Pressure, held_back),
            "stress_regular": largest(Zone::Regular, Group::Stress, held_back),
            "stress_near_end": largest(Zone::NearEnd, Group::Stress, held_back),
        })
    };
    Some(json!({
        "rows": lines(rows),
        "differences": of_model.len(),
        "within": count(Finding::Within),
        "resolved": count(Finding::Resolved),
        "unknown": count(Finding::Unknown),
        "own": largest(false),
        "held_back": largest(true),
        "any_held_back": rows.iter().any(|r| r.held_back),
        "box": limits(files),
    }))
}

/// Pressure and stresses of each pair and place side by side.
fn lines(rows: &[VerificationRow]) -> Vec<Value> {
    let place =
        |r: &VerificationRow| (r.case.clone(), r.source.clone(), r.reference.clone(), r.zone);
    let mut places = Vec::new();
    for row in rows {
        if !places.contains(&place(row)) {
            places.push(place(row));
        }
    }
    let line = |at: &(String, _, _, Zone)| {
        let of =
            |group: Group| rows.iter().find(|r| place(r) == *at && r.group == group).map(values);
        let first = rows.iter().find(|r| place(r) == *at).expect("the place of a row");
        json!({
            "case": first.case,
            "held_back": first.held_back,
            "source": first.source.title(),
            "reference": first.reference.title(),
            "zone": match first.zone {
                Zone::Regular => "regular",
                Zone::NearEnd => "near an end",
            },
            "sizes": first.sizes,
            "pressure": of(Group::Pressure),
            "stress": of(Group::Stress),
        })
    };
    places.iter().map(line).collect()
}

fn values(row: &VerificationRow) -> Value {
    json!({
        "difference": row.difference,
        "u_reference": row.u_reference,
        "u_source": row.u_source,
        "u_num": row.u_num,
        "order": row.order,
        "convergence": name(&row.convergence),
        "finding": name(&row.finding),
    })
}

/// The smallest and largest of each factor among the compared cases.
fn limits(files: &StudyFiles) -> Value {
    let of = |value: &dyn Fn(&crate::report::study_summary::CaseSummary) -> Vec<f64>| {
        let all = || files.summary.cases.iter().flat_map(value);
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    };
    json!({
        "W": of(&|c| vec![c.load]),
        "S_l": of(&|c| vec![c.slenderness]),
        "L_r": of(&|c| vec![c.length_ratio]),
        "poisson": of(&|c| vec![c.roller.material.poisson, c.block.material.poisson]),
    })
}
