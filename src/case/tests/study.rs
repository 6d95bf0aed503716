//! Studies of any factors.

use super::*;
use crate::base::BodyKind;
use std::collections::BTreeSet;

/// Two bodies without a load.
const BODIES: &str = "\
name = \"s\"
[roller]
radius_m = 10e-3
young_pa = 210e9
poisson = 0.3
[block]
young_pa = 210e9
poisson = 0.3
";

/// The load and the lengths by the factors.
const SCENE: &str = "[dimensionless]\nW = 3e-4\nS_l = 5.0\nL_r = 0.5\n";

fn study(parts: &[&str]) -> Study {
    let text = parts.concat();
    parse_study(&text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// C^2 / (2 R) of a case (m).
fn unit_drop(case: &Case) -> f64 {
    case.hertz().c_m.powi(2) / (2.0 * case.equivalent_radius_m())
}

#[test]
fn profiled_is_half_of_five_factors_and_a_centre() {
    let study = Study::find(Path::new("profiled")).unwrap();
    let design = study.design.as_ref().unwrap();
    assert_eq!(design.to_string(), "2^(5-1), resolution V");
    assert_eq!((study.corners.len(), study.cases().count()), (16, 17));
    let names: Vec<&str> = study.corners.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names[0], "w1e-4_sl5_lr0.5_drop0.5_ecc0.05");
    assert_eq!(names[1], "w1e-4_sl5_lr0.5_drop3_ecc0");
    assert_eq!(names[15], "w1e-3_sl10_lr1_drop3_ecc0.05");
    let mut runs = BTreeSet::new();
    for case in &study.corners {
        let coded: Vec<i8> = study
            .pairs()
            .into_iter()
            .map(|(key, [low, high])| {
                let value = key.of(case).unwrap();
                let near = |level: f64| (value - level).abs() < 1e-12 + 1e-9 * level;
                assert!(near(low) || near(high), "{}: {} = {value}", case.name, key.name());
                if near(high) { 1 } else { -1 }
            })
            .collect();
        assert_eq!(coded.iter().product::<i8>(), 1, "I = ABCDE in {}", case.name);
        let profile = case.profile(BodyKind::Roller).unwrap();
        let drop = profile.drop(0.5 * case.roller.length_m) / unit_drop(case);
        assert!((drop - if coded[3] > 0 { 3.0 } else { 0.5 }).abs() < 1e-9, "{}", case.name);
        let eccentricity = case.load.eccentricity_m.unwrap() / case.shorter_m();
        assert!((eccentricity - if coded[4] > 0 { 0.05 } else { 0.0 }).abs() < 1e-12);
        runs.insert(coded);
    }
    assert_eq!(runs.len(), 16);
    let centre = study.centre.as_ref().unwrap();
    let of = |name: &str| FactorKey::find(name).unwrap().of(centre).unwrap();
    for (name, wanted) in [
        ("W", 1e-7f64.sqrt()),
        ("S_l", 50f64.sqrt()),
        ("L_r", 0.75),
        ("roller.end_drop", 1.5f64.sqrt()),
        ("eccentricity", 0.025),
    ] {
        assert!((of(name) / wanted - 1.0).abs() < 1e-9, "{name}: {}", of(name));
    }
    assert!(Study::find(Path::new("nowhere")).unwrap_err().to_string().contains("profiled"));
}

#[test]
fn cases_of_built_in_studies_are_found_wherever_a_case_is() {
    let wanted = find_case(Path::new("w1e-3_sl5_lr1")).unwrap();
    let listed = study(&["name = \"s\"\ncases = [\"w1e-3_sl5_lr1\", \"profiled/centre\"]\n"]);
    assert_eq!(listed.extra[0], wanted);
    assert_eq!(listed.extra[1], find_case(Path::new("profiled/centre")).unwrap());
    let design = "case = \"w1e-3_sl5_lr1\"\n[profile]\nkind = \"crown\"\n[bounds]\n\
                  radius_m = [0.5, 5.0]\n[[loads]]\nforce_n = 1e3\n";
    let parse_design = |text: &str| Design::parse(text, Path::new("d.toml"));
    assert_eq!(parse_design(design).unwrap().case, wanted);
    let base = find_draft(Path::new("w1e-3_sl5_lr1")).unwrap();
    assert_eq!(base.form(), Form::Factors);
    assert!(base.case().unwrap().is_same_problem(&wanted));
    // Names that are none get the list of those that are some.
    for (name, wanted) in [
        ("flush-shrt", "did you mean flush-short?"),
        ("scenes", "is a study, not a case"),
        ("scenes/zzz", "or a built-in case: crown-inside"),
    ] {
        let listed = format!("name = \"s\"\ncases = [\"{name}\"]\n");
        let design = design.replace("w1e-3_sl5_lr1", name);
        for error in [parse_study(&listed).unwrap_err(), parse_design(&design).unwrap_err()] {
            assert!(error.to_string().contains(wanted), "{error}");
        }
    }
}

/// The rest of a study in which the number at `path` can be a factor.
fn rest_for(key: &Key) -> String {
    let (table, leaf) = (key.table(), key.leaf());
    let given = |text: &str, own: &str| {
        let lines = text.lines().filter(|line| !line.starts_with(&format!("{own} =")));
        lines.map(|line| format!("{line}\n")).collect::<String>()
    };
    if table.ends_with(".profile") {
        let kind = ProfileKind::ALL.into_iter().find(|kind| kind.keys().contains(&leaf)).unwrap();
        let others = kind.keys().iter().filter(|other| **other != leaf).map(|other| {
            let example = Key::find(&format!("{table}.{other}")).unwrap().example;
            format!("{other} = {example}\n")
        });
        let others: String = others.collect();
        return format!("{LOADED}[{table}]\nkind = \"{}\"\n{others}", kind.name());
    }
    if table == "fatigue" {
        let partner = match leaf {
            "dang_van_beta_pa" => "dang_van_alpha = 0.3",
            "yield_pa" => "fatemi_socie_k = 0.6",
            "fatemi_socie_k" => "yield_pa = 1.8e9",
            _ => "",
        };
        return format!("{BODIES}{SCENE}[fatigue]\n{partner}\n");
    }
    let body = |text: &str, body: &str| {
        let (first, second) = text.split_at(text.find("[block]").unwrap());
        match body {
            "roller" => given(first, leaf) + second,
            "block" => first.to_string() + &given(second, leaf),
            _ => text.to_string(),
        }
    };
    if key.is_of(Form::Load) && !key.is_of(Form::Factors) {
        let text = LOADED.replace("[accuracy]\ntolerance = 1e-2\n", "");
        return match leaf {
            "force_n" => text.replace("[load]\nforce_n = 1000\n", ""),
            _ => body(&text, table),
        };
    }
    match table {
        "dimensionless" => format!("{BODIES}{}", given(SCENE, leaf)),
        _ => format!("{}{SCENE}", body(BODIES, table)),
    }
}

#[test]
fn every_number_of_a_smooth_case_can_be_a_factor() {
    let has_no_effect = |key: &&Key| ["surface", "fatigue"].contains(&key.table());
    for key in KEYS.iter().filter(|key| !has_no_effect(key) && key.leaf() != "approach_m") {
        let example: f64 = key.example.parse().unwrap();
        let high = if example == 0.0 { 1e-5 } else { 0.9 * example };
        let levels = format!("{} = [{example:e}, {high:e}]", key.leaf());
        let rest = rest_for(key);
        // By its path, and by tables.
        let quoted = format!("[factors]\n\"{}\" = [{example:e}, {high:e}]\n", key.path);
        let nested = format!("[factors.{}]\n{levels}\n", key.table());
        for factors in [quoted, nested] {
            let study = study(&[&rest, &factors]);
            assert_eq!(study.factors.len(), 1);
            let [(factor, pair)] = study.pairs()[..] else { panic!("{}", key.path) };
            assert_eq!(factor.path(), key.path);
            assert_eq!(pair, [example.min(high), example.max(high)], "{}", key.path);
            let values: Vec<f64> =
                study.corners.iter().map(|case| factor.of(case).expect(key.path)).collect();
            for (value, level) in values.iter().zip([example, high]) {
                assert!((value - level).abs() <= 1e-12 * level.abs(), "{}: {value}", key.path);
            }
            assert!(study.corners.iter().all(|case| case.name.contains(&factor.token())));
        }
    }
    assert_eq!(FactorKey::all().count(), KEYS.len() - 2 + 3, "two distances of surfaces are none");
}

#[test]
fn factors_have_names_of_their_own() {
    for of in [|f: FactorKey| f.name().to_string(), |f: FactorKey| f.token()] {
        let all: BTreeSet<String> = FactorKey::all().map(of).collect();
        assert_eq!(all.len(), FactorKey::all().count(), "{all:?}");
    }
    for name in ["W", "dimensionless.W"] {
        assert_eq!(FactorKey::find(name).unwrap().name(), "W");
    }
    for (name, by_ratio) in [
        ("W", true),
        ("S_l", true),
        ("L_r", false),
        ("roller.young_pa", true),
        ("roller.profile.radius_m", true),
        ("roller.end_drop", true),
        ("load.force_n", true),
        ("roller.poisson", false),
        ("roller.profile.k", false),
        ("sliding.friction", false),
        ("pose.offset_m", false),
        ("block.radius_m", false),
        ("eccentricity", false),
        ("accuracy.tolerance", true),
    ] {
        assert_eq!(FactorKey::find(name).unwrap().is_by_ratio(), by_ratio, "{name}");
    }
}

#[test]
fn factors_have_the_units_of_their_numbers() {
    for (name, unit) in [
        ("W", None),
        ("S_l", None),
        ("block.poisson", None),
        ("roller.end_drop", Some("C²/2R")),
        ("eccentricity", Some("lengths of the shorter body")),
        ("roller.radius_m", Some("m")),
        ("block.young_pa", Some("Pa")),
        ("pose.tilt_rad", Some("rad")),
    ] {
        assert_eq!(FactorKey::find(name).unwrap().unit(), unit, "{name}");
    }
}

#[test]
fn an_end_drop_is_that_of_the_profile_at_the_end() {
    for profile in [
        "kind = \"crown\"",
        "kind = \"relief\"\nstraight_m = 1e-3",
        "kind = \"logarithmic\"\nk = 0.95",
        "kind = \"fujiwara\"\ndesign_force_n = 5000.0\nk1 = 1.5\nk2 = 0.6",
    ] {
        for body in ["roller", "block"] {
            let table = format!("[{body}.profile]\n{profile}\n");
            let factors = format!("[factors]\nW = [1e-4, 1e-3]\n\"{body}.end_drop\" = [0.4, 2]\n");
            let scene = SCENE.replace("W = 3e-4\n", "");
            let study = study(&[BODIES, &scene, &table, &factors]);
            let kind = if body == "block" { BodyKind::Block } else { BodyKind::Roller };
            for (case, level) in study.corners.iter().zip([0.4, 2.0, 0.4, 2.0]) {
                let [from, to] = case.ends_m(kind);
                let drop = case.profile(kind).unwrap().drop(0.5 * (to - from)) / unit_drop(case);
                assert!((drop / level - 1.0).abs() < 1e-6, "{body} {profile}: {drop}");
            }
        }
    }
}

#[test]
fn a_study_may_stand_on_lengths_and_forces() {
    let text = LOADED.replace("force_n = 1000\n", "").replace("[load]\n", "");
    let factors = "[factors]\n\"load.force_n\" = [500, 1000]\neccentricity = [0, 0.02]\n\
                   \"sliding.friction\" = [0, 0.2]\n";
    let generated = format!("generators = [\"C = -AB\"]\ncentre = true\n{text}{factors}");
    let study = parse_study(&generated).unwrap();
    let names: Vec<&str> = study.cases().map(|c| c.name.as_str()).collect();
    let wanted = ["force500_ecc0_friction0", "force500_ecc0.02_friction0.2"];
    assert_eq!(names[..2], wanted);
    assert_eq!(names[4], "centre");
    let far = &study.corners[1];
    assert_eq!((far.load.force_n, far.sliding.friction), (500.0, 0.2));
    assert!(close(far.load.eccentricity_m.unwrap(), 0.02 * 20e-3));
    let centre = study.centre.as_ref().unwrap();
    assert!(close(centre.load.force_n, 5e5f64.sqrt()), "{centre:?}");
    assert_eq!(study.design.unwrap().to_string(), "2^(3-1), resolution III");
}

#[test]
fn cases_with_names_that_are_too_long_are_numbered() {
    let profile = "[roller.profile]\nkind = \"logarithmic\"\n";
    let factors = "[factors]\n\"roller.profile.amplitude_m\" = [1.25e-6, 2.25e-6]\n\
                   \"roller.profile.k\" = [0.9125, 0.9525]\n\"block.young_pa\" = [2.1e11, 2.2e11]\n";
    let study = study(&[
        BODIES.split_at(BODIES.find("[block]").unwrap()).0,
        "[block]\npoisson = 0.3\n",
        SCENE,
        profile,
        factors,
    ]);
    let names: Vec<&str> = study.corners.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, (1..=8).map(|i| format!("run-{i}")).collect::<Vec<_>>());
}

