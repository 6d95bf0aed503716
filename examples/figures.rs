//! Draws the figures of docs/theory.md from the built-in case `flush-short`, and that of the README
//! from the recorded finite-element curves and the recorded run times:
//!
//! ```text
//! cargo run --release --example figures
//! ```
//!
//! writes docs/figures/*.svg in a few seconds.

use edgeline::base::Result;
use edgeline::body::EdgeModel;
use edgeline::case::builtin_case;
use edgeline::fem::FemResults;
use edgeline::report::draw::{Figure, Map, Panel, Series, look};
use edgeline::solve::{Scene, SolvedScene};
use edgeline::stress::{BodyKind, Curves};
use edgeline::study::bench::{Against, Bench};
use edgeline::study::{Engine, Source};
use std::path::Path;

/// Largest magnitude of the colour scale (p0). Without it, the large values of half-space and
/// mirror would leave few colours for the other models.
const LIMIT: f64 = 1.0;

fn main() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures");
    std::fs::create_dir_all(&folder).expect("docs can be written");
    let write = |name: &str, figure: &Figure| {
        let path = folder.join(format!("{name}.svg"));
        std::fs::write(path, figure.draw().to_svg()).expect("docs can be written");
    };
    let case = builtin_case("flush-short").expect("a case of that name")?;
    let mut panels = panels();
    for model in EdgeModel::ALL {
        let scene = Scene::new(&case, model, None);
        let solved = SolvedScene::new(&scene)?;
        let field = solved.field(BodyKind::Block);
        let end = scene.half_length;
        let curve = |points| Series {
            markers: false,
            ..Series::curve(model.name(), look(&model.into()), points)
        };
        let distances: Vec<f64> = (0..=60).map(|i| 0.1 * 50f64.powf(f64::from(i) / 60.0)).collect();
        panels[0].series.push(curve(
            distances.iter().map(|&s| (s, solved.pressure.at(0.0, end - s))).collect(),
        ));
        let along = [0.0].iter().chain(&distances);
        panels[1]
            .series
            .push(curve(along.map(|&s| (s, field.at(end - s, 0.5, &[0.0])[0].yy)).collect()));
        let depths: Vec<f64> = (1..=60).map(|i| 0.05 * f64::from(i)).collect();
        panels[2]
            .series
            .push(curve(depths.iter().map(|&z| (z, field.at(end, z, &[0.0])[0].yy)).collect()));
        let ys: Vec<f64> = (0..=60).map(|i| end - 3.0 + 0.05 * f64::from(i)).collect();
        let zs: Vec<f64> = (0..=40).map(|i| 0.05 * f64::from(i)).collect();
        let values = zs.iter().flat_map(|&z| {
            let field = &field;
            ys.iter().map(move |&y| field.at(y, z, &[0.0])[0].yy.clamp(-LIMIT, LIMIT))
        });
        let (label, values) = ("σyy / p0".into(), values.collect());
        let map = Map { label, values, axes: [ys, zs], down: true, limit: LIMIT };
        let title = format!("{model}: σyy in the plane x = 0; the end face is the right border");
        write(model.name(), &Figure::of_map(title, ["y / C", "z / C"], map));
    }
    let figure = Figure {
        title: "Flush ends, S_l = 5, ν = 0.3".into(),
        columns: 3,
        panels,
        panel_size: (420, 320),
    };
    write("models", &figure);
    write("overview", &overview()?);
    Ok(())
}

/// A recorded case with flush ends.
const RECORDED: &str = "w1e-3_sl5_lr1";

/// How far from the roller's end the README's figure goes (C).
const REACH: f64 = 3.0;

