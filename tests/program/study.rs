//! `edgeline study` and `edgeline report`.

use crate::support::{edgeline, rows, said};
use std::path::{Path, PathBuf};

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

/// A study of the given slendernesses, both length ratios and W = 1e-3.
pub(crate) fn study_file(folder: &Path, slenderness: &str) -> PathBuf {
    let path = folder.join("small.toml");
    let content = format!(
        "name = \"small\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n[block]\n\
         young_pa = 210e9\npoisson = 0.3\n[factors]\nW = [1e-3]\nS_l = {slenderness}\n\
         L_r = [0.5, 1.0]\n"
    );
    std::fs::write(&path, content).unwrap();
    path
}

#[test]
fn a_study_leaves_what_it_says_and_every_number_can_be_traced() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_file(folder.path(), "[5.0, 20.0]");
    let out = folder.path().join("deep/run");
    let arguments = ["study", study.to_str().unwrap(), "--repeats", "2", "--json", "--out"];
    let done = edgeline(folder.path(), &[&arguments[..], &[out.to_str().unwrap()]].concat())
        .output()
        .unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));

    // Standard output contains only one JSON object, the content of the file.
    let summary: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text(&out.join("summary.json"))).unwrap();
    assert_eq!(summary["method_summary"], file["method_summary"]);
    assert_eq!(summary["contact_problems_solved"], 16);

    let study_rows = rows(&out.join("study.csv"));
    // Four models, the published method and FEM; a second code where it has a record.
    let further = study_rows.iter().filter(|r| r["source"] == "calculix").count();
    assert!(further <= 4 && study_rows.len() == 4 * 6 + further, "{}", study_rows.len());
    assert!(study_rows.iter().all(|r| r["err"].is_empty()));
    let tables = ["curves.csv", "pressure.csv", "fem_error.csv", "errors.csv", "effects.csv"];
    for name in tables.into_iter().chain(["verification.csv"]) {
        assert!(rows(&out.join(name)).len() >= 16, "{name}");
    }
    let plots = std::fs::read_dir(out.join("plots")).unwrap().count();
    assert_eq!(plots, 4 * 7 + 4 * 3 + 1);

    // The quarter-space model is the most accurate one on every measure.
    let of = |source: &str, case: &str, column: &str| -> f64 {
        let row = study_rows.iter().find(|r| r["source"] == source && r["case"] == case);
        row.unwrap()[column].parse().unwrap()
    };
    let cases: Vec<&str> =
        study_rows.iter().filter(|r| r["source"] == "fem").map(|r| r["case"].as_str()).collect();
    for case in &cases {
        for column in ["pressure_rms", "stress_rms", "von_mises_rms"] {
            let best = of("quarter-space", case, column);
            assert!(best < 0.02, "{case} {column} {best}");
            for other in ["half-space", "mirror", "guilbault", "guilbault-cells"] {
                assert!(of(other, case, column) > best, "{other} {case} {column}");
            }
        }
    }

    // A hundred cells of the error tables are also in study.csv.
    let markdown = text(&out.join("report.md"));
    let (mut compared, mut method) = (0, "");
    let columns = ["pressure_rms", "pressure_max", "stress_rms", "stress_max", "von_mises_rms"];
    for line in markdown.lines() {
        if let Some(name) = line.strip_prefix("### ") {
            method = name;
        } else if line.starts_with("## ") {
            method = "";
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        if method.is_empty() || cells.len() != 13 || !cases.contains(&cells[1]) {
            continue;
        }
        for (cell, column) in cells[2..].iter().zip(columns) {
            let expected = format!("{:.4}", of(method, cells[1], column));
            assert_eq!(*cell, expected, "{method} {} {column}", cells[1]);
            compared += 1;
        }
    }
    assert_eq!(compared, 4 * 5 * 5);
    // The published method on cells has the errors of its model.
    for case in &cases {
        let [line, cells] =
            ["guilbault", "guilbault-cells"].map(|source| of(source, case, "stress_rms"));
        assert!((cells / line - 1.0).abs() < 0.1, "{case}: {cells} {line}");
    }
    assert_eq!(summary["published"]["cases"], 4);
    // The page has the same numbers.
    let page = text(&out.join("report.html"));
    for case in &cases {
        let cell = format!("<td>{:.4}</td>", of("guilbault", case, "von_mises_max"));
        assert!(page.contains(&cell), "{case}: {cell}");
    }

    // The page is made from the run's files alone: rebuilt, it is the same.
    std::fs::remove_file(out.join("report.html")).unwrap();
    let again = edgeline(folder.path(), &["report", out.to_str().unwrap()]).output().unwrap();
    assert_eq!(again.status.code(), Some(0), "{}", said(&again));
    assert_eq!(text(&out.join("report.html")), page);
    assert_eq!(text(&out.join("report.md")), markdown);
    assert!(
        !page.contains("http://")
            || page.matches("http://").count()
                == page.matches("http://www.w3.org/2000/svg").count()
    );
}

#[test]
fn cases_without_a_record_are_said_so() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_file(folder.path(), "[5.5]");
    let out = folder.path().join("run");
    let arguments = ["study", study.to_str().unwrap(), "--methods", "mirror", "--repeats", "0"];
    let done =
        edgeline(folder.path(), &[&arguments[..], &["--out", out.to_str().unwrap()]].concat())
            .output()
            .unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    assert!(said(&done).contains("is not compared with FEM"), "{}", said(&done));
    let study_rows = rows(&out.join("study.csv"));
    assert_eq!(study_rows.len(), 4);
    for row in study_rows.iter().filter(|r| r["source"] == "fem") {
        assert_eq!(row["err"], "there is no record of it");
    }
    assert!(rows(&out.join("errors.csv")).is_empty());
}

