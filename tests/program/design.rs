//! The design of profiles: files and messages.

use crate::support::{edgeline, files, number, refused, rows, said};
use serde_json::Value;
use std::fs;

const GOOD: &str = "case = \"flush-short\"\n[profile]\nkind = \"relief\"\nstraight_m = 1e-3\n[bounds]\n\
                    radius_m = [0.05, 5.0]\n[[loads]]\nforce_n = 1e4\n[[loads]]\nforce_n = 5e3\n\
                    eccentricity_m = 0.1e-3\n";

#[test]
fn a_design_writes_a_case_that_sees_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("d.toml"), GOOD).unwrap();
    let design = ["design", "d.toml", "--starts", "1", "--tolerance", "2e-2", "--json"];
    let output = edgeline(path, &design).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let out = path.join("design");
    let wanted = [
        "case.toml",
        "history.csv",
        "loads.csv",
        "plot-loads.png",
        "plot-loads.svg",
        "plot-parameters.png",
        "plot-parameters.svg",
        "scans.csv",
        "summary.json",
    ];
    assert_eq!(files(&out).iter().filter(|f| !f.starts_with('.')).collect::<Vec<_>>(), wanted);
    let (loads, history) = (rows(&out.join("loads.csv")), rows(&out.join("history.csv")));
    // A load without its place has an empty cell.
    assert_eq!(loads[0]["eccentricity_m"], "");
    let objective = summary["objective_pa"].as_f64().unwrap();
    let largest = loads.iter().map(|row| number(row, "von_mises_pa")).fold(0.0, f64::max);
    assert!((largest / objective - 1.0).abs() < 1e-6, "{summary}");
    assert_eq!(history.len() as u64, summary["trials"].as_u64().unwrap());
    let best =
        history.iter().filter_map(|row| row["objective_pa"].parse().ok()).fold(f64::MAX, f64::min);
    assert!((best / summary["objective_of_search_pa"].as_f64().unwrap() - 1.0).abs() < 1e-6);
    // The straight roller of the case has its largest stress at the end.
    assert!(objective < summary["own_profile_pa"].as_f64().unwrap());
    // The case under the heavier load has the pressure of the table.
    let case = fs::read_to_string(out.join("case.toml")).unwrap();
    assert!(case.contains("flush-short-designed"), "{case}");
    let force = case.lines().find(|line| line.starts_with("force_n")).unwrap();
    fs::write(path.join("c.toml"), case.replace(force, "force_n = 1e4")).unwrap();
    let output = edgeline(path, &["solve", "c.toml", "--json"]).output().unwrap();
    let solved: Value = serde_json::from_slice(&output.stdout).unwrap();
    let approach = solved["approach_m"].as_f64().unwrap();
    assert!((number(&loads[0], "approach_m") / approach - 1.0).abs() < 1e-6, "{solved}");
}

#[test]
fn bad_designs_exit_with_two_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (from, to, wanted) in [
        (
            "radius_m = [0.05, 5.0]",
            "radius_m = [5.0, 0.05]",
            "bounds.radius_m = [5.0, 0.05] is not valid: the first",
        ),
        ("radius_m = [0.05, 5.0]", "radius_m = [0.05]", "bounds are two numbers"),
        (
            "radius_m = [0.05, 5.0]",
            "radius_m = [-1.0, 5.0]",
            "bounds.radius_m = [-1.0, 5.0] is not valid",
        ),
        ("radius_m = [0.05, 5.0]", "k = [0.5, 0.9]", "unknown key bounds.k"),
        ("radius_m = [0.05, 5.0]", "", "radius_m is neither in [profile] nor in [bounds]"),
        (
            "radius_m = [0.05, 5.0]",
            "radius_m = [0.05, 5.0]\nstraight_m = [1e-4, 1e-3]",
            "[profile] gives this number",
        ),
        (
            "kind = \"relief\"",
            "kind = \"table\"",
            "there is no profile of this name with parameters",
        ),
        ("kind = \"relief\"", "kind = \"relief\"\nbody = \"race\"", "there is no such body"),
        ("straight_m = 1e-3", "straight_m = 1.0", "the straight part is as long as the body"),
        (
            "radius_m = [0.05, 5.0]",
            "radius_m = [1e-6, 1e-5]",
            "d.toml:5: in the middle of the bounds, radius_m = 3.162e-6, roller.profile.kind = \"relief\" is \
             not legal: the profile ends before the body does, 0.001262 m from its middle",
        ),
        ("case = \"flush-short\"", "case = \"nowhere.toml\"", "there is no file"),
        ("case = \"flush-short\"", "case = \"sliding-flush\"", "designed without friction"),
        ("[profile]", "objective = \"stress\"\n[profile]", "there is no such objective"),
        ("[profile]", "exclude_c = -0.1\n[profile]", "exclude_c = -0.1 is not valid"),
        (
            "case = \"flush-short\"",
            "case = \"flush-short\"\nexclude_c = 2.0",
            "all of the contact lies within exclude_c = 2 half-widths of its ends",
        ),
        ("force_n = 5e3", "force_n = -5e3", "loads.force_n = -5e3 is not valid"),
        ("force_n = 5e3", "", "loads.force_n is missing"),
        ("eccentricity_m = 0.1e-3", "eccentricity_m = 0.1", "the roller would fall over"),
        ("eccentricity_m = 0.1e-3", "eccentricity_m = 0.0\ntilt_rad = 1e-4", "finds its own tilt"),
    ] {
        assert!(GOOD.contains(from), "{from}");
        fs::write(path.join("d.toml"), GOOD.replacen(from, to, 1)).unwrap();
        let said = refused(&mut edgeline(path, &["design", "d.toml"]));
        assert!(said.contains(wanted) && said.contains("d.toml"), "{to}: {said}");
    }
    let none = GOOD.split("[[loads]]").next().unwrap();
    fs::write(path.join("d.toml"), none).unwrap();
    assert!(refused(&mut edgeline(path, &["design", "d.toml"])).contains("there are no [[loads]]"));
    fs::write(path.join("d.toml"), GOOD).unwrap();
    let said = refused(&mut edgeline(path, &["design", "d.toml", "--tolerance", "0.5"]));
    assert!(said.contains("--tolerance"), "{said}");
    assert_eq!(files(path), ["d.toml"]);
}
