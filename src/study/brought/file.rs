//! A file of curves: CSV with a header of `# key: value` lines.

use super::columns::{self, Meaning};
use super::statements::{Axes, KEYS, Statements, System, Unit, body_of};
use crate::base::number::stated;
use crate::base::{BodyKind, Error, Result, StressTensor};
use crate::case::Case;
use crate::host::{check_memory, csv_fault, csv_line, read_input};
use crate::solve::{Extent, Outside};
use crate::stress::{Curves, PressureLine, StressCurve};
use crate::study::errors::POINTS;
use crate::study::source::Source;
use std::path::{Path, PathBuf};
use std::result::Result as Checked;

/// Larger files are refused without reading them (bytes).
pub const MAX_BYTES: u64 = 1 << 30;

/// Memory for a byte of a file: a point takes about 40 of them, and a stress by every model.
const BYTES_PER_BYTE: f64 = 25.0;

/// Points that rounding has moved out of a body by less than this (C) are moved back.
const ROUNDING: f64 = 1e-3;

/// Points this near to an end of the overlap (C) are on it.
const END: f64 = 1e-5;

/// Distance from x = 0 (C) within which a contact has some pressure, whatever its profile.
const NEAR: f64 = 2.0;

/// Distance (C) from the plane where the bodies touch first, beyond which no point can be one of
/// the contact, however its surfaces are curved and pressed in.
const OFF_SURFACE: f64 = 2.0;

/// Depths below this (C) are those of the surface.
const SURFACE: f64 = 1e-6;

/// Stresses beyond the stiffest modulus that a case takes (Pa) are marks of missing values, or in
/// another unit.
const MOST_PA: f64 = 1e14;

/// The curves of a file, in C and p0 and in our axes.
#[derive(Debug, Clone, PartialEq)]
pub struct BroughtFile {
    /// What they are called.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// What it states, or options do.
    pub statements: Statements,
    /// The curves. A component that the file lacks is NaN at all points.
    pub curves: Curves,
    /// The sizes of cells across the contact (C), over which the pressures of each line are means;
    /// 0 at points.
    pub widths: Vec<Vec<f64>>,
    /// Number of points.
    pub points: usize,
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
}

/// A column that is used.
struct Column {
    /// Where it stands, from 0.
    at: usize,
    /// Its name.
    header: String,
    meaning: Meaning,
    /// What turns its numbers into SI units.
    si: f64,
}

impl BroughtFile {
    /// Reads the file `path` of curves of `case`; `options` take the place of what it states.
    ///
    /// # Errors
    /// [`Error::File`] with line and column of what cannot be used, [`Error::Io`],
    /// [`Error::Memory`].
    pub fn read(path: &Path, case: &Case, options: &Statements) -> Result<Self> {
        let size = std::fs::metadata(path).map_or(0, |m| m.len());
        let what = format!("comparing {}", path.display());
        check_memory(&what, size as f64 * BYTES_PER_BYTE, "split the file")?;
        Self::parse(&read_input(path, MAX_BYTES, "split the file")?, path, case, options)
    }

    /// Reads the text of a file; `path` names the curves that have no name.
    ///
    /// # Errors
    /// As [`BroughtFile::read`].
    pub fn parse(text: &str, path: &Path, case: &Case, options: &Statements) -> Result<Self> {
        let own = read_statements(text, path)?;
        let statements = options.clone().or(&own);
        let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .delimiter(delimiter(text))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let line_of = |at: &csv::Position| csv_line(text, at);
        let of_csv = |e: csv::Error| refuse(path, e.position().map(line_of), csv_fault(&e));
        let header = reader.headers().map_err(of_csv)?.clone();
        let line = reader.position().line().saturating_sub(1).max(1) as usize;
        let (columns, ignored) = find_columns(&header, &statements)
            .map_err(|message| refuse(path, Some(line), message))?;
        let mut table = Table::new(case, &statements, &columns, path, line)?;
        if table.pressures && own.body.is_some() {
            let message = "states a body, but a pressure is that of both: remove the line";
            return Err(refuse(path, None, message.to_string()));
        }
        for record in reader.records() {
            let record = record.map_err(of_csv)?;
            table.take(&record, record.position().map(line_of))?;
        }
        let (curves, widths, points) = table.finish()?;
        let name = statements.name.clone().unwrap_or(stem);
        Ok(Self { name, path: path.to_path_buf(), statements, curves, widths, points, ignored })
    }

