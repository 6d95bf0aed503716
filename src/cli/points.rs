//! The file of points that `edgeline solve --points` takes.

use crate::base::number::stated;
use crate::base::{Error, Result};
use crate::case::{Case, unknown_word};
use crate::host::{check_memory, csv_fault, csv_line, other_separators, read_input};
use crate::solve::{Extent, Outside, Point};
use crate::stress::BodyKind;
use serde::Deserialize;
use std::path::Path;

/// Larger files are refused without reading them (bytes).
const MAX_BYTES: u64 = 8 << 30;

/// Memory of a point and its stress, and the least length of its row in the file (bytes).
const POINT_BYTES: f64 = 500.0;
const ROW_BYTES: f64 = 40.0;

/// One row of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    body: BodyKind,
    x_m: f64,
    y_m: f64,
    z_m: f64,
}

/// The columns, which may stand in any order.
const COLUMNS: [&str; 4] = ["body", "x_m", "y_m", "z_m"];

/// Reads points from a CSV file with the columns `body,x_m,y_m,z_m`, all within the bodies of
/// `case`. Lines that begin with `#` are comments.
///
/// # Errors
/// [`Error::File`] with the line of the first row that is not such a point, [`Error::Memory`] when
/// the points need more memory than there is, [`Error::Io`].
pub(super) fn read(path: &Path, case: &Case) -> Result<Vec<Point>> {
    let size = std::fs::metadata(path).map_or(0, |m| m.len());
    check_memory(
        &format!("what {} asks for", path.display()),
        size as f64 * (1.0 + POINT_BYTES / ROW_BYTES),
        "split the file",
    )?;
    parse(&read_input(path, MAX_BYTES, "split the file")?, path, case)
}

/// Parses the text of a file of points; `path` is only named in errors.
///
/// # Errors
/// As `--points`: [`Error::File`] with the line of the first row that is not a point in a body of
/// `case`.
pub fn parse(text: &str, path: &Path, case: &Case) -> Result<Vec<Point>> {
    let refuse = |line: Option<usize>, message: String| Error::File {
        path: path.to_path_buf(),
        line,
        message,
        remedy: "give the columns body,x_m,y_m,z_m: block or roller, and metres; z is the depth \
                 into that body"
            .into(),
    };
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let line_of = |at: &csv::Position| csv_line(text, at);
    let of_csv = |e: csv::Error| refuse(e.position().map(line_of), csv_fault(&e));
    let header = reader.headers().map_err(of_csv)?.clone();
    let mut sorted: Vec<&str> = header.iter().collect();
    sorted.sort_unstable();
    if sorted != COLUMNS {
        let names = header.iter().collect::<Vec<_>>().join(",");
        let message = match other_separators(&names) {
            Some(message) => format!("{message}, where commas are read"),
            None => format!("has the columns {names}"),
        };
        return Err(refuse(header.position().map(line_of), message));
    }
    let mut points = Vec::new();
    for record in reader.records() {
        let record = record.map_err(of_csv)?;
        let line = record.position().map(line_of);
        let row: Row = record.deserialize(Some(&header)).map_err(|e| {
            let fault = csv_fault(&e);
            refuse(
                line,
                unknown_word(&fault).map_or(fault, |(word, known)| format!("{word}; {known}")),
            )
        })?;
        let at_m = [row.x_m, row.y_m, row.z_m];
        Extent::of(case, row.body).check(at_m).map_err(|outside| {
            let Outside { axis, value_m, reason, remedy } = outside;
            refuse(line, format!("{axis}_m = {} {reason}: {remedy}", stated(value_m)))
        })?;
        points.push(Point { body: row.body, at_m });
    }
    if points.is_empty() {
        return Err(refuse(None, "holds no points".into()));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Vec<Point>> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read(file.path(), &Case::find(Path::new("half-short")).unwrap())
    }

    #[test]
    fn points_are_read_in_their_order() {
        let text = "# mine\nx_m,y_m,z_m,body\n0, 1e-4,0,roller\n# a\n1e-4,-0.002,3e-4,block\n";
        let points = read_text(text).unwrap();
        let wanted = [
            Point { body: BodyKind::Roller, at_m: [0.0, 1e-4, 0.0] },
            Point { body: BodyKind::Block, at_m: [1e-4, -0.002, 3e-4] },
        ];
        assert_eq!(points, wanted);
    }

    #[test]
    fn bad_points_are_refused_with_their_line() {
        let head = "body,x_m,y_m,z_m\nblock,0,0,0\n";
        for (row, wanted) in [
            ("block,0,0", ":3: has 3 cells where the header has 4; give the columns"),
            ("blok,0,0,0", ":3: unknown name blok; did you mean block? There are block, roller;"),
            ("block,0,zero,0", ":3: "),
            ("block,nan,0,0", ":3: x_m = NaN is not a finite number"),
            ("block,0,0,-1e-9", ":3: z_m = -1e-9 is outside the block"),
            ("block,0,1,0", ":3: y_m = 1 is outside the block"),
            ("roller,0,0.002,0", ":3: y_m = 0.002 is outside the roller"),
            ("roller,0,0,0.0201", ":3: z_m = 0.0201 is outside the roller"),
        ] {
            let message = read_text(&format!("{head}{row}\n")).unwrap_err().to_string();
            assert!(message.contains(wanted), "{row}: {message}");
            assert!(message.contains("give the columns"), "{row}: {message}");
        }
        let late =
            read_text("# mine\nbody,x_m,y_m,z_m\n\n# a\nblock,0,0,-1\n").unwrap_err().to_string();
        assert!(late.contains(":5: z_m = "), "{late}");
        let said = read_text("body;x_m;y_m;z_m\nblock;0;0;0\n").unwrap_err().to_string();
        assert!(said.contains(":1: has semicolons between its columns"), "{said}");
        for header in ["body,x_m,y_m", "body,x,y,z", "body,x_m,y_m,z_m,z_m"] {
            let said =
                read_text(&format!("# mine\n{header}\nblock,0,0\n")).unwrap_err().to_string();
            assert!(said.contains(&format!(":2: has the columns {header}; give the")), "{said}");
        }
        assert!(
            read_text(head.lines().next().unwrap()).unwrap_err().to_string().contains("no points")
        );
    }
}
