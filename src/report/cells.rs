//! The files of a solution on cells beside those of every solution: `pressure.npy` and `axes.json`.

use crate::base::HertzScales;
use crate::cells::{CellPressure, Grid};
use serde_json::json;

/// Both files by their names, in SI units.
pub fn contents(pressure: &CellPressure, hertz: &HertzScales) -> Vec<(String, Vec<u8>)> {
    let grid = &pressure.grid;
    let pascals = pressure.pressure.iter().map(|p| p * hertz.p0_pa);
    let places = |count: usize, at: fn(&Grid, usize) -> f64| -> Vec<f64> {
        (0..count).map(|i| at(grid, i) * hertz.c_m).collect()
    };
    let axes = json!({ "x_m": places(grid.nx, Grid::x), "y_m": places(grid.ny, Grid::y) });
    vec![
        ("pressure.npy".into(), npy([grid.nx, grid.ny], pascals)),
        ("axes.json".into(), format!("{axes}\n").into_bytes()),
    ]
}

/// An array of numpy's format 1.0 whose first index runs fastest in `values`.
fn npy([nx, ny]: [usize; 2], values: impl Iterator<Item = f64>) -> Vec<u8> {
    /// Magic string, version and the header's length; with the header a multiple of 64.
    const START: usize = 10;
    let form = format!("{{'descr': '<f8', 'fortran_order': True, 'shape': ({nx}, {ny}), }}");
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
        let bytes = npy([2, 3], (0..6).map(f64::from));
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
