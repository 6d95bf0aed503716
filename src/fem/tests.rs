use super::*;
use crate::case::{Case, Load, Study};
use crate::stress::BodyKind;
use std::path::{Path, PathBuf};

fn records() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("results/reference")
}

#[test]
fn records_are_read_and_built_in_alike() {
    let read = FemResults::read_all(&records()).unwrap();
    let embedded: Vec<FemResults> = FemResults::embedded_names()
        .map(|name| FemResults::embedded(name).unwrap().unwrap())
        .collect();
    assert_eq!(read, embedded);
    assert_eq!(FemResults::embedded("no such case").unwrap(), None);
}

#[test]
fn default_study_and_validation_cases_are_on_record() {
    let validation = ["validation-nu025", "validation-nu040", "validation-steel-aluminium"]
        .map(|name| Case::find(Path::new(name)).unwrap());
    for case in Study::built_in().cases().chain(&validation) {
        let reference = FemResults::embedded_of(case).unwrap().expect(&case.name);
        assert_eq!(reference.case.name, case.name);
        assert!(reference.meshes.is_sorted_by(|a, b| a.size < b.size));
        // The estimates' names are those of the curves.
        for error in &reference.errors {
            let known = match BodyKind::ALL.iter().find(|b| b.name() == error.body) {
                Some(&body) => reference.finest().curves.curve(body, &error.curve).is_some(),
                None => reference.finest().curves.line(&error.curve).is_some(),
            };
            assert!(known, "{error:?}");
        }
        assert!(reference.error("contact", "along-y", "pressure").is_some());
    }
}

#[test]
fn a_record_belongs_to_a_problem_not_to_a_name() {
    let case = Case::find(Path::new("validation-nu025")).unwrap();
    let renamed = Case { name: "other".into(), ..case.clone() };
    let found = FemResults::embedded_of(&renamed).unwrap().unwrap();
    assert_eq!(found.case.name, "validation-nu025");
    let heavier = Case { load: Load { force_n: case.load.force_n * 1.001, ..case.load }, ..case };
    assert_eq!(FemResults::embedded_of(&heavier).unwrap(), None);
}

#[test]
fn damaged_records_are_refused_with_their_place() {
    let source = records().join("validation-nu025");
    let damage = |file: &str, change: &dyn Fn(String) -> String| {
        let texts = ["record.json", "curves.csv", "pressure.csv"].map(|name| {
            let text = std::fs::read_to_string(source.join(name)).unwrap();
            if name == file { change(text) } else { text }
        });
        let texts = texts.each_ref().map(String::as_str);
        FemResults::parse(texts, &source).unwrap_err().to_string()
    };
    let line_three = |text: String, from: &str, to: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
        lines[2] = lines[2].replacen(from, to, 1);
        lines.join("\n")
    };
    let message = damage("curves.csv", &|t| line_three(t, ",0,", ",nan,"));
    assert!(message.contains("curves.csv:3: 'nan' is not a finite number"), "{message}");
    let message = damage("curves.csv", &|t| line_three(t, "block", "blok"));
    assert!(message.contains("curves.csv:3: there is no body 'blok'"), "{message}");
    let message = damage("curves.csv", &|t| line_three(t, ",0,", ","));
    assert!(message.contains("curves.csv:3: "), "{message}");
    let message = damage("curves.csv", &|t| t[..t.len() / 2].to_string());
    assert!(message.contains("curves.csv"), "{message}");
    let message = damage("curves.csv", &|t| t.replace("sigma_xy_pa", "tau_xy_pa"));
    assert!(message.contains("curves.csv:1: has no column sigma_xy_pa"), "{message}");
    let message = damage("pressure.csv", &|t| t.lines().take(5).collect::<Vec<_>>().join("\n"));
    assert!(message.contains("pressure.csv: the pressure lines are not those"), "{message}");
    let message = damage("record.json", &|t| t[..t.len() / 2].to_string());
    assert!(message.contains("record.json:"), "{message}");
    let message = damage("record.json", &|t| t.replace("\"schema\": 1", "\"schema\": 2"));
    assert!(message.contains("has schema 2, this program reads 1"), "{message}");
    let message =
        damage("record.json", &|t| t.replace("\"load_error_rel\": ", "\"load_error_rel\": 1"));
    assert!(message.contains("load_error_rel = 1"), "{message}");
}

