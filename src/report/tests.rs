//! What a study's run leaves behind, made from synthetic solutions.

use super::fraction::fraction;
use super::study_files::StudyFiles;
use super::study_rows::EffectRow;
use super::study_summary::{CaseMethod, FemOrigin, StudySummary};
use super::summarise::Context;
use super::*;
use crate::base::number::with_minus_signs;
use crate::body::EdgeModel;
use crate::case::{ProfileKind, ProfileSpec, Study};
use crate::solve::{Avoided, WorkSummary};
use crate::study::bench::{Against, Machine, Speedup};
use crate::study::gate::{self, Baseline, Gates};
use crate::study::response::Response;
use crate::study::synthetic::{self, Twist};
use crate::study::timing::Ratio;
use crate::study::verification::{self, Convergence, Finding, VerificationRow};
use crate::study::{Engine, Source, StudyRun};
use std::path::Path;

/// The differences of a run's quarter-space, whose refined solution is off by 1e-4 p0.
fn verification(run: &StudyRun) -> Vec<VerificationRow> {
    let of_case = |case: &crate::study::CaseRun| {
        let found = case.references.iter();
        let references: Vec<_> =
            found.filter_map(|r| Some((r.engine.clone(), r.result.as_ref().ok()?))).collect();
        let model = Source::from(EdgeModel::QuarterSpace);
        let own = case.methods.iter().find(|m| m.source == model);
        let Some(Ok(own)) = own.map(|m| &m.result) else { return Vec::new() };
        let curves = &own.solution.curves;
        let mut refined = curves.clone();
        for line in &mut refined.pressure {
            line.p.iter_mut().for_each(|p| *p += 1e-4);
        }
        verification::rows(&case.case, false, (model, curves, Some(&refined)), &references)
    };
    run.cases.iter().flat_map(of_case).collect()
}

/// Files of a run on made-up solutions.
fn files(twist: Twist) -> StudyFiles {
    files_of(&synthetic::run(twist))
}

fn files_of(run: &StudyRun) -> StudyFiles {
    let gates: Gates = Gates::built_in().unwrap();
    let outcomes = gate::evaluate(run, &gates, Some(&Baseline::of(run)));
    let context = Context {
        date: "2026-01-01T00:00:00Z",
        command: "edgeline study --out out",
        fem: FemOrigin::Recorded,
        machine: Machine { processor: "a made-up processor".to_string(), threads: 2 },
        seconds: 1.5,
        gates: &outcomes,
        speedups: &[],
        published_speedups: &[],
        verification: &verification(run),
        brought: &[],
    };
    StudyFiles::of(run, &context)
}

#[test]
fn a_run_is_read_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let written = files(Twist::None);
    crate::host::write_set(folder.path(), &written.contents()).unwrap();
    let read = StudyFiles::read(folder.path()).unwrap();
    assert!(read == written, "every number has the digits of the files");
    assert_eq!(read.summary.cases.len(), 9);
    // Nine cases (eight corners and the centre), four methods and FEM.
    assert_eq!(read.study.len(), 45);
    assert!(StudyFiles::read(&folder.path().join("nowhere")).is_err());
}

#[test]
fn the_files_of_a_run_have_the_names_that_are_checked_before_it() {
    let names: Vec<String> = files(Twist::None).contents().into_iter().map(|file| file.0).collect();
    assert_eq!(names.len(), 8);
    assert!(names.iter().all(|name| StudyFiles::names().any(|own| own == name)), "{names:?}");
}

