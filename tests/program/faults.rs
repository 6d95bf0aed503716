//! Faults outside the program: full and read-only disks, removed folders, children that write
//! nonsense, names that look like commands, two runs in one folder, wrong clocks, and requests that
//! are far too large. Finished results are kept, incomplete ones are not taken for complete, no
//! process is left behind, and every refusal has a remedy and exit code 2.
//!
//! Full and read-only disks are mounted for the test, which needs root. Without root these tests
//! are skipped with a message, unless `EDGELINE_REQUIRE_MOUNT` is set; `tests/all.sh` sets it if it
//! runs as root.

use crate::support::{Bench, edgeline, fake, kill, refused, start, succeeded, wait_for};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::{self, File, FileTimes, OpenOptions};
use std::io::Write;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// `command` with limits of `prlimit`, e.g. `--as=1000000000`.
fn limited(limit: &str, command: &Command) -> Command {
    let mut limited = Command::new("prlimit");
    limited.arg(limit).arg(command.get_program()).args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        limited.current_dir(folder);
    }
    limited.stdin(Stdio::null());
    limited
}

/// A disk of its own, unmounted at the end.
struct Disk {
    path: PathBuf,
}

impl Disk {
    /// Mounts a disk of `size` (in the form of `mount`) at the new folder `path`. None if that is
    /// not allowed.
    fn mount(path: &Path, size: &str) -> Option<Disk> {
        fs::create_dir_all(path).unwrap();
        let options = format!("size={size}");
        let mount = ["-t", "tmpfs", "-o", &options, "none"];
        let done = Command::new("mount").args(mount).arg(path).output();
        if done.as_ref().is_ok_and(|o| o.status.success()) {
            return Some(Disk { path: path.to_path_buf() });
        }
        assert!(std::env::var_os("EDGELINE_REQUIRE_MOUNT").is_none(), "no disk: {done:?}");
        eprintln!("skipped: a disk can only be mounted by root");
        None
    }

    /// Fills the disk up to `left` free bytes.
    fn fill(&self, left: u64) {
        let mut file = File::create(self.ballast()).unwrap();
        while file.write_all(&[0; 4096]).is_ok() {}
        let length = file.metadata().unwrap().len();
        file.set_len(length - left).unwrap();
    }

    /// Frees the filled space.
    fn clear(&self) {
        fs::remove_file(self.ballast()).unwrap();
    }

    fn ballast(&self) -> PathBuf {
        self.path.join("ballast")
    }

    /// Mounts it again as read-only.
    fn protect(&self) {
        let done = Command::new("mount").args(["-o", "remount,ro"]).arg(&self.path).status();
        assert!(done.unwrap().success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // A process that was just killed may still hold it.
        let _ = Command::new("umount").arg("--lazy").arg(&self.path).status();
    }
}

/// All files below a folder with their content, without the ballast.
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(content(&path));
        } else if !path.ends_with("ballast") {
            found.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    found
}

/// A study of two cases by one model, which takes a second.
fn small_study(folder: &Path) {
    let body = "young_pa = 210e9\npoisson = 0.3";
    let text = format!(
        "name = \"small\"\n[roller]\nradius_m = 10e-3\n{body}\n[block]\n{body}\n\
         [factors]\nW = [1e-3]\nS_l = [5.0]\nL_r = [0.5, 1.0]\n[accuracy]\ntolerance = 1e-2\n"
    );
    fs::write(folder.join("small.toml"), text).unwrap();
}

const SMALL_STUDY: [&str; 6] = ["study", "small.toml", "--methods", "mirror", "--repeats", "0"];