#[test]
fn files_that_are_not_those_recorded_are_refused() {
    let source = records().join("validation-nu025");
    let folder = tempfile::tempdir().unwrap();
    let copy = || {
        for name in ["record.json", "curves.csv", "pressure.csv", "SHA256SUMS"] {
            std::fs::copy(source.join(name), folder.path().join(name)).unwrap();
        }
    };
    let refused = || FemResults::read(folder.path()).unwrap_err().to_string();
    for name in ["record.json", "curves.csv", "pressure.csv"] {
        copy();
        FemResults::read(folder.path()).unwrap();
        // One digit more, which no reader of numbers would notice.
        let path = folder.path().join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        let at = text.rfind(|c: char| c.is_ascii_digit()).unwrap();
        std::fs::write(&path, format!("{}1{}", &text[..=at], &text[at + 1..])).unwrap();
        let said = refused();
        assert!(
            said.contains(&format!("{name}: was changed or is damaged: its SHA-256")),
            "{said}"
        );
        assert!(said.contains("restore the folder from version control"), "{said}");
    }
    copy();
    let sums = folder.path().join("SHA256SUMS");
    std::fs::write(&sums, "0  other\n").unwrap();
    assert!(refused().contains("SHA256SUMS: holds no checksum of record.json"), "{}", refused());
    std::fs::remove_file(&sums).unwrap();
    assert!(refused().contains("cannot read"), "{}", refused());
}

#[test]
fn meshes_state_their_unknowns() {
    let parse = |text: &str| MeshSummary::parse(text, Path::new("mesh.json"));
    let bodies = r#"{"bodies": {"block": {"unknowns": 30}, "roller": {"unknowns": 12}}}"#;
    assert_eq!(parse(bodies).unwrap().unknowns, 42);
    for bad in ["{}", "[", "", "nan", &bodies.replace("12", "-1"), &bodies.replace("12", "0")] {
        let said = parse(bad).unwrap_err().to_string();
        assert!(said.starts_with("mesh.json"), "{bad}: {said}");
    }
    let huge = bodies.replace("12", &u64::MAX.to_string());
    assert!(parse(&huge).unwrap_err().to_string().contains("has no number at /bodies/roller"));
}

/// Where a request says that the contact ends, the recorded pressure falls to nothing.
#[test]
fn a_request_says_where_the_contact_ends() {
    let ends = |name: &str| {
        let case = Case::find(Path::new(name)).unwrap();
        let request = serde_json::to_value(request::Request::new(&case, &FemSettings::default()));
        let c_m = case.hertz().c_m;
        let ends: Vec<f64> = match request.unwrap().get("contact_ends_m") {
            Some(ends) => serde_json::from_value(ends.clone()).unwrap(),
            None => Vec::new(),
        };
        (case, ends.into_iter().map(|y| y / c_m).collect::<Vec<f64>>())
    };
    for name in ["crown-inside", "logarithmic-eccentric"] {
        let (case, ends) = ends(name);
        assert_eq!(ends.len(), 2, "{name}: {ends:?}");
        let recorded = FemResults::embedded_of(&case).unwrap().expect(name);
        let line = recorded.finest().curves.line("along-y").unwrap();
        for (at, p) in line.at.iter().zip(&line.p) {
            let inside = (at[1] - ends[0]).min(ends[1] - at[1]);
            assert!(*p > 0.0 || inside < 0.05, "{name}: {p} at {at:?}, ends {ends:?}");
            assert!(*p == 0.0 || inside > -0.05, "{name}: {p} at {at:?}, ends {ends:?}");
        }
    }
    for name in ["flush-short", "half-short", "eccentric-flush", "crown-to-the-ends"] {
        assert_eq!(ends(name).1, Vec::<f64>::new(), "{name}");
    }
}
