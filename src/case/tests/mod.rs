mod keys;
mod study;
mod sweep;

use super::*;
use crate::base::Error;
use proptest::prelude::*;
use std::path::Path;

const DIMENSIONLESS: &str = "\
name = \"one\"
[roller]
radius_m = 10e-3
young_pa = 210e9
poisson = 0.3
[block]
young_pa = 210e9
poisson = 0.3
[dimensionless]
W = 5e-4
S_l = 5.0
L_r = 0.5
";

const LOADED: &str = "\
name = \"two\"
[roller]
radius_m = 10e-3
length_m = 20e-3
young_pa = 210e9
poisson = 0.3
[block]
length_m = 40e-3
young_pa = 70e9
poisson = 0.33
[load]
force_n = 1000
[accuracy]
tolerance = 1e-2
";

fn parse(text: &str) -> crate::base::Result<Case> {
    Case::parse(text, Path::new("f.toml"))
}

fn parse_study(text: &str) -> crate::base::Result<Study> {
    Study::parse(text, Path::new("f.toml"))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * b.abs()
}

#[test]
fn a_case_survives_its_file() {
    for text in [DIMENSIONLESS, LOADED] {
        let case = parse(text).unwrap();
        assert_eq!(parse(&case.to_toml()).unwrap(), case);
        let other = Case {
            name: "other".into(),
            accuracy: Accuracy { tolerance: 1e-4, first_order: true },
            ..case.clone()
        };
        assert!(case.is_same_problem(&other));
        let longer = Block { length_m: 1.001 * case.block.length_m, ..case.block.clone() };
        assert!(!case.is_same_problem(&Case { block: longer, ..case.clone() }));
    }
}

#[test]
fn dimensionless_case_has_its_factors() {
    let case = parse(DIMENSIONLESS).unwrap();
    let (factors, hertz) = (case.factors(), case.hertz());
    assert!(close(factors.load, 5e-4), "{factors:?}");
    assert!(close(factors.slenderness, 5.0), "{factors:?}");
    assert!(close(factors.length_ratio, 0.5), "{factors:?}");
    // C = 2 R sqrt(W / pi), p0 = E* sqrt(W / pi).
    let root = (5e-4 / std::f64::consts::PI).sqrt();
    assert!(close(hertz.c_m, 20e-3 * root));
    assert!(close(hertz.p0_pa, 210e9 / (2.0 * 0.91) * root));
    assert_eq!(case.accuracy, Accuracy::default());
}

#[test]
fn loaded_case_keeps_its_values() {
    let case = parse(LOADED).unwrap();
    assert_eq!((case.load.force_n, case.accuracy.tolerance), (1000.0, 1e-2));
    assert_eq!((case.roller.length_m, case.block.length_m), (20e-3, 40e-3));
    assert_eq!(case.block.material, crate::base::Material { young_pa: 70e9, poisson: 0.33 });
    assert!(close(case.factors().length_ratio, 0.5));
}

/// Replaces one line of `text` and returns the error's text.
fn broken(text: &str, line: &str, with: &str) -> String {
    assert!(text.contains(line), "{line} is not in the text");
    parse(&text.replacen(line, with, 1)).expect_err(with).to_string()
}

