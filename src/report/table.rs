//! Tables as CSV files. A row is a struct; one list says which columns each of its fields takes,
//! and rows are written and read by that list.

use crate::base::number::significant;
use crate::base::{Error, Result};
use crate::host::{check_memory, csv_fault, read_text};
use crate::study::Range;
use serde::Serialize;
use serde::de::{DeserializeOwned, IntoDeserializer, value};
use serde_json::Value;
use std::iter::Enumerate;
use std::path::Path;
use std::slice::Iter;

/// A value of one cell.
pub trait Cell: Sized {
    /// Its text.
    fn text(&self) -> String;

    /// The value of a text; `None` where it is no such value.
    fn parse(text: &str) -> Option<Self>;
}

/// What takes one or more neighbouring cells of a row.
pub trait Cells: Sized {
    /// The cells' texts.
    fn write(&self) -> Vec<String>;

    /// The value of the cells; `None` where they hold none.
    fn read(cells: &[&str]) -> Option<Self>;
}

/// What the columns of a table depend on.
#[derive(Debug, Clone, Copy)]
pub struct Layout<'a> {
    /// The range of the errors.
    pub range: &'a Range,
    /// The names of the factors that a study varies beside W, S_l and L_r.
    pub further: &'a [String],
    /// Whether effects have aliases.
    pub aliases: bool,
}

impl<'a> From<&'a Range> for Layout<'a> {
    fn from(range: &'a Range) -> Self {
        Self { range, further: &[], aliases: false }
    }
}

/// A row of a table. The macro `columns!` implements it.
pub trait Row: Sized {
    /// The names of the columns that each field takes.
    fn columns(layout: Layout) -> Vec<Vec<String>>;

    /// The texts of each field.
    fn cells(&self) -> Vec<Vec<String>>;

    /// Reads the cells of each field.
    ///
    /// # Errors
    /// The number of the field whose cells hold no such value.
    fn from_cells(fields: &[&[&str]]) -> std::result::Result<Self, usize>;
}

/// Implements [`Row`] for a struct by the list of its fields in the order of the file. A field is
/// the column of its name; `field => [names]` names its columns, which may depend on the
/// [`Layout`]. [`Short`] writes the number of `field as Short`.
macro_rules! columns {
    ($row:ty, $layout:ident, { $($field:ident $(as $form:ident)? $(=> $names:expr)?,)* }) => {
        impl $crate::report::table::Row for $row {
            fn columns($layout: $crate::report::table::Layout) -> Vec<Vec<String>> {
                vec![$(
                    $crate::report::table::columns!(@names $field $(, $names)?)
                        .into_iter()
                        .map(String::from)
                        .collect()
                ),*]
            }

            fn cells(&self) -> Vec<Vec<String>> {
                vec![$($crate::report::table::Cells::write(
                    &$crate::report::table::columns!(@form self.$field.clone() $(, $form)?)
                )),*]
            }

            fn from_cells(fields: &[&[&str]]) -> std::result::Result<Self, usize> {
                let mut fields = fields.iter().enumerate();
                $(
                    let $crate::report::table::columns!(@bind $field $(, $form)?) =
                        $crate::report::table::next(&mut fields)?;
                )*
                Ok(Self { $($field),* })
            }
        }
    };
    (@names $field:ident) => { [stringify!($field)] };
    (@names $field:ident, $names:expr) => { $names };
    (@bind $field:ident) => { $field };
    (@bind $field:ident, $form:ident) => { $crate::report::table::$form($field) };
    (@form $value:expr) => { $value };
    (@form $value:expr, $form:ident) => { $crate::report::table::$form($value) };
}
pub(super) use columns;

/// Reads the next field.
///
/// # Errors
/// Its number, when its cells hold no such value.
pub(super) fn next<T: Cells>(
    fields: &mut Enumerate<Iter<&[&str]>>,
) -> std::result::Result<T, usize> {
    let (number, cells) = fields.next().ok_or(0usize)?;
    T::read(cells).ok_or(number)
}

impl<T: Cell> Cells for T {
    fn write(&self) -> Vec<String> {
        vec![self.text()]
    }

