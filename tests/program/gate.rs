//! The gates detect errors: another psi, any wrong sign, a FEM curve with an error of 2 %.

use crate::support::{edgeline, said};
use edgeline::base::{Result, StressTensor};
use edgeline::body::EdgeModel;
use edgeline::case::{Case, Sliding, Study};
use edgeline::fem;
use edgeline::solve::{Options, Solution, solve_group};
use edgeline::study::gate::{self, Baseline, GateOutcome};
use edgeline::study::measure::Measure;
use edgeline::study::{Engine, Models, Range, Solver, StudyRun, StudySetup, reference, run};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::process::Output;

/// One flush case and one on a longer block of the default study, by the two most accurate models.
const STUDY: &str = "name = \"small\"\n[roller]\nradius_m = 10e-3\nyoung_pa = 210e9\npoisson = 0.3\n\
[block]\nyoung_pa = 210e9\npoisson = 0.3\n[factors]\nW = [1e-3]\nS_l = [5.0]\nL_r = [0.5, 1.0]\n[accuracy]\nfirst_order = true\n";

const METHODS: [EdgeModel; 2] = [EdgeModel::Guilbault, EdgeModel::QuarterSpace];

/// [`STUDY`] by the models, solved by `solver`.
fn run_with(solver: &Solver) -> StudyRun {
    run_of(STUDY, solver)
}

/// The study of this text by the models, solved by `solver`.
fn run_of(text: &str, solver: &Solver) -> StudyRun {
    let study = Study::parse(text, Path::new("small.toml")).unwrap();
    let recorded = |case: &Case| {
        let found = fem::FemResults::embedded_of(case).map_err(|e| e.to_string())?;
        found.map(|r| reference::from_fem(&r)).ok_or_else(|| "no record".to_string())
    };
    run(
        &study,
        &StudySetup {
            models: Models {
                methods: METHODS.to_vec(),
                repeats: 0,
                solver,
                cold: &|_, _, _| None,
                published: None,
            },
            range: Range::default(),
            references: &|case| vec![(Engine::fenicsx(), recorded(case))],
            progress: &|_, _, _| {},
        },
    )
}

fn usual(cases: &[Case], method: EdgeModel) -> Vec<Result<Solution>> {
    solve_group(cases, &Options::new(method))
}

fn failed(run: &StudyRun, accepted: &Baseline) -> Vec<GateOutcome> {
    let gates = gate::Gates::built_in().unwrap();
    let mut outcomes = gate::evaluate(run, &gates, Some(accepted));
    outcomes.retain(|o| !o.passed);
    outcomes
}

#[test]
fn flipped_shears_are_named() {
    let right = run_with(&usual);
    let accepted = Baseline::of(&right);
    assert_eq!(failed(&right, &accepted), Vec::new());

    // The sign of the shears across z that follows from the paper's x_k - x_p.
    let sign = |cases: &[Case], method: EdgeModel| {
        let mut solutions = usual(cases, method);
        for solution in solutions.iter_mut().flatten() {
            for stress in solution.curves.stress.iter_mut().flat_map(|c| &mut c.stress) {
                (stress.xz, stress.yz) = (-stress.xz, -stress.yz);
            }
        }
        solutions
    };
    let outcomes = failed(&run_with(&sign), &accepted);
    for method in METHODS {
        let drift =
            outcomes.iter().find(|o| o.kind == gate::Kind::Drift && o.method == method.name());
        let named =
            |o: &GateOutcome| ["sigma_xz", "sigma_yz"].iter().any(|shear| o.note.contains(shear));
        assert!(drift.is_some_and(named), "{method}: {outcomes:?}");
    }
    // The limits alone detect it too, without accepted numbers.
    assert!(outcomes.iter().any(|o| o.kind == gate::Kind::Limit && o.method == "quarter-space"));
}

/// A component of the wrong sign is off by twice its size. Wherever it is as large as the widest
/// limit of the gates, they name the body, the curve and the component.
#[test]
fn a_wrong_sign_of_any_component_on_any_curve_is_named() {
    let one = STUDY.replace("[0.5, 1.0]", "[0.5]");
    let case = Study::parse(&one, Path::new("small.toml")).unwrap().corners.remove(0);
    let right = solve_group(&[case], &Options::new(EdgeModel::QuarterSpace)).remove(0).unwrap();
    let gates = gate::Gates::built_in().unwrap();
    let widest = gates.gate.iter().filter(|g| g.measure == Some(Measure::Rms));
    let widest = widest.map(|g| g.limit).fold(0.0, f64::max);
    let (mut named, mut small) = (0, 0);
    for (at, curve) in right.curves.stress.iter().enumerate() {
        for (component, name) in StressTensor::NAMES.iter().enumerate() {
            let square = |s: &StressTensor| s.components()[component].powi(2);
            let squares: f64 = curve.stress.iter().map(square).sum();
            if (squares / curve.stress.len() as f64).sqrt() < widest {
                small += 1;
                continue;
            }
            let turned = |_: &[Case], _: EdgeModel| {
                let mut solution = right.clone();
                for stress in &mut solution.curves.stress[at].stress {
                    let mut components = stress.components();
                    components[component] *= -1.0;
                    *stress = StressTensor::from_components(components);
                }
                vec![Ok(solution)]
            };
            let outcomes = gate::evaluate(&run_of(&one, &turned), &gates, None);
            let place = format!("{}, {}, {name}", curve.body.name(), curve.name);
            assert!(outcomes.iter().any(|o| !o.passed && o.note.ends_with(&place)), "{place}");
            named += 1;
        }
    }
    assert!(named > 90 && small < 60, "{named} are named, {small} are too small");
}