/// A sweep over `count` loads, which one solution serves, or over as many lengths, which take one
/// each.
fn sweep_file(folder: &Path, key: &str, from: f64, to: f64, count: usize) {
    let mut values = BTreeMap::from([("W", "1e-3".to_string()), ("S_l", "5".to_string())]);
    values.insert(key, format!("{{ from = {from:e}, to = {to:e}, count = {count} }}"));
    let body = "young_pa = 210e9\npoisson = 0.3";
    let text = format!(
        "[roller]\nradius_m = 10e-3\n{body}\n[block]\n{body}\n\
         [dimensionless]\nW = {}\nS_l = {}\nL_r = 1.0\n[accuracy]\ntolerance = 1e-1\n",
        values["W"], values["S_l"]
    );
    fs::write(folder.join("sweep.toml"), text).unwrap();
}

/// Checks the message about a full disk.
fn assert_says_full(said: &str) {
    assert!(said.contains("No space left on device"), "{said}");
    assert!(said.contains("make room there, or give a folder on another disk"), "{said}");
}

#[test]
fn a_full_disk_leaves_the_results_that_were_there() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let Some(disk) = Disk::mount(&out, "32m") else { return };
    small_study(folder.path());
    let solve = |method| {
        let solve = ["solve", "flush-short", "--tolerance", "1e-2", "--method", method];
        edgeline(folder.path(), &[&solve[..], &["--out", "out/solve"]].concat())
    };
    let study = edgeline(folder.path(), &[&SMALL_STUDY[..], &["--out", "out/study"]].concat());
    let mut runs = [solve("half-space"), study];
    runs.iter_mut().for_each(|run| {
        succeeded(run);
    });
    let before = content(&out);
    runs[0] = solve("mirror");
    // Too little for the tables, then for a single byte.
    for left in [16384, 0] {
        disk.fill(left);
        for run in &mut runs {
            assert_says_full(&refused(run));
        }
        assert!(content(&out) == before, "with {left} bytes left something was changed");
        disk.clear();
    }
    succeeded(&mut runs[0]);
    let text = fs::read_to_string(out.join("solve/summary.json")).unwrap();
    assert!(text.contains("\"mirror\""), "{text}");
}

#[test]
fn a_sweep_goes_on_after_a_full_disk() {
    let folder = tempfile::tempdir().unwrap();
    sweep_file(folder.path(), "W", 1e-5, 1e-3, 300);
    let sweep = |out: &str| {
        let method = ["--method", "half-space", "--out", out];
        edgeline(folder.path(), &[&["sweep", "sweep.toml"], &method[..]].concat())
    };
    succeeded(&mut sweep("whole.csv"));
    let whole = fs::read_to_string(folder.path().join("whole.csv")).unwrap();
    assert_eq!(whole.lines().count(), 301);
    let Some(disk) = Disk::mount(&folder.path().join("out"), "1m") else { return };
    disk.fill(20480);
    assert_says_full(&refused(&mut sweep("out/s.csv")));
    let half = fs::read_to_string(disk.path.join("s.csv")).unwrap();
    assert!(half.lines().count() > 10 && half.len() < whole.len() && whole.starts_with(&half));
    disk.clear();
    succeeded(&mut sweep("out/s.csv"));
    assert_eq!(fs::read_to_string(disk.path.join("s.csv")).unwrap(), whole);
}

#[test]
fn finite_elements_go_on_after_a_full_disk() {
    let bench = Bench::new();
    let Some(disk) = Disk::mount(&bench.out(), "4m") else { return };
    let run = || {
        let mut run = bench.fake("");
        // The compiled forms of the user's cache would fill the disk.
        run.env("XDG_CACHE_HOME", bench.folder.path().join("cache"));
        run
    };
    // Room for the sources of the finite-element side, not for its results.
    disk.fill(430_080);
    let said = refused(&mut run());
    assert!(said.contains("make room there"), "{said}");
    assert!(!bench.out().join("fem.json").exists());
    disk.clear();
    succeeded(&mut run());
    let before = bench.results();
    assert_eq!(bench.notes(), ["mesh", "solve", "solve"]);
    // Finished results are kept on a full disk, and where there is room for a part of the next run.
    let whole = content(&bench.out());
    for left in [430_080, 0] {
        disk.fill(left);
        let said = refused(run().args(["--size", "2"]));
        assert!(said.contains("make room there"), "{left}: {said}");
        let now = content(&bench.out());
        assert!(whole.iter().all(|(path, text)| now.get(path) == Some(text)), "{left}");
        disk.clear();
    }
    assert_eq!(bench.results(), before);
    let notes = bench.notes().len();
    succeeded(&mut run());
    assert_eq!(bench.notes().len(), notes, "a finished run was repeated");
    bench.assert_no_process_is_left();
}

