//! `edgeline solve --field`: the files as ParaView's reader sees them.
//!
//! Skipped with a message where the system's Python cannot import VTK, unless
//! `EDGELINE_REQUIRE_VTK` is set; `tests/all.sh` installs it and sets that.

use crate::support::{edgeline, files, succeeded};
use std::fmt::Write;
use std::process::Command;

/// Prints `name x y z` and the arrays' values at points spread over each grid, by VTK's reader.
const READER: &str = r#"
import sys
from vtkmodules.vtkIOXML import vtkXMLRectilinearGridReader
for name in sys.argv[1:]:
    reader = vtkXMLRectilinearGridReader()
    reader.SetFileName(name + ".vtr")
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    count = grid.GetNumberOfPoints()
    print("grid", name, *grid.GetDimensions(), count)
    print("bounds", name, *map(repr, grid.GetBounds()))
    for n in range(10):
        i = (n * 7919 + 13) % count
        values = [data.GetArray(k).GetTuple1(i) for k in range(data.GetNumberOfArrays())]
        print("point", name, *(repr(v) for v in (*grid.GetPoint(i), *values)))
    print("arrays", name, *(data.GetArrayName(k) for k in range(data.GetNumberOfArrays())))
"#;

#[test]
fn a_real_reader_finds_the_right_values() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let field = ["--field", "--field-points", "9,11,8", "--out", "f"];
    succeeded(&mut edgeline(at, &[&["solve", "half-short"], &field[..]].concat()));
    let mut names = files(&at.join("f"));
    names.retain(|n| n.starts_with("field") || n == "pressure.vtr");
    let mut expected = vec!["pressure.vtr".to_string()];
    for body in ["block", "roller"] {
        expected.push(format!("field-{body}.vtr"));
        for place in ["critical-depth", "end", "x0"] {
            expected.extend(["svg", "png"].map(|form| format!("field-{body}-{place}.{form}")));
        }
    }
    expected.sort();
    assert_eq!(names, expected);

    let python = "/usr/bin/python3";
    let imports = Command::new(python).args(["-c", "import vtkmodules.vtkIOXML"]).output();
    if !imports.is_ok_and(|o| o.status.success()) {
        assert!(std::env::var_os("EDGELINE_REQUIRE_VTK").is_none(), "{python} imports no VTK");
        eprintln!("skipped: {python} cannot import VTK");
        return;
    }
    let read = Command::new(python)
        .args(["-c", READER, "field-block", "field-roller", "pressure"])
        .current_dir(at.join("f"))
        .output()
        .unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    let text = String::from_utf8(read.stdout).unwrap();
    assert!(text.contains("grid field-roller 17 21 8 2856"), "{text}");
    // Five more rows of points on the block's ledge, on either side.
    assert!(text.contains("grid field-block 17 31 8 4216"), "{text}");
    assert!(text.contains("grid pressure 17 31 1 527"), "{text}");

    // The same points by --points, in each body's own frame, each with the farthest point of its
    // line in the grid, because the extent of a line determines its wavenumbers.
    let farthest = |name: &str| -> f64 {
        let bounds = text.lines().find_map(|l| l.strip_prefix(&format!("bounds {name} "))).unwrap();
        bounds.split(' ').nth(1).unwrap().parse().unwrap()
    };
    let mut wanted: Vec<(String, Vec<f64>)> = Vec::new();
    for line in text.lines().filter(|l| l.starts_with("point")) {
        let mut words = line.split(' ').skip(1);
        let name = words.next().unwrap().to_string();
        wanted.push((name, words.map(|w| w.parse().unwrap()).collect()));
    }
    assert_eq!(wanted.len(), 30);
    let mut points = String::from("body,x_m,y_m,z_m\n");
    for (name, v) in &wanted {
        let body = if name == "field-roller" { "roller" } else { "block" };
        for x in [v[0], farthest(name)] {
            writeln!(points, "{body},{x:e},{:e},{:e}", v[1], v[2].abs()).unwrap();
        }
    }
    std::fs::write(at.join("points.csv"), points).unwrap();
    succeeded(&mut edgeline(at, &["solve", "half-short", "--points", "points.csv", "--out", "p"]));
    let mut reader = csv::Reader::from_path(at.join("p/points.csv")).unwrap();
    let (mut compared, mut largest) = (0, 0.0f64);
    for ((name, v), row) in wanted.iter().zip(reader.records().step_by(2)) {
        let row = row.unwrap();
        let mut s: Vec<f64> = row.iter().skip(4).map(|c| c.parse().unwrap()).collect();
        if name == "field-roller" {
            // The grid's frame has z into the block for both bodies.
            (s[4], s[5]) = (-s[4], -s[5]);
        }
        if name == "pressure" {
            s = vec![(-s[2]).max(0.0)];
        }
        assert_eq!(v.len(), 3 + s.len());
        for (got, want) in v[3..].iter().zip(&s) {
            // The grid's values are of single precision, of a p0 of 1.5 GPa.
            assert!((got - want).abs() <= 1e-6 * want.abs() + 2e3, "{name} {v:?}: {got} {want}");
            largest = largest.max(want.abs());
            compared += 1;
        }
    }
    assert_eq!(compared, 10 * (8 + 8 + 1));
    assert!(largest > 1e8, "points with stresses to speak of are among them");
}
