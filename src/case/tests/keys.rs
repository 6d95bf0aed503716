use super::super::*;
use crate::base::number::stated;
use crate::base::{Error, Material};
use crate::cells::Detrend;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use toml::{Table, Value};

/// A case whose numbers all differ. It is written out so that a new field does not compile before
/// it is here, and with that in the tests below.
fn every_field() -> Case {
    Case {
        name: "all".into(),
        roller: Roller {
            radius_m: 1e-2,
            length_m: 2e-2,
            material: Material { young_pa: 2.1e11, poisson: 0.3 },
            profile: Some(every_number()),
        },
        block: Block {
            length_m: 3e-2,
            material: Material { young_pa: 0.7e11, poisson: 0.33 },
            radius_m: Some(-0.05),
            profile: Some(every_number()),
        },
        load: Load { force_n: 1e3, approach_m: None, eccentricity_m: Some(1e-3) },
        pose: Pose { tilt_rad: Some(1e-4), offset_m: 2e-3 },
        sliding: Sliding { friction: 0.2 },
        fatigue: Fatigue {
            dang_van_alpha: Some(0.31),
            dang_van_beta_pa: Some(3.5e8),
            fatemi_socie_k: Some(0.7),
            yield_pa: Some(1.7e9),
            residual_xx_pa: Some(-1.1e8),
            residual_yy_pa: Some(-1.2e8),
        },
        surface: Some(Surface {
            heights: "rough.npy".into(),
            dx_m: 1.1e-6,
            dy_m: 1.2e-6,
            detrend: Some(Detrend::Plane),
            samples: None,
        }),
        accuracy: Accuracy { tolerance: 2e-3, first_order: true },
        cells: Some(Cells { half_width_m: 4e-4 }),
    }
}

/// A profile with all numbers, which no kind has.
fn every_number() -> ProfileSpec {
    let mut numbers = (1..).map(|i| Some(1e-3 * f64::from(i)));
    let mut next = || numbers.next().flatten();
    ProfileSpec {
        kind: ProfileKind::Table,
        radius_m: next(),
        amplitude_m: next(),
        k: next(),
        design_force_n: next(),
        k1: next(),
        k2: next(),
        zm_m: next(),
        straight_m: next(),
        file: None,
        table: None,
    }
}

/// A legal case that has `key`, and as much besides as it can have.
fn legal_with(key: &Key) -> Case {
    let mut case = every_field();
    let profile = |body: &str| {
        if key.table() != format!("{body}.profile") {
            return None;
        }
        let kind = ProfileKind::ALL.into_iter().find(|kind| kind.keys().contains(&key.leaf()));
        let mut spec = ProfileSpec::new(kind.expect("every number belongs to a kind"));
        for name in spec.kind.keys() {
            let example = Key::find(&format!("{body}.profile.{name}")).unwrap().example;
            *spec.number_mut(name).unwrap() = Some(example.parse().unwrap());
        }
        Some(spec)
    };
    (case.roller.profile, case.block.profile) = (profile("roller"), profile("block"));
    // A load with an eccentricity finds its own tilt.
    match key.leaf() {
        "tilt_rad" => case.load.eccentricity_m = None,
        _ => case.pose.tilt_rad = None,
    }
    if key.path == "load.approach_m" {
        case.load.approach_m = Some(5e-6);
        case.load.force_n = f64::NAN;
    }
    case.check().unwrap();
    case
}

/// The numbers of a table by their paths.
fn numbers(table: &Table, prefix: &str) -> BTreeMap<String, f64> {
    let mut found = BTreeMap::new();
    for (key, value) in table {
        let path = format!("{prefix}{key}");
        match value {
            Value::Float(number) => drop(found.insert(path, *number)),
            Value::Table(below) => found.extend(numbers(below, &format!("{path}."))),
            Value::String(_) => {
                assert!(
                    path == "name" || ["kind", "heights", "detrend"].contains(&key.as_str()),
                    "{path}"
                );
            }
            Value::Boolean(_) => assert_eq!(path, "accuracy.first_order"),
            other => panic!("{path} = {other} is neither a number nor a known text"),
        }
    }
    found
}

fn file_of(case: &Case) -> BTreeMap<String, f64> {
    numbers(&case.to_toml().parse().unwrap(), "")
}

