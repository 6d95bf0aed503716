//! Recorded finite-element results, as `results/reference/README.md` describes them.

use super::code::Code;
use super::request::Problem;
use super::result::{FemSummary, MeshResult, check_points, nonsense, parse_curves, parse_lines};
use super::sum::sha256;
use crate::base::{Error, Result};
use crate::case::Case;
use crate::host::read_text;
use crate::stress::Curves;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Records that are built into the program: case, then `record.json`, `curves.csv` and
/// `pressure.csv`.
type Embedded = &'static [(&'static str, [&'static str; 3])];

/// Those of FEniCSx and of CalculiX.
const FENICSX: Embedded = include!(concat!(env!("OUT_DIR"), "/records.rs"));
const CALCULIX: Embedded = include!(concat!(env!("OUT_DIR"), "/records_calculix.rs"));

/// The files of a record, in the order of [`Embedded`].
const FILES: [&str; 3] = ["record.json", "curves.csv", "pressure.csv"];

/// The checksums of these files, as `sha256sum` writes and checks them.
const SUMS: &str = "SHA256SUMS";

/// Size limit of a file of a record (bytes), far above that of any correct one.
const MAX_FILE_BYTES: u64 = 256 << 20;

/// The remedy for a file that differs from the recorded one.
const RESTORE: &str = "restore the folder from version control, or remove it and record it anew: \
                       python3 -m edgeline_fem record (docs/fem.md)";

/// Refuses the text of the file `name` unless its checksum is in `sums`.
fn check_sum(text: &str, name: &str, sums: &str, folder: &Path) -> Result<()> {
    let refuse = |name: &str, message: String| Error::File {
        path: folder.join(name),
        line: None,
        message,
        remedy: RESTORE.to_string(),
    };
    let wanted = sums
        .lines()
        .find_map(|line| line.split_once("  ").filter(|(_, of)| *of == name))
        .ok_or_else(|| refuse(SUMS, format!("holds no checksum of {name}")))?
        .0;
    let found = sha256(text);
    if found == wanted {
        return Ok(());
    }
    Err(refuse(name, format!("was changed or is damaged: its SHA-256 is {found}, not {wanted}")))
}

/// The estimated error of one component of one curve, from its meshes. Curves on the surface
/// exclude the immediate neighbourhood of the overlap's ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// `block`, `roller`, or `contact` for the pressure lines.
    pub body: String,
    /// The curve or the pressure line.
    pub curve: String,
    /// `sigma_xx` to `tau_max`, or `pressure`.
    pub component: String,
    /// The sizes compared, finest last.
    pub sizes: Vec<f64>,
    /// Largest difference of the two finest meshes (p0).
    pub difference_max: f64,
    /// Root mean square of that difference (p0).
    pub difference_rms: f64,
    /// Observed order of convergence over the three finest meshes, if any.
    pub order: Option<f64>,
    /// Factor from a point's difference to the finest mesh's error.
    pub factor: Option<f64>,
    /// `factor` times `difference_max` (p0).
    pub error_max: Option<f64>,
    /// `factor` times `difference_rms` (p0).
    pub error_rms: Option<f64>,
}

/// Finite-element results of one case on one or more meshes.
#[derive(Debug, Clone, PartialEq)]
pub struct FemResults {
    /// The problem that was solved (its tolerance means nothing here).
    pub case: Case,
    /// `recorded`, or `live` for a run of this program, now.
    pub source: &'static str,
    /// The meshes, finest first; at least one.
    pub meshes: Vec<MeshResult>,
    /// Errors of the finest mesh; empty for a single mesh.
    pub errors: Vec<ErrorEstimate>,
}

/// The content of `record.json`.
#[derive(Deserialize)]
struct Record {
    schema: u32,
    #[serde(with = "Problem")]
    case: Case,
    meshes: BTreeMap<String, FemSummary>,
    errors: Vec<ErrorEstimate>,
}