/// A line of a file, its replacement, and a part of the error.
type Mistake = (&'static str, &'static str, &'static str);

const MISTAKES: &[Mistake] = &[
    ("poisson = 0.3", "poison = 0.3", "f.toml:5: unknown key roller.poison; did you mean poisson?"),
    ("poisson = 0.3", "poisson = 0.5", "f.toml:5: roller.poisson = 0.5 is not valid"),
    ("poisson = 0.3", "poisson = -0.1", "f.toml:5: roller.poisson = -0.1 is not valid"),
    ("radius_m = 10e-3", "radius_m = 0", "f.toml:3: roller.radius_m = 0 is not valid"),
    ("radius_m = 10e-3", "radius_m = nan", "f.toml:3: roller.radius_m = nan is not valid"),
    ("radius_m = 10e-3", "radius_m = inf", "f.toml:3: roller.radius_m = inf is not valid"),
    ("radius_m = 10e-3", "radius_m = 1e999", "f.toml:3: "),
    ("radius_m = 10e-3", "radius_m = 0x10", "f.toml:3: roller.radius_m = 0x10 is not valid"),
    ("radius_m = 10e-3", "radius_m = \"10\"", "f.toml:3: roller.radius_m = \"10\" is not valid"),
    ("radius_m = 10e-3", "radius_m = [10]", "f.toml:3: roller.radius_m = [10] is not valid"),
    (
        "radius_m = 10e-3",
        "radius = 10e-3",
        "f.toml:3: unknown key roller.radius; did you mean radius_m?",
    ),
    ("radius_m = 10e-3", "", "f.toml:2: roller.radius_m is missing; add for example `radius_m"),
    ("radius_m = 10e-3", "radius_m 10e-3", "f.toml:3: is not valid TOML"),
    ("radius_m = 10e-3", "radius_m = 1\nradius_m = 2", "f.toml:4: is not valid TOML"),
    ("young_pa = 210e9", "young_pa = 210", "f.toml:4: roller.young_pa = 210 is not valid"),
    (
        "L_r = 0.5",
        "L_r = 2e3",
        "f.toml:12: dimensionless.L_r = 2e3 is not valid: L_r = L1 / L2 lies between 0.001 and 1000",
    ),
    ("L_r = 0.5", "", "f.toml:9: dimensionless.L_r is missing"),
    ("W = 5e-4", "W = -5e-4", "f.toml:10: dimensionless.W = -5e-4 is not valid"),
    ("W = 5e-4", "w = 5e-4", "f.toml:10: unknown key dimensionless.w; did you mean W?"),
    ("S_l = 5.0", "S_l = 0.1", "f.toml:11: dimensionless.S_l = 0.1 is not valid"),
    (
        "[block]",
        "[block]\nlength_m = 1",
        "f.toml:7: block.length_m = 1 is not valid: the lengths follow",
    ),
    ("[block]", "[blok]", "f.toml:6: unknown key blok; did you mean block?"),
    ("name = \"one\"", "name = \"a/b\"", "f.toml:1: name = \"a/b\" is not valid"),
    ("name = \"one\"", "name = 1", "f.toml:1: name = 1 is not valid: a text belongs here"),
    ("name = \"one\"", "name = \"one\"\nroller = 3", "is not valid TOML"),
    (
        "[dimensionless]",
        "[load]\nforce_n = 1\n[dimensionless]",
        "f.toml:9: the load is given twice",
    ),
    (
        "[dimensionless]",
        "[accuracy]\ntolerance = 0.5\n[dimensionless]",
        "f.toml:10: accuracy.tolerance = 0.5",
    ),
    ("[dimensionless]", "[factors]", "is a study file"),
    ("[dimensionless]", "[sweep]", "is a sweep file"),
    ("W = 5e-4", "W = [1e-4, 5e-4]", "write one, or run `edgeline sweep` on the file"),
];

const LOADED_MISTAKES: &[Mistake] = &[
    (
        "length_m = 40e-3",
        "length_m = 19e-6",
        "f.toml:8: block.length_m = 19e-6 is not valid: L_r = L1 / L2 becomes 1.053e3",
    ),
    ("length_m = 20e-3", "", "f.toml:2: roller.length_m is missing"),
    ("force_n = 1000", "force_n = 1e12", "f.toml:12: load.force_n = 1e12 is not valid: W = "),
    (
        "force_n = 1000",
        "force_n = 1000\nunit = 1",
        "f.toml:13: unknown key load.unit; [load] takes force_n",
    ),
    (
        "force_n = 1000",
        "force_n = 1000\napproach_m = 5e-6",
        "f.toml:13: load.approach_m = 5e-6 is not valid: force_n gives the load already; remove force_n or",
    ),
    ("force_n = 1000", "eccentricity_m = 0", "f.toml:11: load.force_n is missing; add for example"),
    ("force_n = 1000", "approach_m = -5e-6", "f.toml:12: load.approach_m = -5e-6 is not valid"),
];

#[test]
fn errors_name_key_line_and_remedy() {
    for (text, mistakes) in [(DIMENSIONLESS, MISTAKES), (LOADED, LOADED_MISTAKES)] {
        for (line, with, wanted) in mistakes {
            let message = broken(text, line, with);
            assert!(message.contains(wanted), "{with}: {message}");
        }
    }
    let cut = DIMENSIONLESS.split("[dimensionless]").next().unwrap();
    let message = parse(cut).unwrap_err().to_string();
    assert!(message.contains("f.toml: there is no load"), "{message}");
}

/// The case of [`LOADED`] with these profiles.
fn profiled(roller: &str, block: &str) -> crate::base::Result<Case> {
    let profile = |body: &str, keys: &str| match keys {
        "" => String::new(),
        keys => format!("[{body}.profile]\n{keys}\n"),
    };
    parse(&format!("{LOADED}{}{}", profile("roller", roller), profile("block", block)))
}

#[test]
fn a_drop_of_both_bodies_together_is_not_given_twice() {
    let kinds = [
        "kind = \"lundberg\"\ndesign_force_n = 500",
        "kind = \"johns-gohar\"\ndesign_force_n = 500",
        "kind = \"iso-16281\"",
        "kind = \"fujiwara\"\ndesign_force_n = 500\nk1 = 1.5\nk2 = 0.6\nzm_m = 1e-5",
    ];
    for own in kinds {
        for other in kinds {
            let said = profiled(own, other).unwrap_err().to_string();
            assert!(said.contains("block.profile.kind") && said.contains("both bodies"), "{said}");
        }
        profiled(own, "").unwrap();
        profiled("kind = \"crown\"\nradius_m = 10", own).unwrap();
    }
}

#[test]
fn a_table_drops_nowhere_by_half_of_the_radius() {
    // The radius is 10 mm and the roller 20 mm long; points beyond its ends do not count.
    let of = |drops: [f64; 5]| {
        let mut case = parse(LOADED).unwrap();
        let y = [-15e-3, -10e-3, 2e-3, 10e-3, 15e-3];
        let table = crate::base::profile::Table::new(y.to_vec(), drops.to_vec());
        let mut spec = ProfileSpec::new(ProfileKind::Table);
        spec.table = Some(std::sync::Arc::new(table));
        case.roller.profile = Some(spec);
        case.check().map_err(|e| e.to_string())
    };
    of([1.0, 0.0, 4.9e-3, 0.0, 1.0]).unwrap();
    of([1.0, 2.4e-3, -2.4e-3, 2.4e-3, 1.0]).unwrap();
    for (drops, wanted) in [
        ([0.0, 0.0, 1.0, 0.0, 0.0], "drops by 1 m at y = 0.002 m, which no small slope allows"),
        ([0.0, 0.0, 5e-3, 0.0, 0.0], "drops by 0.005 m at y = 0.002 m"),
        ([0.0, 0.0, -1.0, 0.0, 0.0], "m at the body's end"),
        ([0.0, 0.0, 0.0, 1.0, 1.0], "m at the body's end"),
        ([1.0; 5], "drops by 1 m at the body's end"),
    ] {
        let said = of(drops).unwrap_err();
        assert!(said.contains("roller.profile.kind") && said.contains(wanted), "{drops:?}: {said}");
    }
}

/// Beyond the force whose Hertz half-width b is a / 0.3033 the profile would be a straight line.
#[test]
fn a_force_under_which_johns_and_gohars_profile_does_not_drop_is_refused() {
    let of =
        |force: f64| profiled(&format!("kind = \"johns-gohar\"\ndesign_force_n = {force:e}"), "");
    let (case, force) = (of(500.0).unwrap(), 500.0);
    // b grows with the root of the force, and at the limit the drop vanishes.
    let b = Case { load: Load { force_n: force, ..case.load }, ..case.clone() }.hertz().c_m;
    let most = force * (10e-3 / 0.3033 / b).powi(2);
    let profile = of(0.9999 * most).unwrap().profile(crate::base::BodyKind::Roller).unwrap();
    assert!(profile.drop(10e-3) > 0.0);
    let said = of(1.0001 * most).unwrap_err().to_string();
    assert!(said.contains("roller.profile.design_force_n"), "{said}");
    assert!(said.contains(&format!("less than {most:.4e} N")), "{said}");
}

#[test]
fn missing_file_names_the_built_in_cases() {
    let message = Case::find(Path::new("flush-shirt")).unwrap_err().to_string();
    assert!(message.contains("no such file; did you mean flush-short? "), "{message}");
    let folder = tempfile::tempdir().unwrap();
    for (path, wanted) in [
        (folder.path(), ": is a folder; give a case file"),
        (Path::new("-"), "-: no such file; for a case from standard input give /dev/stdin"),
        (Path::new("factorial"), "is a study, not a case; run `edgeline study factorial`"),
    ] {
        let message = Case::find(path).unwrap_err().to_string();
        assert!(message.contains(wanted) && message.contains("flush-short"), "{message}");
    }
    let message = Study::find(folder.path()).unwrap_err().to_string();
    assert!(message.contains(": is a folder; give a study file"), "{message}");
    assert_eq!(Case::find(Path::new("flush-short")).unwrap().name, "flush-short");
}

#[test]
fn errors_of_a_solution_have_their_place_in_the_case_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.toml");
    std::fs::write(&path, LOADED).unwrap();
    let placed = |path: &Path, key: &str| {
        let (key, reason, remedy) = (key.into(), "why".into(), "what to do".into());
        let error = Error::Value { key, value: "9".into(), reason, remedy };
        Case::place(path, error).to_string()
    };
    let said = placed(&path, "load.force_n");
    assert!(
        said.ends_with("f.toml:12: load.force_n = 1000 is not valid: why; what to do"),
        "{said}"
    );
    for (path, key) in [(&*path, "--loads"), (Path::new("flush-short"), "load.force_n")] {
        assert_eq!(placed(path, key), format!("{key} = 9 is not valid: why; what to do"));
    }
    let late = Error::NotConverged { iterations: 3, residual: 0.5, remedy: "wait".into() };
    let said = Case::place(&path, late).to_string();
    assert!(said.contains("f.toml: contact did not converge after 3 iterations"), "{said}");
}

