//! What a study's run leaves behind, made from synthetic solutions.

use super::study_files::{Context, StudyFiles};
use super::*;
use crate::study::gate::{self, Baseline, Gates};
use crate::study::synthetic::{self, Twist};

/// Files of a run on made-up solutions.
fn files(twist: Twist) -> StudyFiles {
    let run = synthetic::run(twist);
    let gates: Gates = gate::parse(gate::DEFAULT_GATES, "gates.toml".as_ref()).unwrap();
    let outcomes = gate::evaluate(&run, &gates, Some(&Baseline::of(&run)));
    let context = Context {
        date: "2026-01-01T00:00:00Z",
        command: "edgeline study --out out",
        fem: "recorded",
        machine: ("a made-up processor", 2),
        seconds: 1.5,
        gates: &outcomes,
    };
    StudyFiles::of(&run, &context)
}

#[test]
fn a_run_is_read_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let written = files(Twist::None);
    written.write(folder.path()).unwrap();
    let read = StudyFiles::read(folder.path()).unwrap();
    assert_eq!(read.tables().map(|t| t.rows.len()), written.tables().map(|t| t.rows.len()));
    assert_eq!(read.tables(), written.tables());
    // Not compared as a whole: JSON's numbers come back to one in the last digit.
    assert_eq!(
        read.summary["method_summary"][3]["gates"],
        written.summary["method_summary"][3]["gates"]
    );
    assert_eq!(read.summary["cases"].as_array().map(Vec::len), Some(9));
    // Nine cases (eight corners and the centre), four methods and FEM.
    assert_eq!(read.study.rows.len(), 45);
    assert!(StudyFiles::read(&folder.path().join("nowhere")).is_err());
}

#[test]
fn a_failed_case_is_a_row_with_its_reason() {
    let run = files(Twist::Unsolved(crate::body::EdgeModel::Mirror));
    let of_mirror: Vec<_> =
        run.study.rows.iter().filter(|r| run.study.text(r, "source") == "mirror").collect();
    assert_eq!(of_mirror.len(), 9);
    for row in of_mirror {
        assert!(run.study.text(row, "err").contains("did not converge"));
        assert_eq!(run.study.text(row, "stress_rms"), "");
    }
    let text = run.summary["not_done"].to_string();
    assert!(text.contains("by mirror failed"), "{text}");
}

#[test]
fn plots_are_well_formed_and_hold_every_source() {
    let plots = plots::all(&files(Twist::None));
    // Seven a case, three a method, and run time against error.
    assert_eq!(plots.len(), 9 * 7 + 4 * 3 + 1);
    for (name, svg) in &plots {
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
        assert!(!svg.contains("NaN"), "{name}");
    }
    let (_, pressure) = plots.iter().find(|(n, _)| n.ends_with("pressure.svg")).unwrap();
    for word in ["half-space", "mirror", "guilbault", "quarter-space", "FEM", "y / C", "p / p0"] {
        assert!(pressure.contains(word), "{word}");
    }
    if let Ok(folder) = std::env::var("EDGELINE_KEEP_PLOTS") {
        std::fs::create_dir_all(&folder).unwrap();
        let f = files(Twist::None);
        f.write(folder.as_ref()).unwrap();
        page::write(&f, folder.as_ref()).unwrap();
    }
}
