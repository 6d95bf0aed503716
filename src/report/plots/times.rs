//! The plot of run time against error.

use crate::report::draw::{Figure, Panel, Series, look};
use crate::report::study_files::StudyFiles;
use crate::report::study_rows::StudyRow;
use crate::study::response::Response;

/// Run time against error: each model and reference in each case.
pub(super) fn figure(files: &StudyFiles) -> Figure {
    let panel = |title: &str, of_model: Response, own: fn(&StudyRow) -> Option<f64>| Panel {
        title: title.to_string(),
        x_label: "seconds a case (one thread; FEM: on its own machine)".to_string(),
        y_label: "error / p0".to_string(),
        series: files
            .sources()
            .into_iter()
            .map(|source| {
                let rows = files.study.iter().filter(|row| row.source == *source);
                let point = |row: &StudyRow| {
                    let error = if source.is_engine() { own(row) } else { row.response(of_model) };
                    Some((row.seconds?, error?))
                };
                let whose = if source.is_engine() { " (its own error)" } else { "" };
                let name = format!("{}{whose}", source.title());
                Series::marks(&name, look(source), rows.filter_map(point).collect())
            })
            .collect(),
        log: (true, true),
        ..Default::default()
    };
    let pressure = panel("largest error of the pressure", Response::PRESSURE_MAX, |row| {
        row.fem_error_pressure
    });
    let stress = panel("largest error of the six stresses", Response::STRESS_MAX, |row| {
        row.fem_error_stress
    });
    Figure {
        title: "Run time against error, one point a case".to_string(),
        columns: 2,
        panels: vec![pressure, stress],
        panel_size: (470, 370),
    }
}