#[test]
fn every_number_of_a_case_file_is_a_key() {
    let case = every_field();
    let file = file_of(&case);
    // An approach takes the place of the force.
    let of_file = |key: &&Key| key.is_of(Form::Load) && key.path != "load.approach_m";
    let mut keys: Vec<&str> = KEYS.iter().filter(of_file).map(|key| key.path).collect();
    keys.sort_unstable();
    assert_eq!(keys, file.keys().map(String::as_str).collect::<Vec<_>>());
    for (path, value) in &file {
        let key = Key::find(path).unwrap();
        let mut draft = Draft::of(&case, Form::Load);
        assert_eq!(key.get(&draft), Some(*value), "{path}");
        key.set(&mut draft, 1.01 * value);
        let mut wanted = file.clone();
        wanted.insert(path.clone(), 1.01 * value);
        assert_eq!(file_of(&draft.case), wanted, "{path}");
    }
}

#[test]
fn force_and_approach_take_each_others_place() {
    let [force, approach] =
        ["load.force_n", "load.approach_m"].map(|path| Key::find(path).unwrap());
    let mut draft = Draft::of(&every_field(), Form::Load);
    assert_eq!((force.get(&draft), approach.get(&draft)), (Some(1e3), None));
    approach.set(&mut draft, 4e-6);
    assert_eq!((force.get(&draft), approach.get(&draft)), (None, Some(4e-6)));
    let file = file_of(&draft.case);
    assert_eq!((file.get("load.force_n"), file.get("load.approach_m")), (None, Some(&4e-6)));
    force.set(&mut draft, 2e3);
    assert_eq!((force.get(&draft), approach.get(&draft)), (Some(2e3), None));
}

#[test]
fn forces_are_legal_between_their_limits_and_not_beyond() {
    for radius_m in [None, Some(-0.0101), Some(1.0)] {
        let mut case = legal_with(Key::find("load.force_n").unwrap());
        case.block.radius_m = radius_m;
        case.fatigue = Fatigue::default();
        let [least, most] = case.legal_forces_n();
        for (force_n, legal) in [
            (least * 1.0001, true),
            (most * 0.9999, true),
            (least * 0.99, false),
            (most * 1.01, false),
        ] {
            assert_eq!(case.clone().with_force(force_n).check().is_ok(), legal, "{force_n:e} N");
        }
    }
}

#[test]
fn an_approach_needs_a_legal_force() {
    // A raceway that all but fits the roller, and a wire.
    for (radius_m, length_m, hollow_m) in
        [(0.01, 0.01, Some(-0.010_000_01)), (1e-3, 10.0, None), (0.01, 0.01, Some(-0.0101))]
    {
        let mut case = legal_with(Key::find("load.approach_m").unwrap());
        case.roller.profile = None;
        (case.roller.radius_m, case.roller.length_m) = (radius_m, length_m);
        (case.block.radius_m, case.block.length_m) = (hollow_m, length_m);
        case.fatigue = Fatigue::default();
        case.load.approach_m = Some(1e-6);
        let [least, most] = case.legal_forces_n();
        match case.check() {
            Ok(()) => assert!(least <= most),
            Err(error) => {
                let said = error.to_string();
                assert!(least > most && said.contains("no force is legal for these"), "{said}");
            }
        }
        assert_eq!(least > most, hollow_m != Some(-0.0101), "{least} {most}");
    }
}

#[test]
fn every_factor_is_a_key() {
    let fields = serde_json::to_value(every_field().factors()).unwrap();
    let keys: Vec<&Key> =
        KEYS.iter().filter(|key| key.presence == Presence::With(Form::Factors)).collect();
    assert_eq!(keys.len(), fields.as_object().unwrap().len());
    for key in keys {
        let mut draft = Draft::of(&legal_with(key), Form::Factors);
        let wanted = 0.5 * key.get(&draft).unwrap();
        key.set(&mut draft, wanted);
        let again = Draft::of(&draft.case().unwrap(), Form::Factors);
        assert!((key.get(&again).unwrap() / wanted - 1.0).abs() < 1e-13, "{}", key.path);
        assert_eq!(key.get(&Draft::of(&legal_with(key), Form::Load)), None);
    }
}

/// Whether an error is about this value of a key, which it rounds or, beside a limit, does not.
fn names(said: &str, key: &Key, value: f64) -> bool {
    let shown = [format!("{value:e}"), stated(value)];
    shown.iter().any(|value| said.starts_with(&format!("{} = {value} is not valid: ", key.path)))
}

