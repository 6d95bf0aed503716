//! What the columns of a file of curves are, by their names in common programs.

use super::statements::Unit;

/// What a column is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    /// The body's name.
    Body,
    /// The curve's name.
    Curve,
    /// A coordinate along one of the file's axes.
    Place(usize),
    /// The size of a cell along one of the file's axes, over which its pressure is the mean.
    Width(usize),
    /// A stress component in the file's axes, by its index in the tensor's components.
    Stress(usize),
    /// The contact pressure.
    Pressure,
    /// The relative size of a mesh; only the smallest counts.
    Mesh,
    /// A name that is the same in the whole file.
    Same,
}

/// The names of components: ours, those by numbers, and those of normal stresses and axes by one
/// letter or digit.
const COMPONENTS: [[&str; 4]; 6] = [
    ["xx", "11", "x", "1"],
    ["yy", "22", "y", "2"],
    ["zz", "33", "z", "3"],
    ["xy", "12", "yx", "21"],
    ["xz", "13", "zx", "31"],
    ["yz", "23", "zy", "32"],
];

/// What a column called `header` is, and the unit that its name states: `sigma_xx_pa`, `S11 [MPa]`,
/// `S.S11`, `SX`, `CPRESS`, `x_mm`, `COORD1`.
pub(super) fn read(header: &str) -> Option<(Meaning, Option<Unit>)> {
    let (name, unit) = split_unit(header);
    let name = name.to_ascii_lowercase();
    let axis = |text: &str| COMPONENTS[..3].iter().position(|c| c[2] == text || c[3] == text);
    let meaning = match name.as_str() {
        "body" => Meaning::Body,
        "curve" | "line" | "path" => Meaning::Curve,
        "mesh" => Meaning::Mesh,
        "case" | "source" => Meaning::Same,
        "p" | "pressure" | "contact_pressure" | "cpress" => Meaning::Pressure,
        "x" | "y" | "z" => Meaning::Place(axis(&name)?),
        "dx" | "dy" | "dz" => Meaning::Width(axis(&name[1..])?),
        _ => match name.strip_prefix("coord").or_else(|| name.strip_prefix("coor")) {
            Some(rest) => Meaning::Place(axis(rest)?),
            None => Meaning::Stress(component(&name)?),
        },
    };
    Some((meaning, unit))
}

/// The index of the component called `name`: `sigma_xx`, `s_xx`, `s11`, `s.s11`, `s-s11`, `sx`.
fn component(name: &str) -> Option<usize> {
    let rest = name.strip_prefix("sigma").or_else(|| {
        let rest = name.strip_prefix('s')?;
        // The field's name may stand before the component's.
        Some(rest.strip_prefix(['.', '-', ':']).and_then(|r| r.strip_prefix('s')).unwrap_or(rest))
    })?;
    let rest = rest.trim_start_matches(['_', '.', '-', ':']);
    // S1, S2 and S3 are principal stresses in many programs.
    let is_principal = ["1", "2", "3"].contains(&rest);
    COMPONENTS.iter().position(|names| !is_principal && names.contains(&rest))
}

/// A column's name, and the unit at its end: behind the last `_`, or in brackets.
fn split_unit(header: &str) -> (&str, Option<Unit>) {
    let unit = |text: &str| Unit::of_length(text).or_else(|| Unit::of_stress(text));
    let header = header.trim();
    let bracketed = header
        .strip_suffix([']', ')'])
        .and_then(|h| h.rsplit_once(['[', '(']))
        .and_then(|(name, text)| Some((name.trim_end(), unit(text.trim())?)));
    let joined = header.rsplit_once('_').and_then(|(name, text)| Some((name, unit(text)?)));
    match bracketed.or(joined) {
        Some((name, unit)) => (name, Some(unit)),
        None => (header, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_common_programs_are_known() {
        let name = |header: &str| {
            read(header).map(|(meaning, unit)| (meaning, unit.map_or("", |u| u.name)))
        };
        for (header, wanted) in [
            ("x_m", (Meaning::Place(0), "m")),
            ("Y [mm]", (Meaning::Place(1), "mm")),
            ("COORD3", (Meaning::Place(2), "")),
            ("dx_m", (Meaning::Width(0), "m")),
            ("sigma_xz_pa", (Meaning::Stress(4), "Pa")),
            ("S11", (Meaning::Stress(0), "")),
            ("S.S23", (Meaning::Stress(5), "")),
            ("S-S12 (MPa)", (Meaning::Stress(3), "MPa")),
            ("SYZ", (Meaning::Stress(5), "")),
            ("SZ", (Meaning::Stress(2), "")),
            ("s_xx", (Meaning::Stress(0), "")),
            ("p_pa", (Meaning::Pressure, "Pa")),
            ("CPRESS", (Meaning::Pressure, "")),
            ("line", (Meaning::Curve, "")),
            ("mesh", (Meaning::Mesh, "")),
        ] {
            assert_eq!(name(header), Some(wanted), "{header}");
        }
        for header in
            ["S1", "sigma_3_pa", "von_mises_pa", "p_lumped_pa", "size", "", "_", "coord4", "s"]
        {
            assert_eq!(name(header), None, "{header}");
        }
    }
}