#[test]
fn files_that_are_no_text_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("binary.toml");
    std::fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    assert!(Case::read(&path).unwrap_err().to_string().contains("UTF-8"));
    std::fs::write(&path, vec![b'#'; 2 << 20]).unwrap();
    assert!(Case::read(&path).unwrap_err().to_string().contains("1 MiB"));
    assert!(Case::read(folder.path()).unwrap_err().to_string().contains("cannot read"));
}

#[test]
fn default_study_is_the_two_level_factorial() {
    let study = Study::built_in();
    let names: Vec<&str> = study.cases().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "w1e-4_sl5_lr0.5",
            "w1e-4_sl5_lr1",
            "w1e-4_sl20_lr0.5",
            "w1e-4_sl20_lr1",
            "w1e-3_sl5_lr0.5",
            "w1e-3_sl5_lr1",
            "w1e-3_sl20_lr0.5",
            "w1e-3_sl20_lr1",
            "centre",
        ]
    );
    let low = study.corners[0].factors();
    assert!(close(low.load, 1e-4) && close(low.slenderness, 5.0) && close(low.length_ratio, 0.5));
    let centre = study.centre.unwrap().factors();
    assert!(close(centre.load, 1e-7f64.sqrt()) && close(centre.slenderness, 10.0), "{centre:?}");
    assert!(close(centre.length_ratio, 0.75), "{centre:?}");
}