#[test]
fn files_that_may_not_grow_are_not_taken_for_whole() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let solve = |method| edgeline(folder.path(), &["solve", "flush-short", "--method", method]);
    succeeded(&mut solve("half-space"));
    let before = content(&out);
    // The signal of this limit would kill the program without a message.
    let said = refused(&mut limited("--fsize=30000", &solve("mirror")));
    assert!(said.contains("File too large") && said.contains("allow larger files"), "{said}");
    let now = content(&out);
    assert!(before.iter().all(|(path, text)| now[path] == *text), "a result was changed");
    succeeded(&mut solve("mirror"));
    assert_eq!(content(&out).len(), before.len(), "{:?}", content(&out).keys());
}

#[test]
fn streams_that_take_nothing_are_no_reason_to_fail_silently() {
    let folder = tempfile::tempdir().unwrap();
    let full = || OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut solve = edgeline(folder.path(), &["solve", "flush-short", "--json"]);
    let said = refused(solve.stdout(full()));
    assert!(said.contains("cannot write to standard output: No space left"), "{said}");
    // An error without a message is still an error, and not a crash.
    let mut wrong = edgeline(folder.path(), &["solve", "nowhere.toml"]);
    let status = wrong.stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));
    // Warnings that cannot be written are dropped.
    let bench = Bench::new();
    assert!(bench.fake("").stdout(Stdio::null()).stderr(full()).status().unwrap().success());
}

#[test]
fn read_only_folders_are_refused_before_anything_is_computed() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let Some(disk) = Disk::mount(&bench.out(), "1m") else { return };
    small_study(folder);
    sweep_file(folder, "W", 1e-5, 1e-3, 3);
    disk.protect();
    let out = ["--out", "run/o"];
    for mut command in [
        edgeline(folder, &[&["solve", "flush-short"], &out[..]].concat()),
        edgeline(folder, &[&SMALL_STUDY[..], &out].concat()),
        edgeline(folder, &[&["gate"], &out[..]].concat()),
        edgeline(folder, &[&["bench"], &out[..]].concat()),
        edgeline(folder, &["sweep", "sweep.toml", "--out", "run/s.csv"]),
        bench.fake(""),
    ] {
        let said = refused(&mut command);
        assert!(said.contains("Read-only file system (os error 30)"), "{said}");
        assert!(said.contains("give another path, or change the permissions there"), "{said}");
    }
    assert_eq!(bench.notes(), [""; 0]);
}

