use super::thresholds::BUILTIN_GATES;
use super::*;
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::stress::Variable;
use crate::study::measure::Measure;
use crate::study::synthetic::{self, Twist};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const GATES: &str = r#"
[[gate]]
name = "stresses"
method = "quarter-space"
quantity = "stress"
measure = "rms"
limit = 0.006

[[gate]]
name = "pressure"
method = "quarter-space"
quantity = "pressure"
measure = "max"
excluded_c = 0.2
limit = 0.006

[drift]
recorded = 2e-4
live = 5e-3
"#;

fn gates() -> Gates {
    parse(GATES, Path::new("gates.toml")).unwrap()
}

fn failed(outcomes: &[GateOutcome]) -> Vec<String> {
    let failed = outcomes.iter().filter(|o| !o.passed);
    failed.map(|o| format!("{} {} {}: {}", o.kind.name(), o.method, o.name, o.note)).collect()
}

#[test]
fn an_unchanged_run_holds_every_gate() {
    let run = synthetic::run(Twist::None);
    let outcomes = evaluate(&run, &gates(), Some(&Baseline::of(&run)));
    assert_eq!(failed(&outcomes), Vec::<String>::new());
    // Coverage, the two limits, and a drift gate for each method, each with something in it.
    assert_eq!(outcomes.len(), 3 + 4);
    assert!(outcomes.iter().all(|o| o.compared > 0));
    let pressure = outcomes.iter().find(|o| o.name == "pressure").unwrap();
    assert!((pressure.value.unwrap() - synthetic::SHIFT).abs() < 1e-12);
    assert!((pressure.margin.unwrap() - (0.006 - synthetic::SHIFT)).abs() < 1e-12);
}

#[test]
fn a_fem_curve_off_by_two_percent_is_named() {
    let accepted = Baseline::of(&synthetic::run(Twist::None));
    let case = &synthetic::run(Twist::None).cases[2].case.name.clone();
    let run =
        synthetic::run(Twist::FemCurve { case: case.clone(), curve: "depth-0.9", factor: 1.02 });
    let failed = failed(&evaluate(&run, &gates(), Some(&accepted)));
    assert!(!failed.is_empty());
    assert!(
        failed.iter().all(|f| f.contains(case.as_str()) && f.contains("depth-0.9")),
        "{failed:?}"
    );
}

#[test]
fn a_flipped_shear_is_named() {
    let accepted = Baseline::of(&synthetic::run(Twist::None));
    let run = synthetic::run(Twist::ShearSign);
    let outcomes = evaluate(&run, &gates(), Some(&accepted));
    let stress = outcomes.iter().find(|o| o.name == "stresses").unwrap();
    assert!(!stress.passed && stress.note.contains("sigma_xz"), "{}", stress.note);
}

#[test]
fn another_mirror_factor_drifts() {
    let accepted = Baseline::of(&synthetic::run(Twist::None));
    let run = synthetic::run(Twist::EndShare(EdgeModel::Guilbault, 1.1));
    let failed = failed(&evaluate(&run, &gates(), Some(&accepted)));
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert!(failed[0].starts_with("drift guilbault"), "{failed:?}");
}

#[test]
fn numbers_at_other_distances_are_not_taken_for_drift() {
    let run = synthetic::run(Twist::None);
    let mut accepted = Baseline::of(&run);
    let moved = accepted.numbers.into_iter().map(|(place, values)| {
        let (place, _) = place.rsplit_once(' ').unwrap();
        (format!("{place} 0.7"), values)
    });
    accepted.numbers = moved.collect();
    let outcomes = evaluate(&run, &gates(), Some(&accepted));
    let drift = outcomes.iter().find(|o| o.kind == Kind::Drift).unwrap();
    assert!(!drift.passed && drift.value.is_none() && drift.margin.is_none());
    assert!(drift.note.contains("are those outside 0.7 C, and"), "{}", drift.note);
    assert!(drift.note.contains("--exclude"), "{}", drift.note);
}

#[test]
fn nothing_compared_fails() {
    let run = synthetic::run(Twist::None);
    let text = GATES.replace("measure = \"rms\"", "measure = \"rms\"\ncurves = [\"depth-ends\"]");
    let typo = parse(&text, Path::new("gates.toml")).unwrap();
    let outcomes = evaluate(&run, &typo, Some(&Baseline::of(&run)));
    assert_eq!(failed(&outcomes), ["limit quarter-space stresses: nothing was compared"]);
    // No reference at all: coverage, limits and drift all say so.
    let bare = synthetic::run(Twist::NoReference);
    let outcomes = evaluate(&bare, &gates(), Some(&Baseline::of(&run)));
    assert!(outcomes.iter().all(|o| !o.passed), "{outcomes:?}");
    // No gates at all.
    let none = Gates { gate: Vec::new(), drift: None };
    assert!(evaluate(&run, &none, None).iter().any(|o| !o.passed));
}

