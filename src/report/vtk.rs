//! Stress fields as VTK rectilinear grids (`.vtr`), which ParaView opens.
//!
//! Files are XML with the numbers appended as they are in memory (little-endian, 64-bit headers;
//! VTK User's Guide, 11th ed., section 19.3, "XML File Formats").

/// Bytes of an array's length before the array.
const HEADER: usize = size_of::<u64>();

/// A field on a rectilinear grid, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct VtkGrid {
    /// Coordinates along x, y and z (m), each ascending.
    pub axes_m: [Vec<f64>; 3],
    /// Names and values of the arrays; x runs fastest, z slowest.
    pub arrays: Vec<(String, Vec<f32>)>,
}

impl VtkGrid {
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
        let mut offset = 0;
        let mut array = |name: &str, kind: &str, bytes: usize| {
            let line = format!(
                "        <DataArray type=\"{kind}\" Name=\"{name}\" format=\"appended\" \
                 offset=\"{offset}\"/>\n"
            );
            offset += HEADER + bytes;
            line
        };
        for (name, values) in &self.arrays {
            assert_eq!(values.len(), nx * ny * nz, "{name} has a value for every point");
            text += &array(name, "Float32", size_of_val(values.as_slice()));
        }
        text += "      </PointData>\n      <Coordinates>\n";
        for (name, axis) in ["x_m", "y_m", "z_m"].iter().zip(&self.axes_m) {
            text += &array(name, "Float64", size_of_val(axis.as_slice()));
        }
        text += "      </Coordinates>\n    </Piece>\n  </RectilinearGrid>\n  \
                 <AppendedData encoding=\"raw\">\n_";
        let end = b"\n  </AppendedData>\n</VTKFile>\n";
        let mut bytes = Vec::with_capacity(text.len() + offset + end.len());
        bytes.extend_from_slice(text.as_bytes());
        for (_, values) in &self.arrays {
            bytes.extend_from_slice(&(size_of_val(values.as_slice()) as u64).to_le_bytes());
            bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        }
        for axis in &self.axes_m {
            bytes.extend_from_slice(&(size_of_val(axis.as_slice()) as u64).to_le_bytes());
            bytes.extend(axis.iter().flat_map(|v| v.to_le_bytes()));
        }
        bytes.extend_from_slice(end);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_stand_where_the_header_says() {
        let axes = [vec![0.0, 1.0], vec![-2.0, 0.0, 2.0], vec![0.5]];
        let arrays = [("zeros", 0.0), ("sigma_zz_pa", 1.0)].map(|(name, scale)| {
            (name.to_string(), (0..6u8).map(|i| scale * f32::from(i)).collect())
        });
        let grid = VtkGrid { axes_m: axes, arrays: arrays.into() };
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