#[test]
fn study_lists_further_cases_beside_it_or_built_in() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mine.toml"), LOADED).unwrap();
    let path = folder.path().join("study.toml");
    let text = format!("cases = [\"mine.toml\", \"flush-short\"]\n{DEFAULT_STUDY}");
    std::fs::write(&path, text).unwrap();
    let study = Study::read(&path).unwrap();
    let names: Vec<&str> = study.extra.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["two", "flush-short"]);
    assert_eq!(study.cases().count(), 11);
}

#[test]
fn study_errors_name_key_line_and_remedy() {
    let line = |key: &str| {
        1 + DEFAULT_STUDY.lines().position(|l| l.starts_with(key)).expect("key in the study")
    };
    for (key, with, wanted) in [
        ("W = ", "W = []", "factors.W = [] is not valid: the list is empty"),
        ("centre = ", "cases = []", "cases = [] is not valid: the list is empty"),
        ("W = ", "W = 1e-4", "factors.W = 1e-4 is not valid: a list belongs here"),
        ("W = ", "W = [1e-4, 1e-4]", "factors.W = 1e-4 is not valid: this level is there already"),
        ("W = ", "W = [1e-4, -1]", "factors.W = -1 is not valid"),
        (
            "L_r = ",
            "L_r = [0.5, 1500]",
            "factors.L_r = 1500 is not valid: L_r = L1 / L2 lies between 0.001 and 1000",
        ),
        ("S_l = ", "S_1 = [5]", "unknown key factors.S_1; did you mean S_l?"),
        ("centre = ", "centre = 1", "centre = 1 is not valid"),
        (
            "centre = ",
            "cases = [\"nowhere.toml\"]",
            "cases = \"nowhere.toml\" is not valid: there is no file",
        ),
        (
            "centre = ",
            "cases = [\"flush-short\", \"flush-short\"]",
            "another case called flush-short",
        ),
    ] {
        let number = line(key);
        let mut lines: Vec<&str> = DEFAULT_STUDY.lines().collect();
        lines[number - 1] = with;
        let message = parse_study(&lines.join("\n")).expect_err(with).to_string();
        assert!(message.contains(wanted), "{with}: {message}");
        assert!(message.starts_with(&format!("f.toml:{number}: ")), "{with}: {message}");
    }
    let message = parse_study(DIMENSIONLESS).unwrap_err().to_string();
    assert!(message.contains("is a case file, not a study file"), "{message}");
    let many: Vec<String> = (1..=2100).map(|i| format!("{i}")).collect();
    let text = DEFAULT_STUDY.replace("S_l = [5.0, 20.0]", &format!("S_l = [{}]", many.join(",")));
    assert!(parse_study(&text).unwrap_err().to_string().contains("more than 4096 cases"));
}