#[test]
fn a_folder_that_vanishes_is_reported() {
    // Finite elements: the folder is removed while a child works in it.
    let bench = Bench::new();
    let driver = start(bench.fake("").env("FAKE_PAUSE", "0.5"));
    wait_for("meshing", || bench.notes() == ["mesh"]);
    wait_for("the removal", || {
        let _ = fs::remove_dir_all(bench.out());
        !bench.out().exists()
    });
    let done = driver.wait_with_output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("stage mesh: failed"), "{said}");
    fs::create_dir_all(bench.out()).unwrap();
    bench.assert_no_process_is_left();

    // A sweep: rows would be written into a file without a name.
    let folder = tempfile::tempdir().unwrap();
    sweep_file(folder.path(), "S_l", 5.0, 50.0, 2000);
    let arguments = ["sweep", "sweep.toml", "--jobs", "1", "--out", "deep/s.csv"];
    let sweep = start(&mut edgeline(folder.path(), &arguments));
    let file = folder.path().join("deep/s.csv");
    wait_for("a row", || fs::read_to_string(&file).is_ok_and(|t| t.lines().count() > 1));
    fs::remove_dir_all(folder.path().join("deep")).unwrap();
    let done = sweep.wait_with_output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("cannot write deep/s.csv: No such file"), "{said}");
    assert!(said.contains("check the path, and that nobody removed it meanwhile"), "{said}");

    // A study writes all its files or fails.
    small_study(folder.path());
    let study = start(&mut edgeline(folder.path(), &[&SMALL_STUDY[..], &["--out", "o"]].concat()));
    let out = folder.path().join("o");
    wait_for("the folder", || out.join(".lock").exists());
    wait_for("the removal", || {
        let _ = fs::remove_dir_all(&out);
        !out.exists()
    });
    let done = study.wait_with_output().unwrap();
    match done.status.code() {
        Some(0) => assert!(out.join("summary.json").exists() && out.join("report.html").exists()),
        Some(2) => assert!(!out.join("summary.json").exists()),
        other => panic!("exit code {other:?}: {}", String::from_utf8_lossy(&done.stderr)),
    }
}

#[test]
fn solves_killed_at_any_moment_leave_one_answer_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let solve = |method: &str, out: &str| {
        let solve = ["solve", "flush-short", "--tolerance", "1e-2", "--method", method];
        edgeline(folder.path(), &[&solve[..], &["--out", out]].concat())
    };
    let methods = ["half-space", "mirror"];
    let tables = |out: &str| {
        let out = folder.path().join(out);
        ["curves.csv", "pressure.csv"].map(|name| fs::read(out.join(name)).unwrap_or_default())
    };
    let began = Instant::now();
    let answers = methods.map(|method| {
        succeeded(&mut solve(method, method));
        tables(method)
    });
    let span = began.elapsed() / 2;
    let summary = folder.path().join("out/summary.json");
    for round in 0..24u32 {
        let mut run = start(&mut solve(methods[round as usize % 2], "out"));
        let phase = (f64::from(round) * 0.618_033_988_749_895 + 0.07).fract();
        std::thread::sleep(span.mul_f64(1.2 * phase));
        kill(run.id() as i32, libc::SIGKILL);
        run.wait().unwrap();
        if let Ok(text) = fs::read(&summary) {
            let summary: serde_json::Value = serde_json::from_slice(&text).unwrap();
            let which = methods.iter().position(|m| summary["method"] == *m).unwrap();
            assert!(tables("out") == answers[which], "round {round}: files of two runs");
        }
    }
    succeeded(&mut solve("mirror", "out"));
    let left: Vec<PathBuf> = content(&folder.path().join("out")).into_keys().collect();
    // The four files of a solution, and the list of them.
    assert_eq!(left.len(), 5, "{left:?}");
}

/// A folder with a copy of one record.
fn copied_record(folder: &Path) -> PathBuf {
    let name = "w1e-3_sl5_lr1";
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/reference").join(name);
    let copy = folder.join("reference").join(name);
    fs::create_dir_all(&copy).unwrap();
    for entry in fs::read_dir(source).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, copy.join(path.file_name().unwrap())).unwrap();
    }
    copy
}

