//! `edgeline bench` with stand-ins for the finite elements. No test depends on a time.

use crate::support::{Row, edgeline, fake, number, said};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Output;

fn bench(folder: &Path, arguments: &[&str]) -> Output {
    edgeline(folder, &[&["bench"], arguments].concat()).output().unwrap()
}

fn rows(folder: &Path) -> Vec<Row> {
    crate::support::rows(&folder.join("pareto.csv"))
}

/// Options for a short run: two models, two tolerances, one repetition.
const SHORT: [&str; 6] =
    ["--methods", "mirror,quarter-space", "--tolerances", "5e-3,1e-4", "--repeats", "1"];

#[test]
fn recorded_meshes_are_shown_apart_and_never_divided() {
    let folder = tempfile::tempdir().unwrap();
    let done = bench(folder.path(), &[&["w1e-4_sl5_lr1", "--json"][..], &SHORT].concat());
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let out = folder.path().join("out");
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    let file = std::fs::read_to_string(out.join("bench.json")).unwrap();
    assert_eq!(json, serde_json::from_str::<serde_json::Value>(&file).unwrap());
    assert_eq!(json["cases"][0]["fem_reference"], "recorded, size 1");
    assert_eq!(json["limit"], 1e-4);
    assert_eq!(json["speedups"], serde_json::json!([]));

    let rows = rows(&out);
    let of = |source: &str, setting: f64| {
        let is_it = |r: &&Row| r["source"] == source && number(r, "setting") == setting;
        rows.iter().find(is_it).unwrap_or_else(|| panic!("{source} at {setting}"))
    };
    // Two models at two tolerances, and the three meshes of the record.
    assert_eq!(rows.len(), 4 + 3);
    for row in &rows {
        let recorded = row["origin"] == "recorded-fem";
        assert_eq!(recorded, row["source"] == "fem");
        assert_eq!(recorded, row["timed_on"] != "this machine");
        assert!(row["err"].is_empty() && number(row, "seconds") > 0.0);
        assert_eq!(recorded, row["seconds_cold"].is_empty(), "{row:?}");
    }
    // The mirror keeps its modelling error at any tolerance, quarter-space does not, and finer
    // meshes of FEM are nearer to the finest.
    for tolerance in [5e-3, 1e-4] {
        assert!(number(of("mirror", tolerance), "worst_rms_to_limit") > 0.1);
        assert!(number(of("quarter-space", tolerance), "worst_rms_to_fem") < 0.025);
    }
    assert!(number(of("quarter-space", 5e-3), "worst_rms_to_limit") < 5e-3);
    assert_eq!(of("quarter-space", 1e-4)["worst_rms_to_limit"], "");
    let coarse = number(of("fem", 2.0), "worst_rms_to_fem");
    assert!(coarse > number(of("fem", 1.4), "worst_rms_to_fem") && coarse < 0.1, "{coarse}");
    // Something is on every front.
    for origin in ["model", "recorded-fem"] {
        for front in ["front_fem", "front_limit"] {
            assert!(rows.iter().any(|r| r["origin"] == origin && r[front] == "yes"), "{front}");
        }
    }

    let svg = std::fs::read_to_string(out.join("pareto.svg")).unwrap();
    for word in [
        "front of the models",
        "mirror",
        "quarter-space",
        "FEM, recorded on its own machine",
        "seconds a case (one thread)",
        "worst RMS error of a curve / p0",
    ] {
        assert!(svg.contains(word), "{word}");
    }
    assert!(!svg.contains("FEM, this run") && !svg.contains("NaN"));
    assert!(!out.join("cold").exists(), "what cold starts need is taken away");
}

