//! Stress fields as VTK rectilinear grids (`.vtr`), which ParaView opens.
//!
//! Files are XML with the numbers appended as they are in memory (little-endian, 64-bit headers;
//! VTK User's Guide, 11th ed., section 19.3, "XML File Formats").

use crate::base::StressTensor;

/// A field on a rectilinear grid, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Coordinates along x, y and z (m), each ascending.
    pub axes_m: [Vec<f64>; 3],
    /// Names and values of the arrays; x runs fastest, z slowest.
    pub arrays: Vec<(String, Vec<f32>)>,
}

impl Grid {
    /// A grid of stresses (Pa) with the arrays `sigma_xx_pa` ... `sigma_yz_pa`, `von_mises_pa` and
    /// `tau_max_pa`.
    pub fn of_stress(axes_m: [Vec<f64>; 3], stress_pa: &[StressTensor]) -> Self {
        let mut arrays: Vec<(String, Vec<f32>)> = StressTensor::NAMES
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let values = stress_pa.iter().map(|s| s.components()[i] as f32).collect();
                (format!("{name}_pa"), values)
            })
            .collect();
        let von_mises = stress_pa.iter().map(|s| s.von_mises() as f32).collect();
        let tau_max = stress_pa.iter().map(|s| s.tau_max() as f32).collect();
        arrays.push(("von_mises_pa".to_string(), von_mises));
        arrays.push(("tau_max_pa".to_string(), tau_max));
        Self { axes_m, arrays }
    }

    /// The file's bytes.
    ///
    /// # Panics
    /// When an array is not as long as the grid has points.
    pub fn to_vtr(&self) -> Vec<u8> {
        let [nx, ny, nz] = [0, 1, 2].map(|k| self.axes_m[k].len());
        let extent = format!("0 {} 0 {} 0 {}", nx - 1, ny - 1, nz - 1);
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"RectilinearGrid\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
        );
        text += &format!("  <RectilinearGrid WholeExtent=\"{extent}\">\n");
        text += &format!("    <Piece Extent=\"{extent}\">\n      <PointData>\n");
        let mut data: Vec<u8> = Vec::new();
        let mut append = |bytes: &[u8]| {
            let offset = data.len();
            data.extend_from_slice(&(bytes.len() as u64).to_le_bytes());
            data.extend_from_slice(bytes);
            offset
        };
        for (name, values) in &self.arrays {
            assert_eq!(values.len(), nx * ny * nz, "{name} has a value for every point");
            let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            let offset = append(&bytes);
            text += &format!(
                "        <DataArray type=\"Float32\" Name=\"{name}\" format=\"appended\" \
                 offset=\"{offset}\"/>\n"
            );
        }
        text += "      </PointData>\n      <Coordinates>\n";
        for (name, axis) in ["x_m", "y_m", "z_m"].iter().zip(&self.axes_m) {
            let bytes: Vec<u8> = axis.iter().flat_map(|v| v.to_le_bytes()).collect();
            let offset = append(&bytes);
            text += &format!(
                "        <DataArray type=\"Float64\" Name=\"{name}\" format=\"appended\" \
                 offset=\"{offset}\"/>\n"
            );
        }
        text += "      </Coordinates>\n    </Piece>\n  </RectilinearGrid>\n  \
                 <AppendedData encoding=\"raw\">\n_";
        let mut bytes = text.into_bytes();
        bytes.extend_from_slice(&data);
        bytes.extend_from_slice(b"\n  </AppendedData>\n</VTKFile>\n");
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_stand_where_the_header_says() {
        let axes = [vec![0.0, 1.0], vec![-2.0, 0.0, 2.0], vec![0.5]];
        let stress: Vec<StressTensor> =
            (0..6).map(|i| StressTensor { zz: f64::from(i), ..Default::default() }).collect();
        let grid = Grid::of_stress(axes, &stress);
        let bytes = grid.to_vtr();
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start = bytes.windows(marker.len()).position(|w| w == marker).unwrap() + marker.len();
        let header = std::str::from_utf8(&bytes[..start]).unwrap();
        assert!(header.contains("WholeExtent=\"0 1 0 2 0 0\""));
        let of = |name: &str| -> usize {
            let line = header.lines().find(|l| l.contains(&format!("\"{name}\""))).unwrap();
            let offset = line.split("offset=\"").nth(1).unwrap().split('"').next().unwrap();
            start + offset.parse::<usize>().unwrap()
        };
        let at = of("sigma_zz_pa");
        assert_eq!(u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()), 24);
        let third = &bytes[at + 8 + 3 * 4..at + 8 + 4 * 4];
        assert_eq!(f32::from_le_bytes(third.try_into().unwrap()), 3.0);
        let at = of("y_m");
        assert_eq!(f64::from_le_bytes(bytes[at + 8..at + 16].try_into().unwrap()), -2.0);
    }
}