    fn read(cells: &[&str]) -> Option<Self> {
        let [cell] = cells else { return None };
        T::parse(cell)
    }
}

impl<T: Cell, const N: usize> Cells for [T; N] {
    fn write(&self) -> Vec<String> {
        self.iter().map(Cell::text).collect()
    }

    fn read(cells: &[&str]) -> Option<Self> {
        Vec::<T>::read(cells)?.try_into().ok()
    }
}

impl<T: Cell> Cells for Vec<T> {
    fn write(&self) -> Vec<String> {
        self.iter().map(Cell::text).collect()
    }

    fn read(cells: &[&str]) -> Option<Self> {
        cells.iter().map(|cell| T::parse(cell)).collect()
    }
}

/// Seven significant digits; what is not a finite number is empty.
impl Cell for f64 {
    fn text(&self) -> String {
        number(*self)
    }

    fn parse(text: &str) -> Option<Self> {
        if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() }
    }
}

/// A number that was given or computed from such ones: ten significant digits, fewer than rounding
/// leaves, and no more than it has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Short(pub f64);

impl Cell for Short {
    fn text(&self) -> String {
        significant(self.0, 10)
    }

    fn parse(text: &str) -> Option<Self> {
        text.parse().ok().map(Self)
    }
}

/// Nothing is an empty cell.
impl<T: Cell> Cell for Option<T> {
    fn text(&self) -> String {
        self.as_ref().map(Cell::text).unwrap_or_default()
    }

    fn parse(text: &str) -> Option<Self> {
        if text.is_empty() { Some(None) } else { T::parse(text).map(Some) }
    }
}

/// Cells by `Display` and `FromStr`.
macro_rules! by_text {
    ($($plain:ty),*) => { $(
        impl Cell for $plain {
            fn text(&self) -> String {
                self.to_string()
            }

            fn parse(text: &str) -> Option<Self> {
                text.parse().ok()
            }
        }
    )* };
}

by_text!(String, bool, u64, usize);

/// Implements [`Cell`] by the names that serde gives the values.
macro_rules! by_name {
    ($($named:ty),*) => { $(
        impl $crate::report::table::Cell for $named {
            fn text(&self) -> String {
                $crate::report::table::name(self)
            }

            fn parse(text: &str) -> Option<Self> {
                $crate::report::table::from_name(text)
            }
        }
    )* };
}
pub(super) use by_name;

/// The name of a value in files.
pub(super) fn name(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(name)) => name,
        other => panic!("a name is a text, not {other:?}"),
    }
}

/// The value of a name.
pub(super) fn from_name<T: DeserializeOwned>(name: &str) -> Option<T> {
    T::deserialize::<value::StrDeserializer<value::Error>>(name.into_deserializer()).ok()
}

/// Rows as CSV, with a header.
pub fn to_csv<'a, R: Row>(rows: &[R], layout: impl Into<Layout<'a>>) -> String {
    let header = R::columns(layout.into()).concat();
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory fails only for rows of another width than the header.
    writer.write_record(&header).expect("a vector takes all bytes");
    for row in rows {
        writer.write_record(row.cells().concat()).expect("a row as wide as the header");
    }
    let bytes = writer.into_inner().expect("a vector takes all bytes");
    String::from_utf8(bytes).expect("text in, text out")
}

