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
use edgeline::report::chart::{Figure, Panel, Series, look};
use edgeline::report::contour::Plane;
use edgeline::solve::{Scene, SolvedScene};
use edgeline::stress::BodyKind;
use std::path::Path;

/// Values of a plane in units of p0 beyond this are drawn as this: half-space and mirror would
/// otherwise leave no colours for the others.
const LIMIT: f64 = 1.0;

fn main() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/figures");
    std::fs::create_dir_all(&folder).expect("docs can be written");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(format!("{name}.svg")), text).expect("docs can be written");
    };
    let case = builtin_case("flush-short").expect("a case of that name")?;
    let mut panels: Vec<Panel> = [
        ("Pressure on x = 0", "distance from the roller's end (C)", "p / p0"),
        ("Along the contact, x = 0, z = 0.5 C", "distance from the roller's end (C)", "σyy / p0"),
        ("Down the end face, x = 0", "depth (C)", "σyy / p0"),
    ]
    .into_iter()
    .map(|(title, x_label, y_label)| Panel {
        title: title.into(),
        x_label: x_label.into(),
        y_label: y_label.into(),
        ..Panel::default()
    })
    .collect();
    for model in EdgeModel::ALL {
        let scene = Scene::new(&case, model, None);
        let solved = SolvedScene::new(&scene)?;
        let field = solved.field(BodyKind::Block);
        let end = scene.half_length;
        let curve = |points| Series {
            markers: false,
            ..Series::curve(model.name(), look(model.name()), points)
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
        let plane = Plane {
            title: format!("{model}: σyy in the plane x = 0; the end face is the right border"),
            labels: ["y / C".into(), "z / C".into()],
            value_label: "σyy / p0".into(),
            values: values.collect(),
            axes: [ys, zs],
            down: true,
        };
        write(model.name(), &plane.to_svg());
    }
    let figure = Figure {
        title: "Flush ends, S_l = 5, ν = 0.3".into(),
        columns: 3,
        panels,
        panel_size: (420, 320),
    };
    write("models", &figure.to_svg());
    Ok(())
}