#[test]
fn a_fractional_study_names_its_design_and_what_it_cannot_tell_apart() {
    let study = Study::find(Path::new("profiled")).unwrap();
    let written = files_of(&synthetic::run_of(&study, Twist::None));
    let folder = tempfile::tempdir().unwrap();
    crate::host::write_set(folder.path(), &written.contents()).unwrap();
    let read = StudyFiles::read(folder.path()).unwrap();
    assert!(read == written, "every number has the digits of the files");
    let design = read.summary.design.as_ref().unwrap();
    assert_eq!((&*design.name, design.runs), ("2^(5-1), resolution V", 16));
    assert_eq!(design.defining_relation, ["ABCDE"]);
    assert_eq!(design.aliases[..3], ["A + BCDE", "B + ACDE", "AB + CDE"]);
    let names: Vec<&str> = read.summary.factors.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names, ["W", "S_l", "L_r", "roller.end_drop", "eccentricity"]);
    let means = ["geometric", "geometric", "arithmetic", "geometric", "arithmetic"];
    assert_eq!(design.centre, means);
    let header = std::fs::read_to_string(folder.path().join("study.csv")).unwrap();
    assert!(header.lines().next().unwrap().ends_with(",unknowns,roller.end_drop,eccentricity"));
    let row = read.row("w1e-4_sl5_lr1_drop0.5_ecc0", &EdgeModel::Mirror.into()).unwrap();
    assert_eq!(read.factor(row, "roller.end_drop"), Some(0.5));
    assert_eq!(read.factor(row, "eccentricity"), Some(0.0));
    // Fifteen estimates of each response, all named by one or two factors.
    let own = |e: &&EffectRow| e.method == EdgeModel::Mirror && e.response == Response::STRESS_RMS;
    let effects: Vec<&EffectRow> = read.effects.iter().filter(own).collect();
    assert_eq!(effects.len(), 15);
    let of = |term: &str| &effects.iter().find(|e| e.term == term).expect(term).aliases[0];
    assert_eq!(of("eccentricity"), "ABCD");
    assert_eq!(of("roller.end_drop x eccentricity"), "ABC");
    for text in [page::html(&read).unwrap(), page::markdown(&read).unwrap()] {
        for wanted in [
            "D = roller.end_drop (0.5 and 3)",
            "16 runs, 2^(5-1), resolution V",
            "Defining relation: I = ABCDE",
            "AB + CDE",
            "E + ABCD",
        ] {
            assert!(text.contains(wanted), "{wanted}");
        }
    }
    let plots = plots::all(&read);
    let (_, half_normal) =
        plots.iter().find(|(n, _)| n.ends_with("half-normal-quarter-space.svg")).unwrap();
    assert_eq!(half_normal.matches("<circle").count(), 4 * 15, "no point is left out");
    keep(&read, "profiled");
}

/// A full design has no further column.
#[test]
fn the_columns_of_a_study_of_three_factors_are_what_they_were() {
    let full = files(Twist::None);
    let of = |name: &str| {
        let contents = full.contents();
        let (_, bytes) = contents.iter().find(|(own, _)| own == name).unwrap();
        let text = String::from_utf8(bytes.clone()).unwrap();
        text.lines().next().unwrap().to_string()
    };
    assert!(of("study.csv").ends_with(",timed_on,unknowns"));
    assert!(of("effects.csv").ends_with(",centre,curvature"));
    assert_eq!(full.summary.design.as_ref().unwrap().name, "2^3, full");
    assert!(full.summary.further_factors.is_empty());
}

/// Writes page and plots to look at, below the folder of this variable.
fn keep(files: &StudyFiles, name: &str) {
    if let Ok(folder) = std::env::var("EDGELINE_KEEP_PLOTS") {
        let folder = Path::new(&folder).join(name);
        std::fs::create_dir_all(&folder).unwrap();
        page::write_run(files, &folder).unwrap();
    }
}

#[test]
fn a_failed_case_is_a_row_with_its_reason() {
    let run = files(Twist::Unsolved(EdgeModel::Mirror));
    let of_mirror: Vec<_> =
        run.study.iter().filter(|r| r.source == EdgeModel::Mirror.into()).collect();
    assert_eq!(of_mirror.len(), 9);
    for row in of_mirror {
        assert!(row.err.as_ref().is_some_and(|err| err.contains("did not converge")), "{row:?}");
        assert_eq!(row.response(Response::STRESS_RMS), None);
    }
    let text = run.summary.not_done.join("\n");
    assert!(text.contains("by mirror failed"), "{text}");
}

#[test]
fn a_second_reference_is_shown_beside_the_first_that_errors_are_taken_against() {
    let (one, two) = (files(Twist::None), files(Twist::SecondReference));
    assert_eq!(two.errors, one.errors);
    let second: Source = synthetic::second_engine().into();
    assert_eq!(two.study.iter().filter(|row| row.source == second).count(), 9);
    assert_eq!(two.study.len(), one.study.len() + 9);
    assert!(two.fem_error.len() == 2 * one.fem_error.len());
    assert_eq!(two.summary.cases[0].references.len(), 1);
    let folder = tempfile::tempdir().unwrap();
    crate::host::write_set(folder.path(), &two.contents()).unwrap();
    assert!(StudyFiles::read(folder.path()).unwrap() == two);
    let plots = plots::all(&two);
    let (_, pressure) = plots.iter().find(|(n, _)| n.ends_with("pressure.svg")).unwrap();
    assert!(pressure.contains("another-code (band: its own error)"));
    let html = page::html(&two).unwrap();
    assert!(html.contains("another-code ran on") && html.contains("FEM ran on"));
    assert!(page::markdown(&two).unwrap().contains("| another-code | unknowns |"));
}