#[test]
fn damaged_references_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    small_study(folder.path());
    let with_reference = ["--reference", "reference", "--out", "o"];
    let run = || edgeline(folder.path(), &[&SMALL_STUDY[..], &with_reference].concat());
    let record = copied_record(folder.path());
    succeeded(&mut run());
    let curves = fs::read(record.join("curves.csv")).unwrap();
    fs::write(record.join("curves.csv"), &curves[..curves.len() / 2]).unwrap();
    let said = refused(&mut run());
    assert!(said.contains("curves.csv: was changed or is damaged: its SHA-256 is"), "{said}");
    assert!(said.contains("restore the folder from version control"), "{said}");
    assert!(said.contains("python3 -m edgeline_fem record"), "{said}");
    // An endless pipe is not read to its end.
    File::create(record.join("curves.csv")).unwrap().set_len(1 << 40).unwrap();
    let said = refused(&mut run());
    assert!(said.contains("curves.csv: is larger than 256 MiB"), "{said}");
    fs::write(record.join("curves.csv"), &curves).unwrap();
    // Another version of the format, with the right checksum.
    let text = fs::read_to_string(record.join("record.json")).unwrap();
    let text = text.replacen("\"schema\": 1", "\"schema\": 7", 1);
    let sum: String = Sha256::digest(&text).iter().map(|b| format!("{b:02x}")).collect();
    fs::write(record.join("record.json"), text).unwrap();
    let sums = fs::read_to_string(record.join("SHA256SUMS")).unwrap();
    let others: Vec<&str> = sums.lines().filter(|l| !l.ends_with("record.json")).collect();
    let sums = format!("{sum}  record.json\n{}\n", others.join("\n"));
    fs::write(record.join("SHA256SUMS"), sums).unwrap();
    let said = refused(&mut run());
    assert!(said.contains("record.json: has schema 7, this program reads 1"), "{said}");
}

#[test]
fn children_that_write_garbage_are_refused() {
    for (mode, wanted) in [
        ("garbage-probe", "imports dolfinx was not found"),
        ("flood-probe", "imports dolfinx was not found"),
        ("kill-mesh", "stage mesh: was killed (signal 9)"),
        ("nothing-mesh", "stage mesh: ended with exit code 0, but did not write"),
        ("nothing-mesh", "| no mesh today"),
        ("garbage-log", "stage mesh: failed with exit code 3"),
        ("huge-mesh", "solving for 2.0e9 unknowns takes about"),
        ("garbage-csv", "curves.csv: is not UTF-8 text"),
        ("huge-csv", "pressure.csv: is larger than 256 MiB"),
        ("deep-json", "fem.json:1: is not JSON"),
        ("other-case", "fem.json: /hertz/c_m = "),
    ] {
        let bench = Bench::new();
        let said = refused(&mut bench.fake(mode));
        assert!(said.contains(wanted), "{mode}: {said}");
        assert!(!said.chars().any(|c| c.is_control() && c != '\n'), "{mode}: {said:?}");
        assert!(!bench.out().join("fem.json").exists(), "{mode}");
        bench.assert_no_process_is_left();
        if mode != "huge-mesh" {
            succeeded(&mut bench.fake(""));
        }
    }
    // A folder of the name that it would work in is somebody else's.
    let bench = Bench::new();
    let own = bench.out().join("work/mine.txt");
    fs::create_dir_all(own.parent().unwrap()).unwrap();
    fs::write(&own, "mine").unwrap();
    let said = refused(&mut bench.fake(""));
    assert!(said.contains("work: was not made by this program") && own.exists(), "{said}");
    // A program that fails, dies or prints nothing is not gmsh.
    let bench = Bench::new();
    for script in ["exit 3", "kill -9 $$", "exit 0", "printf '\\377\\376'"] {
        let gmsh = bench.folder.path().join("gmsh");
        fs::write(&gmsh, format!("#!/bin/sh\n{script}\n")).unwrap();
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        fs::set_permissions(&gmsh, mode).unwrap();
        let mut run = bench.live("flush-short");
        let said = refused(run.arg("--python").arg(fake("python3")).arg("--gmsh").arg(&gmsh));
        assert!(said.contains("gmsh was not found") && said.contains("--gmsh"), "{script}: {said}");
    }
}

