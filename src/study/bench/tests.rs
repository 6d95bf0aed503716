use super::*;
use crate::body::EdgeModel;
use crate::case::{Case, Study};
use crate::fem::Code;
use crate::study::synthetic;
use crate::study::timing::Timing;
use crate::study::{Engine, Models, Source};
use std::path::Path;

/// Two cases of the built-in study that differ only in load, with made-up solutions.
fn cases() -> Vec<Case> {
    let study = Study::built_in();
    let names = ["w1e-4_sl5_lr1", "w1e-3_sl5_lr1"];
    study.corners.into_iter().filter(|c| names.contains(&c.name.as_str())).collect()
}

fn bench() -> Vec<CaseBench> {
    run(
        &cases(),
        &BenchSetup {
            models: Models {
                methods: vec![EdgeModel::Mirror, BEST],
                repeats: 2,
                solver: &synthetic::solve_to_tolerance,
                cold: &|_, _, threads| Some(threads as f64),
                published: Some(&synthetic::solve_on_cells),
            },
            tolerances: vec![1e-2, 1e-3, 1e-4],
            fem: &|case| synthetic::fem_meshes(case, &[2.0, 1.0], &[1.4]),
            progress: &|done, all, _| assert!(done <= all),
        },
    )
}

fn find<'a>(case: &'a CaseBench, source: &str, origin: Origin, setting: f64) -> &'a BenchPoint {
    let is_it =
        |p: &&BenchPoint| p.source.name() == source && p.origin == origin && p.setting == setting;
    case.points.iter().find(is_it).unwrap()
}

#[test]
fn errors_are_those_of_the_made_up_solutions() {
    for case in bench() {
        assert_eq!(case.fem_reference.as_deref(), Some("recorded, size 1"));
        // Two models at three tolerances, five grids, two recorded meshes and a live one.
        assert_eq!(case.points.len(), 6 + 5 + 3);
        let [coarse, fine] =
            [4096.0, 524_288.0].map(|n| find(&case, "guilbault-cells", Origin::Cells, n));
        let off = synthetic::cells_shift(64) - synthetic::mesh_shift(1.0);
        assert!((coarse.to_fem.unwrap().pressure_max - off).abs() > 1e-3, "the ends differ too");
        assert_ne!(fine.error(Against::Fem), coarse.error(Against::Fem));
        assert!(fine.timing.is_some() && fine.all_threads.is_none());
        // Off by its tolerance in every normal stress, and so is the limit.
        let loose = find(&case, "quarter-space", Origin::Model, 1e-2);
        let to_limit = loose.to_limit.unwrap();
        assert!((to_limit.worst_rms - (1e-2 - 1e-4)).abs() < 1e-12, "{to_limit:?}");
        assert!((to_limit.stress_max - (1e-2 - 1e-4)).abs() < 1e-12, "{to_limit:?}");
        let to_fem = loose.to_fem.unwrap();
        assert!((to_fem.pressure_max - (1e-2 - synthetic::mesh_shift(1.0))).abs() < 1e-12);
        assert!(find(&case, "quarter-space", Origin::Model, 1e-4).to_limit.is_none());
        assert!(find(&case, "mirror", Origin::Model, 1e-4).to_limit.unwrap().worst_rms > 0.01);
        // Meshes against the finest, which says of itself what the next one is off by.
        let off = |a: f64| synthetic::mesh_shift(a) - synthetic::mesh_shift(1.0);
        for (origin, size, error) in [
            (Origin::RecordedFem, 2.0, off(2.0)),
            (Origin::LiveFem, 1.4, off(1.4)),
            (Origin::RecordedFem, 1.0, off(1.4)),
        ] {
            let point = find(&case, "fem", origin, size);
            assert!((point.error(Against::Fem).unwrap() - error).abs() < 1e-12, "{point:?}");
            assert_eq!(point.machine.is_some(), origin == Origin::RecordedFem);
        }
        assert_eq!(loose.timing.unwrap().cold_s, Some(1.0));
        assert!(loose.all_threads.is_some());
    }
}

#[test]
fn only_times_of_this_run_are_divided_and_only_within_the_level() {
    let mut cases = bench();
    for case in &mut cases {
        for point in case.points.iter_mut().filter(|p| p.origin == Origin::Model) {
            // A time that is known, ten times as long for a tenth of the tolerance.
            point.timing = Some(Timing::new(1, &[0.9e-5 / point.setting, 1.1e-5 / point.setting]));
        }
    }
    let fem_error = synthetic::mesh_shift(1.4) - synthetic::mesh_shift(1.0);
    let all = speedups(&cases, &[fem_error * 1.01, fem_error * 0.99]);
    // The tighter level is reached by no live mesh; each case at the other against both.
    assert_eq!(all.len(), 2 * 2, "{all:?}");
    for s in &all {
        assert_eq!((s.size, s.tolerance), (1.4, 1e-3));
        assert!((s.model_seconds.0 - 0.01).abs() < 1e-12);
        let expected = s.fem_seconds.0 / 0.01;
        assert!((s.ratio.value - expected).abs() < 1e-9 * expected);
        let share = (s.fem_seconds.1 / s.fem_seconds.0).hypot(0.1);
        assert!((s.ratio.plus_minus - expected * share).abs() < 1e-9 * expected);
    }
    // Without a live mesh there is no ratio, however good the record is.
    cases.iter_mut().for_each(|c| c.points.retain(|p| p.origin != Origin::LiveFem));
    assert!(speedups(&cases, &[1.0]).is_empty());
}

