//! `edgeline study --curves`: a user's own curves beside the references of a study.

use crate::compare::{bench, record};
use crate::study::study_file;
use crate::support::{Row, edgeline, files, number, refused, rows, said};
use std::fs;

/// The case of the study whose curves the folder of [`bench`] holds.
const CASE: &str = "w1e-3_sl5_lr0.5";

#[test]
fn own_curves_stand_beside_the_references() {
    let folder = bench();
    let at = |name: &str| folder.path().join(name);
    study_file(folder.path(), "[5.0]");
    fs::copy(record().join("pressure.csv"), at("of the record.csv")).unwrap();
    let own: Vec<String> = ["si.csv", "elsewhere.csv", "shifted.csv", "of the record.csv"]
        .iter()
        .flat_map(|file| ["--curves".to_string(), format!("{CASE}={file}")])
        .collect();
    let mut arguments = vec!["study", "small.toml", "--repeats", "0", "--out", "o"];
    arguments.extend(["--methods", "mirror,quarter-space"]);
    arguments.extend(own.iter().map(String::as_str));
    let done = edgeline(folder.path(), &arguments).output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    assert!(said(&done).contains("Largest differences from elsewhere in w1e-3_sl5_lr0.5: quarter"));

    // Every model and code, on every curve of every file.
    let brought = rows(&at("o/brought.csv"));
    assert!(brought.iter().all(|row| row["case"] == CASE));
    let of = |file: &str, source: &str| -> Vec<Row> {
        let own = |row: &&Row| row["reference"] == file && row["method"] == source;
        brought.iter().filter(own).cloned().collect()
    };
    let largest = |file: &str, source: &str| {
        let all = of(file, source).into_iter().map(|row| number(&row, "max"));
        all.fold(f64::MIN, f64::max)
    };
    for source in ["mirror", "quarter-space", "fem", "calculix"] {
        for file in ["si", "elsewhere", "shifted"] {
            assert_eq!(of(file, source).len(), 208, "{file} {source}");
        }
        assert_eq!(of("of the record", source).len(), 4, "{source}");
    }
    assert!(of("si", "half-space").is_empty());
    // The record itself; in other units and axes but for the digits; not itself once it is shifted.
    assert!(largest("si", "fem") < 1e-6 && largest("of the record", "fem") < 1e-6);
    assert!(largest("elsewhere", "fem") < 2e-3, "{}", largest("elsewhere", "fem"));
    assert!((0.01..0.05).contains(&largest("shifted", "fem")));
    // What the study says of a model against the record it says of it against the same curves.
    let study = rows(&at("o/study.csv"));
    let row = study.iter().find(|r| r["case"] == CASE && r["source"] == "quarter-space").unwrap();
    let stresses = |row: &&Row| row["quantity"].starts_with("sigma_");
    let own = of("si", "quarter-space");
    let stress = own.iter().filter(stresses).map(|row| number(row, "max")).fold(0.0, f64::max);
    assert!((stress - number(row, "stress_max")).abs() < 1e-5, "{stress} {row:?}");

    // Beside the uncertainty of both sides, which the file states or not.
    let verification = rows(&at("o/verification.csv"));
    let verified = |file: &str, source: &str, zone: &str| {
        let own = |row: &&Row| {
            row["reference"] == file
                && row["source"] == source
                && (row["group"] == "stress" && row["zone"] == zone)
        };
        verification.iter().find(own).cloned().unwrap()
    };
    for zone in ["regular", "near-end"] {
        for source in ["quarter-space", "fem"] {
            let row = verified("elsewhere", source, zone);
            assert_eq!((&*row["convergence"], &*row["finding"]), ("stated", "within"), "{row:?}");
            assert!(number(&row, "u_reference") == 0.004 && number(&row, "u_source") < 0.004);
            let silent = verified("si", source, zone);
            assert_eq!((&*silent["u_reference"], &*silent["finding"]), ("", "unknown"));
        }
        // A code has the same difference on the curves of the record as from the record.
        let [on, from] = ["si", "fem"].map(|file| verified(file, "calculix", zone));
        assert!((number(&on, "difference") - number(&from, "difference")).abs() < 1e-5);
    }

    // Page, Markdown and plots show them, and are made from the files alone.
    let [page, text] = ["o/report.html", "o/report.md"].map(|f| fs::read_to_string(at(f)).unwrap());
    assert!(page.contains("<td class=\"text\">CalculiX − elsewhere</td>"));
    assert!(page.contains("block/elsewhere: depth-centre"));
    let cell = format!("| {CASE} | shifted | FEM | – | – | {:.4}", {
        let own = of("shifted", "fem");
        own.iter().filter(stresses).map(|row| number(row, "rms")).fold(0.0, f64::max)
    });
    assert!(text.contains(&cell), "{cell}");
    let plots = files(&at("o/plots"));
    let own = plots.iter().filter(|p| p.contains("-brought-"));
    assert_eq!(own.count(), 3 * 26 + 2);
    let again = edgeline(folder.path(), &["report", "o"]).output().unwrap();
    assert_eq!(again.status.code(), Some(0), "{}", said(&again));
    assert!(fs::read_to_string(at("o/report.html")).unwrap() == page, "rebuilt, it is the same");
}