#[test]
fn errors_of_factors_name_key_line_and_remedy() {
    let profile = "[roller.profile]\nkind = \"logarithmic\"\nk = 0.9\n";
    let w = "[factors]\nW = [1e-4, 1e-3]\n";
    let scene = SCENE.replace("W = 3e-4\n", "");
    for (parts, place, wanted) in [
        (
            [SCENE, "[factors]\n\"roller.poison\" = [0.2, 0.3]\n", ""],
            "\"roller.poison\"",
            "unknown key factors.roller.poison; did you mean roller.poisson?",
        ),
        (
            [SCENE, "[factors.roller]\npoison = [0.2, 0.3]\n", ""],
            "poison",
            "did you mean roller.poisson?",
        ),
        (
            [SCENE, "[factors]\n\"surface.dx_m\" = [1e-6, 2e-6]\n", ""],
            "\"surface.dx_m\"",
            "unknown key",
        ),
        ([SCENE, "[factors]\n", ""], "[factors]", "there is no factor"),
        (
            [SCENE, "[factors]\n\"roller.poisson\" = [0.2, 0.3]\n", ""],
            "poisson = 0.3",
            "roller.poisson = 0.3 is not valid: the factor roller.poisson sets it",
        ),
        ([SCENE, w, ""], "W = 3e-4", "the factor W sets it; remove it, or the factor"),
        (
            [&scene, w, "\"dimensionless.W\" = [1e-4, 1e-3]\n"],
            "\"dimensionless.W\"",
            "this factor is there already",
        ),
        (
            [&scene, w, "\"load.force_n\" = [1, 2]\n"],
            "\"load.force_n\"",
            "the load and the lengths are given twice",
        ),
        (
            [&scene, w, "\"roller.end_drop\" = [0.5, 2]\n"],
            "\"roller.end_drop\"",
            "the roller has no profile",
        ),
        (
            [&scene, w, "\"roller.profile.k\" = [0.5, 0.9]\n"],
            "\"roller.profile.k\"",
            "[roller.profile] has no k, by its kind",
        ),
        (
            [&scene, profile, "[factors]\nW = [1e-4]\n\"roller.end_drop\" = [0, 2]\n"],
            "\"roller.end_drop\"",
            "an end drop lies between 1e-6 and 1e6",
        ),
        (
            [
                &scene,
                profile,
                "[factors]\nW = [1e-4]\n\"roller.end_drop\" = [1, 2]\n\"roller.profile.amplitude_m\" = [1e-6, 2e-6]\n",
            ],
            "\"roller.profile.amplitude_m\"",
            "another factor sets roller.profile.amplitude_m too",
        ),
        (
            [
                &scene,
                "[roller.profile]\nkind = \"lundberg\"\ndesign_force_n = 500\n",
                "[factors]\nW = [1e-4]\n\"roller.end_drop\" = [1, 2]\n",
            ],
            "\"roller.end_drop\"",
            "no number of the profile lundberg sets its end drop; give [roller.profile] one of the kinds crown",
        ),
        ([&scene, w, "eccentricity = [0, 5]\n"], "eccentricity", "less than 1"),
        ([&scene, w, "eccentricity = [0, 0.6]\n"], "[factors]", "lies outside the overlap"),
        (["", w, ""], "[factors]", "factors.S_l is missing; add for example `S_l = [low, high]`"),
        (
            ["[load]\nforce_n = 1\n", "[factors]\n\"load.approach_m\" = [1e-6, 2e-6]\n", ""],
            "\"load.approach_m\"",
            "every model would find another force",
        ),
        (
            [
                &scene,
                "[fatigue]\nfatemi_socie_k = 0.6\n",
                "[factors]\n\"fatigue.yield_pa\" = [1e9, 2e9]\n",
            ],
            "\"fatigue.yield_pa\"",
            "a study tells nothing of fatigue; remove it: `edgeline fatigue` takes a case",
        ),
        (
            ["[load]\napproach_m = 1e-6\n", "[factors]\n\"roller.poisson\" = [0.2, 0.3]\n", ""],
            "approach_m",
            "every model would find another force",
        ),
    ] {
        // A number that is a factor stands in the factors alone, but where that is the mistake.
        let bodies = match wanted.contains("sets it") || !parts.concat().contains("roller.poisson")
        {
            true => BODIES.to_string(),
            false => BODIES.replacen("poisson = 0.3\n", "", 1),
        };
        let text = bodies + &parts.concat();
        let message = parse_study(&text).expect_err(&text).to_string();
        assert!(message.contains(wanted), "{message}\n{text}");
        let line = 1 + text.lines().position(|l| l.starts_with(place)).unwrap();
        assert!(message.starts_with(&format!("f.toml:{line}: ")), "{message}\n{text}");
    }
}