/// A valid file with one slice replaced by arbitrary text.
fn mutilated() -> impl Strategy<Value = String> {
    let files = prop_oneof![Just(DIMENSIONLESS), Just(LOADED), Just(DEFAULT_STUDY)];
    (files, any::<(prop::sample::Index, usize)>(), "\\PC{0,12}|[\\[\\]{}=\"\n#,.0-9e+-]{0,12}")
        .prop_map(|(text, (at, length), with)| {
            let start = at.index(text.len());
            let end = (start + length % 20).min(text.len());
            format!("{}{with}{}", &text[..start], &text[end..])
        })
}

proptest! {
    #[test]
    fn no_text_panics(text in "(\\PC|[\n\\[\\]=\"])*") {
        let _ = parse(&text);
        let _ = parse_study(&text);
    }

    #[test]
    fn mutilated_files_give_an_error_or_a_legal_case(text in mutilated()) {
        if let Ok(case) = parse(&text) {
            prop_assert!(case.load.force_n > 0.0 && case.hertz().c_m > 0.0);
            case.check().unwrap();
        }
        if let Ok(study) = parse_study(&text) {
            for case in study.cases() {
                case.check().unwrap();
            }
        }
    }

    #[test]
    fn factors_survive_the_way_through_si_units(
        load in 1e-8..0.05f64,
        slenderness in 0.5..1e4f64,
        length_ratio in 1e-3..=1.0f64,
        poisson in 0.0..0.5f64,
    ) {
        let wanted = Factors { load, slenderness, length_ratio };
        let steel = crate::base::Material { young_pa: 2e11, poisson };
        let got = Case::from_factors("p", 0.01, steel, steel, wanted).factors();
        prop_assert!((got.load / load - 1.0).abs() < 1e-13);
        prop_assert!((got.slenderness / slenderness - 1.0).abs() < 1e-13);
        prop_assert!((got.length_ratio / length_ratio - 1.0).abs() < 1e-13);
    }
}

#[test]
fn what_follows_from_factors_is_held_to_the_ranges_of_files() {
    let case = |radius: &str, young: &str, slenderness: &str| {
        let body = format!("young_pa = {young}\npoisson = 0.3");
        let text = format!(
            "name = \"a\"\n[roller]\nradius_m = {radius}\n{body}\n[block]\n{body}\n\
             [dimensionless]\nW = 0.05\nS_l = {slenderness}\nL_r = 0.5\n"
        );
        let study = text.replace("[dimensionless]", "[factors]").replace("W = 0.05", "W = [0.05]");
        let study = study
            .replace(&format!("S_l = {slenderness}"), &format!("S_l = [{slenderness}]"))
            .replace("L_r = 0.5", "L_r = [0.5]");
        let case = Case::parse(&text, Path::new("c.toml"));
        let study = Study::parse(&study, Path::new("c.toml")).map(|s| s.corners[0].clone());
        assert_eq!(case.is_ok(), study.is_ok());
        (case, study)
    };
    for (radius, young, slenderness, wanted) in [
        ("1e4", "210e9", "1e4", "the roller's length in metres lies between 1e-9 and 10000"),
        ("5e3", "210e9", "2", "the block's length in metres lies between 1e-9 and 10000"),
        ("1e4", "1e14", "0.5", "the load in newtons lies between 1e-12 and 1e15"),
    ] {
        let (case, study) = case(radius, young, slenderness);
        for said in [case.unwrap_err(), study.unwrap_err()] {
            assert!(said.to_string().contains(wanted), "{said}");
        }
    }
    // A case on a limit is a rounding beyond it when it is read from its own file.
    for radius in ["1e-3", "3e-3", "7e-3", "0.011", "0.013"] {
        let case = case(radius, "2.3e11", "0.5").0.unwrap();
        assert!(Case::parse(&case.to_toml(), Path::new("again")).unwrap().is_same_problem(&case));
    }
}

