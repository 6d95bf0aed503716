//! Heights from files: numpy's arrays, CSV and x3p.

use super::heights::Heights;
#[cfg(feature = "cli")]
use super::x3p;
use crate::base::{Error, Result};
use crate::host::{MARK, check_memory};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Larger files are refused unread (bytes): more samples than cells can be.
const MOST_BYTES: u64 = 1 << 30;

/// Bytes for each byte of a file: itself and the numbers in it.
const COPIES: f64 = 3.0;

/// The shape of an array, and its values, those of the last index next to each other.
type Array = ([usize; 2], Vec<f64>);

/// Formats that are read, for messages.
const FORMATS: &str = "give a two-dimensional array of floats of 32 or 64 bits as .npy, .csv with a \
                       row for each x, its heights between commas, semicolons or blanks and with \
                       decimal points, or .x3p";

/// Letters of a word that an error shows.
const SHOWN: usize = 24;

impl Heights {
    /// Reads the heights (m) in a file, an array of the shape (nx, ny): .npy with 32 or 64-bit
    /// floats, .csv with a line for each x, or .x3p (ISO 25178-72), which has its own distances of
    /// the samples. Other formats go through SurfaceTopography, whose `Topography.heights()` numpy
    /// saves.
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read, [`Error::File`] and [`Error::Memory`] before a file is
    /// read that is too large, and [`Error::File`] when it has another format or other numbers than
    /// [`Heights::new`] takes.
    pub fn read(path: &Path, steps_m: [f64; 2]) -> Result<Self> {
        let io = |source| Error::Io { action: "read", path: path.to_path_buf(), source };
        let too_large = |has: String| Error::File {
            path: path.to_path_buf(),
            line: None,
            message: format!("has {has} bytes; at most {MOST_BYTES} are read"),
            remedy: "cut out the part within the contact, or keep every second sample".into(),
        };
        crate::host::remember_input(path);
        let file = File::open(path).map_err(io)?;
        let bytes = file.metadata().map_err(io)?.len();
        if bytes > MOST_BYTES {
            return Err(too_large(bytes.to_string()));
        }
        check_memory(
            &format!("the surface {}", path.display()),
            COPIES * bytes as f64,
            "give fewer samples",
        )?;
        // A pipe or a device has no length of its own.
        let mut content = Vec::new();
        file.take(MOST_BYTES + 1).read_to_end(&mut content).map_err(io)?;
        if content.len() as u64 > MOST_BYTES {
            return Err(too_large("more".to_string()));
        }
        Self::parse(&content, path, steps_m)
    }

    /// Reads the `content` of a file; the name of its `path` says in which format.
    ///
    /// # Errors
    /// [`Error::File`] when it has another format or other numbers than [`Heights::new`] takes.
    pub fn parse(content: &[u8], path: &Path, steps_m: [f64; 2]) -> Result<Self> {
        let refuse = |(line, message): (Option<usize>, String)| Error::File {
            path: path.to_path_buf(),
            line,
            message,
            remedy: FORMATS.to_string(),
        };
        #[cfg(feature = "cli")]
        if Self::has_steps(path) {
            let (shape, own_m, values) = x3p::read(content).map_err(|e| refuse((None, e)))?;
            return Self::new(shape, own_m, values).map_err(|e| within(path, e));
        }
        let is_csv = has_extension(path, "csv");
        let read = if is_csv { csv(content) } else { npy(content).map_err(|e| (None, e)) };
        let (shape, values) = read.map_err(refuse)?;
        Self::new(shape, steps_m, values).map_err(|e| within(path, e))
    }

    /// Whether a file of this name has the distances of its samples itself.
    pub fn has_steps(path: &Path) -> bool {
        cfg!(feature = "cli") && has_extension(path, "x3p")
    }
}

/// An error of the heights in the file at `path`, which is the one to change.
fn within(path: &Path, error: Error) -> Error {
    let Error::Value { key, value, reason, remedy } = error else { return error };
    let message = format!("{key} = {value} is not valid: {reason}");
    Error::File { path: path.to_path_buf(), line: None, message, remedy }
}