#[test]
fn friction_of_the_other_sign_is_named() {
    let sliding = |solver: &Solver| {
        let run = run_of("name = \"scenes\"\ncases = [\"sliding-flush\"]\n", solver);
        let mut outcomes =
            gate::evaluate(&run, &gate::Gates::built_in_for("scenes").unwrap(), None);
        outcomes.retain(|o| !o.passed && o.name.starts_with("sliding"));
        outcomes
    };
    assert_eq!(sliding(&usual), Vec::new());
    let backwards = |cases: &[Case], method: EdgeModel| {
        let turned = |case: &Case| Case {
            sliding: Sliding { friction: -case.sliding.friction },
            ..case.clone()
        };
        usual(&cases.iter().map(turned).collect::<Vec<_>>(), method)
    };
    let failed = sliding(&backwards);
    let notes: Vec<&str> = failed.iter().map(|o| o.note.as_str()).collect();
    assert!(failed.len() == 3 && notes.iter().all(|n| n.contains("sigma_")), "{failed:?}");
}

/// Runs `edgeline gate` with the table of the job's summary in the same folder.
fn gate(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = edgeline(folder, &[&["gate"], arguments].concat());
    command.env("GITHUB_STEP_SUMMARY", folder.join("step.md")).output().unwrap()
}

/// Copies the records of the small study's cases.
fn copy_records(to: &Path) -> Vec<PathBuf> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/reference");
    ["w1e-3_sl5_lr0.5", "w1e-3_sl5_lr1"]
        .iter()
        .map(|case| {
            let folder = to.join(case);
            std::fs::create_dir_all(&folder).unwrap();
            for name in ["record.json", "curves.csv", "pressure.csv", "SHA256SUMS"] {
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
    let text = writer.into_inner().unwrap();
    // With matching checksums, so that the gates must detect it.
    let sum: String = Sha256::digest(&text).iter().map(|b| format!("{b:02x}")).collect();
    let sums = record.join("SHA256SUMS");
    let others = std::fs::read_to_string(&sums).unwrap();
    let others = others.lines().filter(|l| !l.ends_with("curves.csv")).map(|l| format!("{l}\n"));
    let others: String = others.collect();
    std::fs::write(&sums, format!("{others}{sum}  curves.csv\n")).unwrap();
    std::fs::write(&path, text).unwrap();
}

#[test]
fn another_psi_fails_the_command_and_names_its_model() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), STUDY).unwrap();
    let gate = |more: &[&str]| {
        let usual = ["small.toml", "--methods", "guilbault,quarter-space", "--out", "gate"];
        gate(at, &[&usual[..], &["--baseline", "accepted.json"], more].concat())
    };
    assert_eq!(gate(&["--accept"]).status.code(), Some(0));
    assert_eq!(gate(&[]).status.code(), Some(0));
    // psi is 1.39 at nu = 0.3: less than a hundredth more of the images.
    let bad = gate(&["--psi", "1.40"]);
    assert_eq!(bad.status.code(), Some(1), "{}", said(&bad));
    let text = std::fs::read_to_string(at.join("gate/gates.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let failed: Vec<_> =
        json["gates"].as_array().unwrap().iter().filter(|g| g["passed"] == false).collect();
    assert_eq!(failed.len(), 1, "psi belongs to one model only: {failed:?}");
    assert_eq!((&failed[0]["kind"], &failed[0]["method"]), (&"drift".into(), &"guilbault".into()));
    assert!(failed[0]["note"].as_str().unwrap().contains(" guilbault "), "{failed:?}");
    assert!(said(&bad).contains("guilbault"));
    assert_eq!(gate(&["--psi", "-1"]).status.code(), Some(2));
    let files = ["--baseline", "accepted.json", "--out", "gate"];
    let one = self::gate(at, &[&["small.toml", "--methods", "guilbault"], &files[..]].concat());
    assert_eq!(one.status.code(), Some(0), "{}", said(&one));
    assert!(said(&one).contains("gates of quarter-space are not checked"), "{}", said(&one));
    let cells = self::gate(at, &["small.toml", "--methods", "guilbault-cells", "--out", "gate"]);
    assert_eq!(cells.status.code(), Some(2));
    assert!(said(&cells).contains("--methods = guilbault-cells is not valid"), "{}", said(&cells));
}

#[test]
fn a_fem_curve_off_by_two_percent_fails_the_command_and_accepting_shows_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("small.toml"), STUDY).unwrap();
    let records = copy_records(&at.join("records"));
    let gate = |more: &[&str]| {
        let usual = ["small.toml", "--methods", "quarter-space", "--out", "gate"];
        let files = ["--reference", "records", "--baseline", "accepted.json"];
        gate(at, &[&usual[..], &files, more].concat())
    };

    // There are no accepted numbers yet; accepting them is a separate command.
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

    // Accepting lists the changes, and only that curve has changed.
    let accept = gate(&["--accept"]);
    let text = said(&accept);
    let changes: Vec<&str> = text.lines().filter(|l| l.contains(" -> ")).collect();
    assert!(!changes.is_empty());
    assert!(changes.iter().all(|l| l.contains("roller depth-centre")), "{text}");
    // Then no number drifts. The limits cannot be accepted, and the curve exceeds one.
    let after = gate(&[]);
    assert!(said(&after).contains("nothing moved"), "{}", said(&after));
    assert_eq!(after.status.code(), Some(1), "{}", said(&after));
}