/// What is on record about the published method is said where it ran and was timed.
#[test]
fn the_time_of_the_published_method_is_said_of_a_run_that_timed_it() {
    let mut summary = files(Twist::Published).summary;
    let ratio = Ratio { value: 9e3, plus_minus: 90.0 };
    summary.published_speedups = vec![Speedup {
        case: "a".to_string(),
        level: 0.05,
        against: Against::Fem,
        engine: Engine::fenicsx(),
        size: 1.0,
        unknowns: None,
        fem_error: 0.01,
        fem_seconds: (9e3, 90.0),
        tolerance: 8192.0,
        model_error: 0.05,
        model_seconds: (1.0, 0.0),
        ratio,
    }];
    let said = |summary: &StudySummary| {
        let all = verdict::sentences(summary);
        all.into_iter().find(|sentence| sentence.contains("times faster"))
    };
    let text = said(&summary).unwrap();
    assert!(text.contains("the published method on uniform cells is 9,000 ± 90"), "{text}");
    summary.published.as_mut().unwrap().seconds = None;
    assert_eq!(said(&summary), None);
    summary.published = None;
    assert_eq!(said(&summary), None);
}

/// The published method is a source without being one of the models: it has a column, too.
#[test]
fn times_stand_under_the_names_of_their_sources() {
    let mut run = files(Twist::Published);
    // One time for each source, so that none can stand for another.
    for row in &mut run.study {
        (row.seconds, row.seconds_spread) = (Some(1.5 + row.source.name().len() as f64), None);
    }
    let [html, markdown] = [page::html(&run).unwrap(), page::markdown(&run).unwrap()];
    let section = markdown.split("## Run time").nth(1).unwrap();
    let lines: Vec<&str> = section.lines().filter(|l| l.starts_with('|')).take(11).collect();
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect()
    };
    let head = cells(lines[0]);
    let names: Vec<&str> = run.sources().into_iter().map(Source::title).collect();
    assert_eq!(names.len(), 6);
    assert_eq!(head[1..7], *names);
    for line in &lines[1..] {
        assert_eq!(cells(line).len(), head.len(), "{line}");
    }
    let caption = html.split("Time a case.").nth(1).unwrap();
    let html_rows: Vec<&str> = caption.split("<tr>").skip(1).take(10).collect();
    let heads = html_rows[0].matches("</th>").count();
    for (line, row) in lines[2..].iter().zip(&html_rows[1..]) {
        let own = cells(line);
        assert_eq!(row.matches("<td").count(), heads, "{row}");
        for (i, source) in run.sources().into_iter().enumerate() {
            let time = run.row(&own[0], source).unwrap().seconds.unwrap();
            let shown = crate::base::number::duration(time);
            assert_eq!(own[i + 1], shown, "{line}");
            let cell = row.split("<td").nth(i + 2).unwrap();
            assert_eq!(cell, format!(">{shown}</td>"), "{row}");
        }
    }
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
    keep(&files(Twist::None), "factorial");
}

