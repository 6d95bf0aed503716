//! The files of a solution on cells beside those of every solution: `pressure.npy` and `axes.json`,
//! and what rough surfaces and many loads add.

use super::columns::{Columns, Value};
use crate::base::HertzScales;
use crate::base::StressTensor;
use crate::cells::CellPressure;
use crate::solve::{CellLayer, CellSolution, LoadStep};
use serde_json::json;

/// Bins of the histogram of pressures.
const BINS: usize = 50;

/// Both files by their names, in SI units.
pub fn contents(found: &CellSolution) -> Vec<(String, Vec<u8>)> {
    let (grid, hertz) = (&found.pressure.grid, &found.solution.summary.hertz);
    let pascals = found.pressure.pressure.iter().map(|p| p * hertz.p0_pa);
    let places = |count: usize, at: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (0..count).map(|i| at(i) * hertz.c_m).collect()
    };
    let x_m = places(grid.nx, &|i| grid.x(i));
    let axes = json!({ "x_m": x_m, "y_m": places(grid.ny, &|j| found.middle + grid.y(j)) });
    vec![
        ("pressure.npy".into(), npy(&[grid.nx, grid.ny], pascals)),
        ("axes.json".into(), format!("{axes}\n").into_bytes()),
    ]
}

/// `pressure_histogram.csv`: shares of the real contact area by their pressures.
pub fn histogram(pressure: &CellPressure, hertz: &HertzScales) -> (String, Vec<u8>) {
    let largest = pressure.pressure.iter().fold(0.0, |m: f64, p| m.max(*p)) * hertz.p0_pa;
    let edge = |i: usize| largest * i as f64 / BINS as f64;
    let row = |(i, share): (usize, f64)| {
        let numbers = [("from_pa", edge(i)), ("to_pa", edge(i + 1)), ("share", share)];
        numbers.map(|(name, v)| (name.to_string(), Value::Number(v))).to_vec()
    };
    let rows = pressure.histogram(BINS).into_iter().enumerate().map(row);
    csv(Columns::of_rows("pressure_histogram", rows))
}

/// `load_gap.csv`: a row for each load.
pub fn load_gap(steps: &[LoadStep]) -> (String, Vec<u8>) {
    let row = |step: &LoadStep| {
        let LoadStep { force_n, approach_m, mean_gap_m, contact_area_m2, p_max_pa } = *step;
        let numbers = [
            ("force_n", force_n),
            ("approach_m", approach_m),
            ("mean_gap_m", mean_gap_m),
            ("contact_area_m2", contact_area_m2),
            ("p_max_pa", p_max_pa),
        ];
        numbers.map(|(name, v)| (name.to_string(), Value::Number(v))).to_vec()
    };
    csv(Columns::of_rows("load_gap", steps.iter().map(row)))
}

fn csv(table: Columns) -> (String, Vec<u8>) {
    (format!("{}.csv", table.name), table.to_csv().into_bytes())
}

/// `layer-BODY-NUMBER.npy` for each of `layers`, numbered by their depths, and `layers.json` with
/// the most stressed place of all.
pub fn layers(found: &CellSolution, layers: &[CellLayer]) -> Vec<(String, Vec<u8>)> {
    let (grid, hertz) = (&found.pressure.grid, &found.solution.summary.hertz);
    let mut files = Vec::new();
    let mut listed = Vec::new();
    let mut critical = (0.0, json!(null));
    for (i, layer) in layers.iter().enumerate() {
        let number = 1 + layers[..i].iter().filter(|other| other.body == layer.body).count();
        let name = format!("layer-{}-{number}.npy", layer.body.name());
        listed.push(json!({ "file": name, "body": layer.body.name(), "z_m": layer.depth_m }));
        for cell in 0..grid.len() {
            let components = layer.stress.each_ref().map(|field| field[cell]);
            let value = StressTensor::from_components(components).von_mises() * hertz.p0_pa;
            if value > critical.0 {
                let [x, y] = [grid.x(cell % grid.nx), found.middle + grid.y(cell / grid.nx)];
                let at = [x * hertz.c_m, y * hertz.c_m, layer.depth_m];
                let place = json!({ "body": layer.body.name(), "measure": "von_mises",
                    "value_pa": value, "at_m": at });
                critical = (value, place);
            }
        }
        let pascals = layer.stress.iter().flatten().map(|s| s * hertz.p0_pa);
        files.push((name, npy(&[grid.nx, grid.ny, 6], pascals)));
    }
    let names = StressTensor::NAMES.map(|name| format!("{name}_pa"));
    let list = json!({ "components": names, "layers": listed, "critical": critical.1 });
    files.push(("layers.json".into(), format!("{list:#}\n").into_bytes()));
    files
}

/// An array of numpy's format 1.0 whose first index runs fastest in `values`.
fn npy(shape: &[usize], values: impl Iterator<Item = f64>) -> Vec<u8> {
    /// Magic string, version and the header's length; with the header a multiple of 64.
    const START: usize = 10;
    let shape = shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    let form = format!("{{'descr': '<f8', 'fortran_order': True, 'shape': ({shape}), }}");
    let padding = 63 - (START + form.len()) % 64;
    let header = format!("{form}{}\n", " ".repeat(padding));
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    values.for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_have_the_header_that_numpy_reads() {
        let bytes = npy(&[2, 3], (0..6).map(f64::from));
        assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
        let length = u16::from_le_bytes([bytes[8], bytes[9]]) as usize;
        assert_eq!((10 + length) % 64, 0);
        let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
        assert!(header.starts_with("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }"));
        assert!(header.ends_with(" \n"));
        assert_eq!(bytes.len(), 10 + length + 48);
        assert_eq!(bytes[10 + length + 8..][..8], 1f64.to_le_bytes());
    }
}