#[test]
fn names_of_cases_cannot_leave_their_folder() {
    let folder = tempfile::tempdir().unwrap();
    let good = include_str!("../../cases/flush-short.toml");
    let long = "x".repeat(65);
    let names =
        ["", ".", "..", "../up", "/tmp/x", "a b", "a\\\"b", "a'b", "a\\nb", "ü", "$(id)", &long];
    for name in names {
        let text = good.replacen("\"flush-short\"", &format!("\"{name}\""), 1);
        fs::write(folder.path().join("c.toml"), text).unwrap();
        let said = refused(&mut edgeline(folder.path(), &["solve", "c.toml", "--out", "o"]));
        assert!(said.contains("c.toml:") && said.contains("a name is 1 to 64 letters"), "{said}");
    }
    assert_eq!(content(folder.path()).len(), 1);
    // In a table they are an error of the row, which remains one line.
    let mut table = csv::Writer::from_path(folder.path().join("t.csv")).unwrap();
    table.write_record(["name", "W", "S_l", "L_r"]).unwrap();
    for name in ["..", "a b", "a\"b", "a\nb", "ü", "good"] {
        table.write_record([name, "1e-3", "5", "1"]).unwrap();
    }
    table.flush().unwrap();
    drop(table);
    let arguments = ["sweep", "t.csv", "--base", "flush-short", "--method", "mirror"];
    let mut sweep = edgeline(folder.path(), &arguments);
    succeeded(&mut sweep);
    let rows = fs::read_to_string(folder.path().join("sweep.csv")).unwrap();
    assert_eq!(rows.lines().count(), 7, "{rows}");
    assert_eq!(rows.lines().filter(|l| l.contains("a name is 1 to 64")).count(), 5, "{rows}");
    // A sweep is continued even if its file was cut within a character, as by a full disk.
    let cut = rows.find('ü').unwrap() + 1;
    fs::write(folder.path().join("sweep.csv"), &rows.as_bytes()[..cut]).unwrap();
    succeeded(&mut sweep);
    assert_eq!(fs::read_to_string(folder.path().join("sweep.csv")).unwrap(), rows);
}

/// Results have fixed names, and so may what they come from.
#[test]
fn results_do_not_take_the_place_of_what_was_given() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let points = "body,x_m,y_m,z_m\nblock,0,0,1e-5\n";
    fs::write(path.join("points.csv"), points).unwrap();
    let solve = ["solve", "flush-short", "--points", "points.csv", "--out", "."];
    let said = refused(&mut edgeline(path, &solve));
    assert!(said.contains("points.csv") && said.contains("give another --out"), "{said}");
    assert_eq!(fs::read_to_string(path.join("points.csv")).unwrap(), points);
    assert!(!path.join("summary.json").exists());
    succeeded(&mut edgeline(path, &["solve", "flush-short", "--points", "points.csv"]));
}

#[test]
fn a_folder_in_the_place_of_a_file_is_somebody_elses() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("o/summary.json");
    fs::create_dir_all(&own).unwrap();
    fs::write(own.join("kept"), "").unwrap();
    let solve = ["solve", "flush-short", "--method", "half-space", "--tolerance", "1e-2"];
    let said = refused(edgeline(folder.path(), &solve).args(["--out", "o"]));
    assert!(said.contains("summary.json") && said.contains("not a folder"), "{said}");
    assert!(own.join("kept").exists());
    assert_eq!(fs::read_dir(folder.path().join("o")).unwrap().count(), 1);
}