#[test]
fn bad_input_ends_with_exit_code_2_and_one_message() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    std::fs::write(path("file"), "").unwrap();
    std::fs::write(path("bad.toml"), "name = \"x\"\nfactor = 1\n").unwrap();
    for (arguments, wanted) in [
        (vec!["study", "nowhere.toml"], "nowhere.toml"),
        (vec!["study", &path("bad.toml")], "factor"),
        (vec!["study", "--out", &path("file")], "cannot create the folder"),
        (vec!["study", "--methods", "halfspace"], "halfspace"),
        (vec!["study", "--exclude=-1"], "--exclude"),
        (vec!["study", "--reference", &path("nowhere"), "--out", &path("o")], "nowhere"),
        (vec!["study", "--reference", ".", "--out", &path("o")], "holds no record; give a folder"),
        // What would change nothing.
        (vec!["study", "--size", "0"], "--fem = recorded is not valid: --size is given"),
        (vec!["study", "--ranks", "2"], "add --fem live, or leave out --ranks"),
        (vec!["study", "--engine", "calculix"], "--engine is given"),
        (vec!["study", "--max-disk", "5"], "--max-disk is given"),
        (vec!["study", "--keep"], "--keep is given"),
        (vec!["gate", "factorial", "--fem-repeats", "2"], "--fem-repeats is given"),
        (vec!["gate", "factorial", "--size", "3"], "--size is given"),
        (vec!["study", "--fem", "live", "--reference", "r"], "--reference = r is not valid"),
        (vec!["study", "--psi", "1", "--methods", "half-space"], "--psi = 1 is not valid"),
        (vec!["gate", "--psi", "1", "--methods", "mirror"], "add guilbault to --methods"),
        (vec!["gate", "--methods", "guilbault-cells"], "--methods = guilbault-cells"),
        (vec!["gate", "scenes", "--psi", "1"], "--psi = 1 is not valid"),
        (vec!["report", &path("nowhere")], "nowhere: is no folder; give the folder that"),
        (vec!["report", &path(".")], "has no summary.json; give the folder that"),
        (vec!["gate", "--accept"], "--baseline"),
        (vec!["gate", "--baseline", &path("bad.toml")], "bad.toml:1: is no JSON file of accepted"),
        (vec!["gate", "--gates", &path("bad.toml"), "--out", &path("o")], "bad.toml"),
        (vec!["gate", "--baseline", &path("file"), "--out", &path("o")], "edgeline gate --accept"),
    ] {
        let done = edgeline(folder.path(), &arguments).output().unwrap();
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {}", said(&done));
        assert!(said(&done).contains(wanted), "{arguments:?}: {}", said(&done));
        assert!(done.stdout.is_empty(), "{arguments:?}");
    }
}

/// The block of this case ends before the roller at +y and beyond it at -y: both ends of the
/// contact are drawn, where they are.
#[test]
fn plots_of_a_contact_that_is_not_symmetric_show_both_ends() {
    let folder = tempfile::tempdir().unwrap();
    let case = "name = \"offset\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n[block]\n\
                young_pa = 210e9\npoisson = 0.3\n[dimensionless]\nW = 5e-4\nS_l = 5.0\nL_r = 1.0\n\
                [pose]\noffset_m = -0.5e-3\n";
    std::fs::write(folder.path().join("offset.toml"), case).unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(&study, "name = \"study\"\ncases = [\"offset.toml\"]\n").unwrap();
    let arguments =
        ["study", "study.toml", "--methods", "quarter-space", "--repeats", "0", "--out", "run"];
    let done = edgeline(folder.path(), &arguments).output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let plot = |name: &str| text(&folder.path().join(format!("run/plots/offset-{name}.svg")));
    let pressure = plot("pressure");
    let left_out = "not compared: within 0.1 C of an edge";
    for words in ["2 C beside the −y end", "2 C beside the +y end", left_out] {
        assert!(pressure.contains(words), "{words}");
    }
    assert!(plot("depth-block").contains("−y end") && plot("surface-roller").contains("−4"));
    let summary: serde_json::Value =
        serde_json::from_str(&text(&folder.path().join("run/summary.json"))).unwrap();
    let of = |end: usize| summary["cases"][0]["overlap_m"][end].as_f64().unwrap();
    let c_m = summary["cases"][0]["hertz"]["c_m"].as_f64().unwrap();
    assert!((of(0) + 5.0 * c_m).abs() < 1e-12 && (of(1) - 5.0 * c_m + 0.5e-3).abs() < 1e-12);
}

/// As `--out` makes one.
#[test]
fn a_folder_does_not_hide_a_built_in_study() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("factorial")).unwrap();
    let arguments = ["study", "factorial", "--methods", "mirror", "--repeats", "0", "--json"];
    let done = edgeline(folder.path(), &[&arguments[..], &["--out", "factorial"]].concat())
        .output()
        .unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let summary: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert!(summary["gates"].as_array().unwrap().len() > 1, "{}", summary["gates"]);
}
