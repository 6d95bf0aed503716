//! The driver of the finite elements: children that fail, hang or write nonsense, and killed runs,
//! which are continued and leave no process.
//!
//! Most tests use the stand-ins in `tests/fake/`. Those that run gmsh and FEniCSx are marked
//! `ignore`, since not every machine has them; `tests/all.sh` installs both and runs all tests.

use crate::support::{
    self, Bench, edgeline, fake, files, kill, refused, start, succeeded, wait_for,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

#[test]
fn a_run_leaves_checked_results_and_is_not_repeated() {
    let bench = Bench::new();
    let output = succeeded(bench.fake("").arg("--json"));
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed["case"], "flush-short");
    assert_eq!(printed["summary"]["unknowns"], 42);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("(--python)"), "does not say which interpreter: {said}");
    let wanted = [
        "curves.csv",
        "fem.json",
        "mesh.json",
        "mesh.log",
        "pressure.csv",
        "request.json",
        "request.key",
        "solve.log",
    ];
    assert_eq!(files(&bench.out()), wanted);
    let done = support::said(&succeeded(&mut bench.fake("")));
    assert!(done.contains("done already") && !done.contains("wrote"), "{done}");
    assert_eq!(bench.notes(), ["mesh", "solve"]);
    // A changed request starts a new run, and so does a changed result, whichever it is.
    succeeded(bench.fake("").args(["--size", "2"]));
    assert_eq!(bench.notes().len(), 4);
    for name in ["curves.csv", "pressure.csv", "mesh.json", "request.json", "fem.json"] {
        let (path, before) = (bench.out().join(name), bench.notes().len());
        fs::write(&path, "").unwrap();
        let done = support::said(&succeeded(bench.fake("").args(["--size", "2", "--keep"])));
        assert!(!done.contains("done already"), "{name}: {done}");
        assert!(fs::metadata(&path).unwrap().len() > 0, "{name} is still damaged");
        // What was kept of that run is taken again.
        assert_eq!(bench.notes().len(), if name == "curves.csv" { before + 2 } else { before });
    }
    assert!(bench.out().join("work/block.msh").is_file());
}

