//! The gates notice what they are there for: another psi, a sign, a FEM curve that is off.

use edgeline::base::Result;
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Study};
use edgeline::fem;
use edgeline::solve::{Options, Solution, solve_group};
use edgeline::study::gate::{self, Baseline, Outcome};
use edgeline::study::{Range, Setup, Solver, StudyRun, reference, run};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// One flush case and one on a longer block, by the two models that have something to lose.
const STUDY: &str = "name = \"small\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
[block]\nyoung_pa = 210e9\npoisson = 0.3\n[factors]\nW = [1e-3]\nS_l = [5.0]\nL_r = [0.5, 1.0]\n";

const METHODS: [EdgeModel; 2] = [EdgeModel::Guilbault, EdgeModel::QuarterSpace];

fn run_with(solver: &Solver) -> StudyRun {
    let study = Study::parse(STUDY, Path::new("small.toml")).unwrap();
    let answer = |case: &Case| {
        let found = fem::Reference::embedded_of(case).map_err(|e| e.to_string())?;
        found.map(|r| reference::from_fem(&r)).ok_or_else(|| "no record".to_string())
    };
    run(
        &study,
        &Setup {
            methods: METHODS.to_vec(),
            range: Range::default(),
            repeats: 0,
            solver,
            reference: &answer,
            progress: &|_, _, _| {},
        },
    )
}

fn usual(cases: &[Case], method: EdgeModel) -> Vec<Result<Solution>> {
    solve_group(cases, &Options::new(method))
}

fn failed(run: &StudyRun, accepted: &Baseline) -> Vec<Outcome> {
    let gates = gate::parse(gate::DEFAULT_GATES, Path::new("gates.toml")).unwrap();
    let mut outcomes = gate::evaluate(run, &gates, Some(accepted));
    outcomes.retain(|o| !o.passed);
    outcomes
}

#[test]
fn another_psi_and_a_flipped_sign_are_named() {
    let right = run_with(&usual);
    let accepted = Baseline::of(&right);
    assert_eq!(failed(&right, &accepted), Vec::new());

    // A hundredth more of the images.
    let psi = |cases: &[Case], method: EdgeModel| {
        let options = Options { psi: Some(1.40), ..Options::new(method) };
        solve_group(cases, &options)
    };
    let outcomes = failed(&run_with(&psi), &accepted);
    assert!(outcomes.iter().any(|o| o.kind == "drift" && o.method == "guilbault"), "{outcomes:?}");
    assert!(outcomes.iter().all(|o| o.method == "guilbault"), "psi belongs to one model only");
    assert!(outcomes[0].note.contains("guilbault"), "{}", outcomes[0].note);

    // The sign that the paper's x_k - x_p gives the shears across z.
    let sign = |cases: &[Case], method: EdgeModel| {
        let mut solutions = usual(cases, method);
        for solution in solutions.iter_mut().flatten() {
            for stress in solution.curves.iter_mut().flat_map(|c| &mut c.stress_pa) {
                (stress.xz, stress.yz) = (-stress.xz, -stress.yz);
            }
        }
        solutions
    };
    let outcomes = failed(&run_with(&sign), &accepted);
    for method in METHODS {
        let drift = outcomes.iter().find(|o| o.kind == "drift" && o.method == method.name());
        assert!(drift.is_some_and(|o| o.note.contains("sigma_yz")), "{method}: {outcomes:?}");
    }
    // The limits alone notice it too, without accepted numbers.
    assert!(outcomes.iter().any(|o| o.kind == "limit" && o.method == "quarter-space"));
}

fn edgeline(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_edgeline"))
        .args(arguments)
        .current_dir(folder)
        .env("GITHUB_STEP_SUMMARY", folder.join("step.md"))
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Copies the records of the small study's cases.
fn copy_records(to: &Path) -> Vec<PathBuf> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/reference");
    ["w1e-3_sl5_lr0.5", "w1e-3_sl5_lr1"]
        .iter()
        .map(|case| {
            let folder = to.join(case);
            std::fs::create_dir_all(&folder).unwrap();
            for name in ["record.json", "curves.csv", "pressure.csv"] {
                std::fs::copy(from.join(case).join(name), folder.join(name)).unwrap();
            }
            folder
        })
        .collect()
}

/// Multiplies the stresses of one curve of all meshes of a record.
fn scale_curve(record: &Path, body: &str, curve: &str, factor: f64) {
    let path = record.join("curves.csv");
    let mut reader = csv::Reader::from_path(&path).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (of_body, of_curve) = (column("body"), column("curve"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header).unwrap();
    let mut changed = 0;
    for row in reader.records() {
        let row = row.unwrap();
        let hit = &row[of_body] == body && &row[of_curve] == curve;
        let cells = row.iter().zip(&header).map(|(cell, name)| {
            if hit && name.ends_with("_pa") {
                format!("{:e}", cell.parse::<f64>().unwrap() * factor)
            } else {
                cell.to_string()
            }
        });
        writer.write_record(cells).unwrap();
        changed += usize::from(hit);
    }
    assert!(changed > 0, "{body} {curve} is in the record");
    std::fs::write(&path, writer.into_inner().unwrap()).unwrap();
}

#[test]
fn a_fem_curve_off_by_two_percent_fails_the_command_and_accepting_shows_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), STUDY).unwrap();
    let records = copy_records(&at.join("records"));
    let gate = |more: &[&str]| {
        let usual = [
            "gate",
            "small.toml",
            "--reference",
            "records",
            "--methods",
            "quarter-space",
            "--baseline",
            "accepted.json",
            "--out",
            "gate",
        ];
        edgeline(&[&usual, more].concat(), at)
    };

    // There is nothing to compare with yet; accepting is a command of its own.
    assert_eq!(gate(&[]).status.code(), Some(2));
    let accept = gate(&["--accept"]);
    assert_eq!(accept.status.code(), Some(0), "{}", said(&accept));
    assert!(said(&accept).contains("absent -> "), "{}", said(&accept));

    let good = gate(&[]);
    assert_eq!(good.status.code(), Some(0), "{}", said(&good));
    assert!(said(&good).contains("gates hold"));
    for name in ["gates.json", "gates.md", "junit.xml"] {
        assert!(at.join("gate").join(name).is_file(), "{name}");
    }
    let step = std::fs::read_to_string(at.join("step.md")).unwrap();
    assert!(step.contains("## Accuracy gates"));

    scale_curve(&records[1], "roller", "depth-centre", 1.02);
    let bad = gate(&[]);
    assert_eq!(bad.status.code(), Some(1), "{}", said(&bad));
    let text = said(&bad);
    assert!(text.contains("w1e-3_sl5_lr1 quarter-space roller depth-centre"), "{text}");
    let junit = std::fs::read_to_string(at.join("gate/junit.xml")).unwrap();
    assert!(junit.contains("<failure message="));
    let json: serde_json::Value =
        serde_json::from_slice(&gate(&["--json"]).stdout).expect("one JSON object");
    assert_eq!(json["hold"], false);

    // Accepting it shows what changed, and only that curve did.
    let accept = gate(&["--accept"]);
    let text = said(&accept);
    let changes: Vec<&str> = text.lines().filter(|l| l.contains(" -> ")).collect();
    assert!(!changes.is_empty());
    assert!(changes.iter().all(|l| l.contains("roller depth-centre")), "{text}");
    assert_eq!(gate(&[]).status.code(), Some(0));
}