    /// Refuses a name that one of `others` has.
    ///
    /// # Errors
    /// [`Error::Value`] with both files.
    pub fn check_name<'a>(&self, others: impl IntoIterator<Item = &'a Self>) -> Result<()> {
        match others.into_iter().find(|other| other.name == self.name) {
            None => Ok(()),
            Some(other) => Err(self.refused_name(format!(
                "{} and {} are called so",
                other.path.display(),
                self.path.display()
            ))),
        }
    }

    /// Refuses the name of a model or of a finite-element code, whose curves stand beside these.
    ///
    /// # Errors
    /// [`Error::Value`] with the file.
    pub fn check_foreign(&self) -> Result<()> {
        let known = Source::all().any(|s| [s.name(), s.title()].contains(&self.name.as_str()));
        let reason = || format!("{} is called like a model or a code", self.path.display());
        if known { Err(self.refused_name(reason())) } else { Ok(()) }
    }

    fn refused_name(&self, reason: String) -> Error {
        Error::Value {
            key: "name".to_string(),
            value: self.name.clone(),
            reason,
            remedy: "write a line `# name: ...` above the table".to_string(),
        }
    }
}

fn refuse(path: &Path, line: Option<usize>, message: String) -> Error {
    Error::File {
        path: path.to_path_buf(),
        line,
        message,
        remedy: "docs/compare.md describes the file".to_string(),
    }
}

/// The lines `# key: value` before the table. Other comments are left alone, unless a key is
/// mistyped, or stands below the names of the columns.
fn read_statements(text: &str, path: &Path) -> Result<Statements> {
    if text.contains('\r') && !text.contains('\n') {
        let message =
            "has line ends of carriage returns alone: save it with line feeds".to_string();
        return Err(refuse(path, None, message));
    }
    let mut statements = Statements::default();
    let mut stated: Vec<&str> = Vec::new();
    let mut is_above = true;
    for (i, line) in text.lines().enumerate() {
        let line = line.trim();
        let Some(comment) = line.strip_prefix('#') else {
            is_above &= line.is_empty();
            continue;
        };
        let Some((key, value)) = comment.split_once(':') else { continue };
        let (key, value) = (key.trim(), value.trim());
        if !is_above {
            if KEYS.iter().any(|(known, _)| *known == key) {
                let message =
                    format!("{key} is stated below the names of the columns: put it above them");
                return Err(refuse(path, Some(i + 1), message));
            }
            continue;
        }
        let distance = |(known, _): &(&str, &str)| strsim::damerau_levenshtein(known, key);
        let nearest = KEYS.iter().min_by_key(|k| distance(k)).expect("there are keys");
        let said = match distance(nearest) {
            0 if stated.contains(&key) => {
                Err(format!("{key} is stated twice: keep the line that holds"))
            }
            0 => {
                stated.push(key);
                statements.set(key, value)
            }
            // A short word is near to anything.
            1 | 2 if key.len() > 4 => {
                Err(format!("'{key}' is no key; did you mean {}?", nearest.0))
            }
            _ => Ok(()),
        };
        said.map_err(|message| refuse(path, Some(i + 1), message))?;
    }
    Ok(statements)
}

/// The character between columns: the one that is most frequent in the line of their names.
fn delimiter(text: &str) -> u8 {
    let is_header = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let header = text.lines().find(is_header).unwrap_or_default();
    let count = |c: &u8| header.bytes().filter(|b| b == c).count();
    // The last of equals: a comma.
    *b"\t;,".iter().max_by_key(|c| count(c)).expect("three characters")
}