impl FemResults {
    /// Names of the cases whose records are built into the program.
    pub fn embedded_names() -> impl Iterator<Item = &'static str> {
        FENICSX.iter().map(|(name, _)| *name)
    }

    /// The record of the case called `name` that is built into the program, if there is one.
    ///
    /// # Errors
    /// [`Error::File`] when the record is damaged.
    pub fn embedded(name: &str) -> Result<Option<FemResults>> {
        Self::in_list(FENICSX, name, Path::new("results/reference"))
    }

    /// The record called `name` in a list of those that stand in `folder`.
    fn in_list(list: Embedded, name: &str, folder: &Path) -> Result<Option<FemResults>> {
        let Some((name, texts)) = list.iter().find(|(known, _)| *known == name) else {
            return Ok(None);
        };
        FemResults::parse(*texts, &folder.join(name)).map(Some)
    }

    /// The built-in record that solves the problem `case`, if there is one: the same bodies,
    /// materials and load, whatever the names are.
    ///
    /// # Errors
    /// As [`FemResults::embedded`].
    pub fn embedded_of(case: &Case) -> Result<Option<FemResults>> {
        Self::embedded_by(Code::Fenicsx, case)
    }

    /// The built-in record of `case` by a code, as [`FemResults::embedded_of`].
    ///
    /// # Errors
    /// As [`FemResults::embedded`].
    pub fn embedded_by(code: Code, case: &Case) -> Result<Option<FemResults>> {
        let (list, folder) = match code {
            Code::Fenicsx => (FENICSX, "results/reference"),
            Code::Calculix => (CALCULIX, "results/calculix"),
        };
        let names = || list.iter().map(|(name, _)| *name);
        // The record of the same name first, because it nearly always matches.
        let same_name = names().filter(|name| *name == case.name);
        let others = names().filter(|name| *name != case.name);
        for name in same_name.chain(others) {
            match Self::in_list(list, name, Path::new(folder))? {
                Some(reference) if reference.is_of(case) => return Ok(Some(reference)),
                _ => {}
            }
        }
        Ok(None)
    }

    /// Reads the record in the folder `results/reference/<case>`.
    ///
    /// # Errors
    /// [`Error::Io`] when a file cannot be read; [`Error::File`] when it is not the file that was
    /// recorded, and as [`FemResults::parse`].
    pub fn read(folder: &Path) -> Result<FemResults> {
        let read = |name: &str| read_text(&folder.join(name), MAX_FILE_BYTES, RESTORE);
        let sums = read(SUMS)?;
        let mut texts = Vec::new();
        for file in FILES {
            let text = read(file)?;
            check_sum(&text, file, &sums, folder)?;
            texts.push(text);
        }
        Self::parse([&texts[0], &texts[1], &texts[2]], folder)
    }

    /// Reads all records below a folder such as `results/reference`, by name.
    ///
    /// # Errors
    /// As [`FemResults::read`].
    pub fn read_all(folder: &Path) -> Result<Vec<FemResults>> {
        let io = |source| Error::Io { action: "list", path: folder.to_path_buf(), source };
        let mut folders: Vec<PathBuf> = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(io)? {
            let path = entry.map_err(io)?.path();
            if path.join(FILES[0]).is_file() {
                folders.push(path);
            }
        }
        folders.sort();
        folders.iter().map(|folder| Self::read(folder)).collect()
    }

    /// Reads the texts of `record.json`, `curves.csv` and `pressure.csv`; `folder`, which contains
    /// them, is only named in errors.
    ///
    /// # Errors
    /// [`Error::File`] when one is damaged or of another version, when its case is not legal, when
    /// a run did not carry its load, or when the points are not the standard curves'.
    pub fn parse([record, curves, lines]: [&str; 3], folder: &Path) -> Result<FemResults> {
        let path = folder.join(FILES[0]);
        let record: Record = serde_json::from_str(record)
            .map_err(|e| nonsense(&path, Some(e.line()), format!("is not a record: {e}")))?;
        if record.schema != 1 {
            let message = format!("has schema {}, this program reads 1", record.schema);
            return Err(nonsense(&path, None, message));
        }
        let case = record.case;
        case.check().map_err(|e| nonsense(&path, None, format!("is not of a legal case: {e}")))?;
        let hertz = case.hertz();
        let mut curves = parse_curves(curves, &hertz, &folder.join(FILES[1]))?;
        let mut lines = parse_lines(lines, &hertz, &folder.join(FILES[2]))?;
        let mut meshes = Vec::new();
        for (size, summary) in record.meshes {
            let parsed: f64 = size.parse().unwrap_or(f64::NAN);
            if !(parsed.is_finite() && parsed > 0.0) {
                return Err(nonsense(&path, None, format!("'{size}' is not the size of a mesh")));
            }
            summary.check(&path)?;
            let pressure = lines.extract_if(.., |(s, _)| *s == parsed).map(|(_, line)| line);
            let stress = curves.extract_if(.., |(s, _)| *s == parsed).map(|(_, curve)| curve);
            let curves = Curves { hertz, pressure: pressure.collect(), stress: stress.collect() };
            check_points(&case, &curves, folder)?;
            meshes.push(MeshResult { size: parsed, summary, curves });
        }
        if meshes.is_empty() {
            return Err(nonsense(&path, None, "holds no mesh"));
        }
        meshes.sort_by(|a, b| a.size.total_cmp(&b.size));
        Ok(FemResults { case, source: "recorded", meshes, errors: record.errors })
    }

    /// The finest mesh, the one to compare with.
    pub fn finest(&self) -> &MeshResult {
        &self.meshes[0]
    }

    /// Whether this is a record of the problem `case`.
    pub fn is_of(&self, case: &Case) -> bool {
        self.case.is_same_problem(case)
    }

    /// The error estimate of one component (`sigma_xx` ... `tau_max`, or `pressure` with the body
    /// `contact`) on one curve.
    pub fn error(&self, body: &str, curve: &str, component: &str) -> Option<&ErrorEstimate> {
        let is_it =
            |e: &&ErrorEstimate| e.body == body && e.curve == curve && e.component == component;
        self.errors.iter().find(is_it)
    }
}
