//! Draws the figures of docs/theory.md from the built-in case `flush-short`:
//!
//! ```text
//! cargo run --release --example figures
//! ```
//!
//! writes docs/figures/*.svg in a few seconds.

use edgeline::base::Result;
use edgeline::body::EdgeModel;
use edgeline::case::builtin_case;
use edgeline::report::draw::{Figure, Map, Panel, Series, look};
use edgeline::solve::{Scene, SolvedScene};
use edgeline::stress::BodyKind;
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
        let map =
            Map { label: "σyy / p0".into(), values: values.collect(), axes: [ys, zs], down: true };
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
    Ok(())
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
