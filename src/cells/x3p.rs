//! Heights in the format x3p of ISO 25178-72: a zip archive with a description, main.xml, and the
//! heights.

use md5::{Digest, Md5};
use roxmltree::{Document, Node};
use std::io::{Cursor, Read};
use zip::ZipArchive;

/// What an x3p file holds: the shape (nx, ny), the distances of the samples along x and y (m), and
/// the heights (m), those of the last index next to each other.
pub(super) type Samples = ([usize; 2], [f64; 2], Vec<f64>);

/// More samples than cells can be: an archive may hold far more than it weighs.
const MOST_SAMPLES: usize = 1 << 27;

/// The feature type of heights on a grid; others are profiles (PRF) and clouds of points (PCL).
const SURFACE: &str = "SUR";

/// Rotations of the axes by less than this (rad) are none: over a million samples nothing moves by
/// more than one.
const LEAST_TURN: f64 = 1e-6;

/// Most bytes of the description, and of each height.
const MOST_TEXT: u64 = 16 << 20;
const MOST_BYTES: u64 = 24;

/// The samples of an x3p file, or what is wrong with it. Lengths are in metres, as the format has
/// them; heights that are missing become NaN.
pub(super) fn read(content: &[u8]) -> Result<Samples, String> {
    let mut archive =
        ZipArchive::new(Cursor::new(content)).map_err(|e| format!("is no zip archive: {e}"))?;
    let text = part(&mut archive, "main.xml", MOST_TEXT)?;
    let text =
        String::from_utf8(text).map_err(|_| "has a main.xml that is not text".to_string())?;
    let document = Document::parse(&text).map_err(|e| format!("has a broken main.xml: {e}"))?;
    let root = document.root_element();
    if let Ok(kind) = find(root, "FeatureType").map(word)
        && kind != SURFACE
    {
        return Err(format!("has a FeatureType '{kind}', not {SURFACE}: no surface on a grid"));
    }
    let axes = find(root, "Axes")?;
    unturned(axes)?;
    let steps = [increment(find(axes, "CX")?)?, increment(find(axes, "CY")?)?];
    let height = find(axes, "CZ")?;
    let kind = word(find(height, "DataType")?);
    // Whole numbers count increments; other ones are lengths.
    let scale = match kind {
        "I" | "L" => increment(height)?,
        _ => 1.0,
    };
    let offset = number(height, "Offset").unwrap_or(0.0);
    let size = find(root, "MatrixDimension")?;
    let count = |name: &str| -> Result<usize, String> {
        let node = find(size, name)?;
        word(node).parse().map_err(|_| format!("has a {name} that is no number"))
    };
    let (nx, ny) = (count("SizeX")?, count("SizeY")?);
    if count("SizeZ").unwrap_or(1) != 1 {
        return Err("has several layers of heights".into());
    }
    let samples = nx.checked_mul(ny).filter(|n| (1..=MOST_SAMPLES).contains(n));
    let samples = samples.ok_or_else(|| format!("has heights of the shape {nx} x {ny}"))?;
    let raw = heights(&mut archive, root, kind, samples)?;
    // In the file x is fastest.
    let place = |i: usize, j: usize| offset + scale * raw[j * nx + i];
    let values = (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j)));
    Ok(([nx, ny], steps, values.map(|(i, j)| place(i, j)).collect()))
}

/// Refuses axes that a matrix turns: the heights would stand elsewhere.
fn unturned(axes: Node) -> Result<(), String> {
    let Ok(turned) = find(axes, "Rotation") else { return Ok(()) };
    for (row, column) in (1..=3).flat_map(|row| (1..=3).map(move |column| (row, column))) {
        let name = format!("r{row}{column}");
        let wanted = if row == column { 1.0 } else { 0.0 };
        let value = number(turned, &name)?;
        if (value - wanted).abs() > LEAST_TURN {
            return Err(format!(
                "has a Rotation of its axes, whose {name} is {value}: turn its heights first"
            ));
        }
    }
    Ok(())
}