/// The files of `folder` with their content, without those below it.
fn content(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let named = files(folder).into_iter().filter(|name| folder.join(name).is_file());
    named.map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn earlier_results_stay_until_the_new_ones_are_complete() {
    let bench = Bench::new();
    let failing = ["fail-mesh", "half-mesh", "fail-solve", "cut-json", "not-finite"];
    // Those of a semi-analytical solution, whose tables have the same names.
    let solve = ["solve", "flush-short", "--method", "half-space", "--tolerance", "1e-2"];
    succeeded(edgeline(bench.folder.path(), &solve).args(["--out", "run"]));
    let before = content(&bench.out());
    assert!(before.iter().any(|(name, _)| name == "summary.json"));
    fs::create_dir(bench.out().join("work")).unwrap();
    let said = refused(&mut bench.fake(""));
    assert!(said.contains("work: was not made by this program"), "{said}");
    assert_eq!(content(&bench.out()), before);
    fs::remove_dir(bench.out().join("work")).unwrap();
    for mode in failing {
        refused(&mut bench.fake(mode));
        assert!(content(&bench.out()) == before, "{mode}: {:?}", files(&bench.out()));
    }
    succeeded(&mut bench.fake(""));
    assert!(!bench.out().join("summary.json").exists(), "curves of another run are marked");
    // Those of another mesh, which are not taken for those of the mesh that failed.
    let before = content(&bench.out());
    for mode in failing {
        refused(bench.fake(mode).args(["--size", "2"]));
        assert!(content(&bench.out()) == before, "{mode}: {:?}", files(&bench.out()));
    }
    let notes = bench.notes().len();
    succeeded(&mut bench.fake(""));
    assert_eq!(bench.notes().len(), notes, "a finished run was repeated");
    let done = support::said(&succeeded(bench.fake("").args(["--size", "2"])));
    assert!(!done.contains("done already"), "{done}");
    assert!(content(&bench.out()) != before);
    // A profile that was given has the name of a result.
    let body = "young_pa = 210e9\npoisson = 0.3\nlength_m = 4e-3\n";
    let case = format!(
        "name = \"a\"\n[roller]\nradius_m = 0.01\n{body}[block]\n{body}[load]\nforce_n = 1e3\n\
         [roller.profile]\nkind = \"table\"\nfile = \"run/pressure.csv\"\n"
    );
    fs::write(bench.folder.path().join("case.toml"), case).unwrap();
    let table = "y_m,drop_m\n-2e-3,1e-6\n0,0\n2e-3,1e-6\n";
    fs::write(bench.out().join("pressure.csv"), table).unwrap();
    let mut run = edgeline(bench.folder.path(), &["fem", "case.toml", "--out", "run"]);
    run.env("FAKE_NOTES", bench.folder.path().join("notes"));
    let notes = bench.notes().len();
    let said = refused(run.arg("--python").arg(fake("python3")).arg("--gmsh").arg(fake("gmsh")));
    assert!(said.contains("pressure.csv: was given to this run"), "{said}");
    assert_eq!(bench.notes().len(), notes, "it ran first");
    assert_eq!(fs::read_to_string(bench.out().join("pressure.csv")).unwrap(), table);
}

#[test]
fn a_damaged_mesh_is_made_again() {
    for name in ["block.msh", "roller.msh", "mesh.json", "mesh.key"] {
        let bench = Bench::new();
        refused(&mut bench.fake("fail-solve"));
        let path = bench.out().join("work").join(name);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let done = support::said(&succeeded(&mut bench.fake("")));
        assert!(!done.contains("meshes are there already"), "{name}: {done}");
        assert_eq!(bench.notes(), ["mesh", "solve", "mesh", "solve"], "{name}");
    }
}

#[test]
fn programs_are_found_from_where_the_command_was_typed() {
    let bench = Bench::new();
    let bin = bench.folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    // Under other names, so that no PATH with them hides the real ones.
    for (name, other) in [("python3", "py"), ("gmsh", "mesher")] {
        std::os::unix::fs::symlink(fake(name), bin.join(other)).unwrap();
    }
    let run = || {
        let mut run = bench.live("flush-short");
        run.args(["--gmsh", "bin/mesher"]);
        run
    };
    succeeded(run().args(["--python", "./bin/py"]));
    succeeded(run().args(["--size", "2"]).env("EDGELINE_PYTHON", "bin/py"));
    let text = fs::read_to_string(bench.out().join("request.json")).unwrap();
    let request: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(Path::new(request["gmsh"].as_str().unwrap()).is_absolute(), "{}", request["gmsh"]);
    // A bare name is looked up on the PATH.
    let paths = std::env::var("PATH").unwrap();
    let mut bare = bench.live("flush-short");
    bare.env("PATH", format!("{}:{paths}", bin.display()));
    succeeded(bare.args(["--size", "4", "--gmsh", "mesher", "--python", "py"]));
    let text = fs::read_to_string(bench.out().join("request.json")).unwrap();
    assert!(text.contains("\"gmsh\": \"mesher\""), "{text}");
}

#[test]
fn failing_children_are_reported_with_the_end_of_their_log() {
    for (mode, wanted) in [
        (
            "fail-mesh",
            ["flush-short, stage mesh: failed with exit code 3", "| gmsh: cannot mesh this"],
        ),
        (
            "fail-solve",
            ["flush-short, stage solve: failed with exit code 2", "| the matrix is singular"],
        ),
        ("die", ["flush-short, stage solve: was killed (signal 9)", "memory"]),
        ("flood-log", ["stage solve: wrote more than 64 MiB of log", "| xxx"]),
        ("flood-disk", ["stage solve: filled its folder with more than 1024 MiB", "--max-disk"]),
    ] {
        let bench = Bench::new();
        let said = refused(bench.fake(mode).args(["--max-disk", "1"]));
        for text in wanted {
            assert!(said.contains(text), "{mode}: {said}");
        }
        assert!(!said.contains('\x1b'), "{mode}: control characters of the child");
        assert!(said.lines().all(|line| line.len() < 5000), "{mode}: an endless line");
        assert!(bench.out().join("work").is_dir(), "{mode}: the files of a failure are kept");
        assert!(!bench.out().join("fem.json").exists(), "{mode}");
        bench.assert_no_process_is_left();
    }
}

#[test]
fn hanging_children_are_stopped_with_all_that_they_started() {
    let bench = Bench::new();
    let began = Instant::now();
    let said = refused(bench.fake("hang").args(["--solve-timeout", "4"]));
    assert!(said.contains("stage solve: took longer than 4 s and was stopped"), "{said}");
    assert!(said.contains("--solve-timeout") && said.contains("| thinking"), "{said}");
    assert!(began.elapsed() < Duration::from_secs(60), "the child was waited for");
    bench.assert_no_process_is_left();
}

#[test]
fn nonsense_is_refused_and_computed_anew() {
    for (mode, wanted) in [
        ("not-finite", "curves.csv:7: 'nan' is not a finite number"),
        ("too-few-rows", "curves.csv: the 43 points of roller depth-end-x1.4 are not the 50"),
        ("cut-json", "fem.json:1: is not JSON"),
        ("bad-mesh-json", "mesh.json:1: is not JSON"),
        ("lost-load", "load_error_rel = 0.001 is more than 1e-6"),
        ("nothing", "but did not write"),
        ("nothing", "| no solution today"),
        ("half-mesh", "but did not write"),
    ] {
        let bench = Bench::new();
        let said = refused(&mut bench.fake(mode));
        assert!(said.contains(wanted), "{mode}: {said}");
        let (stage, file) = match mode {
            "bad-mesh-json" => ("mesh", "mesh.json"),
            "half-mesh" => ("mesh", "roller.msh"),
            "not-finite" | "too-few-rows" => ("solve", "curves.csv"),
            _ => ("solve", "fem.json"),
        };
        let stage_ended = format!("flush-short, stage {stage}: ended with exit code 0, but ");
        assert!(said.contains(&stage_ended) && said.contains(file), "{mode}: {said}");
        let log = bench.out().join(format!("work/{stage}.log"));
        assert!(said.contains("the whole log: ") && log.is_file(), "{mode}: {said}");
        assert!(!said.contains("check the path"), "{mode}: {said}");
        assert!(!bench.out().join("curves.csv").exists(), "{mode}");
        succeeded(&mut bench.fake(""));
        let meshed = bench.notes().iter().filter(|note| *note == "mesh").count();
        assert_eq!(meshed, if stage == "mesh" { 2 } else { 1 }, "{mode}");
    }
}

#[test]
fn missing_tools_are_named_with_what_to_install() {
    let bench = Bench::new();
    let said = refused(&mut bench.fake("no-dolfinx"));
    assert!(said.contains("imports dolfinx was not found"), "{said}");
    let why =
        "tests/fake/python3 (--python), which failed with exit code 1: ModuleNotFoundError: No";
    assert!(said.contains(why), "{said}");
    assert!(said.contains("apt-get install gmsh python3-dolfinx"), "{said}");
    let said = refused(bench.live("flush-short").args(["--gmsh", "no-such-gmsh"]));
    assert!(said.contains("no-such-gmsh was not found") && said.contains("--gmsh"), "{said}");
    let said = refused(bench.fake("").args(["--size", "0.01"]));
    assert!(said.contains("size = 0.01 is not valid"), "{said}");
    let said = refused(bench.fake("").args(["--ranks", "0"]));
    assert!(said.contains("'--ranks <N>': give a number of processes between 1 and"), "{said}");
    let said = refused(bench.fake("").args(["--ranks", "60000"]));
    assert!(said.contains("ranks = 60000 is not valid: it is more than this"), "{said}");
    let said = refused(bench.fake("").args(["--mesh-timeout", "-1"]));
    assert!(said.contains("--mesh-timeout"), "{said}");
    assert_eq!(bench.notes(), [""; 0]);
}

#[test]
fn doctor_says_what_is_missing() {
    let bench = Bench::new();
    let doctor = |mode: &str, more: &[&str]| {
        let mut doctor = edgeline(bench.folder.path(), &["doctor", "--python"]);
        doctor.arg(fake("python3")).args(more).env("FAKE", mode).output().unwrap()
    };
    let gmsh = fake("gmsh");
    let gmsh = gmsh.to_str().unwrap();
    let output = doctor("", &["--gmsh", gmsh, "--fem"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("gmsh: 0.0.0") && said.contains("finite elements: ready"), "{said}");
    assert_eq!(doctor("", &["--gmsh", "/bin/ls", "--fem"]).status.code(), Some(2));
    let output = doctor("no-dolfinx", &["--gmsh", gmsh]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let why = "does not import dolfinx: it failed with exit code 1: ModuleNotFoundError: No module";
    assert!(said.contains(why) && said.contains("apt-get"), "{said}");
    let output = doctor("", &["--gmsh", "/bin/false"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("gmsh: failed with exit code 1"), "{said}");
    let none = ["doctor", "--gmsh", gmsh, "--python", "no-such-python"];
    let output = edgeline(bench.folder.path(), &none).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("no-such-python (--python): not found"), "{said}");
    let output = doctor("", &["--gmsh", "no-such-gmsh", "--fem", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed["fem"]["ready"], false);
    let why = printed["fem"]["gmsh_fault"].as_str().unwrap();
    assert!(why.starts_with("cannot be started: No such file"), "{why}");
    assert_eq!(printed["fem"]["interpreters"][0]["imports"]["dolfinx"], "0");
    assert!(String::from_utf8(output.stderr).unwrap().contains("gmsh was not found"));
}

#[test]
fn a_folder_serves_one_run_at_a_time() {
    let bench = Bench::new();
    let mut first = start(bench.fake("").env("FAKE_PAUSE", "0.4"));
    wait_for("meshing", || bench.notes() == ["mesh"]);
    let said = refused(&mut bench.fake(""));
    assert!(said.contains(&format!("is in use by another run (process {})", first.id())), "{said}");
    assert!(first.wait().unwrap().success());
    succeeded(&mut bench.fake(""));
    assert_eq!(bench.notes(), ["mesh", "solve"]);
}

#[test]
fn requests_to_stop_end_the_child_and_the_next_run_goes_on() {
    for signal in [libc::SIGINT, libc::SIGTERM, libc::SIGHUP] {
        let bench = Bench::new();
        let driver = start(&mut bench.fake("hang"));
        wait_for("solving", || bench.notes().len() == 2);
        kill(driver.id() as i32, signal);
        let output = driver.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(&format!("stopped by signal {signal}")), "{said}");
        bench.assert_no_process_is_left();
        succeeded(&mut bench.fake(""));
        assert_eq!(bench.notes(), ["mesh", "solve", "solve"]);
    }
}

#[test]
fn children_die_with_a_killed_driver_and_the_next_run_removes_the_rest() {
    let bench = Bench::new();
    let mut driver = start(&mut bench.fake("hang"));
    wait_for("solving", || bench.notes().len() == 2 && bench.processes().len() == 2);
    kill(driver.id() as i32, libc::SIGKILL);
    driver.wait().unwrap();
    // The stand-in dies at once; its child has left the process group.
    wait_for("the child's death", || bench.processes().len() == 1);
    succeeded(&mut bench.fake(""));
    bench.assert_no_process_is_left();
    assert_eq!(bench.notes(), ["mesh", "solve", "solve"]);
}

/// The stage process of the run, if it runs.
fn stage_process(bench: &Bench) -> Option<i32> {
    bench.processes().into_iter().find(|pid| {
        fs::read(format!("/proc/{pid}/cmdline"))
            .is_ok_and(|text| text.windows(12).any(|part| part == b"edgeline_fem"))
    })
}

/// Kills drivers and children of runs at moments spread over `span`, then lets one run finish.
/// Returns the number of runs that were hit.
fn run_under_fire(
    bench: &Bench,
    command: &dyn Fn() -> Command,
    span: Duration,
    rounds: u32,
) -> u32 {
    let mut hits = 0;
    // A fixed sequence that has no rhythm: multiples of the golden ratio.
    for round in 0..rounds {
        let mut driver = start(&mut command());
        let phase = (f64::from(round) * 0.618_033_988_749_895 + 0.07).fract();
        std::thread::sleep(span.mul_f64(phase));
        let victim = if round % 2 == 0 { Some(driver.id() as i32) } else { stage_process(bench) };
        if let Some(pid) = victim {
            kill(pid, libc::SIGKILL);
        }
        let status = driver.wait().unwrap();
        bench.assert_no_process_is_left();
        if status.success() {
            // The signal came too late; the next run is hit instead.
            fs::remove_dir_all(bench.out()).unwrap();
            fs::create_dir(bench.out()).unwrap();
        } else {
            hits += 1;
        }
    }
    succeeded(&mut command());
    bench.assert_no_process_is_left();
    hits
}

#[test]
fn killed_runs_are_completed_and_equal_an_undisturbed_one() {
    let undisturbed = Bench::new();
    succeeded(&mut undisturbed.fake(""));
    let bench = Bench::new();
    fs::create_dir(bench.out()).unwrap();
    let command = || {
        let mut command = bench.fake("");
        command.env("FAKE_PAUSE", "0.1");
        command
    };
    let hits = run_under_fire(&bench, &command, Duration::from_millis(800), 12);
    assert!(hits >= 4, "only {hits} of the runs were hit");
    assert_eq!(bench.results(), undisturbed.results());
}

#[test]
#[ignore = "runs gmsh and FEniCSx"]
fn live_coarse_model_carries_its_load_and_meets_the_record() {
    let bench = Bench::new();
    let study = edgeline::case::Study::built_in();
    let case = study.corners.iter().find(|c| c.name == "w1e-3_sl5_lr1").unwrap();
    let text = format!(
        "name = \"live\"\n[roller]\nradius_m = {:e}\nyoung_pa = {:e}\npoisson = {:e}\n\
         [block]\nyoung_pa = {:e}\npoisson = {:e}\n[dimensionless]\nW = 1e-3\nS_l = 5\nL_r = 1\n",
        case.roller.radius_m,
        case.roller.material.young_pa,
        case.roller.material.poisson,
        case.block.material.young_pa,
        case.block.material.poisson,
    );
    fs::write(bench.folder.path().join("live.toml"), text).unwrap();
    let output = succeeded(bench.live("live.toml").args(["--size", "2", "--json"]));
    let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let summary = &printed["summary"];
    assert!(summary["load_error_rel"].as_f64().unwrap() <= 1e-6);
    assert!(summary["equilibrium_residual"].as_f64().unwrap() <= 1e-6);
    let record = edgeline::fem::FemResults::embedded_of(case).unwrap().expect("a record");
    let recorded = record.finest().summary.p_centre_pa;
    let centre = summary["p_centre_pa"].as_f64().unwrap();
    assert!((centre / recorded - 1.0).abs() <= 0.03, "{centre:e} Pa, recorded {recorded:e} Pa");
}

#[test]
#[ignore = "runs gmsh and FEniCSx"]
fn live_killed_runs_are_completed_and_equal_undisturbed_ones() {
    for case in ["flush-short", "half-short"] {
        let undisturbed = Bench::new();
        let began = Instant::now();
        succeeded(undisturbed.live(case).args(["--size", "4"]));
        let span = began.elapsed();
        let bench = Bench::new();
        fs::create_dir(bench.out()).unwrap();
        let command = || {
            let mut command = bench.live(case);
            command.args(["--size", "4"]);
            command
        };
        let hits = run_under_fire(&bench, &command, span, 5);
        assert!(hits >= 2, "only {hits} of the runs were hit");
        assert_eq!(bench.results(), undisturbed.results());
    }
}

#[test]
#[ignore = "runs gmsh and FEniCSx"]
fn live_killed_study_is_completed_and_equals_an_undisturbed_one() {
    let study = |bench: &Bench| {
        let file = bench.folder.path().join("two.toml");
        let body = "young_pa = 210e9\npoisson = 0.3";
        let text = format!(
            "name = \"two\"\n[roller]\nradius_m = 10e-3\n{body}\n[block]\n{body}\n\
             [factors]\nW = [1e-3]\nS_l = [3.0]\nL_r = [0.75, 1.0]\n"
        );
        fs::write(&file, text).unwrap();
        let mut command = edgeline(bench.folder.path(), &["study", "two.toml", "--fem", "live"]);
        command
            .args(["--fem-repeats", "1", "--size", "4", "--repeats", "0", "--methods", "mirror"])
            .arg("--out")
            .arg(bench.out());
        command
    };
    let results = |bench: &Bench| {
        let files = ["curves.csv", "pressure.csv", "fem_error.csv", "errors.csv"];
        files.map(|f| fs::read_to_string(bench.out().join(f)).unwrap())
    };
    // Finished runs of finite elements: two meshes of two cases.
    let finished = |bench: &Bench| {
        let list = |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten();
        let runs = list(bench.out().join("fem")).flat_map(|case| list(case.path()));
        runs.filter(|run| run.path().join("request.key").is_file()).count()
    };

    let undisturbed = Bench::new();
    let began = Instant::now();
    succeeded(&mut study(&undisturbed));
    let span = began.elapsed();
    assert_eq!(finished(&undisturbed), 4);

    let bench = Bench::new();
    fs::create_dir(bench.out()).unwrap();
    let mut hits = 0;
    for round in 0..6 {
        let mut driver = start(&mut study(&bench));
        let phase = (f64::from(round) * 0.618_033_988_749_895 + 0.07).fract();
        std::thread::sleep(span.mul_f64(phase));
        let victim = if round % 2 == 0 { Some(driver.id() as i32) } else { stage_process(&bench) };
        if driver.try_wait().unwrap().is_none()
            && let Some(pid) = victim
        {
            kill(pid, libc::SIGKILL);
            hits += 1;
        }
        // The driver continues without its child: the study has a row for the failed case.
        driver.wait().unwrap();
        bench.assert_no_process_is_left();
        if finished(&bench) == 4 {
            // So that the next round has a run to hit.
            fs::remove_dir_all(bench.out().join("fem")).unwrap();
        }
    }
    assert!(hits >= 3, "only {hits} of the runs were hit");
    succeeded(&mut study(&bench));
    bench.assert_no_process_is_left();
    assert_eq!(finished(&bench), 4);
    assert_eq!(results(&bench), results(&undisturbed));
}

#[test]
#[ignore = "runs gmsh and FEniCSx"]
fn live_solvers_and_ranks_agree() {
    let [direct, other] = [Bench::new(), Bench::new()];
    succeeded(direct.live("flush-short").args(["--size", "6"]));
    let iterative = ["--size", "6", "--linear", "iterative", "--ranks", "2"];
    succeeded(other.live("flush-short").args(iterative));
    let text = fs::read_to_string(other.out().join("fem.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["ranks"], 2);
    let iterations = summary["linear_iterations"].as_u64().unwrap();
    assert!(iterations > 500, "{iterations} iterations are not an iterative solver's");
    let p0_pa = summary["hertz"]["p0_pa"].as_f64().unwrap();
    for (one, two) in direct.results().iter().zip(&other.results()) {
        assert_eq!(one.lines().count(), two.lines().count());
        for (a, b) in one.split([',', '\n']).zip(two.split([',', '\n'])) {
            match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) => assert!((a - b).abs() <= 1e-6 * p0_pa, "{a:e} and {b:e} Pa"),
                _ => assert_eq!(a, b),
            }
        }
    }
}