/// Reads rows from the text of a CSV file that stands at `path`.
///
/// # Errors
/// [`Error::File`] with the line where the file has other columns, or a cell holds no such value.
pub fn from_csv<'a, R: Row>(
    text: &str,
    path: &Path,
    layout: impl Into<Layout<'a>>,
) -> Result<Vec<R>> {
    let refuse = |line: Option<u64>, message: String| Error::File {
        path: path.to_path_buf(),
        line: line.map(|l| l as usize),
        message,
        remedy: "run the study again".to_string(),
    };
    let columns = R::columns(layout.into());
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let of_csv = |e: csv::Error| refuse(e.position().map(|p| p.line()), csv_fault(&e));
    let header = reader.headers().map_err(of_csv)?;
    let wanted = columns.concat();
    if let Some(missing) = wanted.iter().find(|name| !header.iter().any(|h| h == *name)) {
        return Err(refuse(Some(1), format!("has no column {missing}")));
    }
    if !header.iter().eq(&wanted) {
        return Err(refuse(Some(1), "has other columns, or in another order".to_string()));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(of_csv)?;
        let cells: Vec<&str> = record.iter().collect();
        let mut rest = &cells[..];
        let fields: Vec<&[&str]> = columns
            .iter()
            .map(|names| {
                let (field, after) = rest.split_at(names.len());
                rest = after;
                field
            })
            .collect();
        rows.push(R::from_cells(&fields).map_err(|field| {
            let line = record.position().map(|p| p.line());
            let (names, cells) = (columns[field].join(", "), fields[field].join(", "));
            refuse(line, format!("{names} cannot be '{cells}'"))
        })?);
    }
    Ok(rows)
}

/// A number for a CSV cell, seven significant digits; empty for what is not a finite number.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_string()
    } else if value.is_finite() {
        format!("{value:.6e}")
    } else {
        String::new()
    }
}

/// As [`number`], empty for `None`.
pub fn optional(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}

/// Larger files are refused, pipes and devices too, which do not tell their size (bytes).
const MAX_BYTES: u64 = 4 << 30;

/// Reads a text file of a run.
///
/// # Errors
/// [`Error::Io`] when it cannot be read, [`Error::Memory`] when it does not fit into memory, and
/// [`Error::File`] when it is not UTF-8.
pub fn read(path: &Path) -> Result<String> {
    let size = std::fs::metadata(path).map_or(0, |m| m.len());
    check_memory(&format!("reading {}", path.display()), size as f64, "give a smaller file")?;
    read_text(path, MAX_BYTES, "give a smaller file")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Source;

    #[derive(Debug, Clone, PartialEq)]
    struct Sample {
        name: String,
        source: Source,
        at: [f64; 2],
        level: f64,
        errors: Vec<Option<f64>>,
    }

    columns!(Sample, layout, {
        name,
        source,
        at => ["x", "y"],
        level as Short,
        errors => layout.range.pressure_c.iter().map(|c| format!("error_{c}C")),
    });

    fn sample() -> Sample {
        Sample {
            name: "with, comma and \"quote\"".to_string(),
            source: crate::body::EdgeModel::Mirror.into(),
            at: [-0.001_234_567_89, 0.0],
            level: 0.1,
            errors: vec![Some(f64::NAN), Some(2.0)],
        }
    }

    #[test]
    fn rows_survive_the_file() {
        let range = Range::default();
        let text = to_csv(&[sample()], &range);
        let line = "\"with, comma and \"\"quote\"\"\",mirror,-1.234568e-3,0,0.1,,2.000000e0";
        assert_eq!(text, format!("name,source,x,y,level,error_0.1C,error_0.2C\n{line}\n"));
        let back: Vec<Sample> = from_csv(&text, Path::new("t.csv"), &range).unwrap();
        let at = [-0.001_234_568, 0.0];
        assert_eq!(back, [Sample { at, errors: vec![None, Some(2.0)], ..sample() }]);
    }

    #[test]
    fn files_of_something_else_are_refused_with_their_place() {
        let range = Range::default();
        let text = to_csv(&[sample()], &range);
        let refused = |text: String, range: &Range| {
            from_csv::<Sample>(&text, Path::new("t.csv"), range).unwrap_err().to_string()
        };
        let one = Range { pressure_c: vec![0.3], ..Range::default() };
        for (said, wanted) in [
            (
                refused(text.replace("-1.234568e-3", "left"), &range),
                "t.csv:2: x, y cannot be 'left, 0'",
            ),
            (refused(text.replace("source", "from"), &range), "t.csv:1: has no column source"),
            (refused(text.replace("x,y", "y,x"), &range), "in another order"),
            (refused(text.clone(), &one), "has no column error_0.3C"),
            (refused(text.replace(",2.0", ",2.0,"), &range), ":2:"),
        ] {
            assert!(said.contains(wanted), "{said}");
        }
    }
}