/// The columns that are used, and the names of the others.
fn find_columns(
    header: &csv::StringRecord,
    statements: &Statements,
) -> Checked<(Vec<Column>, Vec<String>), String> {
    let (mut columns, mut ignored) = (Vec::<Column>::new(), Vec::new());
    for (at, header) in header.iter().enumerate() {
        let Some((meaning, unit)) = columns::read(header) else {
            ignored.push(header.to_string());
            continue;
        };
        let si = match meaning {
            Meaning::Place(_) | Meaning::Width(_) => {
                in_si(unit, statements.length, header, "length_unit", &Unit::of_length)?
            }
            Meaning::Stress(_) | Meaning::Pressure => {
                in_si(unit, statements.stress, header, "stress_unit", &Unit::of_stress)?
            }
            _ => 1.0,
        };
        if meaning != Meaning::Same
            && let Some(other) = columns.iter().find(|c| c.meaning == meaning)
        {
            return Err(format!("columns '{}' and '{header}' are the same thing", other.header));
        }
        columns.push(Column { at, header: header.to_string(), meaning, si });
    }
    Ok((columns, ignored))
}

/// What turns a column into SI units: its own unit, or else the one that is stated.
fn in_si(
    own: Option<Unit>,
    stated: Option<Unit>,
    header: &str,
    key: &str,
    of_name: &dyn Fn(&str) -> Option<Unit>,
) -> Checked<f64, String> {
    match (own, stated) {
        (Some(own), _) if of_name(own.name).is_none() => {
            Err(format!("column '{header}' cannot be in {}", own.name))
        }
        (Some(own), Some(stated)) if own != stated => Err(format!(
            "column '{header}' is in {}, but {key} is {}: correct one of them",
            own.name, stated.name
        )),
        (Some(unit), _) | (None, Some(unit)) => Ok(unit.si),
        (None, None) => Err(format!(
            "the unit of column '{header}' is not stated: write a line `# {key}: ...` above the table, \
             or give `edgeline compare` the option --{}",
            key.replace('_', "-")
        )),
    }
}

/// Rows as they become curves.
struct Table<'a> {
    case: &'a Case,
    path: &'a Path,
    columns: &'a [Column],
    body: Option<BodyKind>,
    axes: Axes,
    origin_m: [f64; 3],
    system: System,
    /// Whether the rows are pressures and not stresses.
    pressures: bool,
    /// The mesh of the rows so far.
    mesh: f64,
    /// Whether the rows have a place along the third axis.
    has_depths: bool,
    /// The names that stay the same.
    same: Vec<String>,
    curves: Curves,
    /// See [`BroughtFile::widths`].
    widths: Vec<Vec<f64>>,
}

impl<'a> Table<'a> {
    fn new(
        case: &'a Case,
        statements: &Statements,
        columns: &'a [Column],
        path: &'a Path,
        line: usize,
    ) -> Result<Self> {
        let refuse = |message: String| refuse(path, Some(line), message);
        let has = |of: &dyn Fn(Meaning) -> bool| columns.iter().any(|c| of(c.meaning));
        let stresses = has(&|m| matches!(m, Meaning::Stress(_)));
        let pressures = has(&|m| m == Meaning::Pressure);
        if stresses == pressures {
            let which = if stresses {
                "both stresses and a pressure"
            } else {
                "no column of a stress or a pressure"
            };
            return Err(refuse(format!(
                "has {which}: give sigma_xx to sigma_yz (also S11 or SX) in one file, p (also CPRESS) in another"
            )));
        }
        let axes = statements.axes.unwrap_or_default();
        let wanted = if pressures { 2 } else { 3 };
        for (axis, _) in &axes.0[..wanted] {
            if !has(&|m| m == Meaning::Place(*axis)) {
                let name = ["x", "y", "z"][*axis];
                return Err(refuse(format!(
                    "has no column {name}: give one, with 0 where all points have it"
                )));
            }
        }
        if stresses && statements.body.is_none() && !has(&|m| m == Meaning::Body) {
            let remedy = "give one with block or roller, or a line `# body: block` above the table";
            return Err(refuse(format!("has no column body: {remedy}")));
        }
        let first = columns.iter().find(|c| matches!(c.meaning, Meaning::Place(_)));
        let length = statements.length.map_or_else(|| first.map_or(1.0, |c| c.si), |u| u.si);
        Ok(Self {
            case,
            path,
            columns,
            body: statements.body,
            axes,
            origin_m: statements.origin.unwrap_or_default().map(|v| v * length),
            system: statements.system.unwrap_or(System::Bodies),
            pressures,
            mesh: f64::INFINITY,
            has_depths: has(&|m| m == Meaning::Place(axes.0[2].0)),
            same: vec![String::new(); columns.len()],
            curves: Curves { hertz: case.hertz(), pressure: Vec::new(), stress: Vec::new() },
            widths: Vec::new(),
        })
    }