/// The heights as the file has them, x fastest; those that it marks as missing become NaN.
fn heights(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    root: Node,
    kind: &str,
    samples: usize,
) -> Result<Vec<f64>, String> {
    let mut linked = |link: Node, sum: &str, most: u64| {
        let name = word(link).trim_start_matches('/');
        let content = part(archive, name, most)?;
        check_sum(root, sum, &content, name).map(|()| content)
    };
    let mut raw = match find(root, "PointDataLink") {
        Ok(link) => {
            let most = (samples as u64).saturating_mul(MOST_BYTES);
            binary(&linked(link, "MD5ChecksumPointData", most)?, kind)?
        }
        Err(_) => list(find(root, "DataList")?)?,
    };
    if raw.len() != samples {
        return Err(format!("has {} heights for a shape of {samples}", raw.len()));
    }
    if let Ok(link) = find(root, "ValidPointsLink")
        && !word(link).is_empty()
    {
        let bytes = samples.div_ceil(8);
        let valid = linked(link, "MD5ChecksumValidPoints", bytes as u64)?;
        if valid.len() != bytes {
            return Err(format!("says of {} heights whether they are valid", 8 * valid.len()));
        }
        // A bit a height, the lowest of a byte first.
        for (i, height) in raw.iter_mut().enumerate() {
            if valid[i / 8] >> (i % 8) & 1 == 0 {
                *height = f64::NAN;
            }
        }
    }
    Ok(raw)
}

/// Refuses the content of the file `name` whose MD5 is not the one that the element `sum` states.
fn check_sum(root: Node, sum: &str, content: &[u8], name: &str) -> Result<(), String> {
    let stated = find(root, sum).map(word).unwrap_or_default();
    let found: String = Md5::digest(content).iter().map(|byte| format!("{byte:02x}")).collect();
    if stated.is_empty() || stated.eq_ignore_ascii_case(&found) {
        return Ok(());
    }
    Err(format!("has a damaged {name}: its MD5 is {found}, not {stated}"))
}

/// The content of a file of the archive.
fn part(archive: &mut ZipArchive<Cursor<&[u8]>>, name: &str, most: u64) -> Result<Vec<u8>, String> {
    let file = archive.by_name(name).map_err(|e| format!("has no {name}: {e}"))?;
    let mut content = Vec::new();
    file.take(most + 1)
        .read_to_end(&mut content)
        .map_err(|e| format!("has a damaged {name}: {e}"))?;
    if content.len() as u64 > most {
        return Err(format!("has a {name} that is larger than its heights"));
    }
    Ok(content)
}

/// The first element of this name, in any namespace.
fn find<'a, 'i>(from: Node<'a, 'i>, name: &str) -> Result<Node<'a, 'i>, String> {
    let own = |node: &Node| node.is_element() && node.tag_name().name() == name;
    from.descendants().find(own).ok_or_else(|| format!("has no {name} in its main.xml"))
}

fn word<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or("").trim()
}

fn number(node: Node, name: &str) -> Result<f64, String> {
    let text = word(find(node, name)?);
    let value = text.parse::<f64>().ok().filter(|v| v.is_finite());
    value.ok_or_else(|| format!("has an {name} '{text}', which is no number"))
}

/// The increment of an axis, which is above zero.
fn increment(axis: Node) -> Result<f64, String> {
    let value = number(axis, "Increment")?;
    if value > 0.0 { Ok(value) } else { Err(format!("has an Increment of {value}")) }
}