/// Names of files and curves may be longer than those of files are.
#[test]
fn curves_of_any_name_have_plots() {
    let folder = bench();
    let at = |name: &str| folder.path().join(name);
    study_file(folder.path(), "[5.0]");
    let (name, curve) = ("n".repeat(300), "ü/".repeat(200));
    let line = |end: &str| format!("{curve}{end},0,0,1e9\n{curve}{end},0,1e-4,1e9\n");
    let text = format!("# name: {name}\ncurve,x_m,y_m,p_pa\n{}{}", line("a"), line("b"));
    fs::write(at("long.csv"), text).unwrap();
    let curves = format!("--curves={CASE}=long.csv");
    let study = ["study", "small.toml", &curves, "--methods=quarter-space", "--repeats=0"];
    for (arguments, out) in [(&study[..], "s"), (&["compare", "case.toml", "long.csv"][..], "c")] {
        let done =
            edgeline(folder.path(), &[arguments, &["--out", out]].concat()).output().unwrap();
        assert!(done.status.code() != Some(2), "{}", said(&done));
        assert!(at(out).join("summary.json").is_file(), "{out}");
    }
    let of = |out: &str, part: &str| files(&at(out)).iter().filter(|p| p.contains(part)).count();
    assert_eq!([of("c/plots", "nnn"), of("s/plots", "-brought-")], [2, 2]);
}

#[test]
fn curves_that_cannot_be_used_are_refused_before_the_study_runs() {
    let folder = bench();
    let at = |name: &str| folder.path().join(name);
    study_file(folder.path(), "[5.0]");
    fs::write(at("mirror.csv"), "x_m,y_m,p_pa\n0,0,1e9\n").unwrap();
    fs::write(at("bad.csv"), "x,y_m,p_pa\n0,0,1e9\n").unwrap();
    for (curves, wanted) in [
        ([format!("{CASE}5=si.csv")].to_vec(), "did you mean w1e-3_sl5_lr0.5? Its cases are"),
        ([format!("{CASE}=nowhere.csv")].to_vec(), "nowhere.csv"),
        ([format!("{CASE}=bad.csv")].to_vec(), "bad.csv:1: the unit of column 'x' is not stated"),
        ([format!("{CASE}=mirror.csv")].to_vec(), "mirror.csv is called like a model or a code"),
        ([format!("{CASE}=si.csv"), format!("{CASE}=si.csv")].to_vec(), "are called so"),
        (["si.csv".to_string()].to_vec(), "give a case of the study, = and a file"),
    ] {
        let mut arguments = vec!["study", "small.toml", "--out", "o"];
        arguments.extend(curves.iter().flat_map(|text| ["--curves", text]));
        let message = refused(&mut edgeline(folder.path(), &arguments));
        assert!(message.contains(wanted), "{curves:?}: {message}");
    }
    assert!(!at("o").exists());
    // A table of the study would take its place.
    fs::create_dir(at("o")).unwrap();
    fs::copy(at("si.csv"), at("o/brought.csv")).unwrap();
    let curves = format!("--curves={CASE}=o/brought.csv");
    let study = ["study", "small.toml", "--out", "o", "--repeats=0", &curves];
    let message = refused(&mut edgeline(folder.path(), &study));
    assert!(message.contains("o/brought.csv: was given to this run"), "{message}");
    assert_eq!(files(&at("o")), ["brought.csv"]);
    fs::rename(at("o/brought.csv"), at("o/curves.csv")).unwrap();
    let compare = ["compare", "case.toml", "o/curves.csv", "--out", "o"];
    let message = refused(&mut edgeline(folder.path(), &compare));
    assert!(message.contains("o/curves.csv: was given to this run"), "{message}");
    assert_eq!(files(&at("o")), ["curves.csv"]);
}
