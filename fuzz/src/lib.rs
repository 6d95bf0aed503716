//! What every reader of outside files has to do with any bytes: return, with a value that holds
//! what it promises or an error that names the file. `tests/program/corpora.rs` runs the same on a
//! stable compiler.

use edgeline::case::{Case, Design, Draft, Form, Study, Sweep, builtin_case};
use edgeline::cells::Heights;
use edgeline::fem::{FemResults, MeshResult, MeshSummary, ResultTexts};
use edgeline::study::brought::{BroughtFile, Statements};
use std::path::Path;
use std::sync::LazyLock;

/// The bytes as text, as the program reads files; `None` is refused before any parser sees it.
fn text(data: &[u8]) -> Option<&str> {
    std::str::from_utf8(data).ok()
}

/// Texts of several files in one input: what stands between lines of `%%`.
fn texts<const N: usize>(data: &[u8]) -> Option<[&str; N]> {
    let mut parts = text(data)?.splitn(N, "\n%%\n");
    Some(std::array::from_fn(|_| parts.next().unwrap_or_default()))
}

/// Built-in cases that texts belong to, read once: trying an input takes less time than that.
static FLUSH: LazyLock<Case> = LazyLock::new(|| built_in("flush-short"));
static HALF: LazyLock<Case> = LazyLock::new(|| built_in("half-short"));

/// A built-in case.
fn built_in(name: &str) -> Case {
    builtin_case(name).expect("a built-in case").expect("a valid case")
}

/// Checks a refusal: it names the file, and says what to do after a semicolon.
fn refusal(error: &edgeline::base::Error, file: &str) {
    let said = error.to_string();
    assert!(said.starts_with(file) && said.contains("; "), "{said}");
}

/// Checks a case that was accepted: it is within the legal ranges and survives its own file.
fn accepted(case: &Case) {
    case.check().expect("what a reader accepts is legal");
    let again =
        Case::parse(&case.to_toml(), Path::new("again")).expect("a case reads its own file");
    assert!(again.is_same_problem(case), "{case:?} became {again:?}");
    if case.load.approach_m.is_some() {
        return;
    }
    let hertz = case.hertz();
    assert!(hertz.c_m > 0.0 && hertz.c_m.is_finite(), "{case:?}");
    assert!(hertz.p0_pa > 0.0 && hertz.p0_pa.is_finite(), "{case:?}");
}

/// A case file.
pub fn case(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match Case::parse(text, Path::new("f.toml")) {
        Ok(case) => accepted(&case),
        Err(e) => refusal(&e, "f.toml"),
    }
}

/// A study file.
pub fn study(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match Study::parse(text, Path::new("nowhere/f.toml")) {
        Ok(study) => {
            assert!(study.cases().count() > 0);
            study.cases().take(20).for_each(accepted);
        }
        // A case that it lists may be the one at fault.
        Err(e) => assert!(!e.to_string().is_empty()),
    }
}

/// Checks a sweep that was accepted: each of its rows is a case or says why it is none.
fn rows(sweep: &Sweep) {
    assert!(!sweep.is_empty());
    let last = sweep.len() - 1;
    let chosen = [0, 1, last / 2, last];
    for (i, row) in sweep.rows().unwrap().enumerate().filter(|(i, _)| chosen.contains(i)) {
        let row = row.unwrap();
        assert_eq!(row.len(), sweep.columns().len());
        match sweep.case(i, &row) {
            Ok(case) => accepted(&case),
            Err(e) => assert!(e.to_string().contains("; "), "{e}"),
        }
    }
}

/// A sweep file.
pub fn sweep(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match Sweep::parse(text, Path::new("f.toml")) {
        Ok(sweep) => rows(&sweep),
        Err(e) => assert!(e.to_string().contains("; "), "{e}"),
    }
}

/// The table of a sweep, alone and with a base.
pub fn table(data: &[u8]) {
    let Some(text) = text(data) else { return };
    let half = Draft::of(&HALF, Form::Factors);
    for base in [None, Some(&half)] {
        match Sweep::parse_csv(text, Path::new("f.csv"), base) {
            Ok(sweep) => rows(&sweep),
            Err(e) => refusal(&e, "f.csv"),
        }
    }
}

/// A file of points.
pub fn points(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match edgeline::cli::points::parse(text, Path::new("f.csv"), &HALF) {
        Ok(points) => {
            assert!(!points.is_empty());
            for point in points {
                assert!(point.at_m.iter().all(|v| v.is_finite()) && point.at_m[2] >= 0.0);
            }
        }
        Err(e) => refusal(&e, "f.csv"),
    }
}

/// The files of a finished finite-element run: `fem.json`, `curves.csv`, `pressure.csv`.
pub fn fem_result(data: &[u8]) {
    let Some([summary, curves, pressure]) = texts(data) else { return };
    let texts = ResultTexts { summary, curves, pressure };
    match MeshResult::parse(&FLUSH, 1.0, 1, texts, Path::new("run")) {
        Ok(result) => assert!(result.summary.unknowns > 0 && !result.curves.stress.is_empty()),
        Err(e) => refusal(&e, "run/"),
    }
}

/// Curves from anywhere.
pub fn brought(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match BroughtFile::parse(text, Path::new("f.csv"), &HALF, &Statements::default()) {
        Ok(file) => {
            assert!(file.points > 0);
            let stress = file.curves.stress.iter().flat_map(|curve| &curve.at);
            let lines = file.curves.pressure.iter().flat_map(|line| &line.at);
            assert!(stress.flatten().chain(lines.flatten()).all(|v| v.is_finite()));
        }
        Err(e) => refusal(&e, "f.csv"),
    }
}

/// A measured surface in each format.
pub fn heights(data: &[u8]) {
    for name in ["f.npy", "f.csv", "f.x3p"] {
        match Heights::parse(data, Path::new(name), [1e-6; 2]) {
            Ok(heights) => assert!(heights.half_spans_m().iter().all(|v| *v > 0.0)),
            Err(e) => assert!(e.to_string().contains("; "), "{e}"),
        }
    }
}

/// A design file.
pub fn design(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match Design::parse(text, Path::new("nowhere/f.toml")) {
        Ok(design) => assert!(!design.loads.is_empty() && !design.parameters.is_empty()),
        // The case that it names may be the one at fault.
        Err(e) => assert!(!e.to_string().is_empty()),
    }
}

/// A file of gates.
pub fn gates(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match edgeline::study::gate::parse(text, Path::new("f.toml")) {
        Ok(gates) => assert!(gates.gate.iter().all(|gate| gate.limit > 0.0)),
        Err(e) => refusal(&e, "f.toml"),
    }
}

/// The summary of the meshes that gmsh made.
pub fn mesh(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match MeshSummary::parse(text, Path::new("mesh.json")) {
        Ok(meshes) => assert!(meshes.unknowns > 0),
        Err(e) => refusal(&e, "mesh.json"),
    }
}

/// A recorded result: `record.json`, `curves.csv`, `pressure.csv`.
pub fn record(data: &[u8]) {
    let Some(texts) = texts(data) else { return };
    match FemResults::parse(texts, Path::new("record")) {
        Ok(reference) => assert!(!reference.meshes.is_empty()),
        Err(e) => refusal(&e, "record/"),
    }
}