#[test]
fn a_case_that_cannot_be_solved_fails_the_gates_of_its_method() {
    let run = synthetic::run(Twist::Unsolved(EdgeModel::QuarterSpace));
    let failed = failed(&evaluate(&run, &gates(), Some(&Baseline::of(&run))));
    assert!(failed.iter().any(|f| f.contains("could not solve")), "{failed:?}");
}

#[test]
fn a_speed_up_does_not_count_for_a_wrong_answer() {
    let speed = "[[gate]]\nname = \"speed\"\nmethod = \"quarter-space\"\nquantity = \"speedup\"\nlimit = 100.0\n";
    let gates = parse(&format!("{speed}{GATES}"), Path::new("gates.toml")).unwrap();
    let right = synthetic::run(Twist::None);
    let accepted = Baseline::of(&right);
    assert_eq!(failed(&evaluate(&right, &gates, Some(&accepted))), Vec::<String>::new());
    let wrong = evaluate(&synthetic::run(Twist::ShearSign), &gates, Some(&accepted));
    let speed = wrong.iter().find(|o| o.name == "speed").unwrap();
    assert!(!speed.passed && speed.note.starts_with("not counted"), "{}", speed.note);
}

#[test]
fn a_speed_up_that_fails_says_where_and_spoils_no_other() {
    let speed = |name: &str, limit: f64| {
        format!(
            "[[gate]]\nname = \"{name}\"\nmethod = \"quarter-space\"\nquantity = \"speedup\"\nlimit = {limit:?}\n"
        )
    };
    let text = format!("{}{}{GATES}", speed("slow", 1e9), speed("fast", 100.0));
    let gates = parse(&text, Path::new("gates.toml")).unwrap();
    let run = synthetic::run(Twist::None);
    let failed = failed(&evaluate(&run, &gates, Some(&Baseline::of(&run))));
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert!(failed[0].starts_with("limit quarter-space slow: worst at "), "{failed:?}");
}

#[test]
fn accepted_numbers_survive_the_file_and_changes_are_listed() {
    let baseline = Baseline::of(&synthetic::run(Twist::None));
    assert_eq!(Baseline::parse(&baseline.to_json(), Path::new("b")).unwrap(), baseline);
    let mut other = baseline.clone();
    let (place, values) = other.numbers.iter_mut().next().unwrap();
    let place = place.clone();
    *values.get_mut("sigma_xx_rms").unwrap() += 0.25;
    values.remove("tau_max_max");
    let changes = baseline.changes(&other, 2e-4);
    assert_eq!(changes.len(), 2);
    assert_eq!(changes[0].place, format!("{place}: tau_max_max"));
    assert!(changes[0].describe().ends_with("-> absent"));
    assert!((changes[1].size().unwrap() - 0.25).abs() < 1e-12);
}

#[test]
fn bad_thresholds_are_refused_with_their_line() {
    let read = |text: &str| parse(text, Path::new("g.toml")).unwrap_err().to_string();
    let unknown = read(&GATES.replace("limit = 0.006", "limt = 0.006"));
    assert!(unknown.contains("g.toml:"), "{unknown}");
    assert!(unknown.contains("unknown key limt; did you mean limit? There are name,"), "{unknown}");
    let quantity = read(&GATES.replace("\"stress\"", "\"sigma\""));
    assert!(quantity.contains("\"sigma\" is not known"), "{quantity}");
    assert!(read(&GATES.replace("limit = 0.006", "limit = -1.0")).contains("not a positive"));
    assert!(read(&GATES.replace("\"max\"", "\"mean\"")).contains("max, rms, l1"));
}