#[test]
fn work_done_and_avoided_is_shown_by_reason() {
    let mut run = files(Twist::None);
    assert!(!page::html(&run).unwrap().contains("id=\"work\""));
    let work = |done, sources, ends| {
        Some(WorkSummary { done, avoided: Avoided { sources, ends, faded: 0, alike: 0 } })
    };
    for case in &mut run.summary.cases {
        for (method, solved) in &mut case.methods {
            let CaseMethod::Solved { details, .. } = solved else { panic!("all are solved") };
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
fn details_of_the_solver_have_words_and_units() {
    let mut run = files(Twist::None);
    run.summary.methods.truncate(1);
    let page = page::html(&run).unwrap();
    assert!(page.contains("9 cases, 1 model, recorded FEM"));
    let section = page.split("How the models were resolved").nth(1).unwrap();
    let section = section.split("</section>").next().unwrap();
    assert!(section.contains("distance across that wavenumbers resolve (C): 2"), "{section}");
    for raw in ["resolution", "reference m", "tension pa", "k ratio"] {
        assert!(!section.contains(raw), "{raw}: {section}");
    }
}

#[test]
fn ratios_are_shown_with_their_uncertainty_and_their_origin() {
    let run = files(Twist::None);
    // 15 s +- 0.3 s over 10 ms +- 0.4 ms: 1500 +- 67.
    let row = run.study.iter().find(|r| r.case == "w1e-3_sl5_lr1").unwrap();
    assert!((row.speedup.unwrap() - 1500.0).abs() < 1e-3);
    assert!((row.speedup_spread.unwrap() - 1500.0 * 0.02f64.hypot(0.04)).abs() < 1e-3);
    let decades = row.response(Response::Log10Speedup).unwrap();
    assert!((decades - 1500f64.log10()).abs() < 1e-6);
    for text in [page::html(&run).unwrap(), page::markdown(&run).unwrap()] {
        assert!(text.contains("1,500 ± 67"));
        assert!(text.contains("edgeline bench --fem live"));
    }
    // Its effects are analysed like all others.
    assert!(run.effects.iter().any(|r| r.response == Response::Log10Speedup));
}

/// The made-up meshes converge with the square of their size: the index is 1.25 times the error,
/// which is the made-up difference itself.
#[test]
fn differences_stand_beside_the_uncertainty_of_both_sides() {
    let files = files(Twist::SecondReference);
    // Nine cases, two pairs with the model and one of codes, pressure and stresses at two places.
    assert_eq!(files.verification.len(), 9 * 3 * 4);
    for row in &files.verification {
        assert_eq!(row.convergence, Convergence::Observed, "{row:?}");
        assert!((row.order.unwrap() - 2.0).abs() < 1e-5, "{row:?}");
        let index = row.u_reference.unwrap();
        if row.group == verification::Group::Pressure {
            assert!((index / (1.25 * synthetic::SHIFT) - 1.0).abs() < 1e-3, "{row:?}");
        }
        // Codes that are the same do not differ; the model differs by less than the index.
        assert_eq!(row.finding, Finding::Within, "{row:?}");
        assert_eq!(row.difference == 0.0, row.source.is_engine(), "{row:?}");
    }
}

#[test]
fn the_box_of_verification_is_that_of_the_compared_cases() {
    let mut files = files(Twist::None);
    let page = page::html(&files).unwrap();
    assert!(page.contains("; straight generatrices, parallel and centred bodies. Outside"));
    let crown = ProfileSpec { radius_m: Some(1.0), ..ProfileSpec::new(ProfileKind::Crown) };
    files.summary.cases[0].roller.profile = Some(crown);
    files.summary.cases[1].eccentricity_m = Some(0.1 * files.summary.cases[1].roller.length_m);
    files.summary.cases[2].sliding.friction = 0.25;
    let page = page::html(&files).unwrap();
    let said = "; straight generatrices and profiles (crown), eccentricities of the load (lengths of \
                the roller) up to 0.1, friction up to 0.25. Outside";
    assert!(page.contains(said));
    // What was not compared is outside.
    let name = files.summary.cases[2].name.clone();
    files.verification.retain(|row| row.case != name);
    assert!(!page::html(&files).unwrap().contains("friction up to"));
}

/// Ten numbers of the page's verification, each found again in the file that it is said to be from.
#[test]
fn numbers_of_the_page_are_those_of_the_files() {
    let files = files(Twist::SecondReference);
    let page = page::html(&files).unwrap();
    let section = page.split("id=\"verified\"").nth(1).unwrap().split("</table>").next().unwrap();
    let text = crate::report::table::to_csv(&files.verification, &files.summary.range);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let mut seen = 0;
    for row in rows.iter().step_by(9) {
        let place = match &row[at("zone")] {
            "regular" => "regular",
            _ => "near an end",
        };
        let pair = |name: &str| match name {
            "fem" => "FEM".to_string(),
            other => other.to_string(),
        };
        let pair = format!("{} − {}", pair(&row[at("source")]), pair(&row[at("reference")]));
        let line = section
            .lines()
            .find(|l| {
                l.contains(&format!("<td>{}</td>", &row[at("case")]))
                    && l.contains(&pair)
                    && l.contains(place)
            })
            .unwrap_or_else(|| panic!("no line of {pair} in {}", &row[at("case")]));
        for column in ["difference", "u_reference", "u_source"] {
            let value: f64 = row[at(column)].parse().unwrap();
            let shown = format!("<td>{}</td>", with_minus_signs(&fraction(value)));
            assert!(line.contains(&shown), "{column} {shown}: {line}");
            seen += 1;
        }
    }
    assert!(seen >= 30, "{seen}");
    let counted = format!("Of {} differences", 9 * 2 * 4);
    assert!(page.contains(&counted) && page.contains("code-to-code verification"));
}