#[test]
fn keys_are_told_apart_and_their_examples_are_legal() {
    for (i, key) in KEYS.iter().enumerate() {
        assert!(KEYS[..i].iter().all(|k| k.path != key.path && k.column != key.column));
        key.check(key.example.parse().unwrap()).unwrap();
        for end in [key.range.0, key.range.1] {
            key.check(end).unwrap();
        }
        let zero = key.check(0.0).is_ok();
        assert_eq!(zero, key.range.0 <= 0.0 && key.path != "block.radius_m", "{}", key.path);
        for beyond in [key.range.0.next_down(), key.range.1.next_up(), f64::NAN, f64::INFINITY] {
            let said = key.check(beyond).unwrap_err().to_string();
            assert!(names(&said, key, beyond), "{said}");
        }
    }
}

#[test]
fn every_key_is_checked_as_a_part_of_its_case() {
    for key in &KEYS {
        let form = if key.is_of(Form::Load) { Form::Load } else { Form::Factors };
        let mut draft = Draft::of(&legal_with(key), form);
        draft.case().unwrap();
        let low = key.range.0 - 1.0;
        key.set(&mut draft, low);
        let said = draft.case().unwrap_err().to_string();
        assert!(names(&said, key, low), "{said}");
    }
}

#[test]
fn a_name_of_another_alphabet_is_refused() {
    for name in ["", ".", ".a", "a/b", "a b", "über", "a\n", &"x".repeat(65)] {
        let said = Case { name: name.into(), ..every_field() }.check().unwrap_err().to_string();
        assert!(said.starts_with(&format!("name = {name:?} is not valid: a name is 1 to 64")));
    }
}

#[test]
fn problems_differ_by_any_number_but_how_they_are_solved() {
    for key in KEYS.iter().filter(|key| key.is_of(Form::Load)) {
        let case = legal_with(key);
        let changed = |factor: f64| {
            let mut draft = Draft::of(&case, Form::Load).named("other");
            let value = key.get(&draft).unwrap();
            key.set(&mut draft, factor * value);
            draft.case().unwrap()
        };
        assert!(case.is_same_problem(&changed(1.0 + 1e-13)), "{}", key.path);
        let matters = !["fatigue", "accuracy", "cells"].contains(&key.table());
        assert_eq!(case.is_same_problem(&changed(1.0 + 1e-6)), !matters, "{}", key.path);
    }
}

#[test]
fn the_readme_explains_every_key_with_its_range() {
    let readme = include_str!("../../../cases/README.md");
    for key in &KEYS {
        let names = [key.path, key.leaf()].map(|name| format!("`{name}`"));
        let named = |row: &&str| row.starts_with('|') && names.iter().any(|n| row.contains(n));
        let row = readme.lines().find(named).unwrap_or_else(|| panic!("no row for {}", key.path));
        let numbers: Vec<f64> = row
            .split(|c: char| !c.is_ascii_alphanumeric() && !".-".contains(c))
            .filter_map(|word| word.parse().ok())
            .collect();
        for end in [key.range.0, key.range.1] {
            // The README says "less than 0.5".
            let there = numbers.iter().any(|v| (v - end).abs() <= f64::EPSILON * end.abs());
            assert!(there, "{} lacks {end:e}: {row}", key.path);
        }
    }
}

/// A value within a key's range; in equal ratios where the range has any.
fn legal(key: &'static Key) -> impl Strategy<Value = f64> {
    let (low, high) = key.range;
    (0.0..=1.0f64).prop_map(move |t| match low > 0.0 {
        true => (low.ln() + t * (high / low).ln()).exp().clamp(low, high),
        false => low + t * (high - low),
    })
}

proptest! {
    #[test]
    fn drafts_of_legal_numbers_are_refused_or_survive_their_file(
        values in KEYS.iter().map(legal).collect::<Vec<_>>(),
        form in prop_oneof![Just(Form::Load), Just(Form::Factors)],
    ) {
        let mut draft = Draft::new("drawn", form);
        for (key, value) in KEYS.iter().zip(values) {
            if !key.fits(&draft) {
                continue;
            }
            key.set(&mut draft, value);
            prop_assert_eq!(key.get(&draft), Some(value));
        }
        match draft.case() {
            Ok(case) => {
                let file = case.to_toml();
                prop_assert_eq!(&Case::parse(&file, Path::new("f.toml")).unwrap(), &case);
                let again = Draft::of(&case, form).case().unwrap();
                prop_assert!(again.is_same_problem(&case), "{:?} became {:?}", case, again);
            }
            // Legal numbers may make an illegal case; then a number of the list is to blame.
            Err(Error::Value { key, .. }) => prop_assert!(Key::find(&key).is_some(), "{}", key),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}
