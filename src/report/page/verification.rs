//! The page's data on verification: differences beside the uncertainty of both sides, and the box
//! of scenes.

use crate::base::number::significant;
use crate::report::study_files::StudyFiles;
use crate::report::study_summary::CaseSummary;
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
    let is_compared = |c: &&CaseSummary| of_model.iter().any(|r| !r.held_back && r.case == c.name);
    let compared: Vec<&CaseSummary> = files.summary.cases.iter().filter(is_compared).collect();
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
        "box": limits(&compared),
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

/// The smallest and largest of each factor among the compared cases, and what else they have.
fn limits(compared: &[&CaseSummary]) -> Value {
    let of = |value: &dyn Fn(&CaseSummary) -> Vec<f64>| {
        let all = || compared.iter().flat_map(|case| value(case));
        [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)]
    };
    json!({
        "W": of(&|c| vec![c.load]),
        "S_l": of(&|c| vec![c.slenderness]),
        "L_r": of(&|c| vec![c.length_ratio]),
        "young": of(&|c| vec![c.roller.material.young_pa / c.block.material.young_pa]),
        "poisson": of(&|c| vec![c.roller.material.poisson, c.block.material.poisson]),
        "bodies": bodies(compared),
    })
}

/// Generatrices, positions and sliding of the compared cases in words.
fn bodies(compared: &[&CaseSummary]) -> String {
    let profiles = |c: &CaseSummary| -> Vec<&'static str> {
        let own = [&c.roller.profile, &c.block.profile];
        own.into_iter().flatten().map(|profile| profile.kind.name()).collect()
    };
    let mut kinds: Vec<&str> = compared.iter().flat_map(|c| profiles(c)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let any_straight = compared.iter().any(|c| profiles(c).is_empty());
    let kinds = kinds.join(", ");
    let mut words = vec![match (any_straight, kinds.is_empty()) {
        (_, true) => "straight generatrices".to_string(),
        (true, false) => format!("straight generatrices and profiles ({kinds})"),
        (false, false) => format!("profiles ({kinds})"),
    }];
    let mut up_to = |what: &str, of: &dyn Fn(&CaseSummary) -> f64| {
        let largest = compared.iter().map(|c| of(c).abs()).fold(0.0, f64::max);
        if largest > 0.0 {
            words.push(format!("{what} up to {}", significant(largest, 3)));
        }
        largest > 0.0
    };
    let eccentric = |c: &CaseSummary| c.eccentricity_m.unwrap_or(0.0) / c.roller.length_m;
    let moved = [
        up_to("eccentricities of the load (lengths of the roller)", &eccentric),
        up_to("tilts (rad)", &|c| c.pose.tilt_rad.unwrap_or(0.0)),
        up_to("offsets (lengths of the block)", &|c| c.pose.offset_m / c.block.length_m),
    ];
    up_to("friction", &|c| c.sliding.friction);
    if moved == [false; 3] {
        words[0].push_str(", parallel and centred bodies");
    }
    words.join(", ")
}