#[test]
fn live_meshes_are_divided_with_their_uncertainty() {
    let folder = tempfile::tempdir().unwrap();
    let [python, gmsh] = ["python3", "gmsh"].map(|name| fake(name).to_str().unwrap().to_string());
    let live = ["--fem", "live", "--sizes", "1,2", "--python", &python, "--gmsh", &gmsh];
    let done = bench(folder.path(), &[&["flush-short"][..], &live, &SHORT].concat());
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let out = folder.path().join("out");
    let file = std::fs::read_to_string(out.join("bench.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&file).unwrap();
    assert_eq!(json["cases"][0]["fem_reference"], "live, size 1");
    let live: Vec<Row> = rows(&out).into_iter().filter(|r| r["origin"] == "live-fem").collect();
    assert_eq!(live.len(), 2);
    assert!(live.iter().all(|r| r["repeats"] == "2" && number(r, "seconds_spread") == 0.0));
    for size in ["size-1", "size-2"] {
        for run in ["run-1", "run-2"] {
            assert!(out.join("fem/flush-short").join(size).join(run).join("fem.json").is_file());
        }
    }

    // The stand-in takes one second and has no error, so each level has a ratio.
    let speedups = json["speedups"].as_array().unwrap();
    let own: Vec<_> = speedups.iter().filter(|s| s["against"] == "limit").collect();
    assert_eq!(own.len(), 3, "{speedups:?}");
    for s in own {
        let get = |key: &str, i: usize| s[key][i].as_f64().unwrap();
        let (fem, model) = (get("fem_seconds", 0), get("model_seconds", 0));
        let (value, pm) = (s["ratio"]["value"].as_f64(), s["ratio"]["plus_minus"].as_f64());
        assert_eq!(fem, 1.0);
        assert!((value.unwrap() * model / fem - 1.0).abs() < 1e-9);
        let expected = value.unwrap() * get("model_seconds", 1) / model;
        assert!((pm.unwrap() - expected).abs() <= 1e-9 * value.unwrap());
        assert!(s["model_error"].as_f64() <= s["level"].as_f64());
    }
    let text = said(&done);
    assert!(text.contains("to 0.005 p0, each against its own limit, in 1 of 1 cases"), "{text}");
    assert!(json.get("codes").is_none(), "one code ran");
}

#[test]
fn two_codes_run_in_one_bench_and_are_compared_at_equal_error() {
    let folder = tempfile::tempdir().unwrap();
    let ccx = folder.path().join("ccx");
    std::fs::write(&ccx, "#!/bin/sh\necho This is Version 2.20\n").unwrap();
    std::fs::set_permissions(&ccx, std::fs::Permissions::from_mode(0o755)).unwrap();
    let [python, gmsh] = ["python3", "gmsh"].map(|name| fake(name).to_str().unwrap().to_string());
    let live = ["--fem", "live", "--sizes", "1,2,calculix=2,calculix=2.8", "--python", &python];
    let programs = ["--gmsh", &gmsh, "--ccx", ccx.to_str().unwrap()];
    let done = bench(folder.path(), &[&["flush-short"][..], &live, &programs, &SHORT].concat());
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let out = folder.path().join("out");
    let live: Vec<Row> = rows(&out).into_iter().filter(|r| r["origin"] == "live-fem").collect();
    let named: Vec<_> = live.iter().map(|r| (&*r["source"], number(r, "setting"))).collect();
    assert_eq!(named, [("fem", 2.0), ("fem", 1.0), ("calculix", 2.8), ("calculix", 2.0)]);
    let json = std::fs::read_to_string(out.join("bench.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["cases"][0]["fem_reference"], "live, size 1", "that of the first code");
    let codes = json["codes"].as_array().unwrap();
    assert!(codes.len() == 3 && codes.iter().all(|c| c["codes"].as_array().unwrap().len() == 2));
    assert!(said(&done).contains("CalculiX"), "{}", said(&done));
    for part in ["size-1", "calculix-size-2", "calculix-size-2.8"] {
        assert!(out.join("fem/flush-short").join(part).join("run-1/fem.json").is_file(), "{part}");
    }
}

#[test]
fn bad_input_ends_with_exit_code_2_and_one_message() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("file"), "").unwrap();
    std::fs::write(at.join("bad.toml"), "name = \"x\"\n[factors]\n").unwrap();
    for (arguments, wanted) in [
        (&["nowhere.toml"][..], "nowhere.toml"),
        (&["bad.toml"], "there is no factor"),
        (&["flush-short", "flush-short"], "twice"),
        (&["flush-short", "--tolerances", "1e-2,2"], "--tolerances = 2 is not valid"),
        (&["flush-short", "--levels", "0"], "--levels"),
        (&["flush-short", "--repeats", "0"], "--repeats"),
        (&["flush-short", "--methods", "mirrors"], "mirrors"),
        (&["flush-short", "--out", "file"], "cannot create the folder"),
        (&["flush-short", "--reference", "nowhere"], "nowhere"),
        (&["flush-short", "--fem", "live", "--sizes", "-1"], "size"),
        (&["flush-short", "--sizes", "2"], "--sizes is given"),
        (
            &["flush-short", "--sizes", "2,abaqus=2"],
            "there is no code abaqus; there are fenicsx, calculix",
        ),
        (&["flush-short", "--sizes", "calculix="], "give sizes, as in 2,1.4,calculix=2"),
    ] {
        let done = bench(at, arguments);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {}", said(&done));
        assert!(said(&done).contains(wanted), "{arguments:?}: {}", said(&done));
        assert!(done.stdout.is_empty(), "{arguments:?}");
    }
}