#[test]
fn folders_may_be_called_anything() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let plain =
        ["a b", "a'b\"c", "a\nb", "ünï", "$(touch x);touch x", "-dash", "*"].map(OsStr::new);
    let names = plain.into_iter().chain([OsStr::from_bytes(b"\xff\xfe")]);
    let count = || fs::read_dir(folder).unwrap().count();
    for name in names {
        let before = count();
        let out = Path::new("./").join(name);
        let solve =
            ["solve", "flush-short", "--method", "half-space", "--tolerance", "1e-2", "--out"];
        succeeded(edgeline(folder, &solve).arg(&out));
        assert!(folder.join(name).join("summary.json").exists(), "{name:?}");
        let mut run = bench.fake("");
        // A repeated option would be refused, so the folder is set anew.
        let mut fem = Command::new(run.get_program());
        fem.current_dir(folder).args(["fem", "flush-short", "--out"]).arg(out.join("fem"));
        fem.arg("--python").arg(fake("python3")).arg("--gmsh").arg(fake("gmsh"));
        run = fem;
        succeeded(&mut run);
        assert!(folder.join(name).join("fem/fem.json").exists(), "{name:?}");
        assert_eq!(count(), before + 1, "{name:?}: something was put elsewhere");
    }
    // A study reports its command, and a sweep its files.
    small_study(folder);
    let odd = OsStr::from_bytes(b"./\xff\xfe/study");
    succeeded(edgeline(folder, &[&SMALL_STUDY[..], &["--json", "--out"]].concat()).arg(odd));
    sweep_file(folder, "W", 1e-5, 1e-3, 3);
    let odd = OsStr::from_bytes(b"./\xff\xfe/s.csv");
    succeeded(edgeline(folder, &["sweep", "sweep.toml", "--json", "--out"]).arg(odd));
    // A search path cannot hold a colon, and a request is UTF-8.
    let mut fem = edgeline(folder, &["fem", "flush-short", "--out", "a:b"]);
    let said = refused(fem.arg("--python").arg(fake("python3")).arg("--gmsh").arg(fake("gmsh")));
    assert!(said.contains("choose an output folder without that character"), "{said}");
    assert!(said.contains("--out = ") && !folder.join("a:b").exists(), "{said}");
    let mut fem = edgeline(folder, &["fem", "flush-short", "--out", "o", "--gmsh"]);
    let said = refused(fem.arg(OsStr::from_bytes(b"\xff")));
    assert!(said.contains("a path that is not UTF-8 cannot be handed on"), "{said}");
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    small_study(folder);
    sweep_file(folder, "W", 1e-5, 1e-3, 3);
    let first = start(&mut bench.fake("hang"));
    wait_for("solving", || bench.notes().len() == 2);
    let out = ["--out", "run"];
    for mut command in [
        edgeline(folder, &[&["solve", "flush-short"], &out[..]].concat()),
        edgeline(folder, &[&SMALL_STUDY[..], &out].concat()),
        edgeline(folder, &[&["gate"], &out[..]].concat()),
        edgeline(folder, &[&["bench"], &out[..]].concat()),
        bench.fake(""),
    ] {
        let said = refused(&mut command);
        let wanted = format!("is in use by another run (process {})", first.id());
        assert!(said.contains(&wanted) && said.contains("give another path"), "{said}");
    }
    kill(first.id() as i32, libc::SIGTERM);
    let done = first.wait_with_output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    bench.assert_no_process_is_left();
    let file = File::create(folder.join("s.csv")).unwrap();
    file.lock().unwrap();
    let mut sweep = edgeline(folder, &["sweep", "sweep.toml", "--out", "s.csv"]);
    let said = refused(&mut sweep);
    assert!(
        said.contains("s.csv is in use by another run; wait for it, or give another path"),
        "{said}"
    );
    drop(file);
    succeeded(&mut sweep);
}

#[test]
fn a_study_that_is_asked_to_stop_stops() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    small_study(folder);
    let mut study = edgeline(folder, &SMALL_STUDY);
    study.args(["--fem", "live", "--out", "run", "--python"]).arg(fake("python3"));
    study.arg("--gmsh").arg(fake("gmsh")).env("FAKE", "hang");
    let study = start(study.env("FAKE_NOTES", folder.join("notes")));
    wait_for("solving", || bench.notes().len() == 2);
    // Not SIGINT, which is ignored in background jobs of a shell.
    kill(study.id() as i32, libc::SIGTERM);
    let done = study.wait_with_output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("stopped by signal 15; run again to continue"), "{said}");
    assert!(!bench.out().join("summary.json").exists());
    bench.assert_no_process_is_left();
}

