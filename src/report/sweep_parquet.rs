//! The rows of a sweep as Parquet: a finished CSV file of a sweep, converted in groups of rows, and
//! back.

use super::sweep::{TEXTS, header_names, line};
use super::table::number;
use crate::base::{Error, Result};
use csv::StringRecord;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::record::Field;
use parquet::schema::types::Type;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

/// Rows of a group, all of which are in memory.
const GROUP: usize = 1 << 16;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// The number of the row.
    Row,
    Text,
    Number,
}

impl Kind {
    fn of(name: &str) -> Self {
        match name {
            "row" => Kind::Row,
            name if TEXTS.contains(&name) => Kind::Text,
            _ => Kind::Number,
        }
    }

    fn field(self, name: &str) -> std::result::Result<Type, ParquetError> {
        let builder = |physical| Type::primitive_type_builder(name, physical);
        match self {
            Kind::Row => builder(Physical::INT64).with_repetition(Repetition::REQUIRED),
            Kind::Number => builder(Physical::DOUBLE).with_repetition(Repetition::OPTIONAL),
            Kind::Text => builder(Physical::BYTE_ARRAY)
                .with_logical_type(Some(LogicalType::String))
                .with_repetition(Repetition::OPTIONAL),
        }
        .build()
    }
}

/// Writes the rows of the CSV file `rows` of a sweep into `out`: numbers as they stand there, in
/// doubles; empty cells and what is no number in a column of numbers as null.
///
/// # Errors
/// [`Error::Io`] when a file cannot be read or written.
pub(super) fn write(rows: &Path, out: &Path) -> Result<()> {
    let failed = failure("write", out);
    let file = File::create(out).map_err(|e| failed(e.into()))?;
    let mut reader = csv::Reader::from_path(rows).map_err(|e| unread(rows, e))?;
    let names: Vec<String> =
        reader.headers().map_err(|e| unread(rows, e))?.iter().map(str::to_string).collect();
    let kinds: Vec<Kind> = names.iter().map(|name| Kind::of(name)).collect();
    let mut writer = writer(&names, &kinds, file).map_err(&failed)?;
    let mut records = reader.records();
    loop {
        let group = records.by_ref().take(GROUP).collect::<std::result::Result<Vec<_>, _>>();
        let group = group.map_err(|e| unread(rows, e))?;
        if group.is_empty() {
            break;
        }
        write_group(&mut writer, &kinds, &group).map_err(&failed)?;
    }
    let file = writer.into_inner().map_err(&failed)?;
    file.sync_all().map_err(|e| failed(e.into()))
}

fn writer(
    names: &[String],
    kinds: &[Kind],
    file: File,
) -> std::result::Result<SerializedFileWriter<File>, ParquetError> {
    let fields = names.iter().zip(kinds).map(|(name, kind)| kind.field(name).map(Arc::new));
    let schema = Type::group_type_builder("sweep")
        .with_fields(fields.collect::<std::result::Result<_, _>>()?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::LZ4_RAW)
        .set_created_by(format!("edgeline version {}", env!("CARGO_PKG_VERSION")));
    SerializedFileWriter::new(file, Arc::new(schema.build()?), Arc::new(properties.build()))
}

fn write_group(
    writer: &mut SerializedFileWriter<File>,
    kinds: &[Kind],
    rows: &[StringRecord],
) -> std::result::Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    for (i, kind) in kinds.iter().enumerate() {
        let column = group.next_column()?.expect("the schema has these columns");
        let cells = rows.iter().map(|row| row.get(i).unwrap_or_default());
        write_column(column, *kind, cells)?;
    }
    group.close().map(drop)
}

fn write_column<'a>(
    mut column: SerializedColumnWriter,
    kind: Kind,
    cells: impl Iterator<Item = &'a str>,
) -> std::result::Result<(), ParquetError> {
    match kind {
        Kind::Row => {
            let rows: Vec<i64> = cells.map(|cell| cell.parse().unwrap_or_default()).collect();
            column.typed::<Int64Type>().write_batch(&rows, None, None)?;
        }
        Kind::Number => {
            let (there, values) = nullable(cells.map(|cell| cell.parse::<f64>().ok()));
            column.typed::<DoubleType>().write_batch(&values, Some(&there), None)?;
        }
        Kind::Text => {
            let texts = cells.map(|cell| Some(ByteArray::from(cell)).filter(|_| !cell.is_empty()));
            let (there, values) = nullable(texts);
            column.typed::<ByteArrayType>().write_batch(&values, Some(&there), None)?;
        }
    }
    column.close()
}

/// For each cell whether there is a value, 1 or 0, and the values.
fn nullable<T>(cells: impl Iterator<Item = Option<T>>) -> (Vec<i16>, Vec<T>) {
    let mut values = Vec::new();
    let there = cells
        .map(|cell| {
            let there = i16::from(cell.is_some());
            values.extend(cell);
            there
        })
        .collect();
    (there, values)
}

/// Writes the rows of `out`, which [`write`] has made, into the CSV file `rows` again, where
/// `columns` are the sweep's own.
///
/// # Errors
/// [`Error::File`] when `out` is not the file of a sweep with these columns, [`Error::Io`] when a
/// file cannot be read or written.
pub(super) fn read(out: &Path, columns: &[String], rows: &Path) -> Result<()> {
    let foreign = |message: String| Error::File {
        path: out.to_path_buf(),
        line: None,
        message,
        remedy: "give another --out, or remove the file".into(),
    };
    let file = File::open(out).map_err(|e| failure("read", out)(e.into()))?;
    let reader = SerializedFileReader::new(file).map_err(|e| foreign(e.to_string()))?;
    let schema = reader.metadata().file_metadata().schema().clone();
    let names = header_names(columns);
    if !schema.get_fields().iter().map(|field| field.name()).eq(&names) {
        return Err(foreign("has the columns of something else".into()));
    }
    let io = |source| Error::Io { action: "write", path: rows.to_path_buf(), source };
    let mut csv = BufWriter::new(File::create(rows).map_err(io)?);
    csv.write_all(line(&names).as_bytes()).map_err(io)?;
    for row in reader.get_row_iter(None).map_err(|e| foreign(e.to_string()))? {
        let row = row.map_err(|e| foreign(e.to_string()))?;
        let cell = |(i, (_, field)): (usize, (&String, &Field))| match field {
            Field::Null => String::new(),
            Field::Str(text) => text.clone(),
            // The sweep's own numbers have all their digits.
            Field::Double(value) if i <= columns.len() => format!("{value:e}"),
            Field::Double(value) => number(*value),
            other => other.to_string(),
        };
        let cells: Vec<String> = row.get_column_iter().enumerate().map(cell).collect();
        csv.write_all(line(&cells).as_bytes()).map_err(io)?;
    }
    csv.flush().map_err(io)
}

/// Makes an error of one of Parquet.
fn failure(action: &'static str, path: &Path) -> impl Fn(ParquetError) -> Error {
    move |e| {
        let source = match e {
            ParquetError::External(source) => match source.downcast::<std::io::Error>() {
                Ok(source) => *source,
                Err(source) => std::io::Error::other(source),
            },
            e => std::io::Error::other(e),
        };
        Error::Io { action, path: path.to_path_buf(), source }
    }
}

fn unread(path: &Path, e: csv::Error) -> Error {
    Error::Io { action: "read", path: path.to_path_buf(), source: std::io::Error::other(e) }
}