#[test]
fn errors_of_generators_name_the_line_and_the_remedy() {
    let factors = "[factors]\nW = [1e-4, 1e-3]\nS_l = [5, 10]\nL_r = [0.5, 1]\n";
    let one = factors.replace("[0.5, 1]", "[0.5]");
    for (generators, factors, wanted) in [
        (
            "[\"C = AB\"]",
            &one[..],
            "a fractional design has two levels of each factor, and L_r has 1",
        ),
        ("[\"D = AB\"]", factors, "the generator of C is a product of the factors A to B"),
        ("[\"C = A\"]", factors, "it gives two factors the same levels"),
        ("[]", factors, "the list is empty"),
        ("\"C = AB\"", factors, "a list belongs here"),
        ("[3]", factors, "a text belongs here"),
    ] {
        let text = format!("generators = {generators}\n{BODIES}{factors}");
        let message = parse_study(&text).expect_err(generators).to_string();
        assert!(message.contains(wanted), "{message}");
        assert!(message.starts_with("f.toml:1: "), "{message}");
    }
}

#[test]
fn a_study_may_list_cases_alone() {
    let listed = study(&["name = \"s\"\ncases = [\"sliding-half\", \"flush-short\"]\n"]);
    let names: Vec<&str> = listed.cases().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ["sliding-half", "flush-short"]);
    assert!(listed.factors.is_empty() && listed.design.is_none() && listed.pairs().is_empty());
    // What a design alone has is refused.
    for more in ["centre = true\n", "[roller]\nradius_m = 1.0\n"] {
        let text = format!("name = \"s\"\ncases = [\"flush-short\"]\n{more}");
        let error = parse_study(&text).unwrap_err().to_string();
        assert!(error.contains("unknown key"), "{more}: {error}");
    }
    let error = parse("name = \"s\"\ncases = [\"flush-short\"]\n").unwrap_err().to_string();
    assert!(error.contains("is a study file, not a case file"), "{error}");
}