/// Numbers of the format's kind: 16 or 32-bit whole ones, 32 or 64-bit floats.
fn binary(bytes: &[u8], kind: &str) -> Result<Vec<f64>, String> {
    let chunks = |size: usize, of: fn(&[u8]) -> f64| -> Result<Vec<f64>, String> {
        match bytes.len() % size {
            0 => Ok(bytes.chunks_exact(size).map(of).collect()),
            _ => Err(format!("has {} bytes of heights of {size} bytes each", bytes.len())),
        }
    };
    match kind {
        "I" => chunks(2, |b| f64::from(i16::from_le_bytes([b[0], b[1]]))),
        "L" => chunks(4, |b| f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        "F" => chunks(4, |b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        "D" => chunks(8, |b| f64::from_le_bytes(b.try_into().expect("eight bytes"))),
        _ => Err(format!("has heights of the type '{kind}'; known are I, L, F and D")),
    }
}

/// Heights in the description itself, one a datum, the last of whose numbers is the height; an
/// empty one is missing.
fn list(node: Node) -> Result<Vec<f64>, String> {
    let data = node.children().filter(|child| child.tag_name().name() == "Datum");
    data.map(|datum| match word(datum).rsplit(';').next().unwrap_or("").trim() {
        "" => Ok(f64::NAN),
        text => text.parse().map_err(|_| format!("has a datum '{text}', which is no number")),
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::SimpleFileOptions;

    /// An archive with this description and these bytes of heights.
    fn archive(kind: &str, shape: [usize; 2], data: Option<&[u8]>, list: &str) -> Vec<u8> {
        archive_with([kind, ""], shape, data, list, None)
    }

    /// The same with more elements in the description and these bits of validity.
    fn archive_with(
        description: [&str; 2],
        shape: [usize; 2],
        data: Option<&[u8]>,
        list: &str,
        valid: Option<&[u8]>,
    ) -> Vec<u8> {
        archive_on("", description, shape, data, list, valid)
    }

    /// The same with more elements among the axes.
    fn archive_on(
        axes: &str,
        [kind, more]: [&str; 2],
        shape: [usize; 2],
        data: Option<&[u8]>,
        list: &str,
        valid: Option<&[u8]>,
    ) -> Vec<u8> {
        let mask = match valid {
            Some(_) => "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>",
            None => "",
        };
        let link = match data {
            Some(_) => format!(
                "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>{mask}</DataLink>"
            ),
            None => format!("<DataList>{list}</DataList>"),
        };
        let text = format!(
            "<?xml version=\"1.0\"?><p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><Axes>\
             <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment></CX>\
             <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>3e-6</Increment></CY>\
             <CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>1e-9</Increment><Offset>0</Offset></CZ>\
             {axes}</Axes></Record1><Record3><MatrixDimension><SizeX>{}</SizeX><SizeY>{}</SizeY><SizeZ>1</SizeZ>\
             </MatrixDimension>{link}{more}</Record3></p:ISO5436_2>",
            shape[0], shape[1]
        );
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        writer.start_file("main.xml", SimpleFileOptions::default()).unwrap();
        writer.write_all(text.as_bytes()).unwrap();
        for (name, bytes) in [("bindata/data.bin", data), ("bindata/valid.bin", valid)] {
            if let Some(bytes) = bytes {
                writer.start_file(name, SimpleFileOptions::default()).unwrap();
                writer.write_all(bytes).unwrap();
            }
        }
        writer.finish().unwrap().into_inner()
    }

    #[test]
    fn heights_of_every_type_are_read() {
        let counts = [1i16, -2, 3, 4, 5, -600];
        // x is fastest in the file: (0, 0), (1, 0), (2, 0), (0, 1) ...
        let wanted = [1.0, 4.0, -2.0, 5.0, 3.0, -600.0].map(|v| v * 1e-9);
        let lengths: Vec<f64> = counts.iter().map(|v| f64::from(*v) * 1e-9).collect();
        let datum = |v: &f64| format!("<Datum>0;0;{v:e}</Datum>");
        for (kind, data, list) in [
            ("I", Some(counts.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()), None),
            ("L", Some(counts.iter().flat_map(|v| i32::from(*v).to_le_bytes()).collect()), None),
            ("F", Some(lengths.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect()), None),
            ("D", Some(lengths.iter().flat_map(|v| v.to_le_bytes()).collect()), None),
            ("D", None, Some(lengths.iter().map(datum).collect::<String>())),
        ] {
            let bytes = archive(kind, [3, 2], data.as_deref(), list.as_deref().unwrap_or(""));
            let (shape, steps, values) = read(&bytes).unwrap();
            assert_eq!((shape, steps), ([3, 2], [2e-6, 3e-6]));
            for (got, want) in values.iter().zip(wanted) {
                assert!((got - want).abs() <= 1e-7 * want.abs(), "{kind}: {values:?}");
            }
        }
    }

    #[test]
    fn what_is_damaged_is_named() {
        let data = 1f64.to_le_bytes();
        for (bytes, wanted) in [
            (b"PK no".to_vec(), "is no zip archive"),
            (archive("D", [2, 1], Some(&data), ""), "has 1 heights for a shape of 2"),
            (archive("Q", [1, 1], Some(&data), ""), "of the type 'Q'"),
            (archive("D", [1, 1], Some(&data[..5]), ""), "5 bytes of heights of 8"),
            (archive("D", [1, 1], None, "<Datum>x</Datum>"), "'x', which is no number"),
        ] {
            let said = read(&bytes).unwrap_err();
            assert!(said.contains(wanted), "{said}");
        }
        // A description may say what its data are, and their MD5.
        let described = |feature: &str, sum: &str| {
            let said = format!(
                "<FeatureType>{feature}</FeatureType>\
                 <MD5ChecksumPointData>{sum}</MD5ChecksumPointData>"
            );
            read(&archive_with(["D", &said], [1, 1], Some(&data), "", None))
        };
        // The MD5 of eight bytes 00 00 00 00 00 00 f0 3f, by md5sum.
        let sum = "e02e0d84c1f7b647c18ab9646d57ec89";
        for stated in [sum, "", &sum.to_uppercase()] {
            assert_eq!(described("SUR", stated).unwrap().2, [1.0]);
        }
        let said = described("SUR", &sum.replace('9', "8")).unwrap_err();
        assert!(said.contains(&format!("damaged bindata/data.bin: its MD5 is {sum}")), "{said}");
        // Axes that are turned would put the heights elsewhere.
        let turned = |r12: &str| {
            let matrix: String = (0..9)
                .map(|n| (n / 3 + 1, n % 3 + 1))
                .map(|(i, j)| match (i, j) {
                    (1, 2) => format!("<r12>{r12}</r12>"),
                    _ => format!("<r{i}{j}>{}</r{i}{j}>", u8::from(i == j)),
                })
                .collect();
            let axes = format!("<Rotation>{matrix}</Rotation>");
            read(&archive_on(&axes, ["D", ""], [1, 1], Some(&data), "", None))
        };
        assert_eq!(turned("0").unwrap().2, [1.0]);
        assert_eq!(turned("-1e-9").unwrap().2, [1.0]);
        let said = turned("0.5").unwrap_err();
        assert!(said.contains("whose r12 is 0.5: turn its heights first"), "{said}");
        let said = described("PRF", sum).unwrap_err();
        assert!(said.contains("a FeatureType 'PRF', not SUR"), "{said}");
        // A missing height is a hole, which a surface must not have.
        let (_, _, values) = read(&archive("D", [1, 1], None, "<Datum></Datum>")).unwrap();
        assert!(values[0].is_nan());
        // Whole numbers have no NaN: bits say which of them are heights.
        let data: Vec<u8> = (0..10i16).flat_map(|v| v.to_le_bytes()).collect();
        let masked =
            |valid: &[u8]| read(&archive_with(["I", ""], [10, 1], Some(&data), "", Some(valid)));
        let (_, _, values) = masked(&[0b1111_1110, 0b01]).unwrap();
        let holes: Vec<usize> = (0..10).filter(|i| values[*i].is_nan()).collect();
        assert_eq!(holes, [0, 9]);
        assert!(masked(&[0xff]).unwrap_err().contains("of 8 heights"));
    }
}
