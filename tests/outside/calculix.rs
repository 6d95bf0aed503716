//! Decks, and CalculiX as a child: missing, hanging, killed. How it fails otherwise is tested
//! beside its reader, in `fem/tests/test_calculix.py`.

use crate::support::{Bench, edgeline, files, kill, refused, start, succeeded, wait_for};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// A program in `folder` that knows CalculiX' version and then runs `script`.
fn stand_in(folder: &Path, script: &str) -> PathBuf {
    let path = folder.join("ccx");
    let text = format!(
        "#!/bin/sh\n[ \"$1\" = -v ] && {{ echo This is Version 2.20; exit 0; }}\n{script}\n"
    );
    fs::write(&path, text).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[test]
fn a_missing_calculix_and_scenes_it_does_not_take_are_refused() {
    let bench = Bench::new();
    let calculix = ["--engine", "calculix"];
    let said = refused(bench.fake("").args(calculix).args(["--ccx", "no-such-ccx"]));
    assert!(said.contains("no-such-ccx was not found") && said.contains("calculix-ccx"), "{said}");
    let ccx = stand_in(bench.folder.path(), "exit 0");
    let said = refused(bench.fake("").args(calculix).arg("--ccx").arg(&ccx).args(["--ranks", "2"]));
    assert!(said.contains("leave out --ranks"), "{said}");
    let said = refused(bench.fake("").args(["--engine", "ansys"]));
    assert!(said.contains("fenicsx, calculix"), "{said}");
    // The interpreter needs numpy alone. The program is named from here, and runs elsewhere.
    succeeded(bench.fake("").args(calculix).args(["--ccx", "./ccx"]));
    assert_eq!(bench.notes(), ["mesh", "solve"]);
    let text = fs::read_to_string(bench.out().join("request.json")).unwrap();
    let request: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(request["ccx"].as_str().unwrap(), ccx.to_str().unwrap());
    let body = "young_pa = 210e9\npoisson = 0.3\nlength_m = 4e-3\n";
    for (more, wanted) in [
        ("[pose]\noffset_m = 1e-4\n", "symmetric along y"),
        ("[pose]\ntilt_rad = 1e-4\n", "symmetric along y"),
        ("[roller.profile]\nkind = \"crown\"\nradius_m = 1\n", "straight generatrices"),
    ] {
        let case = format!(
            "name = \"a\"\n[roller]\nradius_m = 0.01\n{body}[block]\n{body}[load]\nforce_n = 1e3\n{more}"
        );
        fs::write(bench.folder.path().join("case.toml"), case).unwrap();
        let said =
            refused(&mut edgeline(bench.folder.path(), &["deck", "case.toml", "--out", "deck"]));
        assert!(said.contains(wanted) && said.contains("--engine fenicsx"), "{said}");
        assert!(!bench.folder.path().join("deck").exists());
    }
}

#[test]
#[ignore = "runs gmsh and numpy"]
fn a_hanging_or_killed_calculix_is_ended_and_leaves_nothing() {
    let bench = Bench::new();
    let notes = bench.folder.path().join("began");
    let script = format!("echo iteration 7; touch {}; exec sleep 600", notes.display());
    let ccx = stand_in(bench.folder.path(), &script);
    let run = || {
        let mut run = bench.live("flush-short");
        run.args(["--engine", "calculix", "--size", "5", "--ccx"]).arg(&ccx);
        run
    };
    let began = Instant::now();
    let said = refused(run().args(["--solve-timeout", "4"]));
    assert!(said.contains("stage solve: took longer than 4 s and was stopped"), "{said}");
    assert!(said.contains("| iteration 7"), "what it printed is lost: {said}");
    assert!(notes.exists() && began.elapsed() < Duration::from_secs(60));
    bench.assert_no_process_is_left();
    // Killed from outside, the driver leaves no process; the next run goes on after the mesh.
    fs::remove_file(&notes).unwrap();
    let mut driver = start(&mut run());
    wait_for("CalculiX", || notes.exists());
    kill(driver.id() as i32, libc::SIGKILL);
    driver.wait().unwrap();
    bench.assert_no_process_is_left();
    stand_in(bench.folder.path(), "kill -9 $$");
    let said = refused(&mut run());
    assert!(said.contains("meshes are there already"), "{said}");
    assert!(said.contains("CalculiX was killed by signal 9"), "{said}");
    for name in ["fem.json", "curves.csv", "pressure.csv"] {
        assert!(!bench.out().join(name).exists(), "{name}");
    }
}

#[test]
#[ignore = "runs gmsh and CalculiX"]
fn a_deck_is_written_and_runs() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let deck = ["deck", "flush-short", "--size", "5", "--out", "deck"];
    succeeded(&mut edgeline(folder, &deck));
    let wanted = [
        "block.msh",
        "block.vtu",
        "bodies.inp",
        "deck.log",
        "mesh.inp",
        "mesh.json",
        "mesh.log",
        "model.inp",
        "request.json",
        "roller.msh",
        "roller.vtu",
    ];
    assert_eq!(files(&folder.join("deck")), wanted);
    // The same deck through the driver: results as those of the other engine, and not repeated.
    succeeded(bench.live("flush-short").args(["--engine", "calculix", "--size", "5", "--keep"]));
    let same = |name: &str| {
        fs::read(folder.join("deck").join(name)).unwrap()
            == fs::read(bench.out().join("work").join(name)).unwrap()
    };
    assert!(["model.inp", "mesh.inp", "bodies.inp"].into_iter().all(same));
    let summary = fs::read_to_string(bench.out().join("fem.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["engine"], "calculix");
    let again = ["--engine", "calculix", "--size", "5", "--keep"];
    let again = succeeded(bench.live("flush-short").args(again));
    let said = String::from_utf8(again.stderr).unwrap();
    assert!(said.contains("done already"), "{said}");
    // Its curves are taken as they are.
    let error = ["--error-p0", "0.4"];
    let compare = ["compare", "flush-short", "run/curves.csv", "run/pressure.csv"];
    let done = edgeline(folder, &[&compare[..], &error].concat()).output().unwrap();
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stdout));
    // A deck takes the place of the meshes of results, which are not complete without.
    succeeded(edgeline(folder, &deck[..4]).args(["--out", "run"]));
    assert!(bench.out().join("model.inp").exists() && !bench.out().join("fem.json").exists());
}

#[test]
#[ignore = "runs gmsh and CalculiX"]
fn a_deck_for_large_displacements_runs_and_compares() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let deck = ["deck", "flush-short", "--size", "5", "--large-displacements", "--out", "deck"];
    succeeded(&mut edgeline(folder, &deck));
    succeeded(Command::new("ccx").args(["-i", "model"]).current_dir(folder.join("deck")));
    let points = ["-m", "edgeline_fem", "points", "deck/request.json", "deck"];
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("fem");
    let mut reader = Command::new("/usr/bin/python3");
    succeeded(reader.args(points).current_dir(folder).env("PYTHONPATH", python));
    let compare = ["compare", "flush-short", "deck/model-points.csv", "--error-p0", "0.1"];
    succeeded(&mut edgeline(folder, &compare));
}