/// Numbers that do not follow from W, S_l and L_r are corrected where they stand.
#[test]
fn a_case_by_factors_keeps_the_remedies_of_its_other_numbers() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("heights.csv"), "0,0\n0,2\n").unwrap();
    let surface = "[surface]\nheights = \"heights.csv\"\ndx_m = 1e-6\ndy_m = 1e-6\n";
    for (more, wanted) in [
        (surface, "the heights range over 2 m, more than a tenth of the roller's radius"),
        (surface, "give heights in metres"),
        ("eccentricity_m = 1.0\n", "f.toml:13: dimensionless.eccentricity_m = 1.0 is not valid"),
        ("eccentricity_m = 1.0\n", "place it between the ends of the overlap"),
    ] {
        let text = format!("{DIMENSIONLESS}{more}");
        let said = Case::parse(&text, &folder.path().join("f.toml")).unwrap_err().to_string();
        assert!(said.contains(wanted) && !said.contains("follows from W"), "{said}");
    }
}

/// What is written of a case can stand in any folder; its files are what stands in them, not where.
#[test]
fn cases_with_files_are_read_from_any_folder_and_known_by_their_content() {
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, drop: &str, height: &str| {
        let own = folder.path().join(name);
        std::fs::create_dir(&own).unwrap();
        let table = format!("y_m,drop_m\n-0.01,{drop}\n0,0\n0.01,0\n");
        std::fs::write(own.join("drops.csv"), table).unwrap();
        std::fs::write(own.join("heights.csv"), format!("0,0\n0,{height}\n")).unwrap();
        let text = LOADED.replacen(
            "[block]",
            "[roller.profile]\nkind = \"table\"\nfile = \"drops.csv\"\n[block]",
            1,
        ) + "[surface]\nheights = \"heights.csv\"\ndx_m = 1e-6\ndy_m = 1e-6\n";
        std::fs::write(own.join("case.toml"), text).unwrap();
        Case::read(&own.join("case.toml")).unwrap()
    };
    let case = written("a", "1e-5", "1e-7");
    let elsewhere = folder.path().join("case.toml");
    std::fs::write(&elsewhere, case.to_toml()).unwrap();
    assert_eq!(Case::read(&elsewhere).unwrap(), case);
    assert!(written("b", "1e-5", "1e-7").is_same_problem(&case));
    assert!(!written("c", "2e-5", "1e-7").is_same_problem(&case));
    assert!(!written("d", "1e-5", "2e-7").is_same_problem(&case));
}

#[test]
fn a_profile_between_semicolons_is_told_of_commas() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("drops.csv"), "y_m;drop_m\n-0.01;0\n0.01;0\n").unwrap();
    let profile = "[roller.profile]\nkind = \"table\"\nfile = \"drops.csv\"\n[block]";
    let text = LOADED.replacen("[block]", profile, 1);
    let said = Case::parse(&text, &folder.path().join("f.toml")).unwrap_err().to_string();
    assert!(said.contains("drops.csv:1: has semicolons between its columns; write com"), "{said}");
}

#[test]
fn levels_with_too_many_digits_for_names_are_refused() {
    let text = DEFAULT_STUDY
        .replace("W = [1e-4, 1e-3]", "W = [1.2345678901234567e-12]")
        .replace("S_l = [5.0, 20.0]", "S_l = [1234.5678901234567]")
        .replace("L_r = [0.5, 1.0]", "L_r = [0.0010000000000000002]");
    let said = Study::parse(&text, Path::new("s.toml")).unwrap_err().to_string();
    assert!(said.contains("has a name of more than 64 letters; give levels with fewer"), "{said}");
}