fn has_extension(path: &Path, name: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(name))
}

/// The words of a line: between semicolons or else commas, and without either between blanks.
fn words(line: &str) -> Vec<&str> {
    match [';', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The array of lines of numbers; or the line that is none, and what is wrong.
fn csv(content: &[u8]) -> std::result::Result<Array, (Option<usize>, String)> {
    let text = std::str::from_utf8(content).map_err(|_| (None, "is not text".to_string()))?;
    let text = text.strip_prefix(MARK).unwrap_or(text);
    let (mut values, mut columns, mut rows) = (Vec::new(), None, 0);
    let is_left_out = |line: &str| line.is_empty() || line.starts_with('#');
    let lines = text.lines().map(str::trim).enumerate();
    for (i, line) in lines.filter(|(_, line)| !is_left_out(line)) {
        let before = values.len();
        for word in words(line) {
            let value = word.parse().ok().filter(|height: &f64| height.is_finite());
            values.push(value.ok_or_else(|| {
                let shown: String = word.chars().take(SHOWN).collect();
                (Some(i + 1), format!("has '{shown}' where a finite height belongs"))
            })?);
        }
        let own = values.len() - before;
        if *columns.get_or_insert(own) != own {
            let message =
                format!("has {own} heights where the first line has {}", columns.unwrap_or(0));
            return Err((Some(i + 1), message));
        }
        rows += 1;
    }
    Ok(([rows, columns.unwrap_or(0)], values))
}

/// The array of numpy's format (versions 1 to 3), or what is wrong.
fn npy(content: &[u8]) -> std::result::Result<Array, String> {
    let broken = || "is not an array that numpy wrote".to_string();
    let version =
        *content.strip_prefix(b"\x93NUMPY").and_then(|rest| rest.first()).ok_or_else(broken)?;
    let part = |from: usize, count: usize| content.get(from..from.checked_add(count)?);
    let (start, length) = match version {
        1 => (10, part(8, 2).map(|b| u64::from(u16::from_le_bytes([b[0], b[1]])))),
        _ => (12, part(8, 4).map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))),
    };
    let length = length.ok_or_else(broken)? as usize;
    let header =
        part(start, length).and_then(|h| std::str::from_utf8(h).ok()).ok_or_else(broken)?;
    let field = |key: &str| {
        let rest = header.split_once(&format!("'{key}':"))?.1.trim_start();
        let end = if rest.starts_with('(') { rest.find(')')? + 1 } else { rest.find([',', '}'])? };
        Some(rest[..end].trim())
    };
    let [kind, order, shape] =
        ["descr", "fortran_order", "shape"].map(|key| field(key).ok_or_else(broken));
    let (kind, order, shape) = (kind?.trim_matches('\''), order?, shape?);
    let counts = shape.trim_matches(['(', ')']).split(',').map(|n| n.trim().parse::<usize>());
    let [Ok(nx), Ok(ny)] = counts.collect::<Vec<_>>()[..] else {
        return Err(format!("has an array of the shape {shape}"));
    };
    if nx == 0 || ny == 0 {
        return Err(format!("has an empty array of the shape {shape}"));
    }
    let data = &content[start + length..];
    let size = match kind {
        "<f8" | ">f8" => 8,
        "<f4" | ">f4" => 4,
        _ => return Err(format!("has numbers of the type {kind}")),
    };
    if nx.checked_mul(ny).and_then(|n| n.checked_mul(size)) != Some(data.len()) {
        return Err(format!("has {} bytes of data for the shape {shape}", data.len()));
    }
    let value = |at: usize| {
        let mut own = [0; 8];
        let own = &mut own[..size];
        own.copy_from_slice(&data[at * size..][..size]);
        if kind.starts_with('>') {
            own.reverse();
        }
        match (&*own).try_into() {
            Ok(eight) => f64::from_le_bytes(eight),
            Err(_) => f64::from(f32::from_le_bytes([own[0], own[1], own[2], own[3]])),
        }
    };
    let place = |i: usize, j: usize| if order == "True" { j * nx + i } else { i * ny + j };
    let all = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    Ok(([nx, ny], all.map(|(i, j)| value(place(i, j))).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An array in numpy's format 1.0.
    fn array(kind: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let header =
            format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(data);
        bytes
    }

    fn read(name: &str, content: &[u8]) -> Result<Heights> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        Heights::read(&path, [1.0, 1.0])
    }

    #[test]
    fn both_orders_and_formats_are_one_surface() {
        let rows: Vec<u8> =
            [0.0, 1.0, 2.0, 10.0, 11.0, 12.0f64].iter().flat_map(|v| v.to_le_bytes()).collect();
        let columns: Vec<u8> =
            [0.0, 10.0, 1.0, 11.0, 2.0, 12.0f32].iter().flat_map(|v| v.to_le_bytes()).collect();
        let others: Vec<u8> =
            [0.0, 1.0, 2.0, 10.0, 11.0, 12.0f64].iter().flat_map(|v| v.to_be_bytes()).collect();
        let want = Heights::new([2, 3], [1.0; 2], vec![0.0, 1.0, 2.0, 10.0, 11.0, 12.0]).unwrap();
        for (name, content) in [
            ("a.npy", array("<f8", "False", "(2, 3)", &rows)),
            ("b.npy", array("<f4", "True", "(2, 3)", &columns)),
            ("d.npy", array(">f8", "False", "(2, 3)", &others)),
            ("c.CSV", b"\xef\xbb\xbf0, 1, 2\n10,11,12e0\n\n".to_vec()),
        ] {
            assert_eq!(read(name, &content).unwrap(), want, "{name}");
        }
    }

    #[test]
    fn what_is_no_surface_is_refused_with_its_place() {
        let data = [0; 32];
        for (name, content, wanted) in [
            ("a.npy", b"hello".to_vec(), "not an array that numpy wrote"),
            ("a.npy", b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), "not an array"),
            ("a.npy", array("<f8", "False", "(4,)", &data), "shape (4,)"),
            ("a.npy", array("<f8", "False", "(2, x, 2)", &data), "shape (2, x, 2)"),
            ("a.npy", array("<f8", "False", "(18446744073709551615, 0)", &[]), "an empty array"),
            (
                "a.npy",
                array("<f2", "False", "(4, 4)", &data),
                "type <f2; give a two-dimensional array of floats of 32 or 64 bits",
            ),
            (
                "a.npy",
                array("<f8", "False", "(2, 3)", &data),
                "32 bytes of data for the shape (2, 3)",
            ),
            (
                "a.npy",
                array("<f8", "False", "(2, 2)", &f64::NAN.to_le_bytes().repeat(4)),
                "a.npy: heights = NaN at [0, 0] is not valid",
            ),
            ("a.csv", b"1,2\n3\n".to_vec(), "a.csv:2: has 1 heights"),
            ("a.csv", b"1,2\n3,x\n".to_vec(), "a.csv:2: has 'x'"),
            ("a.csv", b"0,1;0,2\n".to_vec(), "a.csv:1: has '0,1' where"),
            (
                "a.csv",
                [&b"1 2\n"[..], &[b'x'; 5000]].concat(),
                "has 'xxxxxxxxxxxxxxxxxxxxxxxx' where",
            ),
            ("a.csv", b"1,2\n\n3,nan\n".to_vec(), "a.csv:3: has 'nan' where a finite height"),
            ("a.csv", b"\xff".to_vec(), "not text"),
            ("a.csv", b"1\n".to_vec(), "a.csv: heights = 1 x 1 with 1 values is not valid"),
            ("a.csv", b"".to_vec(), "0 x 0"),
        ] {
            let said = read(name, &content).unwrap_err().to_string();
            assert!(said.contains(wanted), "{said}");
        }
        let said = Heights::read(Path::new("/nowhere.npy"), [1.0; 2]).unwrap_err().to_string();
        assert!(said.contains("cannot read /nowhere.npy"), "{said}");
    }
}
