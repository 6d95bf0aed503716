//! What a study's run leaves behind, made from synthetic solutions.

use super::study_files::StudyFiles;
use super::study_summary::{CaseMethod, FemOrigin};
use super::summarise::Context;
use super::*;
use crate::body::EdgeModel;
use crate::solve::{Avoided, WorkSummary};
use crate::study::bench::Machine;
use crate::study::gate::{self, Baseline, Gates};
use crate::study::synthetic::{self, Twist};

/// Files of a run on made-up solutions.
fn files(twist: Twist) -> StudyFiles {
    let run = synthetic::run(twist);
    let gates: Gates = Gates::built_in().unwrap();
    let outcomes = gate::evaluate(&run, &gates, Some(&Baseline::of(&run)));
    let context = Context {
        date: "2026-01-01T00:00:00Z",
        command: "edgeline study --out out",
        fem: FemOrigin::Recorded,
        machine: Machine { processor: "a made-up processor".to_string(), threads: 2 },
        seconds: 1.5,
        gates: &outcomes,
        speedups: &[],
    };
    StudyFiles::of(&run, &context)
}

#[test]
fn a_run_is_read_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let written = files(Twist::None);
    crate::host::write_set(folder.path(), &written.contents()).unwrap();
    let read = StudyFiles::read(folder.path()).unwrap();
    assert_eq!(read.tables().map(|t| t.rows.len()), written.tables().map(|t| t.rows.len()));
    assert_eq!(read.tables(), written.tables());
    assert_eq!(read.summary, written.summary);
    assert_eq!(read.summary.cases.len(), 9);
    // Nine cases (eight corners and the centre), four methods and FEM.
    assert_eq!(read.study.rows.len(), 45);
    assert!(StudyFiles::read(&folder.path().join("nowhere")).is_err());
}

#[test]
fn a_failed_case_is_a_row_with_its_reason() {
    let run = files(Twist::Unsolved(EdgeModel::Mirror));
    let of_mirror: Vec<_> =
        run.study.rows.iter().filter(|r| run.study.text(r, "source") == "mirror").collect();
    assert_eq!(of_mirror.len(), 9);
    for row in of_mirror {
        assert!(run.study.text(row, "err").contains("did not converge"));
        assert_eq!(run.study.text(row, "stress_rms"), "");
    }
    let text = run.summary.not_done.join("\n");
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
        page::write_run(&f, folder.as_ref()).unwrap();
    }
}

#[test]
fn work_done_and_avoided_is_shown_by_reason() {
    let mut run = files(Twist::None);
    assert!(!page::html(&run).unwrap().contains("id=\"work\""));
    let work = |done, sources, ends| {
        Some(WorkSummary { done, avoided: Avoided { sources, ends, faded: 0, alike: 0 } })
    };
    for case in &mut run.summary.cases {
        for (method, answer) in &mut case.methods {
            let CaseMethod::Answer { details, .. } = answer else { panic!("all are solved") };
            details.work = match method {
                EdgeModel::QuarterSpace => work(1200, 1200, 600),
                EdgeModel::Mirror => work(7, 0, 0),
                _ => None,
            };
        }
    }
    let html = page::html(&run).unwrap();
    let table = html.split("id=\"work\"").nth(1).unwrap().split("</table>").next().unwrap();
    assert!(table.contains("avoided:<br>sources beyond a wave"), "{table}");
    // Five problems by two models: cases that differ in load share their rows.
    assert_eq!(table.matches("<tr><td").count(), 10, "{table}");
    let row = "<td class=\"text\">quarter-space</td><td>1200</td><td>1800 (60 %)</td>\
               <td>1200</td><td>600</td><td>0</td><td>0</td>";
    assert_eq!(table.matches(row).count(), 5, "{table}");
    assert_eq!(
        table.matches("<td>7</td><td>0 (0 %)</td><td>0</td><td>0</td><td>0</td><td>0</td>").count(),
        5
    );
    let markdown = page::markdown(&run).unwrap();
    assert!(
        markdown.contains("| quarter-space | 1200 | 1800 (60 %) | 1200 | 600 | 0 | 0 |"),
        "{markdown}"
    );
}

#[test]
fn ratios_are_shown_with_their_uncertainty_and_their_origin() {
    let run = files(Twist::None);
    // 15 s +- 0.3 s over 10 ms +- 0.4 ms: 1500 +- 67.
    let row = run.study.rows.iter().find(|r| run.study.text(r, "case") == "w1e-3_sl5_lr1").unwrap();
    let number = |name| run.study.number(row, name).unwrap();
    assert!((number("speedup") - 1500.0).abs() < 1e-3);
    assert!((number("speedup_spread") - 1500.0 * 0.02f64.hypot(0.04)).abs() < 1e-3);
    assert!((number("log10_speedup") - 1500f64.log10()).abs() < 1e-6);
    for text in [page::html(&run).unwrap(), page::markdown(&run).unwrap()] {
        assert!(text.contains("1,500 ± 67"));
        assert!(text.contains("edgeline bench --fem live"));
    }
    // Its effects are analysed like all others.
    let rows = &run.effects.rows;
    assert!(rows.iter().any(|r| run.effects.text(r, "response") == "log10_speedup"));
}
