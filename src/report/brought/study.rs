//! The brought curves of a study's case, from the files of its run.

use super::rows::Of;
use super::summary::FileSummary;
use crate::base::{HertzScales, StressTensor};
use crate::report::study_files::StudyFiles;
use crate::report::study_rows::{CurveRow, PressureRow};
use crate::report::study_summary::CaseSummary;
use crate::stress::{Curves, PressureLine, StressCurve};
use crate::study::Source;

/// The curves of a file, and all sources on its points.
pub struct FileCurves<'a> {
    /// What the file was compared with.
    pub summary: &'a FileSummary,
    /// The file's own curves with the error that it states, then those of all sources.
    pub all: Vec<(Source, Curves)>,
}

/// The files of curves of a case.
pub fn of_case<'a>(files: &'a StudyFiles, case: &'a CaseSummary) -> Vec<FileCurves<'a>> {
    let of_file = |summary: &'a FileSummary| {
        let stress = rows_of(&files.brought_curves, &summary.name, |r| r.case == case.name);
        let pressure = rows_of(&files.brought_pressure, &summary.name, |r| r.case == case.name);
        let mut sources: Vec<&Source> = Vec::new();
        for source in stress.iter().map(|r| &r.source).chain(pressure.iter().map(|r| &r.source)) {
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        let mut all: Vec<(Source, Curves)> = sources
            .into_iter()
            .map(|source| (source.clone(), curves(case.hertz, source, &stress, &pressure)))
            .collect();
        if let (Some((_, own)), Some(error)) = (all.first_mut(), summary.error_p0) {
            own.state_error(error);
        }
        FileCurves { summary, all }
    };
    case.brought.iter().map(of_file).collect()
}

/// The rows about the curves of `reference` that `own` keeps.
fn rows_of<'a, R>(all: &'a [Of<R>], reference: &str, own: impl Fn(&R) -> bool) -> Vec<&'a R> {
    all.iter().filter(|of| of.reference == reference && own(&of.row)).map(|of| &of.row).collect()
}

/// The curves of a source from its rows.
fn curves(
    hertz: HertzScales,
    source: &Source,
    stress: &[&CurveRow],
    pressure: &[&PressureRow],
) -> Curves {
    let HertzScales { c_m, p0_pa, .. } = hertz;
    let own: Vec<&PressureRow> = pressure.iter().copied().filter(|r| r.source == *source).collect();
    let line = |rows: &[&PressureRow]| PressureLine {
        name: rows[0].line.clone(),
        at: rows.iter().map(|r| r.at_m.map(|v| v / c_m)).collect(),
        p: rows.iter().map(|r| r.p_pa / p0_pa).collect(),
        own_error: None,
    };
    let pressure = own.chunk_by(|a, b| a.line == b.line).map(line).collect();
    let own: Vec<&CurveRow> = stress.iter().copied().filter(|r| r.source == *source).collect();
    let curve = |rows: &[&CurveRow]| StressCurve {
        body: rows[0].body,
        name: rows[0].curve.clone(),
        at: rows.iter().map(|r| r.at_m.map(|v| v / c_m)).collect(),
        stress: rows
            .iter()
            .map(|r| {
                let [xx, yy, zz, xy, xz, yz, ..] = r.stress_pa;
                StressTensor::from_components([xx, yy, zz, xy, xz, yz]) * (1.0 / p0_pa)
            })
            .collect(),
        own_error: None,
    };
    let stress = own.chunk_by(|a, b| (a.body, &a.curve) == (b.body, &b.curve)).map(curve).collect();
    Curves { hertz, pressure, stress }
}