/// A second code twice as fast and one with a larger error: the faster one within the level is the
/// opponent.
#[test]
fn the_faster_code_is_the_opponent() {
    let mut cases = bench();
    assert!(code_times(&cases, &[1.0]).is_empty(), "one code ran");
    let second = Source::from(Engine::of(Code::Calculix));
    for case in &mut cases {
        let mut other = find(case, "fem", Origin::LiveFem, 1.4).clone();
        let seconds = other.seconds().unwrap();
        let error = other.to_fem.as_mut().unwrap();
        error.worst_rms *= 3.0;
        (other.source, other.setting) = (second.clone(), 2.8);
        other.timing = Some(Timing::new(1, &[0.5 * seconds]));
        case.points.push(other);
    }
    let error = cases[0].points.last().unwrap().error(Against::Fem).unwrap();
    let levels = [1.01 * error, 0.5 * error];
    for s in speedups(&cases, &levels) {
        let is_second = s.level == levels[0];
        assert_eq!((s.engine.is_fenicsx(), s.size == 2.8), (!is_second, is_second));
    }
    // Only where both are within the level is one of them said to be faster.
    let times = code_times(&cases, &levels);
    assert_eq!(times.len(), cases.len());
    for t in times {
        assert_eq!((t.level, t.codes.len()), (levels[0], 2));
        assert_eq!(Source::from(t.codes[0].engine.clone()), second);
        assert!((t.ratio.value - 2.0).abs() < 1e-12 && t.codes[1].size == 1.4);
    }
}

/// `results/bench-codes.json`: FEniCSx is the opponent, because at equal error it is the faster of
/// the two.
#[test]
fn in_the_record_of_both_codes_the_first_is_faster() {
    let text = include_str!("../../../results/bench-codes.json");
    let record = Bench::parse(text, Path::new("bench-codes.json")).unwrap();
    assert_eq!(record.codes, code_times(&record.cases, &record.levels));
    let times: Vec<_> = record.codes.iter().filter(|t| t.level <= 0.01).collect();
    assert!(times.len() >= 2, "{times:?}");
    for t in times {
        assert!(t.codes[0].engine.is_fenicsx() && t.codes.iter().all(|c| c.error <= t.level));
        assert!(t.ratio.value - t.ratio.plus_minus > 1.0, "{t:?}");
    }
    assert!(record.speedups.iter().all(|s| s.engine.is_fenicsx()));
}

#[test]
fn the_published_method_is_compared_at_the_error_that_it_reaches() {
    let mut cases = bench();
    for point in cases.iter_mut().flat_map(|c| &mut c.points).filter(|p| p.origin == Origin::Cells)
    {
        point.timing = Some(Timing::new(1, &[point.setting / 100.0]));
    }
    let all = published_speedups(&cases);
    assert_eq!(all.len(), 2);
    for (s, case) in all.iter().zip(&cases) {
        let own = case.points.iter().filter(|p| p.origin == Origin::Cells);
        let least = own.filter_map(|p| p.error(Against::Fem)).fold(f64::INFINITY, f64::min);
        assert!(s.model_error <= 1.05 * least && s.fem_error <= 1.05 * least);
        assert_eq!((s.size, s.model_seconds.0), (1.4, s.tolerance / 100.0));
    }
    cases.iter_mut().for_each(|c| c.points.retain(|p| p.origin != Origin::LiveFem));
    assert!(published_speedups(&cases).is_empty());
}

#[test]
fn the_built_in_record_survives_its_file_and_finds_its_cases() {
    let record = Bench::recorded().unwrap();
    assert!(record.speedups.iter().all(|s| s.fem_error <= s.level && s.model_error <= s.level));
    let text = serde_json::to_string(&record).unwrap();
    assert_eq!(Bench::parse(&text, Path::new("b")).unwrap(), record);
    let other = text.replacen("\"schema\":1", "\"schema\":9", 1);
    assert!(Bench::parse(&other, Path::new("b")).unwrap_err().to_string().contains("schema 9"));

    let made_up = Bench { cases: bench(), ..record };
    for case in cases() {
        let timed = made_up.timed(&case.clone().with_tolerance(1e-3)).unwrap();
        assert_eq!((timed.size, timed.methods.len()), (1.4, 2));
        assert!(made_up.timed(&case.with_tolerance(3e-3)).is_none());
    }
}

#[test]
fn the_front_holds_what_nothing_beats() {
    let points = vec![(3.0, 0.1), (1.0, 0.5), (2.0, 0.6), (2.0, 0.3), (4.0, 0.1), (5.0, 0.01)];
    assert_eq!(front(points), [(1.0, 0.5), (2.0, 0.3), (3.0, 0.1), (5.0, 0.01)]);
}