    /// Takes in a row, which stands in this line.
    fn take(&mut self, record: &csv::StringRecord, line: Option<usize>) -> Result<()> {
        let path = self.path;
        let at = |column: &Column, message: String| {
            let place = format!("column {} ({}): {message}", column.at + 1, column.header);
            refuse(path, line, place)
        };
        let (mut place, mut stress, mut p) = ([0.0; 3], [f64::NAN; 6], f64::NAN);
        let (mut body, mut curve, mut mesh) = (self.body, POINTS.to_string(), None);
        let mut width = 0.0;
        for (column, same) in self.columns.iter().zip(&mut self.same) {
            // The reader refuses rows of another width than the header.
            let text = &record[column.at];
            let number = || match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value * column.si),
                // Some programs write the decimals of some languages.
                _ if text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok() => Err(
                    at(column, format!("'{text}' has a comma: write its decimals after a point")),
                ),
                _ => Err(at(column, format!("'{text}' is not a finite number"))),
            };
            let stress_pa = || match number()? {
                value if value.abs() <= MOST_PA => Ok(value),
                _ => {
                    let message = format!("'{text}' is more than {MOST_PA:e} Pa: check the unit");
                    Err(at(column, message))
                }
            };
            match column.meaning {
                Meaning::Place(axis) => place[axis] = number()?,
                Meaning::Width(axis) if axis == self.axes.0[0].0 => width = number()?.abs(),
                Meaning::Width(_) => {}
                Meaning::Stress(i) => stress[i] = stress_pa()?,
                Meaning::Pressure => p = stress_pa()?,
                Meaning::Mesh => mesh = Some(number()?),
                Meaning::Curve if text.is_empty() => {}
                Meaning::Curve => curve = text.to_string(),
                Meaning::Body => {
                    let unknown = || at(column, format!("'{text}' is neither block nor roller"));
                    body = Some(body_of(text).ok_or_else(unknown)?);
                }
                Meaning::Same if same.is_empty() => *same = text.to_string(),
                Meaning::Same if same == text => {}
                Meaning::Same => {
                    return Err(at(
                        column,
                        format!("'{text}' after '{same}': give one file for each"),
                    ));
                }
            }
        }
        if let Some(mesh) = mesh {
            if mesh > self.mesh {
                return Ok(());
            }
            if mesh < self.mesh {
                // All rows so far are of a coarser mesh.
                (self.curves.pressure, self.curves.stress) = Default::default();
                self.widths.clear();
                self.mesh = mesh;
            }
        }
        let place = self.axes.turn(std::array::from_fn(|i| place[i] - self.origin_m[i]));
        let added = if self.pressures {
            self.add_pressure(curve, place, width, p)
        } else {
            let stress = self.axes.turn_stress(&StressTensor::from_components(stress));
            self.add_stress(body.expect("a column or a statement"), curve, place, stress)
        };
        added.map_err(|message| refuse(path, line, message))
    }

    fn add_pressure(
        &mut self,
        name: String,
        [x_m, y_m, z_m]: [f64; 3],
        width_m: f64,
        p_pa: f64,
    ) -> Checked<(), String> {
        let at_m = [x_m, y_m];
        if self.has_depths && p_pa != 0.0 && z_m.abs() > OFF_SURFACE * self.curves.hertz.c_m {
            let z = stated(z_m);
            return Err(format!(
                "in our axes z = {z} m is not on the contact: state axes and origin, as in `# axes: x z -y`"
            ));
        }
        // One body may be longer than the other, and nothing presses there.
        let on = |body| self.moved_inside(body, [at_m[0], at_m[1], 0.0]);
        on(BodyKind::Roller).or_else(|_| on(BodyKind::Block))?;
        let Curves { hertz, pressure, .. } = &mut self.curves;
        let known = pressure.iter().position(|line| line.name == name);
        let place = known.unwrap_or_else(|| {
            let (at, p) = (Vec::new(), Vec::new());
            pressure.push(PressureLine { name, at, p, own_error: None });
            self.widths.push(Vec::new());
            pressure.len() - 1
        });
        let line = &mut pressure[place];
        self.widths[place].push(width_m / hertz.c_m);
        let [x, mut y] = at_m.map(|v| v / hertz.c_m);
        // Beyond the end by rounding there would be no pressure.
        for end in self.case.overlap() {
            if (y - end).abs() < END {
                y = end;
            }
        }
        line.at.push([x, y]);
        line.p.push(p_pa / hertz.p0_pa);
        Ok(())
    }

    fn add_stress(
        &mut self,
        body: BodyKind,
        name: String,
        mut at_m: [f64; 3],
        mut stress: StressTensor,
    ) -> Checked<(), String> {
        if self.system == System::Space {
            if body == BodyKind::Roller {
                at_m[2] = -at_m[2];
                stress = stress.mirrored(StressTensor::ODD_IN_Z);
            }
            at_m[2] -= surface_m(self.case, body, at_m[0]);
        }
        let at_m = self.moved_inside(body, at_m)?;
        let Curves { hertz, stress: curves, .. } = &mut self.curves;
        let curve = match curves.iter().position(|c| c.body == body && c.name == name) {
            Some(i) => &mut curves[i],
            None => {
                let (at, stress) = (Vec::new(), Vec::new());
                curves.push(StressCurve { body, name, at, stress, own_error: None });
                curves.last_mut().expect("just added")
            }
        };
        curve.at.push(at_m.map(|v| v / hertz.c_m));
        curve.stress.push(stress * (1.0 / hertz.p0_pa));
        Ok(())
    }

    /// The point, moved back into the body where rounding has moved it out.
    fn moved_inside(&self, body: BodyKind, mut at_m: [f64; 3]) -> Checked<[f64; 3], String> {
        let (extent, c_m) = (Extent::of(self.case, body), self.curves.hertz.c_m);
        let [from, to] = extent.ends_m();
        let y = at_m[1].clamp(from, to);
        if (y - at_m[1]).abs() <= ROUNDING * c_m {
            at_m[1] = y;
        }
        if (-ROUNDING * c_m..SURFACE * c_m).contains(&at_m[2]) {
            at_m[2] = 0.0;
        }
        extent.check(at_m).map(|()| at_m).map_err(|outside| {
            let Outside { axis, value_m, reason, remedy } = outside;
            let value = stated(value_m);
            format!(
                "in our axes {axis} = {value} m {reason}: {remedy}, or state units, axes and origin"
            )
        })
    }

    /// The curves, the widths of their cells and the number of points.
    fn finish(self) -> Result<(Curves, Vec<Vec<f64>>, usize)> {
        let pressures = self.curves.pressure.iter().map(|line| line.at.len());
        let points = pressures.chain(self.curves.stress.iter().map(|c| c.at.len())).sum();
        if points == 0 {
            return Err(refuse(self.path, None, "holds no points".to_string()));
        }
        if self.pressures {
            let [from, to] = self.case.overlap();
            let on = |[x, y]: &[f64; 2]| x.abs() <= NEAR && (from..=to).contains(y);
            let one_place = |line: &&PressureLine| {
                line.at.len() > 1 && line.at.iter().all(|at| *at == line.at[0])
            };
            if let Some(PressureLine { name, at, .. }) = self.curves.pressure.iter().find(one_place)
            {
                let message = format!(
                    "has all {} pressures of '{name}' at one x and y in our axes: check axes and origin",
                    at.len()
                );
                return Err(refuse(self.path, None, message));
            }
            if !self.curves.pressure.iter().any(|line| line.at.iter().any(on)) {
                let [from, to] = self.case.overlap_m().map(stated);
                let message = format!(
                    "has no point on the contact, which has x = 0 and y from {from} to {to} m in our axes: \
                     check units, axes and origin"
                );
                return Err(refuse(self.path, None, message));
            }
        }
        Ok((self.curves, self.widths, points))
    }
}

/// How far a body's unloaded surface lies below the tangent plane at `x_m`, into the body (m).
fn surface_m(case: &Case, body: BodyKind, x_m: f64) -> f64 {
    let radius_m = match body {
        BodyKind::Roller => Some(case.roller.radius_m),
        BodyKind::Block => case.block.radius_m,
    };
    radius_m.map_or(0.0, |r| x_m * x_m / (r + r.signum() * (r * r - x_m * x_m).max(0.0).sqrt()))
}