/// The README's figure: pressure and a stress near an end beside finite elements, and run time
/// against error.
fn overview() -> Result<Figure> {
    let record = FemResults::embedded(RECORDED)?.expect("a record of that name");
    let panel = |title: &str, y_label: &str| Panel {
        title: title.into(),
        x_label: "distance from the end (C)".into(),
        y_label: y_label.into(),
        x_range: Some((0.0, REACH)),
        ..Panel::default()
    };
    let mut pressure = panel("Contact pressure, x = 0", "p / p0");
    let mut stress = panel("Stress along the axis, 0.5 C deep", "σyy / p0");
    for model in EdgeModel::ALL {
        let scene = Scene::new(&record.case, model, None);
        let solved = SolvedScene::new(&scene)?;
        let (field, end) = (solved.field(BodyKind::Block), scene.half_length);
        let curve = |points: Vec<(f64, f64)>| Series {
            markers: false,
            ..Series::curve(model.name(), look(&model.into()), points)
        };
        // Not nearer to the end than 0.1 C, where a half-space's pressure has no bound.
        let distances: Vec<f64> =
            (0..=60).map(|i| 0.1 * (REACH / 0.1).powf(f64::from(i) / 60.0)).collect();
        let at = |s: &f64| (*s, solved.pressure.at(0.0, end - s));
        pressure.series.push(curve(distances.iter().map(at).collect()));
        let at = |s: &f64| (*s, field.at(end - s, 0.5, &[0.0])[0].yy);
        stress.series.push(curve([0.0].iter().chain(&distances).map(at).collect()));
    }
    let engine = Source::Engine(Engine::fenicsx());
    let marks = |points: Vec<(f64, f64)>| {
        let near = points.into_iter().filter(|(s, _)| (0.0..=REACH).contains(s)).collect();
        Series::marks("finite elements", look(&engine), near)
    };
    let fem: &Curves = &record.finest().curves;
    let end = record.case.factors().slenderness;
    let line = fem.line("along-y").expect("a record has the line");
    pressure
        .series
        .push(marks(line.at.iter().zip(&line.p).map(|(at, p)| (end - at[1], *p)).collect()));
    let curve = fem.curve(BodyKind::Block, "along-y-0.5C").expect("a record has the curve");
    let points = curve.at.iter().zip(&curve.stress);
    stress.series.push(marks(points.map(|(at, s)| (end - at[1], s.yy)).collect()));
    Ok(Figure {
        title: "The end of a roller on a block with flush ends: four models beside finite elements"
            .into(),
        columns: 3,
        panels: vec![pressure, stress, times(&record)?],
        panel_size: (400, 340),
    })
}

/// Run time against error of one recorded case, each model at several tolerances and finite
/// elements on several meshes.
fn times(record: &FemResults) -> Result<Panel> {
    let bench = Bench::recorded()?;
    let own = bench.cases.iter().find(|case| case.case.is_same_problem(&record.case));
    let points = &own.expect("the case was timed").points;
    let of = |source: Source, name: &str| {
        let own = points.iter().filter(|point| point.source == source);
        let at = own.filter_map(|point| Some((point.seconds()?, point.error(Against::Limit)?)));
        Series::curve(name, look(&source), at.collect())
    };
    let models = EdgeModel::ALL.map(|model| of(model.into(), model.name()));
    let fem = of(Source::Engine(Engine::fenicsx()), "finite elements");
    Ok(Panel {
        title: "Run time against error".into(),
        x_label: "seconds (one thread)".into(),
        y_label: "worst RMS error of a curve / p0".into(),
        series: models.into_iter().chain([fem]).collect(),
        log: (true, true),
        ..Panel::default()
    })
}

/// The panels of the four models' curves, without curves.
fn panels() -> Vec<Panel> {
    [
        ("Pressure on x = 0", "distance from the roller's end (C)", 5.0, "p / p0"),
        ("Along x = 0, z = 0.5 C", "distance from the roller's end (C)", 5.0, "σyy / p0"),
        ("Down the end face, x = 0", "depth (C)", 3.0, "σyy / p0"),
    ]
    .into_iter()
    .map(|(title, x_label, reach, y_label)| Panel {
        title: title.into(),
        x_label: x_label.into(),
        y_label: y_label.into(),
        x_range: Some((0.0, reach)),
        ..Panel::default()
    })
    .collect()
}