#[test]
fn every_built_in_study_has_thresholds_and_accepted_numbers_of_its_own() {
    let accepted = Baseline::built_in().unwrap();
    let mut places: BTreeSet<[String; 3]> = BTreeSet::new();
    let own = |study: &Study| BUILTIN_GATES.iter().any(|(name, _)| *name == study.name);
    for study in Study::all_built_in() {
        assert!(own(&study), "{}", study.name);
        let gates = Gates::built_in_for(&study.name).unwrap();
        assert!(gates.gate.iter().any(|g| g.method == EdgeModel::QuarterSpace));
        assert!(gates.drift.is_some());
        let of_case = |case: &Case| {
            let place =
                |method: EdgeModel| [&study.name, &case.name, method.name()].map(String::from);
            gates.methods().into_iter().map(place).collect::<Vec<_>>()
        };
        places.extend(study.cases().flat_map(of_case));
    }
    let of_numbers = |place: &String| {
        let words: Vec<&str> = place.split(' ').collect();
        [words[0], words[1], words[2]].map(String::from)
    };
    assert_eq!(accepted.numbers.keys().map(of_numbers).collect::<BTreeSet<_>>(), places);
    assert_eq!(Gates::built_in_for("any other").unwrap(), Gates::for_others().unwrap());
}

#[test]
fn numbers_of_another_study_and_of_other_models_do_not_count() {
    let run = synthetic::run(Twist::None);
    let mut elsewhere = synthetic::run(Twist::EndShare(EdgeModel::Guilbault, 1.1));
    elsewhere.study = "elsewhere".to_string();
    let both = Baseline::of(&elsewhere).with(Baseline::of(&run));
    assert_eq!(failed(&evaluate(&run, &gates(), Some(&both))), Vec::<String>::new());
    let only = parse(&format!("{GATES}methods = [\"quarter-space\"]\n"), Path::new("g")).unwrap();
    let outcomes = evaluate(&run, &only, Some(&both));
    let drifts = outcomes.iter().filter(|o| o.kind == Kind::Drift);
    let titles: Vec<String> = drifts.map(|o| format!("{}, {}", o.title(), o.method)).collect();
    assert_eq!(titles, ["factorial: drift from the accepted numbers, quarter-space"]);
}

/// The accepted numbers of the model in a study, by their places in the file.
fn accepted_numbers(study: &str) -> Vec<Number> {
    let accepted = Baseline::built_in().unwrap().of_model(study, EdgeModel::QuarterSpace);
    let of_place = |(place, values): (&String, &BTreeMap<String, f64>)| {
        let [_, case, _, body, curve, excluded] = place.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{place}");
        };
        let number = |(name, value): (&String, &f64)| {
            let (variable, measure) = name.rsplit_once('_').unwrap();
            let of = NumberOf::Curve {
                body: body.into(),
                curve: curve.into(),
                variable: Variable::from_name(variable).unwrap(),
                excluded_c: excluded.parse().unwrap(),
                measure: Measure::ALL.into_iter().find(|m| m.name() == measure).unwrap(),
            };
            Number { case: case.into(), method: EdgeModel::QuarterSpace, of, value: *value }
        };
        values.iter().map(number).collect::<Vec<_>>()
    };
    accepted.numbers.iter().flat_map(of_place).collect()
}

/// The decimal numbers of a text.
fn numbers_in(text: &str) -> Vec<String> {
    let words = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    words
        .map(|word| word.trim_end_matches('.'))
        .filter(|w| w.contains('.'))
        .map(String::from)
        .collect()
}

/// The page about gates has the limits of each study and the accepted numbers beside them.
#[test]
fn the_page_has_the_limits_and_the_accepted_numbers() {
    let page = include_str!("../../../docs/methodology.md");
    for (study, of, row) in [
        ("scenes", "sliding", "| sliding |"),
        ("scenes", "materials", "| other materials |"),
        ("scenes", "real rollers", "| real rollers |"),
        ("profiled", "", "| `profiled` |"),
    ] {
        let line = page.lines().find(|line| line.starts_with(row)).unwrap();
        let (limits, accepted) = line.split('|').nth(2).unwrap().split_once("accepted").unwrap();
        let all = accepted_numbers(study);
        let gates = Gates::built_in_for(study).unwrap().gate;
        let gates = gates.iter().filter(|g| g.name.starts_with(of));
        let gates: Vec<&Gate> =
            gates.filter(|g| matches!(g.selected, Selected::Error(_))).collect();
        let sorted = |mut numbers: Vec<String>| {
            numbers.sort();
            numbers
        };
        let own = gates.iter().map(|gate| gate.limit.to_string());
        assert_eq!(sorted(numbers_in(limits)), sorted(own.collect()), "{row}");
        let worst = |gate: &&Gate| format!("{:.4}", gate.evaluate(&all, &[]).value.unwrap());
        let worst = gates.iter().map(worst);
        assert_eq!(sorted(numbers_in(accepted)), sorted(worst.collect()), "{row}");
    }
}