#[test]
fn clocks_that_are_off_change_nothing() {
    let bench = Bench::new();
    succeeded(&mut bench.fake(""));
    let year = Duration::from_secs(365 * 86_400);
    for time in [SystemTime::UNIX_EPOCH, SystemTime::UNIX_EPOCH + 130 * year] {
        // Files of a killed run and of a finished one.
        fs::write(bench.out().join(".lock"), "999999\n").unwrap();
        for path in content(&bench.out()).into_keys() {
            let file = OpenOptions::new().append(true).open(&path).unwrap();
            file.set_times(FileTimes::new().set_modified(time).set_accessed(time)).unwrap();
        }
        succeeded(&mut bench.fake(""));
        assert_eq!(bench.notes(), ["mesh", "solve"], "a finished run was repeated");
    }
    // Only the date of a run comes from the wall clock; time limits use the monotonic clock.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut asks = Vec::new();
    for (path, text) in content(&root.join("src")).into_iter().chain(content(&root.join("fem"))) {
        let text = String::from_utf8_lossy(&text);
        if ["SystemTime::now", "time.time(", ".now("].iter().any(|call| text.contains(call)) {
            asks.push(path.strip_prefix(root).unwrap().to_path_buf());
        }
    }
    asks.retain(|p| p.extension().is_some_and(|e| e == "rs" || e == "py"));
    asks.sort();
    assert_eq!(asks, ["fem/edgeline_fem/record.py", "src/cli/provenance.rs"].map(PathBuf::from));
}

#[test]
fn requests_that_are_far_too_large_are_refused_with_an_estimate() {
    let bench = Bench::new();
    let folder = bench.folder.path();
    let sparse = |name: &str| File::create(folder.join(name)).unwrap().set_len(1 << 40).unwrap();
    sparse("huge.csv");
    sparse("huge.toml");
    let body = "young_pa = 210e9\npoisson = 0.3";
    let million = "{ from = 1e-5, to = 1e-3, count = 1000000 }";
    let text = format!(
        "[roller]\nradius_m = 10e-3\n{body}\n[block]\n{body}\n\
         [dimensionless]\nW = {million}\nS_l = {million}\nL_r = 1.0\n"
    );
    fs::write(folder.join("grid.toml"), text).unwrap();
    let field = ["solve", "half-short", "--field", "--field-points", "2000,2000,2000"];
    let mut mesh = bench.fake("");
    mesh.args(["--size", "0.1"]);
    for (command, wanted) in [
        (
            edgeline(folder, &field),
            "a field of 2000 x 2000 x 2000 points a quarter of a body takes",
        ),
        (
            edgeline(folder, &["solve", "half-short", "--points", "huge.csv"]),
            "huge.csv asks for takes",
        ),
        (edgeline(folder, &["sweep", "huge.csv"]), "huge.csv: is larger than 4096 MiB"),
        (edgeline(folder, &["sweep", "grid.toml"]), "1.00e12 rows would be a file of about"),
        (edgeline(folder, &["solve", "huge.toml"]), "huge.toml: is larger than 1 MiB"),
        (edgeline(folder, &["study", "huge.toml"]), "huge.toml: is larger than 1 MiB"),
        (edgeline(folder, &["sweep", "huge.toml"]), "huge.toml: is larger than 1 MiB"),
        (edgeline(folder, &["gate", "--gates", "huge.toml"]), "reading huge.toml takes about"),
        (mesh, "a mesh of size 0.1 takes about"),
    ] {
        // With less than a gigabyte of memory, the request was refused before any large allocation.
        let mut limited = limited("--as=1073741824", &command);
        for (name, value) in command.get_envs() {
            limited.env(name, value.unwrap_or_default());
        }
        let began = Instant::now();
        let said = refused(&mut limited);
        assert!(said.contains(wanted) && said.contains(" GiB") || said.contains(" MiB"), "{said}");
        assert!(said.contains(wanted), "{said}");
        assert!(said.contains("; "), "no remedy: {said}");
        assert!(began.elapsed() < Duration::from_secs(20), "{wanted}: that took long");
    }
}
